"""
A runtime written from docs/bundle.md alone, in NumPy: slow, and of no use but to tell whether that page is complete.

Nothing of the project is imported. Numbers in brackets are sections of the page.
"""

import itertools
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[np.float64]]

STANDARD_GRAVITY = 9.80665
BEHIND_DISTANCE, SAME_TOUCH, MOST_CANDIDATES = 0.003, 4.5, 8
SAME_SLOPE, NO_DEEPER = 0.5, 1 + 1e-6
LAYER_SHARE, LAYER_SLOPE, LAYER_COST, SAME_MISFIT = 0.3, 0.4, 4.0, 0.25
STEEPEST, GRAZING, SHARP = 0.001, 0.0174524064372835, 0.7660444431189780
LEAST_VARIANCE, MOST_Q, FAR, TIE, NO_FURTHER = 1e-12, 1.75, 1000.0, 2.0**-24, 1e-9
MOST_STALE, LEAST_FROZEN, FROZEN_MEMORY = 50, 5, 20000
TWIST_SPAN, MOST_TURN, POSE_CAPACITY = 0.04, 1.5, 512
LEAST_FIT, FIT_SPAN, FINEST, UNFOLLOWED, FLANGE_LEVER = 8, 0.7, 2e-5, 0.1, 0.05
DOUBT, MOST_ACCELERATION, BEND_SPAN = 8, 100.0, 0.07
MEMORY, PRIOR, MOST_ARM, WIDE = 1.0, 0.5, 0.009, 2.5
CHANGED, MOVED, LEANS = 0.12, 0.5, 0.25
LATE, CLOCK, OVERRANGE = 8, 32, 1
FROZEN, SILENT, FLAGGED, NO_POSE, LEAPT = 1, 2, 4, 8, 16
POINTS = {"ok", "vertex", "ambiguous", "by_region", "two_touches", "uncertain"}
UNKNOWN = np.full(3, np.nan)


def skew(v: Array) -> Array:
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def rotvec(R: Array) -> Array:
    v = 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    e, c = float(np.linalg.norm(v)), 0.5 * (R[0, 0] + R[1, 1] + R[2, 2] - 1)
    return v * (np.arctan2(e, c) / e) if e > 1e-12 else v


def rot(w: Array) -> Array:
    a = float(np.linalg.norm(w))
    A = np.sin(a) / a if a > 1e-4 else 1 - a * a / 6
    B = (1 - np.cos(a)) / (a * a) if a > 1e-4 else 0.5 - a * a / 24
    return np.eye(3) + A * skew(w) + B * (skew(w) @ skew(w))


def is_rotation(R: Array) -> bool:
    x, y, z = R
    off = [abs(x @ x - 1), abs(y @ y - 1), abs(z @ z - 1), abs(x @ y), abs(y @ z), abs(z @ x)]
    return max(off) <= 1e-3 and float(np.cross(x, y) @ z) > 0


# ---- the probe (4) -----------------------------------------------------------------------------


@dataclass
class Mesh:
    vertices: Array  # m
    faces: Any  # lowest vertex first
    normals: Array
    region: Any
    centre: Array
    scale: float
    corners: Array  # (n, 3, 3), mesh scales, lowest vertex first
    spread: Array
    bend: Array
    prior: Array


def read_mesh(data: bytes, touch: dict[str, Any], regions: list[dict[str, Any]]) -> Mesh:
    head, body = data.split(b"end_header\n", 1)
    count = {
        words[1]: int(words[2])
        for words in map(str.split, head.decode().splitlines())
        if words[0] == "element"
    }
    V, N = count["vertex"], count["face"]
    vertices = np.frombuffer(body, "<f8", 3 * V).reshape(V, 3)
    row = np.dtype([("three", "u1"), ("v", "<i4", 3), ("region", "<i4"), ("rest", "u1", 4)])
    rows = np.frombuffer(body, row, N, offset=24 * V)
    faces, region = rows["v"].astype(int), rows["region"].astype(int)
    used = vertices[faces.ravel()]
    low, high = used.min(axis=0), used.max(axis=0)
    half = 0.5 * (high - low)
    centre, scale = low + half, float(half.max())
    p = (1 / scale) * (vertices - centre)
    n = np.cross(p[faces[:, 1]] - p[faces[:, 0]], p[faces[:, 2]] - p[faces[:, 0]])
    normals = n / np.linalg.norm(n, axis=1)[:, None]
    spread, bend = np.zeros(N), np.zeros(N)
    if touch["mesh_curved"]:
        edges: dict[tuple[int, int], list[tuple[int, bool]]] = {}
        for f, t in enumerate(faces.tolist()):
            for i in range(3):
                u, w = t[i], t[(i + 1) % 3]
                edges.setdefault((min(u, w), max(u, w)), []).append((f, u < w))
        turn, arch, middle = np.zeros(N), np.zeros(N), p[faces].mean(axis=1)
        for users in edges.values():
            if len(users) != 2 or users[0][1] == users[1][1]:
                continue
            f, g = users[0][0], users[1][0]
            cosine = float(normals[f] @ normals[g])
            if cosine >= SHARP:
                theta = np.arccos(min(1.0, cosine))
                bow = theta * np.linalg.norm(middle[f] - middle[g])
                for each in (f, g):
                    turn[each], arch[each] = max(turn[each], theta), max(arch[each], bow)
        spread, bend = (0.7 / 8 * arch) ** 2, (0.5 * turn) ** 2
    spread = spread + (touch["mesh_deviation_m"] / scale) ** 2
    first = faces.argmin(axis=1)
    turned = faces[np.arange(N)[:, None], (first[:, None] + np.arange(3)) % 3]
    bonus = np.array([0.0, *(2 * np.log(each["odds"]) for each in regions)])
    return Mesh(vertices, turned, normals, region, centre, scale, p[turned], spread, bend, bonus[region])


# ---- a touch on a facet (13) -------------------------------------------------------------------


class Wrench:
    """What section 13 makes of a wrench."""

    def __init__(self, mesh: Mesh, F: Array, M: Array, C: Array, arm: float) -> None:
        c, s = mesh.centre, mesh.scale
        self.F, self.M, self.mesh = F, M, mesh
        self.size = float(np.linalg.norm(F))
        T = np.eye(6)
        T[3:, :3] = -skew(c)
        D = T @ C @ T.T
        D[3:, :] /= s
        D[:, 3:] /= s
        f, mu = F / self.size, (M - np.cross(c, F)) / (self.size * s)
        sg = -1.0 if np.signbit(f[2]) else 1.0
        e = -1 / (sg + f[2])
        a = np.array([1 + sg * f[0] * f[0] * e, sg * f[0] * f[1] * e, -sg * f[0]])
        b = np.array([f[0] * f[1] * e, sg + f[1] * f[1] * e, -f[1]])
        self.f, self.a, self.b, self.mu = f, a, b, mu
        self.h, self.ma, self.mb = float(mu @ f), float(mu @ a), float(mu @ b)
        self.foot = np.cross(f, mu)
        out = float(np.linalg.norm(self.foot))
        q = self.foot * (MOST_Q / out) if out > MOST_Q else self.foot
        self.l, self.l2 = arm, (arm / s) ** 2
        zero = np.zeros(3)
        Gf, Ga, Gb = (np.concatenate([np.cross(q, u), u]) for u in (f, a, b))
        Ta, Tb = np.concatenate([b, zero]), np.concatenate([-a, zero])

        def pair(x: Array, y: Array) -> float:
            return float(x @ D @ y) / (self.size * self.size)

        self.ff = pair(Gf, Gf) + LEAST_VARIANCE
        self.fa = (pair(Ga, Gf), pair(Ta, Gf), 0.0)
        self.fb = (pair(Gb, Gf), pair(Tb, Gf), 0.0)
        self.aa = (pair(Ga, Ga) + LEAST_VARIANCE, 2 * pair(Ga, Ta), pair(Ta, Ta))
        self.ab = (pair(Ga, Gb), pair(Ga, Tb) + pair(Gb, Ta), pair(Ta, Tb))
        self.bb = (pair(Gb, Gb) + LEAST_VARIANCE, 2 * pair(Gb, Tb), pair(Tb, Tb))

    def given(self, n: Any, t: Any, spread: Any, bend: Any) -> dict[str, Any]:
        """V(n, t), of one facet or of many."""
        at = lambda d: d[0] + t * (d[1] + t * d[2])  # noqa: E731
        fa, fb, aa, ab, bb = (at(d) for d in (self.fa, self.fb, self.aa, self.ab, self.bb))
        c = np.maximum(-(n @ self.f), 1e-6)
        na, nb = n @ self.a, n @ self.b
        bent = bend * self.h**2 / c**2
        ua, ub = na + fa * c / self.ff, nb + fb * c / self.ff
        T = self.ff + self.l2 * c**2
        v = self.l2 * self.ff / T
        kappa = -self.l2 * self.h * c / T
        ka, kb = v * ua, v * ub
        return {
            "pitch2": self.h**2 / T,
            "kappa": kappa,
            "ka": ka,
            "kb": kb,
            "wa": self.h * fa / self.ff + ua * kappa,
            "wb": self.h * fb / self.ff + ub * kappa,
            "aa": aa + bent + spread * nb**2 - fa**2 / self.ff + ka * ua,
            "ab": ab - spread * na * nb - fa * fb / self.ff + ka * ub,
            "bb": bb + bent + spread * na**2 - fb**2 / self.ff + kb * ub,
        }

    def on_facets(self) -> dict[str, Any]:
        """d2, torque, weights and point on every facet."""
        m = self.mesh
        along = m.corners @ self.f
        c = np.maximum(-(m.normals @ self.f), 1e-6)
        met = (m.normals @ self.foot - (m.normals * m.corners[:, 0]).sum(axis=1)) / c
        t = np.clip(met, along.min(axis=1), along.max(axis=1))
        g = self.given(m.normals, t, m.spread, m.bend)
        L11 = np.sqrt(g["aa"])
        L21 = g["ab"] / L11
        L22 = np.sqrt(np.maximum(g["bb"] - L21**2, 1e-12 * g["bb"]))
        x = (self.ma - m.corners @ self.b - g["wa"][:, None]) / L11[:, None]
        y = (self.mb + m.corners @ self.a - g["wb"][:, None] - L21[:, None] * x) / L22[:, None]
        C = np.stack(
            [x[:, (i + 2) % 3] * y[:, (i + 1) % 3] - x[:, (i + 1) % 3] * y[:, (i + 2) % 3] for i in range(3)],
            1,
        )
        total = C.sum(axis=1)
        inside = (C >= 0).all(axis=1) & (total > 0)
        with np.errstate(all="ignore"):
            W = C / total[:, None]
        X, Y, miss = np.zeros(len(t)), np.zeros(len(t)), np.full(len(t), np.inf)
        W[~inside] = 0
        for i in range(3):
            j = (i + 1) % 3
            ex, ey = x[:, j] - x[:, i], y[:, j] - y[:, i]
            length = ex**2 + ey**2
            with np.errstate(all="ignore"):
                share = np.where(length > 0, np.clip(-(x[:, i] * ex + y[:, i] * ey) / length, 0, 1), 0)
            px, py = x[:, i] + share * ex, y[:, i] + share * ey
            d = px**2 + py**2
            here = ~inside & (d < miss)
            miss[here], X[here], Y[here] = d[here], px[here], py[here]
            W[here] = 0
            W[here, i], W[here, j] = 1 - share[here], share[here]
        miss[inside] = 0
        ta = g["ka"] / L11
        tb = (g["kb"] - L21 * ta) / L22
        v = m.vertices[m.faces]
        return {
            "d2": g["pitch2"] + miss,
            "k": (g["kappa"] + ta * X + tb * Y) * self.size * m.scale,
            "weights": W,
            "point": W[:, :1] * v[:, 0] + (W[:, 1:2] * v[:, 1] + W[:, 2:] * v[:, 2]),
        }

    def depth(self, points: Array) -> Any:
        return (1 / self.mesh.scale) * (points - self.mesh.centre) @ self.f

    def least(self, key: Array, points: Array) -> int:
        """Of equal keys the point that is met first, and of those the lowest number."""
        rounded = np.rint(key / TIE)
        equal = np.flatnonzero(rounded == rounded.min())
        return int(equal[np.rint(self.depth(points[equal]) / TIE).argmin()])

    def at_touch(self, face: int, point: Array) -> dict[str, Any]:
        m = self.mesh
        return self.given(m.normals[face], self.depth(point), m.spread[face], m.bend[face])

    def covariance(self, face: int, point: Array) -> Array:
        n, g = self.mesh.normals[face], self.at_touch(face, point)
        push = float(n @ self.f)
        if abs(push) <= 1e-9:
            push = -1e-9
        A = (n @ self.b / push) * self.f - self.b
        B = self.a - (n @ self.a / push) * self.f
        both = np.outer(A, B)
        V = g["aa"] * np.outer(A, A) + g["ab"] * (both + both.T) + g["bb"] * np.outer(B, B)
        scaled: Array = self.mesh.scale**2 * V
        return scaled


@dataclass
class Touch:
    face: int
    point: Array
    normal: Array
    k: float
    d2: float
    prior: float
    near: float
    vertex: int
    region: int
    radius: float
    slope: Array
    hidden: float = 0.0
    depth: float = 0.0

    def off_plane(self, x: Array) -> tuple[Array, Array]:
        d, steep = x - self.point, 1 / np.sqrt(1 - self.slope @ self.slope)
        off = d @ self.normal
        return steep * off, steep * np.sqrt(np.maximum(0, (d * d).sum(axis=-1) - off**2))

    def elsewhere(self, x: Array, depth: float) -> Any:
        d = x - self.point
        apart = np.sqrt(np.maximum(0, (d * d).sum(axis=-1) - (d @ self.slope) ** 2))
        if not depth > 0:
            return apart > self.radius
        height, along = self.off_plane(x)
        return (apart > self.radius) | (np.abs(height) > NO_DEEPER * depth + SAME_SLOPE * along)

    @property
    def unhidden(self) -> float:
        return self.d2 - self.near - self.prior

    @property
    def free(self) -> float:
        return self.d2 - self.near + self.hidden

    @property
    def cost(self) -> float:
        return self.free - self.prior


@dataclass
class Found:
    """What is said of one wrench, sections 14 to 16."""

    reason: str
    chosen: Touch | None = None
    runner_up: Touch | None = None
    candidates: int = 0
    misfit: float = np.nan
    left_over: float = np.nan
    arm: float = np.nan
    torsion_arm: float = np.nan
    torsion_since: float = np.nan
    confidence: float = 0.0
    second: Touch | None = None


@dataclass
class Answer:
    time: float
    reason: str = "stale"
    accepted: bool = False
    health: int = 0
    pose_age: float = np.nan
    latency: float = np.nan
    wrench: Array = field(default_factory=lambda: np.full(6, np.nan))
    point: Array = field(default_factory=UNKNOWN.copy)
    normal: Array = field(default_factory=UNKNOWN.copy)
    filtered: Array = field(default_factory=UNKNOWN.copy)
    second: Array = field(default_factory=UNKNOWN.copy)
    runner_up: Array = field(default_factory=UNKNOWN.copy)
    covariance: Array = field(default_factory=lambda: np.full((3, 3), np.nan))
    k: float = np.nan
    candidates: int = 0
    region: int = 0
    confidence: float = 0.0
    misfit: float = np.nan
    left_over: float = np.nan
    arm: float = np.nan
    torsion_arm: float = np.nan
    torsion_since: float = np.nan


# ---- parts of a stream -------------------------------------------------------------------------


@dataclass
class Pose:
    time: float
    R: Array
    p: Array


class FrozenTest:
    """(8)."""

    def __init__(self, probability: float) -> None:
        self.probability = probability
        self.last, self.run, self.longest, self.frozen = np.zeros(6), 0, [0, 0], False
        self.repeats, self.seen = 0.0, 0.0

    def see(self, channels: Array) -> bool:
        if bool((channels == self.last).all()):
            self.run += 1
            if self.run >= LEAST_FROZEN:
                p = min((self.repeats + 9) / (self.seen + 10), 0.999)
                needed = max(
                    int(np.ceil(np.log(self.probability) / np.log(p))), 3 * self.longest[1] + LEAST_FROZEN
                )
                self.frozen = self.run >= needed
            return self.frozen
        told = min(self.run, LEAST_FROZEN) if self.frozen else self.run
        self.repeats += told
        self.seen += told + 1
        if not self.frozen:
            self.longest = sorted([*self.longest, self.run], reverse=True)[:2]
        if self.seen > FROZEN_MEMORY:
            self.repeats, self.seen = self.repeats / 2, self.seen / 2
            self.longest = [length - length // 4 for length in self.longest]
        self.last, self.run, self.frozen = channels.copy(), 0, False
        return False


class Kalman:
    """(11)."""

    def __init__(self, part: dict[str, Any] | None, sigma: Array) -> None:
        self.part, self.sigma = part, sigma
        self.follows = part is not None and part["kind"] == "adaptive"
        if part is not None:
            tuned = part["rate_Hz"] / part["tuned_rate_Hz"]
            self.R = part["r"] if part["per_sample"] else part["r"] * tuned
            Q = self._q(1 / part["rate_Hz"])
            P = Q / 2 + np.sqrt(Q * (Q / 4 + self.R))
            self.settled = P / (P + 2 * self.R)
        self.reset()

    def reset(self) -> None:
        self.v, self.x, self.L, self.age = np.inf, np.zeros(6), 1.0, 0.0
        self.m, self.j, self.lag = np.zeros(6), np.zeros(6), np.zeros(6)
        self.c, self.back = 1.0, np.inf

    def _q(self, dt: float) -> float:
        assert self.part is not None
        q: float = self.part["q"]
        return q if self.part["per_sample"] else q * dt * self.part["tuned_rate_Hz"]

    def take(self, z: Array, dt: float) -> Array:
        if self.part is None:
            return z
        G = 1.0
        if np.isfinite(self.v):
            before = self.v + self._q(dt)
            G = 1 / (1 + self.R / before)
            if self.follows:
                z, G = self._follow(z, dt, float(np.sqrt(self.c * (1 + before / self.R))), G)
        self.x, self.v = G * z + (1 - G) * self.x, G * self.R
        self.L, self.age = G**2 + (1 - G) ** 2 * self.L, (1 - G) * (self.age + dt)
        return self.x

    def _follow(self, z: Array, dt: float, d: float, G: float) -> tuple[Array, float]:
        e = (z - self.x) / (self.sigma * d)
        L = G**2 + (1 - G) ** 2 * self.L
        p = min(1.0, 1.2 * np.sqrt(24 * L) / ((2 - G) * G * max(np.linalg.norm(e), 1e-300)))
        self.m += G * (p * e - self.m)
        self.c, self.back = 1 + (self.c - 1) / (1 + dt / 10), self.back + dt
        size = self.m @ self.m
        self.lag = 2 * (1 - G) * d * self.sigma * self.m if size > 6 * L else np.zeros(6)
        if size <= 24 * L:
            return self.x + p * (z - self.x), G
        if self.m @ self.j < 0:
            self.c = min(4 * self.c, 1e4) if self.back < 0.15 else self.c
            self.back = 0.0
        self.j, self.m, self.lag = self.m, np.zeros(6), np.zeros(6)
        return z, 1.0

    def skip(self, dt: float) -> None:
        self.age += dt
        if self.part is not None and np.isfinite(self.v):
            self.v += self._q(dt)

    def doubt(self) -> Array | float:
        """What comes on top of the wrench's covariance."""
        if not self.follows or not (self.lag.any() or 1.1 * self.settled < self.L):
            return 0.0
        return max(self.L - self.settled, 0.0) * np.diag(self.sigma**2) + np.outer(self.lag, self.lag)

    def released(self, F: Array, min_force: float) -> bool:
        return self.follows and np.linalg.norm(F) + 3 * self.sigma[:3].max() < min_force


class LowPass:
    """(19)."""

    def __init__(self, sections: list[list[float]]) -> None:
        self.sections = sections
        self.z: list[Array] | None = None

    def reset(self) -> None:
        self.z = None

    def take(self, x: Array) -> Array:
        if self.z is None:
            self.z, g = [], 1.0
            for b0, b1, b2, _, a1, a2 in self.sections:
                Y = (b0 + b1 + b2) / (1 + a1 + a2)
                self.z.append(np.array([g * (Y - b0) * x, g * (b2 - a2 * Y) * x]))
                g *= Y
        for z, (b0, b1, b2, _, a1, a2) in zip(self.z, self.sections, strict=True):
            y = b0 * x + z[0]
            z[0] = b1 * x - a1 * y + z[1]
            z[1] = b2 * x - a2 * y
            x = y
        return x


class TwoTouches:
    """The state of (18)."""

    def __init__(self) -> None:
        self.before: tuple[Array, Touch] | None = None
        self.later: tuple[Array, Touch] | None = None
        self.age, self.doubts, self.told = 0, 0, False
        self.second: Touch | None = None


class Torsion:
    """The state of (17)."""

    def __init__(self) -> None:
        self.sum, self.weight, self.since, self.age = 0.0, 0.0, 0.0, 0.0
        self.before: tuple[Array, Touch] | None = None
        self.later: tuple[Array, Touch] | None = None


# ---- the runtime -------------------------------------------------------------------------------


class FollowedZero:
    """(10)."""

    def __init__(self, min_force: float, *, on: bool) -> None:
        self.on, self.most = on, 0.38 * min_force
        self.lose()
        self.stood: tuple[float, Array] | None = None
        self.R = self.R_last = np.zeros((3, 3))
        self.slow = self.last = self.taken = self.variance = np.zeros(6)
        self.anchor, self.anchored, self.touched = np.zeros(3), 0.0, -np.inf
        self.P = [np.diag([first**2, 0.0]) for first in self._six(0.05, 2e-3)]
        self.beyond, self.learned, self.known, self.time = np.zeros(6), self._six(0.01, 3e-4) ** 2, None, None

    @staticmethod
    def _six(force: float, torque: float) -> Array:
        return np.repeat([force, torque], 3)

    @staticmethod
    def _kinds(of: Array) -> Array:
        return np.repeat(of.reshape(2, 3).sum(axis=1), 3)

    def lose(self) -> None:
        self.before: Array | None = None
        self.now: list[Array] = []
        self.begin = 0.0

    def see(self, w: Array, R: Array, time: float, *, touched: bool) -> None:
        if not self.on:
            return
        if not (np.trace(R.T @ self.R) - 1) / 2 > 0.99985:
            self.lose()
            self.stood, self.R = None, R
            self._look(time)
        if touched:
            self.lose()
            self.stood, self.touched = None, time
            return
        self.begin = self.begin if self.now else time
        self.now.append(w)
        if len(self.now) < 5 or time - self.begin < 0.1:
            return
        a, b = self.before, np.array(self.now)
        self.before, self.now = b, []
        if a is not None and self._steady(a, b):
            self._judge(time)
            self.lose()
        self._look(time)

    def _steady(self, a: Array, b: Array) -> bool:
        n = len(a) + len(b)
        white = (np.diff(a, axis=0) ** 2).sum(axis=0) + (np.diff(b, axis=0) ** 2).sum(axis=0)
        white /= 2 * (n - 2)
        self.z, self.s = (a.sum(axis=0) + b.sum(axis=0)) / n, white / n + self._six(0.002, 6e-5) ** 2
        allowed = self._six(0.03, 1e-3) + 4 * np.sqrt(white * (1 / len(a) + 1 / len(b)))
        return bool((np.abs(b.mean(axis=0) - a.mean(axis=0)) <= allowed).all())

    def _kept(self, time: float) -> float:
        near = np.cos(np.pi / 6)
        angle = (np.trace(self.R.T @ self.R_last) - 1) / 2
        return float(max(0.0, (angle - near) / (1 - near)) * 60 / (60 + time - (self.time or 0.0)))

    def _judge(self, time: float) -> None:
        if self.stood is not None:
            allowed = self._six(0.03, 1e-3) + self._six(2e-3, 1e-4) * (time - self.stood[0])
            if (np.abs(self.z - self.stood[1]) > allowed + 4 * np.sqrt(2 * self.s)).any():
                return
        passed, rho = (0.0, 0.0) if self.time is None else (time - self.time, self._kept(time))
        zero = np.concatenate([self.anchor, np.zeros(3)])
        far = float(np.linalg.norm((self.z - zero)[:3])) / self.most
        self.beyond = max(1 - 1 / far, 0.0) * (self.z - zero) if far else np.zeros(6)
        if far <= 1:
            self.stood = self.stood or (time, self.z)
        self.z = self.z - self.beyond
        if self.known is None:
            self.known = self._kinds(4 / 3 / (self.learned + self.s) ** 2)
        new, v = 1 - rho**2, np.maximum(self.learned - np.sqrt(2 / self.known), 0.0)
        weights, pulls = np.zeros(6), np.zeros(6)
        self.slow, self.last = self.slow.copy(), rho * self.last
        for i, walk in enumerate(self._six(1e-4, 3e-6)):
            keep = np.diag([1.0, rho])
            P = keep @ self.P[i] @ keep + np.diag([walk**2 * passed, new * v[i]])
            gain = P.sum(axis=1)
            total, e = P.sum() + self.s[i], self.z[i] - self.slow[i] - self.last[i]
            weights[i] = (new / total) ** 2
            pulls[i] = new / total**2 * (e**2 - total + new * (v[i] - self.learned[i]))
            self.slow[i] += gain[0] / total * e
            self.last[i] += gain[1] / total * e
            self.P[i] = P - np.outer(gain, gain) / total
        self.known = (1 - new / 40) * self.known + self._kinds(weights)
        self.learned = self.learned + self._kinds(pulls) / self.known
        self.anchored = time if self.time is None else self.anchored
        if far <= 1 and time - self.touched < 0.5:
            gap, way = self.slow[:3] - self.anchor, 2e-3 * min(time - self.anchored, 30.0)
            size = float(np.linalg.norm(gap))
            self.anchor = self.anchor + (gap if size <= way else way / size * gap)
            self.anchored = time
        self.time, self.R_last = time, self.R

    def _look(self, time: float) -> None:
        if self.time is None:
            return
        rho, passed = self._kept(time), time - self.time
        self.taken = self.slow + rho * self.last
        gap = self.taken[:3] - self.anchor
        if np.linalg.norm(gap) > self.most:
            self.taken[:3] = self.anchor + self.most / np.linalg.norm(gap) * gap
        at = np.array([1.0, rho])
        walk = self._six(1e-4, 3e-6) ** 2 * passed
        known = np.array([at @ P @ at for P in self.P])
        self.variance = known + walk + (1 - rho**2) * np.maximum(self.learned, 0.0) + self.beyond**2


class Reference:
    """A bundle's runtime (5): poses and samples, in the order in which they come."""

    def __init__(self, folder: Path) -> None:
        about = json.loads((folder / "contactbench.json").read_text(encoding="utf-8"))
        self.mesh = read_mesh((folder / "probe.ply").read_bytes(), about["touch"], about["regions"])
        gravity, self.gates, self.streams = about["gravity"], about["gates"], about["streams"]
        self.g, self.L = np.array(gravity["gravity_W_N"]), np.array(gravity["centre_of_mass_S_m"])
        self.bias = np.concatenate([gravity["force_bias_N"], gravity["torque_bias_Nm"]])
        error = about["touch"]["model_error"]
        sigma = np.concatenate([error["force_N"], error["torque_Nm"]])
        self.C = np.array(about["noise"]["wrench_covariance"]) + np.diag(sigma**2)
        self.l0 = self.arm = about["touch"]["torsion_arm_m"]
        self.learned = about["touch"].get("torsion", "fixed") == "learned"
        self.c_min = max(float(np.cos(self.gates["friction_angle_rad"])), STEEPEST) - TIE
        self.rival, self.behind, self.follow = (
            2 * float(np.log(self.gates[f"{name}_odds"])) for name in ("rival", "first", "follow")
        )
        self.limits = np.array([np.inf if each is None else each for each in self.gates["saturation"]])
        quaternion = about["frames"]["quaternion_ES"]
        self.R_ES = None
        if quaternion is not None:
            w, *v = np.array(quaternion) / np.linalg.norm(quaternion)
            X = skew(np.array(v))
            self.R_ES = np.eye(3) + 2 * w * X + 2 * X @ X
        noise = about["noise"]
        self.kalman = Kalman(
            about["filters"]["wrench"], np.concatenate([noise["force_N"], noise["torque_Nm"]])
        )
        location = about["filters"]["location"]
        self.low_pass = LowPass([] if location is None else location["sections"])
        self.frozen = FrozenTest(self.streams["frozen_probability"])
        self.zero = FollowedZero(self.gates["min_force_N"], on=about["zero"].get("follow", False))
        self.poses: list[Pose] = []
        self.heard: float | None = None
        self.start_anew()

    def start_anew(self) -> None:
        self.zero.lose()
        self.last_time: float | None = None
        self.kalman.reset()
        self.low_pass.reset()
        self.wrench: Array | None = None
        self.held: Array | None = None
        self.previous: Array | None = None
        self.misses = self.uncertain = 0
        self.pair, self.torsion = TwoTouches(), Torsion()
        self.stale_count, self.stale_begin, self.stale_last = 0, 0.0, 0.0

    # -- poses (6)

    def pose(self, R: Array, p: Array, time: float) -> bool:
        R_WS = R if self.R_ES is None else R @ self.R_ES
        if not (np.isfinite(time) and np.isfinite(R_WS).all() and is_rotation(R_WS)):
            return False
        if self.poses and time <= self.poses[-1].time:
            if self.poses[-1].time - time <= self.streams["pose_gap_s"]:
                return False
            self.poses.clear()
        self.poses.append(Pose(time, R_WS, p if np.isfinite(p).all() else UNKNOWN))
        del self.poses[:-POSE_CAPACITY]
        return True

    def orientation(self, t: float) -> tuple[Array | None, float]:
        gap = self.streams["pose_gap_s"]
        base = len(self.poses) - 1
        while base >= 0 and self.poses[base].time > t:
            base -= 1
        if base < 0:
            return None, np.nan
        a = self.poses[base]
        age = t - a.time
        if age == 0:
            return a.R, age
        if base + 1 < len(self.poses) and (wide := self.poses[base + 1].time - a.time) <= gap:
            return self._moved(a, a, self.poses[base + 1], age / wide), age
        if age > self.streams["pose_ahead_s"]:
            return None, age
        z = base
        while (
            z > 0
            and a.time - self.poses[z].time < TWIST_SPAN
            and self.poses[z].time - self.poses[z - 1].time <= gap
        ):
            z -= 1
        if z == base:
            return a.R, age
        if np.linalg.norm(rotvec(self.poses[z].R.T @ a.R)) > MOST_TURN:
            return None, age
        return self._moved(a, self.poses[z], a, age / max(a.time - self.poses[z].time, TWIST_SPAN)), age

    @staticmethod
    def _moved(c: Pose, a: Pose, b: Pose, q: float) -> Array:
        turned: Array = c.R @ rot(q * rotvec(a.R.T @ b.R))
        return turned

    # -- motion (7)

    def _fitted(self, poses: list[Pose]) -> tuple[Pose, Array, Array, float] | None:
        window, newest = self.streams["motion"]["window_s"], poses[-1]
        used: list[Pose] = []
        for pose in reversed(poses):
            if newest.time - pose.time > window or np.isnan(pose.p[0]):
                break
            used.append(pose)
        if len(used) < LEAST_FIT or newest.time - used[-1].time < FIT_SPAN * window:
            return None
        U = np.array([[((pose.time - newest.time) / window) ** r for r in range(4)] for pose in used])
        Y = np.array([[*(pose.p - newest.p), *rotvec(newest.R.T @ pose.R)] for pose in used])
        K = np.linalg.inv(U.T @ U)
        c = K @ (U.T @ Y)
        left = (Y - U @ c)[:, :3]
        variance = max(float((left**2).sum()) / (3 * (len(used) - 4)), FINEST**2)
        return newest, c, K, variance

    def _bend(self, poses: list[Pose]) -> float | None:
        nodes = [poses[-1]] if np.isfinite(poses[-1].p).all() else []
        for after, pose in zip(reversed(poses[1:]), reversed(poses[:-1]), strict=True):
            wide = after.time - pose.time > self.streams["pose_gap_s"]
            if not nodes or len(nodes) == 4 or wide or np.isnan(pose.p[0]):
                break
            if nodes[-1].time - pose.time >= BEND_SPAN:
                nodes.append(pose)
        if len(nodes) < 3:
            return None
        slopes = [(a.p - b.p) / (a.time - b.time) for a, b in itertools.pairwise(nodes)]
        spans = [nodes[i].time - nodes[i + 2].time for i in range(len(nodes) - 2)]
        bends = [2 * (a - b) / s for (a, b), s in zip(itertools.pairwise(slopes), spans, strict=True)]
        largest = max(float(np.linalg.norm(bend)) for bend in bends)
        return largest if largest <= MOST_ACCELERATION else None

    def load(self, R_WS: Array, t: float) -> tuple[Array, Array]:
        """g' and C."""
        motion = self.streams["motion"]
        poses = self.poses
        if motion is not None and poses and poses[-1].time - t > motion["window_s"] / 2:
            poses = [pose for pose in poses if pose.time <= t + motion["window_s"] / 2]
        if motion is None or not poses or t - poses[-1].time > self.streams["pose_ahead_s"]:
            return self.g, self.C
        mass = float(np.linalg.norm(self.g)) / STANDARD_GRAVITY
        fit = self._fitted(poses)
        if fit is None:
            bend = self._bend(poses)
            if bend is None or poses[-1].time - t > self.streams["pose_gap_s"]:
                return self.g, self.C
            return self.g, self.C + self._share((mass * bend) ** 2, 0.0)
        newest, c, K, variance = fit
        window, gyration = motion["window_s"], motion["gyration_m"]
        u = (t - newest.time) / window
        if u < -1:
            return self.g, self.C
        b1, b2 = np.array([0, 1, 2 * u, 3 * u * u]) / window, np.array([0, 0, 2, 6 * u]) / window**2
        seen, spread = (b2 @ c)[:3], float(b2 @ K @ b2) * variance
        size2 = float(seen @ seen)
        if max(size2, spread + UNFOLLOWED**2 * size2) > MOST_ACCELERATION**2:
            return self.g, self.C
        a = seen * max(0.0, 1 - DOUBT * spread / size2) if size2 > 0 else seen
        spin, rate = newest.R @ (b1 @ c)[3:], newest.R @ (b2 @ c)[3:]
        r = R_WS @ self.L
        inertial = mass * (a + np.cross(rate, r) + np.cross(spin, np.cross(spin, r)))
        v = mass**2 * (
            spread + UNFOLLOWED**2 * size2 + (FLANGE_LEVER * (np.linalg.norm(rate) + spin @ spin)) ** 2
        )
        return self.g - inertial, self.C + self._share(v, float(mass * gyration**2 * np.linalg.norm(rate)))

    def _share(self, v: float, q: float) -> Array:
        X = skew(self.L)
        more: Array = np.block([[v * np.eye(3), v * X.T], [v * X, v * X @ X.T + q**2 * np.eye(3)]])
        return more

    # -- one sample (5)

    def sample(self, channels: Array, time: float, arrival: float = np.nan, flags: int = 0) -> Answer:
        out = Answer(time, latency=arrival - time)
        out.health = self._health(channels, flags)
        self.heard = arrival if np.isfinite(arrival) else time
        R_WS: Array | None = None
        if np.isfinite(time):
            R_WS, out.pose_age = self.orientation(time)
            if R_WS is None:
                out.health |= NO_POSE
                return out
        wrong = flags & ~(LATE | CLOCK)
        over = bool((np.abs(channels) >= self.limits).any())
        if wrong and not (wrong == OVERRANGE and over):
            channels = np.full(6, np.nan)
        if R_WS is None or not np.isfinite(channels).all():
            out.reason = "not_finite"
            return out
        if self.last_time is not None and time <= self.last_time and not self._went_back(time):
            return out
        if not is_rotation(R_WS):
            out.reason = "not_a_rotation"
            return out
        self._locate(channels, R_WS, time, out)
        return out

    def _health(self, channels: Array, flags: int) -> int:
        health = FROZEN if self.frozen.see(channels) else 0
        health |= FLAGGED if flags & ~(LATE | CLOCK) else 0
        return health | (LEAPT if flags & CLOCK else 0)

    def _went_back(self, time: float) -> bool:
        """(9)."""
        if self.stale_count == 0 or time <= self.stale_last:
            self.stale_count, self.stale_begin = 0, time
        self.stale_last = time
        self.stale_count += 1
        if self.stale_count > MOST_STALE or time - self.stale_begin > self.gates["max_age_s"]:
            self.start_anew()
            return True
        return False

    def _locate(self, channels: Array, R_WS: Array, time: float, out: Answer) -> None:
        if self.last_time is not None and time - self.last_time > self.gates["max_age_s"]:
            self.start_anew()
        dt = 0.0 if self.last_time is None else time - self.last_time
        self.last_time, self.stale_count = time, 0
        saturated = bool((np.abs(channels) >= self.limits).any())
        C = self.C
        if saturated or out.health & (FROZEN | LEAPT):
            self.kalman.skip(dt)
            found = Found("saturated" if saturated else "unhealthy")
            if self.previous is None:
                self.torsion = Torsion()
            found.torsion_since = self.torsion.since if self.learned else np.nan
            self._miss_or_take(found, dt)
            self.zero.lose()
        else:
            g, C = self.load(R_WS, time)
            weight = R_WS.T @ g
            w = channels - self.bias - np.concatenate([weight, np.cross(self.L, weight)])
            left = w - self.zero.taken
            self.wrench = self.kalman.take(left, dt)
            C = C + np.diag(self.zero.variance) + self.kalman.doubt()
            now = np.zeros(6) if self.kalman.released(left[:3], self.gates["min_force_N"]) else self.wrench
            if self.previous is None:
                self.torsion = Torsion()
            elif not self.pair.told and np.linalg.norm(now[:3]) >= max(self.gates["min_force_N"], 1e-300):
                self._see(Wrench(self.mesh, now[:3], now[3:], C, self.l0), dt)
            self.arm = self._learned_arm()
            found = self.located(now, C, self.previous, self.arm)
            self._two_touches(now, C, found)
            if found.reason == "two_touches":
                self.torsion = Torsion()
            found.torsion_arm = np.nan if found.reason == "low_force" else self.arm
            found.torsion_since = self.torsion.since if self.learned else np.nan
            self._miss_or_take(found, dt)
            self.zero.see(w, R_WS, time, touched=found.chosen is not None)
        if self.wrench is not None:
            out.wrench = self.wrench.copy()
            out.latency += self.kalman.age if self.kalman.part is not None else 0.0
        self._describe(found, C, out)

    def _describe(self, found: Found, C: Array, out: Answer) -> None:
        out.reason, out.candidates, out.misfit = found.reason, found.candidates, found.misfit
        out.left_over, out.arm, out.confidence = found.left_over, found.arm, found.confidence
        out.torsion_arm, out.torsion_since = found.torsion_arm, found.torsion_since
        out.accepted = out.health == 0 and self.accepts(found.reason)
        self.uncertain = 0 if out.accepted else self.uncertain + (found.reason == "uncertain")
        if found.chosen is not None and self.wrench is not None:
            c = found.chosen
            out.point, out.normal, out.k, out.region = c.point, c.normal, c.k, c.region
            if found.second is None:
                about = Wrench(self.mesh, self.wrench[:3], self.wrench[3:], C, self.arm)
                out.covariance = self._covariance(about, c)
            out.runner_up = UNKNOWN if found.runner_up is None else found.runner_up.point
            out.second = UNKNOWN if found.second is None else found.second.point
        if out.accepted:
            self.held = self.low_pass.take(out.point)
        elif self.previous is None or self.uncertain > self.gates["recent_samples"]:
            self.low_pass.reset()
            self.held = None
        if self.held is not None:
            out.filtered = self.held

    def _covariance(self, about: Wrench, c: Touch) -> Array:
        cosine = max(-float(c.normal @ about.f), STEEPEST)
        slope = (about.f + cosine * c.normal) / cosine
        patch = max(0.0, about.l**2 - self.l0**2) / WIDE * np.outer(slope, slope)
        return about.covariance(c.face, c.point) + patch + c.depth**2 * np.outer(about.f, about.f)

    # -- candidates and ranking (14, 15, 16)

    def located(self, w: Array, C: Array, previous: Array | None, l: float) -> Found:  # noqa: E741
        F, M, gates = w[:3], w[3:], self.gates
        size = float(np.linalg.norm(F))
        if size == 0 or size < gates["min_force_N"]:
            return Found("low_force")
        wrench = Wrench(self.mesh, F, M, C, l)
        arm, most = self.mesh.scale * wrench.h, gates["implausible_misfit"]
        if float(wrench.mu @ wrench.mu) >= FAR**2:
            return Found("implausible", misfit=max(most, wrench.h**2 / (wrench.ff + wrench.l2)), arm=arm)
        fits = wrench.on_facets()
        facing, d2, points, prior = (
            -(self.mesh.normals @ wrench.f),
            fits["d2"],
            fits["point"],
            self.mesh.prior,
        )
        near = np.zeros(len(d2))
        if previous is not None:
            near[np.linalg.norm(points - previous, axis=1) <= gates["follow_distance_m"]] = self.follow
        usable = (facing >= self.c_min) & (d2 <= most)
        if not usable.any():
            return self._no_touch(wrench, fits, facing, arm)
        key = np.where(usable, d2 - prior - near, np.inf)
        best = wrench.least(key, points)
        limit, odds = key[best] + self.rival, (float(prior[best]), float(near[best]))
        key = np.where(usable, d2 - np.maximum(prior, prior[best]) - near, np.inf)
        c = self._touch(wrench, fits, best, *odds)
        depth = gates.get("depth_distance_m", 0.0)
        if depth > 0 and not gates["region_only"]:
            inside = np.where(usable & ~c.elsewhere(points, depth), d2 - self.mesh.prior.max(), np.inf)
            c = self._touch(wrench, fits, wrench.least(inside, points), *odds)
        free, candidates, hidden = usable.copy(), [c], False
        free &= c.elsewhere(points, depth)
        layers = usable & ~free & (key <= limit) & (depth > 0)
        if (free & (key <= limit) & (d2 - prior - near <= c.unhidden + self.rival - self.behind)).any():
            layers[:] = False
        while True:
            left = np.where(free & (key <= limit), key, np.inf)
            best = wrench.least(left, points)
            if len(candidates) == MOST_CANDIDATES or np.isinf(left[best]):
                break
            c = self._touch(wrench, fits, best, float(prior[best]), float(near[best]))
            candidates.append(c)
            if not hidden and self._hides(c, candidates[0], wrench.f):
                hidden, limit = True, limit + self.behind
            free &= c.elsewhere(points, depth)
        candidates[0] = self._first_layer(wrench, fits, candidates[0], layers)
        return self._ranked(wrench, candidates, arm)

    def _first_layer(self, wrench: Wrench, fits: dict[str, Any], c: Touch, layers: Array) -> Touch:
        d2, points = fits["d2"], fits["point"]
        height, along = c.off_plane(points)
        depth = self.gates.get("depth_distance_m", 0.0)
        bent = np.abs(height) > NO_DEEPER * LAYER_SHARE * depth + LAYER_SLOPE * along
        rows = np.flatnonzero(layers & (d2 <= c.d2 + LAYER_COST) & bent)
        seen = height[rows] ** 2 * np.exp(-0.5 * np.maximum(0, d2[rows] - c.d2))
        up = np.where(d2[rows] <= c.d2 + SAME_MISFIT, np.rint(height[rows] / (depth or 1.0) / TIE), -np.inf)
        first = 0.0
        if len(rows) and up.max() >= 0:
            row = rows[up.argmax()]
            first = float(up.max()) * TIE * depth
            c = self._touch(wrench, fits, int(row), c.prior, c.near)
        c.depth = max(float(np.sqrt(seen.max(initial=0.0))), first)
        return c

    def _touch(self, wrench: Wrench, fits: dict[str, Any], face: int, prior: float, near: float) -> Touch:
        m, point = self.mesh, fits["point"][face]
        V = wrench.at_touch(face, point)
        larger = 0.5 * (V["aa"] + V["bb"]) + np.sqrt((0.5 * (V["aa"] - V["bb"])) ** 2 + V["ab"] ** 2)
        n = m.normals[face]
        whole = np.flatnonzero(fits["weights"][face] >= 1 - TIE)
        return Touch(
            face,
            point,
            n,
            float(fits["k"][face]),
            float(fits["d2"][face]),
            prior,
            near,
            int(m.faces[face][whole[-1]]) if len(whole) else -1,
            int(m.region[face]),
            max(self.gates["ambiguity_distance_m"], SAME_TOUCH * m.scale * float(np.sqrt(larger)))
            + NO_FURTHER,
            wrench.f - (n @ wrench.f) * n,
        )

    def _hides(self, x: Touch, y: Touch, f: Array) -> bool:
        return (
            float((y.point - x.point) @ f) > BEHIND_DISTANCE + NO_FURTHER
            and x.unhidden <= y.unhidden + self.behind
        )

    def _ranked(self, wrench: Wrench, candidates: list[Touch], arm: float) -> Found:
        for y in candidates:
            y.hidden = self.behind if any(self._hides(x, y, wrench.f) for x in candidates) else 0.0
        chosen = min(candidates, key=lambda c: np.rint(c.cost / TIE))  # the first of equals
        others = [c for c in candidates if c is not chosen]
        delta = [c.cost - chosen.cost for c in others]
        reason = "ok" if chosen.vertex < 0 else "vertex"
        if any(each <= self.rival for each in delta):
            reason = "ambiguous"
        elif any(c.free - chosen.free <= self.rival for c in others):
            reason = "by_region"
        found = Found(
            reason,
            chosen,
            min(others, key=lambda c: np.rint(c.cost / TIE)) if others else None,
            len(candidates),
            chosen.d2,
        )
        found.arm, found.left_over = arm, self._left_over(wrench, chosen.point, chosen.normal, chosen.k)
        found.confidence = 1 / (1 + sum(float(np.exp(-each / 2)) for each in delta))
        if self.gates["region_only"] and (chosen.region == 0 or chosen.prior < 0):
            found.reason, found.chosen, found.confidence = "outside_region", None, 0.0
        asked = self.gates.get("sigma_max_m", 0.0)
        if asked > 0 and self.accepts(found.reason):
            variance = float(np.linalg.eigvalsh(self._covariance(wrench, chosen))[-1])
            found.reason = found.reason if variance <= asked**2 else "uncertain"
        return found

    def _left_over(self, wrench: Wrench, point: Array, normal: Array, k: float) -> float:
        most = float(np.sqrt(self.gates["implausible_misfit"])) * wrench.l * wrench.size
        rest = wrench.M - np.cross(point, wrench.F) - min(max(k, -most), most) * normal
        return float(np.linalg.norm(rest))

    def _no_touch(self, wrench: Wrench, fits: dict[str, Any], facing: Array, arm: float) -> Found:
        found, d2 = Found("off_surface", arm=arm), fits["d2"]
        if (facing >= self.c_min).any():
            found.reason = "implausible"
            key = np.where(facing >= self.c_min, d2 - self.mesh.prior.max(), np.inf)
            best = wrench.least(key, fits["point"])
            found.misfit = float(d2[best])
            found.left_over = self._left_over(
                wrench, fits["point"][best], self.mesh.normals[best], float(fits["k"][best])
            )
        if self.c_min > GRAZING and ((facing >= GRAZING) & (d2 <= self.gates["implausible_misfit"])).any():
            found.reason = "tangential"
        return found

    # -- following (17) and two touches (18)

    def accepts(self, reason: str) -> bool:
        return reason in ("ok", "vertex") or (reason == "by_region" and self.gates["accept_by_region"])

    def taken(self, reason: str) -> bool:
        return self.accepts(reason) or reason == "uncertain"

    def _miss_or_take(self, found: Found, dt: float) -> None:
        if self.taken(found.reason) and found.chosen is not None:
            self._note_torsion(found.chosen, dt)
            self.previous, self.misses = found.chosen.point, 0
        elif found.reason == "two_touches":
            self.misses = 0
        else:
            self.misses += 1
            if self.misses > self.gates["recent_samples"]:
                self.previous = None

    def _see(self, w: Wrench, dt: float) -> None:
        t = self.torsion
        if not (self.learned and 0 < dt < MEMORY):
            return
        if self._joined(w):
            t.sum = t.weight = t.since = 0.0
            return
        h, scale = self.mesh.scale * w.h, self.mesh.scale
        t.sum = (t.sum + dt * (WIDE * min(h**2, MOST_ARM**2) - scale**2 * w.ff)) / (1 + dt / MEMORY)
        t.weight = (t.weight + dt) / (1 + dt / MEMORY)
        t.since += dt

    def _joined(self, w: Wrench) -> bool:
        if self.torsion.before is None or self.wrench is None:
            return False
        (before, touch), F, M = self.torsion.before, self.wrench[:3], self.wrench[3:]
        least = max(2 * self.gates["min_force_N"], CHANGED * float(np.linalg.norm(before)))
        if float(np.linalg.norm(F - before)) < least:
            return False
        rest = M - np.cross(touch.point, F)
        across = rest - (rest @ touch.normal) * touch.normal
        most = (
            MOVED * touch.radius * abs(float(F @ touch.normal)) + LEANS * abs(self.mesh.scale * w.h) * w.size
        )
        return float(np.linalg.norm(across)) > most

    def _learned_arm(self) -> float:
        t, l0 = self.torsion, self.l0
        mean = (PRIOR * l0**2 + t.sum) / (PRIOR + t.weight)
        return max(l0, float(np.sqrt(min(max(mean, l0**2), MOST_ARM**2))))

    def _note_torsion(self, touch: Touch, dt: float) -> None:
        t = self.torsion
        if not self.learned or self.wrench is None:
            return
        now = (self.wrench[:3].copy(), touch)
        if t.before is None or np.linalg.norm(now[0]) >= 2 * np.linalg.norm(t.before[0]):
            t.before, t.later, t.age = now, now, 0.0
            return
        t.age += dt
        if t.age >= MEMORY:
            t.before, t.later, t.age = t.later, now, 0.0

    def _two_touches(self, w: Array, C: Array, found: Found) -> None:
        pair, following = self.pair, self.previous is not None
        if not (following or pair.told) or found.reason == "low_force":
            if found.reason == "low_force":
                pair = self.pair = TwoTouches()
            if not following:
                self._note(w, found)
            return
        if pair.told and self._has_left(found):
            pair = self.pair = TwoTouches()
        if pair.told or self._suspicious(w, found):
            second = self._second(w, C)
            if second is not None:
                pair.second, pair.told, pair.doubts = second, True, 0
                assert pair.before is not None
                found.reason, found.chosen, found.runner_up = "two_touches", pair.before[1], None
                found.candidates, found.second = 1, second
                return
            if pair.told:
                pair.doubts += 1
                if pair.doubts <= self.gates["recent_samples"] and self._stepped(w):
                    return
                pair.told = False
        self._note(w, found)

    def _has_left(self, found: Found) -> bool:
        c, second = found.chosen, self.pair.second
        if c is None or second is None or not self.taken(found.reason):
            return False
        return float(np.linalg.norm(c.point - second.point)) <= max(c.radius, self.gates["follow_distance_m"])

    def _stepped(self, w: Array) -> bool:
        before = self.pair.before
        return (
            before is not None
            and float(np.linalg.norm(w[:3] - before[0][:3])) >= 2 * self.gates["min_force_N"]
        )

    def _reach(self) -> float:
        assert self.pair.before is not None
        return max(self.gates["follow_distance_m"], self.pair.before[1].radius)

    def _suspicious(self, w: Array, found: Found) -> bool:
        if not self._stepped(w) or self.pair.before is None:
            return False
        if found.chosen is None:
            return True
        w0, touch = self.pair.before
        jumped = float(np.linalg.norm(found.chosen.point - touch.point)) > self._reach()
        return (
            jumped
            and float(np.linalg.norm(w[:3])) >= float(np.linalg.norm(w0[:3])) + self.gates["min_force_N"]
        )

    def _second(self, w: Array, C: Array) -> Touch | None:
        if not self._stepped(w) or self.pair.before is None:
            return None
        w0, touch = self.pair.before
        alone = self.located(w - w0, 2 * C, None, self.l0)
        if alone.reason not in POINTS or alone.chosen is None:
            return None
        far = float(np.linalg.norm(alone.chosen.point - touch.point))
        return alone.chosen if far > 2 * max(alone.chosen.radius, self._reach()) else None

    def _note(self, w: Array, found: Found) -> None:
        if not self.taken(found.reason) or found.chosen is None:
            return
        pair, now = self.pair, (w.copy(), found.chosen)
        if pair.before is not None:
            pair.age += 1
        if pair.before is None or 2 * pair.age >= self.gates["recent_samples"]:
            pair.before, pair.later, pair.age = pair.later or now, now, 0

    # -- no samples (20)

    def silent(self, now: float) -> bool:
        return self.heard is None or abs(now - self.heard) > self.streams["silence_s"]

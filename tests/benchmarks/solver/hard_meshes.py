"""Meshes, wrenches and an independent truth for the hard cases: no hierarchy, no edge moments."""

from __future__ import annotations

import tempfile
import warnings
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from contactbench import assets
from contactbench.pipeline.mesh import MeshWarning, Probe, load_probe
from contactbench.pipeline.study import stability
from contactbench.pipeline.study.stability import Bools, Float, Ints, Long, cross, dot

if TYPE_CHECKING:
    from contactbench.pipeline.contact import Batch


# Shares of an edge or facet: nearer to its border than this, rounding decides who answers.
_BORDER = 1e-9


class SolidBody(stability.SolidBody):
    """A closed triangle mesh in S, m, and what the truth asks of it."""

    @cached_property
    def spokes(self) -> tuple[Ints, Ints, Ints]:
        """(3m,) start and (3m,) end of every half-edge, by start, and the row where each start's begin."""
        start, end = self.faces.ravel(), np.roll(self.faces, -1, axis=1).ravel()
        order = np.argsort(start, kind="stable")
        return start[order], end[order], np.searchsorted(start[order], np.unique(start))

    @cached_property
    def size(self) -> float:
        """Largest extent, m."""
        return float(np.ptp(self.vertices[self.faces].reshape(-1, 3), axis=0).max())

    def moved(self, by: ArrayLike) -> SolidBody:
        """Return the mesh moved by a vector (3,), m."""
        return SolidBody(self.vertices + np.asarray(by, dtype=np.float64), self.faces)

    def holds(self, point: Long) -> bool:
        """Whether a point (3,), m, off the surface, is inside (by its winding number, as a solid angle)."""
        a, b, c = np.moveaxis(self.corners - point, 1, 0)
        x, y, z = (np.sqrt(dot(v, v)) for v in (a, b, c))
        solid = np.arctan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y)
        return bool(np.abs(solid.sum()) > np.pi)


@lru_cache
def bundled(name: str, facets: int) -> SolidBody:
    """Return a bundled probe."""
    vertices, faces = assets.make(name, facets)
    return SolidBody(vertices, faces.astype(np.int64))


@lru_cache
def ellipsoid(subdivisions: int = 3) -> SolidBody:
    """Return a convex body of 20 · 4^n facets, half axes 24, 16 and 40 mm, its middle at z = 120 mm."""
    from trimesh.creation import icosphere

    ball = icosphere(subdivisions=subdivisions)
    return SolidBody(
        np.asarray(ball.vertices) * [0.024, 0.016, 0.040] + [0.0, 0.0, 0.120],
        np.asarray(ball.faces, np.int64),
    )


@lru_cache
def box(cells: int = 8) -> SolidBody:
    """Return a cube of 2^-4 m, a grid on its sides, every coordinate a dyadic fraction, a corner at 0."""
    steps = np.arange(cells + 1)
    i, j = (g.ravel() for g in np.meshgrid(steps[:-1], steps[:-1], indexing="ij"))
    quads = np.array([(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]).transpose(2, 0, 1)
    sides = []
    for axis in range(3):
        for level in (0, cells):
            flat = np.insert(quads, axis, level, axis=2)
            # Cyclic axes: inserting x or z keeps the turn, inserting y turns it over.
            sides.append(flat[:, ::-1] if (level == 0) != (axis == 1) else flat)
    corners = np.concatenate(sides)
    triangles = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
    grid, faces = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    return SolidBody(grid / (16.0 * cells), faces.reshape(-1, 3).astype(np.int64))


def slivered(body: SolidBody, faces: Ints, height: float) -> SolidBody:
    """Split `faces` three ways at a point near the middle of an edge: one part is `height` by 1."""
    a, b, c = (body.vertices[body.faces[faces, i]] for i in range(3))
    added = 0.5 * (a + b) * (1 - height) + height * c
    new = len(body.vertices) + np.arange(len(faces))
    i, j, k = body.faces[faces].T
    parts = [np.stack(t, axis=1) for t in ((i, j, new), (j, k, new), (k, i, new))]
    whole = np.delete(body.faces, faces, axis=0)
    return SolidBody(np.vstack([body.vertices, added]), np.vstack([whole, *parts]))


def soup(body: SolidBody) -> SolidBody:
    """Give every facet vertices of its own."""
    return SolidBody(body.vertices[body.faces].reshape(-1, 3), np.arange(3 * len(body.faces)).reshape(-1, 3))


def through_stl(body: SolidBody) -> Probe:
    """Write a mesh as a binary STL file in millimetres and read it as a probe."""
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
    records = np.zeros(len(body.faces), facet)
    records["corners"] = 1e3 * body.vertices[body.faces]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "body.stl"
        file.write_bytes(bytes(80) + np.uint32(len(records)).tobytes() + records.tobytes())
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", MeshWarning)  # single precision may leave slivers without area
            return load_probe(file, "mm")


Place = Literal["facet", "edge", "vertex", "cone"]


def places(
    body: SolidBody,
    count: int,
    rng: np.random.Generator,
    place: Place = "facet",
    *,
    among: Bools | None = None,
) -> tuple[Float, Float]:
    """Return points (count, 3), m, and normals (count, 3): inside facets, on edges or on vertices.

    Parameters
    ----------
    place : str
        ``facet`` by area; ``edge`` and ``vertex`` with the normal of a facet there; ``cone``: on a vertex,
        with a normal inside the cone of its facets'.
    among : (m,) bool, optional
        Only these facets.
    """
    weight = np.sqrt(dot(body.areas, body.areas)).astype(np.float64)
    weight = weight if among is None else weight * among
    face = rng.choice(len(weight), count, p=weight / weight.sum())
    shares = rng.dirichlet([1.0, 1.0, 1.0], count)
    if place == "edge":
        shares[:, 2] = 0.0
        shares[:, 1] = rng.choice([0.5, *rng.uniform(0.05, 0.95, 7)], count)
        shares[:, 0] = 1.0 - shares[:, 1]
    elif place in ("vertex", "cone"):
        shares = np.tile([1.0, 0.0, 0.0], (count, 1))
    # Turn each facet's corners: any edge, any vertex.
    turned = (rng.integers(3, size=count)[:, None] + np.arange(3)) % 3
    corners = body.vertices[np.take_along_axis(body.faces[face], turned, axis=1)]
    points = np.einsum("nc,ncx->nx", shares, corners)
    normals = body.normals[face].astype(np.float64)
    if place == "cone":
        touched = body.faces[face, turned[:, 0]]
        for i, v in enumerate(touched):
            fan = body.normals[(body.faces == v).any(axis=1)].astype(np.float64)
            mixed = rng.dirichlet(np.ones(len(fan))) @ fan
            normals[i] = mixed / np.linalg.norm(mixed)
    return points, normals


@dataclass(frozen=True, eq=False)
class Solutions:
    """Every contact that answers one wrench."""

    points: Float  # (n, 3) m
    angles: Float  # (n,) friction angles, degrees
    # False where a solution lies on a border within rounding: how many there are is then a convention
    sure: bool


def solve(body: SolidBody, wrench: Float) -> Solutions:
    """Find every facet and vertex with ``p x F + k n = M``, p on it, F . n < 0; long double, one by one.

    A facet's p is solved for and then located by its areal coordinates. A vertex answers when M - v x F is
    along a normal from which all its edges fall away, and the body is on that normal's inner side.
    """
    F, M = wrench[:3].astype(np.longdouble), wrench[3:].astype(np.longdouble)
    f = F / np.sqrt(F @ F)
    facing = -(body.normals @ f)
    hit, sure = _facet_points(body, F, M)
    shares = areal(body, np.arange(len(body.faces)), hit)
    least = shares.min(axis=1)
    seen = facing > 0
    inside = seen & (least > 0)
    points, cosines = [*hit[inside].astype(np.float64)], [*facing[inside].astype(np.float64)]
    sure = sure and not bool(np.any(seen & (np.abs(least) < _BORDER)))
    for v, n, margin in _pressed_vertices(body, F, M):
        sure = sure and margin > _BORDER
        points.append(body.vertices[v])
        cosines.append(float(-(n @ f)))
    angles = np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0)))
    return Solutions(np.array(points).reshape(-1, 3), angles, sure)


def certify(body: SolidBody, wrenches: Float, batch: Batch) -> tuple[Float, Bools]:
    """Check answers against the equations alone, on a convex body.

    Returns
    -------
    off : (n,) m
        How far the answer is from the exact solution on the facet or vertex it names; NaN without one.
    false : (n,) bool
        There is a point, but its facet or vertex does not answer the wrench.
    """
    off, false = np.full(len(wrenches), np.nan), np.zeros(len(wrenches), dtype=bool)
    start, end, _ = body.spokes
    for i in np.flatnonzero(np.isfinite(batch.points[:, 0])):
        F, M = wrenches[i, :3].astype(np.longdouble), wrenches[i, 3:].astype(np.longdouble)
        face, v = int(batch.faces[i]), int(batch.vertices[i])
        if v < 0:
            one = SolidBody(body.vertices, body.faces[[face]])
            exact, _ = _facet_points(one, F, M)
            off[i] = float(np.sqrt(np.sum((exact[0] - batch.points[i]) ** 2)))
            false[i] = areal(one, np.zeros(1, np.int64), exact).min() < -_BORDER or one.normals[0] @ F >= 0
            continue
        off[i] = float(np.linalg.norm(batch.points[i] - body.vertices[v]))
        moment = M - cross(body.vertices[v].astype(np.longdouble), F)
        size = np.sqrt(moment @ moment)
        if size < 1e-12 * body.size * np.sqrt(F @ F):
            continue  # the axis runs through the vertex: any normal of its cone will do
        n = moment / size * (-1.0 if moment @ F > 0 else 1.0)
        spokes = body.vertices[end[start == v]] - body.vertices[v]
        false[i] = bool(np.any(spokes @ n > _BORDER * np.linalg.norm(spokes, axis=1)))
    return off, false


def areal(body: SolidBody, faces: Ints, points: Long) -> Long:
    """Return the areal coordinates (n, 3) of points (n, 3) on the planes of `faces` (n,)."""
    a, b, c = np.moveaxis(body.corners[faces], 1, 0)
    n = body.areas[faces]
    parts = [dot(cross(q - points, r - points), n) for q, r in ((b, c), (c, a), (a, b))]
    return np.asarray(np.stack(parts, axis=1) / dot(n, n)[:, None])


def entry(body: SolidBody, wrench: Float) -> Float:
    """Return where the wrench axis first meets the body (3,), m, or NaN: a ray against every facet."""
    F, M = wrench[:3].astype(np.longdouble), wrench[3:].astype(np.longdouble)
    f, foot = F / np.sqrt(F @ F), cross(F, M) / (F @ F)
    a, b, c = np.moveaxis(body.corners, 1, 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        p = cross(np.broadcast_to(f, c.shape), c - a)
        scale = dot(b - a, p)
        u = dot(foot - a, p) / scale
        q = cross(foot - a, b - a)
        v = (q @ f) / scale
        t = dot(c - a, q) / scale
        t = np.where((u >= 0) & (v >= 0) & (u + v <= 1), t, np.inf)
    return np.asarray(foot + t.min() * f, dtype=np.float64) if np.isfinite(t.min()) else np.full(3, np.nan)


def _facet_points(body: SolidBody, F: Long, M: Long) -> tuple[Long, bool]:
    """Solve Eq. 6 on each facet's plane (m, 3), and tell whether no facet is edge-on within rounding."""
    n, a = body.normals, body.corners[:, 0]
    along = n @ F
    with np.errstate(divide="ignore", invalid="ignore"):
        # p x F + k n = M with n . p = n . a: cross with n, and p (n . F) - F (n . a) = n x M.
        p = (cross(n, np.broadcast_to(M, n.shape)) + dot(n, a)[:, None] * F) / along[:, None]
    p[~np.isfinite(p).all(axis=1)] = np.nan  # edge-on: nowhere, which is inside nothing
    return np.asarray(p), bool(np.all(np.abs(along) > _BORDER * np.sqrt(F @ F)))


def _pressed_vertices(body: SolidBody, F: Long, M: Long) -> list[tuple[int, Long, float]]:
    """Vertices that answer, with their normals and how far their edges are from level (a sine)."""
    start, end, first = body.spokes
    at = body.vertices.astype(np.longdouble)
    moment = np.subtract(M, cross(at, np.broadcast_to(F, at.shape)), dtype=np.longdouble)
    with np.errstate(divide="ignore", invalid="ignore"):
        n = np.asarray(moment / np.sqrt(dot(moment, moment))[:, None], np.longdouble)
    n = np.negative(n) if M @ F > 0 else n
    spoke = np.subtract(at[end], at[start], dtype=np.longdouble)
    length = np.sqrt(dot(spoke, spoke))
    rise = dot(n[start], spoke) / length
    low, high = np.minimum.reduceat(rise, first), np.maximum.reduceat(rise, first)
    found = []
    for row in np.flatnonzero((low > 0) | (high < 0)):
        v = int(start[first[row]])
        up = n[v] if high[row] < 0 else -n[v]
        step = 1e-6 * length[start == v].min()
        # Just above a peak, as `up` sees it, there is air; just above the bottom of a pit there is body.
        if body.holds(at[v] + step * up) == bool(high[row] < 0):
            continue
        found.append((v, n[v], float(min(abs(low[row]), abs(high[row])))))
    return found

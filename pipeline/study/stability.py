"""
How steady answers are on a probe's mesh: what an error of the wrench does, rounding, edges, thin facets.

By how much answers are off, against a truth in long double that shares no code with the solver. What only the solver
itself is judged by - hard cases, other compilers, single precision, exact arithmetic - is beside its tests.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike, NDArray

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver, Gates, TouchModel, WrenchNoise, methods
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.study.harness import CaseRow, CasesReport, verdict_on
from contactbench.pipeline.study.pages import COLOURS, STYLE, Results, chapter, number, png, table
from contactbench.pipeline.study.report import FigureVerdict, verdict_of
from contactbench.pipeline.study.sweep.plan import file_facets, mesh_of

Float = NDArray[np.float64]
Long = NDArray[np.longdouble]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class SolidBody:
    """A closed triangle mesh in S, m."""

    vertices: Float  # (n, 3) m
    faces: Ints  # (m, 3) counter-clockwise seen from outside

    @cached_property
    def corners(self) -> Long:
        """(m, 3, 3) the corners of each facet, m."""
        return np.asarray(self.vertices.astype(np.longdouble)[self.faces])

    @cached_property
    def areas(self) -> Long:
        """(m, 3) normals, each as long as twice its facet's area, m²."""
        return cross(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])

    @cached_property
    def normals(self) -> Long:
        """(m, 3) outward unit normals."""
        return np.asarray(self.areas / np.sqrt(dot(self.areas, self.areas))[:, None])

    def probe(self, faces: ArrayLike | None = None) -> Probe:
        """Return the mesh as a probe of any size, or these `faces` over the same vertices."""
        return Probe.from_arrays(self.vertices, self.faces if faces is None else faces, check_size=False)


@dataclass(frozen=True, eq=False)
class Drawn:
    """Wrenches and where they were made to touch."""

    wrenches: Float  # (n, 6) N and N·m, S
    points: Float  # (n, 3) m, S

    def __len__(self) -> int:
        return len(self.points)

    def take(self, rows: Bools | Ints | slice) -> Drawn:
        """Return some of the rows."""
        return Drawn(self.wrenches[rows], self.points[rows])


def press(
    points: ArrayLike,
    normals: ArrayLike,
    rng: np.random.Generator,
    *,
    angle: tuple[float, float] | Float = (0.0, 60.0),
    arm: ArrayLike = 0.0003,
    pitch: ArrayLike | None = None,
) -> Drawn:
    """Press on points (n, 3), m, with outward normals (n, 3), by 8 to 10 N.

    Parameters
    ----------
    angle : (low, high) or (n,)
        Friction angle, degrees, in a random direction.
    arm : float or (n,)
        Standard deviation of the local torque over the force, m.
    pitch : float or (n,), optional
        Torque about the axis over the force, M·F / |F|², m; its sign is random. Takes the place of `arm`.
    """
    p, n = np.asarray(points, np.longdouble), np.asarray(normals, np.longdouble)
    count = len(p)
    side = cross(n, rng.standard_normal((count, 3)).astype(np.longdouble))
    side /= np.sqrt(dot(side, side))[:, None]
    degrees = rng.uniform(angle[0], angle[1], count) if isinstance(angle, tuple) else np.resize(angle, count)
    theta = np.radians(degrees.astype(np.longdouble))[:, None]
    size = rng.uniform(8.0, 10.0, count)[:, None]
    force = (size * (np.sin(theta) * side - np.cos(theta) * n)).astype(np.float64).astype(np.longdouble)
    if pitch is None:
        k = np.asarray(arm) * rng.standard_normal(count) * size[:, 0]
    else:
        k = np.asarray(pitch) * rng.choice([-1.0, 1.0], count) * dot(force, force) / dot(n, force)
    moment = cross(p, force) + np.asarray(k, np.longdouble)[:, None] * n
    return Drawn(np.hstack([force, moment]).astype(np.float64), p.astype(np.float64))


def cross(a: Long, b: Long) -> Long:
    """Return cross products of rows."""
    return np.asarray(np.cross(a, b))


def dot(a: Long, b: Long) -> Long:
    """Return inner products of rows."""
    return np.asarray(np.einsum("...i,...i->...", a, b))


KIND = "stability"
FEWEST = 50
# No preference for the surface that is met first: it is no part of the closed form.
OPEN = Gates(friction_angle=89.9999999, min_force=0.0, first_odds=1.0)
QUIET = WrenchNoise(0.0, 0.0)
# Any torsion, as far as a model allows, and a mesh that is the very body: where the likelihood is the closed form.
EXACT = TouchModel(torsion_arm=1000.0, model_error=QUIET, mesh_curved=False)
ROUNDOFF = 2.0**-53  # half a unit in the last place of 1
# Stated, up to 100,000 facets: an answer is the exact one of a wrench and a mesh this many roundoffs away.
MOST_ROUNDOFFS = 16.0
# In double precision a facet keeps what lies further inside than this share of its edge.
SURE_SHARE = 1e-12
# Down to nearly the least at which a facet answers, 0.001: what is steeper is edge-on.
COSINES = (1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 0.0015)
_FACETS, _MANY = 1_000, 20_000  # of a bundled probe; a file has its own

PARTS = {
    "amplification": "What an error of the wrench does to the point",
    "rounding": "Rounding",
    "edges": "Edges and vertices",
    "thin facets": "Thin facets",
}
CONDITION = "condition: most that the point moves, of each unit of relative error"
ERROR, RATIO = "error against long double", "error over unit roundoff times condition"
REFUSED = "refused by the friction cone, though no steeper than 45 degrees on the facet that is pressed"
SLENDER = "longest edge of a facet over its height"
COSINE, ANGLE = "cosine of the friction angle", "friction angle, degrees"
NEAR = "distance from the edge or vertex, of the edge's length"
PREDICTED, DOUBLE, ALGORITHM1 = "first order", "double", "algorithm1"


@dataclass(frozen=True)
class StabilityRow(CaseRow):
    """One figure: what `by` computed for a case, its median and its worst, and what the worst may be."""

    part: str
    case: str
    by: str
    figure: str
    unit: str  # "" for counts and ratios
    tries: int
    median: float
    worst: float  # NaN where nothing was measured
    x: float | None = None  # place on the axis, which has a unit in its name
    axis: str = ""
    most: float | None = None  # None where the figure is only shown

    @property
    def verdict(self) -> FigureVerdict:
        """Whether the bound is kept; what is no number keeps none."""
        return verdict_of(self.worst, most=self.most)

    @property
    def met(self) -> bool:
        """The same."""
        return self.verdict is FigureVerdict.MET

    @property
    def cells(self) -> tuple[str, ...]:
        """See `CaseRow`."""
        place = "" if self.x is None else f" at {number(self.x)} ({self.axis})"
        bound = "" if self.most is None else f"at most {number(self.most)}"
        return self.case, self.by, self.figure, f"{number(self.worst)} {self.unit}{place}", bound

    def to_json(self) -> dict[str, Any]:
        """Return plain values; None for what is no number."""
        plain = {
            name: None if isinstance(value, float) and not np.isfinite(value) else value
            for name, value in asdict(self).items()
        }
        return plain | {"met": self.met}

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> StabilityRow:
        """Read back what :meth:`to_json` gave."""
        known: dict[str, Any] = {f.name: data.get(f.name) for f in fields(cls)}
        return cls(**known | {n: np.nan if known[n] is None else known[n] for n in ("median", "worst")})

    @classmethod
    def of(
        cls, part: str, case: str, by: str, figure: str, unit: str, values: npt.ArrayLike, **more: Any
    ) -> StabilityRow:
        """Sum up several values, (n,); those that are no numbers are left out."""
        numbers = np.asarray(values, dtype=np.float64).ravel()
        numbers = numbers[~np.isnan(numbers)]
        middle, worst = (
            (float(np.median(numbers)), float(numbers.max())) if len(numbers) else (np.nan, np.nan)
        )
        return cls(part, case, by, figure, unit, len(numbers), middle, worst, **more)


def run(
    names: Sequence[str] = assets.PROBE_NAMES,
    *,
    samples: int = 1000,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> CasesReport[StabilityRow]:
    """
    Measure every figure on every probe.

    Parameters
    ----------
    names : sequence of str
        Bundled probes, or prepared files in S.
    samples : int
        Touches of each figure, at least 50.
    progress : callable
        Told in words what is being measured.

    Raises
    ------
    InputError
        Too few samples, or a probe that cannot be read.
    """
    if samples < FEWEST:
        raise InputError(f"samples: {samples} are too few to meet the worst: give at least {FEWEST}.")
    check(names)
    rows: list[StabilityRow] = []
    for i, name in enumerate(names):
        progress(title_of(name))
        body, title = body_of(name), title_of(name)
        for j, measure in enumerate((_condition, _rounding, _edges)):
            rows += measure(title, body, samples, np.random.default_rng((seed, 100 * (1 + j) + i)))
        slender = slenderness(body_of(name, _MANY))
        rows.append(StabilityRow.of("thin facets", title, DOUBLE, SLENDER, "", slender))
    rows.sort(key=lambda row: list(PARTS).index(row.part))
    about = {"probes": list(names), "samples": samples, "seed": seed}
    title = f"Numerical stability, {samples} touches a figure, seed {seed}"
    return CasesReport(title, about, tuple(rows), ("case", "by", "figure", "worst", "bound"))


# ---- the parts -----------------------------------------------------------------------------------------


def _condition(title: str, body: SolidBody, samples: int, rng: np.random.Generator) -> Iterator[StabilityRow]:
    for angle in (0.0, 30.0, 60.0, 75.0):
        touches = touch(body, samples, rng, angle=np.full(samples, angle))
        normals = body.normals[touches.faces].astype(np.float64)
        values = condition(normals, touches.points, touches.wrenches)
        yield StabilityRow.of("amplification", title, PREDICTED, CONDITION, "m", values, x=angle, axis=ANGLE)


def _rounding(title: str, body: SolidBody, samples: int, rng: np.random.Generator) -> Iterator[StabilityRow]:
    """Turn the force towards the facet; the literal Algorithm 1 answers beside the solver, and is not judged."""
    solver = ContactSolver(body.probe(), QUIET, OPEN, EXACT)
    literal = methods.algorithm1(body.probe(), QUIET, OPEN)
    for cosine in COSINES:
        touches = touch(body, samples, rng, angle=np.full(samples, np.degrees(np.arccos(cosine))))
        for by, method in ((DOUBLE, solver), (ALGORITHM1, literal)):
            found = method.locate_batch(touches.wrenches)
            # On another facet the wrench has another condition.
            pressed = (found.faces == touches.faces) & (found.vertices < 0)
            points = np.where(pressed[:, None], found.points, np.nan)
            answers = points, found.faces.astype(np.int64), found.vertices.astype(np.int64)
            most = MOST_ROUNDOFFS if by == DOUBLE else None
            # A plane that is off by a roundoff of the mesh moves the point along the force by that over the cosine.
            mesh = reach(body) / cosine
            yield from roundoffs(
                "rounding", title, by, body, touches, answers, most=most, mesh=mesh, x=cosine, axis=COSINE
            )


def roundoffs(
    part: str,
    case: str,
    by: str,
    body: SolidBody,
    touches: FacetTouches,
    answers: tuple[Float, Ints, Ints],
    *,
    most: float | None,
    mesh: float | None = None,
    **more: Any,
) -> list[StabilityRow]:
    """
    Give the errors of answers (points, faces, vertices) against the exact solution of the facet or vertex they name.

    A row of the errors, mm, and one of them over unit roundoff and condition, which is judged by `most`. To the
    condition comes what the mesh's own rounding is worth, m; left out, its reach.
    """
    points, faces, vertices = answers
    normals = body.normals[touches.faces].astype(np.float64)
    scale = condition(normals, touches.points, touches.wrenches) + (reach(body) if mesh is None else mesh)
    off = errors(body, points, faces, vertices, touches.wrenches)
    return [
        StabilityRow.of(part, case, by, ERROR, "mm", 1e3 * off, **more),
        StabilityRow.of(part, case, by, RATIO, "", off / (ROUNDOFF * scale), most=most, **more),
    ]


def _edges(title: str, body: SolidBody, samples: int, rng: np.random.Generator) -> Iterator[StabilityRow]:
    """Count what is refused at a sharp rim because rounding names the facet on its other side."""
    solver = ContactSolver(body.probe(), QUIET, Gates(), EXACT)
    for power in range(3, 16, 3):
        for place in ("edge", "vertex"):
            touches = next_to(body, place, 10.0**-power, samples, rng)
            none = ~np.isfinite(solver.locate_batch(touches.wrenches).points[:, 0])
            refused = 100.0 * float(none.mean())
            most = 0.0 if 10.0**-power >= SURE_SHARE else None
            case = f"{title}, next to {place} points"
            yield StabilityRow(
                "edges", case, DOUBLE, REFUSED, "%", samples, refused, refused, 10.0**-power, NEAR, most
            )


# ---- touches of one mesh, and their truth ----------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class FacetTouches:
    """Wrenches (n, 6), N and N·m in S, made to touch facets `faces` (n,) of one body at points (n, 3), m."""

    wrenches: Float
    points: Float
    faces: Ints

    def __len__(self) -> int:
        return len(self.faces)

    def take(self, rows: Bools | Ints) -> FacetTouches:
        """Return some of the rows."""
        return FacetTouches(self.wrenches[rows], self.points[rows], self.faces[rows])


def touch(
    body: SolidBody,
    count: int,
    rng: np.random.Generator,
    *,
    angle: tuple[float, float] | Float = (0.0, 60.0),
    shares: Float | None = None,
) -> FacetTouches:
    """
    Press on facets, 8 to 10 N.

    Parameters
    ----------
    angle
        As for :func:`contactbench.pipeline.study.stability.press`.
    shares : (count, 3), optional
        Areal coordinates of the points; by default random ones of at least 0.1.
    """
    area = np.sqrt(np.einsum("fi,fi->f", body.areas, body.areas)).astype(np.float64)
    chosen = rng.choice(len(area), count, p=area / area.sum())
    if shares is None:
        shares = 0.1 + 0.7 * rng.dirichlet([1.0, 1.0, 1.0], count)
    points = np.einsum("nc,ncx->nx", shares.astype(np.longdouble), body.corners[chosen])
    drawn = press(points, body.normals[chosen], rng, angle=angle)
    return FacetTouches(drawn.wrenches, drawn.points, chosen)


def next_to(body: SolidBody, place: str, near: float, samples: int, rng: np.random.Generator) -> FacetTouches:
    """Press at this share of the edge's length from an edge or a vertex, up to 45 degrees from the normal."""
    along = rng.uniform(0.2, 0.8, samples)
    if place == "edge":
        shares = np.stack([(1 - near) * along, (1 - near) * (1 - along), np.full(samples, near)], axis=1)
    else:
        shares = np.stack([np.full(samples, 1 - near), near * along, near * (1 - along)], axis=1)
    turned = (rng.integers(3, size=samples)[:, None] + np.arange(3)) % 3
    shares = np.take_along_axis(shares, turned, axis=1)
    return touch(body, samples, rng, shares=shares, angle=(0.0, 45.0))


def answers_on(body: SolidBody, faces: Ints, wrenches: Float) -> Long:
    """Return where wrenches (n, 6) put the contact on the planes of `faces` (n,), long double, m."""
    F, M = np.split(wrenches.astype(np.longdouble), 2, axis=1)
    n, a = body.areas[faces], body.corners[faces, 0]
    along = np.einsum("ni,ni->n", n, F)[:, None]
    return np.asarray((np.cross(n, M) + np.einsum("ni,ni->n", n, a)[:, None] * F) / along)


def errors(body: SolidBody, points: Float, faces: Ints, vertices: Ints, wrenches: Float) -> Float:
    """
    Return how far answers (n, 3), m, are from the exact solution on the facet or vertex that they name, m.

    NaN without an answer.
    """
    truth = answers_on(body, np.maximum(faces, 0), wrenches)
    at_vertex = vertices >= 0
    truth[at_vertex] = body.vertices[vertices[at_vertex]]
    off = np.linalg.norm((points - truth).astype(np.float64), axis=1)
    return np.where(np.isfinite(points[:, 0]), off, np.nan)


def condition(normals: Float, points: Float, wrenches: Float) -> Float:
    """
    Return how far the contact moves for each unit of relative error of force and torque, at worst (n,), m.

    ``|J_F| |F| + |J_M| |M|`` with spectral norms, J_M = [n]x / (n . F), J_F = -J_M [p]x.
    """
    n, p = _skew(normals), _skew(points)
    along = np.abs(np.einsum("ni,ni->n", normals, wrenches[:, :3]))
    force, torque = (np.linalg.norm(part, axis=1) for part in np.split(wrenches, 2, axis=1))
    by_force = np.linalg.norm(n @ p, ord=2, axis=(1, 2))
    return np.asarray((by_force * force + torque) / along)  # |[n]x| = 1


def reach(body: SolidBody) -> float:
    """Return the largest distance of a vertex from the sensor origin, m: what the mesh's own rounding is worth."""
    used: Float = body.vertices[np.unique(body.faces)]
    return float(np.linalg.norm(used, axis=1).max())


def slenderness(body: SolidBody) -> Float:
    """Return the longest edge over the height of each facet (m,)."""
    edges = body.corners - np.roll(body.corners, -1, axis=1)
    longest = np.einsum("fei,fei->fe", edges, edges).max(axis=1)
    areas = np.sqrt(np.einsum("fi,fi->f", body.areas, body.areas))
    return np.asarray(longest / areas, np.float64)


def _skew(v: Float) -> Float:
    x, y, z = v.T
    zero = np.zeros_like(x)
    return np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)


# ---- probes ------------------------------------------------------------------------------------------------


@lru_cache
def body_of(name: str, facets: int = _FACETS) -> SolidBody:
    """Return a bundled probe of about so many facets, or a file's own mesh; InputError."""
    probe = mesh_of(name, file_facets(name) or facets)
    return SolidBody(np.asarray(probe.vertices), probe.faces.astype(np.int64))


def title_of(name: str) -> str:
    """Return a probe's name without a comma, folder or ending."""
    return name if name in assets.PROBE_NAMES else Path(name).stem.replace(",", " ")


def check(names: Sequence[str]) -> None:
    """Refuse probes that cannot be told apart or read: InputError."""
    titles = [title_of(name) for name in names]
    for name, title in zip(names, titles, strict=True):
        if titles.count(title) > 1:
            raise InputError(f"--probe {name}: another one is named {title}, too: rename the file.")
        body_of(name)


# ---- the page ----------------------------------------------------------------------------------------------

_COLUMNS = ("case", "figure", "by", "over", "tries", "worst", "at", "bound", "")
_PICTURE = "rounding.png"
_SAID = {_PICTURE: "Worst error against long double, and the condition, over the angle of the force"}
_ABOUT = """The solver against a truth in long double that shares no code with it. The *condition* is how far the
contact moves for each unit of relative error of force and torque, from the derivative of the closed form; a *roundoff*
is half a unit in the last place of 1. Every line is the worst of its tries."""


def make(results: Results, folder: Path) -> str:
    """Write the picture into the folder and return the chapter, Markdown."""
    rows = [StabilityRow.from_json(row) for row in results.rows]
    about = f"{_ABOUT}\n\n{verdict_on(rows)}"
    return chapter("Numerical stability", about, tables(rows), {_PICTURE: _picture(rows)}, _SAID, folder)


def tables(rows: Sequence[StabilityRow]) -> list[tuple[str, str]]:
    """Return a title and a table, Markdown, for each part: rows that differ only in their place are one line."""
    return [
        (
            PARTS.get(part, part.capitalize()),
            table(_COLUMNS, [_line(group) for group in _groups(r for r in rows if r.part == part)]),
        )
        for part in dict.fromkeys(row.part for row in rows)
    ]


def _groups(rows: Iterable[StabilityRow]) -> list[list[StabilityRow]]:
    found: dict[tuple[object, ...], list[StabilityRow]] = {}
    for row in rows:
        found.setdefault((row.case, row.figure, row.by, row.axis, row.most), []).append(row)
    return list(found.values())


def _line(group: list[StabilityRow]) -> list[str]:
    known = [row for row in group if row.worst == row.worst] or group
    worst = max(known, key=lambda row: row.worst)
    places = [row.x for row in group if row.x is not None]
    over = "" if not places else f"{worst.axis}: {number(min(places))} to {number(max(places))}"
    unit = f" {worst.unit}" if worst.unit else ""
    bound = "" if worst.most is None else f"{number(worst.most)}{unit}"
    kept = "" if worst.most is None else "kept" if all(row.met for row in group) else "**broken**"
    place = "" if worst.x is None else number(worst.x)
    cells = (worst.case, worst.figure, worst.by, over, f"{sum(row.tries for row in group):,}")
    return [c.replace("|", "\\|") for c in (*cells, f"{number(worst.worst)}{unit}", place, bound, kept)]


def _picture(rows: Sequence[StabilityRow]) -> bytes:
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context(STYLE):
        figure = Figure(figsize=(8.0, 3.1), dpi=100, layout="constrained")
        for axes, (name, axis, what) in zip(
            figure.subplots(1, 2),
            ((ERROR, COSINE, "worst error, mm"), (CONDITION, ANGLE, "condition, m, worst")),
            strict=True,
        ):
            lines: dict[str, list[StabilityRow]] = {}
            for row in rows:
                if (row.figure, row.axis) == (name, axis) and np.isfinite(row.worst):
                    lines.setdefault(f"{row.case}, {row.by}", []).append(row)
            for i, (label, own) in enumerate(lines.items()):
                x, y = zip(*sorted((float(r.x or 0.0), r.worst) for r in own), strict=True)
                axes.plot(x, y, "o-", color=COLOURS[i % len(COLOURS)], label=label)
            axes.set(xlabel=axis, ylabel=what, yscale="log", xscale="log" if axis == COSINE else "linear")
            if lines:
                axes.legend(fontsize=6.5)
        return png(figure)

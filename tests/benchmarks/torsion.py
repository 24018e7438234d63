"""Touches that spin, areas that slide, and second touches that come slowly: what an arm that a run learns is worth."""

from __future__ import annotations

from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.signal import lfilter

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver, Reason, TouchModel, WrenchNoise
from contactbench.pipeline.contact.methods import make
from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation import add_noise, draw_touches
from contactbench.pipeline.study.report import Figure, StudyReport
from contactbench.pipeline.study.sweep.plan import MeshSurface, body_of, mesh_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.kernel import Batch
    from contactbench.pipeline.simulation.touches import Sampled

    Array = NDArray[np.float64]

FIXED, LEARNED = TouchModel(torsion_learned=False), TouchModel()
SPINS_NM = (0.0, 0.015, 0.021, 0.032)  # rms
REAL = Path(__file__).parents[3] / "shared" / "data" / "probes"
FILES = ("convex-c5-2", "linear-l14-5", "telemed-l12")
_WHOLE = ("telemed-l12",)  # whose own facets are the shell
RATE, FACETS = 200.0, 2_000
_RAW, _FILTERED = WrenchNoise(), WrenchNoise(0.18 * 0.05, 0.18 * 0.002)
_FACE_M, _FACING, _CENTRAL = 0.015, 0.7, 0.9  # the lens, and that of it which is touched
_LEAN, _FORCE_N = np.radians(15.0), (7.0, 10.0)
_BEGIN = 60  # samples of a stream that are not judged: it is pressed, and the filter settles
_FRICTION, _RADII_M = 0.6, (0.015, 0.025)
_APART_M, _OFF_M, _FEW = 0.020, 0.005, 0.003
_ELLIPSE = -2 * np.log(0.05)
_RAMPS_S = (0.05, 1.0)  # in which a second touch grows


class Body(NamedTuple):
    """A probe with its lens as the region, and its true surface."""

    probe: Probe
    surface: Sampled


@cache
def body(name: str) -> Body:
    """Return a bundled probe, or one of the real files: closed, and its own truth."""
    if name in assets.PROBE_NAMES:
        return Body(_declared(mesh_of(name, FACETS)), body_of(name).surface)
    from contactbench.pipeline.mesh.load import load_probe
    from contactbench.pipeline.mesh.shell import make_shell
    from contactbench.pipeline.mesh.simplify import Count, simplify

    raw = load_probe(REAL / f"{name}.stl", "mm")
    upright = raw.vertices[:, [0, 2, 1]] * [1, -1, 1]
    upright[:, 2] += 0.03 - upright[:, 2].min()
    probe = Probe.from_arrays(upright, raw.faces)
    if name not in _WHOLE:
        probe = simplify(make_shell(probe).probe, Count(FACETS)).probe
    probe = _declared(probe)
    return Body(probe, MeshSurface(probe))


def _declared(probe: Probe) -> Probe:
    heights = probe.vertices[probe.faces].mean(axis=1)[:, 2]
    lens = (heights > probe.bounds[1, 2] - _FACE_M) & (probe.normals[:, 2] > _FACING)
    return probe.with_region(lens.astype(np.int32))


def track(solver: ContactSolver, wrenches: Array) -> Batch:
    """Return what a solver says of a stream (n, 6)."""
    solver.reset()
    return solver.track_batch(wrenches, np.zeros(len(wrenches)), np.full(len(wrenches), 1 / RATE))


def wander(count: int, rng: np.random.Generator, time: float) -> Array:
    """Return (count,) values that wander smoothly within about so many seconds, of mean square 1."""
    left = np.exp(-1 / (RATE * time))
    noise = rng.standard_normal(count + 2_000)
    for _ in range(2):
        noise = lfilter([1 - left], [1, -left], noise)
    kept = np.asarray(noise[2_000:], dtype=np.float64)
    return np.asarray(kept / np.sqrt(np.mean(kept**2)))


def _sizes(count: int, rng: np.random.Generator) -> Array:
    sizes = np.clip(8.5 + 0.7 * wander(count, rng, 0.7), *_FORCE_N)
    return np.minimum((np.arange(count) + 1) / 40, 1) * sizes


def _measured(wrenches: Array, rng: np.random.Generator) -> Array:
    return KalmanFilter(RATE).filter(add_noise(wrenches, _RAW, rng))


def _tangents(normal: Array) -> tuple[Array, Array]:
    first = np.cross(normal, [1.0, 0, 0] if abs(normal[0]) < 0.8 else [0, 1.0, 0])
    first /= np.linalg.norm(first)
    return first, np.cross(normal, first)


# ---- one touch that spins ----------------------------------------------------------------------------


def spinning(name: str, torque: float, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
    """Return a point of the lens (3,), m, and what the sensor reads (count, 6) while `torque`, N·m rms, spins there."""
    of = body(name)
    touch = draw_touches(of.surface, 1, rng, above=float(of.probe.bounds[1, 2]) - _FACE_M, facing=_CENTRAL)
    point, normal = touch.points[0], touch.normals[0]
    first, other = _tangents(normal)
    way = rng.uniform(0, 2 * np.pi) + 0.5 * wander(count, rng, 1.0)[:, None]
    along = np.sin(_LEAN) * (np.cos(way) * first + np.sin(way) * other) - np.cos(_LEAN) * normal
    sizes = _sizes(count, rng)
    forces = sizes[:, None] * along
    twist = torque * wander(count, rng, 0.3) * sizes / sizes.max()
    return point, _measured(np.hstack([forces, np.cross(point, forces) + twist[:, None] * normal]), rng)


def spin(name: str, torque: float, streams: int, count: int, rng: np.random.Generator) -> dict[str, float]:
    """Return refused (%) and mean error (mm) by method."""
    probe = body(name).probe
    solvers = {
        "fixed": ContactSolver(probe, _FILTERED, model=FIXED),
        "learned": ContactSolver(probe, _FILTERED),
    }
    rivals = {each: make(each, probe, _FILTERED) for each in ("wrench_axis", "iterative")}
    found: dict[str, list[Array]] = {each: [] for each in (*solvers, *rivals)}
    for _ in range(streams):
        point, wrenches = spinning(name, torque, count, rng)
        batches = {each: track(solver, wrenches) for each, solver in solvers.items()}
        batches |= {each: rival.locate_batch(wrenches) for each, rival in rivals.items()}
        for each, batch in batches.items():
            errors = np.linalg.norm(batch.points - point, axis=1)
            found[each].append(np.where(batch.accepted, errors, np.nan)[_BEGIN:])
    figures = {}
    for each, errors in found.items():
        whole = np.concatenate(errors)
        figures[f"{each}, refused"] = 100 * float(np.isnan(whole).mean())
        figures[f"{each}, mean error"] = 1e3 * float(np.nanmean(whole))
    return figures


# ---- an area that slides -----------------------------------------------------------------------------


def sliding(
    name: str, radius: float, friction: float, spin: float, count: int, rng: np.random.Generator
) -> tuple[Array, Array]:
    """
    Return the centre of pressure (3,), m, of an area on the lens, and what the sensor reads (count, 6).

    Pressure falls towards the area's edge and leans to one side; friction pulls each place along the way that the
    tissue takes there, which slides in a direction that wanders and turns with up to `spin` rad per m of way.
    """
    mesh = mesh_of(name, 20_000) if name in assets.PROBE_NAMES else body(name).probe
    corners, normals = mesh.vertices[mesh.faces], mesh.normals
    places = corners.mean(axis=1)
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    lens = (places[:, 2] > mesh.bounds[1, 2] - _FACE_M) & (normals[:, 2] > _CENTRAL)
    middle = rng.choice(np.flatnonzero(lens))
    first, other = _tangents(normals[middle])
    off = places - places[middle]
    flat = np.column_stack([off @ first, off @ other])
    share = 1 - (flat**2).sum(axis=1) / radius**2
    towards, lean = rng.uniform(0, 2 * np.pi), rng.uniform(0, 1)
    pressure = areas * share * (1 + lean * flat @ [np.cos(towards), np.sin(towards)] / radius)
    touched = (share > 0) & (normals @ normals[middle] > 0.4) & (off @ normals[middle] > -0.012)
    pressure, places, normals, flat = (each[touched] for each in (pressure, places, normals, flat))
    centre = pressure @ places / pressure.sum()

    def summed(forces: Array) -> Array:
        return np.concatenate([forces.sum(axis=0), np.cross(places, forces).sum(axis=0)])

    def pulled(way: float, turn: float) -> Array:
        x, y = np.cos(way) - turn * flat[:, 1], np.sin(way) + turn * flat[:, 0]
        slip = x[:, None] * first + y[:, None] * other
        slip -= np.sum(slip * normals, axis=1)[:, None] * normals
        size = np.maximum(np.linalg.norm(slip, axis=1), 1e-9)
        return summed((friction * pressure / size)[:, None] * slip)

    knots = np.arange(0, count + 10, 10)
    ways = rng.uniform(0, 2 * np.pi) + 0.8 * wander(count + 20, rng, 1.0)[knots]
    turns = spin * wander(count + 20, rng, 0.3)[knots]
    pulls = np.array([pulled(way, turn) for way, turn in zip(ways, turns, strict=True)])
    wrenches = np.column_stack([np.interp(np.arange(count), knots, pull) for pull in pulls.T])
    wrenches += summed(-pressure[:, None] * normals)
    wrenches *= (_sizes(count, rng) / np.linalg.norm(wrenches[:, :3], axis=1))[:, None]
    return centre, _measured(wrenches, rng) + add_noise(np.zeros((1, 6)), LEARNED.model_error, rng)


def patches(
    name: str, radius: float, friction: float, spin: float, streams: int, count: int, rng: np.random.Generator
) -> dict[str, float]:
    """Return the share (%) of the centres of pressure in the 95 % ellipse, with a fixed and a learned arm."""
    probe = body(name).probe
    held: dict[str, list[Array]] = {}
    solvers = {
        "fixed": ContactSolver(probe, _FILTERED, model=FIXED),
        "learned": ContactSolver(probe, _FILTERED),
    }
    for _ in range(streams):
        centre, wrenches = sliding(name, radius, friction, spin, count, rng)
        for each, solver in solvers.items():
            batch = track(solver, wrenches)
            kept = batch.accepted & (np.arange(count) >= _BEGIN)
            variances, axes = np.linalg.eigh(batch.covariances[kept])
            off = np.einsum("nij,ni->nj", axes, batch.points[kept] - centre)
            inside = np.sum(off[:, 1:] ** 2 / variances[:, 1:], axis=1) <= _ELLIPSE
            held.setdefault(each, []).append(inside)
    return {f"{each}, inside": 100 * float(np.concatenate(all_).mean()) for each, all_ in held.items()}


# ---- a second touch ----------------------------------------------------------------------------------


def second(name: str, ramp: float, pairs: int, rng: np.random.Generator) -> dict[str, float]:
    """
    Let a second touch, more than 20 mm away, grow over `ramp` seconds beside one that is followed.

    Returns
    -------
    dict
        % of the pairs that were told, and of the second after the ramp that is accepted more than 5 mm from both.
    """
    probe = body(name).probe.with_region(np.zeros(len(body(name).probe.faces), np.int32))
    surface = body(name).surface
    above = float(probe.bounds[0, 2] + 0.15 * np.ptp(probe.bounds[:, 2]))
    solvers = {"fixed": ContactSolver(probe, _RAW, model=FIXED), "learned": ContactSolver(probe, _RAW)}
    one, other = (draw_touches(surface, pairs, rng, above=above) for _ in range(2))
    weaker = other.wrenches / rng.uniform(1.0, 3.0, (pairs, 1))
    alone = solvers["fixed"].locate_batch(one.wrenches)
    used = np.linalg.norm(one.points - other.points, axis=1) > _APART_M
    used &= alone.accepted & (np.linalg.norm(alone.points - one.points, axis=1) < _FEW)
    before, growing, after = int(1.5 * RATE), max(1, int(ramp * RATE)), int(RATE)
    share = np.concatenate([np.zeros(before), np.linspace(0, 1, growing + 1)[1:], np.ones(after)])[:, None]
    told: dict[str, list[float]] = {each: [] for each in solvers}
    wrong: dict[str, list[float]] = {each: [] for each in solvers}
    for i in np.flatnonzero(used):
        wrenches = add_noise(one.wrenches[i] + share * weaker[i], _RAW, rng)
        for each, solver in solvers.items():
            batch = track(solver, wrenches)
            ends = [np.linalg.norm(batch.points - touch.points[i], axis=1) > _OFF_M for touch in (one, other)]
            wrong[each].append(float(np.mean((batch.accepted & ends[0] & ends[1])[-after:])))
            steady = batch.reasons[before + growing : before + growing + 20]
            told[each].append(float(np.count_nonzero(steady == Reason.TWO_TOUCHES) >= 18))
    found = {f"{each}, told": 100 * float(np.mean(values)) for each, values in told.items()}
    return found | {f"{each}, from both": 100 * float(np.mean(values)) for each, values in wrong.items()}


# ---- the report --------------------------------------------------------------------------------------


def run(
    *,
    probes: Sequence[str] = (*assets.PROBE_NAMES, *FILES),
    streams: int = 16,
    seeds: int = 3,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Measure every figure."""
    figures: list[Figure] = []
    for name in probes:
        progress(name)
        figures += _figures(name, streams, seeds, seed)
    return StudyReport("Torsion", {"streams": streams, "seeds": seeds, "seed": seed}, tuple(figures))


def _figures(name: str, streams: int, seeds: int, seed: int) -> Iterator[Figure]:
    def of(measure: Callable[[np.random.Generator], dict[str, float]], *place: int) -> dict[str, list[float]]:
        found = [measure(np.random.default_rng((seed, *place, i))) for i in range(seeds)]
        return {figure: [each[figure] for each in found] for figure in found[0]}

    for i, torque in enumerate(SPINS_NM):
        cell = of(partial(spin, name, torque, streams, 800), 1, i)
        title = f"{name}, spin {1e3 * torque:g} N·mm"
        for figure, values in cell.items():
            most = {"learned, refused": 1.0, "learned, mean error": 0.36}.get(figure)
            yield Figure.of(title, figure, values, "mm" if "error" in figure else "%", most=most)
        best = np.minimum(cell["wrench_axis, mean error"], cell["iterative, mean error"])
        excess = np.array(cell["learned, mean error"]) - best
        yield Figure.of(title, "learned, error over the better rival's", excess, "mm", most=0.02)
    for i, radius in enumerate(_RADII_M):
        for j, (friction, turn) in enumerate(((0.0, 0.0), (_FRICTION, 0.0), (_FRICTION, 60.0))):
            cell = of(partial(patches, name, radius, friction, turn, 4 * streams, 160), 2, i, j)
            title = f"{name}, area of {1e3 * radius:g} mm, friction {friction:g}, spin {turn:g} rad/m"
            for figure, values in cell.items():
                yield Figure.of(title, figure, values, "%", least=92.0 if "learned" in figure else None)
    for i, ramp in enumerate(_RAMPS_S):
        cell = of(partial(second, name, ramp, 10 * streams), 3, i)
        title = f"{name}, a second touch within {ramp:g} s"
        for figure, values in cell.items():
            yield Figure.of(title, figure, values, "%")
        more = np.subtract(cell["learned, from both"], cell["fixed, from both"])
        yield Figure.of(title, "learned, more from both than fixed", more, "points", most=5.0)

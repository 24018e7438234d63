"""One cell of a sweep: a method on touches, its errors, its reasons, and how long it took."""

from __future__ import annotations

from dataclasses import asdict
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.contact import Gates
from contactbench.pipeline.contact.methods import make
from contactbench.pipeline.contact.wrench_axis import EmbreeAxis
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation import draw_touches
from contactbench.pipeline.study.sweep.bodies import body_of, file_facets, mesh_of
from contactbench.pipeline.study.sweep.noise import believed, deviations
from contactbench.pipeline.study.sweep.plan import identity, label
from contactbench.pipeline.study.sweep.scores import bound_of, judged
from contactbench.pipeline.timing import Timing, time_calls

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.contact.methods import ContactMethod
    from contactbench.pipeline.simulation import Touches
    from contactbench.pipeline.study.sweep.plan import Cell

# What does not depend on who computes it, nor when; the rest are times.
TIMES = ("compiled_median_ns", "compiled_p99_ns", "python_median_ns", "python_p99_ns")
_TIMED = 2_000  # solves
_SLOW_NS, _FEW = 50_000, 100  # of methods that take so long only a few are timed
_PYTHON_ROUNDS, _PYTHON_BLOCK = 8, 50
_FITTED = ("iterative",)  # needs the region to know which face to fit
_METHODS = 5  # kept of a process: those of one noise on one mesh, which at a million facets take long to make


def run_cell(cell: Cell) -> dict[str, Any]:
    """
    Compute a cell.

    Returns
    -------
    dict
        Plain values: those of the cell, its key, the facets there were, whether they are the very mesh that is touched
        (exact), what `judged` gives, times in ns. A method that cannot do it has ``failed`` with the reason, and no
        figures.
    """
    row: dict[str, Any] = {"key": cell.key, **asdict(cell), "probe": label(cell.probe), "failed": ""}
    try:
        who = cell.method, identity(cell.probe), cell.probe, cell.facets, cell.noise, cell.filter
        method, facets = _method(*who, gates_for(cell.angle))
        touches, wrenches = touches_of(cell)
    except InputError as error:
        return row | {"failed": str(error)}
    row["facets_found"] = facets
    row["exact"] = facets == file_facets(cell.probe)
    row |= judged(
        method.locate_batch(wrenches), touches, bound_of(touches, deviations(cell.noise, cell.filter))
    )
    return row | (_timed(method, wrenches) if cell.times else {})


@lru_cache(maxsize=_METHODS)
def _method(
    name: str, identity: str, probe: str, facets: int, noise: str, way: str, gates: Gates
) -> tuple[ContactMethod, int]:
    """Make a method, and say how many facets it has; `identity` tells files apart that were changed meanwhile."""
    del identity
    mesh = mesh_of(probe, facets)
    if name not in _FITTED:
        # Touches are spread over the whole probe: nobody expects them in a region of priority more than elsewhere.
        mesh = mesh.with_region(np.zeros(len(mesh.faces), dtype=np.int32))
    return make(name, mesh, believed(noise, way), gates), len(mesh.faces)


def forget() -> None:
    """Let go of methods and touches that are kept for the next cell: a million facets are hundreds of megabytes."""
    _method.cache_clear()
    _touches.cache_clear()


def gates_for(angle: float) -> Gates:
    """
    Return the gates of somebody who knows that touches may be this steep, degrees.

    Nothing is gated away that is asked for.
    """
    return Gates(friction_angle=max(Gates().friction_angle, min(angle + 15.0, 89.0)))


def touches_of(cell: Cell) -> tuple[Touches, NDArray[np.float64]]:
    """Return the true touches of a cell, and the wrenches (n, 6) that are read: N and N·m in S."""
    touches = _touches(cell.probe, cell.force, cell.angle, cell.torsion, cell.touches, cell.touch_seed)
    # The same draws for every noise: what differs is its size.
    drawn = np.random.default_rng((cell.touch_seed, 1)).standard_normal(touches.wrenches.shape)
    return touches, touches.wrenches + drawn * deviations(cell.noise, cell.filter)


@lru_cache(maxsize=1)  # the methods of one condition follow each other
def _touches(probe: str, force: float, angle: float, torsion: float, count: int, seed: int) -> Touches:
    body = body_of(probe)
    return draw_touches(
        body.surface,
        count,
        np.random.default_rng(seed),
        force=(force, force),
        angle=(angle, angle),
        torsion_arm=torsion,
        above=body.above,
    )


def _timed(method: ContactMethod, wrenches: NDArray[np.float64]) -> dict[str, float]:
    times = dict.fromkeys(TIMES, float("nan"))
    engine = getattr(method.engine, "time_each", None)
    slow = False
    if engine is not None:
        first = np.asarray(engine(np.ascontiguousarray(wrenches[:_FEW])), dtype=np.float64)
        slow = bool(np.median(first) > _SLOW_NS)
        if not slow:
            many = np.ascontiguousarray(np.resize(wrenches, (_TIMED, 6)))
            first = np.asarray(engine(many), dtype=np.float64)
        times["compiled_median_ns"], times["compiled_p99_ns"] = _both(Timing.of(first))
    # No wrench twice, as far as they go: a processor soon knows the way of one that comes again.
    calls = {"it": _calls(method, wrenches[: (_PYTHON_ROUNDS + 1) * _PYTHON_BLOCK])}
    python = time_calls(calls, rounds=1 if slow else _PYTHON_ROUNDS, block=_PYTHON_BLOCK)["it"]
    times["python_median_ns"], times["python_p99_ns"] = _both(python)
    return times


def _calls(method: ContactMethod, wrenches: NDArray[np.float64]) -> tuple[Callable[[Any], object], list[Any]]:
    """Return what is timed from Python; of the wrench axis only the ray, the least that any program must do for it."""
    axis = method.engine
    if not isinstance(axis, EmbreeAxis):
        return method.locate, list(wrenches)
    origins, directions = axis.rays(wrenches)
    rays = [(origins[i : i + 1], directions[i : i + 1]) for i in range(len(wrenches))]
    return lambda ray: axis.scene.run(ray[0], ray[1], query="INTERSECT"), rays


def _both(timing: Timing) -> tuple[float, float]:
    return timing.median, timing.p99

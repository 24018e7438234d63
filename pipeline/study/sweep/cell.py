"""One cell of a sweep: a method on touches, its errors, its reasons, and how long it took."""

from __future__ import annotations

from dataclasses import asdict
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from pipeline.contact import ContactSolver, Gates
from pipeline.contact.methods import make
from pipeline.errors import InputError
from pipeline.simulation import draw_touches
from pipeline.study.sweep.bodies import body_of, mesh_of
from pipeline.study.sweep.judging import bound_of, judged
from pipeline.study.sweep.noise import believed, deviations
from pipeline.study.sweep.plan import identity, label
from pipeline.timing import Timing, time_calls

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pipeline.contact.methods import Method
    from pipeline.simulation import Touches
    from pipeline.study.sweep.plan import Cell

# What does not depend on who computes it, nor when; the rest are times.
TIMES = ("compiled_median_ns", "compiled_p99_ns", "python_median_ns", "python_p99_ns")
_TIMED = 2_000  # solves
_SLOW_NS, _FEW = 50_000, 100  # of methods that take so long only a few are timed
_PYTHON_ROUNDS, _PYTHON_BLOCK = 8, 50
_WIDE = Gates(friction_angle=89.0)  # steep touches are asked for: they must not be gated away
_METHODS = 5  # kept of a process: those of one noise on one mesh, which at a million facets take long to make


def run_cell(cell: Cell, *, timed: bool = True) -> dict[str, Any]:
    """
    Compute a cell.

    Parameters
    ----------
    cell : Cell
    timed : bool
        Whether to measure times, too.

    Returns
    -------
    dict
        Plain values: those of the cell, its key, the facets there were, what `judged` gives, times in ns. A method that
        cannot do it has ``failed`` with the reason, and no figures.
    """
    row: dict[str, Any] = {"key": cell.key, **asdict(cell), "probe": label(cell.probe), "failed": ""}
    try:
        method, facets = _method(
            cell.method, identity(cell.probe), cell.probe, cell.facets, cell.noise, cell.filter
        )
        touches, wrenches = touches_of(cell)
    except InputError as error:
        return row | {"failed": str(error)}
    row["facets_found"] = facets
    row |= judged(
        method.locate_batch(wrenches), touches, bound_of(touches, deviations(cell.noise, cell.filter))
    )
    return row | (_timed(method, wrenches) if timed else {})


@lru_cache(maxsize=_METHODS)
def _method(name: str, identity: str, probe: str, facets: int, noise: str, way: str) -> tuple[Method, int]:
    """Make a method, and say how many facets it has; `identity` tells files apart that were changed meanwhile."""
    del identity
    mesh = mesh_of(probe, facets)
    return make(name, mesh, believed(noise, way), _WIDE), len(mesh.faces)


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


def _timed(method: Method, wrenches: NDArray[np.float64]) -> dict[str, float]:
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
    calls = {"it": (method.locate, list(wrenches[: 2 * _PYTHON_BLOCK]))}
    python = time_calls(calls, rounds=1 if slow else _PYTHON_ROUNDS, block=_PYTHON_BLOCK)["it"]
    times["python_median_ns"], times["python_p99_ns"] = _both(python)
    return times


def _both(timing: Timing) -> tuple[float, float]:
    return timing.median, timing.p99


def bound_by_solver(cell: Cell) -> float:
    """Return the noise bound, rms in mm, as the solver states it on a fine mesh: for comparison."""
    touches, _ = touches_of(cell)
    solver = ContactSolver(mesh_of(cell.probe, 50_000), believed(cell.noise, cell.filter), _WIDE)
    covariances = solver.locate_batch(touches.wrenches).covariances
    return float(1e3 * np.sqrt(np.nanmean(np.trace(covariances, axis1=1, axis2=2))))

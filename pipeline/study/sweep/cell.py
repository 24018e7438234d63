"""One cell of a sweep: a method on touches, its errors, its reasons, and how long it took."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from pipeline.contact import ContactSolver, Gates, Reason
from pipeline.contact.methods import make
from pipeline.errors import InputError
from pipeline.simulation import draw_touches
from pipeline.study.sweep.bodies import body_of, mesh_of
from pipeline.study.sweep.noise import believed, deviations
from pipeline.timing import Timing, time_calls

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pipeline.contact.methods import Method
    from pipeline.kernel import Batch
    from pipeline.simulation import Touches
    from pipeline.study.sweep.plan import Cell

# What does not depend on who computes it, nor when; the rest are times.
TIMES = ("compiled_median_ns", "compiled_p99_ns", "python_median_ns", "python_p99_ns")
_TIMED = 2_000  # solves
_SLOW_NS, _FEW = 100_000, 200  # of methods that take so long only a few are timed
_PYTHON_ROUNDS, _PYTHON_BLOCK = 8, 50
_WIDE = Gates(friction_angle=89.0)  # steep touches are asked for: they must not be gated away
_ACCEPTED = (Reason.OK, Reason.VERTEX)


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
        Plain values: those of the cell, its key, the facets there were, errors in mm, shares of each reason, times in
        ns. A method that cannot do it has ``failed`` with the reason, and no figures.
    """
    row: dict[str, Any] = {"key": cell.key, **asdict(cell), "failed": ""}
    try:
        mesh = mesh_of(cell.probe, cell.facets)
        method = make(cell.method, mesh, believed(cell.noise, cell.filter), _WIDE)
    except InputError as error:
        return row | {"failed": str(error)}
    touches, wrenches = touches_of(cell)
    row["facets_found"] = len(mesh.faces)
    batch = method.locate_batch(wrenches)
    row |= _judged(batch, touches, _bound(cell, touches))
    return row | (_timed(method, wrenches) if timed else {})


def touches_of(cell: Cell) -> tuple[Touches, NDArray[np.float64]]:
    """Return the true touches of a cell, and the wrenches (n, 6) that are read: N and N·m in S."""
    body = body_of(cell.probe)
    rng = np.random.default_rng(cell.touch_seed)
    touches = draw_touches(
        body.surface,
        cell.touches,
        rng,
        force=(cell.force, cell.force),
        angle=(cell.angle, cell.angle),
        torsion_arm=cell.torsion,
        above=body.above,
    )
    # The same draws for every noise: what differs is its size.
    drawn = np.random.default_rng((cell.touch_seed, 1)).standard_normal(touches.wrenches.shape)
    return touches, touches.wrenches + drawn * deviations(cell.noise, cell.filter)


def _bound(cell: Cell, touches: Touches) -> NDArray[np.float64]:
    """Return the variance (n,), m², of the best unbiased point on the tangent plane at the truth (Cramér-Rao)."""
    sigmas = deviations(cell.noise, cell.filter)
    F, n = touches.wrenches[:, :3], touches.normals
    # On the plane through p: n x (M - p x F) = 0 in the two tangent directions, so dp = (dM_t - p x dF ...) / (n . F).
    along = np.einsum("nd,nd->n", n, F)
    J = np.empty((len(F), 3, 6))
    for axis in range(3):
        e = np.zeros(3)
        e[axis] = 1.0
        # A wrong force by e shows as a torque p x e less than there is; a wrong torque by e as itself.
        J[:, :, axis] = _moved(-np.cross(touches.points, e), F, n, along)
        J[:, :, 3 + axis] = _moved(np.broadcast_to(e, F.shape), F, n, along)
    return np.asarray(np.einsum("nij,j,nij->n", J, sigmas**2, J))


def _moved(
    torque: NDArray[np.float64], F: NDArray[np.float64], n: NDArray[np.float64], along: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return how far (n, 3) the point moves on its plane to explain a torque (n, 3): dp x F + dk n = dT, dp . n = 0."""
    # Crossed with n: n x dT = n x (dp x F) = dp (n . F) - F (n . dp) = dp (n . F).
    del F
    return np.asarray(np.cross(n, torque) / along[:, None])


def _judged(batch: Batch, touches: Touches, bound: NDArray[np.float64]) -> dict[str, Any]:
    error = np.linalg.norm(batch.points - touches.points, axis=1)
    answered = np.isfinite(error)
    sure = np.isin(batch.reasons, _ACCEPTED) & answered
    rates = {
        f"reason_{reason.name.lower()}": float(np.mean(batch.reasons == reason.value)) for reason in Reason
    }
    figures = {"answered": float(answered.mean()), "sure": float(sure.mean()), **rates}
    rms_bound = float(np.sqrt(bound[sure].mean())) if sure.any() else float("nan")
    mm = 1e3 * error[answered]
    of_sure = 1e3 * error[sure]
    return figures | {
        "mean_mm": _or_nan(mm, np.mean),
        "sd_mm": _or_nan(mm, np.std),
        "p95_mm": _or_nan(mm, lambda x: np.percentile(x, 95)),
        "max_mm": _or_nan(mm, np.max),
        "rms_sure_mm": _or_nan(of_sure, lambda x: np.sqrt(np.mean(x * x))),
        "max_sure_mm": _or_nan(of_sure, np.max),
        "bound_mm": 1e3 * rms_bound,
        "over_bound": _or_nan(of_sure, lambda x: np.sqrt(np.mean(x * x))) / (1e3 * rms_bound)
        if rms_bound > 0
        else float("nan"),
    }


def _or_nan(values: NDArray[np.float64], what: Any) -> float:
    return float(what(values)) if len(values) else float("nan")


def _timed(method: Method, wrenches: NDArray[np.float64]) -> dict[str, float]:
    times = dict.fromkeys(TIMES, float("nan"))
    engine = getattr(method.engine, "time_each", None)
    if engine is not None:
        some = np.ascontiguousarray(wrenches[:_FEW])
        first = np.asarray(engine(some), dtype=np.float64)
        if np.median(first) < _SLOW_NS:
            first = np.asarray(
                engine(np.ascontiguousarray(np.resize(wrenches, (_TIMED, 6)))), dtype=np.float64
            )
        times["compiled_median_ns"], times["compiled_p99_ns"] = _both(Timing.of(first))
    calls = {"it": (method.locate, list(wrenches[: 2 * _PYTHON_BLOCK]))}
    python = time_calls(calls, rounds=_PYTHON_ROUNDS, block=_PYTHON_BLOCK)["it"]
    times["python_median_ns"], times["python_p99_ns"] = _both(python)
    return times


def _both(timing: Timing) -> tuple[float, float]:
    return timing.median, timing.p99


def bound_by_solver(cell: Cell) -> float:
    """Return the same bound, rms in mm, as the solver states it on a fine mesh: for comparison."""
    touches, _ = touches_of(cell)
    solver = ContactSolver(mesh_of(cell.probe, 50_000), believed(cell.noise, cell.filter), _WIDE)
    covariances = solver.locate_batch(touches.wrenches).covariances
    return float(1e3 * np.sqrt(np.nanmean(np.trace(covariances, axis1=1, axis2=2))))

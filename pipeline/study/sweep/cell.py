"""One cell of a sweep: a method on touches, its errors, its reasons, and how long it took."""

from collections.abc import Callable
from dataclasses import asdict
from functools import lru_cache
from typing import Any

import numpy as np

from contactbench.pipeline.contact import Gates, Reason
from contactbench.pipeline.contact.methods import ContactMethod, EmbreeAxis, make
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.kernel import Batch
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.simulation import Touches, draw_touches
from contactbench.pipeline.study.sweep.plan import (
    Cell,
    believed,
    body_of,
    deviations,
    file_facets,
    identity,
    label,
    mesh_of,
)
from contactbench.pipeline.timing import Timing, time_calls

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


def touches_of(cell: Cell) -> tuple[Touches, Floats]:
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


def _timed(method: ContactMethod, wrenches: Floats) -> dict[str, float]:
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


def _calls(method: ContactMethod, wrenches: Floats) -> tuple[Callable[[Any], object], list[Any]]:
    """Return what is timed from Python; of the wrench axis only the ray, the least that any program must do for it."""
    axis = method.engine
    if not isinstance(axis, EmbreeAxis):
        return method.locate, list(wrenches)
    origins, directions = axis.rays(wrenches)
    rays = [(origins[i : i + 1], directions[i : i + 1]) for i in range(len(wrenches))]
    return lambda ray: axis.scene.run(ray[0], ray[1], query="INTERSECT"), rays


def _both(timing: Timing) -> tuple[float, float]:
    return timing.median, timing.p99


# ---- what answers are worth ----------------------------------------------------------------------


_ACCEPTED = (Reason.OK, Reason.VERTEX)
# An answer on another part of the probe: further off than noise and a coarse mesh explain.
_ASTRAY_M, _ASTRAY_SIGMAS = 0.005, 5.0


def bound_of(touches: Touches, sigmas: Floats) -> Floats:
    """
    Return the variance (n,), m², of the best unbiased point on the tangent plane at the truth (Cramér-Rao).

    Parameters
    ----------
    sigmas : (6,)
        Standard deviations of Fx Fy Fz Mx My Mz, N and N·m.
    """
    F, n, p = touches.wrenches[:, :3], touches.normals, touches.points
    # On the plane, dp . n = 0, the point moves by dp to explain a torque: dp x F + dk n = dT. Crossed with n that is
    # n x dT = n x (dp x F) = dp (n . F). A torque that is wrong by e is dT = e; a force, dT = -p x e.
    along = np.einsum("nd,nd->n", n, F)[:, None]
    variance = np.zeros(len(F))
    for axis, e in enumerate(np.eye(3)):
        by_force = np.cross(n, -np.cross(p, e)) / along
        by_torque = np.cross(n, e) / along
        variance += sigmas[axis] ** 2 * np.einsum("nd,nd->n", by_force, by_force)
        variance += sigmas[3 + axis] ** 2 * np.einsum("nd,nd->n", by_torque, by_torque)
    return variance


def judged(batch: Batch, touches: Touches, bound: Floats) -> dict[str, Any]:
    """
    Return what a batch of answers is worth.

    Parameters
    ----------
    touches : Touches
        The truth, row by row.
    bound : (n,)
        Of `bound_of`.

    Returns
    -------
    dict
        Plain values: shares that are answered, sure (accepted without doubt), of each reason, and astray (on another
        part of the probe), errors in mm, and root mean squares of the sure ones, of those not astray (near), and of
        the bound.
    """
    error = np.linalg.norm(batch.points - touches.points, axis=1)
    answered = np.isfinite(error)
    sure = np.isin(batch.reasons, _ACCEPTED) & answered
    astray = answered & (np.nan_to_num(error) > np.maximum(_ASTRAY_M, _ASTRAY_SIGMAS * np.sqrt(bound)))
    shares = {"answered": answered, "sure": sure, "astray": astray, "astray_sure": astray & sure}
    reasons = {f"reason_{each.name.lower()}": batch.reasons == each.value for each in Reason}
    return {
        **{name: float(np.mean(chosen)) for name, chosen in (shares | reasons).items()},
        **_errors(error[answered], error[sure], error[sure & ~astray], bound[sure]),
    }


def _errors(all_m: Floats, sure_m: Floats, near_m: Floats, bound: Floats) -> dict[str, float]:
    mm, sure = 1e3 * all_m, 1e3 * sure_m
    rms_sure, rms_bound = _of(sure, _rms), 1e3 * _of(np.sqrt(bound), _rms)
    return {
        "mean_mm": _of(mm, np.mean),
        "sd_mm": _of(mm, np.std),
        "p95_mm": _of(mm, lambda x: np.percentile(x, 95)),
        "max_mm": _of(mm, np.max),
        "mean_sure_mm": _of(sure, np.mean),
        "rms_sure_mm": rms_sure,
        "rms_near_mm": _of(1e3 * near_m, _rms),
        "max_sure_mm": _of(sure, np.max),
        "bound_mm": rms_bound,
        "over_bound": rms_sure / rms_bound if rms_bound > 0 else float("nan"),
    }


def _rms(x: Floats) -> float:
    return float(np.sqrt(np.mean(x * x)))


def _of(values: Floats, what: Callable[[Floats], Any]) -> float:
    return float(what(values)) if len(values) else float("nan")

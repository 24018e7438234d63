"""What answers are worth: errors against the truth, as multiples of the noise bound, and reasons."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.contact import Reason

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.kernel import Batch
    from contactbench.pipeline.simulation import Touches

    Float = NDArray[np.float64]

_ACCEPTED = (Reason.OK, Reason.VERTEX)
# An answer on another part of the probe: further off than noise and a coarse mesh explain.
_ASTRAY_M, _ASTRAY_SIGMAS = 0.005, 5.0


def bound_of(touches: Touches, sigmas: Float) -> Float:
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


def judged(batch: Batch, touches: Touches, bound: Float) -> dict[str, Any]:
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


def _errors(all_m: Float, sure_m: Float, near_m: Float, bound: Float) -> dict[str, float]:
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


def _rms(x: Float) -> float:
    return float(np.sqrt(np.mean(x * x)))


def _of(values: Float, what: Callable[[Float], Any]) -> float:
    return float(what(values)) if len(values) else float("nan")

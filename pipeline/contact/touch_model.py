"""The model of a touch beside the sensor's noise, and that noise: torsion, mesh deviation and model error."""

from dataclasses import dataclass, field
from functools import cached_property
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.touch_settings import DEFAULT_FORCE_N, DEFAULT_TORQUE_NM, TORSION_ARM_M, Scene

_CHANNELS = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")


@dataclass(frozen=True, eq=False)
class WrenchNoise:
    """Standard deviation of a compensated, filtered wrench, in the sensor frame S.

    Parameters
    ----------
    force : float or array_like (3,)
        Standard deviation of each force component, N.
    torque : float or array_like (3,)
        Standard deviation of each torque component, N·m, about the sensor origin.
    extra : array_like (6, 6), optional
        Covariance to add, force before torque, N², N²·m, N²·m²: the uncertainty of the calibration.

    Raises
    ------
    InputError
        A value is negative or not finite, a shape is wrong, or `extra` is not a covariance.
    """

    force: float | ArrayLike = 0.05
    torque: float | ArrayLike = 0.002
    extra: ArrayLike | None = None

    def __post_init__(self) -> None:
        self.covariance  # noqa: B018  (validates now, not at first use)

    @cached_property
    def covariance(self) -> NDArray[np.float64]:
        """(6, 6) covariance of Fx Fy Fz Mx My Mz; N², N²·m, N²·m²."""
        sigmas = np.concatenate([_three("force", self.force, "N"), _three("torque", self.torque, "N·m")])
        covariance = np.diag(sigmas**2)
        if self.extra is not None:
            covariance = covariance + _checked_covariance(self.extra)
        covariance.flags.writeable = False
        return covariance


def _three(name: str, value: float | ArrayLike, unit: str) -> NDArray[np.float64]:
    array = np.asarray(value, dtype=np.float64)
    if array.shape not in {(), (3,)}:
        raise InputError(
            f"WrenchNoise.{arg(name)}: give one number or three ({arg(unit)}), not shape {arg(array.shape)}"
        )
    if not np.all(np.isfinite(array)) or np.any(array < 0):
        raise InputError(
            f"WrenchNoise.{arg(name)}: standard deviations ({arg(unit)}) must be finite and at least 0, not"
            f" {arg(value)!r}"
        )
    return np.broadcast_to(array, (3,))


def _checked_covariance(extra: ArrayLike) -> NDArray[np.float64]:
    array = np.asarray(extra, dtype=np.float64)
    if array.shape != (6, 6) or not np.all(np.isfinite(array)):
        raise InputError(f"WrenchNoise.extra: give a finite (6, 6) covariance of {arg(' '.join(_CHANNELS))}")
    size = float(np.abs(array).max())
    if not np.allclose(array, array.T, rtol=0, atol=1e-12 * size):
        raise InputError("WrenchNoise.extra: the covariance is not symmetric")
    if np.linalg.eigvalsh(array)[0] < -1e-9 * size:
        raise InputError("WrenchNoise.extra: the covariance has a negative eigenvalue")
    return 0.5 * (array + array.T)


@dataclass(frozen=True, eq=False)
class TouchModel:
    """The model of one touch: ``M - p x F = k n`` with a small k, on a surface that is nearly the mesh.

    Parameters
    ----------
    torsion_arm : float
        One sigma of the local torque k over the force, m. Default 1 mm: a hard tip has 0.3, soft tissue 1 to 5.
        Infinity gives the closed form for any k, 0 the wrench axis.
    model_error : WrenchNoise
        Error that drift, cable, hysteresis and mount leave in the wrench. Default 0.05 N and 1 mN·m: with an
        unmodelled pull of 0.2 N on a 7 N press, fewer than one in a thousand answers is then confident and wrong.
        Verification measures it.
    mesh_deviation : float
        Root mean square between mesh and surface, beyond the effect of its curvature, m.
    mesh_curved : bool
        Facets that turn by less than 40 degrees to their neighbours represent a curved surface, so their normals and
        positions have the corresponding error. Off for a body that truly has flat facets.
    torsion_learned : bool
        While a touch is followed, the arm grows to what the wrenches show of it; `torsion_arm` is then where it begins
        and the least it becomes. It needs the time of each wrench; one that is located alone has `torsion_arm`.
    scene : str, optional
        What is touched: ``dry`` skin, ``gel`` or ``bone``; told in a bundle, and without effect.

    Raises
    ------
    InputError
        A length is negative, not finite, or longer than a kilometre.
    """

    torsion_arm: float = TORSION_ARM_M
    model_error: WrenchNoise = field(default_factory=lambda: WrenchNoise(DEFAULT_FORCE_N, DEFAULT_TORQUE_NM))
    mesh_deviation: float = 0.0
    mesh_curved: bool = True
    torsion_learned: bool = True
    scene: Scene | None = None

    def __post_init__(self) -> None:
        for name in ("torsion_arm", "mesh_deviation"):
            value = getattr(self, name)
            if not (isfinite(value) and 0 <= value <= 1000):
                raise InputError(f"TouchModel.{arg(name)} must be between 0 and 1000 m, not {arg(value)}")

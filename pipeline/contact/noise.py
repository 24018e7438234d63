"""How uncertain a wrench is."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.errors import InputError, arg

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

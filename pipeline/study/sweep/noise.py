"""Sensors and filters of a sweep, as what they leave of the noise in a held touch."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact.noise import WrenchNoise
from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.simulation.sensor_model import PRESETS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

# Standard deviation of one reading: Fx, Fy, Fz in N, Mx, My, Mz in N·m.
NOISES: Mapping[str, tuple[float, ...]] = {
    "none": (0.0,) * 6,
    **{name: tuple(float(x) for x in np.asarray(settings.noise)) for name, settings in PRESETS.items()},
}
# Share of the standard deviation of white noise that is left in a touch that is held long enough. Filters are linear:
# of Gaussian noise they make Gaussian noise of that share, so that it can be drawn as it is.
FILTERS: Mapping[str, float] = {
    "none": 1.0,
    "mean-10": float(1 / np.sqrt(10)),
    "mean-50": float(1 / np.sqrt(50)),
    "kalman": float(KalmanFilter().figures(200.0).noise_left),
}
_QUIETEST = np.repeat([1e-6, 1e-8], 3)  # a solver needs some noise to weigh candidates by


def deviations(noise: str, way: str) -> NDArray[np.float64]:
    """Return the standard deviations (6,) of a filtered reading, N and N·m."""
    return FILTERS[way] * np.array(NOISES[noise])


def believed(noise: str, way: str) -> WrenchNoise:
    """Return the noise that a method is told: that of the filtered reading, a millionth of a newton at least."""
    sigmas = np.maximum(deviations(noise, way), _QUIETEST)
    return WrenchNoise(force=sigmas[:3], torque=sigmas[3:])

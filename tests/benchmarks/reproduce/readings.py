"""Held touches as one virtual sensor reads them: compensated and filtered as in the paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.simulation.sensor_model import SensorModel
from contactbench.pipeline.study.gain_trials import RATE_HZ, WARM_S

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.contact import WrenchNoise
    from contactbench.pipeline.study.gain_trials import CalibratedSensor

COLD_S = 60.0  # since the sensor was switched on
_BEFORE_S, _HOLD_S = 0.1, 0.5  # seven time constants of the filter
_BETWEEN_S = 5.0


def filtered_noise(bench: CalibratedSensor) -> WrenchNoise:
    """Return what the filter leaves of noise and of the readings' steps."""
    return bench.noise(KalmanFilter(RATE_HZ).figures().noise_left)


def noise_at(bench: CalibratedSensor, R_WS: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the covariance of filtered, compensated wrenches at orientations R_WS (n, 3, 3), (n, 6, 6)."""
    return filtered_noise(bench).covariance + bench.calibration.model.wrench_covariance(R_WS)


def read_touches(
    bench: CalibratedSensor, contacts: NDArray[np.float64], R_WS: NDArray[np.float64], key: int
) -> NDArray[np.float64]:
    """
    Return what is located: readings of held touches after compensation and the paper's Kalman filter.

    Parameters
    ----------
    contacts : (n, 6)
        True wrenches on the probe, S.
    R_WS : (n, 3, 3)
    key : int
        Of the noise: the same one gives the same noise whatever the touches are.

    Returns
    -------
    (n, 6)
        The filter's answer half a second into each touch.
    """
    before, held = round(_BEFORE_S * RATE_HZ), round(_HOLD_S * RATE_HZ)
    count, length = len(contacts), before + held
    true = np.repeat(bench.weight(R_WS)[:, None], length, axis=1)
    true[:, before:] += contacts[:, None]
    times = WARM_S + _BETWEEN_S * np.arange(count)[:, None] + np.arange(length) / RATE_HZ
    model = SensorModel(bench.settings, np.random.default_rng([bench.seed, 2, key]))
    read = model.read(times.ravel(), true.reshape(-1, 6)).wrenches.reshape(true.shape)
    net = read - bench.calibration.model.predict(R_WS)[:, None]
    # Channels of the filter are independent: all touches at once.
    rows = net.transpose(1, 0, 2).reshape(length, -1)
    return np.asarray(KalmanFilter(RATE_HZ).filter(rows)[-1].reshape(count, 6))

"""One virtual sensor with a load: calibrated from poses, then read, compensated and filtered as in the paper."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration import Calibration, GravityModel, PoseSample, calibrate
from contactbench.pipeline.calibration.reachable import by_hand
from contactbench.pipeline.calibration.suggest import plan_poses
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.simulation.sensor_model import SensorModel, SensorSettings, preset
from contactbench.pipeline.simulation.weighing import draw_load

if TYPE_CHECKING:
    from numpy.typing import NDArray

RATE_HZ = 200.0
POSES = 8
COLD_S, WARM_S = 60.0, 3600.0  # since the sensor was switched on
_POSE_S = 1.0
_BEFORE_S, _HOLD_S = 0.1, 0.5  # seven time constants of the filter
_BETWEEN_S = 5.0
_MASS_KG = (0.3, 0.8)


@dataclass(frozen=True, eq=False)
class Bench:
    """A sensor, its load, and the gravity calibration that was made of it."""

    seed: int
    settings: SensorSettings  # with the biases of this bench
    truth: GravityModel  # weight, centre of mass and biases as they are
    calibration: Calibration

    @property
    def filtered_noise(self) -> WrenchNoise:
        """What the filter leaves of noise and of the readings' steps."""
        sigma = np.sqrt(self.settings.noise**2 + self.settings.resolution**2 / 12)
        left = KalmanFilter(RATE_HZ).figures().noise_left * sigma
        return WrenchNoise(left[:3], left[3:])

    def noise_at(self, R_WS: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the covariance of filtered, compensated wrenches at orientations R_WS (n, 3, 3), (n, 6, 6)."""
        return self.filtered_noise.covariance + self.calibration.model.wrench_covariance(R_WS)


def draw_bench(seed: int, sensor: str = "paper", calibrated_at: float = WARM_S) -> Bench:
    """
    Draw load and biases, and calibrate.

    Each pose is a second of readings of weight, bias and noise. The physics is left out there: at rest it gives just
    these sums.

    Parameters
    ----------
    sensor : str
        A preset.
    calibrated_at : float
        s since the sensor was switched on; a cold one drifts afterwards.
    """
    rng = np.random.default_rng([seed, 1])
    truth = draw_load(rng, _MASS_KG)
    settings = replace(preset(sensor), bias=np.concatenate([truth.force_bias, truth.torque_bias]))
    model = SensorModel(settings, rng)
    poses = []
    for number, R_WS in enumerate(_orientations()):
        times = calibrated_at + _BETWEEN_S * number + np.arange(0.0, _POSE_S, 1 / RATE_HZ)
        read = model.read(times, np.tile(_weight(truth, R_WS), (len(times), 1))).wrenches
        mean, scatter = read.mean(axis=0), read.std(axis=0, ddof=1)
        poses.append(PoseSample(R_WS, mean[:3], mean[3:], len(read), scatter[:3], scatter[3:]))
    return Bench(seed, settings, truth, calibrate(poses))


def read_touches(
    bench: Bench, contacts: NDArray[np.float64], R_WS: NDArray[np.float64], key: int
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
    true = np.repeat(_weight(bench.truth, R_WS)[:, None], length, axis=1)
    true[:, before:] += contacts[:, None]
    times = WARM_S + _BETWEEN_S * np.arange(count)[:, None] + np.arange(length) / RATE_HZ
    model = SensorModel(bench.settings, np.random.default_rng([bench.seed, 2, key]))
    read = model.read(times.ravel(), true.reshape(-1, 6)).wrenches.reshape(true.shape)
    net = read - bench.calibration.model.predict(R_WS)[:, None]
    # Channels of the filter are independent: all touches at once.
    rows = net.transpose(1, 0, 2).reshape(length, -1)
    return np.asarray(KalmanFilter(RATE_HZ).filter(rows)[-1].reshape(count, 6))


def _weight(truth: GravityModel, R_WS: NDArray[np.float64]) -> NDArray[np.float64]:
    bias = np.concatenate([truth.force_bias, truth.torque_bias])
    return np.asarray(truth.predict(R_WS) - bias)


@cache
def _orientations() -> NDArray[np.float64]:
    return plan_poses(POSES, by_hand()).R_WS

"""From raw samples to contacts: poses are held, a reading that is none is kept out, the kernel does the rest."""

from __future__ import annotations

from math import log
from typing import TYPE_CHECKING, Any

import numpy as np

from pipeline import kernel
from pipeline.config.runtime.values import gates_of, touch_model_of
from pipeline.devices.sample import Status
from pipeline.runtime.lines import Answer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from pipeline.config.runtime import RuntimeConfig
    from pipeline.devices.sample import FlangeSample, WrenchSample

_KEPT = 64  # a sample that is late by a slice of a pose stream still finds the pose of its time


def make_runtime(config: RuntimeConfig) -> kernel.Runtime:
    """
    Return the compiled runtime of a config: the same as ``cb_open`` of the C library, to the last bit.

    Parameters
    ----------
    config : RuntimeConfig
    """
    return kernel.Runtime(**kernel_arguments(config))


def kernel_arguments(config: RuntimeConfig) -> dict[str, Any]:
    """
    Return the arguments of :class:`pipeline.kernel.Runtime` for a config, with the bits of the C library.

    Parameters
    ----------
    config : RuntimeConfig
    """
    model, probe = config.model, config.probe
    touch = touch_model_of(model.touch)
    bonus = np.array([0.0, *(2 * log(region.odds) for region in model.regions)])
    wrench, location = model.filters.wrench, model.filters.location
    kalman = None
    if wrench is not None:
        values = (wrench.rate_Hz, wrench.q, wrench.r, wrench.tuned_rate_Hz, wrench.per_sample)
        kalman = np.array(values, dtype=np.float64)
    return {
        "vertices": probe.vertices,
        "faces": probe.faces,
        "region": probe.region,
        "noise": np.array(model.noise.wrench_covariance) + touch.model_error.covariance,
        "gravity": config.gravity.vector,
        "kalman": kalman,
        "sections": np.zeros((0, 6)) if location is None else np.array(location.sections),
        "bonus": bonus[probe.region],
        "torsion_arm": touch.torsion_arm,
        "mesh_deviation": touch.mesh_deviation,
        "mesh_curved": touch.mesh_curved,
        **gates_of(model.gates).kernel_arguments(),
        # As it stands there: Gates has come to it by way of a probability.
        "implausible_misfit": model.gates.implausible_misfit,
    }


class Engine:
    """
    One stream of wrenches and one of poses, into contacts.

    A sample takes the newest pose that is not later than itself, live as in a replay: nothing is interpolated,
    for a controller does not know the next pose either, and a recording gives again what was given live. Without a pose
    at most `hold` old the reason is ``stale``, and the kernel is left as it was.

    A reading that the sensor itself calls no measurement is given to the kernel as not a number (reason
    ``not_finite``); one that is at its limits, as it is (reason ``saturated``).

    Wrenches may come in one thread and poses in another.

    Parameters
    ----------
    config : RuntimeConfig
    hold : float, optional
        The oldest pose that counts, s; left out, the config's ``gates.max_age_s``; infinite for one that stands still.
    """

    def __init__(self, config: RuntimeConfig, *, hold: float | None = None) -> None:
        self._runtime = make_runtime(config)
        self._R_ES = mount_rotation(config)
        self._hold = config.model.gates.max_age_s if hold is None else hold
        limits = config.model.gates.saturation
        self._limits = [np.inf if limit is None else limit for limit in limits]
        # Replaced, never changed: the other thread may be looking. Newest first.
        self._poses: tuple[tuple[float, NDArray[np.float64]], ...] = ()

    def poses(self, samples: Sequence[FlangeSample]) -> None:
        """Take poses of the flange, oldest first."""
        for sample in samples[-_KEPT:]:
            R_WS = sensor_rotation(sample.R_BE, self._R_ES)
            self._poses = ((sample.time, R_WS), *self._poses[: _KEPT - 1])

    def locate(self, sample: WrenchSample) -> Answer:
        """Say where the probe is touched."""
        R_WS = self._pose_at(sample.time)
        if R_WS is None:
            return Answer(sample.time, None)
        return Answer(sample.time, self._runtime.update(self._reading(sample), R_WS, sample.time))

    def _pose_at(self, time: float) -> NDArray[np.float64] | None:
        for moment, R_WS in self._poses:
            if moment <= time:
                return R_WS if time - moment <= self._hold else None
        return None

    def _reading(self, sample: WrenchSample) -> NDArray[np.float64]:
        reading = np.array((*sample.force, *sample.torque))
        wrong = sample.status & ~Status.LATE
        if wrong and not (wrong == Status.OVERRANGE and (np.abs(reading) >= self._limits).any()):
            reading[:] = np.nan
        return reading


def mount_rotation(config: RuntimeConfig) -> NDArray[np.float64] | None:
    """Return R_ES (3, 3), as the C library computes it; None: poses are of the sensor itself."""
    quaternion = config.model.frames.quaternion_ES
    if quaternion is None:
        return None
    w, x, y, z = quaternion
    size = np.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / size, x / size, y / size, z / size
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def sensor_rotation(R_WE: NDArray[np.float64], R_ES: NDArray[np.float64] | None) -> NDArray[np.float64]:
    """
    Return R_WS = R_WE R_ES, with the bits of ``cb_sensor_rotation``.

    Parameters
    ----------
    R_WE : (3, 3)
    R_ES : (3, 3) or None
        None: `R_WE` is R_WS already.
    """
    if R_ES is None:
        return np.ascontiguousarray(R_WE, dtype=np.float64)
    product = np.zeros((3, 3))
    for k in range(3):  # a matrix product may fuse and reorder, and differ in the last bit
        product += R_WE[:, k, None] * R_ES[k]
    return product

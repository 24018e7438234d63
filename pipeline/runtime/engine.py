"""From raw samples and poses to contacts: the kernel does all of it."""

from __future__ import annotations

from math import log
from typing import TYPE_CHECKING, Any

import numpy as np

from pipeline import kernel
from pipeline.config.runtime.values import gates_of, touch_model_of
from pipeline.runtime.lines import Answer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from pipeline.config.runtime import RuntimeConfig
    from pipeline.devices.sample import FlangeSample, WrenchSample

_UNKNOWN = np.full(3, np.nan)


def make_runtime(config: RuntimeConfig, *, hold: float | None = None) -> kernel.Runtime:
    """
    Return the compiled runtime of a config: the same as ``cb_open`` of the C library, to the last bit.

    Parameters
    ----------
    config : RuntimeConfig
    hold : float, optional
        The oldest pose that counts, s; left out, the config's ``streams.pose_ahead_s``.
    """
    arguments = kernel_arguments(config)
    if hold is not None:
        arguments["pose_ahead"] = hold
    return kernel.Runtime(**arguments)


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
    streams = model.streams
    motion = streams.motion
    return {
        "R_ES": _mount_rotation(model.frames.quaternion_ES),
        "pose_gap": streams.pose_gap_s,
        "pose_ahead": streams.pose_ahead_s,
        "silence": streams.silence_s,
        "frozen_chance": streams.frozen_probability,
        "motion": None if motion is None else (motion.window_s, motion.gyration_m),
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

    A sample takes the pose at its own time: between two poses, or carried on from the last one, as the config's
    ``streams`` allow. Without one the reason is ``stale``, and the filters are left as they were.

    Wrenches may come in one thread and poses in another.

    Parameters
    ----------
    config : RuntimeConfig
    hold : float, optional
        As for `make_runtime`; infinite for a pose that stands still.
    clock : callable, optional
        The present on the samples' clock, s: a contact's latency then runs until it is found. Left out, it is the
        sample's own, arrival less time.
    """

    def __init__(
        self, config: RuntimeConfig, *, hold: float | None = None, clock: Callable[[], float] | None = None
    ) -> None:
        self._runtime, self._clock = make_runtime(config, hold=hold), clock

    def poses(self, samples: Sequence[FlangeSample]) -> None:
        """Take poses of the flange, oldest first."""
        for sample in samples:
            R = np.ascontiguousarray(sample.R_BE, dtype=np.float64)
            p = np.ascontiguousarray(sample.p_BE_B, dtype=np.float64)
            self._runtime.pose(R, p if p.shape == (3,) else _UNKNOWN, sample.time)

    def locate(self, sample: WrenchSample) -> Answer:
        """Say where the probe is touched."""
        reading = np.array((*sample.force, *sample.torque))
        arrival = sample.time if sample.arrival is None else sample.arrival
        contact = self._runtime.locate(reading, sample.time, arrival, int(sample.status))
        return Answer(contact, contact.latency if self._clock is None else self._clock() - sample.time)

    def silent(self, now: float) -> Answer | None:
        """Return an answer that says that no sample comes, or None while they do; `now` in s of the samples' clock."""
        contact = self._runtime.silent(now)
        return None if contact is None else Answer(contact, contact.latency)


def _mount_rotation(quaternion_ES: Sequence[float] | None) -> NDArray[np.float64] | None:
    """Return R_ES (3, 3) with the bits of the C library; None: poses are of the sensor itself."""
    if quaternion_ES is None:
        return None
    w, x, y, z = quaternion_ES
    size = np.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / size, x / size, y / size, z / size
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )

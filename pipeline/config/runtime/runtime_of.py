"""The compiled runtime of a config."""

from __future__ import annotations

from math import log, radians
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline import kernel
from contactbench.pipeline.config.runtime.values import gates_of, touch_model_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.config.runtime.config import RuntimeConfig

_LEAST_ORIENTATION_RAD = radians(0.1)


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
    Return the arguments of :class:`contactbench.pipeline.kernel.Runtime` for a config, with the bits of the C library.

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
        "gravity_covariance": config.gravity.covariance,
        # Poses of a moving robot are no better than this, whatever the still ones of a calibration were.
        "orientation_sigma": max(model.noise.orientation_rad or 0.0, _LEAST_ORIENTATION_RAD),
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

"""What a config stands for: the project's own values, what follows from them, and the compiled runtime."""

from __future__ import annotations

from math import log, radians
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline import kernel
from contactbench.pipeline.calibration.model import GravityModel
from contactbench.pipeline.contact.touch_model import TouchModel, WrenchNoise
from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.gates import Gates

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.config.runtime.config import RuntimeConfig
    from contactbench.pipeline.config.runtime.model import KalmanPart, RuntimeModel, TouchModelPart

# The covariance of a compensated wrench is of second degree in the rotation: the mean over the 24 rotations of a cube
# is the mean over all rotations, exactly.
_ORIENTATIONS = Rotation.create_group("O").as_matrix()
_LEAST_ORIENTATION_RAD = radians(0.1)


def gravity_of(model: RuntimeModel) -> GravityModel:
    """Return the gravity model of a config."""
    part = model.gravity
    return GravityModel(
        np.array(part.gravity_W_N),
        np.array(part.force_bias_N),
        np.array(part.centre_of_mass_S_m),
        np.array(part.torque_bias_Nm),
        np.array(part.covariance),
    )


def kalman_of(part: KalmanPart) -> KalmanFilter:
    """Return the wrench filter, fresh; InputError if a number is out of its range."""
    return KalmanFilter(
        part.rate_Hz, q=part.q, r=part.r, tuned_rate=part.tuned_rate_Hz, per_sample=part.per_sample
    )


def touch_model_of(part: TouchModelPart) -> TouchModel:
    """Return what is known of a touch beside the sensor's noise."""
    return TouchModel(
        torsion_arm=part.torsion_arm_m,
        model_error=WrenchNoise(part.model_error.force_N, part.model_error.torque_Nm),
        mesh_deviation=part.mesh_deviation_m,
        mesh_curved=part.mesh_curved,
        torsion_learned=part.torsion == "learned",
        scene=part.scene,
    )


def wrench_covariance(
    force: ArrayLike, torque: ArrayLike, wrench_filter: KalmanFilter | None, gravity: GravityModel
) -> NDArray[np.float64]:
    """
    Return how uncertain a compensated, filtered wrench is, on average over all orientations.

    (sigma of a reading times what the filter leaves of white noise)² plus the calibration's share, which no filter
    removes.

    Parameters
    ----------
    force, torque : (3,)
        Standard deviation of one reading, N and N·m.
    wrench_filter : KalmanFilter or None
    gravity : GravityModel

    Returns
    -------
    (6, 6)
        Force before torque, N², N²·m, N²·m².
    """
    left = 1.0 if wrench_filter is None else wrench_filter.figures().noise_left
    sigmas = np.concatenate([np.asarray(force, dtype=np.float64), np.asarray(torque, dtype=np.float64)])
    share = gravity.wrench_covariance(_ORIENTATIONS).mean(axis=0)
    total: NDArray[np.float64] = np.diag((sigmas * left) ** 2) + 0.5 * (share + share.T)
    return total


def low_pass_sections(cutoff: float, rate: float, order: int) -> NDArray[np.float64]:
    """Return the second-order sections of a Butterworth low-pass, (n, 6), as `LowPass` has them; Hz."""
    from scipy.signal import butter  # takes longer to import than all else here

    sections: NDArray[np.float64] = butter(order, cutoff, fs=rate, output="sos")
    return sections


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
        sigma = (*model.noise.force_N, *model.noise.torque_Nm) if wrench.kind == "adaptive" else (0.0,) * 6
        kalman = np.array((*values, *sigma), dtype=np.float64)
    streams = model.streams
    motion = streams.motion
    return {
        "R_ES": rotation_ES(model.frames.quaternion_ES),
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
        "follow": model.zero.follow,
        "kalman": kalman,
        "sections": np.zeros((0, 6)) if location is None else np.array(location.sections),
        "bonus": bonus[probe.region],
        "torsion_arm": touch.torsion_arm,
        "torsion_learned": touch.torsion_learned,
        "mesh_deviation": touch.mesh_deviation,
        "mesh_curved": touch.mesh_curved,
        "gates": {
            **Gates.of_stored(model.gates).kernel_values(),
            # As it stands there: Gates has come to it by way of a probability.
            "implausible_misfit": model.gates.implausible_misfit,
        },
    }


def rotation_ES(quaternion_ES: Sequence[float] | None) -> NDArray[np.float64] | None:
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

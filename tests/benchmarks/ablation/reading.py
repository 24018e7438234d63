"""Choices of how a wrench is read: the sensor's crosstalk, its rotation on the flange, and its drift."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.ablation.locating import SENSOR, sigmas_of
from benchmarks.ablation.records import WEIGHT
from scipy.spatial.transform import Rotation

from contactbench.pipeline import kernel
from contactbench.pipeline.calibration import PoseNoise, PoseSample, calibrate
from contactbench.pipeline.calibration.mount import estimate_mount
from contactbench.pipeline.calibration.suggest import by_hand, plan_poses
from contactbench.pipeline.simulation.sensor_model import preset

if TYPE_CHECKING:
    from benchmarks.ablation.records import SceneRecord
    from numpy.typing import NDArray

    Read = tuple[NDArray[np.float64], NDArray[np.float64]]

    from contactbench.pipeline.calibration import GravityModel

DRIFT, MOUNT, CROSSTALK = CHOICES = ("drift model", "mount rotation", "sensor crosstalk")
# What each is: K, degrees, % of full scale.
AMOUNTS = {DRIFT: 4.0, MOUNT: 2.0, CROSSTALK: 0.5}
_POSES, _MEANED = 12, 200  # readings of a pose: a second
_FREE_S, _FREE = (60.0, 3600.0), 12
_FLOOR = np.repeat([1e-4, 2e-6], 3)  # N, N·m: below it a calibration would find no noise at all


def read(choice: str, record: SceneRecord, amount: float, noise: float, rng: np.random.Generator) -> Read:
    """
    Read a record with a sensor that is not perfect: (n, 6) wrenches without the choice, and with it, S, N and N·m.

    Parameters
    ----------
    choice : str
        Of CHOICES.
    amount : float
        See AMOUNTS.
    noise : float
        Times that of one reading.
    """
    drawn = sigmas_of(noise) * rng.standard_normal(record.contacts.shape)
    return {DRIFT: _drift, MOUNT: _mount, CROSSTALK: _crosstalk}[choice](record, amount, drawn, rng)


def crosstalk_of(percent: float) -> NDArray[np.float64]:
    """Return the matrix (6, 6) of a sensor with so much crosstalk: the pattern of the noisy preset, scaled."""
    pattern = preset("noisy").crosstalk - np.eye(6)
    return np.asarray(np.eye(6) + percent / 0.5 * pattern)


def _crosstalk(
    record: SceneRecord, amount: float, drawn: NDArray[np.float64], rng: np.random.Generator
) -> Read:
    C = crosstalk_of(amount)
    back = np.linalg.inv(C)
    bias, noise = _bias(), _pose_noise()
    R = _orientations()
    still = WEIGHT.predict(R) @ C.T + bias + noise.sigmas * rng.standard_normal((_POSES, 6))
    readings = (record.contacts + WEIGHT.predict(record.R_WS)) @ C.T + bias + drawn
    plain = calibrate(_poses(R, still)).model
    mended = calibrate(_poses(R, still @ back.T)).model
    return plain.compensate(record.R_WS, readings), mended.compensate(record.R_WS, readings @ back.T)


def _mount(record: SceneRecord, amount: float, drawn: NDArray[np.float64], rng: np.random.Generator) -> Read:
    axis = rng.standard_normal(3)
    R_SE = Rotation.from_rotvec(np.radians(amount) * axis / np.linalg.norm(axis)).as_matrix()
    bias, noise, R_WE = _bias(), _pose_noise(), _orientations()
    still = WEIGHT.predict(R_WE @ R_SE.T) + bias + noise.sigmas * rng.standard_normal((_POSES, 6))
    poses = _poses(R_WE, still)  # their orientations are the flange's
    readings = record.contacts + WEIGHT.predict(record.R_WS) + bias + drawn
    used = record.R_WS @ R_SE  # R_WE while it is used
    believed, estimated = calibrate(poses), estimate_mount(poses)
    mended = estimated.calibration.model.compensate(used @ estimated.R_SE.T, readings)
    return believed.model.compensate(used, readings), mended


def _drift(record: SceneRecord, amount: float, drawn: NDArray[np.float64], rng: np.random.Generator) -> Read:
    drift, bias, noise = preset(SENSOR).drift, _bias(), _pose_noise()
    R = _orientations()
    still = WEIGHT.predict(R) + bias + noise.sigmas * rng.standard_normal((_POSES, 6))
    model = calibrate(_poses(R, still)).model
    watch = _watch(model)
    first, last = _FREE_S
    for number, t in enumerate(np.linspace(first, last, _FREE)):
        warmer, turn = amount * (t - first) / (last - first), R[number % _POSES]
        free = WEIGHT.predict(turn) + bias + warmer * drift
        _see(watch, float(t), turn, model.compensate(turn, free), rng)
    zero = watch.at(last).offset
    moved = np.zeros(6) if zero is None else zero
    readings = record.contacts + WEIGHT.predict(record.R_WS) + bias + amount * drift + drawn
    compensated = model.compensate(record.R_WS, readings)
    return compensated, compensated - moved


def _watch(model: GravityModel) -> kernel.ZeroWatch:
    """Watch the zero of a sensor whose probe is touched 100 mm away from it."""
    return kernel.ZeroWatch(
        model.vector,
        model.covariance,
        np.tile([0.0, 0.0, 0.1], (6, 1)),
        orientation_sigma=0.0,
        min_force=0.5,
    )


def _see(
    watch: kernel.ZeroWatch,
    t: float,
    R_WS: NDArray[np.float64],
    wrench: NDArray[np.float64],
    rng: np.random.Generator,
) -> None:
    """Show it a moment without contact: a second of readings about a compensated wrench (6,), S."""
    times = t + np.arange(_MEANED + 1) / _MEANED
    noise = preset(SENSOR).noise * rng.standard_normal((len(times), 6))
    watch.see(wrench + noise, np.repeat(R_WS[None], len(times), axis=0), times)


def _bias() -> NDArray[np.float64]:
    return preset(SENSOR).bias


def _pose_noise() -> PoseNoise:
    sigmas = np.maximum(preset(SENSOR).noise / np.sqrt(_MEANED), _FLOOR)
    return PoseNoise(sigmas[:3], sigmas[3:])


def _poses(R: NDArray[np.float64], readings: NDArray[np.float64]) -> list[PoseSample]:
    return [PoseSample(each, w[:3], w[3:]) for each, w in zip(R, readings, strict=True)]


@cache
def _orientations() -> NDArray[np.float64]:
    return plan_poses(_POSES, by_hand()).R_WS

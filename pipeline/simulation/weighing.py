"""A load on a sensor, held still in known poses: what the sensor reads, and the truth behind it.

The smallest bench for gravity calibration. It leaves out how the arm got there, drift and hum; what it keeps
is what a pose's mean reading is made of.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel, PoseNoise, PoseSample
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY

if TYPE_CHECKING:
    from numpy.typing import NDArray

Range = tuple[float, float]

_TOOL_LENGTH = (0.02, 0.15)  # m, of the centre of mass along the sensor's z axis
_LEVER = 0.15  # m, at which a hand bumps the tool


@dataclass(frozen=True, eq=False)
class Weighing:
    """Poses and the truth behind them."""

    truth: GravityModel
    noise: PoseNoise  # True standard deviations of a pose's mean
    poses: tuple[PoseSample, ...]
    bumped: NDArray[np.bool_]  # (n,) bool Poses that something touched


def draw_load(rng: np.random.Generator, mass: Range = (0.1, 2.0)) -> GravityModel:
    """Draw a load and biases: centre of mass on the tool's side, a few mm off its axis.

    Parameters
    ----------
    mass : (low, high)
        kg, uniform.
    """
    weight = rng.uniform(*mass) * STANDARD_GRAVITY
    off_axis = rng.uniform(-0.02, 0.02, 2)
    return GravityModel(
        np.array([0.0, 0.0, -weight]),
        rng.uniform(-10, 10, 3),
        np.array([*off_axis, rng.uniform(*_TOOL_LENGTH)]),
        rng.uniform(-0.5, 0.5, 3),
    )


def draw_noise(
    rng: np.random.Generator, force: Range = (0.02, 0.2), torque: Range = (0.0005, 0.01)
) -> PoseNoise:
    """Draw the standard deviations of a pose's mean, N and N·m, uniform."""
    return PoseNoise(rng.uniform(*force), rng.uniform(*torque))


def weigh(
    truth: GravityModel, R_WS: NDArray[np.float64], noise: PoseNoise, rng: np.random.Generator
) -> Weighing:
    """Read a load in poses R_WS (n, 3, 3)."""
    readings = truth.predict(R_WS) + noise.sigmas * rng.standard_normal((len(R_WS), 6))
    poses = tuple(PoseSample(R, w[:3], w[3:]) for R, w in zip(R_WS, readings, strict=True))
    return Weighing(truth, noise, poses, np.zeros(len(poses), dtype=bool))


def draw_weighing(
    rng: np.random.Generator,
    *,
    poses: tuple[int, int] = (4, 12),
    mass: Range = (0.1, 2.0),
    force_noise: Range = (0.02, 0.2),
    torque_noise: Range = (0.0005, 0.01),
) -> Weighing:
    """Draw a load, its noise, and orientations spread over all rotations.

    Parameters
    ----------
    poses : (low, high)
        How many, both included.
    mass, force_noise, torque_noise : (low, high)
        kg, N and N·m, uniform.
    """
    count = int(rng.integers(poses[0], poses[1] + 1))
    R_WS = Rotation.random(count, rng).as_matrix()
    return weigh(draw_load(rng, mass), R_WS, draw_noise(rng, force_noise, torque_noise), rng)


def bump(weighing: Weighing, share: float, rng: np.random.Generator, force: Range = (2.0, 20.0)) -> Weighing:
    """Touch some of the poses: half of them by a push at the tool, half by a torque only.

    Parameters
    ----------
    share : float
        Of the poses, rounded to whole ones.
    force : (low, high)
        N, uniform; a torque is such a force on a lever of 50 mm.
    """
    poses = list(weighing.poses)
    chosen = rng.choice(len(poses), round(share * len(poses)), replace=False)
    for index in chosen:
        direction = Rotation.random(None, rng).as_matrix()[0]
        push = rng.uniform(*force) * direction
        pose = poses[index]
        if rng.random() < 0.5:
            lever = np.array([0.0, 0.0, _LEVER]) + rng.uniform(-0.02, 0.02, 3)
            poses[index] = replace(pose, force=pose.force + push, torque=pose.torque + np.cross(lever, push))
        else:
            poses[index] = replace(pose, torque=pose.torque + 0.05 * push)
    bumped = weighing.bumped.copy()
    bumped[chosen] = True
    return replace(weighing, poses=tuple(poses), bumped=bumped)

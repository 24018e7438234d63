"""A load on a sensor, held still in known poses: what the sensor reads, and the truth behind it.

The smallest bench for gravity calibration. It leaves out how the arm got there, drift and hum; what it keeps
is what a pose's mean reading is made of.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel, PoseNoise, PoseSample
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.mesh.arrays import Floats, Mask
from contactbench.pipeline.simulation.sensor_model import SensorSettings, preset

Range = tuple[float, float]

_TOOL_LENGTH = (0.02, 0.15)  # m, of the centre of mass along the sensor's z axis
_LEVER = 0.15  # m, at which a hand bumps the tool
_USE_TILT = np.radians(45.0)


@dataclass(frozen=True, eq=False)
class LoadedSensor:
    """A sensor with something on it that weighs."""

    load: GravityModel  # weight in the world W, centre of mass, and biases of the cold sensor
    preset: str = "paper"  # figures of the sensor, but for its biases

    @cached_property
    def settings(self) -> SensorSettings:
        """The sensor: the preset with the biases of this one."""
        return replace(
            preset(self.preset), bias=np.concatenate([self.load.force_bias, self.load.torque_bias])
        )

    def noise(self, left: float = 1.0) -> WrenchNoise:
        """Return that of one reading, with the steps of the readings; `left`: the share that a filter leaves."""
        sigma = left * np.sqrt(self.settings.noise**2 + self.settings.resolution**2 / 12)
        return WrenchNoise(sigma[:3], sigma[3:])

    def weight(self, R_WS: Floats) -> Floats:
        """Return what a perfect sensor reads of the load at rest, (n, 6), at orientations (n, 3, 3)."""
        bias = np.concatenate([self.load.force_bias, self.load.torque_bias])
        return np.asarray(self.load.predict(R_WS) - bias)


@dataclass(frozen=True, eq=False)
class Weighing:
    """Poses and the truth behind them."""

    truth: GravityModel
    noise: PoseNoise  # True standard deviations of a pose's mean
    poses: tuple[PoseSample, ...]
    bumped: Mask  # (n,) bool Poses that something touched


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


def weigh(truth: GravityModel, R_WS: Floats, noise: PoseNoise, rng: np.random.Generator) -> Weighing:
    """Read a load in poses R_WS (n, 3, 3)."""
    readings = truth.predict(R_WS) + noise.sigmas * rng.standard_normal((len(R_WS), 6))
    poses = tuple(PoseSample(R, w[:3], w[3:]) for R, w in zip(R_WS, readings, strict=True))
    return Weighing(truth, noise, poses, np.zeros(len(poses), dtype=bool))


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


def orientations_in_use(count: int, rng: np.random.Generator) -> Floats:
    """Draw R_WS (n, 3, 3) of a probe in use: pointing down, or tilted from that by up to 45 degrees."""
    bearing, tilt = rng.uniform(0, 2 * np.pi, count), _USE_TILT * np.sqrt(rng.random(count))
    axes = np.column_stack([np.cos(bearing), np.sin(bearing), np.zeros(count)])
    spin = Rotation.from_rotvec(np.outer(rng.uniform(0, 2 * np.pi, count), [0.0, 0.0, 1.0]))
    down = Rotation.from_rotvec([np.pi, 0.0, 0.0])
    return (Rotation.from_rotvec(tilt[:, None] * axes) * down * spin).as_matrix()

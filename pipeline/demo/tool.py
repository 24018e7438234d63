"""What the demo puts on the bench: a load on a sensor, and the robot that says how it is turned."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.simulation.scenes.physics import Payload
from contactbench.pipeline.simulation.sensor_model import SensorModel, SensorSettings, preset
from contactbench.pipeline.simulation.weighing import draw_load

if TYPE_CHECKING:
    from numpy.typing import NDArray

SENSOR = "paper"
SENSOR_MODEL = "virtual, paper-like"
RATE_HZ = 200
WARM_S = 3600.0  # since the sensor was switched on: as long as one should wait before a calibration

_MASS = (0.3, 0.8)  # kg
_BASE_TILT = np.radians(0.5)
_USE_TILT = np.radians(45.0)


@dataclass(frozen=True, eq=False)
class Tool:
    """A probe with its holder on a warm sensor, on a robot whose base B stands not quite upright."""

    load: GravityModel  # weight in the world W, centre of mass, and biases of the cold sensor
    R_BW: NDArray[np.float64]  # (3, 3) what the robot does not know: half a degree from the identity

    @cached_property
    def settings(self) -> SensorSettings:
        """The sensor: the preset with the biases of this one."""
        return replace(preset(SENSOR), bias=np.concatenate([self.load.force_bias, self.load.torque_bias]))

    @cached_property
    def truth(self) -> GravityModel:
        """What a calibration should find: of the warm sensor, gravity in B."""
        warmer = float(SensorModel(self.settings).temperature(WARM_S)[0]) - self.settings.ambient
        bias = self.settings.bias + warmer * self.settings.drift
        return GravityModel(
            self.R_BW @ self.load.gravity_W,
            bias[:3],
            self.load.centre_of_mass_S,
            bias[3:],
            self.load.covariance,
        )

    @property
    def payload(self) -> Payload:
        """The load as physics wants it."""
        return Payload(self.load.mass, self.load.centre_of_mass_S)

    def noise(self, left: float = 1.0) -> WrenchNoise:
        """Return that of one reading, with the steps of the readings; `left`: the share that a filter leaves."""
        sigma = left * np.sqrt(self.settings.noise**2 + self.settings.resolution**2 / 12)
        return WrenchNoise(sigma[:3], sigma[3:])

    def weight(self, R_WS: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return what a perfect sensor reads of the load at rest, (n, 6), at orientations (n, 3, 3)."""
        bias = np.concatenate([self.load.force_bias, self.load.torque_bias])
        return np.asarray(self.load.predict(R_WS) - bias)


def draw_tool(rng: np.random.Generator) -> Tool:
    """Draw a load and biases."""
    tilt = Rotation.from_rotvec(_BASE_TILT * np.array([0.6, -0.8, 0.0])).as_matrix()
    return Tool(draw_load(rng, _MASS), tilt)


def orientations_in_use(count: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """Draw R_WS (n, 3, 3) of a probe in use: pointing down, or tilted from that by up to 45 degrees."""
    bearing, tilt = rng.uniform(0, 2 * np.pi, count), _USE_TILT * np.sqrt(rng.random(count))
    axes = np.column_stack([np.cos(bearing), np.sin(bearing), np.zeros(count)])
    spin = Rotation.from_rotvec(np.outer(rng.uniform(0, 2 * np.pi, count), [0.0, 0.0, 1.0]))
    down = Rotation.from_rotvec([np.pi, 0.0, 0.0])
    return (Rotation.from_rotvec(tilt[:, None] * axes) * down * spin).as_matrix()

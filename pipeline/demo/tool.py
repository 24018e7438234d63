"""What the demo puts on the bench: a load on a sensor, and the robot that says how it is turned."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.simulation.loads import LoadedSensor, draw_load
from contactbench.pipeline.simulation.scenes.physics import Payload
from contactbench.pipeline.simulation.sensor_model import SensorModel

if TYPE_CHECKING:
    from numpy.typing import NDArray

SENSOR_MODEL = "virtual, paper-like"
OPERATOR = "contactbench demo"
RATE_HZ = 200
WARM_S = 3600.0  # since the sensor was switched on: as long as one should wait before a calibration

_MASS = (0.3, 0.8)  # kg
_BASE_TILT = np.radians(0.5)


@dataclass(frozen=True, eq=False)
class DemoTool(LoadedSensor):
    """A probe with its holder on a warm sensor, on a robot whose base B stands not quite upright."""

    # what the robot does not know: half a degree from the identity
    R_BW: NDArray[np.float64] = field(kw_only=True)

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


def draw_tool(rng: np.random.Generator) -> DemoTool:
    """Draw a load and biases."""
    tilt = Rotation.from_rotvec(_BASE_TILT * np.array([0.6, -0.8, 0.0])).as_matrix()
    return DemoTool(draw_load(rng, _MASS), R_BW=tilt)

"""What a robot carries behind its flange, in the words that its own controller takes.

A robot that is told a wrong payload pulls on its hand-guiding, and takes its own weight for a touch. The calibration
has weighed what hangs on the sensor's measuring side; the sensor's own body, and an adapter in front of it, the sensor
does not feel: they are added as a body whose mass and centre of mass somebody knows.

    m = m_L + m_B,    p_EC = (m_L (p_ES + R_ES L) + m_B p_EB) / m

(E flange, S sensor, L the load's centre of mass in S, B the body in between.)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.model import CENTRE_OF_MASS, GRAVITY, STANDARD_GRAVITY
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.settings import RobotMaker

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.calibration import GravityModel

    Array = NDArray[np.float64]

# A payload less certain than this is not worth telling a robot: it weighs the tool as well by itself.
_LARGEST_SHARE, _LARGEST_OFFSET_M = 0.1, 0.01

CAUTIONS = {
    RobotMaker.UR: message(
        "Setting the payload also zeroes the robot's own force and torque readings: set it with the robot at"
        " rest and nothing touching the tool."
    ),
    RobotMaker.ABB: message(
        "Replace probe_tool by the name of your tooldata. These numbers are in the wrist frame: do not use"
        " them as a loaddata for GripLoad, which is in the tool frame."
    ),
}
"""What must be known before a maker's line is used."""


@dataclass(frozen=True, eq=False)
class Payload:
    """
    Mass and centre of mass of all that hangs on a flange.

    Attributes
    ----------
    load : float
        Mass that the calibration has weighed, kg.
    mass, mass_sigma : float
        With the body in between, which is taken as known, kg.
    centre_E, centre_sigma_E : (3,)
        Centre of mass and its standard deviations by axis, flange frame E, m.
    """

    load: float
    mass: float
    mass_sigma: float
    centre_E: Array
    centre_sigma_E: Array

    @property
    def is_known(self) -> bool:
        """Whether the load is known within 10 % and the centre of mass within 10 mm, one standard deviation."""
        return self.mass_sigma <= _LARGEST_SHARE * self.load and bool(
            np.all(self.centre_sigma_E <= _LARGEST_OFFSET_M)
        )

    def text(self, maker: RobotMaker, index: int = 1) -> str:
        """
        Return the line that a controller, or the person at its pendant, takes.

        Parameters
        ----------
        maker : RobotMaker
        index : int
            Number of the tool, where the controller counts tools (KUKA 1 to 16), or in the name of the tool (ABB).
        """
        kg = f"{self.mass:.3f}"
        m, mm = (
            [f"{scale * each + 0.0:.{places}f}" for each in self.centre_E]
            for scale, places in ((1, 4), (1e3, 1))
        )
        return {
            # URScript: kg and m in the tool flange's frame; an inertia that is left out becomes zero.
            RobotMaker.UR: f"set_target_payload({kg}, [{', '.join(m)}])",
            # The service franka_msgs/srv/SetLoad, or Robot::setLoad of libfranka: kg, m, kg·m².
            RobotMaker.FRANKA: f"{{mass: {kg}, center_of_mass: [{', '.join(m)}],"
            f" load_inertia: [{', '.join(['0.0'] * 9)}]}}",
            # KRL, in $config.dat: kg, mm, kg·m².
            RobotMaker.KUKA: f"LOAD_DATA[{index}]={{M {kg},CM {{X {mm[0]},Y {mm[1]},Z {mm[2]},A 0.0,B 0.0,C 0.0}},"
            "J {X 0.0,Y 0.0,Z 0.0}}",
            # RAPID: kg, mm, axes of inertia as a quaternion, kg·m². The load of a tool is in the frame of the wrist; a
            # loaddata for GripLoad would be in that of the tool.
            RobotMaker.ABB: f"probe_tool{index}.tload:=[{kg},[{','.join(mm)}],[1,0,0,0],0,0,0];",
            # Tool weight in the pendant, field by field.
            RobotMaker.DOOSAN: message(
                f"Weight {arg(kg)} kg, Cx {arg(mm[0])} mm, Cy {arg(mm[1])} mm, Cz {arg(mm[2])} mm"
            ),
        }[maker]


def payload_of(
    model: GravityModel,
    R_ES: ArrayLike,
    p_ES: ArrayLike,
    body_mass: float = 0.0,
    p_EB: ArrayLike = (0.0, 0.0, 0.0),
) -> Payload:
    """
    Return what hangs on the flange, with what the calibration leaves uncertain.

    Parameters
    ----------
    model : GravityModel
    R_ES : array_like (3, 3)
        Orientation of the sensor on the flange.
    p_ES : array_like (3,)
        The sensor's origin in E, m.
    body_mass : float
        Of the sensor and of what is between it and the flange, kg: the sensor does not feel it.
    p_EB : array_like (3,)
        That body's centre of mass in E, m.

    Raises
    ------
    InputError
        A number is not finite, the body's mass is negative, or nothing hangs on the sensor.
    """
    R, p, b = (np.asarray(each, dtype=np.float64) for each in (R_ES, p_ES, p_EB))
    if not all(np.isfinite(each).all() for each in (R, p, b)) or not 0 <= body_mass < np.inf:
        raise InputError(
            "payload: positions must be finite, and the mass of the sensor finite and not negative"
        )
    load = model.mass
    if load <= 0:
        raise InputError("payload: the calibration has no load: weigh the tool that the robot is to carry")
    total = load + body_mass
    arm = p + R @ model.centre_of_mass_S
    centre = (load * arm + body_mass * b) / total
    # First-order propagation of the covariance of weight vector and centre of mass (JCGM 100, 5.2.2).
    by_weight = model.gravity_W / np.linalg.norm(model.gravity_W) / STANDARD_GRAVITY
    J = np.zeros((3, 12))
    J[:, GRAVITY] = np.outer((arm - centre) / total, by_weight)
    J[:, CENTRE_OF_MASS] = load / total * R
    sigma = np.sqrt(np.maximum(np.diag(J @ model.covariance @ J.T), 0.0))
    return Payload(load, total, model.mass_sigma, centre, sigma)


def payload_in_mm(
    model: GravityModel, R_ES: ArrayLike, sensor_at: Sequence[float], sensor_body: Sequence[float]
) -> Payload:
    """
    Return the same for what people say: millimetres.

    Parameters
    ----------
    model : GravityModel
    R_ES : array_like (3, 3)
        Orientation of the sensor on the flange.
    sensor_at : (3,)
        The sensor's origin in E, mm.
    sensor_body : (4,)
        Mass of the sensor with its adapters, kg, and its centre of mass in E, mm.

    Raises
    ------
    InputError
        As `payload_of`.
    """
    mass, *centre = sensor_body
    return payload_of(
        model, R_ES, [1e-3 * each for each in sensor_at], mass, [1e-3 * each for each in centre]
    )

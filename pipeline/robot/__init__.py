"""Robot arms as kinematics, by MuJoCo: flange pose, Jacobian, limits, and clear configurations to visit."""

from pipeline.robot.clearance import Clearance, ClearanceCheck
from pipeline.robot.description import Capsule, Joint, RobotDescription
from pipeline.robot.known import ELFIN3, ROBOTS
from pipeline.robot.robot import Robot

__all__ = ["ELFIN3", "ROBOTS", "Capsule", "Clearance", "ClearanceCheck", "Joint", "Robot", "RobotDescription"]

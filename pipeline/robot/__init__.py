"""Robot arms as kinematics, by MuJoCo: flange pose, Jacobian, limits, and clear configurations to visit."""

from contactbench.pipeline.robot.clearance import Clearance, ClearanceCheck
from contactbench.pipeline.robot.robot import Robot
from contactbench.pipeline.robot.robots import ELFIN3, ROBOTS, Capsule, Joint, RobotDescription

__all__ = ["ELFIN3", "ROBOTS", "Capsule", "Clearance", "ClearanceCheck", "Joint", "Robot", "RobotDescription"]

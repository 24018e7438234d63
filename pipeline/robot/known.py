"""The robot arms that contactbench knows.

Lengths, limits and masses are the manufacturer's published figures. Where they are printed as 1.5708 or
3.1416 the exact multiple of π is meant; rounding would move the flange by up to 10 µm.
"""

from math import pi

from pipeline.robot.description import Capsule, Joint, RobotDescription

# Hans Robot Elfin3. The chain places every joint frame on the intersection of the axes, so the frames of
# J1-J2, J3-J4 and J4-J5-J6 share origins and the last three joints are a spherical wrist.
_ELFIN3_JOINTS = (
    Joint("J1", (0.0, 0.0, 0.1925), (0.0, 0.0, 0.0), -3.14, 3.14, 1.57, 104.0, 1.7683),
    # One published table allows J2 1.57 rad/s; the slower figure is the safe one.
    Joint("J2", (0.0, 0.0, 0.0), (pi / 2, 0.0, 0.0), -2.35, 2.35, 1.27, 104.0, 1.4143),
    Joint("J3", (0.0, 0.266, 0.0), (pi, 0.0, pi / 2), -2.61, 2.61, 1.57, 69.0, 1.2481),
    Joint("J4", (0.0, 0.0, 0.0), (pi / 2, 0.0, pi / 2), -3.14, 3.14, 1.57, 69.0, 1.1138),
    Joint("J5", (0.0, 0.0, 0.324), (-pi / 2, 0.0, 0.0), -2.56, 2.56, 1.57, 34.0, 0.9324),
    Joint("J6", (0.0, 0.0, 0.0), (pi / 2, 0.0, 0.0), -3.14, 3.14, 1.57, 34.0, 0.2888),
)

# The links do not lie on the chain: the upper arm runs 105 mm beside it, and the forearm leaves it on the way
# to the wrist. Centre lines follow the published faces of the joints and centres of mass; the radii are
# estimates, rounded up from the published radii of gyration. No outline drawing stands behind them.
_ELFIN3_CAPSULES = (
    Capsule("base", 0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.1925), 0.08),  # with the shoulder, which J1 turns
    Capsule("upper arm", 2, (0.0, 0.0, 0.105), (0.0, 0.266, 0.105), 0.06),
    Capsule("elbow", 3, (0.0, 0.0, 0.0), (0.101, 0.0, 0.0), 0.07),
    Capsule("forearm", 4, (0.0, 0.0, 0.101), (0.0, -0.1, 0.324), 0.06),
    Capsule("wrist", 5, (0.0, 0.0, 0.0), (0.0, -0.096, 0.0), 0.06),
    Capsule("hand", 6, (0.0, 0.0, 0.096), (0.0, 0.0, 0.155), 0.05),
)

ELFIN3 = RobotDescription(
    name="elfin3",
    joints=_ELFIN3_JOINTS,
    flange_xyz=(0.0, 0.0, 0.155),
    capsules=_ELFIN3_CAPSULES,
    # The upper arm turns beside the base, the hand turns beside the forearm.
    never_touch=(("base", "upper arm"), ("forearm", "hand")),
)

ROBOTS = {ELFIN3.name: ELFIN3}

"""The robot arms that contactbench knows.

Lengths, limits and masses are the manufacturer's published figures. Where they are printed as 1.5708 or
3.1416 the exact multiple of π is meant; rounding would move the flange by up to 10 µm.
"""

from math import pi

from contactbench.pipeline.robot.description import Capsule, Joint, RobotDescription, Triple

# Hans Robot Elfin3. The chain places every joint frame on the intersection of the axes, so the frames of
# J1-J2, J3-J4 and J4-J5-J6 share origins and the last three joints are a spherical wrist.
#
# Centres of mass and inertias (scaled by mass) are those of an earlier revision of the published description,
# the last one whose joint frames are these; its masses are up to 27 % larger. Rotors and gears are in none.
_ACCELERATION = 12.56  # rad/s², of every joint


def _joint(
    name: str,
    origin_xyz: Triple,
    origin_rpy: Triple,
    limits: tuple[float, float, float],
    mass: float,
    centre_mm: Triple,
    inertia_gm2: tuple[float, float, float, float, float, float],
) -> Joint:
    """Give a joint that turns as far to either side; limits: angle (rad), speed (rad/s), torque (N·m)."""
    most, velocity, effort = limits
    x, y, z = (1e-3 * value for value in centre_mm)
    xx, yy, zz, xy, xz, yz = (1e-3 * value for value in inertia_gm2)
    return Joint(
        name,
        origin_xyz,
        origin_rpy,
        -most,
        most,
        velocity,
        effort,
        mass,
        acceleration=_ACCELERATION,
        centre_xyz=(x, y, z),
        inertia=(xx, yy, zz, xy, xz, yz),
    )


# fmt: off
_ELFIN3_JOINTS = (
    _joint("J1", (0.0, 0.0, 0.1925), (0.0, 0.0, 0.0), (3.14, 1.57, 104.0), 1.7683,
           (0.0, -4.0, -29.0), (5.295, 4.702, 2.896, -0.001, 0.0, 1.020)),
    # One published table allows J2 1.57 rad/s; the slower figure is the safe one.
    _joint("J2", (0.0, 0.0, 0.0), (pi / 2, 0.0, 0.0), (2.35, 1.27, 104.0), 1.4143,
           (0.0, 116.4, 107.6), (11.720, 0.943, 12.152, 0.002, 0.0, 0.520)),
    _joint("J3", (0.0, 0.266, 0.0), (pi, 0.0, pi / 2), (2.61, 1.57, 69.0), 1.2481,
           (26.2, 0.0, -3.4), (1.633, 3.014, 2.624, 0.0, -0.573, -0.001)),
    _joint("J4", (0.0, 0.0, 0.0), (pi / 2, 0.0, pi / 2), (3.14, 1.57, 69.0), 1.1138,
           (0.0, -60.0, 203.8), (7.169, 5.863, 2.296, 0.0, 0.0, 2.083)),
    _joint("J5", (0.0, 0.0, 0.324), (-pi / 2, 0.0, 0.0), (2.56, 1.57, 34.0), 0.9324,
           (0.0, -22.0, -3.1), (1.756, 1.062, 1.518, 0.0, 0.0, 0.331)),
    _joint("J6", (0.0, 0.0, 0.0), (pi / 2, 0.0, 0.0), (3.14, 1.57, 34.0), 0.2888,
           (0.0, -0.3, 128.9), (0.145, 0.148, 0.258, 0.0, 0.0, 0.0)),
)
# fmt: on

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

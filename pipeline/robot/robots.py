"""The robot arms that contactbench knows.

Lengths, limits and masses are the manufacturer's published figures. Where they are printed as 1.5708 or
3.1416 the exact multiple of π is meant; rounding would move the flange by up to 10 µm.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.errors import InputError, arg

Triple = tuple[float, float, float]

_BALL_M = 0.1  # of the ball that stands in for a link whose inertia is not known
TOOL = "tool"  # the capsule that a clearance check adds; no link may be called that


@dataclass(frozen=True)
class Joint:
    """One revolute joint; it turns about the z axis of its own frame.

    Raises
    ------
    InputError
        A number is not finite, the limits are in the wrong order, a speed, acceleration, torque or mass is not
        positive, or no body has such an inertia.
    """

    name: str  # What messages call it
    # (3,) origin of the joint frame in the frame of the joint before it (the first: in the base frame B), m
    origin_xyz: Triple
    # (3,) its rotation there: turns about the fixed x, then y, then z axis, rad (the convention of URDF)
    origin_rpy: Triple
    # Joint limits, rad
    lower: float
    upper: float
    velocity: float  # Largest speed, rad/s
    effort: float  # Largest torque, N·m
    child_mass: float  # Mass of the link that the joint moves, kg
    acceleration: float = np.inf  # Largest acceleration, rad/s²; inf where none is known
    centre_xyz: Triple = (0.0, 0.0, 0.0)  # (3,) centre of that mass in the joint's frame, m
    # (6,) of that mass about its centre, along the axes of the joint's frame: xx, yy, zz, xy, xz, yz, kg·m².
    # Left out, a ball of 0.1 m.
    inertia: tuple[float, float, float, float, float, float] | None = None

    def __post_init__(self) -> None:
        where = f"joint {self.name}"
        _refuse_triples(
            where, origin_xyz=self.origin_xyz, origin_rpy=self.origin_rpy, centre_xyz=self.centre_xyz
        )
        if not (np.isfinite([self.lower, self.upper]).all() and self.lower < self.upper):
            raise InputError(
                f"{arg(where)}: limits must be finite with lower < upper, not {arg(self.lower)} .. {arg(self.upper)}"
            )
        _refuse_not_positive(where, velocity=self.velocity, effort=self.effort, child_mass=self.child_mass)
        if not self.acceleration > 0:  # so that NaN is refused; inf says that none is known
            raise InputError(f"{arg(where)}: acceleration must be above 0, not {arg(self.acceleration)!r}")
        if self.inertia is not None:
            _refuse_inertia(where, self.inertia)

    @property
    def inertia_matrix(self) -> NDArray[np.float64]:
        """(3, 3) inertia of the link about its centre of mass, axes of the joint's frame, kg·m²."""
        if self.inertia is None:
            return 0.4 * self.child_mass * _BALL_M**2 * np.eye(3)
        xx, yy, zz, xy, xz, yz = self.inertia
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


@dataclass(frozen=True)
class Capsule:
    """A link's envelope: every point nearer than `radius` to a line segment fixed in the link.

    Raises
    ------
    InputError
        A number is not finite, the ends coincide, or the radius is not positive.
    """

    name: str  # What messages call it
    body: int  # 0 for the base, otherwise the number (from 1) of the joint that moves it
    # each (3,): Ends of the segment in the frame of that joint (the base: in B), m. They must differ.
    start_xyz: Triple
    end_xyz: Triple
    radius: float  # m

    def __post_init__(self) -> None:
        where = f"capsule {self.name}"
        _refuse_triples(where, start_xyz=self.start_xyz, end_xyz=self.end_xyz)
        _refuse_not_positive(where, radius=self.radius)
        if self.start_xyz == self.end_xyz:
            raise InputError(
                f"{arg(where)}: start_xyz and end_xyz must differ, both are {arg(self.start_xyz)}"
            )


@dataclass(frozen=True)
class RobotDescription:
    """A serial arm of revolute joints.

    Raises
    ------
    InputError
        No joint, a name twice, a capsule on a joint that is not there, or a pair of unknown capsules.
    """

    name: str  # The arm's name
    joints: tuple[Joint, ...]  # From the base to the flange
    # each (3,): The flange frame E in the frame of the last joint; m, rad, convention as in `Joint`
    flange_xyz: Triple
    flange_rpy: Triple = (0.0, 0.0, 0.0)
    # Envelope of the links, for clearance alone: kinematics never look at it
    capsules: tuple[Capsule, ...] = ()
    # Capsules that overlap or come close by construction, though the links themselves cannot meet. Pairs on
    # the same link or on neighbouring links need no entry. `TOOL` stands for the tool.
    never_touch: tuple[tuple[str, str], ...] = ()

    def __post_init__(self) -> None:
        where = f"robot {self.name}"
        if not self.joints:
            raise InputError(f"{arg(where)}: at least one joint is needed")
        _refuse_triples(where, flange_xyz=self.flange_xyz, flange_rpy=self.flange_rpy)
        _refuse_twice(where, [joint.name for joint in self.joints])
        _refuse_twice(where, [capsule.name for capsule in self.capsules] + [TOOL])
        for capsule in self.capsules:
            if not 0 <= capsule.body <= len(self.joints):
                raise InputError(
                    f"{arg(where)}: capsule {arg(capsule.name)} sits on body {arg(capsule.body)}, "
                    f"but bodies run from 0 to {arg(len(self.joints))}"
                )
        unknown = {name for pair in self.never_touch for name in pair} - {c.name for c in self.capsules}
        unknown.discard(TOOL)
        if unknown:
            raise InputError(
                f"{arg(where)}: never_touch names no capsule of this arm: {arg(', '.join(sorted(unknown)))}"
            )


def joint_angles(
    description: RobotDescription, q: ArrayLike, *, where: str = "", ndim: int | None = 1
) -> NDArray[np.float64]:
    """Joint angles as an array, refused unless they are finite numbers for this arm.

    Parameters
    ----------
    description : RobotDescription
        The arm, with n joints.
    q : (..., n) array_like
        Joint angles, rad; limits are not looked at.
    where : str
        Begins the message, such as "poses.csv, line 3".
    ndim : int, optional
        How many axes to insist on; None takes any.

    Returns
    -------
    (..., n) array
        The angles.

    Raises
    ------
    InputError
        The shape is wrong or a number is not finite.
    """
    angles = np.asarray(q, dtype=np.float64)
    n = len(description.joints)
    where = f"{where}: " if where else ""
    if angles.shape[-1:] != (n,) or ndim not in {None, angles.ndim}:
        wanted = {1: f"({n},)", 2: f"(m, {n})"}.get(ndim or 0, f"(..., {n})")
        raise InputError(
            f"{arg(where)}joint angles of {arg(description.name)} have the shape {arg(wanted)}, not {arg(angles.shape)}"
        )
    if not np.isfinite(angles).all():
        raise InputError(f"{arg(where)}joint angles must be finite (rad), not {arg(angles)}")
    return angles


def _refuse_triples(where: str, **fields: Triple) -> None:
    for field, value in fields.items():
        if np.shape(value) != (3,) or not np.isfinite(value).all():
            raise InputError(f"{arg(where)}: {arg(field)} must be three finite numbers, not {arg(value)!r}")


def _refuse_inertia(where: str, inertia: tuple[float, ...]) -> None:
    """Refuse what no body has: the principal moments are positive, and no one exceeds the sum of the others."""
    if np.shape(inertia) != (6,) or not np.isfinite(inertia).all():
        raise InputError(f"{arg(where)}: inertia must be six finite numbers, not {arg(inertia)!r}")
    xx, yy, zz, xy, xz, yz = inertia
    least, middle, most = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if least <= 0 or most > (least + middle) * (1 + 1e-9):
        raise InputError(
            f"{arg(where)}: the inertia {arg(inertia)!r} is physically impossible: principal moments"
            f" {arg(least):.3g}, {arg(middle):.3g}, {arg(most):.3g}"
        )


def _refuse_not_positive(where: str, **fields: float) -> None:
    for field, value in fields.items():
        if not (np.isfinite(value) and value > 0):
            raise InputError(f"{arg(where)}: {arg(field)} must be finite and above 0, not {arg(value)!r}")


def _refuse_twice(where: str, names: list[str]) -> None:
    for name, following in pairwise(sorted(names)):
        if name == following:
            raise InputError(f"{arg(where)}: the name {arg(name)} is given twice")


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

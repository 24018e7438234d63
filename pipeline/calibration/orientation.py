"""Orientations as robots and files write them, and the rotation matrices they mean."""

import re
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.robot import Robot
from contactbench.pipeline.settings import OrientationSettings

_UNIT = 0.02  # a quaternion written with two digits is this far from unit length


class Kind(StrEnum):
    """How an orientation is written."""

    QUATERNION = "quaternion"  # qw qx qy qz, or q1 to q4 in a known order
    EULER = "euler"  # three angles about axes
    ROTATION_VECTOR = message("rotation vector")  # axis times angle
    JOINTS = "joints"  # of a known robot
    MATRIX = message("rotation matrix")  # r11 to r33, row by row, or rxx to rzz in a known order


ORDERS = {Kind.QUATERNION: ("wxyz", "xyzw"), Kind.MATRIX: ("rows", "columns")}
# Of w, x, y and z, and of a matrix row by row.
_COLUMNS = {
    "wxyz": ("q1", "q2", "q3", "q4"),
    "xyzw": ("q4", "q1", "q2", "q3"),
    "rows": tuple(f"r{row}{column}" for row in "xyz" for column in "xyz"),
    "columns": tuple(f"r{column}{row}" for row in "xyz" for column in "xyz"),
}


class RowError(InputError):
    """A row that cannot be used.

    Attributes
    ----------
    row : int
        Its index, from 0.
    what : str
        What is wrong with it and the remedy, without the row.
    """

    def __init__(self, what: str, row: int) -> None:
        self.row, self.what = row, message(what)
        super().__init__(message(f"row {arg(row + 1)}: {arg(self.what)}"))


@dataclass(frozen=True)
class Convention:
    """How the numbers of an orientation are meant.

    Raises
    ------
    InputError
        There is no such order.
    """

    kind: Kind = Kind.QUATERNION
    # For Euler angles: the axes in the order in which the columns name their angles; lower case for fixed
    # axes (``xyz``: R = Rz Ry Rx), upper case for axes that turn along (``ZYX``: R = Rz Ry Rx too).
    # For columns whose names leave it open: wxyz or xyzw, what q1 to q4 are; rows or columns, what the first letter of
    # rxx to rzz names
    order: str = "xyz"
    degrees: bool = True  # Angles are in degrees, else rad
    robot: str = ""  # For joints: which robot, as in contactbench.pipeline.robot
    inverse: bool = False  # The numbers mean R_SW instead of R_WS

    def __post_init__(self) -> None:
        if self.order in ORDERS.get(self.kind, ()):
            return
        axes = self.order.lower()
        one_case = self.order in {axes, self.order.upper()}
        # Three axes, none twice in a row.
        if not one_case or not re.fullmatch(r"([xyz])(?!\1)([xyz])(?!\2)[xyz]", axes):
            raise InputError(
                f"Euler order {arg(self.order)!r}: give three axes, such as xyz (fixed axes) or ZYX"
                " (rotating axes)"
            )

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns that hold such an orientation."""
        if self.order in _COLUMNS:
            return _COLUMNS[self.order]
        joints = len(Robot.named(self.robot).lower) if self.robot else 6
        return {
            Kind.QUATERNION: ("qw", "qx", "qy", "qz"),
            Kind.EULER: ("rx", "ry", "rz"),
            Kind.ROTATION_VECTOR: ("rx", "ry", "rz"),
            Kind.JOINTS: tuple(f"j{number}" for number in range(1, joints + 1)),
            Kind.MATRIX: tuple(f"r{row}{column}" for row in "123" for column in "123"),
        }[self.kind]


def convention_of(given: OrientationSettings) -> Convention | None:
    """Return how orientations are written, from what was said of it; None: as the file's columns say.

    Raises
    ------
    InputError
        Two things were said that contradict each other, or there is no such order or robot.
    """
    robot = getattr(given, "robot", None)
    degrees, inverse = not given.radians, given.inverse
    ways = {
        "euler": given.euler,
        "rotation-vector": given.rotation_vector,
        "robot": robot,
        "components": given.components,
    }
    chosen = [f"--{name}" for name, said in ways.items() if said]
    if len(chosen) > 1:
        raise InputError(f"{arg(' and '.join(chosen))} contradict each other: give only one.")
    if given.euler:
        return Convention(Kind.EULER, order=given.euler, degrees=degrees, inverse=inverse)
    if given.components:
        kind = next(kind for kind, orders in ORDERS.items() if given.components in orders)
        return Convention(kind, order=given.components, inverse=inverse)
    if given.rotation_vector:
        return Convention(Kind.ROTATION_VECTOR, degrees=degrees, inverse=inverse)
    if robot:
        Robot.named(robot)  # an unknown name is said before the file is read
        return Convention(Kind.JOINTS, degrees=degrees, robot=robot, inverse=inverse)
    return Convention(inverse=True) if inverse else None


def rotations(values: NDArray[np.float64], convention: Convention) -> NDArray[np.float64]:
    """Return R_WS (n, 3, 3) of orientations as they are written.

    Parameters
    ----------
    values : (n, k)
        Finite; columns as `convention.columns`. Joints give the flange: then S stands for E.
    convention : Convention

    Raises
    ------
    RowError
        A quaternion is not of unit length, or a joint is outside its limits.
    InputError
        The robot is unknown.
    """
    R = _matrices(values, convention)
    return np.ascontiguousarray(R.transpose(0, 2, 1)) if convention.inverse else R


def _matrices(values: NDArray[np.float64], convention: Convention) -> NDArray[np.float64]:
    angles = np.radians(values) if convention.degrees else values
    match convention.kind:
        case Kind.QUATERNION:
            return _from_quaternions(values)
        case Kind.EULER:
            return Rotation.from_euler(convention.order, angles).as_matrix()
        case Kind.ROTATION_VECTOR:
            return Rotation.from_rotvec(angles).as_matrix()
        case Kind.JOINTS:
            return _from_joints(angles, convention.robot)
        case Kind.MATRIX:
            return _from_matrices(values.reshape(-1, 3, 3))


def _from_quaternions(values: NDArray[np.float64]) -> NDArray[np.float64]:
    lengths = np.linalg.norm(values, axis=1)
    wrong = np.flatnonzero(np.abs(lengths - 1) > _UNIT)
    if len(wrong):
        row = int(wrong[0])
        raise RowError(
            f"the quaternion has length {arg(lengths[row]):.4g}, not 1: check the columns qw, qx, qy, qz.",
            row,
        )
    return Rotation.from_quat(values[:, [1, 2, 3, 0]]).as_matrix()  # scipy puts the scalar last


def _from_matrices(R: NDArray[np.float64]) -> NDArray[np.float64]:
    off = np.abs(R @ R.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2))
    wrong = np.flatnonzero((off > _UNIT) | (np.linalg.det(R) < 0))
    if len(wrong):
        raise RowError("r11 to r33 are no rotation: check the columns and their order.", int(wrong[0]))
    return Rotation.from_matrix(R).as_matrix()


def _from_joints(q: NDArray[np.float64], name: str) -> NDArray[np.float64]:
    robot = Robot.named(name)
    for row, joints in enumerate(q):
        try:
            robot.check_joints(joints)
        except InputError as error:
            raise RowError(str(error), row) from None
    return robot.flange_rotations(q)


# ---- how numbers are written for people: with as many digits as they deserve ---------------------


# Of the units that people see no sensor resolves the billionth.
MOST_PLACES = 9


def with_sigma(value: float, sigma: float) -> tuple[str, str]:
    """Return a value and its standard deviation: two digits of that, and as many places of the value."""
    if not sigma:
        return signed(f"{value:.4f}"), "0"
    places, least = min(places_of(sigma), MOST_PLACES), 10.0**-MOST_PLACES
    spread = f"{sigma:.{places}f}" if sigma >= least else f"under {least:.{places}f}"
    return signed(f"{value:.{places}f}"), spread


def plain(value: float) -> str:
    """Return a number that is not negative, with two digits and no exponent."""
    if 0 < value < 1e-6:
        return "under 0.000001"
    return f"{value:.{places_of(value)}f}" if value else "0"


def places_of(value: float) -> int:
    """Return how many places show two digits of a number above 0."""
    return max(1 - int(f"{value:.1e}".split("e")[1]), 0)


def signed(number: str) -> str:
    """Return a number with a real minus sign, and none before zero."""
    if not number.strip("-0."):
        return number.removeprefix("-")
    return number.replace("-", "\N{MINUS SIGN}")

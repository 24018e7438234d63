"""Other meanings of the same orientations: transposed, another order, other angles."""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import permutations, product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.diagnosis.hypothesis import Hypothesis
from contactbench.pipeline.calibration.orientation import Convention, Kind, rotations
from contactbench.pipeline.errors import InputError, arg, message

VECTOR = "vector"
FIXED_ORDERS = tuple("".join(axes) for axes in permutations("xyz"))
# Orders as scipy has them, as read and as meant, whose columns are the other way round. Those that are left out make
# the same of every rotation as one of these.
COLUMNS_REVERSED = (("xyz", "ZYX"), ("xyz", "zyx"), ("XYZ", "ZYX"))
_ROUNDING = 1e-9
_PROPER = tuple(first + second + first for first, second in permutations("xyz", 2))
ORDERS = tuple(way(order) for way in (str.lower, str.upper) for order in (*FIXED_ORDERS, *_PROPER))
_SAME_RAD = 1e-3  # rad: orientations printed with four digits differ by less
# Transposed orientations are by far the most common mistake of this family, then another order of quaternions.
_OFTEN, _SOMETIMES = 20.0, 5.0


@dataclass(frozen=True, eq=False)
class RawOrientations:
    """Orientations as they were written, and how they were read.

    Raises
    ------
    InputError
        The shape does not fit the convention, or a value is not finite.
    """

    values: NDArray[np.float64]  # (n, k) one row a pose, columns as `convention.columns`
    # How the poses' R_WS were made from them; a constant rotation of the sensor in the flange may have
    # followed
    convention: Convention

    def __post_init__(self) -> None:
        values, columns = np.array(self.values, dtype=np.float64), self.convention.columns
        if values.ndim != 2 or values.shape[1] != len(columns) or not np.isfinite(values).all():
            raise InputError(
                f"RawOrientations.values: give finite numbers of shape (n, {arg(len(columns))}), columns"
                f" {arg(', '.join(columns))}, not shape {arg(values.shape)}."
            )
        object.__setattr__(self, "values", values)


class Rereadings:
    """Other meanings of the same orientations."""

    def __init__(self, R_WS: NDArray[np.float64], raw: RawOrientations | None) -> None:
        self._R_WS, self._raw = R_WS, raw
        self._mount = np.eye(3) if raw is None else _mount(R_WS, raw)
        self.not_testable: list[str] = []

    def __iter__(self) -> Iterator[Hypothesis]:
        yield self._transposed()
        kind = Kind.QUATERNION if self._raw is None else self._raw.convention.kind
        if kind is Kind.QUATERNION:
            yield from self._quaternions()
            yield from self._converted()
        else:
            yield from self._angles()

    def _transposed(self) -> Hypothesis:
        if self._raw is None:
            R_WS, inverse = self._R_WS.transpose(0, 2, 1), False
        else:
            inverse = self._raw.convention.inverse
            R_WS = self._read(replace(self._raw.convention, inverse=not inverse))
        there, here = ("R_WS", "R_SW") if inverse else ("R_SW", "R_WS")
        return Hypothesis(
            "transposed",
            message("orientations transposed"),
            message(f"The orientations are transposed ({arg(there)}, not {arg(here)})"),
            message(f"the numbers read as {arg(there)}"),
            message("Leave out --inverse.") if inverse else message("Pass --inverse, or export R_WS."),
            R_WS,
            share=_OFTEN,
        )

    def _read(self, convention: Convention) -> NDArray[np.float64]:
        assert self._raw is not None  # noqa: S101 - for the type checker; callers have seen to it
        return np.asarray(rotations(self._raw.values, convention) @ self._mount, dtype=np.float64)

    def _quaternions(self) -> Iterator[Hypothesis]:
        if self._raw is None:
            values = Rotation.from_matrix(self._R_WS).as_quat(scalar_first=True)
            convention = Convention()
        else:
            values, convention = self._raw.values, self._raw.convention
        for shift, order, read in ((1, "x, y, z, w", "w, x, y, z"), (-1, "w, x, y, z", "x, y, z, w")):
            yield Hypothesis(
                "quaternion_" + order.replace(", ", ""),
                message(f"quaternions in the order {arg(order)}"),
                message(f"The quaternions are in the order {arg(order)}, but were read as {arg(read)}"),
                message(f"the numbers read as {arg(order)}"),
                message(
                    "Correct the column names or the order of the export: contactbench expects qw, qx, qy, qz."
                ),
                rotations(np.roll(values, shift, axis=1), convention) @ self._mount,
                share=_SOMETIMES,
            )

    def _angles(self) -> Iterator[Hypothesis]:
        assert self._raw is not None  # noqa: S101
        given = self._raw.convention
        if given.kind is Kind.EULER:
            for degrees in (given.degrees, not given.degrees):
                yield self._kind(replace(given, kind=Kind.ROTATION_VECTOR, degrees=degrees))
        if given.kind is not Kind.JOINTS:
            for order in ORDERS:
                if given.kind is not Kind.EULER or order != given.order:
                    yield self._kind(replace(given, kind=Kind.EULER, order=order))
        unit, other = ("radians", "degrees") if given.degrees else ("degrees", "radians")
        try:
            R_WS = self._read(replace(given, degrees=not given.degrees))
        except InputError as error:
            self.not_testable.append(message(f"The angles cannot be {arg(unit)}: {arg(error)}"))
            return
        yield Hypothesis(
            unit,
            message(f"angles in {arg(unit)}"),
            message(f"The angles are in {arg(unit)}, but were read as {arg(other)}"),
            message(f"the numbers read as {arg(unit)}"),
            message("Pass --radians.") if given.degrees else message("Leave out --radians."),
            R_WS,
            share=_OFTEN,
        )

    def _kind(self, convention: Convention) -> Hypothesis:
        assert self._raw is not None  # noqa: S101
        given = self._raw.convention
        what, here = _meaning(convention), _meaning(given)
        if convention.kind is Kind.ROTATION_VECTOR:
            key, option, share = "rotation_vector", "--rotation-vector", _SOMETIMES
        else:
            key, option, share = f"euler_{convention.order}", f"--euler {convention.order}", 1.0
        remedy = message(f"Pass {arg(option)}.")
        if convention.degrees != given.degrees:
            unit = "degrees" if convention.degrees else "radians"
            radians = message("leave out") if convention.degrees else message("pass")
            key, what = f"{key}_{unit}", message(f"{arg(what)} in {arg(unit)}")
            remedy = message(f"Pass {arg(option)}, and {arg(radians)} --radians.")
        return Hypothesis(
            key,
            what,
            message(f"The orientations are {arg(what)}, not {arg(here)}"),
            message("that convention"),
            remedy,
            self._read(convention),
            share=share,
        )

    def _converted(self) -> Iterator[Hypothesis]:
        """Yield what an earlier program did that took angles for other angles than they were."""
        unit = message(
            "A mix-up of degrees and radians can only be tested with the angles as they were written."
        )
        self.not_testable.append(unit)
        R = self._R_WS @ self._mount.T
        inverse = self._raw is not None and self._raw.convention.inverse
        if inverse:
            R = R.transpose(0, 2, 1)
        for read, meant in product((*FIXED_ORDERS, VECTOR), repeat=2):
            if meant != read:
                again = from_angles(recovered(R, read, meant), meant)
                names = _named(meant), _named(read), _short(meant), _short(read)
                yield self._mended(f"{_slug(meant)}_read_as_{_slug(read)}", names, again, inverse)
        # The three columns the other way round. Of angles whose first axis is also the last, such as ZYZ, two sets
        # are equally plain: only the numbers themselves tell which was written.
        for read, meant in COLUMNS_REVERSED:
            long = [message(f"Euler angles in the order {arg(order)}") for order in (meant, read)]
            # The first column is read as the angle about x, whichever axis it was about.
            columns = angles_of(R, read if read.islower() else read.lower()[::-1])
            again = Rotation.from_euler(meant, columns).as_matrix()
            yield self._mended(f"columns_{meant}_read_as_{read}", (*long, long[0], read), again, inverse)

    def _mended(self, key: str, names: tuple[str, ...], R: NDArray[np.float64], inverse: bool) -> Hypothesis:
        """Return the hypothesis of a wrong conversion; `names` of what was meant and read, long and short."""
        meant, read, short_meant, short_read = names
        return Hypothesis(
            key,
            message(f"{arg(short_meant)} converted as {arg(short_read)}"),
            message(f"The orientations were made from {arg(meant)} as if they were {arg(read)}"),
            message("that conversion corrected"),
            message(f"Convert again as {arg(meant)}, or give contactbench the original angles."),
            (R.transpose(0, 2, 1) if inverse else R) @ self._mount,
        )


def _meaning(convention: Convention) -> str:
    if convention.kind is Kind.ROTATION_VECTOR:
        return message("rotation vectors")
    return message(f"Euler angles in the order {arg(convention.order)}")


def _mount(R_WS: NDArray[np.float64], raw: RawOrientations) -> NDArray[np.float64]:
    """Return the constant rotation R_ES that the sensor has in the flange of raw orientations R_WE."""
    if len(raw.values) != len(R_WS):
        raise InputError(
            f"raw has {arg(len(raw.values))} rows for {arg(len(R_WS))} poses: give the numbers behind each"
            " pose, in order."
        )
    mounts = rotations(raw.values, raw.convention).transpose(0, 2, 1) @ R_WS
    wrong = np.flatnonzero(np.abs(mounts - mounts[0]).max(axis=(1, 2)) > _SAME_RAD)
    if len(wrong):
        raise InputError(
            f"raw row {arg(wrong[0] + 1)} is not the orientation of pose {arg(wrong[0] + 1)}, unlike the"
            " other rows: give the numbers that the poses were made from, and their convention."
        )
    return np.asarray(mounts[0], dtype=np.float64)


def _named(way: str) -> str:
    if way == VECTOR:
        return message("rotation vectors")
    return message(f"Euler angles about the fixed axes {arg(', '.join(way))}")


def _short(way: str) -> str:
    return message("rotation vectors") if way == VECTOR else message(f"Euler angles {arg(way)}")


def _slug(way: str) -> str:
    return "rotation_vector" if way == VECTOR else f"euler_{way}"


def recovered(R: NDArray[np.float64], read: str, meant: str) -> NDArray[np.float64]:
    """Return the angles (n, 3) that became R when they were `read` one way but `meant` another, rad.

    Two sets of angles give the same R. Which of them was written is known by what they meant: programs write
    a middle angle within 90 degrees of zero, and rotation vectors of up to half a turn.
    """
    first = angles_of(R, read)
    if read == VECTOR:
        length = np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-12)
        second = first * (1 - 2 * np.pi / length)
    else:
        middle = "xyz".index(read[1])
        second = first + np.pi
        second[:, middle] = np.pi - first[:, middle]
        second -= 2 * np.pi * np.ceil(second / (2 * np.pi) - 0.5)
    plain = _writes(first, meant) | ~_writes(second, meant)
    return np.where(plain[:, None], first, second)


def _writes(angles: NDArray[np.float64], way: str) -> NDArray[np.bool_]:
    """Tell whether a program writes such angles (n, 3)."""
    if way == VECTOR:
        return np.asarray(np.linalg.norm(angles, axis=1) <= np.pi + _ROUNDING)
    middle = np.abs(angles[:, "xyz".index(way[1])]) <= np.pi / 2 + _ROUNDING
    return middle & (np.abs(angles) <= np.pi + _ROUNDING).all(axis=1)


def angles_of(R: NDArray[np.float64], way: str) -> NDArray[np.float64]:
    """Return three numbers (n, 3), that of each axis in its column, rad; the middle one within 90 degrees of 0."""
    if way == VECTOR:
        return Rotation.from_matrix(R).as_rotvec()
    # Where the middle angle is at its end, only the sum of the outer ones is known.
    with warnings.catch_warnings(action="ignore", category=UserWarning):
        turns: Any = Rotation.from_matrix(R)  # whose stub knows only literal orders
        angles = turns.as_euler(way)
    return np.asarray(angles[:, [way.index(axis) for axis in "xyz"]], dtype=np.float64)


def from_angles(angles: NDArray[np.float64], way: str) -> NDArray[np.float64]:
    """Return the rotations (n, 3, 3) that angles (n, 3), rad, mean one way."""
    if way == VECTOR:
        return Rotation.from_rotvec(angles).as_matrix()
    return Rotation.from_euler(way, angles[:, ["xyz".index(axis) for axis in way]]).as_matrix()

"""Conventions that people get wrong: what each would make of the same recorded poses."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from pipeline.calibration.diagnosis.conversions import FIXED_ORDERS, VECTOR, from_angles, recovered
from pipeline.calibration.model import STANDARD_GRAVITY
from pipeline.calibration.orientation import Convention, Kind, rotations
from pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

AS_DECLARED = "as_declared"

ORDERS = (*FIXED_ORDERS, *(order.upper() for order in FIXED_ORDERS))
# A re-zero needs so many poses on either side: a single one cannot be told from a bumped pose.
FEWEST_BESIDE = 2
_YAWS = (90, 180, 270)
_MILLI = 1000.0
_SAME = 1e-3  # rad: orientations printed with four digits differ by less


@dataclass(frozen=True, eq=False)
class RawOrientations:
    """Orientations as they were written, and how they were read.

    Parameters
    ----------
    values : (n, k)
        One row a pose, columns as `convention.columns`.
    convention : Convention
        How the poses' R_WS were made from them; a constant rotation of the sensor in the flange may have
        followed.

    Raises
    ------
    InputError
        The shape does not fit the convention, or a value is not finite.
    """

    values: NDArray[np.float64]
    convention: Convention

    def __post_init__(self) -> None:
        values, columns = np.array(self.values, dtype=np.float64), self.convention.columns
        if values.ndim != 2 or values.shape[1] != len(columns) or not np.isfinite(values).all():
            raise InputError(
                f"RawOrientations.values: give finite numbers of shape (n, {len(columns)}), columns"
                f" {', '.join(columns)}, not shape {values.shape}."
            )
        object.__setattr__(self, "values", values)


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """One way to read the poses.

    Attributes
    ----------
    key : str
        For programs.
    title : str
        For tables, such as "orientations transposed".
    fact : str
        What is then true, a sentence without its full stop.
    reading : str
        How to read the data then; completes "with ...".
    remedy : str
        What to do, whole sentences.
    R_WS : (n, 3, 3)
        Orientations, so read.
    factor : (6,)
        What recorded forces and torques are to be multiplied by to give N and N·m on the probe.
    change : int
        Index of the first pose with another bias; 0 when the bias never changes.
    """

    key: str
    title: str
    fact: str
    reading: str
    remedy: str
    R_WS: NDArray[np.float64]
    factor: NDArray[np.float64] = field(default_factory=lambda: np.ones(6))
    change: int = 0


def hypotheses(
    R_WS: NDArray[np.float64], raw: RawOrientations | None
) -> tuple[tuple[Hypothesis, ...], tuple[str, ...]]:
    """Return every way to read poses, as declared first, and in sentences what these data do not test.

    Parameters
    ----------
    R_WS : (n, 3, 3)
        Orientations as declared.
    raw : RawOrientations or None
        The numbers behind them.

    Raises
    ------
    InputError
        `raw` are not the numbers behind R_WS.
    """
    rereadings = _Rereadings(R_WS, raw)
    found = (
        Hypothesis(AS_DECLARED, "as declared", "The data are as declared", "the data as they are", "", R_WS),
        *rereadings,
        *_scales(R_WS),
        *_signs(R_WS),
        *_yaws(R_WS),
        *_changes(R_WS),
    )
    return found, tuple(rereadings.not_testable)


# ---- orientations ------------------------------------------------------------------------------


class _Rereadings:
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
            "orientations transposed",
            f"The orientations are transposed ({there}, not {here})",
            f"them read as {there}",
            "Leave out --inverse." if inverse else "Pass --inverse, or export R_WS.",
            R_WS,
        )

    def _read(self, convention: Convention) -> NDArray[np.float64]:
        assert self._raw is not None  # noqa: S101 - for the type checker; callers have seen to it
        return np.asarray(rotations(self._raw.values, convention) @ self._mount, dtype=np.float64)

    def _quaternions(self) -> Iterator[Hypothesis]:
        if self._raw is None:
            values, convention = _quaternions(self._R_WS), Convention()
        else:
            values, convention = self._raw.values, self._raw.convention
        for shift, order, read in ((1, "x, y, z, w", "w, x, y, z"), (-1, "w, x, y, z", "x, y, z, w")):
            yield Hypothesis(
                "quaternion_" + order.replace(", ", ""),
                f"quaternions in the order {order}",
                f"The quaternions are in the order {order}, but were read as {read}",
                f"them read as {order}",
                "Swap the columns' names or the order in which they are exported: contactbench wants qw, qx, qy, qz.",
                rotations(np.roll(values, shift, axis=1), convention) @ self._mount,
            )

    def _angles(self) -> Iterator[Hypothesis]:
        assert self._raw is not None  # noqa: S101
        given = self._raw.convention
        if given.kind is Kind.EULER:
            yield self._kind(replace(given, kind=Kind.ROTATION_VECTOR))
        if given.kind is not Kind.JOINTS:
            for order in ORDERS:
                if given.kind is not Kind.EULER or order != given.order:
                    yield self._kind(replace(given, kind=Kind.EULER, order=order))
        unit, other = ("radians", "degrees") if given.degrees else ("degrees", "radians")
        try:
            R_WS = self._read(replace(given, degrees=not given.degrees))
        except InputError as error:
            self.not_testable.append(f"The angles cannot be {unit}: {error}")
            return
        yield Hypothesis(
            unit,
            f"angles in {unit}",
            f"The angles are in {unit}, but were read as {other}",
            f"them read as {unit}",
            "Pass --radians." if given.degrees else "Leave out --radians.",
            R_WS,
        )

    def _kind(self, convention: Convention) -> Hypothesis:
        assert self._raw is not None  # noqa: S101
        what, here = _meaning(convention), _meaning(self._raw.convention)
        if convention.kind is Kind.ROTATION_VECTOR:
            key, option = "rotation_vector", "--rotation-vector"
        else:
            key, option = f"euler_{convention.order}", f"--euler {convention.order}"
        return Hypothesis(
            key,
            what,
            f"The orientations are {what}, not {here}",
            "them read so",
            f"Pass {option}.",
            self._read(convention),
        )

    def _converted(self) -> Iterator[Hypothesis]:
        """Yield what an earlier program did that took angles for other angles than they were."""
        self.not_testable.append(
            "Degrees taken for radians, or the reverse, can only be tested with the angles as they were written."
        )
        R = self._R_WS @ self._mount.T
        inverse = self._raw is not None and self._raw.convention.inverse
        if inverse:
            R = R.transpose(0, 2, 1)
        ways = (*FIXED_ORDERS, VECTOR)
        for read in ways:
            for meant in ways:
                if meant == read:
                    continue
                again = from_angles(recovered(R, read, meant), meant)
                yield Hypothesis(
                    f"{_slug(meant)}_read_as_{_slug(read)}",
                    f"{_short(meant)} converted as {_short(read)}",
                    f"The orientations were made from {_named(meant)} as if they were {_named(read)}",
                    "that conversion mended",
                    f"Convert again as {_named(meant)}, or give contactbench the angles themselves.",
                    (again.transpose(0, 2, 1) if inverse else again) @ self._mount,
                )


def _meaning(convention: Convention) -> str:
    vector = convention.kind is Kind.ROTATION_VECTOR
    return "rotation vectors" if vector else f"Euler angles in the order {convention.order}"


def _mount(R_WS: NDArray[np.float64], raw: RawOrientations) -> NDArray[np.float64]:
    """Return the constant rotation R_ES that the sensor has in the flange of raw orientations R_WE."""
    if len(raw.values) != len(R_WS):
        raise InputError(
            f"raw has {len(raw.values)} rows for {len(R_WS)} poses: give the numbers behind each pose, in order."
        )
    mounts = rotations(raw.values, raw.convention).transpose(0, 2, 1) @ R_WS
    wrong = np.flatnonzero(np.abs(mounts - mounts[0]).max(axis=(1, 2)) > _SAME)
    if len(wrong):
        raise InputError(
            f"raw row {wrong[0] + 1} is not the orientation of pose {wrong[0] + 1}, as the other rows are: give"
            " the numbers that the poses were made from, and the convention by which."
        )
    return np.asarray(mounts[0], dtype=np.float64)


def _named(way: str) -> str:
    return "rotation vectors" if way == VECTOR else f"Euler angles about the fixed axes {', '.join(way)}"


def _short(way: str) -> str:
    return "rotation vectors" if way == VECTOR else f"Euler angles {way}"


def _slug(way: str) -> str:
    return "rotation_vector" if way == VECTOR else f"euler_{way}"


def _quaternions(R: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return w, x, y, z (n, 4)."""
    return np.roll(Rotation.from_matrix(R).as_quat(), 1, axis=1)


# ---- wrenches ----------------------------------------------------------------------------------


def _factor(force: float, torque: float) -> NDArray[np.float64]:
    return np.repeat([force, torque], 3)


def _scales(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    kgf = STANDARD_GRAVITY
    for key, title, fact, force, torque in (
        ("torque_Nmm", "torques in N·mm", "Torques are in N·mm", 1, 1 / _MILLI),
        (
            "torque_1000_too_small",
            "torques 1000 times too small",
            "Torques are 1000 times too small, as if N·m had been taken for N·mm and divided once too often",
            1,
            _MILLI,
        ),
        ("force_kgf", "forces in kgf", "Forces are in kgf", kgf, 1),
        (
            "force_kgf_torque_Nmm",
            "forces in kgf with torques in N·mm",
            "Forces are in kgf and torques in N·mm",
            kgf,
            1 / _MILLI,
        ),
        (
            "force_kgf_torque_kgfm",
            "forces in kgf with torques in kgf·m",
            "Forces are in kgf and torques in kgf·m",
            kgf,
            kgf,
        ),
    ):
        what = " and ".join(
            f"{name} by {value:g}" for name, value in (("forces", force), ("torques", torque)) if value != 1
        )
        yield Hypothesis(
            key,
            title,
            fact,
            f"{what.replace(' by', ' multiplied by')}",
            f"Multiply {what}.",
            R_WS,
            _factor(force, torque),
        )


def _signs(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    remedy = "Multiply {} by -1, or set the sign in the driver."
    for key, what, factor, why in (
        (
            "wrench_negated",
            "forces and torques",
            _factor(-1, -1),
            ", as a sensor that reports the reaction has",
        ),
        ("torque_negated", "torques", _factor(1, -1), ""),
        ("force_negated", "forces", _factor(-1, 1), ""),
    ):
        yield Hypothesis(
            key,
            f"{what} with the wrong sign",
            f"The {what} have the wrong sign{why}",
            f"{what} negated",
            remedy.format(what),
            R_WS,
            factor,
        )
    for axis, name in enumerate("xyz"):
        factor = np.ones(6)
        factor[[axis, axis + 3]] = -1
        yield Hypothesis(
            f"axis_{name}_reversed",
            f"{name} axis reversed",
            f"The sensor's {name} axis is reversed",
            f"f{name} and m{name} negated",
            remedy.format(f"f{name} and m{name}"),
            R_WS,
            factor,
        )


def _yaws(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    for angle in _YAWS:
        turn = Rotation.from_euler("z", angle, degrees=True).as_matrix()
        yield Hypothesis(
            f"yaw_{angle}",
            f"sensor turned by {angle}° on the flange",
            f"The sensor is turned by {angle}° about its z axis on the flange",
            f"the orientations turned by {angle}° about the sensor's z axis",
            f"Correct the sensor's mounting: R_WS becomes R_WS · Rz({angle}°).",
            R_WS @ turn,
        )


def _changes(R_WS: NDArray[np.float64]) -> Iterator[Hypothesis]:
    for change in range(FEWEST_BESIDE, len(R_WS) - FEWEST_BESIDE + 1):
        yield Hypothesis(
            f"rezero_before_{change + 1}",
            f"re-zero before pose {change + 1}",
            f"The sensor was re-zeroed between poses {change} and {change + 1}",
            "another bias from there on",
            "Calibrate with the poses before or after it alone, and keep the sensor from re-zeroing itself.",
            R_WS,
            change=change,
        )

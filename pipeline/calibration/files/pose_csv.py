"""Poses from CSV and to CSV; the columns an orientation may come in."""

import csv
import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.orientation import ORDERS, Convention, Kind, RowError, rotations
from contactbench.pipeline.calibration.poses import PoseError, PoseSample, named
from contactbench.pipeline.calibration.stillness.blocks import SLOWEST
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.files import File
from contactbench.pipeline.robot import ROBOTS
from contactbench.pipeline.shown import Shown
from contactbench.pipeline.tables import TableError, TableReader, TableRows, Wording, open_table, read_table
from contactbench.pipeline.tables.layouts import UNITS

FORCES, TORQUES = ("fx", "fy", "fz"), ("mx", "my", "mz")
CHANNELS = (*FORCES, *TORQUES)
_FORCE_SD, _TORQUE_SD = ("sfx", "sfy", "sfz"), ("smx", "smy", "smz")
_OPTIONAL = ("t", "count", *_FORCE_SD, *_TORQUE_SD, "temperature")

# Nobody takes more poses than this; a recording has as many rows in a second.
POSE_LIMIT = 200
# Rows that are closer than this are samples: averaging a pose takes a second. A few such rows may be poses whose times
# are in minutes or hours.
_CLOSEST_POSES_S, _FEWEST_SAMPLES = 1 / SLOWEST, 50
_PEEK_BYTES = 2**20

_LONGEST_NAME = 256  # bytes; what a table takes as text

# What each column may hold, and what to call it. The bounds are those of PoseSample.
_RANGES: dict[str, tuple[float, float, str]] = {
    **dict.fromkeys(FORCES, (-1e5, 1e5, message("a force in N"))),
    **dict.fromkeys(TORQUES, (-1e5, 1e5, message("a torque in N·m"))),
    **dict.fromkeys(_FORCE_SD, (0.0, 1e5, message("a standard deviation in N"))),
    **dict.fromkeys(_TORQUE_SD, (0.0, 1e5, message("a standard deviation in N·m"))),
    "t": (-1e300, 1e300, message("a time in s")),
    "temperature": (-1e300, 1e300, message("a temperature in °C")),
    "count": (1.0, 2.0**53, message("a number of samples")),
}


class PoseFileError(TableError):
    """A file of poses that cannot be used: names the file, the line, the column, and the remedy."""


@dataclass(frozen=True, eq=False, repr=False)
class PoseTable(Shown):
    """Poses as a file has them."""

    poses: tuple[PoseSample, ...]  # One a row
    raw: NDArray[np.float64]  # (n, k) the cells of `convention.columns`, as written
    convention: Convention  # How they were read
    joints: NDArray[np.float64] | None  # (n, 6) joint angles, rad; None for other kinds of orientation
    lines: NDArray[np.int64]  # (n,) the line of each pose in the file; the header is line 1
    warnings: tuple[str, ...]  # What should make one doubt the file: sentences with a remedy
    # How the poses were found in a recording: sentences. Empty for a table of poses.
    notes: tuple[str, ...] = ()

    def facts(self) -> dict[str, str]:
        """As `Shown.facts`."""
        return {
            "poses": f"{len(self.poses)}",
            "columns": ", ".join(self.convention.columns),
            "doubts": " ".join(self.warnings),
        }


def read_poses(
    source: File | BinaryIO, convention: Convention | None = None, *, R_ES: ArrayLike | None = None
) -> PoseTable:
    """
    Read still, contact-free poses from a CSV file.

    Columns: the orientation (`convention.columns`); fx, fy, fz, mx, my, mz, the mean reading in S, N and N·m,
    with bias and weight; optional t (s), count, sfx, sfy, sfz, smx, smy, smz (standard deviation of single
    samples, N and N·m), temperature (°C), name. Cells of optional columns may be empty. Others are ignored. A row with
    an empty cell elsewhere, or with something else than a number, is left out, and the warnings tell it.

    Parameters
    ----------
    source : path or binary file
    convention : Convention, optional
        How orientations are written. Left out: quaternions, if there are no others beside them.
    R_ES : array_like (3, 3), optional
        Orientation of the sensor in the flange, where orientations or joints are those of the flange E:
        R_WS = R_WE @ R_ES. Left out: S = E.

    Raises
    ------
    PoseFileError
        The file cannot be used, or is a recording; the message names line, column and remedy.
    InputError
        R_ES is no rotation, or there is no such robot.
    """
    selection = _Selection(convention)
    rows = read_table(source, selection, _wording(convention), row_limit=POSE_LIMIT, lab=True)
    reader, chosen = selection.reader, selection.convention
    if "t" in rows.columns:
        check_unit(reader, rows.column("t"), stamps=True)
    if "t" in rows.columns and _sampled(rows.column("t")):
        what = message(
            f"this is a recording ({arg(len(rows.lines))} rows, {arg(_step_text(rows.column('t')))} apart),"
            " not a table of still poses: find the still poses with contactbench calibrate"
            " captures."
        )
        raise reader.error(what)
    _check_ranges(reader, rows)
    raw = np.column_stack([rows.column(name) for name in chosen.columns])
    R_WS = orientations_in(reader, rows, raw, chosen, R_ES)
    poses = tuple(_poses(reader, rows, R_WS))
    joints = None
    if chosen.kind is Kind.MATRIX:
        R = rotations(raw, replace(chosen, inverse=False))
        raw = Rotation.from_matrix(R).as_quat(canonical=True, scalar_first=True)
    if chosen.kind in ORDERS:
        chosen = Convention(inverse=chosen.inverse)
    if chosen.kind is Kind.JOINTS:
        joints = np.radians(raw) if chosen.degrees else raw
    warnings = (*reader.left_out(), *_warnings(chosen, raw, R_WS, rows))
    return PoseTable(poses, raw, chosen, joints, rows.lines, warnings)


def write_poses(file: Path, poses: Sequence[PoseSample]) -> None:
    """
    Write poses, so that `read_poses` gives the same ones back: R_WS to 1e-15, all else exactly.

    Orientations become unit quaternions with qw >= 0. Columns that no pose fills are left out; names lose
    the spaces around them.

    Parameters
    ----------
    file : path
        Appears as a whole; what was there stays until then.
    poses : sequence of PoseSample

    Raises
    ------
    InputError
        There are no poses, a name does not fit into a line, or the file cannot be written.
    """
    write_file(file, encode_poses(poses, str(file)), InputError, message("the poses cannot be written"))


def encode_poses(poses: Sequence[PoseSample], name: str) -> bytes:
    """Return what `write_poses` writes; `name` is what messages call it."""
    if not poses:
        raise InputError(f"{arg(name)}: there are no poses to write: capture some first.")
    quaternions = Rotation.from_matrix(np.array([pose.R_WS for pose in poses])).as_quat(canonical=True)
    rows = [
        dict(zip(("qx", "qy", "qz", "qw"), quaternion, strict=True)) | _cells(name, poses, index)
        for index, quaternion in enumerate(quaternions.tolist())
    ]
    order = ("t", *Convention().columns, *CHANNELS, *_OPTIONAL[1:], "name")
    columns = [column for column in order if any(row.get(column) is not None for row in rows)]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([row.get(column) for column in columns] for row in rows)
    return text.getvalue().encode()


# ---- recordings --------------------------------------------------------------------------------


def is_recorded_table(file: File) -> bool:
    """
    Tell by its first rows whether a CSV file is a recording of samples, not a table of still poses.

    Samples are at most 0.25 s apart, by the column t; a table of poses has at most 200 rows.

    Raises
    ------
    PoseFileError
        There are too many rows for poses, and no times by which a recording could be searched for them.
    """
    with open_table(file, PoseFileError, lab=True) as (stream, name, _):
        reader = TableReader(stream, name, _wording(None), block_bytes=_PEEK_BYTES)
        if not set(CHANNELS) <= set(reader.names):
            return False  # who reads it says what is missing
        column = "t" if "t" in reader.names else CHANNELS[0]
        reader.select((column,), allow_nan=(column,))
        values = next(iter(reader)).numbers[:, 0]
        if column == "t":
            check_unit(reader, values, stamps=len(values) <= POSE_LIMIT)
        if column == "t" and _sampled(values):
            return True
        if len(values) <= POSE_LIMIT:
            return False
        many = message(f"there are more than {arg(POSE_LIMIT)} rows, too many for a table of still poses")
        what = message(
            f"{arg(many)}. If this is a recording, add the time of each row in s as column t:"
            " contactbench calibrate fit and contactbench calibrate captures then find the still poses"
            " in it."
        )
        raise reader.error(what)


# Times since some year by their size, and times since the start by their steps: unit, and in which range they are.
_STAMPS = (("ms", 1e12, 3e12), ("us", 1e15, 3e15), ("100ns", 1e17, 2e17), ("ns", 1e18, 3e18))
_DAYS = ((3e4, 7e4), (6.9e5, 8e5))  # of Excel, since 1900; of MATLAB, since the year 0
_FASTEST_HZ, _FEWEST_STEPS = 2e4, 5


def check_unit(reader: TableReader, times: NDArray[np.float64], *, stamps: bool = False) -> None:
    """
    Refuse times (n,) of samples that are not in s, and name the unit that they look like.

    Parameters
    ----------
    reader : TableReader
    times : (n,)
    stamps : bool
        Whether times since a year alone are looked at: the rows may be poses.

    Raises
    ------
    PoseFileError, WrenchFileError
        As the reader's wording has it.
    """
    steps, known = _steps(times), times[np.isfinite(times)]
    if not len(steps):
        return
    start, step = abs(float(known[0])), float(np.median(steps))
    units = [unit for unit, least, most in _STAMPS if least < start < most]
    if not (units or stamps):
        if any(least < start < most for least, most in _DAYS) and step < 1 / 86_400:
            units = ["d"]
        elif step > _CLOSEST_POSES_S and len(steps) >= _FEWEST_STEPS:
            scales = {unit: UNITS["t"][unit] for unit in ("ms", "us", "ns")}
            units = [unit for unit, scale in scales.items() if SLOWEST <= 1 / (step * scale) <= _FASTEST_HZ]
    if units:
        what = message(
            f"column t runs from {arg(known[0]):.10g} to {arg(known[-1]):.10g} in steps of {arg(step):.3g}, which"
            f" looks like {arg(units[0])}, not s: name the column t_{arg(units[0])}, or write s."
        )
        raise reader.error(what, 1)


def _steps(times: NDArray[np.float64]) -> NDArray[np.float64]:
    steps: NDArray[np.float64] = np.abs(np.diff(times[np.isfinite(times)]))
    return steps[steps > 0]  # a controller repeats a time; a column of zeros is no time


def _sampled(times: NDArray[np.float64]) -> bool:
    """Tell whether rows with these times (n,) are samples of a recording."""
    steps = _steps(times)
    return len(steps) >= _FEWEST_SAMPLES and float(np.median(steps)) <= _CLOSEST_POSES_S


def _step_text(times: NDArray[np.float64]) -> str:
    steps = _steps(times)
    step = float(np.median(steps)) if len(steps) else 0.0
    return f"{step:.3g} s" if step >= 1 else f"{1e3 * step:.3g} ms"


# ---- orientations ------------------------------------------------------------------------------


def find_convention(reader: TableReader, convention: Convention | None) -> Convention:
    """
    Return how a table's orientations are meant: as said, or quaternions where nothing else is there.

    Raises
    ------
    PoseFileError, WrenchFileError
        As the reader's wording has it: nobody said it, and the columns leave it open.
    """
    inverse = convention == Convention(inverse=True)
    if convention is not None and not inverse:
        return convention
    ways = (
        (Convention(), message("quaternions"), ""),
        (
            Convention(Kind.EULER),
            message("angles"),
            message(
                "--euler ORDER for the angles rx, ry, rz (xyz: about the fixed x, y and z axis in turn;"
                " ZYX: about the rotating axes), --rotation-vector if they are axis times angle"
            ),
        ),
        (
            Convention(Kind.JOINTS),
            message("joints"),
            message(f"--robot NAME for the joints j1 to j6 (known: {arg(', '.join(sorted(ROBOTS)))})"),
        ),
        (Convention(Kind.MATRIX), Kind.MATRIX, ""),
        (
            Convention(order="wxyz"),
            message("quaternions"),
            message("--components wxyz if q1 is the scalar, --components xyzw if q4 is"),
        ),
        (
            Convention(Kind.MATRIX, order="rows"),
            Kind.MATRIX,
            message(
                "--components rows if rxy is in row x and column y of the matrix, --components columns if it is"
                " component y of axis x"
            ),
        ),
    )
    there = [way for way in ways if set(way[0].columns) <= set(reader.names)]
    remedies = join(message(" or "), (remedy for *_, remedy in there if remedy))
    if len(there) < 2 and not remedies:
        found = next((way[0] for way in there), Convention())  # where columns are missing, the reader says so
        return replace(found, inverse=inverse)
    if len(there) == 1:
        columns = ", ".join(there[0][0].columns)
        raise reader.error(
            message(f"columns {arg(columns)} alone do not define the orientation: pass {arg(remedies)}."), 1
        )
    if set(Convention().columns) <= set(reader.names):
        remedies += message(", or rename these columns to use qw, qx, qy, qz")
    kinds = join(message(" and as "), (kind for _, kind, _ in there))
    raise reader.error(
        message(f"the orientations are given as {arg(kinds)}: choose one. Pass {arg(remedies)}."), 1
    )


def sensor_orientations(
    values: NDArray[np.float64], convention: Convention, R_ES: ArrayLike | None = None
) -> NDArray[np.float64]:
    """
    Return R_WS (n, 3, 3) of orientations as they are written.

    Parameters
    ----------
    values : (n, k)
        Finite; columns as `convention.columns`.
    convention : Convention
    R_ES : array_like (3, 3), optional
        Sensor in flange, where the values are those of the flange.

    Raises
    ------
    RowError
        A row is no orientation.
    InputError
        R_ES is no rotation, or the robot is unknown.
    """
    R = rotations(values, convention)
    return R if R_ES is None else R @ mount_rotation(R_ES)


def orientations_in(
    reader: TableReader,
    rows: TableRows,
    values: NDArray[np.float64],
    convention: Convention,
    R_ES: ArrayLike | None,
) -> NDArray[np.float64]:
    """Return R_WS (n, 3, 3) of the rows of a table, see `sensor_orientations`; the reader's error names the line."""
    try:
        return sensor_orientations(values, convention, R_ES)
    except RowError as error:
        raise reader.error(error.what, int(rows.lines[error.row])) from None


def mount_rotation(R_ES: ArrayLike) -> NDArray[np.float64]:
    """
    Return R_ES (3, 3), checked.

    Raises
    ------
    InputError
        It is no rotation.
    """
    R = np.array(R_ES, dtype=np.float64)
    if R.shape != (3, 3) or not (np.abs(R.T @ R - np.eye(3)) < 1e-6).all() or np.linalg.det(R) < 0:
        raise InputError(
            f"R_ES must be a (3, 3) rotation, the sensor's axes in the flange as columns, not {arg(R.tolist())}"
        )
    return R


# ---- reading -----------------------------------------------------------------------------------


def _wording(convention: Convention | None) -> Wording:
    return Wording(
        header=",".join(((convention or Convention()).columns) + CHANNELS),
        rows="poses",
        meaning=message(
            "mean readings with bias and weight, forces in N, torques in N·m, in the sensor frame S"
        ),
        not_finite=message("complete or remove the pose."),
        text="a name",
        error=PoseFileError,
    )


class _Selection:
    """Chooses the columns, and remembers whose they are."""

    reader: TableReader

    def __init__(self, convention: Convention | None) -> None:
        self.convention = convention or Convention()
        self._given = convention

    def __call__(self, reader: TableReader) -> None:
        self.reader = reader
        self.convention = find_convention(reader, self._given)
        for group in (_FORCE_SD, _TORQUE_SD):
            there = [name in reader.names for name in group]
            if any(there) and not all(there):
                missing = ", ".join(name for name, found in zip(group, there, strict=True) if not found)
                what = message(
                    f"column {arg(missing)} missing: give {arg(', '.join(group))}, or none of them."
                )
                raise reader.error(what, 1)
        reader.select(
            (*self.convention.columns, *CHANNELS),
            optional=_OPTIONAL,
            text="name" if "name" in reader.names else None,
            allow_nan=_OPTIONAL,
            leave_out=(*self.convention.columns, *CHANNELS),
        )


def _check_ranges(reader: TableReader, rows: TableRows) -> None:
    for column in rows.columns:
        if column not in _RANGES:
            continue
        least, most, what = _RANGES[column]
        values = rows.column(column)
        wrong = (values < least) | (values > most)  # NaN is an empty cell
        if column == "count":
            wrong |= np.isfinite(values) & (values != np.rint(values))
            what += ", whole"
        if wrong.any():
            row = int(np.argmax(wrong))
            problem = message(
                f"column {arg(column)} holds {arg(values[row]):g}, but {arg(what)} lies between"
                f" {arg(least):g} and {arg(most):g}"
            )
            raise reader.error(message(f"{arg(problem)}: correct or remove the row."), int(rows.lines[row]))


def _poses(reader: TableReader, rows: TableRows, R_WS: NDArray[np.float64]) -> Iterator[PoseSample]:
    def cells(*names: str) -> list[list[float]]:
        return np.column_stack([rows.column(name) for name in names]).tolist()  # type: ignore[no-any-return]

    forces, torques = cells(*FORCES), cells(*TORQUES)
    extra = {name: rows.column(name).tolist() for name in _OPTIONAL if name in rows.columns}
    for index, line in enumerate(rows.lines.tolist()):
        row = {name: values[index] for name, values in extra.items() if not np.isnan(values[index])}
        name = "" if rows.text is None else _name(rows.text[index])
        try:
            yield PoseSample(
                R_WS[index],
                np.array(forces[index]),
                np.array(torques[index]),
                count=int(row.get("count", 1)),
                force_sd=_three(reader, row, _FORCE_SD, line),
                torque_sd=_three(reader, row, _TORQUE_SD, line),
                temperature=row.get("temperature"),
                time=row.get("t"),
                name=name,
            )
        except PoseError as error:
            raise reader.error(str(error).removeprefix(f"{name or 'pose'}: "), line) from None


def _three(
    reader: TableReader, row: dict[str, float], group: tuple[str, ...], line: int
) -> NDArray[np.float64] | None:
    given = [row[name] for name in group if name in row]
    if len(given) in {0, 3}:
        return np.array(given) if given else None
    empty = next(name for name in group if name not in row)
    raise reader.error(
        message(f"column {arg(empty)} is empty: give {arg(', '.join(group))}, or none of them."), line
    )


def _name(cell: bytes) -> str:
    text = cell.decode()
    return next(csv.reader([text]))[0].strip() if text.startswith('"') else text.strip()


# ---- doubts ------------------------------------------------------------------------------------

_LONGEST_ARM = 5.0  # m: no weight hangs this far from its sensor; in N·mm one of 50 mm looks like 50 m
_FELT_TORQUE = 0.1  # below, it is noise
_SAME = np.radians(0.5)
_FULL_TURN = 2 * np.pi


def _warnings(
    convention: Convention, raw: NDArray[np.float64], R_WS: NDArray[np.float64], rows: TableRows
) -> Iterator[str]:
    if convention.kind is not Kind.QUATERNION:
        yield from _angle_warnings(raw, degrees=convention.degrees)
    wrenches = np.column_stack([rows.column(name) for name in CHANNELS])
    # The bias is the same in all poses: what changes with them is the weight and its torque.
    moved = np.abs(wrenches - wrenches.mean(axis=0))
    force, torque = np.linalg.norm(moved[:, :3], axis=1).max(), np.linalg.norm(moved[:, 3:], axis=1).max()
    if torque > max(_LONGEST_ARM * force, _FELT_TORQUE):
        yield message(
            f"Between poses the torques change by up to {arg(torque):.3g}, but the forces by only"
            f" {arg(force):.3g} N: if the torques are in N·mm, divide them by 1000."
        )
    cosines = (np.einsum("iab,ab->i", R_WS, R_WS[0]) - 1) / 2
    if len(R_WS) > 1 and (cosines > np.cos(_SAME)).all():
        yield message(
            "All poses have the same orientation to within half a degree. Turn the wrist between"
            " poses, or check that the orientation columns are the ones the robot updates."
        )
    yield from _repeats(np.column_stack([raw, wrenches]), rows.lines)
    yield from _copied(R_WS, wrenches, rows.lines)
    if "t" in rows.columns:
        yield from _time_warnings(rows.column("t"), rows.lines)
    if rows.text is not None:
        yield from _name_warnings([_name(cell) for cell in rows.text.tolist()], rows.lines)


def _copied(
    R_WS: NDArray[np.float64], wrenches: NDArray[np.float64], lines: NDArray[np.int64]
) -> Iterator[str]:
    """Name a reading that is its neighbour's to the last digit, though the sensor was turned between the two."""
    turned = (np.einsum("iab,iab->i", R_WS[1:], R_WS[:-1]) - 1) / 2 < np.cos(_SAME)
    again = np.flatnonzero(turned & (wrenches[1:] == wrenches[:-1]).all(axis=1))
    if len(again):
        one, other = lines[again[0] : again[0] + 2].tolist()
        more = message(f", and {arg(len(again) - 1)} more such pairs") if len(again) > 1 else ""
        yield message(
            f"Lines {arg(one)} and {arg(other)} have exactly the same reading although the sensor was turned"
            f" between them{arg(more)}: the reading was copied, or the readings are shifted by a row."
            " Correct or remove the pose."
        )


def _time_warnings(times: NDArray[np.float64], lines: NDArray[np.int64]) -> Iterator[str]:
    known = np.isfinite(times)
    yield from _disorder(message("times in column t"), times[known], lines[known])
    steps = _steps(times)
    if len(steps) and float(np.median(steps)) <= _CLOSEST_POSES_S:
        yield message(
            f"By column t the poses are {arg(_step_text(times))} apart, but a pose takes a second:"
            " write t in s. If the rows are samples of a recording, give the whole recording."
        )


def _name_warnings(names: Sequence[str], lines: NDArray[np.int64]) -> Iterator[str]:
    """Doubt the order of names that are one word with a growing number, such as pose 1, pose 2."""
    parts = [re.match(r"(\D*)(\d{1,9})", name) for name in names]
    numbers = [int(part[2]) for part in parts if part]
    if len(numbers) == len(names) and len({part[1] for part in parts if part}) == 1:
        yield from _disorder(message("numbers in column name"), np.array(numbers, dtype=np.float64), lines)


def _disorder(what: str, values: NDArray[np.float64], lines: NDArray[np.int64]) -> Iterator[str]:
    """Name the rows that break a rising order; a falling one, newest first, is an order too."""
    steps = np.diff(values)
    if (steps >= 0).all() or (steps <= 0).all():
        return
    moved = lines[values != np.sort(values)].tolist()
    shown = ", ".join(map(str, moved[:6])) + (", ..." if len(moved) > 6 else "")
    how = message("two rows are swapped") if len(moved) == 2 else message("rows were moved")
    yield message(
        f"The {arg(what)} do not increase at lines {arg(shown)}: if {arg(how)}, entirely or in some columns,"
        " restore the order. Each reading must stand beside its own orientation."
    )


def _angle_warnings(raw: NDArray[np.float64], *, degrees: bool) -> Iterator[str]:
    largest = np.abs(raw).max()
    if degrees and 0 < largest <= _FULL_TURN:
        yield message(f"No angle is larger than {arg(largest):.3g}°: if they are in rad, pass --radians.")
    if not degrees and largest > 2 * _FULL_TURN:
        yield message(
            f"Angles reach {arg(largest):.3g} rad, more than two turns: if they are in degrees, leave out --radians."
        )


def _repeats(values: NDArray[np.float64], lines: NDArray[np.int64]) -> Iterator[str]:
    first: dict[bytes, int] = {}
    again = []
    for line, row in zip(lines.tolist(), values, strict=True):
        earlier = first.setdefault(row.tobytes(), line)
        if earlier != line:
            again.append((earlier, line))
    if again:
        yield message(
            f"Rows that repeat an earlier row exactly: {arg(len(again))}; the first is line"
            f" {arg(again[0][1])}, which repeats line {arg(again[0][0])}. They count as separate poses:"
            " remove them."
        )


# ---- writing -----------------------------------------------------------------------------------


def _cells(file: str, poses: Sequence[PoseSample], index: int) -> dict[str, object]:
    pose = poses[index]
    cells: dict[str, object] = {"t": pose.time, "count": pose.count, "temperature": pose.temperature}
    for names, values in (
        (FORCES, pose.force),
        (TORQUES, pose.torque),
        (_FORCE_SD, pose.force_sd),
        (_TORQUE_SD, pose.torque_sd),
    ):
        if values is not None:
            cells.update(zip(names, values.tolist(), strict=True))
    cells["name"] = _one_line(file, poses, index) or None
    return cells


def _one_line(file: str, poses: Sequence[PoseSample], index: int) -> str:
    name = poses[index].name.strip()
    try:
        fits = len(name.encode()) <= _LONGEST_NAME and not any(mark in name for mark in "\0\r\n")
    except UnicodeEncodeError:  # half a character, which has no bytes
        fits = False
    if not fits:
        what = message(f"its name must be one line of text of at most {arg(_LONGEST_NAME)} bytes: change it.")
        raise InputError(f"{arg(file)}: {arg(ascii(named(poses, index)[:40]))}: {arg(what)}")
    return name

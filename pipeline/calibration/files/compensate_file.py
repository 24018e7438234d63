"""Take bias and weight off every reading in a recording, whatever its size, for ``locate`` to read."""

import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.calibration.calibrate import Calibration
from contactbench.pipeline.calibration.files.pose_csv import (
    CHANNELS,
    find_convention,
    mount_rotation,
    sensor_orientations,
)
from contactbench.pipeline.calibration.model import GravityModel
from contactbench.pipeline.calibration.orientation import Convention, Kind, RowError
from contactbench.pipeline.calibration.verdict import Level
from contactbench.pipeline.contact.stream import WrenchFileError, ahead, refuse_overwriting, whole_output
from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.files import Progress, unheard
from contactbench.pipeline.robot import Robot
from contactbench.pipeline.tables import BLOCK_BYTES, TableReader, TableRows, Wording, open_table
from contactbench.pipeline.tables.shortest import csv_rows

HEADER = b"t,fx,fy,fz,mx,my,mz\n"

# Encoders may read a little past a limit; an angle in the wrong unit is past it by far. rad
_PAST_LIMIT = 0.02

# The uncertainty changes as slowly as the orientation: every row of a short file, some of a long one.
_ALL_ROWS, _STRIDE = 1024, 100


@dataclass(frozen=True)
class CompensateSummary:
    """What came of a file."""

    rows: int  # Readings compensated
    # Of these, how many have empty or infinite cells, because the reading or the orientation had
    not_finite: int
    largest_force_N: float  # Largest compensated |F|, N
    # What the calibration leaves uncertain: the largest standard deviation in any direction, over the
    # orientations of the recording, N and N·m. The sensor's own noise is not in it.
    sigma_force_N: float
    sigma_torque_Nm: float
    seconds: float  # From the first byte read to the last one written
    warnings: tuple[str, ...] = ()  # What should make one doubt the result: sentences with a remedy

    @property
    def rows_per_second(self) -> float:
        """Rows per second of wall time."""
        return self.rows / max(self.seconds, 1e-9)

    def facts(self) -> dict[str, Any]:
        """Return everything as values that JSON knows."""
        return {**asdict(self), "rows_per_second": self.rows_per_second, "warnings": list(self.warnings)}


def compensate_file(
    calibration: Calibration | GravityModel,
    source: Path | BinaryIO,
    out: Path | BinaryIO,
    convention: Convention | None = None,
    *,
    allow_nan: bool = False,
    R_ES: ArrayLike | None = None,
    progress: Progress = unheard,
    block_bytes: int = BLOCK_BYTES,
) -> CompensateSummary:
    """
    Compensate every reading in a file and write a file of wrenches.

    The file is read in blocks, so that it may be larger than the memory. The output appears as a whole or
    not at all: a file that was there stays untouched until the last row is written.

    Parameters
    ----------
    calibration : Calibration or GravityModel
    source : path or binary file
        Columns t, fx, fy, fz, mx, my, mz (raw readings, S, N and N·m about the sensor origin) and those of
        the orientation at the same time, in any order; others are ignored.
    out : path or binary file
        Gets columns t, fx, fy, fz, mx, my, mz: what the tissue does to the probe. t is the text of the
        input, numbers are as ``repr`` writes them; a NaN is an empty cell.
    convention : Convention, optional
        How orientations are written. Left out: quaternions, if there are no others beside them.
    allow_nan : bool
        Pass on rows with NaN, infinity or empty cells instead of refusing the file. A reading without an
        orientation has no wrench: its cells become empty.
    R_ES : array_like (3, 3), optional
        Orientation of the sensor in the flange, where orientations or joints are those of the flange E.
    progress : callable, optional
        Called after each block with the bytes read and the size of the source (0 if that is unknown).
    block_bytes : int
        How much is read at a time. The output does not depend on it.

    Returns
    -------
    CompensateSummary

    Raises
    ------
    WrenchFileError
        The source cannot be used or the output not written; the message names file, line and column.
    InputError
        R_ES is no rotation, or there is no such robot.
    """
    refuse_overwriting(out, source)
    begin = time.perf_counter()
    mount = None if R_ES is None else mount_rotation(R_ES)
    with (
        open_table(source, WrenchFileError, lab=True) as (stream, name, size),
        whole_output(out, "wrenches") as write,
    ):
        remedy = message("remove the row, or use --allow-nan to pass it through.")
        reader = TableReader(stream, name, readings_wording(convention, remedy), block_bytes=block_bytes)
        convention = find_convention(reader, convention)
        wanted = (*CHANNELS, *convention.columns)
        reader.select(wanted, text="t", allow_nan=wanted if allow_nan else ())
        work = _Compensation(calibration, convention, mount, reader.error)
        write(HEADER)
        for _, text in ahead(reader, work):
            write(text)
            progress(reader.bytes_read, size)
    return work.summary(time.perf_counter() - begin)


def readings_wording(convention: Convention | None, not_finite: str) -> Wording:
    """Return what messages say about a table of raw readings with their orientations."""
    return Wording(
        header=",".join(("t", *CHANNELS, *(convention or Convention()).columns)),
        rows="readings",
        meaning=message("raw forces in N, torques in N·m, in the sensor frame S, and its orientation"),
        not_finite=not_finite,
        text="a time",
        error=WrenchFileError,
    )


class _Compensation:
    """The work on a block, and what it adds up to."""

    def __init__(
        self,
        calibration: Calibration | GravityModel,
        convention: Convention,
        R_ES: NDArray[np.float64] | None,
        error: Callable[[str, int], InputError],
    ) -> None:
        self._refused = ""
        if isinstance(calibration, Calibration):
            if calibration.verdict.level is Level.REFUSE:
                self._refused = join(" ", calibration.verdict.reasons)
            calibration = calibration.model
        self._model = calibration
        self._convention = convention
        self._R_ES = R_ES
        self._error = error
        self._rows = self._not_finite = 0
        self._largest_force = 0.0
        self._variances = np.zeros(2)  # of force and torque, N² and N²·m²

    def __call__(self, rows: TableRows) -> bytes:
        readings, written = rows.numbers[:, :6], rows.numbers[:, 6:]
        oriented = np.isfinite(written).all(axis=1)
        if oriented.all():
            R_WS = self._orientations(written, rows.lines)
            wrenches = self._model.compensate(R_WS, readings)
        else:
            R_WS = self._orientations(written[oriented], rows.lines[oriented])
            wrenches = np.full_like(readings, np.nan)
            wrenches[oriented] = self._model.compensate(R_WS, readings[oriented])
        self._add(wrenches, R_WS, np.flatnonzero(oriented))
        assert rows.text is not None  # noqa: S101  (the table was asked for them)
        return csv_rows(rows.text, *wrenches.T)

    def summary(self, seconds: float) -> CompensateSummary:
        sigma_force, sigma_torque = np.sqrt(self._variances).tolist()
        return CompensateSummary(
            rows=self._rows,
            not_finite=self._not_finite,
            largest_force_N=min(self._largest_force, sys.float_info.max),
            sigma_force_N=sigma_force,
            sigma_torque_Nm=sigma_torque,
            seconds=seconds,
            warnings=tuple(self._warnings()),
        )

    # ---- orientations ------------------------------------------------------------------------

    def _orientations(self, values: NDArray[np.float64], lines: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return R_WS (n, 3, 3) of finite cells."""
        if not len(values):
            return np.empty((0, 3, 3))
        try:
            if self._convention.kind is Kind.JOINTS:
                return self._from_joints(values)
            return sensor_orientations(values, self._convention, self._R_ES)
        except RowError as error:
            raise self._error(error.what, int(lines[error.row])) from None

    def _from_joints(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """As sensor_orientations, but a hair past a limit is let through: a recording cannot be taken again."""
        q = np.radians(values) if self._convention.degrees else values
        inside = self._robot.within_limits(q, margin=-_PAST_LIMIT)
        if not inside.all():
            row = int(np.argmin(inside))
            try:
                self._robot.check_joints(q[row])
            except InputError as error:
                raise RowError(str(error), row) from None
        R = self._robot.flange_rotations(q)
        if self._convention.inverse:
            R = R.transpose(0, 2, 1)
        return R if self._R_ES is None else R @ self._R_ES

    @cached_property
    def _robot(self) -> Robot:
        return Robot.named(self._convention.robot)

    # ---- counting ----------------------------------------------------------------------------

    def _add(
        self, wrenches: NDArray[np.float64], R_WS: NDArray[np.float64], places: NDArray[np.intp]
    ) -> None:
        """Count wrenches (n, 6), and the uncertainty at orientations R_WS (m, 3, 3) of the rows `places`."""
        numbers = self._rows + places
        # Chosen by their number in the file, so that the answer does not depend on the blocks.
        chosen = R_WS[(numbers < _ALL_ROWS) | (numbers % _STRIDE == 0)]
        if len(chosen):
            C = self._model.wrench_covariance(chosen)
            both = np.array([C[:, :3, :3], C[:, 3:, 3:]])
            self._variances = np.maximum(self._variances, np.linalg.eigvalsh(both)[..., -1].max(axis=1))
        finite = np.isfinite(wrenches).all(axis=1)
        with np.errstate(over="ignore", invalid="ignore"):
            sizes = np.hypot(np.hypot(wrenches[:, 0], wrenches[:, 1]), wrenches[:, 2])
        self._largest_force = max(self._largest_force, float(sizes.max(where=finite, initial=0.0)))
        self._not_finite += int(np.count_nonzero(~finite))
        self._rows += len(wrenches)

    def _warnings(self) -> Iterator[str]:
        if self._refused:
            yield message(
                f"The calibration was refused, so do not trust these wrenches. {arg(self._refused)}"
            )
        if self._not_finite:
            yield message(
                f"{arg(self._not_finite)} of {arg(self._rows)} rows have empty or infinite cells; they were"
                " passed through (--allow-nan)."
            )

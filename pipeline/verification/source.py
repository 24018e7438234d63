"""Recordings of touches as arrays: compensated wrenches, and the orientation at each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.calibration.files.compensate_file import readings_wording
from contactbench.pipeline.calibration.files.pose_csv import (
    find_convention,
    orientations_in,
    sensor_orientations,
)
from contactbench.pipeline.calibration.orientation import Convention
from contactbench.pipeline.contact.following import FollowedZero
from contactbench.pipeline.contact.wrench_csv import CHANNELS, WrenchFileError
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.files import File
from contactbench.pipeline.kernel import Zero
from contactbench.pipeline.tables import TableReader, TableRows, Wording, open_table, read_table

_OVERRANGE = 1  # the flag of the samples' status
_GAP_S, _MOST_BACK = 0.5, 0.05
_BLOCK_ROWS = 65_536
_REFERENCE = Wording(header="t,force", rows="forces", meaning=message("time in s, reference force in N"))


@dataclass(frozen=True, eq=False)
class TouchRecording:
    """What a recording holds; n samples."""

    times: NDArray[np.float64]  # (n,) s
    wrenches: NDArray[np.float64]  # (n, 6) S, N and N·m; as read, or compensated
    R_WS: NDArray[np.float64]  # (n, 3, 3)
    saturated: NDArray[np.bool_]  # (n,)
    warnings: tuple[str, ...] = ()
    zero: Zero | None = None  # what was taken off at the end, where the zero follows

    def compensated(self, model: GravityModel, *, follow: bool = False) -> TouchRecording:
        """Return it without bias and weight; `follow`: and without what is read between touches."""
        wrenches = model.compensate(self.R_WS, self.wrenches)
        if not follow:
            return replace(self, wrenches=wrenches)
        zero = FollowedZero()
        followed = wrenches - zero.taken(wrenches, self.R_WS, self.times)
        return replace(
            self, wrenches=followed, zero=zero.at(float(self.times[-1]) if len(self.times) else 0.0)
        )

    def zeros_at(self, model: GravityModel, moments: Sequence[float]) -> list[Zero]:
        """Return what a zero that follows takes off a raw recording at some moments, s, in their order."""
        zero, untaken, found, begin = FollowedZero(), model.compensate(self.R_WS, self.wrenches), [], 0
        for moment, end in zip(moments, np.searchsorted(self.times, moments), strict=True):
            zero.taken(untaken[begin:end], self.R_WS[begin:end], self.times[begin:end])
            found.append(zero.at(moment))
            begin = end
        return found


def read_touch_recording(
    file: File, convention: Convention | None = None, R_ES: ArrayLike | None = None
) -> TouchRecording:
    """
    Read a recording: MCAP, or CSV with t,fx,fy,fz,mx,my,mz (raw) and orientations.

    Parameters
    ----------
    file : path
    convention : Convention, optional
        How orientations in a CSV file are written; quaternions if left out.
    R_ES : (3, 3), optional
        Sensor in flange, where the orientations are those of the flange.

    Raises
    ------
    InputError
        The file cannot be used; the message says where and why.
    """
    if file.suffix.lower() == ".mcap":
        return _from_mcap(file, R_ES)
    return _from_csv(file, convention, R_ES)


def clock_sentences(times: NDArray[np.float64], name: str) -> Iterator[str]:
    """
    Yield sentences about a clock, s, that goes back or leaves gaps.

    Raises
    ------
    InputError
        So many samples are out of order that this is no recording.
    """
    latest = np.maximum.accumulate(times) if len(times) else times
    back = int(np.count_nonzero(times[1:] <= latest[:-1]))
    if back > _MOST_BACK * len(times):
        raise InputError(
            f"{arg(name)}: {arg(back):,} of {arg(len(times)):,} samples are not later than an earlier row: sort"
            " them by time, or record again; t must be seconds of one clock."
        )
    steps = np.diff(latest)
    gaps = steps[steps > _GAP_S]
    if back:
        yield message(
            f"The clock goes back: {arg(back):,} samples that are not later than an earlier one are left out."
        )
    if len(gaps):
        yield message(
            f"The recording has {arg(len(gaps)):,} gaps, the longest of {arg(gaps.max()):.1f} s: a touch"
            " ends where a gap begins."
        )


def read_reference(file: File) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Read times, s, and forces, N, of a reference sensor: CSV with t,force.

    Raises
    ------
    InputError
        The file cannot be used.
    """

    def select(reader: TableReader) -> None:
        reader.select(("t", "force"))

    rows = read_table(file, select, _REFERENCE, row_limit=10_000_000, lab=True)
    order = np.argsort(rows.numbers[:, 0], kind="stable")
    return rows.numbers[order, 0], np.abs(rows.numbers[order, 1])


def _from_mcap(file: File, R_ES: ArrayLike | None) -> TouchRecording:
    from contactbench.pipeline.recording import read_recording
    from contactbench.pipeline.recording.convert import poses_at

    recording = read_recording(file)
    track, flange = recording.pair(file)
    clipped = (track.status & _OVERRANGE) != 0
    kept = track.usable | (clipped & np.isfinite(track.wrenches).all(axis=1) & ~track.frozen)
    R_WS = np.empty((len(kept), 3, 3))
    count = 0
    for begin in range(0, len(kept), _BLOCK_ROWS):
        rows = slice(begin, begin + _BLOCK_ROWS)
        poses, there = poses_at(flange, track.times[rows])
        kept[rows] &= there
        if found := int(np.count_nonzero(kept[rows])):
            R_WS[count : count + found] = sensor_orientations(poses[kept[rows], :4], Convention(), R_ES)
            count += found
    if not count:
        raise InputError(f"{arg(file)}: no reading has a pose: record the robot together with the sensor.")
    said = list(recording.warnings)
    if lost := len(kept) - count:
        said.append(
            message(f"{arg(lost):,} readings left out: without a pose, or flagged as bad by the device.")
        )
    return TouchRecording(
        track.times[kept],
        track.wrenches[kept],
        R_WS[:count],
        clipped[kept],
        (*said, *clock_sentences(track.times[kept], str(file))),
    )


def _from_csv(file: File, convention: Convention | None, R_ES: ArrayLike | None) -> TouchRecording:
    wording = readings_wording(convention, message("remove the row."))
    parts: list[TouchRecording] = []
    with open_table(file, WrenchFileError, lab=True) as (stream, name, _):
        reader = TableReader(stream, name, wording)
        how = find_convention(reader, convention)
        reader.select(("t", *CHANNELS, *how.columns), optional=("status",))
        parts.extend(_block(rows, how, R_ES, reader) for rows in reader)
    times = np.concatenate([part.times for part in parts])
    return TouchRecording(
        times,
        np.concatenate([part.wrenches for part in parts]),
        np.concatenate([part.R_WS for part in parts]),
        np.concatenate([part.saturated for part in parts]),
        tuple(clock_sentences(times, str(file))),
    )


def _block(rows: TableRows, how: Convention, R_ES: ArrayLike | None, reader: TableReader) -> TouchRecording:
    numbers, width = rows.numbers, 7 + len(how.columns)
    R_WS = orientations_in(reader, rows, numbers[:, 7:width], how, R_ES)
    clipped = np.zeros(len(numbers), dtype=bool)
    if "status" in rows.columns:
        clipped = (rows.column("status").astype(np.int64) & _OVERRANGE) != 0
    return TouchRecording(numbers[:, 0].copy(), numbers[:, 1:7].copy(), R_WS, clipped)

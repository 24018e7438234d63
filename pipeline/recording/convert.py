"""Recordings as CSV, for everything that reads tables, and as NPZ, for NumPy."""

from __future__ import annotations

import json
import os
from contextlib import contextmanager
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from contactbench.pipeline.devices import pose_track
from contactbench.pipeline.durable import scratch_beside, sync_folder
from contactbench.pipeline.recording.errors import RecordingError
from contactbench.pipeline.tables.shortest import csv_rows

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from contactbench.pipeline.recording.reader import Recording
    from contactbench.pipeline.recording.tracks import FlangeTrack, WrenchTrack

_WRENCH_COLUMNS = ("t", "fx", "fy", "fz", "mx", "my", "mz")
_POSE_COLUMNS = ("qw", "qx", "qy", "qz", "px", "py", "pz")
_BLOCK_ROWS = 50_000

# Poses are asked for at 50 Hz or more; over a longer gap the flange may have been anywhere.
LONGEST_GAP = pose_track.LONGEST_GAP_S


def write_csv(file: Path, recording: Recording, topic: str | None = None) -> tuple[str, ...]:
    """
    Write the samples of one topic as a table.

    A wrench topic gives t,fx,fy,fz,mx,my,mz (s, N, N·m), status, sequence and temperature where there are any,
    and, if there is exactly one flange, its pose at the same moments: qw,qx,qy,qz (R_BE) and px,py,pz (m),
    interpolated. Readings that are no measurements, or that have no pose beside them, are left out. A flange
    topic gives t, its pose, and joints j1.. in degrees.

    Parameters
    ----------
    file : path
        Appears as a whole; what was there stays until then.
    recording : Recording
    topic : str, optional
        Left out: the wrenches if there is one sensor, else the one flange.

    Returns
    -------
    tuple of str
        What was left out: sentences.

    Raises
    ------
    RecordingError
        There is no such topic, the choice is not clear, no row is left, or the file cannot be written.
    """
    topic = _chosen(recording, topic)
    table = _FlangeTable(recording, topic) if topic in recording.flanges else _WrenchTable(recording, topic)
    some = False
    with _whole_file(file) as stream:
        stream.write((",".join(table.columns) + "\n").encode())
        for begin in range(0, table.count, _BLOCK_ROWS):
            columns = table.rows(slice(begin, begin + _BLOCK_ROWS))
            if len(columns[0]):
                some = True
                stream.write(csv_rows(*map(_cells, columns)))
        if not some:
            reasons = " ".join(table.said()) or "There is none."
            raise RecordingError(f"{file}: no reading of {topic} is usable for the table. {reasons}")
    return table.said()


def write_npz(file: Path, recording: Recording, topic: str | None = None) -> None:
    """
    Write everything as NumPy arrays, no row left out and nothing interpolated.

    The names: `topics`, `about` and `events` are UTF-8 bytes of JSON; for the topic number i of `topics`
    there are `i/times` and the other arrays of its track, by their names there. Nothing is pickled.

    Parameters
    ----------
    file : path
        Appears as a whole; what was there stays until then.
    recording : Recording
    topic : str, optional
        Only that one.

    Raises
    ------
    RecordingError
        There is no such topic, or the file cannot be written.
    """
    tracks: Mapping[str, WrenchTrack | FlangeTrack] = {**recording.wrenches, **recording.flanges}
    if topic is not None:
        _check_topic(recording, topic)
        tracks = {topic: tracks[topic]}
    arrays: dict[str, NDArray[Any]] = {
        "topics": _json_bytes(list(tracks)),
        "about": _json_bytes(asdict(recording.info)),
        "events": _json_bytes([asdict(event) for event in recording.events]),
    }
    for number, track in enumerate(tracks.values()):
        arrays.update((f"{number}/{name}", values) for name, values in vars(track).items())
    with _whole_file(file) as stream:
        np.savez(stream, **arrays)  # type: ignore[arg-type]


def _chosen(recording: Recording, topic: str | None) -> str:
    if topic is not None:
        _check_topic(recording, topic)
        return topic
    for tracks in (recording.wrenches, recording.flanges):
        if len(tracks) == 1:
            return next(iter(tracks))
        if tracks:
            raise RecordingError(
                f"the recording has several topics of that kind: {', '.join(tracks)}. Choose one:"
                " --topic NAME."
            )
    raise RecordingError("the recording contains no samples, so there is nothing to convert.")


def _check_topic(recording: Recording, topic: str) -> None:
    known = (*recording.wrenches, *recording.flanges)
    if topic not in known:
        raise RecordingError(
            f"the recording has no samples on {topic}; it has: {', '.join(known) or 'none'}."
        )


class _WrenchTable:
    """The wrenches of one sensor as rows of a table, a block at a time."""

    def __init__(self, recording: Recording, topic: str) -> None:
        self._track = track = recording.wrenches[topic]
        self._flanges = [*recording.flanges.values()]
        self.count = len(track.times)
        self._bad = self._lost = 0
        optional: tuple[tuple[str, NDArray[Any], NDArray[np.bool_]], ...] = (
            ("sequence", track.sequence, track.sequence >= 0),
            ("temperature", track.temperature, np.isfinite(track.temperature)),
        )
        more = {name: values for name, values, there in optional if there.all()}
        self._more = (track.status, *more.values())
        poses = _POSE_COLUMNS if len(self._flanges) == 1 else ()
        self.columns = [*_WRENCH_COLUMNS, *poses, "status", *more]

    def rows(self, rows: slice) -> list[NDArray[Any]]:
        """Return the columns of those of some rows that are measurements and have a pose, if there is a flange."""
        track = self._track
        kept = track.usable[rows]
        self._bad += int(np.count_nonzero(~kept))
        parts: list[NDArray[Any]] = [track.times[rows], *track.wrenches[rows].T]
        if len(self._flanges) == 1:
            poses, there = poses_at(self._flanges[0], track.times[rows])
            self._lost += int(np.count_nonzero(kept & ~there))
            kept = kept & there
            parts.extend(poses.T)
        parts.extend(column[rows] for column in self._more)
        return [part[kept] for part in parts]

    def said(self) -> tuple[str, ...]:
        """Return what was left out so far: sentences."""
        several = "The recording has several flanges, so the table has no poses."
        return (
            *([f"{self._bad:,} readings left out: flagged as bad by the device."] if self._bad else []),
            *([f"{self._lost:,} readings left out: no pose within {LONGEST_GAP} s."] if self._lost else []),
            *([several] if len(self._flanges) > 1 else []),
        )


class _FlangeTable:
    """The poses of one flange as rows of a table, a block at a time."""

    def __init__(self, recording: Recording, topic: str) -> None:
        self._track = recording.flanges[topic]
        self.count = len(self._track.times)
        self.columns = ["t", *_POSE_COLUMNS, *(f"j{n + 1}" for n in range(self._track.joints.shape[1]))]

    def rows(self, rows: slice) -> list[NDArray[Any]]:
        """Return the columns of some rows."""
        track = self._track
        quaternions, joints = _quaternions(track.R_BE[rows]), np.degrees(track.joints[rows])
        return [track.times[rows], *quaternions.T, *track.p_BE_B[rows].T, *joints.T]

    def said(self) -> tuple[str, ...]:
        """Nothing is left out."""
        return ()


def poses_at(track: FlangeTrack, times: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """
    Interpolate poses by the rule of the runtime: orientation by the shortest turn, position linearly.

    Parameters
    ----------
    track : FlangeTrack
    times : (n,) float64
        s.

    Returns
    -------
    poses : (n, 7) float64
        qw qx qy qz px py pz; NaN where there is none.
    there : (n,) bool
        There are samples on both sides, no more than LONGEST_GAP apart, or one at that moment.
    """
    # The next pose is at hand: nothing is carried on beyond the last one.
    R, p = pose_track.poses_at(track.times, track.R_BE, track.p_BE_B, times, longest_ahead=0.0)
    there = np.isfinite(R[:, 0, 0])
    poses = np.full((len(times), 7), np.nan)
    if there.any():
        poses[there, :4], poses[there, 4:] = _quaternions(R[there]), p[there]
    return poses, there


def _quaternions(R: NDArray[np.float64]) -> NDArray[np.float64]:
    from scipy.spatial.transform import Rotation

    return Rotation.from_matrix(R).as_quat(canonical=True)[:, [3, 0, 1, 2]]


def _cells(column: NDArray[Any]) -> NDArray[Any]:
    """Return what `csv_rows` takes: counts are texts."""
    return column if column.dtype.kind == "f" else column.astype(np.bytes_)


def _json_bytes(value: Any) -> NDArray[np.uint8]:
    return np.frombuffer(json.dumps(value, ensure_ascii=False).encode("utf-8", "replace"), dtype=np.uint8)


@contextmanager
def _whole_file(file: Path) -> Iterator[BinaryIO]:
    """Write a file that appears as a whole, or not at all; larger than fits into memory twice."""
    try:
        scratch = scratch_beside(file)
        try:
            with scratch.open("xb") as stream:
                yield stream
                stream.flush()
                os.fsync(stream.fileno())
            scratch.replace(file)
        except BaseException:
            scratch.unlink(missing_ok=True)
            raise
        sync_folder(file.parent)
    except (OSError, ValueError) as error:
        if isinstance(error, RecordingError):
            raise
        raise RecordingError(
            f"{file}: the file cannot be written ({error}): choose a folder that exists, is writable and has space."
        ) from error

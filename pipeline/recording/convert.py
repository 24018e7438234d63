"""Recordings as CSV, for everything that reads tables, and as NPZ, for NumPy."""

from __future__ import annotations

import csv
import io
import json
import os
from contextlib import contextmanager
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from contactbench.pipeline.devices import pose_track
from contactbench.pipeline.durable import scratch_beside, sync_folder
from contactbench.pipeline.recording.errors import RecordingError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
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
    said: list[str] = []
    if topic in recording.flanges:
        columns, table = _flange_table(recording.flanges[topic])
    else:
        columns, table = _wrench_table(recording, topic, said)
    if not len(table[0]):
        reasons = " ".join(said) or "There is none."
        raise RecordingError(f"{file}: no reading of {topic} is usable for the table. {reasons}")
    with _whole_file(file) as stream:
        stream.write((",".join(columns) + "\n").encode())
        for begin in range(0, len(table[0]), _BLOCK_ROWS):
            stream.write(_rows([column[begin : begin + _BLOCK_ROWS] for column in table]))
    return tuple(said)


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


def _wrench_table(recording: Recording, topic: str, said: list[str]) -> tuple[list[str], list[NDArray[Any]]]:
    track = recording.wrenches[topic]
    columns = list(_WRENCH_COLUMNS)
    parts: list[NDArray[Any]] = [track.times, *track.wrenches.T]
    kept = track.usable
    if not kept.all():
        said.append(f"{np.count_nonzero(~kept):,} readings left out: flagged as bad by the device.")
    if len(recording.flanges) == 1:
        poses, there = poses_at(next(iter(recording.flanges.values())), track.times)
        lost = kept & ~there
        if lost.any():
            said.append(f"{np.count_nonzero(lost):,} readings left out: no pose within {LONGEST_GAP} s.")
        kept &= there
        columns += _POSE_COLUMNS
        parts.extend(poses.T)
    elif recording.flanges:
        said.append("The recording has several flanges, so the table has no poses.")
    columns.append("status")
    parts.append(track.status)
    optional: tuple[tuple[str, NDArray[Any], NDArray[np.bool_]], ...] = (
        ("sequence", track.sequence, track.sequence >= 0),
        ("temperature", track.temperature, np.isfinite(track.temperature)),
    )
    for name, values, some in optional:
        if some.all():
            columns.append(name)
            parts.append(values)
    return columns, [part[kept] for part in parts]


def _flange_table(track: FlangeTrack) -> tuple[list[str], list[NDArray[Any]]]:
    joints = [f"j{number + 1}" for number in range(track.joints.shape[1])]
    parts = (track.times[:, None], _quaternions(track.R_BE), track.p_BE_B, np.degrees(track.joints))
    return ["t", *_POSE_COLUMNS, *joints], list(np.hstack(parts).T)


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


def _rows(columns: Sequence[NDArray[Any]]) -> bytes:
    """Return rows as text: counts as they are, floats with all their digits, nothing for NaN."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(zip(*map(_cells, columns), strict=True))
    return text.getvalue().encode()


def _cells(column: NDArray[Any]) -> list[Any]:
    cells: list[Any] = column.tolist()
    if column.dtype.kind == "f" and np.isnan(column).any():
        return ["" if value != value else value for value in cells]
    return cells


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

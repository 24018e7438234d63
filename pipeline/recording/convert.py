"""Recordings as CSV, for everything that reads tables, and as NPZ, for NumPy."""

import json
import struct
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from itertools import chain
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.devices.pose_source import LONGEST_GAP_S
from contactbench.pipeline.devices.pose_source import poses_at as poses_of
from contactbench.pipeline.durable import whole_or_raise
from contactbench.pipeline.errors import RecordingError, arg, join, message
from contactbench.pipeline.files import Progress, unheard
from contactbench.pipeline.recording.contents import Spill, Table
from contactbench.pipeline.recording.messages import Event, RecordingInfo
from contactbench.pipeline.recording.reader import (
    MOST_EVENT_BYTES,
    FlangeTrack,
    Recording,
    RecordingReader,
    Repeats,
    WrenchTrack,
    columns_of,
    joined,
    padded,
    read_recording,
)
from contactbench.pipeline.recording.ros2_poses import POSE_STAMPED, WRENCH_STAMPED
from contactbench.pipeline.tables.shortest import csv_rows

_WRENCH_COLUMNS = ("t", "fx", "fy", "fz", "mx", "my", "mz")
_POSE_COLUMNS = ("qw", "qx", "qy", "qz", "px", "py", "pz")

# Poses are asked for at 50 Hz or more; over a longer gap the flange may have been anywhere.


@dataclass(frozen=True)
class Converted:
    """How a recording was converted."""

    complete: bool  # The recording was closed, and the file is whole
    warnings: tuple[str, ...]  # What of it is missing or damaged: sentences
    left_out: tuple[str, ...]  # What of the rest is not in the table: sentences


def write_csv(file: Path, source: Path, topic: str | None = None, progress: Progress = unheard) -> Converted:
    """
    Write the samples of one topic of a recording of any length as a table.

    A wrench topic gives t,fx,fy,fz,mx,my,mz (s, N, N·m), status, sequence and temperature where there are any,
    and, if there is exactly one flange, its pose at the same moments: qw,qx,qy,qz (R_BE) and px,py,pz (m),
    interpolated. Readings that are no measurements, or that have no pose beside them, are left out. A flange
    topic gives t, its pose, and joints j1.. in degrees.

    Parameters
    ----------
    file : path
        Appears as a whole; what was there stays until then. Its folder also takes the readings until it is written.
    source : path
        The recording.
    topic : str, optional
        Left out: the wrenches if there is one sensor, else the one flange.
    progress : callable, optional
        Gets the bytes read so far, and those in the recording.

    Raises
    ------
    RecordingError
        The recording cannot be read, there is no such topic, the choice is not clear, no row is left, or the file
        cannot be written.
    """
    with Spill(file.parent) as spill:
        found = _put_aside(source, spill, progress)
        topic = _chosen(found, topic)
        table = _FlangeTable(found, topic) if topic in found.flanges else _WrenchTable(found, topic)
        some = False
        with whole_or_raise(file, RecordingError, message("the file cannot be written")) as stream:
            stream.write((",".join(table.columns) + "\n").encode())
            for columns in table.blocks():
                if len(columns[0]):
                    some = True
                    stream.write(csv_rows(*map(_cells, columns)))
            if not some:
                reasons = join(" ", table.said()) or message("There is none.")
                raise RecordingError(
                    f"{arg(file)}: no reading of {arg(topic)} is usable for the table. {arg(reasons)}"
                )
    return Converted(found.complete, found.warnings, table.said())


def write_npz(file: Path, source: Path, topic: str | None = None, progress: Progress = unheard) -> Converted:
    """
    Write everything in a recording of any length as NumPy arrays, no row left out and nothing interpolated.

    The names: `topics`, `about` and `events` are UTF-8 bytes of JSON; for the topic number i of `topics`
    there are `i/times` and the other arrays of its track, by their names there. Nothing is pickled.

    Parameters
    ----------
    file, source, progress
        As for `write_csv`.
    topic : str, optional
        Only that one.

    Raises
    ------
    RecordingError
        The recording cannot be read, there is no such topic, or the file cannot be written.
    """
    with Spill(file.parent) as spill:
        found = _put_aside(source, spill, progress)
        tables: Mapping[str, Table] = {**found.wrenches, **found.flanges}
        if topic is not None:
            _check_topic(found, topic)
            tables = {topic: tables[topic]}
        facts = {
            "topics": _json_bytes(list(tables)),
            "about": _json_bytes(asdict(found.info)),
            "events": _json_bytes([asdict(event) for event in found.events]),
        }
        whole = whole_or_raise(file, RecordingError, message("the file cannot be written"))
        with whole as stream, ZipFile(stream, "w") as archive:
            for name, values in facts.items():
                _write_array(archive, name, values.shape, [values])
            for number, table in enumerate(tables.values()):
                for name, shape in table.shapes.items():
                    _write_array(archive, f"{number}/{name}", shape, table.column(name))
    return Converted(found.complete, found.warnings, ())


def write_ros2(
    folder: Path, source: Path, topic: str | None = None, progress: Progress = unheard
) -> Converted:
    """
    Write a recording as a ROS 2 bag, in MCAP: WrenchStamped and PoseStamped with Unix time.

    Readings that are no measurements are left out. A position that is not known is NaN.

    Parameters
    ----------
    folder : path
        Must not exist.
    source, topic, progress
        As for `write_csv`; without a topic all are written.

    Raises
    ------
    RecordingError
        As for `write_csv`, or the recording is too long for arrays.
    """
    from rosbags.rosbag2 import StoragePlugin, Writer, WriterError
    from rosbags.typesys import Stores, get_typestore

    found, store, bad = read_recording(source, progress), get_typestore(Stores.ROS2_HUMBLE), 0
    if topic is not None:
        _check_topic(found, topic)
    try:
        with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as bag:
            tracks: Mapping[str, WrenchTrack | FlangeTrack] = {**found.wrenches, **found.flanges}
            for name in tracks if topic is None else [topic]:
                if isinstance(track := tracks[name], WrenchTrack):
                    kind, frame, kept, rows = WRENCH_STAMPED, "ft_sensor", track.usable, track.wrenches
                    bad += int(np.count_nonzero(~kept))
                else:
                    turns = np.roll(quaternions(track.R_BE), -1, axis=1)  # ROS has the scalar last
                    kind, frame, kept = POSE_STAMPED, "base_link", np.full(len(turns), fill_value=True)
                    rows = np.hstack([track.p_BE_B, turns])
                connection = bag.add_connection(name, kind, typestore=store)
                for stamp, row in zip(
                    map(found.info.log_time, track.times[kept].tolist()), rows[kept], strict=True
                ):
                    bag.write(connection, stamp, _stamped(stamp, frame) + row.tobytes())
    except (OSError, WriterError) as error:
        raise RecordingError(
            f"{arg(folder)}: it cannot be written ({arg(error)}): choose a new folder."
        ) from error
    said = message(f"{arg(bad):,} readings left out: flagged as bad by the device.")
    return Converted(found.complete, found.warnings, (said,) if bad else ())


def _stamped(stamp: int, frame: str) -> bytes:
    """Return the head of a message in CDR, a std_msgs/Header, up to where its doubles begin; Unix time in ns."""
    text = struct.pack("<iII", *divmod(stamp, 10**9), len(frame) + 1) + frame.encode() + b"\0"
    return b"\0\1\0\0" + text + bytes(-len(text) % 8)


def _write_array(archive: ZipFile, name: str, shape: tuple[int, ...], blocks: Iterable[NDArray[Any]]) -> None:
    """Write an array that comes in blocks as `numpy.savez` would write the whole."""
    with archive.open(f"{name}.npy", "w", force_zip64=True) as stream:
        for number, values in enumerate(blocks):
            if number == 0:
                kind = np.lib.format.dtype_to_descr(values.dtype)
                header = {"descr": kind, "fortran_order": False, "shape": shape}
                np.lib.format.write_array_header_1_0(stream, header)
            stream.write((values if values.shape[1:] == shape[1:] else padded(values, shape[1])).tobytes())


@dataclass(frozen=True)
class _Found:
    """A recording that was put aside."""

    info: RecordingInfo
    wrenches: Mapping[str, Table]
    flanges: Mapping[str, Table]
    events: tuple[Event, ...]
    warnings: tuple[str, ...]
    complete: bool
    apart: bool  # Wrenches and poses do not belong together


def _put_aside(source: Path, spill: Spill, progress: Progress) -> _Found:
    wrenches: defaultdict[str, Table] = defaultdict(lambda: Table(spill))
    flanges: defaultdict[str, Table] = defaultdict(lambda: Table(spill))
    events: list[Event] = []
    with RecordingReader(source, progress) as reader:
        reader.bound_events(MOST_EVENT_BYTES)
        reader.gather(
            lambda topic, block: wrenches[topic].add(columns_of(block)),
            lambda topic, block: flanges[topic].add(columns_of(block)),
            events.append,
        )
        warnings, apart = tuple(reader.warnings), reader.steps.apart()
        return _Found(reader.info, wrenches, flanges, tuple(events), warnings, reader.complete, apart)


def _chosen(found: _Found, topic: str | None) -> str:
    if topic is not None:
        _check_topic(found, topic)
        return topic
    for tables in (found.wrenches, found.flanges):
        if len(tables) == 1:
            return next(iter(tables))
        if tables:
            raise RecordingError(
                f"the recording has several topics of that kind: {arg(', '.join(tables))}. Choose one:"
                " --topic NAME."
            )
    raise RecordingError("the recording contains no samples, so there is nothing to convert.")


def _check_topic(found: _Found | Recording, topic: str) -> None:
    known = (*found.wrenches, *found.flanges)
    if topic not in known:
        raise RecordingError(
            f"the recording has no samples on {arg(topic)}; it has: {arg(', '.join(known) or 'none')}."
        )


class _WrenchTable:
    """The wrenches of one sensor as rows of a table, a block at a time."""

    def __init__(self, found: _Found, topic: str) -> None:
        self._rows = rows = found.wrenches[topic]
        self._several = len(found.flanges) > 1
        beside = len(found.flanges) == 1 and not found.apart
        self._poses = _Poses(*found.flanges.values()) if beside else None
        self._bad = self._lost = 0
        known = {
            "sequence": all((block >= 0).all() for block in rows.column("sequence")),
            "temperature": all(np.isfinite(block).all() for block in rows.column("temperature")),
        }
        self._more = ("status", *(name for name, is_known in known.items() if is_known))
        self.columns = [*_WRENCH_COLUMNS, *(() if self._poses is None else _POSE_COLUMNS), *self._more]

    def blocks(self) -> Iterator[list[NDArray[Any]]]:
        """Yield the columns of the readings that are measurements and have a pose, if there is a flange."""
        repeats = Repeats()
        tracks = (repeats.add(WrenchTrack(**columns)) for columns in self._rows.blocks())
        for track in chain(tracks, repeats.end()):
            kept = track.usable
            self._bad += int(np.count_nonzero(~kept))
            parts: list[NDArray[Any]] = [track.times, *track.wrenches.T]
            if self._poses is not None:
                poses, there = self._poses.at(track.times)
                self._lost += int(np.count_nonzero(kept & ~there))
                kept = kept & there
                parts.extend(poses.T)
            parts.extend(getattr(track, name) for name in self._more)
            yield [part[kept] for part in parts]

    def said(self) -> tuple[str, ...]:
        """Return what was left out so far: sentences."""
        bad = message(f"{arg(self._bad):,} readings left out: flagged as bad by the device.")
        lost = message(f"{arg(self._lost):,} readings left out: no pose within {arg(LONGEST_GAP_S)} s.")
        several = message("The recording has several flanges, so the table has no poses.")
        said = {bad: self._bad, lost: self._lost, several: self._several}
        return tuple(sentence for sentence, is_so in said.items() if is_so)


class _FlangeTable:
    """The poses of one flange as rows of a table, a block at a time."""

    def __init__(self, found: _Found, topic: str) -> None:
        self._rows = found.flanges[topic]
        _, self._joints = self._rows.shapes["joints"]
        self.columns = ["t", *_POSE_COLUMNS, *(f"j{n + 1}" for n in range(self._joints))]

    def blocks(self) -> Iterator[list[NDArray[Any]]]:
        """Yield the columns."""
        for columns in self._rows.blocks():
            joints = np.degrees(padded(columns["joints"], self._joints))
            yield [columns["times"], *quaternions(columns["R_BE"]).T, *columns["p_BE_B"].T, *joints.T]

    def said(self) -> tuple[str, ...]:
        """Nothing is left out."""
        return ()


class _Poses:
    """The poses of one flange, of which only those around the times that are asked for come into memory."""

    def __init__(self, rows: Table) -> None:
        self._rows = rows
        # The blocks with poses that are later than all before them, and the first of those times: `poses_at` leaves
        # out the others.
        self._blocks: list[int] = []
        self._first: list[float] = []
        latest = -np.inf
        for number, times in enumerate(rows.column("times")):
            if (times > latest).any():
                self._blocks.append(number)
                self._first.append(float(times[times > latest][0]))
                latest = float(times.max())

    def at(self, times: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Return the same as `poses_at` of all poses."""
        poses, there = np.full((len(times), 7), np.nan), np.zeros(len(times), dtype=bool)
        # A pose lies between the last one that is not later, and the one after that.
        last = np.searchsorted(self._first, times, side="right") - 1
        for number in np.unique(last[last >= 0]).tolist():
            rows = last == number
            poses[rows], there[rows] = poses_at(self._around(number), times[rows])
        return poses, there

    def _around(self, number: int) -> FlangeTrack:
        blocks = self._blocks[number : number + 2]
        parts = [FlangeTrack(**next(self._rows.blocks(block))) for block in blocks]
        return parts[0] if len(parts) == 1 else joined(*parts)


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
        There are samples on both sides, no more than LONGEST_GAP_S apart, or one at that moment.
    """
    # The next pose is at hand: nothing is carried on beyond the last one.
    R, p = poses_of(track.times, track.R_BE, track.p_BE_B, times, longest_ahead=0.0)
    there = np.isfinite(R[:, 0, 0])
    poses = np.full((len(times), 7), np.nan)
    if there.any():
        poses[there, :4], poses[there, 4:] = quaternions(R[there]), p[there]
    return poses, there


def quaternions(R: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return unit quaternions (n, 4) of rotations (n, 3, 3), scalar first and not negative."""
    from scipy.spatial.transform import Rotation  # slow to import

    return Rotation.from_matrix(R).as_quat(canonical=True, scalar_first=True)


def _cells(column: NDArray[Any]) -> NDArray[Any]:
    """Return what `csv_rows` takes: counts are texts."""
    return column if column.dtype.kind == "f" else column.astype(np.bytes_)


def _json_bytes(value: Any) -> NDArray[np.uint8]:
    return np.frombuffer(json.dumps(value, ensure_ascii=False).encode("utf-8", "replace"), dtype=np.uint8)

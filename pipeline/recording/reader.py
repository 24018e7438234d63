"""Reading recordings: sample by sample, or as arrays."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from itertools import chain, groupby, islice, repeat
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline import kernel
from contactbench.pipeline.devices.clock import SampleClock
from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.protocols.registry import driver_of
from contactbench.pipeline.devices.sample import FROZEN_CHANCE, FlangeSample, Status, WrenchSample
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import RecordingError, arg, join, message
from contactbench.pipeline.files import File, Progress, unheard
from contactbench.pipeline.recording.clock_steps import ClockSteps, breaks
from contactbench.pipeline.recording.messages import (
    ABOUT_RECORD,
    ARRIVALS_ONLY,
    DEVICE_RECORD,
    FORMAT,
    Event,
    MessageError,
    RecordingInfo,
    WrenchCells,
    cells_of,
    event_room,
    read_about,
    read_device,
    read_event,
    read_flange,
    read_wrench,
    wrench_cells,
)
from contactbench.pipeline.recording.schemas import EVENT_SCHEMA, FLANGE_SCHEMA, WRENCH_SCHEMA
from contactbench.pipeline.recording.stream import McapMessage, McapStream, Metadata
from contactbench.pipeline.tables.reader import floats_of

_USABLE = Status.LATE  # everything else says that a reading is no measurement, or that its time is a guess


@dataclass(frozen=True, eq=False)
class WrenchTrack:
    """
    The wrenches of one sensor; n samples, as given.

    Attributes
    ----------
    times : (n,) float64
        When they were measured, on the samples' clock, s.
    wrenches : (n, 6) float64
        Fx Fy Fz Mx My Mz in S, N and N·m about the sensor's origin.
    sequence : (n,) int64
        The device's count; -1: it has none.
    status : (n,) int64
        Flags of `Status`.
    device_time : (n,) float64
        The device's clock, s; NaN: it has none.
    temperature : (n,) float64
        °C; NaN: unknown.
    arrivals : (n,) float64
        When they arrived, on the samples' clock, s; NaN: unknown.
    """

    times: NDArray[np.float64]
    wrenches: NDArray[np.float64]
    sequence: NDArray[np.int64]
    status: NDArray[np.int64]
    device_time: NDArray[np.float64]
    temperature: NDArray[np.float64]
    arrivals: NDArray[np.float64]

    @cached_property
    def frozen(self) -> NDArray[np.bool_]:
        """(n,) the reading is part of a run that repeats beyond chance: the sensor hung."""
        return kernel.frozen(np.ascontiguousarray(self.wrenches), FROZEN_CHANCE)

    @cached_property
    def usable(self) -> NDArray[np.bool_]:
        """(n,) healthy: finite, not frozen, and nothing is reported but lateness."""
        reported = (self.status & ~int(_USABLE)) != 0
        usable: NDArray[np.bool_] = ~reported & np.isfinite(self.wrenches).all(axis=1) & ~self.frozen
        return usable

    def samples(self) -> Iterator[WrenchSample]:
        """Yield the samples one by one."""
        for row in range(len(self.times)):
            fx, fy, fz, mx, my, mz = self.wrenches[row].tolist()
            sequence = int(self.sequence[row])
            yield WrenchSample(
                float(self.times[row]),
                (fx, fy, fz),
                (mx, my, mz),
                None if sequence < 0 else sequence,
                Status(int(self.status[row])),
                _or_none(self.device_time[row]),
                _or_none(self.temperature[row]),
                _or_none(self.arrivals[row]),
            )


@dataclass(frozen=True, eq=False)
class FlangeTrack:
    """
    The poses of one flange E in its base B; n samples, as given.

    Attributes
    ----------
    times : (n,) float64
        When they were measured, on the samples' clock, s.
    R_BE : (n, 3, 3) float64
    p_BE_B : (n, 3) float64
        m; NaN: unknown.
    joints : (n, k) float64
        rad; NaN: unknown. k = 0 where no sample has any.
    device_time : (n,) float64
        The controller's clock, s; NaN: it has none.
    arrivals : (n,) float64
        When they arrived, on the samples' clock, s; NaN: unknown.
    """

    times: NDArray[np.float64]
    R_BE: NDArray[np.float64]
    p_BE_B: NDArray[np.float64]
    joints: NDArray[np.float64]
    device_time: NDArray[np.float64]
    arrivals: NDArray[np.float64]


Track = TypeVar("Track", WrenchTrack, FlangeTrack)


def wrench_track(samples: Sequence[WrenchCells]) -> WrenchTrack:
    """Read the numbers of samples (n,) together, n > 0: one by one would take several times as long."""
    times, *wrench, status, sequence, device_time, temperature, arrivals = zip(*samples, strict=True)
    return WrenchTrack(
        times=_numbers(times),
        wrenches=np.column_stack([_numbers(cells) for cells in wrench]),
        sequence=_counts(sequence),
        status=_counts(status),
        device_time=_numbers(device_time),
        temperature=_numbers(temperature),
        arrivals=_numbers(arrivals),
    )


def flange_track(samples: Sequence[FlangeSample]) -> FlangeTrack:
    """Put poses (n,) in columns, n > 0; where they differ in the number of joints, the missing ones are NaN."""
    known = [() if sample.joints is None else sample.joints for sample in samples]
    joints = np.full((len(samples), max(map(len, known))), np.nan)
    for row, angles in enumerate(known):
        joints[row, : len(angles)] = angles
    return FlangeTrack(
        times=np.array([sample.time for sample in samples]),
        R_BE=np.array([sample.R_BE for sample in samples]),
        p_BE_B=np.array([sample.p_BE_B for sample in samples]),
        joints=joints,
        device_time=np.array([_or_nan(sample.device_time) for sample in samples]),
        arrivals=np.array([_or_nan(sample.arrival) for sample in samples]),
    )


class Whole(Generic[Track]):
    """A track that grows by blocks and is in memory once."""

    def __init__(self, kind: Callable[..., Track]) -> None:
        self._kind: Callable[..., Track] = kind
        self._columns: defaultdict[str, bytearray] = defaultdict(bytearray)
        self._forms: dict[str, tuple[np.dtype[Any], tuple[int, ...]]] = {}
        self._count = 0

    def add(self, block: Track) -> None:
        """Append the samples of a block."""
        columns = columns_of(block)
        if "joints" in columns:
            columns["joints"] = self._as_wide(columns["joints"])
        for name, values in columns.items():
            self._forms[name] = values.dtype, values.shape[1:]
            # Where there is no room left, the system moves the pages and copies nothing.
            self._columns[name] += values.tobytes()
        self._count += len(block.times)

    def track(self) -> Track:
        """Return the samples; no more can be added then."""
        return self._kind(**{name: self._array(name) for name in self._columns})

    def _array(self, name: str) -> NDArray[Any]:
        kind, shape = self._forms[name]
        return np.frombuffer(self._columns[name], kind).reshape(self._count, *shape)

    def _as_wide(self, joints: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return joints in as many columns as the widest so far; those so far become as wide as these."""
        width = self._forms["joints"][1][0] if self._count else 0
        if joints.shape[1] > width and self._count:
            self._columns["joints"] = bytearray(padded(self._array("joints"), joints.shape[1]).tobytes())
        return padded(joints, max(width, joints.shape[1]))


class Repeats:
    """
    Tell the frozen readings of a track that comes in blocks: `frozen` of a block alone knows nothing of the others.

    What led to a run that is told frozen was frozen, too: readings of a run that is not decided are held back.
    """

    def __init__(self) -> None:
        self._detector = kernel.FrozenDetector()
        self._held: WrenchTrack | None = None

    def add(self, block: WrenchTrack) -> WrenchTrack:
        """Return the readings that are decided, perhaps none: their `frozen` and `usable` are those of the whole."""
        told = np.fromiter(
            map(self._detector.see, block.wrenches.tolist(), repeat(FROZEN_CHANCE)), dtype=bool
        )
        if self._held is not None:
            told = np.concatenate((np.zeros(len(self._held.times), dtype=bool), told))
            block = joined(self._held, block)
        begins = np.flatnonzero(np.r_[True, (block.wrenches[1:] != block.wrenches[:-1]).any(axis=1)])
        frozen = np.repeat(np.logical_or.reduceat(told, begins), np.diff(np.r_[begins, len(told)]))
        decided = len(told) if told[-1] else int(begins[-1])
        self._held = None if told[-1] else part(block, slice(decided, None))
        return _known(part(block, slice(decided)), frozen[:decided])

    def end(self) -> Iterator[WrenchTrack]:
        """Yield what was held back: nothing decided that it is frozen."""
        if self._held is not None:
            yield _known(self._held, np.zeros(len(self._held.times), dtype=bool))


def columns_of(track: WrenchTrack | FlangeTrack) -> dict[str, NDArray[Any]]:
    """Return the arrays of a track by name."""
    return {field.name: getattr(track, field.name) for field in fields(track)}


def part(track: Track, rows: slice) -> Track:
    """Return some of the samples."""
    return type(track)(**{name: values[rows] for name, values in columns_of(track).items()})


def joined(first: Track, second: Track) -> Track:
    """Return the samples of one track, then those of the other."""
    one, other = columns_of(first), columns_of(second)
    if "joints" in one:
        width = max(one["joints"].shape[1], other["joints"].shape[1])
        one["joints"], other["joints"] = padded(one["joints"], width), padded(other["joints"], width)
    return type(first)(**{name: np.concatenate((one[name], other[name])) for name in one})


def _known(track: WrenchTrack, frozen: NDArray[np.bool_]) -> WrenchTrack:
    vars(track)["frozen"] = frozen  # where the property would put it
    return track


def padded(joints: NDArray[np.float64], width: int) -> NDArray[np.float64]:
    """Return joints (n, k) in so many columns; NaN in the new ones."""
    return np.pad(joints, ((0, 0), (0, width - joints.shape[1])), constant_values=np.nan)


def _numbers(cells: Sequence[bytes | None]) -> NDArray[np.float64]:
    """Read cells (n,) as numbers; NaN where there is none."""
    if not any(cells):
        return np.full(len(cells), np.nan)
    return floats_of([cell or b"" for cell in cells])


def _counts(cells: Sequence[bytes | None]) -> NDArray[np.int64]:
    """Read cells (n,) as counts; -1 where there is none."""
    return np.array([-1 if cell is None else int(cell) for cell in cells], dtype=np.int64)


def _or_nan(value: float | None) -> float:
    return np.nan if value is None else value


def _or_none(value: np.float64) -> float | None:
    return None if np.isnan(value) else float(value)


_DECODERS: Mapping[str, Callable[[bytes], WrenchSample | FlangeSample | Event]] = {
    WRENCH_SCHEMA: read_wrench,
    FLANGE_SCHEMA: read_flange,
    EVENT_SCHEMA: read_event,
}

BLOCK_ROWS = 16_384  # samples, of all topics together, of which blocks are made
# Half a day of three sensors at 1 kHz; longer ones are read with RecordingReader.
MOST_SAMPLES = 130_000_000
_MOST_AT_ONCE = 4096  # samples of one arrival: what a damaged file has more of is no batch
MOST_EVENT_BYTES = 2**27  # in memory: a hundred thousand ordinary events


@dataclass(frozen=True, eq=False)
class Recording:
    """
    A recording as arrays.

    Attributes
    ----------
    info : RecordingInfo
    wrenches, flanges : mapping of topic to track
        Topics without samples are left out.
    events : tuple of Event
    warnings : tuple of str
        What is missing or damaged: sentences.
    complete : bool
        The recording was closed, and the file is whole.
    """

    info: RecordingInfo
    wrenches: Mapping[str, WrenchTrack]
    flanges: Mapping[str, FlangeTrack]
    events: tuple[Event, ...]
    warnings: tuple[str, ...]
    complete: bool

    def pair(self, source: object) -> tuple[WrenchTrack, FlangeTrack]:
        """Return the one sensor and the one robot; RecordingError, which calls the file `source`: there are others."""
        if len(self.wrenches) != 1 or len(self.flanges) != 1:
            raise RecordingError(
                f"{arg(source)}: it contains {arg(len(self.wrenches))} sensors and {arg(len(self.flanges))} robots:"
                " record one of each, the robot with --pose, or convert the right ones to CSV."
            )
        return next(iter(self.wrenches.values())), next(iter(self.flanges.values()))


class RecordingReader:
    """
    Iterate over the samples of a recording, once, as they were written; for files of any length.

    Older recordings have the arrivals of a device's samples only: they are timed here, as a stream times them now.
    Where the clock was set, the times go on as `ClockSteps` says.

    Parameters
    ----------
    path : path
    progress : callable, optional
        Gets the bytes read so far, and those in the file.

    Attributes
    ----------
    info : RecordingInfo
        What the recording says about itself.
    steps : ClockSteps
        Where the clock was set; known at the end.
    warnings : list of str
        What is missing or damaged, and where the clock was set; known at the end.
    complete : bool
        The recording was closed, and the file is whole; known at the end.

    Raises
    ------
    RecordingError
        The file cannot be read, or is no recording of contactbench.
    """

    def __init__(self, path: File, progress: Progress = unheard) -> None:
        self._path = path
        self._stream = McapStream(path, progress)
        self._records: Iterator[McapMessage | Metadata] = iter(self._stream)
        self._event_room: float = math.inf
        self._format = FORMAT
        self.steps = ClockSteps()
        try:
            self.info = self._about(path)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> RecordingReader:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __iter__(self) -> Iterator[tuple[str, WrenchSample | FlangeSample | Event]]:
        """Yield topics and what was recorded on them."""
        for topic, sample in self._as_written():
            if isinstance(sample, Event):
                yield topic, sample
                continue
            time = self.steps.at(topic, sample.time)
            yield topic, sample if time == sample.time else _moved(sample, time - sample.time)

    def _as_written(self) -> Iterator[tuple[str, WrenchSample | FlangeSample | Event]]:
        if self._format > ARRIVALS_ONLY:
            return self._recorded()
        timed = [device for device in self.info.devices if _is_timed(device.address)]
        return _timed(self._recorded(), {device.topic: SampleClock(device.rate) for device in timed})

    def _recorded(self) -> Iterator[tuple[str, WrenchSample | FlangeSample | Event]]:
        for record in self._records:
            if isinstance(record, McapMessage):
                yield from self._decoded(record)

    @property
    def warnings(self) -> list[str]:
        """What is missing or damaged, and where the clock was set."""
        return [*self._stream.warnings, *self.steps.told()]

    @property
    def complete(self) -> bool:
        """The recording was closed, and the file is whole."""
        return self._stream.complete

    def close(self) -> None:
        """Close the file."""
        self._stream.close()

    def blocks(self) -> Iterator[tuple[str, WrenchTrack | FlangeTrack | Event]]:
        """Yield the same as an iteration, several times as fast: events, and blocks of the samples of each topic."""
        pending: defaultdict[tuple[str, bool], list[Any]] = defaultdict(list)

        def tracks() -> Iterator[tuple[str, WrenchTrack | FlangeTrack]]:
            for (topic, cells), samples in pending.items():
                track = wrench_track(samples) if cells else flange_track(samples)
                yield topic, self._in_order(topic, track)
            pending.clear()

        room, last = BLOCK_ROWS, dict[str, float]()
        for topic, sample in self._samples_or_cells():
            if isinstance(sample, Event):
                yield topic, sample
                continue
            taken = cells_of(sample) if isinstance(sample, WrenchSample) else sample
            time = float(taken[0] or "nan") if isinstance(taken, tuple) else taken.time
            if topic not in last or breaks(time - last[topic]):
                yield from tracks()  # the step of the topic that shows it first is that of all
                room = BLOCK_ROWS
            last[topic] = time
            pending[topic, isinstance(taken, tuple)].append(taken)
            room -= 1
            if not room:
                yield from tracks()
                room = BLOCK_ROWS
        yield from tracks()

    def _samples_or_cells(self) -> Iterator[tuple[str, WrenchSample | FlangeSample | Event | WrenchCells]]:
        """Yield the same as an iteration, but of most wrenches only their cells."""
        if self._format <= ARRIVALS_ONLY:
            yield from self._as_written()
            return
        for record in self._records:
            if isinstance(record, McapMessage):
                channel = record.channel
                plain = channel.schema_name == WRENCH_SCHEMA and channel.encoding == "json"
                cells = wrench_cells(record.data) if plain else None
                if cells is None:
                    yield from self._decoded(record)
                else:
                    yield channel.topic, cells

    def _in_order(self, topic: str, track: WrenchTrack | FlangeTrack) -> WrenchTrack | FlangeTrack:
        times = self.steps.all_at(topic, track.times)
        if times is track.times:
            return track
        return replace(track, times=times, arrivals=track.arrivals + (times - track.times))

    def gather(
        self,
        wrench: Callable[[str, WrenchTrack], object],
        flange: Callable[[str, FlangeTrack], object],
        event: Callable[[Event], object],
        most: float = math.inf,
    ) -> int:
        """
        Hand all blocks with their topics, and the events, to callables; more samples than `most` are refused.

        Returns how many events there were.
        """
        events = 0
        for topic, block in self.blocks():
            if isinstance(block, Event):
                event(block)
                events += 1
                continue
            if isinstance(block, WrenchTrack):
                wrench(topic, block)
            else:
                flange(topic, block)
            most -= len(block.times)
            if most < 0:
                raise RecordingError(
                    f"{arg(self._path)}: the recording is too long to read at once: split it."
                )
        return events

    def bound_events(self, room: int) -> None:
        """Leave out the events for which `room` bytes of memory are too few: for those who keep them all."""
        self._event_room = room

    def _about(self, path: File) -> RecordingInfo:
        about: RecordingInfo | None = None
        devices = []
        for record in self._records:
            if isinstance(record, McapMessage):
                self._records = chain((record,), self._records)  # who reads on begins with it
                break
            try:
                if record.name == ABOUT_RECORD:
                    self._format = _format(path, record)
                    about = read_about(record.values)
                elif record.name == DEVICE_RECORD:
                    devices.append(read_device(record.values))
            except (KeyError, ValueError) as error:
                if isinstance(error, RecordingError):
                    raise
                self._stream.warn(message(f"The description in the file is damaged ({arg(error)})."))
        if about is None:
            reason = join(" ", self.warnings[:1]) or message(
                "For a ROS 2 bag use: contactbench record import-ros2."
            )
            raise RecordingError(f"{arg(path)}: not a recording of contactbench. {arg(reason)}")
        return RecordingInfo(about.started_ns, about.clock, tuple(devices), about.tool, about.note)

    def _decoded(self, raw: McapMessage) -> Iterator[tuple[str, WrenchSample | FlangeSample | Event]]:
        channel = raw.channel
        decode = _DECODERS.get(channel.schema_name) if channel.encoding == "json" else None
        if decode is None:
            self._stream.warn(
                message(f"There are messages of an unknown kind on {arg(channel.topic[:80])!r}.")
            )
            return
        if decode is read_event and not self._fits(raw.data):
            return
        try:
            sample = decode(raw.data)
        except MessageError as error:
            self._stream.warn(
                message(
                    f"A message on {arg(channel.topic[:80])!r} is damaged and was left out ({arg(error)})."
                )
            )
            return
        yield channel.topic, sample

    def _fits(self, data: bytes) -> bool:
        if self._event_room == math.inf:
            return True
        if (room := event_room(data)) > self._event_room:
            self._stream.warn(
                message("The recording has more events than fit into memory: some were left out.")
            )
            return False
        self._event_room -= room
        return True


def read_recording(path: File, progress: Progress = unheard) -> Recording:
    """
    Read a whole recording.

    Parameters
    ----------
    path : path
    progress : callable, optional
        Gets the bytes read so far, and those in the file.

    Raises
    ------
    RecordingError
        The file cannot be read, is no recording of contactbench, or is too long for arrays; or wrenches and poses do
        not belong together, as the clock was set for one of the two only.
    """
    wrenches: defaultdict[str, Whole[WrenchTrack]] = defaultdict(lambda: Whole(WrenchTrack))
    flanges: defaultdict[str, Whole[FlangeTrack]] = defaultdict(lambda: Whole(FlangeTrack))
    events: list[Event] = []
    with RecordingReader(path, progress) as reader:
        reader.bound_events(MOST_EVENT_BYTES)
        reader.gather(
            lambda topic, block: wrenches[topic].add(block),
            lambda topic, block: flanges[topic].add(block),
            events.append,
            MOST_SAMPLES,
        )
        if wrenches and flanges and reader.steps.apart():
            raise RecordingError(f"{arg(path)}: {arg(reader.warnings[-1])}")
        return Recording(
            reader.info,
            {topic: rows.track() for topic, rows in wrenches.items()},
            {topic: rows.track() for topic, rows in flanges.items()},
            tuple(events),
            tuple(reader.warnings),
            reader.complete,
        )


def _moved(sample: WrenchSample | FlangeSample, by: float) -> WrenchSample | FlangeSample:
    arrival = None if sample.arrival is None else sample.arrival + by
    return replace(sample, time=sample.time + by, arrival=arrival)


def _timed(
    recorded: Iterator[tuple[str, WrenchSample | FlangeSample | Event]], clocks: Mapping[str, SampleClock]
) -> Iterator[tuple[str, WrenchSample | FlangeSample | Event]]:
    """Time the samples of some topics, whose times are arrivals; what arrived together was written together."""
    for (topic, kind, _), batch in groupby(recorded, lambda item: (item[0], type(item[1]), item[1].time)):
        if topic not in clocks or kind is Event:
            yield from batch
            continue
        while samples := [sample for _, sample in islice(batch, _MOST_AT_ONCE)]:
            wrenches = [sample for sample in samples if isinstance(sample, WrenchSample)]
            poses = [sample for sample in samples if isinstance(sample, FlangeSample)]
            yield from ((topic, wrench) for wrench in clocks[topic].stamp(wrenches))
            yield from ((topic, pose) for pose in clocks[topic].stamp(poses))


def _is_timed(address: str) -> bool:
    """Tell whether a stream from there times its samples by a clock."""
    try:
        where = DeviceAddress.parse(address)
    except AddressError:
        return False
    known = driver_of(where.protocol)
    return known is not None and known.stamped


def _format(path: File, record: Metadata) -> int:
    number = int(record.values["format"])
    if number > FORMAT:
        raise RecordingError(
            f"{arg(path)}: the recording was written by a newer program"
            f" ({arg(record.values.get('tool', '')[:80])}): update contactbench."
        )
    return number

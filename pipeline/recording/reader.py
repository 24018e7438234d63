"""Reading recordings: sample by sample, or as arrays."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass
from itertools import chain, groupby, islice
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.clock import SampleClock
from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.protocols.registry import driver_of
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.recording.errors import RecordingError
from contactbench.pipeline.recording.info import (
    ABOUT_RECORD,
    ARRIVALS_ONLY,
    DEVICE_RECORD,
    FORMAT,
    RecordingInfo,
    read_about,
    read_device,
)
from contactbench.pipeline.recording.messages import (
    Event,
    MessageError,
    cells_of,
    event_room,
    read_event,
    read_flange,
    read_wrench,
    wrench_cells,
)
from contactbench.pipeline.recording.schemas import EVENT_SCHEMA, FLANGE_SCHEMA, WRENCH_SCHEMA
from contactbench.pipeline.recording.stream import McapMessage, McapStream, Metadata
from contactbench.pipeline.recording.tracks import FlangeTrack, Whole, WrenchTrack, flange_track, wrench_track

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from types import TracebackType

    from contactbench.pipeline.files import File
    from contactbench.pipeline.recording.messages import WrenchCells

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


class RecordingReader:
    """
    Iterate over the samples of a recording, once, as they were written; for files of any length.

    Older recordings have the arrivals of a device's samples only: they are timed here, as a stream times them now.

    Parameters
    ----------
    path : path
    progress : callable, optional
        Gets the bytes read so far, and those in the file.

    Attributes
    ----------
    info : RecordingInfo
        What the recording says about itself.
    warnings : list of str
        What is missing or damaged; known at the end.
    complete : bool
        The recording was closed, and the file is whole; known at the end.

    Raises
    ------
    RecordingError
        The file cannot be read, or is no recording of contactbench.
    """

    def __init__(self, path: File, progress: Callable[[int, int], None] | None = None) -> None:
        self._stream = McapStream(path, progress)
        self._records = iter(self._stream)
        self._first: McapMessage | None = None
        self._event_room: float = math.inf
        self._format = FORMAT
        try:
            self.info = self._about(path)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> RecordingReader:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __iter__(self) -> Iterator[tuple[str, WrenchSample | FlangeSample | Event]]:
        """Yield topics and what was recorded on them."""
        if self._format > ARRIVALS_ONLY:
            return self._recorded()
        clocks = {
            device.topic: SampleClock(device.rate)
            for device in self.info.devices
            if _is_timed(device.address)
        }
        return _timed(self._recorded(), clocks)

    def _recorded(self) -> Iterator[tuple[str, WrenchSample | FlangeSample | Event]]:
        raw = self._first
        if raw is not None:
            yield from self._decoded(raw)
        for record in self._records:
            if isinstance(record, McapMessage):
                yield from self._decoded(record)

    @property
    def warnings(self) -> list[str]:
        """What is missing or damaged."""
        return self._stream.warnings

    @property
    def complete(self) -> bool:
        """The recording was closed, and the file is whole."""
        return self._stream.complete

    def close(self) -> None:
        """Close the file."""
        self._stream.close()

    def blocks(self) -> Iterator[tuple[str, WrenchTrack | FlangeTrack | Event]]:
        """Yield the same as an iteration, several times as fast: events, and blocks of the samples of each topic."""
        wrenches: defaultdict[str, list[WrenchCells]] = defaultdict(list)
        flanges: defaultdict[str, list[FlangeSample]] = defaultdict(list)

        def tracks() -> Iterator[tuple[str, WrenchTrack | FlangeTrack]]:
            yield from ((topic, wrench_track(cells)) for topic, cells in wrenches.items())
            yield from ((topic, flange_track(samples)) for topic, samples in flanges.items())
            wrenches.clear()
            flanges.clear()

        room = BLOCK_ROWS
        for topic, sample in self._samples_or_cells():
            if isinstance(sample, tuple):
                wrenches[topic].append(sample)
            elif isinstance(sample, WrenchSample):
                wrenches[topic].append(cells_of(sample))
            elif isinstance(sample, FlangeSample):
                flanges[topic].append(sample)
            else:
                yield topic, sample
                continue
            room -= 1
            if not room:
                yield from tracks()
                room = BLOCK_ROWS
        yield from tracks()

    def _samples_or_cells(self) -> Iterator[tuple[str, WrenchSample | FlangeSample | Event | WrenchCells]]:
        """Yield the same as an iteration, but of most wrenches only their cells."""
        if self._format <= ARRIVALS_ONLY:
            yield from self
            return
        first = () if self._first is None else (self._first,)
        for record in chain(first, self._records):
            if isinstance(record, McapMessage):
                channel = record.channel
                plain = channel.schema_name == WRENCH_SCHEMA and channel.encoding == "json"
                cells = wrench_cells(record.data) if plain else None
                if cells is None:
                    yield from self._decoded(record)
                else:
                    yield channel.topic, cells

    def bound_events(self, room: int) -> None:
        """Leave out the events for which `room` bytes of memory are too few: for those who keep them all."""
        self._event_room = room

    def _about(self, path: File) -> RecordingInfo:
        about: RecordingInfo | None = None
        devices = []
        for record in self._records:
            if isinstance(record, McapMessage):
                self._first = record
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


def read_recording(path: File, progress: Callable[[int, int], None] | None = None) -> Recording:
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
        The file cannot be read, is no recording of contactbench, or is too long for arrays.
    """
    wrenches: defaultdict[str, Whole[WrenchTrack]] = defaultdict(lambda: Whole(WrenchTrack))
    flanges: defaultdict[str, Whole[FlangeTrack]] = defaultdict(lambda: Whole(FlangeTrack))
    events: list[Event] = []
    room = MOST_SAMPLES
    with RecordingReader(path, progress) as reader:
        reader.bound_events(MOST_EVENT_BYTES)
        for topic, block in reader.blocks():
            if isinstance(block, Event):
                events.append(block)
                continue
            if isinstance(block, WrenchTrack):
                wrenches[topic].add(block)
            else:
                flanges[topic].add(block)
            room -= len(block.times)
            if room < 0:
                raise RecordingError(f"{arg(path)}: the recording is too long to read at once: split it.")
        return Recording(
            reader.info,
            {topic: rows.track() for topic, rows in wrenches.items()},
            {topic: rows.track() for topic, rows in flanges.items()},
            tuple(events),
            tuple(reader.warnings),
            reader.complete,
        )


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

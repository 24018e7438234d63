"""Writing a recording while it happens."""

from __future__ import annotations

import threading
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Literal

from contactbench.pipeline.errors import arg
from contactbench.pipeline.recording.chunk_file import ChunkFile
from contactbench.pipeline.recording.errors import RecordingError, SampleError
from contactbench.pipeline.recording.messages import (
    ABOUT_RECORD,
    DEVICE_RECORD,
    EVENT_TOPIC,
    LONGEST_MESSAGE,
    Event,
    RecordingInfo,
    about_record,
    device_record,
    event_message,
    flange_message,
    wrench_message,
)
from contactbench.pipeline.recording.schemas import EVENT_SCHEMA, FLANGE_SCHEMA, WRENCH_SCHEMA, schema

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path
    from types import TracebackType

    from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample

_Kind = Literal["wrench", "flange", "event"]
_SCHEMAS: dict[_Kind, str] = {"wrench": WRENCH_SCHEMA, "flange": FLANGE_SCHEMA, "event": EVENT_SCHEMA}

_CHUNK_BYTES = 2**20


class RecordingWriter:
    """
    Append samples and events to a new MCAP file.

    If the process dies, what was given in the last `chunk_seconds` before the last call may be missing; if the
    power fails, what was given in the last `sync_seconds` before it. `flush` brings everything to the disk:
    call it where a stream pauses, because bounds are looked at only when something is given. Threads may
    share a writer. Every call may wait for the disk: do not record in the thread that reads a device.

    Parameters
    ----------
    path : path
        Must not exist.
    about : RecordingInfo
        `RecordingInfo.now(...)` for samples that are stamped by the host's monotonic clock.
    chunk_seconds, sync_seconds : float
        How long samples may be held back, by the host's clock, s.
    clock : callable
        Measures those, s.

    Raises
    ------
    RecordingError
        The file exists or cannot be written; two devices of different kinds share a topic.
    """

    def __init__(
        self,
        path: Path,
        about: RecordingInfo,
        *,
        chunk_seconds: float = 0.2,
        sync_seconds: float = 1.0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._path, self._about, self._clock = path, about, clock
        self._chunk_seconds, self._sync_seconds = chunk_seconds, sync_seconds
        topics = _topics(path, about)
        self._defaults = {kind: topic for topic, kind in reversed(topics.items())}
        self._kinds = topics
        self._lock = threading.Lock()
        self._file = ChunkFile(path, about.tool)
        try:
            self._channels = self._begin()
        except BaseException:
            self._file.discard()
            raise
        self._chunk_begin = self._synced = clock()

    def __enter__(self) -> RecordingWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is None:
            self.close()
        else:
            with suppress(RecordingError):  # the first error is the one to show
                self.close()

    def wrench(self, sample: WrenchSample, topic: str | None = None) -> None:
        """
        Append a wrench; numbers that are not finite are read back as NaN.

        Parameters
        ----------
        sample : WrenchSample
        topic : str, optional
            That of a device in `about`; left out: the first one.

        Raises
        ------
        SampleError
            There is no such topic, or the sample's time is far from the start.
        RecordingError
            The file cannot be written: the recording is over.
        """
        self._add("wrench", topic, sample.time, lambda stamp: wrench_message(sample, stamp))

    def flange(self, sample: FlangeSample, topic: str | None = None) -> None:
        """
        Append a pose of the flange.

        Raises
        ------
        SampleError, RecordingError
            As for a wrench; or its orientation is no rotation.
        """
        self._add("flange", topic, sample.time, lambda stamp: flange_message(sample, stamp))

    def event(self, name: str, fields: Mapping[str, Any], time: float) -> None:
        """
        Append an event at a time of the samples' clock.

        Raises
        ------
        SampleError, RecordingError
            As for a wrench; or the fields cannot be written as JSON, or are longer than 1 MiB.
        """
        self._add("event", None, time, lambda stamp: event_message(Event(time, name, fields), stamp))

    def flush(self) -> None:
        """Bring everything to the disk.

        Raises
        ------
        RecordingError
            It cannot be written.
        """
        with self._lock:
            self._finish_chunk(sync=True)

    def close(self) -> None:
        """Write the summary and close the file. A second call does nothing.

        Raises
        ------
        RecordingError
            It cannot be written; what was written before stays readable.
        """
        with self._lock:
            self._file.finish()

    def _begin(self) -> dict[str, int]:
        self._file.add_metadata(ABOUT_RECORD, about_record(self._about))
        for device in self._about.devices:
            self._file.add_metadata(DEVICE_RECORD, device_record(device))
        numbers = {kind: self._file.add_schema(name, schema(name)) for kind, name in _SCHEMAS.items()}
        channels = {
            topic: self._file.add_channel(topic, numbers[kind]) for topic, kind in self._kinds.items()
        }
        self._file.sync()
        return channels

    def _add(self, kind: _Kind, topic: str | None, moment: float, encode: Callable[[int], bytes]) -> None:
        topic = self._defaults[kind] if topic is None else topic
        if self._kinds.get(topic) != kind:
            known = ", ".join(name for name, other in self._kinds.items() if other == kind)
            raise SampleError(
                f"{arg(self._path)}: {arg(topic)} is not a topic for {arg(kind)} samples; there are: {arg(known)}."
                " Name its device in the description of the recording."
            )
        try:
            stamp = self._about.log_time(moment)
            data = encode(stamp)
        except ValueError as error:
            raise SampleError(
                f"{arg(self._path)}: a sample on {arg(topic)} cannot be recorded: {arg(error)}. Check its device."
            ) from error
        if len(data) > LONGEST_MESSAGE:
            raise SampleError(f"{arg(self._path)}: an event is longer than 1 MiB: keep such data in a file.")
        with self._lock:
            if not self._file.pending:
                self._chunk_begin = self._clock()
            self._file.add_message(self._channels[topic], stamp, data)
            self._keep_bounds()

    def _keep_bounds(self) -> None:
        now = self._clock()
        late = now - self._synced >= self._sync_seconds
        if late or now - self._chunk_begin >= self._chunk_seconds or self._file.pending >= _CHUNK_BYTES:
            self._finish_chunk(sync=late)

    def _finish_chunk(self, *, sync: bool) -> None:
        self._file.finish_chunk()
        if sync:
            self._file.sync()
            self._synced = self._clock()


def _topics(path: Path, about: RecordingInfo) -> dict[str, _Kind]:
    topics: dict[str, _Kind] = dict.fromkeys(about.topics("wrench"), "wrench")
    others: tuple[tuple[str, _Kind], ...] = (
        *((topic, "flange") for topic in about.topics("flange")),
        (EVENT_TOPIC, "event"),
    )
    for topic, kind in others:
        if topics.setdefault(topic, kind) != kind:
            raise RecordingError(f"{arg(path)}: {arg(topic)} would contain two kinds of samples: rename one.")
    return topics

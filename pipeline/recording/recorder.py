"""What streams give, into a recording, without keeping the streams waiting for the disk."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal, Self

from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.devices.stream import Health
from contactbench.pipeline.errors import InputError, RecordingError, SampleError, arg, message
from contactbench.pipeline.recording.chunk_file import ChunkFile
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

FLUSH_S = 0.5
# A minute at 1 kHz: a disk may pause that long.
_MOST_WAITING = 60_000
_LOOK_S = 0.1
_STATUS_EVERY_S = 0.1


class Recorder:
    """
    Takes samples in the threads of streams, and writes them in its own.

    Samples that come are on the disk half a second later. Changes of a stream's state, of the status that a sensor
    reports, and what the stream suspects, such as a re-zero, become events. Use it in a ``with`` statement, around
    the streams.

    When the disk is a minute behind, samples of a device are dropped, for a device waits for nobody: the recording
    says so in events ``dropped``, and `on_change` is told. A source that can wait is made to wait instead.

    Parameters
    ----------
    writer : RecordingWriter
        Stays open.
    on_change : callable, optional
        Told the device and its health when a stream's state or findings changed.
    clock : callable
        The samples' clock, s: dates changes of the streams.
    flush_seconds : float
        How often what was written is brought to the disk, s.
    patient : bool
        Whether the source waits, as a replay that goes by steps does: then nothing is dropped.
    most_waiting : int
        Samples that may wait for the disk.

    Attributes
    ----------
    failed : threading.Event
        Set once something cannot be written; what was written before stays.
    error : InputError or None
        Why.
    suspicions : tuple of (float, str)
        What a stream suspects, such as a re-zero, and when that was heard of, s of the samples' clock.
    skipped : int
        Batches with a sample that cannot be recorded, such as an orientation that is no rotation; what follows such
        a sample in its batch is missing.
    dropped : int
        Samples that are missing because the disk was too slow.
    unusable : int
        Wrenches that the sensor flagged as no measurements, or whose time is a guess.
    """

    def __init__(
        self,
        writer: RecordingWriter,
        on_change: Callable[[str, Health], None] | None = None,
        *,
        clock: Callable[[], float] = time.monotonic,
        flush_seconds: float = FLUSH_S,
        patient: bool = False,
        most_waiting: int = _MOST_WAITING,
    ) -> None:
        self._clock = clock
        self._writer, self._on_change, self._flush_seconds = writer, on_change, flush_seconds
        self._patient, self._most_waiting = patient, most_waiting
        # Unbounded by itself: events and the end must always get in; samples are counted.
        self._queue: queue.SimpleQueue[tuple[int, Callable[[], None]] | None] = queue.SimpleQueue()
        self._waiting, self._room = 0, threading.Condition()
        self._lost: dict[str, int] = {}
        self._health: dict[str, Health] = {}
        self._thread = threading.Thread(target=self._run, name="recorder", daemon=True)
        self._suspected: dict[str, tuple[str, ...]] = {}
        self._status, self._told = Status.OK, 0.0
        self.failed = threading.Event()
        self.error: InputError | None = None
        self.suspicions: tuple[tuple[float, str], ...] = ()
        self.skipped = self.dropped = self.unusable = 0

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Write what has come until now; the streams have ended."""
        for device in tuple(self._lost):
            self._say_dropped(device)
        self._queue.put(None)
        self._thread.join()

    def samples(self, samples: Sequence[WrenchSample]) -> None:
        """Take wrenches, oldest first."""
        self._put("sensor", len(samples), lambda: self._wrenches(samples))

    def poses(self, samples: Sequence[FlangeSample]) -> None:
        """Take poses of the flange, oldest first."""
        self._put("robot", len(samples), lambda: self._flanges(samples))

    def health(self, device: str, health: Health) -> None:
        """Take a change of a stream."""
        self._health[device] = health
        if self._on_change is not None:
            self._on_change(device, health)
        fields = {"device": device, "state": health.state.value, "findings": list(health.findings)}
        now = self._clock()
        self._put(device, 0, lambda: self._writer.event("stream", fields, now))
        before = self._suspected.get(device, ())
        self._suspected[device] = health.suspicions
        # Suspicions are added until somebody has read them; then they begin anew.
        known = len(before) if health.suspicions[: len(before)] == before else 0
        for what in health.suspicions[known:]:
            self._suspect(device, what, now)

    def _suspect(self, device: str, what: str, now: float) -> None:
        self.suspicions = (*self.suspicions, (now, what))
        self._put(device, 0, lambda: self._writer.event("suspicion", {"device": device, "what": what}, now))

    # ---- in the threads of streams -----------------------------------------------------------------

    def _put(self, device: str, count: int, write: Callable[[], None]) -> None:
        if self.error is not None:
            return
        if count and not self._take_room(count):
            self._drop(device, count)
            return
        if count and self._lost.get(device):
            self._say_dropped(device)
        self._queue.put((count, write))

    def _take_room(self, count: int) -> bool:
        with self._room:
            while self._waiting and self._waiting + count > self._most_waiting:
                if not self._patient:
                    return False
                # Not for ever at once: the writing thread may fail meanwhile.
                self._room.wait(_LOOK_S)
                if self.error is not None:
                    return True
            self._waiting += count
        return True

    def _drop(self, device: str, count: int) -> None:
        with self._room:  # two streams may drop at once
            self.dropped += count
        begins = not self._lost.get(device)
        self._lost[device] = self._lost.get(device, 0) + count
        health = self._health.get(device)
        if begins and self._on_change is not None and health is not None:
            words = message("The disk is too slow, so samples are dropped. Record to another disk.")
            self._on_change(device, replace(health, findings=(*health.findings, words)))

    def _say_dropped(self, device: str) -> None:
        fields, now = {"device": device, "samples": self._lost.pop(device)}, self._clock()
        self._queue.put((0, lambda: self._writer.event("dropped", fields, now)))

    # ---- in its own thread -------------------------------------------------------------------------

    def _run(self) -> None:
        flushed = time.monotonic()
        going = True
        while going:
            going = self._next(flushed + self._flush_seconds - time.monotonic())
            if not going or time.monotonic() - flushed >= self._flush_seconds:
                # Also without new samples: those before a silence must not wait for its end.
                self._do(self._writer.flush)
                flushed = time.monotonic()

    def _next(self, patience: float) -> bool:
        """Write what comes next; tells whether to go on."""
        try:
            found = self._queue.get(timeout=max(patience, 0.001))
        except queue.Empty:
            return True
        if found is None:
            return False
        count, write = found
        self._do(write)
        with self._room:
            self._waiting -= count
            self._room.notify_all()
        return True

    def _do(self, write: Callable[[], None]) -> None:
        if self.error is not None:
            return
        try:
            write()
        except SampleError:  # the device's fault, not the disk's: the recording goes on
            self.skipped += 1
        except InputError as error:  # such as a full disk
            self.error = error
            self.failed.set()

    def _wrenches(self, samples: Sequence[WrenchSample]) -> None:
        for sample in samples:
            self._writer.wrench(sample)
            self.unusable += bool(sample.status & ~Status.LATE)
            # A status that flickers would fill the recording with events; every sample has its own anyway.
            if sample.status != self._status and sample.time - self._told >= _STATUS_EVERY_S:
                change = {"before": int(self._status), "now": int(sample.status)}
                self._writer.event("status", {"device": "sensor", **change}, sample.time)
                self._status, self._told = sample.status, sample.time

    def _flanges(self, samples: Sequence[FlangeSample]) -> None:
        for sample in samples:
            self._writer.flange(sample)


def health_facts(health: Health) -> dict[str, Any]:
    """Return the counters of a stream as JSON values."""
    return {
        "samples": health.samples,
        "rate_hz": health.rate,
        "jitter_s": health.jitter,
        "lost": health.counters.lost,
        "bad_checksums": health.counters.bad_checksums,
        "skipped_bytes": health.counters.skipped_bytes,
        "reconnected": health.reconnected,
    }


# ---- writing a recording while it happens --------------------------------------------------------


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

    def __exit__(self, _kind: object, error: BaseException | None, _trace: object) -> None:
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

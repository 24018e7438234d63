"""A recording as a source of samples: at its own pace, faster, or step by step."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

from contactbench.pipeline.devices.pose_source import Track
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.devices.stream import Health, Sample, SourceStream
from contactbench.pipeline.devices.url import STEPWISE, DeviceAddress
from contactbench.pipeline.errors import RecordingError, arg, message
from contactbench.pipeline.recording.messages import DeviceInfo, DeviceKind, Event, RecordingInfo
from contactbench.pipeline.recording.reader import RecordingReader

_SLICE_S = 0.02  # samples of this time are given together, as a line would


class Replay:
    """
    Gives what was recorded to the same callables that a device would.

    The samples keep their recorded times and their order, of both kinds: what is computed from them is what was
    computed then. Where the clock was set, the times go on as `ClockSteps` says, and `warnings` tell it.

    Parameters
    ----------
    path : path
        A recording.
    on_wrenches, on_flanges : callable, optional
        Get samples, oldest first; from `start` in a thread, from `step` in the caller's. A kind without is left
        out, and no step counts it.
    speed : float
        Times the recorded pace, above 0; infinity: as fast as they are taken. `step` needs none.
    wrench_topic, flange_topic : str, optional
        Only the samples of this topic are given; left out: those of all.
    beside : callable, optional
        Gets the time of the first sample and returns poses, oldest first, that are put between the wrenches by
        their times, instead of recorded ones; those after the last wrench are not given. It may be endless.
    on_end : callable, optional
        Called where `done` is about to be set, in the same thread.

    Attributes
    ----------
    info : RecordingInfo
        What the recording says about itself.
    done : threading.Event
        Set at the end, or where the recording could not be read on.
    error : RecordingError or None
        Why it could not.
    time : float
        Of the last sample given; before that, of the recording's start.

    Raises
    ------
    RecordingError
        It cannot be read.
    ValueError
        The speed is not above 0.
    """

    def __init__(
        self,
        path: Path,
        on_wrenches: Callable[[Sequence[WrenchSample]], None] | None = None,
        on_flanges: Callable[[Sequence[FlangeSample]], None] | None = None,
        *,
        speed: float = 1.0,
        wrench_topic: str | None = None,
        flange_topic: str | None = None,
        beside: Callable[[float], Iterator[FlangeSample]] | None = None,
        on_end: Callable[[], None] = lambda: None,
    ) -> None:
        if not speed > 0:
            raise ValueError(message(f"the speed is {arg(speed):g}: give a number above 0."))
        self._reader = RecordingReader(path)
        self.info: RecordingInfo = self._reader.info
        self._wanted: dict[type, str | None] = {}
        if on_wrenches is not None:
            self._wanted[WrenchSample] = wrench_topic
        if on_flanges is not None and beside is None:
            self._wanted[FlangeSample] = flange_topic
        recorded = self._recorded()
        self._samples = recorded if beside is None else self._merged(recorded, beside)
        self._on_wrenches, self._on_flanges, self._on_end = on_wrenches, on_flanges, on_end
        self._speed = speed
        self._stopping, self.done = threading.Event(), threading.Event()
        # Another thread may stop what this one steps through; so may whoever gets the samples.
        self._stepping = threading.RLock()
        self._thread: threading.Thread | None = None
        self.error: RecordingError | None = None
        self.time = self.info.clock

    @property
    def warnings(self) -> tuple[str, ...]:
        """What of the recording is missing or damaged, as far as it was read: sentences."""
        return tuple(self._reader.warnings)

    def start(self) -> Replay:
        """Begin in a thread of its own; `done` is set at the end."""
        self._thread = threading.Thread(target=self._run, name="replay", daemon=True)
        self._thread.start()
        return self

    def stop(self) -> None:
        """Stop, and close the file."""
        self._stopping.set()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join()
        with self._stepping:
            self._reader.close()

    def __enter__(self) -> Replay:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def step(self, count: int = 1) -> int:
        """Give the next samples, `count` of them, one by one; returns how many there were."""
        given = 0
        with self._stepping:
            while given < count and not self._stopping.is_set():
                sample = next(self._samples, None)
                if sample is None:
                    self._end()
                    break
                self._give([sample])
                given += 1
        return given

    def _recorded(self) -> Iterator[WrenchSample | FlangeSample]:
        try:
            for topic, sample in self._reader:
                if isinstance(sample, Event) or type(sample) not in self._wanted:
                    continue
                if self._wanted[type(sample)] in (None, topic):
                    yield sample
        except RecordingError as error:
            self.error = error

    def _merged(
        self,
        recorded: Iterator[WrenchSample | FlangeSample],
        beside: Callable[[float], Iterator[FlangeSample]],
    ) -> Iterator[WrenchSample | FlangeSample]:
        poses: Iterator[FlangeSample] | None = None
        waiting: FlangeSample | None = None
        for sample in recorded:
            if poses is None:
                poses = beside(sample.time)
                waiting = next(poses, None)
            while waiting is not None and waiting.time <= sample.time:
                yield waiting
                waiting = next(poses, None)
            yield sample

    def _run(self) -> None:
        begun = time.monotonic()
        first: float | None = None
        batch: list[WrenchSample | FlangeSample] = []
        for sample in self._samples:
            first = sample.time if first is None else first
            if batch and sample.time - batch[0].time > _SLICE_S:
                self._pass(batch, begun + (batch[-1].time - first) / self._speed)
                batch = []
            if self._stopping.is_set():
                return
            batch.append(sample)
        if batch and first is not None:
            self._pass(batch, begun + (batch[-1].time - first) / self._speed)
        if not self._stopping.is_set():
            self._end()

    def _pass(self, batch: list[WrenchSample | FlangeSample], due: float) -> None:
        # What lies far ahead in a damaged recording must not make a wait that no lock can hold.
        self._stopping.wait(min(max(0.0, due - time.monotonic()), threading.TIMEOUT_MAX))
        if not self._stopping.is_set():
            self._give(batch)

    def _give(self, batch: list[WrenchSample | FlangeSample]) -> None:
        for _, run in groupby(batch, type):
            samples = list(run)
            self.time = samples[-1].time
            wrenches = [sample for sample in samples if isinstance(sample, WrenchSample)]
            flanges = [sample for sample in samples if isinstance(sample, FlangeSample)]
            if wrenches and self._on_wrenches is not None:
                self._on_wrenches(wrenches)
            if flanges and self._on_flanges is not None:
                self._on_flanges(flanges)

    def _end(self) -> None:
        if not self.done.is_set():
            self._on_end()
            self.done.set()


class Player:
    """
    The source of one or two streams: a recording that is read once for both.

    Parameters
    ----------
    sensor, poses : DeviceAddress or None
        Addresses of the streams; at least one.
    track : callable, optional
        Poses to give instead of recorded ones; see `PacedPoses`.

    Raises
    ------
    RecordingError
        It cannot be read, or does not hold what is asked for.
    """

    def __init__(
        self, sensor: DeviceAddress | None, poses: DeviceAddress | None, track: Track | None = None
    ) -> None:
        path, speed = next((Path(each.path), each.speed) for each in (sensor, poses) if each is not None)
        wrench_topic = None if sensor is None else find_topic(path, "wrench", sensor.topic)
        flange_topic = None
        if poses is not None and track is None:
            flange_topic = find_topic(path, "flange", poses.topic)
        self.stepwise = speed == STEPWISE
        self.replay = Replay(
            path,
            None if sensor is None else self._give,
            None if poses is None else self._give,
            speed=speed or math.inf,
            wrench_topic=wrench_topic,
            flange_topic=flange_topic,
            beside=track,
            on_end=self._end,
        )
        kinds = {WrenchSample: sensor, FlangeSample: poses}
        self._lock = threading.Lock()
        self._streams: dict[type, SourceStream[Any]] = {}
        self._open = {kind for kind, where in kinds.items() if where is not None}
        self._waiting = set(self._open)
        topics = (wrench_topic, flange_topic)
        self.devices: dict[str, DeviceInfo] = {
            device.kind: device for device in reversed(self.replay.info.devices) if device.topic in topics
        }

    @property
    def time(self) -> float:
        """As `Source`."""
        return self.replay.time

    def join(self, stream: SourceStream[Any]) -> None:
        """Take a stream that was started, and begin with the last: none misses what another gets."""
        with self._lock:
            already = not self._waiting
            self._waiting.discard(stream.kind)
            if already or self._waiting or self.stepwise:
                return
        self.replay.start()

    def leave(self, stream: SourceStream[Any]) -> None:
        """Note that a stream was stopped, and close the recording with the last."""
        with self._lock:
            self._open.discard(stream.kind)
            if self._open:
                return
        self.replay.stop()

    def step(self, count: int) -> int:
        """As `Source`."""
        return self.replay.step(count)

    def stream(
        self,
        address: DeviceAddress,
        kind: type[Sample],
        on_samples: Callable[[Sequence[Sample]], None],
        on_change: Callable[[Health], None] | None = None,
    ) -> SourceStream[Sample]:
        """Return the stream of one kind of samples, not yet started."""
        device = self.devices.get("wrench" if kind is WrenchSample else "flange")
        rate = None if device is None else device.rate
        self._streams[kind] = made = SourceStream(address, self, kind, on_samples, on_change, rate=rate)
        return made

    def _give(self, samples: Sequence[WrenchSample] | Sequence[FlangeSample]) -> None:
        self._streams[type(samples[0])].take(samples, self.replay.warnings)

    def _end(self) -> None:
        for stream in self._streams.values():
            stream.end(self.replay.error, self.replay.warnings)


def find_topic(path: Path, kind: DeviceKind, topic: str | None = None) -> str:
    """
    Return the topic of a recording that has a kind of samples.

    Parameters
    ----------
    path : path
        A recording.
    kind : {"wrench", "flange"}
    topic : str, optional
        Which, where several devices of the kind were recorded.

    Raises
    ------
    RecordingError
        It cannot be read, holds no such samples, or of several devices and none was chosen.
    """
    what, sought = {"wrench": ("wrenches", WrenchSample), "flange": ("poses", FlangeSample)}[kind]
    with RecordingReader(path) as reader:
        topics = reader.info.topics(kind)
        if topic is None and len(topics) > 1:
            raise RecordingError(
                f"{arg(path)}: it contains {arg(what)} of several devices: add ?topic= with one of"
                f" {arg(', '.join(topics))}."
            )
        chosen = topics[0] if topic is None else topic
        if any(found == chosen and isinstance(sample, sought) for found, sample in reader):
            return chosen
    raise RecordingError(
        f"{arg(path)}: it has no {arg(what)} on {arg(chosen)}: choose another recording or topic; contactbench"
        " record info lists its content."
    )

"""A recording as one stream, or as two that share its reader and its clock."""

from __future__ import annotations

import math
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypeVar

from contactbench.pipeline.devices.drive import State
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.devices.url import STEPWISE
from contactbench.pipeline.recording.replay import Replay, find_topic
from contactbench.pipeline.streams.source import Ending, Pulse

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from types import TracebackType
    from typing import Self

    from contactbench.pipeline.devices.drive import Health
    from contactbench.pipeline.devices.url import DeviceAddress
    from contactbench.pipeline.recording import DeviceInfo, RecordingInfo
    from contactbench.pipeline.streams.paced import Track

Sample = TypeVar("Sample", WrenchSample, FlangeSample)


class ReplayStream(Ending, Generic[Sample]):
    """
    The wrenches or the poses of a recording, with their recorded times.

    Parameters
    ----------
    address : DeviceAddress
    on_samples : callable
        Gets samples, oldest first; in a thread of the replay or, stepwise, in that of `step`.
    on_change : callable, optional
        Gets the health when its state or findings change.
    """

    player: Player

    def __init__(
        self,
        address: DeviceAddress,
        on_samples: Callable[[Sequence[Sample]], None],
        on_change: Callable[[Health], None] | None = None,
    ) -> None:
        super().__init__(address, Pulse(on_change))
        self._on_samples: Callable[[Sequence[Sample]], None] = on_samples
        self._on_change = on_change
        self._stopped = False
        self._giving = threading.RLock()  # one that lets who gets the samples stop the stream

    @property
    def stepwise(self) -> bool:
        """Whether samples come only when `step` asks for them."""
        return self.player.stepwise

    def start(self) -> Self:
        """Begin, once every stream of the recording was started: none misses what another gets."""
        self.player.begin(self)
        return self

    def stop(self) -> None:
        """End it; the last stream that is stopped closes the recording."""
        with self._giving:
            self._stopped = True
        self.player.leave(self)
        if not self.done.is_set():
            self._pulse.become(State.CLOSED)

    def step(self, count: int = 1) -> int:
        """Give the next samples, of all streams of the recording; returns how many of `count` there were."""
        return self.player.step(count)

    def __enter__(self) -> Self:
        return self.start()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    # ---- what the player calls -----------------------------------------------------------------

    def join(self, player: Player, device: DeviceInfo | None) -> None:
        """Belong to a player, before it begins."""
        self.player = player
        self._pulse = Pulse(self._on_change, None if device is None else device.rate)

    def take(self, samples: Sequence[Sample]) -> None:
        """Give samples on."""
        with self._giving:
            if not self._stopped:
                self._on_samples(samples)
            if not self._stopped:
                self._pulse.beat(samples, self.player.replay.warnings)

    def end(self) -> None:
        """Be at the end, with what was wrong on the way."""
        replay = self.player.replay
        if self._stopped:
            pass  # it has said that it is closed
        elif replay.error is not None:
            self._pulse.become(State.LOST, (str(replay.error),))
        else:
            self._pulse.become(State.CLOSED, replay.warnings)
        self.done.set()


class Player:
    """
    Reads a recording once for all of its streams.

    Parameters
    ----------
    address : DeviceAddress
        Of the recording.
    wrenches, flanges : ReplayStream, optional
        At least one.
    track : callable, optional
        Poses to give instead of recorded ones; see `PacedPoses`.

    Raises
    ------
    RecordingError
        It cannot be read, or does not hold what is asked for.
    """

    def __init__(
        self,
        address: DeviceAddress,
        wrenches: ReplayStream[WrenchSample] | None,
        flanges: ReplayStream[FlangeSample] | None,
        track: Track | None = None,
    ) -> None:
        path = Path(address.path)
        wrench_topic = None if wrenches is None else find_topic(path, "wrench", wrenches.address.topic)
        flange_topic = None
        if flanges is not None and track is None:
            flange_topic = find_topic(path, "flange", flanges.address.topic)
        self.stepwise = address.speed == STEPWISE
        self.replay = Replay(
            path,
            None if wrenches is None else wrenches.take,
            None if flanges is None else flanges.take,
            speed=address.speed or math.inf,
            wrench_topic=wrench_topic,
            flange_topic=flange_topic,
            beside=track,
            on_end=self._end,
        )
        self._views = [view for view in (wrenches, flanges) if view is not None]
        self._lock = threading.Lock()
        self._waiting, self._watching = set(map(id, self._views)), set(map(id, self._views))
        self.devices: dict[str, DeviceInfo] = {}
        for view, topic in ((wrenches, wrench_topic), (flanges, flange_topic)):
            if view is not None:
                device = _device(self.replay.info, topic)
                if device is not None:
                    self.devices[device.kind] = device
                view.join(self, device)

    def begin(self, view: object) -> None:
        """Note that a stream was started, and begin with the last."""
        with self._lock:
            already = not self._waiting
            self._waiting.discard(id(view))
            if already or self._waiting or self.stepwise:
                return
        self.replay.start()

    def leave(self, view: object) -> None:
        """Note that a stream was stopped, and close the recording with the last."""
        with self._lock:
            self._watching.discard(id(view))
            if self._watching:
                return
        self.replay.stop()

    def step(self, count: int) -> int:
        """Give the next samples; returns how many there were.

        Raises
        ------
        RuntimeError
            The recording is not opened stepwise: its samples come by themselves.
        """
        if not self.stepwise:
            raise RuntimeError("this replay goes at its own pace: open it with ?speed=step")
        return self.replay.step(count)

    def _end(self) -> None:
        for view in self._views:
            view.end()


def _device(info: RecordingInfo, topic: str | None) -> DeviceInfo | None:
    return next((device for device in info.devices if device.topic == topic), None)

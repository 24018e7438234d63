"""Poses that are computed or read at once, given at their times."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.drive import State
from contactbench.pipeline.streams.source import Ending, Pulse

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from types import TracebackType
    from typing import Self

    from contactbench.pipeline.devices.drive import Health
    from contactbench.pipeline.devices.sample import FlangeSample
    from contactbench.pipeline.devices.url import DeviceAddress

    Track = Callable[[float], Iterator[FlangeSample]]

_SLICE_S = 0.02  # poses of this time are given together, as a line would


class PacedPoses(Ending):
    """
    A track of poses, from the moment of its start, on the host's monotonic clock.

    Parameters
    ----------
    address : DeviceAddress
    track : callable
        Gets the time of the start, s, and returns the poses with their times, oldest first; it may be endless.
    on_samples : callable
        Gets every batch of poses in the stream's thread.
    on_change : callable, optional
        Gets the health when its state changes.
    """

    def __init__(
        self,
        address: DeviceAddress,
        track: Track,
        on_samples: Callable[[Sequence[FlangeSample]], None],
        on_change: Callable[[Health], None] | None = None,
    ) -> None:
        super().__init__(address, Pulse(on_change, judged=False))
        self._track, self._on_samples = track, on_samples
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self) -> Self:
        """Begin, in a thread of its own."""
        self._thread = threading.Thread(target=self._run, name=str(self.address), daemon=True)
        self._thread.start()
        return self

    def stop(self) -> None:
        """End it."""
        self._stopping.set()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join()

    def __enter__(self) -> Self:
        return self.start()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    def _run(self) -> None:
        batch: list[FlangeSample] = []
        for pose in self._track(time.monotonic()):
            if batch and pose.time - batch[0].time > _SLICE_S:
                self._pass(batch)
                batch = []
            if self._stopping.is_set():
                break
            batch.append(pose)
        else:
            self._pass(batch)
        self._pulse.become(State.CLOSED)
        if not self._stopping.is_set():
            self.done.set()

    def _pass(self, batch: list[FlangeSample]) -> None:
        # None before its time, and none later than a slice after it.
        wait = batch[-1].time - time.monotonic()
        if not self._stopping.wait(min(max(0.0, wait), threading.TIMEOUT_MAX)):
            self._on_samples(batch)
            self._pulse.beat(batch)

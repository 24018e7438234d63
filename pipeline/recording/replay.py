"""A recording as a source of samples: at its own pace, faster, or step by step."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

from pipeline.devices.sample import FlangeSample, WrenchSample
from pipeline.recording.reader import RecordingReader

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path
    from types import TracebackType

_SLICE_S = 0.02  # samples of this time are given together, as a line would


class Replay:
    """
    Gives what was recorded to the same callables that a device would.

    The samples keep their recorded times: what is computed from them is what was computed then.

    Parameters
    ----------
    path : path
        A recording.
    on_wrenches, on_flanges : callable, optional
        Get samples, oldest first; from `start` in a thread, from `step` in the caller's.
    speed : float
        Times the recorded pace, above 0; infinity: as fast as they are taken. `step` needs none.

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
        on_wrenches: Callable[[Sequence[WrenchSample]], None] = lambda _: None,
        on_flanges: Callable[[Sequence[FlangeSample]], None] = lambda _: None,
        *,
        speed: float = 1.0,
    ) -> None:
        if not speed > 0:
            raise ValueError(f"the speed is {speed:g}: give a number above 0.")
        self._reader = RecordingReader(path)
        self._samples = (
            sample for _, sample in self._reader if isinstance(sample, WrenchSample | FlangeSample)
        )
        self._on_wrenches, self._on_flanges = on_wrenches, on_flanges
        self._speed = speed
        self._stopping, self.done = threading.Event(), threading.Event()
        self._thread: threading.Thread | None = None

    def start(self) -> Replay:
        """Begin in a thread of its own; `done` is set at the end."""
        self._thread = threading.Thread(target=self._run, name="replay", daemon=True)
        self._thread.start()
        return self

    def stop(self) -> None:
        """Stop, and close the file."""
        self._stopping.set()
        if self._thread is not None:
            self._thread.join()
        self._reader.close()

    def __enter__(self) -> Replay:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    def step(self, count: int = 1) -> int:
        """Give the next samples, `count` of them; returns how many there were."""
        given = 0
        for sample in self._samples:
            self._give([sample])
            given += 1
            if given == count:
                break
        return given

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
        self.done.set()

    def _pass(self, batch: list[WrenchSample | FlangeSample], due: float) -> None:
        self._stopping.wait(max(0.0, due - time.monotonic()))
        if not self._stopping.is_set():
            self._give(batch)

    def _give(self, batch: list[WrenchSample | FlangeSample]) -> None:
        wrenches = [sample for sample in batch if isinstance(sample, WrenchSample)]
        flanges = [sample for sample in batch if isinstance(sample, FlangeSample)]
        if wrenches:
            self._on_wrenches(wrenches)
        if flanges:
            self._on_flanges(flanges)

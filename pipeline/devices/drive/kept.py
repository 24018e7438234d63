"""A device kept streaming: opened, started, read, watched, and opened again when its line was lost."""

from __future__ import annotations

import threading
import time
from abc import ABC, abstractmethod
from contextlib import suppress
from typing import TYPE_CHECKING, Generic, TypeVar

from pipeline.devices.drive.health import Health, State, Watch
from pipeline.devices.protocols import Counters, ProtocolError
from pipeline.devices.sample import FlangeSample, WrenchSample
from pipeline.devices.transport import LineError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from types import TracebackType
    from typing import Self

    from pipeline.devices.transport import Line
    from pipeline.devices.url import DeviceAddress

Sample = TypeVar("Sample", WrenchSample, FlangeSample)

READ_S = 0.02  # how long a read may wait: how soon a stop or a silence is noticed
_RETRY_S = (0.1, 0.2, 0.5, 1.0, 2.0)
# A device that was switched off and on says nothing until it is started again.
_START_AGAIN_S = 1.0


class KeptStream(ABC, Generic[Sample]):
    """
    One device's samples, in a thread of their own.

    Lost lines are opened again by themselves. What did not arrive is never made up: a gap stays a gap.

    Parameters
    ----------
    address : DeviceAddress
    line : Line
    rate : float
        Samples a second that should come, Hz.
    on_samples : callable
        Gets every batch of samples, oldest first, in the stream's thread; it must be quick and not raise.
    on_change : callable, optional
        Told when the state or the findings changed, in the same thread.
    """

    def __init__(
        self,
        address: DeviceAddress,
        line: Line,
        rate: float,
        on_samples: Callable[[Sequence[Sample]], None],
        on_change: Callable[[Health], None] | None = None,
    ) -> None:
        self.address = address
        self._line = line
        self._on_samples: Callable[[Sequence[Sample]], None] = on_samples
        self._on_change = on_change
        self._watch = Watch(rate)
        self._state, self._why, self._reconnected = State.CLOSED, "", 0
        self._told: tuple[State, tuple[str, ...]] | None = None
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self) -> Self:
        """Begin; the line is opened in the background. A stream is started once."""
        self._thread = threading.Thread(target=self._run, name=str(self.address), daemon=True)
        self._thread.start()
        return self

    def stop(self) -> None:
        """Stop the device and close the line; returns when that is done."""
        self._stopping.set()
        if self._thread is not None:
            self._thread.join()

    def __enter__(self) -> Self:
        return self.start()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    @property
    def health(self) -> Health:
        """How the stream is now."""
        return Health(
            self._state,
            self._findings(),
            self._watch.samples,
            self._watch.rate(),
            self._watch.jitter(),
            self._counters(),
            self._reconnected,
        )

    # ---- what each kind of device does ---------------------------------------------------------

    @abstractmethod
    def _begin(self) -> None:
        """Make the device stream; the line is open."""

    @abstractmethod
    def _feed(self, data: bytes, arrived: float) -> list[Sample]:
        """Turn bytes into samples, oldest first."""

    @abstractmethod
    def _end(self) -> None:
        """Make the device stop; the line is open or lost."""

    def _idle(self, now: float) -> None:
        """Do what is due between reads, such as asking again."""

    def _reset(self) -> None:
        """Forget what was half received; the line was lost."""

    def _counters(self) -> Counters:
        return Counters()

    # ---- the thread ----------------------------------------------------------------------------

    def _findings(self) -> tuple[str, ...]:
        if self._state in (State.LOST, State.SILENT):
            return (self._why,)
        return self._watch.findings() if self._state is State.STREAMING else ()

    def _run(self) -> None:
        tries = 0
        while not self._stopping.is_set():
            self._change(State.CONNECTING if tries == 0 else State.LOST)
            try:
                self._line.open()
                self._begin()
                tries = 0
                self._read()
            except (LineError, ProtocolError) as error:
                self._why = str(error)
                self._change(State.LOST)
                self._reset()
                self._watch.forget()
                self._line.close()
                self._stopping.wait(_RETRY_S[min(tries, len(_RETRY_S) - 1)])
                tries += 1
                self._reconnected += 1
        self._finish()

    def _read(self) -> None:
        last = begun_again = time.monotonic()
        while not self._stopping.is_set():
            self._idle(time.monotonic())
            chunk = self._line.read(READ_S)
            if self._take(chunk.data, chunk.time):
                last = chunk.time
            elif chunk.time - last > self._watch.patience:
                self._why = (
                    f"{self.address}: no sample for {chunk.time - last:.1f} s: check that the device has power and that"
                    " nothing else uses its line."
                )
                self._change(State.SILENT)
                self._watch.forget()
                if chunk.time - max(last, begun_again) > _START_AGAIN_S:
                    self._begin()
                    begun_again = time.monotonic()

    def _take(self, data: bytes, arrived: float) -> bool:
        """Give on the samples that end in these bytes; tells whether there were any."""
        samples = self._feed(data, arrived) if data else []
        if not samples:
            return False
        self._watch.see(samples)
        self._on_samples(samples)
        self._change(State.STREAMING)
        return True

    def _change(self, state: State) -> None:
        self._state = state
        now = (state, self._findings() if state is not State.SILENT else ())
        if now != self._told:
            self._told = now
            if self._on_change is not None:
                self._on_change(self.health)

    def _finish(self) -> None:
        with suppress(LineError):  # it is gone, and with it the stream
            self._end()
        self._line.close()
        self._change(State.CLOSED)

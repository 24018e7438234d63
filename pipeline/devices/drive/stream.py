"""A sensor kept streaming: opened, started, read, watched, and opened again when its line was lost."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

from pipeline.devices.drive.driver import driver_for
from pipeline.devices.drive.health import Health, State, Watch
from pipeline.devices.transport import LineError, line_to
from pipeline.devices.url import DeviceAddress

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from types import TracebackType

    from pipeline.devices.drive.driver import SensorDriver
    from pipeline.devices.protocols import Command
    from pipeline.devices.sample import WrenchSample
    from pipeline.devices.transport import Line

_READ_S = 0.02  # how long a read may wait: how soon a stop or a silence is noticed
_REPLY_S = 1.0
_RETRY_S = (0.1, 0.2, 0.5, 1.0, 2.0)
# A device that was switched off and on says nothing until it is started again.
_START_AGAIN_S = 1.0
_REPLY_BYTES = 4096


class SensorStream:
    """
    One sensor's samples, in a thread of their own.

    Lost lines are opened again by themselves. What did not arrive is never made up: a gap stays a gap.

    Parameters
    ----------
    address : DeviceAddress or str
    on_samples : callable
        Gets every batch of samples, oldest first, in the stream's thread; it must be quick and not raise.
    on_change : callable, optional
        Told when the state or the findings changed, in the same thread.
    line, driver : optional
        Instead of the address's own, such as a line of a test.
    """

    def __init__(
        self,
        address: DeviceAddress | str,
        on_samples: Callable[[Sequence[WrenchSample]], None],
        on_change: Callable[[Health], None] | None = None,
        *,
        line: Line | None = None,
        driver: SensorDriver | None = None,
    ) -> None:
        self.address = DeviceAddress.parse(address) if isinstance(address, str) else address
        self._driver = driver or driver_for(self.address)
        self._line = line or line_to(self.address)
        self._on_samples, self._on_change = on_samples, on_change
        self._watch = Watch(self._driver.rate)
        self._state, self._why, self._reconnected = State.CLOSED, "", 0
        self._told: tuple[State, tuple[str, ...]] | None = None
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self) -> SensorStream:
        """Begin; the line is opened in the background. A stream is started once."""
        self._thread = threading.Thread(target=self._run, name=str(self.address), daemon=True)
        self._thread.start()
        return self

    def stop(self) -> None:
        """Stop the sensor and close the line; returns when that is done."""
        self._stopping.set()
        if self._thread is not None:
            self._thread.join()

    def __enter__(self) -> SensorStream:
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
            self._driver.parser.counters,
            self._reconnected,
        )

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
            except LineError as error:
                self._why = str(error)
                self._change(State.LOST)
                self._driver.parser.reset()
                self._watch.forget()
                self._line.close()
                self._stopping.wait(_RETRY_S[min(tries, len(_RETRY_S) - 1)])
                tries += 1
                self._reconnected += 1
        self._finish()

    def _begin(self) -> None:
        for command in self._driver.start:
            self._send(command)

    def _send(self, command: Command) -> None:
        """Send a command and wait for its answer; samples that come in between are given on."""
        self._line.write(command.data)
        if command.reply is None:
            return
        heard = b""
        deadline = time.monotonic() + _REPLY_S
        while command.reply not in heard and time.monotonic() < deadline and not self._stopping.is_set():
            chunk = self._line.read(_READ_S)
            heard = (heard + chunk.data)[-_REPLY_BYTES:]
            self._take(chunk.data, chunk.time)

    def _read(self) -> None:
        last = time.monotonic()
        begun_again = last
        while not self._stopping.is_set():
            chunk = self._line.read(_READ_S)
            if self._take(chunk.data, chunk.time):
                last = chunk.time
            elif chunk.time - last > self._watch.patience:
                self._why = (
                    f"{self.address}: no sample for {chunk.time - last:.1f} s: check that the sensor has power and that"
                    " nothing else uses its line."
                )
                self._change(State.SILENT)
                self._watch.forget()
                if chunk.time - max(last, begun_again) > _START_AGAIN_S:
                    self._begin()
                    begun_again = time.monotonic()

    def _take(self, data: bytes, arrived: float) -> bool:
        """Give on the samples that end in these bytes; tells whether there were any."""
        samples = self._driver.parser.feed(data, arrived) if data else []
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
        try:
            for command in self._driver.stop:
                self._line.write(command.data)
        except LineError:
            pass  # it is gone, and with it the stream
        self._line.close()
        self._change(State.CLOSED)

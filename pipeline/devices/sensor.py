"""A force/torque sensor kept streaming."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.clock import SampleClock
from contactbench.pipeline.devices.protocols.registry import driver_for
from contactbench.pipeline.devices.reconnecting_stream import READ_S, ReconnectingStream
from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.devices.transport import line_to
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.devices.watch import Watch
from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.pipeline.devices.protocols import Command, Counters
    from contactbench.pipeline.devices.protocols.parser import SensorDriver
    from contactbench.pipeline.devices.stream import Health
    from contactbench.pipeline.devices.transport import Line

_REPLY_S = 1.0
_REPLY_BYTES = 4096


class SensorStream(ReconnectingStream[WrenchSample]):
    """
    One sensor's samples; see `ReconnectingStream`.

    Parameters
    ----------
    address : DeviceAddress or str
    on_samples, on_change
        As for `ReconnectingStream`.
    line, driver : optional
        Instead of the address's own, such as a line of a test.

    Raises
    ------
    AddressError, ProtocolError
        It is no sensor's address, or the rate does not fit.
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
        where = DeviceAddress.parse(address) if isinstance(address, str) else address
        self._driver = driver or driver_for(where)
        watch = Watch(self._driver.rate, rate_known=self._driver.rate_known, limits=self._driver.limits)
        self._clock = SampleClock(self._driver.rate if self._driver.rate_known else None)
        self._unprepared = ""
        self._unaccepted: dict[str, str] = {}
        super().__init__(where, line or line_to(where), watch, on_samples, on_change)

    def _begin(self) -> None:
        # Once samples were given, those that follow must mean the same.
        if self._driver.prepare is not None and not self._watch.samples:
            self._unprepared = self._driver.prepare()
        self._unaccepted = {}
        for command in self._driver.start:
            self._send(command)

    def _send(self, command: Command) -> None:
        """Send a command and wait for its answer; samples that come in between are given on."""
        self._line.write(command.data)
        if command.settle:
            self._settle(command.settle)
        heard, agreed = b"", command.answered(b"")
        deadline = time.monotonic() + _REPLY_S
        while agreed is None and time.monotonic() < deadline and not self._stopping.is_set():
            chunk = self._line.read(READ_S)
            heard = (heard + chunk.data)[-_REPLY_BYTES:]
            agreed = command.answered(heard)
            self._take(chunk.data, chunk.time)
        if agreed or self._stopping.is_set():
            return
        if command.instead is not None:
            self._send(command.instead)
        elif heard:  # a device that says nothing at all is silent: that is told anyway
            self._refused(command, message("refused it") if agreed is False else message("did not answer"))

    def _settle(self, seconds: float) -> None:
        """Let pass what a stream before this one left on the line."""
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0 and not self._stopping.is_set():
            chunk = self._line.read(min(left, READ_S))
            if chunk.data:
                self._heard = chunk.time
        with self._watching:
            self._driver.parser.reset()

    def _refused(self, command: Command, what: str) -> None:
        shown = command.data.decode("ascii", "backslashreplace").strip()
        with self._watching:
            self._unaccepted[shown] = message(
                f"The device did not accept {arg(shown[:60])!r} (it {arg(what)}): its rate or units may"
                " differ. Check that its firmware is supported."
            )

    def _feed(self, data: bytes, arrived: float) -> list[WrenchSample]:
        return self._clock.stamp(self._driver.parser.feed(data, arrived))

    def _end(self) -> None:
        for command in self._driver.stop:
            self._line.write(command.data)

    def _reset(self) -> None:
        self._driver.parser.reset()
        self._clock.forget()

    def _troubles(self) -> dict[str, str]:
        found = dict(self._unaccepted)
        if self._unprepared:
            found["unprepared"] = self._unprepared
        return found | (self._driver.troubles() if self._driver.troubles is not None else {})

    def _counters(self) -> Counters:
        return self._driver.parser.counters

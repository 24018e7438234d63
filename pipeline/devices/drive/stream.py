"""A force/torque sensor kept streaming."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from pipeline.devices.drive.driver import driver_for
from pipeline.devices.drive.kept import READ_S, KeptStream
from pipeline.devices.sample import WrenchSample
from pipeline.devices.transport import line_to
from pipeline.devices.url import DeviceAddress

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from pipeline.devices.drive.driver import SensorDriver
    from pipeline.devices.drive.health import Health
    from pipeline.devices.protocols import Command, Counters
    from pipeline.devices.transport import Line

_REPLY_S = 1.0
_REPLY_BYTES = 4096


class SensorStream(KeptStream[WrenchSample]):
    """
    One sensor's samples; see `KeptStream`.

    Parameters
    ----------
    address : DeviceAddress or str
    on_samples, on_change
        As for `KeptStream`.
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
        super().__init__(where, line or line_to(where), self._driver.rate, on_samples, on_change)

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
            chunk = self._line.read(READ_S)
            heard = (heard + chunk.data)[-_REPLY_BYTES:]
            self._take(chunk.data, chunk.time)

    def _feed(self, data: bytes, arrived: float) -> list[WrenchSample]:
        return self._driver.parser.feed(data, arrived)

    def _end(self) -> None:
        for command in self._driver.stop:
            self._line.write(command.data)

    def _reset(self) -> None:
        self._driver.parser.reset()

    def _counters(self) -> Counters:
        return self._driver.parser.counters

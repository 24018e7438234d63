"""A robot kept telling where its flange is. It is asked, and never moved."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.pipeline.devices.clock import SampleClock
from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.protocols.parser import ASSUMED_RATE_HZ
from contactbench.pipeline.devices.protocols.registry import driver_of
from contactbench.pipeline.devices.reconnecting_stream import ReconnectingStream
from contactbench.pipeline.devices.sample import FlangeSample
from contactbench.pipeline.devices.transport import line_to
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.devices.watch import Watch
from contactbench.pipeline.errors import arg

if TYPE_CHECKING:
    from contactbench.pipeline.devices.driver import OnChange, OnFlanges
    from contactbench.pipeline.devices.protocols import Counters
    from contactbench.pipeline.devices.protocols.parser import Parser
    from contactbench.pipeline.devices.transport import Line


class ParsedPoses(ReconnectingStream[FlangeSample]):
    """
    A robot that sends its flange by itself, once it was told to.

    Parameters
    ----------
    address : DeviceAddress
    parser : Parser
        Of its poses.
    on_samples, on_change
        As for `ReconnectingStream`.
    start, stop : bytes
        What to send first and last; empty: nothing.
    guess : float
        Poses per second until they have come, where the address gives no rate.
    """

    def __init__(
        self,
        address: DeviceAddress,
        parser: Parser[FlangeSample],
        on_samples: OnFlanges,
        on_change: OnChange = None,
        *,
        start: bytes = b"",
        stop: bytes = b"",
        guess: float = ASSUMED_RATE_HZ,
        line: Line | None = None,
    ) -> None:
        self._parser, self._start, self._stop = parser, start, stop
        self._clock = SampleClock(address.rate)
        watch = Watch(address.rate or guess, rate_known=address.rate is not None)
        super().__init__(address, line or line_to(address), watch, on_samples, on_change)

    def _begin(self) -> None:
        self._parser.begin()
        if self._start:
            self._line.write(self._start)

    def _feed(self, data: bytes, arrived: float) -> list[FlangeSample]:
        return self._clock.stamp(self._parser.feed(data, arrived))

    def _end(self) -> None:
        if self._stop:
            self._line.write(self._stop)

    def _reset(self) -> None:
        self._parser.reset()
        self._clock.forget()

    def _counters(self) -> Counters:
        return self._parser.counters

    def _troubles(self) -> dict[str, str]:
        return self._parser.troubles()


def poses_from(
    address: DeviceAddress | str, on_samples: OnFlanges, on_change: OnChange = None
) -> ReconnectingStream[FlangeSample]:
    """
    Return the stream of the robot at an address, not yet started.

    Raises
    ------
    AddressError
        It is no robot.
    """
    where = DeviceAddress.parse(address) if isinstance(address, str) else address
    known = driver_of(where.protocol)
    if known is None:
        raise AddressError(f"address {arg(str(where))!r}: not a robot. Give the address of a robot.")
    return known.poses(where, on_samples, on_change)

"""A force/torque sensor kept streaming: its parser, the commands that start and stop it, and its answers."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.clock import SampleClock
from contactbench.pipeline.devices.protocols import ati_scale, bota, rdt, robotiq, sri
from contactbench.pipeline.devices.reconnecting_stream import READ_S, ReconnectingStream
from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.devices.transport import line_to
from contactbench.pipeline.devices.url import AddressError, DeviceAddress, Protocol
from contactbench.pipeline.devices.watch import Watch
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.pipeline.devices.protocols import Command, Counters, SensorParser
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
            self._refused(command, "refused it" if agreed is False else "did not answer")

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
            self._unaccepted[shown] = (
                f"The device did not accept {shown[:60]!r} (it {what}): its rate or units may be others; check that its"
                " firmware is known here."
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


# ---- what each sensor needs ---------------------------------------------------------------------

# What its 16 bits hold: there it stops counting.
_ROBOTIQ_LIMITS = (327.67, 32.767)
# RDT without a rate keeps the device's own; a silence is judged by this one.
_ASSUMED_RATE_HZ = 100.0


@dataclass(frozen=True, eq=False)
class SensorDriver:
    """
    One sensor's way to stream.

    Attributes
    ----------
    parser : SensorParser
    start, stop : tuple of Command
        What is sent, and nothing else ever is.
    rate : float
        Samples a second that it should give, Hz.
    rate_known : bool
        False: the sensor has a rate of its own, and `rate` is a guess.
    limits : (force, torque) or None
        Range of each channel, N and N·m, where the protocol tells it.
    prepare : callable, optional
        Asks the device, before it is started, what its samples need; returns what is wrong, or nothing.
    troubles : callable, optional
        Returns what is wrong, by kind, as far as the parser knows.
    """

    parser: SensorParser
    start: tuple[Command, ...]
    stop: tuple[Command, ...]
    rate: float
    rate_known: bool = True
    limits: tuple[float, float] | None = None
    prepare: Callable[[], str] | None = None
    troubles: Callable[[], dict[str, str]] | None = None


def driver_for(address: DeviceAddress) -> SensorDriver:
    """
    Return the driver of the sensor at an address.

    Raises
    ------
    AddressError
        It is a robot or a recording.
    ProtocolError
        The rate does not fit the device or its line.
    """
    rate = address.rate or _ASSUMED_RATE_HZ
    if address.protocol is Protocol.SRI:
        start = sri.start_commands(rate, trailer=sri.Trailer.SUM, baud=address.baud)
        parser = sri.SriParser(either_trailer=True)
        return SensorDriver(
            parser, start, sri.stop_commands(), rate, troubles=lambda: _trailer_troubles(parser)
        )
    if address.protocol is Protocol.BOTA:
        start = bota.start_commands(rate, baud=address.baud or bota.DEFAULT_BAUD)
        return SensorDriver(bota.BotaParser(rate), start, bota.stop_commands(), rate)
    if address.protocol is Protocol.ROBOTIQ:
        return SensorDriver(
            robotiq.RobotiqParser(),
            robotiq.start_commands(rate),
            robotiq.stop_commands(),
            rate,
            limits=_ROBOTIQ_LIMITS,
        )
    if address.protocol is Protocol.RDT:
        return _rdt_driver(address)
    raise AddressError(f"address {str(address)!r}: it is no force/torque sensor: give the address of one.")


def _rdt_driver(address: DeviceAddress) -> SensorDriver:
    profile = rdt.Profile.ONROBOT if address.profile == "onrobot" else rdt.Profile.ATI
    start = rdt.start_commands(address.rate, profile=profile)
    rate = _ASSUMED_RATE_HZ if address.rate is None else rdt.possible_rate(address.rate, profile)
    typical = rdt.ONROBOT_SCALE if profile is rdt.Profile.ONROBOT else rdt.ATI_TYPICAL
    assumed = rdt.CountScale(
        address.counts_per_newton or typical.per_newton,
        address.counts_per_newton_metre or typical.per_newton_metre,
    )
    parser = rdt.RdtParser(assumed)
    known = address.counts_per_newton is not None and address.counts_per_newton_metre is not None
    return SensorDriver(
        parser,
        start,
        rdt.stop_commands(),
        rate,
        rate_known=address.rate is not None,
        prepare=None if known else lambda: _ask_scale(parser, address),
    )


def _ask_scale(parser: rdt.RdtParser, address: DeviceAddress) -> str:
    """Take the sensor's own counts per newton."""
    try:
        parser.scale = ati_scale.scale_for(address)
    except InputError as error:
        scale = parser.scale
        return (
            f"The sensor did not tell its counts per newton ({error}) {scale.per_newton:g} per N and"
            f" {scale.per_newton_metre:g} per N·m are assumed: compare with its calibration sheet, and give cpf and cpt"
            " in the address."
        )
    return ""


def _trailer_troubles(parser: sri.SriParser) -> dict[str, str]:
    if parser.trailer is sri.Trailer.SUM:
        return {}
    return {
        "trailer": "The device did not accept AT+DCKMD=SUM: its frames end with a CRC-32, and are checked by that."
    }

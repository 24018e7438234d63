"""What it takes to make a sensor stream: its parser, and the commands that start and stop it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.protocols import ati_scale, bota, rdt, robotiq, sri
from contactbench.pipeline.devices.url import AddressError, DeviceAddress, Protocol
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.devices.protocols import Command, SensorParser

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

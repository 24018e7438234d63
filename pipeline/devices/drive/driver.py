"""What it takes to make a sensor stream: its parser, and the commands that start and stop it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from pipeline.devices.protocols import bota, rdt, robotiq, sri
from pipeline.devices.url import AddressError, DeviceAddress, Protocol

if TYPE_CHECKING:
    from pipeline.devices.protocols import Command, SensorParser

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
    """

    parser: SensorParser
    start: tuple[Command, ...]
    stop: tuple[Command, ...]
    rate: float


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
        return SensorDriver(sri.SriParser(), start, sri.stop_commands(), rate)
    if address.protocol is Protocol.BOTA:
        start = bota.start_commands(rate, baud=address.baud or bota.DEFAULT_BAUD)
        return SensorDriver(bota.BotaParser(rate), start, bota.stop_commands(), rate)
    if address.protocol is Protocol.ROBOTIQ:
        return SensorDriver(
            robotiq.RobotiqParser(), robotiq.start_commands(rate), robotiq.stop_commands(), rate
        )
    if address.protocol is Protocol.RDT:
        scale = rdt.CountScale(address.counts_per_newton or 1e6, address.counts_per_newton_metre or 1e6)
        profile = rdt.Profile.ONROBOT if address.profile == "onrobot" else rdt.Profile.ATI
        start = rdt.start_commands(rate, profile=profile)
        return SensorDriver(rdt.RdtParser(scale), start, rdt.stop_commands(), rate)
    raise AddressError(f"address {str(address)!r}: it is no force/torque sensor: give the address of one.")

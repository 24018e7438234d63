"""The protocols by their names in an address: a new one needs a line here and one in the table of addresses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.protocols import bota, elfin, rdt, robotiq, sri, ur_pose
from contactbench.pipeline.devices.url import AddressError, DeviceAddress, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.devices.protocols.device_model import Model
    from contactbench.pipeline.devices.protocols.parser import SensorDriver


@dataclass(frozen=True)
class DeviceProtocol:
    """What is known of one protocol."""

    emulated: type[Model]
    driver: Callable[[DeviceAddress], SensorDriver] | None = None  # None: a robot
    # Words in what USB says about a port. Most boxes use a bought converter that says nothing about them.
    usb_words: tuple[str, ...] = ()


PROTOCOLS = {
    Protocol.SRI: DeviceProtocol(sri.SriModel, sri.driver, ("sunrise", "m8128", "m8126", "sri ")),
    Protocol.BOTA: DeviceProtocol(bota.BotaModel, bota.driver, ("bota", "rokubi", "sensone", "minione")),
    Protocol.ROBOTIQ: DeviceProtocol(robotiq.RobotiqModel, robotiq.driver, ("robotiq", "ft300", "ft 300")),
    Protocol.RDT: DeviceProtocol(rdt.RdtModel, rdt.driver),
    Protocol.ELFIN: DeviceProtocol(elfin.ElfinModel),
    Protocol.UR: DeviceProtocol(ur_pose.UrModel),
}


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
    known = PROTOCOLS.get(address.protocol)
    if known is None or known.driver is None:
        raise AddressError(
            f"address {str(address)!r}: not a force/torque sensor. Give the address of a sensor."
        )
    return known.driver(address)

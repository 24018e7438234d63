"""One class a kind of device: all that contactbench knows of it. Built-in ones and plug-ins are alike."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

from contactbench.pipeline.devices.options import Option
from contactbench.pipeline.devices.protocols.device_model import Model, Quirk
from contactbench.pipeline.errors import InputError, arg, message

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from contactbench.pipeline.devices.protocols.parser import SensorDriver
    from contactbench.pipeline.devices.reconnecting_stream import ReconnectingStream
    from contactbench.pipeline.devices.sample import FlangeSample
    from contactbench.pipeline.devices.stream import OnChange, OnFlanges
    from contactbench.pipeline.devices.url import DeviceAddress

_SCHEME = re.compile(r"[a-z][a-z0-9]{1,30}")
_OPTION = re.compile(r"[a-z][a-z0-9_]{0,30}")
_TAKEN = frozenset({"baud", "rate", "replay", "still", "poses", "virtual"})


class AddressError(InputError):
    """An address that names no device; the message names the part and the remedy."""


class Carrier(StrEnum):
    """What carries the bytes."""

    SERIAL = "serial"
    TCP = "tcp"
    UDP = "udp"
    FILE = "file"
    TYPED = "typed"
    SIMULATED = "simulated"


@dataclass(frozen=True)
class Way:
    """One line on which a device can be."""

    carrier: Carrier  # serial, tcp or udp
    port: int | None = None  # of a socket, where an address gives none
    baud: int | None = None  # of a serial line, where an address gives none, bit/s
    frame: int = 0  # bytes of a frame, by which a rate is judged that a serial line cannot carry


class Driver:
    """
    One kind of device: subclass it, fill in what it has, and name the class in an entry point.

    The entry point's group is ``contactbench.sensors`` and its name is the scheme. Nothing but `scheme`, `title`,
    `ways` and one of `sensor` and `poses` is needed.

    Attributes
    ----------
    scheme : str
        How its addresses begin, before ``+tcp://``: small letters and digits.
    title : str
        What people call it.
    ways : tuple of Way
        The lines on which it can be, the usual one first.
    rate : float or None
        Samples per second to ask it for, where the address gives none, Hz; None: what it is set to.
    options : mapping of str to Option
        Of its addresses, beside ``rate`` and, on a serial line, ``baud``.
    emulated : type of Model or None
        What stands in for it in tests and in ``contactbench bench emulate``.
    usb_words : tuple of str
        Words in what USB says about its port, in small letters. Most boxes use a bought converter that says nothing.
    stamped : bool
        Whether the times of its samples are fitted to its own count or clock; False: they are right as they come.
    """

    scheme: ClassVar[str] = ""
    title: ClassVar[str] = ""
    ways: ClassVar[tuple[Way, ...]] = ()
    rate: ClassVar[float | None] = None
    options: ClassVar[Mapping[str, Option]] = MappingProxyType({})
    emulated: ClassVar[type[Model] | None] = None
    usb_words: ClassVar[tuple[str, ...]] = ()
    stamped: ClassVar[bool] = True

    def sensor(self, address: DeviceAddress) -> SensorDriver:
        """
        Return the parser of the sensor at an address, and what starts and stops it.

        Raises
        ------
        ProtocolError
            The rate does not fit the device or its line.
        AddressError
            It is no sensor.
        """
        raise AddressError(
            f"address {arg(str(address))!r}: not a force/torque sensor. Give the address of a sensor."
        )

    def poses(
        self, address: DeviceAddress, on_samples: OnFlanges, on_change: OnChange = None
    ) -> ReconnectingStream[FlangeSample]:
        """
        Return the stream of the flange of the robot at an address, not yet started.

        Raises
        ------
        AddressError
            It is no robot.
        """
        del on_samples, on_change
        raise AddressError(f"address {arg(str(address))!r}: not a robot. Give the address of a robot.")

    def gives_wrenches(self, address: DeviceAddress) -> bool:
        """Tell whether an address of it can be opened as a force/torque sensor."""
        del address
        return type(self).sensor is not Driver.sensor

    def gives_poses(self, address: DeviceAddress) -> bool:
        """Tell whether an address of it can be opened as a source of poses."""
        del address
        return type(self).poses is not Driver.poses

    def complete(self, values: dict[str, Any]) -> dict[str, Any]:
        """
        Return the options of one address, with what follows from others filled in.

        Parameters
        ----------
        values : dict
            Every option by its name, defaults included.

        Raises
        ------
        ValueError
            They contradict each other; says what to give instead.
        """
        return values

    def emulate(
        self, rate: float | None, quirks: Iterable[Quirk | str], options: Mapping[str, Any]
    ) -> tuple[Model, Mapping[str, Any]]:
        """
        Return an emulated device, and the options that its address needs.

        Parameters
        ----------
        rate : float or None
            Frames per second until a command changes it; None: the device's own.
        quirks : iterable of Quirk
        options : mapping
            That somebody gave; those left out are missing.

        Raises
        ------
        EmulatorError
            The device cannot be like that, or there is no emulator.
        """
        from contactbench.pipeline.devices.faults import EmulatorError

        if self.emulated is None:
            raise EmulatorError(f"{arg(self.scheme)}: its driver has no emulator.")
        return self.emulated(rate, quirks), options

    def way(self, carrier: Carrier) -> Way:
        """Return the line of that carrier; there must be one."""
        return next(way for way in self.ways if way.carrier is carrier)


def fault_of(driver: object) -> str:
    """Say what is wrong with a driver's declaration; empty: nothing."""
    if not isinstance(driver, Driver):
        return message("it is not a subclass of contactbench.pipeline.devices.driver.Driver")
    if not isinstance(driver.scheme, str) or not _SCHEME.fullmatch(driver.scheme) or driver.scheme in _TAKEN:
        return message(f"its scheme is {arg(driver.scheme)!r}: give small letters and digits")
    if not isinstance(driver.title, str) or not driver.title.strip():
        return message("it has no title")
    if not isinstance(driver.ways, tuple) or not driver.ways:
        return message("it has no ways: name the lines on which the device can be")
    return next(filter(None, map(_fault_of_way, driver.ways)), "") or _fault_of_the_rest(driver)


def _fault_of_way(way: object) -> str:
    if not isinstance(way, Way):
        return message(f"its way {arg(way)!r} is not a Way")
    if way.carrier is Carrier.SERIAL:
        return "" if way.baud else message("its serial way has no baud rate")
    if way.carrier not in (Carrier.TCP, Carrier.UDP):
        return message(f"its way {arg(way.carrier)} is none of serial, tcp, udp")
    return (
        ""
        if way.port is not None and 1 <= way.port <= 65_535
        else message(f"its {arg(way.carrier)} way has no port")
    )


def _fault_of_the_rest(driver: Driver) -> str:
    for key, option in driver.options.items():
        if not _OPTION.fullmatch(key) or key in _TAKEN or not isinstance(option, Option):
            return message(f"its option {arg(key)!r} is not an Option with a name of its own")
    emulated: object = driver.emulated
    if emulated is not None and not (isinstance(emulated, type) and issubclass(emulated, Model)):
        return message("its emulated is not a subclass of Model")
    kind = type(driver)
    if kind.sensor is Driver.sensor and kind.poses is Driver.poses:
        return message("it has neither sensor nor poses")
    return ""

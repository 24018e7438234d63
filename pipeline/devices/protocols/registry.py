"""The drivers by their schemes: those of contactbench, and those of installed packages."""

from __future__ import annotations

import sys
from collections import Counter
from contextlib import redirect_stdout
from dataclasses import dataclass
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.driver import Driver, fault_of
from contactbench.pipeline.devices.protocols.parser import ProtocolError, SensorDriver
from contactbench.pipeline.errors import InputError, arg, message

if TYPE_CHECKING:
    from contactbench.pipeline.devices.url import DeviceAddress

GROUP = "contactbench.sensors"
"""The group of entry points in which an installed package names its drivers."""

# Imported when one is asked for: some take a third of a second.
_BUILT_IN = {
    name: EntryPoint(name, f"contactbench.pipeline.devices.protocols.{place}", GROUP)
    for name, place in {
        "sri": "sri:SriDriver",
        "bota": "bota:BotaDriver",
        "robotiq": "robotiq:RobotiqDriver",
        "rdt": "rdt:RdtDriver",
        "kunwei": "kunwei:KunweiDriver",
        "robotous": "robotous:RobotousDriver",
        "elfin": "elfin:ElfinDriver",
        "ur": "ur_pose:UrDriver",
        "line": "line:LineDriver",
        "igtl": "igtl_pose:IgtlDriver",
    }.items()
}


@dataclass(frozen=True)
class LeftOut:
    """A plug-in that cannot be used."""

    scheme: str  # as its entry point says
    why: str  # one sentence that names it


def driver_of(scheme: str) -> Driver | None:
    """
    Return the driver of a scheme; None: there is none.

    Raises
    ------
    ValueError
        A plug-in has it, and cannot be used.
    """
    if scheme in _BUILT_IN:
        return _load(_BUILT_IN[scheme])
    usable, left_out = _plug_ins()
    for each in left_out:
        if each.scheme == scheme and scheme not in usable:
            raise ValueError(each.why)
    return usable.get(scheme)


def drivers() -> dict[str, Driver]:
    """Return all drivers that can be used by their schemes, those of contactbench first."""
    return {name: _load(entry) for name, entry in _BUILT_IN.items()} | _plug_ins()[0]


def left_out() -> tuple[LeftOut, ...]:
    """Return the plug-ins that cannot be used."""
    return _plug_ins()[1]


def driver_for(address: DeviceAddress) -> SensorDriver:
    """
    Return the driver of the sensor at an address.

    Raises
    ------
    AddressError
        It is a robot or a recording.
    ProtocolError
        The rate does not fit the device or its line, or a plug-in has failed.
    """
    known = driver_of(address.protocol) or Driver()
    try:
        return known.sensor(address)
    except InputError:
        raise
    except Exception as error:
        raise ProtocolError(
            f"address {arg(str(address))!r}: the driver of {arg(known.title)} failed: {arg(error)!r}. Update the"
            " package that it comes from."
        ) from error


@cache
def _load(entry: EntryPoint) -> Driver:
    made: Driver = entry.load()()
    return made


@cache
def _plug_ins() -> tuple[dict[str, Driver], tuple[LeftOut, ...]]:
    usable: dict[str, Driver] = {}
    wrong: list[LeftOut] = []
    found = sorted(entry_points(group=GROUP), key=lambda entry: (entry.name, entry.value))
    often = Counter(entry.name for entry in found)
    for entry in found:
        why = ""
        if entry.name in _BUILT_IN:
            why = message("contactbench has a driver of that scheme itself")
        elif often[entry.name] > 1:
            why = message("another plug-in has the same scheme")
        else:
            try:
                with redirect_stdout(sys.stderr):  # a command's own is one JSON object
                    made = _load(entry)
                why = fault_of(made)
                if not why and made.scheme != entry.name:
                    why = message(f"its entry point is named otherwise than its scheme {arg(made.scheme)!r}")
            except (Exception, SystemExit) as error:  # noqa: BLE001 - whatever a foreign module does
                why = message(f"it cannot be imported: {arg(error)!r}")
        if why:
            wrong.append(LeftOut(entry.name, _sentence(entry, why)))
        else:
            usable[entry.name] = made
    return usable, tuple(wrong)


def _sentence(entry: EntryPoint, why: str) -> str:
    package = entry.dist.name if entry.dist is not None else message("an installed package")
    return message(
        f"the plug-in {arg(entry.name)} ({arg(entry.value)}) of {arg(package)} is left out: {arg(why)}: repair or"
        " uninstall that package"
    )

"""
Counts per newton of an ATI sensor, from its own web page.

Net F/T boxes and Ethernet Axia sensors tell counts per unit, and which units these are, in netftapi2.xml. The
page is only read; nothing is set.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from xml.parsers import expat

from contactbench.pipeline.devices.protocols.parser import ProtocolError
from contactbench.pipeline.devices.protocols.units import FORCES, TORQUES, unit_factor
from contactbench.pipeline.devices.transport.http_get import MOST_BYTES, http_get
from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from contactbench.pipeline.devices.url import DeviceAddress

PAGE = "/netftapi2.xml"
_PRODUCT, _PER_FORCE, _PER_TORQUE, _FORCE_UNIT, _TORQUE_UNIT = _NAMES = (
    "prodname",
    "cfgcpf",
    "cfgcpt",
    "scfgfu",
    "scfgtu",
)
_NUMBER = re.compile(r"[0-9]{1,12}(?:\.[0-9]{0,12})?(?:[eE][+-]?[0-9]{1,2})?")
_FEWEST, _MOST = 1e-3, 1e12  # counts per unit that any sensor could have
_LONGEST = 80  # characters of a name or number that are looked at


@dataclass(frozen=True, slots=True)
class CountScale:
    """
    Counts per unit.

    Raises
    ------
    ProtocolError
        One is not finite or not positive.
    """

    # ATI sensors tell theirs (and their units) over HTTP; OnRobot's are fixed.
    per_newton: float
    per_newton_metre: float

    def __post_init__(self) -> None:
        for value in (self.per_newton, self.per_newton_metre):
            if not (math.isfinite(value) and value > 0):
                raise ProtocolError(
                    f"RDT: counts per unit must be finite and above 0, not {arg(value)!r}: "
                    "read them from the sensor's configuration page."
                )


ATI_TYPICAL = CountScale(1e6, 1e6)
ONROBOT_SCALE = CountScale(1e4, 1e5)


class ScaleError(ProtocolError):
    """A page that does not tell the counts per newton; the message names the part and the remedy."""


@dataclass(frozen=True, slots=True)
class AtiScale:
    """What an ATI sensor tells of itself."""

    # In SI whatever units the sensor is set to; finite and positive.
    counts_per_newton: float
    counts_per_newton_metre: float
    product: str = ""  # its name; empty where it tells none


def read_scale(host: str, port: int = 80) -> AtiScale:
    """
    Ask a sensor for its counts per newton; takes 2 s at most.

    Parameters
    ----------
    host : str
    port : int
        Of its web server.

    Raises
    ------
    PageError
        The page cannot be had.
    ScaleError
        The page is not what it should be.
    """
    return parse_scale(http_get(host, PAGE, port), host)


def scale_for(address: DeviceAddress, port: int = 80) -> CountScale:
    """
    Return the counts of an RDT sensor: as the address has them, else as its profile or the sensor itself says.

    The sensor is only asked where the profile is ATI's and the address leaves a count out.

    Parameters
    ----------
    address : DeviceAddress
    port : int
        Of the sensor's web server.

    Raises
    ------
    PageError, ScaleError
        As `read_scale`.
    """
    force, torque = address.options["cpf"], address.options["cpt"]
    if force is not None and torque is not None:
        return CountScale(force, torque)
    if address.options["profile"] == "onrobot":
        return CountScale(force or ONROBOT_SCALE.per_newton, torque or ONROBOT_SCALE.per_newton_metre)
    told = read_scale(address.host, port)
    return CountScale(force or told.counts_per_newton, torque or told.counts_per_newton_metre)


def parse_scale(page: bytes, where: str = message("ATI sensor")) -> AtiScale:
    """
    Read the page.

    Parameters
    ----------
    page : bytes
        As it came, of any source.
    where : str
        Names the sensor in messages.

    Raises
    ------
    ScaleError
        It is too long, not XML, has a document type (and with it entities), or lacks a number or a unit.
    """
    found = _texts(page, where)
    return AtiScale(
        _counts(found, _PER_FORCE, _FORCE_UNIT, FORCES, where),
        _counts(found, _PER_TORQUE, _TORQUE_UNIT, TORQUES, where),
        "".join(character for character in found.get(_PRODUCT, "") if character.isprintable()),
    )


def _counts(found: dict[str, str], name: str, unit_name: str, units: dict[str, float], where: str) -> float:
    number, unit = _present(found, name, where), _present(found, unit_name, where)
    factor = unit_factor(units, unit)
    if factor is None:
        raise ScaleError(
            f"{arg(where)}: {arg(PAGE)}: {arg(unit_name)}: unknown unit {arg(unit)!r}: set the sensor to N and N-m, or"
            " give cpf and cpt in the address."
        )
    value = float(number) if _NUMBER.fullmatch(number) else math.nan
    if not _FEWEST <= value <= _MOST:  # also what is not a number
        raise ScaleError(
            f"{arg(where)}: {arg(PAGE)}: {arg(name)}: {arg(number)!r} is not a valid number: give cpf and"
            " cpt in the address."
        )
    return value / factor


def _present(found: dict[str, str], name: str, where: str) -> str:
    if name not in found:
        raise ScaleError(
            f"{arg(where)}: {arg(PAGE)}: {arg(name)} is missing: check that it is an ATI sensor, or give cpf"
            " and cpt in the address."
        )
    return found[name]


def _texts(page: bytes, where: str) -> dict[str, str]:
    """Return the text of each element that is asked for."""
    if len(page) > MOST_BYTES:
        raise ScaleError(
            f"{arg(where)}: {arg(PAGE)} is longer than {arg(MOST_BYTES)} bytes: check the address."
        )
    reader = _Reader(where)
    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.StartElementHandler = reader.begin
    parser.EndElementHandler = reader.end
    parser.CharacterDataHandler = reader.text
    parser.StartDoctypeDeclHandler = reader.refuse
    try:
        parser.Parse(page, True)
    # LookupError, ValueError: an encoding that Python does not have, or not for this.
    except (expat.ExpatError, LookupError, ValueError) as error:
        if isinstance(error, ScaleError):
            raise
        raise ScaleError(
            f"{arg(where)}: {arg(PAGE)} is not XML ({arg(error)}): check that it is an ATI sensor, or give"
            " cpf and cpt in the address."
        ) from error
    return {name: text.strip() for name, text in reader.found.items()}


class _Reader:
    """Keeps the text of the elements that are asked for, each of which may be there once."""

    def __init__(self, where: str) -> None:
        self._where = where
        self._name: str | None = None
        self.found: dict[str, str] = {}

    def begin(self, name: str, _attributes: dict[str, str]) -> None:
        if name in _NAMES and name in self.found:
            raise ScaleError(
                f"{arg(self._where)}: {arg(PAGE)}: {arg(name)} appears twice: give cpf and cpt in the address."
            )
        self._name = name if name in _NAMES else None
        if self._name is not None:
            self.found[self._name] = ""

    def end(self, _name: str) -> None:
        self._name = None

    def text(self, data: str) -> None:
        if self._name is not None:
            self.found[self._name] = (self.found[self._name] + data)[:_LONGEST]

    def refuse(self, *_declaration: Any) -> None:
        # Without a document type there are no entities, so nothing is expanded and nothing fetched.
        raise ScaleError(
            f"{arg(self._where)}: {arg(PAGE)} has a document type, which no sensor page has: check the address."
        )

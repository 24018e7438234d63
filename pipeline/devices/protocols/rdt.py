"""
RDT over UDP: ATI Net F/T and Ethernet Axia, OnRobot and OptoForce HEX.

A record is one datagram of 36 bytes, big endian: the record's number, the sensor's sample number and a
status (uint32 each), six int32 counts. UDP's own checksum is the only one: whatever has 36 bytes is a
record, so a driver must listen to the sensor's address alone.

Counts per newton of an ATI sensor, from its own web page.

Net F/T boxes and Ethernet Axia sensors tell counts per unit, and which units these are, in netftapi2.xml. The
page is only read; nothing is set.
"""

import math
import re
import struct
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, ClassVar
from xml.parsers import expat

from contactbench.pipeline.devices.driver import Carrier, Driver, Way
from contactbench.pipeline.devices.faults import EmulatorError, Fault, FrameMoment, SensorReading, Six
from contactbench.pipeline.devices.options import Option, choice, number
from contactbench.pipeline.devices.protocols.commands import Command, check_rate
from contactbench.pipeline.devices.protocols.device_model import SENSOR_FAULTS, Model, Quirk
from contactbench.pipeline.devices.protocols.parser import (
    ASSUMED_RATE_HZ,
    Counters,
    ProtocolError,
    SensorDriver,
    SensorParser,
)
from contactbench.pipeline.devices.protocols.sequence import SequenceCounter
from contactbench.pipeline.devices.sample import Status, WrenchSample
from contactbench.pipeline.devices.transport.http_get import MOST_BYTES, http_get
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.units import FORCES, TORQUES, unit_factor

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


RECORD_BYTES = 36
PORT = 49152
_RECORD = struct.Struct(">3I6i")
_REQUEST = struct.Struct(">HHI")
_MAGIC = 0x1234

# Datagrams that overtake each other are a few apart; further back is a sensor that began again.
_REORDER = 16


class _Request(IntEnum):
    STOP = 0x0000
    START = 0x0002
    PERIOD = 0x0082
    """OnRobot only: milliseconds between records."""


class Profile(IntEnum):
    """Whose dialect is spoken."""

    ATI = 1
    ONROBOT = 2


SCALES = {"ati": ATI_TYPICAL, "onrobot": ONROBOT_SCALE}
"""By profile. An ATI box may have others: its own configuration page says."""


class RdtParser(SensorParser):
    """
    For RDT records; each `feed` takes one datagram.

    A status other than 0 makes a sample ERROR and INVALID: the word covers saturation and faults, and the
    numbers are then no measurement.

    Parameters
    ----------
    scale : CountScale
        Of this very sensor; may be set until the first sample.
    """

    def __init__(self, scale: CountScale) -> None:
        self.scale = scale
        self._sequence = SequenceCounter(32, reorder=_REORDER)
        self._last = b""
        self._frames = 0
        self._skipped = 0
        self._duplicates = 0

    @property
    def counters(self) -> Counters:
        """As `SensorParser`."""
        return Counters(
            frames=self._frames,
            skipped_bytes=self._skipped,
            duplicates=self._duplicates + self._sequence.overtaken,
            **self._sequence.counted(),
        )

    def feed(self, data: bytes, time: float) -> list[WrenchSample]:
        """As `SensorParser`; `data` is one datagram."""
        if len(data) != RECORD_BYTES:
            self._skipped += len(data)
            return []
        self._frames += 1
        if data == self._last:
            self._duplicates += 1
            return []
        self._last = bytes(data)
        raw, _, status, *counts = _RECORD.unpack(data)
        number = self._sequence.number(raw)
        return [] if number is None else [self._sample(time, number, status, counts)]

    def _sample(self, time: float, number: int, status: int, counts: list[int]) -> WrenchSample:
        fx, fy, fz = (count / self.scale.per_newton for count in counts[:3])
        mx, my, mz = (count / self.scale.per_newton_metre for count in counts[3:])
        flags = Status.OK if status == 0 else Status.ERROR | Status.INVALID
        return WrenchSample(time, (fx, fy, fz), (mx, my, mz), number, flags)


def start_commands(rate_hz: float | None = None, *, profile: Profile = Profile.ATI) -> tuple[Command, ...]:
    """
    Return what makes the sensor stream until it is told to stop.

    An ATI sensor streams at the rate that is set on its configuration page, whatever `rate_hz` is. An
    OnRobot box is told the period, in whole milliseconds, see `possible_rate`; without a rate it is told none,
    and keeps its own.

    Raises
    ------
    ProtocolError
        The rate is not one that the sensor can have.
    """
    start = _request(_Request.START, 0)
    if rate_hz is None:
        return (start,)
    possible = possible_rate(rate_hz, profile)
    return (start,) if profile is Profile.ATI else (_request(_Request.PERIOD, round(1000 / possible)), start)


def possible_rate(rate_hz: float, profile: Profile) -> float:
    """
    Return the nearest rate that the sensor can have, Hz: an OnRobot box counts its period in milliseconds.

    Raises
    ------
    ProtocolError
        It is out of range.
    """
    if profile is Profile.ATI:
        return check_rate("RDT", rate_hz, 1.0, 7000.0)
    return 1000 / round(1000 / check_rate("RDT", rate_hz, 4.0, 1000.0))


def stop_commands() -> tuple[Command, ...]:
    """Return what ends the stream."""
    return (_request(_Request.STOP, 0),)


def _request(command: _Request, argument: int) -> Command:
    return Command(_REQUEST.pack(_MAGIC, command, argument))


def _ask_scale(parser: RdtParser, address: DeviceAddress) -> str:
    """Take the sensor's own counts per newton."""
    try:
        parser.scale = scale_for(address)
    except InputError as error:
        scale = parser.scale
        return message(
            f"The sensor did not report its counts per newton ({arg(error)}) {arg(scale.per_newton):g} per N"
            f" and {arg(scale.per_newton_metre):g} per N·m are assumed: compare with its calibration"
            " sheet, and give cpf and cpt in the address."
        )
    return ""


# ---- emulated: a box that speaks RDT -------------------------------------------------------------

_STOP, _START, _FILTER, _SPEED = 0x0000, 0x0002, 0x0081, 0x0082
_SATURATED = 0x8000_0002
_INT32 = 2**31


def rdt_record(
    values: Six, scale: CountScale, *, sequence: int = 1, ft_sequence: int = 1, status: int = 0
) -> bytes:
    """Return one record of 36 bytes.

    Parameters
    ----------
    values : six floats
        N, N·m.
    scale : CountScale
    sequence, ft_sequence : int
        Of the record and of the sensor's clock, modulo 2**32.
    status : int
        0: no error.
    """
    factors = (scale.per_newton,) * 3 + (scale.per_newton_metre,) * 3
    counts = [max(-_INT32, min(_INT32 - 1, round(v * k))) for v, k in zip(values, factors, strict=True)]
    return struct.pack(">3I6i", sequence % 2**32, ft_sequence % 2**32, status, *counts)


class RdtModel(Model):
    """A box that speaks RDT.

    Parameters
    ----------
    rate : float or None
    quirks : iterable of Quirk
    profile : str
        "ati" or "onrobot".
    """

    name = "rdt"
    own_rate = 500.0
    faults = (SENSOR_FAULTS - {Fault.HEADER}) | {Fault.CLOCK_JUMP}
    full_scale: ClassVar[Six | None] = (150.0, 150.0, 300.0, 15.0, 15.0, 15.0)

    def __init__(
        self, rate: float | None = None, quirks: Iterable[Quirk | str] = (), *, profile: str = "ati"
    ) -> None:
        super().__init__(rate, quirks)
        self._left: int | None = None
        if profile not in SCALES:
            raise EmulatorError(f"profile {arg(profile)!r}: choose one of {arg(', '.join(SCALES))}.")
        self.scale = SCALES[profile]
        self.onrobot = profile == "onrobot"

    def feed(self, data: bytes, silence: float = math.inf) -> list[bytes]:  # noqa: ARG002 - datagrams stay apart
        """Take one datagram; there are no answers but the records."""
        if len(data) != _REQUEST.size or data[:2] != _MAGIC.to_bytes(2, "big"):
            self._refuse(data)
            return []
        command, count = struct.unpack(">HI", data[2:])
        if command == _START:
            self.streaming, self._left = True, count or None
        elif command == _STOP:
            self.streaming = False
        elif self.onrobot and command == _SPEED and count:
            self.rate = 1000 / count
        elif not (self.onrobot and command == _FILTER):
            self._refuse(data)
            return []
        self._obey(data)
        return []

    def frame(self, reading: SensorReading, moment: FrameMoment) -> bytes:
        """Return one record; it stops by itself after as many as were asked for."""
        if self._left is not None:
            self._left -= 1
            self.streaming = self._left > 0
        return rdt_record(
            reading.values,
            self.scale,
            sequence=moment.number + 1,
            ft_sequence=moment.number + 1 + round(moment.jump * self.rate),
            status=_SATURATED if reading.saturated else 0,
        )

    def damaged(self, frame: bytes) -> bytes:
        """Return the record cut short by a byte: it has no checksum of its own."""
        return frame[:-1]

    def _step(self) -> list[bytes]:
        return []


class RdtDriver(Driver):
    """A box that speaks RDT."""

    scheme, title = "rdt", message("ATI or OnRobot (RDT)")
    ways = (Way(Carrier.UDP, port=PORT),)
    options: ClassVar[Mapping[str, Option]] = {
        "profile": Option("Maker of the box: ati or onrobot.", choice(*SCALES), "ati"),
        "cpf": Option("Counts per N; an ATI box is asked for them.", number(message("counts per N"))),
        "cpt": Option("Counts per N·m; an ATI box is asked for them.", number(message("counts per N·m"))),
    }
    emulated = RdtModel

    def complete(self, values: dict[str, Any]) -> dict[str, Any]:
        """Fill in the counts of an OnRobot box: an ATI sensor has counts of its own, and reports them."""
        if values["profile"] == "onrobot":
            usual = {"cpf": ONROBOT_SCALE.per_newton, "cpt": ONROBOT_SCALE.per_newton_metre}
            values |= {name: scale for name, scale in usual.items() if values[name] is None}
        return values

    def sensor(self, address: DeviceAddress) -> SensorDriver:
        """As `Driver`."""
        profile = Profile.ONROBOT if address.options["profile"] == "onrobot" else Profile.ATI
        start = start_commands(address.rate, profile=profile)
        rate = ASSUMED_RATE_HZ if address.rate is None else possible_rate(address.rate, profile)
        typical, cpf, cpt = SCALES[address.options["profile"]], address.options["cpf"], address.options["cpt"]
        parser = RdtParser(CountScale(cpf or typical.per_newton, cpt or typical.per_newton_metre))
        return SensorDriver(
            parser,
            start,
            stop_commands(),
            rate,
            rate_known=address.rate is not None,
            prepare=None if cpf and cpt else lambda: _ask_scale(parser, address),
        )

    def emulate(
        self, rate: float | None, quirks: Iterable[Quirk | str], options: Mapping[str, Any]
    ) -> tuple[Model, Mapping[str, Any]]:
        """As `Driver`; the address has the counts, since there is no page to ask for them as an ATI sensor has."""
        model = RdtModel(rate, quirks, profile=options.get("profile", "ati"))
        counts = {"cpf": model.scale.per_newton, "cpt": model.scale.per_newton_metre}
        return model, {"profile": "ati", **(counts if not model.onrobot else {}), **options}

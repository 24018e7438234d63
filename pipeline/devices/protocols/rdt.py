"""
RDT over UDP: ATI Net F/T and Ethernet Axia, OnRobot and OptoForce HEX.

A record is one datagram of 36 bytes, big endian: the record's number, the sensor's sample number and a
status (uint32 each), six int32 counts. UDP's own checksum is the only one: whatever has 36 bytes is a
record, so a driver must listen to the sensor's address alone.
"""

from __future__ import annotations

import math
import struct
from enum import IntEnum
from typing import TYPE_CHECKING, Any, ClassVar

from contactbench.pipeline.devices.driver import Carrier, Driver, Way
from contactbench.pipeline.devices.faults import EmulatorError, Fault
from contactbench.pipeline.devices.options import Option, choice, number
from contactbench.pipeline.devices.protocols import ati_scale
from contactbench.pipeline.devices.protocols.ati_scale import ATI_TYPICAL, ONROBOT_SCALE, CountScale
from contactbench.pipeline.devices.protocols.commands import Command, check_rate
from contactbench.pipeline.devices.protocols.device_model import SENSOR_FAULTS, Model, Quirk
from contactbench.pipeline.devices.protocols.parser import (
    ASSUMED_RATE_HZ,
    Counters,
    SensorDriver,
    SensorParser,
)
from contactbench.pipeline.devices.protocols.sequence import SequenceCounter
from contactbench.pipeline.devices.sample import Status, WrenchSample
from contactbench.pipeline.errors import InputError, arg, message

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from contactbench.pipeline.devices.faults import FrameMoment, SensorReading, Six
    from contactbench.pipeline.devices.url import DeviceAddress

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
        parser.scale = ati_scale.scale_for(address)
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

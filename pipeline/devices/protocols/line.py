"""
Lines of text from any sensor or robot: columns, or JSON objects, as the address declares.

A line has no checksum. One with another number of columns, without a key, or with a number that is none or cannot be
is dropped and counted; a digit that changed on the way is not seen.
"""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Generic

from contactbench.pipeline.devices.driver import AddressError, Carrier, Driver, Way
from contactbench.pipeline.devices.faults import SYNTHETIC, Fault, FrameMoment, SensorReading, Six
from contactbench.pipeline.devices.protocols.commands import Command
from contactbench.pipeline.devices.protocols.device_model import JOINTS as AT_REST
from contactbench.pipeline.devices.protocols.device_model import WIRE_FAULTS, Model, Quirk
from contactbench.pipeline.devices.protocols.line_layout import (
    COUNT,
    IGNORED,
    OPTIONS,
    POSITION,
    QUATERNION,
    REST,
    STATUS,
    TIME,
    TURN,
    WRENCH,
    Layout,
    unescaped,
    units_of,
    with_file,
)
from contactbench.pipeline.devices.protocols.parser import (
    ASSUMED_RATE_HZ,
    Counters,
    Parser,
    Sample,
    SensorDriver,
    SensorParser,
)
from contactbench.pipeline.devices.protocols.sequence import SequenceCounter
from contactbench.pipeline.devices.reconnecting_stream import ParsedPoses, ReconnectingStream
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.devices.stream import OnChange, OnFlanges
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.units import unit_factor

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.devices.url import DeviceAddress

    Numbers = Mapping[str, float]

    Made = Callable[[Numbers, float, Status, float | None], Sample | str]

    Turned = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64] | None]

_LONGEST_LINE = 8192
_ABSURD = 1e9  # in SI; times may be seconds since 1970
_ABSURD_TIME = 1e12
# Datagrams that overtake each other are a few apart, or less than this, s.
_REORDER, _OVERTAKEN_S = 16, 1.0
_SEPARATORS = ",;\t"
_SHOWN = 60  # characters of a line
_IN_BRACKETS = re.compile(r"\s*[pP]?(?:\[([^][]*)\]|\(([^()]*)\))\s*")
_WITH_UNIT = re.compile(r"([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([A-Za-zµ°][\w·.*/-]*)")
_SHOWN_S = 2.0  # how long after a line was dropped its reason is told


class LineParser(Parser[Sample], Generic[Sample]):
    """
    Lines of one layout.

    Parameters
    ----------
    layout : Layout
    made : callable
        Gets the numbers in SI by their roles, the arrival, the status and the device's time; returns a sample, or
        why the numbers cannot be; empty: no more is known.
    datagrams : bool
        The end of a datagram ends a line.
    """

    def __init__(self, layout: Layout, made: Made[Sample], *, datagrams: bool) -> None:
        self._layout, self._made, self._datagrams = layout, made, datagrams
        self._buffer = bytearray()
        # A line that was under way when we began is not whole, and may look as if it were.
        self._mid_line = not datagrams
        self._terminated = False
        self._sequence = SequenceCounter(layout.bits, reorder=_REORDER if datagrams else 0)
        self._newest = -math.inf
        self._ordered = bool(layout.roles & {TIME, COUNT})
        self._last = b""
        self._now = 0.0
        # Why lines were dropped: how many, when the last was, and why, by the kind of fault.
        self._reasons: dict[str, tuple[int, float, str]] = {}
        self._frames = self._bad = self._skipped = self._duplicates = 0

    @property
    def pending(self) -> int:  # type: ignore[override]
        """Bytes that wait for the end of their line."""
        return len(self._buffer)

    @property
    def counters(self) -> Counters:
        """As `Parser`; a bad line counts as a bad checksum, and line ends as bytes of no kind."""
        return Counters(
            frames=self._frames,
            bad_checksums=self._bad,
            skipped_bytes=self._skipped,
            duplicates=self._duplicates + self._sequence.overtaken,
            **self._sequence.counted(),
        )

    def reset(self) -> None:
        """As `Parser`."""
        self._skipped += len(self._buffer)
        self._buffer.clear()
        self._mid_line = not self._datagrams

    def troubles(self) -> dict[str, str]:
        """As `Parser`: why lines were dropped of late."""
        return {
            kind: message(f"Lines dropped: {arg(count)}, because {arg(why)}.")
            for kind, (count, last, why) in tuple(self._reasons.items())  # the thread that feeds may add one
            if self._now - last < _SHOWN_S
        }

    def feed(self, data: bytes, time: float) -> list[Sample]:
        """As `Parser`."""
        self._now = time
        self._buffer += data
        *lines, rest = bytes(self._buffer).split(b"\n")
        if self._datagrams:
            lines, rest = self._whole(lines, rest), b""
        elif len(rest) > _LONGEST_LINE:
            self._skipped += len(rest)
            rest, self._mid_line = b"", True
        self._buffer[:] = rest
        samples = []
        for line in lines:
            if self._mid_line:
                self._mid_line = False
                self._skipped += len(line)
                continue
            sample = self._read(line, time)
            if sample is not None:
                samples.append(sample)
        return samples

    def _whole(self, lines: list[bytes], rest: bytes) -> list[bytes]:
        """Return a datagram's lines; where lines end with a line end, one without it was cut."""
        self._terminated |= bool(lines)
        if rest and not self._terminated:
            return [rest]
        self._bad += bool(rest)
        self._skipped += len(rest)
        return lines

    def _read(self, line: bytes, time: float) -> Sample | None:
        if not line.rstrip(b"\r"):
            self._skipped += len(line)
            return None
        if self._ordered and line == self._last:
            self._frames += 1
            self._duplicates += 1
            return None
        texts = self._texts(line)
        numbers = texts if isinstance(texts, str) else self._numbers(texts)
        if isinstance(texts, str) or isinstance(numbers, str):
            self._drop(line, str(numbers))
            return None
        status = Status.OK
        if STATUS in texts and not _is_well(texts[STATUS], self._layout.ok):
            status = Status.ERROR | Status.INVALID
        sample = self._made(numbers, time, status, numbers.get(TIME))
        if isinstance(sample, str):
            self._drop(line, sample)
            return None
        self._frames += 1
        self._last = line
        return self._in_order(sample, numbers)

    def _drop(self, line: bytes, why: str = "") -> None:
        self._bad += 1
        self._skipped += len(line)
        if why:
            # Without what the line holds: there is no end of that.
            kind = re.split("['\"]", why, maxsplit=1)[0]
            self._reasons[kind] = self._reasons.get(kind, (0,))[0] + 1, self._now, why

    def _in_order(self, sample: Sample, numbers: Numbers) -> Sample | None:
        """Return a sample with its count; None where a later datagram has overtaken it."""
        if COUNT in numbers:
            sequence = self._sequence.number(int(numbers[COUNT]) % 2**self._layout.bits)
            if sequence is None:
                return None
            return replace(sample, sequence=sequence) if isinstance(sample, WrenchSample) else sample
        if TIME in numbers and self._datagrams:
            if self._newest - _OVERTAKEN_S < numbers[TIME] <= self._newest:
                self._duplicates += 1
                return None
            self._newest = numbers[TIME]
        return sample

    def _texts(self, line: bytes) -> dict[str, Any] | str:
        """Return what stands in each field, or why it is no such line; empty: no more is known."""
        try:
            text = line.decode("ascii" if not self._layout.is_json else "utf-8")
        except UnicodeDecodeError:
            return ""
        if len(text) > _LONGEST_LINE:
            return ""
        # A tab at an end separates an empty column.
        return self._looked_up(text) if self._layout.is_json else self._columns(text.strip(" \r"))

    def _columns(self, text: str) -> dict[str, Any] | str:
        separator, fields = self._layout.separator, self._layout.fields
        if separator is None:
            used = [each for each in _SEPARATORS if each in text]
            if len(used) > 1:
                return message(
                    "they have more than one of comma, semicolon and tab: send decimal points, or name the"
                    " separator with the option separator"
                )
            separator = used[0] if used else None  # None: runs of blanks
        if within := _IN_BRACKETS.fullmatch(text):
            text = within[1] or within[2] or ""
        parts = [part.strip() for part in text.split(separator)]
        if fields[-1][0] == REST:
            fields = fields[:-1]
            parts = parts[: len(fields)]
        elif len(parts) == len(fields) + 1 and not parts[-1]:
            parts.pop()  # the separator at the end of a line
        if len(parts) != len(fields):
            return message(
                f"{arg(text[:_SHOWN])!r} has {arg(len(parts))} columns, and the option fields {arg(len(fields))}"
            )
        found = {role: part for (role, _), part in zip(fields, parts, strict=True) if role != IGNORED}
        empty = next((role for role, part in found.items() if not part), None)
        return found if empty is None else message(f"column {arg(empty)} is empty in {arg(text[:_SHOWN])!r}")

    def _looked_up(self, text: str) -> dict[str, Any] | str:
        try:
            root = json.loads(text)
            return {role: _at(root, path) for role, path in self._layout.fields}
        except (ValueError, LookupError, TypeError, RecursionError):
            return ""

    def _numbers(self, texts: Mapping[str, Any]) -> dict[str, float] | str:
        """Return the numbers in SI, or why one cannot be."""
        found = {}
        for role, value in texts.items():
            if role == STATUS:
                continue
            number = self._in_si(role, value)
            count = role == COUNT and not (number >= 0 and number.is_integer())
            if count or not abs(number) <= (_ABSURD_TIME if role in (TIME, COUNT) else _ABSURD):
                return message(f"column {arg(role)} holds {arg(str(value)[:_SHOWN])!r}")
            found[role] = number
        return found

    def _in_si(self, role: str, value: Any) -> float:
        """Return a number in SI; a unit behind it counts, not the declared one."""
        factor, plain = self._layout.factors.get(role, 1.0), _number(value)
        if math.isnan(plain) and isinstance(value, str) and (parts := _WITH_UNIT.fullmatch(value)):
            own = unit_factor(units_of(role), parts[2])
            return math.nan if own is None else _number(parts[1]) * math.copysign(own, factor)
        return plain * factor


def _at(root: Any, path: str) -> Any:
    for step in path.split("."):
        root = root[int(step)] if isinstance(root, list) and step.isdecimal() else root[step]
    return root


def _number(value: Any) -> float:
    """Return a number; NaN for what is none, of which Python reads more than anybody sends."""
    if (
        isinstance(value, bool)
        or not isinstance(value, int | float | str)
        or (isinstance(value, str) and "_" in value)
    ):
        return math.nan
    try:
        return float(value)
    except (ValueError, OverflowError):
        return math.nan


def _is_well(status: Any, ok: str) -> bool:
    """Tell whether a status is the declared one; numbers by their value, and JSON's true is ``true`` and 1."""
    if isinstance(status, bool):
        return ok.lower() == str(status).lower() or _number(ok) == status
    return str(status) == ok or _number(status) == _number(ok)


class LineWrenches(LineParser[WrenchSample], SensorParser):
    """Lines with a wrench."""

    def __init__(self, layout: Layout, *, datagrams: bool) -> None:
        super().__init__(layout, _wrench, datagrams=datagrams)


def _wrench(numbers: Numbers, time: float, status: Status, device_time: float | None) -> WrenchSample:
    fx, fy, fz, mx, my, mz = (numbers[role] for role in WRENCH)
    return WrenchSample(time, (fx, fy, fz), (mx, my, mz), None, status, device_time)


# ---- emulated: a device that sends lines ---------------------------------------------------------


class LineModel(Model):
    """
    A sensor that sends lines of a layout.

    Parameters
    ----------
    layout : Layout
    rate, quirks
        As `Model`.
    start : bytes
        What it waits for; empty: it sends by itself.
    """

    name = "line"
    own_rate = 100.0
    faults = WIRE_FAULTS | {Fault.WRONG_RATE, Fault.CLOCK_JUMP, Fault.SATURATION, Fault.DRIFT, Fault.REZERO}
    rest: ClassVar[Six] = SYNTHETIC
    full_scale: ClassVar[Six | None] = (500.0, 500.0, 1000.0, 15.0, 15.0, 10.0)

    def __init__(
        self,
        layout: Layout,
        rate: float | None = None,
        quirks: Iterable[Quirk | str] = (),
        start: bytes = b"",
    ) -> None:
        super().__init__(rate, quirks)
        self._layout, self._start = layout, start
        self.streaming = not start

    def restart(self) -> None:
        """Come up again."""
        super().restart()
        self.streaming = not self._start

    def frame(self, reading: SensorReading, moment: FrameMoment) -> bytes:
        """Return one line."""
        layout = self._layout
        values: dict[str, float | str] = {
            TIME: moment.clock,
            COUNT: moment.number % 2**layout.bits,
            **self._measured(reading),
        }
        written = {role: self._written(role, value) for role, value in values.items()}
        written[STATUS] = "1" if reading.saturated and layout.ok != "1" else layout.ok
        if layout.is_json:
            return (
                json.dumps(_nested([(path, written[role]) for role, path in layout.fields])).encode() + b"\n"
            )
        separator = layout.separator or ","
        return separator.join(str(written.get(role, 0)) for role, _ in layout.fields).encode("ascii") + b"\n"

    def damaged(self, frame: bytes) -> bytes:
        """Return a line of as many question marks: no line has a checksum."""
        return b"?" * (len(frame) - 1) + b"\n"

    def _measured(self, reading: SensorReading) -> dict[str, float]:
        return dict(zip(WRENCH, reading.values, strict=True))

    def _written(self, role: str, value: float | str) -> float | int | str:
        if isinstance(value, str) or role == COUNT:
            return value
        return round(float(value) / self._layout.factors.get(role, 1.0), 9)

    def _step(self) -> list[bytes]:
        if not self._start:
            self._take(len(self._pending))  # such as what tells a datagram's way back
        elif self._pending.startswith(self._start):
            self._obey(self._take(len(self._start)))
            self.streaming = True
        elif not self._start.startswith(self._pending):
            self._refuse(self._take(len(self._pending)))
        return []


class LinePoseModel(LineModel):
    """A robot that sends lines of a layout; its signal is the joint angles of an Elfin3, rad."""

    faults = WIRE_FAULTS | {Fault.WRONG_RATE, Fault.CLOCK_JUMP}
    rest: ClassVar[Six] = AT_REST
    swing: ClassVar[Six] = (0.2,) * 6
    swing_hz = 0.2
    full_scale: ClassVar[Six | None] = None

    def _measured(self, reading: SensorReading) -> dict[str, float]:
        from scipy.spatial.transform import Rotation

        from contactbench.pipeline.devices.protocols.arms import ELFIN3_TABLE, flange_pose

        R_BE, p_BE_B = flange_pose(ELFIN3_TABLE, reading.values)
        rotation = Rotation.from_matrix(R_BE)
        x, y, z, w = rotation.as_quat()
        turn = rotation.as_rotvec() if self._layout.rotation == "vector" else rotation.as_euler("xyz")
        joints = {f"q{number}": value for number, value in enumerate(reading.values, 1)}
        return {
            **joints,
            **dict(zip(POSITION, p_BE_B.tolist(), strict=True)),
            **dict(zip(QUATERNION, (float(w), float(x), float(y), float(z)), strict=True)),
            **dict(zip(TURN, turn.tolist(), strict=True)),
        }


def _nested(pairs: Sequence[tuple[str, object]]) -> Any:
    """Return an object that has these values at these paths; a whole number in a path is a place in a list."""
    if len(pairs) == 1 and not pairs[0][0]:
        return pairs[0][1]
    groups: dict[str, list[tuple[str, object]]] = {}
    for path, value in pairs:
        step, _, rest = path.partition(".")
        groups.setdefault(step, []).append((rest, value))
    made = {step: _nested(inner) for step, inner in groups.items()}
    if all(step.isdecimal() for step in made):
        return [made.get(str(index), 0) for index in range(max(map(int, made)) + 1)]
    return made


class LineDriver(Driver):
    """Anything that sends lines."""

    scheme, title = "line", message("Text or JSON lines")
    ways = (Way(Carrier.UDP, port=5005), Way(Carrier.TCP, port=5005), Way(Carrier.SERIAL, baud=115_200))
    options = OPTIONS
    emulated = LineModel

    def complete(self, values: dict[str, Any]) -> dict[str, Any]:
        """As `Driver`; the layout's file becomes part of the address, so that a recording tells all."""
        values = with_file(values)
        Layout.of(values)
        return values

    def gives_wrenches(self, address: DeviceAddress) -> bool:
        """As `Driver`."""
        return Layout.of(address.options).gives_wrenches

    def gives_poses(self, address: DeviceAddress) -> bool:
        """As `Driver`."""
        return Layout.of(address.options).gives_poses

    def sensor(self, address: DeviceAddress) -> SensorDriver:
        """As `Driver`."""
        layout = Layout.of(address.options)
        if not layout.gives_wrenches:
            raise AddressError(f"address {arg(str(address))!r}: fields: give fx,fy,fz,mx,my,mz of a sensor.")
        start, stop = _talk(address)
        parser = LineWrenches(layout, datagrams=address.carrier is Carrier.UDP)
        return SensorDriver(
            parser,
            tuple(Command(data) for data in (start,) if data),
            tuple(Command(data) for data in (stop,) if data),
            address.rate or ASSUMED_RATE_HZ,
            rate_known=address.rate is not None,
            troubles=parser.troubles,
        )

    def poses(
        self, address: DeviceAddress, on_samples: OnFlanges, on_change: OnChange = None
    ) -> ReconnectingStream[FlangeSample]:
        """As `Driver`."""
        layout = Layout.of(address.options)
        if not layout.gives_poses:
            raise AddressError(
                f"address {arg(str(address))!r}: fields: give qw,qx,qy,qz, rx,ry,rz or q1,q2,... of a robot."
            )
        parser: LineParser[FlangeSample] = LineParser(
            layout, pose_maker(layout), datagrams=address.carrier is Carrier.UDP
        )
        start, stop = _talk(address)
        return ParsedPoses(address, parser, on_samples, on_change, start=start, stop=stop)

    def emulate(
        self, rate: float | None, quirks: Iterable[Quirk | str], options: Mapping[str, Any]
    ) -> tuple[Model, Mapping[str, Any]]:
        """As `Driver`."""
        from contactbench.pipeline.devices.faults import EmulatorError

        try:
            whole = with_file(options)
            layout = Layout.of(whole)
        except ValueError as error:
            raise EmulatorError(f"line: {arg(error)}.") from error
        kind = LineModel if layout.gives_wrenches else LinePoseModel
        return kind(layout, rate, quirks, unescaped(whole["start"])), whole


def _talk(address: DeviceAddress) -> tuple[bytes, bytes]:
    """Return what starts and what stops a device; a datagram tells it the way back."""
    start, stop = unescaped(address.options["start"]), unescaped(address.options["stop"])
    if address.carrier is Carrier.UDP and address.options["listen"] is None:
        return start or b"\n", stop
    return start, stop


# ---- flange poses from the numbers of a line -----------------------------------------------------


_FARTHEST_M = 1e3
_UNIT = 0.02  # a quaternion written with two digits is this far from unit length
_TURN = 2 * math.pi + 0.01  # no controller tells more than a turn, but it rounds
_BEYOND = 0.02  # an arm that stands at a limit tells a bit more than that, rad


def pose_maker(layout: Layout) -> Made[FlangeSample]:
    """
    Return what makes a pose from a line's numbers.

    Raises
    ------
    InputError
        There is no such robot, or MuJoCo is not installed.
    """
    turned = _by_joints(layout) if layout.joints else _by_rotation(layout)

    def made(numbers: Numbers, time: float, status: Status, device_time: float | None) -> FlangeSample | str:
        pose = turned(numbers)
        if isinstance(pose, str):
            return pose
        if status is not Status.OK:
            return ""
        R_BE, p_BE_B, joints = pose
        return FlangeSample(time, R_BE, p_BE_B, joints, device_time)

    return made


def _unit_doubt(layout: Layout) -> str:
    return (
        message("check the option angle of the address")
        if abs(layout.factors[TURN[0]]) != 1  # declared: perhaps by mistake
        else message("if they are degrees, set the option angle of the address to deg")
    )


def _by_rotation(layout: Layout) -> Callable[[Numbers], Turned | str]:
    import numpy as np
    from scipy.spatial.transform import Rotation  # a third of a second to import

    positioned = layout.roles.issuperset(POSITION)
    too_far = message(f"their angles are more than one turn in radians: {arg(_unit_doubt(layout))}")

    def turned(numbers: Numbers) -> Turned | str:
        position = np.array([numbers[role] if positioned else math.nan for role in POSITION])
        if (np.abs(position) > _FARTHEST_M).any():
            return ""
        if layout.rotation is None:
            w, x, y, z = (numbers[role] for role in QUATERNION)
            if not abs(math.sqrt(w * w + x * x + y * y + z * z) - 1) <= _UNIT:
                return ""
            rotation = Rotation.from_quat([x, y, z, w])
        else:
            turn = [numbers[role] for role in TURN]
            largest = math.hypot(*turn) if layout.rotation == "vector" else max(map(abs, turn))
            if largest > _TURN:
                return too_far
            # Lower case: about the fixed axes, one after the other.
            rotation = (
                Rotation.from_rotvec(turn)
                if layout.rotation == "vector"
                else Rotation.from_euler("xyz", turn)
            )
        return rotation.as_matrix(), position, None

    return turned


def _by_joints(layout: Layout) -> Callable[[Numbers], Turned | str]:
    import numpy as np

    from contactbench.pipeline.robot import Robot

    robot = Robot.named(layout.robot or "")
    if len(layout.joints) != len(robot.lower):
        raise InputError(
            f"robot {arg(robot.description.name)}: it has {arg(len(robot.lower))} joints, and the lines have"
            f" {arg(len(layout.joints))}: declare q1 to q{arg(len(robot.lower))}."
        )
    robot.flange_pose(np.zeros(len(robot.lower)))  # says at once where MuJoCo is missing

    beyond = message(
        f"their joints are beyond the limits of {arg(robot.description.name)}: {arg(_unit_doubt(layout))}"
    )

    def turned(numbers: Numbers) -> Turned | str:
        joints = np.array([numbers[role] for role in layout.joints])
        if (joints < robot.lower - _BEYOND).any() or (joints > robot.upper + _BEYOND).any():
            return beyond
        try:
            return *robot.flange_pose(joints), joints
        except InputError:
            return ""

    return turned

"""
Hans Robot's controllers (Elfin), the text protocol on TCP port 10003.

A request is "<Command>,<arguments>,;", an answer "<Command>,OK,<values>,;" or "<Command>,Fail,<code>,;";
an unknown command is answered by "errorcmd,...". Only questions are asked here.

Which half of an Elfin's position is joints, found out from the arm's kinematics; and the flange from it.

Software versions disagree on the order of joints and pose. The joints must lead to the pose by the forward
kinematics, so one reading settles the order, the convention of the angles, and whether the active tool
frame is turned against the flange.
"""

import math
import re
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.driver import Carrier, Driver, Way
from contactbench.pipeline.devices.faults import FrameMoment, SensorReading, Six
from contactbench.pipeline.devices.protocols.arms import ELFIN3_TABLE, flange_pose
from contactbench.pipeline.devices.protocols.device_model import JOINTS, WIRE_FAULTS, Model, Quirk
from contactbench.pipeline.devices.protocols.parser import Counters, ProtocolError
from contactbench.pipeline.devices.protocols.scanner import Pieces
from contactbench.pipeline.devices.reconnecting_stream import READ_S, ReconnectingStream
from contactbench.pipeline.devices.sample import FlangeSample
from contactbench.pipeline.devices.stream import OnChange, OnFlanges
from contactbench.pipeline.devices.transport import Line, LineLost, line_to
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.devices.watch import Watch
from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.robot import Robot

_POSITION = "ReadActPos"
REQUEST = f"{_POSITION},0,;".encode()
"""All that is ever asked, of the first robot of the controller: joints and Cartesian pose, together."""
_NUMBERS = 12
_END = b";"
# Several times the longest answer known, of 24 numbers.
_LONGEST_REPLY = 2048

# Narrower than float(), which also reads "1_0" and numbers of any length.
_DECIMAL = re.compile(r"\s*[+-]?(\d{1,30}(\.\d{0,30})?|\.\d{1,30})([eE][+-]?\d{1,3})?\s*")


class ElfinError(ProtocolError):
    """An answer of the controller that cannot be used."""


class ReplyKind(Enum):
    """How the controller answered."""

    OK = "OK"
    FAIL = "Fail"
    UNKNOWN_COMMAND = "errorcmd"


@dataclass(frozen=True, slots=True)
class Reply:
    """One answer."""

    command: str  # the question that it answers; empty for an unknown command
    kind: ReplyKind
    values: tuple[str, ...] = ()  # what follows OK or Fail


class ReplyReader(Pieces):
    """
    Cuts a stream into answers; what is no answer is dropped and counted.

    Attributes
    ----------
    malformed : int
        Pieces that ended in ";" but were no answer, or were longer than any answer.
    skipped_bytes : int
        Their bytes.
    """

    def __init__(self) -> None:
        super().__init__()
        self._overlong = False
        self.malformed = 0

    def feed(self, data: bytes) -> list[Reply]:
        """Take bytes as they arrive, cut anywhere; return the answers that end in them, oldest first."""
        replies: list[Reply] = []
        *whole, rest = bytes(data).split(_END)
        for piece in whole:
            self._collect(piece)
            reply = None if self._overlong else _reply(bytes(self._buffer))
            if reply is None:
                self.malformed += 1
                self.skipped_bytes += len(self._buffer) + len(_END)
            else:
                replies.append(reply)
            self._buffer.clear()
            self._overlong = False
        self._collect(rest)
        return replies

    def reset(self) -> None:
        """Forget half an answer, after the line was lost."""
        super().reset()
        self._overlong = False

    def _collect(self, piece: bytes) -> None:
        if self._overlong or len(self._buffer) + len(piece) > _LONGEST_REPLY:
            self._overlong = True
            self.skipped_bytes += len(self._buffer) + len(piece)
            self._buffer.clear()
        else:
            self._buffer += piece


def read_position(reply: Reply) -> tuple[float, ...]:
    """
    Read joints and Cartesian pose, as the controller gives them: degrees and mm.

    Returns
    -------
    tuple of float
        12, also where newer firmware sends 24.

    Raises
    ------
    ElfinError
        It answers something else, is a failure, or a value is missing or not a finite number.
    """
    if reply.kind is ReplyKind.UNKNOWN_COMMAND:
        raise ElfinError(f"Elfin: the controller does not know {arg(_POSITION)}. Use another query.")
    if reply.command != _POSITION:
        raise ElfinError(f"Elfin: asked for {arg(_POSITION)}, received {arg(reply.command)!r}. Reconnect.")
    if reply.kind is ReplyKind.FAIL:
        code = reply.values[0] if reply.values else "none"
        raise ElfinError(
            f"Elfin: the controller refused {arg(_POSITION)} with error code {arg(code)}. Look it up on the"
            " robot's panel."
        )
    if len(reply.values) < _NUMBERS:
        raise ElfinError(
            f"Elfin: {arg(_POSITION)} returned {arg(len(reply.values))} values instead of {arg(_NUMBERS)}: this"
            " controller's software is not supported."
        )
    return tuple(map(_finite, reply.values[:_NUMBERS]))


def _reply(piece: bytes) -> Reply | None:
    if not piece.isascii():
        return None
    command, *fields = piece.decode("ascii").strip().removesuffix(",").split(",")
    if command == ReplyKind.UNKNOWN_COMMAND.value:
        return Reply("", ReplyKind.UNKNOWN_COMMAND, tuple(fields))
    if not command.isalnum() or not fields:
        return None
    for outcome in (ReplyKind.OK, ReplyKind.FAIL):
        if fields[0] == outcome.value:
            return Reply(command, outcome, tuple(fields[1:]))
    return None


def _finite(text: str) -> float:
    number = float(text) if _DECIMAL.fullmatch(text) else math.nan
    if not math.isfinite(number):
        raise ElfinError(
            f"Elfin: {arg(text[:40])!r} is not a finite number: the controller has no position yet."
        )
    return number


# ---- emulated: an Elfin3's controller ------------------------------------------------------------

_STATE = (0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1)  # enabled, still, no error, electrified, board connected
_POSES = ("ReadActPos", "ReadPcsActualPos", "ReadActACS")


class ElfinModel(Model):
    """An Elfin3; its signal is the joint angles in rad.

    Parameters
    ----------
    rate : float or None
        Of no meaning: it answers when it is asked.
    quirks : iterable of Quirk
    """

    name = "elfin"
    rest: ClassVar[Six] = JOINTS
    swing: ClassVar[Six] = (0.2,) * 6
    swing_hz = 0.2
    own_rate = 50.0
    faults = WIRE_FAULTS
    asked_only = True
    possible_quirks: ClassVar[frozenset[Quirk]] = frozenset({Quirk.OLDER})

    def __init__(self, rate: float | None = None, quirks: Iterable[Quirk | str] = ()) -> None:
        super().__init__(rate, quirks)
        self._asked = "ReadActPos"

    def frame(self, reading: SensorReading, moment: FrameMoment) -> bytes:  # noqa: ARG002 - it has no clock
        """Return the answer to the pose request that came last."""
        R_BE, p_BE_B = flange_pose(ELFIN3_TABLE, reading.values)
        joints = np.degrees(reading.values).tolist()
        angles = Rotation.from_matrix(R_BE).as_euler("xyz", degrees=True).tolist()
        cartesian = [*(1e3 * p_BE_B).tolist(), *angles]
        if self._asked == "ReadActACS":
            return _answer(self._asked, joints)
        if self._asked == "ReadPcsActualPos":
            return _answer(self._asked, cartesian)
        rest = [] if Quirk.OLDER in self.quirks else [0.0] * 12
        return _answer(self._asked, [*joints, *cartesian, *rest])

    def damaged(self, frame: bytes) -> bytes:
        """Return a failure in its place: the protocol has no checksum."""
        return frame.partition(b",")[0] + b",Fail,20011,;"

    def _step(self) -> list[bytes]:
        line, end, _ = self._pending.partition(b";")
        if not end:
            return []
        request = self._take(len(line) + 1)
        name, *arguments = line.decode("ascii", "replace").split(",")
        answer = self._reply(name, arguments)
        if answer is None:
            self._refuse(request)
            return [b"errorcmd,Fail,20004,;"]
        self._obey(request)
        return [answer]

    def _reply(self, name: str, arguments: list[str]) -> bytes | None:
        if arguments[-1:] != [""]:
            return None
        if name in _POSES and arguments == ["0", ""]:
            self._asked = name
            return self.frame(*self._now())
        if name == "ReadTCPByName" and len(arguments) == 3:
            return _answer(name, [0.0] * 6)
        still: dict[str, Sequence[float]] = {
            "ReadRobotState": _STATE,
            "ReadMoveState": (0,),
            "ReadCurFSM": (33,),
            "ReadForceSensorData": (0.0,) * 6,
        }
        return _answer(name, still[name]) if name in still else None


def _answer(name: str, values: Sequence[float]) -> bytes:
    numbers = ",".join(str(v) if isinstance(v, int) else f"{v:.6f}" for v in values)
    return f"{name},OK,{numbers},;".encode("ascii")


# ---- which half of an Elfin's position is joints, found out from the arm's kinematics ------------


_MILLIMETRE = 1e-3
_ABSURD = 1e6  # mm or degrees

# Angles are printed to a thousandth of a degree or so; a wrong order is off by tens of degrees.
ROTATION_TOLERANCE_DEG = 0.5
# No probe or tool reaches further from the flange, m.
LONGEST_TOOL = 0.6

_USUAL_RATE_HZ = 50.0
# Without an answer for so long, a line is opened again: questions that wait add up in a slow controller.
_UNANSWERED_S = 1.0
# After a piece that was no answer none follows, or it would have come.
_GARBLED_S = 0.1
# Half of it is how wrong the time of a pose may be; a flange at 0.2 rad/s has turned by 0.3 degrees then.
_LATEST_S = 0.05
_SHOWN_S = 2.0


class FieldOrder(Enum):
    """What comes first in the controller's answer; the value is where the joints begin."""

    JOINTS_FIRST = 0
    POSE_FIRST = 6


@dataclass(frozen=True, slots=True)
class OrderFit:
    """How well joints and pose agree under one order."""

    order: FieldOrder
    rotation_deg: float  # angle between the flange by kinematics and the controller's pose, degrees
    tool: tuple[float, float, float]  # origin of the controller's tool frame in the flange frame E, m

    @property
    def good(self) -> bool:
        """Whether the tool frame is parallel to the flange, and no further away than a tool can be."""
        return (
            self.rotation_deg <= ROTATION_TOLERANCE_DEG and float(np.linalg.norm(self.tool)) <= LONGEST_TOOL
        )


def resolve_order(numbers: Sequence[float], robot: Robot) -> OrderFit:
    """
    Find the order of joints and pose.

    Parameters
    ----------
    numbers : 12 floats
        As the controller gives them: degrees, mm.
    robot : Robot
        The arm.

    Raises
    ------
    ElfinError
        Neither order fits, or both do.
    InputError
        The arm's kinematics cannot be computed.
    """
    fits = [fit_order(numbers, order, robot) for order in FieldOrder]
    good = [fit for fit in fits if fit.good]
    if len(good) == 1:
        return good[0]
    if good:
        raise ElfinError("Elfin: joints and pose look the same here. Move the arm and try again.")
    found = join(
        message(" and "),
        (
            message(
                f"{arg(fit.rotation_deg):.1f}° and {arg(np.linalg.norm(fit.tool) * 1e3):.0f} mm"
                f" ({arg(fit.order.name.lower())})"
            )
            for fit in fits
        ),
    )
    raise ElfinError(
        f"Elfin: joints and pose do not match: the tool frame is {arg(found)} from the flange of"
        f" {arg(robot.description.name)}. Choose a tool frame without rotation, and check the robot"
        " model."
    )


def fit_order(numbers: Sequence[float], order: FieldOrder, robot: Robot) -> OrderFit:
    """Compare joints and pose under one order; parameters and errors as `resolve_order`."""
    joints, position, R_BT = _split(numbers, order)
    R_BE, p_BE_B = robot.flange_pose(joints)
    off = Rotation.from_matrix(R_BE.T @ R_BT).magnitude()
    x, y, z = R_BE.T @ (position - p_BE_B)
    return OrderFit(order, float(np.degrees(off)), (float(x), float(y), float(z)))


def flange_sample(numbers: Sequence[float], order: FieldOrder, time: float, robot: Robot) -> FlangeSample:
    """
    Make a sample from the controller's 12 numbers: the flange follows from the joints alone.

    Parameters
    ----------
    numbers : 12 floats
        Degrees, mm.
    order : FieldOrder
        As `resolve_order` found it.
    time : float
        When the robot was there, seconds of the host's monotonic clock.
    robot : Robot
        The arm.

    Raises
    ------
    ElfinError
        There are not 12 finite numbers.
    InputError
        The arm's kinematics cannot be computed.
    """
    joints, _, _ = _split(numbers, order)
    return FlangeSample(time, *robot.flange_pose(joints), joints)


def _split(
    numbers: Sequence[float], order: FieldOrder
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return joints (6,) rad, position (3,) m and orientation (3, 3) of the tool frame T in the base B."""
    values = np.asarray(numbers, dtype=np.float64)
    # NaN fails the comparison too.
    if values.shape != (_NUMBERS,) or not (np.abs(values) < _ABSURD).all():
        raise ElfinError(f"Elfin: {arg(tuple(numbers))!r} are not six angles and a pose: reconnect.")
    joints, pose = values[:6], values[6:]
    if order is FieldOrder.POSE_FIRST:
        joints, pose = pose, joints
    # Lower case: turns about the fixed axes, R = Rz Ry Rx.
    R_BT = Rotation.from_euler("xyz", pose[3:], degrees=True).as_matrix()
    return np.radians(joints), pose[:3] * _MILLIMETRE, R_BT


class ElfinPoses(ReconnectingStream[FlangeSample]):
    """
    An Elfin robot's flange, asked for at the address's rate.

    The first answer settles whether joints or pose come first, by the arm's kinematics. One question waits for
    its answer at a time; a pose belongs to the middle between question and answer, and where they are too far
    apart it is dropped.

    Parameters
    ----------
    address : DeviceAddress
    on_samples, on_change
        As for `ReconnectingStream`.
    robot : Robot, optional
        The arm; an Elfin3 when left out.

    Raises
    ------
    InputError
        The arm's kinematics cannot be computed: MuJoCo is not installed.
    """

    def __init__(
        self,
        address: DeviceAddress,
        on_samples: OnFlanges,
        on_change: OnChange = None,
        *,
        robot: Robot | None = None,
        line: Line | None = None,
    ) -> None:
        from contactbench.pipeline.robot import Robot as Known  # its kinematics take a third of a second

        rate = address.rate or _USUAL_RATE_HZ
        self._robot = robot or Known.named("elfin3")
        self._robot.flange_pose(np.zeros(6))  # says at once where MuJoCo is missing
        self._period = 1.0 / rate
        self._replies = ReplyReader()
        self._order: FieldOrder | None = None
        self._asked: float | None = None
        self._next = 0.0
        self._trouble, self._refused = "", 0
        self._malformed = 0  # when the question was asked
        self._late, self._lateness, self._late_at = 0, 0.0, float("-inf")
        super().__init__(address, line or line_to(address), Watch(rate), on_samples, on_change)

    def _begin(self) -> None:
        """Nothing: whoever is asked answers."""

    def _idle(self, now: float) -> float:
        if self._asked is not None:
            self._await(now - self._asked)
        if now >= self._next and self._asked is None:
            self._malformed = self._replies.malformed
            self._asked = time.monotonic()  # before it is sent: no answer can be older
            self._line.write(REQUEST)
            # At its own pace: what came late is not asked for twice as fast.
            self._next = max(self._next + self._period, now)
        return READ_S if self._asked is not None else min(READ_S, max(self._next - now, 0.0))

    def _await(self, waited: float) -> None:
        if waited > _GARBLED_S and self._replies.malformed > self._malformed:
            self._asked = None
        elif waited > _UNANSWERED_S:
            raise LineLost(
                f"{arg(self._line.name)}: no answer for {arg(_UNANSWERED_S):g} s: check that the controller"
                " is not busy. Reconnecting."
            )

    def _feed(self, data: bytes, arrived: float) -> list[FlangeSample]:
        samples = []
        for reply in self._replies.feed(data):
            asked, self._asked = self._asked, None
            if asked is None:  # of which question, and so of when, it tells nobody knows
                self._refused += 1
                continue
            try:
                numbers = read_position(reply)
            except ElfinError as error:  # the line is well: the next answer may be
                self._trouble = str(error)
                self._refused += 1
                continue
            if self._order is None:
                self._order = resolve_order(numbers, self._robot).order
            self._trouble = ""
            if arrived - asked > _LATEST_S:
                self._late += 1
                self._lateness, self._late_at = arrived - asked, arrived
                continue
            pose = flange_sample(numbers, self._order, (asked + arrived) / 2, self._robot)
            samples.append(replace(pose, arrival=arrived))
        return samples

    def _end(self) -> None:
        """Leave the robot alone: it was only asked."""

    def _reset(self) -> None:
        self._replies.reset()
        self._trouble = ""
        self._asked, self._next = None, 0.0

    def _counters(self) -> Counters:
        damaged = self._replies.malformed + self._refused
        skipped = self._replies.skipped_bytes
        frames = self._watch.samples + self._late
        return Counters(frames=frames, bad_checksums=damaged, skipped_bytes=skipped)

    def _troubles(self) -> dict[str, str]:
        found = {"answer": self._trouble} if self._trouble else {}
        if time.monotonic() - self._late_at < _SHOWN_S:
            found["late"] = message(
                f"{arg(self._late)} answers of the robot were dropped because they took longer than"
                f" {arg(1e3 * _LATEST_S):.0f} ms; the last took {arg(1e3 * self._lateness):.0f} ms: check"
                " network and controller, or choose a lower rate."
            )
        return found


class ElfinDriver(Driver):
    """An Elfin's controller."""

    scheme, title = "elfin", "Hans Robot Elfin"
    ways = (Way(Carrier.TCP, port=10_003),)
    rate = 50.0
    emulated = ElfinModel
    stamped = False  # it is asked, and so its answers are timed already

    def poses(
        self, address: DeviceAddress, on_samples: OnFlanges, on_change: OnChange = None
    ) -> ReconnectingStream[FlangeSample]:
        """As `Driver`."""
        return ElfinPoses(address, on_samples, on_change)

"""
Hans Robot's controllers (Elfin), the text protocol on TCP port 10003.

A request is "<Command>,<arguments>,;", an answer "<Command>,OK,<values>,;" or "<Command>,Fail,<code>,;";
an unknown command is answered by "errorcmd,...". Only questions are asked here.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.protocols.arms import ELFIN3_TABLE, flange_pose
from contactbench.pipeline.devices.protocols.device_model import JOINTS, WIRE_FAULTS, Model, Quirk
from contactbench.pipeline.devices.protocols.parser import ProtocolError
from contactbench.pipeline.errors import arg

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from contactbench.pipeline.devices.faults import FrameMoment, SensorReading, Six

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


class ReplyReader:
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
        self._buffer = bytearray()
        self._overlong = False
        self.malformed = 0
        self.skipped_bytes = 0

    @property
    def pending(self) -> int:
        """Bytes that wait for their ";"."""
        return len(self._buffer)

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
        self.skipped_bytes += len(self._buffer)
        self._buffer.clear()
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

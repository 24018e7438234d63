"""Hans Robot Elfin: a controller that answers requests in ASCII."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.emulate.arms import ELFIN3_TABLE, flange_pose
from contactbench.pipeline.devices.emulate.models.model import WIRE_FAULTS, Model, Quirk

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from contactbench.pipeline.devices.emulate.signals import Moment, Reading

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
    own_rate = 50.0
    faults = WIRE_FAULTS
    asked_only = True
    possible_quirks: ClassVar[frozenset[Quirk]] = frozenset({Quirk.OLDER})

    def __init__(self, rate: float | None = None, quirks: Iterable[Quirk | str] = ()) -> None:
        super().__init__(rate, quirks)
        self._asked = "ReadActPos"

    def frame(self, reading: Reading, moment: Moment) -> bytes:  # noqa: ARG002 - it has no clock
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

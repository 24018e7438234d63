"""A robot kept telling where its flange is. It is asked, and never moved."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pipeline.devices.drive.kept import KeptStream
from pipeline.devices.protocols import ur_rtde
from pipeline.devices.protocols.elfin import Question, ReplyReader, read_numbers
from pipeline.devices.protocols.elfin_pose import flange_sample, resolve_order
from pipeline.devices.protocols.ur_pose import Stage, UrStream
from pipeline.devices.sample import FlangeSample
from pipeline.devices.transport import line_to
from pipeline.devices.url import AddressError, DeviceAddress, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from pipeline.devices.drive.health import Health
    from pipeline.devices.protocols.elfin_pose import FieldOrder
    from pipeline.devices.transport import Line
    from pipeline.robot import Robot

    OnSamples = Callable[[Sequence[FlangeSample]], None]
    OnChange = Callable[[Health], None] | None

_USUAL_RATE_HZ = 50.0
_OVERDUE = 5.0  # periods after which a question is taken to be lost and asked again


class UrPoses(KeptStream[FlangeSample]):
    """
    A UR robot's flange, over RTDE.

    Parameters
    ----------
    address : DeviceAddress
    on_samples, on_change
        As for `KeptStream`.
    tool : 6 floats, optional
        See `UrStream`.
    """

    def __init__(
        self,
        address: DeviceAddress,
        on_samples: OnSamples,
        on_change: OnChange = None,
        *,
        tool: Sequence[float] | None = None,
        line: Line | None = None,
    ) -> None:
        rate = address.rate or _USUAL_RATE_HZ
        self._talk = UrStream(rate, tool)
        super().__init__(address, line or line_to(address), rate, on_samples, on_change)

    def _begin(self) -> None:
        self._line.write(self._talk.start())

    def _feed(self, data: bytes, arrived: float) -> list[FlangeSample]:
        samples = self._talk.feed(data, arrived)
        if output := self._talk.take_output():
            self._line.write(output)
        return samples

    def _end(self) -> None:
        if self._talk.stage is Stage.STREAMING:
            self._line.write(ur_rtde.pause_request())


class ElfinPoses(KeptStream[FlangeSample]):
    """
    An Elfin robot's flange, asked for at the address's rate.

    The first answer settles whether joints or pose come first, by the arm's kinematics.

    Parameters
    ----------
    address : DeviceAddress
    on_samples, on_change
        As for `KeptStream`.
    robot : Robot, optional
        The arm; an Elfin3 when left out.
    """

    def __init__(
        self,
        address: DeviceAddress,
        on_samples: OnSamples,
        on_change: OnChange = None,
        *,
        robot: Robot | None = None,
        line: Line | None = None,
    ) -> None:
        from pipeline.robot import Robot as Known

        rate = address.rate or _USUAL_RATE_HZ
        self._robot = robot or Known.named("elfin3")
        self._period = 1.0 / rate
        self._replies = ReplyReader()
        self._order: FieldOrder | None = None
        self._asked: float | None = None
        self._next = 0.0
        super().__init__(address, line or line_to(address), rate, on_samples, on_change)

    def _begin(self) -> None:
        self._asked, self._next = None, 0.0

    def _idle(self, now: float) -> None:
        waited = None if self._asked is None else now - self._asked
        if now >= self._next and (waited is None or waited > _OVERDUE * self._period):
            self._line.write(Question.POSITION.request())
            self._asked = now
            # At its own pace: what came late is not asked for twice as fast.
            self._next = max(self._next + self._period, now)

    def _feed(self, data: bytes, arrived: float) -> list[FlangeSample]:
        samples = []
        for reply in self._replies.feed(data):
            self._asked = None
            numbers = read_numbers(reply, Question.POSITION)[:12]
            if self._order is None:
                self._order = resolve_order(numbers, self._robot).order
            samples.append(flange_sample(numbers, self._order, arrived, self._robot))
        return samples

    def _end(self) -> None:
        """Leave the robot alone: it was only asked."""

    def _reset(self) -> None:
        self._replies.reset()


def poses_from(
    address: DeviceAddress | str, on_samples: OnSamples, on_change: OnChange = None
) -> UrPoses | ElfinPoses:
    """
    Return the stream of the robot at an address, not yet started.

    Raises
    ------
    AddressError
        It is no robot.
    """
    where = DeviceAddress.parse(address) if isinstance(address, str) else address
    if where.protocol is Protocol.UR:
        return UrPoses(where, on_samples, on_change)
    if where.protocol is Protocol.ELFIN:
        return ElfinPoses(where, on_samples, on_change)
    raise AddressError(f"address {str(where)!r}: it is no robot: give the address of one.")

"""Which half of an Elfin's position is joints, found out from the arm's kinematics; and the flange from it.

Software versions disagree on the order of joints and pose. The joints must lead to the pose by the forward
kinematics, so one reading settles the order, the convention of the angles, and whether the active tool
frame is turned against the flange.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.driver import Carrier, Driver, Way
from contactbench.pipeline.devices.protocols.elfin import (
    REQUEST,
    ElfinError,
    ElfinModel,
    ReplyReader,
    read_position,
)
from contactbench.pipeline.devices.protocols.parser import Counters
from contactbench.pipeline.devices.reconnecting_stream import READ_S, ReconnectingStream
from contactbench.pipeline.devices.sample import FlangeSample
from contactbench.pipeline.devices.transport import LineLost, line_to
from contactbench.pipeline.devices.watch import Watch
from contactbench.pipeline.errors import arg, join, message

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.devices.driver import OnChange, OnFlanges
    from contactbench.pipeline.devices.transport import Line
    from contactbench.pipeline.devices.url import DeviceAddress
    from contactbench.pipeline.robot import Robot

_NUMBERS = 12
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

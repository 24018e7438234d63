"""A robot kept telling where its flange is. It is asked, and never moved."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.devices.clock import SampleClock
from contactbench.pipeline.devices.protocols import Counters, ProtocolError, ur_rtde
from contactbench.pipeline.devices.protocols.elfin import REQUEST, ElfinError, ReplyReader, read_position
from contactbench.pipeline.devices.protocols.elfin_pose import flange_sample, resolve_order
from contactbench.pipeline.devices.protocols.parser import ASSUMED_RATE_HZ
from contactbench.pipeline.devices.protocols.registry import driver_of
from contactbench.pipeline.devices.protocols.ur_pose import UrStage, UrStream
from contactbench.pipeline.devices.reconnecting_stream import READ_S, ReconnectingStream
from contactbench.pipeline.devices.sample import FlangeSample
from contactbench.pipeline.devices.transport import LineLost, line_to
from contactbench.pipeline.devices.url import AddressError, DeviceAddress
from contactbench.pipeline.devices.watch import Watch
from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.devices.driver import OnChange, OnFlanges
    from contactbench.pipeline.devices.protocols.elfin_pose import FieldOrder
    from contactbench.pipeline.devices.protocols.parser import Parser
    from contactbench.pipeline.devices.transport import Line
    from contactbench.pipeline.robot import Robot

_USUAL_RATE_HZ = 50.0
# Without an answer for so long, a line is opened again: questions that wait add up in a slow controller.
_UNANSWERED_S = 1.0
# After a piece that was no answer none follows, or it would have come.
_GARBLED_S = 0.1
# Half of it is how wrong the time of a pose may be; a flange at 0.2 rad/s has turned by 0.3 degrees then.
_LATEST_S = 0.05
_SHOWN_S = 2.0


class UrPoses(ReconnectingStream[FlangeSample]):
    """
    A UR robot's flange, over RTDE.

    Parameters
    ----------
    address : DeviceAddress
    on_samples, on_change
        As for `ReconnectingStream`.
    tool : 6 floats, optional
        See `UrStream`.
    """

    def __init__(
        self,
        address: DeviceAddress,
        on_samples: OnFlanges,
        on_change: OnChange = None,
        *,
        tool: Sequence[float] | None = None,
        line: Line | None = None,
    ) -> None:
        rate = address.rate or _USUAL_RATE_HZ
        self._talk = UrStream(rate, tool)
        self._clock = SampleClock(rate)
        self._refused = 0
        super().__init__(address, line or line_to(address), Watch(rate), on_samples, on_change)

    def _begin(self) -> None:
        self._line.write(self._talk.start())

    def _feed(self, data: bytes, arrived: float) -> list[FlangeSample]:
        try:
            samples = self._talk.feed(data, arrived)
        except ProtocolError:
            self._refused += 1
            raise
        if output := self._talk.take_output():
            self._line.write(output)
        return self._clock.stamp(samples)

    def _reset(self) -> None:
        self._clock.forget()

    def _troubles(self) -> dict[str, str]:
        if self._talk.stage is not UrStage.STREAMING or self._talk.knows_flange:
            return {}
        return {
            "tool": (
                "The controller does not report the tool set on the pendant, so the orientation is"
                " that of the tool frame. Add ?tool=x,y,z,rx,ry,rz (m, rad) to the address, as set on"
                " the pendant."
            )
        }

    def _end(self) -> None:
        if self._talk.stage is UrStage.STREAMING:
            self._line.write(ur_rtde.pause_request())

    def _counters(self) -> Counters:
        return Counters(
            frames=self._watch.samples, bad_checksums=self._refused, skipped_bytes=self._talk.skipped_bytes
        )


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
        from contactbench.pipeline.robot import Robot as Known

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


class ParsedPoses(ReconnectingStream[FlangeSample]):
    """
    A robot that sends its flange by itself, once it was told to.

    Parameters
    ----------
    address : DeviceAddress
    parser : Parser
        Of its poses.
    on_samples, on_change
        As for `ReconnectingStream`.
    start, stop : bytes
        What to send first and last; empty: nothing.
    """

    def __init__(
        self,
        address: DeviceAddress,
        parser: Parser[FlangeSample],
        on_samples: OnFlanges,
        on_change: OnChange = None,
        *,
        start: bytes = b"",
        stop: bytes = b"",
        line: Line | None = None,
    ) -> None:
        self._parser, self._start, self._stop = parser, start, stop
        self._clock = SampleClock(address.rate)
        watch = Watch(address.rate or ASSUMED_RATE_HZ, rate_known=address.rate is not None)
        super().__init__(address, line or line_to(address), watch, on_samples, on_change)

    def _begin(self) -> None:
        if self._start:
            self._line.write(self._start)

    def _feed(self, data: bytes, arrived: float) -> list[FlangeSample]:
        return self._clock.stamp(self._parser.feed(data, arrived))

    def _end(self) -> None:
        if self._stop:
            self._line.write(self._stop)

    def _reset(self) -> None:
        self._parser.reset()
        self._clock.forget()

    def _counters(self) -> Counters:
        return self._parser.counters

    def _troubles(self) -> dict[str, str]:
        return self._parser.troubles()


def poses_from(
    address: DeviceAddress | str, on_samples: OnFlanges, on_change: OnChange = None
) -> ReconnectingStream[FlangeSample]:
    """
    Return the stream of the robot at an address, not yet started.

    Raises
    ------
    AddressError
        It is no robot.
    """
    where = DeviceAddress.parse(address) if isinstance(address, str) else address
    known = driver_of(where.protocol)
    if known is None:
        raise AddressError(f"address {arg(str(where))!r}: not a robot. Give the address of a robot.")
    return known.poses(where, on_samples, on_change)

"""The bench behind real wire formats: an SRI sensor and an Elfin robot that measure what it measures."""

from __future__ import annotations

import bisect
import threading
import time
from collections import deque
from typing import TYPE_CHECKING, Self

import numpy as np

from contactbench.pipeline.devices.emulate import Emulator, emulator
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.robot import Robot
from contactbench.pipeline.simulation.virtual.pace import Pacer

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType

    from contactbench.pipeline.devices.faults import Six
    from contactbench.pipeline.mesh.arrays import Floats
    from contactbench.pipeline.simulation.virtual.bench import VirtualBench
    from contactbench.pipeline.simulation.virtual.commands import Batch

# The devices tell what was there so long ago: the bench, which may be late, has been there then.
DELAY_S = 0.03
_KEPT_S = 2.0


class ServedBench:
    """
    A bench in real time with a sensor and a robot on real lines.

    Use it in a ``with`` statement. The sensor answers as an SRI box, the robot as an Elfin whose wrist turns as the
    bench's does; where its flange is belongs to the arm, how it stands to the bench.

    Parameters
    ----------
    pty : bool
        The sensor on a pseudo-terminal, not on TCP.
    sensor_port, robot_port : int
        Of the loopback interface; 0: any free one.
    on_batch : callable, optional
        Gets everything that the bench gives, the truth with it.

    Raises
    ------
    InputError
        A port is taken, or MuJoCo is missing.
    """

    def __init__(
        self,
        bench: VirtualBench,
        *,
        pty: bool = False,
        sensor_port: int = 0,
        robot_port: int = 0,
        on_batch: Callable[[Batch], None] = lambda _: None,
    ) -> None:
        self.bench = bench
        self.error: InputError | None = None
        self.over = threading.Event()
        self._on_batch = on_batch
        self._kept: deque[tuple[float, Six, Floats]] = deque(maxlen=int(_KEPT_S * bench.rate) + 2)
        self._lock = threading.Lock()
        self._arm = WristArm()
        self._pacer = Pacer(bench, self._keep, self._end)
        self._first: float | None = None
        self._told = 0.0
        self._keep(bench.advance(1.5 / bench.rate), 0.0)  # there is something to tell from the beginning
        carrier = "serial" if pty else "tcp"
        self.sensor: Emulator = emulator(
            "sri", carrier, port=sensor_port, rate=bench.rate, signal=self._wrench
        )
        try:
            self.robot: Emulator = emulator("elfin", "tcp", port=robot_port, signal=self._joints)
        except BaseException:
            self.sensor.close()
            raise

    def __enter__(self) -> Self:
        self._pacer.start()
        self.sensor.start()
        self.robot.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._pacer.stop()
        self.bench.close()
        try:
            self.sensor.close()
        finally:
            self.robot.close()

    def findings(self) -> tuple[str, ...]:
        """Return what is wrong, in sentences."""
        return self._pacer.findings()

    def _keep(self, batch: Batch, origin: float) -> None:  # noqa: ARG002 - the pacer says it
        with self._lock:
            for sample, truth in zip(batch.wrenches, batch.truths, strict=True):
                self._kept.append(
                    (sample.time, (*sample.force, *sample.torque), truth.R_WS @ self.bench.R_SE)
                )
        self._on_batch(batch)

    def _end(self, error: InputError | None) -> None:
        self.error = error
        self.over.set()

    # ---- in the devices' threads ---------------------------------------------------------------

    def _wrench(self, due: float) -> Six:
        """Return what is measured at a time of the sensor's clock: every frame the next sample."""
        now = time.monotonic() - self._pacer.origin
        # Its clock begins with its first frame, and has leapt where the bench let time slip.
        if self._first is None or abs(self._first + due - now) > DELAY_S:
            self._first = now - due
        # A bench that is late is told once more as it was, never as it was before that.
        self._told = max(self._told, self._first + due - DELAY_S)
        moment, wrench, _ = self._at(self._told)
        self._told = min(self._told, moment + 1 / self.bench.rate)
        return wrench

    def _joints(self, _: float) -> Six:
        q = self._arm.joints(self._at(time.monotonic() - self._pacer.origin - DELAY_S)[2]).tolist()
        return (q[0], q[1], q[2], q[3], q[4], q[5])

    def _at(self, moment: float) -> tuple[float, Six, Floats]:
        """Return the sample that is the newest at a time of the bench's clock."""
        with self._lock:
            # Half a period to the side: rounding does not decide between two samples.
            place = bisect.bisect_right(self._kept, moment + 1e-6, key=lambda kept: kept[0])
            return self._kept[max(0, place - 1)]


# ---- joint angles with which an arm's flange stands as the bench's wrist does --------------------


# The forearm level to the front, to both sides, and rising: what one cannot reach, behind its own wrist or at the end
# of a joint, another can.
_ARMS = ((0.0, 0.0, np.pi / 2), (np.pi / 2, 0.0, np.pi / 2), (-np.pi / 2, 0.0, np.pi / 2), (0.4, -0.3, 0.6))


class WristArm:
    """
    An Elfin3 whose first three joints stay as long as its wrist reaches what is asked for.

    Its last three axes meet in a point and are z, y, z of a turn, so the angles follow without a search.

    Raises
    ------
    InputError
        MuJoCo is missing.
    """

    def __init__(self) -> None:
        self._robot = Robot.named("elfin3")
        straight = np.array([[*arm, 0.0, 0.0, 0.0] for arm in _ARMS])
        self._forearms = self._robot.flange_rotations(straight)
        self._arm = 0
        self._joints = straight[0]

    def joints(self, R_BE: Floats) -> Floats:
        """
        Return the six joint angles, rad, near the ones before.

        Raises
        ------
        InputError
            No posture reaches the orientation.
        """
        for arm in [self._arm, *range(len(_ARMS))]:
            found = [q for q in self._wrists(arm, R_BE) if self._robot.within_limits(q)]
            if found:
                self._arm = arm
                self._joints = min(found, key=lambda q: float(np.abs(q - self._joints).sum()))
                return np.array(self._joints)
        raise InputError("the arm's wrist does not reach that orientation: turn the bench another way.")

    def _wrists(self, arm: int, R_BE: Floats) -> list[Floats]:
        """Return both ways to stand so."""
        R = self._forearms[arm].T @ R_BE
        # In line with the forearm any first angle will do: the present one, so that nothing leaps.
        in_line = np.hypot(R[0, 2], R[1, 2]) < 1e-9
        first = self._joints[3] if in_line else np.arctan2(R[1, 2], R[0, 2])
        ways = []
        for q4 in (first, first - np.copysign(np.pi, first)):
            c, s = np.cos(q4), np.sin(q4)
            rest = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ R
            q5, q6 = np.arctan2(rest[0, 2], rest[2, 2]), np.arctan2(rest[1, 0], rest[1, 1])
            ways.append(np.array([*_ARMS[arm], q4, q5, q6]))
        return ways

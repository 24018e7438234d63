"""The closed loop in simulation: scene, sensor, faults and controller, period by period."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.control.arms import CartesianMount
from contactbench.pipeline.control.axes import cross
from contactbench.pipeline.control.states import ControlState
from contactbench.pipeline.control.trace import STATES, Trace
from contactbench.pipeline.devices.sample import Status, WrenchSample
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.simulation.scenes import ArmScene

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.control.arms import Arm
    from contactbench.pipeline.control.command import ControlCommand
    from contactbench.pipeline.control.controller import Controller
    from contactbench.pipeline.simulation.scenes import MovedScene, SceneMoment
    from contactbench.pipeline.simulation.sensor_model import SensorModel

WARM_S = 3600.0  # a sensor is used warm
_LONGEST_S = 3600.0
Watch = Callable[["ControlCommand", "Loop"], bool | None]
Line = Callable[[WrenchSample], WrenchSample | None]


def arm_of(scene: MovedScene) -> Arm:
    """Return what carries the probe of a scene, as a controller sees it."""
    return scene.robot if isinstance(scene, ArmScene) else CartesianMount()


@dataclass(frozen=True, eq=False)
class Rig:
    """What a closed loop is made of."""

    scene: MovedScene
    controller: Controller
    sensor: SensorModel


class Loop:
    """
    A scene and its controller; `step` goes on by one period.

    Parameters
    ----------
    line : callable, optional
        What arrives of a sample on its way from the sensor to the controller; None: nothing.
    switched_on : float
        How long before the scene began the sensor was switched on, s.
    poses_late : float
        How old the joints are that the controller is told, s; whole periods of it.
    """

    def __init__(
        self,
        scene: MovedScene,
        controller: Controller,
        sensor: SensorModel,
        line: Line | None = None,
        switched_on: float = WARM_S,
        poses_late: float = 0.0,
    ) -> None:
        self.scene, self.controller, self.sensor = scene, controller, sensor
        self._line, self._on = line, switched_on
        self._arm = arm_of(scene)
        self._period, self._rate = controller.settings.period, sensor.settings.rate
        self._periods = self._read = 0
        self._begin = scene.time
        self._joints: deque[NDArray[np.float64]] = deque(maxlen=1 + round(poses_late / self._period))
        self._rows: list[dict[str, Any]] = []

    def step(self) -> ControlCommand:
        """
        Go on by one period: read, decide, and give the servo its set-point.

        Raises
        ------
        PhysicsError
            See `PhysicsScene.step`.
        """
        self._periods += 1
        end = self._begin + self._periods * self._period
        samples, peak = [], 0.0
        while (due := self._begin + (self._read + 1) / self._rate) < end + 1e-9:
            self._read += 1
            sample, force = self._sample(due)
            peak = max(peak, force)
            if sample is not None:
                samples.append(sample)
        self.scene.advance(max(end - self.scene.time, 0.0))
        self._joints.append(self.scene.joints)
        here = self._joints[0]
        began, own = time.perf_counter(), time.thread_time()
        command = self.controller.step(self.scene.time, here, samples)
        took = time.perf_counter() - began, time.thread_time() - own
        self._note(command, peak, took)
        self.scene.command(command.q)
        return command

    def trace(self) -> Trace:
        """
        Return what happened until now.

        Raises
        ------
        InputError
            There was no step yet.
        """
        if not self._rows:
            raise InputError("closed loop: nothing has happened yet: run at least one step.")
        columns = {name: np.array([row[name] for row in self._rows]) for name in self._rows[0]}
        return Trace(**columns, changes=tuple(self.controller.safety.changes))

    def _sample(self, due: float) -> tuple[WrenchSample | None, float]:
        """Read the sensor at a time, s; returns what arrives of it, and the true |F|."""
        self.scene.advance(max(due - self.scene.time, 0.0))
        moment = self.scene.moment()
        read = self.sensor.read([self._on + self.scene.time], moment.reading)
        row = read.wrenches[0].tolist()
        status = Status.OVERRANGE if read.saturated[0] else Status(0)
        sample = WrenchSample(
            self.scene.time, (row[0], row[1], row[2]), (row[3], row[4], row[5]), self._read, status
        )
        return self._line(sample) if self._line else sample, moment.force

    def _note(self, command: ControlCommand, peak: float, took: tuple[float, float]) -> None:
        scene = self.scene
        moment = scene.moment()
        contact = moment.contact
        self._rows.append(
            {
                "time": scene.time,
                "force": -float(contact[2]),
                "peak": max(peak, float(np.linalg.norm(contact[:3]))),
                "sensed": command.force,
                "offset": command.offset,
                "place": moment.centroid_S[:2] - self.controller.wanted_S[:2],
                "torsion": moment.torsion,
                "shift": _shift(moment),
                "angles": scene.angles(),
                "phantom": self._in_P(*scene.surface()),
                "probe": self._in_P(*self._tip()),
                "joints": command.q,
                "state": STATES.index(command.state),
                "share": command.step.share,
                "step_s": took[0],
                "step_cpu_s": took[1],
            }
        )

    def _tip(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return where the middle of the face is in B, and the axis that points out of the tissue."""
        R_BE, p_BE_B = self._arm.flange_pose(self.scene.true_joints)
        axis = R_BE @ self.scene.R_ES[:, 2]
        return p_BE_B + R_BE @ self.scene.p_ES_E + self.scene.top * axis, -axis

    def _in_P(self, point: NDArray[np.float64], up: NDArray[np.float64]) -> tuple[float, float, float]:
        """Return the height of a point (3,) in B, and the tilts of an axis, in the frame where the phantom rests."""
        R_BP, p_BP = self.scene.T_BP[:3, :3], self.scene.T_BP[:3, 3]
        x, y, z = (R_BP.T @ up).tolist()
        return float((point - p_BP) @ R_BP[:, 2]), float(np.arctan2(x, z)), float(np.arctan2(-y, z))


def _shift(moment: SceneMoment) -> float:
    """Return how far the wrench's axis passes from the point of contact, m: |F x torsion n| / |F|², NaN in the air."""
    force = moment.contact[:3]
    size2 = float(force @ force)
    if size2 == 0:
        return float("nan")
    across = cross(force, moment.normal_S)
    return abs(moment.torsion) * float(np.sqrt(across @ across)) / size2


def run_loop(
    scene: MovedScene,
    controller: Controller,
    sensor: SensorModel,
    seconds: float,
    *,
    line: Line | None = None,
    poses_late: float = 0.0,
    stop_after: float | None = None,
    watch: Watch | None = None,
) -> Trace:
    """
    Run a controller on a scene, as fast as it goes.

    Parameters
    ----------
    scene, controller, sensor, line, poses_late
        As of `Loop`.
    seconds : float
        How long, s; it ends before, once the controller stands still for good.
    stop_after : float, optional
        s after which the controller is told to end; left out, it is not.
    watch : callable, optional
        Told each command and the loop; True ends it at once.

    Raises
    ------
    InputError
        A time is out of range.
    PhysicsError
        See `PhysicsScene.step`.
    """
    if not 0 < seconds <= _LONGEST_S:
        raise InputError(f"closed loop: {arg(seconds)} s: give a time above 0, up to {arg(_LONGEST_S):g} s.")
    loop = Loop(scene, controller, sensor, line, poses_late=poses_late)
    begin = scene.time
    while scene.time < begin + seconds - 1e-9:
        if stop_after is not None and scene.time - begin >= stop_after:
            controller.stop()
        command = loop.step()
        ended = watch is not None and bool(watch(command, loop))
        if ended or command.state is ControlState.SAFE:
            break
    return loop.trace()

"""The closed loop in simulation: scene, sensor, faults and controller, period by period."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.control.inverse import Arm, CartesianMount
from contactbench.pipeline.control.states import ControlCommand, ControlState, StateChange
from contactbench.pipeline.control.upright import cross
from contactbench.pipeline.devices.sample import Status, WrenchSample
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.simulation.scenes.arm import ArmScene
from contactbench.pipeline.simulation.scenes.physics import SceneMoment
from contactbench.pipeline.simulation.scenes.platform import MovedScene

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.control.controller import Controller
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
    poses_late : float
        How old the joints are that the controller is told, s; whole periods of it.
    """

    def __init__(
        self,
        scene: MovedScene,
        controller: Controller,
        sensor: SensorModel,
        line: Line | None = None,
        poses_late: float = 0.0,
    ) -> None:
        self.scene, self.controller, self.sensor = scene, controller, sensor
        self._line, self._arm = line, arm_of(scene)
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
        read = self.sensor.read([WARM_S + self.scene.time], moment.reading)
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


# ---- what happened in a closed loop --------------------------------------------------------------


STATES = tuple(ControlState)


@dataclass(frozen=True, eq=False)
class Trace:
    """A closed loop, a row per period."""

    time: NDArray[np.float64]  # (n,) s, of the scene, at the end of the period
    force: NDArray[np.float64]  # (n,) how hard the tissue is truly pressed along the probe's axis, N
    peak: NDArray[np.float64]  # (n,) largest |F| of the true contact in the period, N
    # (n,) what the controller took the force for, N; NaN without a fresh sample
    sensed: NDArray[np.float64]
    # (n, 2) sensed place of the contact less the wanted one, S, m; NaN where it was not known
    offset: NDArray[np.float64]
    # (n, 2) where it truly was at the end of the period, the same way; NaN in the air
    place: NDArray[np.float64]
    # (n,) torque of the true contact about the normal at its point, N·m; NaN in the air
    torsion: NDArray[np.float64]
    # (n,) how far that moves the wrench's axis away from the point, m: what a method that neglects it is
    # off by
    shift: NDArray[np.float64]
    # (n, 2) between the probe's axis and the phantom's normal, in plane and out of plane, rad
    angles: NDArray[np.float64]
    # phantom, probe: (n, 3) height of the phantom's middle and of the probe's tip, m, and their tilts in
    # plane and out of plane, rad, in the frame P where the phantom rests
    phantom: NDArray[np.float64]
    probe: NDArray[np.float64]
    joints: NDArray[np.float64]  # (n, k) Set-points, rad or m
    state: NDArray[np.int_]  # (n,) index in `STATES`
    share: NDArray[np.float64]  # (n,) what the arm's limits left of the wanted motion
    step_s: NDArray[np.float64]  # (n,) how long the controller took, s
    # (n,) how long the processor worked for it, s: without what else ran on the machine. These two are all
    # that is not the same each time.
    step_cpu_s: NDArray[np.float64]
    changes: tuple[StateChange, ...] = ()

    def __len__(self) -> int:
        return len(self.time)

    def between(self, start: float, end: float = np.inf) -> Trace:
        """Return the rows from a time on, up to another, s; all changes stay."""
        rows = (self.time >= start) & (self.time < end)
        cut = {each.name: getattr(self, each.name)[rows] for each in fields(self) if each.name != "changes"}
        return replace(self, **cut)

    def was(self, state: ControlState) -> NDArray[np.bool_]:
        """Return when it was in a state, (n,)."""
        return np.asarray(self.state == STATES.index(state))

    @property
    def tilt(self) -> NDArray[np.float64]:
        """Whole angle between the probe's axis and the phantom's normal, (n,), rad."""
        return np.asarray(np.arctan(np.linalg.norm(np.tan(self.angles), axis=1)))

    @property
    def ended(self) -> ControlState:
        """The state at the end."""
        return STATES[int(self.state[-1])]

    def csv(self) -> str:
        """Write it as CSV, in the units of the names, without what steps took."""
        joints = [f"joint_{k + 1}" for k in range(self.joints.shape[1])]
        heads = [_HEADS, *joints, "state"]
        columns = [
            self.time,
            self.force,
            self.peak,
            self.sensed,
            *(1e3 * self.offset).T,
            *(1e3 * self.place).T,
        ]
        columns += [1e3 * self.torsion, 1e3 * self.shift, *np.degrees(self.angles).T]
        for body in (self.phantom, self.probe):
            columns += [1e3 * body[:, 0], *np.degrees(body[:, 1:]).T]
        columns += [self.share, *self.joints.T]
        rows = (
            ",".join([*("" if np.isnan(value) else f"{value:.6g}" for value in row), STATES[state]])
            for row, state in zip(np.column_stack(columns).tolist(), self.state.tolist(), strict=True)
        )
        return "\n".join([",".join(heads), *rows]) + "\n"


_HEADS = (
    "time_s,force_N,peak_N,sensed_force_N,offset_x_mm,offset_y_mm,true_offset_x_mm,true_offset_y_mm,torsion_Nmm"
    ",axis_shift_mm,in_plane_deg,out_of_plane_deg,phantom_height_mm,phantom_in_plane_deg,phantom_out_of_plane_deg"
    ",probe_height_mm,probe_in_plane_deg,probe_out_of_plane_deg,share_of_motion"
)

"""
The tool on a wrist that takes any orientation, for gravity calibration, with a tip for touches.

Left out: the arm behind the wrist (its reach, its joints and their ripple), the room, tissue. The wrist turns as it is
told, on a smooth path, with the weight and the inertia of the tool on the sensor; it yields to a push as a stiff arm.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.simulation.scenes.indenter import (
    PATCH_M,
    PROBE_BIT,
    STEP_S,
    TIP_BIT,
    Indenter,
    Tip,
    TipPress,
    add_indenter,
    along,
)
from contactbench.pipeline.simulation.scenes.physics import (
    PROBE,
    Payload,
    PhysicsScene,
    TrueSurface,
    add_facets,
    facets_near,
    new_spec,
    physics,
    sensed_body,
)

_WRIST_INERTIA = 0.05  # kg·m², of what turns with the tool
_STIFF = 200.0  # rad/s: 10 N at the tip bend the wrist by some hundredths of a degree
_SPEED = np.radians(60.0)  # mean turning speed of a move without a time of its own
_SHORTEST_S = 0.3
_FASTEST, _HARDEST = np.radians(1000.0), 2000.0  # rad/s in the mean, rad/s² at most
_PEAK = 10 / np.sqrt(3)  # largest acceleration of a path, times angle / seconds²
MOST_BUMP_N, MOST_LEVER_M = 1e3, 10.0
_HEIGHT_M = 0.5


class _Turn:
    """A smooth path from one orientation to another: no jump in speed or acceleration.

    Parameters
    ----------
    start, seconds : float
        s.
    R0 : (3, 3)
    axis_angle : (3,)
        The turn in the frame of R0, rad.
    """

    def __init__(self, start: float, seconds: float, R0: Floats, axis_angle: Floats) -> None:
        self._start, self._seconds, self._axis_angle = start, seconds, axis_angle
        self._begin = Rotation.from_matrix(R0).as_quat(scalar_first=True)
        self._angle = float(np.linalg.norm(axis_angle))
        self._axis = axis_angle / self._angle if self._angle else np.array([0.0, 0.0, 1.0])
        self._mujoco = physics()
        self._over = (self._on_the_way(1.0), np.zeros(3), np.zeros(3))

    def at(self, time: float) -> tuple[Floats, Floats, Floats]:
        """Return the quaternion (w first), angular velocity and acceleration in the body's frame, rad/s and rad/s²."""
        u = max((time - self._start) / self._seconds, 0.0)
        if u >= 1.0:
            return self._over
        share = u**3 * (10 + u * (-15 + 6 * u))
        rate = 30 * u**2 * (1 - u) ** 2 / self._seconds
        change = 60 * u * (1 - u) * (1 - 2 * u) / self._seconds**2
        return self._on_the_way(share), rate * self._axis_angle, change * self._axis_angle

    def _on_the_way(self, share: float) -> Floats:
        # In place: at 2 kHz a Rotation for each step would take longer than the physics.
        step, now = np.empty(4), np.empty(4)
        self._mujoco.mju_axisAngle2Quat(step, self._axis, share * self._angle)
        self._mujoco.mju_mulQuat(now, self._begin, step)
        return now


class BenchScene(PhysicsScene):
    """
    A wrist, a sensor, a probe, and a tip that waits.

    Parameters
    ----------
    truth : TrueSurface
    payload : Payload, optional
    R_WS : (3, 3), optional
        Orientation at the start; upright when left out.
    tip : Tip, optional
    step : float
        s.

    Raises
    ------
    InputError
        MuJoCo is missing.
    """

    def __init__(
        self,
        truth: TrueSurface,
        *,
        payload: Payload | None = None,
        R_WS: Floats | None = None,
        tip: Tip | None = None,
        step: float = STEP_S,
    ) -> None:
        self._payload, self._tip, self._step = payload or Payload(), tip or Tip(), step
        R = np.eye(3) if R_WS is None else np.asarray(R_WS, dtype=np.float64)
        self._turn = _Turn(0.0, 1.0, R, np.zeros(3))
        self._bump: tuple[float, Floats] = (-1.0, np.zeros(6))
        self.aimed_S: Floats | None = None
        super().__init__(self._spec(truth, None), truth)
        self._hold(R)

    # ---- what a person at the bench does -------------------------------------------------------

    def turn_to(self, R_WS: ArrayLike, seconds: float | None = None) -> float:
        """
        Turn the wrist on a smooth path, and return how long that takes, s.

        Raises
        ------
        InputError
            It is no rotation, the time is not positive or too short, or a tip presses on the tool.
        """
        R = np.asarray(R_WS, dtype=np.float64)
        if R.shape != (3, 3) or not np.allclose(R @ R.T, np.eye(3), atol=1e-6) or np.linalg.det(R) < 0:
            raise InputError("the wrist: give a rotation matrix.")
        if self.aimed_S is not None:
            raise InputError("the wrist: a tip is at the tool: release it first.")
        start = Rotation.from_quat(self._turn.at(self.time)[0], scalar_first=True).as_matrix()
        path = Rotation.from_matrix(start.T @ R).as_rotvec()
        needed = max(_SHORTEST_S, float(np.linalg.norm(path)) / _SPEED) if seconds is None else seconds
        if not 0 < needed < 1e4:
            raise InputError(f"the wrist: {arg(needed):g} s is not a valid duration: give a positive number.")
        angle = float(np.linalg.norm(path))
        shortest = max(angle / _FASTEST, float(np.sqrt(_PEAK * angle / _HARDEST)))
        if needed < shortest:
            raise InputError(
                f"the wrist: {arg(np.degrees(angle)):.0f} degrees in {arg(needed):g} s is too fast for an"
                f" arm: give {arg(shortest):.3f} s or more."
            )
        self._turn = _Turn(self.time, needed, start, path)
        return needed

    def aim(self, marker_S: ArrayLike) -> Floats:
        """
        Put the tip above the nearest point of the probe, and return that point, (3,), m.

        The wrist and the time stay as they are.
        """
        point, normal = self.truth.nearest(marker_S)
        self._rebuild(point)
        self.aimed_S = point
        site = self.data.site_xmat[self._site].reshape(3, 3)
        origin = self.data.site_xpos[self._site]
        self.indenter = Indenter(self.model, self.data)
        self.indenter.place(origin + site @ point, site @ normal, site @ along(normal))
        self.control()
        return point

    def press(self, press: TipPress) -> None:
        """Press where the tip is aimed at.

        Raises
        ------
        InputError
            It is aimed at nothing.
        """
        if self.aimed_S is None:
            raise InputError("the tip has no target: aim at a marker first.")
        self.indenter.press(press)

    def release(self) -> None:
        """Take the tip away from the tool at once."""
        if self.aimed_S is not None:
            self._rebuild(None)
            self.aimed_S = None
            self.control()

    def bump(self, force_S: ArrayLike, seconds: float, lever_S: ArrayLike = (0.0, 0.0, 0.1)) -> None:
        """
        Push the tool at a point of S, m, with a force, N, for some time, s.

        Raises
        ------
        InputError
            A number is not finite, or larger than 1000 N or 10 m.
        """
        force, lever = np.asarray(force_S, float), np.asarray(lever_S, float)
        if force.shape != (3,) or lever.shape != (3,) or not np.isfinite([*force, *lever, seconds]).all():
            raise InputError("a bump: give a force and a lever of three finite numbers.")
        if np.linalg.norm(force) > MOST_BUMP_N or np.linalg.norm(lever) > MOST_LEVER_M:
            raise InputError(
                f"a bump: give a force of at most {arg(MOST_BUMP_N):g} N on a lever of at most {arg(MOST_LEVER_M):g} m."
            )
        self._bump = (self.time + seconds, np.concatenate([force, np.cross(lever, force)]))

    # ---- physics -------------------------------------------------------------------------------

    def control(self) -> None:
        """Hold the wrist on its path, push the tip, and bump."""
        target, rate, change = self._turn.at(self.time)
        off = np.empty(3)
        self.mujoco.mju_subQuat(off, target, self.data.qpos[:4])
        wanted = np.zeros(self.model.nv)
        wanted[:3] = change + _STIFF**2 * off + 2 * _STIFF * (rate - self.data.qvel[:3])
        force = np.empty(self.model.nv)
        self.mujoco.mj_mulM(self.model, self.data, force, wanted)
        self.data.qfrc_applied[:3] = force[:3] + self.data.qfrc_bias[:3]
        if self.aimed_S is not None:
            self.indenter.control()
        self._push()

    def _push(self) -> None:
        until, wrench_S = self._bump
        if until < 0:
            return
        body = self.model.body(PROBE).id
        if self.time >= until:
            self.data.xfrc_applied[body] = 0.0
            self._bump = (-1.0, wrench_S)
            return
        site = self.data.site_xmat[self._site].reshape(3, 3)
        force, torque = site @ wrench_S[:3], site @ wrench_S[3:]
        # MuJoCo applies it at the centre of mass, not at S.
        arm = self.data.xipos[body] - self.data.site_xpos[self._site]
        self.data.xfrc_applied[body] = np.concatenate([force, torque - np.cross(arm, force)])

    def _spec(self, truth: TrueSurface, point: Floats | None) -> Any:
        mujoco = physics()
        spec = new_spec(self._step)
        wrist = spec.worldbody.add_body(
            pos=[0, 0, _HEIGHT_M],
            mass=1.0,
            # Left out, MuJoCo takes the body's own place for that of its mass.
            ipos=[0, 0, 0],
            iquat=[1, 0, 0, 0],
            inertia=np.full(3, _WRIST_INERTIA),
            explicitinertial=True,
        )
        wrist.add_joint(name="wrist", type=mujoco.mjtJoint.mjJNT_BALL)
        body = sensed_body(spec, wrist, self._payload)
        add_indenter(spec, self._tip, self._step)
        if point is not None:
            near = facets_near(truth, point, PATCH_M)
            bits = {"contype": PROBE_BIT, "conaffinity": TIP_BIT}
            add_facets(spec, body, truth.probe, near, "facet", **bits, **self._tip.geometry(self._step))
        return spec

    def _rebuild(self, point: Floats | None) -> None:
        """Compile the model with another patch of surface; wrist and time go on.

        The new model holds nothing yet: without `control` after it, a sensor would see the wrist fall at this moment.
        """
        before = self.data
        self._compile(self._spec(self.truth, point))
        self.data.time = before.time
        self.data.qpos[:4], self.data.qvel[:3] = before.qpos[:4], before.qvel[:3]
        self.mujoco.mj_forward(self.model, self.data)

    def _hold(self, R_WS: Floats) -> None:
        self.data.qpos[:4] = Rotation.from_matrix(R_WS).as_quat(scalar_first=True)
        self.mujoco.mj_forward(self.model, self.data)

"""
A probe on a position-controlled mount, over a soft phantom on a platform that moves with six axes.

Left out: the arm that would carry the mount (its joints, limits and bending), what tissue does sideways and between its
places. The mount follows its set-points with 60 rad/s, as an arm's servo, and carries weight and inertia of the tool on
its sensor; neither it nor the platform stands more than 0.1 mm off under 7 N.

On a convex probe at 7 N and a motion as of the paper's quickest, half the time step changes the force by 0.02 N and
the place by 0.01 mm, four times as many places change them by 0.2 N and 0.09 mm; without friction the force leans by
0.3 degrees less.

The phantom is a bed of springs: each place of the face is pushed by its own depth times the foundation modulus, and by
nothing else.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.simulation.scenes.physics import OTHER, Payload, TrueSurface, new_spec
from contactbench.pipeline.simulation.scenes.setpoints import ServoPath
from contactbench.pipeline.simulation.scenes.tissue import (
    PLACES,
    Tissue,
    TissueScene,
    add_phantom,
    add_probe,
    add_six_joints,
)

PRESS_STEP_S = 0.001
SERVO = 150.0  # rad/s, how stiffly the moved side follows


DOWN = np.diag([1.0, -1.0, -1.0])  # R_BS of a tool that points down, x kept
_FASTEST = np.repeat([0.25, np.pi / 2], 3)  # m/s and rad/s, of the mount
_HARDEST = np.repeat([5.0, 30.0], 3)  # m/s² and rad/s²
_BANDWIDTH = 60.0  # rad/s, as an arm's: what jumps in acceleration shakes the tool as no machine does


class MovedScene(TissueScene):
    """
    What scenes with a phantom on a platform share: where its surface is, and how the probe stands to it.

    The platform goes where its motion says, pulled by a stiff servo that knows it beforehand. Its six joints are the
    last ones of the model.

    Parameters
    ----------
    spec, truth, tissue, places, area
        As of `TissueScene`.
    motion : PlatformMotion or None
        None: it rests.
    T_BP : (4, 4)
        Where the middle of the phantom's top rests in B, z up: the frame whose axes the motion is along and about.

    Attributes
    ----------
    R_ES : (3, 3)
    p_ES_E : (3,)
        How the sensor sits on the flange, m.
    top : float
        Height of the probe's face above S, m.
    start : (n,)
        Joints at the beginning, m and rad.
    """

    start: Floats

    def __init__(
        self,
        spec: Any,
        truth: TrueSurface,
        tissue: Tissue,
        places: Floats,
        area: float,
        *,
        motion: PlatformMotion | None,
        T_BP: Floats,
        R_ES: Floats,
        p_ES_E: Floats,
    ) -> None:
        super().__init__(spec, truth, tissue, places, area)
        self.motion, self.T_BP, self.R_ES, self.p_ES_E = motion, T_BP, R_ES, p_ES_E
        self.top = float(truth.probe.vertices[:, 2].max())
        self.data.qpos[-6:], self.data.qvel[-6:] = self._platform(0.0), self._platform_speed(0.0)

    # ---- what a controller has to do with ---------------------------------------------------------

    @property
    def joints(self) -> Floats:
        """What the encoders say, (n,)."""
        raise NotImplementedError

    @property
    def true_joints(self) -> Floats:
        """Where the joints are, (n,)."""
        raise NotImplementedError

    def command(self, joints: ArrayLike) -> None:
        """Give the servo its next set-point, (n,)."""
        raise NotImplementedError

    def joints_for(self, R_BS: Floats, p_BS_B: Floats, near: ArrayLike | None = None) -> Floats:
        """Return joints, (n,), that hold the sensor so; of several the ones found from `near`, or from `start`."""
        raise NotImplementedError

    # ---- physics and truth -------------------------------------------------------------------------

    def step(self) -> None:
        """
        Go on by one time step; the servos know the masses and the weight where everything is now.

        Raises
        ------
        PhysicsError
            See `PhysicsScene.step`.
        """
        self._change_tissue()
        # Before `mj_step` they would be those of the step before, and none at all at the first.
        self.mujoco.mj_step1(self.model, self.data)
        self.control()
        self.mujoco.mj_step2(self.model, self.data)
        if self._warnings.any():
            self._fail()

    def look(self) -> None:
        """Have the sensors tell of now, with the forces that the servos give now: what speeds up is felt by them."""
        self.mujoco.mj_step1(self.model, self.data)
        self.control()
        # Places and speeds are known by now.
        self.mujoco.mj_forwardSkip(self.model, self.data, self.mujoco.mjtStage.mjSTAGE_VEL, 0)

    def surface(self) -> tuple[Floats, Floats]:
        """
        Return the middle of the phantom's top in B, m, and the normal that points out of it, both (3,).

        Of a cylinder it is the place next to the middle of the probe's face.
        """
        # After a step the poses are those of its beginning.
        self.mujoco.mj_kinematics(self.model, self.data)
        body = self.data.body(OTHER)
        R_BO, p_BO = body.xmat.reshape(3, 3), body.xpos.copy()
        if self._tissue.cylinder is None:
            return p_BO, -R_BO[:, 2]
        R_BS = self.data.site_xmat[self._site].reshape(3, 3)
        face = self.data.site_xpos[self._site] + self.top * R_BS[:, 2]
        place, normal = self._tissue.cylinder.nearest(R_BO.T @ (face - p_BO))
        return p_BO + R_BO @ place, R_BO @ normal

    def angles(self) -> tuple[float, float]:
        """
        Return how far the phantom's normal is turned against the probe's axis, rad.

        In plane: the turn about S's y, along the long side of the face; out of plane: about its x. A probe that turns
        by them in S, as small as they are, stands upright on the phantom.
        """
        _, normal = self.surface()
        R_BS = self.data.site_xmat[self._site].reshape(3, 3)
        inward = -R_BS.T @ normal
        return float(np.arctan2(inward[0], inward[2])), float(np.arctan2(-inward[1], inward[2]))

    def held_at(self, gap: float, pose: ArrayLike | None = None) -> tuple[Floats, Floats]:
        """
        Return R_BS (3, 3) and p_BS_B (3,) of a probe upright on the phantom's middle.

        Parameters
        ----------
        gap : float
            m between them.
        pose : (6,), optional
            Where the phantom is, as `PlatformMotion.at` says; left out, where it rests.
        """
        moved = np.zeros(6) if pose is None else np.asarray(pose, dtype=np.float64)
        R_BP = self.T_BP[:3, :3]
        R_BS = R_BP @ Rotation.from_euler("XYZ", moved[3:]).as_matrix() @ DOWN
        return R_BS, self.T_BP[:3, 3] + R_BP @ moved[:3] - (self.top + gap) * R_BS[:, 2]

    def _pulled(self) -> Floats:
        """Return the acceleration (6,) with which the platform stays where it should be."""
        now = self.time
        speed = self._platform_speed(now)
        # Over the step: at a jump in speed the derivative is none, and what it begins with must fit its length.
        ahead = (self._platform_speed(now + self.step_s) - speed) / self.step_s
        off = self._platform(now) - self.data.qpos[-6:]
        return np.asarray(ahead + SERVO**2 * off + 2 * SERVO * (speed - self.data.qvel[-6:]))

    def _platform(self, time: float) -> Floats:
        return np.zeros(6) if self.motion is None else self.motion.at(time)

    def _platform_speed(self, time: float) -> Floats:
        return np.zeros(6) if self.motion is None else self.motion.speed(time)


def add_platform(spec: Any, T_BP: Floats, tissue: Tissue) -> None:
    """Add the phantom, which moves along and about the axes of P, z up."""
    turned = Rotation.from_matrix(T_BP[:3, :3] @ DOWN).as_quat(scalar_first=True)
    other = spec.worldbody.add_body(name=OTHER, pos=T_BP[:3, 3], quat=turned)
    # The inverse of DOWN is itself: its rows are the axes of P in the body's frame.
    add_six_joints(other, DOWN)
    add_phantom(other, tissue)


class PlatformScene(MovedScene):
    """
    The probe points down at the phantom; B is where the platform rests, z up.

    Parameters
    ----------
    truth : TrueSurface
    payload : Payload, optional
    tissue : Tissue, optional
    motion : PlatformMotion, optional
        Left out: it rests.
    gap : float
        m between probe and phantom at the beginning.
    step : float
        s.
    places : int
        About how many places of the face feel the tissue.
    period : float
        s between set-points.

    Attributes
    ----------
    start : (6,)
        Joints at the beginning: where the flange E, which is S, is in B (m), and turns about the moved x, y, z axes
        (rad) on top of `DOWN`.

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
        tissue: Tissue | None = None,
        motion: PlatformMotion | None = None,
        gap: float = 0.003,
        step: float = PRESS_STEP_S,
        places: int = PLACES,
        period: float = 0.02,
    ) -> None:
        tissue = tissue or Tissue()
        spec = new_spec(step)
        turned = Rotation.from_matrix(DOWN).as_quat(scalar_first=True)
        carrier = spec.worldbody.add_body(name="carrier", quat=turned)
        add_six_joints(carrier, DOWN)
        where, area = add_probe(spec, carrier, truth, payload or Payload(), tissue, places)
        add_platform(spec, np.eye(4), tissue)
        fixed = {"T_BP": np.eye(4), "R_ES": np.eye(3), "p_ES_E": np.zeros(3)}
        super().__init__(spec, truth, tissue, where, area, motion=motion, **fixed)
        self.start = np.array([0.0, 0.0, self.top + gap, 0.0, 0.0, 0.0])
        self._path = ServoPath(self.start, _FASTEST, _HARDEST, period, _BANDWIDTH, self.step_s)
        self.data.qpos[:6] = self.start

    @property
    def joints(self) -> Floats:
        """Where the mount is, (6,), as `start`: nothing is rounded."""
        return np.array(self.data.qpos[:6])

    @property
    def true_joints(self) -> Floats:
        """The same."""
        return self.joints

    def joints_for(self, R_BS: Floats, p_BS_B: Floats, near: ArrayLike | None = None) -> Floats:
        """Return joints, (6,), that hold the sensor so; there are no others, so that `near` does not count."""
        del near
        return np.concatenate([p_BS_B, Rotation.from_matrix(R_BS @ DOWN).as_euler("XYZ")])

    def command(self, joints: ArrayLike) -> None:
        """Give the mount's servo its next set-point, (6,)."""
        self._path.give(self.time, np.asarray(joints, dtype=np.float64))

    def control(self) -> None:
        """Pull both sides to where they should be, with the forces that this takes."""
        path = self._path
        path.go_on(self.time)
        off, slow = path.place - self.data.qpos[:6], path.speed - self.data.qvel[:6]
        asked = path.change + SERVO**2 * off + 2 * SERVO * slow
        self._push(np.concatenate([asked, self._pulled()]))


# ---- how a platform moves what lies on it --------------------------------------------------------


_INSTANT_S = 1e-9  # times of a scene are sums of its steps
AXES = ("x", "y", "z", "rx", "ry", "rz")


@dataclass(frozen=True, eq=False)
class PlatformMotion:
    """
    A sine along and about the axes of the platform P, z up; the turns are about the middle of the phantom's top.

    Attributes
    ----------
    amplitude : (6,)
        m along x, y, z, then rad about x, y, z.
    period : float
        s.
    start : float
        Until then it rests, s; then it begins with a jump in speed, as the paper's.
    ease : float
        For so long after the start the amplitude grows to its full size, s; 0: at once.
    """

    amplitude: Floats
    period: float
    start: float = 0.0
    ease: float = 0.0

    def __post_init__(self) -> None:
        amplitude = np.array(self.amplitude, dtype=np.float64)
        if amplitude.shape != (6,) or not np.isfinite(amplitude).all():
            raise InputError(
                f"platform: amplitude {arg(self.amplitude)}: give six finite numbers, m and rad."
            )
        if not (0 < self.period < 1e6 and 0 <= self.start < 1e6 and 0 <= self.ease < 1e6):
            raise InputError(
                f"platform: period {arg(self.period)} s, start {arg(self.start)} s, ease {arg(self.ease)} s:"
                " the period must be positive, the others 0 or more."
            )
        object.__setattr__(self, "amplitude", amplitude)

    @classmethod
    def along(cls, axis: str, size: float, period: float, start: float = 0.0) -> PlatformMotion:
        """
        Move along or about one axis.

        Parameters
        ----------
        size : float
            m or rad.
        period, start : float
            s.

        Raises
        ------
        InputError
            There is no such axis.
        """
        if axis not in AXES:
            raise InputError(f"platform: axis {arg(axis)!r}: give one of {arg(', '.join(AXES))}.")
        return cls(size * np.eye(6)[AXES.index(axis)], period, start)

    def at(self, time: float) -> Floats:
        """Return position and angles, (6,), at a time, s."""
        since = max(time - self.start, 0.0)
        share = 1.0 if self.ease == 0 else min(since / self.ease, 1.0)
        return np.asarray(self.amplitude * (share * math.sin(2 * math.pi * since / self.period)))

    def speed(self, time: float) -> Floats:
        """Return how fast they change, (6,), m/s and rad/s; where that jumps, the mean of both sides."""
        since, turn = time - self.start, 2 * math.pi / self.period
        if since < -_INSTANT_S:
            return np.zeros(6)
        if since >= self.ease - _INSTANT_S:
            share = 1.0 if since > _INSTANT_S or self.ease > 0 else 0.5
            return np.asarray(self.amplitude * (share * turn * math.cos(turn * since)))
        growing = math.sin(turn * since) + turn * since * math.cos(turn * since)
        return np.asarray(self.amplitude * (growing / self.ease))

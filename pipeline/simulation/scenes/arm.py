"""
An arm that carries sensor and probe, over a soft phantom on a platform that moves with six axes.

The arm has its real chain, limits, and link masses; its position servo follows set-points within the limits of speed,
acceleration and torque, and meets gravity and the coupling of its joints by a model that is right. The controller
reads rounded angles. Left out: that joints, links and the table bend, friction and ripple of gears, the inertia of
rotors, a wrong model in the servo, delays on the wire, collisions of the arm, and what `PlatformScene` leaves out of
tissue.

On a convex probe at 7 N, a phantom that turns by 10 degrees or heaves by 10 mm in 2 s, and set-points that follow nine
tenths of it, the arm instead of the platform's mount changes the force by 0.1 N, angles by 0.02 degrees, and the
force's direction by up to 0.6; half the time step changes those by 0.002 N, 0.001 and 0.07. Encoders of 17 bits
put the flange where it is within some 10 µm.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.robot import Robot, RobotDescription
from contactbench.pipeline.simulation.scenes.physics import Payload, TrueSurface, new_spec, physics
from contactbench.pipeline.simulation.scenes.platform import (
    PLACES,
    PRESS_STEP_S,
    MovedScene,
    PlatformMotion,
    Tissue,
    add_platform,
    add_probe,
)
from contactbench.pipeline.simulation.scenes.setpoints import JointServo, ServoSettings

# In front of the base, on its table, turned to face it: there an Elfin3 is far from its limits and from singularities,
# and the quickest motion (10 degrees in 2 s) asks for half of its speed.
_PLACE_B = np.array([0.32, 0.0, 0.10])
_FACING = np.diag([-1.0, -1.0, 1.0])
_BENT = (0.0, 0.0, 1.8, 0.0, 1.35, 0.0)  # elbow up, tool down: where the search for the first joints starts
_ROUNDS, _CLOSE = 100, 1e-10


class ArmScene(MovedScene):
    """
    The probe on an arm; B is the arm's base, z up.

    Parameters
    ----------
    truth : TrueSurface
    payload : Payload, optional
    tissue : Tissue, optional
    motion : PlatformMotion, optional
        Along and about the axes of P; left out: it rests.
    robot : Robot, optional
        An Elfin3 when left out.
    servo : ServoSettings, optional
    R_ES : (3, 3), optional
        Left out: the sensor's axes are the flange's.
    p_ES_E : (3,), optional
        m; left out: on the flange.
    T_BP : (4, 4), optional
        Where the middle of the phantom's top rests; the probe's long side is held along x.
    near : (n,), optional
        Joints from which those of the beginning are searched, rad.
    gap : float
        m between probe and phantom at the beginning.
    step : float
        s.
    places : int
        About how many places of the face feel the tissue.

    Attributes
    ----------
    robot : Robot
    start : (n,)
        Joints at the beginning, rad.

    Raises
    ------
    InputError
        MuJoCo is missing, or the arm does not reach the phantom.
    """

    def __init__(
        self,
        truth: TrueSurface,
        *,
        payload: Payload | None = None,
        tissue: Tissue | None = None,
        motion: PlatformMotion | None = None,
        robot: Robot | None = None,
        servo: ServoSettings | None = None,
        R_ES: ArrayLike | None = None,
        p_ES_E: ArrayLike | None = None,
        T_BP: ArrayLike | None = None,
        near: ArrayLike = _BENT,
        gap: float = 0.003,
        step: float = PRESS_STEP_S,
        places: int = PLACES,
    ) -> None:
        tissue = tissue or Tissue()
        self.robot = robot or Robot.named("elfin3")
        T_ES = _pose(np.eye(3) if R_ES is None else R_ES, np.zeros(3) if p_ES_E is None else p_ES_E, "T_ES")
        rests = np.array(_pose(_FACING, _PLACE_B, "T_BP") if T_BP is None else T_BP, dtype=np.float64)
        if rests.shape != (4, 4):
            raise InputError(f"T_BP: give a pose of (4, 4), not {arg(rests.shape)}.")
        rests = _pose(rests[:3, :3], rests[:3, 3], "T_BP")
        spec = new_spec(step)
        flange = add_arm(spec, self.robot.description)
        holder = flange.add_body(pos=T_ES[:3, 3], quat=_quaternion(T_ES[:3, :3]))
        where, area = add_probe(spec, holder, truth, payload or Payload(), tissue, places)
        add_platform(spec, rests, tissue)
        fixed = {"T_BP": rests, "R_ES": T_ES[:3, :3], "p_ES_E": T_ES[:3, 3]}
        super().__init__(spec, truth, tissue, where, area, motion=motion, **fixed)
        self.start = self.joints_for(*self.held_at(gap), near)
        self._servo = JointServo(self.robot, self.start, servo or ServoSettings(), self.step_s)
        self._n = len(self.start)
        # The platform pulls as hard as it has to.
        self._most = np.full(self.model.nv, np.inf)
        self._most[: self._n] = [joint.effort for joint in self.robot.description.joints]
        self.data.qpos[: self._n] = self.start

    @property
    def joints(self) -> Floats:
        """What the encoders say, (n,), rad."""
        return self._servo.read(self.true_joints)

    @property
    def true_joints(self) -> Floats:
        """Where the joints are, (n,), rad."""
        return np.array(self.data.qpos[: self._n])

    @property
    def torques(self) -> Floats:
        """What the motors gave in the last step, (n,), N·m."""
        return np.array(self.data.qfrc_applied[: self._n])

    def command(self, joints: ArrayLike) -> None:
        """Give the servo its next set-point, (n,), rad."""
        self._servo.command(self.time, np.asarray(joints, dtype=np.float64))

    def control(self) -> None:
        """Pull the arm along its path and the platform along its own, with the forces that this takes."""
        n = self._n
        asked = self._servo.acceleration(self.time, self.data.qpos[:n], self.data.qvel[:n])
        self._push(np.concatenate([asked, self._pulled()]), self._most)

    def joints_for(self, R_BS: Floats, p_BS_B: Floats, near: ArrayLike | None = None) -> Floats:
        """
        Return joints, (n,), that hold the sensor so; of several the ones found from `near`, or from `start`.

        Raises
        ------
        InputError
            The arm does not reach there.
        """
        R_BE = R_BS @ self.R_ES.T
        p_BE = p_BS_B - R_BE @ self.p_ES_E
        q = np.asarray(self.start if near is None else near, dtype=np.float64)
        for _ in range(_ROUNDS):
            R, p = self.robot.flange_pose(q)
            off = np.concatenate([p_BE - p, Rotation.from_matrix(R_BE @ R.T).as_rotvec()])
            if np.abs(off).max() < _CLOSE:
                break
            J = self.robot.flange_jacobian(q)
            q = q + J.T @ np.linalg.solve(J @ J.T + 1e-9 * np.eye(6), off)
        else:
            raise InputError(
                f"the arm {arg(self.robot.description.name)} does not reach"
                f" {arg(np.round(p_BS_B, 3).tolist())} m with this tool: move the phantom (T_BP) nearer, or"
                " give joints near there."
            )
        return self.robot.check_joints(np.arctan2(np.sin(q), np.cos(q)), message("above the phantom"))


def add_arm(spec: Any, description: RobotDescription) -> Any:
    """Add the links of an arm with their masses, and return a body at its flange."""
    mujoco = physics()
    body = spec.worldbody
    for joint in description.joints:
        body = body.add_body(
            name=joint.name,
            pos=joint.origin_xyz,
            quat=Rotation.from_euler("xyz", joint.origin_rpy).as_quat(scalar_first=True),
        )
        body.explicitinertial = True
        body.mass, body.ipos = joint.child_mass, joint.centre_xyz
        moments, axes = np.linalg.eigh(joint.inertia_matrix)
        body.inertia, body.iquat = moments, _quaternion(axes * np.linalg.det(axes))
        body.add_joint(name=joint.name, type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 0, 1])
    return body.add_body(
        pos=description.flange_xyz,
        quat=Rotation.from_euler("xyz", description.flange_rpy).as_quat(scalar_first=True),
    )


def _quaternion(R: Floats) -> Floats:
    return np.asarray(Rotation.from_matrix(R).as_quat(scalar_first=True))


def _pose(R: ArrayLike, p: ArrayLike, where: str) -> Floats:
    """Put a rotation and a place together, (4, 4), if they are such."""
    turn, place = np.asarray(R, dtype=np.float64), np.asarray(p, dtype=np.float64)
    shapes = turn.shape == (3, 3) and place.shape == (3,)
    if not (shapes and np.isfinite(turn).all() and np.isfinite(place).all()):
        raise InputError(f"{arg(where)}: give finite numbers: a rotation (3, 3) and a place (3,), m.")
    if not np.allclose(turn @ turn.T, np.eye(3), atol=1e-6) or np.linalg.det(turn) < 0:
        raise InputError(f"{arg(where)}: {arg(turn.round(4).tolist())} is not a rotation matrix.")
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = turn, place
    return T

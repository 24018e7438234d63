"""Whether the arm keeps clear of its base, of itself and of the floor.

Links and tool are capsules. What is left out: everything else in the room (bed, patient, cables, people), the
shape of the links beyond their capsules, links next to each other (the joint limits keep those apart), and
what happens on the way from one configuration to the next unless `path_conflict` is asked.

Only what moves is watched: a gap that no moving joint changes is as wide as where the arm stands already.
That lets the wrist work above a bed higher than the shoulder, and a folded elbow keep still.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.robot.robot_file import Kinematics, fixed_axes
from contactbench.pipeline.robot.robots import TOOL, Capsule, RobotDescription, Triple, joint_angles


@dataclass(frozen=True)
class Clearance:
    """What the arm carries, and how far it has to keep away from what.

    Raises
    ------
    InputError
        A length is not finite (`z_min` may be -inf) or out of range.
    """

    # (3,) tip of the tool in the flange frame, m; the tool is the capsule from the flange to there. All
    # zeros: no tool.
    p_ET_E: Triple = (0.0, 0.0, 0.2)
    tool_radius: float = 0.05  # Radius of that capsule, m: sensor, adapter and probe must fit inside
    # Height in B that links and tool stay above, m: 0 is a table that the base stands on, a negative number
    # the floor below a column. -inf: no floor, as for an arm that hangs from the ceiling.
    z_min: float = 0.0
    # Smallest gap between any two capsules, and between a capsule and `z_min`, m. It also pays for what the
    # capsules get wrong.
    distance: float = 0.02

    def __post_init__(self) -> None:
        if np.shape(self.p_ET_E) != (3,) or not np.isfinite(self.p_ET_E).all():
            raise InputError(f"Clearance.p_ET_E: give three finite numbers (m), not {arg(self.p_ET_E)!r}")
        if not (np.isfinite(self.tool_radius) and self.tool_radius > 0):
            raise InputError(
                f"Clearance.tool_radius: give a length above 0 (m), not {arg(self.tool_radius)!r}"
            )
        if not self.z_min < np.inf:
            raise InputError(f"Clearance.z_min: give a height in B (m) or -inf, not {arg(self.z_min)!r}")
        if not (np.isfinite(self.distance) and self.distance >= 0):
            raise InputError(
                f"Clearance.distance: give a length of at least 0 (m), not {arg(self.distance)!r}"
            )


class ClearanceCheck:
    """Checks configurations of one arm against one `Clearance`.

    Parameters
    ----------
    description : RobotDescription
        The arm.
    clearance : Clearance
        The tool and the gaps to keep.

    Raises
    ------
    InputError
        The description has no capsules, or MuJoCo is not installed.
    """

    def __init__(self, description: RobotDescription, clearance: Clearance) -> None:
        if not description.capsules:
            raise InputError(
                f"robot {arg(description.name)} has no capsules: its clearance cannot be checked"
            )
        self._description = description
        self._clearance = clearance
        self._capsules = description.capsules + _tool(description, clearance)
        self._kinematics = Kinematics(description, self._capsules)
        model = self._kinematics.model
        self._geoms = [model.geom(capsule.name).id for capsule in self._capsules]
        self._pairs = [
            (i, j)
            for i, j in combinations(range(len(self._capsules)), 2)
            if _may_touch(self._capsules[i], self._capsules[j], description)
        ]
        self._radius = model.geom_size[self._geoms, 0].copy()
        self._half_length = model.geom_size[self._geoms, 1].copy()

    def conflict(self, q: ArrayLike, *, moving: ArrayLike | None = None) -> str | None:
        """Say what is too close.

        Parameters
        ----------
        q : (n,) array_like
            Joint angles, rad.
        moving : (n,) array_like of bool, optional
            The joints that move to get there; the gaps that they change are watched. Default: all.

        Returns
        -------
        str or None
            The first pair found, such as "tool to upper arm" or "tool to floor"; None when all is clear.

        Raises
        ------
        InputError
            The shape is wrong or a number is not finite.
        """
        angles = joint_angles(self._description, q)
        joints = np.ones(len(angles), dtype=bool) if moving is None else np.asarray(moving, dtype=bool)
        if joints.shape != angles.shape:
            raise InputError(f"conflict: moving needs the shape {arg(angles.shape)}, not {arg(joints.shape)}")
        return self._conflict(angles, joints.tolist())

    def path_conflict(self, q_a: ArrayLike, q_b: ArrayLike, *, step: float = 0.02) -> str | None:
        """Say what comes too close while all joints move from q_a to q_b in proportion.

        No point of the arm moves further than (sum of the joint angles) x (its reach), so between two samples
        nothing comes nearer than the gaps checked by more than half a step times the reach: 0.01 rad x 1.1 m
        = 11 mm for an arm of 0.9 m with a tool of 0.2 m.

        Parameters
        ----------
        q_a, q_b : (n,) array_like
            Start and end, rad.
        step : float
            Largest sum of the joint angles between two samples, rad.

        Returns
        -------
        str or None
            As `conflict`, for the first sample that is not clear.

        Raises
        ------
        InputError
            A shape is wrong, a number is not finite, or `step` is not positive.
        """
        if not step > 0:
            raise InputError(f"path_conflict: step must be above 0 rad, not {arg(step)!r}")
        start, end = joint_angles(self._description, q_a), joint_angles(self._description, q_b)
        moving = (start != end).tolist()
        samples = int(np.ceil(np.abs(end - start).sum() / step)) + 1
        for s in np.linspace(0.0, 1.0, max(samples, 2)):
            found = self._conflict((1.0 - s) * start + s * end, moving)
            if found is not None:
                return found
        return None

    def _conflict(self, q: NDArray[np.float64], moving: list[bool]) -> str | None:
        with self._kinematics.lock:
            self._kinematics.place(q)
            return self._floor_conflict(moving) or self._pair_conflict(moving)

    def _floor_conflict(self, moving: list[bool]) -> str | None:
        if self._clearance.z_min == -np.inf:
            return None
        data = self._kinematics.data
        # A capsule's axis is the z axis of its geom; entry 8 of the row-major rotation is that axis' height.
        rise = np.abs(data.geom_xmat[self._geoms, 8]) * self._half_length
        gap = data.geom_xpos[self._geoms, 2] - rise - self._radius - self._clearance.z_min
        for i, capsule in enumerate(self._capsules):
            if any(moving[: capsule.body]) and gap[i] < self._clearance.distance:
                return message(f"{arg(capsule.name)} to floor")
        return None

    def _pair_conflict(self, moving: list[bool]) -> str | None:
        kinematics, geoms, distance = self._kinematics, self._geoms, self._clearance.distance
        # Past distmax MuJoCo stops counting, and some versions then answer with a huge number: both are clear.
        distmax = distance + 0.01
        for i, j in self._pairs:
            a, b = self._capsules[i], self._capsules[j]
            if not any(moving[min(a.body, b.body) : max(a.body, b.body)]):
                continue
            gap = kinematics.mujoco.mj_geomDistance(
                kinematics.model, kinematics.data, geoms[i], geoms[j], distmax, None
            )
            if not gap >= distance:  # so that NaN is a conflict
                return message(f"{arg(b.name)} to {arg(a.name)}")
        return None


def _tool(description: RobotDescription, clearance: Clearance) -> tuple[Capsule, ...]:
    """Give the tool as a capsule of the last link, which carries the flange; nothing for no tool."""
    if not np.any(clearance.p_ET_E):
        return ()
    R_6E = fixed_axes(description.flange_rpy)
    tip = np.add(description.flange_xyz, R_6E.apply(clearance.p_ET_E))
    last = len(description.joints)
    start = description.flange_xyz
    return (Capsule(TOOL, last, start, (tip[0], tip[1], tip[2]), clearance.tool_radius),)


def _may_touch(a: Capsule, b: Capsule, description: RobotDescription) -> bool:
    if abs(a.body - b.body) < 2:
        return False
    return (a.name, b.name) not in description.never_touch and (b.name, a.name) not in description.never_touch

"""Kinematics of one arm: flange pose, Jacobian, limits, and where it could go next."""

from collections import Counter
from collections.abc import Iterator
from functools import cached_property
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.robot.clearance import Clearance, ClearanceCheck
from contactbench.pipeline.robot.robot_file import Kinematics, names_file, read_robot
from contactbench.pipeline.robot.robots import ROBOTS, RobotDescription, joint_angles


class Robot:
    """An arm with n revolute joints, from the base frame B to the flange frame E.

    Joint angles are in rad everywhere. Poses and Jacobians need MuJoCo, which is loaded when the first one
    is asked for; limits and travel times do without. Several threads may share one robot.

    Parameters
    ----------
    description : RobotDescription
        The arm.

    Examples
    --------
    >>> robot = Robot.named("elfin3")
    >>> R_BE, p_BE_B = robot.flange_pose([0, 0, pi / 2, 0, pi / 2, 0])
    >>> p_BE_B.round(4)
    array([0.324 , 0.    , 0.3035])
    """

    def __init__(self, description: RobotDescription) -> None:
        self.description = description
        joints = description.joints
        self.lower = _constant([joint.lower for joint in joints])  # (n,) rad; these four are read-only
        self.upper = _constant([joint.upper for joint in joints])  # (n,) rad
        self.velocity_limits = _constant([joint.velocity for joint in joints])  # (n,) rad/s
        self.acceleration_limits = _constant(
            [joint.acceleration for joint in joints]
        )  # (n,) rad/s²; unknown: inf

    @classmethod
    def named(cls, name: str) -> "Robot":
        """Look up a known arm, or read one from a file.

        Parameters
        ----------
        name : str
            A key of `ROBOTS`, such as "elfin3", or a URDF or MJCF file, see `read_robot`.

        Raises
        ------
        InputError
            There is none of that name, or the file is no arm.
        """
        if names_file(name):
            return cls(read_robot(name))
        if name not in ROBOTS:
            known = ", ".join(sorted(ROBOTS))
            raise InputError(
                f"there is no robot named {arg(name)!r}; known: {arg(known)}, or a URDF or MJCF file"
            )
        return cls(ROBOTS[name])

    def flange_pose(self, q: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Pose of the flange.

        Parameters
        ----------
        q : (n,) array_like
            Joint angles, rad. They may lie outside the limits: a reading is never refused.

        Returns
        -------
        R_BE : (3, 3) array
            Orientation; columns are the axes of E in B.
        p_BE_B : (3,) array
            Position, m.

        Raises
        ------
        InputError
            The shape is wrong, a number is not finite, or MuJoCo is not installed.
        """
        return self._kinematics.flange(joint_angles(self.description, q))

    def flange_rotations(self, Q: ArrayLike) -> NDArray[np.float64]:
        """Orientations of the flange for many configurations.

        Parameters
        ----------
        Q : (m, n) array_like
            Joint angles, rad.

        Returns
        -------
        (m, 3, 3) array
            R_BE, each as `flange_pose` gives it.

        Raises
        ------
        InputError
            As `flange_pose`.
        """
        return self._kinematics.rotations(joint_angles(self.description, Q, ndim=2))

    def flange_jacobian(self, q: ArrayLike) -> NDArray[np.float64]:
        """Jacobian of the flange's motion, in B, at the origin of E.

        Parameters
        ----------
        q : (n,) array_like
            Joint angles, rad.

        Returns
        -------
        (6, n) array
            J with [v; w] = J dq/dt: three rows for the velocity v of the origin of E (m/s per rad/s), then
            three for the angular velocity w (rad/s per rad/s).

        Raises
        ------
        InputError
            As `flange_pose`.
        """
        return self._kinematics.jacobian(joint_angles(self.description, q))

    def within_limits(self, q: ArrayLike, *, margin: float = 0.0) -> NDArray[np.bool_]:
        """Tell whether every joint is within its limits, ends included.

        Parameters
        ----------
        q : (..., n) array_like
            Joint angles, rad.
        margin : float
            Distance to keep from the limits, rad; a negative one lets rounded readings pass.

        Returns
        -------
        (...) array of bool
            One answer per configuration; without leading axes it has shape () and works in an ``if``.

        Raises
        ------
        InputError
            The last axis does not have n entries, or a number is not finite.
        """
        angles = joint_angles(self.description, q, ndim=None)
        inside = (angles >= self.lower + margin) & (angles <= self.upper - margin)
        return np.asarray(inside.all(axis=-1))

    def check_joints(self, q: ArrayLike, where: str = "") -> NDArray[np.float64]:
        """Refuse joint angles that the arm cannot take.

        Parameters
        ----------
        q : (n,) array_like
            Joint angles, rad.
        where : str
            Where they come from, such as "poses.csv, line 3"; begins the message.

        Returns
        -------
        (n,) array
            The angles.

        Raises
        ------
        InputError
            The shape is wrong, a number is not finite, or a joint is outside its limits: the message names
            it, its value and its limits.
        """
        angles = joint_angles(self.description, q, where=where)
        for joint, value in zip(self.description.joints, angles, strict=True):
            if joint.lower <= value <= joint.upper:
                continue
            prefix = f"{where}: " if where else ""
            hint = message("; check whether these are degrees") if np.abs(angles).max() > 2 * pi else ""
            raise InputError(
                f"{arg(prefix)}joint {arg(joint.name)} is at {arg(value):.4f} rad"
                f" ({arg(np.degrees(value)):.2f}°), outside its limits {arg(joint.lower):.4f} .."
                f" {arg(joint.upper):.4f} rad ({arg(np.degrees(joint.lower)):.2f}° .."
                f" {arg(np.degrees(joint.upper)):.2f}°){arg(hint)}"
            )
        return angles

    def travel(self, q_a: ArrayLike, q_b: ArrayLike) -> NDArray[np.float64]:
        """Time that a move takes when every joint goes at its limit: the slowest joint decides.

        Accelerations are left out, so short moves take longer than this; the order of moves stays useful.

        Parameters
        ----------
        q_a, q_b : (..., n) array_like
            Start and end, rad; leading axes broadcast.

        Returns
        -------
        (...) array
            max over joints of |q_b - q_a| / velocity limit, s.

        Raises
        ------
        InputError
            A shape is wrong or a number is not finite.
        """
        start, end = (joint_angles(self.description, q, ndim=None) for q in (q_a, q_b))
        try:
            moved = np.abs(end - start)
        except ValueError as error:
            raise InputError(
                f"travel: shapes {arg(start.shape)} and {arg(end.shape)} do not broadcast"
            ) from error
        return np.asarray((moved / self.velocity_limits).max(axis=-1))

    def candidate_joints(
        self,
        q_start: ArrayLike,
        *,
        count: int = 64,
        seed: int | np.random.Generator = 0,
        wrist_only: bool = True,
        wrist_reach: float = 2 * pi,
        arm_reach: float = 0.5,
        margin: float = 0.05,
        clearance: Clearance | None = None,
    ) -> NDArray[np.float64]:
        """Propose configurations for a calibration: spread evenly, within limits, clear of base and floor.

        The last three joints tilt the tool any way while the arm stays put, so by default only they move. The
        spread is even in joint angles, from the first candidate on: more candidates with the same integer
        seed only append to fewer. Nothing is said about the way there:
        `ClearanceCheck.path_conflict` looks along it.

        Parameters
        ----------
        q_start : (n,) array_like
            Present configuration, rad, within the limits.
        count : int
            Number of candidates wanted.
        seed : int or numpy.random.Generator
            Another seed, another set; the same integer gives the same set on every machine.
        wrist_only : bool
            Keep all joints but the last three where they are.
        wrist_reach, arm_reach : float
            How far the last three and the other joints may go from q_start, rad.
        margin : float
            Distance that moving joints keep from their limits, rad.
        clearance : Clearance, optional
            Tool, floor and gaps; the default has a tool of 0.2 m along z of E and a table at the base.

        Returns
        -------
        (m, n) array
            1 <= m <= count candidates, rad; fewer than count where little is clear.

        Raises
        ------
        InputError
            q_start or an option is no use, no candidate is clear, or MuJoCo is not installed.
        """
        start = self.check_joints(q_start, "candidate_joints: q_start")
        if count < 1:
            raise InputError(f"candidate_joints: count must be at least 1, not {arg(count)}")
        for name, value in {"wrist_reach": wrist_reach, "arm_reach": arm_reach}.items():
            if not (np.isfinite(value) and value > 0):
                raise InputError(
                    f"candidate_joints: {arg(name)} must be finite and above 0 rad, not {arg(value)!r}"
                )
        if not (np.isfinite(margin) and margin >= 0):
            raise InputError(
                f"candidate_joints: margin must be finite and at least 0 rad, not {arg(margin)!r}"
            )
        reach = np.full(len(start), 0.0 if wrist_only else arm_reach)
        reach[-WRIST_JOINTS:] = wrist_reach
        check = ClearanceCheck(self.description, clearance or Clearance())
        return draw_candidates(
            self.description, start, check, count=count, seed=seed, reach=reach, margin=margin
        )

    @cached_property
    def _kinematics(self) -> Kinematics:
        return Kinematics(self.description)


def _constant(values: list[float]) -> NDArray[np.float64]:
    array = np.array(values)
    array.flags.writeable = False
    return array


# ---- well-spread, clear configurations near the present one --------------------------------------


WRIST_JOINTS = 3
# A start from which fewer than one draw in 32 is clear is a start to complain about.
_DRAWS_PER_CANDIDATE = 32
_LEAST_DRAWS = 1024
_BLOCK = 256


def draw_candidates(
    description: RobotDescription,
    q_start: NDArray[np.float64],
    check: ClearanceCheck,
    *,
    count: int,
    seed: int | np.random.Generator,
    reach: NDArray[np.float64],
    margin: float,
) -> NDArray[np.float64]:
    """Draw configurations within `reach` of q_start that are clear; `Robot.candidate_joints` explains.

    Parameters
    ----------
    description : RobotDescription
        The arm.
    q_start : (n,) array
        Configuration to stay near, rad, within the limits.
    check : ClearanceCheck
        Refuses what is not clear.
    count : int
        How many are wanted.
    seed : int or numpy.random.Generator
        Shifts the sequence.
    reach : (n,) array
        How far each joint may move from q_start, rad; 0 holds it.
    margin : float
        Distance kept from the limits of the joints that move, rad.

    Returns
    -------
    (m, n) array
        1 <= m <= count configurations, rad.

    Raises
    ------
    InputError
        The margin leaves a joint no room, or no configuration is clear.
    """
    low, high = _box(description, q_start, reach, margin)
    kept: list[NDArray[np.float64]] = []
    conflicts: Counter[str] = Counter()
    moving = reach > 0
    for q in _spread(low, high, moving, max(_LEAST_DRAWS, _DRAWS_PER_CANDIDATE * count), seed):
        found = check.conflict(q, moving=moving)
        if found is None:
            kept.append(q)
            if len(kept) == count:
                break
        else:
            conflicts[found] += 1
    if not kept:
        raise InputError(_complaint(conflicts))
    return np.array(kept)


def _box(
    description: RobotDescription, q_start: NDArray[np.float64], reach: NDArray[np.float64], margin: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lowest and highest angle of each joint, rad; both are q_start where the joint is held."""
    low, high = q_start.copy(), q_start.copy()
    for i, joint in enumerate(description.joints):
        if reach[i] == 0:
            continue
        floor, ceiling = joint.lower + margin, joint.upper - margin
        if floor > ceiling:
            raise InputError(
                f"candidate_joints: a margin of {arg(margin)} rad leaves joint {arg(joint.name)} no range"
            )
        # A start inside the margin pulls the box back in rather than emptying it.
        centre = min(max(q_start[i], floor), ceiling)
        low[i], high[i] = max(floor, centre - reach[i]), min(ceiling, centre + reach[i])
    return low, high


def _spread(
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    moving: NDArray[np.bool_],
    draws: int,
    seed: int | np.random.Generator,
) -> Iterator[NDArray[np.float64]]:
    """Yield points that fill the box evenly from the first one on.

    Halton points need no power of two, and any first part of them is spread too. Unscrambled and shifted by
    hand they are the same in every release of SciPy.
    """
    from scipy.stats import qmc  # half a second to import, which not everybody who wants a pose should pay

    size = int(moving.sum())
    shift = np.random.default_rng(seed).random(size)
    points = qmc.Halton(size, scramble=False)
    for _ in range(0, draws, _BLOCK):
        for u in (points.random(_BLOCK) + shift) % 1.0:
            q = low.copy()
            q[moving] += u * (high - low)[moving]
            yield q


def _complaint(conflicts: Counter[str]) -> str:
    tried = conflicts.total()
    worst = join(
        ", ",
        (message(f"{arg(what)} ({arg(times)} of {arg(tried)})") for what, times in conflicts.most_common(3)),
    )
    return message(
        f"candidate_joints: none of {arg(tried)} configurations near the start is clear; too close:"
        f" {arg(worst)}. Move the arm away from there, allow the arm joints to move too, or correct the"
        " Clearance."
    )

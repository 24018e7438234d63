"""Which pose to take next, and which poses to take at all: those that help the contact point most."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache, cached_property, partial
from itertools import pairwise, permutations
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.model import (
    DOWN_W,
    GRAVITY,
    UNKNOWN,
    GravityModel,
    PoseNoise,
    cross_matrix,
    felt,
    length,
    parameter_covariance,
    prediction_jacobian,
    upright,
)
from contactbench.pipeline.calibration.orientation import plain
from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.files import Progress, unheard
from contactbench.pipeline.robot import Clearance, ClearanceCheck, Robot

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.calibration.calibrate import Calibration

# What a pose means before anything was measured: a probe of half a kilogram, like the bundled ones.
USUAL_LOAD = GravityModel(np.array([0.0, 0.0, -5.0]), np.zeros(3), np.array([0.0, 0.0, 0.05]), np.zeros(3))
USUAL_NOISE = PoseNoise(0.05, 0.002)

# Of poses that are this nearly as good as the best one, the one most unlike those before is taken.
_NEARLY = 1.05
_QUIETEST = np.repeat([1e-5, 1e-7], 3)  # N and N·m: finer than any sensor, coarse enough to invert
_UNDETERMINED = 0.05  # m
_HARDLY_KNOWN = 0.25  # of what a weight could be, 1 sigma
_PASSES = 8
_STARTS = 3
_ALL_ORDERS = 7  # poses whose every order is tried: 5,040
_LARGEST_PLAN = 60


@dataclass(frozen=True, eq=False)
class Suggestion:
    """A pose to take."""

    R_WS: NDArray[np.float64]  # (3, 3)
    joints: NDArray[np.float64] | None  # (6,) of the robot, rad
    travel: float  # s for a robot, rad by hand
    # The calibration's share of the contact error, worst 1 sigma, m: now, and predicted with this pose
    error_before: float
    error_after: float
    sentence: str  # What to do and what it gains


@dataclass(frozen=True, eq=False)
class PosePlan:
    """Poses to take, in this order."""

    R_WS: NDArray[np.float64]  # (n, 3, 3)
    joints: NDArray[np.float64] | None  # (n, 6) of the robot, rad
    # (n,) predicted share of the calibration in the contact error after each pose, worst 1 sigma, m; values
    # far beyond a probe's size mean that something is still undetermined
    errors: NDArray[np.float64]
    warnings: tuple[str, ...]  # Moves that are not clear

    @property
    def error(self) -> float:
        """After the last pose, m."""
        return float(self.errors[-1])


def suggest_pose(calibration: Calibration, reachable: Reachable) -> Suggestion:
    """Return the pose that lowers most the predicted error at the contact.

    Every candidate's reading would add its information to the calibration's; the covariance that would be
    left is carried to the contact points of the calibration's task, and the worst 1 sigma counts. Among
    candidates within five per cent of the best, the one is taken in which the weight pulls least as it did in
    any pose before: a cable or a play of the mount, which no covariance knows, then shows in the residuals.

    Parameters
    ----------
    calibration : Calibration
        May be one that is refused: that is when a suggestion is needed.
    reachable : Reachable
        The candidates.

    Raises
    ------
    InputError
        No candidate can be reached by a clear move.
    """
    theta = _plausible(calibration)
    J = prediction_jacobian(reachable.R_WS.swapaxes(1, 2), theta) / _sigmas(calibration.noise)
    A = calibration.task.parameter_sensitivity(theta)
    errors = _errors_with(calibration.covariance, J, A)
    settled = errors.min() < _UNDETERMINED
    taken = np.array([np.asarray(reachable.down_W) @ pose.R_WS for pose in calibration.poses])
    chosen = _newest_good(errors if settled else _ignorance(calibration.covariance, J), reachable, taken)
    before, after = calibration.contact_error, float(errors[chosen])
    sentence = message(f"Next: {arg(_how(reachable, chosen))}. {arg(_gain(before, after))}")
    return Suggestion(
        reachable.R_WS[chosen],
        reachable.joint_vector(chosen),
        float(reachable.travel[chosen]),
        before,
        after,
        sentence,
    )


def plan_poses(
    count: int,
    reachable: Reachable,
    *,
    load: GravityModel = USUAL_LOAD,
    noise: PoseNoise = USUAL_NOISE,
    task: ContactTask | None = None,
    progress: Progress = unheard,
) -> PosePlan:
    """Return `count` poses that together leave the least error at the contact.

    Poses are added one by one, then exchanged one for another as long as that helps (Fedorov's exchange),
    from several beginnings; the best set is ordered for short and clear moves.

    Parameters
    ----------
    count : int
        At least 3.
    reachable : Reachable
        What to choose from.
    load : GravityModel
        About what hangs on the sensor; only mass and centre of mass count.
    noise : PoseNoise
        Of a pose's mean.
    task : ContactTask, optional
        The touches to come.
    progress : callable, optional
        Told how many of how many exchanges are done; raises to stop.

    Raises
    ------
    InputError
        There are too few or too many poses to plan, or too few to choose from.
    """
    if not 3 <= count <= _LARGEST_PLAN:
        raise InputError(f"a plan has 3 to {arg(_LARGEST_PLAN)} poses, not {arg(count)}")
    if len(reachable) < count:
        raise InputError(
            f"only {arg(len(reachable))} poses can be reached, fewer than the {arg(count)} asked for"
        )
    theta = load.vector
    J = prediction_jacobian(reachable.R_WS.swapaxes(1, 2), theta) / _sigmas(noise)
    A = (task or usual_task()).parameter_sensitivity(theta)

    def done(start: int, exchanges: int) -> None:
        progress(start * _PASSES * count + exchanges, _STARTS * _PASSES * count)

    designs = [_exchange(count, start, J, A, partial(done, start)) for start in range(_STARTS)]
    _, chosen = min(designs, key=lambda design: design[0])
    order, warnings = _ordered(chosen, reachable)
    errors = [worst_sigma(A, parameter_covariance(J[order[: k + 1]])) for k in range(count)]
    joints = None if reachable.joints is None else reachable.joints[order]
    return PosePlan(reachable.R_WS[order], joints, np.array(errors), warnings)


def _plausible(calibration: Calibration) -> NDArray[np.float64]:
    """Return the parameters (12,), with the usual weight along directions in which it is not known yet.

    There the estimate is nothing, and a pose would seem to show nothing of the centre of mass.
    """
    theta = calibration.model.vector
    variances, axes = np.linalg.eigh(calibration.covariance[GRAVITY, GRAVITY])
    missing = length(USUAL_LOAD.gravity_W) * calibration.down_W - theta[GRAVITY]
    if felt(theta, calibration.covariance):
        unknown = axes[:, variances > (_HARDLY_KNOWN * UNKNOWN[GRAVITY][0]) ** 2]
        missing = unknown @ (unknown.T @ missing)
    theta[GRAVITY] += missing
    return theta


# ---- information -------------------------------------------------------------------------------


def _sigmas(noise: PoseNoise) -> NDArray[np.float64]:
    """Return the noise (6, 1) that poses to come are credited with: never less than any sensor has."""
    sigmas: NDArray[np.float64] = np.maximum(noise.sigmas, _QUIETEST)[:, None]
    return sigmas


def _errors_with(
    C: NDArray[np.float64], J: NDArray[np.float64], A: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the contact error (k,) if one more pose, with Jacobian J[k], were added to covariance C.

    The covariance with one more pose is C less ``C J' inv(1 + J C J') J C``; carried to the contact.
    """
    JC = J @ C
    lowered = np.linalg.solve(np.eye(6) + JC @ J.transpose(0, 2, 1), JC)  # (k, 6, 12)
    reach, less = (part[:, None] @ A.transpose(1, 2, 0) for part in (JC, lowered))  # (k, 2, 6, touches)
    left = A @ C @ A.transpose(0, 2, 1) - np.einsum("kaet,kbet->ktab", reach, less)
    return np.asarray(np.sqrt(largest_eigenvalue(left).max(axis=1)), dtype=np.float64)


def _ignorance(C: NDArray[np.float64], J: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how much less of the unknown (k,) one more pose takes away than the best one; at least 1.

    For when no single pose settles the contact: then its error is that of what stays unknown, whichever pose
    is taken. The determinant of the covariance still tells which pose narrows down the rest.
    """
    gain = np.linalg.slogdet(np.eye(6) + J @ C @ J.transpose(0, 2, 1))[1]
    return np.asarray(np.exp(gain.max() - gain), dtype=np.float64)


def _exchange(
    count: int, start: int, J: NDArray[np.float64], A: NDArray[np.float64], progress: Callable[[int], None]
) -> tuple[float, list[int]]:
    """Return error and poses of a set that no single exchange improves."""
    chosen = [start * (len(J) // _STARTS)]
    while len(chosen) < count:
        errors = _errors_with(parameter_covariance(J[chosen]), J, A)
        errors[chosen] = np.inf
        chosen.append(int(np.argmin(errors)))
    best = worst_sigma(A, parameter_covariance(J[chosen]))
    for done in range(_PASSES * count):
        progress(done)
        place = done % count
        if place == 0:
            before = best
        others = chosen[:place] + chosen[place + 1 :]
        errors = _errors_with(parameter_covariance(J[others]), J, A)
        errors[others] = np.inf
        if errors.min() < best * (1 - 1e-6):
            chosen[place], best = int(np.argmin(errors)), float(errors.min())
        if place == count - 1 and best == before:
            break
    return best, chosen


# ---- moves -------------------------------------------------------------------------------------


def _newest_good(errors: NDArray[np.float64], reachable: Reachable, taken: NDArray[np.float64]) -> int:
    """Return the candidate least like the poses before that is nearly as good as the best and can be reached.

    `taken` (n, 3) is where down was in S: all that a weight tells of a pose.
    """
    good = errors <= _NEARLY * errors.min()
    likeness = (np.asarray(reachable.down_W) @ reachable.R_WS @ taken.T).max(axis=1)
    in_turn = np.lexsort((np.where(good, likeness, errors), ~good))  # good ones by likeness, then by error
    for index in in_turn.tolist():
        if reachable.obstacle(None, index) is None:
            return int(index)
    raise InputError(
        "no candidate can be reached from here by a straight joint move: first move the robot to"
        " a clearer position"
    )


def _ordered(chosen: list[int], reachable: Reachable) -> tuple[list[int], tuple[str, ...]]:
    """Return the poses in an order of short moves, and what is in the way of some."""
    first, between = reachable.travel[chosen], reachable.between(chosen)

    def length(order: tuple[int, ...]) -> float:
        return float(first[order[0]] + sum(between[i, j] for i, j in pairwise(order)))

    if len(chosen) <= _ALL_ORDERS:
        order = min(permutations(range(len(chosen))), key=length)
    else:
        order = _nearest_next(first, between)
    poses = [chosen[place] for place in order]
    warnings = (
        message(f"The straight joint move to pose {arg(number)} is not clear ({arg(obstacle)}): go around.")
        for number, (here, there) in enumerate(zip([None, *poses], poses, strict=False), 1)
        if (obstacle := reachable.obstacle(here, there))
    )
    return poses, tuple(warnings)


def _nearest_next(first: NDArray[np.float64], between: NDArray[np.float64]) -> tuple[int, ...]:
    order = [int(np.argmin(first))]
    left = set(range(len(first))) - set(order)
    while left:
        order.append(min(left, key=lambda place: (between[order[-1], place], place)))
        left.remove(order[-1])
    return tuple(order)


def _gain(before: float, after: float) -> str:
    """Say what a pose gains; an error far beyond a probe's size only means that something is still unknown."""
    if after > _UNDETERMINED:
        return message(
            "This pose alone is not enough: the contact stays undetermined until another pose follows."
        )
    now = f"{plain(1e3 * before)} mm" if before < _UNDETERMINED else message("not determined yet")
    return message(
        f"The calibration's share of the contact error: {arg(now)} -> {arg(plain(1e3 * after))} mm (1 sigma,"
        " worst case)."
    )


def _how(reachable: Reachable, index: int) -> str:
    """Say how to take a pose."""
    stands = describe(reachable.R_WS[index], reachable.down_W)
    joints, start = reachable.joint_vector(index), reachable.start
    if joints is None or start is None:
        return stands
    moves = [
        message(f"joint {arg(number)} to {arg(np.degrees(there)):.0f}°")
        for number, (here, there) in enumerate(zip(start, joints, strict=True), 1)
        if abs(there - here) > np.radians(0.5)
    ]
    return message(f"{arg(join(', ', moves) or message('stay where you are'))} ({arg(stands)})")


# ---- what a calibration's uncertainty does to the contact point ----------------------------------


_RINGS = 2  # of tilts beside upright
_ROUND = 6  # tilts on a ring
_SIDES = 4  # directions in which friction may pull


@dataclass(frozen=True, eq=False)
class ContactTask:
    """The touches whose error a calibration is judged by.

    The probe points down or is tilted from that by up to `tilt`; the tissue pushes at `point`, along the
    normal or up to `friction` beside it.

    Parameters
    ----------
    point : (3,)
        Where the probe is touched, S, m. Default: 100 mm along the sensor's z axis.
    normal : (3,)
        Outward normal there, S. Default: z.
    force : float
        Of the touch, N.
    tilt : float
        Largest angle between the normal and straight down, rad.
    friction : float
        Angle between the force and the normal at the sides, rad.
    down_W : (3,)
        Where gravity points in W: the probe points there.

    Raises
    ------
    InputError
        A value is not finite or outside its range.
    """

    point: NDArray[np.float64] = field(default_factory=lambda: np.array([0.0, 0.0, 0.1]))
    normal: NDArray[np.float64] = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    force: float = 10.0
    tilt: float = np.radians(60.0)
    friction: float = np.radians(30.0)
    down_W: NDArray[np.float64] = field(default_factory=lambda: np.array(DOWN_W))

    def __post_init__(self) -> None:
        point, normal = (np.array(value, dtype=np.float64) for value in (self.point, self.normal))
        if point.shape != (3,) or not np.isfinite(point).all():
            raise InputError(f"ContactTask.point: give three finite numbers, m in S, not {arg(self.point)!r}")
        length = float(np.linalg.norm(normal)) if normal.shape == (3,) else np.nan
        if not np.isfinite(length) or length == 0:
            raise InputError(
                f"ContactTask.normal: give three numbers that are not all 0, not {arg(self.normal)!r}"
            )
        ranges = (("force", self.force, 1e4), ("tilt", self.tilt, np.pi), ("friction", self.friction, 1.4))
        for name, value, most in ranges:
            if not 0 <= value <= most or (name == "force" and value == 0):
                raise InputError(
                    f"ContactTask.{arg(name)}: {arg(value)} is not between 0 and {arg(most):.4g}"
                )
        object.__setattr__(self, "point", point)
        object.__setattr__(self, "normal", normal / length)

    @cached_property
    def orientations(self) -> NDArray[np.float64]:
        """(k, 3, 3) R_SW in which the probe is used: pointing down, and tilted in all directions."""
        orientations: NDArray[np.float64] = _cone(self.normal, self.tilt) @ upright(self.down_W)
        return orientations

    @cached_property
    def forces(self) -> NDArray[np.float64]:
        """(m, 3) forces on the probe, S, N: along the normal, and at the friction angle to all sides."""
        angles = np.concatenate([[0.0], np.full(_SIDES, self.friction)])
        return self.force * force_directions(self.normal, angles, np.arange(-1, _SIDES) * 2 * np.pi / _SIDES)

    @cached_property
    def _sensitivities(self) -> NDArray[np.float64]:
        """(m, 2, 6) shift of the contact point in the surface with the wrench, m/N and m/(N·m), by force."""
        in_surface: NDArray[np.float64] = np.array(_across(self.normal))
        return in_surface @ contact_sensitivity(self.point, self.normal, self.forces)

    def parameter_sensitivity(self, theta: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return how the contact point moves in the surface with the calibration's parameters (k m, 2, 12)."""
        J = prediction_jacobian(self.orientations, theta)  # the sign of a change does not matter here
        return (self._sensitivities.reshape(-1, 6) @ J).reshape(-1, 2, 12)

    def calibration_error(self, theta: NDArray[np.float64], covariance: NDArray[np.float64]) -> float:
        """Return the calibration's share of the contact error: the worst 1 sigma over all touches, m.

        Parameters
        ----------
        theta : (12,)
        covariance : (12, 12)
            Of the parameters.
        """
        return worst_sigma(self.parameter_sensitivity(theta), covariance)

    def wrench_error(self, wrenches: NDArray[np.float64]) -> float:
        """Return how far wrenches (n, 6), N and N·m, that are not taken off move a contact: rms, worst touch, m."""
        moved = np.einsum("mai,ni->mna", self._sensitivities, wrenches)
        return float(np.sqrt((moved**2).sum(axis=2).mean(axis=1).max()))

    def response_error(self, C: NDArray[np.float64]) -> float:
        """Return how far a sensor that adds C (6, 6) times a wrench, N and N·m, moves a contact: the worst, m."""
        wrenches = np.hstack([self.forces, np.cross(self.point, self.forces)]) @ C.T
        return float(np.linalg.norm((self._sensitivities @ wrenches[..., None])[..., 0], axis=1).max())

    def sensor_error(self, sigmas: NDArray[np.float64]) -> float:
        """Return what noise of sigmas (6,), N and N·m, in the live wrench adds: the worst 1 sigma, m."""
        return worst_sigma(self._sensitivities, np.diag(sigmas**2))


@cache
def usual_task() -> ContactTask:
    """Return the task that is assumed when nobody says another; made once, because it takes a while."""
    return ContactTask()


def contact_sensitivity(
    point: NDArray[np.float64], normal: NDArray[np.float64], forces: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return how the contact point moves with the wrench.

    Differentiating ``p x F + k n = M`` and ``n . dp = 0`` at a point p of a surface with normal n (Cao et al.
    2023, Eq. 3-4) gives, with ``m = dM - p x dF``, ``dk = F.m / F.n`` and
    ``dp = F x (m - dk n) / |F|²`` plus the multiple of F that stays in the surface.

    Parameters
    ----------
    point, normal : (3,)
        S, m; of length 1.
    forces : (m, 3)
        On the probe, S, N; not along the surface.

    Returns
    -------
    (m, 3, 6)
        Columns Fx Fy Fz Mx My Mz.
    """
    moment = np.concatenate([-cross_matrix(point), np.eye(3)], axis=1)  # m = moment @ (dF, dM)
    into = forces @ normal
    without_k = np.eye(3) - normal[:, None] * (forces / into[:, None])[:, None, :]
    across = cross_matrix(forces) @ without_k / (forces**2).sum(axis=1)[:, None, None]
    in_surface = np.eye(3) - forces[:, :, None] * normal / into[:, None, None]
    sensitivity: NDArray[np.float64] = in_surface @ across @ moment
    return sensitivity


def force_directions(
    normal: NDArray[np.float64], angles: NDArray[np.float64], around: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return unit forces (m, 3) that push on a surface: at `angles` from -normal, turned `around` it, rad."""
    first, second = _across(normal)
    side = np.cos(around)[:, None] * first + np.sin(around)[:, None] * second
    directions: NDArray[np.float64] = np.sin(angles)[:, None] * side - np.cos(angles)[:, None] * normal
    return directions


def worst_sigma(A: NDArray[np.float64], covariance: NDArray[np.float64]) -> float:
    """Return the largest 1 sigma in any direction of any ``A[k] covariance A[k]'``, for A (k, 2, m)."""
    AC = (A.reshape(-1, A.shape[-1]) @ covariance).reshape(A.shape)  # one product instead of k
    return float(np.sqrt(largest_eigenvalue(AC @ A.swapaxes(1, 2)).max()))


def largest_eigenvalue(C: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the largest eigenvalue (...) of covariances (..., 2, 2), at least 0."""
    a, b, c = C[..., 0, 0], C[..., 0, 1], C[..., 1, 1]
    largest: NDArray[np.float64] = 0.5 * (a + c) + np.hypot(0.5 * (a - c), b)
    return np.maximum(largest, 0.0)


def _cone(normal_S: NDArray[np.float64], tilt: float) -> NDArray[np.float64]:
    """Return R_SW (k, 3, 3) in which `normal_S` points down, and is tilted from that by up to `tilt`."""
    first, second = _across(normal_S)
    # Columns: where x, y, z of an upright tool frame lie in S; its z axis points to the sky.
    R_ST = np.column_stack([first, -second, -normal_S])
    tilts = [(0.0, 0.0)] + [
        (tilt * ring / _RINGS, 2 * np.pi * step / _ROUND)
        for ring in range(1, _RINGS + 1)
        for step in range(_ROUND)
    ]
    turn = Rotation.from_rotvec
    # Yaw matters only for the little that gravity is off the vertical: it alternates from tilt to tilt.
    rotations = [
        R_ST
        @ (turn([a * np.cos(b), a * np.sin(b), 0.0]) * turn([0.0, 0.0, np.pi / 2 * (number % 2)])).as_matrix()
        for number, (a, b) in enumerate(tilts)
    ]
    return np.array(rotations)


def _across(normal: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return two unit vectors that with `normal` form a right-handed frame."""
    helper = np.eye(3)[np.argmin(np.abs(normal))]
    first = np.cross(helper, normal)
    first /= np.linalg.norm(first)
    return first, np.cross(normal, first)


# ---- orientations to choose calibration poses from: anything by hand, or what a robot reaches ----


_PLASTIC = 1.324717957244746  # the real root of x³ = x + 1


@dataclass(frozen=True, eq=False)
class Reachable:
    """Orientations that can be taken."""

    R_WS: NDArray[np.float64]  # (k, 3, 3)
    # (k,) what it takes to get there from where the robot is: s for a robot, rad turned by hand
    travel: NDArray[np.float64]
    joints: NDArray[np.float64] | None = None  # (k, 6) the robot's joints that give them, rad
    robot: Robot | None = None
    start: NDArray[np.float64] | None = None  # (6,) where the robot is, rad
    check: ClearanceCheck | None = None  # Says what a move would hit
    down_W: ArrayLike = DOWN_W  # (3,) where gravity points in W

    def __len__(self) -> int:
        return len(self.R_WS)

    def between(self, chosen: Sequence[int]) -> NDArray[np.float64]:
        """Return the travel (n, n) from each of the `chosen` candidates to each other: s or rad."""
        if self.robot is not None and self.joints is not None:
            joints = self.joints[chosen]
            return self.robot.travel(joints[:, None], joints[None])
        R = self.R_WS[chosen]
        traces = np.einsum("iab,jab->ij", R, R)
        angles: NDArray[np.float64] = np.arccos(np.clip((traces - 1) / 2, -1, 1))
        return angles

    def obstacle(self, first: int | None, last: int) -> str | None:
        """Say what is in the way of a straight joint move to candidate `last`, from the start if first is None."""
        if self.check is None or self.joints is None or self.start is None:
            return None
        return self.check.path_conflict(
            self.start if first is None else self.joints[first], self.joints[last]
        )

    def joint_vector(self, index: int) -> NDArray[np.float64] | None:
        """Return the joints (6,) of a candidate, rad, if a robot takes it."""
        return None if self.joints is None else self.joints[index]


def by_hand(
    count: int = 300,
    *,
    max_tilt: float = np.pi,
    R_WS_now: NDArray[np.float64] | None = None,
    down_W: ArrayLike = DOWN_W,
) -> Reachable:
    """Return orientations spread evenly over all that a free sensor can take.

    Parameters
    ----------
    count : int
        How many, at least 12.
    max_tilt : float
        Largest angle between the sensor's z axis and straight down, rad.
    R_WS_now : (3, 3), optional
        Where the sensor is; without it no orientation is nearer than another.
    down_W : (3,)
        Where gravity points in W.

    Raises
    ------
    InputError
        A value is out of its range.
    """
    if count < 12:
        raise InputError(f"{arg(count)} orientations are too few to choose from: give at least 12")
    if not 0 < max_tilt <= np.pi:
        raise InputError(
            f"the largest tilt must be above 0° and at most 180°, not {arg(np.degrees(max_tilt)):.4g}°"
        )
    # Even in area: equal steps of the cosine. Powers of the plastic number keep bearings and yaws apart.
    step = np.arange(count)
    cosine = 1 - (step + 0.5) / count * (1 - np.cos(max_tilt))
    tilt, bearing, yaw = np.arccos(cosine), 2 * np.pi * step / _PLASTIC, 2 * np.pi * step / _PLASTIC**2
    axis = np.column_stack([np.cos(bearing), np.sin(bearing), np.zeros(count)])
    down = Rotation.from_rotvec([np.pi, 0.0, 0.0])
    spin = Rotation.from_rotvec(np.column_stack([np.zeros((count, 2)), yaw]))
    turned = (
        Rotation.from_matrix(upright(down_W).T) * Rotation.from_rotvec(tilt[:, None] * axis) * down * spin
    )
    travel = np.zeros(count)
    if R_WS_now is not None:
        travel = np.asarray((Rotation.from_matrix(R_WS_now).inv() * turned).magnitude())
    return Reachable(turned.as_matrix(), travel, down_W=down_W)


def by_robot(
    robot: Robot,
    q_now: NDArray[np.float64],
    *,
    R_ES: NDArray[np.float64] | None = None,
    R_WB: NDArray[np.float64] | None = None,
    count: int = 300,
    wrist_only: bool = True,
    clearance: Clearance | None = None,
    seed: int = 0,
    down_W: ArrayLike = DOWN_W,
) -> Reachable:
    """Return orientations that a robot reaches within its joint limits, clear of itself and the floor.

    Parameters
    ----------
    robot : Robot
    q_now : (6,)
        Its joints now, rad.
    R_ES : (3, 3), optional
        Orientation of the sensor on the flange; left out: the same.
    R_WB : (3, 3), optional
        Orientation of the base in the world; left out: upright.
    count : int
        How many to look for; fewer may be found.
    wrist_only : bool
        Only the wrist joints move: short moves that keep the tool where it is.
    clearance : Clearance, optional
        Tool and floor to keep clear of.
    seed : int
        Of the choice.
    down_W : (3,)
        Where gravity points in W.

    Raises
    ------
    InputError
        The joints are out of their limits, or nothing is reachable.
    """
    joints = robot.candidate_joints(q_now, count=count, seed=seed, wrist_only=wrist_only, clearance=clearance)
    R_WS = robot.flange_rotations(joints)
    if R_ES is not None:
        R_WS = R_WS @ R_ES
    if R_WB is not None:
        R_WS = R_WB @ R_WS
    check = ClearanceCheck(robot.description, clearance or Clearance())
    start = np.array(q_now, dtype=np.float64)
    return Reachable(R_WS, robot.travel(start, joints), joints, robot, start, check, down_W)


def describe(R_WS: NDArray[np.float64], down_W: ArrayLike = DOWN_W) -> str:
    """Return in words how the sensor stands: where its z axis points, and which side is down.

    Parameters
    ----------
    R_WS : (3, 3)
    down_W : (3,)
        Where gravity points in W.
    """
    R_WS = upright(down_W) @ R_WS
    z_W = R_WS[:, 2]
    tilt = float(np.degrees(np.arccos(np.clip(-z_W[2], -1, 1))))
    down_S = -R_WS[2]
    side = int(np.argmax(np.abs(down_S)))
    name = f"{'-' if down_S[side] < 0 else '+'}{'xyz'[side]}"
    lean = float(np.degrees(np.arccos(np.clip(np.abs(down_S[side]), -1, 1))))
    lowest = message(f"the {arg(name)} axis lowest ({arg(lean):.0f}° from straight down)")
    if tilt < 1:
        return message("sensor z straight down")
    if tilt > 179:
        return message("sensor z straight up")
    bearing = np.degrees(np.arctan2(z_W[1], z_W[0])) % 360
    return message(
        f"sensor z {arg(tilt):.0f}° from straight down, bearing {arg(bearing):.0f}° from the world's x axis;"
        f" {arg(lowest)}"
    )

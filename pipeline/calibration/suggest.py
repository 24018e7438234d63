"""Which pose to take next, and which poses to take at all: those that help the contact point most."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import pairwise, permutations
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.contact_error import (
    ContactTask,
    largest_eigenvalue,
    usual_task,
    worst_sigma,
)
from contactbench.pipeline.calibration.fit import UNKNOWN, PoseNoise, felt, parameter_covariance
from contactbench.pipeline.calibration.model import GRAVITY, GravityModel, length, prediction_jacobian
from contactbench.pipeline.calibration.number_text import plain
from contactbench.pipeline.calibration.reachable import describe
from contactbench.pipeline.errors import InputError, arg, join, message

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.calibrate import Calibration
    from contactbench.pipeline.calibration.reachable import Reachable

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
    progress: Callable[[int, int], None] | None = None,
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
        if progress:
            progress(start * _PASSES * count + exchanges, _STARTS * _PASSES * count)

    designs = [_exchange(count, start, J, A, partial(done, start)) for start in range(_STARTS)]
    _, chosen = min(designs, key=lambda design: design[0])
    order, warnings = _ordered(chosen, reachable)
    errors = [worst_sigma(A, parameter_covariance(J[order[: k + 1]])) for k in range(count)]
    joints = None if reachable.joints is None else reachable.joints[order]
    return PosePlan(reachable.R_WS[order], joints, np.array(errors), warnings)


def plan_error(
    R_WS: NDArray[np.float64],
    *,
    load: GravityModel = USUAL_LOAD,
    noise: PoseNoise = USUAL_NOISE,
    task: ContactTask | None = None,
) -> float:
    """Return the predicted share of the calibration in the contact error after poses R_WS (n, 3, 3), m."""
    J = prediction_jacobian(R_WS.swapaxes(1, 2), load.vector) / _sigmas(noise)
    return worst_sigma((task or usual_task()).parameter_sensitivity(load.vector), parameter_covariance(J))


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
    reach = A @ JC.transpose(0, 2, 1)[:, None]  # (k, touches, 2, 6)
    left = A @ C @ A.transpose(0, 2, 1) - reach @ (A @ lowered.transpose(0, 2, 1)[:, None]).swapaxes(2, 3)
    return np.asarray(np.sqrt(largest_eigenvalue(left).max(axis=1)), dtype=np.float64)


def _ignorance(C: NDArray[np.float64], J: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how much less of the unknown (k,) one more pose takes away than the best one; at least 1.

    For when no single pose settles the contact: then its error is that of what stays unknown, whichever pose
    is taken. The determinant of the covariance still tells which pose narrows down the rest.
    """
    gain = np.linalg.slogdet(np.eye(6) + J @ C @ J.transpose(0, 2, 1))[1]
    return np.asarray(np.exp(gain.max() - gain), dtype=np.float64)


def _exchange(
    count: int,
    start: int,
    J: NDArray[np.float64],
    A: NDArray[np.float64],
    progress: Callable[[int], None],
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
    warnings = []
    for number, (here, there) in enumerate(pairwise([None, *poses]), 1):
        obstacle = reachable.obstacle(here, there)  # type: ignore[arg-type]  # only the first is None
        if obstacle:
            warnings.append(
                message(
                    f"The straight joint move to pose {arg(number)} is not clear ({arg(obstacle)}): go around."
                )
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

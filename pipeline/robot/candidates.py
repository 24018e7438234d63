"""Well-spread, clear configurations near the present one."""

from collections import Counter
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.robot.clearance import ClearanceCheck
from contactbench.pipeline.robot.description import RobotDescription

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

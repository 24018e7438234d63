"""
How much later the sensor is heard than the robot, from the motion of both.

While a load is turned, its weight turns in the sensor frame. Whatever the mount, the weight and the bias, the force is
linear in the entries of the flange's orientation, ``F_S = C vec(R_EB) + F0``. The delay is the shift of the poses in
time at which that holds best.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.spatial.transform import Rotation

from pipeline.recording.convert import poses_at
from pipeline.recording.errors import RecordingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pipeline.recording.tracks import FlangeTrack, WrenchTrack

_SAMPLES = 3_000
_STEP_S = 0.01
_FEWEST = 100
# A turn that leaves less than this of the force unexplained at the best shift, compared with the worst, shows nothing.
_SHOWN = 0.8
_LEAST_TURN = np.radians(10.0)


@dataclass(frozen=True)
class Delay:
    """
    The sensor's clock against the robot's.

    Attributes
    ----------
    seconds : float or None
        By how much later the wrench of a moment is heard than its pose: use the pose at ``t - seconds`` for the wrench
        at t. None where the motion does not show it.
    sigma : float or None
        Its standard deviation from the noise of the forces, s; poses far apart in time add up to half as much.
    sentence : str
        The same in words.
    """

    seconds: float | None
    sigma: float | None
    sentence: str


def estimate_delay(wrenches: WrenchTrack, poses: FlangeTrack, *, longest: float = 0.3) -> Delay:
    """
    Estimate the delay between two streams from a stretch in which the flange was turned, touching nothing.

    Parameters
    ----------
    wrenches : WrenchTrack
    poses : FlangeTrack
        On the same host clock.
    longest : float
        Shifts up to this, either way, are looked at, s.

    Returns
    -------
    Delay

    Raises
    ------
    RecordingError
        Too few wrenches have poses beside them.
    """
    rows = np.flatnonzero(wrenches.usable)
    rows = rows[:: max(1, len(rows) // _SAMPLES)]
    times, forces = wrenches.times[rows], wrenches.wrenches[rows, :3]
    # Rows whose pose is known at every shift, so that every shift is judged by the same ones.
    known = np.ones(len(times), dtype=bool)
    for shift in (-longest, 0.0, longest):
        known &= poses_at(poses, times - shift)[1]
    times, forces = times[known], forces[known]
    if len(times) < _FEWEST:
        raise RecordingError(
            f"only {len(times)} wrenches have poses before and after them: record both for longer, with the robot"
            " turning."
        )
    if _turn(poses, times) < _LEAST_TURN:
        return Delay(
            None,
            None,
            "The flange hardly turned, which shows no delay: turn it by 30° and back while recording.",
        )
    shifts = np.arange(-longest, longest + _STEP_S / 2, _STEP_S)
    left = np.array([_unexplained(poses, times, forces, shift) for shift in shifts])
    best = int(np.argmin(left))
    if left[best] > _SHOWN * left.max() or best in (0, len(shifts) - 1):
        return Delay(
            None,
            None,
            f"No shift within {longest:g} s explains the forces: is this the robot that holds the sensor?",
        )
    return _refined(poses, times, forces, float(shifts[best]))


def _refined(
    poses: FlangeTrack, times: NDArray[np.float64], forces: NDArray[np.float64], near: float
) -> Delay:
    def unexplained(shift: float) -> float:
        return _unexplained(poses, times, forces, shift)

    found = minimize_scalar(unexplained, bounds=(near - _STEP_S, near + _STEP_S), method="bounded")
    seconds = float(found.x)
    h = _STEP_S / 2
    curvature = (unexplained(seconds - h) - 2 * found.fun + unexplained(seconds + h)) / h**2
    # Twice the noise's variance over the curvature of the sum of squares: the Cramér-Rao bound of one parameter.
    variance = found.fun / max(3 * len(times) - 31, 1)
    sigma = float(np.sqrt(2 * variance / curvature)) if curvature > 0 else None
    spread = "" if sigma is None else f" ± {1e3 * sigma:.1f}"
    later = "later" if seconds >= 0 else "earlier"
    return Delay(
        seconds, sigma, f"The sensor is heard {1e3 * abs(seconds):.1f}{spread} ms {later} than the robot."
    )


def _unexplained(
    poses: FlangeTrack, times: NDArray[np.float64], forces: NDArray[np.float64], shift: float
) -> float:
    """Sum of squares that no linear function of the orientations explains, N²."""
    quaternions = poses_at(poses, times - shift)[0][:, [1, 2, 3, 0]]
    R = Rotation.from_quat(quaternions).as_matrix().reshape(-1, 9)
    terms = np.column_stack((R, np.ones(len(R))))
    solution, *_ = np.linalg.lstsq(terms, forces)
    return float(((forces - terms @ solution) ** 2).sum())


def _turn(poses: FlangeTrack, times: NDArray[np.float64]) -> float:
    """Largest angle between the first and any other orientation, rad."""
    quaternions = poses_at(poses, times)[0][:, [1, 2, 3, 0]]
    turned = Rotation.from_quat(quaternions)
    return float((turned[0].inv() * turned).magnitude().max())

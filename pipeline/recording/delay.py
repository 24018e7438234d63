"""
How much later the sensor is heard than the robot, from the motion of both.

While a load is turned, its weight turns in the sensor frame. Whatever the mount, the weight and the bias, the force is
linear in the entries of the flange's orientation, ``F_S = C vec(R_EB) + F0``. The delay is the shift of the poses in
time at which that holds best.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.pose_source import LONGEST_GAP_S
from contactbench.pipeline.errors import RecordingError, arg, join, message
from contactbench.pipeline.recording.convert import poses_at
from contactbench.pipeline.recording.reader import FlangeTrack, WrenchTrack

_SAMPLES = 3_000
_STEP_S = 0.01
_FEWEST = 100
# A turn that leaves less than this of the force unexplained at the best shift, compared with the worst, shows nothing.
_SHOWN = 0.8
_LEAST_TURN = np.radians(10.0)
# What is left beside the noise is doubted when it is this many times the noise, and this share of what the load does:
# a sensor that smooths its readings shows less noise than they have.
_FAR_ABOVE = 5.0
_SHARE = 0.05
# Sensors filter for up to 50 ms, and controllers publish poses as late: beyond this something else is wrong. s
_LONGEST_LIKELY = 0.15
_SURE = 3.0  # sigmas: a smaller delay may as well be none


@dataclass(frozen=True)
class Delay:
    """The sensor's clock against the robot's."""

    # By how much later the wrench of a moment is heard than its pose: use the pose at ``t - seconds`` for the
    # wrench at t. None where the motion does not show it.
    seconds: float | None
    # Its standard deviation from the noise of the forces, s; poses far apart in time add up to half as much.
    sigma: float | None
    sentence: str  # the same in words, doubts included
    doubt: str = ""  # why the delay should not be used unseen: sentences; empty where nothing speaks for it

    @property
    def usable(self) -> tuple[float, str]:
        """
        The delay to use where nobody looks at it, s, and what to say about it.

        It is 0 where the delay is unlikely - the sensor comes first, or later than any sensor does - and where it is
        below three of its own sigma. A knock that disturbs the forces is told, but moves the delay by little.
        """
        seconds = self.seconds or 0.0
        if _unlikely(self):
            return 0.0, message(
                f"{arg(self.sentence)} The delay is not applied. To apply it anyway, give it: --delay"
                f" {arg(seconds):.4f}."
            )
        if self.sigma is None or abs(seconds) < _SURE * self.sigma:
            return 0.0, message(
                f"{arg(self.sentence)} Within 3 sigma this may be zero, so no delay is applied."
            )
        return seconds, self.sentence


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
    # Every shift is judged by the same rows. The refinement looks up to one and a half steps further.
    known = _known_around(poses, times, longest + 2 * _STEP_S)
    times, forces = times[known], forces[known]
    if len(times) < _FEWEST:
        raise RecordingError(
            f"only {arg(len(times))} wrenches have poses before and after them: record both for longer"
            " while the robot turns."
        )
    if _turn(poses, times) < _LEAST_TURN:
        still = message(
            "The flange hardly turned, so no delay can be seen: turn it by 30° and back while recording."
        )
        return Delay(None, None, still)
    shifts = np.arange(-longest, longest + _STEP_S / 2, _STEP_S)
    left = np.array([_unexplained(poses, times, forces, shift) for shift in shifts])
    best = int(np.argmin(left))
    if left[best] > _SHOWN * left.max() or best in (0, len(shifts) - 1):
        strange = message(
            f"No shift within {arg(longest):g} s explains the forces: check that this robot holds the sensor."
        )
        return Delay(None, None, strange)
    estimate = _refined(poses, times, forces, float(shifts[best]))
    left_over = _left_over(wrenches, forces, poses, times, estimate)
    doubt = join(" ", filter(None, (_unlikely(estimate), left_over)))
    return replace(estimate, sentence=message(f"{arg(estimate.sentence)} {arg(doubt)}").strip(), doubt=doubt)


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
    heard = message(
        f"The sensor is heard {arg(1e3 * abs(seconds)):.1f}{arg(spread)} ms {arg(later)} than the robot."
    )
    return Delay(seconds, sigma, heard)


def _known_around(poses: FlangeTrack, times: NDArray[np.float64], reach: float) -> NDArray[np.bool_]:
    """(n,) the pose is known at every moment within `reach` of the times: no gap lies there."""
    moments = np.unique(poses.times)
    if len(moments) < 2:
        return np.zeros(len(times), dtype=bool)
    gaps = np.concatenate(([0], np.cumsum(np.diff(moments) > LONGEST_GAP_S)))
    inside: NDArray[np.bool_] = (times - reach >= moments[0]) & (times + reach <= moments[-1])
    first = np.clip(np.searchsorted(moments, times - reach, "right") - 1, 0, None)
    last = np.clip(np.searchsorted(moments, times + reach, "left"), None, len(moments) - 1)
    known: NDArray[np.bool_] = inside & (gaps[last] == gaps[first])
    return known


def _unlikely(estimate: Delay) -> str:
    seconds = estimate.seconds or 0.0
    if estimate.sigma is None or abs(seconds) < _SURE * estimate.sigma:
        return ""
    if abs(seconds) > _LONGEST_LIKELY:
        return message(
            f"A delay above {arg(1e3 * _LONGEST_LIKELY):.0f} ms is unlikely: check that both use one"
            " clock, and that this robot holds the sensor."
        )
    if seconds < 0:
        return message(
            "A sensor ahead of the robot is unlikely: check whether the robot publishes its poses late."
        )
    return ""


def _left_over(
    wrenches: WrenchTrack,
    forces: NDArray[np.float64],
    poses: FlangeTrack,
    times: NDArray[np.float64],
    estimate: Delay,
) -> str:
    noise, swing = _noise(wrenches), float(forces.std(axis=0).max())
    left = np.sqrt(_unexplained(poses, times, forces, estimate.seconds or 0.0) / forces.size)
    if left <= max(_FAR_ABOVE * noise, _SHARE * swing):
        return ""
    return message(
        f"The turned load leaves {arg(left):.2g} N of the forces unexplained, but the sensor's noise is"
        f" only {arg(noise):.2g} N: something was touched, or the flange moved fast. The delay may be"
        " off by more than its ±. Record again: turn slowly, touch nothing."
    )


def _noise(wrenches: WrenchTrack) -> float:
    """Return the standard deviation of one force, N, by second differences: slow motion hardly shows in them."""
    bent = np.abs(np.diff(wrenches.wrenches[wrenches.usable, :3], n=2, axis=0))
    # Of normal noise, the median of what is without sign is 0.674 sigma; second differences add it up to sqrt(6).
    return float(np.median(bent, axis=0).max() / (0.6745 * np.sqrt(6)))


def _unexplained(
    poses: FlangeTrack, times: NDArray[np.float64], forces: NDArray[np.float64], shift: float
) -> float:
    """Sum of squares that no linear function of the orientations explains, N²."""
    quaternions = poses_at(poses, times - shift)[0][:, [1, 2, 3, 0]]
    R = Rotation.from_quat(quaternions).as_matrix().reshape(-1, 9)
    # About the means: a large bias leaves the normal equations no digits where the flange turns about one axis alone.
    terms, sought = R - R.mean(axis=0), forces - forces.mean(axis=0)
    # They are exact enough: an error of the solution counts squared in what is left.
    solution, *_ = np.linalg.lstsq(terms.T @ terms, terms.T @ sought, rcond=1e-12)
    return float(((sought - terms @ solution) ** 2).sum())


def _turn(poses: FlangeTrack, times: NDArray[np.float64]) -> float:
    """Largest angle between the first and any other orientation, rad."""
    quaternions = poses_at(poses, times)[0][:, [1, 2, 3, 0]]
    turned = Rotation.from_quat(quaternions)
    return float((turned[0].inv() * turned).magnitude().max())

"""What is found of the mount, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.special import chdtri

from contactbench.pipeline.calibration.calibrate import Calibration
from contactbench.pipeline.calibration.verdict import Level, Limits, Verdict, judge

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.mounting.sight import Sight
from contactbench.pipeline.calibration.mounting.turns import largest_sigma, turn

# Fifteen unknowns bend to a wrong convention once some poses may be left out: so many must stay.
_MOST_OUT, _FEWEST_IN = 0.25, 6


# Poses turn about one axis if they turn about others by this share of it.
_ONE_AXIS = 0.1


# Simple mountings are at multiples of so many degrees; within _NEAR, or 2 sigma, of one it is named.
_SIMPLE, _NEAR, _TWO_SIGMA = 45.0, np.radians(2.0), float(chdtri(3, 0.0455))


def blind_words(R_EW: NDArray[np.float64], axes_E: NDArray[np.float64]) -> str:
    """Say why turns of the mount about the flange's axes (3, k) cannot be seen, and what would show them."""
    turns = Rotation.from_matrix(R_EW @ R_EW[0].T).as_rotvec()
    spread = np.degrees(
        Rotation.from_matrix(np.einsum("iab,jcb->ijac", R_EW, R_EW).reshape(-1, 3, 3)).magnitude().max()
    )
    about = np.linalg.svd(turns, compute_uv=False)
    remedy = "Tilt the wrist up to 90° about two axes"
    if axes_E.shape[1] == 3:
        return (
            "Gravity has nearly the same direction in the flange in every pose, so the forces say nothing of how"
            f" the sensor is mounted. {remedy}."
        )
    if about[1] < _ONE_AXIS * about[0]:
        why = "all poses turn about one axis"
        remedy = "Tilt the wrist about another axis too"
    else:
        why = f"the poses, within {spread:.0f}° of one another, are too much alike"
        remedy += ", and turn it about the vertical as well"
    return f"The mount's rotation about {named_axes(axes_E)} cannot be told from a tilt of the base: {why}. {remedy}."


def named_axes(axes_E: NDArray[np.float64]) -> str:
    """Return words for axes (3, k) of the flange."""
    vectors = [axis if axis[np.argmax(np.abs(axis))] > 0 else -axis for axis in axes_E.T]
    return f"the flange's ax{'is' if len(vectors) == 1 else 'es'} " + " and ".join(
        "({})".format(", ".join(f"{value + 0.0:.2f}" for value in np.round(axis, 2))) for axis in vectors
    )


def simple(R_SE: NDArray[np.float64], covariance: NDArray[np.float64]) -> str:
    """Name the multiple of 45 degrees about the flange's z axis that the mounting may be."""
    angles = np.arange(-135.0, 181.0, _SIMPLE)
    R_EN = turn(np.outer(np.radians(angles), [0.0, 0.0, 1.0]))
    off = Rotation.from_matrix((R_SE @ R_EN).swapaxes(1, 2)).as_rotvec()  # a turn of S that makes it so
    nearest = int(np.argmin(np.linalg.norm(off, axis=1)))
    e, angle = off[nearest], float(np.linalg.norm(off[nearest]))
    if angle > _NEAR and e @ np.linalg.solve(covariance, e) > _TWO_SIGMA:
        return ""
    how = (
        f"turned by {angles[nearest]:.0f}° about the flange's z axis"
        if angles[nearest]
        else "in line with the flange"
    )
    sigma = np.degrees(largest_sigma(covariance))
    return f"Within {np.degrees(angle):.1f}° (1 sigma {sigma:.1f}°) of a sensor mounted {how}."


def verdict(calibration: Calibration, sight: Sight, agree: bool, limits: Limits) -> Verdict:
    """Combine what the parameters and the mount deserve."""
    core = judge(calibration, agree, limits)
    grave = list(sight.grave)
    kept, n = int(calibration.kept.sum()), len(calibration.poses)
    if kept < n and (kept < _FEWEST_IN or n - kept > _MOST_OUT * n):
        grave.append(
            f"Only {kept} of {n} poses agree, which fifteen unknowns can do by chance. Either most captures were"
            " disturbed (take them again), or the orientations are in another convention than was said."
        )
    if core.level is Level.REFUSE:
        grave += core.reasons
    if calibration.gravity_W @ calibration.down_W < 0 and core.level is Level.REFUSE:
        grave.append(
            "With an unknown mount, a sensor frame with one axis of the wrong sign (a left-handed frame) looks"
            " like gravity that points up, too."
        )
    if grave:
        return Verdict(Level.REFUSE, tuple(grave))
    if sight.slight:
        return Verdict(Level.USABLE, sight.slight + (core.reasons if core.level is Level.USABLE else ()))
    return core

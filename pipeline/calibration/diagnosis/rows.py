"""Mistakes in the order of poses, and biases that change on the way."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.diagnosis.hypothesis import Hypothesis

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.poses import Stack

SHIFTED = "rows_shifted_by_"
# A re-zero needs so many poses on either side: a single one cannot be told from a bumped pose.
FEWEST_BESIDE = 2
_FEWEST_DRIFTING = 6
_SETTLING = 4.0  # time constants in a session
_SWAPS = 3  # pairs that are worth a fit


def orders(R_WS: NDArray[np.float64], poses: Stack) -> Iterator[Hypothesis]:
    """Yield poses whose orientations belong to the next or previous row, or to each other's."""
    for step, whose in ((1, "next"), (-1, "previous")):
        yield Hypothesis(
            f"{SHIFTED}{step}",
            f"orientations shifted by one row to the {whose}",
            f"Orientations and readings are shifted by one row: each reading belongs to the {whose} row's orientation",
            "them shifted back",
            "Shift the orientations by one row, and leave out the row at the end that has none.",
            np.roll(R_WS, -step, axis=0),
        )
    pairs, count = _likely_swaps(poses)
    for first, second in pairs:
        again = R_WS.copy()
        again[[first, second]] = R_WS[[second, first]]
        yield Hypothesis(
            f"rows_{first + 1}_and_{second + 1}_swapped",
            f"orientations of poses {first + 1} and {second + 1} swapped",
            f"The orientations of poses {first + 1} and {second + 1} are swapped",
            "them swapped back",
            "Swap the two orientations, or take the two poses again.",
            again,
            variants=count,
        )


def _likely_swaps(poses: Stack) -> tuple[NDArray[np.intp], int]:
    """Return the pairs of poses (m, 2) whose swap explains the forces best, and how many pairs there are.

    What orientations add to the normal equations of gravity and force bias does not depend on their order; a
    swap changes but the right-hand side, by (R_j - R_i)^T (F_i - F_j).
    """
    R, F, n = poses.R_SW, poses.F, len(poses)
    i, j = np.triu_indices(n, 1)
    mean = R.mean(axis=0)
    normal = n * (np.eye(3) - mean.T @ mean) + 1e-9 * np.eye(3)
    right = np.einsum("nab,na->b", R - mean, F) + np.einsum("pab,pa->pb", R[j] - R[i], F[i] - F[j])
    explained = np.einsum("pa,pa->p", right, np.linalg.solve(normal, right.T).T)
    best = np.argsort(-explained)[:_SWAPS]
    return np.stack([i[best], j[best]], axis=1), len(i)


def changes(R_WS: NDArray[np.float64], times: NDArray[np.float64] | None) -> Iterator[Hypothesis]:
    """Yield biases that jump between two poses, drift or settle.

    Parameters
    ----------
    R_WS : (n, 3, 3)
    times : (n,) or None
        Of the poses, s; left out: they follow each other evenly.
    """
    n = len(R_WS)
    moments = range(FEWEST_BESIDE, n - FEWEST_BESIDE + 1)
    for change in moments:
        yield Hypothesis(
            f"rezero_before_{change + 1}",
            f"re-zero before pose {change + 1}",
            f"The sensor was re-zeroed between poses {change} and {change + 1}",
            "another bias from there on",
            "Calibrate with the poses before or after it alone, and keep the sensor from re-zeroing itself.",
            R_WS,
            change=change,
            course=(np.arange(n) >= change).astype(np.float64),
            variants=len(moments),
        )
    when = np.arange(n, dtype=np.float64) if times is None else times
    span = float(np.ptp(when))
    if n >= _FEWEST_DRIFTING and span > 0:
        remedy = "Let the sensor warm up, then take the poses again without a long pause."
        to_go = (when.max() - when) / span
        words = "drifting zero", "The sensor's zero drifts", "a bias that changes evenly", remedy
        yield Hypothesis("drift", *words, R_WS, course=-to_go)
        words = (
            "settling zero",
            "The sensor's zero settles, as while it warms up",
            "a bias that settles",
            remedy,
        )
        yield Hypothesis(
            "settling", *words, R_WS, course=np.expm1(-_SETTLING) - np.expm1(-_SETTLING * (1 - to_go))
        )

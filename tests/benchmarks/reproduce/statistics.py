"""Errors of located touches, against the truth and against the least that noise allows."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan, sqrt
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.contact_error import contact_sensitivity
from contactbench.pipeline.contact import Reason

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.contact import Batch
    from contactbench.pipeline.study.marker_touches import Touched
    from contactbench.pipeline.study.paper_setup import Bench


@dataclass(frozen=True)
class Errors:
    """
    Errors of some touches; mm, NaN where there is none.

    Nothing is left aside: a touch counts wherever a point is named, with the first of several that are as likely.
    """

    touches: int
    # Shares of the touches: with a point, with a point and no doubt, and with the warning that another is
    # as likely
    answered: float
    # Shares of the touches: with a point, with a point and no doubt, and with the warning that another is
    # as likely
    sure: float
    # Shares of the touches: with a point, with a point and no doubt, and with the warning that another is
    # as likely
    ambiguous: float
    mean: float  # Distance to the true contact
    sd: float  # Distance to the true contact
    largest: float  # Distance to the true contact
    to_marker: float  # Mean distance to the marker
    bound: float  # Root mean square that noise after the filter and the calibration alone give
    over_bound: float  # Root mean square distance over it
    common: int  # Touches that every method names a point for
    common_mean: float  # Distance to the true contact over those
    common_largest: float  # Distance to the true contact over those


@dataclass(frozen=True, eq=False)
class Located:
    """Answers of one method, a row per touch."""

    points: NDArray[np.float64]  # (n, 3). S, m; NaN without an answer.
    reasons: NDArray[np.uint8]  # (n,)

    @classmethod
    def of(cls, batch: Batch) -> Located:
        """Copy what is needed of a batch."""
        return cls(batch.points.copy(), batch.reasons.copy())

    @classmethod
    def joined(cls, parts: list[Located]) -> Located:
        """Put answers one behind the other."""
        return cls(np.concatenate([p.points for p in parts]), np.concatenate([p.reasons for p in parts]))

    @property
    def settled(self) -> NDArray[np.bool_]:
        """Which are given without doubt, (n,); the declared region may have decided."""
        return np.isin(self.reasons, (Reason.OK, Reason.VERTEX, Reason.BY_REGION))

    @property
    def answered(self) -> NDArray[np.bool_]:
        """Which have a point, doubtful or not, (n,)."""
        return np.asarray(np.isfinite(self.points).all(axis=1))

    def where(self, chosen: NDArray[np.bool_]) -> Located:
        """Return some rows."""
        return Located(self.points[chosen], self.reasons[chosen])


def bounds_m(touched: Touched, bench: Bench) -> NDArray[np.float64]:
    """Return the root mean square error that noise and calibration alone give to each touch, (n,), m."""
    covariances = bench.noise_at(touched.R_WS)
    squares = [
        np.trace(J @ C @ J.T)
        for J, C in (
            (contact_sensitivity(p, n, w[None, :3])[0], C)
            for p, n, w, C in zip(touched.points, touched.normals, touched.contacts, covariances, strict=True)
        )
    ]
    return np.asarray(np.sqrt(squares))


def distances_mm(points: NDArray[np.float64], truth: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far points (n, 3) are from others, (n,), mm."""
    return np.asarray(1e3 * np.linalg.norm(points - truth, axis=1))


def errors_of(
    located: Located,
    touched: Touched,
    bounds: NDArray[np.float64],
    common: NDArray[np.bool_] | None = None,
) -> Errors:
    """Sum up the answers to touches."""
    answered = located.answered
    every = answered if common is None else common
    share, sure = float(answered.mean()), float(located.settled.mean())
    ambiguous = float((located.reasons == Reason.AMBIGUOUS).mean())
    if not answered.any():
        return Errors(len(touched), share, sure, ambiguous, nan, nan, nan, nan, nan, nan, 0, nan, nan)
    error = distances_mm(located.points, touched.points)
    bound = 1e3 * root_mean_square(bounds[answered])
    shared = error[every]
    return Errors(
        len(touched),
        share,
        sure,
        ambiguous,
        float(error[answered].mean()),
        float(error[answered].std()),
        float(error[answered].max()),
        float(distances_mm(located.points, touched.targets)[answered].mean()),
        bound,
        root_mean_square(error[answered]) / bound,
        len(shared),
        float(shared.mean()) if len(shared) else nan,
        float(shared.max()) if len(shared) else nan,
    )


def root_mean_square(values: NDArray[np.float64]) -> float:
    """Return it over all values; NaN where there is none."""
    return sqrt(float(np.mean(values**2))) if len(values) else nan

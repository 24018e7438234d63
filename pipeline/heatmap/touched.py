"""The contacts of a verification: its accepted touches, each with its distance to the marker."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.heatmap.contacts import Contacts
from contactbench.pipeline.heatmap.heatmap import HeatmapError

if TYPE_CHECKING:
    from contactbench.pipeline.verification.figures import Verification


def touches_of(verification: Verification) -> Contacts:
    """
    Return the accepted touches; those that were rejected are counted in `left_out`.

    Raises
    ------
    HeatmapError
        No touch was accepted.
    """
    used = [t for t in verification.touches if t.accepted and t.point_mm and t.distance_mm is not None]
    if not used:
        raise HeatmapError("the verification has no accepted touch: see its reasons, and touch again.")
    starts = np.array([t.start_s for t in verification.touches])
    ends = np.array([t.time_s for t in verification.touches])
    return Contacts(
        points=1e-3 * np.array([t.point_mm for t in used], dtype=np.float64),
        seconds=np.array([max(t.time_s - t.start_s, 0.0) for t in used]),
        sigmas=1e-3 * np.array([np.nan if t.predicted_mm is None else t.predicted_mm for t in used]),
        forces=np.array([t.force_N for t in used]),
        duration=float(ends.max() - starts.min()),
        left_out=dict(verification.rejected),
        counted="touches",
        times=np.array([t.time_s for t in used]) - float(starts.min()),
        known_errors=1e-3 * np.array([t.distance_mm for t in used], dtype=np.float64),
    )

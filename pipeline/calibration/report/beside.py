"""What was taken off the poses' readings beside weight and bias, as a report has to name it."""

import numpy as np

from contactbench.pipeline.calibration.calibrate import Calibration
from contactbench.pipeline.calibration.nuisance import DRIFT, REZERO

_SAME_WRENCH = 1e-9  # N, N·m


def taken_off(calibration: Calibration) -> str:
    """Return DRIFT or REZERO, or nothing: after a re-zero there are two biases, in a drift one for each pose."""
    offsets = calibration.offsets
    if not offsets.any():
        return ""
    first = offsets[np.argmax(np.abs(offsets).sum(axis=1))]
    two = [np.abs(offsets - one).max(axis=1) < _SAME_WRENCH for one in (first, np.zeros(6))]
    return REZERO if np.logical_or(*two).all() else DRIFT

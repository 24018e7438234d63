"""Forces of touches against those of a reference sensor."""

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.verification.figures import ForceAccuracy
from contactbench.pipeline.verification.protocol import Touch

_LONGEST_GAP = 0.1  # s between two samples of a reference that are still interpolated
_ENOUGH = 0.9  # of the accepted touches


def force_accuracy(
    touches: list[Touch], times: NDArray[np.float64], forces: NDArray[np.float64]
) -> tuple[ForceAccuracy | None, list[str]]:
    """
    Compare forces over the samples of accepted touches.

    Parameters
    ----------
    touches : list of Touch
    times, forces : (n,)
        Of the reference, s on the recording's clock and N.

    Returns
    -------
    ForceAccuracy or None
        None: the reference has nothing there.
    list of str
        What is doubtful about it.
    """
    accepted = [touch for touch in touches if touch.why is None and touch.span is not None]
    pairs = [
        (touch.force, value)
        for touch in accepted
        if touch.span is not None and (value := _during(touch.span, times, forces)) is not None
    ]
    said = []
    if len(pairs) < _ENOUGH * len(accepted):
        few = message(
            f"Only {arg(len(pairs))} of {arg(len(accepted))} accepted touches have a reference force: check"
            " that its times use the recording's clock."
        )
        said.append(few)
    if not pairs:
        return None, said
    ours, theirs = np.array(pairs).T
    if theirs.mean() < 0.5 * ours.mean():
        little = message(
            f"The reference reads {arg(theirs.mean()):.2f} N where the sensor reads {arg(ours.mean()):.2f}"
            " N: check its unit (N), and that it was pressed during these touches."
        )
        said.append(little)
    away = ours - theirs
    sd = float(away.std(ddof=1)) if len(away) > 1 else 0.0
    share = float(100 * np.sqrt(np.mean((away / np.maximum(ours, theirs)) ** 2)))
    found = ForceAccuracy(len(away), float(away.mean()), sd, float(np.abs(away).max()), share, len(accepted))
    return found, said


def _during(
    span: tuple[float, float], times: NDArray[np.float64], forces: NDArray[np.float64]
) -> float | None:
    begin, end = span
    near = forces[(times >= begin - _LONGEST_GAP) & (times <= end + _LONGEST_GAP)]
    within = forces[(times >= begin) & (times <= end)]
    if not len(near):
        return None
    return float((within if len(within) else near).mean())

"""How probable each cause is, and that it is none of those that are known."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.special import logsumexp

from contactbench.pipeline.calibration.diagnosis.prior import QUIET

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from contactbench.pipeline.calibration.diagnosis.explain import Case

NONE = "none"
# An unknown cause leaves residuals of any size: forces and torques by a factor of up to 3,000 each, where those of
# a known cause are those of the noise.
_ANY_SIZE = 2 * float(np.log(np.log(3e3)))

_LEFT_OVER = float(
    np.log(19.0)
)  # that an unknown cause is more probable than any whose residuals chance refutes


def odds(cases: Sequence[Case], mistake: float, *, explained: bool) -> Mapping[str, float]:
    """Return the probability of each case by its key, and of NONE.

    None of the known causes is a reading of its own: its likelihood is that of the best known reading with
    residuals of any size, so it wins where even the best leaves more than the noise explains.

    Parameters
    ----------
    cases : sequence of Case
    mistake : float
        Share of recordings with a mistake of any one family.
    explained : bool
        Chance explains the residuals of the best case; else hardly any case can be true.
    """
    unknown = max(_unexplained(case) for case in cases) + np.log(mistake) - _ANY_SIZE
    if not explained:
        unknown = max(unknown, max(case.score for case in cases) + _LEFT_OVER)
    scores = np.array([*(case.score for case in cases), unknown])
    shares = np.exp(scores - logsumexp(scores))
    return dict(zip([*(case.key for case in cases), NONE], shares.tolist(), strict=True))


def _unexplained(case: Case) -> float:
    """Return the logarithm of the likelihood if the size of the residuals means nothing."""
    return (
        case.value + case.evidence.excess - case.priors.get(QUIET, 0.0) + float(np.log(case.hypothesis.share))
    )


def in_words(probability: float) -> str:
    """Return odds such as "8 to 1"."""
    ratio = probability / max(1 - probability, 1e-9)
    if ratio > 1000:
        return "over 1000 to 1"
    whole = round(max(ratio, 1 / ratio)) if ratio > 0 else 1000
    return f"{whole} to 1" if ratio >= 1 else f"1 to {whole}"

"""The fewest facets that keep an error within its limit, in few attempts."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import arg
from contactbench.pipeline.mesh.errors import MeshError
from contactbench.pipeline.mesh.simplify.target import FEWEST

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.mesh.simplify.job import Attempt, SimplifyJob

MOST_ATTEMPTS = 12
_FIRST_GUESS = 500

# The next count down may do as well by chance as this one.
_CLOSE = 1.05

# An error that falls by less than this while the facets grow eightfold is not the facets' doing.
_ROUGH_FACTOR, _ROUGH_FALL = 8.0, 0.6

# Where a count fails, one nearby is likely to fail too.
_AFTER_FAILURE = 2.0


def fewest_facets(
    job: SimplifyJob,
    error: Callable[[Attempt], float],
    limit: float,
    progress: Callable[[float], None],
    enough: int = FEWEST,
) -> Attempt | None:
    """
    Search the count on a logarithmic scale, guided by the errors met so far.

    The error does not fall strictly with the count, so a smaller count may exist. After twelve attempts the best
    one so far is taken.

    Parameters
    ----------
    job : SimplifyJob
        Makes the simplified probes.
    error : callable
        The error of an attempt.
    limit : float
        The largest error that will do.
    progress : callable
        Takes the fraction done, 0 to 1, before every attempt.
    enough : int
        Fewer are not looked for; and where more hardly help, these will do.

    Returns
    -------
    Attempt or None
        None when none of those tried keeps the limit, but the original does. One that does not keep it where more
        facets hardly help.

    Raises
    ------
    MeshError
        Not even the original keeps the limit.
    Cancelled
        The caller cancelled.
    """
    low, high = enough - 1, len(job.probe.faces)
    best: Attempt | None = None
    fewest: Attempt | None = None
    met: list[tuple[float, float]] = []
    failed = False
    for number in range(MOST_ATTEMPTS):
        if high <= max(low * _CLOSE, low + 2):
            break
        progress(number / MOST_ATTEMPTS)
        count = _after_failure(low, high) if failed else _next(low, high, met)
        try:
            attempt, failed = job.attempt(count), False
        except MeshError:
            low, failed = count, True
            continue
        value = error(attempt)
        failed = not math.isfinite(value)  # says nothing of how far the limit is
        if value > 0 and not failed:
            met.append((math.log(count), math.log(value / limit)))
            if len(met) == 1:
                fewest = attempt
            elif enough > FEWEST and best is None and value > limit and _is_rough(met):
                return fewest
        if value <= limit:
            best, high = attempt, count
        else:
            low = count
    if best is None:
        _check_original(job, error, limit)
    return best


def _is_rough(met: list[tuple[float, float]]) -> bool:
    """Tell whether more facets hardly help: a scan's own roughness moves contacts between any two of its meshes."""
    (fewer, more), (few, many) = met[0], met[-1]
    return few - fewer >= math.log(_ROUGH_FACTOR) and many - more > math.log(_ROUGH_FALL)


def _after_failure(low: int, high: int) -> int:
    """Go up by a factor, or halfway on the logarithmic scale where that would be too far."""
    return min(max(round(min(_AFTER_FAILURE * low, math.sqrt(low * high))), low + 1), high - 1)


def _next(low: int, high: int, met: list[tuple[float, float]]) -> int:
    """Where the error should be at the limit: the secant of the last two, or error inverse to the count."""
    if not met:
        return min(max(_FIRST_GUESS, low + 1), high - 1)
    x, y = met[-1]
    slope = -1.0
    if len(met) > 1:
        (x0, y0) = met[-2]
        if x != x0:
            # Errors jump; a slope far from the law of smooth surfaces is chance.
            slope = min(max((y - y0) / (x - x0), -2.0), -0.5)
    bottom, top = math.log(low), math.log(high)
    # A tenth inside the bracket, so that it shrinks whatever the errors do; a hair on the safe side of the root.
    margin = 0.1 * (top - bottom)
    guess = x - y / slope + 0.01
    return min(max(round(math.exp(min(max(guess, bottom + margin), top - margin))), low + 1), high - 1)


def _check_original(job: SimplifyJob, error: Callable[[Attempt], float], limit: float) -> None:
    value = error(job.unchanged())
    if not value <= limit:
        raise MeshError(
            f"the full mesh already has an error of {arg(value):.4g}, above the limit of {arg(limit):.4g}:"
            " raise the limit."
        )

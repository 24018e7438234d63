"""The fewest facets that keep an error within its limit, in few engine calls."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from pipeline.mesh.errors import MeshError
from pipeline.mesh.simplify.target import FEWEST

if TYPE_CHECKING:
    from collections.abc import Callable

    from pipeline.mesh.simplify.job import Attempt, Job

_MOST_CALLS = 12
_FIRST_GUESS = 500

# Engines reach about this: the next count down may do as well by chance as this one.
_CLOSE = 1.05


def fewest_facets(
    job: Job, error: Callable[[Attempt], float], limit: float, progress: Callable[[float], None]
) -> Attempt:
    """
    Search the count on a logarithmic scale, guided by the errors met so far.

    The error of an engine does not fall strictly with the count, so a smaller count may exist; the one returned is
    within the limit, and within 5 % of one that is not, or that no engine reached.

    Parameters
    ----------
    job : Job
        Makes the simplified probes.
    error : callable
        The error of an attempt.
    limit : float
        The largest error that will do.
    progress : callable
        Takes the fraction done, 0 to 1, before every call of an engine.

    Returns
    -------
    Attempt
        The original itself when nothing else keeps the limit.

    Raises
    ------
    MeshError
        Not even the original keeps the limit.
    Cancelled
        The caller cancelled.
    """
    low, high = FEWEST - 1, len(job.probe.faces)
    best: Attempt | None = None
    met: list[tuple[float, float]] = []
    for call in range(_MOST_CALLS):
        if high <= max(low * _CLOSE, low + 2):
            break
        progress(call / _MOST_CALLS)
        count = _next(low, high, met)
        try:
            attempt = job.reach(count)
        except MeshError:
            low = count
            continue
        value = error(attempt)
        if value > 0 and math.isfinite(value):
            met.append((math.log(count), math.log(value / limit)))
        if value <= limit:
            best, high = attempt, count
        else:
            low = count
    return best if best is not None else _original(job, error, limit)


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


def _original(job: Job, error: Callable[[Attempt], float], limit: float) -> Attempt:
    original = job.unchanged()
    value = error(original)
    if not value <= limit:
        raise MeshError(
            f"the error of the full mesh is {value:.4g} already, above the limit of {limit:.4g}: raise the limit."
        )
    job.steps.append("No fewer facets keep the limit: the surface is left as it is.")
    return original

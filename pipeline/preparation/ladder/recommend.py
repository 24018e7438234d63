"""Which rung to take, and why, in a sentence or two."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.preparation.ladder.errors import LadderError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.preparation.ladder.compare import PartErrors, Statistic
    from contactbench.pipeline.preparation.ladder.ladder import Rung

_WORDS = {"mean": "mean", "p95": message("95th percentile"), "max": "largest"}


@dataclass(frozen=True)
class Goal:
    """
    What simplification may cost.

    Raises
    ------
    LadderError
        A value is out of its range.
    """

    # largest added contact error, m. None: as much as lets the total error grow by `growth`.
    limit_m: float | None = None
    statistic: Statistic = "p95"  # which added error is held against the limit
    # how much the total error may grow, 0.05 for 5 %; used when there is no limit in metres
    growth: float = 0.05
    # share of the touches settled on the full mesh that may be lost, doubtful or jump. Default 2 %:
    # touches near the edge of doubt tip over whatever the mesh.
    failed: float = 0.02

    def __post_init__(self) -> None:
        if self.limit_m is not None and not 0 < self.limit_m < math.inf:
            raise LadderError(f"the largest added error is {arg(self.limit_m):g} m: give a length above 0.")
        if self.statistic not in _WORDS:
            raise LadderError(
                f"there is no statistic {arg(self.statistic)!r}: choose one of {arg(join(', ', _WORDS))}."
            )
        if not 0 < self.growth < math.inf:
            raise LadderError(
                f"the total error may grow by {arg(self.growth):g}: give a number above 0, such as 0.05."
            )
        if not 0 <= self.failed <= 1:
            raise LadderError(
                f"the share of failed touches is {arg(self.failed):g}: give a number from 0 to 1."
            )

    def limit(self, bound: float) -> float:
        """
        Return the largest added error that will do, m.

        Added error e and noise s are independent, so the total is ``sqrt(s² + e²)``; it is `growth` above s at
        ``e = s sqrt((1 + growth)² - 1)``, which is 0.32 s for 5 %.

        Parameters
        ----------
        bound : float
            Noise bound of the full mesh, m.
        """
        return self.limit_m if self.limit_m is not None else bound * math.sqrt((1 + self.growth) ** 2 - 1)

    def keeps(self, errors: PartErrors) -> bool:
        """Tell whether a mesh with these errors on the part that is judged will do."""
        value = errors.noisy.statistic(self.statistic)
        if value is None or value > self.limit(errors.bound):
            return False
        # The formula takes the statistic for the root mean square; a few large errors would break that.
        too_much = self.limit_m is None and errors.growth is not None and errors.growth > self.growth
        return not too_much and errors.noisy.failed_share <= self.failed


@dataclass(frozen=True)
class Recommendation:
    """The rung to take."""

    facets: int | None  # of that rung; None when no simplified mesh will do
    limit: float  # largest added error that would do, m
    reason: str  # why, in sentences


def recommend(rungs: Sequence[Rung], goal: Goal) -> Recommendation:
    """
    Choose the fewest facets that keep the goal.

    Speed does not choose, because a clock never says the same twice: the reason states it.

    Parameters
    ----------
    rungs : sequence of Rung
        By facets, ascending; the last is the full mesh.
    goal : Goal
        What to keep.

    Returns
    -------
    Recommendation
    """
    *simplified, full = rungs
    limit = goal.limit(full.judged.bound)
    keeping = next((i for i, rung in enumerate(simplified) if goal.keeps(rung.judged)), None)
    if keeping is None:
        return Recommendation(None, limit, _none_keeps(simplified, full, goal, limit))
    rung = simplified[keeping]
    sentences = [
        message(
            f"Take {arg(rung.facets):,} facets, the fewest measured that suffice: {arg(_errors(rung, goal, limit))}."
        )
    ]
    if keeping:
        coarser = simplified[keeping - 1]
        sentences.append(
            message(f"With {arg(coarser.facets):,} {arg(_shortfall(coarser.judged, goal, limit))}.")
        )
    sentences += [_elsewhere(errors, goal) for errors in rung.errors[1:]]
    sentences += _speed(rung, full)
    return Recommendation(rung.facets, limit, join(" ", sentences))


def _none_keeps(simplified: Sequence[Rung], full: Rung, goal: Goal, limit: float) -> str:
    keep = message(f"Keep the full mesh of {arg(full.facets):,} facets")
    if not simplified:
        return message(f"{arg(keep)}: no simplified one was measured.")
    if limit == 0:
        return message(
            f"{arg(keep)}: the sensor is declared noise-free, so no error may be added. Give a limit as a length."
        )
    finest = simplified[-1]
    return message(
        f"{arg(keep)}: no simplified mesh suffices. Even with {arg(finest.facets):,}"
        f" {arg(_shortfall(finest.judged, goal, limit))}."
    )


def _errors(rung: Rung, goal: Goal, limit: float) -> str:
    errors = rung.judged
    value = errors.noisy.statistic(goal.statistic)
    told = message(f"the {arg(_WORDS[goal.statistic])} of the added contact error is {arg(_mm(value))} mm")
    over = errors.over_bound(goal.statistic)
    if over is not None:
        told += message(f", {arg(over):.2g} of the noise's {arg(_mm(errors.bound))} mm")
    if errors.growth is not None:
        told += message(f", and the total error changes by {arg(100 * errors.growth):+.1f} %")
    if goal.limit_m is not None:
        return message(f"{arg(told)} (allowed: {arg(_mm(limit))} mm)")
    return message(f"{arg(told)} (allowed: {arg(100 * goal.growth):+.2g} %)")


def _shortfall(errors: PartErrors, goal: Goal, limit: float) -> str:
    """Say what a rung does wrong, the worst first."""
    value = errors.noisy.statistic(goal.statistic)
    if value is None:
        return message("no touch is settled")
    if value > limit:
        return message(
            f"the {arg(_WORDS[goal.statistic])} is {arg(_mm(value))} mm, over the limit of {arg(_mm(limit))} mm"
        )
    if errors.noisy.failed_share > goal.failed:
        return message(
            f"{arg(100 * errors.noisy.failed_share):.2g} % of the settled touches are lost, doubtful or jump, more than"
            f" {arg(100 * goal.failed):.2g} %"
        )
    return message(
        f"the total error grows by {arg(100 * (errors.growth or 0)):.1f} %, more than {arg(100 * goal.growth):.2g} %"
    )


def _elsewhere(errors: PartErrors, goal: Goal) -> str:
    """Say what the part that does not decide pays."""
    return message(
        f"Outside the regions, which does not count for the choice, the {arg(_WORDS[goal.statistic])}"
        f" is {arg(_mm(errors.noisy.statistic(goal.statistic)))} mm; noise alone gives"
        f" {arg(_mm(errors.bound))} mm."
    )


def _speed(rung: Rung, full: Rung) -> list[str]:
    if rung.speed is None or full.speed is None:
        return []
    ours, loop = rung.speed.contactbench.median, rung.speed.algorithm1.median
    before, loop_before = full.speed.contactbench.median, full.speed.algorithm1.median
    sentence = message(
        f"Contactbench takes {arg(ours / 1e3):.3g} µs a solve ({arg(before / 1e3):.3g} on the full mesh),"
        f" the paper's loop {arg(loop / 1e3):.3g} µs ({arg(loop_before / 1e3):.3g})."
    )
    return [sentence]


def _mm(metres: float | None) -> str:
    return "-" if metres is None else f"{1e3 * metres:.3g}"

"""A measured ladder as the points of a chart: what a number of facets costs, and what it saves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from contactbench.pipeline.preparation.ladder import Ladder


@dataclass(frozen=True)
class TradePoint:
    """One number of facets."""

    facets: int
    error_mm: float  # What 95 % of the contacts move less than, against all facets, mm
    solve_us: float  # Median time of a solve, µs
    loop_us: float  # The same of the paper's loop over all facets, µs
    advised: bool = False  # The fewest facets that will do: the knee


@dataclass(frozen=True)
class Trade:
    """A chart of speed against error."""

    points: tuple[TradePoint, ...]  # By facets, ascending; the last has all of them
    allowed_mm: float  # Largest error that will do, mm
    reason: str  # What to take and why

    @property
    def advised(self) -> int:
        """Facets to take."""
        return next((point.facets for point in self.points if point.advised), self.points[-1].facets)


def trade_of(ladder: Ladder) -> Trade:
    """Return a ladder's chart; rungs on which no touch could be compared are left out."""
    points = [
        TradePoint(
            rung.facets,
            1e3 * rung.judged.noisy.p95,
            0.0 if rung.speed is None else rung.speed.contactbench.median / 1e3,
            0.0 if rung.speed is None else rung.speed.algorithm1.median / 1e3,
            rung is ladder.recommended,
        )
        for rung in ladder.rungs
        if rung.judged.noisy.p95 is not None
    ]
    return Trade(tuple(points), 1e3 * ladder.recommendation.limit, ladder.recommendation.reason)

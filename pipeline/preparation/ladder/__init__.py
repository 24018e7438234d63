"""Quality against speed: what fewer facets cost in contact error, what they save in time, and how many to take."""

from contactbench.pipeline.preparation.ladder.compare import (
    ContactDifference,
    ContactReference,
    ExpectedTouches,
    LadderError,
    PartErrors,
)
from contactbench.pipeline.preparation.ladder.ladder import Goal, Ladder, Rung, recommend
from contactbench.pipeline.preparation.ladder.measure import DEFAULT_FACETS, measure_ladder
from contactbench.pipeline.preparation.ladder.picture import save_ladder

__all__ = [
    "DEFAULT_FACETS",
    "ContactDifference",
    "ContactReference",
    "ExpectedTouches",
    "Goal",
    "Ladder",
    "LadderError",
    "PartErrors",
    "Rung",
    "measure_ladder",
    "recommend",
    "save_ladder",
]

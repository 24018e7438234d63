"""One short ladder that several tests look at."""

from dataclasses import dataclass, field

import pytest
from contact_cases import bundled

from contactbench.pipeline.mesh.engines import Monitor
from contactbench.pipeline.preparation.ladder.compare import ExpectedTouches
from contactbench.pipeline.preparation.ladder.ladder import Ladder
from contactbench.pipeline.preparation.ladder.measure import measure_ladder


@dataclass
class Climbed:
    ladder: Ladder
    progress: list[float] = field(default_factory=list)


@pytest.fixture(scope="package")
def climbed() -> Climbed:
    """Linear probe with regions; rungs out of order, one twice, one above the full mesh, one too near to it."""
    told: list[float] = []
    ladder = measure_ladder(
        bundled("linear", 5_000, regions=True),
        ExpectedTouches(count=500),
        (2_000, 300, 1_000, 300, 4_900, 90_000),
        monitor=Monitor(told.append),
    )
    return Climbed(ladder, told)


@pytest.fixture(scope="package")
def ladder(climbed: Climbed) -> Ladder:
    return climbed.ladder

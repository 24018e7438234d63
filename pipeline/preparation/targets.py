"""How many facets to keep, when what counts is where contacts are found."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.mesh.simplify import MaxError
from contactbench.pipeline.preparation.ladder import ExpectedTouches, Goal, contact_error_criterion

if TYPE_CHECKING:
    from contactbench.pipeline.mesh import Probe

DEFAULT_LIMIT = 1e-4
# Times the limit: the surface itself may not move further anywhere, or letters and ribs that hold less than a twentieth
# of the touches would vanish.
_FARTHEST = 3.0
# A contact takes about as long on fewer facets, but thin and engraved parts would lose their shape.
_ENOUGH = 2_000


@dataclass(frozen=True)
class ContactTarget:
    """
    The fewest facets that hardly move a contact.

    Raises
    ------
    LadderError
        A limit that makes no sense.
    """

    # how far 95 % of the contacts may move, m. By default a tenth of a millimetre: a fifth or less of
    # what noise does to a touch of 10 N, so that nobody will see it.
    limit: float = DEFAULT_LIMIT
    expected: ExpectedTouches = field(default_factory=ExpectedTouches)  # noise, forces and friction to expect

    def __post_init__(self) -> None:
        Goal(self.limit)  # refuses what is no limit

    def of(self, probe: Probe) -> tuple[MaxError, dict[str, Any]]:
        """
        Give the target for a full mesh, m, and how it is written into a probe's history.

        Raises
        ------
        LadderError
            The mesh settles too few touches.
        """
        stated = {
            "max_contact_error_mm": round(1e3 * self.limit, 6),
            "statistic": "p95",
            "forces_N": list(self.expected.force),
            "touches": self.expected.count,
        }
        measure = contact_error_criterion(probe, self.expected, "p95")
        return MaxError(measure, self.limit, farthest=_FARTHEST * self.limit, enough=_ENOUGH), stated

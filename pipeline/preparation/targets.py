"""How many facets to keep, when what counts is where contacts are found."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pipeline.mesh.simplify import MaxError
from pipeline.preparation.ladder import ExpectedTouches, Goal, contact_error_criterion

if TYPE_CHECKING:
    from pipeline.mesh import Probe

DEFAULT_LIMIT = 1e-4


def contact_target(
    probe: Probe, limit: float = DEFAULT_LIMIT, force: tuple[float, float] = (8.0, 10.0)
) -> tuple[MaxError, dict[str, Any]]:
    """
    Ask for the fewest facets that hardly move a contact.

    Parameters
    ----------
    probe : Probe
        The full mesh, m.
    limit : float
        How far 95 % of the contacts may move, m. By default a tenth of a millimetre: a fifth or less of what noise
        does to a touch of 10 N, so that nobody will see it.
    force : (low, high)
        Of the touches to expect, N.

    Returns
    -------
    target : MaxError
    stated : dict
        The target, as it is written into a probe's history.

    Raises
    ------
    LadderError
        The forces or the limit make no sense, or the mesh settles too few touches.
    """
    expected = ExpectedTouches(force=force)
    goal = Goal(limit)
    stated = {
        "max_contact_error_mm": round(1e3 * limit, 6),
        "statistic": goal.statistic,
        "forces_N": list(force),
        "touches": expected.count,
    }
    return MaxError(contact_error_criterion(probe, expected, goal.statistic), limit), stated

"""How many facets to keep: a number, within a deviation, or where contacts are found."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.simplify import Count, MaxDeviation, MaxError, check_ratio
from contactbench.pipeline.preparation.ladder import ContactReference, ExpectedTouches, Goal
from contactbench.pipeline.settings import metres

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.mesh.simplify import Target
    from contactbench.pipeline.preparation.ladder.compare import Statistic
    from contactbench.pipeline.settings import SimplifySettings

    # A target, and how it is written into a probe's history where that is not plain to see.
    Chosen = tuple[Target, dict[str, Any] | None]

# A tenth of a millimetre: a fifth or less of what noise does to a touch of 10 N, so that nobody will see it.
DEFAULT_LIMIT = 1e-4
# Times the limit: the surface itself may not move further anywhere, or letters and ribs that hold less than a twentieth
# of the touches would vanish.
_FARTHEST = 3.0
# A contact takes about as long on fewer facets, but thin and engraved parts would lose their shape.
_ENOUGH = 2_000


def target_of(given: SimplifySettings) -> Callable[[Probe], Chosen]:
    """
    Return what gives the target for a full mesh; what makes no sense is refused here, before the work.

    Raises
    ------
    InputError
        More than one target was given, or a number is out of its range.
    """
    if sum(each is not None for each in (given.facets, given.max_deviation, given.max_contact_error)) > 1:
        raise InputError("--facets, --max-deviation and --max-contact-error: give only one of them.")
    check_ratio(given.region_ratio)
    if given.facets is not None:
        count = Count(given.facets)
        return lambda _: (count, None)
    if given.max_deviation is not None:
        deviation = MaxDeviation(given.max_deviation / 1000)
        return lambda _: (deviation, None)
    limit, expected = metres(given.max_contact_error), ExpectedTouches(force=given.forces)
    limit = DEFAULT_LIMIT if limit is None else limit
    Goal(limit)  # refuses what is no limit
    return lambda probe: contact_target(probe, limit, expected)


def contact_target(
    probe: Probe, limit: float = DEFAULT_LIMIT, expected: ExpectedTouches | None = None
) -> tuple[MaxError, dict[str, Any]]:
    """
    Return the target of the fewest facets that hardly move a contact, and how it is written into a probe's history.

    Parameters
    ----------
    probe : Probe
        The full mesh.
    limit : float
        How far 95 % of the contacts may move, m.
    expected : ExpectedTouches, optional
        Noise, forces and friction to expect.

    Raises
    ------
    LadderError
        The mesh settles too few touches.
    """
    expected = expected or ExpectedTouches()
    stated = {
        "max_contact_error_mm": round(1e3 * limit, 6),
        "statistic": "p95",
        "forces_N": list(expected.force),
        "touches": expected.count,
    }
    measure = contact_error_criterion(probe, expected)
    return MaxError(measure, limit, farthest=_FARTHEST * limit, enough=_ENOUGH), stated


def contact_error_criterion(
    full: Probe,
    expected: ExpectedTouches | None = None,
    statistic: Statistic = "p95",
    *,
    failed: float = Goal.failed,
) -> Callable[[Probe], float]:
    """
    Make the measure for `MaxError`: how far a simplified mesh moves the contacts.

    Parameters
    ----------
    full : Probe
        The full mesh.
    expected : ExpectedTouches, optional
        The noise, forces and friction that it will feel.
    statistic : {"mean", "p95", "max"}
        Of the distances between the answers on the two meshes.
    failed : float
        Share of the touches settled on the full mesh that may be lost, doubtful or jump.

    Returns
    -------
    callable
        Takes a simplified mesh and returns its added contact error on the priority regions, or on the whole probe
        when there are none, m; infinite when more touches fail.

    Raises
    ------
    LadderError
        The full mesh settles too few touches.
    """
    reference = ContactReference(full, expected or ExpectedTouches())

    def measure(probe: Probe) -> float:
        noisy = reference.compare(probe)[0].noisy
        value = noisy.statistic(statistic)
        return math.inf if value is None or noisy.failed_share > failed else value

    return measure

"""Contact error as the measure of a simplification: the fewest facets that keep it under a limit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.mesh.simplify import MaxError, Simplified, simplify
from contactbench.pipeline.preparation.ladder.compare import ContactReference, PartErrors, Statistic
from contactbench.pipeline.preparation.ladder.recommend import Goal
from contactbench.pipeline.preparation.ladder.touches import ExpectedTouches

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.mesh.simplify import Engine


@dataclass(frozen=True, eq=False)
class FewestFacets:
    """The fewest facets found that keep the contact error under a limit."""

    simplified: Simplified  # the mesh, how far it is from the full one, and what was tried
    errors: tuple[PartErrors, ...]  # its added contact errors, the part that was judged first


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
    return _measure(ContactReference(full, expected or ExpectedTouches()), statistic, failed)


def fewest_facets(
    full: Probe,
    limit_m: float,
    expected: ExpectedTouches | None = None,
    statistic: Statistic = "p95",
    *,
    failed: float = Goal.failed,
    engine: Engine = "auto",
    region_ratio: float = 1.0,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> FewestFacets:
    """
    Simplify as far as the contact error allows.

    Parameters
    ----------
    full : Probe
        The full mesh.
    limit_m : float
        Largest added contact error, m.
    expected, statistic, failed
        As for `contact_error_criterion`.
    engine, region_ratio, progress, cancelled
        As for `simplify`.

    Returns
    -------
    FewestFacets

    Raises
    ------
    MeshError
        The limit is not above 0, or no engine gave a usable surface.
    LadderError
        The full mesh settles too few touches.
    Cancelled
        `cancelled` answered True.
    """
    reference = ContactReference(full, expected or ExpectedTouches())
    simplified = simplify(
        full,
        MaxError(_measure(reference, statistic, failed), limit_m),
        engine=engine,
        region_ratio=region_ratio,
        progress=progress,
        cancelled=cancelled,
    )
    return FewestFacets(simplified, reference.compare(simplified.probe))


def _measure(reference: ContactReference, statistic: Statistic, failed: float) -> Callable[[Probe], float]:
    def measure(probe: Probe) -> float:
        noisy = reference.compare(probe)[0].noisy
        value = noisy.statistic(statistic)
        return math.inf if value is None or noisy.failed_share > failed else value

    return measure

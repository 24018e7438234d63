"""Fewer facets for the same shape, measured."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pipeline.mesh.deviation import Deviation, Reference
from pipeline.mesh.probe import Probe
from pipeline.mesh.simplify.job import Attempt, Job, check_ratio
from pipeline.mesh.simplify.recipe import ORDER, Engine
from pipeline.mesh.simplify.search import fewest_facets
from pipeline.mesh.simplify.target import Count, MaxDeviation, Target

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

# For a count the deviation is only reported, and is to take less time than the engine; for a limit it decides.
_COARSE = {"uniform": 3_000, "most": 2_500}
_THOROUGH = {"uniform": 20_000, "most": 200_000}


@dataclass(frozen=True, eq=False)
class Simplified:
    """
    A simplified probe, and how far it is from the original.

    Attributes
    ----------
    probe : Probe
        Valid, in the original's frame and unit, with the regions of the nearest original facets.
    count : int
        Its facets; not always those asked for.
    deviation : Deviation
        From the original, over the whole surface.
    regions : mapping of int to Deviation
        The same per priority region, and at 0 for the rest; empty when there are no regions.
    engine : str
        What made it; "none" when the original was left as it is.
    steps : tuple of str
        What was tried, in order, and why it was not used.
    """

    probe: Probe
    count: int
    deviation: Deviation
    regions: Mapping[int, Deviation]
    engine: str
    steps: tuple[str, ...]

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was reached, and what had to be tried for it, in words."""
        out = [f"{self.count:,} facets by {self.engine}: {self.deviation.sentence}."]
        for priority, part in self.regions.items():
            where = f"In region {priority}" if priority else "Outside every region"
            out.append(f"{where}: {part.sentence}.")
        if len(self.steps) > 1:
            out.append(f"That took {len(self.steps)} attempts; the history lists them.")
        return tuple(out)


def simplify(
    probe: Probe,
    target: Target,
    *,
    engine: Engine = "auto",
    region_ratio: float = 1.0,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Simplified:
    """
    Give a probe fewer facets.

    The engines get the mesh centred and scaled to 100 units, so a probe in any unit is simplified alike. What comes
    back is compared with the original. An engine that stops short of the count, opens or tears the surface, turns
    facets over, or makes facets without area is not used: the next one is, and the result says so.

    Parameters
    ----------
    probe : Probe
        The surface; closed is best.
    target : Count, MaxDeviation or MaxError
        So many facets, or the fewest found within a limit.
    engine : {"auto", "fast-simplification", "meshlab", "best"}
        What to try first. "best" tries every engine, at several sizes, and keeps the smallest Hausdorff distance; it
        takes some thirty times as long.
    region_ratio : float
        Facets per area in the priority regions (region above 0) over that in the rest, 1 to 100. A ratio r for a share
        a of the area gives the regions r a / (r a + 1 - a) of the facets. 1 leaves the spread to the engine, which
        goes by curvature.
    progress : callable, optional
        Takes the fraction done, 0 to 1, never falling; in the calling thread.
    cancelled : callable, optional
        Asked every 0.05 s while an engine works.

    Returns
    -------
    Simplified

    Raises
    ------
    MeshError
        No engine gave a usable surface, or not even the original keeps the limit, or a bad ratio.
    Cancelled
        `cancelled` answered True.
    """
    check_ratio(region_ratio)
    tell = _Told(progress)
    density = _COARSE if isinstance(target, Count) else _THOROUGH
    # The search tree is built without the interpreter while the engine works in its process.
    with ThreadPoolExecutor(1) as pool:
        job = Job(
            probe,
            pool.submit(Reference, probe, **density),
            ORDER[engine],
            pick_best=engine == "best",
            ratio=region_ratio,
            control={"progress": tell.within, "cancelled": cancelled},
        )
        attempt = _reach(job, target, tell)
    tell(1.0)
    return _summed_up(job, attempt)


def _reach(job: Job, target: Target, tell: _Told) -> Attempt:
    if isinstance(target, Count):
        if target.facets >= len(job.probe.faces):
            job.steps.append(f"The surface has {len(job.probe.faces)} facets already: it is left as it is.")
            return job.unchanged()
        return job.reach(target.facets)
    if isinstance(target, MaxDeviation):
        return fewest_facets(job, lambda attempt: attempt.deviation.hausdorff, target.metres, tell)
    measure = target.measure
    return fewest_facets(job, lambda attempt: measure(attempt.probe), target.limit, tell)


def _summed_up(job: Job, attempt: Attempt) -> Simplified:
    before, after = job.probe.region, attempt.probe.region
    regions: dict[int, Deviation] = {}
    if before.any():
        for priority in np.unique(before).tolist():
            deviation = attempt.comparison.deviation(before == priority, after == priority)
            if deviation is not None:
                regions[priority] = deviation
    return Simplified(
        attempt.probe,
        len(attempt.probe.faces),
        attempt.deviation,
        regions,
        attempt.engine,
        tuple(job.steps),
    )


class _Told:
    """Progress that never falls, whatever number of engine calls it is made of."""

    def __init__(self, progress: Callable[[float], None] | None) -> None:
        self._progress = progress
        self._highest = 0.0

    def __call__(self, fraction: float) -> None:
        self._highest = max(self._highest, fraction)
        if self._progress is not None:
            self._progress(self._highest)

    def within(self, _fraction: float) -> None:
        """Take an engine's sign of life."""
        self(self._highest)

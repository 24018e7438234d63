"""Fewer facets for the same shape, measured and checked."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from contactbench.pipeline.errors import MeshError, arg, join, message
from contactbench.pipeline.mesh.deviation import Deviation, Reference
from contactbench.pipeline.mesh.monitor import NOBODY, Monitor
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.simplify.job import ENGINE, UNCHANGED, Attempt, SimplifyJob, check_ratio
from contactbench.pipeline.mesh.soundness import Soundness

# For a count the deviation is only reported, and is to take less time than the collapse; for a limit it decides.
_COARSE = {"uniform": 3_000, "most": 2_500}
_THOROUGH = {"uniform": 20_000, "most": 200_000}


_ROUGH = message("which miss the limit, but more facets hardly help because the surface itself is rough")


# A tetrahedron; a closed surface has no fewer.
FEWEST = 4


@dataclass(frozen=True)
class Count:
    """
    So many facets.

    Attributes
    ----------
    facets : int
        At least 4. A probe that has no more is left as it is.

    Raises
    ------
    MeshError
        Fewer than 4.
    """

    facets: int

    def __post_init__(self) -> None:
        if self.facets < FEWEST:
            raise MeshError(
                f"{arg(self.facets)} facets are too few: no closed surface has fewer than {arg(FEWEST)}."
            )


@dataclass(frozen=True)
class MaxDeviation:
    """
    The fewest facets found whose Hausdorff distance from the original is within a limit.

    Attributes
    ----------
    metres : float
        The limit, above 0.

    Raises
    ------
    MeshError
        Not a length above 0.
    """

    metres: float

    def __post_init__(self) -> None:
        _refuse_unless_positive(self.metres, message("the largest deviation"))


@dataclass(frozen=True)
class MaxError:
    """
    The fewest facets found whose error, by a measure of the caller's, is within a limit.

    Attributes
    ----------
    measure : callable
        Takes a simplified probe, returns its error; 0 or more, and on the whole smaller for more facets.
    limit : float
        In the measure's unit, above 0.
    farthest : float
        Hausdorff distance from the original that no facet count may exceed, metres: a measure over the whole
        surface may not see a small part of it vanish, such as letters.
    enough : int
        Fewer facets than this gain nothing: a probe that has no more is left as it is.

    Raises
    ------
    MeshError
        A limit that is not above 0.
    """

    measure: Callable[[Probe], float]
    limit: float
    farthest: float = math.inf
    enough: int = FEWEST

    def __post_init__(self) -> None:
        _refuse_unless_positive(self.limit, message("the largest error"))


Target = Count | MaxDeviation | MaxError


def _refuse_unless_positive(value: float, what: str) -> None:
    if not (math.isfinite(value) and value > 0):
        raise MeshError(f"{arg(what)} is {arg(value):g}: give a number above 0.")


@dataclass(frozen=True, eq=False)
class Simplified:
    """
    A simplified probe, and how far it is from the original.

    Attributes
    ----------
    probe : Probe
        Sound where the original is, in its frame and unit; its regions end where the original's do.
    count : int
        Its facets; not always those asked for.
    deviation : Deviation
        From the original, over the whole surface.
    regions : mapping of int to Deviation
        The same per priority region, and at 0 for the rest; empty when there are no regions.
    engine : {"edge collapse", "none"}
        What made it; "none" when the original was left as it is.
    soundness : Soundness or None
        Compared with the original; None where that was left as it is.
    steps : tuple of str
        What was tried, in order, and why it was not used.
    short : str
        Why it has more facets than wanted; empty when it has not.
    warnings : tuple of str
        What was asked for in vain.
    """

    probe: Probe
    count: int
    deviation: Deviation
    regions: Mapping[int, Deviation]
    engine: str
    soundness: Soundness | None
    steps: tuple[str, ...]
    short: str = ""
    warnings: tuple[str, ...] = ()

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was reached, and what had to be tried for it, in words."""
        short = join("", (", ", self.short)) if self.short else ""
        out = [
            message(f"{arg(self.count):,} facets{arg(short)}: {arg(self.deviation.sentence)}."),
            *self.warnings,
        ]
        for priority, part in self.regions.items():
            where = message(f"In region {arg(priority)}") if priority else message("Outside every region")
            out.append(message(f"{arg(where)}: {arg(part.sentence)}."))
        if len(self.steps) > 1:
            out.append(message(f"That took {arg(len(self.steps))} attempts; the history lists them."))
        return tuple(out)


def simplify(
    probe: Probe, target: Target, *, region_ratio: float = 1.0, monitor: Monitor = NOBODY
) -> Simplified:
    """
    Give a probe fewer facets.

    Edges are collapsed in the order of their quadric error, on the mesh centred and scaled to 100 units, so a probe in
    any unit is simplified alike. No step is done that would open, fold or cross the surface. What comes out is checked
    as if a stranger had made it, and compared with the original; where it is not sound, more facets are kept, and the
    first sentence says so.

    Parameters
    ----------
    probe : Probe
        The surface; closed is best.
    target : Count, MaxDeviation or MaxError
        So many facets, or the fewest found within a limit.
    region_ratio : float
        Facets per area in the priority regions (region above 0) over that in the rest, 1 to 100. A ratio r for a share
        a of the area gives the regions r a / (r a + 1 - a) of the facets. 1 leaves the spread to the collapse, which
        goes by curvature.
    monitor : Monitor
        Told a share that never falls; asked every few milliseconds.

    Returns
    -------
    Simplified

    Raises
    ------
    MeshError
        No count that was tried gave a sound surface, or not even the original keeps the limit, or a bad ratio.
    Cancelled
        The caller cancelled.
    """
    check_ratio(region_ratio)
    tell = _Told(monitor)
    density = _COARSE if isinstance(target, Count) else _THOROUGH
    # The search tree is built without the interpreter while the edges are collapsed.
    with ThreadPoolExecutor(1) as pool:
        job = SimplifyJob(probe, pool.submit(Reference, probe, **density), region_ratio, tell.within)
        attempt, short = _reach(job, target, tell)
    tell(1.0)
    return _summed_up(job, attempt, short, tuple(_warnings(probe, region_ratio)))


def _reach(job: SimplifyJob, target: Target, tell: _Told) -> tuple[Attempt, str]:
    have = len(job.probe.faces)
    if isinstance(target, Count):
        if target.facets >= have:
            job.steps.append(message(f"The surface already has {arg(have)} facets and was left unchanged."))
            return job.unchanged(), ""
        attempt = job.reach(target.facets)
        if len(attempt.probe.faces) <= target.facets:
            return attempt, ""
        wanted = f"{target.facets:,}"
        why = message(
            f"more than the requested {arg(wanted)}, because no smaller number tried gave a valid surface"
        )
        if job.probe.region.any():
            why = join("", (why, message(", with the outlines of the regions kept")))
        return attempt, why
    if isinstance(target, MaxDeviation):
        target = MaxError(lambda _: 0.0, target.metres, farthest=target.metres)
    elif have <= target.enough:
        job.steps.append(message(f"The surface has {arg(have)} facets, few enough, and was left unchanged."))
        return job.unchanged(), ""
    found, error = fewest_facets(job, target, tell.attempts)
    if found is not None:
        return found, _ROUGH if error > 1 else ""
    job.steps.append(message("Fewer facets would exceed the limit: the surface was left unchanged."))
    return job.unchanged(), message("as many as before, because no smaller number tried keeps the limit")


def _warnings(probe: Probe, region_ratio: float) -> Iterator[str]:
    if region_ratio != 1 and not probe.preferred.any():
        yield message(
            f"The region ratio is {arg(region_ratio):g}, but the mesh has no region: facets are spread"
            " evenly. Mark a region first (contactbench probe regions add)."
        )


def _summed_up(job: SimplifyJob, attempt: Attempt, short: str, warnings: tuple[str, ...]) -> Simplified:
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
        UNCHANGED if attempt.probe is job.probe else ENGINE,
        attempt.soundness,
        tuple(job.steps),
        short,
        warnings,
    )


class _Told:
    """Progress that never falls, whatever number of attempts it is made of."""

    def __init__(self, monitor: Monitor) -> None:
        self._monitor = monitor
        self._highest = 0.0
        self._low, self._share = 0.0, 1.0

    def __call__(self, fraction: float) -> None:
        self._highest = max(self._highest, fraction)
        self._monitor.tell(self._highest)

    def attempts(self, begun: float) -> None:
        """Take where the next attempt begins."""
        self._low, self._share = begun, 1 / MOST_ATTEMPTS
        self(begun)

    def within(self, fraction: float) -> None:
        """Take how far the present attempt is."""
        self(self._low + self._share * fraction)


# ---- the fewest facets that keep an error within its limit, in few attempts ----------------------


MOST_ATTEMPTS = 12
_FIRST_GUESS = 500

# The next count down may do as well by chance as this one; from twice as many, halving gets there soonest.
_CLOSE, _NEAR = 1.1, 2.0

# An error that falls by less than this while the facets grow eightfold is not the facets' doing.
_ROUGH_FACTOR, _ROUGH_FALL = 8.0, 0.6


def fewest_facets(
    job: SimplifyJob, target: MaxError, progress: Callable[[float], None]
) -> tuple[Attempt | None, float]:
    """
    Search the count on a logarithmic scale, guided by the errors met so far.

    The error does not fall strictly with the count, so a smaller count may exist. After twelve attempts the best
    one so far is taken.

    Parameters
    ----------
    job : SimplifyJob
        Makes the simplified probes.
    target : MaxError
    progress : callable
        Takes the fraction done, 0 to 1, before every attempt.

    Returns
    -------
    Attempt or None
        None when none of those tried keeps the limit, but the original does. One that does not keep it where more
        facets hardly help.
    float
        Its error over the limit.

    Raises
    ------
    MeshError
        Not even the original keeps the limit.
    Cancelled
        The caller cancelled.
    """
    low, high = target.enough - 1, len(job.probe.faces)
    best: Attempt | None = None
    fewest: Attempt | None = None
    reached = math.inf
    met: list[tuple[float, float]] = []
    measured: list[tuple[float, float]] = []
    failed = False
    for number in range(MOST_ATTEMPTS):
        if high <= max(low * _CLOSE, low + 2):
            break
        progress(number / MOST_ATTEMPTS)
        count = _next(low, high, met, failed=failed)
        try:
            attempt, failed = job.attempt(count), False
        except MeshError:
            low, failed = count, True
            continue
        error, far = _errors(target, attempt)
        failed = not math.isfinite(error)  # says nothing of how far the limit is
        if error > 0 and not failed:
            met.append((math.log(count), math.log(error)))
            if not far:
                measured.append(met[-1])
                fewest = fewest or attempt
                if target.enough > FEWEST and best is None and error > 1 and _is_rough(measured):
                    return fewest, math.exp(measured[0][1])
        if error <= 1:
            best, high, reached = attempt, count, error
        else:
            low = count
    if best is None:
        error, _ = _errors(target, job.unchanged())
        if not error <= 1:
            raise MeshError(
                f"the full mesh already has an error of {arg(error * target.limit):.4g}, above the limit of"
                f" {arg(target.limit):.4g}: raise the limit."
            )
    return best, reached


def _errors(target: MaxError, attempt: Attempt) -> tuple[float, bool]:
    """Return the error over its limit, and whether it is one of the whole surface: then the other is not measured."""
    off = attempt.deviation.hausdorff / target.farthest
    return (off, True) if off > 1 else (max(off, target.measure(attempt.probe) / target.limit), False)


def _is_rough(met: list[tuple[float, float]]) -> bool:
    """Tell whether more facets hardly help: a scan's own roughness moves contacts between any two of its meshes."""
    (fewer, more), (few, many) = met[0], met[-1]
    return few - fewer >= math.log(_ROUGH_FACTOR) and many - more > math.log(_ROUGH_FALL)


def _next(low: int, high: int, met: list[tuple[float, float]], *, failed: bool) -> int:
    """
    Where the error should be at the limit: the secant of the last two, or error inverse to the count.

    Halfway on the logarithmic scale near the end; up by a factor at most, where the last count failed.
    """
    bottom, top = math.log(low), math.log(high)
    # A tenth inside the bracket, so that it shrinks whatever the errors do; a hair on the safe side of the root.
    guess, margin = (bottom + top) / 2, 0.1 * (top - bottom)
    if failed:
        guess = min(guess, bottom + math.log(_NEAR))
    elif not met:
        guess, margin = math.log(_FIRST_GUESS), 0.0
    elif high > _NEAR * low:
        (x0, y0), (x, y) = met[-2:] if len(met) > 1 else (met[0], met[0])
        # Errors jump; a slope far from the law of smooth surfaces is chance.
        slope = min(max((y - y0) / (x - x0), -2.0), -0.5) if x != x0 else -1.0
        guess = x - y / slope + 0.01
    return min(max(round(math.exp(min(max(guess, bottom + margin), top - margin))), low + 1), high - 1)

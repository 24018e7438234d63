"""One simplification under way: reach a count, check what came out, remember it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from contactbench.pipeline.errors import MeshError, arg, join, message
from contactbench.pipeline.kernel import collapse_edges
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Soup
from contactbench.pipeline.mesh.deviation import Deviation, Reference, SurfaceComparison, doubled_areas
from contactbench.pipeline.mesh.monitor import NOBODY, Monitor
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.soundness import SPECKS, Soundness, check_soundness
from contactbench.pipeline.mesh.triangles import first_alike, merge_vertices

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


# Counts tried in turn, over the one asked for: most shapes are sound at the first, thin and engraved ones at some more.
_STEPS = (1.0, 1.05, 1.2, 1.5, 2.0, 4.0, 8.0)

# Of the size: what is further off is another shape. Where no more edges can be collapsed without folding, the collapse
# goes on wherever it still can, and takes whole walls away (test_a_shape_that_cannot_be_kept_is_not_given).
_ANOTHER_SHAPE = 0.05

# Above so many times so many facets a search collapses the mesh to that number once, and not at every try.
_MANY, _HALFWAY = 100_000, 4

ENGINE, UNCHANGED = message("edge collapse"), "none"


@dataclass(frozen=True, eq=False)
class Attempt:
    """
    A simplified probe that passed the checks.

    Attributes
    ----------
    probe : Probe
        The result; its regions end where the original's do.
    comparison : SurfaceComparison
        With the original.
    deviation : Deviation
        Over the whole surface.
    soundness : Soundness or None
        Compared with the original; None for the original itself.
    """

    probe: Probe
    comparison: SurfaceComparison
    deviation: Deviation
    soundness: Soundness | None = None


class SimplifyJob:
    """
    The simplifications of one probe.

    Parameters
    ----------
    probe : Probe
        The original.
    reference : Future[Reference]
        The original made ready for comparing, when it is.
    ratio : float
        Facets per area in the regions over that in the rest.
    tell : callable
        Takes the fraction done of one attempt; raises Cancelled where the work is to stop.
    """

    def __init__(
        self, probe: Probe, reference: Future[Reference], ratio: float, tell: Callable[[float], None]
    ) -> None:
        self.probe = probe
        self.steps: list[str] = []
        self._reference = reference
        self._ratio = ratio
        self._tell = tell
        self._mesh, self._gridded = make_canonical(probe), True
        self._made: dict[int, Attempt | MeshError] = {}

    @property
    def reference(self) -> Reference:
        """The original, ready to be compared with; waits for it."""
        return self._reference.result()

    def unchanged(self) -> Attempt:
        """Return the original as an attempt."""
        return self._compared(self.probe)

    def reach(self, count: int) -> Attempt:
        """
        Simplify to a count, or to the nearest larger one tried that gives a sound surface.

        Parameters
        ----------
        count : int
            Facets, fewer than the original has.

        Raises
        ------
        MeshError
            No count that was tried gave a sound surface.
        Cancelled
            The caller cancelled.
        """
        failed = ""
        for step in _STEPS:
            wanted = round(step * count)
            if wanted >= len(self.probe.faces):
                break
            try:
                return self.attempt(wanted)
            except MeshError as error:
                failed = str(error)
        raise MeshError(
            f"the surface cannot be simplified to {arg(count):,} facets, nor to a few times as many:"
            f" {arg(failed)} Choose more facets, or repair the mesh first."
        )

    def attempt(self, count: int) -> Attempt:
        """
        Simplify to a count, or return what was made for it before.

        Parameters
        ----------
        count : int
            Facets, fewer than the original has.

        Raises
        ------
        MeshError
            What came out is not sound; says what is wrong.
        Cancelled
            The caller cancelled.
        """
        made = self._made.get(count)
        if made is None:
            try:
                made = self._attempt(count)
                done = message(f"within {arg(made.deviation.hausdorff * 1e3):.4g} mm of the original")
                self.steps.append(
                    message(
                        f"{arg(count):,} facets asked for: {arg(len(made.probe.faces)):,} facets, {arg(done)}."
                    )
                )
            except MeshError as error:
                made = error
                self.steps.append(message(f"{arg(count):,} facets asked for: {arg(error)}"))
            self._made[count] = made
        if isinstance(made, MeshError):
            raise made
        return made

    def _attempt(self, count: int) -> Attempt:
        self._tell(0.0)
        vertices, faces, origin = self._collapsed(count)
        made = Probe.from_arrays(
            self._mesh.back(vertices),
            faces,
            self.probe.region[origin],
            name=self.probe.name,
            check_size=False,
        )
        attempt = self._compared(made)
        made, whole = attempt.probe, (self.probe.vertices, self.probe.faces)
        found = check_soundness(made.vertices, made.faces, whole, invented=made.invented)
        if faults := find_faults(found, lambda: self._soundness):
            if found.crossing + found.overlapping and self._gridded:
                # Walls may be so near that they cross on the grid.
                self._gridded, self._mesh = False, make_canonical(self.probe, gridded=False)
                for made_of_it in ("_halfway", "_chosen"):
                    vars(self).pop(made_of_it, None)
                return self._attempt(count)
            raise MeshError(join(" ", faults))
        if attempt.deviation.hausdorff > _ANOTHER_SHAPE * self.probe.size:
            off = f"{1e3 * attempt.deviation.hausdorff:.3g} mm"
            raise MeshError(
                f"{arg(len(attempt.probe.faces))} facets are up to {arg(off)} off: the shape is lost."
            )
        return replace(attempt, soundness=found)

    def _collapsed(self, count: int) -> Soup:
        """Return the mesh collapsed, and which of the original's facets each of its own was."""
        chosen = self._chosen
        mesh = self._mesh if chosen.any() or _HALFWAY * count > _MANY else self._halfway
        if mesh is not self._mesh:
            chosen = np.zeros(len(mesh.faces), dtype=np.bool_)
        inside = min(inside_count(count, self._ratio, self._region_share), int(np.count_nonzero(chosen)))
        # What the regions do not use goes to the rest, and the other way round.
        outside = min(count - inside, int(np.count_nonzero(~chosen)))
        wanted = (outside, count - outside if chosen.any() else 0)
        return self._collapse(mesh, wanted, chosen)

    def _collapse(self, mesh: Canonical, wanted: tuple[int, int], chosen: Mask) -> Soup:
        labels = self.probe.region[mesh.origin]
        vertices, faces, kept = collapse_edges(mesh.vertices, mesh.faces, wanted, chosen, self._tell, labels)
        return vertices, faces, mesh.origin[kept]

    @cached_property
    def _halfway(self) -> Canonical:
        """The mesh with fewer facets, from which it is not far to the counts that are tried; itself if it has few."""
        mesh = self._mesh
        if len(mesh.faces) <= _HALFWAY * _MANY:
            return mesh
        nowhere = np.zeros(len(mesh.faces), dtype=np.bool_)
        vertices, faces, origin = self._collapse(mesh, (_MANY, 0), nowhere)
        return replace(mesh, vertices=vertices, faces=faces, origin=origin)

    @cached_property
    def _chosen(self) -> Mask:
        """The facets that are to stay denser; none when all are to be treated alike."""
        faces = self._mesh.faces
        if self._ratio == 1 or not 0 < self._region_share < 1:
            return np.zeros(len(faces), dtype=np.bool_)
        return self.probe.preferred[self._mesh.origin]

    @cached_property
    def _region_share(self) -> float:
        return float(self.probe.areas[self.probe.preferred].sum() / self.probe.areas.sum())

    @cached_property
    def _soundness(self) -> Soundness:
        return check_soundness(self.probe.vertices, self.probe.faces)

    def _compared(self, made: Probe) -> Attempt:
        if made is not self.probe:
            made = made.with_region(made.region, self.probe.untouchable)
            if self.probe.invented.any():
                # Each takes over what the original one is that its centre is nearest to.
                nearest = self.reference.nearest_facet(made.vertices[made.faces].mean(axis=1))
                made = made.with_invented(self.probe.invented[nearest])
        comparison = self.reference.compare(made)
        return Attempt(made, comparison, comparison.whole())


def inside_count(count: int, ratio: float, share: float) -> int:
    """
    Compute how many of `count` facets the regions get: count r a / (r a + 1 - a).

    Parameters
    ----------
    count : int
        All facets.
    ratio : float
        r: facets per area in the regions over that in the rest.
    share : float
        a: the regions' share of the area, 0 to 1.
    """
    return round(count * ratio * share / (ratio * share + 1 - share))


def check_ratio(ratio: float) -> None:
    """
    Refuse a region ratio that is none.

    Raises
    ------
    MeshError
        Under 1 or over 100.
    """
    # not <=, so that NaN is refused too.
    if not 1 <= ratio <= 100:
        raise MeshError(
            f"the region ratio is {arg(ratio):g}: give 1 for facets spread evenly, up to 100 for more in the regions."
        )


# ---- the mesh as the edge collapse gets it: centred, 100 units long, on a grid, and clean --------


_LENGTH = 100.0

# A metre and a millimetre file of one part differ by rounding, and a difference in the last bit can send the
# collapse down another path. On a grid of 6e-8 of the size both become the same but for one mesh in hundreds.
_GRID = _LENGTH * 2.0**-24

# CAD coordinates are often round numbers: without this shift many would lie halfway between grid points.
_SHIFT = 0.381966

_MERGE = 1e-7 * _LENGTH


@dataclass(frozen=True, eq=False)
class Canonical:
    """
    A mesh in the collapse's unit.

    Attributes
    ----------
    vertices : (n, 3) float64
        From -50 to 50 along the longest axis.
    faces : (m, 3) int32
        No facet twice, none without area.
    origin : (m,) int64
        Which of the probe's facets each is.
    centre : (3,) float64
        Middle of the bounding box, metres in S.
    unit : float
        Metres per unit.
    """

    vertices: Floats
    faces: Ints
    origin: Longs
    centre: Floats
    unit: float

    def back(self, vertices: Floats) -> Floats:
        """Return coordinates in metres in S."""
        return vertices * self.unit + self.centre


def make_canonical(probe: Probe, *, gridded: bool = True) -> Canonical:
    """
    Scale, centre and clean a probe.

    Unmerged vertices would be taken for holes, and duplicate facets for a third one at an edge, so both are mended
    where the probe has them.

    Parameters
    ----------
    probe : Probe
        Its facets have area.
    gridded : bool
        Put the vertices on a grid.

    Returns
    -------
    Canonical
    """
    centre, unit = probe.bounds.mean(axis=0), probe.size / _LENGTH
    exact = (probe.vertices - centre) / unit
    vertices = _on_grid(exact) if gridded else exact
    if not doubled_areas(vertices, probe.faces).all():
        # Facets thinner than the grid: their shape matters more than the last bits.
        vertices = exact
    faces, origin = probe.faces, np.arange(len(probe.faces))
    if not probe.health.watertight or probe.health.duplicate_facets:
        vertices, faces = merge_vertices(vertices, faces, _MERGE)
        origin = np.flatnonzero(doubled_areas(vertices, faces) > 0)
        origin = origin[first_alike(np.sort(faces[origin], axis=1)) == np.arange(len(origin))]
        faces = faces[origin]
    return Canonical(vertices, faces, origin, centre, unit)


def _on_grid(exact: Floats) -> Floats:
    # In place: each temporary of a million vertices is 12 MB.
    grid = exact / _GRID
    grid += _SHIFT
    np.rint(grid, out=grid)
    grid -= _SHIFT
    grid *= _GRID
    return grid


# ---- what is wrong with a simplified mesh that was not wrong with the original -------------------


def find_faults(after: Soundness, original_soundness: Callable[[], Soundness]) -> tuple[str, ...]:
    """
    List the reasons not to use a simplified mesh.

    A surface that is open or crosses may stay so, where the original does, but no worse.

    Parameters
    ----------
    after : Soundness
        Of the simplified mesh, compared with the original.
    original_soundness : callable
        Checks the original by itself; called only when it counts, for it takes long on a large mesh.

    Returns
    -------
    tuple of str
        Sentences; empty when it can be used.
    """
    if after.sound:
        return ()
    before, now = _counts(original_soundness()), _counts(after)
    return after.faults if any(now[what] > before[what] for what in now) else ()


def _counts(soundness: Soundness) -> dict[str, int]:
    health = soundness.health
    return {
        "openings": health.boundary_edges,
        "nonmanifold edges": health.nonmanifold_edges,
        "winding": int(not health.winding_consistent),
        "inside out": int(health.outward is False),
        "repeated": health.duplicate_facets,
        "inward parts": soundness.inward_parts,
        "nested parts": soundness.nested_parts,
        "pinched": len(soundness.pinched_vertices),
        "crossing": soundness.crossing,
        "overlapping": soundness.overlapping,
        "unchecked": int(not soundness.every_pair_checked),
        # Folds too small to count excuse none that are larger.
        "folded": len(soundness.folded_facets) if soundness.folded_share > SPECKS else 0,
        "without area": len(soundness.flat_facets),
    }

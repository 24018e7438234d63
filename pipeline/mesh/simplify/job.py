"""One simplification under way: reach a count, check what came out, remember it."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from contactbench.pipeline.errors import MeshError, arg, join, message
from contactbench.pipeline.kernel import collapse_edges
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Soup
from contactbench.pipeline.mesh.deviation import Deviation, Reference, SurfaceComparison, doubled_areas
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.soundness import SPECKS, Soundness, check_soundness
from contactbench.pipeline.mesh.triangles import first_alike, merge_vertices

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

"""The outer shell of a probe: closed, outward, one part, and honest about what was invented."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from pipeline.kernel import SurfaceIndex
from pipeline.mesh.engines import Cancelled
from pipeline.mesh.errors import MeshError, MeshWarning
from pipeline.mesh.probe import Probe
from pipeline.mesh.regions import RegionSet, transfer
from pipeline.mesh.shell.exposure import exposure
from pipeline.mesh.shell.fit import measure_fit
from pipeline.mesh.shell.openings import Opening, find_openings
from pipeline.mesh.shell.patch import Closing, choose, make_patch
from pipeline.mesh.shell.repair import is_sound, repair, turn
from pipeline.mesh.shell.result import REPAIRED, UNCHANGED, WRAPPED, ClosedOpening, Shell
from pipeline.mesh.shell.rim import find_lip
from pipeline.mesh.shell.wrap import SURFACE, draw_in, fine_wrap, wrap_soup
from pipeline.mesh.triangles import cross_products, join, parts, twins

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from pipeline.mesh.shell.wrap import Wrapped

# Shares of the size. The coarse alpha is what counts as a gap, about a fingertip's crease; the fine one is the
# size of the shell's facets.
COARSE = 1 / 65
FINE = 1 / 190
_FINEST = 1 / 1000
_SPECK = 0.01  # of the largest part's area: what is smaller is not the probe
_MOSTLY = 0.5  # of the area: a shell that is invented to this extent says nothing
_GLANCES, _NIGHT, _MUCH = 4_000, 0.05, 0.01  # facets looked at, light and share of the area of a hollow mesh
_LIP = 0.2  # of the width of a mouth
_NARROWEST = 1.5  # coarse alphas: mouths under this are bridged by the wrap itself


class Steps:
    """Progress from 0 to 1 over weighted steps, and the way out when somebody cancels."""

    def __init__(
        self, progress: Callable[[float], None] | None, cancelled: Callable[[], bool] | None
    ) -> None:
        self._progress = progress
        self.cancelled = cancelled
        self._from = self._to = 0.0

    def upto(self, share: float) -> Callable[[float], None]:
        """Begin the step that ends at `share` of the whole; gives what tells its own progress, 0 to 1."""
        self._from, self._to = self._to, share
        self.tick(0.0)
        return self.tick

    def tick(self, share: float) -> None:
        """Tell the progress of this step.

        Raises
        ------
        Cancelled
        """
        if self.cancelled is not None and self.cancelled():
            raise Cancelled("the shell was cancelled: the mesh is as it was.")
        if self._progress is not None:
            self._progress(self._from + share * (self._to - self._from))


def make_shell(
    probe: Probe,
    closings: Closing | Sequence[Closing] = Closing.AUTO,
    *,
    alpha: float | None = None,
    coarse: float | None = None,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Shell:
    """
    Make the closed surface that a finger could touch.

    A mesh that needs nothing is given back as it is; one that needs no new surface keeps its vertices.

    Parameters
    ----------
    probe : Probe
        Any frame.
    closings : Closing or sequence of Closing
        For all openings, or one for each, largest first; the last one counts for those that are not listed.
    alpha : float, optional
        Size of the wrap's facets, metres; 1/190 of the size when left out.
    coarse : float, optional
        Gaps narrower than this are bridged, metres; 1/65 of the size when left out, or `alpha` if that is more.
    progress : callable, optional
        Told the share done, 0 to 1.
    cancelled : callable, optional
        Asked often; when it says True, the work stops.

    Returns
    -------
    Shell

    Raises
    ------
    MeshError
        A length that makes no sense, an opening that cannot be closed, or a result that is not closed.
    EngineError
        pymeshlab is missing or failed.
    Cancelled
    """
    alpha = FINE * probe.size if alpha is None else alpha
    coarse = max(COARSE * probe.size, alpha) if coarse is None else coarse
    _check_lengths(alpha, coarse, probe.size)
    steps = Steps(progress, cancelled)
    mended = _mended(probe, steps.upto(0.05))
    wrap = wrap_soup(probe.vertices, probe.faces, coarse, progress=steps.upto(0.1), cancelled=cancelled)
    smallest = _NARROWEST * coarse
    found = _at_their_lips(find_openings(*wrap, smallest=smallest, tick=steps.upto(0.15)), probe, smallest)
    wanted = _wanted(found, closings)
    if (
        mended is not None
        and not found
        and _is_hollow(probe.vertices, turn(probe.faces, mended[1])[mended[0]])
    ):
        mended = None
    if mended is not None and all(closing is Closing.OPEN for closing in wanted):
        left = tuple(ClosedOpening(opening, Closing.OPEN) for opening in found)
        return _as_it_was(probe, *mended, left)
    whole, specks = _without_specks(probe, wrap)
    closed = [
        ClosedOpening(opening, choose(opening) if closing is Closing.AUTO else closing)
        for opening, closing in zip(found, wanted, strict=True)
    ]
    return replace(_wrapped(whole, tuple(closed), alpha, coarse, steps), dropped=specks)


def _at_their_lips(found: Sequence[Opening], probe: Probe, reach: float) -> list[Opening]:
    # The darkness of a cavity begins the deeper below its lip the wider the mouth is.
    lips = [
        find_lip(opening, probe.vertices, probe.faces, max(reach, _LIP * opening.width)) for opening in found
    ]
    return sorted((lip for lip in lips if not lip.is_dent), key=lambda lip: -lip.area)


def _wrapped(
    probe: Probe, openings: tuple[ClosedOpening, ...], alpha: float, coarse: float, steps: Steps
) -> Shell:
    patches = [
        make_patch(each.opening, each.closing, alpha) for each in openings if each.closing is not Closing.OPEN
    ]
    steps.upto(0.2)
    vertices, faces = join([(probe.vertices, probe.faces), *patches])
    stop = steps.cancelled
    plug = draw_in(wrap_soup(vertices, faces, coarse, progress=steps.upto(0.3), cancelled=stop), coarse)
    original = (probe.vertices, probe.faces)
    wrapped = fine_wrap(
        original, probe.invented, patches, plug, alpha, progress=steps.upto(0.85), cancelled=stop
    )
    shell = _checked(wrapped, probe.name)
    fit = measure_fit(probe, patches, wrapped, alpha, steps.upto(1.0))
    done = Shell(shell, WRAPPED, openings, fit, alpha, crossing=wrapped.crossing, gap=coarse)
    if not probe.region.any():
        return done
    with warnings.catch_warnings():
        # Invented facets have no original near them; a region that vanished is told by its report.
        warnings.simplefilter("ignore", MeshWarning)
        moved = transfer(RegionSet.from_labels(probe.region), probe, shell)
    carried = shell.with_region(moved.regions.labels, probe.untouchable)
    return replace(done, probe=carried, carried=moved.report)


def _checked(wrapped: Wrapped, name: str) -> Probe:
    invented = wrapped.rests_on != SURFACE
    shell = Probe.from_arrays(wrapped.vertices, wrapped.faces, invented=invented, name=name, check_size=False)
    if shell.health.sentences:
        raise MeshError(
            "the wrap is not sound (" + " ".join(shell.health.sentences) + ") Try another alpha, or close the"
            " mesh in the CAD program."
        )
    if shell.areas[invented].sum() > _MOSTLY * shell.areas.sum():
        raise MeshError(
            "more than half of the shell would be invented: the mesh is a sheet without thickness, or a small part of"
            " a probe. Export the whole part as a solid."
        )
    return shell


def _without_specks(probe: Probe, wrap: tuple[NDArray[np.float64], NDArray[np.int32]]) -> tuple[Probe, int]:
    """Leave out what stands beside the part and is small; gives the rest, and how many facets were left out."""
    vertices, faces = wrap
    label = parts(faces, np.ones(len(faces), dtype=bool), twins(faces))
    areas = np.bincount(label, np.linalg.norm(cross_products(vertices, faces), axis=1))
    if len(areas) == 1:
        return probe, 0
    large = areas > _SPECK * areas.max()
    if np.count_nonzero(large) > 1:
        one, two = (vertices[faces[label == part]].mean(axis=(0, 1)) for part in np.argsort(-areas)[:2])
        raise MeshError(
            f"the mesh has {np.count_nonzero(large)} parts that do not touch, the middles of two of them"
            f" {1e3 * np.linalg.norm(one - two):.4g} mm apart: delete what is not the probe in the CAD program, or"
            " bridge the gap between them by a larger one (gap)."
        )
    _, nearest, _ = SurfaceIndex(vertices, faces).closest(probe.vertices[probe.faces].mean(axis=1))
    keep = large[label[nearest]]
    return _some_facets(probe, probe.faces, np.flatnonzero(keep)), int(np.count_nonzero(~keep))


def _some_facets(probe: Probe, faces: NDArray[np.int32], kept: NDArray[np.int64]) -> Probe:
    """Give a probe some of its facets only, with what is known of them; `faces` may be turned over."""
    return Probe.from_arrays(
        probe.vertices,
        faces[kept],
        probe.region[kept],
        invented=probe.invented[kept],
        name=probe.name,
        check_size=False,
        untouchable=probe.untouchable,
    )


def _mended(
    probe: Probe, tick: Callable[[float], None]
) -> tuple[NDArray[np.int64], NDArray[np.bool_]] | None:
    """Facets to keep and to turn for a mesh that needs no wrap, or None when that does not do."""
    faces = probe.faces
    kept, turned = np.arange(len(faces)), np.zeros(len(faces), dtype=bool)
    if not is_sound(probe.vertices, faces):
        kept, turned = repair(probe.vertices, faces, tick)
    return (kept, turned) if is_sound(probe.vertices, turn(faces, turned)[kept]) else None


def _is_hollow(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> bool:
    """Tell whether much of the surface lies where next to no light comes: in bores too narrow to find a mouth of."""
    areas = np.linalg.norm(cross_products(vertices, faces), axis=1)
    rng = np.random.default_rng(0)
    some = faces[rng.choice(len(faces), _GLANCES, p=areas / areas.sum())]
    return bool(np.mean(exposure(vertices, some, SurfaceIndex(vertices, faces), count=64) < _NIGHT) > _MUCH)


def _as_it_was(
    probe: Probe,
    kept: NDArray[np.int64],
    turned: NDArray[np.bool_],
    openings: tuple[ClosedOpening, ...],
) -> Shell:
    if len(kept) == len(probe.faces) and not turned.any():
        return Shell(probe, UNCHANGED, openings)
    repaired = _some_facets(probe, turn(probe.faces, turned), kept)
    dropped = len(probe.faces) - len(kept)
    return Shell(repaired, REPAIRED, openings, turned=int(turned[kept].sum()), dropped=dropped)


def _wanted(found: Sequence[Opening], closings: Closing | Sequence[Closing]) -> list[Closing]:
    listed = [closings] if isinstance(closings, Closing) else [*closings] or [Closing.AUTO]
    if len(listed) > max(len(found), 1):
        raise MeshError(
            f"{len(listed)} closings were given, but the mesh has {len(found)} openings: leave the others out."
        )
    return [*listed, *[listed[-1]] * (len(found) - len(listed))][: len(found)]


def _check_lengths(alpha: float, coarse: float, size: float) -> None:
    if not _FINEST * size <= alpha <= coarse <= size / 4:
        raise MeshError(
            f"alpha {1e3 * alpha:.4g} mm and gap {1e3 * coarse:.4g} mm: alpha must be at least"
            f" {1e3 * _FINEST * size:.3g} mm, the gap at least alpha and at most {1e3 * size / 4:.3g} mm."
        )

"""The outer shell of a probe: closed, outward, one part, and honest about what was invented."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pipeline.mesh.engines import Cancelled
from pipeline.mesh.errors import MeshError, MeshWarning
from pipeline.mesh.probe import Probe
from pipeline.mesh.regions import RegionSet, transfer
from pipeline.mesh.shell.fit import ShellFit, measure_fit
from pipeline.mesh.shell.openings import Opening, find_openings
from pipeline.mesh.shell.patch import Closing, choose, make_patch
from pipeline.mesh.shell.repair import is_sound, repair, turn
from pipeline.mesh.shell.rim import find_lip
from pipeline.mesh.shell.wrap import SURFACE, draw_in, fine_wrap, wrap_soup
from pipeline.mesh.triangles import join

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from pipeline.mesh.regions import RegionReport
    from pipeline.mesh.shell.wrap import Wrapped

# Shares of the size. The coarse alpha is what counts as a gap, about a fingertip's crease; the fine one is the
# size of the shell's facets.
COARSE = 1 / 65
FINE = 1 / 190
_FINEST = 1 / 1000
_NARROWEST = 1.5  # coarse alphas: mouths under this are bridged by the wrap itself

UNCHANGED, REPAIRED, WRAPPED = "unchanged", "repaired", "wrapped"


@dataclass(frozen=True, eq=False)
class ClosedOpening:
    """
    An opening, and what was done about it.

    Attributes
    ----------
    opening : Opening
    closing : Closing
        FAIR, RULED, HULL, or OPEN where it was left as it is.
    """

    opening: Opening
    closing: Closing

    @property
    def sentence(self) -> str:
        """What was done, in words."""
        how = {
            Closing.FAIR: "closed by a fair surface",
            Closing.RULED: "closed by straight lines between its long rims",
            Closing.HULL: "closed by the hull of its rim",
            Closing.OPEN: "left open",
        }[self.closing]
        return f"{self.opening.sentence}: {how}."

    def to_json(self) -> dict[str, Any]:
        """Give the opening as plain values, millimetres."""
        o = self.opening
        return {
            "centre_mm": [round(1e3 * float(x), 3) for x in o.centre],
            "outwards": [round(float(x), 5) for x in o.axes[2]],
            "length_mm": round(1e3 * o.length, 3),
            "width_mm": round(1e3 * o.width, 3),
            "depth_mm": round(1e3 * o.depth, 3),
            "perimeter_mm": round(1e3 * o.perimeter, 3),
            "closing": self.closing.value,
        }


@dataclass(frozen=True, eq=False)
class Shell:
    """
    A probe's outer surface.

    Attributes
    ----------
    probe : Probe
        The shell; ``probe.invented`` marks facets that close openings or bridge gaps. Its regions are those of
        the original.
    how : str
        "unchanged" (the same object as given), "repaired" (vertices as they were) or "wrapped".
    openings : tuple of ClosedOpening
        Largest first.
    fit : ShellFit or None
        How far shell and original lie apart; None where nothing was moved.
    alpha : float or None
        Size of the wrap's facets, metres.
    turned, dropped : int
        Facets turned over or left out by a repair.
    carried : tuple of RegionReport
        What a wrap did to the area of each region.
    """

    probe: Probe
    how: str
    openings: tuple[ClosedOpening, ...]
    fit: ShellFit | None = None
    alpha: float | None = None
    turned: int = 0
    dropped: int = 0
    carried: tuple[RegionReport, ...] = ()

    @property
    def invented_area(self) -> float:
        """Area of the invented facets, m²."""
        return float(self.probe.areas[self.probe.invented].sum())

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was done, in words."""
        out = [_HOW[self.how].format(turned=self.turned, dropped=self.dropped)]
        out += [f"Found {opening.sentence}" for opening in self.openings]
        if self.invented_area > 0:
            share = self.invented_area / self.probe.areas.sum()
            out.append(
                f"{1e6 * self.invented_area:.0f} mm² ({100 * share:.1f} %) of the shell is invented: a touch there"
                " rests on a guess. Measure the part, or ask for its drawing, if it will be touched."
            )
        if self.fit is not None:
            out.append(self.fit.sentence)
        return (*out, *(report.sentence for report in self.carried))

    def to_json(self) -> dict[str, Any]:
        """Give the result as plain values, without the mesh."""
        return {
            "how": self.how,
            "facets": len(self.probe.faces),
            "turned": self.turned,
            "dropped": self.dropped,
            "openings": [opening.to_json() for opening in self.openings],
            "invented_mm2": round(1e6 * self.invented_area, 2),
            "invented_share": round(self.invented_area / float(self.probe.areas.sum()), 6),
            "alpha_mm": None if self.alpha is None else round(1e3 * self.alpha, 4),
            "fit": None if self.fit is None else self.fit.to_json(),
            "regions": [report.to_json() for report in self.carried],
        }


_HOW = {
    UNCHANGED: "The mesh is its own outer shell: nothing was changed.",
    REPAIRED: "Facets turned: {turned}, left out: {dropped}; every vertex is where it was.",
    WRAPPED: "The outside was wrapped in a closed surface; inner walls and parts are gone.",
}


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
        For all openings, or one for each, largest first; AUTO for those that are not listed.
    alpha : float, optional
        Size of the wrap's facets, metres; 1/190 of the size when left out.
    coarse : float, optional
        Gaps narrower than this are bridged, metres; 1/65 of the size when left out.
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
    coarse = COARSE * probe.size if coarse is None else coarse
    alpha = FINE * probe.size if alpha is None else alpha
    _check_lengths(alpha, coarse, probe.size)
    steps = Steps(progress, cancelled)
    mended = _mended(probe)
    reach = _NARROWEST * coarse
    wrap = wrap_soup(probe.vertices, probe.faces, coarse, progress=steps.upto(0.1), cancelled=cancelled)
    found = _at_their_lips(find_openings(*wrap, smallest=reach, tick=steps.upto(0.15)), probe, reach)
    wanted = _wanted(found, closings)
    if mended is not None and all(closing is Closing.OPEN for closing in wanted):
        left = tuple(ClosedOpening(opening, Closing.OPEN) for opening in found)
        return _as_it_was(probe, *mended, left)
    closed = [
        ClosedOpening(opening, choose(opening) if closing is Closing.AUTO else closing)
        for opening, closing in zip(found, wanted, strict=True)
    ]
    return _wrapped(probe, tuple(closed), alpha, coarse, steps)


def _at_their_lips(found: Sequence[Opening], probe: Probe, reach: float) -> list[Opening]:
    lips = [find_lip(opening, probe.vertices, probe.faces, reach) for opening in found]
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
    wrapped = fine_wrap(original, patches, plug, alpha, progress=steps.upto(0.85), cancelled=stop)
    shell = _checked(wrapped, probe.name)
    fit = measure_fit(probe, patches, wrapped, alpha, steps.upto(1.0))
    if not probe.region.any():
        return Shell(shell, WRAPPED, openings, fit, alpha)
    with warnings.catch_warnings():
        # Invented facets have no original near them; a region that vanished is told by its report.
        warnings.simplefilter("ignore", MeshWarning)
        moved = transfer(RegionSet.from_labels(probe.region), probe, shell)
    shell = shell.with_region(moved.regions.labels)
    return Shell(shell, WRAPPED, openings, fit, alpha, carried=moved.report)


def _checked(wrapped: Wrapped, name: str) -> Probe:
    invented = wrapped.rests_on != SURFACE
    shell = Probe.from_arrays(wrapped.vertices, wrapped.faces, invented=invented, name=name, check_size=False)
    if shell.health.sentences:
        raise MeshError(
            "the wrap is not sound (" + " ".join(shell.health.sentences) + ") Try another alpha, or close the"
            " mesh in the CAD program."
        )
    return shell


def _mended(probe: Probe) -> tuple[NDArray[np.int64], NDArray[np.bool_]] | None:
    """Facets to keep and to turn for a sound mesh, or None when that does not do."""
    faces = probe.faces
    if is_sound(probe.vertices, faces):
        return np.arange(len(faces)), np.zeros(len(faces), dtype=bool)
    kept, turned = repair(probe.vertices, faces)
    return (kept, turned) if is_sound(probe.vertices, turn(faces, turned)[kept]) else None


def _as_it_was(
    probe: Probe,
    kept: NDArray[np.int64],
    turned: NDArray[np.bool_],
    openings: tuple[ClosedOpening, ...],
) -> Shell:
    if len(kept) == len(probe.faces) and not turned.any():
        return Shell(probe, UNCHANGED, openings)
    repaired = Probe.from_arrays(
        probe.vertices,
        turn(probe.faces, turned)[kept],
        probe.region[kept],
        invented=probe.invented[kept],
        name=probe.name,
        check_size=False,
    )
    dropped = len(probe.faces) - len(kept)
    return Shell(repaired, REPAIRED, openings, turned=int(turned[kept].sum()), dropped=dropped)


def _wanted(found: Sequence[Opening], closings: Closing | Sequence[Closing]) -> list[Closing]:
    if isinstance(closings, Closing):
        return [closings] * len(found)
    if len(closings) > len(found):
        raise MeshError(
            f"{len(closings)} closings were given, but the mesh has {len(found)} openings: leave the others out."
        )
    return [*closings, *[Closing.AUTO] * (len(found) - len(closings))]


def _check_lengths(alpha: float, coarse: float, size: float) -> None:
    if not _FINEST * size <= alpha <= coarse <= size / 4:
        raise MeshError(
            f"alpha {1e3 * alpha:.4g} mm and gap {1e3 * coarse:.4g} mm: alpha must be at least"
            f" {1e3 * _FINEST * size:.3g} mm, the gap at least alpha and at most {1e3 * size / 4:.3g} mm."
        )

"""The outer shell of a probe: closed, outward, one part, and honest about what was invented."""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from contactbench.pipeline.errors import MeshError, MeshWarning, arg, message
from contactbench.pipeline.kernel import SurfaceIndex, crossings
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Surface
from contactbench.pipeline.mesh.engines import NOBODY, Monitor, Operation, start_engine
from contactbench.pipeline.mesh.probe import LARGEST_M, Probe, degenerate_facets, label_parts
from contactbench.pipeline.mesh.regions.region import RegionSet
from contactbench.pipeline.mesh.regions.transfer import transfer
from contactbench.pipeline.mesh.shell.exposure import exposure
from contactbench.pipeline.mesh.shell.outside import SEAM, SINGLE, Outside, find_outside, on_grid, sew_up
from contactbench.pipeline.mesh.shell.result import (
    APART,
    HULL,
    LEAKS,
    NO_SPACE,
    UNCHANGED,
    UNSOUND,
    WRAPPED,
    ClosedOpening,
    Shell,
)
from contactbench.pipeline.mesh.shell.rim import Closing, Opening, choose, find_lip, find_openings, make_patch
from contactbench.pipeline.mesh.shell.tidy import ROUNDING, without_slivers
from contactbench.pipeline.mesh.shell.wrap import SURFACE, Wrapped, draw_in, fine_wrap, measure_fit, wrap_soup
from contactbench.pipeline.mesh.soundness import CROSSING, OVERLAP, SPECKS, Soundness, check_soundness
from contactbench.pipeline.mesh.triangles import cross_products, first_alike, six_volumes
from contactbench.pipeline.mesh.triangles import join as join_meshes

# Shares of the size. The coarse alpha is what counts as a gap, about a fingertip's crease; the fine one is the
# size of the shell's facets.
COARSE = 1 / 65
FINE = 1 / 190
_FINEST = 1 / 1000
_SPECK = 0.01  # of the largest part's area: what is smaller is not the probe
_MOSTLY = 0.5  # of the area: a shell that is invented to this extent says nothing
_GLANCES, _NIGHT, _MUCH = 4_000, 0.05, 0.01  # facets looked at, light and share of the area of a hollow mesh
_VOID = 0.1  # of the volume: a mouth that leads into less is a groove, and part of the shape
_NO_SPACE = 1e-6  # of the volume of a body with that area, about
_SHEETS = 0.01  # of the area: with more that is a sheet the mesh is no body
_SHEET = 0.25  # coarse alphas: the wrap of a sheet is twice its offset thick, 0.2
_WIDTHS, _MOST_SLIVERS = (1e-2, 1e-1, 1.0, 1.0), 500  # of a seam's
# Degrees; strips that graze a wall cross it in slivers, and others then do not.
_LEANS = ((30.0, 70.0), (45.0,))
_LIP = 0.2  # of the width of a mouth
_NARROWEST = 1.5  # coarse alphas: mouths under this are bridged by the wrap itself


def make_shell(
    probe: Probe,
    closings: str | Sequence[str] = (),
    *,
    alpha: float | None = None,
    coarse: float | None = None,
    monitor: Monitor = NOBODY,
) -> Shell:
    """
    Make the closed surface that a finger could touch, and change as little as that needs.

    A mesh that is closed and sound is given back as it is. Otherwise the shell is the outer hull of its own facets,
    where they enclose a space once bodies are joined and holes, seams, narrow gaps and mouths closed; and where they
    do not, a wrap all round.

    Parameters
    ----------
    probe : Probe
        Any frame.
    closings : Closing or sequence of Closing, or their values
        For all openings, or one for each, largest first; the last one counts for those that are not listed. None
        given: those of a mesh that is closed but for seams, or of a tube, belong to its shape and stay, and others are
        closed as AUTO does.
    alpha : float, optional
        Size of the wrap's facets, metres; 1/190 of the size when left out.
    coarse : float, optional
        Gaps narrower than this are bridged, metres; 1/65 of the size when left out, or `alpha` if that is more.
    monitor : Monitor

    Returns
    -------
    Shell

    Raises
    ------
    MeshError
        A length that makes no sense, an opening that cannot be closed, or a result that is not closed.
    EngineError
        pymeshlab or libigl is missing or failed.
    Cancelled
    """
    alpha = FINE * probe.size if alpha is None else alpha
    coarse = max(COARSE * probe.size, alpha) if coarse is None else coarse
    _check_lengths(alpha, coarse, probe.size)
    steps = monitor.part()
    listed = [Closing(each) for each in ([closings] if isinstance(closings, str) else closings)]
    exact = _Exact(probe, alpha, coarse, steps)
    keeps = not listed and (probe.health.watertight or exact.complete)
    if keeps and (shell := exact.closed_already()) is not None:
        return shell
    start_engine(Operation.ALPHA_WRAP)  # needed whatever is found
    steps.upto(0.2)
    outside = exact.outside
    base = (probe.vertices, probe.faces) if outside is None else (outside.vertices, outside.faces)
    wrap = wrap_soup(*base, coarse, monitor=steps.upto(0.3))
    if outside is None:
        _refuse_sheet(wrap, coarse)
    else:
        outside = exact.bridged(outside, wrap)
    found = _openings(base, wrap, coarse, steps.upto(0.35).tell)
    if outside is not None:
        found = _mouths(found, (outside.vertices, outside.faces))
    wanted = _wanted(found, listed or [Closing.OPEN if keeps or _is_tube(outside, found) else Closing.AUTO])
    # Mouths that cannot be closed stay open, unless somebody asked: better than a wrap of all.
    opened = [ClosedOpening(opening, Closing.OPEN) for opening in found]
    closed = [
        left
        if left.opening.crosses_itself and not listed
        else ClosedOpening(left.opening, choose(left.opening) if closing is Closing.AUTO else closing)
        for left, closing in zip(opened, wanted, strict=True)
    ]
    why = NO_SPACE
    if outside is not None:
        for tried in [closed] if listed else [closed, opened]:
            shell = exact.closed(outside, tried, narrow=not (found or keeps or Closing.OPEN in listed))
            why = LEAKS
            if shell is not None:
                steps.upto(1.0)
                shell = _mended(shell, probe)
                if not shell.faults and _bodies(shell.probe.vertices, shell.probe.faces) == 1:
                    return shell
                why = UNSOUND if shell.faults else APART
    specks = _beside(probe, wrap)
    whole = _some_facets(probe, np.flatnonzero(~specks))
    return replace(_wrapped(whole, tuple(closed), alpha, coarse, steps), dropped=int(specks.sum()), why=why)


class _Exact:
    """A shell of the mesh's own facets: what is invented only closes its holes, gaps and mouths."""

    def __init__(self, probe: Probe, alpha: float, coarse: float, steps: Monitor) -> None:
        self._probe, self._alpha, self._coarse, self._steps = probe, alpha, coarse, steps
        self._bridged = 0  # bodies
        self._rewrapped = 0.0  # metres
        self._sewn = sew_up(
            self._probe.vertices, self._probe.faces, smallest=_NARROWEST * coarse, spacing=alpha
        )

    @cached_property
    def outside(self) -> Outside | None:
        """The closed outside; None where there is none."""
        sewn = self._sewn
        found = None if sewn.frayed else self._find()
        grid = SINGLE if found is None else _grid(found)
        if grid and not sewn.frayed:
            cut, self._sewn = self._sewn, replace(sewn, vertices=on_grid(sewn.vertices, grid))
            joined = self._find()
            if joined and (found is None or _bodies(joined.vertices, joined.faces) == 1):
                return joined
            self._sewn = cut
        for alpha in (self._alpha, self._coarse):
            if found is None and (tried := sewn.rewrapped(alpha, monitor=self._steps)):
                sewn = self._sewn = tried
                self._rewrapped = alpha
                found = self._find()
        return found

    @property
    def complete(self) -> bool:
        """Whether the mesh is closed bodies, or all of its facets and no others are its outside once seams are sewn."""
        done = self.outside
        if done is None or done.sheets or (done.inner and not done.bodies):
            return False
        return bool((done.born >= 0).all())

    def _find(self, added: Sequence[Surface] = ()) -> Outside | None:
        """Find the closed outside, with surfaces added that close mouths; None where there is none."""
        cut = self._sewn.with_added(added).cut(monitor=self._steps)
        found = find_outside(cut)
        if found is not None and not added:  # what is added later meets these: the others are not cut again
            self._sewn = found[1]
        return None if found is None else found[0]

    def closed_already(self) -> Shell | None:
        """Leave a closed mesh as it is, or join its bodies; None where that does not give one sound body."""
        probe = self._probe
        # A sliver may have an area where the file has it, but none after `--place`.
        flat = degenerate_facets(probe.vertices, probe.faces, reach=2 * LARGEST_M).any()
        one = not flat and _bodies(probe.vertices, probe.faces) == 1
        shell = _examined(Shell(probe, UNCHANGED, ()), probe) if one else None
        self._steps.upto(0.2)
        done = self.outside if shell is None or shell.faults else None
        if done is not None and _bodies(done.vertices, done.faces) == 1:
            shell = self._shell(done, ())
            shell = None if shell is None else _mended(shell, probe)
        if shell is None or shell.faults or _bodies(shell.probe.vertices, shell.probe.faces) > 1:
            return None
        found = find_mouths((shell.probe.vertices, shell.probe.faces), self._steps, self._coarse)
        return replace(shell, openings=tuple(ClosedOpening(each, Closing.OPEN) for each in found))

    def bridged(self, outside: Outside, wrap: Surface) -> Outside:
        """Fill the gaps between bodies that the wrap round them holds together; the same where that is not one body."""
        sewn, apart, held = self._sewn, _bodies(outside.vertices, outside.faces), _bodies(*wrap)
        if apart == held:
            return outside
        self._sewn = sewn.with_added([draw_in(wrap, self._coarse)])
        tried = self._find()
        if tried is None or _crosses(tried) or _bodies(tried.vertices, tried.faces) != held:
            self._sewn = sewn
            return outside
        self._bridged = apart
        return tried

    def closed(self, outside: Outside, closings: Sequence[ClosedOpening], *, narrow: bool) -> Shell | None:
        """
        Close the mouths, where there are some; None where what closes them leaks.

        Where there is no opening at all, `narrow`, a cavity can only lie behind gaps too narrow to find.
        """
        self._steps.upto(0.6)
        done: Outside | None = outside
        if any(each.closing is not Closing.OPEN for each in closings):
            done = self._emptied(outside, closings)
        self._steps.upto(0.8)
        # Behind gaps and bores too narrow to find a mouth of.
        if narrow and done is not None and _has_cavity(done.vertices, done.faces, self._coarse):
            done = self._with_plug(outside, ()) or done
        return None if done is None else self._shell(done, tuple(closings))

    def _emptied(self, outside: Outside, closings: Sequence[ClosedOpening]) -> Outside | None:
        """Close mouths, so that much of the space is inside; None where the patches leak."""
        for leans in _LEANS:
            patches = [
                make_patch(each.opening, each.closing, self._alpha, self._coarse, leans)
                for each in closings
                if each.closing is not Closing.OPEN
            ]
            tried = self._find(patches)
            grown = tried is not None and _has_grown(tried, outside)
            if tried is not None and grown and not _crosses(tried):
                return tried
            if tried is not None and not grown:
                break
        return self._with_plug(outside, patches)

    def _with_plug(self, outside: Outside, patches: Sequence[Surface]) -> Outside | None:
        """Do the same with a lining under the surface, at which what leaks through cracks and bores ends."""
        vertices, faces = join_meshes([(outside.vertices, outside.faces), *patches])
        wrap = wrap_soup(vertices, faces, self._coarse, monitor=self._steps)
        tried = self._find([*patches, draw_in(wrap, self._coarse)])
        return tried if tried is not None and _has_grown(tried, outside) else None

    def _shell(self, done: Outside, openings: tuple[ClosedOpening, ...]) -> Shell | None:
        """Make the shell; None where cutting left facets without area that cannot be joined."""
        probe = self._probe
        # Cutting leaves slivers that have an area where the file has them, but none after `--place`.
        flat = np.flatnonzero(degenerate_facets(done.vertices, done.faces, reach=2 * LARGEST_M))
        if len(flat):
            faces, of = without_slivers(done.vertices, done.faces, flat, _WIDTHS[-1] * SEAM * probe.size)
            if degenerate_facets(done.vertices, faces).any():
                return None
            done = replace(done, faces=faces, born=done.born[of])
        own = done.born >= 0
        as_it_was = probe.vertices[probe.faces]
        alike = own.all() and not done.parted and np.array_equal(done.vertices[done.faces], as_it_was)
        if alike:
            return Shell(probe, UNCHANGED, openings)
        new = Probe.from_arrays(
            done.vertices,
            done.faces,
            np.where(own, probe.region[done.born], 0),
            invented=np.where(own, probe.invented[done.born], True),
            name=probe.name,
            check_size=False,
            untouchable=probe.untouchable,
        )
        closed = tuple(ClosedOpening(hole, choose(hole)) for hole in done.holes)
        return Shell(
            new,
            HULL,
            (*closed, *openings),
            turned=done.turned,
            dropped=done.inner,
            cut=done.cut,
            sheets=done.sheets,
            small_holes=done.small_holes,
            parted=done.parted,
            gap=self._coarse,
            why=self._why(done),
        )

    def _why(self, done: Outside) -> str:
        """Say how bodies became one or what was torn was closed; empty where that was not needed."""
        if self._rewrapped:
            width = 1e3 * self._rewrapped
            return message(
                f"Wrapped at {arg(width):.2g} mm where the surface is torn; the rest keeps its own facets."
            )
        if self._bridged:
            gap = 1e3 * self._coarse
            return message(f"Bridged: {arg(self._bridged)} bodies, over gaps of less than {arg(gap):.2g} mm.")
        if done is not self.outside or not done.bodies:
            return ""
        return message(
            f"Joined exactly: {arg(done.bodies)} closed bodies that overlap, touch or lie in each other."
        )


def find_mouths(surface: Surface, steps: Monitor, coarse: float | None = None) -> list[Opening]:
    """
    Find the openings that lead into a hollow of a closed surface, largest first.

    Parameters
    ----------
    surface : (vertices, faces)
        Metres.
    steps : Monitor
    coarse : float, optional
        What counts as a gap, metres; as for `make_shell`.

    Raises
    ------
    EngineError
        pymeshlab is missing or failed; asked only where the surface is hollow.
    Cancelled
    """
    coarse = coarse or COARSE * float(np.ptp(surface[0], axis=0).max())
    if not _has_cavity(*surface, coarse):
        return []
    wrap = wrap_soup(*surface, coarse, monitor=steps.upto(0.7))
    return _mouths(_openings(surface, wrap, coarse, steps.upto(1.0).tell), surface)


def _openings(surface: Surface, wrap: Surface, coarse: float, tick: Callable[[float], None]) -> list[Opening]:
    reach = _NARROWEST * coarse
    # The darkness of a cavity begins the deeper below its lip the wider the mouth is.
    lips = [
        find_lip(opening, *surface, max(reach, _LIP * opening.width))
        for opening in find_openings(*wrap, smallest=reach, tick=tick)
    ]
    return sorted((lip for lip in lips if not lip.is_dent), key=lambda lip: -lip.area)


def _wrapped(
    probe: Probe, openings: tuple[ClosedOpening, ...], alpha: float, coarse: float, steps: Monitor
) -> Shell:
    patches = [
        make_patch(each.opening, each.closing, alpha) for each in openings if each.closing is not Closing.OPEN
    ]
    steps.upto(0.2)
    vertices, faces = join_meshes([(probe.vertices, probe.faces), *patches])
    plug = draw_in(wrap_soup(vertices, faces, coarse, monitor=steps.upto(0.3)), coarse)
    surface = (probe.vertices, probe.faces)
    wrapped = fine_wrap(surface, probe.invented, patches, plug, alpha, monitor=steps.upto(0.85))
    shell = _checked(wrapped, probe.name)
    fit = measure_fit(probe, patches, wrapped, steps.upto(1.0).tell)
    done = _examined(Shell(shell, WRAPPED, openings, fit, alpha, gap=coarse), probe, patches)
    if not probe.region.any():
        return done
    with warnings.catch_warnings():
        # Invented facets have no original near them; a region that vanished is told by its report.
        warnings.simplefilter("ignore", MeshWarning)
        moved = transfer(RegionSet.from_labels(probe.region), probe, shell)
    carried = moved.regions.mesh(shell).with_region(moved.regions.labels, probe.untouchable)
    return replace(done, probe=carried, carried=moved.report)


def _checked(wrapped: Wrapped, name: str) -> Probe:
    invented = wrapped.rests_on != SURFACE
    shell = Probe.from_arrays(wrapped.vertices, wrapped.faces, invented=invented, name=name, check_size=False)
    if shell.areas[invented].sum() > _MOSTLY * shell.areas.sum():
        raise MeshError(
            "more than half of the shell would be invented: the mesh is a sheet without thickness, or a small part of"
            " a probe. Export the whole part as a solid."
        )
    return shell


def _refuse_sheet(wrap: Surface, coarse: float) -> None:
    vertices, faces = wrap
    cross = cross_products(vertices, faces)
    areas = np.linalg.norm(cross, axis=1)
    inwards = -cross / areas[:, None]
    thickness, _ = SurfaceIndex(vertices, faces).first_hit(
        vertices[faces].mean(axis=1) + 1e-3 * coarse * inwards, inwards
    )
    share = areas[thickness < _SHEET * coarse].sum() / areas.sum()
    if share > _SHEETS:
        raise MeshError(
            f"{arg(100 * share):.0f} % of the surface is a sheet without thickness, which has no inside. Export the"
            " whole part as a solid, or delete the sheet in the CAD program."
        )


def _beside(probe: Probe, wrap: Surface) -> Mask:
    """
    Mark the facets of specks that stand beside the part, (m,).

    Raises
    ------
    MeshError
        There are several large parts.
    """
    vertices, faces = wrap
    label, areas, _ = _labelled(vertices, faces)
    if len(areas) == 1:
        return np.zeros(len(probe.faces), dtype=bool)
    large = areas > _SPECK * areas.max()
    if np.count_nonzero(large) > 1:
        one, two = (vertices[faces[label == part]].mean(axis=(0, 1)) for part in np.argsort(-areas)[:2])
        raise MeshError(
            f"the mesh has {arg(np.count_nonzero(large))} parts that do not touch; the middles of two"
            f" of them are {arg(1e3 * np.linalg.norm(one - two)):.4g} mm apart. Delete everything that"
            " is not the probe in the CAD program, or bridge the gap with a larger value (gap)."
        )
    _, nearest, _ = SurfaceIndex(vertices, faces).closest(probe.vertices[probe.faces].mean(axis=1))
    return np.asarray(~large[label[nearest]])


def _specks(probe: Probe) -> Mask:
    """Mark the facets of parts that are too small to be the probe, or enclose no space, (m,)."""
    label, areas, empty = _labelled(probe.vertices, probe.faces)
    return np.asarray((empty | (areas < _SPECK * areas.max()))[label])


def _bodies(vertices: Floats, faces: Ints) -> int:
    """Count the parts that enclose space."""
    return int(np.count_nonzero(~_labelled(vertices, faces)[2]))


def _grid(outside: Outside) -> float | None:
    """Tell on which grid, a share of the size, what rounding alone keeps apart, as at 0 and -1e-17, becomes one."""
    merged = first_alike(outside.vertices)[outside.faces].astype(np.int32)
    label = label_parts(merged, len(outside.vertices))
    pairs, _, _, complete = crossings(on_grid(outside.vertices, ROUNDING), outside.faces)
    if not complete or np.ptp(label[pairs], axis=1).any():
        return ROUNDING
    # Walls of one part that lie on each other end in slivers that fold.
    folds = check_soundness(outside.vertices, outside.faces).folded_share > SPECKS
    return SINGLE if folds else None


def _labelled(vertices: Floats, faces: Ints) -> tuple[Longs, Floats, Mask]:
    """Label the parts, (m,), with the area of each, and whether it encloses no space: facets that lie on each other."""
    label = label_parts(faces, len(vertices))
    areas = np.bincount(label, np.linalg.norm(cross_products(vertices, faces), axis=1)).astype(np.float64) / 2
    return label, areas, six_volumes(vertices, faces, label) < _NO_SPACE * areas**1.5


def _mended(shell: Shell, base: Probe) -> Shell:
    """Leave specks out, and join the slivers that fold."""
    specks = _specks(shell.probe)
    if specks.any():
        rest = _some_facets(shell.probe, np.flatnonzero(~specks))
        shell = replace(shell, probe=rest, how=HULL, dropped=shell.dropped + int(specks.sum()))
    return _tidied(_examined(shell, base), base)


def _tidied(shell: Shell, base: Probe) -> Shell:
    """Join the slivers that fold or lie on each other: cutting leaves some, of which rounding decides the normal."""
    for width in _WIDTHS:  # the wider what is joined, the likelier it meets something
        found, made = shell.soundness, shell.probe
        if found is None or not found.health.watertight:
            break
        slivers = _faulty(found)
        if not 0 < len(slivers) <= _MOST_SLIVERS:
            break
        faces, of = without_slivers(made.vertices, made.faces, slivers, width * SEAM * made.size)
        if np.array_equal(faces, made.faces):
            continue
        tidied = _examined(replace(shell, probe=_some_facets(made, of, faces), how=HULL), base)
        if tidied.soundness is not None and len(_faulty(tidied.soundness)) < len(slivers):
            shell = tidied
    return shell


def _faulty(found: Soundness) -> Longs:
    """Facets that cross others, lie on them, are folded or have no area, ascending."""
    return np.unique(
        np.concatenate((found.facets_of(CROSSING, OVERLAP), found.folded_facets, found.flat_facets))
    )


def _some_facets(probe: Probe, kept: Longs, faces: Ints | None = None) -> Probe:
    """Give a probe some of its facets only, or `faces` in their place, with what is known of them."""
    return Probe.from_arrays(
        probe.vertices,
        probe.faces[kept] if faces is None else faces,
        probe.region[kept],
        invented=probe.invented[kept],
        name=probe.name,
        check_size=False,
        untouchable=probe.untouchable,
    )


def _examined(shell: Shell, base: Probe, patches: Sequence[Surface] = ()) -> Shell:
    """Look at a shell as if it came from a stranger, and compare it with what it was made of."""
    original = None if shell.how == UNCHANGED else join_meshes([(base.vertices, base.faces), *patches])
    made = shell.probe
    found = check_soundness(made.vertices, made.faces, original, invented=made.invented)
    return replace(shell, soundness=found)


def _mouths(found: Sequence[Opening], surface: Surface) -> list[Opening]:
    """Keep the openings that much space lies behind: grooves, slots and dents are part of the shape."""
    whole = _volume(*surface)
    behind = [opening.area * opening.depth for opening in found]
    return [opening for opening, space in zip(found, behind, strict=True) if space > _VOID * (whole + space)]


def _is_tube(outside: Outside | None, found: Sequence[Opening]) -> bool:
    """Tell whether one looks through it from either end: through a housing one sees a hole at most."""
    if outside is None:
        return False
    index = SurfaceIndex(outside.vertices, outside.faces)
    return all(_seen_through(opening, index) > _MOSTLY for opening in found)


def _seen_through(opening: Opening, index: SurfaceIndex) -> float:
    """Tell through which share of a mouth light comes straight from the other side, 0 to 1."""
    shares = np.array([0.2, 0.5, 0.8])[:, None, None]
    points = (
        opening.centre + shares * (opening.rim[:: max(1, len(opening.rim) // 24)] - opening.centre)
    ).reshape(-1, 3)
    return float(np.mean(index.escapes(points, np.tile(-opening.axes[2], (len(points), 1)))))


def _crosses(surface: Outside) -> bool:
    counts = crossings(surface.vertices, surface.faces)[2]
    return bool(counts[[CROSSING, OVERLAP]].any())


def _has_grown(surface: Outside, before: Outside) -> bool:
    """Tell whether a cavity is inside now."""
    return _volume(surface.vertices, surface.faces) > (1 + _VOID) * _volume(before.vertices, before.faces)


def _volume(vertices: Floats, faces: Ints) -> float:
    return float(six_volumes(vertices, faces, np.zeros(len(faces), dtype=np.int64))[0]) / 6


def _has_cavity(vertices: Floats, faces: Ints, gap: float) -> bool:
    """Tell whether much of the surface sees next to no light, but much space and a wall far opposite: no groove."""
    cross = cross_products(vertices, faces)
    areas = np.linalg.norm(cross, axis=1)
    pick = np.random.default_rng(0).choice(len(faces), _GLANCES, p=areas / areas.sum())
    index = SurfaceIndex(vertices, faces)
    dark = pick[exposure(vertices, faces[pick], index, count=64) < _NIGHT]
    if len(dark) < _MUCH * _GLANCES:
        return False
    normals = cross[dark] / areas[dark, None]
    opposite, _ = index.first_hit(vertices[faces[dark]].mean(axis=1) + 1e-3 * gap * normals, normals)
    far = float(np.median(opposite))
    space = len(dark) / _GLANCES * areas.sum() / 2 * far / 2  # between walls: each of two has it before it
    return far > 2 * gap and space > _VOID * _volume(vertices, faces)


def _wanted(found: Sequence[Opening], listed: Sequence[Closing]) -> list[Closing]:
    if len(listed) > max(len(found), 1):
        raise MeshError(
            f"{arg(len(listed))} closings were given, but the mesh has {arg(len(found))} openings: leave out the rest."
        )
    return [*listed, *[listed[-1]] * (len(found) - len(listed))][: len(found)]


def _check_lengths(alpha: float, coarse: float, size: float) -> None:
    if not _FINEST * size <= alpha <= coarse <= size / 4:
        raise MeshError(
            f"alpha {arg(1e3 * alpha):.4g} mm and gap {arg(1e3 * coarse):.4g} mm: alpha must be at least"
            f" {arg(1e3 * _FINEST * size):.3g} mm, the gap at least alpha and at most {arg(1e3 * size / 4):.3g} mm."
        )

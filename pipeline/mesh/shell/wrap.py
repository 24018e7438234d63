"""
Wrap a broken, hollow surface in a closed one that follows its outside.

One wrap is not enough: a fine one creeps through every seam and lines the inside, a coarse one loses the
shape. So a coarse wrap, drawn in by more than its own thickness, is put inside as a plug, and the fine wrap is
made of surface, patches and plug together: what leaks through a seam ends at once.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Unpack

import numpy as np
import scipy
from numpy.typing import NDArray

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Surface
from contactbench.pipeline.mesh.engines import NOBODY, Control, Monitor, alpha_wrap
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.shell.exposure import LIFT, exposure_at
from contactbench.pipeline.mesh.soundness import CROSSING, OVERLAP, TOUCHING, check_soundness
from contactbench.pipeline.mesh.triangles import cross_products, join, vertex_normals

# CGAL's wrap advises an offset well below alpha.
OFFSET = 0.1
# How deep the plug lies under the coarse wrap, in its alphas: the offset, and more than the wrap's sag.
_DRAWN_IN = OFFSET + 0.3
_SHORT_OF = OFFSET + 0.05
_PUT_BACK = 8
_MARGIN = 3.0  # alphas: so far round what is torn a wrap reaches
_MUCH = 0.25  # of the area

_FOLLOWS = 0.25  # of the wrap's facets: what is further from the surface does not follow it, but was made up

SURFACE, PATCH, PLUG = 0, 1, 2


@dataclass(frozen=True, eq=False)
class Wrapped:
    """
    A closed surface, and what each of its facets rests on.

    Attributes
    ----------
    vertices : (n, 3) float64
        Metres.
    faces : (m, 3) int32
        Outward.
    rests_on : (m,) int8
        SURFACE, PATCH or PLUG.
    held_back : int
        Vertices that kept a part of the offset, because a facet would have folded.
    """

    vertices: Floats
    faces: Ints
    rests_on: NDArray[np.int8]
    held_back: int


def wrap_soup(vertices: Floats, faces: Ints, alpha: float, **control: Unpack[Control]) -> Surface:
    """
    Wrap a surface; gaps narrower than `alpha` (metres) are bridged.

    Each facet gets corners of its own: pymeshlab hands CGAL a connected surface, and silently leaves out
    facets that are turned over or are the third at an edge (test_a_wrap_sees_every_facet).
    """
    soup = vertices[faces].reshape(-1, 3)
    alone = np.arange(len(soup), dtype=np.int32).reshape(-1, 3)
    return alpha_wrap(soup, alone, alpha, OFFSET * alpha, **control)


def wrap_round(
    vertices: Floats, faces: Ints, lids: Mask, edges: Longs, alpha: float, **control: Unpack[Control]
) -> tuple[Surface, Mask] | None:
    """
    Wrap the surface near some edges, (k, 2): what is torn there vanishes in it, and what is whole leads into it.

    Gives the wrap and the facets, (m,), that lie deep in it, or are lids that begin there; None where that is much of
    the surface.
    """
    import pyvista as pv

    fine = pv.PolyData.from_regular_faces(vertices, faces).subdivide_adaptive(max_edge_len=alpha)
    points, pieces = np.asarray(fine.points, dtype=np.float64), fine.regular_faces
    start, along = vertices[edges[:, 0]], vertices[edges[:, 1]] - vertices[edges[:, 0]]
    steps = np.linspace(0, 1, 2 + int(np.linalg.norm(along, axis=1).max() / alpha))
    torn = scipy.spatial.cKDTree((start + steps[:, None, None] * along).reshape(-1, 3))
    near = torn.query(points[pieces].mean(axis=1))[0] < _MARGIN * alpha
    areas = np.linalg.norm(cross_products(points, pieces), axis=1)
    if areas[near].sum() > _MUCH * areas.sum():
        return None
    corners = vertices[faces]
    small = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1) < _MARGIN * alpha
    inside: Mask = np.asarray(torn.query(vertices)[0] < (_MARGIN - 1) * alpha)[faces]
    deep = np.where(lids, inside.any(axis=1), small & inside.all(axis=1))
    return wrap_soup(points, pieces[near], alpha, **control), deep


def draw_in(wrap: Surface, alpha: float) -> Surface:
    """
    Move a coarse wrap inwards, to where it hides under the surface that it was wrapped round.

    In a thin wall it stops short of the other side, so as not to come out there.
    """
    vertices, faces = wrap
    inwards = -vertex_normals(cross_products(vertices, faces), faces, len(vertices))
    thickness, _ = SurfaceIndex(vertices, faces).first_hit(vertices + 1e-3 * alpha * inwards, inwards)
    depth = np.clip(thickness - _SHORT_OF * alpha, 0.0, _DRAWN_IN * alpha)
    return vertices + depth[:, None] * inwards, faces


def fine_wrap(
    surface: Surface,
    invented: Mask,
    patches: list[Surface],
    plug: Surface,
    alpha: float,
    **control: Unpack[Control],
) -> Wrapped:
    """
    Wrap surface, patches and plug, and lay the result on them.

    Parameters
    ----------
    surface, plug : (vertices, faces)
        Metres.
    invented : (m,) bool
        Facets of the surface that were patches once.
    patches : list of (vertices, faces)
    alpha : float
        Metres; the facets of the result are of about this size.
    **control
        Monitor and time limit of `engines.child.run`.
    """
    layers = [surface, *patches, plug]
    vertices, faces = join(layers)
    of_surface = np.where(invented, PATCH, SURFACE)
    of_others = np.repeat([*[PATCH] * len(patches), PLUG], [len(each[1]) for each in layers[1:]])
    kind = np.concatenate((of_surface, of_others)).astype(np.int8)
    wrap, wrap_faces = wrap_soup(vertices, faces, alpha, **control)
    index = SurfaceIndex(vertices, faces)
    settled, share = settle(wrap, wrap_faces, index.closest(wrap)[2])
    before = kind[index.closest(settled[wrap_faces].mean(axis=1))[1]] != SURFACE
    monitor = control.get("monitor", NOBODY)
    settled, share = _mended(wrap, settled, wrap_faces, share, join(layers[:-1]), before, monitor)
    distance, nearest, _ = index.closest(settled[wrap_faces].mean(axis=1))
    rests_on = np.where(distance > _FOLLOWS * alpha, np.int8(PLUG), kind[nearest])
    return Wrapped(settled, wrap_faces, rests_on, int(np.count_nonzero(share < 1)))


def _mended(
    wrap: Floats,
    settled: Floats,
    faces: Ints,
    share: Floats,
    original: Surface,
    invented: Mask,
    monitor: Monitor = NOBODY,
) -> tuple[Floats, Floats]:
    """
    Put back the corners of facets that cross others, and even out what stands across the surface.

    The wrap crosses itself nowhere, so its own positions end every crossing. But where it fills a groove to some
    depth only, a single facet of its own may end the filling like a step
    (test_a_step_in_a_groove_is_evened_out).
    """
    ends = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    neighbours = scipy.sparse.csr_array((np.ones(faces.size), ends), shape=(len(wrap), len(wrap)))
    degree: Floats = np.asarray(neighbours.sum(axis=1))
    for attempt in range(_PUT_BACK + 1):
        monitor.check()
        found = check_soundness(settled, faces, original, invented=invented)
        crossing = found.facets_of(CROSSING, OVERLAP, TOUCHING)
        if len(crossing) + len(found.folded_facets) == 0 or attempt == _PUT_BACK:
            break
        # A corner that is moved may make its neighbours cross or fold, so the later the wider.
        back, steep = (_around(facets, faces, attempt // 2) for facets in (crossing, found.folded_facets))
        middles = np.asarray(neighbours[steep] @ settled) / degree[steep, None]
        settled[steep] = (settled[steep] + middles) / 2
        settled[back] = wrap[back]
        share[back] = share[steep] = 0.0
    return settled, share


def _around(facets: Longs, faces: Ints, rings: int) -> Ints:
    """Vertices of facets, and of so many rings of facets around them."""
    corners = np.unique(faces[facets])
    for _ in range(rings):
        corners = np.unique(faces[np.isin(faces, corners).any(axis=1)])
    return corners


# ---- take a wrap's offset off again --------------------------------------------------------------


# A facet that turns further than this, or shrinks more, has folded: its corners stop short.
_LEAST_COSINE = 0.5
_LEAST_AREA = 0.02
_ROUNDS = 8


def settle(vertices: Floats, faces: Ints, targets: Floats) -> tuple[Floats, Floats]:
    """
    Move vertices to their targets, as far as no facet folds or loses its area.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
    targets : (n, 3) float64
        Where each vertex should go: nearest points of another surface.

    Returns
    -------
    vertices : (n, 3) float64
    share : (n,) float64
        Of the way that each vertex went: 1 nearly everywhere.
    """
    before = cross_products(vertices, faces)
    area = np.linalg.norm(before, axis=1)
    share = np.ones(len(vertices))
    for attempt in range(_ROUNDS + 1):
        moved = vertices + share[:, None] * (targets - vertices)
        if attempt == _ROUNDS:  # what folded last time stands where it was, and cannot fold
            break
        after = cross_products(moved, faces)
        size = np.linalg.norm(after, axis=1)
        upright = np.einsum("ij,ij->i", before, after) > _LEAST_COSINE * area * size
        bad = np.unique(faces[~(upright & (size > _LEAST_AREA * area))])
        if len(bad) == 0:
            break
        share[bad] = 0.0 if attempt == _ROUNDS - 1 else share[bad] / 2
    return moved, share


# ---- how well a shell fits what can be seen of the original --------------------------------------


# What sees less of the sky than this lies in a groove that no finger enters.
_VISIBLE = 0.2
_LOOKS = 64
_SAMPLES = 20_000


@dataclass(frozen=True)
class ShellFit:
    """
    Distances between a shell and the original, metres.

    Attributes
    ----------
    visible_median, visible_p95, visible_max : float
        From points of the original that can be seen from outside to the shell.
    shell_p95, shell_max : float
        From the shell, but for its invented facets, to the original.
    held_back : int
        Vertices that stayed a little outside, because a facet would have folded.
    bridged_area : float
        Of facets over gaps too narrow to enter, m².
    """

    visible_median: float
    visible_p95: float
    visible_max: float
    shell_p95: float
    shell_max: float
    held_back: int
    bridged_area: float

    @property
    def sentence(self) -> str:
        """The fit in words."""
        return message(
            "Distance from the visible outside of the original to the shell: median"
            f" {arg(1e3 * self.visible_median):.3f} mm, 95 % below {arg(1e3 * self.visible_p95):.3f} mm, at"
            f" most {arg(1e3 * self.visible_max):.2f} mm."
        )

    def to_json(self) -> dict[str, Any]:
        """Give the figures as plain values, millimetres."""
        lengths = ("visible_median", "visible_p95", "visible_max", "shell_p95", "shell_max")
        return {
            **{f"{name}_mm": round(1e3 * getattr(self, name), 5) for name in lengths},
            "held_back": self.held_back,
            "bridged_mm2": round(1e6 * self.bridged_area, 3),
        }


def measure_fit(
    original: Probe, patches: list[Surface], wrapped: Wrapped, tick: Callable[[float], None]
) -> ShellFit:
    """
    Measure a shell against the original.

    Parameters
    ----------
    original : Probe
    patches : list of (vertices, faces)
        What closes its openings: they hide the inside.
    wrapped : Wrapped
    tick : callable
        Told the share that is done; may raise to stop.
    """
    closed = SurfaceIndex(*join([(original.vertices, original.faces), *patches]))
    points = _visible_points(original, closed, tick)
    shell = SurfaceIndex(wrapped.vertices, wrapped.faces)
    there, _, _ = shell.closest(points)
    real = wrapped.faces[wrapped.rests_on == SURFACE]
    back, _, _ = closed.closest(draw_points(wrapped.vertices, real, _SAMPLES, np.random.default_rng(0))[0])
    areas = np.linalg.norm(cross_products(wrapped.vertices, wrapped.faces), axis=1) / 2
    median, p95, most = np.percentile(there, [50, 95, 100]).tolist()
    return ShellFit(
        visible_median=median,
        visible_p95=p95,
        visible_max=most,
        shell_p95=float(np.percentile(back, 95)),
        shell_max=float(back.max()),
        held_back=wrapped.held_back,
        bridged_area=float(areas[wrapped.rests_on == PLUG].sum()),
    )


def draw_points(vertices: Floats, faces: Ints, count: int, rng: np.random.Generator) -> tuple[Floats, Longs]:
    """Draw `count` points evenly over the facets, (count, 3), and say which facet each is on, (count,)."""
    areas = np.linalg.norm(cross_products(vertices, faces), axis=1)
    facets = rng.choice(len(faces), count, p=areas / areas.sum())
    pick = faces[facets]
    u, v = rng.random((2, count, 1))
    over = u + v > 1
    u, v = np.where(over, 1 - u, u), np.where(over, 1 - v, v)
    a, b, c = (vertices[pick[:, corner]] for corner in range(3))
    return np.asarray(a + u * (b - a) + v * (c - a)), facets


def _visible_points(original: Probe, closed: SurfaceIndex, tick: Callable[[float], None]) -> Floats:
    """Draw points of the original that can be seen, from whichever side."""
    points, facets = draw_points(original.vertices, original.faces, _SAMPLES, np.random.default_rng(0))
    normals = original.normals[facets]
    light = [
        exposure_at(points, side, closed, LIFT * original.size, count=_LOOKS, tick=tick)
        for side in (normals, -normals)
    ]
    visible = np.maximum(*light) > _VISIBLE
    return points[visible] if visible.any() else points

"""How well a shell fits what can be seen of the original."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh.engines import Cancelled
from contactbench.pipeline.mesh.shell.exposure import exposure, exposure_at
from contactbench.pipeline.mesh.shell.wrap import PLUG, SURFACE
from contactbench.pipeline.mesh.triangles import cross_products, directions, join

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.mesh.probe import Probe
    from contactbench.pipeline.mesh.shell.wrap import Wrapped

# What sees less of the sky than this lies in a groove that no finger enters.
_VISIBLE = 0.2
_LOOKS = 64
_SAMPLES = 20_000
_LINES = 60_000


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
    inner_hits : int
        Of `lines` half-lines from all round outside, those that land on what was an inner wall. 0 on a good shell.
    lines : int
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
    inner_hits: int
    lines: int
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
            "inner_hits": self.inner_hits,
            "lines": self.lines,
            "held_back": self.held_back,
            "bridged_mm2": round(1e6 * self.bridged_area, 3),
        }


@dataclass(frozen=True, eq=False)
class Original:
    """
    What a shell is measured against.

    Attributes
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
        The original's, and then those of the patches that close it.
    index : SurfaceIndex
        Of all of them.
    seen : (k,) float64
        How much of the sky each facet of the original sees.
    points : (l, 3) float64
        Of the original, that can be seen.
    rng : Generator
        What they were drawn with, for what is drawn next.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]
    index: SurfaceIndex
    seen: NDArray[np.float64]
    points: NDArray[np.float64]
    rng: np.random.Generator


def look_at(
    original: Probe,
    patches: list[tuple[NDArray[np.float64], NDArray[np.int32]]],
    stop: Callable[[], bool],
) -> Original:
    """
    Find out what can be seen of the original, for `measure_fit`.

    Parameters
    ----------
    original : Probe
    patches : list of (vertices, faces)
        What closes its openings: they hide the inside.
    stop : callable
        Asked whether to stop.

    Raises
    ------
    Cancelled
        `stop` answered True.
    """

    def tick(_share: float) -> None:
        if stop():
            raise Cancelled(message("the shell was cancelled: the mesh is unchanged."))

    vertices, faces = join([(original.vertices, original.faces), *patches])
    index = SurfaceIndex(vertices, faces)
    seen = _seen(original, index, tick)
    rng = np.random.default_rng(0)
    return Original(vertices, faces, index, seen, _visible_points(original, index, seen, rng), rng)


def measure_fit(original: Original, wrapped: Wrapped, alpha: float) -> ShellFit:
    """
    Measure a shell against the original.

    Parameters
    ----------
    original : Original
        Its generator goes on: for one measurement only.
    wrapped : Wrapped
    alpha : float
        Size of its facets, metres.
    """
    vertices, faces, closed, rng = original.vertices, original.faces, original.index, original.rng
    shell = SurfaceIndex(wrapped.vertices, wrapped.faces)
    there, _, _ = shell.closest(original.points)
    real = wrapped.faces[wrapped.rests_on == SURFACE]
    back, _, _ = closed.closest(sample_surface(wrapped.vertices, real, _SAMPLES, rng))
    areas = np.linalg.norm(cross_products(wrapped.vertices, wrapped.faces), axis=1) / 2
    hidden = np.zeros(len(faces), dtype=bool)
    hidden[: len(original.seen)] = original.seen == 0
    median, p95, most = np.percentile(there, [50, 95, 100]).tolist()
    # At a lip the nearest facet may be a hidden one although the outside is as near: what counts is that
    # nothing visible is.
    outside = SurfaceIndex(vertices, np.ascontiguousarray(faces[~hidden]))
    landed = _landed(wrapped, shell, rng)
    _, nearest, _ = closed.closest(landed)
    inner = hidden[nearest] & (outside.closest(landed)[0] > alpha)
    return ShellFit(
        visible_median=median,
        visible_p95=p95,
        visible_max=most,
        shell_p95=float(np.percentile(back, 95)),
        shell_max=float(back.max()),
        inner_hits=int(np.count_nonzero(inner)),
        lines=len(landed),
        held_back=wrapped.held_back,
        bridged_area=float(areas[wrapped.rests_on == PLUG].sum()),
    )


def sample_surface(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], count: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Draw `count` points evenly over the facets, (count, 3)."""
    return draw_points(vertices, faces, count, rng)[0]


def draw_points(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], count: int, rng: np.random.Generator
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Draw `count` points evenly over the facets, (count, 3), and say which facet each is on, (count,)."""
    areas = np.linalg.norm(cross_products(vertices, faces), axis=1)
    facets = rng.choice(len(faces), count, p=areas / areas.sum())
    pick = faces[facets]
    u, v = rng.random((2, count, 1))
    over = u + v > 1
    u, v = np.where(over, 1 - u, u), np.where(over, 1 - v, v)
    a, b, c = (vertices[pick[:, corner]] for corner in range(3))
    return np.asarray(a + u * (b - a) + v * (c - a)), facets


def _visible_points(
    original: Probe, closed: SurfaceIndex, seen: NDArray[np.float64], rng: np.random.Generator
) -> NDArray[np.float64]:
    """Draw points of the original that can be seen; of a large facet a part may be, and the rest lie inside."""
    faces = original.faces[seen > 0] if (seen > 0).any() else original.faces
    points, facets = draw_points(original.vertices, faces, _SAMPLES, rng)
    cross = cross_products(original.vertices, faces[facets])
    normals = cross / np.linalg.norm(cross, axis=1, keepdims=True)
    light = [exposure_at(points, side, closed, original.size, count=_LOOKS) for side in (normals, -normals)]
    visible = np.maximum(*light) > _VISIBLE
    return points[visible] if visible.any() else points


def _seen(original: Probe, closed: SurfaceIndex, tick: Callable[[float], None]) -> NDArray[np.float64]:
    """How much of the sky each facet sees from its better side, whatever its winding, (m,)."""
    seen = np.zeros(len(original.faces))
    for faces in (original.faces, np.ascontiguousarray(original.faces[:, ::-1])):
        seen = np.maximum(seen, exposure(original.vertices, faces, closed, count=_LOOKS, tick=tick))
    return seen


def _landed(wrapped: Wrapped, shell: SurfaceIndex, rng: np.random.Generator) -> NDArray[np.float64]:
    """Shoot lines at the shell from all round; give where those that meet it land, (k, 3)."""
    size = float(np.ptp(wrapped.vertices, axis=0).max())
    targets = sample_surface(wrapped.vertices, wrapped.faces, _LINES, rng)
    towards = directions(_LINES)[rng.permutation(_LINES)]
    origins = targets - 3 * size * towards
    t, face = shell.first_hit(origins, towards)
    met = np.flatnonzero(face >= 0)
    return np.asarray(origins[met] + t[met, None] * towards[met])

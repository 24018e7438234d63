"""
The probe with its markers and where the touches on them were located, from two sides.

Importing this module imports Matplotlib, which takes a while: import it when a report is made.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from contactbench.pipeline.heatmap import Heatmap, heatmap
from contactbench.pipeline.heatmap.heatmap import NO_DATA
from contactbench.pipeline.heatmap.picture import HIGH, PictureLook, SurfaceView, add_triad, looks_at
from contactbench.pipeline.heatmap.subdivide import drawing_of
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.page import printable
from contactbench.pipeline.page.figures import WIDTH, page_style, to_svg
from contactbench.pipeline.page.palette import BLUE, VERMILION
from contactbench.pipeline.verification.figures import TouchFigure, VerificationLimits

DARK = "#111111"  # on the probe, whose colour is the same on every page
_MOST_NAMES = 30  # markers: of more, the names would cover one another


def draw_touches(
    touches: Sequence[TouchFigure], probe: Probe, limits: VerificationLimits, pixels: int = 520
) -> str:
    """
    Return the probe as an SVG element: markers as crosses with their names, located points as dots.

    Blue: within the limit of the largest error; orange: beyond. Without touches it is the probe alone.

    Parameters
    ----------
    touches : sequence of TouchFigure
        Accepted ones.
    probe : Probe
        In S.
    limits : VerificationLimits
    pixels : int
        Width of each look.
    """
    known = [t for t in touches if t.point_mm is not None and t.error_mm is not None]
    located = 1e-3 * np.array([t.point_mm for t in known], dtype=np.float64).reshape(-1, 3)
    errors = 1e-3 * np.array([t.error_mm for t in known], dtype=np.float64).reshape(-1, 3)
    beyond = np.linalg.norm(errors, axis=1) > limits.max_m
    markers = {t.marker: point for t, point in zip(known, located - errors, strict=True) if t.marker}
    index = SurfaceIndex(probe.vertices, probe.faces)
    with page_style():
        figure = Figure(figsize=(WIDTH, 0.5 * HIGH * WIDTH))
        for column, look in enumerate(looks_at(probe, located)):
            axes = figure.add_axes((0.5 * column, 0.0, 0.5, 1.0))
            image = SurfaceView(probe, look, pixels).plain(NO_DATA)
            axes.imshow(image, extent=(-0.5, 0.5, -HIGH / 2, HIGH / 2), interpolation="none")
            axes.set_axis_off()
            axes.set(xlim=(-0.5, 0.5), ylim=(-HIGH / 2, HIGH / 2))
            add_triad(axes, look)
            for which, colour in ((~beyond, BLUE), (beyond, VERMILION)):
                at = _seen(located[which], look, probe, index)
                axes.plot(*at.T, "o", color=colour, ms=4, mec="white", mew=0.5)
            for name, point in markers.items():
                for x, y in _seen(point[None], look, probe, index):
                    axes.plot(x, y, "+", color=DARK, ms=9, mew=1.2)
                    if len(markers) <= _MOST_NAMES:
                        style: dict[str, Any] = {"textcoords": "offset points", "fontsize": 8, "color": DARK}
                        axes.annotate(short(name, 10), (x, y), (5, 4), **style)
        return to_svg(figure, "t", "The probe from two sides, with its markers and the located points")


def _seen(points: Floats, look: PictureLook, probe: Probe, index: SurfaceIndex) -> Floats:
    """Return where on the picture (m, 2) those of the points (n, 3) lie that nothing hides."""
    if not len(points):
        return np.zeros((0, 2))
    return np.asarray(look.project(points)[look.unhidden(points, probe, index)] / look.width)


def short(name: str, most: int) -> str:
    """Return a name as it can be drawn, with no more than so many characters."""
    name = printable(name)
    return name if len(name) <= most else f"{name[: most - 1]}…"


# ---- touches as the report shows them ------------------------------------------------------------


MOST_SHOWN = 24  # markers; of more, the worst
_BANDWIDTH = 3e-3  # m: markers are usually some 10 mm apart


@dataclass(frozen=True, eq=False)
class MarkerView:
    """The touches of a marker in its tangent plane, seen from outside."""

    name: str
    point: Floats  # (3,) the marker, S, m
    flat_mm: Floats  # (n, 2) located minus marker, to the right and up, mm
    # right, up: which way they point, in words: the axis of S that lies nearest
    right: str
    up: str


def marker_views(touches: Sequence[TouchFigure], probe: Probe) -> list[MarkerView]:
    """Return accepted touches by marker, in the order in which they were first touched."""
    groups: dict[str, list[TouchFigure]] = {}
    for touch in touches:
        if touch.marker is not None and touch.point_mm is not None and touch.error_mm is not None:
            groups.setdefault(touch.marker, []).append(touch)
    index = SurfaceIndex(probe.vertices, probe.faces)
    return [_view(name, group, probe, index) for name, group in groups.items()]


def _view(name: str, touches: list[TouchFigure], probe: Probe, index: SurfaceIndex) -> MarkerView:
    errors = np.array([touch.error_mm for touch in touches], dtype=np.float64)
    points = np.array([touch.point_mm for touch in touches], dtype=np.float64)
    marker = 1e-3 * (points - errors).mean(axis=0)
    _, faces, _ = index.closest(marker[None])
    normal = probe.normals[int(faces[0])]
    axis = int(np.argmin(np.abs(normal)))  # the flattest axis of S lies to the right
    right = np.eye(3)[axis] - normal[axis] * normal
    right /= np.linalg.norm(right)
    up = np.cross(normal, right)
    return MarkerView(name, marker, errors @ np.column_stack([right, up]), _nearest(right), _nearest(up))


def _nearest(direction: Floats) -> str:
    axis = int(np.argmax(np.abs(direction)))
    sign = "+" if direction[axis] > 0 else "\N{MINUS SIGN}"
    return f"{'' if abs(direction[axis]) > 0.98 else '≈ '}{sign}{'xyz'[axis]}"


def error_map(touches: Sequence[TouchFigure], probe: Probe) -> Heatmap | None:
    """Return the mean error over the probe; None without located touches."""
    known = [touch for touch in touches if touch.point_mm is not None and touch.distance_mm is not None]
    if not known:
        return None
    points = 1e-3 * np.array([touch.point_mm for touch in known], dtype=np.float64)
    errors = 1e-3 * np.array([touch.distance_mm for touch in known], dtype=np.float64)
    bandwidth = min(_BANDWIDTH, 0.1 * probe.size)
    return heatmap(drawing_of(probe), points, None, "error", bandwidth, values=errors, counted="touches")

"""
The probe with its markers and where the touches on them were located, from two sides.

Importing this module imports Matplotlib, which takes a while: import it when a report is made.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from contactbench.pipeline.heatmap.colours import NO_DATA
from contactbench.pipeline.heatmap.picture import HIGH, SurfaceView, add_triad, looks_at
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.page import printable
from contactbench.pipeline.page.figures import WIDTH, page_style, to_svg
from contactbench.pipeline.page.palette import BLUE, VERMILION

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.heatmap.picture import PictureLook
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.verification.figures import TouchFigure, VerificationLimits

_HIDDEN_M = 5e-4  # behind the surface by more than this, a point is on the other side
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
            names = list(markers)
            points = np.array([markers[name] for name in names]).reshape(-1, 3)
            for name, point in zip(names, points, strict=True):
                for x, y in _seen(point[None], look, probe, index):
                    axes.plot(x, y, "+", color=DARK, ms=9, mew=1.2)
                    if len(names) <= _MOST_NAMES:
                        style: dict[str, Any] = {"textcoords": "offset points", "fontsize": 8, "color": DARK}
                        axes.annotate(_short(name), (x, y), (5, 4), **style)
        return to_svg(figure, "t", "The probe from two sides, with its markers and the located points")


def _seen(
    points: NDArray[np.float64], look: PictureLook, probe: Probe, index: SurfaceIndex
) -> NDArray[np.float64]:
    """Return where on the picture (m, 2) those of the points (n, 3) lie that nothing hides."""
    if not len(points):
        return np.zeros((0, 2))
    far = 4.0 * probe.size
    directions = np.ascontiguousarray(np.broadcast_to(-look.toward, points.shape))
    t, faces = index.first_hit(points + far * look.toward, directions)
    free = (faces < 0) | (t > far - _HIDDEN_M)
    away = (points - look.middle) / look.width
    return np.column_stack([away @ look.right, away @ look.up])[free]


def _short(name: str) -> str:
    name = printable(name)
    return name if len(name) <= 10 else f"{name[:9]}…"

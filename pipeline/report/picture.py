"""The probe with its markers and where the touches on them were located, from two sides."""

from __future__ import annotations

from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.heatmap.colours import NO_DATA
from contactbench.pipeline.heatmap.picture import HIGH, SurfaceView, add_triad, looks_at
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.page.palette import BLUE, VERMILION

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.heatmap.picture import PictureLook
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.verification.figures import TouchFigure, VerificationLimits

_HIDDEN_M = 5e-4  # behind the surface by more than this, a point is on the other side
_MOST_NAMES = 30  # markers: of more, the names would cover one another


def encode_touches(
    touches: Sequence[TouchFigure], probe: Probe, limits: VerificationLimits, pixels: int = 520
) -> bytes:
    """
    Return a PNG of the probe: markers as crosses with their names, located points as dots.

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
    import matplotlib as mpl
    from matplotlib.figure import Figure

    known = [t for t in touches if t.point_mm is not None and t.error_mm is not None]
    located = 1e-3 * np.array([t.point_mm for t in known], dtype=np.float64).reshape(-1, 3)
    errors = 1e-3 * np.array([t.error_mm for t in known], dtype=np.float64).reshape(-1, 3)
    beyond = np.linalg.norm(errors, axis=1) > limits.max_m
    markers = {t.marker: point for t, point in zip(known, located - errors, strict=True) if t.marker}
    index = SurfaceIndex(probe.vertices, probe.faces)
    side = 4.0
    style: dict[Any, Any] = {"font.family": ["DejaVu Sans"], "text.parse_math": False}
    with mpl.rc_context(style):
        figure = Figure(figsize=(2 * side, HIGH * side), dpi=pixels / side)
        for column, look in enumerate(looks_at(probe, located)):
            axes = figure.add_axes((0.5 * column, 0.0, 0.5, 1.0))
            image = SurfaceView(probe, look, pixels).plain(NO_DATA)
            axes.imshow(image, extent=(-0.5, 0.5, -HIGH / 2, HIGH / 2))
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
                    axes.plot(x, y, "+", color="#111111", ms=9, mew=1.2)
                    if len(names) <= _MOST_NAMES:
                        axes.annotate(_short(name), (x, y), (5, 4), textcoords="offset points", fontsize=8)
        data = BytesIO()
        figure.savefig(data, format="png", metadata={"Software": None}, facecolor="white")
    return data.getvalue()


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
    return name if len(name) <= 10 else f"{name[:9]}…"

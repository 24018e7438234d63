"""Touches as the report shows them: each marker seen from outside, and the error over the probe."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.heatmap import Heatmap, heatmap
from contactbench.pipeline.heatmap.subdivide import drawing_of
from contactbench.pipeline.kernel import SurfaceIndex

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.verification.figures import TouchFigure

MOST_SHOWN = 24  # markers; of more, the worst
_BANDWIDTH = 3e-3  # m: markers are usually some 10 mm apart


@dataclass(frozen=True, eq=False)
class MarkerView:
    """The touches of a marker in its tangent plane, seen from outside."""

    name: str
    point: NDArray[np.float64]  # (3,) the marker, S, m
    flat_mm: NDArray[np.float64]  # (n, 2) located minus marker, to the right and up, mm
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


def _nearest(direction: NDArray[np.float64]) -> str:
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

"""Touches that went astray, on the probe."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.heatmap.picture import HIGH, PictureLook, SurfaceView
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.study.pages import STYLE, png
from contactbench.pipeline.study.sweep.bodies import unpacked_mesh
from contactbench.pipeline.study.sweep.targets import plain

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.study.sweep.growth import Row

_PANEL, _PIXELS, _DPI = 3.0, 300, 100  # inches of a panel, and the probe's pixels
_TRUE, _FOUND, _FORCE, _BODY = "#009e73", "#d55e00", "#0072b2", (0.85, 0.86, 0.88)
_ARROW_M = 0.03
_FINE = 1_000  # facets: below, the mesh alone is far off


@dataclass(frozen=True)
class Panel:
    """One touch that went astray."""

    mesh: Mapping[str, str]  # of `packed_mesh`
    title: str
    # true, found: points, S, m
    true: list[float]
    found: list[float]
    force: list[float]  # on the probe, S, N


def astray(rows: Sequence[Row], meshes: Mapping[str, Mapping[str, str]]) -> list[list[Panel]]:
    """Return, for each method, a panel for each probe on which it went astray: its worst touch, a sure one if any."""
    lines = []
    for method in dict.fromkeys(row["method"] for row in rows):
        line = []
        for probe in dict.fromkeys(row["probe"] for row in rows):
            own = [
                row
                for row in rows
                if (row["method"], row["probe"]) == (method, probe) and row.get("worst_reason")
            ]
            if own and probe in meshes:
                line.append(_panel(max(own, key=_badness), meshes[probe]))
        if line:
            lines.append(line)
    return lines


def _badness(row: Row) -> tuple[bool, bool, float]:
    return row["facets_found"] >= _FINE, row["worst_reason"][0] != "ambiguous", _distance(row)


def _distance(row: Row) -> float:
    return float(np.linalg.norm(np.subtract(row["worst_true"][:3], row["worst_found"][:3])))


def _panel(row: Row, mesh: Mapping[str, str]) -> Panel:
    title = (
        f"{row['method']}, {plain(row['probe'])}\n{row['force']:g} N, {row['angle']:g} deg, {row['facets']:,} facets:\n"
        f"{1e3 * _distance(row):.0f} mm off ({row['worst_reason'][0]})"
    )
    return Panel(mesh, title, *(list(row[f"worst_{name}"][:3]) for name in ("true", "found", "force")))


def draw(lines: Sequence[Sequence[Panel]]) -> bytes:
    """Draw panels, a line for each method, as a PNG image; empty when there is nothing to draw."""
    if not any(lines):
        return b""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    columns = max(len(line) for line in lines)
    with rc_context(STYLE):
        figure = Figure(figsize=(_PANEL * columns, _PANEL * len(lines)), dpi=_DPI, layout="constrained")
        for line, row in zip(lines, figure.subplots(len(lines), columns, squeeze=False), strict=True):
            for axes in row:
                axes.set_axis_off()
            for panel, axes in zip(line, row, strict=False):
                _draw_panel(axes, panel)
        return png(figure)


def _draw_panel(axes: Any, panel: Panel) -> None:
    probe = Probe.from_arrays(*unpacked_mesh(panel.mesh))
    true, found, force = (np.array(each) for each in (panel.true, panel.found, panel.force))
    along = force / np.linalg.norm(force)
    look = _beside(probe, along)
    half, high = 500 * look.width, 500 * HIGH * look.width
    axes.imshow(SurfaceView(probe, look, _PIXELS).plain(_BODY), extent=(-half, half, -high, high))
    points = [true - _ARROW_M * along, true, found]
    tail, one, other = 1e3 * (points - look.middle) @ np.column_stack([look.right, look.up])
    axes.annotate(
        "", one, tail, arrowprops={"arrowstyle": "-|>", "color": _FORCE, "shrinkA": 0, "shrinkB": 3}
    )
    axes.plot(*zip(one, other, strict=True), color=_FOUND, linewidth=1.5)
    axes.plot(*one, "o", color=_TRUE)
    axes.plot(*other, "o", color=_FOUND)
    axes.set(xlim=(-half, half), ylim=(-high, high))
    axes.set_title(panel.title, fontsize=7)


def _beside(probe: Probe, along: NDArray[np.float64]) -> PictureLook:
    """Look across the force, because both points lie near its line; a little from above."""
    across = np.cross(along, [0.0, 0.0, 1.0])
    if np.linalg.norm(across) < 1e-3:
        across = np.array([0.0, -1.0, 0.0])
    toward = across / np.linalg.norm(across) + [0.0, 0.0, 0.35]
    toward /= np.linalg.norm(toward)
    right = np.cross([0.0, 0.0, 1.0], toward)
    right /= np.linalg.norm(right)
    return PictureLook(probe.bounds.mean(axis=0), right, np.cross(toward, right), toward, 1.5 * probe.size)

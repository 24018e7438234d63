"""
Touches that went astray, on the probe: rendered in a process of its own, which ends if there is no graphics driver.

The child is ``python -m contactbench.pipeline.study.sweep.pictures FILE``; it gets what to draw as JSON on
standard input.
"""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import asdict, dataclass
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.study.sweep.bodies import unpacked_mesh
from contactbench.pipeline.study.sweep.targets import plain

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.study.sweep.growth import Row

_PATIENCE_S = 180
_WIDTH, _HEIGHT = 300, 300  # pixels of a panel
_TRUE, _FOUND, _FORCE, _BODY = "#009e73", "#d55e00", "#0072b2", "#c9cdd1"
_ARROW_M, _POINT_M = 0.03, 0.004
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
    """
    Draw panels, a line for each method.

    Returns
    -------
    bytes
        A PNG image; empty when there is nothing to draw, no PyVista, or nothing to render with.
    """
    if not any(lines) or find_spec("pyvista") is None:
        return b""
    orders = json.dumps([[asdict(panel) for panel in line] for line in lines])
    with TemporaryDirectory() as folder:
        file = Path(folder, "astray.png")
        command = [sys.executable, "-m", "contactbench.pipeline.study.sweep.pictures", str(file)]
        try:
            subprocess.run(  # noqa: S603  (this interpreter and this module)
                command, input=orders.encode(), capture_output=True, check=True, timeout=_PATIENCE_S
            )
            return file.read_bytes()
        except (OSError, subprocess.SubprocessError):
            return b""


def _render(lines: list[list[dict[str, Any]]], file: str) -> None:
    import pyvista as pv
    from PIL import Image

    columns = max(len(line) for line in lines)
    plotter = pv.Plotter(
        off_screen=True,
        shape=(len(lines), columns),
        window_size=[_WIDTH * columns, _HEIGHT * len(lines)],
        border=False,
    )
    plotter.set_background("white")
    for i, line in enumerate(lines):
        for j, panel in enumerate(line):
            plotter.subplot(i, j)
            _draw_panel(plotter, pv, panel)
    image = np.asarray(plotter.screenshot(return_img=True))[..., :3]
    plotter.close()
    # Few colours are enough, and a third of the size; an octree keeps those of small marks.
    Image.fromarray(image).quantize(128, Image.Quantize.FASTOCTREE).save(file, optimize=True)


def _draw_panel(plotter: Any, pv: Any, panel: dict[str, Any]) -> None:
    vertices, faces = unpacked_mesh(panel["mesh"])
    true, found, force = (np.array(panel[name]) for name in ("true", "found", "force"))
    along = force / np.linalg.norm(force)
    plotter.add_mesh(
        pv.PolyData.from_regular_faces(vertices, faces), color=_BODY, opacity=0.45, smooth_shading=False
    )
    plotter.add_mesh(pv.Sphere(_POINT_M, true), color=_TRUE, lighting=False)
    plotter.add_mesh(pv.Sphere(_POINT_M, found), color=_FOUND, lighting=False)
    plotter.add_mesh(pv.Line(true, found), color=_FOUND, line_width=2)
    plotter.add_mesh(
        pv.Arrow(
            true - (_ARROW_M + _POINT_M) * along, along, scale=_ARROW_M, tip_radius=0.12, shaft_radius=0.04
        ),
        color=_FORCE,
        lighting=False,
    )
    plotter.add_text(panel["title"], font_size=7, color="black")
    centre = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    plotter.camera_position = [tuple(centre + _beside(along)), tuple(centre), (0.0, 0.0, 1.0)]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 0.62 * float(np.linalg.norm(np.ptp(vertices, axis=0)))
    plotter.reset_camera_clipping_range()


def _beside(along: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return where to look from: across the force, because both points lie near its line; a little from above."""
    across = np.cross(along, [0.0, 0.0, 1.0])
    if np.linalg.norm(across) < 1e-3:
        across = np.array([0.0, -1.0, 0.0])
    return np.asarray(across / np.linalg.norm(across) + [0.0, 0.0, 0.35])


if __name__ == "__main__":
    _render(json.load(sys.stdin), sys.argv[1])

"""
Draw the figures of docs/explanation: frames, signs, and where uncertainty comes from.

``python docs/figures/draw.py`` writes docs/figures/*.svg; the same code gives the same bytes.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes

OUT = Path(__file__).resolve().parent
# Okabe and Ito: everybody can tell them apart.
RED, GREEN, BLUE, GREY, PROBE = "#d55e00", "#009e73", "#0072b2", "#6b6b6b", "#dfe3e6"
STYLE = {"svg.hashsalt": "contactbench", "svg.fonttype": "none", "font.size": 9, "font.family": "sans-serif"}


def main() -> None:
    """Write all figures."""
    OUT.mkdir(exist_ok=True)
    _write(OUT / "frames.svg", (7.6, 4.6), frames)
    _write(OUT / "signs.svg", (6.4, 3.4), signs)
    _write(OUT / "uncertainty.svg", (7.6, 2.5), parts)


def _write(file: Path, size: tuple[float, float], draw: Callable[[Axes], None]) -> None:
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=size)
        figure.patch.set_facecolor("white")
        axes = figure.add_axes((0, 0, 1, 1))
        axes.set_axis_off()
        axes.set_aspect("equal")
        draw(axes)
        figure.savefig(file, metadata={"Date": None, "Creator": None})


def frames(axes: Axes) -> None:
    """Draw a robot's base, flange, sensor, probe and contact, each with its axes."""
    axes.set_xlim(-1, 14.2)
    axes.set_ylim(-1.4, 7.8)
    axes.plot([-1, 14.2], [-0.2, -0.2], color=GREY, lw=1)
    axes.plot(
        [0.8, 0.8, 2.6, 6.4], [-0.2, 2.4, 6.3, 6.3], color="#b8bec4", lw=14, solid_joinstyle="round", zorder=0
    )
    _box(axes, 5.9, 5.8, 1.0, 0.75, "#b8bec4")
    _box(axes, 5.9, 5.15, 1.0, 0.5, "#8f979e")
    axes.fill(
        [6.1, 6.7, 6.75, 7.3, 7.3, 5.5, 5.5, 6.05],
        [5.1, 5.1, 3.2, 2.6, 1.6, 1.6, 2.6, 3.2],
        color=PROBE,
        ec=GREY,
    )
    _frame(axes, (0.8, -0.2), (1, 0), (0, 1), "W", "world: the robot's base", (0.2, -0.95))
    _frame(axes, (6.4, 5.8), (1, 0), (0, -1), "E", "flange", (8.0, 6.2), shown="x")
    _frame(axes, (6.4, 5.4), (1, 0), (0, -1), "S", "sensor: everything is located here", (8.0, 5.05))
    _frame(axes, (6.4, 1.6), (0, 1), (-1, 0), "P", "mesh, as its file has it", (2.6, 1.05))
    contact = (7.3, 2.1)
    axes.plot(*contact, "o", color=RED, ms=6, zorder=5)
    axes.annotate("", (8.5, 2.1), contact, arrowprops={"arrowstyle": "-|>", "color": GREEN, "lw": 1.8})
    axes.text(8.6, 2.0, "C: contact, outward normal n", color=GREEN)
    axes.annotate(
        "", contact, (6.4, 5.4), arrowprops={"arrowstyle": "-|>", "color": RED, "lw": 1.4, "ls": "--"}
    )
    axes.text(7.2, 3.3, "p_SC_S", color=RED)
    axes.annotate(
        "", (6.2, 5.4), (0.95, 0.1), arrowprops={"arrowstyle": "<|-", "color": GREY, "lw": 1.0, "ls": ":"}
    )
    axes.text(1.7, 4.1, "R_WS turns S into W", color=GREY)
    axes.text(8.0, 4.2, "T_SP moves P into S", color=GREY)


def _frame(
    axes: Axes, at: tuple[float, float], x: tuple[float, float], z: tuple[float, float], name: str, text: str,
    where: tuple[float, float], shown: str = "xz",
) -> None:  # fmt: skip
    for direction, letter, colour in ((x, "x", RED), (z, "z", BLUE)):
        if letter not in shown:
            continue
        tip = np.add(at, np.multiply(0.95, direction))
        axes.annotate("", tip, at, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.8}, zorder=4)
        axes.text(*np.add(at, np.multiply(1.15, direction)), letter, color=colour, ha="center", va="center")
    axes.text(*where, f"{name}: {text}", fontweight="bold" if name == "S" else "normal")


def _box(axes: Axes, x: float, y: float, width: float, height: float, colour: str) -> None:
    axes.fill([x, x + width, x + width, x], [y, y, y + height, y + height], color=colour, ec=GREY)


def signs(axes: Axes) -> None:
    """Draw a press: the force on the probe, the normal, the torsion, and what the sensor reads besides."""
    axes.set_xlim(-4.4, 8.4)
    axes.set_ylim(-1.5, 5.3)
    axes.fill_between([-4.4, 8.4], -1.5, 0.35, color="#f3d9c9", lw=0)
    axes.text(-4.2, -1.2, "tissue", color=GREY)
    axes.fill(
        [-0.4, 0.4, 0.5, 1.3, 1.3, -1.3, -1.3, -0.5],
        [4.6, 4.6, 2.4, 1.8, 0.3, 0.3, 1.8, 2.4],
        color=PROBE,
        ec=GREY,
    )
    _box(axes, -0.6, 4.6, 1.2, 0.5, "#8f979e")
    axes.text(-2.2, 4.75, "sensor S")
    axes.plot(0.5, 0.3, "o", color=RED, ms=6, zorder=5)
    _arrow(axes, (0.5, 0.3), (0.85, 2.0), BLUE)
    axes.text(1.5, 2.1, "F: force of the tissue on the probe,\ninto it: F · n < 0", color=BLUE, va="center")
    _arrow(axes, (0.5, 0.3), (0.5, -1.2), GREEN)
    axes.text(0.75, -0.75, "n: outward normal", color=GREEN)
    turn = np.linspace(np.radians(200), np.radians(340), 40)
    axes.plot(0.5 + 0.55 * np.cos(turn), -0.25 + 0.22 * np.sin(turn), color=RED, lw=1.4)
    _arrow(axes, (0.92, -0.38), (1.04, -0.3), RED)
    axes.text(3.4, -0.75, "k n: torsion about it", color=RED)
    _arrow(axes, (0.0, 3.3), (0.0, 2.5), GREY)
    axes.text(
        1.5,
        3.3,
        "weight g at L: in the raw reading,\nlike the bias F0, M0; compensation takes both off",
        color=GREY,
        va="center",
    )
    axes.plot([0, 0.5], [4.6, 0.3], color=RED, lw=1, ls="--")
    axes.text(-0.1, 1.6, "p", color=RED)


def _arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float], colour: str) -> None:
    axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.8}, zorder=5)


def parts(axes: Axes) -> None:
    """Draw what enters the covariance of a contact, and what it is used for."""
    axes.set_xlim(0, 14.1)
    axes.set_ylim(0, 4.6)
    for row, (name, source) in enumerate(
        (("noise", "of the sensor"), ("calibration", "its covariance"), ("mesh", "facets against surface"),
         ("model error", "cable, hysteresis, mount"))
    ):  # fmt: skip
        y = 3.75 - 1.05 * row
        _box(axes, 0.2, y, 5.2, 0.75, "#e8eef3")
        axes.text(0.4, y + 0.37, f"{name}: {source}", va="center")
        _arrow(axes, (5.5, y + 0.37), (6.3, 2.3), GREY)
    _box(axes, 6.4, 1.85, 2.6, 0.9, "#cfe3ef")
    axes.text(7.7, 2.3, "covariance\nof the wrench", ha="center", va="center")
    for y, text in (
        (3.3, "misfit of every place:\nconfidence and reason"),
        (0.5, "covariance of the point:\nsigma_max, ellipse"),
    ):
        _box(axes, 10.0, y, 3.9, 0.9, "#d9efe6")
        axes.text(11.95, y + 0.45, text, ha="center", va="center")
        _arrow(axes, (9.1, 2.3), (9.9, y + 0.45), GREY)


if __name__ == "__main__":
    main()

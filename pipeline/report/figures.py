"""
The pictures of a report, as SVG with colours that everybody can tell apart (Okabe and Ito).

They carry numbers and the markers' names; names are escaped by the writer of SVG, and the same verification gives the
same text. Importing this module imports Matplotlib, which takes a while: import it when a report is made.
"""

from __future__ import annotations

import re
import warnings
from contextlib import contextmanager
from dataclasses import dataclass
from io import StringIO
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from contactbench.pipeline.page import printable

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from contactbench.pipeline.report.touches import MarkerView
    from contactbench.pipeline.verification.figures import (
        ErrorDiagnosis,
        Summary,
        TouchFigure,
        VerificationLimits,
    )

BLUE, ORANGE, GREEN, PURPLE, SKY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9"
_SERIES = ((BLUE, "o"), (ORANGE, "s"), (GREEN, "^"), (PURPLE, "D"), (SKY, "v"))
_INK, _FAINT, _GRID = "#222222", "#595959", "#d9dcdf"
_WIDTH = 6.9  # inches: the width of the text on an A4 page
COLUMNS = 4
FEWEST_REPEATS = 3  # touches of a marker: of fewer nobody can tell what is the same each time
_STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "contactbench",
    "font.family": ["DejaVu Sans"],
    "font.size": 8.5,
    "text.parse_math": False,
    "text.color": _INK,
    "axes.labelcolor": _INK,
    "axes.edgecolor": _FAINT,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "figure.facecolor": "none",
    "axes.facecolor": "none",
    "grid.color": _GRID,
    "grid.linewidth": 0.6,
    "xtick.color": _FAINT,
    "ytick.color": _FAINT,
    "xtick.labelcolor": _INK,
    "ytick.labelcolor": _INK,
}
_MOST_NAMES = 30


@dataclass(frozen=True)
class VerificationFigures:
    """SVG elements; empty where there is nothing to draw. `scatter` has one for each row of markers."""

    markers: str
    force: str
    scatter: tuple[str, ...]
    parts: str
    causes: str


def draw(
    touches: Sequence[TouchFigure],
    per_marker: Sequence[Summary],
    views: Sequence[MarkerView],
    limits: VerificationLimits,
    diagnosis: ErrorDiagnosis | None,
) -> VerificationFigures:
    """Draw all pictures of a report.

    Parameters
    ----------
    touches : sequence of TouchFigure
        Accepted ones.
    views : sequence of MarkerView
        The markers whose scatter is shown.
    """
    repeated = [each for each in per_marker if each.touches >= FEWEST_REPEATS and each.scatter_mm is not None]
    with _style():
        rows = [views[i : i + COLUMNS] for i in range(0, len(views), COLUMNS)]
        reach = max([1.15e3 * limits.max_m, *(1.15 * float(np.abs(v.flat_mm).max()) for v in views)])
        return VerificationFigures(
            _svg(_markers(per_marker, limits), "m", "Errors by marker") if per_marker else "",
            _svg(_force(touches, limits), "f", "Error by contact force") if touches else "",
            tuple(
                _svg(_scatter(row, reach, limits), f"s{i}", "Located points around each marker")
                for i, row in enumerate(rows)
            ),
            _svg(_parts(repeated), "b", "Bias and scatter by marker") if repeated else "",
            ""
            if diagnosis is None
            else _svg(_causes(diagnosis), "c", "Shares of the squared error by cause"),
        )


def _markers(per_marker: Sequence[Summary], limits: VerificationLimits) -> Figure:
    figure = Figure(figsize=(_WIDTH, 2.5))
    axes = figure.add_axes((0.08, 0.24, 0.9, 0.62))
    x = np.arange(len(per_marker))
    mean, most = (np.array([getattr(s, name) for s in per_marker]) for name in ("mean_mm", "max_mm"))
    sd = np.array([s.sd_mm or 0.0 for s in per_marker])  # of one touch there is none, and no bar
    # A distance is not negative; the bar of an SD ends there.
    axes.errorbar(
        x, mean, [np.minimum(sd, mean), sd], fmt="o", color=BLUE, capsize=3, ms=5, label="mean ± SD", zorder=3
    )
    axes.plot(x, most, "_", color=ORANGE, ms=9, mew=1.8, label="largest", zorder=3)
    _limits(axes, limits)
    axes.set_xticks(x, [_short(s.name) for s in per_marker], rotation=0 if len(x) <= 12 else 90)
    if len(x) > _MOST_NAMES:
        axes.set_xticks(x[:: len(x) // _MOST_NAMES + 1])
    top = max(1.1 * float(most.max()), 1.1e3 * limits.max_m)
    axes.set(xlim=(-0.6, len(x) - 0.4), ylim=(0, top), ylabel="error, mm", xlabel="marker")
    axes.grid(axis="y")
    _legend(figure, 4)
    return figure


def _force(touches: Sequence[TouchFigure], limits: VerificationLimits) -> Figure:
    figure = Figure(figsize=(_WIDTH, 2.7))
    axes = figure.add_axes((0.08, 0.17, 0.9, 0.68))
    windows = sorted({touch.window_N or (0.0, 0.0) for touch in touches})
    for number, window in enumerate(windows):
        chosen = [touch for touch in touches if (touch.window_N or (0.0, 0.0)) == window]
        force = np.array([touch.force_N for touch in chosen])
        error = np.array([touch.distance_mm or 0.0 for touch in chosen])
        colour, shape = _SERIES[number % len(_SERIES)]
        words = f"{window[0]:g} to {window[1]:g} N" if window[1] else "touches"
        axes.plot(force, error, shape, color=colour, ms=4.5, mec="white", mew=0.5, label=words, zorder=3)
        axes.plot([force.min(), force.max()], [error.mean()] * 2, color=colour, lw=2.2, alpha=0.55, zorder=2)
    known = [(t.force_N, t.predicted_mm) for t in touches if t.predicted_mm is not None]
    if known:
        at = np.array(sorted(known))
        axes.plot(*at.T, ".", color=_FAINT, ms=2.5, zorder=1, label="explained by noise (rms)")
    _limits(axes, limits)
    top = max([1.1 * (t.distance_mm or 0.0) for t in touches] + [1.1e3 * limits.max_m])
    axes.set(ylim=(0, top), xlabel="contact force, N", ylabel="error, mm")
    axes.grid()
    _legend(figure, 5)
    return figure


def _scatter(views: Sequence[MarkerView], reach: float, limits: VerificationLimits) -> Figure:
    side = _WIDTH / COLUMNS
    figure = Figure(figsize=(_WIDTH, side + 0.2))
    high = figure.get_size_inches()[1]
    for column, view in enumerate(views):
        axes = figure.add_axes(((column + 0.27) / COLUMNS, 0.36 / high, 0.7 / COLUMNS, 0.7 * side / high))
        for radius, style in ((1e3 * limits.mean_m, "-"), (1e3 * limits.max_m, "--")):
            axes.add_patch(Circle((0, 0), radius, fill=False, ec=_FAINT, lw=0.8, ls=style))
        axes.plot(0, 0, "+", color=_INK, ms=9, mew=1.2)
        axes.plot(*view.flat_mm.T, "o", color=BLUE, ms=3.6, mec="white", mew=0.4)
        axes.plot(*view.flat_mm.mean(axis=0), "x", color=ORANGE, ms=6, mew=1.8)
        axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
        axes.locator_params(nbins=5)
        axes.tick_params(labelsize=7.5, pad=2)
        axes.set_title(_short(view.name), fontsize=9, pad=3)
        axes.set_xlabel(f"{view.right}, mm", labelpad=1)
        axes.set_ylabel(f"{view.up}, mm", labelpad=-1)
    return figure


def _parts(per_marker: Sequence[Summary]) -> Figure:
    """Plot scatter over bias: right of the diagonal it is the bias that matters."""
    figure = Figure(figsize=(3.35, 2.9))
    axes = figure.add_axes((0.17, 0.16, 0.79, 0.79))
    bias = np.array([float(np.linalg.norm(s.bias_mm)) for s in per_marker])
    scatter = np.array([s.scatter_mm or 0.0 for s in per_marker])
    top = 1.15 * max(float(bias.max()), float(scatter.max()), 1e-3)
    axes.plot([0, top], [0, top], color=_FAINT, lw=0.9, ls=(0, (4, 3)))
    axes.plot(bias, scatter, "o", color=BLUE, ms=5, mec="white", mew=0.5, zorder=3)
    shown = np.argsort(-np.hypot(bias, scatter), kind="stable")[:6]
    for row in shown:
        axes.annotate(
            _short(per_marker[row].name),
            (bias[row], scatter[row]),
            (4, 3),
            textcoords="offset points",
            fontsize=7.5,
        )
    axes.set(
        xlim=(0, top), ylim=(0, top), aspect="equal", xlabel="bias of the marker, mm", ylabel="scatter, mm"
    )
    axes.grid()
    return figure


def _causes(diagnosis: ErrorDiagnosis) -> Figure:
    figure = Figure(figsize=(3.35, 2.9))
    axes = figure.add_axes((0.25, 0.16, 0.64, 0.79))
    shares = diagnosis.shares[::-1]
    y = np.arange(len(shares))
    colours = [ORANGE if share.cause == diagnosis.first else BLUE for share in shares]
    axes.barh(y, [100 * share.share for share in shares], color=colours, height=0.62)
    for row, share in enumerate(shares):
        axes.text(100 * share.share + 1.5, row, f"{100 * share.share:.0f} %", va="center")
    axes.set_yticks(y, [share.cause.value for share in shares])
    axes.set(xlim=(0, 112), xlabel="share of the squared error, %", xticks=[0, 25, 50, 75, 100])
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x")
    return figure


def _limits(axes: Any, limits: VerificationLimits) -> None:
    for value, style, words in (
        (limits.mean_m, "-", "limit of the mean"),
        (limits.max_m, (0, (5, 3)), "of the largest"),
    ):
        axes.axhline(1e3 * value, color=_INK, lw=1, ls=style, label=words, zorder=1)


def _legend(figure: Figure, columns: int) -> None:
    place: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (0.06, 1.02), "ncols": columns}
    figure.legend(frameon=False, handletextpad=0.5, columnspacing=1.3, fontsize=8, **place)


def _short(name: str) -> str:
    name = printable(name)
    return name if len(name) <= 14 else f"{name[:13]}…"


@contextmanager
def _style() -> Iterator[None]:
    with mpl.rc_context(), warnings.catch_warnings():
        # The text stays text in the SVG: whoever shows it has the letters, whatever the font here lacks.
        warnings.filterwarnings("ignore", "Glyph .* missing from", UserWarning)
        mpl.rcdefaults()
        mpl.rcParams.update(_STYLE)
        yield


def _svg(figure: Figure, prefix: str, words: str) -> str:
    """Return a figure as an SVG element whose ids are its own on the page."""
    text = StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    svg = text.getvalue()
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
    svg = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{prefix}-", svg)
    return svg.replace("<svg ", f'<svg role="img" aria-label="{words}" ', 1)

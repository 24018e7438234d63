"""
The pictures of a verification report, see `contactbench.pipeline.page.figures`.

They carry numbers and the markers' names; names are escaped by the writer of SVG, and the same verification gives the
same text. Importing this module imports Matplotlib, which takes a while: import it when a report is made.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from contactbench.pipeline.page.figures import FAINT, INK, WIDTH, page_style, to_svg
from contactbench.pipeline.page.palette import BLUE, GREEN, PURPLE, SKY, VERMILION
from contactbench.pipeline.report.picture import MarkerView, short
from contactbench.pipeline.verification.figures import (
    ErrorDiagnosis,
    Summary,
    TouchFigure,
    VerificationLimits,
)

_SERIES = ((BLUE, "o"), (VERMILION, "s"), (GREEN, "^"), (PURPLE, "D"), (SKY, "v"))
COLUMNS = 4
FEWEST_REPEATS = 3  # touches of a marker: of fewer nobody can tell what is the same each time
_STYLE: dict[str, Any] = {"font.size": 8.5, "axes.spines.top": False, "axes.spines.right": False}
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
    *,
    passed: bool = False,
) -> VerificationFigures:
    """Draw all pictures of a report.

    Parameters
    ----------
    touches : sequence of TouchFigure
        Accepted ones.
    views : sequence of MarkerView
        The markers whose scatter is shown.
    passed : bool
        Then no cause is to be put right.
    """
    repeated = [each for each in per_marker if each.touches >= FEWEST_REPEATS and each.scatter_mm is not None]
    with page_style(**_STYLE):
        rows = [views[i : i + COLUMNS] for i in range(0, len(views), COLUMNS)]
        reach = max([1.15e3 * limits.max_m, *(1.15 * float(np.abs(v.flat_mm).max()) for v in views)])
        return VerificationFigures(
            to_svg(_markers(per_marker, limits), "m", "Errors by marker") if per_marker else "",
            to_svg(_force(touches, limits), "f", "Error by contact force") if touches else "",
            tuple(
                to_svg(_scatter(row, reach, limits), f"s{i}", "Located points around each marker")
                for i, row in enumerate(rows)
            ),
            to_svg(_parts(repeated), "b", "Bias and scatter by marker") if repeated else "",
            ""
            if diagnosis is None
            else to_svg(_causes(diagnosis, passed), "c", "Shares of the squared error by cause"),
        )


def _markers(per_marker: Sequence[Summary], limits: VerificationLimits) -> Figure:
    figure = Figure(figsize=(WIDTH, 2.5))
    axes = figure.add_axes((0.08, 0.24, 0.9, 0.62))
    x = np.arange(len(per_marker))
    mean, most = (np.array([getattr(s, name) for s in per_marker]) for name in ("mean_mm", "max_mm"))
    sd = np.array([s.sd_mm or 0.0 for s in per_marker])  # of one touch there is none, and no bar
    # A distance is not negative; the bar of an SD ends there.
    bars: dict[str, Any] = {"ecolor": BLUE, "capsize": 3, "zorder": 2}
    axes.errorbar(x, mean, [np.minimum(sd, mean), sd], fmt="none", label="SD", **bars)
    for values, limit, shape, words in (
        (mean, limits.mean_m, "o", "mean"),
        (most, limits.max_m, "_", "largest"),
    ):
        style: dict[str, Any] = {"linestyle": "none", "marker": shape, "ms": 6, "mew": 1.8, "zorder": 3}
        beyond = values > 1e3 * limit
        if not beyond.all():
            axes.plot(x[~beyond], values[~beyond], color=BLUE, label=words, **style)
        if beyond.any():
            axes.plot(x[beyond], values[beyond], color=VERMILION, label=f"{words} over its limit", **style)
    _limits(axes, limits)
    axes.set_xticks(x, [short(s.name, 14) for s in per_marker], rotation=0 if len(x) <= 12 else 90)
    if len(x) > _MOST_NAMES:
        axes.set_xticks(x[:: len(x) // _MOST_NAMES + 1])
    top = max(1.1 * float(most.max()), 1.1e3 * limits.max_m)
    axes.set(xlim=(-0.6, len(x) - 0.4), ylim=(0, top), ylabel="error, mm", xlabel="marker")
    axes.grid(axis="y")
    _legend(figure, 7)
    return figure


def _force(touches: Sequence[TouchFigure], limits: VerificationLimits) -> Figure:
    figure = Figure(figsize=(WIDTH, 2.7))
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
        axes.plot(*at.T, ".", color=FAINT, ms=2.5, zorder=1, label="explained by noise (rms)")
    _limits(axes, limits)
    top = max([1.1 * (t.distance_mm or 0.0) for t in touches] + [1.1e3 * limits.max_m])
    axes.set(ylim=(0, top), xlabel="contact force, N", ylabel="error, mm")
    axes.grid()
    _legend(figure, 5)
    return figure


def _scatter(views: Sequence[MarkerView], reach: float, limits: VerificationLimits) -> Figure:
    side = WIDTH / COLUMNS
    figure = Figure(figsize=(WIDTH, side + 0.2))
    high = figure.get_size_inches()[1]
    for column, view in enumerate(views):
        axes = figure.add_axes(((column + 0.27) / COLUMNS, 0.36 / high, 0.7 / COLUMNS, 0.7 * side / high))
        for radius, style in ((1e3 * limits.mean_m, "-"), (1e3 * limits.max_m, "--")):
            axes.add_patch(Circle((0, 0), radius, fill=False, ec=FAINT, lw=0.8, ls=style))
        axes.plot(0, 0, "+", color=INK, ms=9, mew=1.2)
        beyond = np.linalg.norm(view.flat_mm, axis=1) > 1e3 * limits.max_m
        for which, colour in ((~beyond, BLUE), (beyond, VERMILION)):
            axes.plot(*view.flat_mm[which].T, "o", color=colour, ms=3.6, mec="white", mew=0.4)
        axes.plot(*view.flat_mm.mean(axis=0), "x", color=INK, ms=6, mew=1.8)
        axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
        axes.locator_params(nbins=5)
        axes.tick_params(labelsize=7.5, pad=2)
        axes.set_title(short(view.name, 14), fontsize=9, pad=3)
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
    axes.plot([0, top], [0, top], color=FAINT, lw=0.9, ls=(0, (4, 3)))
    axes.plot(bias, scatter, "o", color=BLUE, ms=5, mec="white", mew=0.5, zorder=3)
    shown = np.argsort(-np.hypot(bias, scatter), kind="stable")[:6]
    for row in shown:
        axes.annotate(
            short(per_marker[row].name, 14),
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


def _causes(diagnosis: ErrorDiagnosis, passed: bool) -> Figure:
    figure = Figure(figsize=(3.35, 2.9))
    axes = figure.add_axes((0.25, 0.16, 0.64, 0.79))
    shares = diagnosis.shares[::-1]
    y = np.arange(len(shares))
    colours = [VERMILION if share.cause == diagnosis.first and not passed else BLUE for share in shares]
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
        axes.axhline(1e3 * value, color=INK, lw=1, ls=style, label=words, zorder=1)


def _legend(figure: Figure, columns: int) -> None:
    place: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (0.06, 1.02), "ncols": columns}
    figure.legend(frameon=False, handletextpad=0.5, columnspacing=1.3, fontsize=8, **place)

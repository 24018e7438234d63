"""Rivals as pictures, by Matplotlib; importing this module imports it, which takes a while."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from contactbench.pipeline.study.pages import COLOURS, STYLE, png
from contactbench.pipeline.study.rivals import place
from contactbench.pipeline.study.rivals.rows import OURS

if TYPE_CHECKING:
    from collections.abc import Sequence

Row = dict[str, Any]
_MARKS = "osv^D<>P"
_PANEL, _HEIGHT, _DPI = 3.3, 3.0, 80
_NOISE = "filtered"


def plots(rows: Sequence[Row]) -> dict[str, bytes]:
    """Return PNG images by file name: those that the rows have something for."""
    made = {"location.png": _location(rows)}
    return {name: data for name, data in made.items() if data}


Points = dict[str, list[tuple[float, float]]]


def _location(rows: Sequence[Row]) -> bytes:
    errors = {
        (r["subject"], r["facets"], r["contender"]): r["mean_mm"]
        for r in rows
        if r["kind"] == "error" and r["family"] == place.FAMILY and r["condition"] == _NOISE
    }
    panels: dict[str, Points] = {}
    for row in rows:
        if row["kind"] != "time" or row["family"] != place.FAMILY:
            continue
        alone = any(
            other["kind"] == "time" and other["mode"] == place.RAY and other["contender"] == row["contender"]
            for other in rows
        )
        if row["mode"] != (place.RAY if alone else place.WRENCH):
            continue
        error = errors.get((row["subject"], row["facets"], row["contender"]))
        if error is not None:
            points = panels.setdefault(row["subject"], {}).setdefault(row["contender"], [])
            points.append((row["median_us"], error))
    return _draw(panels, "µs", "mean error, mm, noise filtered")


def _draw(panels: dict[str, Points], x_name: str, y_name: str) -> bytes:
    if not panels:
        return b""
    names = list(dict.fromkeys(name for points in panels.values() for name in points))
    with rc_context(STYLE):
        figure = Figure(figsize=(_PANEL * max(len(panels), 2), _HEIGHT + 0.6), dpi=_DPI, layout="constrained")
        drawn = figure.subplots(1, len(panels), squeeze=False)[0]
        for axes, (title, points) in zip(drawn, panels.items(), strict=True):
            for name, some in points.items():
                k = names.index(name)
                colour = COLOURS[k % len(COLOURS)]
                axes.plot(
                    *zip(*some, strict=True),
                    _MARKS[k % len(_MARKS)],
                    color=colour,
                    markerfacecolor=colour if name == OURS else "none",
                    label=name,
                )
            axes.set(title=title, xlabel=x_name, ylabel=y_name, xscale="log", yscale="log")
            for axis in (axes.xaxis, axes.yaxis):
                axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=6))
                axis.set_major_formatter("{x:g}")
                axis.set_minor_formatter(NullFormatter())
        handles, labels = drawn[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=min(len(panels) + 1, 4), fontsize=7)
        return png(figure)

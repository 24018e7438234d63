"""The picture of a ladder: added contact error against facets, and against the time of a solve."""

from __future__ import annotations

import csv
import json
from io import BytesIO, StringIO
from typing import TYPE_CHECKING, Any, Literal

from contactbench.pipeline.durable import write_file
from contactbench.pipeline.preparation.ladder.compare import LadderError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from contactbench.pipeline.preparation.ladder.ladder import Ladder, Rung

# Okabe and Ito's colours, told apart by everybody.
_OURS, _LOOP, _NOISE, _CHOSEN = "#0072b2", "#d55e00", "#009e73", "#cc79a7"
_INK, _FAINT, _GRID = "#222222", "#6b6b6b", "#dddddd"
_STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "contactbench",
    "font.family": ["DejaVu Sans"],  # comes with Matplotlib: the layout is the same on every machine
    "font.size": 9.0,
    "text.parse_math": False,
    "text.color": _INK,
    "axes.labelcolor": _INK,
    "axes.edgecolor": _FAINT,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": _GRID,
    "grid.linewidth": 0.6,
    "xtick.color": _FAINT,
    "ytick.color": _FAINT,
    "xtick.labelcolor": _INK,
    "ytick.labelcolor": _INK,
}
_SIZE = (9.6, 4.6)  # inches
# Above the axes: the lines may go anywhere inside.
_LEGEND: dict[str, Any] = {
    "loc": "lower left",
    "bbox_to_anchor": (0.0, 1.0),
    "borderaxespad": 0.2,
    "borderpad": 0.0,
    "frameon": False,
    "fontsize": 8,
}
_SMALLEST_MM = 1e-4  # less is rounding, and would stretch the axis for nothing


def draw_ladder(ladder: Ladder, file_type: Literal["svg", "png"], pixels_per_inch: int = 150) -> bytes:
    """
    Draw a ladder.

    Parameters
    ----------
    ladder : Ladder
        With its speeds.
    file_type : {"svg", "png"}
        The same ladder gives the same bytes.
    pixels_per_inch : int
        Of a PNG; the picture is 9.6 inches wide.

    Returns
    -------
    bytes
        The file's content.
    """
    import matplotlib as mpl

    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(_STYLE)
        figure = _draw(ladder)
        data = BytesIO()
        metadata: dict[str, Any] = {"Date": None} if file_type == "svg" else {"Software": None}
        figure.savefig(data, format=file_type, dpi=pixels_per_inch, metadata=metadata)
    return data.getvalue()


def _draw(ladder: Ladder) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=_SIZE, layout="constrained")
    by_facets, by_time = figure.subplots(1, 2, sharey=True)
    rungs = [rung for rung in ladder.rungs[:-1] if rung.judged.noisy.p95 is not None]
    _draw_by_facets(by_facets, ladder, rungs)
    _draw_by_time(by_time, ladder, rungs)
    for axes in (by_facets, by_time):
        axes.set(xscale="log", yscale="log")
        _draw_limits(axes, ladder, words=axes is by_time)
        axes.xaxis.set_major_formatter(_plain)
        axes.yaxis.set_major_formatter(_plain)
    judged = ladder.full.judged
    where = {"region": "in the priority regions"}.get(judged.part, "over the whole probe")
    low, high = ladder.expected.force
    figure.suptitle(
        f"{ladder.probe}: what fewer facets cost {where}, at {low:g} to {high:g} N",
        fontsize=11,
        x=0.01,
        ha="left",
    )
    return figure


def _draw_by_facets(axes: Axes, ladder: Ladder, rungs: Sequence[Rung]) -> None:
    facets = [rung.facets for rung in rungs]
    noisy = [rung.judged.noisy for rung in rungs]
    for name, style in (("max", "^:"), ("p95", "o-"), ("mean", "s--")):
        values = [_shown(difference.statistic(name)) for difference in noisy]  # type: ignore[arg-type]
        width = 1.8 if name == "p95" else 1.0
        axes.plot(facets, values, style, color=_OURS, linewidth=width, markersize=4.5, label=name)
    axes.axvline(ladder.full.facets, color=_FAINT, linewidth=1.0, linestyle=":")
    axes.annotate(
        f"full mesh: {ladder.full.facets:,}",
        (ladder.full.facets, 0.02),
        xycoords=("data", "axes fraction"),
        xytext=(-4, 0),
        textcoords="offset points",
        rotation=90,
        ha="right",
        fontsize=8,
        color=_FAINT,
    )
    _ring(axes, ladder, facets, rungs, words=True)
    axes.set(xlabel="facets", ylabel="added contact error, mm")
    axes.legend(**_LEGEND, ncols=4)


def _draw_by_time(axes: Axes, ladder: Ladder, rungs: Sequence[Rung]) -> None:
    for name, words, colour, marker in (
        ("contactbench", "contactbench", _OURS, "o"),
        ("algorithm1", "the paper's loop", _LOOP, "D"),
    ):
        timed = [rung for rung in rungs if rung.speed is not None]
        times = [getattr(rung.speed, name).median / 1e3 for rung in timed]
        values = [_shown(rung.judged.noisy.p95) for rung in timed]
        axes.plot(
            times, values, marker=marker, color=colour, linewidth=1.8, markersize=4.5, label=f"p95, {words}"
        )
        if ladder.full.speed is not None:
            full = getattr(ladder.full.speed, name).median / 1e3
            axes.axvline(full, color=colour, linewidth=1.0, linestyle=":")
        if name == "algorithm1":
            for rung, time, value in zip(timed, times, values, strict=True):
                axes.annotate(
                    f"{rung.facets:,}", (time, value), xytext=(9, 4), textcoords="offset points", fontsize=7
                )
        _ring(axes, ladder, times, timed)
    axes.set(xlabel="median time of a solve, µs (dotted: full mesh)")
    axes.legend(**_LEGEND, ncols=2)


def _ring(
    axes: Axes, ladder: Ladder, x: Sequence[float], rungs: Sequence[Rung], *, words: bool = False
) -> None:
    """Mark the recommended rung."""
    for at, rung in zip(x, rungs, strict=True):
        if rung is ladder.recommended:
            axes.plot(
                [at],
                [_shown(rung.judged.noisy.p95)],
                marker="o",
                markersize=13,
                markerfacecolor="none",
                markeredgecolor=_CHOSEN,
                markeredgewidth=2.2,
                linestyle="none",
                label="recommended" if words else "_recommended",
            )


def _draw_limits(axes: Axes, ladder: Ladder, *, words: bool) -> None:
    for metres, style, text in (
        (ladder.full.judged.bound, "-", "noise"),
        (ladder.recommendation.limit, "--", "allowed"),
    ):
        if metres > 0:
            axes.axhline(1e3 * metres, color=_NOISE, linewidth=1.4, linestyle=style)
        if metres > 0 and words:
            axes.annotate(
                f"{text} {1e3 * metres:.2g} mm",
                (1.0, 1e3 * metres),
                xycoords=("axes fraction", "data"),
                xytext=(-2, 3),
                textcoords="offset points",
                ha="right",
                fontsize=8,
                color=_NOISE,
            )


def _shown(metres: float | None) -> float:
    return max(1e3 * (metres or 0.0), _SMALLEST_MM)


def _plain(value: float, _position: int | None) -> str:
    return f"{value:,.0f}" if value >= 1_000 else f"{value:g}"


# ---- A ladder's files: data, table and picture, written as a whole or not at all -----------------


def save_ladder(ladder: Ladder, folder: Path) -> tuple[Path, ...]:
    """
    Write ladder.json, ladder.csv, ladder.svg and ladder.png.

    Parameters
    ----------
    ladder : Ladder
        What to write.
    folder : Path
        Exists; files that are there are replaced, each in one step.

    Returns
    -------
    tuple of Path
        The files.

    Raises
    ------
    LadderError
        A file cannot be written; one that was there is left as it was.
    """
    contents = {
        "ladder.json": json.dumps(ladder.to_json(), indent=2, allow_nan=False).encode() + b"\n",
        "ladder.csv": _csv(ladder),
        "ladder.svg": draw_ladder(ladder, "svg"),
        "ladder.png": draw_ladder(ladder, "png"),
    }
    for name, data in contents.items():
        write_file(folder / name, data, LadderError)
    return tuple(folder / name for name in contents)


def _csv(ladder: Ladder) -> bytes:
    columns, rows = ladder.csv_rows()
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(rows)
    return text.getvalue().encode()

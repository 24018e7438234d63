"""The chapter of the confidence study: every figure, and the reliability diagram, from its results alone."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING

from contactbench.assets import PROBE_NAMES
from contactbench.pipeline.study.confidence.study import PARTS, ConfidenceRow
from contactbench.pipeline.study.pages import COLOURS, STYLE, chapter, number, png, table
from contactbench.pipeline.study.report import FigureVerdict

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from contactbench.pipeline.study.results import Results

_PICTURE = "reliability.png"
_ABOUT = """Touches whose place is known, on exact surfaces or on a file's own mesh, located with default gates. An
answer is *sure* if its reason is `ok` or `vertex`. Each figure is a mean over seeds, with the least and the most of
them in brackets; figures in bold miss their bound. Noise is 0.05 N and 2 mN·m, filtered 0.18 times as much.

An answer of the reliability is right if it is within 5 mm or 4.5 standard deviations. Its brackets are 95 % intervals,
and a bin of at least 20 answers misses its bound if its interval lies outside of it. The ellipse is asked of sure
answers that are within 10 mm; the share of all others is in the column *left out*. The ellipse allows for the model's
error: it should hold 95 % where that error is drawn into the wrenches, and holds more without it. The errors beside
the wrench axis are those of touches where both give a point."""
_SAID = {_PICTURE: "Stated confidence against the share of right answers, with 95 % intervals."}


def make(results: Results, folder: Path) -> str:
    """
    Write the diagram into the folder and return the chapter, Markdown.

    Parameters
    ----------
    results : Results
        Of kind ``confidence``.
    """
    known = [field.name for field in fields(ConfidenceRow)]
    rows = [ConfidenceRow(**{name: row[name] for name in known}) for row in results.rows]
    short = [row for row in rows if row.verdict is not FigureVerdict.MET]
    lines = [
        f"- {row.probe}, {row.case}, {row.figure}: {figure(row)}, {bound(row)}: {row.verdict}"
        for row in short
    ]
    verdict = "\n".join(["Bounds that are missed or open:", "", *lines]) if short else "Every bound is kept."
    probes = sorted({row.probe for row in rows if row.part == "one touch"})
    files = (
        "" if set(probes) - set(PROBE_NAMES) else " No probe from a file was measured: `--probe` takes one."
    )
    about = f"{_ABOUT}\n\nProbes: {', '.join(probes)}.{files}\n\n{verdict}"
    return chapter("Confidence", about, tables(rows), {_PICTURE: _diagram(rows)}, _SAID, folder) + "\n"


def tables(rows: Sequence[ConfidenceRow]) -> list[tuple[str, str]]:
    """Return a title and a table, Markdown, for each part: a line for each case, a column for each figure."""
    return [(title, _table([row for row in rows if row.part == part])) for part, title in PARTS.items()]


def _table(rows: Sequence[ConfidenceRow]) -> str:
    if rows and rows[0].stated is not None:
        columns = ["probe", "case", "answers", "stated", "right", "bound"]
        lines = [
            [row.probe, row.case, f"{row.tries:,}", f"{number(row.stated)} %", _marked(row), bound(row)]
            for row in rows
        ]
        return table(columns, lines)
    figures = list(dict.fromkeys(row.figure for row in rows))
    bounds = {row.figure: bound(row) for row in rows if bound(row) and row.probe != "t-shape"}
    cells: dict[tuple[str, str], dict[str, str]] = {}
    for row in rows:
        cells.setdefault((row.probe, row.case), {})[row.figure] = _marked(row)
    heads = [f"{name} ({bounds[name]})" if name in bounds else name for name in figures]
    return table(
        ["probe", "case", *heads], [[*at, *(own.get(f, "–") for f in figures)] for at, own in cells.items()]
    )


def figure(row: ConfidenceRow) -> str:
    """Return a figure with its 95 % interval, for people."""
    spread = "" if row.low == row.high else f" ({number(row.low)} to {number(row.high)})"
    return f"{number(row.value)}{spread}{f' {row.unit}' if row.unit else ''}"


def bound(row: ConfidenceRow) -> str:
    """Return what a figure must keep, for people; nothing where it is only shown."""
    if row.at_least is not None and row.at_most is not None:
        return f"{number(row.at_least)} to {number(row.at_most)}"
    if row.at_least is not None:
        return f"at least {number(row.at_least)}"
    return "" if row.at_most is None else f"at most {number(row.at_most)}"


def _marked(row: ConfidenceRow) -> str:
    return figure(row) if row.verdict is FigureVerdict.MET else f"**{figure(row)}**"


def _diagram(rows: Sequence[ConfidenceRow]) -> bytes:
    import matplotlib as mpl
    from matplotlib.figure import Figure

    found: dict[tuple[str, str], list[ConfidenceRow]] = {}
    for row in rows:
        if row.stated is not None:
            found.setdefault((row.probe, row.case), []).append(row)
    with mpl.rc_context(STYLE):
        drawn = Figure(figsize=(5.0, 4.2), dpi=120, layout="constrained")
        axes = drawn.subplots()
        axes.plot([0, 100], [0, 100], color="#888888", linewidth=0.8)
        colours = {
            probe: COLOURS[i % len(COLOURS)] for i, probe in enumerate(dict.fromkeys(p for p, _ in found))
        }
        for (probe, case), own in found.items():
            low, high = [r.value - r.low for r in own], [r.high - r.value for r in own]
            mark = "s" if "declared" in case else "o"
            axes.errorbar(
                [float(r.stated or 0.0) for r in own],
                [r.value for r in own],
                [low, high],
                fmt=mark,
                color=colours[probe],
                elinewidth=0.8,
                label=f"{probe}, {case}",
            )
        axes.set(xlabel="stated confidence, %", ylabel="right, %", xlim=(0, 101), ylim=(0, 101))
        axes.legend(fontsize=7)
        return png(drawn)

"""The rivals' chapter of the results page, from their rows alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from contactbench.pipeline.study.pages import COLOURS, STYLE, chapter, number, png, table
from contactbench.pipeline.study.rivals.rows import FAMILY, MARGIN, OURS, RAY, WRENCH, Duel, duels

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from contactbench.pipeline.study.results import Results

Row = dict[str, Any]
_MAIN_NOISE = "filtered"
_ROUNDING_MM = 1e-6
_MARKS = "osv^D<>P"
_PANEL, _HEIGHT, _DPI = 3.3, 3.0, 80
_SAID = "Time against error of everybody, in one run; ours filled. Times from Python; a ray alone for ray tracers."
_ABOUT = f"""Everybody gets the same inputs, in turns, in one process. Times are medians, with the 5th to 95th
percentile of the rounds; ratios are to contactbench in the same run. A ray tracer's time for one prepared ray counts as
if it were a whole solve: in its favour. Faster or more accurate means by more than {MARGIN - 1:.0%}, and in paired
errors by twice their standard error; who answers less than 99 % of what ours answers is not more accurate."""


def make(results: Results, folder: Path) -> str:
    """
    Write the pictures and return the chapter.

    Parameters
    ----------
    folder : Path
        For the pictures.

    Raises
    ------
    InputError
        A picture cannot be written.
    """
    rows = [row for row in results.rows if row["family"] == FAMILY]
    pictures = {name: data for name, data in {"location.png": _location(rows)}.items() if data}
    return chapter("Rivals, measured", _ABOUT, tables(rows), pictures, dict.fromkeys(pictures, _SAID), folder)


def tables(rows: Sequence[Row]) -> list[tuple[str, str]]:
    """Return the tables, each with its title; the verdict first."""
    found = duels(rows)
    return [
        ("Is anybody both faster and more accurate?", verdict(found)),
        (FAMILY.capitalize(), _meshes(rows, found)),
        ("What was measured", _versions(rows)),
    ]


def verdict(found: Sequence[Duel]) -> str:
    """Return who is both faster and more accurate than ours, and who is one of them where."""
    winners = [duel for duel in found if duel.beats]
    faster = sorted({duel.contender for duel in found if duel.faster})
    better = sorted({duel.contender for duel in found if duel.better})
    counts = [FAMILY, str(len(found)), str(len(winners))]
    line = [*counts, "; ".join(faster) or "nobody", "; ".join(better) or "nobody"]
    columns = ["family", "comparisons", "both", "faster somewhere", "more accurate somewhere"]
    text = table(columns, [line] if found else [])
    for contender in dict.fromkeys(duel.contender for duel in winners):
        mine = [duel for duel in winners if duel.contender == contender]
        text += f"\n\n**{contender}** is both in {len(mine)} of the comparisons of {FAMILY}.\n\n"
        text += "\n".join(f"- {duel.words}." for duel in mine)
    return text


def _meshes(rows: Sequence[Row], found: Sequence[Duel]) -> str:
    """Return a table for each mesh; those that are not of the middle size are folded away."""
    subjects = dict.fromkeys((row["subject"], row["facets"]) for row in rows if row["kind"] == "error")
    counts = sorted({facets for _, facets in subjects})
    shown: list[str] = []
    others: list[str] = []
    for subject, facets in subjects:
        mine = [row for row in rows if (row.get("subject"), row.get("facets")) == (subject, facets)]
        text = f"**{subject}, {facets:,} facets**\n\n{_subject(mine, found)}"
        (shown if facets == counts[len(counts) // 2] else others).append(text)
    if others:
        folded = "\n\n".join(others)
        shown.append(f"<details><summary>Other meshes</summary>\n\n{folded}\n\n</details>")
    return "\n\n".join(shown)


def _subject(mine: Sequence[Row], found: Sequence[Duel]) -> str:
    conditions = list(dict.fromkeys(r["condition"] for r in mine if r["kind"] == "error"))
    modes = list(dict.fromkeys(r["mode"] for r in mine if r["kind"] == "time"))
    lines = []
    for contender in dict.fromkeys(r["contender"] for r in mine):
        errors = {r["condition"]: r for r in mine if r["kind"] == "error" and r["contender"] == contender}
        times = {r["mode"]: r for r in mine if r["kind"] == "time" and r["contender"] == contender}
        ratio = min(
            (d.ratio for d in found if _same(d, mine[0], contender) and d.ratio is not None), default=None
        )
        cells = [f"**{contender}**" if contender.startswith(OURS) else contender]
        cells += [_span(times.get(mode)) for mode in modes]
        cells.append("1" if contender == OURS else number(ratio, ".2g"))
        cells += [_error(errors.get(condition)) for condition in conditions]
        kept = errors.get(_MAIN_NOISE, next(iter(errors.values())))
        cells.append(f"{100 * kept['answered']:.1f}")
        lines.append(cells)
    figures = [*(f"{_condition(condition)}, mean mm" for condition in conditions), "answered %"]
    return table(["contender", *(f"{mode}, µs" for mode in modes), "least time / ours", *figures], lines)


def _same(duel: Duel, row: Row, contender: str) -> bool:
    return (duel.subject, duel.facets, duel.contender) == (row["subject"], row["facets"], contender)


def _condition(name: str) -> str:
    return {"none": "no noise", "filtered": "noise filtered", "one reading": "noise of a reading"}.get(
        name, name
    )


def _span(row: Row | None) -> str:
    if row is None:
        return "–"
    return f"{row['median_us']:.3g} ({row['low_us']:.3g}–{row['high_us']:.3g})"


def _error(row: Row | None) -> str:
    if row is None:
        return "–"
    mean = "0" if row["mean_mm"] is not None and row["mean_mm"] < _ROUNDING_MM else number(row["mean_mm"])
    apart = row["worse_mm"]
    if row["contender"].startswith(OURS) or apart is None:
        return mean
    if abs(apart) < _ROUNDING_MM:
        return f"{mean} (as ours)"
    return f"{mean} ({apart:+.2g} ± {row['worse_se_mm']:.1g})"


def _versions(rows: Sequence[Row]) -> str:
    lines = [
        [r["contender"], r["family"], r["package"], r["version"] or "–"]
        for r in rows
        if r["kind"] == "version"
    ]
    lines += [[r["contender"], r["family"], r["package"], r["note"]] for r in rows if r["kind"] == "missing"]
    return table(["contender", "for", "package", "version"], lines)


# ---- the picture --------------------------------------------------------------------------------

Points = dict[str, list[tuple[float, float]]]


def _location(rows: Sequence[Row]) -> bytes:
    errors = {
        (r["subject"], r["facets"], r["contender"]): r["mean_mm"]
        for r in rows
        if r["kind"] == "error" and r["condition"] == _MAIN_NOISE
    }
    panels: dict[str, Points] = {}
    for row in rows:
        if row["kind"] != "time":
            continue
        alone = any(
            other["kind"] == "time" and other["mode"] == RAY and other["contender"] == row["contender"]
            for other in rows
        )
        if row["mode"] != (RAY if alone else WRENCH):
            continue
        error = errors.get((row["subject"], row["facets"], row["contender"]))
        if error is not None:
            points = panels.setdefault(row["subject"], {}).setdefault(row["contender"], [])
            points.append((row["median_us"], error))
    return _draw(panels)


def _draw(panels: dict[str, Points]) -> bytes:
    if not panels:
        return b""
    from matplotlib import rc_context
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator, NullFormatter

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
            axes.set(
                title=title, xlabel="µs", ylabel="mean error, mm, noise filtered", xscale="log", yscale="log"
            )
            for axis in (axes.xaxis, axes.yaxis):
                axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=6))
                axis.set_major_formatter("{x:g}")
                axis.set_minor_formatter(NullFormatter())
        handles, labels = drawn[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=min(len(panels) + 1, 4), fontsize=7)
        return png(figure)

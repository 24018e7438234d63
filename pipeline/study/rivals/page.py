"""The rivals' chapter of the results page, from their rows alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from contactbench.pipeline.study.pages import chapter, number, table
from contactbench.pipeline.study.rivals import place
from contactbench.pipeline.study.rivals.rows import OURS
from contactbench.pipeline.study.rivals.verdicts import MARGIN, Duel, duels

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from contactbench.pipeline.study.results import Results

Row = dict[str, Any]
_MAIN_NOISE = "filtered"
_ROUNDING_MM = 1e-6
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
    from contactbench.pipeline.study.rivals.plots import plots

    # Earlier versions measured planes, meshes and calibrations, too.
    rows = [row for row in results.rows if row["family"] == place.FAMILY]
    pictures = plots(rows)
    return chapter("Rivals, measured", _ABOUT, tables(rows), pictures, dict.fromkeys(pictures, _SAID), folder)


def tables(rows: Sequence[Row]) -> list[tuple[str, str]]:
    """Return the tables, each with its title; the verdict first."""
    found = duels(rows)
    made = [("Is anybody both faster and more accurate?", verdict(found))]
    for family in (place.FAMILY,):
        text = _family(family, rows, found)
        if text:
            made.append((family.capitalize(), text))
    made.append(("What was measured", _versions(rows)))
    return made


def verdict(found: Sequence[Duel]) -> str:
    """Return who is both faster and more accurate than ours, and who is one of them where."""
    winners = [duel for duel in found if duel.beats]
    lines = []
    for family in (place.FAMILY,):
        mine = [duel for duel in found if duel.family == family]
        if not mine:
            continue
        beaten = [duel for duel in winners if duel.family == family]
        faster = sorted({duel.contender for duel in mine if duel.faster})
        better = sorted({duel.contender for duel in mine if duel.better})
        lines.append(
            [
                family,
                str(len(mine)),
                str(len(beaten)),
                "; ".join(faster) or "nobody",
                "; ".join(better) or "nobody",
            ]
        )
    text = table(["family", "comparisons", "both", "faster somewhere", "more accurate somewhere"], lines)
    for family, contender in dict.fromkeys((duel.family, duel.contender) for duel in winners):
        mine = [duel for duel in winners if (duel.family, duel.contender) == (family, contender)]
        count = f"{len(mine)} of the comparisons of {family}"
        text += f"\n\n**{contender}** is both in {count}.\n\n"
        text += "\n".join(f"- {duel.words}." for duel in mine)
    return text


def _family(family: str, rows: Sequence[Row], found: Sequence[Duel]) -> str:
    parts: list[str] = []
    subjects = dict.fromkeys(
        (row["subject"], _facets(row))
        for row in rows
        if row.get("family") == family and row["kind"] == "error"
    )
    details: list[str] = []
    for subject, facets in subjects:
        mine = [
            r
            for r in rows
            if r.get("family") == family and (r.get("subject"), _facets(r)) == (subject, facets)
        ]
        name = subject + (f", {facets:,} facets" if facets else "")
        text = f"**{name}**\n\n{_subject(mine, found)}"
        (details if family == place.FAMILY and facets != _middle(subjects) else parts).append(text)
    if details:
        shown = "\n\n".join(details)
        parts.append(f"<details><summary>Other meshes</summary>\n\n{shown}\n\n</details>")
    return "\n\n".join(parts)


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
    mine = (row["family"], row["subject"], _facets(row), contender)
    return (duel.family, duel.subject, duel.facets, duel.contender) == mine


def _facets(row: Row) -> int | None:
    return row.get("facets") if row.get("family") == place.FAMILY else None


def _middle(subjects: Any) -> int | None:
    counts = sorted({facets for _, facets in subjects if facets})
    return counts[len(counts) // 2] if counts else None


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

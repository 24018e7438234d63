"""The chapter of the stability study: verdicts, pictures and tables, from its results alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.pipeline.study.markdown import number, table
from contactbench.pipeline.study.stability import precision
from contactbench.pipeline.study.stability.rows import PARTS, Row, of_part
from contactbench.pipeline.study.stability.verdicts import verdicts

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from contactbench.pipeline.study.results import Results

_COLUMNS = ("case", "figure", "by", "over", "tries", "worst", "at", "bound", "")
_HEAD = """## Numerical stability

The solver in double precision, and its own sources compiled with every double a float ("single"), against a truth in
long double or exact rational numbers that shares no code with it. The *condition* is how far the contact moves for each
unit of relative error of force and torque, from the derivative of the closed form; a *roundoff* is half a unit in the
last place of 1. Every line is the worst of its tries."""


def make(results: Results, folder: Path) -> str:
    """
    Write the pictures into the folder and return the chapter, Markdown.

    Parameters
    ----------
    results : Results
        Of kind ``stability``.
    folder : Path
    """
    from contactbench.pipeline.study.stability import pictures

    rows = [Row.from_json(row) for row in results.rows]
    parts = [_HEAD, verdict_list(rows)]
    for name, alt in pictures.draw(rows, folder):
        parts.append(f"![{alt}]({name})")
    folded = (
        f"<details><summary>{title}: every figure</summary>\n\n{text}\n\n</details>"
        for title, text in tables(rows)
    )
    return "\n\n".join([*parts, *folded]) + "\n"


def verdict_list(rows: Sequence[Row]) -> str:
    """Return a line for each part: its verdict in bold where a bound broke."""
    lines = []
    for verdict in verdicts(rows):
        state = {True: "kept", False: "**broken**", None: "not measured"}[verdict.passed]
        lines.append(f"- *{PARTS[verdict.part]}* ({state}): {verdict.words}")
    return "\n".join(lines)


def tables(rows: Sequence[Row]) -> list[tuple[str, str]]:
    """Return a title and a table, Markdown, for each part: rows that differ only in their place are one line."""
    return [
        (PARTS[part], table(_COLUMNS, [_line(group) for group in _groups(of_part(rows, part))]))
        for part in PARTS
        if of_part(rows, part)
    ]


def _groups(rows: Sequence[Row]) -> list[list[Row]]:
    found: dict[tuple[object, ...], list[Row]] = {}
    for row in rows:
        found.setdefault((_every_probe(row), row.figure, row.by, row.axis, row.most), []).append(row)
    return list(found.values())


def _every_probe(row: Row) -> str:
    """Return a row's case without the name of a probe: what was tried on all of them is one line."""
    return f"all probes, {row.case.partition(', ')[2]}" if row.part == precision.PART else row.case


def _line(group: list[Row]) -> list[str]:
    known = [row for row in group if row.worst == row.worst] or group
    worst = max(known, key=lambda row: row.worst)
    places = [row.x for row in group if row.x is not None]
    over = "" if not places else f"{worst.axis}: {number(min(places))} to {number(max(places))}"
    unit = f" {worst.unit}" if worst.unit else ""
    bound = "" if worst.most is None else f"{number(worst.most)}{unit}"
    kept = "" if worst.most is None else "kept" if all(row.met for row in group) else "**broken**"
    place = "" if worst.x is None else number(worst.x)
    cells = (_every_probe(worst), worst.figure, worst.by, over, f"{sum(row.tries for row in group):,}")
    return [c.replace("|", "\\|") for c in (*cells, f"{number(worst.worst)}{unit}", place, bound, kept)]

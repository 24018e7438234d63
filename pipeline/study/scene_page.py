"""The chapter of what a scene costs or leaves out, from the rows of its tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from contactbench.pipeline.study.pages import chapter, table
from contactbench.pipeline.study.report import short

if TYPE_CHECKING:
    from pathlib import Path

    from contactbench.pipeline.study.report import StudyReport
    from contactbench.pipeline.study.results import Results

KIND = "scene"
_ABOUT = ("study", "notes", "table")  # columns that are none of a table's own


def rows_of(report: StudyReport) -> list[dict[str, Any]]:
    """Return the rows of all tables of a report, each with the table and the study that it is of."""
    notes = " ".join(report.notes)
    return [
        {"study": report.title, "notes": notes, "table": sheet.title, **row}
        for sheet in report.sheets
        for row in sheet.to_json()
    ]


def make(results: Results, folder: Path) -> str:
    """
    Return the chapter, Markdown: a table for each mix, or for each thing that a moving scene leaves out.

    Parameters
    ----------
    results : Results
        Of kind ``scene``.
    folder : Path
        There are no pictures to write there.
    """
    first = results.rows[0]
    tables = []
    for title in dict.fromkeys(row["table"] for row in results.rows):
        mine = [row for row in results.rows if row["table"] == title]
        # Of the columns of all tables only those that this one has.
        own = [name for name in first if name not in _ABOUT and any(row[name] is not None for row in mine)]
        tables.append((title, table(own, [[short(row[name]) for name in own] for row in mine])))
    return chapter(first["study"], first["notes"], tables, {}, {}, folder)

"""Tables as Markdown."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence


def table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table; columns of figures are flush right."""
    figures = [any(row[i][:1].isdigit() or row[i][:1] in "-–" for row in rows) for i in range(len(columns))]
    lines = ["| " + " | ".join(columns) + " |", "|" + "".join("---:|" if f else "---|" for f in figures)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def number(value: float | None, digits: str = ".3g") -> str:
    """Return a figure, an en dash where there is none."""
    return "–" if value is None or value != value else format(value, digits)

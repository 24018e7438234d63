"""Tables that go to a CSV file, a Markdown file, the terminal and JSON alike."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    from rich.table import Table

Cell = str | int | float | None


@dataclass(frozen=True)
class Sheet:
    """
    One table.

    Attributes
    ----------
    name : str
        Of its file, without ending.
    title : str
    columns : tuple of str
        With units.
    rows : tuple of tuple
        A NaN is no value.
    shown : bool
        For people too; a long table, or one that every run changes, is only for its file and JSON.
    """

    name: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    shown: bool = True

    def csv(self) -> str:
        """Write it with all digits."""
        return "\n".join([",".join(self.columns), *(",".join(map(_whole, row)) for row in self.rows)]) + "\n"

    def markdown(self) -> str:
        """Write it with three digits, under a heading."""
        lines = [f"## {self.title}", "", _line(self.columns), "|---" * len(self.columns) + "|"]
        return "\n".join([*lines, *(_line([short(cell) for cell in row]) for row in self.rows)]) + "\n"

    def table(self) -> Table:
        """Build it for the terminal."""
        from rich.table import Table
        from rich.text import Text

        table = Table(title=self.title)
        for column in self.columns:
            table.add_column(column)
        for row in self.rows:
            table.add_row(*(Text(short(cell)) for cell in row))
        return table

    def to_json(self) -> list[dict[str, Any]]:
        """Return a row as one object by column."""
        return [dict(zip(self.columns, map(_plain, row), strict=True)) for row in self.rows]


def short(cell: Cell) -> str:
    """Write one cell with three digits; a dash for no value."""
    if cell is None or (isinstance(cell, float) and not isfinite(cell)):
        return "-"
    if isinstance(cell, float):
        if abs(cell) < 5e-4:
            return "0"
        return f"{cell:,.0f}" if abs(cell) >= 100 else f"{cell:.2f}" if abs(cell) >= 0.1 else f"{cell:.3f}"
    return str(cell)


def write_text(file: Path, text: str) -> None:
    """
    Put text in a file in one step.

    Raises
    ------
    InputError
        It cannot be written.
    """
    write_bytes(file, text.encode())


def write_bytes(file: Path, data: bytes) -> None:
    """
    Put bytes in a file in one step.

    Raises
    ------
    InputError
        It cannot be written.
    """
    try:
        write_durably(file, data)
    except (OSError, ValueError) as error:
        raise InputError(
            f"{file}: the file cannot be written ({error}): choose a folder that is writable and has space."
        ) from error


def _line(cells: tuple[str, ...] | list[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def _plain(cell: Cell) -> Cell:
    return None if isinstance(cell, float) and not isfinite(cell) else cell


def _whole(cell: Cell) -> str:
    value = _plain(cell)
    text = "" if value is None else repr(value) if isinstance(value, float) else str(value)
    return f'"{text}"' if "," in text else text

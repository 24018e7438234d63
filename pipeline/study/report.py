"""What studies and benchmarks report: figures with their targets, and tables."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from contactbench.pipeline.durable import make_folder, write_file

if TYPE_CHECKING:
    from pathlib import Path

    import numpy.typing as npt
    from rich.table import Table


_HEADINGS = ("of", "figure", "target", "measured", "spread", "worst")


Cell = str | int | float | None


@dataclass(frozen=True)
class Sheet:
    """One table."""

    name: str  # of its file, without ending
    title: str
    columns: tuple[str, ...]  # with units
    rows: tuple[tuple[Cell, ...], ...]  # a NaN is no value
    # for people too; a long table, or one that every run changes, is only for its file and JSON
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
    if cell is None or (isinstance(cell, float) and not np.isfinite(cell)):
        return "-"
    if isinstance(cell, float):
        if abs(cell) < 5e-4:
            return "0"
        return f"{cell:,.0f}" if abs(cell) >= 100 else f"{cell:.2f}" if abs(cell) >= 0.1 else f"{cell:.3f}"
    return str(cell)


@dataclass(frozen=True)
class Figure:
    """One measured figure, and what it must reach."""

    subject: str  # what was measured: a shape, a file, a method
    name: str
    measured: float  # the headline: the median where there are several values
    unit: str = ""  # written behind the numbers; "" for ratios and counts
    # least, most: the target; both None where there is none
    least: float | None = None
    most: float | None = None
    spread: tuple[float, float] | None = None  # 5th and 95th percentile; None for a single value
    worst: float | None = None  # the value furthest towards missing the target
    judged: Literal["measured", "worst"] = "measured"  # which of them the target is for

    @classmethod
    def of(
        cls,
        subject: str,
        name: str,
        values: npt.ArrayLike,
        unit: str = "",
        *,
        least: float | None = None,
        most: float | None = None,
        judged: Literal["measured", "worst"] = "measured",
    ) -> Figure:
        """
        Sum up several values of one figure: median, 5th to 95th percentile, worst.

        Parameters
        ----------
        subject, name, unit, least, most, judged
            See the attributes.
        values : (n,) array_like
            At least one.
        """
        numbers = np.asarray(values, dtype=np.float64)
        low, middle, high = np.percentile(numbers, [5, 50, 95]).tolist()
        worst = float(numbers.min() if least is not None else numbers.max())
        return cls(subject, name, middle, unit, least, most, (low, high), worst, judged)

    @property
    def passed(self) -> bool:
        """Whether the target is reached; True where there is none. What is not a number reaches no target."""
        if self.least is None and self.most is None:
            return True
        value = self.worst if self.judged == "worst" and self.worst is not None else self.measured
        above = self.least is None or value >= self.least
        return bool(above and (self.most is None or value <= self.most))

    @property
    def target(self) -> str:
        """The target in words; empty where there is none."""
        of = " (worst)" if self.judged == "worst" and self.worst is not None else ""
        match self.least, self.most:
            case None, None:
                return ""
            case None, most:
                return f"at most {self._said(most)}{of}"
            case least, None:
                return f"at least {self._said(least)}{of}"
            case least, most if least == most:
                return f"{self._said(least)}{of}"
            case least, most:
                return f"{_number(least)} to {self._said(most)}{of}"

    @property
    def cells(self) -> tuple[str, ...]:
        """The figure as a row of a table."""
        spread = "" if self.spread is None else f"{_number(self.spread[0])} to {self._said(self.spread[1])}"
        worst = "" if self.worst is None else self._said(self.worst)
        return (self.subject, self.name, self.target, self._said(self.measured), spread, worst)

    def to_json(self) -> dict[str, Any]:
        """Give the figure as plain values; null for what is not a number."""
        data = {**asdict(self), "target": self.target, "passed": self.passed}
        return {name: _plain(value) for name, value in data.items()}

    def _said(self, value: float | None) -> str:
        text = _number(value)
        return f"{text} {self.unit}" if self.unit else text


@dataclass(frozen=True)
class StudyReport:
    """All figures of a study."""

    title: str
    settings: dict[str, Any]  # what the figures depend on: counts and seed
    figures: tuple[Figure, ...]
    notes: tuple[str, ...] = ()  # what the numbers do not say, in sentences
    sheets: tuple[Sheet, ...] = ()  # tables beside the figures
    # more files to write, by name: pictures and recordings
    files: dict[str, bytes] = field(default_factory=dict)
    # where the set-up differs from the one that the figures are compared with
    differences: tuple[str, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether every figure reached its target."""
        return all(figure.passed for figure in self.figures)

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        return {
            "passed": self.passed,
            "title": self.title,
            "settings": self.settings,
            "figures": [figure.to_json() for figure in self.figures],
            "notes": list(self.notes),
            **({"differences": list(self.differences)} if self.differences else {}),
            **{sheet.name: sheet.to_json() for sheet in self.sheets},
        }

    def write(self, out: Path, page: str = "report.md") -> None:
        """
        Write the report as a Markdown file, or, with tables, a folder: `page`, a CSV file a table, and all files.

        Raises
        ------
        InputError
            It cannot be written.
        """
        if not self.sheets:
            write_file(out, self.markdown().encode())
            return
        make_folder(out)
        write_file(out / page, self.markdown().encode())
        for sheet in self.sheets:
            write_file(out / f"{sheet.name}.csv", sheet.csv().encode())
        for name, data in self.files.items():
            make_folder((out / name).parent)
            write_file(out / name, data)

    def table(self) -> Table:
        """Build the table for the terminal; what misses its target is red."""
        from rich.table import Table
        from rich.text import Text

        built = Table(title=self._heading, caption=" ".join(self.notes) or None, caption_justify="left")
        for heading in _HEADINGS:
            built.add_column(heading)
        for figure in self.figures:
            # File names must not be read as markup.
            built.add_row(*map(Text, figure.cells), style="" if figure.passed else "red")
        return built

    def markdown(self) -> str:
        """Write the figures, and the tables that people read, as Markdown."""
        lines = [f"{self._heading}\n", "| " + " | ".join((*_HEADINGS, "")) + " |", "|---" * 7 + "|"]
        for figure in self.figures:
            verdict = "" if not figure.target else "ok" if figure.passed else "MISSED"
            cells = (cell.replace("|", "\\|").replace("\n", " ") for cell in (*figure.cells, verdict))
            lines.append("| " + " | ".join(cells) + " |")
        parts = ["\n".join([*lines, "", *self.notes]).rstrip() + "\n"]
        parts += [sheet.markdown() for sheet in self.sheets if sheet.shown]
        parts += [f"![{name}]({name})\n" for name in self.files if name.endswith(".png")]
        if self.differences:
            parts.append("## What differs\n\n" + "".join(f"- {sentence}\n" for sentence in self.differences))
        return "\n".join(parts)

    @property
    def _heading(self) -> str:
        return f"{self.title}: " + ", ".join(f"{name} {value}" for name, value in self.settings.items())


def _number(value: float | None) -> str:
    if value is None or not np.isfinite(value):
        return "-"
    if value == round(value):
        return f"{value:,.0f}"
    if abs(value) < 1e-3:
        return f"{value:.1e}"
    # Three digits also where the last is 0: 1.10 is not 1.1.
    return f"{value:,.0f}" if abs(value) >= 100 else f"{value:#.3g}"


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    if isinstance(value, float):
        return value if np.isfinite(value) else None
    return value


def _line(cells: tuple[str, ...] | list[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def _whole(cell: Cell) -> str:
    value = _plain(cell)
    text = "" if value is None else repr(value) if isinstance(value, float) else str(value)
    return f'"{text}"' if "," in text else text

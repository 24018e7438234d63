"""What studies and benchmarks report: figures with their targets, and tables."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from contactbench.pipeline.durable import make_folder, write_file

if TYPE_CHECKING:
    from pathlib import Path

    import numpy.typing as npt
    from rich.table import Table


_HEADINGS = ("of", "figure", "target", "measured", "95 % interval", "spread", "worst", "verdict")
_CONFIDENCE = 0.95


class FigureVerdict(StrEnum):
    """Whether a figure reaches its target."""

    MET = "met"
    OPEN = "open"  # it does not, but by so little that other seeds might have
    MISSED = "missed"


# How a verdict is coloured on a terminal.
STYLES = {FigureVerdict.MET: "", FigureVerdict.OPEN: "yellow", FigureVerdict.MISSED: "red"}


def verdict_of(
    measured: float,
    interval: tuple[float, float] | None = None,
    *,
    least: float | None = None,
    most: float | None = None,
) -> FigureVerdict:
    """
    Judge a figure: missed only if its interval lies wholly beyond the target, so that few trials do not by chance.

    Parameters
    ----------
    measured : float
        What is not a number reaches no target.
    interval : (low, high), optional
        In which the figure lies with 95 %; left out, there is no doubt about it.
    least, most : float, optional
        The target; both left out, there is none, and it is met.
    """

    def beyond(low: float, high: float) -> bool:
        return not ((least is None or high >= least) and (most is None or low <= most))

    if (least is None and most is None) or not beyond(measured, measured):
        return FigureVerdict.MET
    return (
        FigureVerdict.MISSED
        if interval is None or np.isnan(measured) or beyond(*interval)
        else FigureVerdict.OPEN
    )


def mean_interval(values: npt.ArrayLike) -> tuple[float, float] | None:
    """Return in what the mean of several values lies with 95 % (Student's t); None for fewer than two numbers."""
    from scipy.stats import t

    numbers = np.asarray(values, dtype=np.float64)
    numbers = numbers[np.isfinite(numbers)]
    if len(numbers) < 2:
        return None
    mean, size = float(numbers.mean()), float(numbers.std(ddof=1)) / np.sqrt(len(numbers))
    off = float(t.ppf((1 + _CONFIDENCE) / 2, len(numbers) - 1)) * float(size)
    return mean - off, mean + off


def share_interval(hits: int, trials: int) -> tuple[float, float]:
    """Return in what a share lies with 95 %, 0 to 1 (Clopper and Pearson)."""
    from scipy.stats import beta

    tail = (1 - _CONFIDENCE) / 2
    low = float(beta.ppf(tail, hits, trials - hits + 1)) if hits else 0.0
    high = float(beta.ppf(1 - tail, hits + 1, trials - hits)) if hits < trials else 1.0
    return low, high


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

        table = Table(*self.columns, title=self.title)
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
    measured: float  # the headline: the mean where there are several values
    unit: str = ""  # written behind the numbers; "" for ratios and counts
    # least, most: the target; both None where there is none
    least: float | None = None
    most: float | None = None
    values: tuple[float, ...] = ()  # one for each seed or trial; none for a single value
    worst: float | None = None  # the value furthest towards missing the target
    judged: Literal["measured", "worst"] = "measured"  # which of them the target is for
    interval: tuple[float, float] | None = None  # in which what is measured lies with 95 %

    @classmethod
    def of(
        cls,
        subject: str,
        name: str,
        values: npt.ArrayLike,
        unit: str = "",
        *,
        measured: float | None = None,
        least: float | None = None,
        most: float | None = None,
        judged: Literal["measured", "worst"] = "measured",
    ) -> Figure:
        """
        Sum up several values of one figure: mean and its interval, spread, worst.

        Parameters
        ----------
        subject, name, unit, least, most, judged
            See the attributes.
        values : (n,) array_like
            At least one; by seed, so that they are independent.
        measured : float, optional
            The headline where it is not their mean: a figure of all trials together.
        """
        numbers = np.asarray(values, dtype=np.float64)
        headline = float(numbers.mean()) if measured is None else measured
        worst = float(numbers.min() if least is not None else numbers.max())
        own = tuple(numbers.tolist())
        return cls(subject, name, headline, unit, least, most, own, worst, judged, mean_interval(numbers))

    @classmethod
    def share(
        cls,
        subject: str,
        name: str,
        hits: int,
        trials: int,
        *,
        least: float | None = None,
        most: float | None = None,
    ) -> Figure:
        """Sum up how many of several trials, in percent."""
        low, high = share_interval(hits, trials)
        interval = 100 * low, 100 * high
        return cls(subject, name, 100 * hits / trials, "%", least, most, interval=interval)

    @property
    def verdict(self) -> FigureVerdict:
        """Whether the target is reached; met where there is none."""
        if self.judged == "worst" and self.worst is not None:
            return verdict_of(self.worst, least=self.least, most=self.most)
        return verdict_of(self.measured, self.interval, least=self.least, most=self.most)

    @property
    def passed(self) -> bool:
        """Whether the target is not missed."""
        return self.verdict is not FigureVerdict.MISSED

    @property
    def spread(self) -> tuple[float, float] | None:
        """5th and 95th percentile of the values; None for fewer than two."""
        if len(self.values) < 2:
            return None
        low, high = np.percentile(self.values, [5, 95]).tolist()
        return low, high

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
        interval, spread = (
            "" if pair is None else f"{_number(pair[0])} to {self._said(pair[1])}"
            for pair in (self.interval, self.spread)
        )
        worst = "" if self.worst is None else self._said(self.worst)
        verdict = str(self.verdict) if self.target else ""
        return (
            self.subject,
            self.name,
            self.target,
            self._said(self.measured),
            interval,
            spread,
            worst,
            verdict,
        )

    def to_json(self) -> dict[str, Any]:
        """Give the figure as plain values; null for what is not a number."""
        data = {**asdict(self), "spread": self.spread, "target": self.target, "verdict": str(self.verdict)}
        data["passed"] = self.passed
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
        """Whether no figure missed its target."""
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
        Write the report: a Markdown file with its pictures beside it, or a folder.

        Parameters
        ----------
        out : Path
            A file, if there are no tables or it ends in .md; else a folder for the page, tables as CSV, and pictures.
        page : str
            Name of the page in a folder.

        Raises
        ------
        InputError
            It cannot be written.
        """
        alone = not self.sheets or out.suffix == ".md"
        folder = out.parent if alone else out
        make_folder(folder)
        write_file(out if alone else out / page, self.markdown().encode())
        for sheet in () if alone else self.sheets:
            write_file(out / f"{sheet.name}.csv", sheet.csv().encode())
        for name, data in self.files.items():
            make_folder((folder / name).parent)
            write_file(folder / name, data)

    def table(self) -> Table:
        """Build the table for the terminal; what misses its target is red, what is open yellow."""
        from rich.table import Table
        from rich.text import Text

        title, caption = f"{self.title}: {self._settings}", " ".join(self.notes) or None
        built = Table(*_HEADINGS, title=title, caption=caption, caption_justify="left")
        for figure in self.figures:
            # File names must not be read as markup.
            built.add_row(*map(Text, figure.cells), style=STYLES[figure.verdict])
        return built

    def tables(self) -> list[Table]:
        """Build all that people read for the terminal: tables, and the figures where there are any."""
        shown = [sheet.table() for sheet in self.sheets if sheet.shown]
        return [*shown, self.table()] if self.figures else shown

    def markdown(self) -> str:
        """Write the figures, and the tables that people read, as Markdown."""
        lines = [f"# {self.title}\n\n{self._settings}\n", _line(_HEADINGS), "|---" * len(_HEADINGS) + "|"]
        lines += [_line([cell.replace("\n", " ") for cell in figure.cells]) for figure in self.figures]
        parts = ["\n".join([*lines, "", *self.notes]).rstrip() + "\n"]
        parts += [f"![{name}]({name})\n" for name in self.files if name.endswith(".png")]
        parts += [sheet.markdown() for sheet in self.sheets if sheet.shown]
        if self.differences:
            parts.append("## What differs\n\n" + "".join(f"- {sentence}\n" for sentence in self.differences))
        return "\n".join(parts)

    @property
    def _settings(self) -> str:
        return ", ".join(f"{name} {value}" for name, value in self.settings.items())


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

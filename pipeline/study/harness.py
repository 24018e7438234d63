"""What the cases of a study give, judged and told: rows with a verdict, and the report of all of them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np

from contactbench.pipeline.study.report import STYLES, FigureVerdict

if TYPE_CHECKING:
    from rich.table import Table

Bounds = tuple[float | None, float | None]


@dataclass(frozen=True)
class Case:
    """One thing that is tried with several seeds: its figures, and what the mean of each must keep."""

    part: str
    probe: str
    name: str
    chance: tuple[int, ...]  # beside the seed and the repetition
    measure: Callable[[np.random.Generator], Mapping[str, float]]
    bounds: Mapping[str, Bounds] = field(default_factory=dict)

    def measured(self, seeds: int, seed: int) -> dict[str, list[float]]:
        """Return the values of each figure, one for each repetition."""
        found = [self.measure(rng) for rng in chances(seeds, seed, *self.chance)]
        return {figure: [one[figure] for one in found] for figure in found[0]}


def chances(seeds: int, seed: int, *place: int) -> Iterable[np.random.Generator]:
    """Return a generator for each repetition of what stands at a place."""
    return (np.random.default_rng((seed, *place, i)) for i in range(seeds))


class CaseRow(ABC):
    """One figure of a case, and what it must keep."""

    @property
    @abstractmethod
    def verdict(self) -> FigureVerdict:
        """Whether its bound is kept."""

    @property
    @abstractmethod
    def cells(self) -> tuple[str, ...]:
        """It in words: what it is of, what was measured, and last its bound, empty where it is only shown."""

    @abstractmethod
    def to_json(self) -> dict[str, Any]:
        """Return plain values."""


R = TypeVar("R", bound=CaseRow)


@dataclass(frozen=True)
class CasesReport(Generic[R]):
    """Every row of a study, and what they depend on."""

    title: str
    about: Mapping[str, Any]
    rows: tuple[R, ...]
    headings: tuple[str, ...] = ("probe", "case", "figure", "measured", "bound")

    @property
    def passed(self) -> bool:
        """Whether no bound was missed."""
        return all(row.verdict is not FigureVerdict.MISSED for row in self.rows)

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        return {"passed": self.passed, **self.about, "rows": [row.to_json() for row in self.rows]}

    def tables(self) -> list[Table]:
        """Build what misses its bound, or may, for the terminal."""
        from rich.table import Table
        from rich.text import Text

        judged = [row for row in self.rows if row.cells[-1]]
        off = [row for row in judged if row.verdict is not FigureVerdict.MET]
        built = Table(*self.headings, "verdict", title=self.title, caption_justify="left")
        built.caption = (
            f"{len(judged) - len(off)} of {len(judged)} bounds kept; --out or --json gives every figure"
        )
        for row in off:
            built.add_row(*map(Text, (*row.cells, str(row.verdict))), style=STYLES[row.verdict])
        return [built]


def verdict_on(rows: Iterable[CaseRow]) -> str:
    """Return which bounds are missed or open, as a list in Markdown."""
    off = [row for row in rows if row.cells[-1] and row.verdict is not FigureVerdict.MET]
    lines = [f"- {', '.join(filter(None, row.cells))}: {row.verdict}" for row in off]
    return "\n".join(["Bounds that are missed or open:", "", *lines]) if off else "Every bound is kept."

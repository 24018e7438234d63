"""The stability study: every part, one after the other."""

from __future__ import annotations

import shlex
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.durable import make_folder
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.stability import (
    amplification,
    bias,
    builds,
    edges,
    exact,
    precision,
    probes,
    repeat,
    rounding,
    thin,
    units,
)
from contactbench.pipeline.study.stability.verdicts import verdicts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from rich.table import Table

    from contactbench.pipeline.study.stability.builds import Workshop
    from contactbench.pipeline.study.stability.rows import Row

KIND = "stability"
FEWEST = 50


@dataclass(frozen=True)
class StabilityReport:
    """
    Every figure.

    Attributes
    ----------
    names, samples, seed, quick
        As given to :func:`run`.
    rows : tuple of Row
    """

    names: tuple[str, ...]
    samples: int
    seed: int
    quick: bool
    rows: tuple[Row, ...]

    @property
    def passed(self) -> bool:
        """Whether every bound was kept."""
        return all(row.met for row in self.rows)

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        return {
            "passed": self.passed,
            "probes": list(self.names),
            "samples": self.samples,
            "seed": self.seed,
            "quick": self.quick,
            "verdicts": [{"part": v.part, "passed": v.passed, "words": v.words} for v in verdicts(self.rows)],
            "rows": [row.to_json() for row in self.rows],
        }

    def table(self) -> Table:
        """Build the verdicts for a terminal; what broke a bound is red."""
        from rich.table import Table
        from rich.text import Text

        built = Table(title=f"Numerical stability, {self.samples} touches a figure, seed {self.seed}")
        for heading in ("part", "verdict", ""):
            built.add_column(heading)
        for verdict in verdicts(self.rows):
            said = "" if verdict.passed is None else "kept" if verdict.passed else "BROKEN"
            built.add_row(
                Text(verdict.part),
                Text(verdict.words),
                said,
                style="" if verdict.passed is not False else "red",
            )
        return built

    def markdown(self) -> str:
        """Write the verdicts and the tables as Markdown."""
        from contactbench.pipeline.study.stability.page import tables, verdict_list

        parts = [f"### {title}\n\n{text}" for title, text in tables(self.rows)]
        return "\n\n".join([verdict_list(self.rows), *parts]) + "\n"


def run(
    names: Sequence[str] = probes.BUNDLED,
    *,
    samples: int = 1000,
    seed: int = 0,
    quick: bool = False,
    progress: Callable[[str], None] = lambda _: None,
) -> StabilityReport:
    """
    Measure every part.

    Without g++ nothing is said of single precision and of builds.

    Parameters
    ----------
    names : sequence of str
        Probes whose condition, thinnest facets and single precision are measured: bundled, or prepared files in S.
    samples : int
        Touches of each figure, at least 50; a fifth of them in exact arithmetic.
    seed : int
    quick : bool
        Coarse meshes and one build of each compiler.
    progress : callable
        Told in words what is being measured.

    Raises
    ------
    InputError
        Too few samples, a probe that cannot be read, or a compiler that fails.
    """
    if samples < FEWEST:
        raise InputError(f"samples: {samples} are too few to meet the worst: give at least {FEWEST}.")
    probes.check(names)
    with builds.Workshop() as made:
        workshop = made if shutil.which(builds.SINGLE.compiler) else None
        rows: list[Row] = []
        for said, part in _parts(names, samples, seed, workshop, quick=quick):
            progress(said)
            rows += part()
    return StabilityReport(tuple(names), samples, seed, quick, tuple(rows))


def keep(report: StabilityReport, folder: Path) -> Path:
    """
    Write a report's results, its page and its pictures; `contactbench.pipeline.study.pages` makes the latter again.

    Parameters
    ----------
    report : StabilityReport
    folder : Path
        Made if it is not there.

    Returns
    -------
    Path
        Of the page.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    from contactbench.pipeline.study.pages import PAGE, make_page
    from contactbench.pipeline.study.results import environment, write_results

    make_folder(folder)
    words = [
        "contactbench",
        "study",
        "stability",
        "--samples",
        str(report.samples),
        "--seed",
        str(report.seed),
    ]
    words += ["--quick"] if report.quick else []
    if report.names != probes.BUNDLED:
        words += [word for name in report.names for word in ("--probe", Path(name).name)]
    rows = [row.to_json() for row in report.rows]
    write_results(folder, KIND, shlex.join(words), rows, environment())
    make_page(folder)
    return folder / PAGE


def _parts(
    names: Sequence[str], samples: int, seed: int, workshop: Workshop | None, *, quick: bool
) -> Iterator[tuple[str, Callable[[], list[Row]]]]:
    yield "what an error of the wrench does", lambda: amplification.run(samples, seed, names)
    yield "rounding", lambda: rounding.run(samples, seed, workshop, quick=quick)
    yield "edges and vertices", lambda: edges.run(samples, seed, workshop)
    if workshop is not None:
        yield "single precision", lambda: precision.run(samples, seed, workshop, names, quick=quick)
    yield "thin facets", lambda: thin.run(samples, seed, workshop, names)
    yield "units", lambda: units.run(samples, seed, workshop)
    yield "bias", lambda: bias.run(samples, seed, workshop)
    yield "exact arithmetic", lambda: exact.run(max(FEWEST, samples // 5) if not quick else FEWEST // 2, seed)
    yield "the same bits", lambda: repeat.run(samples, seed, workshop, quick=quick)

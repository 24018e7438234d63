"""Every case, on every probe, with several seeds: figures with their spread, and what each must keep."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from functools import partial
from itertools import pairwise, product
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.assets import PROBE_NAMES
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.confidence import cases
from contactbench.pipeline.study.harness import Bounds, Case, CaseRow, CasesReport, chances, verdict_on
from contactbench.pipeline.study.pages import COLOURS, STYLE, Results, chapter, number, png, table
from contactbench.pipeline.study.report import FigureVerdict, mean_interval, share_interval, verdict_of
from contactbench.pipeline.study.stability import check, title_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from rich.table import Table

    from contactbench.pipeline.mesh.arrays import Floats, Mask


KIND = "confidence"
PARTS = {
    "two touches": "Two touches more than 20 mm apart, the stronger 8 to 10 N",
    "one touch": "Single touches, 8 to 10 N, up to 30 degrees",
    "reliability": "Confidence told, no probability, against how often the place is right",
    "ellipse": "True points in the 95 % ellipse",
}
_BINS = np.array([0.0, *np.linspace(0.5, 0.9, 5), 0.99, 1.0])
_RELIABILITY = ("probe", "touched", "confidence", "answers", "mean told", "right")


@dataclass(frozen=True)
class ConfidenceSizes:
    """How much is tried."""

    # touches, seeds: of each figure, and repetitions of it
    touches: int = 10_000
    seeds: int = 5
    facets: int = 2_000  # of the meshes, where they do not vary
    ellipse_facets: tuple[int, ...] = (500, 1_000, 2_000, 20_000)


QUICK = ConfidenceSizes(touches=400, seeds=2, facets=1_000, ellipse_facets=(500, 2_000))


@dataclass(frozen=True)
class ConfidenceRow(CaseRow):
    """One figure."""

    part: str  # a key of :data:`PARTS`
    # probe, case, figure, unit: in words
    probe: str
    case: str
    figure: str
    unit: str
    tries: int  # touches of one seed; for the reliability, answers
    # value, low, high: mean of the seeds, or the share of what is right; and its 95 % interval
    value: float
    low: float
    high: float
    # at_least, at_most: what the mean must keep
    at_least: float | None = None
    at_most: float | None = None
    stated: float | None = None  # of the reliability: confidence told, mean of the bin, times 100

    @property
    def verdict(self) -> FigureVerdict:
        """Whether the bounds are kept."""
        return verdict_of(self.value, (self.low, self.high), least=self.at_least, most=self.at_most)

    @property
    def words(self) -> str:
        """The figure with its 95 % interval, for people."""
        spread = "" if self.low == self.high else f" ({number(self.low)} to {number(self.high)})"
        return f"{number(self.value)}{spread}{f' {self.unit}' if self.unit else ''}"

    @property
    def bound(self) -> str:
        """What it must keep, for people; nothing where it is only shown."""
        match self.at_least, self.at_most:
            case None, None:
                return ""
            case None, most:
                return f"at most {number(most)}"
            case least, None:
                return f"at least {number(least)}"
            case least, most:
                return f"{number(least)} to {number(most)}"

    @property
    def reliable(self) -> tuple[str, ...]:
        """It in the columns of the reliability."""
        return self.probe, self.case, self.figure, f"{self.tries:,}", f"{self.stated:.1f} %", self.words

    @property
    def cells(self) -> tuple[str, ...]:
        """See `CaseRow`."""
        return self.probe, self.case, self.figure, self.words, self.bound

    def to_json(self) -> dict[str, Any]:
        """Return plain values."""
        return asdict(self) | {"verdict": str(self.verdict)}


class ConfidenceReport(CasesReport[ConfidenceRow]):
    """The rows, and the reliability as a table of its own: it has no bounds."""

    def tables(self) -> list[Table]:
        """Build what misses its bound, and the reliability, for the terminal."""
        from rich.table import Table

        built = Table(*_RELIABILITY, title=PARTS["reliability"])
        for row in self.rows:
            if row.stated is not None:
                built.add_row(*row.reliable)
        return [*super().tables(), built]


def run(
    names: Sequence[str] = PROBE_NAMES,
    sizes: ConfidenceSizes | None = None,
    *,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> ConfidenceReport:
    """
    Measure every case.

    Parameters
    ----------
    names : sequence of str
        Bundled probes, or prepared files in S: those have no declared lens, and are their own truth.
    seed : int
        At least 0.
    progress : callable
        Told in words what is being measured.

    Raises
    ------
    InputError
        A probe cannot be read, or the seed is negative.
    """
    if seed < 0:
        raise InputError(f"seed: {seed} is negative: give at least 0.")
    check(names)
    sizes, rows = sizes or ConfidenceSizes(), list[ConfidenceRow]()
    tried = list(_cases(names, sizes))
    for part, title in PARTS.items():
        progress(title)
        if part == "reliability":
            rows += _reliability(names, sizes, seed)
        else:
            rows += (row for case in tried if case.part == part for row in rows_of(case, sizes, seed))
    about = {"probes": [title_of(name) for name in names], "seed": seed, **asdict(sizes)}
    title = f"Confidence, {sizes.touches:,} touches x {sizes.seeds}, seed {seed}"
    return ConfidenceReport(title, about, tuple(rows))


# ---- the parts -----------------------------------------------------------------------------------------


def rows_of(case: Case, sizes: ConfidenceSizes, seed: int) -> Iterator[ConfidenceRow]:
    """Sum up what several seeds gave: shares as %."""
    for figure, measured in case.measured(sizes.seeds, seed).items():
        values = 100.0 * np.array(measured)
        mean = float(values.mean())
        low, high = mean_interval(values) or (mean, mean)
        low, high = max(low, 0.0), min(high, 100.0)  # a share is no less, and no more
        about = case.part, case.probe, case.name, figure, "%", sizes.touches
        yield ConfidenceRow(*about, mean, low, high, *case.bounds.get(figure, (None, None)))


def _cases(names: Sequence[str], sizes: ConfidenceSizes) -> Iterator[Case]:
    """Give every case but the reliability, which is no figure of several seeds."""
    count, facets = sizes.touches, sizes.facets
    noises, (little, _) = cases.NOISES.items(), cases.TORSIONS_M
    for i, probe in enumerate(names):
        title, two = title_of(probe), partial(cases.two, probe, facets, count)
        bounds: dict[str, Bounds] = {"sure and over 5 mm from both": (None, 15.0)}
        yield Case("two touches", title, "forces 1:1 to 1:3", (i,), two, bounds)
        bounds = {"sure": (95.0 if probe == "t-shape" else 98.0, None)}
        for (said, noise), torsion in product(noises, cases.TORSIONS_M):
            single = partial(cases.single, probe, facets, noise, torsion, count)
            name = f"torsion {1e3 * torsion:g} mm, {said} noise"
            # Of a file nobody knows how often one wrench has several answers.
            judged = probe in PROBE_NAMES and torsion == little
            yield Case("one touch", title, name, (i,), single, bounds if judged else {})
        bounds = {"inside": (92.0, 98.0)}
        for size, (said, noise), torsion, drift in product(
            sizes.ellipse_facets, noises, cases.TORSIONS_M, (True, False)
        ):
            error = "with the model's error" if drift else "without"
            name = f"{size:,} facets, torsion {1e3 * torsion:g} mm, {said} noise, {error}"
            ellipse = partial(cases.ellipse, probe, size, noise, torsion, count, drift=drift)
            # Without it the ellipse, which allows for it, holds more.
            yield Case("ellipse", title, name, (i,), ellipse, bounds if drift else {})


def _reliability(names: Sequence[str], sizes: ConfidenceSizes, seed: int) -> Iterator[ConfidenceRow]:
    for i, name in enumerate(names):
        for touched in cases.TOUCHED if name in PROBE_NAMES else (cases.EVENLY,):
            pairs = [
                cases.reliability(name, sizes.facets, touched, sizes.touches, rng)
                for rng in chances(sizes.seeds, seed, i)
            ]
            told, right = (np.concatenate(parts) for parts in zip(*pairs, strict=True))
            yield from bins(title_of(name), touched, told, right)


def bins(probe: str, case: str, told: Floats, right: Mask) -> Iterator[ConfidenceRow]:
    """Compare confidence (n,) with what was right (n,): by its tenths from 0.5 up, the last one split at 0.99."""
    where = np.clip(np.digitize(told, _BINS) - 1, 0, len(_BINS) - 2)
    for i, (low, high) in enumerate(pairwise(_BINS)):
        own = where == i
        count, hits = int(own.sum()), int(right[own].sum())
        if not count:
            continue
        figure = f"{low:g} to {high:g}"
        value, least, most = (100.0 * share for share in (hits / count, *share_interval(hits, count)))
        mean = 100.0 * float(told[own].mean())
        yield ConfidenceRow("reliability", probe, case, figure, "%", count, value, least, most, stated=mean)


# ---- the page ----------------------------------------------------------------------------------------------

_PICTURE = "reliability.png"
_ABOUT = """Touches whose place is known, on exact surfaces or on a file's own mesh, located with default gates. An
answer is *sure* if its reason is `ok` or `vertex`. Each figure is a mean over seeds, with the least and the most of
them in brackets; figures in bold miss their bound. Noise is 0.05 N and 2 mN·m, filtered 0.18 times as much.

Confidence is no probability, so nothing is asked of the reliability: it shows how often the place is right (within
5 mm, or 4.5 standard deviations across the force and 2 mm along it) where so much is told. Touches of 1 to 12 N, up
to 15 degrees, are drawn with all errors that the solver allows for. Brackets are 95 % intervals. The ellipse is asked
of sure answers that are within 10 mm; the share of all others is in the column *left out*. The ellipse allows for the
model's error: it should hold 95 % where that error is drawn into the wrenches, and holds more without it."""
_SAID = {_PICTURE: "Confidence told against the share of right answers, with 95 % intervals."}


def make(results: Results, folder: Path) -> str:
    """
    Write the diagram into the folder and return the chapter, Markdown.

    Parameters
    ----------
    results : Results
        Of kind ``confidence``.
    """
    known = [field.name for field in fields(ConfidenceRow)]
    rows = [ConfidenceRow(**{name: row[name] for name in known}) for row in results.rows]
    probes = sorted({row.probe for row in rows if row.part == "one touch"})
    files = (
        "" if set(probes) - set(PROBE_NAMES) else " No probe from a file was measured: `--probe` takes one."
    )
    about = f"{_ABOUT}\n\nProbes: {', '.join(probes)}.{files}\n\n{verdict_on(rows)}"
    return chapter("Confidence", about, tables(rows), {_PICTURE: _diagram(rows)}, _SAID, folder) + "\n"


def tables(rows: Sequence[ConfidenceRow]) -> list[tuple[str, str]]:
    """Return a title and a table, Markdown, for each part: a line for each case, a column for each figure."""
    return [(title, _table([row for row in rows if row.part == part])) for part, title in PARTS.items()]


def _table(rows: Sequence[ConfidenceRow]) -> str:
    if rows and rows[0].stated is not None:
        return table(_RELIABILITY, [row.reliable for row in rows])
    figures = list(dict.fromkeys(row.figure for row in rows))
    bounds = {row.figure: row.bound for row in rows if row.bound and row.probe != "t-shape"}
    cells: dict[tuple[str, str], dict[str, str]] = {}
    for row in rows:
        cells.setdefault((row.probe, row.case), {})[row.figure] = _marked(row)
    heads = [f"{name} ({bounds[name]})" if name in bounds else name for name in figures]
    return table(
        ["probe", "case", *heads], [[*at, *(own.get(f, "–") for f in figures)] for at, own in cells.items()]
    )


def _marked(row: ConfidenceRow) -> str:
    return row.words if row.verdict is FigureVerdict.MET else f"**{row.words}**"


def _diagram(rows: Sequence[ConfidenceRow]) -> bytes:
    import matplotlib as mpl
    from matplotlib.figure import Figure

    found: dict[tuple[str, str], list[ConfidenceRow]] = {}
    for row in rows:
        if row.stated is not None:
            found.setdefault((row.probe, row.case), []).append(row)
    with mpl.rc_context(STYLE):
        drawn = Figure(figsize=(5.0, 4.2), dpi=120, layout="constrained")
        axes = drawn.subplots()
        axes.plot([0, 100], [0, 100], color="#888888", linewidth=0.8)
        probes = list(dict.fromkeys(probe for probe, _ in found))
        for (probe, case), own in found.items():
            axes.errorbar(
                [float(r.stated or 0.0) for r in own],
                [r.value for r in own],
                [[r.value - r.low for r in own], [r.high - r.value for r in own]],
                fmt="osv"[cases.TOUCHED.index(case)],
                color=COLOURS[probes.index(probe) % len(COLOURS)],
                elinewidth=0.8,
                label=f"{probe}, {case}",
            )
        axes.set(xlabel="confidence told, %", ylabel="right, %", xlim=(0, 101), ylim=(0, 101))
        axes.legend(fontsize=7)
        return png(drawn)

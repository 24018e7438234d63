"""A measured ladder: as values, as plain data, and as tables."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.preparation.ladder.compare import LadderError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rich.table import Table

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.preparation.ladder.compare import (
        ContactDifference,
        ExpectedTouches,
        PartErrors,
        Statistic,
    )
    from contactbench.pipeline.timing import Timing

_WORDS = {"mean": "mean", "p95": message("95th percentile"), "max": "largest"}


@dataclass(frozen=True)
class Goal:
    """
    What simplification may cost.

    Raises
    ------
    LadderError
        A value is out of its range.
    """

    # largest added contact error, m. None: as much as lets the total error grow by `growth`.
    limit_m: float | None = None
    statistic: Statistic = "p95"  # which added error is held against the limit
    # how much the total error may grow, 0.05 for 5 %; used when there is no limit in metres
    growth: float = 0.05
    # share of the touches settled on the full mesh that may be lost, doubtful or jump. Touches near
    # the edge of doubt tip over whatever the mesh; 2 % cost a long grip 1.4 points of its sure answers.
    failed: float = 0.01

    def __post_init__(self) -> None:
        if self.limit_m is not None and not 0 < self.limit_m < math.inf:
            raise LadderError(f"the largest added error is {arg(self.limit_m):g} m: give a length above 0.")
        if self.statistic not in _WORDS:
            raise LadderError(
                f"there is no statistic {arg(self.statistic)!r}: choose one of {arg(join(', ', _WORDS))}."
            )
        if not 0 < self.growth < math.inf:
            raise LadderError(
                f"the total error may grow by {arg(self.growth):g}: give a number above 0, such as 0.05."
            )
        if not 0 <= self.failed <= 1:
            raise LadderError(
                f"the share of failed touches is {arg(self.failed):g}: give a number from 0 to 1."
            )

    def limit(self, bound: float) -> float:
        """
        Return the largest added error that will do, m.

        Added error e and noise s are independent, so the total is ``sqrt(s² + e²)``; it is `growth` above s at
        ``e = s sqrt((1 + growth)² - 1)``, which is 0.32 s for 5 %.

        Parameters
        ----------
        bound : float
            Noise bound of the full mesh, m.
        """
        return self.limit_m if self.limit_m is not None else bound * math.sqrt((1 + self.growth) ** 2 - 1)

    def keeps(self, errors: PartErrors) -> bool:
        """Tell whether a mesh with these errors on the part that is judged will do."""
        value = errors.noisy.statistic(self.statistic)
        if value is None or value > self.limit(errors.bound):
            return False
        # The formula takes the statistic for the root mean square; a few large errors would break that.
        too_much = self.limit_m is None and errors.growth is not None and errors.growth > self.growth
        return not too_much and errors.noisy.failed_share <= self.failed


@dataclass(frozen=True)
class Recommendation:
    """The rung to take."""

    facets: int | None  # of that rung; None when no simplified mesh will do
    limit: float  # largest added error that would do, m
    reason: str  # why, in sentences


def recommend(rungs: Sequence[Rung], goal: Goal) -> Recommendation:
    """
    Choose the fewest facets that keep the goal.

    Speed does not choose, because a clock never says the same twice: the reason states it.

    Parameters
    ----------
    rungs : sequence of Rung
        By facets, ascending; the last is the full mesh.
    goal : Goal
        What to keep.

    Returns
    -------
    Recommendation
    """
    *simplified, full = rungs
    limit = goal.limit(full.judged.bound)
    keeping = next((i for i, rung in enumerate(simplified) if goal.keeps(rung.judged)), None)
    if keeping is None:
        return Recommendation(None, limit, _none_keeps(simplified, full, goal, limit))
    rung = simplified[keeping]
    errors = _errors(rung, goal, limit)
    sentences = [
        message(f"Take {arg(rung.facets):,} facets, the fewest measured that suffice: {arg(errors)}.")
    ]
    if keeping:
        coarser = simplified[keeping - 1]
        lacks = _shortfall(coarser.judged, goal, limit)
        sentences.append(message(f"With {arg(coarser.facets):,} {arg(lacks)}."))
    sentences += [_elsewhere(each, goal) for each in rung.errors[1:]]
    sentences += _speed(rung, full)
    return Recommendation(rung.facets, limit, join(" ", sentences))


def _none_keeps(simplified: Sequence[Rung], full: Rung, goal: Goal, limit: float) -> str:
    keep = message(f"Keep the full mesh of {arg(full.facets):,} facets")
    if not simplified:
        return message(f"{arg(keep)}: no simplified one was measured.")
    if limit == 0:
        return message(
            f"{arg(keep)}: the sensor is declared noise-free, so no error may be added. Give a limit as a length."
        )
    finest = simplified[-1]
    return message(
        f"{arg(keep)}: no simplified mesh suffices. Even with {arg(finest.facets):,}"
        f" {arg(_shortfall(finest.judged, goal, limit))}."
    )


def _errors(rung: Rung, goal: Goal, limit: float) -> str:
    errors = rung.judged
    value = errors.noisy.statistic(goal.statistic)
    told = message(f"the {arg(_WORDS[goal.statistic])} of the added contact error is {arg(_in_mm(value))} mm")
    over = errors.over_bound(goal.statistic)
    if over is not None:
        told += message(f", {arg(over):.2g} of the noise's {arg(_in_mm(errors.bound))} mm")
    if errors.growth is not None:
        told += message(f", and the total error changes by {arg(100 * errors.growth):+.1f} %")
    if goal.limit_m is not None:
        return message(f"{arg(told)} (allowed: {arg(_in_mm(limit))} mm)")
    return message(f"{arg(told)} (allowed: {arg(100 * goal.growth):+.2g} %)")


def _shortfall(errors: PartErrors, goal: Goal, limit: float) -> str:
    """Say what a rung does wrong, the worst first."""
    value = errors.noisy.statistic(goal.statistic)
    if value is None:
        return message("no touch is settled")
    if value > limit:
        return message(
            f"the {arg(_WORDS[goal.statistic])} is {arg(_in_mm(value))} mm, over the limit of {arg(_in_mm(limit))} mm"
        )
    if errors.noisy.failed_share > goal.failed:
        return message(
            f"{arg(100 * errors.noisy.failed_share):.2g} % of the settled touches are lost, doubtful or jump, more than"
            f" {arg(100 * goal.failed):.2g} %"
        )
    return message(
        f"the total error grows by {arg(100 * (errors.growth or 0)):.1f} %, more than {arg(100 * goal.growth):.2g} %"
    )


def _elsewhere(errors: PartErrors, goal: Goal) -> str:
    """Say what the part that does not decide pays."""
    return message(
        f"Outside the regions, which does not count for the choice, the {arg(_WORDS[goal.statistic])}"
        f" is {arg(_in_mm(errors.noisy.statistic(goal.statistic)))} mm; noise alone gives"
        f" {arg(_in_mm(errors.bound))} mm."
    )


def _speed(rung: Rung, full: Rung) -> Iterator[str]:
    if rung.speed is None or full.speed is None:
        return
    ours, loop = rung.speed.contactbench.median, rung.speed.algorithm1.median
    before, loop_before = full.speed.contactbench.median, full.speed.algorithm1.median
    yield message(
        f"Contactbench takes {arg(ours / 1e3):.3g} µs a solve ({arg(before / 1e3):.3g} on the full mesh),"
        f" the paper's loop {arg(loop / 1e3):.3g} µs ({arg(loop_before / 1e3):.3g})."
    )


def _in_mm(metres: float | None) -> str:
    return "-" if metres is None else f"{1e3 * metres:.3g}"


SCHEMA, VERSION = "contactbench.ladder", 1


@dataclass(frozen=True)
class Speed:
    """Nanoseconds of one compiled solve."""

    algorithm1: Timing  # the paper's loop
    contactbench: Timing  # `ContactSolver.locate`, each touch on its own

    @property
    def ratio(self) -> float:
        """Median of the paper's loop over ours."""
        return self.algorithm1.median / self.contactbench.median


@dataclass(frozen=True, eq=False)
class Rung:
    """One mesh of the ladder."""

    probe: Probe  # the mesh
    asked: int  # facets asked for
    engine: str  # what simplified it; "none" for the full mesh
    # hausdorff, rms: deviation from the full mesh, m
    hausdorff: float
    rms: float
    file_bytes: int  # of the PLY file that `save_probe` writes
    errors: tuple[PartErrors, ...]  # added contact errors; the part that is judged first
    speed: Speed | None  # None when it was not timed

    @property
    def facets(self) -> int:
        """Facets of the mesh; not always those asked for."""
        return len(self.probe.faces)

    @property
    def judged(self) -> PartErrors:
        """The errors that decide: on the priority regions, or on the whole probe when it has none."""
        return self.errors[0]


@dataclass(frozen=True, eq=False)
class Ladder:
    """Quality against speed of one probe."""

    probe: str  # its name
    expected: ExpectedTouches  # what it was measured with
    goal: Goal  # what the recommendation keeps
    rungs: tuple[Rung, ...]  # by facets, ascending; the last is the full mesh
    recommendation: Recommendation
    notes: tuple[str, ...]  # a sentence for each rung that is missing

    @property
    def full(self) -> Rung:
        """The full mesh."""
        return self.rungs[-1]

    @property
    def recommended(self) -> Rung:
        """The rung to take; the full mesh when no simplified one will do."""
        return next((rung for rung in self.rungs if rung.facets == self.recommendation.facets), self.full)

    def to_json(self) -> dict[str, Any]:
        """Return plain data: metres, nanoseconds, bytes."""
        return {
            "schema": SCHEMA,
            "version": VERSION,
            "probe": self.probe,
            "expected": self.expected.to_json(),
            "goal": asdict(self.goal),
            "rungs": [_plain(rung, self.full) for rung in self.rungs],
            "recommendation": asdict(self.recommendation),
            "notes": list(self.notes),
        }

    def csv_rows(self) -> tuple[tuple[str, ...], list[tuple[object, ...]]]:
        """Return columns and rows: one for each rung and part."""
        rows = [_csv_row(rung, errors) for rung in self.rungs for errors in rung.errors]
        return tuple(rows[0]), [tuple(row.values()) for row in rows]

    def tables(self) -> tuple[Table, Table]:
        """Return two tables for the terminal: what fewer facets cost, and what they save."""
        return _error_table(self), _speed_table(self)

    def sentences(self) -> list[str]:
        """Return what was measured and what to take, for people."""
        low, high = self.expected.force
        judged = self.full.judged
        parts: dict[str, str] = {"region": message("its priority regions"), "all": message("its surface")}
        where = parts.get(judged.part, judged.part)
        measured = message(
            f"{arg(self.probe)}: {arg(judged.touches):,} touches of {arg(low):g} to {arg(high):g} N on"
            f" {arg(where)}, located on the full mesh of {arg(self.full.facets):,} facets and on"
            f" {arg(len(self.rungs) - 1)} simplified. Noise alone gives {arg(1e3 * judged.bound):.3g} mm."
        )
        return [measured, self.recommendation.reason, *self.notes]


def _plain(rung: Rung, full: Rung) -> dict[str, Any]:
    speed = None
    if rung.speed is not None and full.speed is not None:
        speed = {
            **asdict(rung.speed),
            "ratio": rung.speed.ratio,
            "algorithm1_over_full": rung.speed.algorithm1.median / full.speed.algorithm1.median,
            "contactbench_over_full": rung.speed.contactbench.median / full.speed.contactbench.median,
        }
    return {
        "facets": rung.facets,
        "asked": rung.asked,
        "engine": rung.engine,
        "hausdorff": rung.hausdorff,
        "rms": rung.rms,
        "file_bytes": rung.file_bytes,
        "errors": [{**asdict(errors), "p95_over_bound": errors.over_bound("p95")} for errors in rung.errors],
        "speed": speed,
    }


def _csv_row(rung: Rung, errors: PartErrors) -> dict[str, object]:
    def lengths(difference: ContactDifference, prefix: str) -> dict[str, object]:
        named = {"mean": difference.mean, "p95": difference.p95, "max": difference.largest}
        return {f"{prefix}{name}_mm": None if m is None else 1e3 * m for name, m in named.items()}

    noisy = errors.noisy
    row: dict[str, object] = {"facets": rung.facets, "asked": rung.asked, "part": errors.part}
    row |= {"touches": errors.touches, "settled": noisy.settled, "compared": noisy.compared}
    row |= lengths(noisy, "") | {"bound_mm": 1e3 * errors.bound, "p95_over_bound": errors.over_bound("p95")}
    row |= {"growth": errors.growth} | lengths(errors.noise_free, "noise_free_")
    row |= {name: getattr(noisy, name) for name in ("lost", "doubtful", "gained", "changed", "jumped")}
    for name in ("algorithm1", "contactbench"):
        timing = None if rung.speed is None else getattr(rung.speed, name)
        row |= {f"{name}_{which}_ns": getattr(timing, which, None) for which in ("median", "p99")}
    row |= {"hausdorff_mm": 1e3 * rung.hausdorff, "rms_mm": 1e3 * rung.rms}
    return row | {"file_bytes": rung.file_bytes, "engine": rung.engine}


_ERROR_CAPTION = message(
    "Distances between the contacts on this mesh and on the full one, of touches settled by both, mm. × noise is p95"
    " over the noise bound; growth that of the whole error. Doubtful, lost, jumped: settled on the full mesh, here with"
    " a warning, without a point, or elsewhere without a warning. * recommended."
)
_SPEED_CAPTION = message(
    "Compiled solves of the touches judged, µs, all in one run. × full is the median over the full mesh's; loop is the"
    " paper's Algorithm 1, which stops at the first facet that accepts, priority regions first. Deviation in mm."
)


def _error_table(ladder: Ladder) -> Table:
    headings = ("mean", "p95", "max", message("no noise"), "× noise", "growth", "doubtful", "lost", "jumped")
    table = _table(("facets", "part"), headings, _ERROR_CAPTION)
    for rung in ladder.rungs:
        for errors in rung.errors:
            noisy = errors.noisy
            lengths = [_mm(value) for value in (noisy.mean, noisy.p95, noisy.largest, errors.noise_free.p95)]
            over = errors.over_bound("p95")
            growth = "-" if errors.growth is None else _percent(errors.growth)
            counts = [str(count) for count in (noisy.doubtful, noisy.lost, noisy.jumped)]
            name = _name(ladder, rung) if errors is rung.judged else ""
            cells = (name, errors.part, *lengths, "-" if over is None else f"{over:.2f}", growth, *counts)
            table.add_row(*cells, style=_style(ladder, rung), end_section=errors is rung.errors[-1])
    return table


def _speed_table(ladder: Ladder) -> Table:
    headings = ("loop", "p99", "× full", "ours", "p99", "× full", "loop / ours", "Hausdorff", "RMS", "file")
    table = _table(("facets",), headings, _SPEED_CAPTION)
    for rung in ladder.rungs:
        cells = ["-"] * 7
        if rung.speed is not None and ladder.full.speed is not None:
            loop, ours, full = rung.speed.algorithm1, rung.speed.contactbench, ladder.full.speed
            cells = [_us(loop.median), _us(loop.p99), f"{loop.median / full.algorithm1.median:.3f}"]
            cells += [_us(ours.median), _us(ours.p99), f"{ours.median / full.contactbench.median:.2f}"]
            cells.append(f"{rung.speed.ratio:,.0f}")
        sizes = (_mm(rung.hausdorff), _mm(rung.rms), f"{rung.file_bytes / 1e3:,.0f} kB")
        table.add_row(_name(ladder, rung), *cells, *sizes, style=_style(ladder, rung))
    return table


def _table(words: tuple[str, ...], numbers: tuple[str, ...], caption: str) -> Table:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, caption=caption, caption_justify="left")
    for heading in (*words, *numbers):
        table.add_column(heading, justify="left" if heading == "part" else "right", no_wrap=True)
    return table


def _name(ladder: Ladder, rung: Rung) -> str:
    return f"{rung.facets:,}{'*' if rung is ladder.recommended else ''}"


def _style(ladder: Ladder, rung: Rung) -> str:
    return "bold" if rung is ladder.recommended else ""


def _percent(share: float) -> str:
    # Adding 0 turns the minus of a rounded -0.0 away.
    return f"{round(100 * share, 1) + 0.0:+.1f} %"


def _mm(metres: float | None) -> str:
    return "-" if metres is None else f"{1e3 * metres:.3f}"


def _us(ns: float) -> str:
    return f"{ns / 1e3:,.3g}" if ns < 1e6 else f"{ns / 1e3:,.0f}"

"""A measured ladder: as values, as plain data, and as tables."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from rich.table import Table

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.preparation.ladder.compare import (
        ContactDifference,
        ExpectedTouches,
        PartErrors,
    )
    from contactbench.pipeline.preparation.ladder.recommend import Goal, Recommendation
    from contactbench.pipeline.timing import Timing

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
        where = {"region": message("its priority regions"), "all": message("its surface")}.get(
            judged.part, judged.part
        )
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

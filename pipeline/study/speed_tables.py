"""The speed study as tables: for a terminal, and as Markdown."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.table import Table

from contactbench.pipeline.study.markdown import table as markdown_table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.study.speed import Row, SpeedReport

_COLUMNS = (
    "method",
    "from",
    "facets",
    "median µs",
    "p99 µs",
    "mean mm",
    "p95 mm",
    "max mm",
    "rms/bound, settled",
    "settled %",
    "answered %",
)
_TARGETS = ("figure", "measured", "target", "")


def tables(report: SpeedReport) -> list[Table]:
    """Return the measurements, the targets and the stream comparison for a terminal."""
    measured = _table(
        f"{report.probe}, {report.touches:,} touches, seed {report.seed}", _COLUMNS, _rows(report)
    )
    targets = _table("Ratios, all from this run", _TARGETS, _target_rows(report))
    targets.caption = _stream(report)
    return [measured, targets]


def markdown(report: SpeedReport) -> str:
    """Return the same as Markdown."""
    parts = [
        f"# Speed against error: {report.probe}",
        f"{report.touches:,} touches, seed {report.seed}. {_stream(report)}",
        markdown_table(_COLUMNS, _rows(report)),
        markdown_table(_TARGETS, _target_rows(report)),
    ]
    return "\n\n".join(parts) + "\n"


def _stream(report: SpeedReport) -> str:
    if not report.stream_samples:
        return "Tracking was not compared with cold solves."
    return (
        f"Tracking differed from cold solves on {report.stream_differences} samples"
        f" of a {report.stream_samples:,}-sample stream, over all resolutions."
    )


def _rows(report: SpeedReport) -> list[list[str]]:
    return [_row(row) for row in report.rows]


def _row(row: Row) -> list[str]:
    def number(value: float | None, digits: str = ".2f") -> str:
        return "" if value is None else format(value, digits)

    def percent(value: float | None) -> str:
        return number(None if value is None else 100 * value, ".1f")

    return [
        row.method,
        row.language,
        f"{row.facets:,}",
        f"{row.timing.median / 1e3:.3g}",
        f"{row.timing.p99 / 1e3:.3g}",
        number(row.mean_mm),
        number(row.p95_mm),
        number(row.max_mm, ".1f"),
        number(row.over_bound),
        percent(row.settled),
        percent(row.answered),
    ]


def _target_rows(report: SpeedReport) -> list[list[str]]:
    return [
        [
            t.name,
            f"{t.measured:.3g}",
            f"{'at least' if t.at_least else 'at most'} {t.limit:g}",
            "met" if t.met else "missed",
        ]
        for t in report.targets
    ]


def _table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> Table:
    table = Table(title=title)
    for i, column in enumerate(columns):
        table.add_column(column, justify="left" if i == 0 else "right")
    for row in rows:
        table.add_row(*row)
    return table

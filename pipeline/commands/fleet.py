"""``contactbench fleet``: many sessions in one table."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.options import refuse_overwriting
from contactbench.pipeline.console import Bar, Noun, answer, say, show_tables
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from contactbench.pipeline.fleet.judge import FleetFindings
    from contactbench.pipeline.fleet.row import Fleet

fleet_app = Noun()

_SHOWN = 20  # lines of a kind in a terminal


@fleet_app.command(example="fleet sessions --out fleet.parquet --report fleet.html")
def fleet(
    places: list[Path],
    /,
    out: Path | None = None,
    report: Path | None = None,
    max_age: Annotated[
        int, typer.Option(min=1, max=36_500, help="Age at which a calibration is due, days.")
    ] = 365,
    soon: Annotated[
        int, typer.Option(min=0, max=36_500, help="Days ahead in which due ones are listed.")
    ] = 30,
) -> None:
    """Read many sessions into one table: what drifts, what is due for recalibration, and what stands out.

    Of each session the newest calibration and verification count; meshes and recordings are not read. A calibration
    is due when the sensor's certificate runs out (report.due of the session), or at --max-age. What is damaged
    or no session is named and left out; a sensor whose serial number is missing is judged alone. Exit code 1: a
    calibration is overdue, a session stands out, or one is damaged.

    Parameters
    ----------
    places : DIR...
        Sessions, archives, or folders that hold them.
    out : FILE
        Parquet table to write; sessions that it already has are not read again.
    report : FILE
        HTML or PDF page to write.
    """
    _refuse_outputs(out, report)
    from contactbench.pipeline.calibration.files.calibration_file import creation_time
    from contactbench.pipeline.fleet.judge import DueRules, judge
    from contactbench.pipeline.fleet.row import load_table, read_fleet, save_table
    from contactbench.pipeline.fleet.source import find

    now = creation_time()
    known = load_table(out) if out is not None else None
    with Bar("reading sessions", counted=True) as bar:
        found = read_fleet(list(find(places)), known, bar)
    if not found.table.num_rows:
        why = f": {found.skipped[0].reason}" if found.skipped else "."
        raise InputError(f"{', '.join(map(str, places))}: no session that can be read is in it{why}")
    findings = judge(found.table, DueRules(now.date(), max_age, soon))
    if out is not None:
        save_table(found.table, out)
    if report is not None:
        from contactbench.pipeline.durable import write_file
        from contactbench.pipeline.fleet.page import fleet_html
        from contactbench.pipeline.page import print_pdf

        page = fleet_html(found.table, findings, found.skipped, now)
        write_file(report, print_pdf(page) if report.suffix.lower() == ".pdf" else page.encode())
    _tell(found, findings)
    answer(
        {
            "sessions": found.table.num_rows,
            "read": found.read,
            "out": None if out is None else str(out),
            "report": None if report is None else str(report),
            "due": [asdict(each) for each in findings.due],
            "outliers": [asdict(each) for each in findings.outliers],
            "trends": [asdict(each) for each in findings.trends],
            "skipped": [asdict(each) for each in found.skipped],
        }
    )
    overdue = any(each.days < 0 or not each.due for each in findings.due)
    if overdue or findings.outliers or any(each.damaged for each in found.skipped):
        raise typer.Exit(1)


def _refuse_outputs(out: Path | None, report: Path | None) -> None:
    """Refuse outputs that could take the place of something else; typer.BadParameter."""
    from contactbench.pipeline.fleet.source import session_around

    for name, file, endings in (("--out", out, (".parquet",)), ("--report", report, (".html", ".pdf"))):
        if file is None:
            continue
        if file.suffix.lower() not in endings:
            raise typer.BadParameter(f"{name} {file}: name a file that ends in {' or '.join(endings)}.")
        if (session := session_around(file)) is not None:
            raise typer.BadParameter(f"{name} {file}: this is inside the session {session}: write elsewhere.")
    if out is not None:
        refuse_overwriting(report, [out])


def _tell(found: Fleet, findings: FleetFindings) -> None:
    _lines([f"not in the table: {each.reason}" for each in found.skipped], "yellow")
    _lines([f"{_who(each)}: {each.sentence} ({each.place})" for each in findings.outliers], "yellow")
    _lines(
        [f"{_who(each)}: {each.sentence}" for each in findings.due],
        "red" if any(each.days < 0 or not each.due for each in findings.due) else "yellow",
    )
    drifting = [each for each in findings.trends if each.drifts]
    if drifting:
        from rich.table import Table

        table = Table("sensor", "tool", "drifts", "sessions", "newest", "a year")
        for each in drifting[:_SHOWN]:
            newest, year = f"{each.newest:.4g} {each.unit}", f"{each.per_year:+.2g} {each.unit}"
            table.add_row(each.sensor, each.tool, each.quantity, str(each.sessions), newest, year)
        show_tables(table)
    say(
        f"{found.table.num_rows:,} sessions in the table; {found.read:,} were read now.",
        "" if findings.outliers or findings.due else "green",
    )


def _who(each: Any) -> str:
    return f"{each.sensor or 'unnamed sensor'}, {each.tool or 'unknown tool'}"


def _lines(sentences: list[str], style: str) -> None:
    for sentence in sentences[:_SHOWN]:
        say(sentence, style)
    if len(sentences) > _SHOWN:
        say(f"... and {len(sentences) - _SHOWN:,} more: --report and --json have them.", style)

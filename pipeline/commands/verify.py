"""``contactbench verify ...``: tell whether the contact point is right."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from contactbench.pipeline.commands.options import (
    CalibrationOption,
    ProbeOption,
    SerialOption,
    refuse_overwriting,
    serials_of,
    written,
)
from contactbench.pipeline.console import Noun, answer, say, say_all, show_tables, warn
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.settings import ReportSettings, VerificationSettings

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.table import Table

    from contactbench.pipeline.verification import Verification
    from contactbench.pipeline.verification.figures import Summary


verify_app = Noun("Judge contact points by touches of markers, and write the results as a page.")


@verify_app.command(
    example=(
        "verify touches --probe probe.ply --calibration calibration.json --markers markers.csv touches.mcap"
    )
)
def touches(
    recording: Path,
    /,
    probe: ProbeOption,
    calibration: CalibrationOption,
    markers: Path,
    said: VerificationSettings,
    force: list[tuple[float, float]] | None = None,
    order: str | None = None,
    leave_out: list[str] | None = None,
    limit_time: float = 1.0,
    reference: Path | None = None,
    out: Path | None = None,
) -> None:
    """Find the touches of markers in a recording, and judge the errors of the contact points.

    RECORDING is an .mcap file with one sensor and one robot, or a CSV file with t,fx,fy,fz,mx,my,mz (raw
    readings) and orientations, as for calibrate compensate. Every press is accepted or rejected, with the reason.
    The file of --out is the same for the same input, except for the solve times and the parts of the
    verdict about them.

    Exit code 1: a limit is exceeded, or markers are missing. Needs no hardware.

    Parameters
    ----------
    recording
        Touches: .mcap or .csv.
    markers
        CSV file: name,x_mm,y_mm,z_mm, sensor frame.
    force : LOW,HIGH
        Force window, N; several if repeated [8,10].
    order : NAME,...
        Markers in the order in which they must be touched [any].
    leave_out : NAME=WHY
        A marker to skip, and the reason; may be repeated. The verdict mentions it.
    limit_time
        Largest p99 of the time of a solve, ms.
    reference
        CSV file t,force of a reference sensor (s, N).
    out
        Also write everything to this file, JSON.
    """
    inputs = {"probe": probe, "calibration": calibration, "markers": markers, "recording": recording}
    if reference is not None:
        inputs["reference"] = reference
    refuse_overwriting(out, list(inputs.values()))
    written(said)
    from contactbench.pipeline.verification.result import VerificationParameters, verify_files

    left_out = dict(_left_out(text) for text in leave_out or ())
    given = VerificationParameters.checked(
        {
            **said.model_dump(),
            "name": "verification.json" if out is None else out.name,
            "windows": force or [(8.0, 10.0)],
            "order": () if order is None else _in_order(order, left_out),
            "left_out": left_out,
            "p99_limit_s": limit_time / 1e3,
        }
    )
    found = verify_files(inputs, given, timed=True)
    if out is not None:
        write_file(out, found.to_bytes())
    _show(found)
    answer(found.to_json(), good=found.verdict.passed)


def _left_out(text: str) -> tuple[str, str]:
    name, _, why = (part.strip() for part in text.partition("="))
    if not name or not why:
        raise typer.BadParameter(
            f"--leave-out {text}: give the marker and the reason: M3='nothing reaches it'."
        )
    return name, why


def _in_order(order: str, left_out: dict[str, str]) -> list[str]:
    names = [name.strip() for name in order.split(",")]
    return [name for name in names if name not in left_out]


def _show(found: Verification) -> None:
    from contactbench.pipeline.verification.model_error import model_error_words

    warn(found.warnings)
    tables = [_table("Errors per marker", found.per_marker), _table("Errors", _groups(found))]
    show_tables(*tables)
    for reason, count in found.rejected.items():
        say(f"rejected: {count} x {reason}", "yellow")
    if found.unresolved is not None:
        lost = found.unresolved
        say(f"settled touches without a marker: {lost.touches} of {lost.settled} ({100 * lost.share:.0f} %)")
    if found.ci is not None:
        low, high = found.ci.mean_mm
        say(f"mean error between {low:.2f} and {high:.2f} mm (95 %)")
    if found.ratio is not None:
        say(f"error relative to the prediction of noise and calibration: {found.ratio:.1f}")
    if found.times is not None:
        say(f"a solve takes {1e6 * found.times.median_s:.1f} µs, p99 {1e6 * found.times.p99_s:.1f} µs")
    if found.force is not None:
        size = f"{found.force.mean_N:+.2f} ± {found.force.sd_N:.2f} N"
        say(f"force against the reference: {size} ({found.force.touches} touches)")
    refined = found.alignment_refined
    if refined is not None:
        say(
            f"alignment refined on {len(refined.fitted)} markers: on the other {len(refined.judged)} the mean error"
            f" goes from {refined.judged_before_mm:.2f} to {refined.judged_after_mm:.2f} mm"
        )
    if found.diagnosis is not None:
        say(found.diagnosis.text)
    say(model_error_words(found.model_error))
    say_all(found.verdict.notes, "yellow")
    if found.verdict.passed:
        say("passed", "green")
    else:
        say(f"FAILED: {'; '.join(found.verdict.reasons)}.", "red")


def _groups(found: Verification) -> Sequence[Summary]:
    overall = () if found.overall is None else (found.overall,)
    return (*found.per_force, *found.per_angle, *overall)


def _table(title: str, rows: Sequence[Summary]) -> Table:
    from rich.table import Table

    built = Table(title=title)
    for heading in ("", "touches", "mean mm", "SD mm", "p95 mm", "max mm", "bias mm", "scatter mm"):
        built.add_column(heading, justify="right" if heading else "left")
    for row in rows:
        sizes = (row.mean_mm, row.sd_mm, row.p95_mm, row.max_mm)
        bias = " ".join(f"{value:+.2f}" for value in row.bias_mm)
        cells = (_size(size) for size in sizes)
        built.add_row(row.name, str(row.touches), *cells, bias, _size(row.scatter_mm))
    return built


def _size(value: float | None) -> str:
    return "–" if value is None else f"{value:.2f}"


@verify_app.command(
    example=("verify report --verification v.json --calibration c.json --probe p.ply --out report.html")
)
def report(
    verification: Path,
    probe: Path,
    out: Path,
    said: ReportSettings,
    calibration: Path | None = None,
    known_weight: Path | None = None,
    known_touch: Path | None = None,
    serial: SerialOption = None,
) -> None:
    """Write the results of a verification as a report: HTML, or PDF on A4.

    Its first page says who, what, when and with which sensor, the verdict and the uncertainty budget, with room for a
    signature; the details follow. The HTML file is self-contained. A PDF needs WeasyPrint:
    pip install 'contactbench[pdf]'.

    Parameters
    ----------
    verification
        File written by contactbench verify touches --out.
    probe
        The verified probe, .ply.
    out
        File to write: .html or .pdf.
    calibration
        File written by contactbench calibrate fit.
    known_weight
        File written by contactbench calibrate check weight --out.
    known_touch
        File written by contactbench calibrate check touch --out.
    """
    if out.suffix.lower() not in (".html", ".pdf"):
        raise typer.BadParameter(f"--out {out}: give a name that ends in .html or .pdf.")
    optional = {"calibration": calibration, "known_weight": known_weight, "known_touch": known_touch}
    inputs = {"verification": verification, "probe": probe}
    inputs |= {role: file for role, file in optional.items() if file is not None}
    refuse_overwriting(out, list(inputs.values()))
    serials = serials_of(serial)
    from contactbench.pipeline.calibration.files.calibration_file import creation_time
    from contactbench.pipeline.report.report_file import report as make

    name = f"report{out.suffix.lower()}"
    parameters = {**said.model_dump(), "name": name, "serials": serials}
    data = make(inputs, parameters, creation_time().isoformat())[name]
    write_file(out, data)
    say(f"{out}: {len(data):,} bytes")
    answer({"out": str(out), "bytes": len(data)})

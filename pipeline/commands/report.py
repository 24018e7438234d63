"""``contactbench report``: a verification as a page for people."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contactbench.pipeline.commands.options import refuse_overwriting
from contactbench.pipeline.console import JsonOption, print_json, say

report_app = typer.Typer(rich_markup_mode=None)


@report_app.command(
    help=(
        "Write what a verification found as one page that anybody can read: HTML, or PDF on A4.\n\n"
        "The HTML file needs nothing beside itself. A PDF needs WeasyPrint: pip install 'contactbench[pdf]'."
    ),
    epilog=(
        "Example: contactbench report --verification v.json --calibration c.json --probe p.ply --out report.html"
    ),
)
def report(
    verification: Annotated[Path, typer.Option(help="What contactbench verify --out wrote.")],
    probe: Annotated[Path, typer.Option(help="The probe that was verified, .ply.")],
    out: Annotated[Path, typer.Option(help="File to write: .html or .pdf.")],
    calibration: Annotated[Path | None, typer.Option(help="What contactbench calibrate wrote.")] = None,
    known_weight: Annotated[
        Path | None, typer.Option(help="What contactbench check weight --out wrote.")
    ] = None,
    known_touch: Annotated[
        Path | None, typer.Option(help="What contactbench check touch --out wrote.")
    ] = None,
    operator: Annotated[str, typer.Option(help="Who verified.")] = "",
    serial: Annotated[
        list[str] | None, typer.Option(metavar="DEVICE=NUMBER", help="A serial number; may be repeated.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Write what a verification found as a page."""
    if out.suffix.lower() not in (".html", ".pdf"):
        raise typer.BadParameter(f"--out {out}: name a file that ends in .html or .pdf.")
    optional = {"calibration": calibration, "known_weight": known_weight, "known_touch": known_touch}
    inputs = {"verification": verification, "probe": probe}
    inputs |= {role: file for role, file in optional.items() if file is not None}
    refuse_overwriting(out, list(inputs.values()))
    pairs = [pair.partition("=") for pair in serial or []]
    if not all(device and number for device, _, number in pairs):
        raise typer.BadParameter('--serial needs DEVICE=NUMBER, such as "M8128=SN 7".')
    from contactbench.pipeline.calibration.files.calibration_file import creation_time
    from contactbench.pipeline.durable import write_durably
    from contactbench.pipeline.errors import InputError
    from contactbench.pipeline.report.making import report as make

    serials = {device: number for device, _, number in pairs}
    name = f"report{out.suffix.lower()}"
    parameters = {"name": name, "operator": operator, "serials": serials}
    data = make(inputs, parameters, creation_time().isoformat())[name]
    try:
        write_durably(out, data)
    except (OSError, ValueError) as error:
        raise InputError(
            f"{out}: the report cannot be written ({error}): choose a folder that exists and is writable."
        ) from error
    say(f"{out}: {len(data):,} bytes")
    if as_json:
        print_json({"out": str(out), "bytes": len(data)})

"""``contactbench gui-study ...``: what the window must reach, measured on the real one."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from contactbench.pipeline.console import JsonOption, print_json, say, show_tables
from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from contactbench.pipeline.study.preparation.report import Report

study_app = typer.Typer(
    help="Measure the real window: its start, stalls, charts, brush, leaks, and ends without warning.",
    epilog="Example: contactbench gui-study stalls --seconds 60 --json",
    no_args_is_help=True,
    rich_markup_mode=None,
)

_NOT_GOOD_ENOUGH = 1

MarkdownOption = Annotated[
    Path | None, typer.Option("--out", help="Also write the table to this Markdown file.")
]
SecondsOption = Annotated[float, typer.Option(help="How long to measure, s.", min=2.0, max=7200.0)]


@study_app.command(epilog="Example: contactbench gui-study startup --repeats 7")
def startup(
    repeats: Annotated[int, typer.Option(help="Pairs of starts.", min=1, max=1000)] = 7,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Time the start of the window beside importing PySide6 and pyvista and showing an empty view, in pairs.

    Exit code 1 when the window takes more than 1.5 times as long.
    """
    _check_screen()
    from contactbench.app import study_startup

    _finish(study_startup.run(repeats, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench gui-study stalls --seconds 60 --facets 100000")
def stalls(
    seconds: SecondsOption = 60.0,
    facets: Annotated[int, typer.Option(help="Of the mesh.", min=100, max=2_000_000)] = 100_000,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Measure how long the window stands still while three sensors stream, a mesh is simplified and the scene turns.

    Exit code 1 when it ever stands still for more than 100 ms.
    """
    _check_screen()
    from contactbench.app import study_stalls

    _finish(study_stalls.run(seconds, facets, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench gui-study charts --seconds 1800")
def charts(seconds: SecondsOption = 60.0, out: MarkdownOption = None, as_json: JsonOption = False) -> None:
    """Count the pictures of the strip charts and watch the memory while a sensor streams at 1 kHz.

    Exit code 1 when they come less than 29 times a second, or memory grows.
    """
    _check_screen()
    from contactbench.app import study_charts

    _finish(study_charts.run(seconds, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench gui-study brush --facets 100000")
def brush(
    facets: Annotated[int, typer.Option(help="Of the probe.", min=100, max=2_000_000)] = 100_000,
    events: Annotated[int, typer.Option(help="Movements of the mouse.", min=5, max=100_000)] = 200,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Time the brush from the mouse event to the frame that shows it, and finding facets under the pointer.

    Exit code 1 when 95 of 100 take more than 33 ms, or finding a facet more than 1 ms.
    """
    _check_screen()
    from contactbench.app import study_brush

    _finish(study_brush.run(facets, events, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench gui-study leaks --times 50")
def leaks(
    times: Annotated[int, typer.Option(help="How often to open and close.", min=1, max=10_000)] = 50,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Open and close the window with a session, and count windows, threads, processes, files and objects of VTK.

    Exit code 1 when anything stays.
    """
    _check_screen()
    from contactbench.app import study_leaks

    _finish(study_leaks.run(times, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench gui-study kill --page gravity")
def kill(
    page: Annotated[
        list[str] | None, typer.Option(metavar="STEP", help="May be repeated [all pages].")
    ] = None,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Do something at each page, end the application with SIGKILL, start it again, and compare.

    Exit code 1 when something is lost, another page is shown, or a recording is not asked about.
    """
    from contactbench.pipeline.workbench.steps import Step

    unknown = set(page or ()) - set(Step)
    if unknown:
        raise InputError(f"page {', '.join(sorted(unknown))}: choose from {', '.join(Step)}.")
    _check_screen()
    from contactbench.app import study_kill

    steps = [step for step in Step if not page or step in page]
    _finish(study_kill.run(steps, progress=say), out, as_json=as_json)


def _check_screen() -> None:
    from contactbench.app.cli import check_screen

    check_screen()


def _finish(report: Report, out: Path | None, *, as_json: bool) -> None:
    """Write, print, and leave with the exit code of a report."""
    if out:
        try:
            write_durably(out, report.markdown().encode())
        except OSError as error:
            raise InputError(f"{out}: cannot be written ({error}): choose another place.") from error
    if as_json:
        print_json(report.to_json())
    else:
        show_tables(report.table())
    if not report.passed:
        raise typer.Exit(_NOT_GOOD_ENOUGH)

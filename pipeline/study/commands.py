"""``contactbench study ...``: measurements as commands."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pipeline.console import JsonOption, print_json, say
from pipeline.durable import write_durably
from pipeline.errors import InputError

if TYPE_CHECKING:
    from rich.table import Table

study_app = typer.Typer(
    help="Measure speed against error, and stability on hard cases.",
    epilog="Example: contactbench study speed --probe t-shape --facets 1000,20000 --json",
    no_args_is_help=True,
    rich_markup_mode=None,
)

_NOT_GOOD_ENOUGH = 1

SeedOption = Annotated[int, typer.Option(help="Seed of the touches and the noise.")]
MarkdownOption = Annotated[
    Path | None, typer.Option("--out", help="Also write the tables to this Markdown file.")
]


@study_app.command(epilog="Example: contactbench study speed --probe linear --out speed.md")
def speed(
    probe: Annotated[str, typer.Option(help="Bundled probe: linear, convex or t-shape.")] = "t-shape",
    facets: Annotated[str, typer.Option(help="Resolutions, comma separated.")] = "500,1000,20000,100000",
    touches: Annotated[int, typer.Option(help="Simulated touches for errors and compiled times.")] = 10_000,
    stream: Annotated[
        int, typer.Option(help="Samples on which tracking must equal cold solves.")
    ] = 1_000_000,
    rounds: Annotated[int, typer.Option(help="Blocks of 250 calls for each method timed from Python.")] = 40,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Time every method beside its rivals in one run, with its error on the same touches.

    Times are for this machine; the ratios are what to compare. Exit code 1 when tracking and a cold solve
    ever disagreed.
    """
    from pipeline.study import speed as study
    from pipeline.study.speed_tables import markdown, tables

    counts = sorted(_whole_number(text) for text in facets.split(","))
    report = study.run(probe, counts, touches=touches, stream=stream, rounds=rounds, seed=seed, progress=say)
    if out:
        _write(out, markdown(report))
    if as_json:
        print_json(report.to_json())
    else:
        _show(tables(report))
    if report.stream_differences:
        raise typer.Exit(_NOT_GOOD_ENOUGH)


@study_app.command("hard-cases", epilog="Example: contactbench study hard-cases --samples 500")
def hard_cases(
    samples: Annotated[int, typer.Option(help="Wrenches for each case.")] = 2_000,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Try what breaks contact location, and judge each answer against an independent truth.

    Exit code 1 when a case fails.
    """
    from pipeline.study import hard_cases as study

    report = study.run(samples=samples, seed=seed, progress=say)
    if out:
        _write(out, study.markdown(report))
    if as_json:
        print_json(report.to_json())
    else:
        _show([study.table(report)])
    if not all(case.passed for case in report.cases):
        raise typer.Exit(_NOT_GOOD_ENOUGH)


@study_app.command(epilog="Example: contactbench study gravity --trials 500 --out gravity.md")
def gravity(
    trials: Annotated[int, typer.Option(help="Random set-ups for each statistical figure.")] = 2_000,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Measure gravity calibration: efficiency, coverage, bumped poses, blind sets, plans, time.

    Needs mujoco for the plans. Exit code 1 when a figure misses its target.
    """
    from pipeline.study import gravity as study

    report = study.run(trials=trials, seed=seed, progress=say)
    if out:
        _write(out, report.markdown())
    if as_json:
        print_json(report.to_json())
    else:
        _show([report.table()])
    if not report.passed:
        raise typer.Exit(_NOT_GOOD_ENOUGH)


def _whole_number(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        raise InputError(f"--facets: {text!r} is no whole number; give for instance 1000,20000") from None
    if value < 300:
        raise InputError(f"--facets: {value} is too coarse for a bundled probe; give at least 300")
    return value


def _show(tables: list[Table]) -> None:
    from rich.console import Console

    console = Console()
    for table in tables:
        console.print(table)


def _write(path: Path, text: str) -> None:
    try:
        write_durably(path, text.encode())
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be written ({error}); choose another --out") from error

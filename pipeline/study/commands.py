"""``contactbench study ...``: measurements as commands."""

from __future__ import annotations

from typing import Annotated

import typer

from contactbench.pipeline.console import JsonOption, Noun, print_json, say
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.ablation.commands import add_ablation_command
from contactbench.pipeline.study.confidence.commands import add_confidence_command
from contactbench.pipeline.study.finishing import (
    NOT_GOOD_ENOUGH,
    MarkdownOption,
    SeedOption,
    show,
    write,
)
from contactbench.pipeline.study.rivals.commands import add_rivals_command
from contactbench.pipeline.study.stability_commands import add_stability_commands
from contactbench.pipeline.study.sweep_commands import add_sweep_commands

study_app = Noun("Measure speed against error, stability on hard cases, and what a scene needs.")


@study_app.command(example="study speed --probe linear --out speed.md")
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
    from contactbench.pipeline.study import speed as study
    from contactbench.pipeline.study.speed_tables import markdown, tables

    counts = sorted(_whole_number(text) for text in facets.split(","))
    report = study.run(probe, counts, touches=touches, stream=stream, rounds=rounds, seed=seed, progress=say)
    if out:
        write(out, markdown(report))
    if as_json:
        print_json(report.to_json())
    else:
        show(tables(report))
    if report.stream_differences:
        raise typer.Exit(NOT_GOOD_ENOUGH)


@study_app.command("hard-cases", example="study hard-cases --samples 500")
def hard_cases(
    samples: Annotated[int, typer.Option(help="Wrenches for each case.")] = 2_000,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Try what breaks contact location, and judge each answer against an independent truth.

    Exit code 1 when a case fails.
    """
    from contactbench.pipeline.study import hard_cases as study

    report = study.run(samples=samples, seed=seed, progress=say)
    if out:
        write(out, study.markdown(report))
    if as_json:
        print_json(report.to_json())
    else:
        show([study.table(report)])
    if not all(case.passed for case in report.cases):
        raise typer.Exit(NOT_GOOD_ENOUGH)


@study_app.command(example="study scenes --probe convex --period 2")
def scenes(
    probe: Annotated[str, typer.Option(help="Bundled probe: linear, convex or t-shape.")] = "convex",
    period: Annotated[float, typer.Option(help="Of the platform's motion, s.")] = 2.0,
    as_json: JsonOption = False,
) -> None:
    """Measure what the platform and the arm scene leave out: servo, inertia, friction, time step, places."""
    from contactbench.pipeline.study import scene_limits as study

    report = study.run(probe, period, progress=say)
    say(study.markdown(report))
    if as_json:
        print_json(report.to_json())


def _whole_number(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        raise InputError(f"--facets: {text!r} is no whole number; give for instance 1000,20000") from None
    if value < 300:
        raise InputError(f"--facets: {value} is too coarse for a bundled probe; give at least 300")
    return value


add_sweep_commands(study_app)
add_ablation_command(study_app)
add_rivals_command(study_app)
add_stability_commands(study_app)
add_confidence_command(study_app)

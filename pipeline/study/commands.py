"""``contactbench study ...``: measurements as commands."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contactbench.pipeline.console import JsonOption, print_json, say
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.ablation.commands import add_ablation_command
from contactbench.pipeline.study.confidence.commands import add_confidence_command
from contactbench.pipeline.study.control_commands import add_control_commands
from contactbench.pipeline.study.device_commands import add_device_commands
from contactbench.pipeline.study.finishing import (
    NOT_GOOD_ENOUGH,
    MarkdownOption,
    SeedOption,
    finish,
    show,
    write,
)
from contactbench.pipeline.study.interactive_commands import add_commands
from contactbench.pipeline.study.preparation_commands import add_preparation_commands
from contactbench.pipeline.study.rivals.commands import add_rivals_command
from contactbench.pipeline.study.stability_commands import add_stability_commands
from contactbench.pipeline.study.sweep_commands import add_sweep_commands

study_app = typer.Typer(
    help="Measure speed against error, stability on hard cases, and every step of preparing a probe.",
    epilog="Example: contactbench study speed --probe t-shape --facets 1000,20000 --json",
    no_args_is_help=True,
    rich_markup_mode=None,
)


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
    from contactbench.pipeline.study import gravity as study

    finish(study.run(trials=trials, seed=seed, progress=say), out, as_json=as_json)


@study_app.command(
    "calibration-doubt", epilog="Example: contactbench study calibration-doubt --cells drift --sets 100"
)
def calibration_doubt(
    sets: Annotated[int, typer.Option(help="Drawn sessions of poses for each cell.")] = 300,
    cells: Annotated[str, typer.Option(help="Only cells with this in their name, such as re-zero.")] = "",
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes that calibrate at once [number of cores].")
    ] = None,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Calibrate sessions with a drift, a re-zero, a cable, a turned mount or wrong noise, and judge what is told.

    Shares have their 95 % interval behind them.
    Exit code 1 when a figure misses its target.
    """
    from contactbench.pipeline.study import calibration_doubt as study

    report = study.run(sets=sets, cells=cells, workers=workers, seed=seed, progress=say)
    finish(report, out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study mistakes --trials 50 --out mistakes.md")
def mistakes(
    trials: Annotated[int, typer.Option(help="Random sets of poses for each mistake.")] = 200,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Diagnose poses with mistakes that the convention check knows, and others: the cause is named, or none is.

    Exit code 1 when a figure misses its target.
    """
    from contactbench.pipeline.study import mistakes as study

    finish(study.run(trials=trials, seed=seed, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study verification --trials 200")
def verification(
    trials: Annotated[int, typer.Option(help="Synthetic verifications for each figure.")] = 1_000,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Verify with known bias, scatter and causes: whether intervals are what they say, and the cause is named.

    Exit code 1 when a figure misses its target.
    """
    from contactbench.pipeline.study import verification as study

    finish(study.run(trials=trials, seed=seed, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study bundles --count 5000")
def bundles(
    count: Annotated[int, typer.Option(help="Mutated bundles.")] = 5_000,
    cpp: Annotated[
        Path | None, typer.Option(help="The program contactbench-load_all, to compare the loader in C++.")
    ] = None,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Load runtime configs that were damaged or tampered with: each is refused with a reason.

    Exit code 1 when one is not, or when the loader in C++ comes to another verdict.
    """
    from contactbench.pipeline.study import bundle_fuzz as study

    finish(study.run(count, seed, cpp).report(), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study runtime --seconds 20 --minutes 2")
def runtime(
    seconds: Annotated[float, typer.Option(help="How long a sensor is read live at 1 kHz, s.")] = 60.0,
    minutes: Annotated[float, typer.Option(help="How much of a 1 kHz recording is replayed, min.")] = 60.0,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Run a bundle on a live sensor and on a long recording: time from byte to contact, memory, nothing lost.

    Exit code 1 when a figure misses its target.
    """
    from contactbench.pipeline.study import runtime as study

    finish(study.run(seconds, minutes, seed=seed, progress=say), out, as_json=as_json)


def _whole_number(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        raise InputError(f"--facets: {text!r} is no whole number; give for instance 1000,20000") from None
    if value < 300:
        raise InputError(f"--facets: {value} is too coarse for a bundled probe; give at least 300")
    return value


add_preparation_commands(study_app)
add_device_commands(study_app)
add_control_commands(study_app)
add_commands(study_app)
add_sweep_commands(study_app)
add_ablation_command(study_app)
add_rivals_command(study_app)
add_stability_commands(study_app)
add_confidence_command(study_app)

"""``contactbench study ...``: measurements as commands."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Protocol

import typer

from pipeline.console import Bar, JsonOption, print_json, say
from pipeline.durable import write_durably
from pipeline.errors import InputError
from pipeline.study.interactive_commands import add_commands
from pipeline.study.sweep_commands import add_sweep_commands

if TYPE_CHECKING:
    from typing import Any

    from rich.table import Table

study_app = typer.Typer(
    help="Measure speed against error, stability on hard cases, and every step of preparing a probe.",
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

    _finish(study.run(trials=trials, seed=seed, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study simplify --facets-in 100000 --facets-out 500 --memory")
def simplify(
    facets_in: Annotated[int, typer.Option(help="Facets of each shape before.")] = 100_000,
    facets_out: Annotated[int, typer.Option(help="Facets to leave.")] = 500,
    shapes: Annotated[
        str, typer.Option(help="Comma separated: linear, convex, t-shape, bumpy sphere.")
    ] = "linear,convex,t-shape,bumpy sphere",
    rounds: Annotated[int, typer.Option(help="Timed calls of each, in turn.")] = 7,
    memory: Annotated[
        bool, typer.Option("--memory", help="Also take a million facets' peak memory.")
    ] = False,
    seed: Annotated[int, typer.Option(help="Seed of where regions are painted.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Measure simplification beside the libraries called bare: time, distance, units, regions, memory.

    Needs pymeshlab for the comparison. Exit code 1 when a figure misses its target.
    """
    from pipeline.study.preparation import simplify as study

    report = study.run(
        facets_in,
        facets_out,
        shapes=[shape.strip() for shape in shapes.split(",")],
        rounds=rounds,
        memory=memory,
        seed=seed,
        progress=say,
    )
    _finish(report, out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study regions --facets 300000 --strokes 200")
def regions(
    facets: Annotated[int, typer.Option(help="Facets of each bundled probe.")] = 300_000,
    strokes: Annotated[int, typer.Option(help="Timed strokes of each kind on each probe.")] = 200,
    undone: Annotated[int, typer.Option(help="Strokes undone and done again.")] = 1_000,
    seed: Annotated[int, typer.Option(help="Seed of where the strokes go.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Measure painting: time of a stroke beside scipy's, errors of surface distances, undo and redo.

    Exit code 1 when a figure misses its target.
    """
    from pipeline.study.preparation import regions as study

    _finish(study.run(facets, strokes=strokes, undone=undone, seed=seed, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study alignment --setups 300 --out alignment.md")
def alignment(
    setups: Annotated[int, typer.Option(help="Random set-ups on each probe.")] = 300,
    adoptions: Annotated[int, typer.Option(help="Set-ups for each mount whose advice is counted.")] = 60,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Measure alignment by touches: contact error, stated uncertainty, advice, what a flat face does not show.

    Exit code 1 when a figure misses its target.
    """
    from pipeline.study.preparation import alignment as study

    _finish(study.run(setups, adoptions=adoptions, seed=seed, progress=say), out, as_json=as_json)


@study_app.command("mesh-fuzz", epilog="Example: contactbench study mesh-fuzz --count 10000")
def mesh_fuzz(
    count: Annotated[int, typer.Option(help="Hostile files.")] = 10_000,
    seed: Annotated[int, typer.Option(help="Seed of the series of files.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Read hostile mesh files in child processes: each must give a valid mesh or a typed error, soon.

    Exit code 1 when a file does anything else, or takes too much time or memory.
    """
    from pipeline.study import mesh_fuzz as study
    from pipeline.study.preparation.fuzz import summarise

    with Bar("Reading files", counted=True) as bar:
        report = study.run(count, seed, bar)
    _finish(summarise(report), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study shell housing.stl other.stl --out shell.md")
def shell(
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="FILE...", help="Mesh files; the bundled probes as hollow housings if left out."
        ),
    ] = None,
    facets: Annotated[int, typer.Option(help="Facets of each bundled probe.")] = 20_000,
    quick: Annotated[bool, typer.Option("--quick", help="One housing, coarse facets.")] = False,
    seed: Annotated[int, typer.Option(help="Seed of the points that are measured.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Make the outer shell of meshes and measure it: time, soundness, distance to what can be seen, openings.

    Needs pymeshlab. Exit code 1 when a figure misses its target.
    """
    from pipeline.study.preparation import shell as study

    report = study.run(files or (), facets=facets, quick=quick, seed=seed, progress=say)
    _finish(report, out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study protocols --bytes 10000000")
def protocols(
    count: Annotated[int, typer.Option("--bytes", help="Random bytes for each parser.")] = 10_000_000,
    frames: Annotated[int, typer.Option(help="Frames of each damaged stream.")] = 50_000,
    seed: Annotated[int, typer.Option(help="Seed of bytes and damage.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Feed the parsers of all devices random bytes and damaged streams: false frames, frames recovered, speed.

    Exit code 1 when a figure misses its target.
    """
    from pipeline.study import devices as study

    _finish(study.run_protocols(count, frames, seed=seed, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study sessions --kills 200")
def sessions(
    kills: Annotated[int, typer.Option(help="Times that a writing process is killed.")] = 200,
    seed: Annotated[int, typer.Option(help="Seed of the moments.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Kill a process that writes a session, again and again: nothing acknowledged may be lost.

    Exit code 1 when something was.
    """
    from pipeline.study import devices as study

    _finish(study.run_sessions(kills, seed=seed, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study faults --out faults.md")
def faults(
    trials: Annotated[int, typer.Option(help="Re-zeros of each size for the detector's figures.")] = 300,
    short: Annotated[bool, typer.Option("--short", help="One fault of each kind on two devices.")] = False,
    seed: Annotated[int, typer.Option(help="Seed of signals and faults.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Give every emulated device every fault on a live line: when it is shown, recovered, and nothing made up.

    Exit code 1 when a fault is not shown in time, or a sample is not one that was sent.
    """
    from pipeline.study import faults as study

    _finish(study.run(short=short, trials=trials, seed=seed, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study live --seconds 60 --sensors 3")
def live(
    seconds: Annotated[float, typer.Option(help="How long, s; 600 is a soak.")] = 600.0,
    sensors: Annotated[int, typer.Option(help="How many at once.")] = 3,
    rate: Annotated[float, typer.Option(help="Samples a second of each, Hz.")] = 1000.0,
    busy: Annotated[
        bool, typer.Option("--busy", help="Once more beside a process that never rests.")
    ] = False,
    seed: Annotated[int, typer.Option(help="Seed of the readings.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Read several sensors at once from serial lines: samples lost, time from byte to sample, load of a core.

    Exit code 1 when a figure misses its target.
    """
    from pipeline.study.live import report as study

    _finish(study.run(seconds, sensors, rate=rate, busy=busy, seed=seed, progress=say), out, as_json=as_json)


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
    from pipeline.study import verification as study

    _finish(study.run(trials=trials, seed=seed, progress=say), out, as_json=as_json)


@study_app.command(epilog="Example: contactbench study bundles --count 5000")
def bundles(
    count: Annotated[int, typer.Option(help="Mutated bundles.")] = 5_000,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Load runtime configs that were damaged or tampered with: each is refused with a reason.

    Exit code 1 when one is not.
    """
    from pipeline.study import bundle_fuzz as study

    _finish(study.run(count, seed).report(), out, as_json=as_json)


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
    from pipeline.study import runtime as study

    _finish(study.run(seconds, minutes, seed=seed, progress=say), out, as_json=as_json)


@study_app.command("control-safety", epilog="Example: contactbench study control-safety --runs 100")
def control_safety(
    runs: Annotated[
        int, typer.Option(help="Random starts; a fifth with each kind of fault, a fifth with none.")
    ] = 1_000,
    workers: Annotated[int | None, typer.Option(help="Processes [one for each core].")] = None,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Start motion control at random: tissue, friction, motion, sensor faults; the force's limit, and safe ends.

    Needs MuJoCo. Exit code 1 when a force passed its limit by more than 20 %, an end was not safe, or a loop swung.
    """
    from pipeline.study import control_safety as study

    with Bar("starting", counted=True) as bar:
        report = study.run(runs, seed=seed, workers=workers, progress=bar)
    _finish(report, out, as_json=as_json)


class _Report(Protocol):
    @property
    def passed(self) -> bool: ...
    def to_json(self) -> dict[str, Any]: ...
    def table(self) -> Table: ...
    def markdown(self) -> str: ...


def _finish(report: _Report, out: Path | None, *, as_json: bool) -> None:
    """Write, print, and leave with the exit code of a report that says whether it reached its targets."""
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


add_commands(study_app)
add_sweep_commands(study_app)

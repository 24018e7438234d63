"""``contactbench study ...``: measurements as commands."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Protocol

import typer

from contactbench.pipeline.console import Bar, JsonOption, Noun, print_json, say, show_tables
from contactbench.pipeline.durable import make_folder, write_file
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from rich.table import Table

    from contactbench.pipeline.study.results import Results
    from contactbench.pipeline.study.sweep.plan import SweepPlan

study_app = Noun("Measure speed against error, stability on hard cases, and what a scene needs.")

_NOT_GOOD_ENOUGH = 1
_MOST_PARTS = 1_000_000
_OTHERS = ("hard", "ablation", "rivals")

SeedOption = Annotated[int, typer.Option(help="Seed of the touches and the noise.")]
MarkdownOption = Annotated[
    Path | None, typer.Option("--out", help="Also write the tables to this Markdown file.")
]
ProbesOption = Annotated[
    list[str] | None,
    typer.Option(help="Bundled probe or prepared .ply in S; may be repeated [the bundled ones]."),
]
BundledOption = Annotated[list[str] | None, typer.Option(help="Bundled probe; may be repeated [all].")]


class _Report(Protocol):
    """What a study gives."""

    @property
    def passed(self) -> bool: ...

    def to_json(self) -> dict[str, Any]: ...

    def tables(self) -> list[Table]: ...


def _finish(report: _Report, *, as_json: bool) -> None:
    """Print, and leave with the exit code of a report that says whether it reached its targets."""
    from rich.console import Console

    if as_json:
        print_json(report.to_json())
    else:
        console = Console()
        for table in report.tables():
            console.print(table)
    if not report.passed:
        raise typer.Exit(_NOT_GOOD_ENOUGH)


def _typed(*given: str, **options: object) -> str:
    """Return a command as it is typed; without what is None or False, and without the folders of files."""
    words = ["contactbench", "study", *given]
    for option, value in options.items():
        if value is True:
            words.append(f"--{option}")
        elif value is not None and value is not False:
            for each in value if isinstance(value, list) else (value,):
                words += [f"--{option}", Path(str(each)).name]
    return shlex.join(words)


# ---- methods, hard cases, scenes -----------------------------------------------------------------


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
    """Time every method and its rivals in one run, with the error on the same touches.

    Times are for this machine: compare the ratios. Exit code 1: tracking and a cold solve disagreed.
    """
    from contactbench.pipeline.study import speed as study

    counts = sorted(_whole_number(text) for text in facets.split(","))
    report = study.run(probe, counts, touches=touches, stream=stream, rounds=rounds, seed=seed, progress=say)
    if out:
        write_file(out, report.markdown().encode())
    _finish(report, as_json=as_json)


def _whole_number(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        raise InputError(f"--facets: {text!r} is not a whole number: give for instance 1000,20000") from None
    if value < 300:
        raise InputError(f"--facets: {value} is too coarse for a bundled probe: give at least 300")
    return value


@study_app.command("hard-cases", example="study hard-cases --samples 500")
def hard_cases(
    samples: Annotated[int, typer.Option(help="Wrenches for each case.")] = 2_000,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Run hard cases of contact location, and judge each answer against an independent truth.

    Exit code 1: a case fails.
    """
    from contactbench.pipeline.study import hard_cases as study

    report = study.run(samples=samples, seed=seed, progress=say)
    if out:
        write_file(out, report.markdown().encode())
    _finish(report, as_json=as_json)


@study_app.command(example="study scene --probe convex --seeds 2")
def scene(
    probe: BundledOption = None,
    seeds: Annotated[int, typer.Option(help="Number of benches, with seeds from --seed on.")] = 5,
    seed: SeedOption = 0,
    reality: Annotated[
        list[str] | None,
        typer.Option(
            metavar="MIX|EFFECT=SIZE,...", help="Mix to take apart; may be repeated [typical and harsh]."
        ),
    ] = None,
    moving: Annotated[
        bool, typer.Option("--moving", help="Instead: leave out single effects of the platform and the arm.")
    ] = False,
    period: Annotated[float, typer.Option(help="With --moving: period of the platform's motion, s.")] = 2.0,
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Save the results in this folder, with a page of tables."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Measure the cost of each effect of a real bench in mm: alone, and as the gain of a mix without it.

    A gravity calibration, then presses on every marker, on benches with one effect each, with the whole mix, and
    with the mix without one effect: the same benches and the same noise each time. With --moving instead: servo,
    inertia, friction, time step and places of the platform and the arm scene.
    """
    from contactbench.pipeline.reality import Reality
    from contactbench.pipeline.simulation.marker_touches import check_bundled
    from contactbench.pipeline.study import reality_costs, scene_limits
    from contactbench.pipeline.study.pages import publish
    from contactbench.pipeline.study.scene_page import KIND, rows_of

    if moving:
        names = check_bundled(probe or ["convex"])
        report = scene_limits.report_of([scene_limits.run(name, period, progress=say) for name in names])
        command = _typed("scene", moving=True, probe=names, period=period)
    else:
        mixes = [Reality.parse(text) for text in reality or ("typical", "harsh")]
        report = reality_costs.run(mixes, probe, seeds=seeds, seed=seed, progress=say)
        command = _typed("scene", probe=probe, seeds=seeds, seed=seed, reality=reality)
    if out:
        say(f"{publish(out, KIND, command, rows_of(report))}: page")
    if as_json:
        print_json(report.to_json())
    else:
        show_tables(*(sheet.table() for sheet in report.sheets))


# ---- sweeps, and pages of all studies --------------------------------------------------------------


@study_app.command(example="study run --preset quick --out quick-study")
def run(
    study: Annotated[
        Path | None, typer.Argument(metavar="[STUDY.toml]", help="Study file: what to vary.")
    ] = None,
    preset: Annotated[
        str | None,
        typer.Option(
            help=(
                "Instead: one of paper, resolution, quick, steep; hard, ablation and rivals are the"
                " studies of that kind."
            )
        ),
    ] = None,
    probe: Annotated[
        list[str] | None,
        typer.Option(help="Bundled probe or prepared .ply in S; may be repeated [the plan's]."),
    ] = None,
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Folder for the results; finished cells are kept.")
    ] = Path("contactbench-study"),
    workers: Annotated[
        int | None,
        typer.Option(
            min=1,
            help=(
                "Number of processes [one per core]. For timing use 1, because processes share the machine."
            ),
        ),
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(help="Address of a Dask scheduler, tcp://HOST:PORT [this machine].")
    ] = None,
    touches: Annotated[int | None, typer.Option(help="Touches per cell [the plan's].")] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of the touches [the plan's].")] = None,
    times: Annotated[bool, typer.Option(help="Also measure times.")] = True,
    part: Annotated[
        str | None,
        typer.Option(
            metavar="K/N",
            help="Compute only this of N parts, each on a machine of its own, into one shared folder [1/1].",
        ),
    ] = None,
    dry_run: Annotated[
        bool,
        typer.Option("--dry-run", help="Measure a few cells, and estimate the time and memory of all."),
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Sweep methods, meshes, probes, forces, angles, torsions, noises and filters.

    Errors are the same whatever the number of workers. After Ctrl-C or a crash, it resumes where it stopped.
    Exit code 1: a cell could not be computed. The presets hard, ablation and rivals are not sweeps: they run
    `study stability`, `study ablation` and `study rivals`, which have more options.
    """
    from contactbench.pipeline.study.sweep.plan import SweepPlan, preset_plan
    from contactbench.pipeline.study.sweep.run import run as sweep

    if (study is None) == (preset is None):
        raise InputError("study run: give either a STUDY.toml or a --preset.")
    if preset in _OTHERS:
        given = {
            "--workers": workers,
            "--scheduler": scheduler,
            "--no-times": not times,
            "--part": part,
            "--dry-run": dry_run,
            "--touches": None if preset == "hard" else touches,
        }
        if unknown := [name for name, value in given.items() if value]:
            raise InputError(f"--preset {preset}: {', '.join(unknown)} is not available: leave it out.")
        common: dict[str, Any] = {"out": out, "probe": probe or None, "seed": seed or 0, "as_json": as_json}
        if preset == "hard":
            stability(**common, **({} if touches is None else {"samples": touches}))
        elif preset == "ablation":
            ablation(**common)
        else:
            rivals(**common)
        return
    plan = (preset_plan(str(preset)) if study is None else SweepPlan.read(study)).changed(
        probe or (), touches, seed, None if times else False
    )
    command = _typed(
        "run",
        *([] if study is None else [study.name]),
        preset=preset,
        probe=probe,
        touches=touches,
        seed=seed,
        **{"no-times": not times},
    )
    if dry_run:
        if part is not None:
            raise InputError("--dry-run estimates the whole plan: leave out --part, and divide.")
        _estimate(plan, workers, as_json)
        return
    say(f"{plan.name}: up to {len(plan):,} cells of {plan.touches:,} touches")
    with Bar("computing", counted=True) as bar:
        done = sweep(
            plan,
            out,
            command=command,
            scheduler=scheduler,
            workers=workers,
            part=_part(part),
            progress=bar,
        )
    for missing in done.left_out:
        say(f"left out: {missing}", "yellow")
    for fault in done.faults:
        say(f"not computed: {fault}", "red")
    where = done.results or "\n".join((*done.strange, f"{out}: not all parts are done"))
    say(f"{where}: {done.cells:,} cells, {done.computed:,} computed now, {done.failed:,} failed.")
    if as_json:
        print_json(done.to_json())
    if done.failed:
        raise typer.Exit(_NOT_GOOD_ENOUGH)


def _part(text: str | None) -> tuple[int, int]:
    number, slash, of = (text or "1/1").partition("/")
    if not (slash and number.isdecimal() and of.isdecimal() and 1 <= int(number) <= int(of) <= _MOST_PARTS):
        raise InputError(f"--part {text}: give which of how many, such as 2/8, and at most {_MOST_PARTS:,}.")
    return int(number), int(of)


def _estimate(plan: SweepPlan, workers: int | None, as_json: bool) -> None:
    from contactbench.pipeline.study.sweep.estimate import estimate

    with Bar("measuring", counted=True) as bar:
        found = estimate(plan, workers=workers, progress=bar)
    memory = "" if found.worker_MB is None else f", {found.worker_MB:,.0f} MB of memory for each"
    say(
        f"{plan.name}: {found.cells:,} cells, {found.touches:,} touches in {found.tasks:,} tasks. Measured on"
        f" {found.measured:,} cells: {_hours(found.core_hours)} of one core; {_hours(found.hours)} on"
        f" {found.workers:,}{memory}. The results take {found.results_MB:,.1f} MB."
    )
    if as_json:
        print_json(found.to_json())


def _hours(hours: float) -> str:
    return f"{hours:,.1f} hours" if hours >= 1 else f"{60 * hours:,.1f} minutes"


@study_app.command(example="study compare quick-study full-study")
def compare(
    small: Annotated[Path, typer.Argument(metavar="SMALL", help="Folder of a quick sweep.")],
    large: Annotated[Path, typer.Argument(metavar="LARGE", help="Folder of a full one.")],
    as_json: JsonOption = False,
) -> None:
    """Compare the conclusions of two sweeps: the order of methods in time and error, and growth exponents.

    Exit code 1: a clear order is reversed, or an exponent differs by more than 0.1.
    """
    from dataclasses import asdict

    from rich.table import Table

    from contactbench.pipeline.study.sweep.compare import compare as compared

    found = compared(list(_sweep(small).rows), list(_sweep(large).rows))
    differ = sum(not each.same for each in found)
    if as_json:
        print_json({"same": not differ, "findings": [asdict(each) for each in found]})
    else:
        table = Table(
            "conclusion", "small", "large", "", title=f"{len(found) - differ} of {len(found)} the same"
        )
        for each in found:
            table.add_row(each.what, each.small, each.large, "" if each.same else "differs")
        show_tables(table)
    if differ:
        raise typer.Exit(_NOT_GOOD_ENOUGH)


def _sweep(place: Path) -> Results:
    from contactbench.pipeline.study.results import read_results
    from contactbench.pipeline.study.sweep.run import KIND

    results = read_results(place)
    if results.kind != KIND:
        raise InputError(f"{place}: a study of kind {results.kind!r}: give the folder of a sweep.")
    return results


@study_app.command(example="study page quick-study --out docs")
def page(
    studies: Annotated[list[Path], typer.Argument(metavar="DIR...", help="Folders with results.parquet.")],
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Put the pages here, each under its study's name.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Make tables and plots of studies from their Parquet files: page.md in each, and all of them in one folder.

    Exit code 1: a sweep misses a target.
    """
    from contactbench.pipeline.study.pages import PAGE, gather, make_page
    from contactbench.pipeline.study.results import read_results
    from contactbench.pipeline.study.sweep.run import KIND
    from contactbench.pipeline.study.sweep.targets import targets

    if out is None:
        for folder in studies:
            make_page(folder)
        pages = [folder / PAGE for folder in studies]
    else:
        pages = gather(studies, out)
    sweeps = [results for results in map(read_results, studies) if results.kind == KIND]
    judged = [target for results in sweeps for target in targets(results.rows)]
    missed = [target for target in judged if not target.met]
    for target in missed:
        say(f"missed: {target.what}: {target.measured}", "red")
    say(", ".join(map(str, pages)))
    if as_json:
        shown = [{"what": target.what, "measured": target.measured} for target in missed]
        print_json({"pages": [str(p) for p in pages], "targets": len(judged), "missed": shown})
    if missed:
        raise typer.Exit(_NOT_GOOD_ENOUGH)


# ---- studies that keep their results ---------------------------------------------------------------


@study_app.command(example="study ablation --quick --out ablation")
def ablation(
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Folder for results.parquet, page.md, pictures.")
    ] = Path("contactbench-ablation"),
    probe: BundledOption = None,
    scene: Annotated[
        list[str] | None,
        typer.Option(help="touch, press, bench, platform or arm; may be repeated [all]."),
    ] = None,
    seeds: Annotated[
        int | None, typer.Option(help="Repetitions with other noise, for the spread [5].")
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of the first repetition.")] = 0,
    quick: Annotated[
        bool, typer.Option("--quick", help="Quick look: one probe, two scenes, few touches.")
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Measure the gain (mm) and cost (µs) of each modelling choice in each scene, and recommend what to model.

    Needs MuJoCo. Local torque, smooth normals, the friction gate, drift, the mount's rotation, crosstalk,
    a phantom that yields, an arm with dynamics.
    """
    from contactbench.pipeline.study.ablation import run as study
    from contactbench.pipeline.study.ablation.verdicts import about_choices
    from contactbench.pipeline.study.pages import publish

    sizes = _sized(study.QUICK if quick else study.AblationSizes(), probes=probe, scenes=scene, seeds=seeds)
    make_folder(out)
    rows = study.run(sizes, seed=seed, progress=say)
    command = _typed("ablation", quick=quick, probe=probe, scene=scene, seeds=sizes.seeds, seed=seed)
    place = publish(out, study.KIND, command, rows)
    found = about_choices(rows)
    for each in found:
        say(each.sentence)
    say(f"{place}: tables and curves.")
    if as_json:
        print_json({"page": str(place), "rows": len(rows), "choices": [c.to_json() for c in found]})


@study_app.command(example="study rivals --quick --out rivals")
def rivals(
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Folder for results.parquet, page.md, pictures.")
    ] = Path("contactbench-rivals"),
    probe: BundledOption = None,
    rounds: Annotated[int | None, typer.Option(help="Timed rounds of each, in turn [15].")] = None,
    seed: Annotated[int, typer.Option(help="Seed of touches and noise.")] = 0,
    quick: Annotated[
        bool, typer.Option("--quick", help="Quick look: one probe, one mesh, few rounds.")
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Locate the same touches with the literal Algorithm 1, ray tracers, Levenberg-Marquardt and ours, in one run.

    Missing packages are listed: pip install contactbench[rivals]. Exit code 1: a rival locates contacts both faster
    and more accurately.
    """
    from contactbench.pipeline.study.pages import publish
    from contactbench.pipeline.study.rivals import run as study
    from contactbench.pipeline.study.rivals.rows import duels

    sizes = _sized(study.QUICK if quick else study.RivalsSizes(), probes=probe, rounds=rounds)
    make_folder(out)
    rows = study.run(sizes, seed=seed, progress=say)
    command = _typed("rivals", quick=quick, probe=probe, rounds=sizes.rounds, seed=seed)
    place = publish(out, study.KIND, command, rows)
    for row in rows:
        if row["kind"] == "missing":
            say(f"{row['contender']}: {row['note']}")
    winners = [duel.words for duel in duels(rows) if duel.beats]
    for words in winners:
        say(f"Faster and more accurate: {words}.")
    say(f"{place}: all tables.")
    if as_json:
        print_json({"page": str(place), "rows": len(rows), "faster_and_more_accurate": winners})
    if winners:
        raise typer.Exit(_NOT_GOOD_ENOUGH)


@study_app.command(example="study stability --out stability-study")
def stability(
    probe: ProbesOption = None,
    samples: Annotated[int, typer.Option(help="Touches per figure, at least 50.")] = 1_000,
    quick: Annotated[bool, typer.Option("--quick", help="At most 50 touches per figure.")] = False,
    seed: SeedOption = 0,
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Save the results in this folder, with a page of tables and plots."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Measure the stability of answers on a probe's mesh, against a truth in long double.

    Exit code 1: a stated bound is exceeded.
    """
    from contactbench.assets import PROBE_NAMES
    from contactbench.pipeline.study import stability as study
    from contactbench.pipeline.study.pages import publish

    samples = min(samples, study.FEWEST) if quick else samples
    report = study.run(tuple(probe or PROBE_NAMES), samples=samples, seed=seed, progress=say)
    if out:
        command = _typed("stability", samples=samples, seed=seed, probe=probe)
        say(f"{publish(out, study.KIND, command, [row.to_json() for row in report.rows])}: page and plots")
    _finish(report, as_json=as_json)


@study_app.command(example="study confidence --quick --out confidence-study")
def confidence(
    probe: ProbesOption = None,
    touches: Annotated[
        int | None, typer.Option(min=100, help="Touches for each figure and seed [10,000].")
    ] = None,
    seeds: Annotated[int | None, typer.Option(min=1, help="Repetitions, for the spread [5].")] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Quick look: few touches, coarse meshes.")] = False,
    seed: SeedOption = 0,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR", help="Save the results in this folder, with a page of tables and the diagram."
        ),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Measure how reliable the stated confidence is: thin fins, regions, pulls, two touches, the ellipse.

    Exit code 1: a figure misses its bound.
    """
    from dataclasses import asdict

    from contactbench.assets import PROBE_NAMES
    from contactbench.pipeline.study.confidence import study
    from contactbench.pipeline.study.pages import publish

    sizes = _sized(study.QUICK if quick else study.ConfidenceSizes(), touches=touches, seeds=seeds)
    report = study.run(tuple(probe or PROBE_NAMES), sizes, seed=seed, progress=say)
    if out:
        command = _typed(
            "confidence", quick=quick, touches=sizes.touches, seeds=sizes.seeds, seed=seed, probe=probe
        )
        place = publish(out, study.KIND, command, [asdict(row) for row in report.rows])
        say(f"{place}: tables and the reliability diagram")
    _finish(report, as_json=as_json)


def _sized(sizes: Any, **given: Any) -> Any:
    """Return how much is measured, with what was given; what is None is left as it is."""
    values = {name: tuple(value) if isinstance(value, list) else value for name, value in given.items()}
    return replace(sizes, **{name: value for name, value in values.items() if value not in (None, ())})

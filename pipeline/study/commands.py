"""``contactbench study ...``: measurements as commands."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer
from pydantic import Field

from contactbench.pipeline.console import Bar, Noun, answer, as_json, say, show_tables
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.knobs import Settings, knob

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from contactbench.pipeline.study.harness import CasesReport
    from contactbench.pipeline.study.sweep.plan import SweepPlan

# ---- what a person chooses for a study, and what repeats it -----------------------------------------------


_SAVED = "Save the results in this folder, with a page of tables and plots."


class StudySettings(Settings):
    """What every study has."""

    out: Path | None = knob(None, _SAVED, metavar="DIR")

    def command(self, *given: str) -> str:
        """Return the command as it is typed, without the folders of files: `given` and what is not left out."""
        words = ["contactbench", "study", *given]
        for name, field in type(self).model_fields.items():
            value, extra = getattr(self, name), cast("dict[str, str]", field.json_schema_extra)
            option, _, no = extra["option"].partition("/")
            option = option or f"--{name.replace('_', '-')}"
            if name in _UNTOLD or value is None:
                continue
            if isinstance(value, bool):
                words += [option] if value and not no else [no] if not value and no else []
            else:
                for each in value if isinstance(value, tuple) else (value,):
                    words += [option, Path(str(each)).name]
        return shlex.join(words)


_UNTOLD = ("out", "workers", "scheduler", "part", "dry_run")  # the figures are the same with any


class SeededSettings(StudySettings):
    """What a study has that draws touches of its own."""

    seed: Annotated[int, Field(ge=0)] = knob(0, "Seed of the touches and the noise.")


class ProbesSettings(SeededSettings):
    """Whose probes are measured."""

    probe: tuple[str, ...] = knob(
        (), "Bundled probe or prepared .ply in S; may be repeated [the bundled ones]."
    )
    quick: bool = knob(False, "Quick look: few touches, coarse meshes.")


class StabilitySettings(ProbesSettings):
    """How much is tried of each figure of stability."""

    samples: int = knob(1_000, "Touches per figure, at least 50.")


class ConfidenceSettings(ProbesSettings):
    """How much is tried of each figure of confidence."""

    touches: Annotated[int, Field(ge=100)] | None = knob(None, "Touches for each figure and seed [10,000].")
    seeds: Annotated[int, Field(ge=1)] | None = knob(None, "Repetitions, for the spread [5].")


class SweepSettings(StudySettings):
    """Which plan is swept, what of it is changed, and who computes it."""

    out: Path = knob(
        Path("contactbench-study"), "Folder for the results; finished cells are kept.", metavar="DIR"
    )
    preset: str | None = knob(None, "Instead of a file: one of paper, resolution, quick, steep.")
    probe: tuple[str, ...] = knob((), "Bundled probe or prepared .ply in S; may be repeated [the plan's].")
    workers: Annotated[int, Field(ge=1)] | None = knob(
        None, "Number of processes [one per core]. For timing use 1, because processes share the machine."
    )
    scheduler: str | None = knob(None, "Address of a Dask scheduler, tcp://HOST:PORT [this machine].")
    touches: int | None = knob(None, "Touches per cell [the plan's].")
    seed: int | None = knob(None, "Seed of the touches [the plan's].")
    times: bool = knob(True, "Also measure times.", option="--times/--no-times")
    part: str | None = knob(
        None,
        "Compute only this of N parts, each on a machine of its own, into one shared folder [1/1].",
        metavar="K/N",
    )
    dry_run: bool = knob(False, "Measure a few cells, and estimate the time and memory of all.")

    @property
    def share(self) -> tuple[int, int]:
        """Which part of how many."""
        number, slash, of = (self.part or "1/1").partition("/")
        if not (
            slash and number.isdecimal() and of.isdecimal() and 1 <= int(number) <= int(of) <= _MOST_PARTS
        ):
            raise InputError(
                f"--part {self.part}: give which of how many, such as 2/8, and at most {_MOST_PARTS:,}."
            )
        return int(number), int(of)


_MOST_PARTS = 1_000_000


def sized(sizes: Any, settings: StudySettings, *names: str) -> Any:
    """Return how much is measured, with what the settings say of it; what is None is left as it is."""
    from dataclasses import replace

    given = {name: getattr(settings, name) for name in names}
    return replace(sizes, **{name: value for name, value in given.items() if value is not None})


study_app = Noun("Measure speed against error, stability and confidence.")

_NOT_GOOD_ENOUGH = 1


def _finish(
    report: CasesReport[Any], settings: StudySettings, kind: str, rows: Sequence[Mapping[str, Any]]
) -> None:
    """Save what a study of a kind that has a page measured, print its report, and leave with its exit code."""
    if settings.out:
        from contactbench.pipeline.study.pages import publish

        say(f"{publish(settings.out, kind, settings.command(kind), rows)}: page of tables and plots")
    if as_json():
        answer(report.to_json())
    else:
        show_tables(*report.tables())
    _judge(report.passed)


def _judge(passed: bool) -> None:
    if not passed:
        raise typer.Exit(_NOT_GOOD_ENOUGH)


# ---- stability, confidence -------------------------------------------------------


@study_app.command(example="study stability --out stability-study")
def stability(settings: StabilitySettings) -> None:
    """Measure the stability of answers on a probe's mesh, against a truth in long double.

    Exit code 1: a stated bound is exceeded.
    """
    from contactbench.assets import PROBE_NAMES
    from contactbench.pipeline.study import stability as study

    samples = min(settings.samples, study.FEWEST) if settings.quick else settings.samples
    report = study.run(settings.probe or PROBE_NAMES, samples=samples, seed=settings.seed, progress=say)
    _finish(report, settings, study.KIND, [row.to_json() for row in report.rows])


@study_app.command(example="study confidence --quick --out confidence-study")
def confidence(settings: ConfidenceSettings) -> None:
    """Measure what an answer's own word is worth: two touches, confidence told against right, the 95 % ellipse.

    Exit code 1: a figure misses its bound.
    """
    from dataclasses import asdict

    from contactbench.assets import PROBE_NAMES
    from contactbench.pipeline.study.confidence import study

    sizes = sized(study.QUICK if settings.quick else study.ConfidenceSizes(), settings, "touches", "seeds")
    report = study.run(settings.probe or PROBE_NAMES, sizes, seed=settings.seed, progress=say)
    _finish(report, settings, study.KIND, [asdict(row) for row in report.rows])


# ---- sweeps, and pages of all studies --------------------------------------------------------------


@study_app.command(example="study run --preset quick --out quick-study")
def run(study: Path | None = None, /, *, settings: SweepSettings) -> None:
    """Sweep methods, meshes, probes, forces, angles, torsions, noises and filters.

    Errors are the same whatever the number of workers. After Ctrl-C or a crash, it resumes where it stopped.
    Exit code 1: a cell could not be computed.

    Parameters
    ----------
    study : [STUDY.toml]
        Study file: what to vary.
    """
    from contactbench.pipeline.study.sweep.plan import SweepPlan, preset_plan
    from contactbench.pipeline.study.sweep.run import run as sweep

    if (study is None) == (settings.preset is None):
        raise InputError("study run: give either a STUDY.toml or a --preset.")
    plan = (preset_plan(str(settings.preset)) if study is None else SweepPlan.read(study)).changed(
        settings.probe, settings.touches, settings.seed, None if settings.times else False
    )
    if settings.dry_run:
        if settings.part is not None:
            raise InputError("--dry-run estimates the whole plan: leave out --part, and divide.")
        _estimate(plan, settings.workers)
        return
    say(f"{plan.name}: up to {len(plan):,} cells of {plan.touches:,} touches")
    with Bar("computing", counted=True) as bar:
        done = sweep(
            plan,
            settings.out,
            command=settings.command("run", *([] if study is None else [study.name])),
            scheduler=settings.scheduler,
            workers=settings.workers,
            part=settings.share,
            progress=bar,
        )
    for missing in done.left_out:
        say(f"left out: {missing}", "yellow")
    for fault in done.faults:
        say(f"not computed: {fault}", "red")
    where = done.results or "\n".join((*done.strange, f"{settings.out}: not all parts are done"))
    say(f"{where}: {done.cells:,} cells, {done.computed:,} computed now, {done.failed:,} failed.")
    answer(done.to_json())
    _judge(not done.failed)


def _estimate(plan: SweepPlan, workers: int | None) -> None:
    from contactbench.pipeline.study.sweep.run import estimate

    with Bar("measuring", counted=True) as bar:
        found = estimate(plan, workers=workers, progress=bar)
    memory = "" if found.worker_MB is None else f", {found.worker_MB:,.0f} MB of memory for each"
    say(
        f"{plan.name}: {found.cells:,} cells, {found.touches:,} touches in {found.tasks:,} tasks. Measured on"
        f" {found.measured:,} cells: {_hours(found.core_hours)} of one core; {_hours(found.hours)} on"
        f" {found.workers:,}{memory}. The results take {found.results_MB:,.1f} MB."
    )
    answer(found.to_json())


def _hours(hours: float) -> str:
    return f"{hours:,.1f} hours" if hours >= 1 else f"{60 * hours:,.1f} minutes"


@study_app.command(example="study page quick-study --out docs")
def page(studies: list[Path], /, *, out: Path | None = None) -> None:
    """Make tables and plots of studies from their Parquet files: page.md in each, and all of them in one folder.

    Exit code 1: a sweep misses a target.

    Parameters
    ----------
    studies : DIR...
        Folders with results.parquet.
    out : DIR
        Put the pages here, each under its study's name.
    """
    from contactbench.pipeline.study.pages import PAGE, gather, make_page, read_results
    from contactbench.pipeline.study.sweep.growth import targets
    from contactbench.pipeline.study.sweep.run import KIND

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
    shown = [{"what": target.what, "measured": target.measured} for target in missed]
    answer({"pages": [str(p) for p in pages], "targets": len(judged), "missed": shown})
    _judge(not missed)

"""``contactbench study run``, ``compare`` and ``page``: sweeps of speed against error, and what is shown of studies."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.console import Bar, JsonOption, Noun, print_json, say, show_tables
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.finishing import NOT_GOOD_ENOUGH

_OTHERS = ("hard", "ablation", "rivals")

if TYPE_CHECKING:
    from contactbench.pipeline.study.results import Results
    from contactbench.pipeline.study.sweep.growth import Row


def add_sweep_commands(app: Noun) -> None:
    """Add the commands to ``contactbench study``."""
    app.command(name="run", example="study run --preset quick --out quick-study")(run)
    app.command(name="compare", example="study compare quick-study full-study")(compare)
    app.command(name="page", example="study page quick-study --out docs")(page)


def run(
    study: Annotated[Path | None, typer.Argument(metavar="[STUDY.toml]", help="What to vary.")] = None,
    preset: Annotated[
        str | None,
        typer.Option(
            help="Or one of paper, resolution, quick, steep; hard, ablation and rivals are the studies of that kind."
        ),
    ] = None,
    probe: Annotated[
        list[str] | None,
        typer.Option(help="Bundled probe or prepared .ply in S; may be repeated [the plan's]."),
    ] = None,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder; what is done in it is kept.")] = Path(
        "contactbench-study"
    ),
    workers: Annotated[
        int | None,
        typer.Option(min=1, help="Processes [one per core]. For times give 1: they share the machine."),
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(help="Address of a Dask scheduler, tcp://HOST:PORT [this machine].")
    ] = None,
    touches: Annotated[int | None, typer.Option(help="In each cell [the plan's].")] = None,
    seed: Annotated[int | None, typer.Option(help="Of the touches [the plan's].")] = None,
    times: Annotated[bool, typer.Option(help="Measure times, too.")] = True,
    as_json: JsonOption = False,
) -> None:
    """Sweep methods, meshes, probes, forces, angles, torsions, noises and filters.

    Errors are the same whatever the number of workers. Stopped with Ctrl-C or killed, it goes on from where it was.
    Exit code 1: a cell could not be computed. The presets hard, ablation and rivals are no sweeps: they run
    `study stability`, `study ablation` and `study rivals`, where more can be chosen.
    """
    from contactbench.pipeline.study.sweep.plan import Plan, label
    from contactbench.pipeline.study.sweep.presets import changed
    from contactbench.pipeline.study.sweep.presets import preset as named
    from contactbench.pipeline.study.sweep.run import run as sweep

    if (study is None) == (preset is None):
        raise InputError("study run: give either a STUDY.toml or a --preset.")
    if preset in _OTHERS:
        given = {"--workers": workers, "--scheduler": scheduler, "--no-times": not times or None}
        _run_other(
            preset, out, probe or [], touches, seed, [n for n, v in given.items() if v], as_json=as_json
        )
        return
    plan = named(str(preset)) if study is None else Plan.read(study)
    plan = changed(plan, probe or (), touches, seed)
    # Without the folders of files: they mean nothing elsewhere.
    words = ["contactbench", "study", "run", *(["--preset", str(preset)] if study is None else [study.name])]
    words += [word for name in probe or () for word in ("--probe", label(name))]
    words += [
        w
        for name, value in (("--touches", touches), ("--seed", seed))
        if value is not None
        for w in (name, str(value))
    ]
    say(f"{plan.name}: up to {len(plan):,} cells of {plan.touches:,} touches")
    with Bar("computing", counted=True) as bar:
        done = sweep(
            plan,
            out,
            command=shlex.join(words),
            scheduler=scheduler,
            workers=workers,
            timed=times,
            progress=bar,
        )
    for missing in done.left_out:
        say(f"left out: {missing}", "yellow")
    for fault in done.faults:
        say(f"not computed: {fault}", "red")
    say(f"{done.results}: {done.cells:,} cells, {done.computed:,} computed now, {done.failed:,} failed.")
    if as_json:
        print_json(
            {
                "results": str(done.results),
                "cells": done.cells,
                "computed": done.computed,
                "failed": done.failed,
                "left_out": list(done.left_out),
                "faults": list(done.faults),
            }
        )
    if done.failed:
        raise typer.Exit(NOT_GOOD_ENOUGH)


def _run_other(
    preset: str,
    out: Path,
    probes: list[str],
    touches: int | None,
    seed: int | None,
    meaningless: list[str],
    *,
    as_json: bool,
) -> None:
    """Run a study that is no sweep; InputError for options that mean nothing to it."""
    from contactbench.pipeline.study.ablation.commands import ablation
    from contactbench.pipeline.study.rivals.commands import rivals
    from contactbench.pipeline.study.stability_commands import stability

    sizes: dict[str, Any] = {} if touches is None else {"samples": touches}
    if preset != "hard":
        meaningless += ["--touches"] if sizes else []
    if meaningless:
        raise InputError(f"--preset {preset}: {', '.join(meaningless)}: it has no such option: leave it out.")
    if preset == "hard":
        stability(probe=probes or None, seed=seed or 0, out=out, as_json=as_json, **sizes)
    else:
        command = ablation if preset == "ablation" else rivals
        command(out=out, probe=probes or None, seed=seed or 0, as_json=as_json)


def compare(
    small: Annotated[Path, typer.Argument(metavar="SMALL", help="Folder of a quick sweep.")],
    large: Annotated[Path, typer.Argument(metavar="LARGE", help="Folder of a full one.")],
    as_json: JsonOption = False,
) -> None:
    """Compare what two sweeps conclude: the order of methods in time and error, and exponents of growth.

    Exit code 1: a clear order is reversed, or an exponent differs by more than 0.1.
    """
    from rich.table import Table

    from contactbench.pipeline.study.sweep.compare import compare as compared

    found = compared(_rows(small), _rows(large))
    differ = sum(not each.same for each in found)
    if as_json:
        print_json(
            {
                "same": not differ,
                "findings": [
                    {"what": f.what, "small": f.small, "large": f.large, "same": f.same} for f in found
                ],
            }
        )
    else:
        table = Table(
            "conclusion", "small", "large", "", title=f"{len(found) - differ} of {len(found)} the same"
        )
        for each in found:
            table.add_row(each.what, each.small, each.large, "" if each.same else "differs")
        show_tables(table)
    if differ:
        raise typer.Exit(NOT_GOOD_ENOUGH)


def _rows(place: Path) -> list[Row]:
    return list(_sweep(place).rows)


def _sweep(place: Path) -> Results:
    from contactbench.pipeline.study.results import read_results
    from contactbench.pipeline.study.sweep.run import KIND

    results = read_results(place)
    if results.kind != KIND:
        raise InputError(f"{place}: a study of kind {results.kind!r}: give the folder of a sweep.")
    return results


def page(
    studies: Annotated[list[Path], typer.Argument(metavar="DIR...", help="Folders with results.parquet.")],
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Put them together as results.md in this folder.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Make tables and plots of studies from their Parquet files alone: page.md in each, and one page of all.

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
        pages = [gather(studies, out)]
    sweeps = [results for results in map(read_results, studies) if results.kind == KIND]
    judged = [target for results in sweeps for target in targets(results.rows)]
    for target in judged:
        if not target.met:
            say(f"missed: {target.what}: {target.measured}", "red")
    say(", ".join(map(str, pages)))
    if as_json:
        missed = [{"what": t.what, "measured": t.measured} for t in judged if not t.met]
        print_json({"pages": [str(p) for p in pages], "targets": len(judged), "missed": missed})
    if not all(target.met for target in judged):
        raise typer.Exit(NOT_GOOD_ENOUGH)

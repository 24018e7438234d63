"""``contactbench study run`` and ``page``: sweeps of speed against error."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pipeline.console import Bar, JsonOption, print_json, say

_MISSED = 1


def add_sweep_commands(app: typer.Typer) -> None:
    """Add the commands to ``contactbench study``."""
    app.command(name="run", epilog="Example: contactbench study run --preset quick --out quick-study")(run)


def run(
    study: Annotated[Path | None, typer.Argument(metavar="[STUDY.toml]", help="What to vary.")] = None,
    preset: Annotated[str | None, typer.Option(help="Or one of paper, resolution, quick, steep.")] = None,
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
    Exit code 1: a cell could not be computed.
    """
    from pipeline.study.sweep.plan import Plan
    from pipeline.study.sweep.presets import changed
    from pipeline.study.sweep.presets import preset as named
    from pipeline.study.sweep.run import run as sweep

    if (study is None) == (preset is None):
        raise typer.BadParameter("give a STUDY.toml or a --preset.")
    plan = named(str(preset)) if study is None else Plan.read(study)
    plan = changed(plan, probe or (), touches, seed)
    say(f"{plan.name}: {len(plan):,} cells of {plan.touches:,} touches")
    with Bar("computing", counted=True) as bar:
        done = sweep(plan, out, scheduler=scheduler, workers=workers, timed=times, progress=bar)
    say(f"{done.results}: {done.cells:,} cells, {done.computed:,} computed now, {done.failed:,} failed.")
    if as_json:
        print_json(
            {
                "results": str(done.results),
                "cells": done.cells,
                "computed": done.computed,
                "failed": done.failed,
            }
        )
    if done.failed:
        raise typer.Exit(_MISSED)

"""``contactbench study simplify``, ``regions``, ``alignment``, ``mesh-fuzz`` and ``shell``: preparing a probe."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contactbench.pipeline.console import Bar, JsonOption, say
from contactbench.pipeline.study.finishing import MarkdownOption, SeedOption, finish


def add_preparation_commands(app: typer.Typer) -> None:
    """Add them to ``contactbench study``."""
    app.command(epilog="Example: contactbench study simplify --facets-in 100000 --facets-out 500 --memory")(
        simplify
    )
    app.command(epilog="Example: contactbench study regions --facets 300000 --strokes 200")(regions)
    app.command(epilog="Example: contactbench study alignment --setups 300 --out alignment.md")(alignment)
    app.command("mesh-fuzz", epilog="Example: contactbench study mesh-fuzz --count 10000")(mesh_fuzz)
    app.command(epilog="Example: contactbench study shell housing.stl other.stl --out shell.md")(shell)


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
    from contactbench.pipeline.study.preparation import simplify as study

    report = study.run(
        facets_in,
        facets_out,
        shapes=[shape.strip() for shape in shapes.split(",")],
        rounds=rounds,
        memory=memory,
        seed=seed,
        progress=say,
    )
    finish(report, out, as_json=as_json)


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
    from contactbench.pipeline.study.preparation import regions as study

    finish(study.run(facets, strokes=strokes, undone=undone, seed=seed, progress=say), out, as_json=as_json)


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
    from contactbench.pipeline.study.preparation import alignment as study

    finish(study.run(setups, adoptions=adoptions, seed=seed, progress=say), out, as_json=as_json)


def mesh_fuzz(
    count: Annotated[int, typer.Option(help="Hostile files.")] = 10_000,
    seed: Annotated[int, typer.Option(help="Seed of the series of files.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Read hostile mesh files in child processes: each must give a valid mesh or a typed error, soon.

    Exit code 1 when a file does anything else, or takes too much time or memory.
    """
    from contactbench.pipeline.study import mesh_fuzz as study
    from contactbench.pipeline.study.preparation.fuzz import summarise

    with Bar("Reading files", counted=True) as bar:
        report = study.run(count, seed, bar)
    finish(summarise(report), out, as_json=as_json)


def shell(
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="FILE...", help="Mesh files; the bundled probes as hollow housings if left out."
        ),
    ] = None,
    facets: Annotated[int, typer.Option(help="Facets of each bundled probe.")] = 20_000,
    quick: Annotated[bool, typer.Option("--quick", help="One housing.")] = False,
    seed: Annotated[int, typer.Option(help="Seed of the points that are measured.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Make the outer shell of meshes and measure it: time, soundness, distance to what can be seen, openings.

    Needs pymeshlab. Exit code 1 when a figure misses its target.
    """
    from contactbench.pipeline.study.preparation import shell as study

    report = study.run(files or (), facets=facets, quick=quick, seed=seed, progress=say)
    finish(report, out, as_json=as_json)

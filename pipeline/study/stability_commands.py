"""``contactbench study stability``: rounding, single precision, units, thin facets, cancellation, the same bits."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contactbench.pipeline.console import JsonOption, say
from contactbench.pipeline.study.finishing import SeedOption, finish


def add_stability_commands(app: typer.Typer) -> None:
    """Add the command to ``contactbench study``."""
    app.command(epilog="Example: contactbench study stability --out stability-study")(stability)


def stability(
    probe: Annotated[
        list[str] | None,
        typer.Option(help="Bundled probe or prepared .ply in S; may be repeated [the bundled ones]."),
    ] = None,
    samples: Annotated[int, typer.Option(help="Touches for each figure, at least 50.")] = 1_000,
    quick: Annotated[
        bool, typer.Option("--quick", help="Coarse meshes, one build of each compiler.")
    ] = False,
    seed: SeedOption = 0,
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Keep the results here, with a page of tables and plots."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Measure how steady the solver is, against long double, exact arithmetic and first-order theory.

    Single precision and the bits of other builds need g++; clang++ is compared where it is there.
    Exit code 1 when a stated bound is broken.
    """
    from contactbench.pipeline.study.stability import study
    from contactbench.pipeline.study.stability.probes import BUNDLED

    report = study.run(probe or BUNDLED, samples=samples, seed=seed, quick=quick, progress=say)
    if out:
        say(f"{study.keep(report, out)}: page and plots")
    finish(report, None, as_json=as_json)

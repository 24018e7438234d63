"""``contactbench study stability``: how steady answers are on a probe's mesh."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contactbench.pipeline.console import JsonOption, Noun, say
from contactbench.pipeline.study.finishing import SeedOption, finish


def add_stability_commands(app: Noun) -> None:
    """Add the command to ``contactbench study``."""
    app.command(example="study stability --out stability-study")(stability)


def stability(
    probe: Annotated[
        list[str] | None,
        typer.Option(help="Bundled probe or prepared .ply in S; may be repeated [the bundled ones]."),
    ] = None,
    samples: Annotated[int, typer.Option(help="Touches for each figure, at least 50.")] = 1_000,
    quick: Annotated[bool, typer.Option("--quick", help="At most 50 touches for each figure.")] = False,
    seed: SeedOption = 0,
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Keep the results here, with a page of tables and plots."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Measure how steady answers are on a probe's mesh, against a truth in long double.

    Exit code 1 when a stated bound is broken.
    """
    from contactbench.assets import PROBE_NAMES
    from contactbench.pipeline.study import stability as study
    from contactbench.pipeline.study.pages import publish

    samples = min(samples, study.FEWEST) if quick else samples
    names = tuple(probe or PROBE_NAMES)
    report = study.run(names, samples=samples, seed=seed, progress=say)
    if out:
        words = ["stability", "--samples", str(samples), "--seed", str(seed)]
        words += [] if names == PROBE_NAMES else [w for n in names for w in ("--probe", Path(n).name)]
        say(f"{publish(out, study.KIND, words, [row.to_json() for row in report.rows])}: page and plots")
    finish(report, None, as_json=as_json)

"""``contactbench study confidence``: whether sure answers are right, and confidence and ellipse what they say."""

from __future__ import annotations

from dataclasses import asdict, replace
from pathlib import Path
from typing import Annotated

import typer

from contactbench.pipeline.console import JsonOption, Noun, say
from contactbench.pipeline.study.finishing import SeedOption, finish


def add_confidence_command(app: Noun) -> None:
    """Add the command to ``contactbench study``."""
    app.command(example="study confidence --quick --out confidence-study")(confidence)


def confidence(
    probe: Annotated[
        list[str] | None,
        typer.Option(help="Bundled probe or prepared .ply in S; may be repeated [the bundled ones]."),
    ] = None,
    touches: Annotated[
        int | None, typer.Option(min=100, help="Touches for each figure and seed [10,000].")
    ] = None,
    seeds: Annotated[int | None, typer.Option(min=1, help="Repetitions, for the spread [5].")] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Few touches, coarse meshes: a look.")] = False,
    seed: SeedOption = 0,
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Keep the results here, with a page of tables and the diagram."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Measure how far an answer's own word can be trusted: thin fins, regions, pulls, two touches, the ellipse.

    Exit code 1 when a figure misses its bound.
    """
    from contactbench.assets import PROBE_NAMES
    from contactbench.pipeline.study.confidence import study
    from contactbench.pipeline.study.pages import publish

    sizes = study.QUICK if quick else study.Sizes()
    sizes = replace(sizes, touches=touches or sizes.touches, seeds=seeds or sizes.seeds)
    names = tuple(probe or PROBE_NAMES)
    report = study.run(names, sizes, seed=seed, progress=say)
    if out:
        words = ["confidence", *(["--quick"] if quick else []), "--touches", str(sizes.touches)]
        words += ["--seeds", str(sizes.seeds), "--seed", str(seed)]
        words += [] if names == PROBE_NAMES else [w for n in names for w in ("--probe", Path(n).name)]
        page = publish(out, study.KIND, words, [asdict(row) for row in report.rows])
        say(f"{page}: tables and the reliability diagram")
    finish(report, None, as_json=as_json)

"""``contactbench study ablation``: what a scene needs."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from contactbench.pipeline.console import JsonOption, Noun, print_json, say


def add_ablation_command(app: Noun) -> None:
    """Add the command to ``contactbench study``."""
    app.command(example="study ablation --quick --out ablation")(ablation)


def ablation(
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Folder for results.parquet, page.md, pictures.")
    ] = Path("contactbench-ablation"),
    probe: Annotated[list[str] | None, typer.Option(help="Bundled probe; may be repeated [all].")] = None,
    scene: Annotated[
        list[str] | None,
        typer.Option(help="touch, press, bench, platform or arm; may be repeated [all]."),
    ] = None,
    seeds: Annotated[
        int | None, typer.Option(help="Repetitions with other noise, for the spread [5].")
    ] = None,
    seed: Annotated[int, typer.Option(help="Of the first repetition.")] = 0,
    quick: Annotated[
        bool, typer.Option("--quick", help="One probe, two scenes, few touches: a look.")
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Measure what each modelling choice buys, mm, and costs, µs, in each scene: model this, leave that out.

    Needs MuJoCo. Local torque, smooth normals, the friction gate, drift, the mount's rotation, crosstalk,
    a phantom that yields, an arm with dynamics.
    """
    from contactbench.pipeline.durable import make_folder
    from contactbench.pipeline.study.ablation.run import KIND, QUICK, Sizes, run
    from contactbench.pipeline.study.ablation.verdicts import about_choices
    from contactbench.pipeline.study.pages import make_page
    from contactbench.pipeline.study.results import environment, read_results, write_results

    sizes = QUICK if quick else Sizes()
    given: dict[str, Any] = {"probes": tuple(probe or ()), "scenes": tuple(scene or ()), "seeds": seeds}
    sizes = replace(sizes, **{name: value for name, value in given.items() if value})
    make_folder(out)
    rows = run(sizes, seed=seed, progress=say)
    words = ["contactbench", "study", "ablation", *(["--quick"] if quick else [])]
    words += [word for name in probe or () for word in ("--probe", name)]
    words += [word for name in scene or () for word in ("--scene", name)]
    words += ["--seeds", str(sizes.seeds), "--seed", str(seed)]
    write_results(out, KIND, shlex.join(words), rows, environment())
    make_page(out)
    found = about_choices(read_results(out).rows)
    for each in found:
        say(each.sentence)
    say(f"{out / 'page.md'}: tables and curves.")
    if as_json:
        print_json({"page": str(out / "page.md"), "rows": len(rows), "choices": [c.to_json() for c in found]})

"""``contactbench study rivals``: other people's code beside ours."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from contactbench.pipeline.console import JsonOption, print_json, say


def add_rivals_command(app: typer.Typer) -> None:
    """Add the command to ``contactbench study``."""
    app.command(epilog="Example: contactbench study rivals --quick --out rivals")(rivals)


def rivals(
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Folder for results.parquet, page.md, pictures.")
    ] = Path("contactbench-rivals"),
    family: Annotated[
        list[str] | None,
        typer.Option(help="location, plane, simplification or calibration; may be repeated [all]."),
    ] = None,
    probe: Annotated[list[str] | None, typer.Option(help="Bundled probe; may be repeated [all].")] = None,
    rounds: Annotated[int | None, typer.Option(help="Timed rounds of each, in turn [15].")] = None,
    seed: Annotated[int, typer.Option(help="Of touches, poses and noise.")] = 0,
    quick: Annotated[bool, typer.Option("--quick", help="One probe, one mesh, few rounds: a look.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Measure public code beside ours on the same inputs: location, a plane, simplification, calibration.

    What is not installed is said: pip install contactbench[rivals]. Exit code 1: a rival locates contacts both faster
    and more accurately.
    """
    from contactbench.pipeline.durable import make_folder
    from contactbench.pipeline.study.finishing import NOT_GOOD_ENOUGH
    from contactbench.pipeline.study.pages import make_page
    from contactbench.pipeline.study.results import environment, write_results
    from contactbench.pipeline.study.rivals.place import FAMILY
    from contactbench.pipeline.study.rivals.run import KIND, QUICK, Sizes, run
    from contactbench.pipeline.study.rivals.verdicts import duels

    given: dict[str, Any] = {"families": tuple(family or ()), "probes": tuple(probe or ()), "rounds": rounds}
    sizes = replace(
        QUICK if quick else Sizes(),
        **{name: value for name, value in given.items() if value not in ((), None)},
    )
    make_folder(out)
    rows = run(sizes, seed=seed, progress=say)
    words = ["contactbench", "study", "rivals", *(["--quick"] if quick else [])]
    words += [word for name in family or () for word in ("--family", name)]
    words += [word for name in probe or () for word in ("--probe", name)]
    words += ["--rounds", str(sizes.rounds), "--seed", str(seed)]
    write_results(out, KIND, shlex.join(words), rows, environment())
    make_page(out)
    for row in rows:
        if row["kind"] == "missing":
            say(f"{row['contender']}: {row['note']}")
    winners = [duel for duel in duels(rows) if duel.beats]
    for duel in winners:
        say(f"Faster and more accurate: {duel.words}.")
    say(f"{out / 'page.md'}: all tables.")
    if as_json:
        beaten = [duel.words for duel in winners]
        print_json({"page": str(out / "page.md"), "rows": len(rows), "faster_and_more_accurate": beaten})
    if any(duel.family == FAMILY for duel in winners):
        raise typer.Exit(NOT_GOOD_ENOUGH)

"""``contactbench study rivals``: other people's code beside ours."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from contactbench.pipeline.console import JsonOption, Noun, print_json, say


def add_rivals_command(app: Noun) -> None:
    """Add the command to ``contactbench study``."""
    app.command(example="study rivals --quick --out rivals")(rivals)


def rivals(
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="Folder for results.parquet, page.md, pictures.")
    ] = Path("contactbench-rivals"),
    probe: Annotated[list[str] | None, typer.Option(help="Bundled probe; may be repeated [all].")] = None,
    rounds: Annotated[int | None, typer.Option(help="Timed rounds of each, in turn [15].")] = None,
    seed: Annotated[int, typer.Option(help="Of touches and noise.")] = 0,
    quick: Annotated[bool, typer.Option("--quick", help="One probe, one mesh, few rounds: a look.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Locate the same touches with the literal Algorithm 1, ray tracers, Levenberg-Marquardt and ours, in one run.

    What is not installed is said: pip install contactbench[rivals]. Exit code 1: a rival locates contacts both faster
    and more accurately.
    """
    from contactbench.pipeline.study.finishing import NOT_GOOD_ENOUGH
    from contactbench.pipeline.study.pages import publish
    from contactbench.pipeline.study.rivals.run import KIND, QUICK, Sizes, run
    from contactbench.pipeline.study.rivals.verdicts import duels

    given: dict[str, Any] = {"probes": tuple(probe or ()), "rounds": rounds}
    sizes = replace(
        QUICK if quick else Sizes(),
        **{name: value for name, value in given.items() if value not in ((), None)},
    )
    rows = run(sizes, seed=seed, progress=say)
    words = ["rivals", *(["--quick"] if quick else [])]
    words += [word for name in probe or () for word in ("--probe", name)]
    words += ["--rounds", str(sizes.rounds), "--seed", str(seed)]
    page = publish(out, KIND, words, rows)
    for row in rows:
        if row["kind"] == "missing":
            say(f"{row['contender']}: {row['note']}")
    winners = [duel for duel in duels(rows) if duel.beats]
    for duel in winners:
        say(f"Faster and more accurate: {duel.words}.")
    say(f"{page}: all tables.")
    if as_json:
        beaten = [duel.words for duel in winners]
        print_json({"page": str(page), "rows": len(rows), "faster_and_more_accurate": beaten})
    if winners:
        raise typer.Exit(NOT_GOOD_ENOUGH)

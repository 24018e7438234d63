"""``contactbench study painting`` and ``scenes``: what painting takes, and what the scenes leave out."""

from __future__ import annotations

from typing import Annotated

import typer

from contactbench.pipeline.console import JsonOption, print_json, say

_NOT_GOOD_ENOUGH = 1


def add_commands(app: typer.Typer) -> None:
    """Add them to ``contactbench study``."""
    app.command(epilog="Example: contactbench study painting --facets 100000")(painting)
    app.command(epilog="Example: contactbench study scenes --probe convex --period 2")(scenes)


def painting(
    facets: Annotated[int, typer.Option(help="Of the mesh that is painted.")] = 100_000,
    as_json: JsonOption = False,
) -> None:
    """Measure how long an event of the brush keeps a window, whatever draws it. Exit code 1: over a frame."""
    from contactbench.pipeline.study import painting as study

    report = study.run(facets=facets, progress=say)
    for sentence in report.sentences:
        say(sentence)
    if as_json:
        print_json(report.to_json())
    if not all(row.met for row in report.rows):
        raise typer.Exit(_NOT_GOOD_ENOUGH)


def scenes(
    probe: Annotated[str, typer.Option(help="Bundled probe: linear, convex or t-shape.")] = "convex",
    period: Annotated[float, typer.Option(help="Of the platform's motion, s.")] = 2.0,
    as_json: JsonOption = False,
) -> None:
    """Measure what the platform and the arm scene leave out: servo, inertia, friction, time step, places."""
    from contactbench.pipeline.study import scene_limits as study

    report = study.run(probe, period, progress=say)
    say(study.markdown(report))
    if as_json:
        print_json(report.to_json())

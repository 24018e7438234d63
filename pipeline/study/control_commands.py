"""``contactbench study control-safety`` and ``control-speed``: whether motion control is safe, and quick enough."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contactbench.pipeline.console import Bar, JsonOption
from contactbench.pipeline.study.finishing import MarkdownOption, SeedOption, finish


def add_control_commands(app: typer.Typer) -> None:
    """Add the commands to ``contactbench study``."""
    app.command("control-safety", epilog="Example: contactbench study control-safety --runs 100")(
        control_safety
    )
    app.command("control-speed", epilog="Example: contactbench study control-speed --scene arm")(
        control_speed
    )


def control_safety(
    runs: Annotated[
        int, typer.Option(help="Random starts; a fifth with each kind of fault, a fifth with none.")
    ] = 1_000,
    workers: Annotated[int | None, typer.Option(help="Processes [one for each core].")] = None,
    seed: SeedOption = 0,
    kept: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Ends are added to it as they come; started again, it goes on."),
    ] = None,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Start motion control at random: tissue, friction, motion, sensor faults; the force's limit, and safe ends.

    Needs MuJoCo. Exit code 1 when a force passed its limit by more than 20 %, an end was not safe, or a loop swung.
    """
    from contactbench.pipeline.study import control_safety as study

    with Bar("starting", counted=True) as bar:
        report = study.run(runs, seed=seed, workers=workers, kept=kept, progress=bar)
    finish(report, out, as_json=as_json)


def control_speed(
    scene: Annotated[str, typer.Option(metavar="platform|arm", help="What carries the probe.")] = "arm",
    probe: Annotated[str, typer.Option(help="Bundled probe: linear, convex or t-shape.")] = "convex",
    seconds: Annotated[float, typer.Option(help="Of the scene, for each variant.")] = 30.0,
    seed: SeedOption = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Time the control step (sense, control, inverse kinematics) and the simulation of the closed loop.

    The phantom turns by 10 degrees in 2 s. Needs MuJoCo. Exit code 1 when the 99th percentile of a step is 1 ms or
    more, or the simulation is less than twice as fast as real time.
    """
    from contactbench.pipeline.study import control_speed as study

    with Bar("timing", counted=True) as bar:
        report = study.run(scene, probe, seconds=seconds, seed=seed, progress=bar)
    finish(report, out, as_json=as_json)

"""``contactbench study protocols``, ``sessions``, ``faults`` and ``live``: devices and what is kept of them."""

from __future__ import annotations

from typing import Annotated

import typer

from contactbench.pipeline.console import JsonOption, say
from contactbench.pipeline.study.finishing import MarkdownOption, finish


def add_device_commands(app: typer.Typer) -> None:
    """Add them to ``contactbench study``."""
    app.command(epilog="Example: contactbench study protocols --bytes 10000000")(protocols)
    app.command(epilog="Example: contactbench study sessions --kills 200")(sessions)
    app.command(epilog="Example: contactbench study faults --out faults.md")(faults)
    app.command(epilog="Example: contactbench study live --seconds 60 --sensors 3")(live)


def protocols(
    count: Annotated[int, typer.Option("--bytes", help="Random bytes for each parser.")] = 10_000_000,
    frames: Annotated[int, typer.Option(help="Frames of each damaged stream.")] = 50_000,
    seed: Annotated[int, typer.Option(help="Seed of bytes and damage.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Feed the parsers of all devices random bytes and damaged streams: false frames, frames recovered, speed.

    Exit code 1 when a figure misses its target.
    """
    from contactbench.pipeline.study import devices as study

    finish(study.run_protocols(count, frames, seed=seed, progress=say), out, as_json=as_json)


def sessions(
    kills: Annotated[int, typer.Option(help="Times that a writing process is killed.")] = 200,
    seed: Annotated[int, typer.Option(help="Seed of the moments.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Kill a process that writes a session, again and again: nothing acknowledged may be lost.

    Exit code 1 when something was.
    """
    from contactbench.pipeline.study import devices as study

    finish(study.run_sessions(kills, seed=seed, progress=say), out, as_json=as_json)


def faults(
    trials: Annotated[int, typer.Option(help="Re-zeros of each size for the detector's figures.")] = 300,
    short: Annotated[bool, typer.Option("--short", help="One fault of each kind on two devices.")] = False,
    seed: Annotated[int, typer.Option(help="Seed of signals and faults.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Give every emulated device every fault on a live line: when it is shown, recovered, and nothing made up.

    Exit code 1 when a fault is not shown in time, or a sample is not one that was sent.
    """
    from contactbench.pipeline.study import faults as study

    finish(study.run(short=short, trials=trials, seed=seed, progress=say), out, as_json=as_json)


def live(
    seconds: Annotated[float, typer.Option(help="How long, s; 600 is a soak.")] = 600.0,
    sensors: Annotated[int, typer.Option(help="How many at once.")] = 3,
    rate: Annotated[float, typer.Option(help="Samples a second of each, Hz.")] = 1000.0,
    busy: Annotated[
        bool, typer.Option("--busy", help="Once more beside a process that never rests.")
    ] = False,
    seed: Annotated[int, typer.Option(help="Seed of the readings.")] = 0,
    out: MarkdownOption = None,
    as_json: JsonOption = False,
) -> None:
    """Read several sensors at once from serial lines: samples lost, time from byte to sample, load of a core.

    Exit code 1 when a figure misses its target.
    """
    from contactbench.pipeline.study.live import report as study

    finish(study.run(seconds, sensors, rate=rate, busy=busy, seed=seed, progress=say), out, as_json=as_json)

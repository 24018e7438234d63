"""``contactbench emulate``: a device that is not there, to point the application at."""

from __future__ import annotations

import signal
import time
from typing import TYPE_CHECKING, Annotated

import typer

from pipeline.console import JsonOption, print_json, say

if TYPE_CHECKING:
    from types import FrameType

    from pipeline.devices.emulate import Emulator

emulate_app = typer.Typer(rich_markup_mode=None)


@emulate_app.command(
    help=(
        "Emulate a force/torque sensor or a robot: sri, bota, robotiq, rdt, elfin, ur.\n\n"
        "Prints the address to connect to, and runs until Ctrl-C. Faults are NAME@START+DURATION in seconds after"
        " the first frame, some with xSIZE: split, merged, garbage, bad-checksum, header, stall, disconnect,"
        " reconnect, wrong-rate, clock-jump, saturation, stuck, drift, rezero."
    ),
    epilog="Example: contactbench emulate sri --pty --fault stall@2+0.5 --fault wrong-rate@5+2x0.5",
)
def emulate(
    device: Annotated[str, typer.Argument(metavar="DEVICE", help="What to emulate.")],
    pty: Annotated[bool, typer.Option("--pty", help="On a pseudo-terminal.")] = False,
    port: Annotated[
        int | None, typer.Option(help="On this port of the loopback interface; 0 is any free one.")
    ] = None,
    rate: Annotated[float | None, typer.Option(help="Frames per second until a command changes it.")] = None,
    fault: Annotated[list[str] | None, typer.Option(metavar="FAULT", help="May be repeated.")] = None,
    seconds: Annotated[float | None, typer.Option(help="How long to run.")] = None,
    profile: Annotated[str, typer.Option(help="Of rdt: ati or onrobot.")] = "ati",
    still: Annotated[bool, typer.Option("--still", help="A constant signal, not one that swings.")] = False,
    seed: Annotated[int, typer.Option(help="Of chance in the faults.")] = 0,
    as_json: JsonOption = False,
) -> None:
    """Emulate a device."""
    if pty and port is not None:
        raise typer.BadParameter("--pty and --port contradict each other: give one.")
    if seconds is not None and not 0 < seconds < 1e9:
        raise typer.BadParameter(f"--seconds {seconds}: give a positive number.")
    from pipeline.devices.emulate import FaultEvent, Script, emulator, swinging

    script = Script([FaultEvent.parse(text) for text in fault or ()])
    carrier = "serial" if pty else ("tcp" if port is not None and device != "rdt" else None)
    made = emulator(
        device,
        carrier,
        port=port or 0,
        rate=rate,
        script=script,
        seed=seed,
        profile=profile,
        signal=None if still else swinging(device),
    )
    before = signal.signal(signal.SIGTERM, _interrupt)  # before the address is out: it may come at once
    try:
        with made:
            _run(made, seconds, as_json=as_json)
    finally:
        signal.signal(signal.SIGTERM, before)
    taken = made.counts
    say(
        f"{taken['intact']} frames sent whole, {taken['not intact']} not; {len(made.refused)} commands refused."
    )


def _run(device: Emulator, seconds: float | None, *, as_json: bool) -> None:
    """Say the address, and sleep until the time is up or somebody ends it; both are the expected end."""
    end = None if seconds is None else time.monotonic() + seconds
    try:
        if as_json:
            print_json({"url": device.url})
        else:
            typer.echo(device.url)
        while device.failure is None and (end is None or time.monotonic() < end):
            time.sleep(0.1 if end is None else max(0.0, min(0.1, end - time.monotonic())))
    except KeyboardInterrupt:
        pass


def _interrupt(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
    raise KeyboardInterrupt


if __name__ == "__main__":
    emulate_app()

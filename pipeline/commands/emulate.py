"""``contactbench emulate``: a device that is not there, to point the application at."""

from __future__ import annotations

import signal
import time
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from contactbench.pipeline.console import JsonOption, print_json, say

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import FrameType

    from contactbench.pipeline.devices.emulate import Emulator
    from contactbench.pipeline.devices.faults import Six

emulate_app = typer.Typer(rich_markup_mode=None)
_LOOK_S = 0.1  # how long an end may go unnoticed
# A closed terminal ends it too: a pseudo-terminal's folder would stay behind. Not all systems have SIGHUP.
_ENDS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))


@emulate_app.command(
    help=(
        "Emulate a force/torque sensor or a robot: sri, bota, robotiq, rdt, elfin, ur.\n\n"
        "Prints the address to connect to, and runs until Ctrl-C. Faults are NAME@START+DURATION in seconds after"
        " the first frame, some with xSIZE: split, merged, garbage, bad-checksum, header, stall, disconnect,"
        " reconnect, wrong-rate, clock-jump, saturation, stuck, drift, rezero.\n\n"
        "Quirks are what some devices of a kind do: older (sri, elfin, ur), crc32-only, crc32-silently, answers-start"
        " (sri), forgiving (sri, robotiq: no pause is needed between commands)."
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
    quirk: Annotated[list[str] | None, typer.Option(metavar="QUIRK", help="May be repeated.")] = None,
    tool: Annotated[
        str | None,
        typer.Option(metavar="X,Y,Z,RX,RY,RZ", help="Of ur: the tool in the flange frame, m and rad."),
    ] = None,
    seed: Annotated[int, typer.Option(help="Of chance in the faults.")] = 0,
    as_json: JsonOption = False,
) -> None:
    """Emulate a device."""
    if pty and port is not None:
        raise typer.BadParameter("--pty and --port contradict each other: give one.")
    if seconds is not None and not 0 < seconds < 1e9:
        raise typer.BadParameter(f"--seconds {seconds}: give a positive number.")
    from contactbench.pipeline.devices.emulate import FaultEvent, Script, emulator, swinging

    script = Script([FaultEvent.parse(text) for text in fault or ()])
    carrier = "serial" if pty else ("tcp" if port is not None and device != "rdt" else None)
    with _ended() as ended:  # before there is anything to clear away, until it is
        made = emulator(
            device,
            carrier,
            port=port or 0,
            rate=rate,
            script=script,
            seed=seed,
            profile=profile,
            signal=None if still else swinging(device),
            quirks=quirk or (),
            tool=_six(tool),
            log=0,
        )
        with made:
            _run(made, ended, seconds, as_json=as_json)
    taken, refused = made.counts, made.model.refused_count
    late = f", {taken['skipped']} skipped" if taken["skipped"] else ""
    say(f"{taken['intact']} frames sent whole, {taken['not intact']} not{late}; {refused} commands refused.")


@dataclass
class _Ended:
    """Whether somebody has ended it: a flag, since an exception could come in the middle of the clearing away."""

    by_signal: bool = False

    def __call__(self, number: int, frame: FrameType | None) -> None:  # noqa: ARG002
        """Take a signal."""
        self.by_signal = True


@contextmanager
def _ended() -> Iterator[_Ended]:
    """Take the signals that end a process, but for those that whoever started it has had ignored, as nohup does."""
    ended = _Ended()
    heard = [number for number in _ENDS if signal.getsignal(number) is not signal.SIG_IGN]
    before = {number: signal.signal(number, ended) for number in heard}
    try:
        yield ended
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _run(device: Emulator, ended: _Ended, seconds: float | None, *, as_json: bool) -> None:
    """Say the address, and sleep until the time is up or somebody ends it; both are the expected end."""
    end = None if seconds is None else time.monotonic() + seconds
    if as_json:
        print_json({"url": device.url})
    else:
        typer.echo(device.url)
    while not ended.by_signal and device.failure is None and (end is None or time.monotonic() < end):
        time.sleep(_LOOK_S if end is None else max(0.0, min(_LOOK_S, end - time.monotonic())))


def _six(text: str | None) -> Six | None:
    if text is None:
        return None
    try:
        x, y, z, rx, ry, rz = map(float, text.split(","))
    except ValueError as error:
        raise typer.BadParameter(f"--tool {text}: give six numbers with commas between them.") from error
    return x, y, z, rx, ry, rz


if __name__ == "__main__":
    emulate_app()

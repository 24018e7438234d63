"""``contactbench bench run, serve``: the virtual bench, by a script or behind real lines."""

from __future__ import annotations

import signal
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from contactbench.pipeline.console import JsonOption, print_json, say
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from types import FrameType

    from contactbench.pipeline.devices.url import DeviceAddress
    from contactbench.pipeline.simulation.virtual.bench import VirtualBench
    from contactbench.pipeline.simulation.virtual.serve import ServedBench

bench_app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="The virtual bench: a probe on a wrist, read by a sensor, without hardware.",
)

_LOOK_S = 0.1

ProbeOption = Annotated[str, typer.Option(metavar="t-shape|linear|convex", help="A bundled probe.")]
MeshOption = Annotated[Path | None, typer.Option(help="Or a probe of your own, a mesh file in S.")]
SensorOption = Annotated[str, typer.Option(metavar="paper|ideal|noisy", help="The sensor's faults.")]
SeedOption = Annotated[int, typer.Option(help="Of the sensor's noise.")]
RateOption = Annotated[float, typer.Option(help="Wrenches per second, up to 1000.")]


@bench_app.command(
    help=(
        "Run a script from beginning to end, as fast as it goes, and record wrenches and poses.\n\n"
        'SCRIPT has a command a line: {"at": 2, "do": "touch", "marker": 3, "force": 9, "seconds": 1}. at is in'
        " seconds of the bench; after instead: seconds after the command above was over. do is turn_to (rpy or"
        " R_WS, seconds), touch (marker from 1 or point_S, force, tilt, azimuth, torsion, seconds), release, bump"
        " (force, seconds, lever), warm (kelvin), rezero, end. The same seed gives the same bytes."
    ),
    epilog="Example: contactbench bench run bench.jsonl --out bench.mcap --truth truth.csv",
)
def run(
    script: Annotated[Path, typer.Argument(metavar="SCRIPT", help="Timed commands.")],
    out: Annotated[Path, typer.Option(help="Recording to write, .mcap; one that is there is not touched.")],
    truth: Annotated[
        Path | None, typer.Option(help="CSV to write: the truth beside every wrench; not over a file either.")
    ] = None,
    probe: ProbeOption = "t-shape",
    mesh: MeshOption = None,
    sensor: SensorOption = "paper",
    seed: SeedOption = 0,
    rate: RateOption = 200.0,
    as_json: JsonOption = False,
) -> None:
    """Run a script on the virtual bench."""
    from contactbench.pipeline.simulation.virtual.run import run_script
    from contactbench.pipeline.simulation.virtual.slips import SLIPPED_S

    where = _address(probe, mesh, sensor, seed, rate, script)
    ran = run_script(_bench(where), out, truth, str(_without_paths(where)))
    say(
        f"{ran.seconds:.2f} s of the bench: {ran.wrenches:,} wrenches, {ran.flanges:,} poses,"
        f" {ran.commands} commands. Wrote {out}" + (f" and {truth}." if truth else ".")
    )
    for slip in ran.slips:
        say(
            f"The touch at {slip.touch.time:.2f} s pressed nothing from {slip.time - SLIPPED_S:.2f} s on: the tip slid"
            " off. Touch elsewhere, or with less tilt.",
            "yellow",
        )
    if as_json:
        print_json(
            {
                "out": str(out),
                "truth": None if truth is None else str(truth),
                "seconds": ran.seconds,
                "wrenches": ran.wrenches,
                "flanges": ran.flanges,
                "commands": ran.commands,
                "slipped": [slip.touch.time for slip in ran.slips],
            }
        )


@bench_app.command(
    help=(
        "Serve the virtual bench in real time as an SRI sensor and an Elfin robot, until Ctrl-C.\n\n"
        "The first line of standard output is a JSON object with the two addresses. Commands come on standard"
        ' input, one JSON object a line as in a script but without a time: {"do": "turn_to", "rpy": [0, 90, 0]};'
        " each is answered by one line with the bench's time at which it took effect, or with the error."
    ),
    epilog="Example: contactbench bench serve --probe t-shape --sensor paper --pty",
)
def serve(
    probe: ProbeOption = "t-shape",
    mesh: MeshOption = None,
    sensor: SensorOption = "paper",
    seed: SeedOption = 0,
    rate: RateOption = 200.0,
    script: Annotated[Path | None, typer.Option(help="Timed commands to begin with.")] = None,
    pty: Annotated[bool, typer.Option("--pty", help="The sensor on a pseudo-terminal.")] = False,
    sri_port: Annotated[
        int | None, typer.Option(help="Of the sensor, on the loopback interface [a free one].")
    ] = None,
    elfin_port: Annotated[int, typer.Option(help="Of the robot; 0 is any free one.")] = 0,
) -> None:
    """Serve the virtual bench on real lines."""
    if pty and sri_port is not None:
        raise typer.BadParameter("--pty and --sri-port contradict each other: give one.")
    from contactbench.pipeline.simulation.virtual.serve import ServedBench

    bench = _bench(_address(probe, mesh, sensor, seed, rate, script))
    before = signal.signal(signal.SIGTERM, _interrupt)
    try:
        with ServedBench(bench, pty=pty, sensor_port=sri_port or 0, robot_port=elfin_port) as served:
            _run(served)
    finally:
        signal.signal(signal.SIGTERM, before)
    for sentence in served.findings():
        say(sentence, "yellow")
    if served.error is not None:
        raise served.error


def _address(
    probe: str, mesh: Path | None, sensor: str, seed: int, rate: float, script: Path | None
) -> DeviceAddress:
    """Return the address of the bench: its door checks what was given."""
    from urllib.parse import urlencode

    from contactbench.pipeline.devices.url import DeviceAddress

    options = {
        **({"probe": probe} if mesh is None else {"mesh": str(mesh)}),
        "sensor": sensor,
        "seed": seed,
        "rate": rate,
        "speed": "step",
        **({} if script is None else {"script": str(script)}),
    }
    return DeviceAddress.parse(f"virtual://bench?{urlencode(options)}")


def _without_paths(where: DeviceAddress) -> DeviceAddress:
    """Return the address for a recording: what is in its files, not what they are called, so that bytes stay the same.

    The script is left out: the recording tells what was done.
    """
    import hashlib
    from dataclasses import replace

    options = where.bench
    if options is None:
        return where
    mesh = None
    if options.mesh is not None:
        with Path(options.mesh).open("rb") as file:
            mesh = f"sha256-{hashlib.file_digest(file, 'sha256').hexdigest()}"
    return replace(where, bench=replace(options, mesh=mesh, script=None))


def _bench(where: DeviceAddress) -> VirtualBench:
    from contactbench.pipeline.simulation.virtual.world import bench_at

    return bench_at(where)


def _run(served: ServedBench) -> None:
    """Say the addresses, and obey until the script, the devices or somebody ends it."""
    try:
        print_json({"sensor": served.sensor.url, "robot": served.robot.url})
        # A daemon: a line that never comes does not keep the command from ending.
        threading.Thread(target=_obey, args=(served,), name="commands", daemon=True).start()
        while not served.over.wait(_LOOK_S):
            if served.sensor.failure is not None or served.robot.failure is not None:
                return
    except KeyboardInterrupt:
        pass


def _obey(served: ServedBench) -> None:
    from contactbench.pipeline.simulation.virtual.commands import read_command
    from contactbench.pipeline.simulation.virtual.script import read_object

    for number, line in enumerate(sys.stdin, 1):
        if not line.strip():
            continue
        try:
            command = read_command(read_object(line, f"line {number}"))
            done = served.bench.send(command).result()
        except InputError as error:
            print_json({"line": number, "error": str(error)})
        else:
            print_json({"line": number, "do": command.name, "at": done.time, "until": done.until})
        sys.stdout.flush()


def _interrupt(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
    raise KeyboardInterrupt


if __name__ == "__main__":
    bench_app()

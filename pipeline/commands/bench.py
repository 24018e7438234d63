"""``contactbench bench ...``: the virtual bench, emulated devices, and motion control in simulation."""

from __future__ import annotations

import sys
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from contactbench.pipeline.commands.control import control_app
from contactbench.pipeline.console import (
    Ended,
    Noun,
    answer,
    as_json,
    ended_by_signals,
    output_is_data,
    print_json,
    say,
    say_all,
)
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from contactbench.pipeline.devices.emulate import Emulator
    from contactbench.pipeline.devices.url import DeviceAddress
    from contactbench.pipeline.reality import Reality
    from contactbench.pipeline.simulation.virtual.bench import VirtualBench
    from contactbench.pipeline.simulation.virtual.run import ServedBench


bench_app = Noun("Try without hardware: a virtual bench, emulated devices, and motion control by touch.")
bench_app.add_typer(control_app, name="control")

_LOOK_S = 0.1  # how long an end may go unnoticed


@dataclass(frozen=True)
class ChosenBench:
    """
    A virtual bench.

    Parameters
    ----------
    probe : t-shape|linear|convex
        Bundled probe.
    mesh
        Your own probe instead: a mesh file in S.
    model : paper|ideal|noisy
        What the sensor is, with its faults.
    seed
        Seed of the sensor's noise.
    rate
        Wrenches per second, up to 1000.
    reality : MIX|EFFECT=SIZE,...
        Deviation from the ideal bench: ideal, typical, harsh or tissue, effects with their sizes, or both, such as
        typical,cable=0.2. `contactbench bench reality` lists them.
    """

    probe: str = "t-shape"
    mesh: Path | None = None
    model: str = "paper"
    seed: int = 0
    rate: float = 200.0
    reality: str = "ideal"

    def address(self, script: Path | None) -> DeviceAddress:
        """Return its address, which checks what was given."""
        from urllib.parse import quote, urlencode

        from contactbench.pipeline.devices.url import DeviceAddress

        options = {
            **({"probe": self.probe} if self.mesh is None else {"mesh": str(self.mesh)}),
            "sensor": self.model,
            "seed": self.seed,
            "rate": self.rate,
            "speed": "step",
            **({} if script is None else {"script": str(script)}),
            **({} if self.reality == "ideal" else {"reality": self.reality}),
        }
        return DeviceAddress.parse(f"virtual://bench?{urlencode(options, quote_via=quote)}")


@bench_app.command(example="bench run bench.jsonl --out bench.mcap --truth truth.csv")
def run(script: Path, /, out: Path, chosen: ChosenBench, truth: Path | None = None) -> None:
    """Run a script from beginning to end, as fast as it goes, and record wrenches and poses.

    SCRIPT has one command per line: {"at": 2, "do": "touch", "marker": 3, "force": 9, "seconds": 1}. at is in
    seconds of the bench; use after for seconds after the previous command ended. do is turn_to (rpy or
    R_WS, seconds), touch (marker from 1 or point_S, force, tilt, azimuth, torsion, seconds), release,
    bump (force, seconds, lever), warm (kelvin), rezero, end. The same seed gives the same bytes.

    Parameters
    ----------
    script
        Timed commands.
    out
        Recording to write, .mcap; never overwrites a file.
    truth
        CSV to write: the truth beside every wrench; never overwrites a file.
    """
    from contactbench.pipeline.simulation.virtual.bench import SLIPPED_S
    from contactbench.pipeline.simulation.virtual.run import run_script

    where = chosen.address(script)
    ran = run_script(_bench(where), out, truth, str(_without_paths(where)))
    say(
        f"{ran.seconds:.2f} s of the bench: {ran.wrenches:,} wrenches, {ran.flanges:,} poses,"
        f" {ran.commands} commands. Wrote {out}" + (f" and {truth}." if truth else ".")
    )
    for slip in ran.slips:
        say(
            f"The touch at {slip.touch.time:.2f} s pressed nothing from"
            f" {slip.time - SLIPPED_S:.2f} s on because the tip slid off. Touch elsewhere, or with"
            " less tilt.",
            "yellow",
        )
    answer(
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


@bench_app.command(example="bench serve --probe t-shape --model paper --pty")
def serve(
    chosen: ChosenBench,
    script: Path | None = None,
    pty: bool = False,
    sri_port: int | None = None,
    elfin_port: int = 0,
) -> None:
    """Serve the virtual bench in real time as an SRI sensor and an Elfin robot, until Ctrl-C.

    The first line of standard output is a JSON object with the two addresses. Commands come on standard
    input, one JSON object per line as in a script but without a time: {"do": "turn_to", "rpy": [0, 90, 0]};
    each is answered with one line: the bench time at which it took effect, or the error.

    Parameters
    ----------
    script
        Timed commands to start with.
    pty
        Put the sensor on a pseudo-terminal.
    sri_port
        Port of the sensor on the loopback interface [a free one].
    elfin_port
        Port of the robot; 0 for any free one.
    """
    if pty and sri_port is not None:
        raise typer.BadParameter("--pty and --sri-port contradict each other: give only one.")
    from contactbench.pipeline.simulation.virtual.run import ServedBench

    bench = _bench(chosen.address(script))
    with (
        ended_by_signals() as ended,
        ServedBench(bench, pty=pty, sensor_port=sri_port or 0, robot_port=elfin_port) as served,
    ):
        _serve(served, ended)
    say_all(served.findings(), "yellow")
    if served.error is not None:
        raise served.error


@bench_app.command("reality", example="bench reality typical,cable=0.2")
def show_reality(mix: str | None = None, /) -> None:
    """List the effects of a real bench: unit, range, and size in each mix.

    Use the same text in an address, virtual://bench?reality=typical, and with --reality.

    Parameters
    ----------
    mix : [MIX|EFFECT=SIZE,...]
        Mix to show beside the others.
    """
    from contactbench.pipeline.reality import MIXES, Reality

    mixes = MIXES if mix is None else {**MIXES, mix: Reality.parse(mix)}
    answer({name: each.model_dump() for name, each in mixes.items()})
    if not as_json():
        _show_mixes(mixes)


def _show_mixes(mixes: Mapping[str, Reality]) -> None:
    from rich.console import Console
    from rich.table import Table

    from contactbench.pipeline.reality import Reality

    table = Table(box=None, pad_edge=False)
    table.add_column("effect", no_wrap=True)
    for name in ("range", *mixes):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("unit: meaning", min_width=40)
    for name, field in Reality.model_fields.items():
        least, most = Reality.limits(name)
        sizes = (f"{getattr(each, name):g}" for each in mixes.values())
        table.add_row(name, f"{least:g} to {most:g}", *sizes, field.description)
    Console().print(table)


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


def _serve(served: ServedBench, ended: Ended) -> None:
    """Say the addresses, and obey until the script, the devices or somebody ends it."""
    output_is_data()
    print_json({"sensor": served.sensor.url, "robot": served.robot.url})
    # A daemon: a line that never comes does not keep the command from ending.
    threading.Thread(target=_obey, args=(served,), name="commands", daemon=True).start()
    while not (ended.asked or served.over.wait(_LOOK_S)):
        if served.sensor.failure is not None or served.robot.failure is not None:
            return


def _obey(served: ServedBench) -> None:
    from contactbench.pipeline.simulation.virtual.commands import read_command, read_object

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


@bench_app.command(example="bench emulate sri --pty --fault stall@2+0.5 --fault wrong-rate@5+2x0.5")
def emulate(
    device: str,
    /,
    pty: bool = False,
    port: int | None = None,
    rate: float | None = None,
    fault: list[str] | None = None,
    seconds: float | None = None,
    still: bool = False,
    quirk: list[str] | None = None,
    option: list[str] | None = None,
    seed: int = 0,
) -> None:
    """Emulate a force/torque sensor or a robot: sri, bota, robotiq, rdt, elfin, ur, or that of a plug-in.

    Prints the address to connect to, and runs until Ctrl-C. Faults are NAME@START+DURATION in seconds
    after the first frame, some with xSIZE: split, merged, garbage, bad-checksum, header, stall,
    disconnect, reconnect, wrong-rate, clock-jump, saturation, stuck, drift, rezero.

    Quirks are the habits of some devices of a kind: older (sri, elfin, ur), crc32-only, crc32-silently,
    answers-start (sri), forgiving (sri, robotiq: no pause is needed between commands).

    Parameters
    ----------
    device
        Device to emulate, such as sri or sri+tcp.
    pty
        Use a pseudo-terminal.
    port
        Use this port of the loopback interface; 0 for any free one.
    rate
        Frames per second, until a command changes it.
    fault : FAULT
        Fault to inject; may be repeated.
    seconds
        How long to run.
    still
        Send a constant signal instead of one that swings.
    quirk : QUIRK
        Quirk to imitate; may be repeated.
    option : NAME=VALUE
        Option as in an address: profile=onrobot. May be repeated.
    seed
        Seed of the randomness in the faults.
    """
    if pty and port is not None:
        raise typer.BadParameter("--pty and --port contradict each other: give only one.")
    if seconds is not None and not 0 < seconds < 1e9:
        raise typer.BadParameter(f"--seconds {seconds}: give a positive number.")
    from contactbench.pipeline.devices.emulate import emulator, socket_of, swinging
    from contactbench.pipeline.devices.faults import FaultEvent, Script

    script = Script([FaultEvent.parse(text) for text in fault or ()])
    device, _, carrier = device.partition("+")
    if pty:
        carrier = "serial"
    elif port is not None and not carrier:
        carrier = socket_of(device)
    with ended_by_signals() as ended:  # before there is anything to clear away, until it is
        made = emulator(
            device,
            carrier or None,
            port=port or 0,
            rate=rate,
            script=script,
            seed=seed,
            quirks=quirk or (),
            options=_options(option or []),
            log=0,
        )
        if not still:
            made.measure(swinging(made.model))
        with made:
            _emulate(made, ended, seconds)
    taken, refused = made.counts, made.model.refused_count
    late = f", {taken['skipped']} skipped" if taken["skipped"] else ""
    say(f"{taken['intact']} frames sent whole, {taken['not intact']} not{late}; {refused} commands refused.")


def _emulate(device: Emulator, ended: Ended, seconds: float | None) -> None:
    """Say the address, and sleep until the time is up or somebody ends it; both are the expected end."""
    end = None if seconds is None else time.monotonic() + seconds
    output_is_data()
    if as_json():
        print_json({"url": device.url})
    else:
        typer.echo(device.url)
    while not ended.asked and device.failure is None and (end is None or time.monotonic() < end):
        time.sleep(_LOOK_S if end is None else max(0.0, min(_LOOK_S, end - time.monotonic())))


def _options(given: list[str]) -> dict[str, str]:
    pairs = [text.partition("=") for text in given]
    for name, equals, _ in pairs:
        if not (name and equals):
            raise typer.BadParameter(f"--option {name}: write it as NAME=VALUE.")
    return {name: value for name, _, value in pairs}

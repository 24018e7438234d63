"""``contactbench record, ports``: what a sensor gives, into a file; and where sensors may hang."""

from __future__ import annotations

import signal
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pipeline.console import JsonOption, print_json, say
from pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from pipeline.devices.drive import Health
    from pipeline.devices.sample import FlangeSample, WrenchSample
    from pipeline.recording import RecordingWriter

record_app = typer.Typer(rich_markup_mode=None)

_FLUSH_S = 0.5


@record_app.command(
    help=(
        "Record a force/torque sensor until Ctrl-C, or for some seconds.\n\n"
        "ADDRESS is sri+serial, sri+tcp, bota+serial, robotiq+serial or rdt+udp, then :// and where it is. Nothing"
        " but what it takes to stream is sent: no sensor is zeroed. A lost line is opened again; a gap stays a gap."
        " Exit code 1: not one sample came."
    ),
    epilog="Example: contactbench record sri+serial:///dev/ttyUSB0 --out poses.mcap --seconds 60",
)
def record(
    address: Annotated[str, typer.Argument(metavar="ADDRESS", help="Of the sensor.")],
    out: Annotated[Path, typer.Option(help="Recording to write, .mcap; one that is there is not touched.")],
    pose: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Also the flange of a robot: elfin+tcp:// or ur+tcp://."),
    ] = None,
    seconds: Annotated[float | None, typer.Option(help="How long [until Ctrl-C].")] = None,
    note: Annotated[str, typer.Option(help="A few words to keep with it.")] = "",
    as_json: JsonOption = False,
) -> None:
    """Record a force/torque sensor."""
    from contextlib import ExitStack

    from pipeline.devices.drive import SensorStream, poses_from
    from pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter

    if seconds is not None and not 0 < seconds < 1e6:
        raise typer.BadParameter(f"--seconds {seconds:g}: give a number above 0.")
    taken: _Taken
    sensor = SensorStream(
        address, lambda samples: taken.samples(samples), lambda health: taken.health("sensor", health)
    )
    devices = [DeviceInfo("wrench", "/wrench", str(sensor.address), rate=sensor.address.rate)]
    robot = None
    if pose is not None:
        robot = poses_from(
            pose, lambda samples: taken.poses(samples), lambda health: taken.health("robot", health)
        )
        devices.append(DeviceInfo("flange", "/flange", str(robot.address), rate=robot.address.rate))
    with RecordingWriter(out, RecordingInfo.now(tuple(devices), note)) as writer:
        taken = _Taken(writer)
        with ExitStack() as streams:
            streams.enter_context(sensor)
            if robot is not None:
                streams.enter_context(robot)
            _wait(seconds, taken.failed)
    if taken.error is not None:
        raise taken.error
    given = {"sensor": sensor.health} | ({} if robot is None else {"robot": robot.health})
    _tell(out, given, as_json)
    if not all(health.samples for health in given.values()):
        raise typer.Exit(1)


@record_app.command(
    help="List the serial ports of this machine, with a guess at what hangs on each.",
    epilog="Example: contactbench ports",
)
def ports(as_json: JsonOption = False) -> None:
    """List the serial ports of this machine."""
    from pipeline.devices.transport import list_ports

    found = list_ports()
    for port in found:
        say(f"{port.path}: {port.description}" + (f"; try {port.url}" if port.url else ""))
    if not found:
        say("There is no serial port: plug the sensor in, or give a network address.")
    if as_json:
        rows = [{"path": p.path, "description": p.description, "url": p.url} for p in found]
        print_json({"ports": rows})


class _Taken:
    """Writes what a stream gives, in the stream's thread."""

    def __init__(self, writer: RecordingWriter) -> None:
        self._writer = writer
        self._flushed = time.monotonic()
        self.failed = threading.Event()
        self.error: InputError | None = None

    def samples(self, samples: Sequence[WrenchSample]) -> None:
        self._do(lambda: self._write(samples))
        if time.monotonic() - self._flushed > _FLUSH_S:
            self._do(self._writer.flush)
            self._flushed = time.monotonic()

    def _write(self, samples: Sequence[WrenchSample]) -> None:
        for sample in samples:
            self._writer.wrench(sample)

    def poses(self, samples: Sequence[FlangeSample]) -> None:
        self._do(lambda: self._write_poses(samples))

    def _write_poses(self, samples: Sequence[FlangeSample]) -> None:
        for sample in samples:
            self._writer.flange(sample)

    def health(self, device: str, health: Health) -> None:
        """Keep changes of a stream with the samples, and say them."""
        found = " ".join(health.findings)
        words = f"{device}: {health.state}"
        say(f"{words}: {found}" if found else words, "yellow" if found else "")
        fields = {"device": device, "state": health.state.value, "findings": list(health.findings)}
        self._do(lambda: self._writer.event("stream", fields, time.monotonic()))

    def _do(self, write: Callable[[], None]) -> None:
        if self.error is not None:
            return
        try:
            write()
        except InputError as error:  # such as a full disk: what is written stays, and the command ends
            self.error = error
            self.failed.set()


def _wait(seconds: float | None, failed: threading.Event) -> None:
    """Wait until the time is over, Ctrl-C, or something failed; Ctrl-C ends a recording well."""
    before = signal.signal(signal.SIGINT, lambda *_: failed.set())
    try:
        failed.wait(seconds)
    finally:
        signal.signal(signal.SIGINT, before)


def _tell(out: Path, given: Mapping[str, Health], as_json: bool) -> None:
    for device, health in given.items():
        counters = health.counters
        rate = "an unknown rate" if health.rate is None else f"{health.rate:.1f} Hz"
        jitter = "" if health.jitter is None else f", jitter {1e3 * health.jitter:.2f} ms"
        say(
            f"{device}: {health.samples:,} samples at {rate}{jitter}; lost {counters.lost}, damaged"
            f" {counters.bad_checksums}, reconnected {health.reconnected} times."
        )
    say(f"Wrote {out}.")
    if as_json:
        print_json({"out": str(out), **{device: _facts(health) for device, health in given.items()}})


def _facts(health: Health) -> dict[str, Any]:
    return {
        "samples": health.samples,
        "rate_hz": health.rate,
        "jitter_s": health.jitter,
        "lost": health.counters.lost,
        "bad_checksums": health.counters.bad_checksums,
        "skipped_bytes": health.counters.skipped_bytes,
        "reconnected": health.reconnected,
    }

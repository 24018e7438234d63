"""``contactbench record, ports``: what a sensor gives, into a file; and where sensors may hang."""

from __future__ import annotations

import math
import re
import signal
import threading
import time
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.console import JsonOption, print_json, say

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from contactbench.pipeline.devices.stream import Health
    from contactbench.pipeline.recording.recorder import Recorder
    from contactbench.pipeline.streams import Pair

record_app = typer.Typer(rich_markup_mode=None)

_LOOK_S = 0.05  # how soon the end of a replay is noticed
_STEPS = 500  # samples between looks at Ctrl-C
_FOLD_S = 5.0  # between two lines about a device that comes and goes
_MOST_KINDS = 50
_NUMBER = re.compile(r"\d+(\.\d+)?")


@record_app.command(
    help=(
        "Record a force/torque sensor until Ctrl-C, or for some seconds.\n\n"
        "ADDRESS is sri+serial, sri+tcp, bota+serial, robotiq+serial or rdt+udp, then :// and where it is; or"
        " replay:///recording.mcap?speed=4 (or speed=step: as fast as it can be read), which ends by itself and"
        " keeps its times. Nothing but what it takes to stream is sent: no sensor is zeroed. A lost line is opened"
        " again; a gap stays a gap. Exit code 1: one of them gave not one sample, a stream failed, or a replay"
        " could not be read to its end; without a sample no file is kept."
    ),
    epilog="Example: contactbench record sri+serial:///dev/ttyUSB0 --out poses.mcap --seconds 60",
)
def record(
    address: Annotated[str, typer.Argument(metavar="ADDRESS", help="Of the sensor.")],
    out: Annotated[Path, typer.Option(help="Recording to write, .mcap; one that is there is not touched.")],
    pose: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="Also the flange of a robot: elfin+tcp://, ur+tcp://, the same replay:// address,"
            " poses:///file.csv, or one that stays: still://?rpy=0,90,0 (degrees).",
        ),
    ] = None,
    seconds: Annotated[float | None, typer.Option(help="How long [until Ctrl-C].")] = None,
    note: Annotated[str, typer.Option(help="A few words to keep with it.")] = "",
    as_json: JsonOption = False,
) -> None:
    """Record a force/torque sensor."""
    from contactbench.pipeline.recording import RecordingWriter
    from contactbench.pipeline.recording.recorder import Recorder
    from contactbench.pipeline.streams import open_pair

    if seconds is not None and not 0 < seconds < 1e6:
        raise typer.BadParameter(f"--seconds {seconds:g}: give a number above 0.")
    changes = Changes()
    recorder: Recorder
    pair = open_pair(
        address,
        pose,
        lambda samples: recorder.samples(samples),
        lambda samples: recorder.poses(samples),
        lambda health: recorder.health("sensor", health),
        lambda health: recorder.health("robot", health),
    )
    # Until all is written: a second Ctrl-C must not cut the end off.
    with ended_by_signals() as ended:
        try:
            with RecordingWriter(out, pair.about(note)) as writer:
                recorder = Recorder(writer, changes.tell, clock=pair.now)
                with recorder, pair:
                    wait(pair, seconds, ended, recorder.failed, changes=changes)
        finally:
            pair.stop()  # a replay has its file open before it begins
            changes.end()
    given = dict(zip(("sensor", "robot"), (stream.health for stream in pair.streams), strict=False))
    _end(out, given, recorder, as_json)
    if broken(pair) or not all(health.samples for health in given.values()):
        raise typer.Exit(1)


def _end(out: Path, given: Mapping[str, Health], recorder: Recorder, as_json: bool) -> None:
    """Say what was written; nothing is kept where nothing came: an empty file would stand in the next one's way."""
    kept = any(health.samples for health in given.values())
    if not kept:
        out.unlink(missing_ok=True)
    if recorder.error is not None:
        raise recorder.error
    _tell(out, given, recorder, kept)
    if as_json:
        facts = {device: _facts(health) for device, health in given.items()}
        suspicions = [what for _, what in recorder.suspicions]
        print_json(
            {
                "out": str(out) if kept else None,
                **facts,
                "suspicions": suspicions,
                "skipped": recorder.skipped,
            }
        )


@record_app.command(
    help="List the serial ports of this machine, with a guess at what hangs on each.",
    epilog="Example: contactbench ports",
)
def ports(as_json: JsonOption = False) -> None:
    """List the serial ports of this machine."""
    from contactbench.pipeline.devices.transport import list_ports

    found = list_ports()
    for port in found:
        say(f"{port.path}: {port.description}" + (f"; try {port.url}" if port.url else ""))
    if not found:
        say("There is no serial port: plug the sensor in, or give a network address.")
    if as_json:
        rows = [{"path": p.path, "description": p.description, "url": p.url} for p in found]
        print_json({"ports": rows})


def wait(pair: Pair, seconds: float | None, *ends: threading.Event, changes: Changes | None = None) -> None:
    """Wait until the time or the source is over, a stream has failed, or one of the events is set."""
    deadline = math.inf if seconds is None else time.monotonic() + seconds
    while not (pair.finished or broken(pair) or any(end.is_set() for end in ends)):
        left = deadline - time.monotonic()
        if left <= 0:
            return
        if changes is not None:
            changes.tick()
        if pair.stepwise:
            pair.step(_STEPS)
        else:
            ends[0].wait(min(left, _LOOK_S))


def broken(pair: Pair) -> bool:
    """Tell whether a stream has ended before its end: it failed, or its recording cannot be read on."""
    from contactbench.pipeline.devices.stream import State

    return any(
        stream.health.failure is not None or (stream.done.is_set() and stream.health.state is State.LOST)
        for stream in pair.streams
    )


@contextmanager
def ended_by_signals() -> Iterator[threading.Event]:
    """Let Ctrl-C, a polite kill and a closed terminal end a recording well; only the main thread may ask for that."""
    ended = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield ended
        return
    signals = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    before = {each: signal.signal(each, lambda *_: ended.set()) for each in signals}
    try:
        yield ended
    finally:
        for each, handler in before.items():
            # Once asked to end, the process is about to: one more signal must not kill it while it says what it wrote.
            signal.signal(each, signal.SIG_IGN if ended.is_set() else handler)


@dataclass
class _Told:
    """Of one device: when it last had a line, s; what was said of it; what waits, the newest kind last."""

    at: float
    known: set[tuple[str, str]] = field(default_factory=set)
    waiting: dict[tuple[str, str], int] = field(default_factory=dict)
    found: str = ""


class Changes:
    """Lines about changes of devices: a new one at once, repeats folded into a count.

    A device that comes and goes would flood the terminal. Two changes are the same if the device, its state and its
    findings are, numbers ignored. Repeats wait until the device has had no line for some seconds; then one line counts
    them, and ends with how the device is now.

    Streams may call it from their threads. A closed terminal is no error: samples matter more than lines.

    Parameters
    ----------
    clock : callable
        Seconds; only differences count.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._devices: dict[str, _Told] = {}
        self._lock = threading.Lock()

    def tell(self, device: str, health: Health) -> None:
        """Say that a device has changed, or count it."""
        found = " ".join((*health.findings, *health.suspicions))
        kind = health.state.value, _NUMBER.sub("", found)
        with self._lock:
            told = self._devices.setdefault(device, _Told(self._clock()))
            # Bounded: a device may put anything into its words.
            new = kind not in told.known and len(told.known) < _MOST_KINDS
            if new:
                told.known.add(kind)
                self._fold(device, told)  # what waited came before
            told.waiting[kind] = told.waiting.pop(kind, 0) + 1
            told.found = found
            if new or self._clock() - told.at >= _FOLD_S:
                self._fold(device, told)

    def tick(self) -> None:
        """Say what has waited long enough; to be called a few times a second."""
        with self._lock:
            for device, told in self._devices.items():
                if self._clock() - told.at >= _FOLD_S:
                    self._fold(device, told)

    def end(self) -> None:
        """Say whatever waits."""
        with self._lock:
            for device, told in self._devices.items():
                self._fold(device, told)

    def _fold(self, device: str, told: _Told) -> None:
        if not told.waiting:
            return
        newest_first = dict.fromkeys(state for state, _ in reversed(told.waiting))
        words = f"{device}: {', then '.join(reversed(newest_first))}"
        now, times = self._clock(), max(told.waiting.values())
        if times > 1 or len(told.waiting) > 1:
            words += f" again: {'once' if times == 1 else f'{times} times'} in {now - told.at:.0f} s"
        told.at = now
        told.waiting.clear()
        with suppress(OSError, SystemExit):
            say(f"{words}: {told.found}" if told.found else words, "yellow" if told.found else "")


def _tell(out: Path, given: Mapping[str, Health], recorder: Recorder, kept: bool) -> None:
    for device, health in given.items():
        counters = health.counters
        rate = "an unknown rate" if health.rate is None else f"{health.rate:.1f} Hz"
        jitter = "" if health.jitter is None else f", jitter {1e3 * health.jitter:.2f} ms"
        if health.lateness is not None:
            jitter += f", at worst {1e3 * health.lateness[1]:.1f} ms late"
        say(
            f"{device}: {health.samples:,} samples at {rate}{jitter}; lost {counters.lost}, damaged"
            f" {counters.bad_checksums}, reconnected {health.reconnected} times."
        )
        if health.failure is not None:
            say(f"{device}: {health.failure}", "red")
    for _, what in recorder.suspicions:
        say(what, "yellow")
    if recorder.skipped:
        say(f"{recorder.skipped} batches hold a sample that cannot be recorded.", "yellow")
    say(f"Wrote {out}." if kept else "Not one sample came: nothing is kept.", "" if kept else "red")


def _facts(health: Health) -> dict[str, Any]:
    from contactbench.pipeline.recording.recorder import health_facts

    usual, worst = health.lateness or (None, None)
    return {**health_facts(health), "lateness_p99_s": usual, "lateness_max_s": worst}

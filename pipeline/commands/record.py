"""``contactbench record ...``: what a sensor and a robot give, into a file; and what is in such files."""

from __future__ import annotations

import math
import re
import threading
import time
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.options import refuse_overwriting
from contactbench.pipeline.console import (
    Bar,
    Ended,
    Noun,
    answer,
    as_json,
    ended_by_signals,
    print_json,
    say,
    say_all,
    warn,
)
from contactbench.pipeline.settings import JointsSettings

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from contactbench.pipeline.devices.stream import Health
    from contactbench.pipeline.recording.recorder import Recorder
    from contactbench.pipeline.streams import Pair


record_app = Noun("Record a sensor and a robot; inspect and convert recordings.")

_LOOK_S = 0.05  # how soon the end of a replay is noticed
_STEPS = 500  # samples between looks at Ctrl-C
_FOLD_S = 5.0  # between two lines about a device that comes and goes
_MOST_KINDS = 50
_NUMBER = re.compile(r"\d+(\.\d+)?")


@dataclass(frozen=True)
class Extent:
    """
    What is recorded beside a sensor, and for how long.

    Parameters
    ----------
    pose : ADDRESS
        Also record a robot's flange: elfin+tcp://, ur+tcp://, igtl+tcp://, the same replay:// address,
        poses:///file.csv, or a fixed pose: still://?rpy=0,90,0 (degrees).
    seconds
        Duration, s [until Ctrl-C].
    note
        Note to keep with the recording.
    """

    pose: str | None = None
    seconds: float | None = None
    note: str = ""

    def __post_init__(self) -> None:
        check_seconds(self.seconds)


def check_seconds(seconds: float | None) -> None:
    """Refuse a duration that is none; typer.BadParameter."""
    if seconds is not None and not 0 < seconds < 1e6:
        raise typer.BadParameter(f"--seconds {seconds:g}: give a number above 0.")


@record_app.command(example="record start sri+serial:///dev/ttyUSB0 --out poses.mcap --seconds 60")
def start(address: str, /, out: Path, extent: Extent) -> None:
    """Record a force/torque sensor until Ctrl-C, or for some seconds.

    ADDRESS is one of contactbench record devices, such as sri+tcp, then :// and its location; or
    replay:///recording.mcap?speed=4 (or speed=step: as fast as it can be read), which ends by itself and
    keeps its times. Only the commands needed for streaming are sent: no sensor is zeroed. A lost connection
    is reopened; the gap remains. Exit code 1: one of them sent no sample, a stream failed, or a replay could
    not be read to its end; without samples no file is kept.

    Parameters
    ----------
    address
        Address of the sensor.
    out
        Recording to write, .mcap; never overwrites a file.
    """
    from contactbench.pipeline.recording import RecordingWriter
    from contactbench.pipeline.recording.recorder import Recorder

    changes = Changes()
    recorder: Recorder
    pair = recorded_pair(address, extent.pose, lambda: recorder)
    # Until all is written: a second Ctrl-C must not cut the end off.
    with ended_by_signals() as ended:
        try:
            with RecordingWriter(out, pair.about(extent.note)) as writer:
                recorder = Recorder(writer, changes.tell, clock=pair.now)
                with recorder, pair:
                    wait(pair, extent.seconds, ended, recorder.failed, changes)
        finally:
            pair.stop()  # a replay has its file open before it begins
            changes.end()
    given = pair.healths
    _end(out, given, recorder)
    if broken(pair) or not all(health.samples for health in given.values()):
        raise typer.Exit(1)


def recorded_pair(address: str, pose: str | None, recorder: Callable[[], Recorder]) -> Pair:
    """Open a sensor, and a robot beside it, for a recorder that is there once the first sample comes."""
    from contactbench.pipeline.streams import open_pair

    return open_pair(
        address,
        pose,
        lambda samples: recorder().samples(samples),
        lambda samples: recorder().poses(samples),
        lambda health: recorder().health("sensor", health),
        lambda health: recorder().health("robot", health),
    )


def _end(out: Path, given: Mapping[str, Health], recorder: Recorder) -> None:
    """Say what was written; nothing is kept where nothing came: an empty file would stand in the next one's way."""
    kept = any(health.samples for health in given.values())
    if not kept:
        out.unlink(missing_ok=True)
    if recorder.error is not None:
        raise recorder.error
    _tell(out, given, recorder, kept)
    if as_json():
        facts = {device: _facts(health) for device, health in given.items()}
        suspicions = [what for _, what in recorder.suspicions]
        print_json(
            {
                "out": str(out) if kept else None,
                **facts,
                "suspicions": suspicions,
                "skipped": recorder.skipped,
                "unusable": recorder.unusable,
            }
        )


@record_app.command(example="record ports")
def ports() -> None:
    """List the serial ports of this machine, with a guess at the connected device."""
    from contactbench.pipeline.devices.transport import list_ports

    found = list_ports()
    for port in found:
        say(f"{port.path}: {port.description}" + (f"; try {port.url}" if port.url else ""))
    if not found:
        say("No serial port found: plug in the sensor, or give a network address.")
    rows = [{"path": p.path, "description": p.description, "url": p.url} for p in found]
    answer({"ports": rows})


@record_app.command(example="record devices")
def devices() -> None:
    """List the sensors and robots that can be opened, with the options of their addresses.

    An installed package can add devices of its own; a package that cannot be used is named.
    """
    from contactbench.pipeline.devices.protocols.registry import drivers, left_out

    found = drivers()
    for scheme, driver in found.items():
        say(f"{' '.join(f'{scheme}+{way.carrier}' for way in driver.ways)}: {driver.title}")
        for name, option in driver.options.items():
            say(f"    {name}: {option.help}")
    say_all((f"{each.why[:1].upper()}{each.why[1:]}." for each in left_out()), "yellow")
    answer(
        {
            "devices": [
                {
                    "scheme": scheme,
                    "title": driver.title,
                    "carriers": [way.carrier for way in driver.ways],
                    "options": {name: option.help for name, option in driver.options.items()},
                }
                for scheme, driver in found.items()
            ],
            "left_out": [{"scheme": each.scheme, "why": each.why} for each in left_out()],
        }
    )


def wait(pair: Pair, seconds: float | None, ended: Ended, failed: threading.Event, changes: Changes) -> None:
    """Wait until the time or the source is over, somebody ends it, or a stream or what takes it has failed."""
    deadline = math.inf if seconds is None else time.monotonic() + seconds
    while not (pair.finished or broken(pair) or ended.asked or failed.is_set()):
        left = deadline - time.monotonic()
        if left <= 0:
            return
        changes.tick()
        if pair.stepwise:
            pair.step(_STEPS)
        else:
            failed.wait(min(left, _LOOK_S))


def broken(pair: Pair) -> bool:
    """Tell whether a stream has ended before its end: it failed, or its recording cannot be read on."""
    from contactbench.pipeline.devices.stream import StreamState

    return any(
        stream.health.failure is not None
        or (stream.done.is_set() and stream.health.state is StreamState.LOST)
        for stream in pair.streams
    )


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
            style = "yellow" if told.found else ""
            say(f"{words}: {told.found}" if told.found else words, style, aside=True)


def _tell(out: Path, given: Mapping[str, Health], recorder: Recorder, kept: bool) -> None:
    for device, health in given.items():
        counters = health.counters
        rate = "an unknown rate" if health.rate is None else f"{health.rate:.1f} Hz"
        jitter = "" if health.jitter is None else f", jitter {1e3 * health.jitter:.2f} ms"
        if health.lateness is not None:
            jitter += f", at most {1e3 * health.lateness[1]:.1f} ms late"
        say(
            f"{device}: {health.samples:,} samples at {rate}{jitter}; lost {counters.lost}, damaged"
            f" {counters.bad_checksums}, reconnected {health.reconnected} times."
        )
        if health.failure is not None:
            say(f"{device}: {health.failure}", "red")
    for _, what in recorder.suspicions:
        say(what, "yellow")
    if recorder.unusable:
        say(
            f"{recorder.unusable:,} of the sensor's samples are flagged as unusable: see record info.",
            "yellow",
        )
    if recorder.skipped:
        say(f"{recorder.skipped} batches contain a sample that cannot be recorded.", "yellow")
    say(f"Wrote {out}." if kept else "No sample arrived, so nothing was kept.", "" if kept else "red")


def _facts(health: Health) -> dict[str, Any]:
    from contactbench.pipeline.recording.recorder import health_facts

    usual, worst = health.lateness or (None, None)
    return {**health_facts(health), "lateness_p99_s": usual, "lateness_max_s": worst}


_FLAGS = {"late": "slower than the rate", "error": "with a sensor error", "clock": "with an estimated time"}

FileArgument = Annotated[Path, typer.Argument(metavar="FILE", help="Recording, an MCAP file.")]


@record_app.command(example="record info touches.mcap")
def info(file: FileArgument) -> None:
    """Show the contents of a recording: devices, topics, samples, rates, and whether the file is complete.

    Counts lost and unusable samples, those that the sensor flagged, those whose time is an estimate
    because the device's counter or clock had just jumped, and those that arrived more than 0.1 s after they
    were measured.

    Exit code 1: it is cut off or damaged, its clock was set, or it contains no samples.
    """
    from contactbench.pipeline.recording.contents import read_contents

    with Bar("reading") as bar:
        found = read_contents(file, bar)
    topics = found.topics
    for facts in topics:
        say(_sentence(facts))
    say(f"{found.events:,} events; written by {found.info.tool}.")
    for device in found.info.devices:
        say(" ".join(part for part in (device.topic, device.address, device.model, device.serial) if part))
    warn(found.warnings)
    whole = found.complete and not found.warnings and bool(topics)
    if not topics:
        say("It contains no samples.", "red")
    told = {name: getattr(found.info, name) for name in ("tool", "note", "started_ns")}
    devices = [{name: getattr(device, name) for name in device.__slots__} for device in found.info.devices]
    more = {
        "devices": devices,
        "topics": list(topics),
        "events": found.events,
        "warnings": list(found.warnings),
    }
    answer({"complete": found.complete, **told, **more}, good=whole)


@record_app.command(example="record convert touches.mcap --out touches.csv")
def convert(file: FileArgument, /, out: Path, topic: str | None = None) -> None:
    """Write a recording as .csv, .npz or a ROS 2 bag.

    CSV: one topic, as locate and calibrate captures read it: t,fx,fy,fz,mx,my,mz (s, N, N·m) and, where one robot
    was recorded too, qw,qx,qy,qz,px,py,pz of its flange at the same times; readings flagged as bad by
    the device, or without a pose, are left out. NPZ: everything. ROS 2 bag (MCAP; ROS is not needed): WrenchStamped
    and PoseStamped of each topic. Where the clock was set, what follows is placed a second later.

    Exit code 1: the recording is cut off or damaged, and the readable part is written; or its clock was set.

    Parameters
    ----------
    out
        File to write: .csv or .npz; without an ending, the new folder of a ROS 2 bag.
    topic : NAME
        Only this topic [the only sensor, else the only robot; all in .npz and a bag].
    """
    from contactbench.pipeline.recording.convert import write_csv, write_npz, write_ros2

    write = {".csv": write_csv, ".npz": write_npz, "": write_ros2}.get(out.suffix.lower())
    if write is None:
        raise typer.BadParameter(
            f"--out {out}: end its name with .csv or .npz, or leave the ending out for a bag."
        )
    refuse_overwriting(out, [file])
    with Bar("reading") as bar:
        done = write(out, file, topic, bar)
    warnings = (*done.warnings, *done.left_out)
    warn(warnings)
    say(f"written: {out}")
    answer({"out": str(out), "complete": done.complete, "warnings": list(warnings)}, good=not done.warnings)


@record_app.command(example="record delay poses.mcap")
def delay(file: FileArgument) -> None:
    """Estimate the delay of the sensor relative to the robot, from a stretch in which the tool was turned.

    Needs no mount and no calibration: the weight must turn with the flange without touching anything. Exit
    code 1: the motion does not show the delay, or only doubtfully.
    """
    from contactbench.pipeline.recording import read_recording
    from contactbench.pipeline.recording.delay import estimate_delay

    with Bar("reading") as bar:
        wrenches, poses = read_recording(file, bar).pair(file)
    estimate = estimate_delay(wrenches, poses)
    say(estimate.sentence, "yellow" if estimate.doubt else "")
    told = {name: getattr(estimate, name) for name in ("seconds", "sigma", "sentence", "doubt")}
    answer(told, good=not (estimate.seconds is None or estimate.doubt))


@record_app.command("import-ros2", example="record import-ros2 bag_0.mcap --out touches.mcap")
def import_bag(
    bag: Path,
    /,
    out: Path,
    joints: JointsSettings,
    wrench_topic: str | None = None,
    pose_topic: str | None = None,
    base: str | None = None,
    flange: str | None = None,
    header_stamps: bool = False,
) -> None:
    """Convert a ROS bag to a recording; ROS is not needed.

    BAG is an MCAP or SQLite file, also packed with zstd, a folder of them with its metadata.yaml, or a bag of ROS 1.

    Takes a topic of geometry_msgs/WrenchStamped, and the flange's pose from tf2_msgs/TFMessage,
    geometry_msgs/PoseStamped, or sensor_msgs/JointState with --robot. A topic that is the only one of
    its kind is used; otherwise the error lists them. Where the clock was set back, what follows is placed a second
    later.

    Exit code 1: something in the bag is damaged or missing; the readable part is written.

    Parameters
    ----------
    bag
        Bag: a file or a folder.
    out
        Recording to write; must not exist.
    wrench_topic : NAME
        Topic of the sensor.
    pose_topic : NAME
        Topic of the robot.
    base : NAME
        Frame of the robot's base.
    flange : NAME
        Frame of its flange.
    header_stamps
        Use the times in the headers instead of those when the bag received them.
    """
    from contactbench.pipeline.recording.ros2 import ImportChoice, import_ros2
    from contactbench.pipeline.robot import Robot

    arm = None if joints.robot is None else Robot.named(joints.robot)
    wanted = ImportChoice(wrench_topic, pose_topic, arm, base, flange, header_stamps)
    with Bar("importing") as bar:
        done = import_ros2(bag, out, wanted, bar)
    warn(done.warnings)
    where = "" if done.pose_topic is None else f", {done.poses:,} poses from {done.pose_topic}"
    say(f"{done.wrenches:,} wrenches from {done.wrench_topic}{where}.")
    told = {name: getattr(done, name) for name in ("wrench_topic", "pose_topic", "wrenches", "poses")}
    answer({"out": str(out), **told, "warnings": list(done.warnings)}, good=not done.warnings)


def _sentence(facts: dict[str, Any]) -> str:
    from contactbench.pipeline.recording.contents import LATE_S

    rate = "" if facts["rate"] is None else f" ({facts['rate']:.1f} Hz)"
    what = {"wrench": "wrenches", "flange": "poses of the flange"}[facts["kind"]]
    sentence = f"{facts['topic']}: {facts['samples']:,} {what} in {facts['seconds']:.2f} s{rate}"
    if facts["kind"] == "wrench":
        sentence += f", {facts['lost']:,} lost, {facts['unusable']:,} unusable"
        if facts["frozen"]:
            sentence += f", {facts['frozen']:,} frozen"
        sentence += "".join(f", {count:,} {_FLAGS.get(name, name)}" for name, count in facts["flags"].items())
    if facts["late"]:
        sentence += f", {facts['late']:,} late by more than {LATE_S:g} s"
    if facts["latency_median"] is not None:
        median, p99 = 1e3 * facts["latency_median"], 1e3 * facts["latency_p99"]
        sentence += f"; latency {median:.1f} ms (median), {p99:.1f} ms (99th percentile)"
    return sentence + "."

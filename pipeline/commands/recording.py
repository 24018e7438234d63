"""``contactbench recording info, convert, import-ros2``: look into recordings and turn them into others."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.options import RobotOption, refuse_overwriting
from contactbench.pipeline.console import Bar, JsonOption, print_json, say

if TYPE_CHECKING:
    from contactbench.pipeline.recording import FlangeTrack, Recording, WrenchTrack

recording_app = typer.Typer(
    help="Look into recordings of sensors and robots, and convert them.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

_LATE_S = 0.1
_FLAGS = {
    "overrange": "overrange",
    "invalid": "invalid",
    "raw": "raw",
    "late": "slower than the rate",
    "error": "with a sensor error",
    "clock": "with a guessed time",
}

FileArgument = Annotated[Path, typer.Argument(metavar="FILE", help="Recording, an MCAP file.")]


@recording_app.command(
    help=(
        "Say what is in a recording: devices, topics, samples, rates, and whether the file is whole.\n\n"
        "Counts lost and unusable samples, those that the sensor flagged, those whose time is a guess because the"
        " device's count or clock had just leapt, and those that arrived more than 0.1 s after they were measured.\n\n"
        "Exit code 1: it is cut off or damaged, or holds no samples."
    ),
    epilog="Example: contactbench recording info touches.mcap",
)
def info(file: FileArgument, as_json: JsonOption = False) -> None:
    """Say what is in a recording."""
    found = _read(file)
    topics = [
        *(_wrench_facts(topic, track) for topic, track in found.wrenches.items()),
        *(_flange_facts(topic, track) for topic, track in found.flanges.items()),
    ]
    for facts in topics:
        say(_sentence(facts))
    say(f"{len(found.events):,} events; written by {found.info.tool}.")
    for device in found.info.devices:
        say(" ".join(part for part in (device.topic, device.address, device.model, device.serial) if part))
    _warn(found.warnings)
    whole = found.complete and not found.warnings and bool(topics)
    if not topics:
        say("There are no samples in it.", "red")
    if as_json:
        print_json(
            {
                "complete": found.complete,
                "tool": found.info.tool,
                "note": found.info.note,
                "started_ns": found.info.started_ns,
                "devices": [
                    {name: getattr(device, name) for name in device.__slots__}
                    for device in found.info.devices
                ],
                "topics": topics,
                "events": len(found.events),
                "warnings": list(found.warnings),
            }
        )
    if not whole:
        raise typer.Exit(1)


@recording_app.command(
    help=(
        "Write a recording as .csv or .npz.\n\n"
        "CSV: one topic, as locate and captures read it: t,fx,fy,fz,mx,my,mz (s, N, N·m) and, where one robot"
        " was recorded too, qw,qx,qy,qz,px,py,pz of its flange at the same moments; readings that the device"
        " says are no good, or without a pose beside them, are left out. NPZ: everything, as it is.\n\n"
        "Exit code 1: the recording is cut off or damaged; what can be read is written."
    ),
    epilog="Example: contactbench recording convert touches.mcap --out touches.csv",
)
def convert(
    file: FileArgument,
    out: Annotated[Path, typer.Option(help="File to write: .csv or .npz.")],
    topic: Annotated[
        str | None, typer.Option(metavar="NAME", help="Only that topic [the one sensor, else the one robot].")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Write a recording as .csv or .npz."""
    ending = out.suffix.lower()
    if ending not in (".csv", ".npz"):
        raise typer.BadParameter(f"--out {out}: end its name with .csv or .npz.")
    refuse_overwriting(out, [file])
    from contactbench.pipeline.recording.convert import write_csv, write_npz

    found = _read(file)
    left_out: tuple[str, ...] = ()
    if ending == ".csv":
        left_out = write_csv(out, found, topic)
    else:
        write_npz(out, found, topic)
    warnings = (*found.warnings, *left_out)
    _warn(warnings)
    say(f"written: {out}")
    if as_json:
        print_json({"out": str(out), "complete": found.complete, "warnings": list(warnings)})
    if found.warnings:
        raise typer.Exit(1)


@recording_app.command(
    help=(
        "Estimate how much later the sensor is heard than the robot, from a stretch in which it was turned.\n\n"
        "Needs no mount and no calibration: the weight must turn with the flange, touching nothing. Exit code 1: the"
        " motion does not show it, or shows it doubtfully."
    ),
    epilog="Example: contactbench recording delay poses.mcap",
)
def delay(file: FileArgument, as_json: JsonOption = False) -> None:
    """Estimate how much later the sensor is heard than the robot."""
    from contactbench.pipeline.recording import RecordingError
    from contactbench.pipeline.recording.delay import estimate_delay

    found = _read(file)
    if len(found.wrenches) != 1 or len(found.flanges) != 1:
        raise RecordingError(
            f"{file}: one sensor and one robot are needed, and it holds {len(found.wrenches)} and"
            f" {len(found.flanges)}: record one of each."
        )
    (wrenches,), (poses,) = found.wrenches.values(), found.flanges.values()
    estimate = estimate_delay(wrenches, poses)
    say(estimate.sentence, "yellow" if estimate.doubt else "")
    if as_json:
        print_json(
            {
                "seconds": estimate.seconds,
                "sigma": estimate.sigma,
                "sentence": estimate.sentence,
                "doubt": estimate.doubt,
            }
        )
    if estimate.seconds is None or estimate.doubt:
        raise typer.Exit(1)


@recording_app.command(
    "import-ros2",
    help=(
        "Make a recording of a ROS 2 bag in MCAP format; ROS is not needed.\n\n"
        "Takes a topic of geometry_msgs/WrenchStamped, and the flange's pose from tf2_msgs/TFMessage,"
        " geometry_msgs/PoseStamped, or sensor_msgs/JointState with --robot. Where there is one of a kind it is"
        " taken; otherwise the message lists them.\n\n"
        "Exit code 1: something in the bag is damaged or missing; what can be read is written."
    ),
    epilog="Example: contactbench recording import-ros2 bag_0.mcap --out touches.mcap",
)
def import_bag(
    bag: Annotated[Path, typer.Argument(metavar="BAG", help="ROS 2 bag, an MCAP file.")],
    out: Annotated[Path, typer.Option(help="Recording to write; must not exist.")],
    wrench_topic: Annotated[str | None, typer.Option(metavar="NAME", help="Topic of the sensor.")] = None,
    pose_topic: Annotated[str | None, typer.Option(metavar="NAME", help="Topic of the robot.")] = None,
    robot: RobotOption = None,
    base: Annotated[str | None, typer.Option(metavar="NAME", help="Frame of the robot's base.")] = None,
    flange: Annotated[str | None, typer.Option(metavar="NAME", help="Frame of its flange.")] = None,
    header_stamps: Annotated[
        bool,
        typer.Option("--header-stamps", help="Times are those in the headers, not when the bag got them."),
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Make a recording of a ROS 2 bag."""
    from contactbench.pipeline.recording.ros2 import Wanted, import_ros2
    from contactbench.pipeline.robot import Robot

    arm = None if robot is None else Robot.named(robot)
    wanted = Wanted(wrench_topic, pose_topic, arm, base, flange, header_stamps)
    with Bar("importing") as bar:
        done = import_ros2(bag, out, wanted, bar)
    _warn(done.warnings)
    where = "" if done.pose_topic is None else f", {done.poses:,} poses from {done.pose_topic}"
    say(f"{done.wrenches:,} wrenches from {done.wrench_topic}{where}.")
    if as_json:
        print_json(
            {
                "out": str(out),
                "wrench_topic": done.wrench_topic,
                "pose_topic": done.pose_topic,
                "wrenches": done.wrenches,
                "poses": done.poses,
                "warnings": list(done.warnings),
            }
        )
    if done.warnings:
        raise typer.Exit(1)


def _read(file: Path) -> Recording:
    from contactbench.pipeline.recording import read_recording

    with Bar("reading") as bar:
        return read_recording(file, bar)


def _warn(warnings: tuple[str, ...]) -> None:
    for sentence in warnings:
        say(f"warning: {sentence}", "yellow")


def _facts(topic: str, kind: str, track: WrenchTrack | FlangeTrack) -> dict[str, Any]:
    times = track.times
    duration = float(times.max() - times.min())
    rate = (len(times) - 1) / duration if duration > 1e-9 else None
    return {
        "topic": topic,
        "kind": kind,
        "samples": len(times),
        "seconds": duration,
        "rate": rate,
        **_latency(track),
    }


def _latency(track: WrenchTrack | FlangeTrack) -> dict[str, Any]:
    """Return how long samples took to arrive, s, beyond the shortest time; None where it is not known."""
    import numpy as np

    delays = (track.arrivals - track.times)[np.isfinite(track.arrivals)]
    if not len(delays):
        return {"latency_median": None, "latency_p99": None, "late": 0}
    median, p99 = np.percentile(delays, (50, 99)).tolist()
    return {
        "latency_median": median,
        "latency_p99": p99,
        "late": int(np.count_nonzero(delays > _LATE_S)),
    }


def _wrench_facts(topic: str, track: WrenchTrack) -> dict[str, Any]:
    import numpy as np

    from contactbench.pipeline.devices.sample import Status

    steps = np.diff(track.sequence[track.sequence >= 0])
    return {
        **_facts(topic, "wrench", track),
        "lost": sum(step - 1 for step in steps.tolist() if step > 1),
        "unusable": int(np.count_nonzero(~track.usable)),
        "frozen": int(np.count_nonzero(track.frozen)),
        "flags": {
            str(flag.name).lower(): count
            for flag in Status
            if (count := int(np.count_nonzero(track.status & flag)))
        },
    }


def _flange_facts(topic: str, track: FlangeTrack) -> dict[str, Any]:
    return {**_facts(topic, "flange", track), "joints": track.joints.shape[1]}


def _sentence(facts: dict[str, Any]) -> str:
    rate = "" if facts["rate"] is None else f" ({facts['rate']:.1f} Hz)"
    what = {"wrench": "wrenches", "flange": "poses of the flange"}[facts["kind"]]
    sentence = f"{facts['topic']}: {facts['samples']:,} {what} in {facts['seconds']:.2f} s{rate}"
    if facts["kind"] == "wrench":
        sentence += f", {facts['lost']:,} lost, {facts['unusable']:,} unusable"
        if facts["frozen"]:
            sentence += f", {facts['frozen']:,} frozen"
        sentence += "".join(f", {count:,} {_FLAGS[name]}" for name, count in facts["flags"].items())
    if facts["late"]:
        sentence += f", {facts['late']:,} late by more than {_LATE_S:g} s"
    if facts["latency_median"] is not None:
        median, p99 = 1e3 * facts["latency_median"], 1e3 * facts["latency_p99"]
        sentence += f"; latency {median:.1f} ms (median), {p99:.1f} ms (99th percentile)"
    return sentence + "."

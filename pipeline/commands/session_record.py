"""``contactbench session record``: a sensor's raw stream, straight into a session."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from contactbench.pipeline.commands.record import Changes, ended_by_signals, wait
from contactbench.pipeline.console import JsonOption, print_json, say

if TYPE_CHECKING:
    from contactbench.pipeline.devices.stream import Health
    from contactbench.pipeline.recording import RecordingInfo
    from contactbench.pipeline.session import Session
    from contactbench.pipeline.session.live import LiveRecording

FolderArgument = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of the session.")]

_HELP = (
    "Record a force/torque sensor, and a robot beside it, into a session, until Ctrl-C or for some seconds.\n\n"
    "The raw streams are on the disk half a second later; when it ends, the recording becomes an input of the kind"
    " recording, with the counters of its streams. Should this process or the power die, `contactbench session repair`"
    " adopts what was recorded. Nothing but what it takes to stream is sent: no sensor is zeroed.\n\n"
    "Exit code 1: not one sample came from one of them."
)


def add_record_command(app: typer.Typer) -> None:
    """Add ``record`` to the commands of a session."""
    epilog = "Example: contactbench session record bench-1 --sensor sri+tcp://192.168.0.108:4008 --seconds 60"
    app.command(help=_HELP, epilog=epilog)(record)


def record(
    folder: FolderArgument,
    sensor: Annotated[str, typer.Option(metavar="ADDRESS", help="Of the sensor, as for record.")],
    pose: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Of a robot: also record its flange.")
    ] = None,
    seconds: Annotated[float | None, typer.Option(help="How long [until Ctrl-C].")] = None,
    serial: Annotated[
        str | None, typer.Option(metavar="SN", help="Serial number of the sensor: say it, if it is known.")
    ] = None,
    name: Annotated[
        str | None,
        typer.Option(metavar="NAME.mcap", help="Name of the recording [with the time of its start]."),
    ] = None,
    note: Annotated[str, typer.Option(help="A few words to keep with it.")] = "",
    as_json: JsonOption = False,
) -> None:
    """Record a sensor into a session."""
    if seconds is not None and not 0 < seconds < 1e6:
        raise typer.BadParameter(f"--seconds {seconds:g}: give a number above 0.")
    from contactbench.pipeline.session import Session

    with Session.open(folder) as session:
        for words in session.notes:
            say(f"warning: {words}", "yellow")
        live, streams = _record(session, sensor, pose, seconds, serial, name, note)
        error = live.recorder.error
        came = all(health.samples and health.failure is None for health in streams.values())
        path = _keep(live, streams)
    if as_json:
        print_json({"name": live.name, "file": path, **_facts(live, streams)})
    if error is not None:
        raise error
    if not came:
        raise typer.Exit(1)


def _record(
    session: Session,
    sensor: str,
    pose: str | None,
    seconds: float | None,
    serial: str | None,
    name: str | None,
    note: str,
) -> tuple[LiveRecording, dict[str, Health]]:
    """Record until the time or a replay is over; return the recording, not yet kept, and how its streams were."""
    from contactbench.pipeline.session.live import LiveRecording
    from contactbench.pipeline.streams import open_pair

    changes = Changes()
    live: LiveRecording
    pair = open_pair(
        sensor,
        pose,
        lambda samples: live.recorder.samples(samples),
        lambda samples: live.recorder.poses(samples),
        lambda health: live.recorder.health("sensor", health),
        lambda health: live.recorder.health("robot", health),
    )
    try:
        about = _with_serial(pair.about(note), serial)
        live = LiveRecording(
            session,
            about,
            sensor=serial,
            name=name,
            on_change=changes.tell,
            clock=pair.now,
            patient=pair.stepwise,
        )
        with ended_by_signals() as ended, live, pair:
            wait(pair, seconds, ended, live.recorder.failed, changes=changes)
    finally:
        pair.stop()  # a replay has its file open before it begins
        changes.end()
    healths = (stream.health for stream in pair.streams)
    return live, dict(zip(("sensor", "robot"), healths, strict=False))


def _with_serial(about: RecordingInfo, serial: str | None) -> RecordingInfo:
    if serial is None:
        return about
    first, *others = about.devices
    return replace(about, devices=(replace(first, serial=serial), *others))


def _keep(live: LiveRecording, streams: dict[str, Health]) -> str | None:
    """Put the recording into the journal; return its place, if there was anything."""
    from contactbench.pipeline.recording.recorder import health_facts
    from contactbench.pipeline.session.actions import files_of

    if not any(health.samples for health in streams.values()):
        live.discard()
        say("Not one sample came: nothing is kept.", "red")
        return None
    record = live.keep({device: health_facts(health) for device, health in streams.items()})
    path = files_of(record.action)[0].path
    say(f"{live.name} is kept as {path}.")
    if live.recorder.dropped:
        say(
            f"{live.recorder.dropped:,} samples are missing, for the disk was too slow: events `dropped` say when.",
            "yellow",
        )
    if live.recorder.suspicions:
        say(
            "If the sensor was re-zeroed, say so with `contactbench session rezero`, and record again.",
            "yellow",
        )
    return path


def _facts(live: LiveRecording, streams: dict[str, Health]) -> dict[str, object]:
    from contactbench.pipeline.recording.recorder import health_facts

    return {
        **{device: health_facts(health) for device, health in streams.items()},
        "suspicions": [what for _, what in live.recorder.suspicions],
        "skipped": live.recorder.skipped,
        "dropped": live.recorder.dropped,
    }

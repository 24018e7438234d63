"""``contactbench session ...``: every action, sample and result of a bench session in one folder."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.record import Changes, Extent, recorded_pair, wait
from contactbench.pipeline.console import Bar, Noun, answer, ended_by_signals, say, say_all, warn
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from contactbench.pipeline.devices.stream import Health
    from contactbench.pipeline.session import Session, State
    from contactbench.pipeline.session.adoption import LiveRecording
    from contactbench.pipeline.session.state import Result


FolderArgument = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of the session.")]

session_app = Noun("Keep every action, sample and result of a bench session in one folder.")


@session_app.command(example="session record bench-1 --source sri+tcp://192.168.0.108:4008 --seconds 60")
def record(
    folder: FolderArgument, /, source: str, extent: Extent, serial: str | None = None, name: str | None = None
) -> None:
    """Record a sensor, and a robot beside it, into a session, until Ctrl-C or for some seconds.

    The raw streams are on disk within half a second; at the end, the recording becomes an input of the kind
    recording, with the counters of its streams. After a crash or a power failure, recover the recording
    with `contactbench session repair`. Only the commands needed for streaming are sent: no sensor is
    zeroed. Exit code 1: one of them sent no sample.

    Parameters
    ----------
    source : ADDRESS
        Address of the sensor, as for record start.
    serial : SN
        Serial number of the sensor, if known.
    name : NAME.mcap
        Name of the recording [with its start time].
    """
    from contactbench.pipeline.session import Session

    with Session.open(folder) as session:
        warn(session.notes)
        live, streams = _record(session, source, extent, serial, name)
        error = live.recorder.error
        came = all(health.samples and health.failure is None for health in streams.values())
        path = _keep(live, streams)
    answer({"name": live.name, "file": path, **_stream_facts(live, streams)})
    if error is not None:
        raise error
    if not came:
        raise typer.Exit(1)


def _record(
    session: Session, source: str, extent: Extent, serial: str | None, name: str | None
) -> tuple[LiveRecording, dict[str, Health]]:
    """Record until the time or a replay is over; return the recording, not yet kept, and how its streams were."""
    from contactbench.pipeline.session.adoption import LiveRecording

    changes = Changes()
    live: LiveRecording
    pair = recorded_pair(source, extent.pose, lambda: live.recorder)
    try:
        about = pair.about(extent.note, serial)
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
            wait(pair, extent.seconds, ended, live.recorder.failed, changes)
    finally:
        pair.stop()  # a replay has its file open before it begins
        changes.end()
    return live, pair.healths


def _keep(live: LiveRecording, streams: dict[str, Health]) -> str | None:
    """Put the recording into the journal; return its place, if there was anything."""
    from contactbench.pipeline.recording.recorder import health_facts
    from contactbench.pipeline.session.actions import files_of

    if not any(health.samples for health in streams.values()):
        live.discard()
        say("No sample arrived, so nothing was kept.", "red")
        return None
    record = live.keep({device: health_facts(health) for device, health in streams.items()})
    path = files_of(record.action)[0].path
    say(f"{live.name} is kept as {path}.")
    if live.recorder.dropped:
        say(
            f"{live.recorder.dropped:,} samples are missing because the disk was too slow: events"
            " `dropped` show when.",
            "yellow",
        )
    if live.recorder.suspicions:
        say(
            "If the sensor was re-zeroed, note it with `contactbench session rezero`, and record again.",
            "yellow",
        )
    return path


def _stream_facts(live: LiveRecording, streams: dict[str, Health]) -> dict[str, object]:
    from contactbench.pipeline.recording.recorder import health_facts

    return {
        **{device: health_facts(health) for device, health in streams.items()},
        "suspicions": [what for _, what in live.recorder.suspicions],
        "skipped": live.recorder.skipped,
        "dropped": live.recorder.dropped,
    }


@session_app.command(example="session verify bench-1")
def verify(folder: FolderArgument) -> None:
    """Check the hash chain, every record, and size and content of every file. Exit code 1: a problem was found."""
    from contactbench.pipeline.session.check import check

    with Bar("checking files", counted=True) as bar:
        found = check(folder, bar)
    say_all(f"note: {note}" for note in found.notes)
    say_all((f"wrong: {problem}" for problem in found.problems), "red")
    if found.sound:
        say(f"{folder}: {found.records} records and {found.files} files are unchanged.", "green")
    answer({**vars(found), "sound": found.sound}, good=found.sound)


@session_app.command(example="session repair bench-1")
def repair(folder: FolderArgument) -> None:
    """Cut an unfinished or damaged record off the journal's end, and recover recordings that ended abruptly.

    Intact records are never removed, and the previous journal is kept. Exit code 1: a recording could not be recovered.
    """
    from contactbench.pipeline.session.check import repair as run

    done = run(folder)
    say_all((done.sentence, *done.adopted))
    say_all(done.left, "yellow")
    answer(vars(done), good=not done.left)


@session_app.command(example="session salvage bench-1 --out bench-1-new")
def salvage(folder: FolderArgument, /, out: Path | None = None) -> None:
    """Copy everything intact in a damaged session into a new one, and mark results that depend on lost data as stale.

    The damaged session is not changed. Exit code 1: a record or a file is lost.

    Parameters
    ----------
    out : NEW
        Folder to create [DIR-salvaged, beside DIR].
    """
    from contactbench.pipeline.session.check import salvage as run

    with Bar("copying files", counted=True) as bar:
        done = run(folder, out, bar)
    say_all(done.found, "yellow")
    for title, reasons in done.stale.items():
        say(f"{title} is stale: {reasons[0]}", "yellow")
    for place in done.unclaimed:
        say(
            f"{done.out / place} belongs to no record: if you need it, add it with `contactbench"
            " session add`.",
            "yellow",
        )
    lost = "nothing is lost" if done.whole else "not everything could be saved"
    say(
        f"{done.out}: a new session with {done.records} records; {lost}.", "green" if done.whole else "yellow"
    )
    answer({**vars(done), "out": str(done.out)}, good=done.whole)


@session_app.command("export-archive", example="session export-archive bench-1 --out bench-1.zip")
def export(folder: FolderArgument, /, out: Path) -> None:
    """Check a session and pack it into one zip file. Exit code 1: a recording in progress is not included.

    Parameters
    ----------
    out
        Zip file to write.
    """
    from contactbench.pipeline.session.archive import export_archive

    done = export_archive(folder, out)
    say_all((f"note: {note}" for note in done.notes), "yellow")
    say_all((f"{place} is not included: this recording is in progress." for place in done.left_out), "yellow")
    say(f"{out}: {done.files} files.")
    answer({"out": str(out), **vars(done)}, good=not done.left_out)


@session_app.command("import-archive", example="session import-archive bench-1.zip --out bench-1")
def unpack(archive: Path, /, out: Path) -> None:
    """Check every byte of an archive, and unpack it into a new folder.

    Parameters
    ----------
    archive : ZIP
        Archive written by export-archive.
    out
        Folder to create.
    """
    from contactbench.pipeline.session.archive import import_archive

    import_archive(archive, out)
    say(f"{out}: a complete session.")
    answer({"out": str(out)})


@session_app.command(example="session new bench-1")
def new(folder: FolderArgument) -> None:
    """Create a session in a new or empty folder."""
    from contactbench.pipeline.session import Session

    with Session.create(folder) as session:
        identity = session.state.id
    say(f"{folder}: new session created.")
    answer({"session": str(folder), "id": identity})


@session_app.command(example="session add bench-1 poses.csv --kind poses --serial M8128-0042")
def add(
    folder: FolderArgument,
    file: Path,
    /,
    kind: str,
    serial: str | None = None,
    companion: list[Path] | None = None,
    name: str | None = None,
) -> None:
    """Copy a raw input into a session; results computed from an input that it replaces become stale.

    Parameters
    ----------
    file
        File to copy into the session.
    kind
        Kind of file: mesh, poses, recording, ...; a mesh replaces the previous one.
    serial
        Serial number of the sensor it was recorded with.
    companion : FILE
        File that belongs with it; may be repeated. The JSON file of a probe is found automatically.
    name : NAME
        Name in the session [the file's name].
    """
    from contactbench.pipeline.session.actions import files_of
    from contactbench.pipeline.session.recompute import about_of, companions_of

    beside, about = companions_of(file, companion or []), about_of(file)
    with _writing(folder) as session:
        before = _stale_titles(session)
        record = session.add_input(file, kind, name=name, sensor=serial, companions=beside, about=about)
        newly = _stale_titles(session) - before
    ref, *others = files_of(record.action)
    say(f"{file} is kept as {ref.path}.")
    for name, other in zip(beside, others, strict=True):
        say(f"{name}, which belongs to it, is kept as {other.path}.")
    for title in sorted(newly):
        say(f"{title} is now stale: `contactbench session info` says why.", "yellow")
    answer(
        {
            "record": record.number,
            "file": ref.path,
            "sha256": ref.sha256,
            "size": ref.size,
            "companions": {name: other.path for name, other in zip(beside, others, strict=True)},
            "stale": sorted(newly),
        }
    )


@session_app.command(example="session compute bench-1 calibration calibration.json --set euler=xyz")
def compute(
    folder: FolderArgument,
    kind: str,
    name: str,
    /,
    set_: list[str] | None = None,
    input_: list[str] | None = None,
) -> None:
    """Compute a result from the newest inputs of its kind, raw or computed, and record it with its origin.

    Parameters
    ----------
    kind
        captures, from a recording; calibration, from poses; probe, from the mesh and, where there are some, an
        alignment and regions; known_weight, from a calibration and inputs unloaded and loaded; known_touch,
        from a calibration, a probe and an input touch; verification, from a recording, a probe, a calibration
        and markers; report, from a verification and its probe and, where there are some, its calibration and
        both checks.
    name
        Name of the result's file.
    set_ : NAME=VALUE
        Parameter, as JSON or text; may be repeated. Others keep the values set by `session set` or the window for
        this kind.
    input_ : ROLE=NAME
        Use this recording, poses or alignment instead of the newest; without a name: none.
    """
    from contactbench.pipeline.session.actions import files_of
    from contactbench.pipeline.session.recompute import compute as run
    from contactbench.pipeline.session.recompute import newest_inputs, settings_of

    chosen = dict(_choice(text) for text in input_ or [])
    with _writing(folder) as session:
        given = settings_of(session.state, kind) | dict(_setting(text) for text in set_ or [])
        record = run(
            session,
            kind,
            name,
            newest_inputs(session.state, kind, chosen),
            given,
            tell=lambda sentence: say(sentence, "yellow"),
        )
        stale = session.stale()[kind, name]
    files = [ref.path for ref in files_of(record.action)]
    say(f"{kind} {name} is kept as {', '.join(files)}.")
    say_all((f"it is already stale: {reason}" for reason in stale), "yellow")
    answer({"record": record.number, "files": files, "stale": list(stale)})


def _choice(text: str) -> tuple[str, str]:
    role, equals, name = text.partition("=")
    if not role or not equals:
        raise typer.BadParameter(f"--input needs ROLE=NAME, not {text!r}.")
    return role, name


def _setting(text: str) -> tuple[str, Any]:
    name, equals, value = text.partition("=")
    if not name or not equals:
        raise typer.BadParameter(f"a parameter is written NAME=VALUE, not {text!r}.")
    try:
        return name, json.loads(value)
    except (ValueError, RecursionError):
        return name, value


@session_app.command(example="session info bench-1 --json")
def info(folder: FolderArgument) -> None:
    """Show the contents of a session, and which results are stale and why; works read-only, and while it is in use.

    Of a damaged session, the intact part is shown. Nothing is written. Exit code 1: the session is damaged.
    """
    from contactbench.pipeline.session import Session

    with Session.open(folder, write=False, damaged=True) as session:
        state, stale, notes, damage = session.state, session.stale(), session.notes, session.damage
    if damage:
        say(f"{folder}: {damage}: `contactbench session salvage` copies everything intact.", "red")
    warn(notes)
    say(f"Session {state.id}: {state.count} records.")
    for each in state.current_inputs.values():
        say(f"{each.kind} {each.name}: {each.file.size} bytes, {each.at}.")
    for slot, result in state.current_results.items():
        say(f"{result.title}: {_word(result, stale[slot])}, {result.at}.", "yellow" if stale[slot] else "")
        say_all(f"  {reason}" for reason in stale[slot])
    answer(_facts(state, stale, notes) | {"damage": damage}, good=not damage)


def _word(result: Result, reasons: tuple[str, ...]) -> str:
    mark = "" if result.mark is None else result.mark.mark
    if mark == "rejected":
        return "REJECTED"
    if reasons:
        return "STALE"
    return "holds, accepted" if mark == "accepted" else "holds"


def _facts(
    state: State, stale: dict[tuple[str, str], tuple[str, ...]], notes: tuple[str, ...]
) -> dict[str, Any]:
    return {
        "id": state.id,
        "records": state.count,
        "inputs": [
            {
                "kind": each.kind,
                "name": each.name,
                "sensor": each.sensor,
                "at": each.at,
                "companions": {name: ref.path for name, ref in each.companions.items()},
                "about": dict(each.about),
                **each.file.model_dump(),
            }
            for each in state.current_inputs.values()
        ],
        "results": [_result(result, stale[slot]) for slot, result in state.current_results.items()],
        "parameters": {key: setting.value for key, setting in state.settings.items()},
        "notes": list(notes),
    }


def _result(result: Result, reasons: tuple[str, ...]) -> dict[str, Any]:
    return {
        "kind": result.action.kind,
        "name": result.action.name,
        "at": result.at,
        "tool": result.tool,
        "content": result.content,
        "files": {name: ref.path for name, ref in result.action.files.items()},
        "mark": None if result.mark is None else result.mark.mark,
        "stale": list(reasons),
    }


@session_app.command(example="session note bench-1 'new cable'")
def note(folder: FolderArgument, text: str, /) -> None:
    """Write a note into a session's journal, with author and time.

    Parameters
    ----------
    text
        Text of the note.
    """
    with _writing(folder) as session:
        record = session.note(text)
    say(f"Noted by {record.entry.by or '-'} at {record.entry.at}.")
    answer({"record": record.number, "by": record.entry.by, "at": record.entry.at})


@session_app.command(
    "set", example=("session set bench-1 devices.serial=M8128-0042 calibration.tip=[0,0,120]")
)
def set_parameters(folder: FolderArgument, settings: list[str], /) -> None:
    """Set parameters for computing results, opening devices and exporting bundles.

    Results computed with another value become stale.

    Parameters
    ----------
    settings : KIND.NAME=VALUE...
        Parameters, as JSON or text; null restores the default.
    """
    given = _report_checked(dict(_setting(text) for text in settings), settings)
    _refuse_unknown(given)
    with _writing(folder) as session:
        before = _stale_titles(session)
        records = [session.set_parameter(key, value) for key, value in given.items()]
        newly = sorted(_stale_titles(session) - before)
    say(f"Set {', '.join(given)}.")
    say_all((f"{title} is now stale: `contactbench session info` says why." for title in newly), "yellow")
    answer({"records": [record.number for record in records], "stale": newly})


def _refuse_unknown(keys: Iterable[str]) -> None:
    """Refuse a key that nothing reads, with what it may have been meant for."""
    from difflib import get_close_matches

    from contactbench.pipeline.config.runtime.options import ExportOptions
    from contactbench.pipeline.session.recompute import RECOMPUTE

    models = {kind: each.parameters for kind, each in RECOMPUTE.items()} | {"config": ExportOptions}
    known = {
        f"{kind}.{name}" for kind, model in models.items() for name in model.model_fields if name != "name"
    }
    known |= {f"devices.{name}" for name in ("serial", "sensor", "poses", "mount", "max_tilt")}
    known.add("outputs.addresses")
    for key in keys:
        if "." in key and key not in known:
            near = get_close_matches(key, known, 3, 0.5) or sorted(
                {each.partition(".")[0] + ".*" for each in known}
            )
            raise InputError(f"{key}: nothing reads this setting. Did you mean {', '.join(near)}?")


def _report_checked(given: dict[str, Any], settings: list[str]) -> dict[str, Any]:
    """Return parameters with those of a report as text, as they were typed; InputError: no report could say one."""
    from contactbench.pipeline.settings import ReportSettings

    typed = {text.partition("=")[0]: text.partition("=")[2] for text in settings}
    said = {
        name: value if isinstance(value, str) else typed[f"report.{name}"]
        for name in ReportSettings.model_fields
        if (value := given.get(f"report.{name}")) is not None
    }
    try:
        ReportSettings.checked(said)
    except InputError as error:
        raise InputError(str(error).replace("parameter ", "parameter report.", 1)) from error
    return given | {f"report.{name}": value for name, value in said.items()}


@session_app.command(example="session rezero bench-1 --serial M8128-0042 --reason 'new cable'")
def rezero(folder: FolderArgument, /, serial: str, reason: str) -> None:
    """Note that a sensor was re-zeroed, by hand or by its box; results of older recordings become stale.

    Nothing is sent to the sensor.

    Parameters
    ----------
    serial
        Serial number of the sensor.
    reason
        Reason, in a few words.
    """
    with _writing(folder) as session:
        before = _stale_titles(session)
        record = session.rezeroed(serial, reason)
        newly = sorted(_stale_titles(session) - before)
    say(f"Noted by {record.entry.by or '-'} at {record.entry.at}: {serial} was re-zeroed.")
    say_all((f"{title} is now stale: `contactbench session info` says why." for title in newly), "yellow")
    answer({"record": record.number, "by": record.entry.by, "at": record.entry.at, "stale": newly})


@session_app.command(example="session replay bench-1")
def replay(folder: FolderArgument) -> None:
    """Recompute every result from raw inputs and compare the bytes. Exit code 1: one differs or fails."""
    from contactbench.pipeline.session import Session
    from contactbench.pipeline.session.recompute import ReplayOutcome
    from contactbench.pipeline.session.recompute import replay as run

    with Session.open(folder, write=False) as session, Bar("replaying", counted=True) as bar:
        found = run(session, bar)
    wrong = [each for each in found if each.outcome in {ReplayOutcome.DIFFERENT, ReplayOutcome.FAILED}]
    for each in found:
        say(each.sentence, "red" if each in wrong else "")
    same = sum(each.outcome is ReplayOutcome.SAME for each in found)
    say(f"{same} of {len(found)} results are identical, byte for byte.")
    answer({"same": same, "results": [vars(each) for each in found]}, good=not wrong)


def _writing(folder: Path) -> Session:
    from contactbench.pipeline.session import Session

    session = Session.open(folder)
    warn(session.notes)
    return session


def _stale_titles(session: Session) -> set[str]:
    return {" ".join(slot) for slot, reasons in session.stale().items() if reasons}

"""``contactbench session ...``: a folder that keeps every action, sample and result."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.session_keep import add_keeping_commands
from contactbench.pipeline.commands.session_record import FolderArgument, add_record_command
from contactbench.pipeline.console import Bar, JsonOption, print_json, say

if TYPE_CHECKING:
    from contactbench.pipeline.session import Session, State
    from contactbench.pipeline.session.state import Result

session_app = typer.Typer(
    help="Keep every action, sample and result of a bench session in one folder.",
    epilog="Example: contactbench session new bench-1",
    no_args_is_help=True,
    rich_markup_mode=None,
)

_WRONG = 1


@session_app.command(epilog="Example: contactbench session new bench-1")
def new(folder: FolderArgument, as_json: JsonOption = False) -> None:
    """Make a session in a folder that is new or empty."""
    from contactbench.pipeline.session import Session

    with Session.create(folder) as session:
        identity = session.state.id
    say(f"{folder}: a new session.")
    if as_json:
        print_json({"session": str(folder), "id": identity})


@session_app.command(
    epilog="Example: contactbench session add bench-1 poses.csv --kind poses --sensor M8128-0042"
)
def add(
    folder: FolderArgument,
    file: Annotated[Path, typer.Argument(metavar="FILE", help="File to copy into the session.")],
    kind: Annotated[
        str, typer.Option(help="What it is: mesh, poses, recording, ...; a mesh replaces the one before.")
    ],
    sensor: Annotated[
        str | None, typer.Option(help="Serial number of the sensor that it was recorded with.")
    ] = None,
    companion: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="FILE",
            help="File that belongs beside it; may be repeated. The JSON file of a probe is found by itself.",
        ),
    ] = None,
    name: Annotated[
        str | None, typer.Option(metavar="NAME", help="What it is called in the session [as the file].")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Copy a raw input into a session; what was computed from one that it replaces becomes stale."""
    from contactbench.pipeline.session.actions import files_of
    from contactbench.pipeline.session.companions import about_of, companions_of

    beside, about = companions_of(file, companion or []), about_of(file)
    with _writing(folder) as session:
        before = _stale_titles(session)
        record = session.add_input(file, kind, name=name, sensor=sensor, companions=beside, about=about)
        newly = _stale_titles(session) - before
    ref, *others = files_of(record.action)
    say(f"{file} is kept as {ref.path}.")
    for name, other in zip(beside, others, strict=True):
        say(f"{name}, which belongs to it, is kept as {other.path}.")
    for title in sorted(newly):
        say(f"{title} is stale now: `contactbench session info` says why.", "yellow")
    if as_json:
        print_json(
            {
                "record": record.number,
                "file": ref.path,
                "sha256": ref.sha256,
                "size": ref.size,
                "companions": {name: other.path for name, other in zip(beside, others, strict=True)},
                "stale": sorted(newly),
            }
        )


@session_app.command(
    epilog="Example: contactbench session compute bench-1 calibration calibration.json --set euler=xyz"
)
def compute(
    folder: FolderArgument,
    kind: Annotated[
        str,
        typer.Argument(
            metavar="KIND",
            help="captures, from a recording; calibration, from poses; probe, from the mesh and, where there are some,"
            " an alignment and regions; known_weight, from a calibration and inputs unloaded and loaded; known_touch,"
            " from a calibration, a probe and an input touch; verification, from a recording, a probe, a calibration"
            " and markers; report, from a verification and its probe and, where there are some, its calibration and"
            " both checks.",
        ),
    ],
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the result's file.")],
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="NAME=VALUE",
            help="Parameter, as JSON or text; may be repeated. Others are those that `session set` or the window"
            " left for this kind.",
        ),
    ] = None,
    inputs: Annotated[
        list[str] | None,
        typer.Option(
            "--input",
            metavar="ROLE=NAME",
            help="Not the newest recording, poses or alignment, but this one; without a name: none.",
        ),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Compute a result from the newest inputs of its kind, raw or computed, and record it with all it follows from."""
    from contactbench.pipeline.session.actions import files_of
    from contactbench.pipeline.session.recompute import compute as run
    from contactbench.pipeline.session.recompute import newest_inputs, settings_of

    chosen = dict(_choice(text) for text in inputs or [])
    with _writing(folder) as session:
        given = settings_of(session.state, kind) | dict(_setting(text) for text in settings or [])
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
    for reason in stale:
        say(f"it is stale already: {reason}", "yellow")
    if as_json:
        print_json({"record": record.number, "files": files, "stale": list(stale)})


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


@session_app.command(epilog="Example: contactbench session info bench-1 --json")
def info(folder: FolderArgument, as_json: JsonOption = False) -> None:
    """Say what a session holds, and which results are stale and why; also while it is being written, or read-only.

    Of a damaged session, what is whole. Nothing is written. Exit code 1: it is damaged.
    """
    from contactbench.pipeline.session import Session

    with Session.open(folder, write=False, damaged=True) as session:
        state, stale, notes, damage = session.state, session.stale(), session.notes, session.damage
    if damage:
        say(f"{folder}: {damage}: `contactbench session salvage` copies all that is whole.", "red")
    for note in notes:
        say(f"warning: {note}", "yellow")
    say(f"Session {state.id}: {state.count} records.")
    for each in state.current_inputs.values():
        say(f"{each.kind} {each.name}: {each.file.size} bytes, {each.at}.")
    for slot, result in state.current_results.items():
        say(f"{result.title}: {_word(result, stale[slot])}, {result.at}.", "yellow" if stale[slot] else "")
        for reason in stale[slot]:
            say(f"  {reason}")
    if as_json:
        print_json(_facts(state, stale, notes) | {"damage": damage})
    if damage:
        raise typer.Exit(_WRONG)


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


@session_app.command(epilog="Example: contactbench session note bench-1 'new cable'")
def note(
    folder: FolderArgument,
    text: Annotated[str, typer.Argument(metavar="TEXT", help="A few words.")],
    as_json: JsonOption = False,
) -> None:
    """Write words into a session's journal, with who and when."""
    with _writing(folder) as session:
        record = session.note(text)
    say(f"Noted by {record.entry.by or '-'} at {record.entry.at}.")
    if as_json:
        print_json({"record": record.number, "by": record.entry.by, "at": record.entry.at})


@session_app.command(
    "set",
    epilog="Example: contactbench session set bench-1 devices.serial=M8128-0042 calibration.tip=[0,0,120]",
)
def set_parameters(
    folder: FolderArgument,
    settings: Annotated[
        list[str],
        typer.Argument(metavar="KIND.NAME=VALUE...", help="Parameters, as JSON or text; null: the default."),
    ],
    as_json: JsonOption = False,
) -> None:
    """Set parameters that results are computed with, devices are opened with and bundles are exported with.

    What was computed with another value becomes stale.
    """
    given = dict(_setting(text) for text in settings)
    with _writing(folder) as session:
        before = _stale_titles(session)
        records = [session.set_parameter(key, value) for key, value in given.items()]
        newly = sorted(_stale_titles(session) - before)
    say(f"Set {', '.join(given)}.")
    for title in newly:
        say(f"{title} is stale now: `contactbench session info` says why.", "yellow")
    if as_json:
        print_json({"records": [record.number for record in records], "stale": newly})


@session_app.command(
    epilog="Example: contactbench session rezero bench-1 --sensor M8128-0042 --reason 'new cable'"
)
def rezero(
    folder: FolderArgument,
    sensor: Annotated[str, typer.Option(help="Serial number of the sensor.")],
    reason: Annotated[str, typer.Option(help="Why, in a few words.")],
    as_json: JsonOption = False,
) -> None:
    """Record that a sensor's zero was moved, by hand or by its box; what rests on older recordings becomes stale.

    Nothing is sent to the sensor.
    """
    with _writing(folder) as session:
        before = _stale_titles(session)
        record = session.rezeroed(sensor, reason)
        newly = sorted(_stale_titles(session) - before)
    say(f"Noted by {record.entry.by or '-'} at {record.entry.at}: {sensor} was re-zeroed.")
    for title in newly:
        say(f"{title} is stale now: `contactbench session info` says why.", "yellow")
    if as_json:
        print_json({"record": record.number, "by": record.entry.by, "at": record.entry.at, "stale": newly})


@session_app.command(epilog="Example: contactbench session replay bench-1")
def replay(folder: FolderArgument, as_json: JsonOption = False) -> None:
    """Compute every result again from raw inputs and compare the bytes. Exit code 1: one differs or cannot be."""
    from contactbench.pipeline.session import Session
    from contactbench.pipeline.session.replay import Outcome
    from contactbench.pipeline.session.replay import replay as run

    with Session.open(folder, write=False) as session, Bar("replaying", counted=True) as bar:
        found = run(session, bar)
    wrong = [each for each in found if each.outcome in {Outcome.DIFFERENT, Outcome.FAILED}]
    for each in found:
        say(each.sentence, "red" if each in wrong else "")
    same = sum(each.outcome is Outcome.SAME for each in found)
    say(f"{same} of {len(found)} results are the same to the byte.")
    if as_json:
        print_json({"same": same, "results": [vars(each) for each in found]})
    if wrong:
        raise typer.Exit(_WRONG)


def _writing(folder: Path) -> Session:
    from contactbench.pipeline.session import Session

    session = Session.open(folder)
    for note in session.notes:
        say(f"warning: {note}", "yellow")
    return session


def _stale_titles(session: Session) -> set[str]:
    return {" ".join(slot) for slot, reasons in session.stale().items() if reasons}


add_record_command(session_app)
add_keeping_commands(session_app)

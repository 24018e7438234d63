"""``contactbench session ...``: a folder that keeps every action, sample and result."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pipeline.console import Bar, JsonOption, print_json, say

if TYPE_CHECKING:
    from pipeline.session import Session, State
    from pipeline.session.state import Result

session_app = typer.Typer(
    help="Keep every action, sample and result of a bench session in one folder.",
    epilog="Example: contactbench session new bench-1",
    no_args_is_help=True,
    rich_markup_mode=None,
)

_WRONG = 1

FolderArgument = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of the session.")]


@session_app.command(epilog="Example: contactbench session new bench-1")
def new(folder: FolderArgument, as_json: JsonOption = False) -> None:
    """Make a session in a folder that is new or empty."""
    from pipeline.session import Session

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
    as_json: JsonOption = False,
) -> None:
    """Copy a raw input into a session; what was computed from one that it replaces becomes stale."""
    from pipeline.session.actions import files_of

    with _writing(folder) as session:
        before = _stale_titles(session)
        record = session.add_input(file, kind, sensor=sensor)
        newly = _stale_titles(session) - before
    ref = files_of(record.action)[0]
    say(f"{file} is kept as {ref.path}.")
    for title in sorted(newly):
        say(f"{title} is stale now: `contactbench session info` says why.", "yellow")
    if as_json:
        print_json(
            {
                "record": record.number,
                "file": ref.path,
                "sha256": ref.sha256,
                "size": ref.size,
                "stale": sorted(newly),
            }
        )


@session_app.command(
    epilog="Example: contactbench session compute bench-1 calibration calibration.json --set euler=xyz"
)
def compute(
    folder: FolderArgument,
    kind: Annotated[
        str, typer.Argument(metavar="KIND", help="calibration, from poses; or probe, from the mesh.")
    ],
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the result's file.")],
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="Parameter, as JSON or text; may be repeated."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Compute a result from the newest poses or the mesh in use, and record it with all it follows from."""
    from pipeline.session.actions import files_of
    from pipeline.session.recompute import compute as run

    given = dict(_setting(text) for text in settings or [])
    with _writing(folder) as session:
        record = run(session, kind, name, _newest_inputs(session.state, kind), given)
    files = [ref.path for ref in files_of(record.action)]
    say(f"{kind} {name} is kept as {', '.join(files)}.")
    if as_json:
        print_json({"record": record.number, "files": files})


def _setting(text: str) -> tuple[str, Any]:
    name, equals, value = text.partition("=")
    if not name or not equals:
        raise typer.BadParameter(f"--set needs NAME=VALUE, not {text!r}.")
    try:
        return name, json.loads(value)
    except (ValueError, RecursionError):
        return name, value


def _newest_inputs(state: State, kind: str) -> dict[str, str]:
    from pipeline.session import SessionError

    role = {"calibration": "poses", "probe": "mesh"}.get(kind)
    if role is None:
        raise SessionError(f"{kind}: nothing here computes this kind of result: give calibration or probe.")
    found = [each for each in state.current_inputs.values() if each.kind == role]
    if not found:
        raise SessionError(f"there are no {role} in this session: add them with --kind {role}.")
    return {role: max(found, key=lambda each: each.number).file.sha256}


@session_app.command(epilog="Example: contactbench session info bench-1 --json")
def info(folder: FolderArgument, as_json: JsonOption = False) -> None:
    """Say what a session holds, and which results are stale and why; also while it is being written."""
    from pipeline.session import Session

    with Session.open(folder, write=False) as session:
        state, stale, notes = session.state, session.stale(), session.notes
    for note in notes:
        say(f"warning: {note}", "yellow")
    say(f"Session {state.id}: {state.count} records.")
    for each in state.current_inputs.values():
        say(f"{each.kind} {each.name}: {each.file.size} bytes, {each.at}.")
    for slot, result in state.current_results.items():
        say(
            f"{result.title}: {'STALE' if stale[slot] else 'holds'}, {result.at}.",
            "yellow" if stale[slot] else "",
        )
        for reason in stale[slot]:
            say(f"  {reason}")
    if as_json:
        print_json(_facts(state, stale, notes))


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
        "mark": result.marks[-1].mark if result.marks else None,
        "stale": list(reasons),
    }


@session_app.command(epilog="Example: contactbench session verify bench-1")
def verify(folder: FolderArgument, as_json: JsonOption = False) -> None:
    """Check the hash chain, every record, and size and content of every file. Exit code 1: something is wrong."""
    from pipeline.session.check import check

    with Bar("checking files", counted=True) as bar:
        found = check(folder, bar)
    for note in found.notes:
        say(f"note: {note}")
    for problem in found.problems:
        say(f"wrong: {problem}", "red")
    if found.sound:
        say(f"{folder}: {found.records} records and {found.files} files are what they were.", "green")
    if as_json:
        print_json({**vars(found), "sound": found.sound})
    if not found.sound:
        raise typer.Exit(_WRONG)


@session_app.command(epilog="Example: contactbench session repair bench-1")
def repair(folder: FolderArgument, as_json: JsonOption = False) -> None:
    """Cut an unfinished or damaged record off the journal's end, never a whole one; the journal as it was is kept."""
    from pipeline.session.check import repair as run

    done = run(folder)
    say(done.sentence)
    if as_json:
        print_json(vars(done))


@session_app.command(epilog="Example: contactbench session replay bench-1")
def replay(folder: FolderArgument, as_json: JsonOption = False) -> None:
    """Compute every result again from raw inputs and compare the bytes. Exit code 1: one differs or cannot be."""
    from pipeline.session import Session
    from pipeline.session.replay import Outcome
    from pipeline.session.replay import replay as run

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


@session_app.command(
    "export-archive", epilog="Example: contactbench session export-archive bench-1 --out bench-1.zip"
)
def export(
    folder: FolderArgument,
    out: Annotated[Path, typer.Option(help="Zip file to write.")],
    as_json: JsonOption = False,
) -> None:
    """Pack a session into one zip file, after checking it."""
    from pipeline.session.archive import export_archive

    count = export_archive(folder, out)
    say(f"{out}: {count} files.")
    if as_json:
        print_json({"out": str(out), "files": count})


@session_app.command(
    "import-archive", epilog="Example: contactbench session import-archive bench-1.zip --out bench-1"
)
def unpack(
    archive: Annotated[Path, typer.Argument(metavar="ZIP", help="What export-archive wrote.")],
    out: Annotated[Path, typer.Option(help="Folder to make.")],
    as_json: JsonOption = False,
) -> None:
    """Unpack a session into a new folder, checking every byte of it first."""
    from pipeline.session.archive import import_archive

    import_archive(archive, out)
    say(f"{out}: a whole session.")
    if as_json:
        print_json({"out": str(out)})


def _writing(folder: Path) -> Session:
    from pipeline.session import Session

    session = Session.open(folder)
    for note in session.notes:
        say(f"warning: {note}", "yellow")
    return session


def _stale_titles(session: Session) -> set[str]:
    return {" ".join(slot) for slot, reasons in session.stale().items() if reasons}

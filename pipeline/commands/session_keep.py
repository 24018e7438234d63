"""``contactbench session verify, repair, salvage, export-archive, import-archive``: what keeps a session whole."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contactbench.pipeline.commands.session_record import FolderArgument
from contactbench.pipeline.console import Bar, JsonOption, print_json, say

_WRONG = 1


def add_keeping_commands(app: typer.Typer) -> None:
    """Add them to the commands of a session."""
    app.command("verify", epilog="Example: contactbench session verify bench-1")(verify)
    app.command("repair", epilog="Example: contactbench session repair bench-1")(repair)
    app.command("salvage", epilog="Example: contactbench session salvage bench-1 --out bench-1-new")(salvage)
    app.command(
        "export-archive", epilog="Example: contactbench session export-archive bench-1 --out bench-1.zip"
    )(export)
    app.command(
        "import-archive", epilog="Example: contactbench session import-archive bench-1.zip --out bench-1"
    )(unpack)


def verify(folder: FolderArgument, as_json: JsonOption = False) -> None:
    """Check the hash chain, every record, and size and content of every file. Exit code 1: something is wrong."""
    from contactbench.pipeline.session.check import check

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


def repair(folder: FolderArgument, as_json: JsonOption = False) -> None:
    """Cut an unfinished or damaged record off the journal's end, and adopt recordings that ended abruptly.

    Never a whole record; the journal as it was is kept. Exit code 1: a recording could not be adopted.
    """
    from contactbench.pipeline.session.check import repair as run

    done = run(folder)
    for sentence in (done.sentence, *done.adopted):
        say(sentence)
    for sentence in done.left:
        say(sentence, "yellow")
    if as_json:
        print_json(vars(done))
    if done.left:
        raise typer.Exit(_WRONG)


def salvage(
    folder: FolderArgument,
    out: Annotated[
        Path | None, typer.Option(metavar="NEW", help="Folder to make [DIR-salvaged, beside DIR].")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Copy all that is whole in a damaged session into a new one, and mark what rests on the rest as stale.

    The damaged session is not changed. Exit code 1: a record or a file is lost.
    """
    from contactbench.pipeline.session.salvage import salvage as run

    with Bar("copying files", counted=True) as bar:
        done = run(folder, out, bar)
    for sentence in done.found:
        say(sentence, "yellow")
    for title, reasons in done.stale.items():
        say(f"{title} is stale: {reasons[0]}", "yellow")
    for place in done.unclaimed:
        say(
            f"{done.out / place} belongs to no record: if it is needed, `contactbench session add` it.",
            "yellow",
        )
    lost = "nothing is lost" if done.whole else "not everything could be saved"
    say(
        f"{done.out}: a new session with {done.records} records; {lost}.", "green" if done.whole else "yellow"
    )
    if as_json:
        print_json({**vars(done), "out": str(done.out)})
    if not done.whole:
        raise typer.Exit(_WRONG)


def export(
    folder: FolderArgument,
    out: Annotated[Path, typer.Option(help="Zip file to write.")],
    as_json: JsonOption = False,
) -> None:
    """Pack a session into one zip file, after checking it. Exit code 1: a recording that is being made is not in it."""
    from contactbench.pipeline.session.archive import export_archive

    done = export_archive(folder, out)
    for note in done.notes:
        say(f"note: {note}", "yellow")
    for place in done.left_out:
        say(f"{place} is not in it: this recording is being made.", "yellow")
    say(f"{out}: {done.files} files.")
    if as_json:
        print_json({"out": str(out), **vars(done)})
    if done.left_out:
        raise typer.Exit(_WRONG)


def unpack(
    archive: Annotated[Path, typer.Argument(metavar="ZIP", help="What export-archive wrote.")],
    out: Annotated[Path, typer.Option(help="Folder to make.")],
    as_json: JsonOption = False,
) -> None:
    """Unpack a session into a new folder, checking every byte of it first."""
    from contactbench.pipeline.session.archive import import_archive

    import_archive(archive, out)
    say(f"{out}: a whole session.")
    if as_json:
        print_json({"out": str(out)})

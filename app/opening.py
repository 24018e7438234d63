"""Opening a session for a window: what is done in a worker, and what is asked before.

The functions import what they need themselves, in a worker: the window is there before that is loaded.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import date
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import InputError, arg

if TYPE_CHECKING:
    from pathlib import Path

    from contactbench.pipeline.session import Session
    from contactbench.pipeline.workbench.desk import Desk
    from contactbench.pipeline.workbench.undo_history import UndoHistory

VIRTUAL_BENCH = "virtual://bench?probe=t-shape&sensor=paper"


@dataclass(frozen=True)
class OpenedSession:
    """A session that can be worked on."""

    desk: Desk
    unfinished: tuple[str, ...]  # Recordings in it whose making was cut short
    found: tuple[str, ...] = ()  # What its salvage found, in sentences
    # "damaged", "elsewhere" or "folder": why nothing can be added to it; empty if it can be
    why_read_only: str = ""
    history: UndoHistory | None = None  # What can be undone; None: nothing, for nothing can be added


@dataclass(frozen=True)
class OpeningProblem:
    """Why a session was not opened."""

    sentence: str
    readable: bool = False  # Whether it can be opened read-only nevertheless
    damaged: bool = False  # Whether a copy of what is whole may be made


def open_session(folder: Path, *, write: bool = True) -> OpenedSession:
    """
    Open a session, read-only where its folder cannot be written; waits for the disk.

    Parameters
    ----------
    folder : path
    write : bool
        False: read-only, also if it is damaged or open elsewhere.

    Raises
    ------
    SessionError
        It cannot be opened.
    """
    from contactbench.pipeline.session import Session, SessionReadOnlyError
    from contactbench.pipeline.session.files import unfinished
    from contactbench.pipeline.workbench.desk import Desk
    from contactbench.pipeline.workbench.undo_history import read_history

    try:
        session = Session.open(folder, write=write, damaged=not write)
    except SessionReadOnlyError:
        return open_session(folder, write=False)
    try:
        left = tuple(unfinished(folder)) if write else ()
        history = read_history(session) if write else None
        return OpenedSession(Desk(session), left, why_read_only=_why_read_only(session), history=history)
    except BaseException:
        session.close()
        raise


def new_session(folder: Path) -> OpenedSession:
    """Make a session in a folder that is new or empty. SessionError, InputError: it cannot be made."""
    from contactbench.pipeline.session import Session, SessionError
    from contactbench.pipeline.workbench.desk import Desk
    from contactbench.pipeline.workbench.undo_history import UndoHistory

    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise SessionError(
            f"{arg(folder.parent)}: the folder cannot be made ({arg(error)}): choose another place."
        ) from error
    return OpenedSession(Desk(Session.create(folder)), (), history=UndoHistory())


def virtual_session(folder: Path) -> OpenedSession:
    """Make, or open, a session whose devices are those of a virtual bench."""
    opened = open_session(folder) if (folder / "journal").exists() else new_session(folder)

    def equip(session: Session) -> None:
        for key in ("devices.sensor", "devices.poses"):
            if session.state.setting(key) != VIRTUAL_BENCH:
                session.set_parameter(key, VIRTUAL_BENCH)

    try:
        opened.desk.do(equip).result()
    except BaseException:
        opened.desk.close()
        raise
    return opened


def free_folder(parent: Path, name: str) -> Path:
    """Return a folder that does not exist yet: the name with today's date, and a number where there is one."""
    first = parent / f"{name} {date.today().isoformat()}"
    candidate, number = first, 2
    while candidate.exists():
        candidate = first.with_name(f"{first.name} ({number})")
        number += 1
    return candidate


def unpacked(archive: Path, parent: Path) -> OpenedSession:
    """Unpack a session archive into a new folder of `parent`, and open it. SessionError: it is none, or damaged."""
    from contactbench.pipeline.durable import make_folder
    from contactbench.pipeline.session.archive import import_archive

    folder = free_folder(parent, archive.stem)
    make_folder(parent)
    import_archive(archive, folder)
    return open_session(folder)


def salvaged(folder: Path, elsewhere: Path) -> OpenedSession:
    """
    Salvage a copy beside a damaged session, and open it.

    The copy goes into the folder `elsewhere` where nothing can be written beside the session. SessionError: there is
    nothing whole, or the copy cannot be written.
    """
    from contactbench.pipeline.session.check import salvage
    from contactbench.pipeline.session.lock import writable

    out = None
    if not writable(folder.absolute().parent):
        elsewhere.mkdir(parents=True, exist_ok=True)
        out = free_folder(elsewhere, f"{folder.name} salvaged")
    done = salvage(folder, out)
    return replace(open_session(done.out), found=done.found)


def opened_up_to_damage(folder: Path) -> OpenedSession:
    """Cut off all that follows the damage of a journal, which is kept beside, and open the session."""
    from contactbench.pipeline.session.check import repair

    done = repair(folder, up_to_damage=True)
    return replace(open_session(folder), found=(done.sentence, *done.left))


def _why_read_only(session: Session) -> str:
    from contactbench.pipeline.session.lock import written_now

    if session.writable:
        return ""
    if session.damage:
        return "damaged"
    return "elsewhere" if written_now(session.folder) else "folder"


def adopt(session: Session) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Take recordings into the session that were cut short; what was done, and what could not be."""
    from contactbench.pipeline.session.adoption import adopt_unfinished

    return adopt_unfinished(session)


def problem_with(error: BaseException) -> OpeningProblem | None:
    """Return why a session was not opened, in words; None for an error that nobody expected."""
    from contactbench.pipeline.session import JournalError, SessionLockedError

    if not isinstance(error, (InputError, OSError)):
        return None
    damaged = isinstance(error, JournalError)
    return OpeningProblem(str(error), damaged or isinstance(error, SessionLockedError), damaged)


def holds_session(folder: Path) -> bool:
    """Whether there is a session in a folder."""
    try:
        return (folder / "journal").is_file()
    except OSError:
        return False

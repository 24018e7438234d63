"""Opening a session for a window: what is done in a worker, and what is asked before.

The functions import what they need themselves, in a worker: the window is there before that is loaded.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from typing import TYPE_CHECKING

from pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from pipeline.session import Session
    from pipeline.workbench.desk import Desk

VIRTUAL_BENCH = "virtual://bench?probe=t-shape&sensor=paper"


@dataclass(frozen=True)
class Opened:
    """
    A session that can be worked on.

    Attributes
    ----------
    desk : Desk
    unfinished : tuple of str
        Recordings in it whose making was cut short.
    """

    desk: Desk
    unfinished: tuple[str, ...]


@dataclass(frozen=True)
class Problem:
    """
    Why a session was not opened.

    Attributes
    ----------
    sentence : str
    readable : bool
        Whether it can be looked at nevertheless.
    """

    sentence: str
    readable: bool


def open_session(folder: Path) -> Opened:
    """Open a session for writing; waits for the disk. SessionError: it cannot be."""
    from pipeline.session import Session
    from pipeline.session.files import unfinished
    from pipeline.workbench.desk import Desk

    session = Session.open(folder)
    try:
        return Opened(Desk(session), tuple(unfinished(folder)))
    except BaseException:
        session.close()
        raise


def new_session(folder: Path) -> Opened:
    """Make a session in a folder that is new or empty. SessionError, InputError: it cannot be made."""
    from pipeline.session import Session, SessionError
    from pipeline.workbench.desk import Desk

    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise SessionError(
            f"{folder.parent}: the folder cannot be made ({error}): choose another place."
        ) from error
    return Opened(Desk(Session.create(folder)), ())


def virtual_session(folder: Path) -> Opened:
    """Make, or open, a session whose devices are those of a virtual bench."""
    opened = open_session(folder) if (folder / "journal").exists() else new_session(folder)

    def equip(session: Session) -> None:
        for key in ("devices.sensor", "devices.poses"):
            setting = session.state.settings.get(key)
            if setting is None or setting.value != VIRTUAL_BENCH:
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


def adopt(session: Session) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Take recordings into the session that were cut short; what was done, and what could not be."""
    from pipeline.session.unfinished import adopt_unfinished

    return adopt_unfinished(session)


def damage(folder: Path, cancelled: Callable[[], bool]) -> tuple[str, ...]:
    """
    Look at every file of a session; for a worker. Returns what is not as it was written, in sentences.

    Nothing else would tell: a calibration of which one digit was changed on the disk is still a calibration.
    """
    from pipeline.session.check import check

    class _Stopped(Exception):  # noqa: N818 - no error
        pass

    def stop(_done: int, _all: int) -> None:
        if cancelled():
            raise _Stopped

    try:
        return check(folder, stop).problems
    except _Stopped:
        return ()


def problem_with(error: BaseException) -> Problem | None:
    """Return why a session was not opened, in words; None for an error that nobody expected."""
    from pipeline.session import SessionLockedError

    if not isinstance(error, (InputError, OSError)):
        return None
    return Problem(str(error), isinstance(error, SessionLockedError))


def holds_session(folder: Path) -> bool:
    """Whether there is a session in a folder."""
    try:
        return (folder / "journal").is_file()
    except OSError:
        return False


def description(folder: Path) -> str:
    """Return what is in a session, as lines; changes nothing. SessionError: it cannot be read."""
    from pipeline.session import Session

    with Session.open(folder, write=False) as session:
        state, stale = session.state, session.stale()
        lines = [str(folder), ""]
        lines += [f"input  {each.kind}  {each.name}  {each.at}" for each in state.inputs]
        for slot, why in stale.items():
            result = state.current_results[slot]
            lines.append(
                f"result  {result.title}  {result.at}" + (f"  stale: {' '.join(why)}" if why else "")
            )
        lines += [f"setting  {key} = {setting.value}" for key, setting in state.settings.items()]
        lines += [f"note  {note.text}" for note in state.notes]
        return "\n".join(lines + list(session.notes))

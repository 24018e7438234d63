"""Looking a session over without trusting any of it, and repairing what can be."""

from __future__ import annotations

import secrets
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.session import journal
from contactbench.pipeline.session.actions import files_of
from contactbench.pipeline.session.adoption import adopt_unfinished
from contactbench.pipeline.session.files import (
    UNFINISHED,
    file_problem,
    own_file,
    refuse_links,
    unclaimed,
    unfinished,
)
from contactbench.pipeline.session.journal import (
    JOURNAL,
    JournalError,
    JournalWriter,
    SessionError,
    read_journal,
    refuse_damage,
)
from contactbench.pipeline.session.lock import Lock
from contactbench.pipeline.session.remains import upright
from contactbench.pipeline.session.state import content_of, fold, origin_problems, sources_of
from contactbench.pipeline.session.store import Session

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from contactbench.pipeline.session.state import Content


@dataclass(frozen=True)
class Check:
    """What was found."""

    records: int  # Whole records
    files: int  # Files that they refer to
    problems: tuple[str, ...]  # What is wrong, in sentences
    notes: tuple[str, ...]  # What is worth knowing, but wrong with nothing

    @property
    def sound(self) -> bool:
        """Whether nothing is wrong."""
        return not self.problems


def check(folder: Path, progress: Callable[[int, int], None] | None = None) -> Check:
    """
    Check the hash chain, every record, and size and content of every file; changes nothing.

    Parameters
    ----------
    folder : path
    progress : callable, optional
        Takes the number of files that are done, and of all.

    Raises
    ------
    SessionError
        There is no session, or its journal cannot be read at all.
    """
    return check_journal(folder, read_journal(folder), progress)[0]


def check_journal(
    folder: Path, data: bytes, progress: Callable[[int, int], None] | None = None
) -> tuple[Check, Content | None]:
    """Check a session by the bytes of its journal, which may grow meanwhile; also return what they say."""
    try:
        content = content_of(folder, data)
        refuse_links(folder)
    except SessionError as error:
        return Check(len(journal.scan(data).frames), 0, (str(error),), ()), None
    refs = {(ref.path, ref.sha256): ref for record in content.records for ref in files_of(record.action)}
    problems = []
    for done, ref in enumerate(refs.values(), 1):
        if wrong := file_problem(folder, ref):
            problems.append(wrong)
        if progress is not None:
            progress(done, len(refs))
    problems += _others(folder, content)
    notes = [*content.notes, *_unreferenced(folder, {path for path, _ in refs}), *_inputs_lost(content)]
    return Check(len(content.records), len(refs), tuple(problems), tuple(notes)), content


def other_problems(folder: Path) -> tuple[str, ...]:
    """
    Say what is wrong with a session besides the files that its records refer to.

    Raises
    ------
    SessionError
        Its journal cannot be read at all.
    """
    try:
        return tuple(_others(folder, content_of(folder, read_journal(folder))))
    except JournalError as error:
        return (str(error),)


def _others(folder: Path, content: Content) -> list[str]:
    return [
        *(message(f"{arg(each)}.") for each in origin_problems(folder, content.origins)),
        *_no_recordings(folder),
    ]


def _inputs_lost(content: Content) -> list[str]:
    state = fold(content.records)
    sources = sources_of(state)
    lost = [each.title for each in state.results if any(source.lost for source in sources[each.number])]
    words = message(
        f"{arg(len(lost))} results were computed from inputs that no earlier record contains, such as"
        f" {arg(', '.join(lost[:1]))}."
    )
    return [words] if lost else []


def _no_recordings(folder: Path) -> list[str]:
    problems = []
    for place in unfinished(folder):
        try:
            own_file(folder / place)
        except SessionError as error:
            problems.append(str(error))
    return problems


def _unreferenced(folder: Path, known: set[str]) -> list[str]:
    extra = [each for each in unclaimed(folder, known) if not each.startswith(f"raw/{UNFINISHED}")]
    notes = [
        message(
            f"{arg(place)}: a recording in progress, or one that ended abruptly: `contactbench session"
            " repair` recovers the latter."
        )
        for place in unfinished(folder)
    ]
    if not extra:
        return notes
    return [
        *notes,
        message(
            f"{arg(len(extra))} files belong to no record, such as {arg(extra[0])}: left by a crash before their"
            " record was written."
        ),
    ]


@dataclass(frozen=True)
class Repair:
    """What a repair did."""

    sentence: str
    removed: int = 0  # Bytes taken off the journal's end
    kept_as: str = ""  # Name of the journal as it was; empty if nothing had to be done
    adopted: tuple[str, ...] = ()  # What became of recordings that ended abruptly, in sentences
    left: tuple[str, ...] = ()  # Why others stay where they are, in sentences


def repair(folder: Path, *, up_to_damage: bool = False) -> Repair:
    """
    Cut off what follows the last whole record, if no whole record follows it, and adopt recordings that ended abruptly.

    The journal as it was is kept beside.

    Parameters
    ----------
    folder : path
    up_to_damage : bool
        Cut off all that follows the damage, also whole records; see `ways_in` for what that is.

    Raises
    ------
    SessionError
        Another process writes the session, whole records follow the damage, or the disk fails.
    """
    done = _repair_journal(folder, up_to_damage=up_to_damage)
    if not unfinished(folder):
        return done
    with Session.open(folder) as session:
        adopted, left = adopt_unfinished(session)
    return replace(done, adopted=adopted, left=left)


def _repair_journal(folder: Path, *, up_to_damage: bool) -> Repair:
    read_journal(folder)  # no lock is left in a folder that is no session
    lock = Lock(folder)
    try:
        data = read_journal(folder)
        found = upright(folder, data) if up_to_damage else journal.scan(data)
        if not found.torn and not found.last and not (up_to_damage and found.damage and found.frames):
            refuse_damage(folder, found)
            return Repair(message("The journal is intact: nothing to repair."))
        if not found.frames:
            refuse_damage(folder, found)
        kept = f"{JOURNAL}.before-repair-{secrets.token_hex(4)}"
        write_durably(folder / kept, data)
        JournalWriter(folder, found).close()
    except OSError as error:
        raise SessionError(
            f"{arg(folder)}: the session cannot be repaired ({arg(error)}): free disk space or check the permissions."
        ) from error
    finally:
        lock.release()
    removed = len(data) - found.end
    what = found.torn or found.damage
    return Repair(
        message(
            f"{arg(what)}: {arg(removed)} bytes were cut off; the previous journal is kept as {arg(kept)}."
        ),
        removed,
        kept,
    )

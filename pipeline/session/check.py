"""Looking a session over without trusting any of it, and repairing what can be."""

from __future__ import annotations

import secrets
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pipeline.durable import write_durably
from pipeline.session import frames
from pipeline.session.actions import files_of
from pipeline.session.errors import SessionError
from pipeline.session.files import FOLDERS, wrong_with
from pipeline.session.journal import JOURNAL, JournalWriter, read_journal, refuse_damage
from pipeline.session.lock import Lock
from pipeline.session.migrate import origin_problems
from pipeline.session.reading import read_content
from pipeline.session.state import fold

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


@dataclass(frozen=True)
class Check:
    """
    What was found.

    Attributes
    ----------
    records : int
        Whole records.
    files : int
        Files that they refer to.
    problems : tuple of str
        What is wrong, in sentences.
    notes : tuple of str
        What is worth knowing, but wrong with nothing.
    """

    records: int
    files: int
    problems: tuple[str, ...]
    notes: tuple[str, ...]

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
    found = frames.scan(read_journal(folder))
    try:
        content = read_content(folder)
    except SessionError as error:
        return Check(len(found.frames), 0, (str(error),), ())
    refs = {(ref.path, ref.sha256): ref for record in content.records for ref in files_of(record.action)}
    problems = []
    for done, ref in enumerate(refs.values(), 1):
        if wrong := wrong_with(folder, ref):
            problems.append(f"{wrong}: take it from an archive, or add the original again.")
        if progress is not None:
            progress(done, len(refs))
    problems += [f"{each}." for each in origin_problems(folder, fold(content.records).origins)]
    notes = [*content.notes, *_unreferenced(folder, {path for path, _ in refs})]
    return Check(len(content.records), len(refs), tuple(problems), tuple(notes))


def _unreferenced(folder: Path, known: set[str]) -> list[str]:
    extra = [
        f"{name}/{file.name}"
        for name in FOLDERS
        for file in sorted((folder / name).glob("*"))
        if f"{name}/{file.name}" not in known
    ]
    if not extra:
        return []
    return [
        f"{len(extra)} files belong to no record, such as {extra[0]}: a crash before the record was written does that."
    ]


@dataclass(frozen=True)
class Repair:
    """
    What a repair did.

    Attributes
    ----------
    sentence : str
    removed : int
        Bytes taken off the journal's end.
    kept_as : str
        Name of the journal as it was; empty if nothing had to be done.
    """

    sentence: str
    removed: int = 0
    kept_as: str = ""


def repair(folder: Path) -> Repair:
    """
    Cut off what follows the last whole record, if no whole record follows it; the journal as it was is kept beside.

    Raises
    ------
    SessionError
        Another process writes the session, whole records follow the damage, or the disk fails.
    """
    lock = Lock(folder)
    try:
        data = read_journal(folder)
        found = frames.scan(data)
        if not found.torn and not found.last:
            refuse_damage(folder, found)
            return Repair("The journal is whole: nothing was done.")
        if not found.frames:
            refuse_damage(folder, found)
        kept = f"{JOURNAL}.before-repair-{secrets.token_hex(4)}"
        write_durably(folder / kept, data)
        JournalWriter(folder, found).close()
    except OSError as error:
        raise SessionError(
            f"{folder}: the session cannot be repaired ({error}): free space or check the rights."
        ) from error
    finally:
        lock.release()
    removed = len(data) - found.end
    what = found.torn or found.damage
    return Repair(
        f"{what}: {removed} bytes were cut off; the journal as it was is kept as {kept}.", removed, kept
    )

"""Looking a session over without trusting any of it, and repairing what can be."""

import secrets
import shutil
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from contactbench.pipeline.durable import sync_folder, write_durably
from contactbench.pipeline.errors import REPAIR, arg, message
from contactbench.pipeline.files import Progress, unheard
from contactbench.pipeline.session import journal
from contactbench.pipeline.session.actions import files_of
from contactbench.pipeline.session.adoption import adopt_unfinished
from contactbench.pipeline.session.files import (
    FOLDERS,
    UNFINISHED,
    chunks_of,
    digest_of,
    file_problem,
    own_file,
    refuse_links,
    unclaimed,
    unfinished,
    write_file,
    wrong_with,
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
from contactbench.pipeline.session.remains import Remains, doubts, note_of, remains_of, upright
from contactbench.pipeline.session.state import (
    Content,
    content_of,
    fold,
    origin_problems,
    original_of,
    sources_of,
)
from contactbench.pipeline.session.store import Session


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


def check(folder: Path, progress: Progress = unheard) -> Check:
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


def check_journal(folder: Path, data: bytes, progress: Progress = unheard) -> tuple[Check, Content | None]:
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
            f"{arg(place)}: a recording in progress, or one that ended abruptly: {arg(REPAIR)} to recover the latter."
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


# ---- A new session of all that is whole in a damaged one, which itself is never changed ----------


@dataclass(frozen=True)
class Salvage:
    """What a salvage gave."""

    out: Path  # The new session
    records: int  # Records of the damaged session that are in it
    whole: bool  # Nothing is lost
    found: tuple[str, ...]  # What is damaged, restored and lost, in sentences
    # Whole files of the new session that belong to no record: those of lost records
    unclaimed: tuple[str, ...]
    stale: Mapping[str, tuple[str, ...]]  # Title of each result that is stale in the new session -> why


def salvage(folder: Path, out: Path | None = None, progress: Progress = unheard) -> Salvage:
    """
    Write all that is whole in a session into a new one; whatever goes wrong, nothing is left of that.

    Parameters
    ----------
    folder : path
        The damaged session. A whole one is copied.
    out : path, optional
        Folder to make; left out, one beside it.
    progress : callable, optional
        Takes the number of files that are done, and of all.

    Raises
    ------
    SessionError
        There is no session, not one of its records is whole, it is of a newer version, or `out` is there already or
        cannot be written.
    """
    data = read_journal(folder)
    refuse_links(folder)
    out = _free_place(folder) if out is None else out
    _refuse_place(folder, out)
    remains = remains_of(folder, data)
    scratch = out.with_name(f".{out.name}.{secrets.token_hex(8)}.tmp")
    try:
        for place in (scratch, *(scratch / name for name in FOLDERS)):
            place.mkdir()
        wrong, extra = _copy(folder, scratch, remains, progress)
        write_durably(scratch / JOURNAL, remains.data)
        done = _settle(scratch, out, remains, wrong, extra)
        scratch.rename(out)
        sync_folder(out.absolute().parent)
    except OSError as error:
        raise SessionError(
            f"{arg(out)}: the copy cannot be written ({arg(error)}): choose another location with --out."
        ) from error
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    return done


def _free_place(folder: Path) -> Path:
    folder = folder.absolute()
    first = place = folder.with_name(f"{folder.name}-salvaged")
    number = 2
    while place.exists():
        place = first.with_name(f"{first.name}-{number}")
        number += 1
    return place


def _refuse_place(folder: Path, out: Path) -> None:
    try:
        taken = out.exists() or out.is_symlink()
        inside = out.resolve().is_relative_to(folder.resolve())
    except (OSError, ValueError, RuntimeError) as error:  # RuntimeError: links in a circle
        raise SessionError(
            f"{arg(out)}: a session cannot be made here ({arg(error)}): choose another location."
        ) from error
    if taken:
        raise SessionError(f"{arg(out)}: this already exists: choose another name.")
    if inside:
        raise SessionError(f"{arg(out)}: this is inside the damaged session: choose another location.")


def _copy(
    folder: Path, target: Path, remains: Remains, progress: Progress
) -> tuple[dict[str, str], tuple[str, ...]]:
    """Copy every whole file; return what is wrong with the others, and which belong to no record."""
    content = content_of(folder, remains.data)
    refs = {ref.path: ref for record in content.records for ref in files_of(record.action)}
    extra = [place for place in unclaimed(folder, refs) if _is_whole(folder, place)]
    wrong = {}
    for done, (place, ref) in enumerate(refs.items(), 1):
        # Read before it is copied: what cannot be read is the session's damage, and not the copy's.
        if why := wrong_with(folder, ref):
            wrong[place] = why
        else:
            write_file(target / place, chunks_of(folder / place))
        progress(done, len(refs))
    for place in extra:
        write_file(target / place, chunks_of(folder / place))
    for version in content.origins:
        if (original := original_of(folder, version)).is_file():
            write_durably(target / original.name, original.read_bytes())
    for name in FOLDERS:
        sync_folder(target / name)
    return wrong, tuple(place for place in extra if not place.startswith(f"raw/{UNFINISHED}"))


def _is_whole(folder: Path, place: str) -> bool:
    """Tell whether a file that no record speaks of is as it was stored, under its hash; unfinished recordings count."""
    name = place.partition("/")[2]
    try:
        sha256, _ = digest_of(own_file(folder / place))
    except (OSError, SessionError):
        return False
    return name.startswith((UNFINISHED, f"{sha256[:12]}-"))


def _settle(
    scratch: Path, out: Path, remains: Remains, wrong: Mapping[str, str], extra: tuple[str, ...]
) -> Salvage:
    """Write into the new session what is lost, and mark what rested on it."""
    found = (*remains.sentences, *(f"{why}." for why in wrong.values()))
    with Session.open(scratch) as session:
        records = len(session.records)
        marks = list(doubts(session.state, remains.losses, wrong))
        if found:
            session.note(note_of(found).text)
        for mark in marks:
            session.mark(mark.kind, mark.name, mark.mark, mark.reason)
        stale = {" ".join(slot): reasons for slot, reasons in session.stale().items() if reasons}
    return Salvage(out, records, not (remains.losses or wrong), found, extra, stale)

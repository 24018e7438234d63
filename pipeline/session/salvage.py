"""A new session of all that is whole in a damaged one, which itself is never changed."""

from __future__ import annotations

import secrets
import shutil
from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.durable import sync_folder, write_durably
from contactbench.pipeline.errors import arg
from contactbench.pipeline.session.actions import files_of
from contactbench.pipeline.session.files import (
    FOLDERS,
    UNFINISHED,
    chunks_of,
    digest_of,
    own_file,
    refuse_links,
    unclaimed,
    write_file,
    wrong_with,
)
from contactbench.pipeline.session.journal import JOURNAL, SessionError, read_journal
from contactbench.pipeline.session.remains import doubts, note_of, remains_of
from contactbench.pipeline.session.state import content_of, original_of
from contactbench.pipeline.session.store import Session

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from contactbench.pipeline.session.remains import Remains


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


def salvage(
    folder: Path, out: Path | None = None, progress: Callable[[int, int], None] | None = None
) -> Salvage:
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
    folder: Path, target: Path, remains: Remains, progress: Callable[[int, int], None] | None
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
        if progress is not None:
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

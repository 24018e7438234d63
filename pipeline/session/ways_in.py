"""The ways into a session whose journal is damaged, and what each of them costs; found out without changing it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.session import frames
from contactbench.pipeline.session.actions import VERSION, files_of, parse_payload, read_entry, records_of
from contactbench.pipeline.session.content import content_of
from contactbench.pipeline.session.errors import JournalError, SessionError
from contactbench.pipeline.session.files import wrong_with
from contactbench.pipeline.session.journal import read_journal
from contactbench.pipeline.session.migrate import version_of
from contactbench.pipeline.session.remains import doubts, remains_of
from contactbench.pipeline.session.state import fold

if TYPE_CHECKING:
    from pathlib import Path

    from contactbench.pipeline.session.state import State


@dataclass(frozen=True)
class WaysIn:
    """What is left of a damaged session."""

    damage: str  # What is wrong with its journal, in a sentence
    before: int  # Whole records before the damage; 0: it cannot be opened up to there
    after: int  # Whole records behind it
    behind: tuple[str, ...]  # What is only behind it, or is another there: kinds and names
    gaps: int  # Places at which at least one record is lost for good
    doubtful: tuple[str, ...]  # Results that a salvaged copy does not rely on: kinds and names
    files: tuple[str, ...]  # What is wrong with files, in sentences


def ways_in(folder: Path) -> WaysIn:
    """
    Look at a damaged session; reads all its files.

    Raises
    ------
    SessionError
        There is no session, not one record is whole, or it is of a newer version: there is no way in.
    """
    data = read_journal(folder)
    found = upright(folder, data)
    remains = remains_of(folder, data)
    content = content_of(folder, remains.data)
    state = fold(content.records)
    refs = {ref.path: ref for record in content.records for ref in files_of(record.action)}
    wrong = {place: why for place, ref in refs.items() if (why := wrong_with(folder, ref))}
    known = fold(records_of(found.frames)) if found.frames else fold(())
    return WaysIn(
        found.damage,
        len(found.frames),
        max(0, len(content.records) - len(found.frames)),
        _others(known, state),
        len(remains.losses),
        tuple(f"{mark.kind} {mark.name}" for mark in doubts(state, remains.losses, wrong)),
        tuple(f"{why}." for why in wrong.values()),
    )


def upright(folder: Path, data: bytes) -> frames.Scan:
    """
    Return the records of a journal up to its damage; also up to the first that is whole and yet no record.

    Empty where the journal is of an older version: what follows its damage cannot be told.
    """
    found = frames.scan(data)
    try:
        if not found.frames or version_of(folder, found) != VERSION:
            return frames.Scan((), 0, damage=found.damage or found.torn)
    except SessionError as error:
        return frames.Scan((), 0, damage=str(error))
    for number, frame in enumerate(found.frames, 1):
        try:
            read_entry(parse_payload(frame.payload, number), number)
        except JournalError as error:
            kept = found.frames[: number - 1]
            return frames.Scan(kept, frame.offset, damage=str(error))
    return found


def _others(before: State, after: State) -> tuple[str, ...]:
    """Return what only the second state has, or has otherwise."""
    known = {slot: each.content for slot, each in before.current_inputs.items()}
    made = {slot: each.content for slot, each in before.current_results.items()}
    set_ = {key: each.value for key, each in before.settings.items()}
    inputs = (each for slot, each in after.current_inputs.items() if known.get(slot) != each.content)
    results = (each for slot, each in after.current_results.items() if made.get(slot) != each.content)
    settings = (key for key, each in after.settings.items() if key not in set_ or set_[key] != each.value)
    return (
        *(each.title for each in results),
        *(f"{each.kind} {each.name}" for each in inputs),
        *settings,
    )

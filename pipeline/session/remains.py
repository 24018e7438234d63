"""
What is left of a damaged journal: every whole record, and the results that can no longer be relied on.

The chain of hashes tells more than where the damage is. It proves a record of which only the header or one bit of the
payload is damaged, puts records that were moved back into order, and tells junk between two records from a lost record.
"""

import hashlib
import zlib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import accumulate
from pathlib import Path

from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.session import journal
from contactbench.pipeline.session.actions import (
    VERSION,
    Note,
    Record,
    ResultMarked,
    SessionCreated,
    entry,
    files_of,
    parse_payload,
    payload_of,
    read_entry,
    records_of,
    user,
)
from contactbench.pipeline.session.files import wrong_with
from contactbench.pipeline.session.journal import (
    JournalError,
    JournalFrame,
    SessionError,
    read_journal,
    refuse_damage,
)
from contactbench.pipeline.session.state import (
    MESH,
    Content,
    InputSource,
    Result,
    State,
    content_of,
    fold,
    sources_of,
    version_of,
)

# A hostile journal must not keep anybody waiting: more is not tried.
_MENDED_BYTES, _MENDED_GAPS, _SORTED_RUNS = 8192, 50, 1000
_LONGEST_NOTE = 9000


@dataclass(frozen=True)
class Remains:
    """A journal of the records that are left."""

    data: bytes  # A whole journal, of the version of the damaged one
    losses: frozenset[int]  # Numbers of the records in it after which at least one is missing
    sentences: tuple[str, ...]  # What was found


def remains_of(folder: Path, data: bytes) -> Remains:
    """
    Gather what is left of a journal; of a whole one, all of it.

    Raises
    ------
    SessionError
        Not one record is whole, or the journal is of a newer version.
    """
    found, sentences, end_is_lost = _found(data)
    if not found:
        refuse_damage(folder, journal.scan(data))
    lines = _lines(found, sentences)
    counts = list(accumulate(map(len, lines)))
    losses = set(counts if end_is_lost else counts[:-1])
    payloads = [frame.payload for line in lines for frame in line]
    if _follows(journal.GENESIS, lines[0]):
        version = version_of(folder, journal.Scan(tuple(lines[0]), 0))
    else:
        identity = hashlib.sha256(data).hexdigest()[:32]
        payloads.insert(0, payload_of(entry(SessionCreated(id=identity), user(), None)))
        losses, version = {1, *(after + 1 for after in losses)}, VERSION
        sentences.append(message("The first record is lost, so the session gets a new identity."))
    if version == VERSION:  # what an older version wrote can only be read once it is migrated
        payloads, losses = _readable(payloads, losses, sentences)
    sentences += [
        message(f"At least one record is lost after record {arg(after)}.") for after in sorted(losses)
    ]
    return Remains(journal.encode_all(payloads), frozenset(losses), tuple(sentences))


def _found(data: bytes) -> tuple[list[JournalFrame], list[str], bool]:
    """Return the whole and mended records as they lie in the file, what to say, and whether the end is lost."""
    found: list[JournalFrame] = []
    sentences: list[str] = []
    at = gaps = 0
    while at < len(data):
        frame = journal.whole(data, at)
        if frame is not None:
            found.append(frame)
            at = frame.end
            continue
        gaps += 1
        follows = journal.next_whole(data, at + 1)
        end = len(data) if follows is None else follows
        before = found[-1].chain if found else journal.GENESIS
        following = None if follows is None else journal.whole(data, follows)
        if mended := _mended(data, at, end, before, following) if gaps <= _MENDED_GAPS else None:
            found.append(mended)
            sentences.append(
                message(f"The damaged record at byte {arg(at)} is restored; its hash proves it.")
            )
        elif follows is None and journal.unfinished(data, at):
            sentences.append(
                message(f"The record at byte {arg(at)} was never finished, so nothing relied on it.")
            )
        else:
            sentences.append(message(f"Bytes {arg(at)} to {arg(end - 1)} of the journal are damaged."))
            if follows is None:
                return found, sentences, True
        at = end
    return found, sentences, False


def _mended(
    data: bytes, at: int, end: int, before: bytes, following: JournalFrame | None
) -> JournalFrame | None:
    """Return the one damaged record between two places, if a hash proves what it was."""
    payload = data[at + journal.HEADER.size : end]
    if not 0 < len(payload) <= journal.LONGEST_PAYLOAD:
        return None
    _, _, checksum, chain, _ = journal.HEADER.unpack_from(data, at)
    digest = journal.chained(before, payload)
    if digest == chain or (following is not None and _follows(digest, [following])):
        return journal.JournalFrame(at, payload, digest)
    changed = bytearray(payload if len(payload) <= _MENDED_BYTES else b"")
    for bit in range(8 * len(changed)):
        changed[bit // 8] ^= 1 << bit % 8
        if zlib.crc32(changed) == checksum and journal.chained(before, bytes(changed)) == chain:
            return journal.JournalFrame(at, bytes(changed), chain)
        changed[bit // 8] ^= 1 << bit % 8
    return None


def _follows(chain: bytes, run: list[JournalFrame]) -> bool:
    return journal.chained(chain, run[0].payload) == run[0].chain


def _lines(found: list[JournalFrame], sentences: list[str]) -> list[list[JournalFrame]]:
    """Return the records once each, in the order in which they were written; between two lines, some are missing."""
    runs: list[list[JournalFrame]] = []
    seen: set[bytes] = set()
    for frame in found:
        if frame.chain in seen:
            sentences.append(
                message(f"The record at byte {arg(frame.offset)} appears twice; one copy is kept.")
            )
        elif runs and _follows(runs[-1][-1].chain, [frame]):
            runs[-1].append(frame)
        else:
            runs.append([frame])
        seen.add(frame.chain)
    following = _links(runs)
    heads = sorted(
        set(range(len(runs))) - set(following.values()),
        key=lambda head: (not _follows(journal.GENESIS, runs[head]), head),
    )
    lines = []
    for head in heads:
        line, at = [], head
        while at >= 0:
            line += runs[at]
            at = following.get(at, -1)
        lines.append(line)
    offsets = [frame.offset for line in lines for frame in line]
    if offsets != sorted(offsets):
        sentences.append(message("Records were out of order; their order was restored from their hashes."))
    return lines


def _links(runs: list[list[JournalFrame]]) -> dict[int, int]:
    """Return which run follows which, where one does."""
    following: dict[int, int] = {}
    for index, run in enumerate(runs[:_SORTED_RUNS]):
        for earlier, other in enumerate(runs[:_SORTED_RUNS]):
            if earlier not in following and earlier != index and _follows(other[-1].chain, run):
                following[earlier] = index
                break
    return following


def _readable(payloads: list[bytes], losses: set[int], sentences: list[str]) -> tuple[list[bytes], set[int]]:
    """Leave out what is whole and yet no record, as in a journal made by hand."""
    kept: list[bytes] = []
    moved: set[int] = set()
    for number, payload in enumerate(payloads, 1):
        try:
            read_entry(parse_payload(payload, len(kept) + 1), len(kept) + 1)
            kept.append(payload)
        except JournalError:
            moved.add(len(kept))
            sentences.append(
                message(f"The record after record {arg(len(kept))} cannot be read and is left out.")
            )
        if number in losses:
            moved.add(len(kept))
    return kept, moved


# ---- what rests on it ------------------------------------------------------------------------------


def doubts(state: State, losses: Collection[int], wrong: Mapping[str, str]) -> Iterator[ResultMarked]:
    """
    Yield the marks that keep results from being relied on after a loss.

    A lost record may have replaced an input or a result, set a parameter, rejected a result or told of a re-zeroed
    sensor. So a result holds only if it, and the recordings that it was computed from, came after the last loss. A
    result of which an input is in no record at all is stale by itself, and one that rests on a stale one, too.

    Parameters
    ----------
    state : State
        Of what is left.
    losses : collection of int
        See `Remains`.
    wrong : mapping
        Place of a file in the session -> what is wrong with it.
    """
    sources, last = sources_of(state), max(losses, default=0)
    for result in state.current_results.values():
        if result.mark is not None and result.mark.mark != "accepted":
            continue  # it does not hold anyway, and that mark says why
        reason = _doubt(result, sources[result.number], last, wrong)
        if reason:
            yield ResultMarked(kind=result.action.kind, name=result.action.name, mark="stale", reason=reason)


def _doubt(result: Result, sources: tuple[InputSource, ...], last: int, wrong: Mapping[str, str]) -> str:
    for ref in files_of(result.action):
        if ref.path in wrong:
            return message(f"its file {arg(wrong[ref.path])}; compute it again")
    if result.number <= last:
        return message("a later record is lost and may have changed its inputs; compute it again")
    for used in (each for source in sources for each in source.inputs):
        for ref in (used.file, *used.companions.values()):
            if ref.path in wrong:
                return message(
                    f"the {arg(used.kind)} {arg(used.name)} cannot be relied on, because {arg(wrong[ref.path])}"
                )
        if used.kind != MESH and used.number <= last:
            return message(
                f"a record after the {arg(used.kind)} {arg(used.name)} is lost and may have noted a"
                " re-zeroed sensor; compute it again unless you know that the sensor was not"
                " re-zeroed"
            )
    return ""


def note_of(sentences: Collection[str]) -> Note:
    """Return what a salvaged session's journal says of its salvage."""
    return Note(text=join(" ", (message("Salvaged from a damaged session."), *sentences))[:_LONGEST_NOTE])


def read_damaged(folder: Path) -> Content:
    """
    Read a session as its salvaged copy would hold it, apart from files, which nobody looks at; changes nothing.

    Raises
    ------
    SessionError
        There is no session, not one record is whole, or it is of a newer version.
    """
    data = read_journal(folder)
    found = journal.scan(data)
    if not found.damage:
        return content_of(folder, data)
    remains = remains_of(folder, data)
    content = content_of(folder, remains.data)
    records, by = list(content.records), user()
    added: list[Note | ResultMarked] = [note_of(remains.sentences)]
    added += doubts(fold(records), remains.losses, {})
    for action in added:
        made = entry(action, by, None)
        chain = journal.chained(bytes.fromhex(records[-1].hash), payload_of(made))
        records.append(Record(len(records) + 1, chain.hex(), made))
    return replace(content, records=tuple(records), notes=(*content.notes, *remains.sentences), found=found)


# ---- the ways in ----------------------------------------------------------------------------------


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
        tuple(message(f"{arg(why)}.") for why in wrong.values()),
    )


def upright(folder: Path, data: bytes) -> journal.Scan:
    """
    Return the records of a journal up to its damage; also up to the first that is whole and yet no record.

    Empty where the journal is of an older version: what follows its damage cannot be told.
    """
    found = journal.scan(data)
    try:
        if not found.frames or version_of(folder, found) != VERSION:
            return journal.Scan((), 0, damage=found.damage or found.torn)
    except SessionError as error:
        return journal.Scan((), 0, damage=str(error))
    for number, frame in enumerate(found.frames, 1):
        try:
            read_entry(parse_payload(frame.payload, number), number)
        except JournalError as error:
            kept = found.frames[: number - 1]
            return journal.Scan(kept, frame.offset, damage=str(error))
    return found


def _others(before: State, after: State) -> tuple[str, ...]:
    """Return what only the second state has, or has otherwise."""
    known = {slot: each.content for slot, each in before.current_inputs.items()}
    made = {slot: each.content for slot, each in before.current_results.items()}
    set_ = {key: each.value for key, each in before.settings.items()}
    inputs = (each for slot, each in after.current_inputs.items() if known.get(slot) != each.content)
    results = (each for slot, each in after.current_results.items() if made.get(slot) != each.content)
    settings = (key for key, each in after.settings.items() if key not in set_ or set_[key] != each.value)
    return (*(each.title for each in results), *(f"{each.kind} {each.name}" for each in inputs), *settings)

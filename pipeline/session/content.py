"""Reading a session without changing it."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.session import frames
from contactbench.pipeline.session.actions import (
    SCHEMA,
    VERSION,
    Origin,
    Record,
    parse_payload,
    records_of,
)
from contactbench.pipeline.session.errors import SchemaError, SessionError
from contactbench.pipeline.session.journal import JOURNAL, read_journal, refuse_damage
from contactbench.pipeline.session.state import fold

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    Payloads = list[dict[str, Any]]
    Migration = Callable[[Payloads], Payloads]

# version -> what makes the next version's payloads of all payloads of that one, the first with its new version.
# Version 2 has companions of inputs, and what is known about them: version 1 has neither, and needs no change.
MIGRATIONS: dict[int, Migration] = {1: lambda payloads: payloads}


def version_of(folder: Path, found: frames.Scan) -> int:
    """
    Return the version of a journal.

    Raises
    ------
    SchemaError
        It is newer than this program, or no session's.
    """
    first = parse_payload(found.frames[0].payload, 1)
    action = first.get("action")
    version = action.get("version") if isinstance(action, dict) else None
    if not isinstance(action, dict) or action.get("schema_id") != SCHEMA or type(version) is not int:
        raise SchemaError(
            f"{arg(folder / JOURNAL)}: its first record does not state {arg(SCHEMA)}: choose a session folder."
        )
    if version > VERSION:
        raise SchemaError(
            f"{arg(folder)}: the session has version {arg(version)}, but this contactbench knows at most"
            f" {arg(VERSION)}: use a newer contactbench. Nothing was changed."
        )
    return version


def migrated(folder: Path, data: bytes, found: frames.Scan, version: int) -> list[bytes]:
    """
    Return the payloads of an older journal as this version writes them; writes nothing.

    Raises
    ------
    SchemaError
        There is no way from that version to this one.
    """
    payloads = [parse_payload(frame.payload, number) for number, frame in enumerate(found.frames, 1)]
    for step in range(version, VERSION):
        if step not in MIGRATIONS:
            raise SchemaError(
                f"{arg(folder)}: the session has version {arg(version)}, too old for this contactbench: open"
                f" it with a contactbench that migrates version {arg(step)}."
            )
        payloads = MIGRATIONS[step](payloads)
    digest = hashlib.sha256(data[: found.end]).hexdigest()
    payloads[0]["action"] |= {"version": VERSION, "migrated_from": {"version": version, "sha256": digest}}
    return [frames.canonical(payload) for payload in payloads]


def kept_origins(folder: Path, found: frames.Scan) -> dict[int, str]:
    """
    Return what an older journal says is kept of the one before it: version -> SHA-256.

    Raises
    ------
    SchemaError
        What it says makes no sense.
    """
    said = parse_payload(found.frames[0].payload, 1)["action"].get("migrated_from")
    if said is None:
        return {}
    try:
        origin = Origin.model_validate(said)
    except ValidationError as error:
        raise SchemaError(
            f"{arg(folder / JOURNAL)}: its first record does not state the version it was migrated"
            " from: restore the session from a backup."
        ) from error
    return {origin.version: origin.sha256}


def original_of(folder: Path, version: int) -> Path:
    """Return where the journal of an older version is kept."""
    return folder / f"{JOURNAL}.v{version}"


def write_migrated(
    folder: Path, data: bytes, found: frames.Scan, version: int, payloads: list[bytes]
) -> None:
    """
    Keep the original beside, then replace the journal in one step; only for the holder of the lock.

    Raises
    ------
    SessionError
        It cannot be written: the old journal is still the journal.
    """
    try:
        write_durably(original_of(folder, version), data[: found.end])
        write_durably(folder / JOURNAL, frames.encode_all(payloads))
    except OSError as error:
        raise SessionError(
            f"{arg(folder)}: the session cannot be migrated to version {arg(VERSION)} ({arg(error)}): free disk"
            " space or check the permissions. The original is unchanged."
        ) from error


def origin_problems(folder: Path, origins: Mapping[int, str]) -> list[str]:
    """Say which kept originals are missing or changed; `origins` maps versions to hashes."""
    problems = []
    for version, sha256 in origins.items():
        file = original_of(folder, version)
        try:
            digest = hashlib.sha256(file.read_bytes()).hexdigest()
        except OSError as error:
            problems.append(
                message(f"{arg(file.name)}, the journal before its migration, cannot be read ({arg(error)})")
            )
            continue
        if digest != sha256:
            problems.append(message(f"{arg(file.name)}, the journal before its migration, was changed"))
    return problems


@dataclass(frozen=True)
class Content:
    """What a journal says."""

    records: tuple[Record, ...]
    notes: tuple[str, ...]  # What was noticed, in sentences
    found: frames.Scan  # Of the file as it is now
    # Version -> SHA-256 of the journals that the one on the disk says are kept beside it. One that was only
    # migrated in memory has kept nothing yet.
    origins: Mapping[int, str]


def read_content(folder: Path, *, settle: bool = False) -> Content:
    """
    Read a journal; one of an older version as this version would write it.

    Parameters
    ----------
    folder : path
    settle : bool
        Write the migrated journal, and keep the old one; only for the holder of the lock. A torn record at the
        end is left to `JournalWriter`.

    Raises
    ------
    SessionError
        No session, a damaged one, of a newer version or of one that cannot be migrated.
    """
    return content_of(folder, read_journal(folder), settle=settle)


def content_of(folder: Path, data: bytes, *, settle: bool = False) -> Content:
    """Read the bytes of a journal; see `read_content`."""
    found = frames.scan(data)
    refuse_damage(folder, found)
    notes = (
        [message(f"{arg(folder / JOURNAL)}: {arg(found.torn)}: {arg(_fate(settle))}")] if found.torn else []
    )
    version = version_of(folder, found)
    if version == VERSION:
        records = records_of(found.frames)
        return Content(records, tuple(notes), found, fold(records[:1]).origins)
    payloads = migrated(folder, data, found, version)
    renewed = frames.scan(frames.encode_all(payloads))
    records = records_of(renewed.frames)  # what could not be read again is not written
    if not settle:
        notes.append(
            message(f"{arg(folder)}: older version {arg(version)}; it will be migrated on the next write.")
        )
        return Content(records, tuple(notes), found, kept_origins(folder, found))
    write_migrated(folder, data, found, version, payloads)
    notes.append(
        message(
            f"{arg(folder)}: migrated from version {arg(version)} to {arg(VERSION)}; the previous journal is kept"
            f" as {arg(original_of(folder, version).name)}."
        )
    )
    return Content(records, tuple(notes), renewed, fold(records[:1]).origins)


def _fate(settle: bool) -> str:
    return (
        message("it was never confirmed and has been cut off.")
        if settle
        else message("it was never confirmed and has been left out.")
    )

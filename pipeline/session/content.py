"""Reading a session without changing it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.session import frames
from contactbench.pipeline.session.actions import VERSION, Record, records_of
from contactbench.pipeline.session.journal import JOURNAL, read_journal, refuse_damage
from contactbench.pipeline.session.migrate import (
    kept_origins,
    migrated,
    original_of,
    records_of_payloads,
    version_of,
    write_migrated,
)
from contactbench.pipeline.session.state import fold

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path


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
        return _content(records_of(found.frames), notes, found)
    payloads = migrated(folder, data, found, version)
    records = records_of_payloads(payloads)
    if settle:
        write_migrated(folder, data, found, version, payloads)
        notes.append(
            message(
                f"{arg(folder)}: migrated from version {arg(version)} to {arg(VERSION)}; the previous journal is kept"
                f" as {arg(original_of(folder, version).name)}."
            )
        )
        found = frames.scan(frames.encode_all(payloads))
    else:
        notes.append(
            message(f"{arg(folder)}: older version {arg(version)}; it will be migrated on the next write.")
        )
        return _content(records, notes, found, kept_origins(folder, found))
    return _content(records, notes, found)


def _content(
    records: tuple[Record, ...], notes: list[str], found: frames.Scan, origins: dict[int, str] | None = None
) -> Content:
    kept = fold(records[:1]).origins if origins is None else origins
    return Content(records, tuple(notes), found, kept)


def _fate(settle: bool) -> str:
    return (
        message("it was never confirmed and has been cut off.")
        if settle
        else message("it was never confirmed and has been left out.")
    )

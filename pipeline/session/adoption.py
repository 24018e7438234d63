"""Recordings whose process died: adopted by the session, with what is in them."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.recording import Event, RecordingError, RecordingReader, WrenchTrack
from contactbench.pipeline.recording.wire import MAGIC, PREFIX, Opcode
from contactbench.pipeline.session.errors import SessionError
from contactbench.pipeline.session.files import UNFINISHED, digest_of, own_file, unfinished, wrong_with
from contactbench.pipeline.session.live import RECORDING

if TYPE_CHECKING:
    from pathlib import Path

    from contactbench.pipeline.recording import RecordingInfo
    from contactbench.pipeline.session.store import Session

UNREADABLE = "unreadable"
_DESCRIPTION = (Opcode.HEADER, Opcode.METADATA, Opcode.SCHEMA, Opcode.CHANNEL)
_END_BYTES = 4
_LONGEST_SERIAL = 200


@dataclass(frozen=True)
class _Found:
    wrenches: int
    flanges: int
    started: str | None
    ended: datetime | None
    sensor: str | None
    warnings: tuple[str, ...]
    sound: bool

    @property
    def samples(self) -> int:
        return self.wrenches + self.flanges


def adopt_unfinished(session: Session) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """
    Make inputs of the recordings that ended abruptly; no sample of them is changed or lost.

    One that cannot be adopted stays where it is, and is in no other's way.

    Parameters
    ----------
    session : Session
        Open for writing: no one else is recording into it.

    Returns
    -------
    done, left : tuple of str
        What was done, and what could not be, in sentences.
    """
    done, left = [], []
    for place in unfinished(session.folder):
        try:
            done.append(_adopt(session, session.folder / place))
        except (InputError, OSError) as error:
            left.append(message(f"{arg(place)} was left in place: {arg(error)}"))
    return tuple(done), tuple(left)


def _adopt(session: Session, file: Path) -> str:
    name = file.name.removeprefix(UNFINISHED)
    if not own_file(file).stat().st_size:
        return _remove(
            file, message(f"The recording {arg(name)} never started: its empty file has been removed.")
        )
    digest, _ = digest_of(file)
    same = [each.file for each in session.state.inputs if each.file.sha256 == digest]
    if any(not wrong_with(session.folder, each) for each in same):
        return _remove(
            file,
            message(
                f"The recording {arg(name)} is already in the session: its duplicate name has been removed."
            ),
        )
    try:
        found = _look(file)
    except RecordingError as error:
        return _keep_unreadable(session, file, name, str(error))
    if not found.samples and not _only_begun(file, sound=found.sound):
        # A chunk that is damaged or cut may have held samples: somebody else may be able to read them.
        return _keep_unreadable(
            session, file, name, join(" ", (message("No sample is readable."), *found.warnings))
        )
    if not found.samples:
        words = message(f"The recording {arg(name)} ended abruptly before its first sample and was not kept.")
        session.note(words)
        return _remove(file, words)
    ended = message("an unknown time") if found.ended is None else found.ended.isoformat()
    about: dict[str, Any] = {
        "started": found.started,
        "ended_abruptly": None if found.ended is None else ended,
        "wrenches": found.wrenches,
        "flanges": found.flanges,
    }
    session.adopt(file, RECORDING, name=name, sensor=found.sensor, about=about)
    words = message(f"The recording {arg(name)} ended abruptly at {arg(ended)}; recovered with")
    words += message(f" {arg(found.wrenches):,} wrenches and {arg(found.flanges):,} flange poses.")
    session.note(words, sensor=found.sensor)
    return words


def _keep_unreadable(session: Session, file: Path, name: str, why: str) -> str:
    about: dict[str, Any] = {"ended_abruptly": None, "problem": why}
    session.adopt(file, UNREADABLE, name=name, sensor=None, about=about)
    return message(f"The recording {arg(name)} cannot be read and is kept unchanged: {arg(why)}")


def _only_begun(file: Path, *, sound: bool) -> bool:
    """Tell whether nothing but the description of a recording is in a file; `sound`: it was closed, and is whole."""
    size = file.stat().st_size
    with file.open("rb") as stream:
        at = len(stream.read(len(MAGIC)))
        while at < size:
            head = stream.read(PREFIX.size)
            if len(head) < PREFIX.size:
                return False
            opcode, length = PREFIX.unpack(head)
            at += PREFIX.size + length
            if opcode == Opcode.DATA_END and length == _END_BYTES:  # closed; then comes the table of contents
                return sound
            if opcode not in _DESCRIPTION or at > size:
                return False
            stream.seek(at)
    return True


def _look(file: Path) -> _Found:
    """Count what can be read."""
    wrenches = flanges = 0
    last: float | None = None
    with RecordingReader(file) as reader:
        for _, block in reader.blocks():
            if isinstance(block, Event):
                continue
            if isinstance(block, WrenchTrack):
                wrenches += len(block.times)
            else:
                flanges += len(block.times)
            latest = float(block.times.max())
            last = latest if last is None else max(last, latest)
        serials = [each.serial for each in reader.info.devices if each.kind == "wrench" and each.serial]
        info, warnings = reader.info, tuple(reader.warnings)
        sound = reader.complete and not warnings
    ended = None if last is None else _moment(info, last)
    serial = serials[0][:_LONGEST_SERIAL] if serials else None
    started = _moment(info, info.clock)
    began = None if started is None else started.isoformat()
    return _Found(wrenches, flanges, began, ended, serial, warnings, sound)


def _moment(info: RecordingInfo, moment: float) -> datetime | None:
    """Return a moment of the samples' clock; None for one that no calendar has, in a damaged file."""
    try:
        return datetime.fromtimestamp(info.log_time(moment) / 1e9, UTC)
    except (ValueError, OverflowError, OSError):
        return None


def _remove(file: Path, words: str) -> str:
    try:
        file.unlink()
    except OSError as error:
        raise SessionError(
            f"{arg(file)}: the file cannot be removed ({arg(error)}): check the permissions."
        ) from error
    return words

"""Recordings whose process died: adopted by the session, with what is in them."""

import re
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from contactbench.pipeline.devices.stream import Health
from contactbench.pipeline.errors import REPAIR, InputError, arg, join, message
from contactbench.pipeline.recording import (
    Event,
    RecordingError,
    RecordingInfo,
    RecordingReader,
    RecordingWriter,
    WrenchTrack,
)
from contactbench.pipeline.recording.recorder import Recorder
from contactbench.pipeline.recording.wire import MAGIC, PREFIX, Opcode
from contactbench.pipeline.session.actions import Record
from contactbench.pipeline.session.files import UNFINISHED, digest_of, own_file, unfinished, wrong_with
from contactbench.pipeline.session.journal import SessionError
from contactbench.pipeline.session.state import State
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
        sound = reader.complete and len(warnings) == len(reader.steps.told())  # a clock may be set
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


# ---- A recording made inside a session -----------------------------------------------------------


RECORDING = "recording"
_NAME = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9._-]{0,80}\.mcap")


def next_recording(state: State, folder: Path, stem: str) -> str:
    """Return the first name ``STEM-NUMBER.mcap`` that neither the session nor its folder has."""
    known = {each.name for each in state.inputs} | {
        file.name.removeprefix(UNFINISHED) for file in (folder / "raw").glob(f"{UNFINISHED}*")
    }
    number = 1
    while f"{stem}-{number}.mcap" in known:
        number += 1
    return f"{stem}-{number}.mcap"


class LiveRecording:
    """
    A recording in a session's folder.

    Use it in a ``with`` statement around the streams, then `keep` it. Whatever happens before that, the samples are
    in ``raw/unfinished-...``, half a second behind, and `repair` adopts them.

    Parameters
    ----------
    session : Session
        Open for writing.
    about : RecordingInfo
    sensor : str, optional
        Serial number of the sensor.
    name : str, optional
        Ends in .mcap; left out, with the time of the start.
    on_change, clock, patient : optional
        See `Recorder`.

    Attributes
    ----------
    name : str
    recorder : Recorder
        Takes the samples.

    Raises
    ------
    SessionError, RecordingError
        The name does not do or is taken, the session is open for reading only, or the disk fails.
    """

    def __init__(
        self,
        session: Session,
        about: RecordingInfo,
        *,
        sensor: str | None = None,
        name: str | None = None,
        on_change: Callable[[str, Health], None] | None = None,
        clock: Callable[[], float] = time.monotonic,
        patient: bool = False,
    ) -> None:
        started = datetime.fromtimestamp(about.started_ns / 1e9, UTC)
        self.name = f"recording-{started:%Y%m%dT%H%M%S%f}Z.mcap" if name is None else name
        if not _NAME.fullmatch(self.name):
            raise SessionError(
                f"{arg(repr(self.name)[:100])}: the name of a recording may have letters, digits, - and _,"
                " and must end in .mcap: choose another name."
            )
        self._session, self._sensor, self._started = session, sensor, started
        self._file = session.folder / "raw" / f"{UNFINISHED}{self.name}"
        session.check_writable()
        self._refuse_known()
        self._writer = RecordingWriter(self._file, about)
        try:
            # With who and when: all that would be lost of it otherwise, should this process die.
            session.note(
                message(f"Recording {arg(self.name)} started: {arg(_devices(about))}."), sensor=sensor
            )
        except BaseException:
            with suppress(RecordingError):  # the first error is the one to show
                self._writer.close()
            self._file.unlink(missing_ok=True)
            raise
        self.recorder = Recorder(self._writer, on_change, clock=clock, patient=patient)

    def _refuse_known(self) -> None:
        if (RECORDING, self.name) in self._session.state.current_inputs:
            raise SessionError(
                f"{arg(self.name)}: the session already has a recording with this name: choose another"
                " name. Recordings are never overwritten."
            )
        if self._file.exists() or self._file.is_symlink():
            raise SessionError(
                f"{arg(self._file)}: a recording with this name ended abruptly: {arg(REPAIR)} to recover it, or"
                " choose another name."
            )

    def __enter__(self) -> Self:
        self.recorder.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.recorder.__exit__(kind, error, trace)
        if error is not None or self.recorder.error is not None:
            with suppress(RecordingError):  # the first error is the one to show
                self._writer.close()
        else:
            self._writer.close()

    def keep(self, streams: Mapping[str, Mapping[str, Any]]) -> Record:
        """
        Record it in the journal.

        Parameters
        ----------
        streams : mapping
            Device -> counters of its stream, JSON values.

        Raises
        ------
        SessionError
            It cannot be; `repair` adopts it later.
        """
        about: dict[str, Any] = {
            "started": self._started.isoformat(),
            "ended": datetime.now(UTC).isoformat(),
            "streams": {device: dict(facts) for device, facts in streams.items()},
            "suspicions": [{"time": moment, "what": what} for moment, what in self.recorder.suspicions],
            "skipped": self.recorder.skipped,
            "dropped": self.recorder.dropped,
        }
        if self.recorder.error is not None:
            about["problem"] = str(self.recorder.error)
        return self._session.adopt(self._file, RECORDING, name=self.name, sensor=self._sensor, about=about)

    def discard(self, why: str = message("ended without a sample")) -> None:
        """Delete it: nothing came, or nobody wants it. The journal says so."""
        self._session.note(
            message(f"The recording {arg(self.name)} {arg(why)} and was not kept."), sensor=self._sensor
        )
        self._file.unlink(missing_ok=True)


def _devices(about: RecordingInfo) -> str:
    return ", ".join(
        " ".join(part for part in (device.address, device.model, device.serial) if part)
        for device in about.devices
    )

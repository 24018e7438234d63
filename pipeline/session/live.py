"""A recording made inside a session: on the disk while it happens, in the journal when it ends."""

from __future__ import annotations

import re
import time
from contextlib import suppress
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.recording import RecordingError, RecordingWriter
from contactbench.pipeline.recording.recorder import Recorder
from contactbench.pipeline.session.errors import SessionError
from contactbench.pipeline.session.files import UNFINISHED

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path
    from types import TracebackType
    from typing import Self

    from contactbench.pipeline.devices.stream import Health
    from contactbench.pipeline.recording import RecordingInfo
    from contactbench.pipeline.session.actions import Record
    from contactbench.pipeline.session.state import State
    from contactbench.pipeline.session.store import Session

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
                f"{arg(self._file)}: a recording with this name ended abruptly: recover it with"
                " `contactbench session repair`, or choose another name."
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

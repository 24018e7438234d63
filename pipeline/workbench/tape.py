"""A recording of what is live, in the session: on the disk while it happens, and an input when it is kept."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from typing import Any

from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.devices.stream import Health, StreamState
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.recording.recorder import health_facts
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.actions import Record
from contactbench.pipeline.session.adoption import LiveRecording
from contactbench.pipeline.streams import Pair
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.live import Live, Tap

_NAMES = {"sensor": message("The sensor"), "robot": message("The source of poses")}


class SessionTape:
    """
    One recording that is being made; see `start`.

    Unplugged devices end nothing: what comes when they are back goes on in the same recording. When the disk fails,
    `error` says so, and what was written before can be kept.

    Attributes
    ----------
    name : str
        Of the recording.
    """

    def __init__(self, desk: Desk, recording: LiveRecording, pair: Pair) -> None:
        self.name = recording.name
        self._desk, self._recording, self._pair = desk, recording, pair
        self._before = pair.healths
        self._health: dict[str, Health] = {}
        self.samples, self._poses, self._first, self._last = 0, 0, 0.0, 0.0
        self._end: Callable[[], None] = lambda: None
        self._ended = self._cut = False
        self._ending = threading.Lock()

    @classmethod
    def start(cls, desk: Desk, live: Live, name: str | None = None) -> Future[SessionTape]:
        """
        Begin to record what comes from now on, by the sensor whose serial number is in the session.

        Parameters
        ----------
        desk : Desk
        live : Live
        name : str, optional
            Ends in .mcap; left out, with the time of the start.

        Returns
        -------
        Future
            Of the tape; of InputError: nothing is open, the name is taken, or the disk fails.
        """
        return desk.do(lambda session: cls._begin(desk, session, live, name))

    @classmethod
    def _begin(cls, desk: Desk, session: Session, live: Live, name: str | None) -> SessionTape:
        pair = live.pair
        if pair is None:
            raise InputError("No device is open, so nothing can be recorded: choose devices first.")
        known = session.state.setting("devices.serial")
        serial = str(known) if known else None
        about = pair.about(serial=serial)
        recording = LiveRecording(
            session, about, sensor=serial, name=name, clock=pair.now, patient=pair.stepwise
        )
        tape = cls(desk, recording, pair)
        recording.__enter__()  # its end is that of the tape
        tape._end = live.tap(Tap(tape._wrenches, tape._flanges, tape._tell, tape._closed))
        return tape

    # ---- how it goes -------------------------------------------------------------------------------

    @property
    def seconds(self) -> float:
        """Time from the first wrench to the newest one, s."""
        return self._last - self._first

    @property
    def error(self) -> str | None:
        """Why nothing more is written, such as a full disk; what was written before is kept. None: all is well."""
        failed = self._recording.recorder.error
        return None if failed is None else message(f"{arg(failed)} Everything recorded until then is safe.")

    @property
    def findings(self) -> tuple[str, ...]:
        """What is wrong now, in sentences."""
        said = [self.error] if self.error else []
        for device, health in tuple(self._health.items()):
            if health.state in {StreamState.SILENT, StreamState.LOST}:
                said.append(
                    message(
                        f"{arg(_NAMES[device])} sends nothing: the recording waits and resumes automatically."
                    )
                )
            said += [*health.findings, *health.suspicions]
        if self._recording.recorder.dropped:
            said.append(
                message(
                    "The disk is too slow, so samples are missing in the recording. Record to another disk."
                )
            )
        if self._cut and not self._ended:
            said.append(message("The devices were closed: the recording ends there."))
        return tuple(dict.fromkeys(said))

    # ---- its end -----------------------------------------------------------------------------------

    def keep(self) -> Future[Record]:
        """
        End it, and make it an input of the session.

        Returns
        -------
        Future
            Of the record; of InputError: there is not one sample (it is discarded), or the disk fails (the file
            stays, and `contactbench session repair` adopts it).
        """
        return self._desk.do(self._keep)

    def discard(self) -> Future[None]:
        """End it, and delete what was recorded; the journal says so."""
        return self._desk.do(self._discard)

    def _keep(self, session: Session) -> Record:  # noqa: ARG002 - the recording knows it
        self._stop()
        if not self.samples:
            self._recording.discard()
            raise InputError(
                f"{arg(self.name)}: no sample arrived, so nothing was kept: check that the sensor sends"
                " samples, then start again."
            )
        return self._recording.keep(self._facts())

    def _discard(self, session: Session) -> None:  # noqa: ARG002 - the recording knows it
        self._stop()
        self._recording.discard(message(f"was abandoned, with {arg(self.samples):,} samples"))

    def _stop(self) -> None:
        with self._ending:
            if self._ended:
                raise InputError(f"{arg(self.name)}: this recording has already ended.")
            self._ended = True
        self._end()
        self._recording.__exit__(None, None, None)

    def _facts(self) -> dict[str, dict[str, Any]]:
        """Return the counters of the streams, of the time of this recording."""
        facts, counts = {}, {"sensor": self.samples, "robot": self._poses}
        for device, health in self._pair.healths.items():
            before = health_facts(self._before[device])
            now = {**health_facts(health), "samples": counts[device]}
            for count in ("lost", "bad_checksums", "skipped_bytes", "reconnected"):
                now[count] -= before[count]
            facts[device] = now
        return facts

    # ---- in the streams' threads -------------------------------------------------------------------

    def _wrenches(self, samples: Sequence[WrenchSample]) -> None:
        if not samples or self._ended:
            return
        if not self.samples:
            self._first = samples[0].time
        self._last = samples[-1].time
        self.samples += len(samples)
        self._recording.recorder.samples(samples)

    def _flanges(self, samples: Sequence[FlangeSample]) -> None:
        if not self._ended:
            self._poses += len(samples)
            self._recording.recorder.poses(samples)

    def _tell(self, device: str, health: Health) -> None:
        self._health[device] = health
        if not self._ended:
            self._recording.recorder.health(device, health)

    def _closed(self) -> None:
        self._cut = True

"""Verifying at the bench: markers, touches as they happen, and the verdict that the recording gives."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session.live import next_recording
from contactbench.pipeline.session.recompute import laid_out
from contactbench.pipeline.verification.markers import with_normals
from contactbench.pipeline.workbench.markers import KIND
from contactbench.pipeline.workbench.markers import kept as read_kept
from contactbench.pipeline.workbench.verify_outcome import Outcome, judge_recording, outcome_of
from contactbench.pipeline.workbench.verify_settings import checked_parameters, parameters_of
from contactbench.pipeline.workbench.verify_touches import LiveTouches, TouchView, live_noise

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from contactbench.pipeline.calibration import GravityModel
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.session import Session, State
    from contactbench.pipeline.workbench.desk import Desk
    from contactbench.pipeline.workbench.live import Live
    from contactbench.pipeline.workbench.markers import Markers
    from contactbench.pipeline.workbench.tape import Tape

_NOISE_S, _PATIENCE_S = 1.0, 5.0


@dataclass(frozen=True, eq=False)
class Tool:
    """
    What touches are located with.

    Attributes
    ----------
    probe : Probe
        S.
    model : GravityModel
    content : tuple of str
        Hashes of probe and calibration: other ones are another tool.
    """

    probe: Probe
    model: GravityModel
    content: tuple[str, str]


def tool_of(folder: Path, state: State) -> Tool:
    """
    Load a session's newest probe and calibration; for a worker.

    Raises
    ------
    InputError
        One is missing, refused or cannot be read.
    """
    from contactbench.pipeline.calibration import Level
    from contactbench.pipeline.calibration.files.calibration_file import load_calibration
    from contactbench.pipeline.verification.result import load_surface

    content = tool_key(state)
    if content is None:
        raise InputError(why_locked(state))
    with laid_out(folder, state, dict(zip(("probe", "calibration"), content, strict=True))) as files:
        calibration = load_calibration(files["calibration"])
        probe = load_surface(files["probe"])
    if calibration.verdict.level is Level.REFUSE:
        raise InputError(
            "The calibration was refused: nothing verified with it would count. Calibrate again."
        )
    return Tool(probe, calibration.model, content)


def tool_key(state: State) -> tuple[str, str] | None:
    """Return the hashes of a session's newest probe and calibration; None: one is missing."""
    probe, calibration = state.newest("probe"), state.newest("calibration")
    return None if probe is None or calibration is None else (probe.content, calibration.content)


def why_locked(state: State, *kinds: str) -> str:
    """Say what is missing before touches can be located, of some kinds or of all; empty: nothing."""
    missing = [kind for kind in kinds or ("calibration", "probe") if state.newest(kind) is None]
    if not missing:
        return ""
    steps = {"calibration": "calibrate in step 2, Gravity", "probe": "prepare the probe in step 3, Probe"}
    todo = ", and ".join(steps[kind] for kind in missing)
    return f"A contact cannot be located without {' and '.join(missing)}: {todo}."


class VerifyWork:
    """
    A verification that goes on, or does not.

    Attributes
    ----------
    touches : LiveTouches or None
        None: nothing goes on.
    """

    def __init__(self, desk: Desk, live: Live) -> None:
        self._desk, self._live = desk, live
        self.touches: LiveTouches | None = None
        self._tape: Tape | None = None
        self._name = ""
        self._order: tuple[str, ...] = ()
        self._left_out: dict[str, str] = {}
        self._inputs: dict[str, str] = {}
        self._end: Callable[[], None] | None = None
        self._busy = threading.Lock()

    @property
    def going_on(self) -> bool:
        """Whether touches are followed."""
        return self.touches is not None

    @property
    def recording(self) -> bool:
        """Whether they are recorded."""
        return self._tape is not None

    @property
    def findings(self) -> tuple[str, ...]:
        """What is wrong with the devices or the disk while it is recorded, in sentences."""
        tape = self._tape
        return () if tape is None else tape.findings

    def start(self, tool: Tool, markers: Markers, cancelled: Callable[[], bool] = lambda: False) -> None:
        """
        Begin to follow and to record touches; waits for a second of samples, so call it in a worker.

        Raises
        ------
        InputError
            No device is open, a marker is off the probe, a setting is wrong, or the disk fails.
        """
        with self._busy:
            if self.touches is not None:
                return
            self._wait_for_devices(cancelled)
            if self._live.pair is None:
                raise InputError("No sensor is open: connect one in step 1, Devices, then start again.")
            settings = checked_parameters(parameters_of(self._desk.state)).settings()
            placed, _ = with_normals(markers.as_set(), tool.probe)
            self._inputs = self._used(tool, markers)
            noise = self._measured(cancelled)
            if noise is None:
                return
            touches = LiveTouches(tool.probe, tool.model, placed, settings, noise)
            self._record()
            self.touches = touches
            self._end = self._live.follow(touches.feed)

    def _used(self, tool: Tool, markers: Markers) -> dict[str, str]:
        """Return what the touches are judged with, by role: also if there is something newer when they are."""
        state = self._desk.do(lambda session: session.state).result()  # after all that waits to be written
        kept = state.newest(KIND)
        if kept is None or read_kept(self._desk.folder, state) != markers:
            raise InputError("The markers are not in the session yet: wait a moment, then start again.")
        probe, calibration = tool.content
        return {"probe": probe, "calibration": calibration, "markers": kept.content}

    def _wait_for_devices(self, cancelled: Callable[[], bool]) -> None:
        """Wait for devices that are just being opened, as when a session was opened a moment ago."""
        while self._live.pair is None and self._live.opening and not cancelled():
            time.sleep(0.05)

    def _measured(self, cancelled: Callable[[], bool]) -> Any:
        """Return the noise of the last second; None: it was cancelled."""
        until = time.monotonic() + _PATIENCE_S
        while not cancelled():
            _, raw, _ = self._live.history(_NOISE_S)
            if (found := live_noise(raw)) is not None:
                return found
            if time.monotonic() > until:
                raise InputError(
                    "No samples come from the sensor: check its cable and step 1, Devices, then start again."
                )
            time.sleep(0.05)
        return None

    def _record(self) -> None:
        from contactbench.pipeline.workbench.tape import Tape

        self._name = next_recording(self._desk.state, self._desk.folder, "verify")
        self._tape = Tape.start(self._desk, self._live, self._name).result()

    def _stop(self) -> TouchView | None:
        """End the following; returns what was seen last."""
        if self._end is not None:
            self._end()
            self._end = None
        touches, self.touches = self.touches, None
        if touches is None:
            return None
        touches.end()
        self._order, self._left_out = touches.order, touches.left_out
        return touches.view()

    def finish(self) -> Outcome | None:
        """
        Keep the recording, judge it, and make the report; waits, so call it in a worker.

        Raises
        ------
        InputError
            Nothing was touched, or the disk fails; the recording is kept.
        """
        with self._busy:
            seen = self._stop()
            tape, self._tape = self._tape, None
            if tape is None or seen is None:
                return None
            tape.keep().result()
            name, inputs = self._name, dict(self._inputs)
            given: dict[str, Any] = {"order": list(self._order)} if self._order else {}
            if self._left_out or parameters_of(self._desk.state).get("left_out"):
                given["left_out"] = self._left_out

            def judge(session: Session) -> Outcome | None:
                judge_recording(session, name, given, inputs)
                return outcome_of(session.folder, session.state, session.stale(), seen)

            return self._desk.do(judge).result()

    def discard(self) -> None:
        """End it, and throw the recording away; waits."""
        with self._busy:
            self._stop()
            tape, self._tape = self._tape, None
            if tape is not None:
                tape.discard().result()

    def abandon(self) -> None:
        """End it without judging: what was recorded is kept. For the end of a session; waits."""
        with self._busy:
            seen = self._stop()
            tape, self._tape = self._tape, None
            if tape is not None:
                touched = seen is not None and seen.last is not None and tape.samples
                (tape.keep() if touched else tape.discard()).result()

"""A known weight and a known point at the bench: readings as they happen, and what the session makes of them."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.calibration.stillness import StillnessDetector, StillState
from contactbench.pipeline.errors import InputError, message
from contactbench.pipeline.session.adoption import next_recording
from contactbench.pipeline.session.recompute import compute, newest_inputs
from contactbench.pipeline.verification.known_check import TOUCH, WEIGHT, CheckOutcome, read_check
from contactbench.pipeline.workbench.tape import SessionTape
from contactbench.pipeline.workbench.verify import REPORT

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from contactbench.pipeline.calibration import GravityModel
    from contactbench.pipeline.session import Session, State
    from contactbench.pipeline.workbench.desk import Desk
    from contactbench.pipeline.workbench.live import Live, LiveBlock

FILES = {WEIGHT: "known_weight.json", TOUCH: "known_touch.json"}
_PRESSED_N, _RELEASED_N = 3.0, 1.5
_HELD_S = 0.8  # of a press: the check needs a quarter of a second once it has settled
_PATIENCE_S = 30.0


@dataclass(frozen=True)
class KnownOutcome:
    """A check that the session has."""

    outcome: CheckOutcome
    sentence: str
    stale: str = ""  # Why it no longer holds; empty: it does
    parameters: Mapping[str, Any] = field(default_factory=dict)  # That it was computed with


def known_outcome(
    folder: Path, state: State, stale: Mapping[tuple[str, str], tuple[str, ...]], kind: str
) -> KnownOutcome | None:
    """
    Read the check that a session has; None: there is none.

    Raises
    ------
    InputError
        Its file cannot be read.
    """
    found = state.current_results.get((kind, FILES[kind]))
    if found is None or found.rejected:
        return None
    content = read_check(kind, folder / found.file.path)
    reasons = stale.get(found.slot, ())
    return KnownOutcome(
        CheckOutcome(content["outcome"]),
        content["sentence"],
        next(iter(reasons), ""),
        dict(found.action.parameters),
    )


class StillReading:
    """Waits for one still reading; `feed` is called in the streams' thread."""

    stem = "weight"

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._detector = StillnessDetector()
        self.state = StillState.STALE
        self.sentence = ""

    @property
    def done(self) -> bool:
        """Whether it is taken."""
        with self._lock:
            return bool(self._detector.captures)

    def feed(self, block: LiveBlock) -> None:
        """Take samples."""
        known = block.known
        if not known.any():
            return
        with self._lock:
            now = self._detector.update_block(block.times[known], block.wrenches[known], block.R_WS[known])
            self.state, self.sentence = now.state, now.sentence


class PressReading:
    """
    Waits for one press that is held for a while and let go; `feed` is called in the streams' thread.

    Parameters
    ----------
    model : GravityModel
    """

    stem = "point"

    def __init__(self, model: GravityModel) -> None:
        self._model = model
        self._began: float | None = None
        self.done, self.force, self.held = False, 0.0, 0.0

    @property
    def sentence(self) -> str:
        """What to do now."""
        if self.done:
            return message("The press is recorded.")
        if self._began is None:
            return message("Press the point with 5 to 15 N, hold for a second, then let go.")
        return message("Let go.") if self.held >= _HELD_S else message("Hold it steady.")

    def feed(self, block: LiveBlock) -> None:
        """Take samples."""
        known = np.isfinite(block.wrenches).all(axis=1) & np.isfinite(block.R_WS).all(axis=(1, 2))
        if not known.any() or self.done:
            return
        forces = self._model.compensate(block.R_WS[known], block.wrenches[known])[:, :3]
        for time, force in zip(
            block.times[known].tolist(), np.linalg.norm(forces, axis=1).tolist(), strict=True
        ):
            self.force = force
            if self._began is None and force >= _PRESSED_N:
                self._began = time
            elif self._began is not None and force < _RELEASED_N:
                self.done, self._began = self.held >= _HELD_S, None
                if self.done:
                    return
            self.held = 0.0 if self._began is None else time - self._began


class KnownChecks:
    """
    Records readings, and has the session compute the checks from them; everything here waits, so call it in a worker.

    Attributes
    ----------
    reading : StillReading or PressReading or None
        That goes on.
    """

    def __init__(self, desk: Desk, live: Live) -> None:
        self._desk, self._live = desk, live
        self.reading: StillReading | PressReading | None = None
        self._tape: SessionTape | None = None
        self._end: Callable[[], None] = lambda: None
        self._busy = threading.Lock()

    def start(self, reading: StillReading | PressReading) -> None:
        """
        Begin to record.

        Raises
        ------
        InputError
            No sensor is open, nothing tells its orientation, or the disk fails.
        """
        with self._busy:
            if self.reading is not None:
                return
            pair = self._live.pair
            if pair is None:
                raise InputError("No sensor is open: connect one in step 1, Devices, then start again.")
            if pair.poses is None:
                raise InputError(
                    "The sensor's orientation is unknown: choose a source of poses in step 1, Devices."
                )
            name = next_recording(self._desk.state, self._desk.folder, reading.stem)
            self._tape = SessionTape.start(self._desk, self._live, name).result(_PATIENCE_S)
            self._end, self.reading = self._live.follow(reading.feed), reading

    def keep(self) -> str:
        """End the recording, keep it in the session, and return its name; empty: none goes on."""
        with self._busy:
            tape = self._stop()
            if tape is None:
                return ""
            tape.keep().result()
            return tape.name

    def discard(self) -> None:
        """End the recording, and throw it away."""
        with self._busy:
            tape = self._stop()
            if tape is not None:
                tape.discard().result()

    def _stop(self) -> SessionTape | None:
        self._end()
        self._end = lambda: None
        tape, self._tape, self.reading = self._tape, None, None
        return tape

    def compute(self, kind: str, recordings: Mapping[str, str], given: Mapping[str, Any]) -> KnownOutcome:
        """
        Have the session compute a check.

        Parameters
        ----------
        kind : str
            WEIGHT or TOUCH.
        recordings : mapping
            Role -> name of a recording.
        given : mapping
            Parameters.

        Raises
        ------
        InputError
            A recording holds nothing to compare, or something is missing.
        """

        def judge(session: Session) -> KnownOutcome:
            check_recordings(session, kind, recordings, given)
            found = known_outcome(session.folder, session.state, session.stale(), kind)
            assert found is not None  # noqa: S101 - it was just made
            return found

        return self._desk.do(judge).result()


def check_recordings(
    session: Session, kind: str, recordings: Mapping[str, str], given: Mapping[str, Any]
) -> None:
    """
    Compute a check from recordings of the session, and its report anew where there is one.

    As ``contactbench session compute SESSION known_weight known_weight.json --input unloaded=NAME --input
    loaded=NAME --set mass=KG``.

    Raises
    ------
    InputError
        A recording holds nothing to compare, or something is missing.
    """
    compute(session, kind, FILES[kind], newest_inputs(session.state, kind, recordings), given)
    made = session.state.current_results.get(("report", REPORT))
    if made is not None and made.mark is None and session.state.newest("verification") is not None:
        compute(session, "report", REPORT, newest_inputs(session.state, "report"), {})

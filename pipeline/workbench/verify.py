"""Verifying at the bench: markers, touches as they happen, and the verdict that the recording gives."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.calibration.stillness import StillnessDetector, StillState
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.export_knobs import ExportKnobs
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions.region import Region
from contactbench.pipeline.session import Session, State
from contactbench.pipeline.session.adoption import next_recording
from contactbench.pipeline.session.recompute import compute, inputs_of, newest_inputs, settings_of
from contactbench.pipeline.session.why import why_locked
from contactbench.pipeline.verification.figures import Verification
from contactbench.pipeline.verification.known_check import TOUCH, WEIGHT, CheckOutcome, read_check
from contactbench.pipeline.verification.markers import with_normals
from contactbench.pipeline.verification.result import VerificationParameters
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.live import Live, LiveBlock, follows
from contactbench.pipeline.workbench.markers import KIND as MARKERS
from contactbench.pipeline.workbench.markers import Markers
from contactbench.pipeline.workbench.markers import kept as read_kept
from contactbench.pipeline.workbench.tape import SessionTape
from contactbench.pipeline.workbench.undo_history import Deed
from contactbench.pipeline.workbench.verify_touches import (
    LiveTouches,
    MarkerRow,
    TouchView,
    live_noise,
    point_mm,
)

_NOISE_S, _PATIENCE_S = 1.0, 5.0
KIND, RESULT, REPORT = "verification", "verification.json", "report.html"
_SAME_MM = 0.05


def parameters_of(state: State, given: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """
    Return the parameters that a session's verification is computed with, JSON values.

    Parameters
    ----------
    state : State
    given : mapping, optional
        Parameters that count more than the session's settings.

    Raises
    ------
    InputError
        One of them is wrong.
    """
    found = settings_of(state, KIND)
    mount = state.setting("devices.mount")
    if mount is not None:
        found.setdefault("mount", mount)
    found.update(given or {})
    checked_parameters(found)
    return found


def checked_parameters(parameters: Mapping[str, Any]) -> VerificationParameters:
    """Return parameters as a verification has them; InputError, with the first that is wrong."""
    checked = VerificationParameters.checked({"name": RESULT, **parameters})
    checked.settings()
    return checked


def plain_parameters(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Return all parameters as JSON values, those that were left out as they are used."""
    plain: dict[str, Any] = checked_parameters(parameters).model_dump(mode="json", exclude={"name"})
    return plain


@dataclass(frozen=True, eq=False)
class TouchTool:
    """What touches are located with."""

    probe: Probe  # S
    model: GravityModel
    content: tuple[str, str]  # Hashes of probe and calibration: other ones are another tool
    regions: tuple[Region, ...] = ()  # Names and colours, in the order of their ranks
    sigma_max: float = 0.0  # m: as near as the bundle will ask of a contact
    follow: bool = False  # whether the zero follows


def tool_of(folder: Path, state: State) -> TouchTool:
    """
    Load a session's newest probe and calibration; for a worker.

    Raises
    ------
    InputError
        One is missing, refused or cannot be read.
    """
    from contactbench.pipeline.calibration import Level
    from contactbench.pipeline.calibration.files.calibration_file import load_calibration
    from contactbench.pipeline.mesh.sidecar import load_probe_file
    from contactbench.pipeline.verification.result import load_surface

    content = tool_key(state)
    if content is None:
        raise InputError(why_locked(state))
    files = inputs_of(folder, state, dict(zip(("probe", "calibration"), content, strict=True)))
    calibration = load_calibration(files["calibration"])
    probe = load_surface(files["probe"])
    regions = load_probe_file(files["probe"]).regions.regions if probe.region.any() else ()
    if calibration.verdict.level is Level.REFUSE:
        raise InputError(
            "The calibration was refused, so a verification with it would not count. Recalibrate."
        )
    return TouchTool(probe, calibration.model, content, regions, asked_near(state), follows(state))


def asked_near(state: State) -> float:
    """Return the gate `sigma_max` that an export of the session asks for, m."""
    given = state.setting("config.sigma_max")
    return float(given if isinstance(given, float | int) else ExportKnobs().sigma_max)


def tool_key(state: State) -> tuple[str, str] | None:
    """Return the hashes of a session's newest probe and calibration; None: one is missing."""
    probe, calibration = state.newest("probe"), state.newest("calibration")
    return None if probe is None or calibration is None else (probe.content, calibration.content)


class VerifyWork:
    """
    The step Verify: what touches are located with, the markers, and a verification that goes on, or does not.

    Attributes
    ----------
    tool : TouchTool or None
        None: there is none yet.
    markers : Markers
    parameters : VerificationParameters
        Of the session.
    outcome : VerifyOutcome or None
        That the session has.
    touches : LiveTouches or None
        None: nothing goes on.
    """

    def __init__(self, desk: Desk, live: Live) -> None:
        self._desk, self._live = desk, live
        self.tool: TouchTool | None = None
        self.markers = Markers()
        self.parameters = checked_parameters({})
        self.outcome: VerifyOutcome | None = None
        self.touches: LiveTouches | None = None
        self._tape: SessionTape | None = None
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
    def rows(self) -> tuple[MarkerRow, ...]:
        """The markers while nothing goes on: as the last verification has them, if it still holds."""
        outcome = self.outcome
        holds = outcome is not None and not outcome.stale
        judged = {each.name: each for each in outcome.found.per_marker} if outcome and holds else {}
        wanted = self.parameters.repeats * len(self.parameters.windows)
        rows = []
        for marker in self.markers.all:
            row, each = MarkerRow(marker.name, point_mm(marker), 0, wanted), judged.get(marker.name)
            if outcome is not None and each is not None:
                state = "failed" if each.max_mm > 1e3 * outcome.found.limits.max_m else "done"
                row = replace(
                    row, touches=each.touches, mean_mm=each.mean_mm, max_mm=each.max_mm, state=state
                )
            rows.append(row)
        return tuple(rows)

    @property
    def findings(self) -> tuple[str, ...]:
        """What is wrong with the devices or the disk while it is recorded, in sentences."""
        tape = self._tape
        return () if tape is None else tape.findings

    @property
    def error(self) -> str:
        """Why nothing more is recorded of what goes on, such as a full disk; empty: all is well."""
        tape = self._tape
        return "" if tape is None else tape.error or ""

    def pause(self) -> None:
        """Follow no more touches: what is not recorded does not count. What was recorded can be finished."""
        if self._end is not None:
            self._end()

    def take_outcome(self, outcome: VerifyOutcome | None) -> None:
        """Have a verdict that the session has; what was another while it was live is remembered."""
        before = self.outcome
        if outcome is not None and before is not None and before.differs and not outcome.differs:
            outcome = replace(outcome, differs=before.differs)
        self.outcome = outcome

    def start(self, tool: TouchTool, markers: Markers, cancelled: Callable[[], bool] = lambda: False) -> None:
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

    def _used(self, tool: TouchTool, markers: Markers) -> dict[str, str]:
        """Return what the touches are judged with, by role: also if there is something newer when they are."""
        state = self._desk.do(lambda session: session.state).result()  # after all that waits to be written
        kept = state.newest(MARKERS)
        if kept is None or read_kept(self._desk.folder, state) != markers:
            raise InputError("The markers are still being saved: wait a moment, then start again.")
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
                    "No samples arrive from the sensor: check its cable and step 1, Devices, then"
                    " start again."
                )
            time.sleep(0.05)
        return None

    def _record(self) -> None:
        from contactbench.pipeline.workbench.tape import SessionTape

        self._name = next_recording(self._desk.state, self._desk.folder, "verify")
        self._tape = SessionTape.start(self._desk, self._live, self._name).result()

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

    def finish(self, deed: Deed | None = None) -> VerifyOutcome | None:
        """
        Keep the recording, judge it, and make the report; waits, so call it in a worker.

        Parameters
        ----------
        deed : Deed, optional
            Becomes the judging: what can be undone; the recording stays.

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

            def judge(session: Session) -> VerifyOutcome | None:
                judge_recording(session, name, given, inputs)
                return outcome_of(session.folder, session.state, session.stale(), seen)

            return self._desk.do(judge if deed is None else deed.around(judge)).result()

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


@dataclass(frozen=True)
class VerifyOutcome:
    """A verification that the session has."""

    found: Verification
    report: Path | None
    differs: str = ""  # What was another while it was live; empty: nothing
    stale: str = ""  # Why it no longer holds; empty: it does
    broken: str = ""  # What is wrong with a file behind it; empty: nothing

    @property
    def passed(self) -> bool:
        """Whether it did."""
        return self.found.verdict.passed

    @property
    def touches(self) -> int:
        """How many were accepted."""
        return 0 if self.found.overall is None else self.found.overall.touches

    @property
    def mean_mm(self) -> float | None:
        """Mean error; None: no touch was accepted."""
        return None if self.found.overall is None else self.found.overall.mean_mm


def outcome_of(
    folder: Path,
    state: State,
    stale: Mapping[tuple[str, str], tuple[str, ...]],
    live: TouchView | None = None,
) -> VerifyOutcome | None:
    """
    Read a session's verification; None: there is none.

    Parameters
    ----------
    folder : Path
    state : State
    stale : mapping
        As `Session.stale` says.
    live : TouchView, optional
        What was seen while it was recorded.

    Raises
    ------
    InputError
        It cannot be read.
    """
    found = state.current_results.get((KIND, RESULT))
    if found is None or found.rejected:
        return None
    from contactbench.pipeline.report import read_verification

    file = folder / found.file.path
    try:
        verification = read_verification(file)
    except InputError as error:
        raise InputError(
            f"{arg(file)}: the verification cannot be read ({arg(error)}): verify again."
        ) from error
    reasons = stale.get(found.slot, ())
    outcome = VerifyOutcome(
        verification, _report(folder, state, found.known_as), stale=next(iter(reasons), "")
    )
    return outcome if live is None else replace(outcome, differs=differs(outcome, live))


def _report(folder: Path, state: State, verification: set[str]) -> Path | None:
    found = state.current_results.get(("report", REPORT))
    if found is None or not set(found.action.inputs.values()) & verification:
        return None
    return folder / found.file.path


def differs(outcome: VerifyOutcome, live: TouchView) -> str:
    """Say what the raw recording gave otherwise than what was seen while it was made; empty: nothing."""
    if live.mean_mm is None or outcome.mean_mm is None:
        if live.accepted == outcome.touches:
            return ""
        return message(
            f"Live, {arg(live.accepted)} touches were accepted; the recording gives {arg(outcome.touches)}."
            " The recording counts."
        )
    same_count = live.accepted == outcome.touches
    if same_count and abs(live.mean_mm - outcome.mean_mm) <= _SAME_MM:
        return ""
    return message(
        f"Live, {arg(live.accepted)} touches were accepted with a mean error of {arg(live.mean_mm):.2f} mm;"
        f" the recording gives {arg(outcome.touches)} with {arg(outcome.mean_mm):.2f} mm, because it uses"
        " the noise of the whole recording. The recording counts."
    )


def judge_recording(
    session: Session,
    recording: str,
    given: Mapping[str, Any] | None = None,
    used: Mapping[str, str] | None = None,
) -> None:
    """
    Compute verification and report from a recording of the session, with the session's settings.

    As ``contactbench session compute SESSION verification verification.json --input recording=NAME``, with ``--set``
    for each parameter, and then ``report report.html``.

    Parameters
    ----------
    session : Session
        Open for writing.
    recording : str
        Its name.
    given : mapping, optional
        Parameters that count more than the session's settings, such as the order in which markers were asked for.
    used : mapping, optional
        Role -> hash of what was touched with, where that is not the newest.

    Raises
    ------
    InputError
        The recording holds no touch, or something is missing.
    """
    parameters = parameters_of(session.state, given)
    inputs = newest_inputs(session.state, KIND, {"recording": recording})
    compute(session, KIND, RESULT, {**inputs, **(used or {})}, parameters)
    compute(session, "report", REPORT, newest_inputs(session.state, "report"), {})


# ---- A known weight and a known point at the bench -----------------------------------------------


FILES = {WEIGHT: "known_weight.json", TOUCH: "known_touch.json"}
_PRESSED_N, _RELEASED_N = 3.0, 1.5
_HELD_S = 0.8  # of a press: the check needs a quarter of a second once it has settled
_LONGEST_S = 30.0


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
        for moment, force in zip(
            block.times[known].tolist(), np.linalg.norm(forces, axis=1).tolist(), strict=True
        ):
            self.force = force
            if self._began is None and force >= _PRESSED_N:
                self._began = moment
            elif self._began is not None and force < _RELEASED_N:
                self.done, self._began = self.held >= _HELD_S, None
                if self.done:
                    return
            self.held = 0.0 if self._began is None else moment - self._began


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
            self._tape = SessionTape.start(self._desk, self._live, name).result(_LONGEST_S)
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

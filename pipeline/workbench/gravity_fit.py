"""How a session calibrates gravity, and what poses amount to: a calibration, what to take next, what is wrong."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import Calibration, Level, PoseSample, calibrate
from contactbench.pipeline.calibration.assumptions import assumed, contact_task, pose_noise
from contactbench.pipeline.calibration.diagnosis.diagnose import Diagnosis, diagnose
from contactbench.pipeline.calibration.diagnosis.prior import Prior
from contactbench.pipeline.calibration.diagnosis.rereadings import RawOrientations
from contactbench.pipeline.calibration.files import pose_csv
from contactbench.pipeline.calibration.files.calibration_file import load_calibration
from contactbench.pipeline.calibration.mount import estimate_mount
from contactbench.pipeline.calibration.orientation import Convention
from contactbench.pipeline.calibration.stillness import Capture, Rejected
from contactbench.pipeline.calibration.suggest import (
    PosePlan,
    Reachable,
    by_hand,
    describe,
    plan_poses,
    suggest_pose,
)
from contactbench.pipeline.errors import InputError, arg, capitalised, message
from contactbench.pipeline.session import Session, State
from contactbench.pipeline.session.adoption import RECORDING, next_recording
from contactbench.pipeline.session.files import wrong_with
from contactbench.pipeline.session.journal import SessionError
from contactbench.pipeline.session.recompute import CalibrationParameters, compute
from contactbench.pipeline.session.state import Input, Result

MOUNT, INVERSE, TILT = "devices.mount", "calibration.inverse", "devices.max_tilt"
DOWN, ORIENTATION_NOISE = "calibration.down", "calibration.orientation_noise"
CALIBRATION_FILE, POSES_FILE = "calibration.json", "poses.csv"
PLANNED = 6
_ENOUGH_FOR_ANY = 12  # poses: what they leave open, more of them hardly settle
FEWEST = 3  # poses of which there is a calibration
_CHECKABLE = 5  # poses from which on conventions can be told from noise
_MOUNTABLE = 6
_MOUNT_NEEDS = 4
_CANDIDATES = 300


@dataclass(frozen=True)
class GravitySettings:
    """How poses are read and calibrated."""

    # Those with which the session will compute its calibration; `mount` is R_ES as angles in degrees
    parameters: CalibrationParameters
    # Largest angle between the sensor's z axis and straight down that can be reached, degrees
    max_tilt: float = 180.0

    @property
    def given(self) -> dict[str, Any]:
        """What differs from the usual, as the session is told: JSON values, without the name."""
        given: dict[str, Any] = self.parameters.model_dump(
            mode="json", exclude={"name"}, exclude_defaults=True
        )
        return given

    @property
    def R_ES(self) -> NDArray[np.float64]:
        """(3, 3) orientation of the sensor on the flange."""
        R = self.parameters.R_ES
        return np.eye(3) if R is None else R

    @property
    def down_W(self) -> tuple[float, float, float]:
        """Where gravity points in W."""
        return self.parameters.down

    def sensor_orientations(self, R_WE: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return R_WS (n, 3, 3) of the flange's orientations as the source of poses gives them."""
        read = R_WE.swapaxes(-1, -2) if self.parameters.inverse else R_WE
        R: NDArray[np.float64] = read @ self.R_ES
        return R


def gravity_settings(state: State) -> GravitySettings:
    """
    Return what a session's parameters say.

    Raises
    ------
    InputError
        One of them makes no sense.
    """
    own = state.named("calibration")
    given = {name: setting.value for name, setting in own.items()}
    mount = state.settings.get(MOUNT)
    if mount is not None and (
        "mount" not in own or own["mount"].number < mount.number
    ):  # the newest word counts
        given["mount"] = mount.value if mount.value and any(mount.value) else None
    if given.get("estimate_mount"):
        given.pop("mount", None)
    parameters = CalibrationParameters.checked({**given, "name": CALIBRATION_FILE})
    said = state.setting(TILT)  # None too where it was taken back
    degrees = 180.0 if said is None else said
    if not isinstance(degrees, int | float) or not 0 < degrees <= 180:
        raise InputError(
            f"{arg(TILT)}: {arg(degrees)!r} is not an angle above 0 and up to 180 degrees: set it again."
        )
    return GravitySettings(parameters, float(degrees))


@dataclass(frozen=True)
class GravityFinding:
    """Something that the poses say, and what would mend it."""

    key: str
    sentence: str  # What, and what to do
    # (str, JSON value); Parameters of the session that mend it, once the technician confirms; empty:
    # there are none
    settings: tuple[tuple[str, Any], ...] = ()
    leave_out: tuple[int, ...] = ()  # Or: indices of poses that are better left out
    remedy: str = ""  # What confirming does, in a few words; empty where nothing can be confirmed


@dataclass(frozen=True, eq=False)
class Proposal:
    """A pose to take next."""

    R_WS: NDArray[np.float64]  # (3, 3)
    sentence: str  # How to hold the sensor, and what it gains once there is a calibration


@dataclass(frozen=True, eq=False)
class Solved:
    """What the taken poses amount to."""

    calibration: Calibration | None  # None: there are fewer than three
    proposal: Proposal | None
    findings: tuple[GravityFinding, ...]

    @property
    def enough(self) -> bool:
        """Whether more poses are of no use: the calibration is good, or what ails it is not noise."""
        fitted = self.calibration
        if fitted is None or fitted.verdict.level is Level.GOOD:
            return fitted is not None
        kept = int(fitted.kept.sum())
        not_noise = fitted.model_error >= 0.5 * fitted.contact_error
        return kept >= _ENOUGH_FOR_ANY or (kept >= PLANNED and not_noise)


def plan(settings: GravitySettings) -> PosePlan:
    """Return the poses to begin with."""
    reach = _reach(settings, None)
    return plan_poses(PLANNED, reach, task=contact_task(settings.parameters))


def solve(
    poses: Sequence[PoseSample],
    settings: GravitySettings,
    planned: PosePlan | None,
    R_WS_now: NDArray[np.float64] | None,
) -> Solved:
    """
    Return what poses amount to.

    Parameters
    ----------
    poses : sequence of PoseSample
        Those that count, R_WS of the flange as the source of poses gives it.
    settings : GravitySettings
    planned : PosePlan or None
        For the poses before there is a calibration.
    R_WS_now : (3, 3), optional
        How the sensor stands.
    """
    read = read_poses(poses, settings)
    if len(read) < FEWEST:
        return Solved(None, _planned(read, planned, settings), ())
    given = settings.parameters
    if given.estimate_mount and len(poses) >= _MOUNT_NEEDS:
        calibration = estimate_mount(read, **assumed(given)).calibration
    else:
        calibration = calibrate(read, **assumed(given))
    try:
        suggestion = suggest_pose(calibration, _reach(settings, R_WS_now))
    except InputError:
        proposal = None
    else:
        words = suggestion.sentence.removeprefix("Next: ")
        proposal = Proposal(suggestion.R_WS, capitalised(words))
    return Solved(calibration, proposal, findings(poses, calibration, settings))


def read_poses(poses: Sequence[PoseSample], settings: GravitySettings) -> tuple[PoseSample, ...]:
    """Return poses of the flange as poses of the sensor."""
    return tuple(replace(pose, R_WS=settings.sensor_orientations(pose.R_WS)) for pose in poses)


def _reach(settings: GravitySettings, R_WS_now: NDArray[np.float64] | None) -> Reachable:
    return by_hand(
        _CANDIDATES, max_tilt=float(np.radians(settings.max_tilt)), R_WS_now=R_WS_now, down_W=settings.down_W
    )


def _planned(
    read: Sequence[PoseSample], planned: PosePlan | None, settings: GravitySettings
) -> Proposal | None:
    """Return the first planned pose that nobody has taken."""
    if planned is None:
        return None
    down = np.array(settings.down_W)
    taken = [down @ pose.R_WS for pose in read]  # where down is in S: all that a weight can tell
    for R_WS in planned.R_WS:
        if all(float(down @ R_WS @ there) < np.cos(np.radians(20.0)) for there in taken):
            # No forecast: before there are residuals nobody knows the noise, and a figure would be wrong tenfold.
            return Proposal(R_WS, message(f"{arg(capitalised(describe(R_WS, settings.down_W)))}."))
    return None


# ---- what is wrong -----------------------------------------------------------------------------


def findings(
    poses: Sequence[PoseSample], calibration: Calibration, settings: GravitySettings
) -> tuple[GravityFinding, ...]:
    """Return what poses say of themselves and of the conventions they were read by, in sentences."""
    found = [
        GravityFinding(
            f"rejected {rejection.name}",
            message(
                f"{arg(capitalised(rejection.name))}: {arg(rejection.reason)} It does not count. Retake it, or"
                f" continue with {arg(int(calibration.kept.sum()))} poses."
            ),
            leave_out=(rejection.index,),
            remedy=message("Leave it out"),
        )
        for rejection in calibration.rejected
    ]
    refused = calibration.verdict.level is Level.REFUSE
    if len(poses) < (_CHECKABLE if refused else _MOUNTABLE):
        return tuple(found)
    convention = _convention(poses, calibration, settings)
    if convention is not None:
        found.insert(0, convention)
    return tuple(found)


def _convention(
    poses: Sequence[PoseSample], calibration: Calibration, settings: GravitySettings
) -> GravityFinding | None:
    """Return which mistaken convention explains the poses, if one does."""
    convention = Convention(inverse=settings.parameters.inverse)
    quaternions = Rotation.from_matrix(np.array([pose.R_WS for pose in poses])).as_quat()
    raw = RawOrientations(np.roll(quaternions, 1, axis=1), convention)
    found = diagnose(
        calibration.poses, pose_noise(settings.parameters), prior=Prior(down_W=settings.down_W), raw=raw
    )
    if found.consistent:
        return None
    if found.none_known or found.best.hypothesis == "as_declared":
        mounted = _mounted(poses, calibration, settings)
        if mounted is not None or calibration.verdict.level is not Level.REFUSE:
            return mounted
        return GravityFinding("unexplained", found.sentence)
    return _remedied(found, len(poses), settings)


def _remedied(found: Diagnosis, count: int, settings: GravitySettings) -> GravityFinding:
    """Return a finding with what mends it, where a parameter can."""
    key, sentence, turn = found.best.hypothesis, found.sentence, found.best.turn
    if key == "transposed":
        return GravityFinding(
            key,
            sentence,
            settings=((INVERSE, not settings.parameters.inverse),),
            remedy=message("Invert the orientations"),
        )
    if turn is not None:
        return _turned(key, sentence, settings.R_ES @ turn)
    if key.startswith("rezero_before_"):
        change = int(key.removeprefix("rezero_before_")) - 1
        short = range(change) if change <= count - change else range(change, count)
        return GravityFinding(
            key, sentence, leave_out=tuple(short), remedy=message("Leave out the smaller part")
        )
    return GravityFinding(key, sentence)


def _turned(key: str, sentence: str, R_ES: NDArray[np.float64]) -> GravityFinding:
    degrees = [
        round(float(angle), 3) + 0.0 for angle in Rotation.from_matrix(R_ES).as_euler("xyz", degrees=True)
    ]
    words = ", ".join(f"{angle:.1f}" for angle in degrees)
    return GravityFinding(
        key,
        sentence,
        settings=((MOUNT, degrees),),
        remedy=message(f"Set the mount to {arg(words)}° about x, y, z"),
    )


def _mounted(
    poses: Sequence[PoseSample], calibration: Calibration, settings: GravitySettings
) -> GravityFinding | None:
    """Return the mount that explains poses which as they are read are refused."""
    if (
        calibration.verdict.level is not Level.REFUSE
        or len(poses) < _MOUNTABLE
        or settings.parameters.estimate_mount
    ):
        return None
    read = tuple(
        replace(pose, R_WS=pose.R_WS.T if settings.parameters.inverse else pose.R_WS) for pose in poses
    )
    mounted = estimate_mount(read, **assumed(settings.parameters))
    if mounted.calibration.verdict.level is Level.REFUSE:
        return None
    off = np.degrees(Rotation.from_matrix(mounted.R_SE @ settings.R_ES).magnitude())
    sentence = message(
        f"The sensor is mounted on the flange {arg(off):.0f}° differently than declared: with that"
        f" corrected, the poses agree. {arg(mounted.mounting)} Set the mount accordingly, or check how"
        " the sensor is bolted on."
    )
    return _turned("mount", " ".join(sentence.split()), mounted.R_SE.T)


# ---- the poses, as a technician sees them ---------------------------------------------------------


class PoseState(StrEnum):
    """Whether a pose counts."""

    TAKEN = "taken"
    LEFT_OUT = message("left out")  # by the technician
    REJECTED = "rejected"  # by what it reads, or because it was disturbed


@dataclass(frozen=True, eq=False)
class PoseRow:
    """A pose for a table."""

    name: str  # Such as "pose 3"
    time: float  # A moment within it, s on the recording's clock; NaN: of an earlier recording
    R_WS: NDArray[np.float64] | None  # (3, 3); None: nobody knows any more
    words: str  # How the sensor stood, or what happened
    state: PoseState
    reason: str = ""  # Why it does not count, or is doubted
    # The larger of how far force and torque are from what the poses predict, as a normal deviate; NaN: not
    # computed
    sigmas: float = float("nan")
    force_sigmas: float = float("nan")
    torque_sigmas: float = float("nan")
    earlier: bool = False  # It is of an interrupted recording, and cannot be left out by its time
    changeable: bool = True  # It can be left out and taken back


def short_description(R_WS: NDArray[np.float64]) -> str:
    """Say in a few words how the sensor stands: the tilt of z from straight down, and which side is lowest."""
    z_W = R_WS[:, 2]
    tilt = float(np.degrees(np.arccos(np.clip(-z_W[2], -1, 1))))
    down_S = -R_WS[2]
    side = int(np.argmax(np.abs(down_S)))
    return message(f"{arg(tilt):.0f}°, {arg('-' if down_S[side] < 0 else '+')}{arg('xyz'[side])} down")


def middle(capture: Capture) -> float:
    """Return the moment that names a capture, s."""
    return 0.5 * (capture.start + capture.stop)


def calibrated_rows(
    calibration: Calibration, left_out: tuple[float, ...] = (), earlier: int = 0
) -> tuple[PoseRow, ...]:
    """
    Return the poses of a calibration, then those that were left out of it.

    Parameters
    ----------
    calibration : Calibration
    left_out : tuple of float
        Moments of those that it was not given, s.
    earlier : int
        How many of its poses are of an earlier recording.
    """
    none = float("nan")
    rows = [
        _row(
            message(f"pose {arg(index + 1)}"),
            none if pose.time is None else pose.time,
            pose.R_WS,
            calibration,
            index,
        )
        for index, pose in enumerate(calibration.poses)
    ]
    out = [
        PoseRow(
            f"out {number}",
            moment,
            None,
            message("does not count"),
            PoseState.LEFT_OUT,
            message("You left it out."),
        )
        for number, moment in enumerate(left_out, 1)
    ]
    return (*map(_of_earlier, rows[:earlier]), *rows[earlier:], *out)


def earlier_rows(
    poses: Sequence[PoseSample], settings: GravitySettings, fitted: Calibration | None
) -> tuple[PoseRow, ...]:
    """Return the poses (R_WS of the flange) of an interrupted run, which cannot be left out one by one."""
    return tuple(
        _of_earlier(_live_row(pose.name, float("nan"), pose.R_WS, settings, fitted)) for pose in poses
    )


def _of_earlier(row: PoseRow) -> PoseRow:
    return replace(row, time=float("nan"), earlier=True, changeable=False)


def live_rows(
    captures: Iterable[tuple[Capture, bool]],
    rejected: Iterable[Rejected],
    first: int,
    settings: GravitySettings,
    fitted: Calibration | None,
    origin: float,
) -> tuple[PoseRow, ...]:
    """
    Return the poses of a run that goes on, and what was disturbed, in the order in which they came.

    Parameters
    ----------
    captures : iterable of (Capture, bool)
        R_WS of the flange; whether it counts.
    rejected : iterable of Rejected
    first : int
        Number of the first one.
    settings : GravitySettings
    fitted : Calibration or None
        Of the poses that count, by their names.
    origin : float
        s on the samples' clock, from which people count.
    """
    rows: list[tuple[float, PoseRow]] = []
    for number, (capture, counts) in enumerate(captures, first):
        if capture.R_WS is None:
            continue
        row = _live_row(
            message(f"pose {arg(number)}"),
            middle(capture),
            capture.R_WS,
            settings,
            fitted if counts else None,
        )
        if not counts:
            reason = message("It does not count. Restore it if it was good.")
            row = replace(row, state=PoseState.LEFT_OUT, reason=reason)
        rows.append((capture.start, row))
    for each in rejected:
        row = PoseRow(
            f"at {each.start - origin:.0f} s", 0.5 * (each.start + each.stop), None,
            message(f"{arg(each.state.value)}: not captured"), PoseState.REJECTED, each.reason, changeable=False,
        )  # fmt: skip
        rows.append((each.start, row))
    return tuple(row for _, row in sorted(rows, key=lambda each: each[0]))


def _live_row(
    name: str, moment: float, R_WE: NDArray[np.float64], settings: GravitySettings, fitted: Calibration | None
) -> PoseRow:
    index = next((i for i, pose in enumerate(fitted.poses) if pose.name == name), None) if fitted else None
    return _row(name, moment, settings.sensor_orientations(R_WE), fitted, index)


def _row(
    name: str, moment: float, R_WS: NDArray[np.float64], fitted: Calibration | None, index: int | None
) -> PoseRow:
    """Return a row, with what a calibration says of its pose there."""
    row = PoseRow(name, moment, R_WS, short_description(R_WS), PoseState.TAKEN)
    if fitted is None or index is None:
        return row
    force, torque = map(float, fitted.deviates[index])
    reason = next((each.reason for each in fitted.rejected if each.index == index), "")
    return replace(
        row,
        state=PoseState.REJECTED if reason else PoseState.TAKEN,
        reason=reason,
        sigmas=max(force, torque),
        force_sigmas=force,
        torque_sigmas=torque,
    )


# ---- what a gravity calibration leaves in its session: computed from the recording, as the commands
# ---- compute it


_STEM, _CHECK = "gravity-", "gravity-check-"
_PART = "poses-earlier-{}.csv"


@dataclass(frozen=True, eq=False)
class GravityOutcome:
    """A calibration that is in the session."""

    calibration: Calibration
    rows: tuple[PoseRow, ...]
    recording: str  # Name of the recording that it was made from; empty: from poses that were brought in
    leave_out: tuple[float, ...]  # Moments of the poses that were left out, s
    findings: tuple[GravityFinding, ...] = ()  # What is wrong, and what would mend it

    @property
    def changeable(self) -> bool:
        """Whether poses can be left out and taken back."""
        return bool(self.recording)


def next_name(state: State, folder: Path, *, check: bool = False) -> str:
    """Return the name of the next recording of this step that neither the session nor its folder has."""
    return next_recording(state, folder, (_CHECK if check else _STEM).removesuffix("-"))


def interrupted(state: State) -> Input | None:
    """
    Return the newest recording of this step that no poses were taken from: its process died, or it was stopped.

    None: there is none, or a calibration was made since.
    """
    used = {sha256 for each in state.results for sha256 in each.action.inputs.values()}
    made = max((each.number for each in state.results if each.action.kind == "calibration"), default=0)
    found = [
        each
        for each in state.current_inputs.values()
        if each.kind == RECORDING
        and each.name.startswith(_STEM)
        and not each.name.startswith(_CHECK)
        and each.content not in used
        and each.number > made
    ]
    return max(found, key=lambda each: each.number, default=None)


def take_up(session: Session, recording: str) -> tuple[str, tuple[PoseSample, ...]]:
    """
    Find the poses of a recording, and keep them as a result that a later one goes on from.

    Poses that were left out of it stay so, and those that it went on from itself come first.

    Returns
    -------
    name : str
        Of the result.
    poses : tuple of PoseSample
        R_WS of the flange.

    Raises
    ------
    SessionError
        There is no still pose in it.
    """
    source = _recording(session.state, recording)
    name = _PART.format(recording.removeprefix(_STEM).removesuffix(".mcap"))
    inputs, parameters = {"recording": source.content}, {}
    made = session.state.current_results.get(("captures", POSES_FILE))
    if made is not None and made.action.inputs.get("recording") == source.content:
        inputs, parameters = dict(made.action.inputs), dict(made.action.parameters)
    compute(session, "captures", name, inputs, {**parameters, "partial": True})
    part = session.state.current_results["captures", name]
    return name, pose_csv.read_poses(session.folder / part.file.path).poses


def finish(
    session: Session, recording: str, leave_out: Sequence[float] = (), earlier: str | None = None
) -> GravityOutcome:
    """
    Compute poses and calibration from a recording that is in the session.

    The same as ``session compute FOLDER captures poses.csv --input recording=NAME --set leave_out=[...]``, then
    ``session compute FOLDER calibration calibration.json``.

    Parameters
    ----------
    session : Session
        Open for writing.
    recording : str
        Its name.
    leave_out : sequence of float
        Moments, s, of captures that do not count.
    earlier : str, optional
        Name of a result of `take_up` whose poses come first.

    Raises
    ------
    SessionError
        There are too few poses.
    """
    inputs = {"recording": _recording(session.state, recording).content}
    if earlier is not None:
        inputs["earlier"] = session.state.current_results["captures", earlier].content
    parameters: dict[str, Any] = {"leave_out": sorted(leave_out)} if leave_out else {}
    return _computed(session, inputs, parameters)


def change(session: Session, leave_out: Sequence[float]) -> GravityOutcome:
    """Compute the same anew, with other poses left out; arguments and errors as for `finish`."""
    made = session.state.current_results.get(("captures", POSES_FILE))
    if made is None:
        raise SessionError("This session has no recorded poses: record some first.")
    parameters: dict[str, Any] = {
        key: value for key, value in made.action.parameters.items() if key != "leave_out"
    }
    if leave_out:
        parameters["leave_out"] = sorted(leave_out)
    return _computed(session, dict(made.action.inputs), parameters, again=True)


def _computed(
    session: Session, inputs: dict[str, str], parameters: dict[str, Any], *, again: bool = False
) -> GravityOutcome:
    compute(session, "captures", POSES_FILE, inputs, parameters)
    poses = session.state.current_results["captures", POSES_FILE]
    given = gravity_settings(session.state).given
    before = _same(session, {"poses": poses.content}, given) if again else None
    if before is not None:
        session.add_again(before)
    else:
        compute(session, "calibration", CALIBRATION_FILE, {"poses": poses.content}, given)
    outcome = outcome_of(session.folder, session.state)
    assert outcome is not None  # noqa: S101 - it was just made
    return outcome


def _same(session: Session, inputs: Mapping[str, str], given: Mapping[str, Any]) -> Result | None:
    """
    Return an earlier calibration from the same poses and parameters.

    Computed anew it would have another time in it, and what rests on it, such as a verification, would be stale.
    """
    for each in reversed(session.state.results):
        action = each.action
        same = (action.kind, action.name, dict(action.inputs)) == (
            "calibration",
            CALIBRATION_FILE,
            dict(inputs),
        )
        if same and dict(action.parameters) == dict(given) and each.mark is None:
            return None if wrong_with(session.folder, each.file) else each
    return None


def outcome_of(folder: Path, state: State) -> GravityOutcome | None:
    """
    Read the calibration that a session has now; None: none.

    Raises
    ------
    InputError
        Its file cannot be read.
    """
    result = state.current_results.get(("calibration", CALIBRATION_FILE))
    if result is None or result.rejected:
        return None
    fitted = load_calibration(folder / result.file.path)
    poses = state.result_with(result.action.inputs.get("poses", ""))
    if poses is None or poses.slot != ("captures", POSES_FILE):
        return GravityOutcome(fitted, calibrated_rows(fitted, earlier=len(fitted.poses)), "", ())
    given: dict[str, Any] = dict(poses.action.parameters)
    left = tuple(map(float, given.get("leave_out", ())))
    used = state.input_with(poses.action.inputs.get("recording", ""))
    rows = calibrated_rows(fitted, left, _earlier_count(folder, state, poses))
    flange = pose_csv.read_poses(folder / poses.file.path).poses
    found = () if len(flange) != len(fitted.poses) else findings(flange, fitted, gravity_settings(state))
    return GravityOutcome(fitted, rows, "" if used is None else used.name, left, found)


def _earlier_count(folder: Path, state: State, poses: Result) -> int:
    before = state.result_with(poses.action.inputs.get("earlier", ""))
    return 0 if before is None else len(pose_csv.read_poses(folder / before.file.path).poses)


def _recording(state: State, name: str) -> Input:
    found = state.current_inputs.get((RECORDING, name))
    if found is None:
        raise SessionError(
            f"{arg(name)}: the session has no recording with this name: `session info` lists the recordings."
        )
    return found

"""What a gravity calibration leaves in its session: computed from the recording, as the commands compute it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.calibration.files.calibration_file import load_calibration
from contactbench.pipeline.calibration.files.pose_csv import read_poses
from contactbench.pipeline.errors import arg
from contactbench.pipeline.session.adoption import RECORDING, next_recording
from contactbench.pipeline.session.files import wrong_with
from contactbench.pipeline.session.journal import SessionError
from contactbench.pipeline.session.recompute import compute
from contactbench.pipeline.workbench.gravity_fit import (
    CALIBRATION_FILE,
    POSES_FILE,
    GravityFinding,
    PoseRow,
    calibrated_rows,
    findings,
    gravity_settings,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from contactbench.pipeline.calibration import Calibration, PoseSample
    from contactbench.pipeline.session import Session, State
    from contactbench.pipeline.session.state import Input, Result

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
    return name, read_poses(session.folder / part.file.path).poses


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
    flange = read_poses(folder / poses.file.path).poses
    found = () if len(flange) != len(fitted.poses) else findings(flange, fitted, gravity_settings(state))
    return GravityOutcome(fitted, rows, "" if used is None else used.name, left, found)


def _earlier_count(folder: Path, state: State, poses: Result) -> int:
    before = state.result_with(poses.action.inputs.get("earlier", ""))
    return 0 if before is None else len(read_poses(folder / before.file.path).poses)


def _recording(state: State, name: str) -> Input:
    found = state.current_inputs.get((RECORDING, name))
    if found is None:
        raise SessionError(
            f"{arg(name)}: the session has no recording with this name: `session info` lists the recordings."
        )
    return found

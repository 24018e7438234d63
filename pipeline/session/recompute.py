"""
How each kind of result is computed from inputs and parameters; the same ones give the same bytes.

A function reads its inputs where they lie in the session, under the names they came with, because some of those names
are written into results, and gives the result's files. The parameters are those of the command of the same purpose,
lengths in mm.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Container, Iterable, Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from enum import StrEnum
from math import nan
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import BaseModel, Field, TypeAdapter, ValidationError
from pydantic_core import from_json

from contactbench.pipeline.calibration.parameters import Parameters, check_roles
from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.files import NamedFile, Progress, unheard
from contactbench.pipeline.knobs import Three
from contactbench.pipeline.mesh.monitor import NOBODY, Monitor
from contactbench.pipeline.report.report_file import ReportParameters, report
from contactbench.pipeline.session.actions import TOOL, Record, ResultAdded, main_file
from contactbench.pipeline.session.files import touched_mark
from contactbench.pipeline.session.journal import SessionError
from contactbench.pipeline.settings import CalibrationSettings, CapturesSettings, ProbeSettings
from contactbench.pipeline.verification.known_check import TOUCH_ROLES, WEIGHT_ROLES
from contactbench.pipeline.verification.known_touch import TouchParameters, known_touch
from contactbench.pipeline.verification.known_weight import WeightParameters, known_weight
from contactbench.pipeline.verification.result import REFERENCE, VerificationParameters, verification
from contactbench.pipeline.verification.result import ROLES as VERIFICATION_ROLES

if TYPE_CHECKING:
    from pathlib import Path

    from contactbench.pipeline.calibration import PoseSample
    from contactbench.pipeline.calibration.files.capture_file import Captured
    from contactbench.pipeline.files import File
    from contactbench.pipeline.session.state import Result, State
    from contactbench.pipeline.session.store import Session

FEWEST_POSES = 3

# Of a recording's own clock, which may have run for years.
Moment = Annotated[float, Field(ge=-1e15, le=1e15, allow_inf_nan=False)]


class CapturesParameters(CapturesSettings, Parameters):
    """As the options of ``contactbench calibrate captures``."""

    endings = (".csv",)

    leave_out: tuple[Moment, ...] = ()  # s, on the recording's clock: captures in which one lies are left out
    partial: bool = False  # More poses will follow in another recording: fewer than three do


def captures(
    inputs: Mapping[str, File],
    parameters: Mapping[str, Any],
    _created: str | None,
    *,
    tell: Callable[[str], None] | None = None,
) -> dict[str, bytes]:
    """
    Find the still poses of ``recording``: the bytes that ``contactbench calibrate captures`` writes.

    Where the robot was recorded into a table of its own, that is ``robot_poses``. Those of ``earlier``, a table of the
    same run before it was interrupted, come first. `tell` gets what was noticed and left out, sentence by sentence.
    """
    from contactbench.pipeline.calibration.files.calibration_file import load_calibration
    from contactbench.pipeline.calibration.files.capture_file import capture_poses
    from contactbench.pipeline.calibration.files.pose_csv import encode_poses
    from contactbench.pipeline.calibration.orientation import convention_of

    given = CapturesParameters.checked(parameters)
    check_roles(inputs, ("recording",), ("calibration", "earlier", "robot_poses"))
    recording = inputs["recording"]
    model = load_calibration(inputs["calibration"]).model if "calibration" in inputs else None
    found = capture_poses(
        recording,
        convention_of(given),
        robot_poses=inputs.get("robot_poses"),
        R_ES=given.R_ES,
        model=model,
        delay=given.delay,
    )
    if tell is not None:
        for sentence in (*found.warnings, *found.left_out):
            tell(sentence)
    before = _earlier(inputs["earlier"]) if "earlier" in inputs else ()
    poses = (*before, *_chosen(found, given.leave_out, len(before)))
    fewest = 1 if given.partial else FEWEST_POSES
    if len(poses) < fewest:
        why = join(
            "",
            (
                message(f" {arg(each.start):.1f} to {arg(each.stop):.1f} s: {arg(each.reason)}")
                for each in found.rejected[:3]
            ),
        )
        left = message(f", {arg(len(given.leave_out))} left out") if given.leave_out else ""
        needs = (
            message(f"a calibration needs {arg(FEWEST_POSES)}")
            if fewest == FEWEST_POSES
            else message("there is nothing to keep")
        )
        raise SessionError(
            f"{arg(recording.name)}: {arg(len(poses))} still poses{arg(left)}, {arg(needs)}: hold more poses still for"
            f" a few seconds.{arg(why)}"
        )
    return {given.name: encode_poses(poses, given.name)}


def _earlier(file: File) -> tuple[PoseSample, ...]:
    from contactbench.pipeline.calibration.files.pose_csv import read_poses

    # Their times are on another recording's clock.
    return tuple(replace(pose, time=None) for pose in read_poses(file).poses)


def _chosen(found: Captured, leave_out: tuple[float, ...], before: int) -> tuple[PoseSample, ...]:
    """Return the poses in which none of those moments lies, numbered from the ones before on."""
    spans = [(capture.start, capture.stop) for capture in found.captures]
    kept = [
        pose
        for pose, (start, stop) in zip(found.poses, spans, strict=True)
        if not any(start <= moment <= stop for moment in leave_out)
    ]
    if not leave_out and not before:
        return tuple(kept)
    return tuple(
        replace(pose, name=message(f"pose {arg(number)} at {arg(pose.name.partition(' at ')[2])}"))
        for number, pose in enumerate(kept, before + 1)
    )


class CalibrationParameters(CalibrationSettings, Parameters):
    """As the options of ``contactbench calibrate fit``."""


def calibration(
    inputs: Mapping[str, File], parameters: Mapping[str, Any], created: str | None
) -> dict[str, bytes]:
    """Calibrate from ``poses``: the bytes that ``contactbench calibrate fit`` writes at that time."""
    from contactbench.pipeline.calibration.assumptions import fitted
    from contactbench.pipeline.calibration.files.calibration_file import encode_calibration
    from contactbench.pipeline.calibration.files.capture_file import is_recording
    from contactbench.pipeline.calibration.files.pose_csv import is_recorded_table, read_poses
    from contactbench.pipeline.calibration.orientation import convention_of

    given = CalibrationParameters.checked(parameters)
    check_roles(inputs, ("poses",))
    poses = inputs["poses"]
    if is_recording(poses) or is_recorded_table(poses):
        raise SessionError(
            f"{arg(poses.name)} is a recording, not a table of still poses: add it with --kind recording, and compute"
            " captures from it first."
        )
    found, _, mount = fitted(read_poses(poses, convention_of(given), R_ES=given.R_ES), given)
    time = None if created is None else datetime.fromisoformat(created)
    return {given.name: encode_calibration(found, given.name, source=poses, created=time, mount=mount)}


class ProbeParameters(ProbeSettings, Parameters):
    """As the options of ``contactbench probe prepare``."""

    endings = (".ply",)


def probe(
    inputs: Mapping[str, File],
    parameters: Mapping[str, Any],
    _created: str | None,
    *,
    monitor: Monitor = NOBODY,
    remember: bool = False,
) -> dict[str, bytes]:
    """
    Prepare a probe from ``mesh``: the bytes that ``contactbench probe prepare`` writes.

    ``alignment`` and ``regions`` may be left out. See `contactbench.pipeline.preparation.prepare.prepared`.
    """
    from contactbench.pipeline.mesh.sidecar import encode_probe_file
    from contactbench.pipeline.preparation.prepare import prepared

    check_roles(inputs, ("mesh",), ("alignment", "regions"))
    given = ProbeParameters.checked(parameters)
    done = prepared(inputs, given, monitor=monitor, remember=remember)
    return encode_probe_file(done.content, given.name)


@dataclass(frozen=True)
class Roles:
    """The roles of a kind's inputs."""

    needed: tuple[str, ...]  # Without one of them nothing is computed
    optional: tuple[str, ...] = ()  # Taken where the session has them
    on_request: tuple[str, ...] = ()  # Taken only where somebody names them


@dataclass(frozen=True)
class Computation:
    """How results of a kind are computed."""

    make: Callable[..., dict[str, bytes]]  # Of inputs by role, parameters, and the time to write
    parameters: type[BaseModel]
    roles: Roles
    takes: tuple[str, ...] = ()  # Which of `monitor`, `remember` and `tell` it also takes


_CHECKS = ("known_weight", "known_touch")
RECOMPUTE: dict[str, Computation] = {
    "captures": Computation(
        captures,
        CapturesParameters,
        # Poses of an interrupted run, which come first.
        Roles(("recording",), on_request=("earlier", "robot_poses")),
        ("tell",),
    ),
    "calibration": Computation(calibration, CalibrationParameters, Roles(("poses",))),
    # Takes long: it tells how far it is, can be stopped, and may go on from what was computed before.
    "probe": Computation(
        probe, ProbeParameters, Roles(("mesh",), ("alignment", "regions")), ("monitor", "remember")
    ),
    "known_weight": Computation(known_weight, WeightParameters, Roles(WEIGHT_ROLES)),
    "known_touch": Computation(known_touch, TouchParameters, Roles(TOUCH_ROLES)),
    "verification": Computation(
        verification, VerificationParameters, Roles(VERIFICATION_ROLES, (REFERENCE,))
    ),
    "report": Computation(
        report, ReportParameters, Roles(("verification", "probe"), ("calibration", *_CHECKS))
    ),
}
# Nothing keeps a heatmap as a result; what one is made from is chosen in the same way.
_HEATMAP = Roles(("recording", "probe", "calibration"))
_READINGS = frozenset({"unloaded", "loaded", "touch"})
# What of a role a result of another kind can be.
_COMPUTED = {
    "poses": "captures",
    "earlier": "captures",
    "probe": "probe",
    "calibration": "calibration",
    "verification": "verification",
    "known_weight": "known_weight",
    "known_touch": "known_touch",
}


def compute(
    session: Session,
    kind: str,
    name: str,
    inputs: Mapping[str, str],
    parameters: Mapping[str, Any],
    *,
    monitor: Monitor = NOBODY,
    tell: Callable[[str], None] | None = None,
) -> Record:
    """
    Compute a result from what the session holds, and record it.

    Parameters
    ----------
    session : Session
        Open for writing.
    kind, name : str
        The kind is one of RECOMPUTE; for a probe and a calibration the name is the file's.
    inputs : mapping
        Role -> hash; see `newest_inputs`.
    parameters : mapping
        See the kind.
    monitor : Monitor
        Of what takes long.
    tell : callable, optional
        Gets what was noticed on the way and left out, sentence by sentence.

    Raises
    ------
    InputError
        Nothing here computes that kind, an input is missing, or the computation refuses them.
    Cancelled
        The caller cancelled; nothing was recorded.
    """
    created = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    if kind == "report":
        parameters = {**_known_of(session), **parameters}
    files = recomputed(
        session.folder,
        session.state,
        kind,
        inputs,
        {**parameters, "name": name},
        created,
        monitor=monitor,
        tell=tell,
    )
    return session.add_result(kind, name, files, inputs, parameters, created=created)


def _known_of(session: Session) -> dict[str, Any]:
    """Return what a report can take from its session: who, of which one, and with which sensor."""
    state = session.state
    known = {each.sensor: each.name for each in state.current_inputs.values() if each.sensor}
    named = {
        message(f"sensor of {arg(name)}") if len(known) > 1 else "sensor": serial
        for serial, name in known.items()
    }
    # What is chosen on the page of devices, or for the bundle, is of the same sensor and the same people.
    chosen = {key: state.setting(key) for key in ("devices.serial", "config.sensor", "config.operator")}
    if not named and chosen["devices.serial"]:
        named = {"sensor": str(chosen["devices.serial"])}
    return {
        "operator": chosen["config.operator"] or session.records[-1].entry.by,
        "sensor": chosen["config.sensor"] or "",
        "session": state.id,
        "serials": named,
        **settings_of(state, "report"),
    }


def newest_inputs(state: State, kind: str, chosen: Mapping[str, str] | None = None) -> dict[str, str]:
    """
    Return what a result of a kind would be computed from: role -> `Input.content` or `Result.content`.

    Parameters
    ----------
    state : State
    kind : str
        One of RECOMPUTE, or ``heatmap``.
    chosen : mapping, optional
        Role -> name of an input or result instead of the newest one; an empty name: none. A report's probe and
        calibration are by themselves those of its verification.

    Raises
    ------
    SessionError
        Nothing here computes that kind, or there is nothing to compute it from.
    """
    if kind not in RECOMPUTE and kind != "heatmap":
        raise SessionError(
            f"{arg(kind)}: this kind of result cannot be computed: choose one of {arg(', '.join(RECOMPUTE))}."
        )
    chosen = chosen or {}
    roles = RECOMPUTE[kind].roles if kind in RECOMPUTE else _HEATMAP
    asked = tuple(role for role in roles.on_request if chosen.get(role))
    known = (*roles.needed, *roles.optional, *asked)
    if strangers := sorted(set(chosen) - {*known, *roles.on_request}):
        every = ", ".join((*roles.needed, *roles.optional, *roles.on_request))
        raise SessionError(f"{arg(strangers[0])}: a {arg(kind)} is computed from {arg(every)}.")
    found: dict[str, str] = {}
    for role in known:
        # A report is about what was verified, also when there is a newer probe or calibration by now.
        made = state.result_with(found.get("verification", "")) if kind == "report" else None
        verified = made.action.inputs.get(role, "") if made is not None and role not in chosen else ""
        newest = verified or _newest(state, role, chosen.get(role))
        if newest:
            found[role] = newest
        elif role in roles.needed or chosen.get(role):
            name = f" called {chosen[role]}" if chosen.get(role) else ""
            raise SessionError(f"this session has no {arg(role)}{arg(name)}: add it with --kind {arg(role)}.")
    return found


def _newest(state: State, role: str, name: str | None) -> str:
    # What the window records is a recording, whatever it is of: then it goes by its name.
    kinds = {role, "recording"} if role in _READINGS and name else {role}
    inputs = [each for each in state.current_inputs.values() if each.kind in kinds]
    results = [each for each in state.current_results.values() if each.action.kind == _COMPUTED.get(role, "")]
    known = {each.number: (each.name, each.content) for each in inputs}
    known |= {each.number: (each.action.name, each.content) for each in results}
    fitting = [number for number, (called, _) in known.items() if name is None or called == name]
    return known[max(fitting)][1] if fitting else ""


def recomputed(
    folder: Path,
    state: State,
    kind: str,
    inputs: Mapping[str, str],
    parameters: Mapping[str, Any],
    created: str | None,
    before: int | None = None,
    *,
    monitor: Monitor = NOBODY,
    tell: Callable[[str], None] | None = None,
) -> dict[str, bytes]:
    """
    Return the files that a computation gives; the parameter ``name`` says what the main one is called.

    `before` is the record up to which inputs are looked for: what was added later under the same hash may have
    another name, and names are written into results. For `monitor` and `tell` see `compute`.
    """
    if kind not in RECOMPUTE:
        raise SessionError(
            f"{arg(kind)}: this kind of result cannot be computed. Known: {arg(', '.join(RECOMPUTE))}."
        )
    files = inputs_of(folder, state, inputs, before)
    marks = _marks(files)
    # Whoever looks at the past checks results, and has everything computed anew.
    offered = {"monitor": monitor, "remember": before is None, "tell": tell}
    done = RECOMPUTE[kind]
    try:
        made = done.make(files, parameters, created, **{name: offered[name] for name in done.takes})
    except InputError as error:
        raise SessionError(*error.args) from error
    if _marks(files) != marks:  # a file of a session never changes: somebody else wrote it
        raise SessionError(f"{arg(folder)}: an input changed while it was read: run `session verify`.")
    return made


def parameter_of(kind: str, parameter: str, given: Mapping[str, Any]) -> Any:
    """Return a parameter as a computation gets it, also when it is left out; as it is where nobody knows it."""
    if kind not in RECOMPUTE or parameter not in RECOMPUTE[kind].parameters.model_fields:
        return given.get(parameter)
    known = RECOMPUTE[kind].parameters
    chosen = {parameter: given[parameter]} if parameter in given else {}
    try:
        return getattr(known.model_validate({"name": "-", **chosen}), parameter)
    except ValidationError:
        return given.get(parameter)


def settings_of(state: State, kind: str) -> dict[str, Any]:
    """Return the parameters that the session's settings give a computation; those set to null are left out."""
    known = RECOMPUTE[kind].parameters.model_fields if kind in RECOMPUTE else {}
    return chosen_of(state, kind, known)


def chosen_of(state: State, kind: str, known: Container[str]) -> dict[str, Any]:
    """Return those of the known settings ``kind.parameter`` that a session has; those set to null are left out."""
    named = state.named(kind).items()
    return {name: each.value for name, each in named if name in known and each.value is not None}


def mount_of(state: State) -> Three | None:
    """
    Return how a session says that its sensor is mounted, degrees about the fixed axes x, y, z; None: it does not.

    Raises
    ------
    SessionError
        What it says is not three angles.
    """
    given = state.setting("devices.mount")
    if given is None:
        return None
    try:
        angles: Three = TypeAdapter(Three).validate_python(given)
    except ValidationError:
        raise SessionError(
            "devices.mount: set it to three angles, degrees about the fixed axes x, y, z."
        ) from None
    return angles


def inputs_of(
    folder: Path, state: State, inputs: Mapping[str, str], before: int | None = None
) -> dict[str, NamedFile]:
    """
    Find inputs, with what belongs to them: each where it lies in the session, under the name it came with.

    Parameters
    ----------
    folder : Path
        Of the session.
    state : State
    inputs : mapping
        Role -> hash; see `newest_inputs`.
    before : int, optional
        See `recomputed`.

    Returns
    -------
    dict of str to NamedFile
        The main file by role.

    Raises
    ------
    SessionError
        The session does not hold one of them, or it cannot be read.
    """
    return {role: _named(folder, state, sha256, before) for role, sha256 in inputs.items()}


def _named(folder: Path, state: State, sha256: str, before: int | None) -> NamedFile:
    used = state.input_with(sha256, before)
    made = None if used is not None else state.result_with(sha256, before)
    if used is not None:
        names, main = {used.name: used.file, **used.companions}, used.name
    elif made is not None:  # with what belongs to it, such as the names of a probe's regions
        names, main = dict(made.action.files), main_file(made.action)
    else:
        raise SessionError(f"the session contains nothing with the hash {arg(sha256[:12])}: add it first.")
    places = {name: folder / ref.path for name, ref in names.items()}
    try:
        for place in places.values():
            place.open("rb").close()
    except OSError as error:
        raise SessionError(
            f"{arg(folder)}: an input cannot be read ({arg(error)}): run `session verify`."
        ) from error
    return NamedFile(places[main], main, places)


def _marks(files: Mapping[str, NamedFile]) -> list[tuple[int, int, int] | None]:
    return [touched_mark(place) for file in files.values() for place in file.beside.values()]


# ---- computed once more ---------------------------------------------------------------------------


class ReplayOutcome(StrEnum):
    """What computing a result again gave."""

    SAME = "same"
    DIFFERENT = "different"
    FAILED = "failed"
    UNKNOWN = "unknown"  # nothing here computes this kind


@dataclass(frozen=True)
class Replayed:
    """One result, computed again."""

    kind: str
    name: str
    number: int  # Of its record
    outcome: ReplayOutcome
    sentence: str  # What came of it


def replay(session: Session, progress: Progress = unheard) -> tuple[Replayed, ...]:
    """
    Compute every result of a session again, also replaced and stale ones; adds nothing to it.

    Parameters
    ----------
    session : Session
        Open for reading or writing.
    progress : callable, optional
        Takes the number of results that are done, and of all.

    Returns
    -------
    tuple of Replayed
        Oldest first.
    """
    found = []
    results = session.state.results
    for done, result in enumerate(results, 1):
        outcome, why = _again(session, result)
        found.append(Replayed(*result.slot, result.number, outcome, f"{result.title}: {why}"))
        progress(done, len(results))
    return tuple(found)


def _again(session: Session, result: Result) -> tuple[ReplayOutcome, str]:
    action = result.action
    if action.kind not in RECOMPUTE:
        return ReplayOutcome.UNKNOWN, message(
            "this kind of result cannot be computed here, so it was not compared."
        )
    parameters = {**action.parameters, "name": action.name}
    try:
        files = recomputed(
            session.folder,
            session.state,
            action.kind,
            action.inputs,
            parameters,
            action.created,
            before=result.number,
        )
    except InputError as error:
        return ReplayOutcome.FAILED, message(f"it cannot be recomputed: {arg(error)}")
    differing = sorted(
        name
        for name in files.keys() | action.files.keys()
        if name not in files
        or name not in action.files
        or hashlib.sha256(files[name]).hexdigest() != action.files[name].sha256
    )
    if not differing:
        return ReplayOutcome.SAME, message("identical bytes.")
    older = (
        "" if result.tool == TOOL else message(f" It was made by {arg(result.tool)}, this is {arg(TOOL)}.")
    )
    moved = _moved(session.folder, action, files) if action.kind == "verification" else ""
    return ReplayOutcome.DIFFERENT, message(
        f"different bytes in {arg(', '.join(differing))}.{arg(moved)}{arg(older)}"
    )


def _moved(folder: Path, action: ResultAdded, files: Mapping[str, bytes]) -> str:
    """Say how far the contacts of a verification moved; empty where its file cannot be read."""
    name = main_file(action)
    try:
        texts = (folder / action.files[name].path).read_bytes(), files[name]
        before, now = (
            [each.get("point_mm") or 3 * [nan] for each in from_json(text)["touches"]] for text in texts
        )
        if len(before) != len(now):
            return message(f" It finds {arg(len(now))} touches, and found {arg(len(before))}.")
        moved = np.nan_to_num(np.linalg.norm(np.subtract(before, now), axis=1)).max()
    except (OSError, KeyError, TypeError, ValueError, AttributeError):
        return ""
    return message(f" Contacts moved by up to {arg(moved):.3g} mm.")


# ---- what belongs to an input: files beside it, and what it says about itself --------------------


def companions_of(file: Path, more: Iterable[Path] = ()) -> dict[str, Path]:
    """
    Return what belongs beside a file: name -> path. The JSON file of a probe's PLY file is found by itself.

    Raises
    ------
    SessionError
        Two of them, or one and the file, have the same name.
    """
    from contactbench.pipeline.mesh.sidecar import sidecar_of  # slow to import

    found = [*more]
    if _has_sidecar(file) and sidecar_of(file).name not in {each.name for each in found}:
        found.append(sidecar_of(file))
    names = [each.name.casefold() for each in (file, *found)]
    if len(set(names)) < len(names):
        raise SessionError(f"{arg(file)}: two files of one input have the same name: rename one.")
    return {each.name: each for each in found}


def _has_sidecar(file: Path) -> bool:
    """Tell whether a JSON file beside a PLY file says that it is a probe's."""
    from contactbench.pipeline.mesh.sidecar import SCHEMA, read_document, sidecar_of  # slow to import

    if file.suffix.lower() != ".ply" or not sidecar_of(file).is_file():
        return False
    try:
        return read_document(sidecar_of(file)).get("schema") == SCHEMA
    except InputError:  # another program's file; who needs it names it
        return False


def about_of(file: Path) -> dict[str, str]:
    """Return what is known about an input by itself: of a recording, when it was started. Empty for other files."""
    if file.suffix.lower() != ".mcap":
        return {}
    from contactbench.pipeline.recording import RecordingReader  # slow to import

    try:
        with RecordingReader(file) as reader:
            started_ns = reader.info.started_ns
        return {"started": datetime.fromtimestamp(started_ns / 1e9, UTC).isoformat()}
    except (InputError, ValueError, OverflowError, OSError):  # whoever computes from it says what is wrong
        return {}

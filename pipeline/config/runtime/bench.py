"""
What an export takes from files of the bench and from a session.

A session is known here by what it offers, not by its class: sessions are a layer above.
"""

import hashlib
import tempfile
from dataclasses import replace
from datetime import UTC, datetime
from math import hypot, inf
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Protocol

import numpy as np

from contactbench.pipeline.calibration import Calibration
from contactbench.pipeline.calibration.files.calibration_file import CalibrationRecord, load_record
from contactbench.pipeline.config.runtime.build import build_config
from contactbench.pipeline.config.runtime.checks import (
    CHECK_KINDS,
    checks_of,
    gate_reasons,
    made_with_others,
    model_reasons,
    read_check,
    read_verification,
)
from contactbench.pipeline.config.runtime.config import RuntimeConfig
from contactbench.pipeline.config.runtime.model import ChecksPart, SensorPart, SourcePart
from contactbench.pipeline.config.runtime.mounts import (
    UNTURNED,
    Mounts,
    mount_of,
    mount_of_angles,
    mount_reasons,
)
from contactbench.pipeline.config.runtime.options import ExportOptions
from contactbench.pipeline.contact.touch_model import TouchModel, WrenchNoise
from contactbench.pipeline.errors import ConfigError, RateUnknownError, arg, message
from contactbench.pipeline.files import read_bytes
from contactbench.pipeline.mesh.sidecar import ProbeFile, load_probe_file
from contactbench.pipeline.touch_settings import arm_of

_LARGEST_FILE = 512 * 2**20
# Seconds since 1970: times of poses from here on are a clock's, earlier ones count from some beginning.
_CLOCK_BEGINS = datetime(2000, 1, 1, tzinfo=UTC).timestamp()


def export_from_files(
    calibration: Path,
    probe: Path,
    verification: Path | None,
    report: Path | None,
    options: ExportOptions,
    *,
    created: datetime,
    known_weight: Path | None = None,
    known_touch: Path | None = None,
    unverified: bool = False,
) -> RuntimeConfig:
    """
    Build a config of files.

    Parameters
    ----------
    calibration, probe : path
        JSON, and PLY with its JSON beside it.
    verification, report : path, optional
        JSON of ``contactbench verify touches``, and the HTML report.
    options : ExportOptions
    created : datetime
    known_weight, known_touch : path, optional
        JSON of ``contactbench calibrate check``.
    unverified : bool
        See `build_config`.

    Raises
    ------
    UnverifiedError, InputError
        As `build_config`, or a file cannot be used.
    """
    checked = dict(zip(CHECK_KINDS, (known_weight, known_touch), strict=True))
    used = [("calibration", calibration), ("probe", probe), ("verification", verification), *checked.items()]
    sources = [_source(role, file.name, _read(file)) for role, file in used if file is not None]
    hashes = {source.role: {source.sha256} for source in sources}
    checks, stale = {}, []
    for kind, file in checked.items():
        if file is not None:
            checks[kind], made_with = read_check(kind, _read(file), str(file))
            stale += made_with_others(kind, made_with, hashes)
    return _built(
        load_record(calibration),
        load_probe_file(probe),
        None if verification is None else _read(verification),
        None if report is None else _read(report),
        options,
        session=None,
        created=created,
        sources=sources,
        checks=checks_of(checks),
        stale=stale,
        mounts=Mounts(),
        unverified=unverified,
    )


def _built(
    record: CalibrationRecord,
    probe_file: ProbeFile,
    verification: bytes | None,
    report: bytes | None,
    options: ExportOptions,
    *,
    session: str | None,
    created: datetime,
    sources: list[SourcePart],
    checks: ChecksPart,
    stale: list[str],
    mounts: Mounts,
    unverified: bool,
) -> RuntimeConfig:
    checked, rate, error, follow = None, options.rate, None, bool(options.follow)
    mount = options.quaternion_ES or mount_of(record) or mounts.calibrated
    arm = arm_of(None if options.torsion_arm_mm is None else options.torsion_arm_mm / 1e3, options.scene)
    if verification is not None:
        checked, verified = read_verification(verification, "verification")
        mounts = replace(mounts, verified=verified.mount or mounts.verified)
        stale = [*stale, *_others(verified.sources, sources)]
        rate, error = rate or verified.rate, verified.model_error
        follow = verified.follow if options.follow is None else follow
        stale += gate_reasons(verified.gates, options.gates)
        if rate is not None:
            stale += model_reasons(verified, rate, options.filters(rate), options.noise, arm, follow=follow)
    if rate is None:
        raise RateUnknownError("the sensor's sample rate is unknown: give the rate it is set to with --rate.")
    stale += mount_reasons(mount, mount_of(record) or mounts.calibrated, mounts.verified)
    return build_config(
        record.calibration,
        probe_file,
        sensor=SensorPart(model=options.sensor, serial=options.serial or "unknown", rate_Hz=rate),
        noise=options.noise or reading_noise(record.calibration),
        filters=options.filters(rate),
        gates=options.gates,
        mount=mount,
        limits=options.limits,
        controller=options.controller,
        verification=checked,
        report=report,
        operator=options.operator or "unknown",
        session=session,
        created=created,
        sources=sources,
        model=TouchModel(
            arm,
            TouchModel().model_error if error is None else error,
            mesh_deviation(probe_file),
            torsion_learned=options.torsion == "learned",
            scene=options.scene,
        ),
        measured=error is not None,
        zeroed=_zeroed(record),
        follow=follow,
        checks=checks,
        stale=tuple(stale),
        names=options.names,
        unverified=unverified,
    )


def _zeroed(record: CalibrationRecord) -> datetime | None:
    """Return when the bias was measured: the time of the last pose, where a clock gave it; else of the calibration."""
    created = record.created
    times = [pose.time for pose in record.calibration.poses if pose.time is not None]
    if created is None or not times or not _CLOCK_BEGINS <= max(times) <= created.timestamp():
        return created
    return datetime.fromtimestamp(max(times), UTC)


def _others(verified: dict[str, str], sources: list[SourcePart]) -> list[str]:
    """Say which files are not those that were verified, or not known to be."""
    hashes = {source.sha256 for source in sources}
    said = []
    for role in ("calibration", "probe"):
        if role not in verified:
            said.append(message(f"The verification does not state its {arg(role)}: verify again."))
        elif verified[role] not in hashes:
            said.append(message(f"The verification used another {arg(role)}: verify again."))
    return said


def _read(file: Path) -> bytes:
    data = read_bytes(file, _LARGEST_FILE, ConfigError)
    if len(data) > _LARGEST_FILE:
        raise ConfigError(
            f"{arg(file)}: the file is larger than {arg(_LARGEST_FILE >> 20)} MiB: choose another."
        )
    return data


def _source(role: str, name: str, data: bytes) -> SourcePart:
    return SourcePart(role=role, name=name, sha256=hashlib.sha256(data).hexdigest())


def reading_noise(calibration: Calibration) -> WrenchNoise:
    """Return the scatter of single readings within the poses, root mean square; `WrenchNoise`'s own if unknown."""
    force = [pose.force_sd for pose in calibration.poses if pose.force_sd is not None]
    torque = [pose.torque_sd for pose in calibration.poses if pose.torque_sd is not None]
    if not force or not torque:
        return WrenchNoise()
    sigmas = [np.sqrt(np.mean(np.square(each), axis=0)) for each in (force, torque)]
    return WrenchNoise(*sigmas) if all((each > 0).all() for each in sigmas) else WrenchNoise()


def mesh_deviation(probe_file: ProbeFile) -> float:
    """
    Return the root mean square between a probe and the surface that it was simplified from, m; 0 if it never was.

    Raises
    ------
    ConfigError
        The history states no such length.
    """
    total = 0.0
    for number, step in enumerate(probe_file.history, 1):
        if step["step"] != "simplify":
            continue
        try:
            rms = float(step["result"]["deviation"]["rms_mm"])
        except (KeyError, TypeError, ValueError):
            rms = -1.0
        if not 0 <= rms < inf:
            raise ConfigError(
                f"{arg(probe_file.probe.name)}: step {arg(number)} of its history, simplify, states no"
                " result.deviation.rms_mm: prepare the probe again."
            )
        total = hypot(total, rms / 1e3)
    return total


# ---- a session ---------------------------------------------------------------------------------


class SessionLike(Protocol):
    """What an export needs of a session."""

    folder: Path

    @property
    def state(self) -> Any:
        """Its current inputs and results."""

    @property
    def records(self) -> tuple[Any, ...]:
        """Everything that happened."""

    def stale(self) -> dict[tuple[str, str], tuple[str, ...]]:
        """Say of each current result why it is stale."""


def export_from_session(
    session: SessionLike, options: ExportOptions, *, unverified: bool = False
) -> RuntimeConfig:
    """
    Build a config of a session's newest calibration and probe, and their verification if there is one.

    It was made when the newest of what goes into it was, so that the same session gives the same bytes.

    Parameters
    ----------
    session : Session
    options : ExportOptions
    unverified : bool
        See `build_config`.

    Raises
    ------
    UnverifiedError
        Something is stale or rejected, was verified with another calibration or probe, or is reported of another
        verification; or as in `build_config`.
    ConfigError, InputError
        There is no calibration or no probe, or a value is out of its range.
    """
    calibration = _newest(session, "calibration", needed=True)
    probe = _newest(session, "probe", needed=True)
    verification = _newest(session, "verification")
    report = _newest(session, "report")
    used = [each for each in (calibration, probe, verification) if each is not None]
    stale = [reason for each in used for reason in _doubts(session, each)]
    checks, checked = _checks_of(session, calibration, probe)
    used += checked
    stale += _strangers(verification, (calibration, probe))
    if report is not None:
        stale += _doubts(session, report)
        if verification is not None and not set(report.action.inputs.values()) & verification.known_as:
            stale.append(
                message(f"{arg(report.title)} belongs to another verification: create the report again.")
            )
    folder = session.folder
    serials = {each.sensor for each in session.state.current_inputs.values() if each.sensor}
    serial = options.serial or (serials.pop() if len(serials) == 1 else None)
    newest = max((*used, report) if report is not None else used, key=lambda each: each.number)
    operator = options.operator or session.records[newest.number - 1].entry.by
    return _built(
        load_record(folder / calibration.file.path),
        _probe_of(folder, probe),
        None if verification is None else _read(folder / verification.file.path),
        None if report is None else _read(folder / report.file.path),
        options.model_copy(update={"serial": serial, "operator": operator}),
        session=session.state.id,
        created=datetime.fromisoformat(newest.at),
        sources=[
            SourcePart(role=each.action.kind, name=name, sha256=file.sha256)
            for each in used
            # As the journal has them, not as they were added.
            for name, file in sorted(each.action.files.items())
        ],
        checks=checks,
        stale=stale,
        mounts=_mounts(session, calibration, verification),
        unverified=unverified,
    )


def _checks_of(session: SessionLike, calibration: Any, probe: Any) -> tuple[ChecksPart, list[Any]]:
    """
    Return a session's checks, and the results that they are.

    One that is stale, was rejected or belongs to another calibration or probe says nothing of these: it counts as not
    done, whether it passed or failed.
    """
    hashes = {"calibration": calibration.known_as, "probe": probe.known_as}
    parts, used = {}, []
    for kind in CHECK_KINDS:
        found = _newest(session, kind)
        if found is None or _doubts(session, found):
            continue
        part, made_with = read_check(kind, _read(session.folder / found.file.path), found.title, found.at)
        if not made_with_others(kind, made_with, hashes):
            parts[kind] = part
            used.append(found)
    return checks_of(parts), used


def _mounts(session: SessionLike, calibration: Any, verification: Any) -> Mounts:
    """Say with which mountings a session's results were made, as far as its parameters tell."""
    used = set(calibration.action.inputs.values())
    made = [
        each.action
        for each in session.state.current_results.values()
        if each.action.kind == "captures" and used & each.known_as
    ]
    found = [mount_of_angles(each.parameters.get("mount")) for each in (calibration.action, *made)]
    # Poses that were turned when they were found are not turned again.
    known = next((mount for mount in found if mount is not None), None)
    if verification is None or not verification.action.parameters:  # made elsewhere
        return Mounts(known)
    return Mounts(known, mount_of_angles(verification.action.parameters.get("mount")) or UNTURNED)


def _newest(session: SessionLike, kind: str, *, needed: bool = False) -> Any:
    found = [each for each in session.state.current_results.values() if each.action.kind == kind]
    # A probe or a calibration may have been made elsewhere and brought in as it is.
    found += [_brought(each) for each in session.state.current_inputs.values() if each.kind == kind]
    if needed and not found:
        raise ConfigError(
            f"{arg(session.folder)}: there is no {arg(kind)}: add one, compute one with `contactbench"
            " session compute`, or name the files."
        )
    return max(found, key=lambda each: each.number, default=None)


def _brought(given: Any) -> Any:
    """Return an input of a session in the shape of a result: nothing of it was computed here, so nothing is stale."""
    files = {given.name: given.file, **given.companions}
    return SimpleNamespace(
        action=SimpleNamespace(kind=given.kind, name=given.name, files=files, inputs={}, parameters={}),
        title=f"{given.kind} {given.name}",
        number=given.number,
        at=given.at,
        file=given.file,
        known_as={given.file.sha256, given.content},
        mark=None,
        slot=None,
    )


def _probe_of(folder: Path, result: Any) -> ProbeFile:
    """Read a probe with its JSON file: in a session, files are not kept under their names."""
    with tempfile.TemporaryDirectory() as scratch:
        for name, file in result.action.files.items():
            (Path(scratch) / name).write_bytes(_read(folder / file.path))
        mesh = next((name for name in result.action.files if name.endswith(".ply")), result.action.name)
        return load_probe_file(Path(scratch) / mesh)


def _doubts(session: SessionLike, result: Any) -> list[str]:
    reasons = [
        message(f"{arg(result.title)}: {arg(reason)}")[:1000]
        for reason in session.stale().get(result.slot, ())
    ]
    if result.mark is not None and result.mark.mark == "rejected":
        reasons.append(message(f"{arg(result.title)} was rejected. {arg(result.mark.reason)}")[:1000])
    return reasons


def _strangers(verification: Any, rested_on: tuple[Any, ...]) -> list[str]:
    """Say which of calibration and probe a verification was not made with."""
    if verification is None:
        return []
    used = set(verification.action.inputs.values())
    return [
        message(
            f"{arg(verification.title)} was made with another {arg(each.action.kind)} than"
            f" {arg(each.action.name)}: verify again."
        )
        for each in rested_on
        if not used & each.known_as
    ]

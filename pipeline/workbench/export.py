"""A bundle of a session: what would be in it, what differs from the last one, and writing it."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from contactbench.pipeline.calibration.payload import Payload, payload_in_mm
from contactbench.pipeline.config.consumers import NO_ADMITTANCE, down_along_z
from contactbench.pipeline.config.runtime import ConfigError, RateUnknownError, RuntimeConfig
from contactbench.pipeline.config.runtime.bench import export_from_session
from contactbench.pipeline.config.runtime.build import calibration_refused
from contactbench.pipeline.config.runtime.checks import unchecked
from contactbench.pipeline.config.runtime.differ import Differences, differences
from contactbench.pipeline.config.runtime.model import SensorPart
from contactbench.pipeline.config.runtime.options import ExportOptions
from contactbench.pipeline.config.runtime.pack import CONFIG
from contactbench.pipeline.config.runtime.values import rotation_ES
from contactbench.pipeline.control.margins import weak_loops
from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.runtime.run import known
from contactbench.pipeline.session import Session, State
from contactbench.pipeline.session.files import file_problem
from contactbench.pipeline.session.recompute import chosen_of
from contactbench.pipeline.session.why import (
    NO_TROUBLE,
    RESULTS,
    CheckItem,
    SessionTrouble,
    broken_behind,
    checklist,
    files_of_bundle,
    refuse_without,
    regions_in_words,
    results_of,
)
from contactbench.pipeline.settings import PayloadSettings

SHA256, PLACE = "export.sha256", "export.place"
_SHOWN = 60
_MOST_DIFFERENCES = 12
# What is another in every bundle, and says nothing by itself.
_ALWAYS = ("provenance.", "probe.sha256", "planes.sha256")


@dataclass(frozen=True)
class ExportPreview:
    """A bundle as it would be written."""

    files: tuple[tuple[str, int], ...]  # (name, bytes)
    figures: tuple[tuple[str, str], ...]  # (what, value); For people, with units
    sha256: str  # Of contactbench.json, which holds the hashes of the others
    reasons: tuple[str, ...]  # Why it is not verified; empty: it is
    # What to do because neither a known weight nor a known touch told anything; empty: one did
    unchecked: str
    # What differs from the bundle that was exported before, in sentences; None: there is none, or it is gone
    changes: tuple[str, ...] | None
    config: RuntimeConfig


@dataclass(frozen=True)
class ExportView:
    """How an export stands."""

    items: tuple[CheckItem, ...]
    preview: ExportPreview | None
    problem: str = ""  # Why there is no preview; empty where there is one
    lacks: str = ""  # The option that somebody must give before there is one; empty: none


@dataclass(frozen=True)
class ExportedBundle:
    """A bundle that was written, and loaded again."""

    place: Path
    sha256: str  # Of its contactbench.json
    verified: bool
    sentence: str  # What loading it found


def survey(session: Session, trouble: SessionTrouble = NO_TROUBLE) -> ExportView:
    """Say what a bundle of a session, with what is wrong with it, would be; builds it in memory."""
    items = checklist(session.folder, session.state, session.stale(), trouble)
    if broken := broken_behind(session.state, trouble):
        return ExportView(items, None, broken)
    try:
        refuse_without(session.state)
        config = built(session, unverified=True)
        return ExportView(items, _preview(session, config))
    except RateUnknownError as error:
        return ExportView(items, None, str(error), lacks="rate")
    except InputError as error:
        return ExportView(items, None, str(error))


def built(session: Session, *, unverified: bool) -> RuntimeConfig:
    """
    Build what ``contactbench bundle export SESSION`` writes, to the byte.

    Raises
    ------
    UnverifiedError, InputError
        As `export_from_session`.
    """
    options = ExportOptions.stored(session.state.settings)
    return export_from_session(session, options, unverified=unverified)


def export(session: Session, place: Path, *, unverified: bool = False) -> ExportedBundle:
    """
    Write a session's bundle, load it as a runtime does, and write that down in the session.

    Parameters
    ----------
    session : Session
        Open for writing.
    place : Path
        A zip file if it ends in .zip, else a folder.
    unverified : bool
        Write it even if nobody has shown that it is right; it says so then.

    Raises
    ------
    UnverifiedError
        Nobody has, and `unverified` is False.
    ConfigError, InputError
        It cannot be made or written; what was at `place` stays.
    """
    refuse_broken(session)
    config = built(session, unverified=unverified)
    config.write(place)
    found = RuntimeConfig.load(place)
    sha256 = _sha256(found)
    if sha256 != _sha256(config):
        raise ConfigError(
            f"{arg(place)}: the bundle on disk differs from the one that was written: check the disk,"
            " then export again."
        )
    record(session, place, sha256, verified=found.model.verified)
    told = (_checked(found, place), *config.notes, *(said for said, _ in weak_loops(config)))
    return ExportedBundle(place, sha256, found.model.verified, join(" ", told))


def refuse_broken(session: Session) -> None:
    """InputError if a file behind the results that a bundle is made of is missing or damaged; reads them all."""
    for ref in files_of_bundle(session.state):
        if broken := file_problem(session.folder, ref):
            raise InputError(broken)


def record(session: Session, place: Path, sha256: str, *, verified: bool) -> None:
    """Write down that a bundle of the session's current results was exported."""
    standing = "verified" if verified else message("NOT verified")
    session.note(
        message(
            f"A bundle was exported to {arg(place)}: {arg(standing)}, SHA-256 of contactbench.json {arg(sha256)}."
        )
    )
    session.set_parameter(SHA256, sha256)
    session.set_parameter(PLACE, str(place))
    session.set_parameter(RESULTS, dict(results_of(session.state)))


def _sha256(config: RuntimeConfig) -> str:
    return hashlib.sha256(config.encoded()[CONFIG]).hexdigest()


def _checked(config: RuntimeConfig, place: Path) -> str:
    count = len(config.encoded())
    if config.model.verified:
        words = message(f"{arg(place)}: bundle verified, {arg(count)} files. Ready for a robot's runtime.")
        return message(f"{arg(words)} {arg(unchecked(config.model.checks))}").strip()
    return message(
        f"{arg(place)}: {arg(count)} files intact, but the bundle is NOT verified. A robot's runtime refuses"
        " it unless told otherwise; for trials only."
    )


def _preview(session: Session, config: RuntimeConfig) -> ExportPreview:
    files = tuple((name, len(content)) for name, content in config.encoded().items())
    reasons = () if config.model.verified else config.model.provenance.stale
    changes = _changes(session.state.settings, config)
    return ExportPreview(
        files,
        _figures(config),
        _sha256(config),
        tuple(reasons),
        unchecked(config.model.checks),
        changes,
        config,
    )


def _figures(config: RuntimeConfig) -> tuple[tuple[str, str], ...]:
    model = config.model
    regions = sorted(set(config.probe.region[config.probe.region > 0].tolist()))
    found = [
        (message("Sensor"), _sensor(model.sensor)),
        (message("Readings"), message(f"{arg(model.sensor.rate_Hz):g} readings per second")),
        (message("Payload"), f"{config.gravity.mass:.3f} kg"),
        (
            message("Probe"),
            message(
                f"{arg(model.probe.name)} with {arg(model.probe.facets):,} facets and"
                f" {arg(regions_in_words(len(regions)))}"
            ),
        ),
        (message("Limits"), f"{model.limits.max_force_N:g} N, {model.limits.max_torque_Nm:g} N·m"),
    ]
    if down_along_z(model.world.down_W) is None:
        found.append(("ROS 2", NO_ADMITTANCE))
    gains = model.controller
    if gains is not None:
        found.append((message("Gains"), f"{gains.desired_force_N:g} N, {gains.variant}"))
    part, error = model.verification, message("not verified")
    if part is not None:
        error = message(
            f"{arg(1e3 * part.mean_error_m):.2f} mm on average, {arg(1e3 * part.max_error_m):.2f} mm at most,"
            f" on {arg(part.markers)} markers"
        )
    found.append((message("Contact error"), error))
    found.append((message("Made by"), f"{model.provenance.operator}, {model.provenance.created}"))
    return tuple(found)


def _sensor(part: SensorPart) -> str:
    if not known(part.serial):
        return part.model if known(part.model) else message("model and serial number missing")
    number = message(f"serial number {arg(part.serial)}")
    return f"{part.model}, {number}" if known(part.model) else number


# ---- against the one before --------------------------------------------------------------------


def _changes(settings: Mapping[str, Any], config: RuntimeConfig) -> tuple[str, ...] | None:
    place = settings.get(PLACE)
    if place is None or not isinstance(place.value, str):
        return None
    try:
        before = RuntimeConfig.load(place.value)
    except ConfigError:  # moved, or another took its place: nothing to compare with
        return None
    return told(differences(before, config))


def told(found: Differences) -> tuple[str, ...]:
    """Say what differs, in sentences; what is another in every bundle only where nothing else is."""
    if found.same:
        return (message("Identical, byte for byte."),)
    fields = [each for each in found.fields if not each.field.startswith(_ALWAYS)]
    said = [
        message(f"{arg(each.field)}: {arg(_short(each.one))} → {arg(_short(each.other))}")
        + (message(f" ({arg(each.meaning)}).") if each.meaning else ".")
        for each in fields[:_MOST_DIFFERENCES]
    ]
    if len(fields) > _MOST_DIFFERENCES:
        said.append(
            message(
                f"{arg(len(fields) - _MOST_DIFFERENCES)} more fields differ: `contactbench bundle diff` lists them."
            )
        )
    if found.mesh is not None:
        one, other = found.mesh["facets"]
        said.append(
            message(
                f"The surfaces, of {arg(one):,} and {arg(other):,} facets, are at most"
                f" {arg(found.mesh['hausdorff_mm']):.3g} mm apart."
            )
        )
    if not said:
        said.append(message("Only origin and date differ."))
    return tuple(said)


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, list) and all(isinstance(each, int | float) for each in value) and len(value) <= 6:
        return "[" + ", ".join(f"{each:.4g}" for each in value) + "]"
    text = str(value)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"


# ---- the robot's payload --------------------------------------------------------------------------


PAYLOAD = "payload"  # The settings of a session begin with it: ``payload.sensor_at``


@dataclass(frozen=True)
class PayloadText:
    """What a robot is told."""

    line: str  # As its controller takes it
    payload: Payload
    mount_known: bool  # Somebody said how the sensor is turned on the flange; False: taken as not turned


def stored_payload(state: State) -> PayloadSettings:
    """Return what a session's settings say; InputError, with the first that is wrong."""
    return PayloadSettings.checked(chosen_of(state, PAYLOAD, PayloadSettings.model_fields))


def payload_text(config: RuntimeConfig, settings: PayloadSettings) -> PayloadText:
    """
    Return the payload that a bundle's calibration gives.

    Raises
    ------
    InputError
        The calibration was refused, or has no load.
    """
    if calibration_refused(config.model):
        raise InputError("The calibration is refused: calibrate again before you tell a robot its payload.")
    R_ES = rotation_ES(config.model.frames.quaternion_ES)
    made = payload_in_mm(
        config.gravity, np.eye(3) if R_ES is None else R_ES, settings.sensor_at, settings.sensor_body
    )
    return PayloadText(made.text(settings.robot), made, R_ES is not None)

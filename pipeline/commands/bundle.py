"""``contactbench bundle ...``: the bundle that a robot's runtime loads."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.options import (
    SensorAtArgument,
    SensorBodyOption,
    doubt_degrees,
    payload_told,
)
from contactbench.pipeline.console import Noun, answer, as_json, output_is_data, say, say_all, show_tables
from contactbench.pipeline.export_knobs import ExportKnobs
from contactbench.pipeline.settings import MountSettings, RobotMaker

if TYPE_CHECKING:
    from collections.abc import Mapping

    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.config.runtime.differ import Differences
    from contactbench.pipeline.config.runtime.options import ExportOptions

bundle_app = Noun("Export, check and compare the bundle that a robot's runtime loads.")

_NOT_GOOD_ENOUGH = 1
_SHOWN = 48
_SECONDS_AN_HOUR = 3600

BundleArgument = Annotated[Path, typer.Argument(metavar="BUNDLE", help="Folder or zip file.")]


@bundle_app.command(example="bundle export bench-1 --model M8128 --rate 1000 --out runtime.zip")
def export(
    session: Path | None = None,
    /,
    *,
    out: Path,
    chosen: ExportKnobs,
    calibration: Path | None = None,
    probe: Path | None = None,
    verification: Path | None = None,
    report: Path | None = None,
    known_weight: Path | None = None,
    known_touch: Path | None = None,
    settings: Path | None = None,
    unverified: bool = False,
) -> None:
    """Write a bundle: from a session's newest calibration and probe, or from files.

    For a session, missing options come from its settings config.*, such as config.serial, as in the
    desktop application; the same session then gives the same bytes.

    Refused, with exit code 1, unless contacts were verified on markers with this calibration and probe,
    and none of its inputs is stale; also if a known weight or a known touch failed. An earlier bundle at
    --out stays until the new one is complete.

    Parameters
    ----------
    out
        Folder to write, or a zip file if it ends in .zip.
    session
        Folder of a session.
    calibration
        JSON file of calibrate fit.
    probe
        PLY file of probe prepare.
    verification
        JSON file of verify touches.
    report
        HTML report to include.
    known_weight
        JSON file of calibrate check weight.
    known_touch
        JSON file of calibrate check touch.
    settings
        JSON file with any of: controller, limits, gates, filters.
    unverified
        Write the bundle anyway, marked as unverified: for trials only.
    """
    files = _inputs(session, calibration, probe, verification, report, known_weight, known_touch)
    from contactbench.pipeline.calibration.files.calibration_file import creation_time
    from contactbench.pipeline.config.runtime import UnverifiedError
    from contactbench.pipeline.config.runtime.bench import export_from_files

    if chosen.rate is None and chosen.cutoff is not None and session is None:
        raise typer.BadParameter("--cutoff needs --rate.")
    said = {name: getattr(chosen, name) for name in chosen.model_fields_set}
    try:
        if session is not None:
            made = _of_session(session, said, settings, unverified)
        else:
            made = export_from_files(
                *files,
                verification,
                report,
                _settings({}, said, settings),
                created=creation_time(),
                known_weight=known_weight,
                known_touch=known_touch,
                unverified=unverified,
            )
    except UnverifiedError as error:
        say(f"error: {error}", "red")
        answer({"error": str(error), "reasons": list(error.reasons)})
        raise typer.Exit(_NOT_GOOD_ENOUGH) from None
    made.write(out)
    say(f"{out}: {len(made.probe.faces):,} facets, {_standing(made)}.")
    _say_doubts(made)
    answer({"out": str(out), **_facts(made), "warnings": [*made.notes, *_weak(made)]})


@bundle_app.command(example="bundle check runtime.zip --json")
def check(bundle: BundleArgument) -> None:
    """Load a bundle as a runtime does, replay its test vectors, and describe it.

    Exit code 1: the bundle is intact but not verified; 2: it is refused.
    """
    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.config.runtime.self_test import replay
    from contactbench.pipeline.runtime.run import known, sensor_name

    found = RuntimeConfig.load(bundle)
    model, replayed = found.model, replay(found, str(bundle))
    say(
        f"{bundle}: intact, version {model.version}, {_standing(found)}.",
        "green" if model.verified else "yellow",
    )
    by = f" by {model.provenance.operator}" if known(model.provenance.operator) else ""
    sensor = sensor_name(model.sensor.model, model.sensor.serial)
    say(
        f"For {'the ' + sensor if sensor else 'a sensor that nobody named'} at {model.sensor.rate_Hz:g} Hz with"
        f" the probe {model.probe.name} ({model.probe.facets:,} facets); exported"
        f" {model.provenance.created}{by}."
    )
    _say_zero(found)
    if replayed is None:
        say("No test vectors: export the config again to add them.", "yellow")
    else:
        say(f"Test vectors: {replayed} samples, all with the same answers as at the export.")
    _say_doubts(found)
    answer({"bundle": str(bundle), "replayed": replayed, **_facts(found)}, good=model.verified)


@bundle_app.command(example="bundle diff old.zip new.zip")
def diff(one: Path, other: Path, /) -> None:
    """Compare two bundles: the fields that differ, their meaning, and the distance between the surfaces.

    Parameters
    ----------
    one : A
        Folder or zip file.
    other : B
        Another.
    """
    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.config.runtime.differ import differences

    found = differences(RuntimeConfig.load(one), RuntimeConfig.load(other))
    _show_differences(found)
    answer(found.to_json())


@bundle_app.command(
    example="bundle payload runtime.zip --robot ur --sensor-at 0,0,37.5 --sensor-body 0.29,0,0,18"
)
def payload(
    bundle: BundleArgument,
    /,
    turned: MountSettings,
    robot: RobotMaker,
    sensor_at: SensorAtArgument,
    sensor_body: SensorBodyOption = None,
    index: Annotated[int, typer.Option(min=1, max=16, help="Number of the tool, for KUKA and ABB.")] = 1,
    out: Path | None = None,
) -> None:
    """Print mass and centre of mass of the payload as a robot's own controller takes them.

    Poses at rest do not show the inertia, which is written as zero; UR takes zero where it is left out. Nothing is sent
    to the robot. UR: setting the payload zeroes the robot's own force and torque readings, so set it with nothing
    touching the tool. ABB: the line is the load of a tooldata, in the wrist frame.

    Exit code 1, and no line: the calibration was refused, the mass of the load is not known within 10 %, or the centre
    of mass not within 10 mm (one standard deviation).

    Parameters
    ----------
    robot
        Whose controller is to be told.
    out
        Text file to write [standard output].
    """
    from contactbench.pipeline.calibration.payload import CAUTIONS
    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.config.runtime.build import calibration_refused
    from contactbench.pipeline.config.runtime.values import rotation_ES
    from contactbench.pipeline.durable import write_file

    found = RuntimeConfig.load(bundle)
    if calibration_refused(found.model):
        reason = "The calibration was refused, so its payload is not for a robot: calibrate again."
        say(f"{bundle}: {reason}", "red")
        answer({"error": f"{bundle}: {reason}"})
        raise typer.Exit(_NOT_GOOD_ENOUGH)
    doubt_degrees(turned.mount)
    R_ES = rotation_ES(found.model.frames.quaternion_ES) if turned.R_ES is None else turned.R_ES
    if R_ES is None:
        raise typer.BadParameter(
            f"{bundle} does not say how the sensor is turned on the flange: give --mount, 0,0,0 if it is not."
        )
    made = payload_told(found.gravity, R_ES, sensor_at, sensor_body)
    text = made.text(robot, index) if made.is_known else None
    if out is None:
        output_is_data()
    spread = " ± ".join(
        ", ".join(f"{1e3 * each:.1f}" for each in part) for part in (made.centre_E, made.centre_sigma_E)
    )
    say(
        f"{made.mass:.3f} ± {made.mass_sigma:.3f} kg at ({spread}) mm in the flange's frame (one standard deviation)."
    )
    if text is not None:
        if caution := CAUTIONS.get(robot):
            say(caution, "yellow")
        if out is not None:
            write_file(out, f"{text}\n".encode())
            say(f"{out}: {robot}.")
        elif not as_json():
            typer.echo(text)
    answer({
        "robot": str(robot), "text": text, "mass_kg": made.mass, "mass_sigma_kg": made.mass_sigma,
        "centre_E_m": made.centre_E.tolist(), "centre_sigma_E_m": made.centre_sigma_E.tolist(),
    })  # fmt: skip
    if text is None:
        say("That is too unsure to tell a robot: calibrate with poses that tilt farther.", "red")
        raise typer.Exit(_NOT_GOOD_ENOUGH)


@bundle_app.command(example="bundle schema > runtime-config.schema.json")
def schema() -> None:
    """Print the JSON Schema of contactbench.json on standard output."""
    from contactbench.pipeline.config.runtime.canonical import json_schema

    typer.echo(json_schema().decode(), nl=False)


# ---- parts -------------------------------------------------------------------------------------


def _inputs(
    session: Path | None, calibration: Path | None, probe: Path | None, *others: Path | None
) -> tuple[Path, Path]:
    """Return calibration and probe; any paths if there is a session, which has its own."""
    if session is not None:
        if any(each is not None for each in (calibration, probe, *others)):
            raise typer.BadParameter("give either a session or files.")
        return session, session
    if calibration is None or probe is None:
        raise typer.BadParameter("give a session, or both --calibration and --probe.")
    return calibration, probe


def _of_session(
    folder: Path, given: Mapping[str, Any], settings_file: Path | None, unverified: bool
) -> RuntimeConfig:
    from contactbench.pipeline.config.runtime.bench import export_from_session
    from contactbench.pipeline.session import Session

    with Session.open(folder, write=False) as session:
        settings = _settings(session.state.settings, given, settings_file)
        return export_from_session(session, settings, unverified=unverified)


def _settings(
    stored: Mapping[str, Any], given: Mapping[str, Any], settings_file: Path | None
) -> ExportOptions:
    """Return settings: what was given, else what a session says; parts of a file take the place of both."""
    from contactbench.pipeline.config.runtime.options import ExportOptions, with_file

    options = ExportOptions.stored(stored, given)
    if settings_file is None:
        return options
    try:
        with settings_file.open("rb") as stream:
            data = stream.read(2**20 + 1)
    except (OSError, ValueError) as error:
        raise typer.BadParameter(f"--settings {settings_file}: the file cannot be read ({error}).") from None
    return with_file(options, data, str(settings_file))


def _standing(config: RuntimeConfig) -> str:
    part = config.model.verification
    if config.model.verified and part is not None:
        return (
            f"verified on {part.markers} markers: {1e3 * part.mean_error_m:.2f} mm mean,"
            f" {1e3 * part.max_error_m:.2f} mm largest error"
        )
    return "NOT VERIFIED"


def _say_zero(config: RuntimeConfig) -> None:
    """Say when the bias was measured, and how fast it drifted then."""
    zero = config.model.zero
    if zero.measured is not None:
        say(f"The sensor's zero was measured on {zero.measured}.")
    if zero.drift is not None:
        force, torque = (
            _SECONDS_AN_HOUR * max(map(abs, rates))
            for rates in (zero.drift.force_Nps, zero.drift.torque_Nmps)
        )
        say(
            f"It drifted by up to {force:.2g} N and {1e3 * torque:.2g} mN·m per hour during the"
            " calibration: recalibrate shortly before use.",
            "yellow",
        )


def _say_doubts(config: RuntimeConfig) -> None:
    from contactbench.pipeline.config.consumers import NO_ADMITTANCE, down_along_z
    from contactbench.pipeline.config.runtime.checks import unchecked
    from contactbench.pipeline.config.runtime.values import kalman_of

    model = config.model
    say_all((*model.provenance.stale, *config.notes, *_weak(config)), "yellow")
    if missing := unchecked(model.checks):
        say(missing, "yellow")
    if down_along_z(model.world.down_W) is None:
        say(NO_ADMITTANCE, "yellow")
    if None in model.gates.saturation:
        say(
            "NO SATURATION LIMITS: a reading at the end of the sensor's range looks like a touch:"
            " give --saturation, or pass NaN for readings the sensor flags.",
            "yellow",
        )
    wrench = model.filters.wrench
    if wrench is not None and wrench.kind == "kalman":
        lag = 1e3 * kalman_of(wrench).figures().delay
        say(
            f"THE PAPER'S FILTER: contacts lag by {lag:.0f} ms, and are accepted for some time after a release:"
            " export again without --paper-filter.",
            "yellow",
        )
    if model.frames.quaternion_ES is None:
        say(
            "No mounting: the orientations must be those of the sensor itself, as in the calibration.",
            "yellow",
        )
    if not model.touch.model_error.measured:
        say("The model error is the default: verify on markers to measure it.", "yellow")
    if model.verification is not None:
        say(model.verification.diagnosis)


def _weak(config: RuntimeConfig) -> list[str]:
    from contactbench.pipeline.control.margins import weak_loops

    return [said for said, _ in weak_loops(config)]


def _facts(config: RuntimeConfig) -> dict[str, Any]:
    model = config.model.to_json()
    kept = "schema version sensor world zero touch probe regions verified verification checks provenance"
    return {name: model[name] for name in kept.split()}


def _show_differences(found: Differences) -> None:
    if found.same:
        say("The two are identical.")
        return
    from rich.table import Table
    from rich.text import Text

    table = Table("field", "A", "B", "meaning", box=None)
    for each in found.fields:
        table.add_row(Text(each.field), Text(_short(each.one)), Text(_short(each.other)), each.meaning)
    show_tables(table)
    say_all(f"{name} differs." for name in found.files)
    if found.mesh is not None:
        one, other = found.mesh["facets"]
        say(
            f"The surfaces, of {one:,} and {other:,} facets, are at most {found.mesh['hausdorff_mm']:.3g} mm apart,"
            f" {found.mesh['rms_mm']:.2g} mm RMS."
        )


def _short(value: Any) -> str:
    text = str(value)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"

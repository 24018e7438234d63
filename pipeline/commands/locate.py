"""``contactbench locate``: contacts from wrenches in a file."""

from __future__ import annotations

import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.options import PatchOption
from contactbench.pipeline.console import Bar, Noun, answer, as_json, say, show_tables
from contactbench.pipeline.parameter_options import numbers

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.contact import Gates, TouchModel, WrenchNoise
    from contactbench.pipeline.contact.stream import LocateSummary, Locator
    from contactbench.pipeline.mesh import Probe

locate_app = Noun()


class Units(StrEnum):
    """What the numbers in a mesh file are."""

    mm = "mm"
    m = "m"
    cm = "cm"
    inch = "in"


class MethodName(StrEnum):
    """Ways to locate a contact, as in contactbench.pipeline.contact.methods."""

    contactbench = "contactbench"
    scan = "scan"
    algorithm1 = "algorithm1"
    wrench_axis = "wrench_axis"
    iterative = "iterative"


@locate_app.command(
    example=("locate --probe probe.stl --units mm --place 0,0,45,0,0,90 wrenches.csv --out contacts.csv"),
)
def locate(
    wrenches: Annotated[Path, typer.Argument(metavar="WRENCHES", help="CSV file, or - for standard input.")],
    probe: Annotated[
        Path, typer.Option(help="Mesh of the probe: .stl, .ply, .obj, .off, .3mf, .glb or .gltf.")
    ],
    out: Annotated[Path, typer.Option(help="CSV file to write, or - for standard output.")],
    units: Annotated[
        Units | None,
        typer.Option(help="Unit of the mesh's numbers [as stated in the file, or guessed from its size]."),
    ] = None,
    place: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,Z,RX,RY,RZ",
            help="Pose of the mesh in S: position in --units, or in the mesh's unit, rotations about the"
            " fixed axes x, then y, then z, degrees. Left out: the mesh is in S.",
        ),
    ] = None,
    method: Annotated[
        MethodName, typer.Option(help="Method that locates the contact.")
    ] = MethodName.contactbench,
    track: Annotated[bool, typer.Option("--track", help="Follow the contact from row to row.")] = False,
    noise_force: Annotated[float, typer.Option(help="Standard deviation of a force, N.")] = 0.05,
    noise_torque: Annotated[float, typer.Option(help="Standard deviation of a torque, N·m.")] = 0.002,
    torsion_arm: Annotated[
        float | None,
        typer.Option(
            help="Torsion that a touch may have, 1 sigma: local torque over force, mm. A hard tip has 0.3, soft"
            " tissue 1 to 5 [1]."
        ),
    ] = None,
    model_force: Annotated[
        float | None,
        typer.Option(help="Error that drift, cable and hysteresis leave in a force, 1 sigma, N [0.05]."),
    ] = None,
    model_torque: Annotated[float | None, typer.Option(help="The same for a torque, mN·m [1].")] = None,
    min_force: Annotated[
        float | None, typer.Option(help="Reason low_force below this force, N [0.5].")
    ] = None,
    friction_angle: Annotated[
        float | None, typer.Option(help="Reason tangential beyond this angle to the normal, degrees [75].")
    ] = None,
    ambiguity_distance: Annotated[
        float | None,
        typer.Option(help="Reason ambiguous when another likely place is this far away, mm [5]."),
    ] = None,
    follow_distance: Annotated[
        float | None, typer.Option(help="With --track: prefer places this near the last contact, mm [10].")
    ] = None,
    saturation: Annotated[
        str | None,
        typer.Option(
            metavar="FX,FY,FZ,MX,MY,MZ", help="Reason saturated when a channel reaches this, N, N·m [none]."
        ),
    ] = None,
    region_only: Annotated[
        bool, typer.Option("--region-only", help="Refuse contacts outside every region of the mesh.")
    ] = False,
    accept_by_region: Annotated[
        bool,
        typer.Option(
            "--accept-by-region/--no-accept-by-region",
            help=(
                "With --track: also follow contacts whose place is certain only because of the"
                " regions of the mesh."
            ),
        ),
    ] = True,
    patch: PatchOption = None,
    compensated: Annotated[
        bool,
        typer.Option(
            "--compensated",
            help="Accept a file with the columns of a raw recording: it is already compensated.",
        ),
    ] = False,
    allow_nan: Annotated[
        bool, typer.Option("--allow-nan", help="Answer NaN, infinity and empty cells with not_finite.")
    ] = False,
) -> None:
    """Locate the contact of each wrench in a CSV file.

    WRENCHES has the columns t,fx,fy,fz,mx,my,mz (s, N, N·m about the sensor origin, sensor frame S) in
    any order, compensated for weight and offset; - is standard input. The output has
    t,x,y,z,k,face,reason,candidates,sigma_max_mm,misfit,confidence,on (m, N·m, frame S; misfit in
    standard deviations squared; on: measured, or invented where the mesh file had an opening, or
    untouchable) and is written completely or not at all.

    Exit code 1: no single touch explains most of the wrenches. The most likely mistake is named.
    """
    _check_usage(out, method, track, patch)
    placed = None if place is None else numbers(place, 6, "--place")
    limits = None if saturation is None else tuple(numbers(saturation, 6, "--saturation"))
    from contactbench.pipeline.contact import Gates, WrenchNoise
    from contactbench.pipeline.contact.patch import Bed, PatchReader
    from contactbench.pipeline.contact.stream import locate_file, refuse_overwriting

    refuse_overwriting(out, probe)
    given = {
        "min_force": min_force,
        "friction_angle": friction_angle,
        "ambiguity_distance": None if ambiguity_distance is None else ambiguity_distance / 1000,
        "follow_distance": None if follow_distance is None else follow_distance / 1000,
        "saturation": limits,
        "region_only": region_only,
        "accept_by_region": accept_by_region,
    }
    chosen: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
    gates, noise = Gates(**chosen), WrenchNoise(noise_force, noise_torque)
    model = _model(torsion_arm, model_force, model_torque)
    surface, warnings = _load(probe, units, placed)
    for sentence in warnings:
        say(f"warning: {sentence}", "yellow")
    locator = _locator(method, surface, noise, gates, model)
    dash = Path("-")
    with Bar("locating") as bar:
        summary = locate_file(
            locator,
            sys.stdin.buffer if wrenches == dash else wrenches,
            sys.stdout.buffer if out == dash else out,
            track=track,
            allow_nan=allow_nan,
            compensated=compensated,
            probe=surface,
            patches=None if patch is None else PatchReader(surface, Bed.parse(patch)),
            progress=bar,
        )
    for sentence in summary.warnings:
        say(f"warning: {sentence}", "yellow")
    _show(summary)
    answer({"out": str(out), **summary.facts(), "warnings": [*warnings, *summary.warnings]})
    if summary.plausibility is not None:
        raise typer.Exit(1)


def _check_usage(out: Path, method: MethodName, track: bool, patch: str | None) -> None:
    if patch is not None and method is not MethodName.contactbench:
        raise typer.BadParameter(f"--patch works only with --method contactbench, not with {method.value}.")
    if track and method is not MethodName.contactbench:
        raise typer.BadParameter(f"--track works only with --method contactbench, not with {method.value}.")
    if as_json() and out == Path("-"):
        raise typer.BadParameter("--json and --out - both use standard output: give a file name.")


def _load(path: Path, units: Units | None, mount: Sequence[float] | None) -> tuple[Probe, Sequence[str]]:
    """Read the mesh, and what is to be said of it; `mount` is in `units`, or else in those of the file."""
    from contactbench.pipeline.mesh.load import probe_of, read_mesh
    from contactbench.pipeline.mesh.units import METRES
    from contactbench.pipeline.preparation.alignment.placement import from_angles

    read = read_mesh(path, "auto" if units is None else units.value)
    T_SP = None
    if mount is not None:
        over, under = METRES[read.units if units is None else units.value]
        position_mm = [1000 * value * over / under for value in mount[:3]]
        T_SP = from_angles(position_mm, mount[3:]).T_SP
    probe = probe_of(path, read, T_SP)
    sentences = [*read.notes, *probe.health.sentences]
    if T_SP is None and read.raw.settled:
        from contactbench.pipeline.mesh.sidecar import load_probe_file

        known = load_probe_file(path)
        sentences += known.notes
        if known.history and known.frame != "S":
            sentences.append(
                "The probe was never aligned with the sensor, so contacts are found in the mesh's own frame: run"
                " `contactbench probe align`, or give --place."
            )
    return probe, [f"{path}: {sentence}" for sentence in sentences]


def _model(torsion_arm: float | None, force: float | None, torque: float | None) -> TouchModel:
    """Return what is known of a touch: mm, N and mN·m; None: the default."""
    from contactbench.pipeline.contact import TouchModel, WrenchNoise
    from contactbench.pipeline.contact.touch_model import DEFAULT_FORCE_N, DEFAULT_TORQUE_NM

    error = WrenchNoise(
        DEFAULT_FORCE_N if force is None else force, DEFAULT_TORQUE_NM if torque is None else torque / 1000
    )
    if torsion_arm is None:
        return TouchModel(model_error=error)
    return TouchModel(torsion_arm / 1000, error)


def _locator(
    method: MethodName, probe: Probe, noise: WrenchNoise, gates: Gates, model: TouchModel
) -> Locator:
    if method is MethodName.contactbench:  # the others need more to be imported
        from contactbench.pipeline.contact import ContactSolver

        return ContactSolver(probe, noise, gates, model)
    from contactbench.pipeline.contact import methods

    return methods.make(method.value, probe, noise, gates, model)


def _show(summary: LocateSummary) -> None:
    from rich.table import Table

    table = Table(box=None, show_header=False)
    table.add_column()
    table.add_column(justify="right")
    table.add_column(justify="right")
    table.add_row("rows", f"{summary.rows:,}", "")
    for reason, count in summary.reasons.items():
        if count:
            table.add_row(reason, f"{count:,}", f"{100 * count / summary.rows:.1f} %")
    if summary.median_sigma_max_mm is not None:
        table.add_row("median sigma_max", f"{summary.median_sigma_max_mm:.3g} mm", "")
    table.add_row("speed", f"{summary.rows_per_second:,.0f} rows/s", "")
    show_tables(table)

"""``contactbench locate``: contacts from wrenches in a file."""

from __future__ import annotations

import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from contactbench.pipeline.commands.options import PatchOption, doubt_metres
from contactbench.pipeline.console import Bar, Noun, answer, as_json, output_is_data, show_tables, warn
from contactbench.pipeline.gates import GateSettings
from contactbench.pipeline.touch_settings import TouchModelSettings, arm_of

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
    example=("locate --probe probe.stl --units mm --place 0,0,45,0,0,90 wrenches.csv --out contacts.csv")
)
def locate(
    wrenches: Path,
    /,
    probe: Path,
    out: Path,
    gates: GateSettings,
    known: TouchModelSettings,
    units: Units | None = None,
    place: tuple[float, float, float, float, float, float] | None = None,
    method: MethodName = MethodName.contactbench,
    track: bool = False,
    patch: PatchOption = None,
    compensated: bool = False,
    allow_nan: bool = False,
) -> None:
    """Locate the contact of each wrench in a CSV file.

    WRENCHES has the columns t,fx,fy,fz,mx,my,mz (s, N, N·m about the sensor origin, sensor frame S) in
    any order, compensated for weight and offset; - is standard input. The output has
    t,x,y,z,k,face,reason,candidates,sigma_max_mm,misfit,confidence,on (m, N·m, frame S; misfit in
    standard deviations squared; on: measured, or invented where the mesh file had an opening, or
    untouchable) and is written completely or not at all.

    Exit code 1: no single touch explains most of the wrenches. The most likely mistake is named.

    Parameters
    ----------
    wrenches
        CSV file, or - for standard input.
    probe
        Mesh of the probe, of any format that probe prepare reads.
    out
        CSV file to write, or - for standard output.
    units
        Unit of the mesh's numbers [as stated in the file, or as its size tells].
    place : X,Y,Z,RX,RY,RZ
        Pose of the mesh in S: position in --units, or in the mesh's unit, rotations about the fixed axes x, then y,
        then z, degrees. Left out: the mesh is in S.
    method
        Method that locates the contact.
    track
        Follow the contact from row to row, and learn its torsion.
    compensated
        Accept a file with the columns of a raw recording: it is already compensated.
    allow_nan
        Answer NaN, infinity and empty cells with not_finite.
    """
    _check_usage(out, method, track, patch)
    from contactbench.pipeline.contact import Gates, TouchModel, WrenchNoise
    from contactbench.pipeline.contact.patch import Bed, PatchReader
    from contactbench.pipeline.contact.stream import locate_file, refuse_overwriting

    refuse_overwriting(out, probe)
    noise = WrenchNoise(known.noise_force, known.noise_torque)
    model = TouchModel(
        arm_of(known.torsion_arm, known.scene),
        WrenchNoise(known.model_force, known.model_torque),
        torsion_learned=known.torsion == "learned",
    )
    doubt_metres(place)
    surface, warnings = _load(probe, units, place)
    warn(warnings)
    locator = _locator(method, surface, noise, Gates(**dict(gates)), model)
    dash = Path("-")
    if out == dash:
        output_is_data()
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
    warn(summary.warnings)
    _show(summary)
    answer(
        {"out": str(out), **summary.facts(), "warnings": [*warnings, *summary.warnings]},
        good=summary.plausibility is None,
    )


def _check_usage(out: Path, method: MethodName, track: bool, patch: str | None) -> None:
    if patch is not None and method is not MethodName.contactbench:
        raise typer.BadParameter(f"--patch works only with --method contactbench, not with {method.value}.")
    if track and method is not MethodName.contactbench:
        raise typer.BadParameter(f"--track works only with --method contactbench, not with {method.value}.")
    if as_json() and out == Path("-"):
        raise typer.BadParameter("--json and --out - both use standard output: give a file name.")


def _load(path: Path, units: Units | None, mount: Sequence[float] | None) -> tuple[Probe, Sequence[str]]:
    """Read the mesh, and what is to be said of it; `mount` is in `units`, or else in those of the file."""
    from contactbench.pipeline.mesh.load import METRES, probe_of, read_mesh, refuse_doubt
    from contactbench.pipeline.preparation.alignment.alignment import from_angles

    read = read_mesh(path, "auto" if units is None else units.value)
    refuse_doubt(path, read.guess)
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


def _locator(
    method: MethodName, probe: Probe, noise: WrenchNoise, gates: Gates, model: TouchModel
) -> Locator:
    if method is MethodName.contactbench:  # the others need more to be imported
        from contactbench.pipeline.contact import ContactSolver

        return ContactSolver(probe, noise, gates, model)
    from contactbench.pipeline.contact import methods

    return methods.make(method.value, probe, noise, gates, model)


def _show(summary: LocateSummary) -> None:
    from rich.table import Column, Table

    table = Table("", Column(justify="right"), Column(justify="right"), box=None, show_header=False)
    table.add_row("rows", f"{summary.rows:,}", "")
    for reason, count in summary.reasons.items():
        if count:
            table.add_row(reason, f"{count:,}", f"{100 * count / summary.rows:.1f} %")
    if summary.median_sigma_max_mm is not None:
        table.add_row("median sigma_max", f"{summary.median_sigma_max_mm:.3g} mm", "")
    if summary.torsion_arm_mm is not None:
        low, high = summary.torsion_arm_mm
        table.add_row("torsion arm, learned", f"{low:.3g} to {high:.3g} mm", "")
    table.add_row("speed", f"{summary.rows_per_second:,.0f} rows/s", "")
    show_tables(table)

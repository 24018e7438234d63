"""``contactbench probe align``: where the mesh lies in the sensor frame."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.options import numbers, refuse_overwriting
from contactbench.pipeline.commands.probe_options import (
    MeshArgument,
    OutOption,
    UnitsOption,
    UnitsOrAuto,
    open_mesh,
    share,
)
from contactbench.pipeline.console import Bar, JsonOption, print_json, say

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from contactbench.pipeline.mesh.sidecar import ProbeFile
    from contactbench.pipeline.preparation.alignment import Alignment, TouchAlignment


def align(
    file: MeshArgument,
    out: OutOption,
    units: UnitsOption = UnitsOrAuto.auto,
    mount: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,Z,RX,RY,RZ",
            help="Pose of the mesh in S: mm, and degrees about the fixed axes x, then y, then z. With --touches:"
            " where the mount is now.",
        ),
    ] = None,
    alignment: Annotated[Path | None, typer.Option(help="Or: what --save wrote, .json.")] = None,
    points: Annotated[
        Path | None,
        typer.Option(help="CSV of matching points: px,py,pz in the mesh, sx,sy,sz in S, mm; three or more."),
    ] = None,
    frame: Annotated[
        str | None,
        typer.Option(
            metavar="OX,OY,OZ,ZX,ZY,ZZ,PX,PY,PZ",
            help="Three points of the mesh, mm: the origin of S, one on its +z axis, one in its x-z plane towards +x.",
        ),
    ] = None,
    flange_face: Annotated[
        int | None, typer.Option(help="Facet on the plane face that sits on the sensor, counted from 0.")
    ] = None,
    toward: Annotated[
        str | None,
        typer.Option(metavar="X,Y,Z", help="With --flange-face: point of the mesh that lies towards +x, mm."),
    ] = None,
    clock: Annotated[
        float | None, typer.Option(help="With --toward: turn it by this about z, degrees.")
    ] = None,
    axes: Annotated[
        bool, typer.Option("--axes", help="By the principal axes: longest along z, widest along x.")
    ] = False,
    tip: Annotated[
        str | None, typer.Option(metavar="X,Y,Z", help="With --axes: a point of the mesh near the tip, mm.")
    ] = None,
    offset: Annotated[
        float | None,
        typer.Option(help="With --flange-face or --axes: height of the mounting plane in S, mm [0]."),
    ] = None,
    touches: Annotated[
        Path | None,
        typer.Option(
            help="CSV of touched markers: px,py,pz (mm, in the mesh) and fx..mz (N, N·m, in S, compensated)."
        ),
    ] = None,
    noise_force: Annotated[
        float | None, typer.Option(help="With --touches: standard deviation of a force, N [0.05].")
    ] = None,
    noise_torque: Annotated[float | None, typer.Option(help="The same of a torque, N·m [0.002].")] = None,
    placement: Annotated[
        float | None,
        typer.Option(help="With --touches: how well a marker is hit, mm, one standard deviation [0.3]."),
    ] = None,
    again: Annotated[
        bool, typer.Option("--again", help="The probe is in S already: correct it there.")
    ] = False,
    save: Annotated[Path | None, typer.Option(help="Write the alignment itself, .json.")] = None,
    as_json: JsonOption = False,
) -> None:
    """Move a mesh from its own frame P into the sensor frame S."""
    from contactbench.pipeline.mesh.sidecar import save_probe_file
    from contactbench.pipeline.preparation.alignment import Advice
    from contactbench.pipeline.preparation.steps import align_step, refuse_aligned

    _check_files(file, out, save, (alignment, points, touches))
    way = _one_way(mount, alignment, points, frame, flange_face, axes, touches)
    _refuse_strangers(
        way,
        {
            "--toward": (toward, ("--flange-face",)),
            "--clock": (clock, ("--flange-face",)),
            "--tip": (tip, ("--axes",)),
            "--offset": (offset, ("--flange-face", "--axes")),
            "--noise-force": (noise_force, ("--touches",)),
            "--noise-torque": (noise_torque, ("--touches",)),
            "--placement": (placement, ("--touches",)),
        },
    )
    content = open_mesh(file, units, out)
    refuse_aligned(content, again=again)
    by_touch: TouchAlignment | None = None
    found: Alignment | None
    if touches is not None:
        noise = (
            0.05 if noise_force is None else noise_force,
            0.002 if noise_torque is None else noise_torque,
        )
        hit = 0.3 if placement is None else placement
        by_touch = _by_touches(content, touches, mount, alignment, noise, hit)
        found = by_touch.fitted
    elif way == "--mount":
        found = chosen_mount(mount, alignment)
    else:
        found = _by_shape(content, points, frame, flange_face, toward, clock or 0.0, tip, offset or 0.0)
    assert found is not None  # noqa: S101  (one way was given)
    adopted = by_touch is None or by_touch.advice is Advice.ADOPT
    _tell(found, by_touch)
    if adopted:
        save_probe_file(align_step(content, found, again=again), out)
        if save is not None:
            _write(save, found)
        say(f"Wrote {out}.")
    else:
        say("Nothing was written: the present mount stays.", "yellow")
    if as_json:
        print_json(_facts(found, by_touch, out if adopted else None))
    if not adopted:
        raise typer.Exit(1)


def _one_way(
    mount: str | None,
    alignment: Path | None,
    points: Path | None,
    frame: str | None,
    flange_face: int | None,
    axes: bool,
    touches: Path | None,
) -> str:
    """Return the option that says how to align; typer.BadParameter unless there is one."""
    given = {
        "--points": points is not None,
        "--frame": frame is not None,
        "--flange-face": flange_face is not None,
        "--axes": axes,
        "--touches": touches is not None,
    }
    ways = [option for option, there in given.items() if there]
    if touches is None and (mount is not None or alignment is not None):
        ways.append("--mount")
    if len(ways) != 1:
        raise typer.BadParameter(
            "give one way to align: --mount, --alignment, --points, --frame, --flange-face, --axes, or --touches"
            " with --mount."
        )
    return ways[0]


def _refuse_strangers(way: str, options: Mapping[str, tuple[object, Sequence[str]]]) -> None:
    """Refuse options of another way than the chosen one; typer.BadParameter."""
    for option, (value, belongs) in options.items():
        if value is not None and way not in belongs:
            raise typer.BadParameter(f"{option} goes with {' or '.join(belongs)}, not with {way}.")


def _check_files(file: Path, out: Path, save: Path | None, read: Sequence[Path | None]) -> None:
    """Refuse to write over what is read or written; typer.BadParameter."""
    inputs = [path for path in (file, *read) if path is not None]
    refuse_overwriting(out, inputs)
    if save is not None:
        refuse_overwriting(save, inputs)
        if save.resolve() in (out.resolve(), out.with_suffix(".json").resolve()):
            raise typer.BadParameter(f"--save {save} is where the probe goes: choose another name.")


def chosen_mount(mount: str | None, alignment: Path | None) -> Alignment | None:
    """Return the alignment that ``--mount`` or ``--alignment`` gives, if one was given.

    Raises
    ------
    typer.BadParameter
        Both were.
    """
    from contactbench.pipeline.preparation.alignment import AlignmentError, from_angles, from_json

    if mount is not None and alignment is not None:
        raise typer.BadParameter("--mount and --alignment contradict each other: give one.")
    if mount is not None:
        values = numbers(mount, 6, "--mount")
        return from_angles(values[:3], values[3:])
    if alignment is None:
        return None
    try:
        data = alignment.read_bytes()
    except OSError as error:
        raise AlignmentError(f"{alignment}: the file cannot be read ({error}): check the path.") from error
    return from_json(data, str(alignment))


def _by_touches(
    content: ProbeFile,
    touches: Path,
    mount: str | None,
    alignment: Path | None,
    noise: tuple[float, float],
    placement: float,
) -> TouchAlignment:
    from contactbench.pipeline.contact import WrenchNoise
    from contactbench.pipeline.preparation.alignment import align_touches, read_touches

    start = chosen_mount(mount, alignment)
    if start is None:
        raise typer.BadParameter("--touches starts from where the mount is now: give --mount or --alignment.")
    with Bar("cross-validating", counted=True) as bar:
        return align_touches(
            content.probe,
            read_touches(touches),
            start.T_SP,
            WrenchNoise(*noise),
            placement=placement / 1000,
            progress=share(bar),
        )


def _by_shape(
    content: ProbeFile,
    points: Path | None,
    frame: str | None,
    flange_face: int | None,
    toward: str | None,
    clock: float,
    tip: str | None,
    offset: float,
) -> Alignment:
    import numpy as np

    from contactbench.pipeline.preparation.alignment import (
        align_axes,
        align_flange,
        align_frame,
        align_points,
        find_mounting_face,
    )
    from contactbench.pipeline.preparation.alignment.point_csv import read_points

    if points is not None:
        return align_points(*read_points(points))
    if frame is not None:
        return align_frame(*(np.array(numbers(frame, 9, "--frame")) / 1000).reshape(3, 3))
    if flange_face is not None:
        picked = None if toward is None else np.array(numbers(toward, 3, "--toward")) / 1000
        face = find_mounting_face(content.probe, flange_face)
        return align_flange(face, offset=offset / 1000, toward_P=picked, clock_deg=clock)
    near = None if tip is None else np.array(numbers(tip, 3, "--tip")) / 1000
    return align_axes(content.probe, tip_P=near, offset=offset / 1000).alignment


def _tell(found: Alignment, by_touch: TouchAlignment | None) -> None:
    for sentence in found.how:
        say(sentence)
    for sentence in found.warnings:
        say(f"warning: {sentence}", "yellow")
    for reason in () if by_touch is None else by_touch.reasons:
        say(reason)


def _write(file: Path, found: Alignment) -> None:
    from contactbench.pipeline.durable import write_durably
    from contactbench.pipeline.preparation.alignment import AlignmentError

    try:
        write_durably(file, found.to_json().encode())
    except (OSError, ValueError) as error:
        raise AlignmentError(
            f"{file}: the alignment cannot be written ({error}): check the folder."
        ) from error


def _facts(found: Alignment, by_touch: TouchAlignment | None, out: Path | None) -> dict[str, Any]:
    facts = {
        "out": None if out is None else str(out),
        "method": found.method.value,
        "T_SP_m": found.T_SP.tolist(),
        "sigmas_mm": None if found.sigmas_mm is None else found.sigmas_mm.tolist(),
        "sigmas_deg": None if found.sigmas_deg is None else found.sigmas_deg.tolist(),
        "residual_mm": None if found.residual_m is None else 1e3 * found.residual_m,
        "how": list(found.how),
        "warnings": list(found.warnings),
    }
    if by_touch is not None:
        facts |= {
            "advice": by_touch.advice.value,
            "reasons": list(by_touch.reasons),
            "rank": by_touch.rank,
            "unseen": list(by_touch.unseen),
            "left_out": [name for name, kept in zip(by_touch.names, by_touch.kept, strict=True) if not kept],
        }
    return facts

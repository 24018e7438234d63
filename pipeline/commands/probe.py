"""``contactbench probe ...``: a probe's mesh, from a file of a scanner or a CAD program."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.options import ProbeOption, doubt_metres, refuse_overwriting, shown
from contactbench.pipeline.commands.regions import regions_app
from contactbench.pipeline.console import Bar, Noun, answer, say, say_all, show_tables, warn
from contactbench.pipeline.durable import make_folder, write_file
from contactbench.pipeline.settings import (
    MESH_FORMATS_SAID,
    LadderSettings,
    MeshSettings,
    PlaceSettings,
    ProbeSettings,
    ShellSettings,
    SimplifySettings,
    metres,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.mesh.sidecar import ProbeFile
    from contactbench.pipeline.preparation.alignment.alignment import Alignment
    from contactbench.pipeline.preparation.alignment.touches.align import TouchAlignment

markers_app = Noun("Make markers for a probe, and move them onto its surface.")


MarkersOut = Annotated[Path, typer.Option(help="Table to write: name,x_mm,y_mm,z_mm, sensor frame.")]


@markers_app.command(example="probe markers generate probe.ply --all --count 17 --out markers.csv")
def generate(
    probe: Path,
    /,
    out: MarkersOut,
    region: int | None = None,
    all_: bool = False,
    count: int = 17,
    grid: float | None = None,
) -> None:
    """Place markers on a probe, spread evenly or on a grid; every call gives the same ones.

    Parameters
    ----------
    probe
        The probe, aligned with the sensor.
    region
        Only on the region with this rank.
    all_
        Anywhere on the probe.
    count
        Number of markers, spread evenly.
    grid
        Instead: markers on a grid of this pitch, mm.
    """
    if (region is None) != all_:
        raise typer.BadParameter("give either --region N or --all.")
    refuse_overwriting(out, [probe])
    from contactbench.pipeline.verification import grid_markers, spread_markers
    from contactbench.pipeline.verification.result import load_surface

    surface = load_surface(probe)
    made = (
        spread_markers(surface, count, region) if grid is None else grid_markers(surface, grid / 1e3, region)
    )
    made.save(out)
    say(f"{len(made)} markers written to {out}.", "green")
    answer({"markers": len(made), "file": str(out)})


@markers_app.command(example="probe markers snap measured.csv --probe probe.ply --out markers.csv")
def snap(markers: Path, /, probe: ProbeOption, out: MarkersOut, limit: float = 5.0) -> None:
    """Move markers to the nearest points of a probe's surface, and print how far each moved.

    Parameters
    ----------
    markers
        CSV file: name,x_mm,y_mm,z_mm.
    limit
        Refuse markers farther from the surface, mm.
    """
    refuse_overwriting(out, [markers, probe])
    from contactbench.pipeline.verification import load_markers
    from contactbench.pipeline.verification import snap as snapped
    from contactbench.pipeline.verification.result import load_surface

    found = snapped(load_markers(markers), load_surface(probe), limit / 1e3)
    found.markers.save(out)
    moved = dict(zip(found.markers.names, (1e3 * found.distances).tolist(), strict=True))
    for name, distance in moved.items():
        say(f"{name}: moved by {distance:.3f} mm")
    answer({"markers": len(moved), "file": str(out), "moved_mm": moved})


probe_app = Noun(
    "Turn a mesh into a probe: inspect, shell, align, simplify, or all in one go; its regions and markers."
)
probe_app.add_typer(regions_app, name="regions")
probe_app.add_typer(markers_app, name="markers")

MeshArgument = Annotated[
    Path, typer.Argument(metavar="FILE", help=f"Mesh: {MESH_FORMATS_SAID}, packed by gzip or not.")
]
OutOption = Annotated[
    Path, typer.Option(help="Probe to write, .ply; its history is written beside it as .json.")
]


def open_mesh(file: Path, given: MeshSettings, out: Path | None = None) -> ProbeFile:
    """Read a mesh and say what was noticed; refuse to write over it, or where nothing can be written."""
    refuse_overwriting(out, [file])
    if out is not None:
        from contactbench.pipeline.mesh.sidecar import check_target

        check_target(out)
    from contactbench.pipeline.mesh.load import refuse_to_guess
    from contactbench.pipeline.preparation.prepare import import_mesh

    refuse_to_guess(file, given)
    content = import_mesh(file, given.units, given.tolerance / 1000)
    warn(content.notes)
    return content


def counts(text: str) -> list[int]:
    """Return the whole numbers of ``--facets``.

    Raises
    ------
    typer.BadParameter
        It holds something else.
    """
    parts = text.split(",")
    if not all(part.strip().isdecimal() for part in parts):
        raise typer.BadParameter(f"--facets needs whole numbers separated by commas, not {text!r}.")
    return [int(part) for part in parts]


Three = tuple[float, float, float]
Pose = tuple[float, float, float, float, float, float]

# Options that only some ways to align have.
_GOES_WITH = {
    "toward": ("--flange-face",),
    "clock": ("--flange-face",),
    "tip": ("--axes",),
    "offset": ("--flange-face", "--axes"),
    "noise_force": ("--touches",),
    "noise_torque": ("--touches",),
    "placement": ("--touches",),
}


@dataclass(frozen=True)
class WayToAlign:
    """
    How a mesh is aligned with the sensor.

    Parameters
    ----------
    place : X,Y,Z,RX,RY,RZ
        Pose of the mesh in S: mm, and degrees about the fixed axes x, then y, then z. With --touches: the
        probe's present pose.
    alignment
        Instead: the .json file written by --save.
    points
        CSV of matching points: px,py,pz in the mesh, sx,sy,sz in S, mm; three or more.
    frame : OX,OY,OZ,ZX,ZY,ZZ,PX,PY,PZ
        Three points of the mesh, mm: the origin of S, one on its +z axis, one in its x-z plane towards +x.
    flange_face
        Facet on the plane face that sits on the sensor, counted from 0.
    toward : X,Y,Z
        With --flange-face: point of the mesh that lies towards +x, mm.
    clock
        With --toward: turn by this angle about z, degrees.
    axes
        Use the principal axes: longest along z, widest along x.
    tip : X,Y,Z
        With --axes: a point of the mesh near the tip, mm.
    offset
        With --flange-face or --axes: height of the mounting plane in S, mm [0].
    touches
        CSV of touched markers: px,py,pz (mm, in the mesh) and fx..mz (N, N·m, in S, compensated).
    noise_force
        With --touches: standard deviation of a force, N [0.05].
    noise_torque
        The same for a torque, N·m [0.002].
    placement
        With --touches: accuracy of hitting a marker, mm, one standard deviation [0.3].
    """

    place: Pose | None = None
    alignment: Path | None = None
    points: Path | None = None
    frame: tuple[float, float, float, float, float, float, float, float, float] | None = None
    flange_face: int | None = None
    toward: Three | None = None
    clock: float | None = None
    axes: bool = False
    tip: Three | None = None
    offset: float | None = None
    touches: Path | None = None
    noise_force: float | None = None
    noise_torque: float | None = None
    placement: float | None = None

    @property
    def option(self) -> str:
        """The option that says how; typer.BadParameter unless there is one, and no others than go with it."""
        given = {
            "--points": self.points is not None,
            "--frame": self.frame is not None,
            "--flange-face": self.flange_face is not None,
            "--axes": self.axes,
            "--touches": self.touches is not None,
        }
        ways = [option for option, there in given.items() if there]
        if self.touches is None and (self.place is not None or self.alignment is not None):
            ways.append("--place")
        if len(ways) != 1:
            raise typer.BadParameter(
                "give one way to align: --place, --alignment, --points, --frame, --flange-face, --axes, or --touches"
                " with --place."
            )
        (way,) = ways
        for name, belongs in _GOES_WITH.items():
            if getattr(self, name) is not None and way not in belongs:
                option = f"--{name.replace('_', '-')}"
                raise typer.BadParameter(f"{option} goes with {' or '.join(belongs)}, not with {way}.")
        return way

    def placed(self) -> Alignment | None:
        """Return the alignment that was given, if one was; typer.BadParameter if two were."""
        from contactbench.pipeline.preparation.prepare import alignment_of

        if self.place is not None and self.alignment is not None:
            raise typer.BadParameter("--place and --alignment contradict each other: give only one.")
        doubt_metres(self.place)
        return alignment_of(PlaceSettings.checked({"mount": self.place}), self.alignment)

    def by_touches(self, content: ProbeFile, touches: Path) -> TouchAlignment:
        """Return the alignment that touches of markers show."""
        from contactbench.pipeline.contact import WrenchNoise
        from contactbench.pipeline.preparation.alignment.touches.align import align_touches
        from contactbench.pipeline.preparation.alignment.touches.fit import read_touches

        start = self.placed()
        if start is None:
            raise typer.BadParameter("--touches needs the probe's present pose: give --place or --alignment.")
        noise = {"force": self.noise_force, "torque": self.noise_torque}
        hit: dict[str, Any] = {} if self.placement is None else {"placement": self.placement / 1000}
        with Bar("cross-validating", counted=True) as bar:
            return align_touches(
                content.probe,
                read_touches(touches),
                start.T_SP,
                WrenchNoise(**{name: sigma for name, sigma in noise.items() if sigma is not None}),
                **hit,
                progress=shown(bar).tell,
            )

    def by_shape(self, content: ProbeFile) -> Alignment:
        """Return the alignment that points or faces of the mesh give."""
        import numpy as np

        from contactbench.pipeline.preparation.alignment.flange import (
            align_axes,
            align_flange,
            find_mounting_face,
        )
        from contactbench.pipeline.preparation.alignment.points import align_frame, align_points, read_points

        offset = (self.offset or 0.0) / 1000
        if self.points is not None:
            return align_points(*read_points(self.points))
        if self.frame is not None:
            return align_frame(*(np.array(self.frame) / 1000).reshape(3, 3))
        if self.flange_face is not None:
            picked = None if self.toward is None else np.array(self.toward) / 1000
            face = find_mounting_face(content.probe, self.flange_face)
            return align_flange(face, offset=offset, toward_P=picked, clock_deg=self.clock or 0.0)
        near = None if self.tip is None else np.array(self.tip) / 1000
        return align_axes(content.probe, tip_P=near, offset=offset).alignment


@probe_app.command(example="probe align shell.ply --place 0,0,45,0,0,90 --out aligned.ply")
def align(
    file: MeshArgument,
    /,
    out: OutOption,
    read: MeshSettings,
    chosen: WayToAlign,
    again: bool = False,
    save: Path | None = None,
) -> None:
    """Move a mesh from its own frame P into the sensor frame S.

    By one of: typed numbers, matching points, the face that sits on the sensor, the principal axes, or
    touches of marked points. Exit code 1: the touches do not prove a better mount than the present one,
    which is kept.

    Parameters
    ----------
    again
        The probe is already in S: correct it there.
    save
        Also write the alignment itself, .json.
    """
    from contactbench.pipeline.mesh.sidecar import save_probe_file
    from contactbench.pipeline.preparation.alignment.touches.align import Advice
    from contactbench.pipeline.preparation.prepare import align_step, refuse_aligned

    _check_files(file, out, save, (chosen.alignment, chosen.points, chosen.touches))
    way = chosen.option
    content = open_mesh(file, read, out)
    refuse_aligned(content, again=again)
    by_touch: TouchAlignment | None = None
    found: Alignment | None
    if chosen.touches is not None:
        by_touch = chosen.by_touches(content, chosen.touches)
        found = by_touch.fitted
    else:
        found = chosen.placed() if way == "--place" else chosen.by_shape(content)
    assert found is not None  # noqa: S101  (one way was given)
    adopted = by_touch is None or by_touch.advice is Advice.ADOPT
    _tell(found, by_touch)
    if adopted:
        save_probe_file(align_step(content, found, again=again), out)
        if save is not None:
            write_file(save, found.to_json().encode())
        say(f"Wrote {out}.")
    else:
        say("Nothing was written: the present mount is kept.", "yellow")
    answer(_facts(found, by_touch, out if adopted else None), good=adopted)


def _check_files(file: Path, out: Path, save: Path | None, read: Sequence[Path | None]) -> None:
    """Refuse to write over what is read or written; typer.BadParameter."""
    inputs = [path for path in (file, *read) if path is not None]
    refuse_overwriting(out, inputs)
    if save is not None:
        refuse_overwriting(save, inputs)
        if save.resolve() in (out.resolve(), out.with_suffix(".json").resolve()):
            raise typer.BadParameter(f"--save {save} is also the probe's file: choose another name.")


def _tell(found: Alignment, by_touch: TouchAlignment | None) -> None:
    say_all(found.how)
    warn(found.warnings)
    say_all(() if by_touch is None else by_touch.reasons)


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


@probe_app.command(example="probe inspect housing.stl")
def inspect(file: MeshArgument, given: MeshSettings) -> None:
    """Describe the defects of a mesh, in words and numbers.

    Holes, parts, hidden and double walls, facets flipped or cutting through each other, slivers. Exit
    code 1: a defect would spoil contacts.
    """
    from contactbench.pipeline.mesh.inspect import inspect as look

    with Bar("inspecting", counted=True) as bar:
        found = look(file, given.units, tolerance=given.tolerance / 1000, monitor=shown(bar))
    say_all(found.facts)
    for finding in found.findings:
        say(f"{finding.level}: {finding.text}", {"fault": "red", "doubt": "yellow"}.get(finding.level, ""))
    if found.clear:
        say("No problems found.")
    answer(found.to_json(), good=found.sound)


@probe_app.command(example="probe shell housing.stl --close ruled --close fair --out shell.ply")
def shell(file: MeshArgument, out: OutOption, given: ShellSettings) -> None:
    """Make the closed outer surface that can be touched.

    A mesh that is closed and sound stays unchanged. Of others, inner walls and parts are removed; openings are closed
    by invented facets, which are marked. Exit code 1: the resulting surface is not valid.
    """
    from contactbench.pipeline.mesh.sidecar import save_probe_file
    from contactbench.pipeline.preparation.prepare import shell_step

    content = open_mesh(file, given, out)
    with Bar("finding the outer shell", counted=True) as bar:
        done, made = shell_step(
            content, given.close, alpha=metres(given.alpha), gap=metres(given.gap), monitor=shown(bar)
        )
    save_probe_file(done, out)
    for sentence in made.sentences:
        say(sentence, "red" if sentence in made.faults else "")
    answer({"out": str(out), **made.to_json(), "sentences": list(made.sentences)}, good=not made.faults)


@probe_app.command(example="probe simplify aligned.ply --facets 2000 --region-ratio 8 --out probe.ply")
def simplify(file: MeshArgument, out: OutOption, given: SimplifySettings) -> None:
    """Reduce the facets of a probe, and report the resulting error.

    Distances and angles are measured against the input mesh, both ways.
    """
    from contactbench.pipeline.mesh.sidecar import save_probe_file
    from contactbench.pipeline.preparation.prepare import simplify_step, target_of

    target = target_of(given)
    content = open_mesh(file, given, out)
    wanted, stated = target(content.probe)
    with Bar("simplifying", counted=True) as bar:
        done, made, carried = simplify_step(
            content, wanted, stated=stated, region_ratio=given.region_ratio, monitor=shown(bar)
        )
    save_probe_file(done, out)
    result = dict(done.history[-1]["result"])
    sentences = [*made.sentences, *(report.sentence for report in carried)]
    say_all(sentences)
    warn(done.region_warnings)
    answer({"out": str(out), **result, "sentences": sentences, "warnings": list(done.region_warnings)})


@probe_app.command(example="probe ladder aligned.ply --out ladder")
def ladder(
    file: MeshArgument,
    /,
    given: LadderSettings,
    out: Path = Path("contactbench-ladder"),
    facets: str | None = None,
    noise_force: float = 0.05,
    noise_torque: float = 0.002,
    touches: int = 4_000,
) -> None:
    """Compare accuracy and speed over a range of facet counts, and recommend one.

    The same touches, with the sensor's noise, are located on the full mesh and on each simplified one.
    Writes ladder.json, ladder.csv, ladder.svg and ladder.png. Exit code 1: no simplified mesh meets the
    goal.

    Parameters
    ----------
    out : DIR
        Folder to write.
    facets : N,N,...
        Facet counts to try [250 to 20,000].
    noise_force
        Standard deviation of a force, N.
    noise_torque
        Standard deviation of a torque, N·m.
    touches
        Touches to locate.
    """
    from contactbench.pipeline.contact import WrenchNoise
    from contactbench.pipeline.preparation.ladder.compare import ExpectedTouches
    from contactbench.pipeline.preparation.ladder.ladder import Goal
    from contactbench.pipeline.preparation.ladder.measure import DEFAULT_FACETS, measure_ladder
    from contactbench.pipeline.preparation.ladder.picture import save_ladder

    tried = DEFAULT_FACETS if facets is None else counts(facets)
    expected = ExpectedTouches(WrenchNoise(noise_force, noise_torque), given.forces, count=touches)
    goal = Goal(metres(given.max_contact_error))
    content = open_mesh(file, given)
    make_folder(out)
    with Bar("measuring", counted=True) as bar:
        measured = measure_ladder(
            content.probe, expected, tried, goal=goal, region_ratio=given.region_ratio, monitor=shown(bar)
        )
    files = save_ladder(measured, out)
    show_tables(*measured.tables())
    say_all(measured.notes, "yellow")
    say(measured.recommendation.reason)
    say(f"Wrote {', '.join(map(str, files))}.")
    answer({"out": str(out), **measured.to_json()}, good=measured.recommendation.facets is not None)


@probe_app.command(example="probe prepare housing.stl --place 0,0,45,0,0,90 --out probe.ply")
def prepare(
    file: MeshArgument, /, out: OutOption, given: ProbeSettings, alignment: Path | None = None
) -> None:
    """Read, close, align and simplify a mesh, and write the probe with its history, all in one go.

    Regions in the file are kept. Exit code 1: the result is not valid (open, crossing, folded or inside
    out), and nothing is written.

    Parameters
    ----------
    alignment
        Instead: the .json file written by `probe align --save`.
    """
    from contactbench.pipeline.mesh.load import refuse_to_guess
    from contactbench.pipeline.mesh.sidecar import check_target, save_probe_file
    from contactbench.pipeline.preparation.prepare import prepared

    refuse_overwriting(out, [file])
    check_target(out)
    refuse_to_guess(file, given)
    doubt_metres(given.mount)
    inputs = {"mesh": file} if alignment is None else {"mesh": file, "alignment": alignment}
    with Bar("preparing", counted=True) as bar:
        done = prepared(inputs, given, monitor=shown(bar), remember=True)
    if done.ready:
        save_probe_file(done.content, out)
    for sentence in dict.fromkeys(done.sentences):
        noted = sentence in (*done.content.notes, *done.content.region_warnings)
        say(f"warning: {sentence}" if noted else sentence, "yellow" if noted else "")
    say(f"Wrote {out} and {out.with_suffix('.json')}." if done.ready else "Nothing was written.")
    answer({"out": str(out) if done.ready else None, "ready": done.ready, **done.to_json()}, good=done.ready)

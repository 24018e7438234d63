"""``contactbench probe regions ...``: the parts of a probe that are meant to be touched."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from contactbench.pipeline.commands.options import refuse_overwriting
from contactbench.pipeline.console import Noun, as_json, print_json, running_command, say, warn
from contactbench.pipeline.errors import message
from contactbench.pipeline.parameter_options import numbers

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.mesh.regions.exchange import KeptSteps
    from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph
    from contactbench.pipeline.mesh.regions.model import RegionChange, RegionModel
    from contactbench.pipeline.mesh.regions.region import RegionSet
    from contactbench.pipeline.mesh.regions.transfer import Transferred
    from contactbench.pipeline.workbench.regions import Tool


Three = tuple[float, float, float]
MeshArgument = Annotated[
    Path, typer.Argument(metavar="MESH", help="Probe, .ply in metres in S; names are in the .json beside it.")
]
RegionArgument = Annotated[str, typer.Argument(metavar="REGION", help="Name of a region, or its priority.")]


class ProbeRegions:
    """
    The regions of one probe on disk, while a command edits them.

    Attributes
    ----------
    mesh : Path
    probe : Probe
    model : RegionModel
    """

    def __init__(self, mesh: Path) -> None:
        from contactbench.pipeline.mesh.regions.model import RegionModel
        from contactbench.pipeline.mesh.sidecar import load_probe_file

        self.mesh = mesh
        self._content = load_probe_file(mesh)
        warn(self._content.notes)
        self.probe = self._content.probe
        self.model: RegionModel = RegionModel(self._content.regions)
        self._graph: FacetGraph | None = None
        self.model.subscribe(self._changed)

    def _changed(self, change: RegionChange) -> None:
        if change.cut is not None:
            self.probe, self._graph = change.cut.put_on(self.probe), None

    @property
    def graph(self) -> FacetGraph:
        """The probe's facets and their neighbours."""
        from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph

        if self._graph is None:
            self._graph = FacetGraph(self.probe)
        return self._graph

    def replace_all(self, regions: RegionSet, text: str = message("import regions")) -> None:
        """Take over other regions that are kept for the probe, as one step."""
        from contactbench.pipeline.mesh.regions.facet_graph import MeshEdit

        probe = regions.mesh(self.probe)
        cuts = MeshEdit.between(self.probe, probe), MeshEdit.between(probe, self.probe)
        self.model.replace_all(regions, there=cuts[0], back=cuts[1], text=text)

    def rank(self, region: str) -> int:
        """Return the rank of a region given by name or, where none has that name, by rank; InputError if neither."""
        names = [known.name for known in self.model.regions]
        if (
            region not in names
            and region.isascii()
            and region.isdigit()
            and 0 < int(region[:9]) <= len(names)
        ):
            return int(region[:9])
        return self.model.rank_of(region)

    def finish(self, changed: int | None, **facts: Any) -> None:
        """Save, and say how many facets changed and what there is now."""
        self.save({} if changed is None else {"changed": changed})
        if changed is not None:
            say(f"{changed:,} of {len(self.probe.faces):,} facets changed.")
            facts = {"changed": changed, **facts}
        show(self.mesh, self.probe, self.model, **facts)

    def finish_selection(self, changed: int, why_not: str, **facts: Any) -> None:
        """Finish what had facets chosen; where none changed, that is wrong: say why, write nothing, exit code 1."""
        if changed:
            return self.finish(changed, **facts)
        say(f"Nothing changed: {why_not}.", "yellow")
        show(self.mesh, self.probe, self.model, changed=0, **facts)
        raise typer.Exit(1)

    def save(self, result: dict[str, Any]) -> None:
        """Write the probe with the model's regions, and the command that made them into its history, if it did."""
        from contactbench.pipeline.mesh.regions.exchange import KeptStep
        from contactbench.pipeline.mesh.regions.facet_graph import MeshEdit
        from contactbench.pipeline.mesh.sidecar import save_probe_file

        text = self.model.undo_text
        if text is None:
            say("The regions already have this state: nothing was written.")
            return
        regions = self.model.snapshot()
        areas = (1e6 * regions.areas(self.probe.areas)).round(3).tolist()
        content = self._content.after(
            "region",
            self.probe.with_region(regions.labels),
            _command(),
            {**result, "areas_mm2": areas},
            regions=regions,
        )
        steps = self._steps()  # before anything is written: it may refuse
        save_probe_file(content, self.mesh)
        before = replace(self._content.regions, cut=MeshEdit.between(self.probe, self._content.probe))
        steps.done.append(KeptStep.of(text, content.history[-1], before, self.probe))
        steps.undone.clear()
        self._keep(steps)

    def turn(self, way: Literal["undo", "redo"]) -> None:
        """Undo or redo a step, with what it left in the history, and say which; exit code 1: there is none."""
        from contactbench.pipeline.mesh.regions.exchange import KeptStep
        from contactbench.pipeline.mesh.regions.facet_graph import MeshEdit
        from contactbench.pipeline.mesh.sidecar import save_probe_file

        steps, history = self._steps(), self._content.history
        taken, given = (steps.done, steps.undone) if way == "undo" else (steps.undone, steps.done)
        if not taken:
            why = ": something else has changed the probe since then" if steps.changed else ""
            say(f"There is nothing to {way}{why}.", "yellow")
            raise typer.Exit(1)
        step = taken.pop()
        regions = step.regions(self.probe)
        probe = regions.mesh(self.probe)
        cuts = MeshEdit.between(self.probe, probe), MeshEdit.between(probe, self.probe)
        given.append(KeptStep.of(step.text, step.entry, replace(self._content.regions, cut=cuts[1]), probe))
        count = len(self.model.labels)
        differ = regions.labels[:count] != self.model.labels[: len(regions.labels)]
        changed = int(differ.sum()) + abs(len(regions.labels) - count)
        content = replace(
            self._content,
            probe=probe,
            regions=replace(regions, cut=None),
            history=history[:-1] if way == "undo" else (*history, step.entry),
        )
        save_probe_file(content, self.mesh)
        self._keep(steps)
        self.model.replace_all(regions, there=cuts[0], back=cuts[1])
        word = "undone" if way == "undo" else "redone"
        say(f"{word}: {step.text}. {changed:,} of {len(self.probe.faces):,} facets changed.")
        show(self.mesh, self.probe, self.model, **{word: step.text}, changed=changed)

    def _steps(self) -> KeptSteps:
        from contactbench.pipeline.mesh.regions.exchange import load_steps
        from contactbench.pipeline.mesh.sidecar import sidecar_of

        return load_steps((self.mesh, sidecar_of(self.mesh)))

    def _keep(self, steps: KeptSteps) -> None:
        from contactbench.pipeline.mesh.regions.exchange import save_steps
        from contactbench.pipeline.mesh.sidecar import sidecar_of

        save_steps(steps, (self.mesh, sidecar_of(self.mesh)))


def _command() -> dict[str, Any]:
    """Return the command that runs and its parameters, as JSON values; of files the name only."""
    command, parameters = running_command()
    given = {
        name: value.name if isinstance(value, Path) else value
        for name, value in parameters.items()
        if name not in ("mesh", "old", "new", "as_json", "quiet") and value not in (None, False, [], ())
    }
    return {"command": command, **given}


def show(mesh: Path, probe: Probe, model: RegionModel, **facts: Any) -> None:
    """Print the regions: as a table for people, or as one JSON object."""
    snapshot = model.snapshot()
    areas = 1e6 * snapshot.areas(probe.areas)
    counts = [len(snapshot.faces_of(rank)) for rank in range(1, len(snapshot.regions) + 1)]
    if as_json():
        rows = [
            {
                "priority": rank,
                "name": region.name,
                "colour": region.colour,
                "untouchable": region.untouchable,
                "facets": count,
                "area_mm2": float(area),
            }
            for rank, (region, count, area) in enumerate(zip(snapshot.regions, counts, areas, strict=True), 1)
        ]
        print_json({"mesh": str(mesh), "facets": len(probe.faces), **facts, "regions": rows})
        return
    from rich.console import Console
    from rich.table import Column, Table

    sizes = (Column(title, justify="right") for title in ("facets", "mm²", "%"))
    table = Table(Column(justify="right"), "region", "colour", *sizes, "", box=None)
    whole = 1e6 * float(probe.areas.sum())
    for rank, (region, count, area) in enumerate(zip(snapshot.regions, counts, areas, strict=True), 1):
        share = f"{100 * area / whole:.1f}"
        mark = "untouchable" if region.untouchable else ""
        table.add_row(str(rank), region.name, region.colour, f"{count:,}", f"{area:.1f}", share, mark)
    Console(markup=False).print(table)


def _edit(mesh: Path, change: Callable[[ProbeRegions], object]) -> None:
    session = ProbeRegions(mesh)
    change(session)
    session.finish(None)


def _metres(millimetres: Sequence[float]) -> NDArray[np.float64]:
    """Return a point (3,) in m."""
    import numpy as np

    return np.array(millimetres) / 1000


regions_app = Noun(
    "Mark the parts of a probe that are meant to be touched, in order of priority.\n\nRegions are"
    " stored in the probe's .ply (a rank per facet) and in the .json beside it (names, colours,"
    " and which of them are untouchable). Each command changes both in one step, which `probe"
    " regions undo` reverts. Lengths are in mm, in the sensor frame S. Exit code 1: facets were"
    " chosen, but none changed."
)


@regions_app.command("list", example="probe regions list probe.ply")
def list_regions(mesh: MeshArgument) -> None:
    """Show the regions of a probe: priority, name, colour, facets, area, and whether they are untouchable."""
    session = ProbeRegions(mesh)
    show(mesh, session.probe, session.model)


@regions_app.command(example="probe regions add probe.ply Lens --colour '#e69f00'")
def add(mesh: MeshArgument, name: str, /, colour: str | None = None) -> None:
    """Add an empty region, with the last priority.

    Parameters
    ----------
    name
        Name, at most 64 characters.
    colour : #RRGGBB
        Its colour [the next of a palette].
    """
    _edit(mesh, lambda session: session.model.add(name, colour))


@regions_app.command(example="probe regions remove probe.ply Lens")
def remove(mesh: MeshArgument, region: RegionArgument) -> None:
    """Remove a region; its facets then belong to none, and lower priorities move up."""
    session = ProbeRegions(mesh)
    rank = session.rank(region)
    count = int((session.model.labels == rank).sum())
    session.model.remove(rank)
    session.finish(count)


@regions_app.command(example="probe regions rename probe.ply Lens 'Acoustic window'")
def rename(mesh: MeshArgument, region: RegionArgument, name: str, /) -> None:
    """Give a region another name.

    Parameters
    ----------
    name
        New name, at most 64 characters.
    """
    _edit(mesh, lambda session: session.model.rename(session.rank(region), name))


@regions_app.command(example="probe regions colour probe.ply Lens '#0072b2'")
def colour(mesh: MeshArgument, region: RegionArgument, value: str, /) -> None:
    """Give a region another colour.

    Parameters
    ----------
    value : #RRGGBB
        New colour.
    """
    _edit(mesh, lambda session: session.model.recolour(session.rank(region), value))


@regions_app.command(example="probe regions mark probe.ply Clamp --untouchable")
def mark(
    mesh: MeshArgument,
    region: RegionArgument,
    untouchable: Annotated[
        bool, typer.Option("--untouchable/--touchable", help="Whether the region is untouchable.")
    ],
) -> None:
    """Mark a region as untouchable or touchable, such as one hidden by a clamp or a drape.

    A contact there counts as 1000 times less likely, so the remaining places are easier to tell apart.
    """
    _edit(mesh, lambda session: session.model.set_untouchable(session.rank(region), untouchable))


@regions_app.command(example="probe regions reorder probe.ply Lens Neck Handle")
def reorder(mesh: MeshArgument, order: list[str], /) -> None:
    """Change the priorities: name all regions, highest priority first.

    Parameters
    ----------
    order : REGION...
        Names of all regions, each once.
    """
    _edit(mesh, lambda session: session.model.reorder([session.rank(region) for region in order]))


@regions_app.command(example="probe regions undo probe.ply")
def undo(mesh: MeshArgument) -> None:
    """Undo the last region command on a probe; up to 100, one after the other.

    Both files are restored byte for byte. The steps are kept beside the probe, in its .undo file; they end
    when something else changes the probe. Exit code 1: there is nothing to undo.
    """
    ProbeRegions(mesh).turn("undo")


@regions_app.command(example="probe regions redo probe.ply")
def redo(mesh: MeshArgument) -> None:
    """Redo the last undone command. Exit code 1: there is nothing to redo."""
    ProbeRegions(mesh).turn("redo")


@regions_app.command(example="probe regions export probe.ply --out regions.json")
def export(mesh: MeshArgument, /, out: Path) -> None:
    """Export the regions to a .json or .csv file.

    JSON contains names, colours, marks and facets, and fits only this mesh; CSV contains face,region.

    Parameters
    ----------
    out
        File to write, .json or .csv.
    """
    from contactbench.pipeline.mesh.regions.exchange import save_regions
    from contactbench.pipeline.mesh.regions.region import RegionError
    from contactbench.pipeline.mesh.sidecar import sidecar_of

    session = ProbeRegions(mesh)
    if out.resolve() == sidecar_of(mesh).resolve():
        raise RegionError(f"{out} holds the names of the regions: choose another --out.")
    save_regions(session.model.snapshot(), session.probe, out)
    say(f"{len(session.model.regions)} regions written to {out}.")
    show(mesh, session.probe, session.model, out=str(out))


@regions_app.command("import", example="probe regions import probe.ply regions.json")
def import_regions(mesh: MeshArgument, file: Path, /) -> None:
    """Replace all regions of a probe by those in a .json or .csv file.

    A .json file fits only the mesh it was made for; for another mesh use transfer. With .csv, existing
    names, colours and marks are kept.

    Parameters
    ----------
    file
        .json or .csv.
    """
    from contactbench.pipeline.mesh.regions.exchange import load_regions
    from contactbench.pipeline.mesh.regions.region import RegionSet

    session = ProbeRegions(mesh)
    before = session.model.labels.copy()
    imported = load_regions(file, session.probe)
    if file.suffix.lower() == ".csv":
        imported = RegionSet.from_labels(imported.labels, session.model.regions)
    session.replace_all(imported)
    session.finish(
        int((before != session.model.labels).sum()) if imported.cut is None else imported.cut.count
    )


@regions_app.command(example="probe regions transfer probe.ply probe-1000.ply")
def transfer(old: Path, new: Path, /, reach: float | None = None) -> None:
    """Transfer the regions of one mesh to another mesh of the same surface.

    The other mesh may be simplified, a shell, or a new export.

    Both are in S. Each facet of NEW takes the region of the nearest facet of OLD that faces the same way.
    NEW's own regions are replaced. Exit code 1: a region vanished.

    Parameters
    ----------
    old
        Probe with regions, .ply.
    new
        Probe that gets them, .ply; is overwritten.
    reach
        Facets farther than this from OLD get none, mm [2 % of the size].
    """
    import warnings

    from contactbench.pipeline.mesh import MeshWarning
    from contactbench.pipeline.mesh.regions.exchange import mesh_hash
    from contactbench.pipeline.mesh.regions.transfer import transfer as carry

    refuse_overwriting(new, [old])
    source, target = ProbeRegions(old), ProbeRegions(new)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)  # said below
        result = carry(
            source.model.snapshot(), source.probe, target.probe, reach=None if reach is None else reach / 1000
        )
    target.replace_all(result.regions, text=f"transfer from {old.name}")
    target.save({"from": mesh_hash(source.probe)})
    _say_transferred(result)
    if as_json():
        print_json(
            {
                "mesh": str(new),
                "facets": len(target.probe.faces),
                "unmatched": result.unmatched,
                "regions": [part.to_json() for part in result.report],
                "warnings": list(result.warnings),
            }
        )
    else:
        show(new, target.probe, target.model)
    if any(part.vanished for part in result.report):
        raise typer.Exit(1)


def _say_transferred(result: Transferred) -> None:
    for part in result.report:
        say(part.sentence, "red" if part.vanished else "")
    warn(result.warnings)


_NEAR = 0.02  # of the probe's size: as far off the surface a point may be that is meant to be on it

EraseOption = Annotated[bool, typer.Option("--erase", help="Remove the facets from REGION instead.")]
ProtectOption = Annotated[bool, typer.Option("--protect", help="Leave facets of other regions unchanged.")]
RingsOption = Annotated[int | None, typer.Option(help="Rings of facets that share a vertex.")]
DistanceOption = Annotated[float | None, typer.Option(help="Instead: distance along the surface, mm.")]
PointOption = Annotated[str, typer.Option(metavar="X,Y,Z", help="A point on the plane, mm.")]
NormalOption = Annotated[str, typer.Option(metavar="X,Y,Z", help="Normal of the plane, of any length.")]


@regions_app.command(example="probe regions box probe.ply Lens --low=-30,-10,120 --high=30,10,150")
def box(
    mesh: MeshArgument,
    region: RegionArgument,
    /,
    low: Three,
    high: Three,
    frame: tuple[float, float, float, float, float, float] | None = None,
    erase: EraseOption = False,
    protect: ProtectOption = False,
) -> None:
    """Give REGION what lies in a box, whose sides cut the facets.

    Parameters
    ----------
    low : X,Y,Z
        Lowest corner, mm.
    high : X,Y,Z
        Highest corner, mm.
    frame : X,Y,Z,RX,RY,RZ
        Pose of the box's axes in S: mm, then degrees about the fixed axes x, y, z [those of S].
    """
    from contactbench.pipeline.workbench.regions import Box

    tool = Box(_metres(low), _metres(high))
    if frame is not None:
        from scipy.spatial.transform import Rotation

        R_SB = Rotation.from_euler("xyz", frame[3:], degrees=True).as_matrix()
        tool = replace(tool, R_SB=R_SB, p_SB_S=_metres(frame[:3]))
    _use(ProbeRegions(mesh), region, tool, erase=erase, protect=protect)


@regions_app.command(example="probe regions plane probe.ply Lens --point 0,0,120 --normal 0,0,1")
def plane(
    mesh: MeshArgument,
    region: RegionArgument,
    point: PointOption,
    normal: NormalOption,
    erase: EraseOption = False,
    protect: ProtectOption = False,
) -> None:
    """Give REGION what lies on the side of a plane to which its normal points; the plane cuts the facets."""
    from contactbench.pipeline.workbench.regions import Plane

    tool = Plane(_metres(numbers(point, 3, "--point")), numbers(normal, 3, "--normal"))
    _use(ProbeRegions(mesh), region, tool, erase=erase, protect=protect)


@regions_app.command(example="probe regions flood probe.ply Lens --at 0,0,140 --crease 20")
def flood(
    mesh: MeshArgument,
    region: RegionArgument,
    /,
    at: Three,
    crease: float = 30.0,
    erase: EraseOption = False,
    protect: ProtectOption = False,
) -> None:
    """Give REGION the facets around a point, up to edges sharper than --crease.

    Parameters
    ----------
    at : X,Y,Z
        Where to start: the facet nearest to this point, mm.
    crease
        Sharpest edge to cross, degrees.
    """
    from contactbench.pipeline.workbench.regions import Flood

    session = ProbeRegions(mesh)
    faces, _ = session.graph.pick(_metres(at))
    _use(session, region, Flood(int(faces[0]), math.radians(crease)), erase=erase, protect=protect)


@regions_app.command(example="probe regions brush probe.ply Lens --at=-20,0,140 --at=20,0,140 --radius 5")
def brush(
    mesh: MeshArgument,
    region: RegionArgument,
    /,
    at: list[Three],
    radius: float,
    straight: bool = False,
    erase: EraseOption = False,
    protect: ProtectOption = False,
) -> None:
    """Paint REGION with a round brush along the surface, through the points nearest to --at.

    Give --at once for a dab, several times for a stroke. A point farther from the surface than the radius,
    or 2 % of the size if that is more, is refused.

    Parameters
    ----------
    at : X,Y,Z
        A point of the stroke, mm.
    radius
        Radius of the brush, mm.
    straight
        Measure through space, not along the surface.
    """
    from contactbench.pipeline.mesh.regions.selections import Brush

    tool = Brush(radius / 1000, geodesic=not straight, erase=erase, protect=protect or erase)
    where = [_metres(each) for each in at]
    session = ProbeRegions(mesh)
    faces, points = session.graph.pick(where, within=max(tool.radius, _NEAR * session.probe.size))
    rank = session.rank(region)
    with session.model.stroke(session.graph, tool, rank) as stroke:
        changed = sum(
            len(stroke.extend(face, point)) for face, point in zip(faces.tolist(), points, strict=True)
        )
    session.finish_selection(changed, _kept_as(erase=erase, protect=protect))


@regions_app.command(example="probe regions grow probe.ply Lens --distance 2")
def grow(
    mesh: MeshArgument, region: RegionArgument, rings: RingsOption = None, distance: DistanceOption = None
) -> None:
    """Grow REGION at its border, by rings of facets or a distance. Other regions stay unchanged."""
    from contactbench.pipeline.workbench.regions import Grow

    _use(ProbeRegions(mesh), region, Grow((distance or 0.0) / 1000, rings or 0))


@regions_app.command(example="probe regions shrink probe.ply Lens --rings 2")
def shrink(
    mesh: MeshArgument, region: RegionArgument, rings: RingsOption = None, distance: DistanceOption = None
) -> None:
    """Shrink REGION at its border, by rings of facets or a distance."""
    from contactbench.pipeline.workbench.regions import Shrink

    _use(ProbeRegions(mesh), region, Shrink((distance or 0.0) / 1000, rings or 0))


@regions_app.command(example="probe regions smooth probe.ply Lens --rings 3")
def smooth(mesh: MeshArgument, region: RegionArgument, /, rings: int = 2) -> None:
    """Straighten the border of REGION, fill its holes and remove its specks.

    Its area and other regions stay unchanged.

    Parameters
    ----------
    rings
        Features narrower than about this many facets are removed.
    """
    from contactbench.pipeline.workbench.regions import Smooth

    _use(ProbeRegions(mesh), region, Smooth(rings))


@regions_app.command(example="probe regions mirror probe.ply Side --normal 1,0,0")
def mirror(
    mesh: MeshArgument,
    region: RegionArgument,
    /,
    normal: NormalOption,
    point: PointOption = "0,0,0",
    tolerance: float | None = None,
    protect: ProtectOption = False,
) -> None:
    """Add the mirror images of its facets to REGION.

    Exit code 1: some facets have no counterpart, because the surface is not symmetric there.

    Parameters
    ----------
    tolerance
        How far the surface may lie from the image, mm [the mean edge].
    """
    from contactbench.pipeline.workbench.regions import Mirror

    where, direction = _metres(numbers(point, 3, "--point")), numbers(normal, 3, "--normal")
    reach = None if tolerance is None else tolerance / 1000
    _use(ProbeRegions(mesh), region, Mirror(where, direction, reach), protect=protect)


@regions_app.command(example="probe regions clear probe.ply Lens")
def clear(mesh: MeshArgument, region: RegionArgument) -> None:
    """Remove all facets from REGION; its name, colour and priority stay."""
    from contactbench.pipeline.workbench.regions import Clear

    _use(ProbeRegions(mesh), region, Clear())


def _use(
    session: ProbeRegions, region: str, tool: Tool, *, erase: bool = False, protect: bool = False
) -> None:
    """Use a tool of the window on a region."""
    from contactbench.pipeline.mesh.regions.selections import Mirrored
    from contactbench.pipeline.workbench.regions import Box, Flood, Mirror, Plane, find, give

    rank = session.rank(region)
    empty = rank not in session.model.labels
    found = find(session.graph, session.model.labels, rank, tool)
    changed = give(session.model, found, protect=protect, erase=erase)
    chosen = found.selection
    if isinstance(tool, Flood | Box | Plane):
        why_not = _kept_as(erase=erase, protect=protect) if chosen.mask.any() else "no facet lies there"
    elif empty:
        why_not = "the region has no facets"
    elif isinstance(tool, Mirror):
        why_not = _kept_as(erase=erase, protect=protect)
    else:
        why_not = "the region already has that shape"
    unmatched = len(chosen.unmatched) if isinstance(chosen, Mirrored) else 0
    if chosen.sentence:
        say(chosen.sentence, "yellow" if unmatched else "")
    facts = {"unmatched": unmatched} if isinstance(chosen, Mirrored) else {}
    session.finish_selection(changed, why_not, **facts)
    if unmatched:
        raise typer.Exit(1)


def _kept_as(*, erase: bool, protect: bool) -> str:
    """Say why facets that were chosen stayed where they are."""
    if erase:
        return "none of them belongs to it"
    return "they already belong to it" + (", or to others, where --protect leaves them" if protect else "")

"""``contactbench region box, plane, flood, ...``: which facets belong to a region."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated

import typer

from contactbench.pipeline.commands.options import numbers
from contactbench.pipeline.commands.region_session import MeshArgument, RegionArgument, Session, metres
from contactbench.pipeline.console import JsonOption, say

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

facets_app = typer.Typer(rich_markup_mode=None)

_NEAR = 0.02  # of the probe's size: as far off the surface a point may be that is meant to be on it
_EMPTY = "the region has no facets"

EraseOption = Annotated[bool, typer.Option("--erase", help="Take the facets out of REGION instead.")]
ProtectOption = Annotated[bool, typer.Option("--protect", help="Facets of other regions stay theirs.")]
RingsOption = Annotated[int | None, typer.Option(help="Rings of facets that share a vertex.")]
DistanceOption = Annotated[float | None, typer.Option(help="Or so far along the surface, mm.")]
PointOption = Annotated[str, typer.Option(metavar="X,Y,Z", help="A point on the plane, mm.")]
NormalOption = Annotated[str, typer.Option(metavar="X,Y,Z", help="Normal of the plane, of any length.")]


@facets_app.command(
    help="Give REGION the facets whose centroid lies in a box.",
    epilog="Example: contactbench region box probe.ply Lens --low=-30,-10,120 --high=30,10,150",
)
def box(
    mesh: MeshArgument,
    region: RegionArgument,
    low: Annotated[str, typer.Option(metavar="X,Y,Z", help="Lowest corner, mm.")],
    high: Annotated[str, typer.Option(metavar="X,Y,Z", help="Highest corner, mm.")],
    frame: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,Z,RX,RY,RZ",
            help="Pose of the box's axes in S: mm, then degrees about the fixed axes x, y, z [those of S].",
        ),
    ] = None,
    erase: EraseOption = False,
    protect: ProtectOption = False,
    as_json: JsonOption = False,
) -> None:
    """Give a region the facets in a box."""
    from contactbench.pipeline.mesh.regions import in_box

    corners = metres(low, "--low"), metres(high, "--high")
    session = Session(mesh)
    if frame is None:
        chosen = in_box(session.graph, *corners)
    else:
        from scipy.spatial.transform import Rotation

        values = numbers(frame, 6, "--frame")
        R_SB = Rotation.from_euler("xyz", values[3:], degrees=True).as_matrix()
        chosen = in_box(session.graph, *corners, R_SB=R_SB, p_SB_S=[value / 1000 for value in values[:3]])
    _assign(session, region, chosen, "box into", erase, protect, as_json)


@facets_app.command(
    help="Give REGION the facets on the side of a plane that its normal points to.",
    epilog="Example: contactbench region plane probe.ply Lens --point 0,0,120 --normal 0,0,1",
)
def plane(
    mesh: MeshArgument,
    region: RegionArgument,
    point: PointOption,
    normal: NormalOption,
    erase: EraseOption = False,
    protect: ProtectOption = False,
    as_json: JsonOption = False,
) -> None:
    """Give a region the facets on one side of a plane."""
    from contactbench.pipeline.mesh.regions import half_space

    where, direction = metres(point, "--point"), numbers(normal, 3, "--normal")
    session = Session(mesh)
    chosen = half_space(session.graph, where, direction)
    _assign(session, region, chosen, "half into", erase, protect, as_json)


@facets_app.command(
    help="Give REGION the facets around a point, as far as no edge is sharper than --crease.",
    epilog="Example: contactbench region flood probe.ply Lens --at 0,0,140 --crease 20",
)
def flood(
    mesh: MeshArgument,
    region: RegionArgument,
    at: Annotated[str, typer.Option(metavar="X,Y,Z", help="Where to begin: the facet nearest to this, mm.")],
    crease: Annotated[float, typer.Option(help="Sharpest edge that is crossed, degrees.")] = 30.0,
    erase: EraseOption = False,
    protect: ProtectOption = False,
    as_json: JsonOption = False,
) -> None:
    """Give a region the facets around a point, up to creases."""
    from contactbench.pipeline.mesh.regions import flood as fill

    where = metres(at, "--at")
    session = Session(mesh)
    faces, _ = session.graph.pick(where)
    chosen = fill(session.graph, int(faces[0]), math.radians(crease))
    _assign(session, region, chosen, "fill", erase, protect, as_json)


@facets_app.command(
    help=(
        "Paint REGION with a round brush, along the surface through the points nearest to --at.\n\n"
        "--at is given once for a dab, several times for a stroke. A point further from the surface than the radius,"
        " or 2 % of the size if that is more, is refused."
    ),
    epilog="Example: contactbench region brush probe.ply Lens --at=-20,0,140 --at=20,0,140 --radius 5",
)
def brush(
    mesh: MeshArgument,
    region: RegionArgument,
    at: Annotated[list[str], typer.Option(metavar="X,Y,Z", help="A point of the stroke, mm.")],
    radius: Annotated[float, typer.Option(help="Of the brush, mm.")],
    straight: Annotated[
        bool,
        typer.Option("--straight", help="Measure through space, not along the surface."),
    ] = False,
    erase: EraseOption = False,
    protect: ProtectOption = False,
    as_json: JsonOption = False,
) -> None:
    """Paint a region with a round brush."""
    from contactbench.pipeline.mesh.regions import Brush

    tool = Brush(radius / 1000, geodesic=not straight, erase=erase, protect=protect or erase)
    where = [metres(text, "--at") for text in at]
    session = Session(mesh)
    faces, points = session.graph.pick(where, within=max(tool.radius, _NEAR * session.probe.size))
    rank = session.rank(region)
    with session.model.stroke(session.graph, tool, rank) as stroke:
        changed = sum(
            len(stroke.extend(face, point)) for face, point in zip(faces.tolist(), points, strict=True)
        )
    session.finish_selection(changed, _kept_as(erase=erase, protect=protect), as_json)


@facets_app.command(
    help="Let REGION grow at its border, by rings of facets or a distance. Other regions stay as they are.",
    epilog="Example: contactbench region grow probe.ply Lens --distance 2",
)
def grow(
    mesh: MeshArgument,
    region: RegionArgument,
    rings: RingsOption = None,
    distance: DistanceOption = None,
    as_json: JsonOption = False,
) -> None:
    """Let a region grow at its border."""
    from contactbench.pipeline.mesh.regions import grow as extend

    session = Session(mesh)
    rank = session.rank(region)
    chosen = extend(session.graph, session.mask(rank), rings=rings or 0, distance=(distance or 0.0) / 1000)
    _reshape(session, rank, chosen, "grow", as_json)


@facets_app.command(
    help="Let REGION shrink at its border, by rings of facets or a distance.",
    epilog="Example: contactbench region shrink probe.ply Lens --rings 2",
)
def shrink(
    mesh: MeshArgument,
    region: RegionArgument,
    rings: RingsOption = None,
    distance: DistanceOption = None,
    as_json: JsonOption = False,
) -> None:
    """Let a region shrink at its border."""
    from contactbench.pipeline.mesh.regions import shrink as reduce

    session = Session(mesh)
    rank = session.rank(region)
    chosen = reduce(session.graph, session.mask(rank), rings=rings or 0, distance=(distance or 0.0) / 1000)
    _reshape(session, rank, chosen, "shrink", as_json)


@facets_app.command(
    help=(
        "Straighten the border of REGION, fill its holes and remove its specks; its area stays. Other regions stay"
        " as they are."
    ),
    epilog="Example: contactbench region smooth probe.ply Lens --rings 3",
)
def smooth(
    mesh: MeshArgument,
    region: RegionArgument,
    rings: Annotated[int, typer.Option(help="What is narrower than about this many facets goes.")] = 2,
    as_json: JsonOption = False,
) -> None:
    """Straighten the border of a region."""
    from contactbench.pipeline.mesh.regions import smooth as straighten

    session = Session(mesh)
    rank = session.rank(region)
    chosen = straighten(session.graph, session.mask(rank), rings, allowed=session.mask(0))
    _reshape(session, rank, chosen, "smooth", as_json)


@facets_app.command(
    help=(
        "Give REGION also the facets that lie where its own are after mirroring.\n\n"
        "Exit code 1: some facets have no counterpart, because the surface is not symmetric there."
    ),
    epilog="Example: contactbench region mirror probe.ply Side --normal 1,0,0",
)
def mirror(
    mesh: MeshArgument,
    region: RegionArgument,
    normal: NormalOption,
    point: PointOption = "0,0,0",
    tolerance: Annotated[
        float | None, typer.Option(help="How far a centroid may be off, mm [the mean edge].")
    ] = None,
    protect: ProtectOption = False,
    as_json: JsonOption = False,
) -> None:
    """Give a region the facets on the other side of a plane, too."""
    from contactbench.pipeline.mesh.regions import mirror as reflect

    direction, where = numbers(normal, 3, "--normal"), metres(point, "--point")
    session = Session(mesh)
    rank = session.rank(region)
    reach = None if tolerance is None else tolerance / 1000
    result = reflect(session.graph, session.mask(rank), direction, where, tolerance=reach)
    changed = session.model.assign(result.mask, rank, protect=protect, text=f"mirror {session.name(rank)}")
    say(result.sentence, "yellow" if len(result.unmatched) else "")
    why_not = _kept_as(erase=False, protect=protect) if session.mask(rank).any() else _EMPTY
    session.finish_selection(len(changed), why_not, as_json, unmatched=len(result.unmatched))
    if len(result.unmatched):
        raise typer.Exit(1)


@facets_app.command(
    help="Take all facets out of REGION; its name, colour and priority stay.",
    epilog="Example: contactbench region clear probe.ply Lens",
)
def clear(mesh: MeshArgument, region: RegionArgument, as_json: JsonOption = False) -> None:
    """Take all facets out of a region."""
    session = Session(mesh)
    rank = session.rank(region)
    changed = session.model.assign(session.mask(rank), 0, text=f"clear {session.name(rank)}")
    session.finish_selection(len(changed), _EMPTY, as_json)


def _assign(
    session: Session,
    region: str,
    chosen: NDArray[np.bool_],
    what: str,
    erase: bool,
    protect: bool,
    as_json: bool,
) -> None:
    rank = session.rank(region)
    text = f"{what} {session.name(rank)}"
    if erase:
        changed = session.model.assign(chosen & session.mask(rank), 0, text=f"{text}, erasing")
    else:
        changed = session.model.assign(chosen, rank, protect=protect, text=text)
    why_not = _kept_as(erase=erase, protect=protect) if chosen.any() else "no facet lies there"
    session.finish_selection(len(changed), why_not, as_json)


def _kept_as(*, erase: bool, protect: bool) -> str:
    """Say why facets that were chosen stayed where they are."""
    if erase:
        return "none of them is in it"
    return "they are in it already" + (", or in others, where --protect leaves them" if protect else "")


def _reshape(session: Session, rank: int, chosen: NDArray[np.bool_], text: str, as_json: bool) -> None:
    why_not = "the region has that shape already" if session.mask(rank).any() else _EMPTY
    changed = session.model.set_region(rank, chosen, text=f"{text} {session.name(rank)}")
    session.finish_selection(len(changed), why_not, as_json)

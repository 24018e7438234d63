"""``contactbench region``: the priority regions of a probe, from the command line."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from contactbench.pipeline.commands.options import refuse_overwriting
from contactbench.pipeline.commands.region_facets import facets_app
from contactbench.pipeline.commands.region_session import MeshArgument, RegionArgument, Session, show
from contactbench.pipeline.console import JsonOption, print_json, say

if TYPE_CHECKING:
    from contactbench.pipeline.mesh.regions import Transferred

region_app = typer.Typer(
    name="region",
    help=(
        "Mark the parts of a probe that are meant to be touched, in order of priority.\n\n"
        "Regions live in the probe's .ply (a rank per facet) and in the .json beside it (names, colours, and which of"
        " them nothing can touch). Each command changes both in one step, which region undo takes back. Lengths are in"
        " mm, in the sensor frame S."
        " Exit code 1: facets were chosen, but none changed."
    ),
    epilog="Example: contactbench region add probe.ply Lens",
    no_args_is_help=True,
    rich_markup_mode=None,
)

ColourOption = Annotated[str | None, typer.Option(metavar="#RRGGBB", help="[the next of a palette]")]


@region_app.command(
    "list",
    help="Show the regions of a probe: priority, name, colour, facets, area, and whether nothing can touch it.",
    epilog="Example: contactbench region list probe.ply",
)
def list_regions(mesh: MeshArgument, as_json: JsonOption = False) -> None:
    """Show the regions of a probe."""
    session = Session(mesh)
    show(mesh, session.probe, session.model, as_json)


@region_app.command(
    help="Add an empty region, with the last priority.",
    epilog="Example: contactbench region add probe.ply Lens --colour '#e69f00'",
)
def add(
    mesh: MeshArgument,
    name: Annotated[str, typer.Argument(metavar="NAME", help="At most 64 characters.")],
    colour: ColourOption = None,
    as_json: JsonOption = False,
) -> None:
    """Add an empty region."""
    session = Session(mesh)
    session.model.add(name, colour)
    session.finish(None, as_json)


@region_app.command(
    help="Remove a region; its facets belong to none, and the priorities behind it move up.",
    epilog="Example: contactbench region remove probe.ply Lens",
)
def remove(mesh: MeshArgument, region: RegionArgument, as_json: JsonOption = False) -> None:
    """Remove a region."""
    session = Session(mesh)
    rank = session.rank(region)
    count = int(session.mask(rank).sum())
    session.model.remove(rank)
    session.finish(count, as_json)


@region_app.command(
    help="Give a region another name.",
    epilog="Example: contactbench region rename probe.ply Lens 'Acoustic window'",
)
def rename(
    mesh: MeshArgument,
    region: RegionArgument,
    name: Annotated[str, typer.Argument(metavar="NAME", help="At most 64 characters.")],
    as_json: JsonOption = False,
) -> None:
    """Give a region another name."""
    session = Session(mesh)
    session.model.rename(session.rank(region), name)
    session.finish(None, as_json)


@region_app.command(
    help="Give a region another colour.",
    epilog="Example: contactbench region colour probe.ply Lens '#0072b2'",
)
def colour(
    mesh: MeshArgument,
    region: RegionArgument,
    value: Annotated[str, typer.Argument(metavar="#RRGGBB")],
    as_json: JsonOption = False,
) -> None:
    """Give a region another colour."""
    session = Session(mesh)
    session.model.recolour(session.rank(region), value)
    session.finish(None, as_json)


@region_app.command(
    help=(
        "Say whether nothing can touch a region, such as one that a clamp or a drape hides.\n\n"
        "A contact there counts as 1000 times less likely, and the places that remain are told apart better."
    ),
    epilog="Example: contactbench region mark probe.ply Clamp --untouchable",
)
def mark(
    mesh: MeshArgument,
    region: RegionArgument,
    untouchable: Annotated[
        bool, typer.Option("--untouchable/--touchable", help="Whether nothing can touch it.")
    ],
    as_json: JsonOption = False,
) -> None:
    """Say whether nothing can touch a region."""
    session = Session(mesh)
    session.model.set_untouchable(session.rank(region), untouchable)
    session.finish(None, as_json)


@region_app.command(
    help="Change the priorities: name all regions, the first priority first.",
    epilog="Example: contactbench region reorder probe.ply Lens Neck Handle",
)
def reorder(
    mesh: MeshArgument,
    order: Annotated[list[str], typer.Argument(metavar="REGION...", help="Every region once.")],
    as_json: JsonOption = False,
) -> None:
    """Change the priorities."""
    session = Session(mesh)
    session.model.reorder([session.rank(region) for region in order])
    session.finish(None, as_json)


@region_app.command(
    help=(
        "Take back the last region command on a probe; up to 100, one after the other.\n\n"
        "Both files are byte for byte what they were before it. The steps are kept beside the probe, in its .undo file;"
        " they end where something else changes the probe. Exit code 1: there is nothing to undo."
    ),
    epilog="Example: contactbench region undo probe.ply",
)
def undo(mesh: MeshArgument, as_json: JsonOption = False) -> None:
    """Take back the last region command on a probe."""
    Session(mesh).turn("undo", as_json)


@region_app.command(
    help="Do again what region undo took back last. Exit code 1: there is nothing to redo.",
    epilog="Example: contactbench region redo probe.ply",
)
def redo(mesh: MeshArgument, as_json: JsonOption = False) -> None:
    """Do again what was undone last."""
    Session(mesh).turn("redo", as_json)


# ---- files -------------------------------------------------------------------------------------


@region_app.command(
    help=(
        "Write the regions to a file of their own: .json (names, colours, marks, facets; fits this mesh only) or .csv"
        " (face,region)."
    ),
    epilog="Example: contactbench region export probe.ply --out regions.json",
)
def export(
    mesh: MeshArgument,
    out: Annotated[Path, typer.Option(help="File to write, .json or .csv.")],
    as_json: JsonOption = False,
) -> None:
    """Write the regions to a file of their own."""
    from contactbench.pipeline.mesh.regions import RegionError, save_regions
    from contactbench.pipeline.mesh.sidecar import sidecar_of

    session = Session(mesh)
    if out.resolve() == sidecar_of(mesh).resolve():
        raise RegionError(f"{out} holds the names of the regions: choose another --out.")
    save_regions(session.model.snapshot(), session.probe, out)
    say(f"{len(session.model.regions)} regions written to {out}.")
    show(mesh, session.probe, session.model, as_json, out=str(out))


@region_app.command(
    "import",
    help=(
        "Replace all regions of a probe by those of a file, .json or .csv.\n\n"
        "A .json file fits the mesh that it was made for; for another one use transfer. From .csv names, colours and"
        " marks stay, as far as there are any."
    ),
    epilog="Example: contactbench region import probe.ply regions.json",
)
def import_regions(
    mesh: MeshArgument,
    file: Annotated[Path, typer.Argument(metavar="FILE", help=".json or .csv.")],
    as_json: JsonOption = False,
) -> None:
    """Replace all regions by those of a file."""
    from contactbench.pipeline.mesh.regions import RegionSet, load_regions

    session = Session(mesh)
    before = session.model.labels.copy()
    imported = load_regions(file, session.probe)
    if file.suffix.lower() == ".csv":
        imported = RegionSet.from_labels(imported.labels, session.model.regions)
    session.model.replace_all(imported)
    session.finish(int((before != session.model.labels).sum()), as_json)


@region_app.command(
    help=(
        "Carry the regions of one mesh over to another of the same surface: simplified, made a shell, or exported"
        " again.\n\n"
        "Both are in S. Each facet of NEW takes the region of the nearest facet of OLD that faces the same way."
        " NEW's own regions are replaced. Exit code 1: a region vanished."
    ),
    epilog="Example: contactbench region transfer probe.ply probe-1000.ply",
)
def transfer(
    old: Annotated[Path, typer.Argument(metavar="OLD", help="Probe with regions, .ply.")],
    new: Annotated[Path, typer.Argument(metavar="NEW", help="Probe to give them to, .ply; is overwritten.")],
    reach: Annotated[
        float | None, typer.Option(help="Facets further than this from OLD get none, mm [2 % of the size].")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Carry the regions of one mesh over to another."""
    import warnings

    from contactbench.pipeline.mesh import MeshWarning
    from contactbench.pipeline.mesh.regions import transfer as carry
    from contactbench.pipeline.mesh.regions.exchange import mesh_hash

    refuse_overwriting(new, [old])
    source, target = Session(old), Session(new)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)  # said below
        result = carry(
            source.model.snapshot(), source.probe, target.probe, reach=None if reach is None else reach / 1000
        )
    target.model.replace_all(result.regions, text=f"transfer from {old.name}")
    target.save({"from": mesh_hash(source.probe)})
    _say_transferred(result)
    if as_json:
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
        show(new, target.probe, target.model, as_json)
    if any(part.vanished for part in result.report):
        raise typer.Exit(1)


def _say_transferred(result: Transferred) -> None:
    for part in result.report:
        say(part.sentence, "red" if part.vanished else "")
    for sentence in result.warnings:
        say(f"warning: {sentence}", "yellow")


# Merged, without a name of their own: contactbench region box, not region facets box.
region_app.add_typer(facets_app)

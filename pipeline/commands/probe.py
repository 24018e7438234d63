"""``contactbench probe``: from whatever mesh file there is to a probe ready for contact sensing."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contactbench.pipeline.commands.align import align
from contactbench.pipeline.commands.options import numbers, refuse_overwriting
from contactbench.pipeline.commands.probe_options import (
    AlphaOption,
    CloseOption,
    ContactErrorOption,
    DeviationOption,
    EngineName,
    EngineOption,
    FacetsOption,
    ForcesOption,
    GapOption,
    MeshArgument,
    OutOption,
    RatioOption,
    UnitsOption,
    UnitsOrAuto,
    closings,
    counts,
    metres,
    open_mesh,
    planned,
    refuse_to_guess,
    share,
)
from contactbench.pipeline.console import Bar, JsonOption, print_json, say, show_tables
from contactbench.pipeline.durable import make_folder

probe_app = typer.Typer(
    help="Prepare a probe's mesh: inspect, shell, align, simplify, ladder, or all in one go.",
    no_args_is_help=True,
    rich_markup_mode=None,
)


@probe_app.command(
    help=(
        "Say what is wrong with a mesh, in words and numbers.\n\n"
        "Holes, parts, hidden and double walls, facets turned over or cutting through each other, slivers. Exit code"
        " 1: something would spoil contacts."
    ),
    epilog="Example: contactbench probe inspect housing.stl",
)
def inspect(file: MeshArgument, units: UnitsOption = UnitsOrAuto.auto, as_json: JsonOption = False) -> None:
    """Say what is wrong with a mesh."""
    from contactbench.pipeline.mesh.inspect import inspect as look

    with Bar("inspecting", counted=True) as bar:
        found = look(file, units.value, progress=share(bar))
    for sentence in found.facts:
        say(sentence)
    for finding in found.findings:
        say(f"{finding.level}: {finding.text}", {"fault": "red", "doubt": "yellow"}.get(finding.level, ""))
    if found.clear:
        say("Nothing was found that would spoil contacts.")
    if as_json:
        print_json(found.to_json())
    if not found.sound:
        raise typer.Exit(1)


@probe_app.command(
    help=(
        "Make the closed surface that a finger could touch.\n\n"
        "Inner walls and parts go; openings are closed by invented facets, which are marked. A mesh that needs"
        " nothing is left as it is. Exit code 1: what could be made is not sound."
    ),
    epilog="Example: contactbench probe shell housing.stl --close ruled --close fair --out shell.ply",
)
def shell(
    file: MeshArgument,
    out: OutOption,
    units: UnitsOption = UnitsOrAuto.auto,
    close: CloseOption = None,
    alpha: AlphaOption = None,
    gap: GapOption = None,
    as_json: JsonOption = False,
) -> None:
    """Make the closed surface that a finger could touch."""
    from contactbench.pipeline.mesh.sidecar import save_probe_file
    from contactbench.pipeline.preparation.steps import shell_step

    content = open_mesh(file, units, out)
    with Bar("finding the outer shell", counted=True) as bar:
        done, made = shell_step(
            content, closings(close), alpha=metres(alpha), gap=metres(gap), progress=share(bar)
        )
    save_probe_file(done, out)
    for sentence in made.sentences:
        say(sentence, "red" if sentence in made.faults else "")
    if as_json:
        print_json({"out": str(out), **made.to_json(), "sentences": list(made.sentences)})
    if made.faults:
        raise typer.Exit(1)


probe_app.command(
    "align",
    help=(
        "Move a mesh from its own frame P into the sensor frame S.\n\n"
        "By one of: typed numbers, matching points, the face that sits on the sensor, the principal axes, or touches"
        " of marked points. Exit code 1: touches do not bear out a better mount than the present one, which is kept."
    ),
    epilog="Example: contactbench probe align shell.ply --mount 0,0,45,0,0,90 --out aligned.ply",
)(align)


@probe_app.command(
    help=(
        "Give a probe fewer facets, and say what that costs.\n\n"
        "Distances and angles are measured against the mesh as it came, both ways."
    ),
    epilog="Example: contactbench probe simplify aligned.ply --facets 2000 --region-ratio 8 --out probe.ply",
)
def simplify(
    file: MeshArgument,
    out: OutOption,
    units: UnitsOption = UnitsOrAuto.auto,
    facets: FacetsOption = None,
    max_deviation: DeviationOption = None,
    max_contact_error: ContactErrorOption = None,
    forces: ForcesOption = "8,10",
    engine: EngineOption = EngineName.auto,
    region_ratio: RatioOption = 1.0,
    as_json: JsonOption = False,
) -> None:
    """Give a probe fewer facets, and say what that costs."""
    from contactbench.pipeline.mesh.sidecar import save_probe_file
    from contactbench.pipeline.preparation.steps import simplify_step

    plan = planned(facets, max_deviation, max_contact_error, forces, region_ratio)
    content = open_mesh(file, units, out)
    wanted, stated = plan(content)
    with Bar("simplifying", counted=True) as bar:
        done, made, carried = simplify_step(
            content,
            wanted,
            stated=stated,
            engine=engine.value,
            region_ratio=region_ratio,
            progress=share(bar),
        )
    save_probe_file(done, out)
    result = dict(done.history[-1]["result"])
    sentences = [*made.sentences, *(report.sentence for report in carried)]
    for sentence in sentences:
        say(sentence)
    if as_json:
        print_json({"out": str(out), **result, "sentences": sentences})


@probe_app.command(
    help=(
        "Weigh accuracy against speed over a range of facet counts, and recommend one.\n\n"
        "The same touches, with the sensor's noise, are located on the full mesh and on each simplified one. Writes"
        " ladder.json, ladder.csv, ladder.svg and ladder.png. Exit code 1: no simplified mesh keeps the goal."
    ),
    epilog="Example: contactbench probe ladder aligned.ply --out ladder",
)
def ladder(
    file: MeshArgument,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder to write.")] = Path("contactbench-ladder"),
    units: UnitsOption = UnitsOrAuto.auto,
    facets: Annotated[
        str | None, typer.Option(metavar="N,N,...", help="Counts to try [250 to 20,000].")
    ] = None,
    max_contact_error: ContactErrorOption = None,
    forces: ForcesOption = "8,10",
    noise_force: Annotated[float, typer.Option(help="Standard deviation of a force, N.")] = 0.05,
    noise_torque: Annotated[float, typer.Option(help="Standard deviation of a torque, N·m.")] = 0.002,
    touches: Annotated[int, typer.Option(help="Touches to locate.")] = 4_000,
    engine: EngineOption = EngineName.auto,
    region_ratio: RatioOption = 1.0,
    as_json: JsonOption = False,
) -> None:
    """Weigh accuracy against speed over a range of facet counts."""
    from contactbench.pipeline.contact import WrenchNoise
    from contactbench.pipeline.preparation.ladder import (
        DEFAULT_FACETS,
        ExpectedTouches,
        Goal,
        measure_ladder,
        save_ladder,
    )

    tried = DEFAULT_FACETS if facets is None else counts(facets)
    low, high = numbers(forces, 2, "--forces")
    expected = ExpectedTouches(WrenchNoise(noise_force, noise_torque), (low, high), count=touches)
    goal = Goal(metres(max_contact_error))
    content = open_mesh(file, units)
    make_folder(out)
    with Bar("measuring", counted=True) as bar:
        measured = measure_ladder(
            content.probe,
            expected,
            tried,
            goal=goal,
            engine=engine.value,
            region_ratio=region_ratio,
            progress=share(bar),
        )
    files = save_ladder(measured, out)
    show_tables(*measured.tables())
    for note in measured.notes:
        say(note, "yellow")
    say(measured.recommendation.reason)
    say(f"Wrote {', '.join(map(str, files))}.")
    if as_json:
        print_json({"out": str(out), **measured.to_json()})
    if measured.recommendation.facets is None:
        raise typer.Exit(1)


@probe_app.command(
    help=(
        "All in one go: read, close, align, simplify, and write the probe with its history.\n\n"
        "Regions that the file holds are kept. Exit code 1: the result is not sound (open, crossing, folded or"
        " inside out); nothing is written then."
    ),
    epilog="Example: contactbench probe prepare housing.stl --mount 0,0,45,0,0,90 --out probe.ply",
)
def prepare(
    file: MeshArgument,
    out: OutOption,
    units: UnitsOption = UnitsOrAuto.auto,
    close: CloseOption = None,
    alpha: AlphaOption = None,
    gap: GapOption = None,
    mount: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,Z,RX,RY,RZ",
            help="Pose of the mesh in S: mm, and degrees about the fixed axes x, then y, then z. Left out: the mesh"
            " stays in its own frame.",
        ),
    ] = None,
    alignment: Annotated[
        Path | None, typer.Option(help="Or: what `probe align --save` wrote, .json.")
    ] = None,
    facets: FacetsOption = None,
    max_deviation: DeviationOption = None,
    max_contact_error: ContactErrorOption = None,
    forces: ForcesOption = "8,10",
    engine: EngineOption = EngineName.auto,
    region_ratio: RatioOption = 1.0,
    as_json: JsonOption = False,
) -> None:
    """Read, close, align, simplify, and write the probe."""
    from contactbench.pipeline.commands.align import chosen_mount
    from contactbench.pipeline.mesh.sidecar import check_target, save_probe_file
    from contactbench.pipeline.preparation.prepare import prepare as prepare_file

    refuse_overwriting(out, [file])
    check_target(out)
    refuse_to_guess(file, units)
    plan = planned(facets, max_deviation, max_contact_error, forces, region_ratio)
    placed = chosen_mount(mount, alignment)
    with Bar("preparing", counted=True) as bar:
        done = prepare_file(
            file,
            units.value,
            closings(close),
            alpha=metres(alpha),
            gap=metres(gap),
            alignment=placed,
            target=plan,
            engine=engine.value,
            region_ratio=region_ratio,
            progress=share(bar),
        )
    if done.ready:
        save_probe_file(done.content, out)
    for sentence in dict.fromkeys(done.sentences):
        noted = sentence in done.content.notes
        say(f"warning: {sentence}" if noted else sentence, "yellow" if noted else "")
    say(f"Wrote {out} and {out.with_suffix('.json')}." if done.ready else "Nothing was written.")
    if as_json:
        print_json({"out": str(out) if done.ready else None, "ready": done.ready, **done.to_json()})
    if not done.ready:
        raise typer.Exit(1)

"""What the ``probe`` commands share: their options, and what those mean."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.options import numbers, refuse_overwriting
from contactbench.pipeline.console import Bar, say

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.mesh.shell import Closing
    from contactbench.pipeline.mesh.sidecar import ProbeFile
    from contactbench.pipeline.mesh.simplify import Target

    Plan = Callable[[ProbeFile], tuple[Target, dict[str, Any] | None]]


class UnitsOrAuto(StrEnum):
    """What the numbers in a mesh file are."""

    auto = "auto"
    mm = "mm"
    m = "m"
    cm = "cm"
    inch = "in"


class ClosingName(StrEnum):
    """How to close an opening."""

    auto = "auto"
    fair = "fair"
    ruled = "ruled"
    hull = "hull"
    open = "open"


class EngineName(StrEnum):
    """Who simplified in earlier versions; all the same now."""

    auto = "auto"
    fast = "fast-simplification"
    meshlab = "meshlab"
    best = "best"


MeshArgument = Annotated[
    Path, typer.Argument(metavar="FILE", help="Mesh: .stl, .ply, .obj, .off, .3mf, .glb or .gltf.")
]
UnitsOption = Annotated[
    UnitsOrAuto, typer.Option(help="Unit of the file's numbers; auto guesses from its size and says why.")
]
OutOption = Annotated[Path, typer.Option(help="Probe to write, .ply; its history goes beside it as .json.")]
CloseOption = Annotated[
    list[ClosingName] | None,
    typer.Option(
        "--close",
        help="How to close the openings, largest first, once for each; the last one counts for the others."
        " fair: least bending. ruled: straight lines between the long rims. hull: no dent. open: leave it. [auto]",
    ),
]
AlphaOption = Annotated[
    float | None, typer.Option(help="Size of the shell's facets, mm [1/190 of the size].")
]
GapOption = Annotated[
    float | None, typer.Option(help="Gaps narrower than this are bridged, mm [1/65 of the size].")
]
FacetsOption = Annotated[int | None, typer.Option(help="Facets to keep.")]
DeviationOption = Annotated[
    float | None, typer.Option("--max-deviation", help="Or: as few as stay within this of the shell, mm.")
]
ContactErrorOption = Annotated[
    float | None,
    typer.Option(
        "--max-contact-error",
        help="Or: as few as move 95 % of contacts by less than this, mm [0.1].",
    ),
]
ForcesOption = Annotated[
    str, typer.Option("--forces", metavar="LOW,HIGH", help="Forces of touches to expect, N.")
]
EngineOption = Annotated[EngineName, typer.Option(help="Of earlier versions; without effect.", hidden=True)]
RatioOption = Annotated[
    float, typer.Option("--region-ratio", help="Facets per area in regions, over that in the rest.")
]


def open_mesh(file: Path, units: UnitsOrAuto, out: Path | None = None) -> ProbeFile:
    """Read a mesh and say what was noticed; refuse to write over it, or where nothing can be written."""
    refuse_overwriting(out, [file])
    if out is not None:
        from contactbench.pipeline.mesh.sidecar import check_target

        check_target(out)
    from contactbench.pipeline.preparation.steps import import_mesh

    refuse_to_guess(file, units)
    content = import_mesh(file, units.value)
    for note in content.notes:
        say(f"warning: {note}", "yellow")
    return content


def refuse_to_guess(file: Path, units: UnitsOrAuto) -> None:
    """Refuse to make a probe of numbers whose unit nobody can tell; MeshError with the sizes to choose from."""
    from contactbench.pipeline.mesh import MeshError
    from contactbench.pipeline.mesh.load import read_mesh

    guess = None if units is not UnitsOrAuto.auto else read_mesh(file).guess
    if guess is not None and guess.must_be_given:
        raise MeshError(f"{file}: the unit cannot be told. {guess.reason}")


def closings(names: list[ClosingName] | None) -> Closing | list[Closing]:
    """Return what ``--close`` asks for: one for all, or one after the other."""
    from contactbench.pipeline.mesh.shell import Closing

    if not names:
        return Closing.AUTO
    return Closing(names[0].value) if len(names) == 1 else [Closing(name.value) for name in names]


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


def metres(millimetres: float | None) -> float | None:
    """Convert a length, if there is one."""
    return None if millimetres is None else millimetres / 1000


def planned(
    facets: int | None,
    max_deviation: float | None,
    max_contact_error: float | None,
    forces: str,
    region_ratio: float,
) -> Plan:
    """Return what makes the target of a probe; what makes no sense is refused here, before the work.

    Raises
    ------
    typer.BadParameter
        More than one target was asked for, or --forces are not two numbers.
    InputError
        A number is out of its range.
    """
    from contactbench.pipeline.mesh.simplify import Count, MaxDeviation, check_ratio

    if sum(each is not None for each in (facets, max_deviation, max_contact_error)) > 1:
        raise typer.BadParameter("--facets, --max-deviation and --max-contact-error: give one of them.")
    check_ratio(region_ratio)
    target: Target
    if facets is not None or max_deviation is not None:
        target = Count(facets) if facets is not None else MaxDeviation((max_deviation or 0.0) / 1000)
        return lambda _: (target, None)
    from contactbench.pipeline.preparation.ladder import ExpectedTouches
    from contactbench.pipeline.preparation.targets import DEFAULT_LIMIT, ContactTarget

    low, high = numbers(forces, 2, "--forces")
    limit = DEFAULT_LIMIT if max_contact_error is None else max_contact_error / 1000
    wanted = ContactTarget(limit, ExpectedTouches(force=(low, high)))
    return lambda content: wanted.of(content.probe)


def share(bar: Bar) -> Callable[[float], None]:
    """Let a bar show a share from 0 to 1."""
    return lambda share: bar(round(1000 * share), 1000)

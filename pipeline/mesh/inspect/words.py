"""The findings of an inspection in sentences for the person who prepares the mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from contactbench.pipeline.errors import arg, capitalised, join, message
from contactbench.pipeline.mesh.shell.result import left_open
from contactbench.pipeline.mesh.soundness import SPECKS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from contactbench.pipeline.mesh.inspect.run import Inspection
    from contactbench.pipeline.mesh.inspect.visibility import MeshPart, Visibility

_SHELL = message("Make the outer shell before use.")
_IF_CAVITY = message(
    "A closed mesh keeps such openings: to close the mouths of cavities, make the outer shell with --close auto (in"
    ' the window: "Close openings").'
)

# Shares are counted on some thousand points; less than this is a groove or chance.
_SOME = 0.005
_DEEP = 0.01
_NONE = 5e-4
_HOLLOW = 0.05
_OPEN = 0.05
_SHEET = 0.9

# A part with less than this share of the largest one's area is a speck, which the preparation leaves out.
_SPECK = 0.01
_NAMED = 3

# A wall thinner than this share of the size is a copy of the surface: 0.01 mm on a probe of 100 mm.
_COPY = 1e-4
# One and several of what is counted.
_HANDLES = message("handle"), message("handles")
_VERTICES = message("vertex"), message("vertices")
_HOLES = message("hole"), message("holes")
_EDGES = message("edge"), message("edges")
_WHOLE_PARTS = message("whole part"), message("whole parts")
_CLOSED_PARTS = message("closed part lies"), message("closed parts lie")
_DUPLICATES = message("facet is a duplicate"), message("facets are duplicates")
_STANDING = message("facet stands"), message("facets stand")
_FACETS = message("facet"), message("facets")
_FOLDED = message("thin facet folds"), message("thin facets fold")


Level = Literal["fault", "doubt", "note"]


@dataclass(frozen=True)
class MeshFinding:
    """
    One thing found.

    Attributes
    ----------
    level : {"fault", "doubt", "note"}
        A fault spoils contacts and has to be mended; a doubt is to be looked at; a note is to be known.
    text : str
        What it is, why it matters and what to do, in sentences.
    """

    level: Level
    text: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "text", message(self.text))


def facts(found: Inspection) -> tuple[str, ...]:
    """Say how large the mesh is and what it consists of."""
    x, y, z = (1e3 * extent for extent in found.extents_m)
    edges = found.edges
    lengths = message(f"{arg(_length(edges.shortest_m))} to {arg(_length(edges.longest_m))}")
    said = [
        message(
            f"{arg(found.name)}: {arg(found.facets):,} facets, {arg(found.vertices):,} vertices,"
            f" {arg(_parts(found.part_count))}."
        ),
        message(
            f"It measures {arg(x):.1f} x {arg(y):.1f} x {arg(z):.1f} mm, with an area of"
            f" {arg(found.area_m2 * 1e4):.1f} cm²"
        )
        + (message(f" and a volume of {arg(found.volume_m3 * 1e6):.1f} cm³.") if found.volume_m3 else "."),
        message(
            f"Edges are {arg(lengths)} long; half of them are shorter than {arg(_length(edges.median_m))}."
        ),
    ]
    if found.unit is not None and found.unit.certain:
        said.append(message(f"Units: {arg(found.unit.units)}. {arg(found.unit.reason)}"))
    if found.genus:
        said.append(
            message(f"The surface has {arg(_count(found.genus, _HANDLES))}: openings that go right through.")
        )
    return tuple(said)


def findings(found: Inspection) -> tuple[MeshFinding, ...]:
    """Say what is wrong, why it matters and what to do; faults first, then doubts, then notes."""
    every = [
        *_unit(found),
        *_openings(found),
        *_sides(found),
        *_insides(found),
        *_facets(found),
        *_rest(found),
        *_vertices(found),
    ]
    order = {"fault": 0, "doubt": 1, "note": 2}
    return tuple(sorted(every, key=lambda finding: order[finding.level]))


def _unit(found: Inspection) -> Iterator[MeshFinding]:
    if found.unit is not None and not found.unit.certain:
        yield MeshFinding("doubt", found.unit.doubt)


def _openings(found: Inspection) -> Iterator[MeshFinding]:
    if found.seam_vertices:
        yield MeshFinding(
            "doubt",
            f"Seams are not joined: {arg(_count(found.seam_vertices, _VERTICES))} of open"
            " edges lie right beside another edge. The surface looks closed there but counts as"
            " open. Export again with a finer tolerance, or make the outer shell.",
        )
    if found.hole_count:
        holes = found.holes[:_NAMED]
        widths = ", ".join(_length(hole.widest_m) for hole in holes)
        which = message("It is") if found.hole_count == 1 else message(f"The {arg(len(holes))} widest are")
        yield MeshFinding(
            "fault",
            f"The surface has {arg(_count(found.hole_count, _HOLES))}. {arg(which)} {arg(widths)} wide."
            " A line of force can pass through a hole and end on an inner wall, far from the true"
            f" contact. {arg(_SHELL)}",
        )
    if found.joined_edges:
        yield MeshFinding(
            "fault",
            f"More than two facets meet at {arg(_count(found.joined_edges, _EDGES))}, so inside and"
            " outside cannot be told apart there: walls are joined, or bodies touch along an edge."
            f" {arg(_SHELL)}",
        )


def _sides(found: Inspection) -> Iterator[MeshFinding]:
    seen = found.visibility
    sheet = seen.two_sided_share > _SHEET
    if found.soundness.sound:
        return  # closed and outward: rays that slip through somewhere say nothing
    if _inside_out(found):
        yield MeshFinding(
            "fault",
            "The mesh is inside out: its facets face inwards, so contacts would be found on the"
            " far side of the probe. Flip all normals in the CAD program, or make the outer"
            " shell, which flips them.",
        )
    elif seen.turned_share > _SOME:
        turned = sum(1 for part in found.parts if (part.turned_share or 0) > 0.5)
        whole = message(f", {arg(_count(turned, _WHOLE_PARTS))} among them") if turned else ""
        yield MeshFinding(
            "fault",
            f"Facets with {arg(_percent(seen.turned_share))} of the area show their back to the"
            f" outside{arg(whole)}. Contacts there are missed, or found on the far side. Make the"
            " normals consistent in the CAD program, or make the outer shell.",
        )
    if not found.health.winding_consistent:
        yield MeshFinding(
            "fault",
            message("Neighbouring facets disagree about which side is outside. ")
            + (
                ""
                if sheet
                else message("All visible facets face outwards; only hidden ones disagree. ")
                if seen.turned_share <= _SOME
                else message("Contacts on flipped facets are missed. ")
            )
            + message("Make the normals consistent in the CAD program, or make the outer shell."),
        )
    if sheet:
        yield MeshFinding(
            "fault",
            f"The mesh is an open sheet: {arg(_percent(seen.two_sided_share))} of the area can be seen"
            " from both sides, so it has no inside. Export the whole part as a solid.",
        )
    elif seen.two_sided_share > _OPEN:
        yield MeshFinding(
            "doubt",
            f"{arg(_share(seen.two_sided_share))} of the area can be seen from both sides, like a sheet or an open"
            " bowl: it has no thickness. Check that the whole housing was exported, as a solid.",
        )


def _inside_out(found: Inspection) -> bool:
    return found.health.outward is False or found.visibility.turned_share > 0.5


def _insides(found: Inspection) -> Iterator[MeshFinding]:
    if not found.soundness.sound:
        yield from _inner_walls(found)
    elif found.shell_made:
        little = found.visibility.hidden_share + found.visibility.sheltered_share
        if little > _DEEP:
            yield MeshFinding(
                "note",
                f"{arg(_share(little))} of the area has little or no view of the outside: grooves,"
                " bores and gaps, which the outer shell keeps. A finger hardly reaches there.",
            )
    else:
        yield from _recesses(found)
    if found.part_count > 1:
        sizes = join(", ", (_size(part) for part in found.parts[:_NAMED]))
        more = message(", and others") if found.part_count > _NAMED else ""
        said = message(f"The mesh has {arg(found.part_count)} separate parts ({arg(sizes)}{arg(more)})")
        speck = found.parts[1].area_m2 < _SPECK * found.parts[0].area_m2
        if not found.soundness.sound:
            yield MeshFinding("doubt", f"{arg(said)}. Simplification treats each by itself.")
        elif speck:
            yield MeshFinding(
                "note", f"{arg(said)}. All but the largest are specks, which the preparation leaves out."
            )
        else:
            yield MeshFinding(
                "doubt",
                f"{arg(said)}; none lies inside another. The preparation needs a single body: delete"
                " everything that is not the probe in the CAD program, or bridge a narrow gap"
                " with a larger --gap.",
            )


def _inner_walls(found: Inspection) -> Iterator[MeshFinding]:
    """Say what lies inside a mesh that does not separate inside from outside."""
    seen, nested = found.visibility, found.soundness.nested_parts
    if found.overlapping_parts:
        yield MeshFinding(
            "fault",
            f"{arg(found.overlapping_parts)} of the {arg(found.part_count)} parts overlap, so walls of one"
            " lie inside another. Merge them in the CAD program, or make the outer shell before"
            " use.",
        )
    if seen.hidden_share > _SOME:
        parts = sum(1 for part in found.parts if (part.hidden_share or 0) > 0.99)
        whole = message(f" ({arg(parts)} of the {arg(found.part_count)} parts entirely)") if parts else ""
        yield MeshFinding(
            "fault",
            f"{arg(_share(seen.hidden_share))} of the area cannot be seen from outside{arg(whole)}: inner"
            f" walls or parts that cannot be touched, but that a line of force can hit. {arg(_SHELL)}",
        )
    elif nested:
        yield MeshFinding(
            "fault",
            f"{arg(_count(nested, _CLOSED_PARTS))} inside the body. They"
            f" cannot be touched, but a line of force can hit them. {arg(_SHELL)}",
        )
    if seen.sheltered_share > _DEEP:
        yield MeshFinding(
            "doubt",
            f"{arg(_share(seen.sheltered_share))} of the area is visible from outside only through"
            " narrow openings, or lies deep in grooves. If these are inner walls behind a hole,"
            f" contacts can be placed on them. {arg(_SHELL)}",
        )
    if seen.double_wall_share > _DEEP and seen.wall_m is not None:
        if seen.wall_m < _COPY * found.size_m:
            yield MeshFinding(
                "fault",
                f"The surface is doubled: behind {arg(_percent(seen.double_wall_share))} of the outside"
                f" lies a second surface, typically {arg(_length(seen.wall_m))} away. A force meets two"
                f" surfaces at once. {arg(_SHELL)}",
            )
        else:
            yield MeshFinding(
                "fault" if seen.double_wall_share > _HOLLOW else "doubt",
                f"{arg(_hollow(seen))} {arg(_SHELL)}",
            )


def _recesses(found: Inspection) -> Iterator[MeshFinding]:
    """Say what of a sound mesh lies in cavities, bores or grooves: one sentence, for they are not told apart here."""
    seen = found.visibility
    hollow = seen.double_wall_share > _HOLLOW
    if not hollow and not found.mouths and seen.hidden_share <= _SOME and seen.sheltered_share <= _DEEP:
        return
    yield from (MeshFinding("note", f"Found {arg(mouth)}.") for mouth in found.mouths)
    # A closed surface without handles is no tube: the space behind its walls is reached through a mouth.
    bottle = hollow and found.genus == 0
    yield MeshFinding(
        "fault" if bottle else "doubt",
        (message(f"{arg(_hollow(seen))} ") if hollow else "")
        + join(" ", _unseen(seen))
        + ("" if hollow else message(" If these are inner walls, contacts can be placed on them."))
        + message(f" {arg(left_open(len(found.mouths)) if found.mouths else _IF_CAVITY)}"),
    )


def _unseen(seen: Visibility) -> Iterator[str]:
    if seen.hidden_share > _NONE:
        yield message(f"{arg(_share(seen.hidden_share))} of the area cannot be seen from outside.")
    if seen.sheltered_share > _NONE:
        yield message(
            f"{arg(_share(seen.sheltered_share))} of the area has a view of the outside only through"
            " narrow openings or from deep grooves."
        )


def _hollow(seen: Visibility) -> str:
    return message(
        f"The probe is hollow: {arg(_percent(seen.double_wall_share))} of the outside is a wall, typically"
        f" {arg(_length(seen.wall_m or 0.0))} thick, with a space behind it that can hardly be seen from"
        " outside. Contacts can be placed on the inner side of the wall, and facets are wasted on it."
    )


def _facets(found: Inspection) -> Iterator[MeshFinding]:
    health, slivers = found.health, found.slivers
    if health.duplicate_facets:
        yield MeshFinding(
            "fault",
            f"{arg(_count(health.duplicate_facets, _DUPLICATES))}"
            " of another, with the same corners and the same side. They give double answers and"
            " slow the search. Remove duplicates in the CAD program, or make the outer shell.",
        )
    if found.back_to_back:
        yield MeshFinding(
            "fault",
            f"{arg(_count(found.back_to_back, _STANDING))} back to back with"
            " another that has the same corners: a doubled surface or sheet that shows its front on"
            f" both sides, or parts that touch. A force meets two surfaces at once. {arg(_SHELL)}",
        )
    if slivers.count:
        share = slivers.count / found.facets
        yield MeshFinding(
            "doubt" if share > 0.1 and not found.shell_made else "note",
            message(
                f"{arg(_count(slivers.count, _FACETS))} ({arg(_percent(share))}) are slivers with an angle under"
                f" 1°; the worst is {arg(slivers.worst_aspect):,.0f} times longer than high. They are"
                " common in CAD exports, make normals uncertain and simplification worse."
            )
            + (
                ""
                if found.shell_made
                else message(" Simplify the mesh, or export it with a limit on the aspect ratio.")
            ),
        )
    if health.dropped_facets:
        yield MeshFinding(
            "note",
            f"{arg(_count(health.dropped_facets, _FACETS))} without area were left out. They cannot be"
            " touched, but may have closed a seam.",
        )


def _rest(found: Inspection) -> Iterator[MeshFinding]:
    """Pass on what the check of soundness says, except what is said above with more figures."""
    sound = found.soundness
    counted = replace(sound.health, components=1, dropped_facets=0).sentences
    repeats = found.health.duplicate_facets + found.back_to_back
    turned = _inside_out(found) or found.visibility.turned_share > _SOME
    folds = sound.folded_share > SPECKS
    if folds:
        yield MeshFinding(
            "fault",
            message(
                f"{arg(_count(len(sound.folded_facets), _FOLDED))} back onto"
                " a neighbour. Contacts there are missed or found on the far side. "
            )
            + (message("Prepare the mesh again with more facets.") if found.shell_made else _SHELL),
        )
    rest = replace(
        sound,
        folded_share=0.0 if folds else sound.folded_share,
        nested_parts=0,
        inward_parts=0 if turned else sound.inward_parts,
        overlapping=0 if sound.overlapping <= repeats else sound.overlapping,
    )
    for sentence in rest.sentences:
        if sentence not in counted:
            yield MeshFinding("fault" if sentence in rest.faults else "note", sentence)


def _vertices(found: Inspection) -> Iterator[MeshFinding]:
    yield from (MeshFinding("note", sentence) for sentence in found.read_notes)
    file = found.file
    if file is not None and file.shared and file.surplus_vertices:
        yield MeshFinding(
            "note",
            f"{arg(_count(file.surplus_vertices, _VERTICES))} in the file were double or"
            " unused and have been merged or left out.",
        )
    # Where the surface is closed they are there on purpose: bodies that touch in a point or an edge.
    if found.coincident_vertices and found.hole_count:
        yield MeshFinding(
            "doubt",
            f"{arg(_count(found.coincident_vertices, _VERTICES))} lie exactly on another but"
            " are not merged, so the surface falls apart there. Save the mesh to a file and read"
            " it again to merge them.",
        )


def _parts(count: int) -> str:
    return message("one part") if count == 1 else message(f"{arg(count)} separate parts")


def _size(part: MeshPart) -> str:
    return " x ".join(f"{1e3 * extent:.3g}" for extent in part.extents_m) + " mm"


def _count(number: int, things: tuple[str, str]) -> str:
    one, many = things
    return message(f"{arg(number):,} {arg(one if number == 1 else many)}")


def _percent(share: float) -> str:
    if share >= 0.995:
        return message("nearly all") if share < 1 else message("all")
    return f"{100 * share:.0f} %" if share >= 0.095 else f"{100 * share:.1f} %"


def _share(share: float) -> str:
    """Give the same at the beginning of a sentence."""
    return capitalised(_percent(share))


def _length(metres: float) -> str:
    millimetres = 1e3 * metres
    return f"{millimetres:.0f} mm" if millimetres >= 99.5 else f"{millimetres:.2g} mm"

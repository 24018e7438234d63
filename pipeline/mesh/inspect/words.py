"""The findings of an inspection in sentences for the person who prepares the mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pipeline.mesh.inspect.report import Finding

if TYPE_CHECKING:
    from collections.abc import Iterator

    from pipeline.mesh.inspect.report import Inspection

_SHELL = "Make the outer shell before use."

# Shares are counted on some thousand points; less than this is a groove or chance.
_SOME = 0.005
_DEEP = 0.01
_NAMED = 3


def facts(found: Inspection) -> tuple[str, ...]:
    """Say how large the mesh is and what it consists of."""
    x, y, z = (1e3 * extent for extent in found.extents_m)
    edges = found.edges
    lengths = f"{_length(edges.shortest_m)} to {_length(edges.longest_m)}"
    said = [
        f"{found.name}: {found.facets:,} facets, {found.vertices:,} vertices, {_parts(found.part_count)}.",
        f"It measures {x:.1f} x {y:.1f} x {z:.1f} mm, with an area of {found.area_m2 * 1e4:.1f} cm²"
        + (f" and a volume of {found.volume_m3 * 1e6:.1f} cm³." if found.volume_m3 else "."),
        f"Edges are {lengths} long, half of them under {_length(edges.median_m)}.",
    ]
    if found.unit is not None:
        said.append(f"Units: {found.unit.units}. {found.unit.reason}")
    if found.genus:
        said.append(f"The surface has {_count(found.genus, 'handle')}: openings that go right through.")
    return tuple(said)


def findings(found: Inspection) -> tuple[Finding, ...]:
    """Say what is wrong, why it matters and what to do; faults first, then doubts, then notes."""
    every = [*_openings(found), *_sides(found), *_insides(found), *_facets(found), *_vertices(found)]
    order = {"fault": 0, "doubt": 1, "note": 2}
    return tuple(sorted(every, key=lambda finding: order[finding.level]))


def _openings(found: Inspection) -> Iterator[Finding]:
    if found.seam_vertices:
        yield Finding(
            "doubt",
            f"Seams are not sewn: {_count(found.seam_vertices, 'vertex', 'vertices')} of open edges lie beside"
            " another, closer than the eye sees. The surface counts as open there although it looks closed."
            " Export again with a finer tolerance, or make the outer shell.",
        )
    if found.hole_count:
        holes = found.holes[:_NAMED]
        widths = ", ".join(_length(hole.widest_m) for hole in holes)
        which = "It is" if found.hole_count == 1 else f"The {len(holes)} widest are"
        yield Finding(
            "fault",
            f"The surface has {_count(found.hole_count, 'hole')}. {which} {widths} wide. A line of force can pass"
            f" through a hole and end on an inner wall, far from the true contact. {_SHELL}",
        )
    if found.health.nonmanifold_edges:
        yield Finding(
            "fault",
            f"More than two facets meet at {_count(found.health.nonmanifold_edges, 'edge')}, so inside and outside"
            f" cannot be told apart there: walls are joined inside the probe. {_SHELL}",
        )


def _sides(found: Inspection) -> Iterator[Finding]:
    seen = found.visibility
    if found.health.outward is False or seen.turned_share > 0.5:
        yield Finding(
            "fault",
            "The mesh is inside out: its facets face inwards, so contacts would be found on the far side of the"
            " probe. Flip all normals in the CAD program, or make the outer shell, which does.",
        )
    elif seen.turned_share > _SOME:
        turned = sum(1 for part in found.parts if (part.turned_share or 0) > 0.5)
        whole = f", {_count(turned, 'whole part')} among them" if turned else ""
        yield Finding(
            "fault",
            f"Facets with {_percent(seen.turned_share)} of the area show their back to the outside{whole}."
            " Contacts there are missed, or found on the far side. Make the normals consistent in the CAD"
            " program, or make the outer shell.",
        )
    if not found.health.winding_consistent:
        outside = seen.turned_share <= _SOME
        yield Finding(
            "doubt" if outside else "fault",
            "Neighbouring facets disagree about which side is outside. "
            + (
                "Those that can be seen show their front, so it is the hidden ones that disagree. "
                if outside
                else "Contacts on those that are turned over are missed. "
            )
            + "Make the normals consistent in the CAD program, or make the outer shell.",
        )
    if seen.two_sided_share > 0.05:
        yield Finding(
            "doubt",
            f"{_percent(seen.two_sided_share)} of the area can be seen from both sides, like a sheet or an open"
            " bowl: it has no thickness. Check that the whole housing was exported, as a solid.",
        )


def _insides(found: Inspection) -> Iterator[Finding]:
    seen = found.visibility
    if seen.hidden_share > _SOME:
        parts = sum(1 for part in found.parts if (part.hidden_share or 0) > 0.99)
        whole = f" ({parts} of the {found.part_count} parts entirely)" if parts else ""
        yield Finding(
            "fault",
            f"{_percent(seen.hidden_share)} of the area cannot be seen from outside{whole}: inner walls or parts"
            f" that nothing can touch, but that a line of force meets. {_SHELL}",
        )
    if seen.sheltered_share > _DEEP:
        yield Finding(
            "doubt",
            f"{_percent(seen.sheltered_share)} of the area is seen from outside through narrow openings only, or"
            " lies deep in grooves. If these are inner walls behind a hole, contacts can be placed on them."
            f" {_SHELL}",
        )
    if seen.double_wall_share > _DEEP and seen.wall_m is not None:
        yield Finding(
            "fault" if seen.double_wall_share > 0.05 else "doubt",
            f"The probe is hollow: {_percent(seen.double_wall_share)} of the outside is a wall, typically"
            f" {_length(seen.wall_m)} thick, with a closed space behind it. Contacts can be placed on the inner side"
            f" of the wall, and facets are wasted on it. {_SHELL}",
        )
    if found.part_count > 1:
        yield Finding(
            "doubt",
            f"The mesh has {found.part_count} separate parts, {_small(found)}. Parts inside the housing can be"
            f" taken for the surface, and simplification treats each by itself. {_SHELL}",
        )
    if found.self_intersections:
        yield Finding(
            "doubt",
            f"{_count(found.self_intersections, 'facet')} cut through others. Part of them lies inside, where a"
            f" line of force meets them as well. {_SHELL}",
        )
    if found.not_checked is not None:
        yield Finding("note", f"Whether facets cut through others was not checked: {found.not_checked}")


def _facets(found: Inspection) -> Iterator[Finding]:
    health, slivers = found.health, found.slivers
    if health.duplicate_facets:
        yield Finding(
            "doubt",
            f"{_count(health.duplicate_facets, 'facet')} are there more than once. They answer twice and slow the"
            " search. Remove duplicates in the CAD program, or make the outer shell.",
        )
    if found.back_to_back:
        yield Finding(
            "doubt",
            f"{_count(found.back_to_back, 'facet')} stand back to back with another: a sheet without thickness, or"
            f" two parts that touch. One of each pair faces the wrong way. {_SHELL}",
        )
    if slivers.count:
        share = slivers.count / found.facets
        yield Finding(
            "doubt" if share > 0.1 else "note",
            f"{_count(slivers.count, 'facet')} ({_percent(share)}) are slivers with an angle under 1°; the worst is"
            f" {slivers.worst_aspect:,.0f} times as long as high. CAD exports have them; they make normals"
            " uncertain and simplification worse. Simplify the mesh, or export with a limit on the aspect ratio.",
        )
    if health.dropped_facets:
        yield Finding(
            "note",
            f"{_count(health.dropped_facets, 'facet')} without area were left out. They cannot be touched, but may"
            " have closed a seam.",
        )


def _vertices(found: Inspection) -> Iterator[Finding]:
    if found.unit is not None and not found.unit.certain:
        yield Finding("doubt", found.unit.reason)
    file = found.file
    if file is not None and file.shared and file.surplus_vertices:
        yield Finding(
            "note",
            f"{_count(file.surplus_vertices, 'vertex', 'vertices')} in the file were double or unused and have been"
            " merged or left out.",
        )
    if found.coincident_vertices:
        yield Finding(
            "doubt",
            f"{_count(found.coincident_vertices, 'vertex', 'vertices')} lie exactly on another and are not merged:"
            " the surface falls apart there. Save the mesh to a file and read it again, which merges them.",
        )


def _small(found: Inspection) -> str:
    largest = found.parts[0].area_m2 / found.area_m2
    return f"the largest with {_percent(largest)} of the area"


def _parts(count: int) -> str:
    return "one part" if count == 1 else f"{count} separate parts"


def _count(number: int, one: str, many: str | None = None) -> str:
    return f"{number:,} {one if number == 1 else many or one + 's'}"


def _percent(share: float) -> str:
    if share >= 0.995:
        return "nearly all" if share < 1 else "all"
    return f"{100 * share:.0f} %" if share >= 0.095 else f"{100 * share:.1f} %"


def _length(metres: float) -> str:
    millimetres = 1e3 * metres
    return f"{millimetres:.0f} mm" if millimetres >= 99.5 else f"{millimetres:.2g} mm"

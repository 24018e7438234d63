"""Inspect a mesh file, a probe or arrays."""

import math
import os
from contextlib import suppress
from dataclasses import asdict, dataclass, field, fields, is_dataclass
from typing import Any, Literal

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.distance import pdist

from contactbench.pipeline.errors import MeshError, arg
from contactbench.pipeline.files import File, as_file
from contactbench.pipeline.mesh.arrays import Floats, Ints, Mask
from contactbench.pipeline.mesh.engines import EngineError
from contactbench.pipeline.mesh.inspect import words
from contactbench.pipeline.mesh.inspect.visibility import (
    SAMPLES,
    MeshPart,
    Visibility,
    find_parts,
    genus_of,
    look,
)
from contactbench.pipeline.mesh.load import UnitGuess, Units, probe_of, read_mesh
from contactbench.pipeline.mesh.monitor import NOBODY, Monitor
from contactbench.pipeline.mesh.parse import Reading
from contactbench.pipeline.mesh.probe import EdgeTable, MeshHealth, Probe, connected, edge_table
from contactbench.pipeline.mesh.shell import Opening
from contactbench.pipeline.mesh.shell.shell import find_mouths
from contactbench.pipeline.mesh.sidecar import load_probe_file
from contactbench.pipeline.mesh.soundness import CROSSING, Soundness, check_soundness
from contactbench.pipeline.mesh.triangles import first_alike

# Rims are measured one by one from the longest on; a mesh whose facets do not share vertices has a million.
LISTED = 100

# Up to here the widest diameter is the greatest of all distances; above, of the extents along fixed directions.
_EXACT = 500
_FAN = 200

# Two rims this close, as a share of the size, are one seam that was not sewn: 0.015 mm on a probe of 150 mm.
_SEAM = 1e-4


@dataclass(frozen=True)
class Hole:
    """
    One connected rim: edges of one facet only that hang together. Two rims that touch in a vertex are one.

    Attributes
    ----------
    edges : int
        Edges of the rim.
    perimeter_m : float
        Their length together.
    widest_m : float
        Greatest distance between two of its vertices; of a rim of more than 500 vertices at most 1 % too small.
    centre_m : (3,) tuple of float
        Mean of the rim's vertices.
    """

    edges: int
    perimeter_m: float
    widest_m: float
    centre_m: tuple[float, float, float]


def find_holes(vertices: Floats, edges: EdgeTable) -> tuple[int, float, tuple[Hole, ...]]:
    """
    Group the edges of one facet only into rims.

    Parameters
    ----------
    vertices : (n, 3) float64
        Metres.
    edges : EdgeTable
        Of the mesh.

    Returns
    -------
    count : int
        Rims.
    perimeter_m : float
        All together.
    holes : tuple of Hole
        The 100 with the longest rims, widest first.
    """
    open_edge = edges.uses == 1
    if not open_edge.any():
        return 0, 0.0, ()
    low, high = edges.low[open_edge], edges.high[open_edge]
    points = np.unique(np.concatenate((low, high)))
    rows, columns = np.searchsorted(points, low), np.searchsorted(points, high)
    label = connected(len(points), rows, columns)
    count = int(label.max()) + 1
    length = np.linalg.norm(vertices[low] - vertices[high], axis=1)
    rim = label[rows]
    perimeter = np.bincount(rim, length, minlength=count)
    uses = np.bincount(rim, minlength=count)
    holes = []
    # Ties in length are common in CAD parts: the number of the rim keeps the order the same every time.
    for which in np.lexsort((np.arange(count), -perimeter))[:LISTED]:
        corners = vertices[points[label == which]]
        x, y, z = corners.mean(axis=0).tolist()
        holes.append(Hole(int(uses[which]), float(perimeter[which]), _widest(corners), (x, y, z)))
    holes.sort(key=lambda hole: -hole.widest_m)
    return count, float(length.sum()), tuple(holes)


def count_seam_vertices(vertices: Floats, edges: EdgeTable) -> int:
    """
    Count the vertices of rims that have a vertex of a rim beside them, closer than 1e-4 of the size.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    edges : EdgeTable
        Of the mesh.

    Returns
    -------
    int
        Above 0 where facets that meet do not share their vertices, so that a closed skin counts as open.
    """
    open_edge = edges.uses == 1
    rim = np.unique(np.concatenate((edges.low[open_edge], edges.high[open_edge])))
    if len(rim) < 2:
        return 0
    used = vertices[np.concatenate((edges.low, edges.high))]
    size = float(np.ptp(used, axis=0).max())
    tree = cKDTree(vertices[rim])
    pairs = tree.query(vertices[rim], k=[2], distance_upper_bound=_SEAM * size)
    return int(np.count_nonzero(np.isfinite(pairs[0])))


def _widest(corners: Floats) -> float:
    if len(corners) <= _EXACT:
        return float(pdist(corners).max())
    turn = np.arange(_FAN) * np.pi * (3 - np.sqrt(5))
    height = (np.arange(_FAN) + 0.5) / _FAN
    radius = np.sqrt(1 - height**2)
    directions = np.stack((radius * np.cos(turn), radius * np.sin(turn), height))
    return float(np.ptp(corners @ directions, axis=0).max())


# ---- facets by shape -----------------------------------------------------------------------------


# Below it the normal of a facet from a float32 file is uncertain by degrees once the facet is small.
SLIVER_DEG = 1.0


@dataclass(frozen=True)
class Slivers:
    """
    Facets much longer than they are high.

    Attributes
    ----------
    count : int
        With an angle under 1 degree.
    smallest_angle_deg : float
        Of all facets.
    worst_aspect : float
        Greatest ratio of the longest edge to the height over it; 1.15 in an equilateral facet.
    """

    count: int
    smallest_angle_deg: float
    worst_aspect: float


@dataclass(frozen=True)
class EdgeLengths:
    """Lengths of all edges, each counted once, in metres."""

    shortest_m: float
    median_m: float
    mean_m: float
    longest_m: float


def measure_slivers(vertices: Floats, faces: Ints) -> Slivers:
    """
    Measure the facets' angles and aspect ratios.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    faces : (m, 3) int32
        With an area.
    """
    corners = vertices[faces]
    sides = np.roll(corners, -1, axis=1) - corners
    square = np.sort(np.einsum("ijk,ijk->ij", sides, sides), axis=1)
    double_area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    # The smallest angle lies between the two longest sides.
    sine = double_area / np.sqrt(square[:, 1] * square[:, 2])
    angle = np.degrees(np.arcsin(np.minimum(sine, 1.0)))
    return Slivers(
        int(np.count_nonzero(angle < SLIVER_DEG)),
        float(angle.min()),
        float((square[:, 2] / double_area).max()),
    )


def measure_edges(vertices: Floats, edges: EdgeTable) -> EdgeLengths:
    """
    Measure the edges of a mesh.

    Parameters
    ----------
    vertices : (n, 3) float64
        Metres.
    edges : EdgeTable
        Of the mesh.
    """
    length = np.linalg.norm(vertices[edges.low] - vertices[edges.high], axis=1)
    return EdgeLengths(
        float(length.min()), float(np.median(length)), float(length.mean()), float(length.max())
    )


@dataclass(frozen=True, eq=False)
class Repeats:
    """
    Facets with the same three vertices.

    Attributes
    ----------
    surplus : (m,) bool
        Beyond the first with these vertices.
    both_sides : (m,) bool
        There is one with these vertices for each side: they stand back to back.
    """

    surplus: Mask
    both_sides: Mask


def find_repeats(faces: Ints) -> Repeats:
    """
    Find facets with the same three vertices, whichever way they are wound.

    Parameters
    ----------
    faces : (m, 3) int32
        Indices, none twice in a row.
    """
    ordered = np.sort(faces, axis=1)
    group = first_alike(ordered)
    # From the lowest vertex on a facet runs up to the middle one, or to the highest.
    following = np.take_along_axis(faces, (np.argmin(faces, axis=1)[:, None] + 1) % 3, axis=1)[:, 0]
    ascending = following == ordered[:, 1]
    one, other = (np.bincount(group[side], minlength=len(faces)) for side in (ascending, ~ascending))
    return Repeats(group != np.arange(len(faces)), ((one > 0) & (other > 0))[group])


def count_coincident(vertices: Floats, faces: Ints) -> int:
    """
    Count used vertices beyond the first on exactly the same spot.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    faces : (m, 3) int32
        Indices in range.
    """
    used = vertices[np.unique(faces)]
    return int(np.count_nonzero(first_alike(used) != np.arange(len(used))))


@dataclass(frozen=True)
class FileCounts:
    """
    What was in the file before vertices were merged.

    Attributes
    ----------
    vertices : int
    facets : int
        Polygons as the triangles they were split into.
    surplus_vertices : int
        Merged into others, or used by no facet. An STL file holds every vertex about six times.
    shared : bool
        The format lets facets share vertices, so that surplus ones are a defect of the export.
    """

    vertices: int
    facets: int
    surplus_vertices: int
    shared: bool


@dataclass(frozen=True)
class Inspection:
    """
    All that is known about a mesh.

    Attributes
    ----------
    name : str
        For people.
    vertices, facets : int
        After merging and cleaning, where it came from a file.
    file : FileCounts or None
        None for a mesh that came as arrays.
    unit : UnitGuess or None
        How the file's unit was found out; None where it was given.
    read_notes : tuple of str
        What was repaired while the file was read, in sentences.
    shell_made : bool
        The file's history says that its outer shell was made: what is open or narrow was left so.
    extents_m : (3,) tuple of float
        Along the axes of the mesh's frame.
    centre_m : (3,) tuple of float
        Middle of the bounding box.
    area_m2 : float
    volume_m3 : float or None
        Signed; None unless all parts are closed and their facets agree.
    edges : EdgeLengths
    health : MeshHealth
    soundness : Soundness
        What makes the mesh unfit, checked exactly, as for every mesh that the preparation writes.
    slivers : Slivers
    back_to_back : int
        Facets beyond the first with the same three vertices, and the other winding.
    joined_edges : int
        Edges of more than two facets, where those with the same three vertices count once.
    coincident_vertices : int
        Vertices beyond the first on exactly the same spot, not merged.
    seam_vertices : int
        Vertices of rims with a vertex of a rim right beside them: seams that only look closed.
    hole_count : int
    hole_perimeter_m : float
        All rims together.
    holes : tuple of Hole
        The 100 with the longest rims, widest first.
    part_count : int
    overlapping_parts : int
        Those whose facets cut through another part's.
    parts : tuple of MeshPart
        The largest 200.
    euler : int
        V - E + F.
    genus : int or None
        Handles of all parts together; None for a surface that is open or not manifold.
    visibility : Visibility
    mouths : tuple of str
        The openings of a sound mesh that lead into a hollow, as the preparation finds them, largest first.
    """

    name: str
    vertices: int
    facets: int
    file: FileCounts | None
    unit: UnitGuess | None
    read_notes: tuple[str, ...]
    shell_made: bool
    extents_m: tuple[float, float, float]
    centre_m: tuple[float, float, float]
    area_m2: float
    volume_m3: float | None
    edges: EdgeLengths
    health: MeshHealth
    soundness: Soundness = field(compare=False)
    slivers: Slivers
    back_to_back: int
    joined_edges: int
    coincident_vertices: int
    seam_vertices: int
    hole_count: int
    hole_perimeter_m: float
    holes: tuple[Hole, ...]
    part_count: int
    overlapping_parts: int
    parts: tuple[MeshPart, ...]
    euler: int
    genus: int | None
    visibility: Visibility
    mouths: tuple[str, ...]

    @property
    def size_m(self) -> float:
        """Largest extent in metres."""
        return max(self.extents_m)

    @property
    def facts(self) -> tuple[str, ...]:
        """Size, area, volume and counts, in sentences."""
        return words.facts(self)

    @property
    def findings(self) -> tuple[words.MeshFinding, ...]:
        """What is wrong or worth knowing, faults first; empty when there is nothing."""
        return words.findings(self)

    @property
    def sentences(self) -> tuple[str, ...]:
        """The texts of `findings`."""
        return tuple(finding.text for finding in self.findings)

    @property
    def sound(self) -> bool:
        """Whether there is no fault."""
        return not any(finding.level == "fault" for finding in self.findings)

    @property
    def clear(self) -> bool:
        """Whether there is neither a fault nor a doubt: nothing was found that would spoil contacts."""
        return all(finding.level == "note" for finding in self.findings)

    def to_json(self) -> dict[str, Any]:
        """Give all numbers, and the sentences, as plain data; a number that is not finite becomes None."""
        told = (each.name for each in fields(self) if each.name != "soundness")
        content = {name: _plain(getattr(self, name)) for name in told}
        content["soundness"] = self.soundness.to_json()
        content["sound"] = self.sound
        content["facts"] = list(self.facts)
        content["findings"] = [asdict(finding) for finding in self.findings]
        return content


def _plain(value: Any) -> Any:
    if is_dataclass(value) and not isinstance(value, type):
        return _plain(asdict(value))
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, tuple | list):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def inspect(
    source: str | os.PathLike[str] | Probe,
    units: Units | Literal["auto"] = "auto",
    *,
    tolerance: float = Reading.tolerance,
    samples: int = SAMPLES,
    monitor: Monitor = NOBODY,
) -> Inspection:
    """
    Find out all about a mesh: sizes, defects, holes, parts, hidden and double walls.

    Parameters
    ----------
    source : str, path or Probe
        A mesh file that `load_probe` reads, or a probe.
    units : {"mm", "m", "cm", "in", "auto"}
        What the file's numbers are; a probe is in metres.
    tolerance : float
        See `read_mesh`.
    samples : int
        Points from which it is looked whether the outside can be seen, about; at least 100.
    monitor : Monitor

    Returns
    -------
    Inspection

    Raises
    ------
    MeshError
        The file cannot be read as a probe, see `load_probe`; the message names it.
    Cancelled
        As asked for.
    """
    if samples < 100:
        raise MeshError(f"samples={arg(samples)} are too few to detect hidden surfaces: give at least 100.")
    steps = monitor.part().upto(0.1)
    if isinstance(source, Probe):
        return _inspect(source, _Origin(), samples, steps)
    file = as_file(source)
    read = read_mesh(file, units, tolerance=tolerance, monitor=steps)
    steps.upto(0.2)
    probe = probe_of(file, read)
    counts = FileCounts(
        len(read.raw.vertices),
        len(read.raw.faces),
        len(read.raw.vertices) - len(probe.vertices),
        read.suffix != ".stl",  # whose facets each bring their own vertices, so that surplus ones say nothing
    )
    made = read.raw.settled and _shell_made(file)
    return _inspect(probe, _Origin(counts, read.guess, read.raw.notes + read.raw.axes, made), samples, steps)


@dataclass(frozen=True)
class _Origin:
    """What is known of where a mesh comes from; nothing of arrays."""

    counts: FileCounts | None = None
    unit: UnitGuess | None = None
    notes: tuple[str, ...] = ()
    shell_made: bool = False


def _shell_made(file: File) -> bool:
    """Tell whether the history beside a file that contactbench wrote says that its outer shell was made."""
    try:
        known = load_probe_file(file)
    except MeshError:
        return False  # an inspection tells of the surface, whatever state the file beside it is in
    # A note says that the history is that of another surface.
    return not known.notes and any(step.get("step") == "shell" for step in known.history)


def _inspect(probe: Probe, origin: _Origin, samples: int, steps: Monitor) -> Inspection:
    vertices, faces = probe.vertices, probe.faces
    steps.upto(0.25)
    edges = edge_table(faces, len(vertices))
    hole_count, perimeter, holes = find_holes(vertices, edges)
    steps.upto(0.3)
    parts = find_parts(vertices, faces, edges)
    euler, genus = genus_of(vertices, faces, edges, parts.count)
    steps.upto(0.4)
    slivers, lengths = measure_slivers(vertices, faces), measure_edges(vertices, edges)
    seams = count_seam_vertices(vertices, edges)
    repeats = find_repeats(faces)
    repeated = int(np.count_nonzero(repeats.surplus))
    single = edge_table(faces[~repeats.surplus], len(vertices)) if repeated else edges
    steps.upto(0.6)
    soundness = check_soundness(vertices, faces)
    met = np.sort(parts.label[soundness.pairs[soundness.kinds == CROSSING]], axis=1)
    overlaps = np.unique(met[met[:, 0] != met[:, 1]], axis=0)
    visibility, listed = look(
        vertices, faces, parts, repeats.both_sides, overlaps, samples=samples, tick=steps.upto(0.9).tell
    )
    mouths: list[Opening] = []
    if soundness.sound and parts.count == 1 and not origin.shell_made:
        with suppress(EngineError):  # without the libraries that close them they are not counted
            mouths = find_mouths((vertices, faces), steps.upto(1.0).part())
    steps.upto(1.0).tell(1.0)
    volumes = [part.volume_m3 for part in parts.listed]
    x, y, z = np.ptp(probe.bounds, axis=0).tolist()
    u, v, w = probe.bounds.mean(axis=0).tolist()
    return Inspection(
        name=probe.name,
        vertices=len(vertices),
        facets=len(faces),
        file=origin.counts,
        unit=origin.unit,
        read_notes=origin.notes,
        shell_made=origin.shell_made,
        extents_m=(x, y, z),
        centre_m=(u, v, w),
        area_m2=float(parts.area.sum()),
        volume_m3=_volume(volumes) if parts.count == len(volumes) else None,
        edges=lengths,
        health=probe.health,
        soundness=soundness,
        slivers=slivers,
        back_to_back=repeated - probe.health.duplicate_facets,
        joined_edges=int(np.count_nonzero(single.uses > 2)),
        coincident_vertices=count_coincident(vertices, faces),
        seam_vertices=seams,
        hole_count=hole_count,
        hole_perimeter_m=perimeter,
        holes=holes,
        part_count=parts.count,
        overlapping_parts=len(np.unique(overlaps)),
        parts=listed,
        euler=euler,
        genus=genus,
        visibility=visibility,
        mouths=tuple(mouth.sentence for mouth in mouths),
    )


def _volume(volumes: list[float | None]) -> float | None:
    known = [volume for volume in volumes if volume is not None]
    return float(sum(known)) if len(known) == len(volumes) else None

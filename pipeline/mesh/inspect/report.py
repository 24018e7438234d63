"""What an inspection found, as numbers and as sentences."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field, fields, is_dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.mesh.inspect import words

if TYPE_CHECKING:
    from contactbench.pipeline.mesh.health import MeshHealth
    from contactbench.pipeline.mesh.inspect.holes import Hole
    from contactbench.pipeline.mesh.inspect.parts import MeshPart
    from contactbench.pipeline.mesh.inspect.shape import EdgeLengths, Slivers
    from contactbench.pipeline.mesh.inspect.visibility import Visibility
    from contactbench.pipeline.mesh.soundness import Soundness
    from contactbench.pipeline.mesh.units import UnitGuess


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

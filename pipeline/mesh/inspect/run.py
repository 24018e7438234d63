"""Inspect a mesh file, a probe or arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.files import File, as_file
from contactbench.pipeline.mesh.engines import Cancelled
from contactbench.pipeline.mesh.errors import MeshError
from contactbench.pipeline.mesh.health import edge_table
from contactbench.pipeline.mesh.inspect.holes import count_seam_vertices, find_holes
from contactbench.pipeline.mesh.inspect.parts import find_parts, genus_of
from contactbench.pipeline.mesh.inspect.report import FileCounts, Inspection
from contactbench.pipeline.mesh.inspect.shape import (
    count_coincident,
    find_repeats,
    measure_edges,
    measure_slivers,
)
from contactbench.pipeline.mesh.inspect.visibility import SAMPLES, look
from contactbench.pipeline.mesh.load import probe_of, read_mesh
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.sidecar import load_probe_file
from contactbench.pipeline.mesh.soundness import CROSSING, check_soundness

if TYPE_CHECKING:
    import os
    from collections.abc import Callable

    import numpy.typing as npt

    from contactbench.pipeline.mesh.units import UnitGuess, Units

# Formats whose facets each bring their own vertices, so that surplus ones say nothing.
_SOUP = frozenset({".stl"})


def inspect(
    source: str | os.PathLike[str] | Probe,
    units: Units | Literal["auto"] = "auto",
    *,
    samples: int = SAMPLES,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Inspection:
    """
    Find out all about a mesh: sizes, defects, holes, parts, hidden and double walls.

    Parameters
    ----------
    source : str, path or Probe
        A mesh file that `load_probe` reads, or a probe.
    units : {"mm", "m", "cm", "in", "auto"}
        What the file's numbers are; a probe is in metres.
    samples : int
        Points from which it is looked whether the outside can be seen, about; at least 100.
    progress : callable, optional
        Told the share that is done, 0 to 1.
    cancelled : callable, optional
        Asked often; the inspection stops when it returns True.

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
    work = _Work(progress or (lambda _: None), cancelled or (lambda: False))
    work.reach(0.0)
    if isinstance(source, Probe):
        return _inspect(source, _Origin(), samples, work)
    file = as_file(source)
    read = read_mesh(file, units)
    work.reach(0.1)
    probe = probe_of(file, read)
    counts = FileCounts(
        len(read.raw.vertices),
        len(read.raw.faces),
        len(read.raw.vertices) - len(probe.vertices),
        file.suffix.lower() not in _SOUP,
    )
    made = read.raw.settled and _shell_made(file)
    return _inspect(probe, _Origin(counts, read.guess, read.raw.notes, made), samples, work)


def inspect_arrays(
    vertices_m: npt.ArrayLike,
    faces: npt.ArrayLike,
    *,
    name: str = "mesh",
    samples: int = SAMPLES,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Inspection:
    """
    Find out all about a mesh given as arrays; a size that no probe has is not refused.

    Parameters
    ----------
    vertices_m : (n, 3) array_like
        Metres.
    faces : (m, 3) array_like of integers
        Vertex indices, counter-clockwise seen from outside.
    name : str
        For people.
    samples, progress, cancelled
        See `inspect`.

    Returns
    -------
    Inspection

    Raises
    ------
    MeshError
        The arrays are no mesh, or facets have no area.
    Cancelled
        As asked for.
    """
    probe = Probe.from_arrays(vertices_m, faces, name=name, check_size=False)
    return inspect(probe, samples=samples, progress=progress, cancelled=cancelled)


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


class _Work:
    """How far the work is, and whether to go on."""

    def __init__(self, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> None:
        self._progress = progress
        self.cancelled = cancelled

    def reach(self, share: float) -> None:
        if self.cancelled():
            raise Cancelled(message("the inspection was cancelled"))
        self._progress(share)

    def between(self, low: float, high: float) -> Callable[[float], None]:
        return lambda share: self._progress(low + share * (high - low))


def _inspect(
    probe: Probe,
    origin: _Origin,
    samples: int,
    work: _Work,
) -> Inspection:
    vertices, faces = probe.vertices, probe.faces
    work.reach(0.2)
    edges = edge_table(faces, len(vertices))
    hole_count, perimeter, holes = find_holes(vertices, edges)
    work.reach(0.25)
    parts = find_parts(vertices, faces, edges)
    euler, genus = genus_of(vertices, faces, edges, parts.count)
    work.reach(0.3)
    slivers, lengths = measure_slivers(vertices, faces), measure_edges(vertices, edges)
    seams = count_seam_vertices(vertices, edges)
    repeats = find_repeats(faces)
    repeated = int(np.count_nonzero(repeats.surplus))
    single = edge_table(faces[~repeats.surplus], len(vertices)) if repeated else edges
    work.reach(0.4)
    soundness = check_soundness(vertices, faces)
    work.reach(0.6)
    met = np.sort(parts.label[soundness.pairs[soundness.kinds == CROSSING]], axis=1)
    overlaps = np.unique(met[met[:, 0] != met[:, 1]], axis=0)
    visibility, listed = look(
        vertices,
        faces,
        parts,
        repeats.both_sides,
        overlaps,
        samples=samples,
        progress=work.between(0.6, 1.0),
        cancelled=work.cancelled,
    )
    work.reach(1.0)
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
    )


def _volume(volumes: list[float | None]) -> float | None:
    known = [volume for volume in volumes if volume is not None]
    return float(sum(known)) if len(known) == len(volumes) else None

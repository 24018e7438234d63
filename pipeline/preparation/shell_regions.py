"""
Regions that were painted on a dense shell, put on the shell that there is now.

Regions are painted on the outer surface before it has fewer facets, so that another number of facets does not touch
them. Their file is bound to that surface by its hash. If the surface itself lies beside the file, as its PLY file
with its history, the regions outlive another alignment, another way to close it, and another mesh of the same probe.
"""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from contactbench.pipeline.errors import arg
from contactbench.pipeline.files import File, files_beside
from contactbench.pipeline.mesh import MeshWarning
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.mesh.regions.exchange import (
    decode_json,
    load_regions,
    mesh_hash,
    parse_json,
    read_limited,
)
from contactbench.pipeline.mesh.regions.region import RegionError, RegionSet
from contactbench.pipeline.mesh.regions.transfer import RegionReport, transfer
from contactbench.pipeline.mesh.sidecar import ProbeFile, load_probe_file
from contactbench.pipeline.preparation.alignment.alignment import apply

# Vertices that are the same but for the rounding of an alignment there and back, m.
_SAME_M = 1e-9


def put_on(content: ProbeFile, file: File) -> ProbeFile:
    """
    Give an aligned shell the regions of a file.

    Parameters
    ----------
    content : ProbeFile
        The shell, aligned or not.
    file : path
        Regions as ``contactbench probe regions export`` writes them, JSON or CSV. Regions of another surface are
        carried over if that one lies in a PLY file beside it.

    Returns
    -------
    ProbeFile
        Its history says what became of them.

    Raises
    ------
    RegionError
        The file is no such file, or for a surface that is not there; or nothing of the regions lies on this one.
    """
    regions, carried = painted_regions(content, file)
    probe = regions.mesh(content.probe)
    result = {
        "facets": int(np.count_nonzero(regions.labels)),
        "areas_mm2": (1e6 * regions.areas(probe.areas)).round(3).tolist(),
        "carried": [report.to_json() for report in carried],
    }
    parameters = {"command": "painted", "file": file.name}
    return content.after("region", probe, parameters, result, regions=replace(regions, cut=None))


def painted_regions(content: ProbeFile, file: File) -> tuple[RegionSet, tuple[RegionReport, ...]]:
    """Return the regions of a file on a shell, and what carrying them over did to each; see `put_on`."""
    if file.suffix.lower() == ".csv":
        return load_regions(file, content.probe), ()
    try:
        return decode_json(read_limited(file), content.probe), ()
    except RegionError as error:
        surface = _surface_beside(file)
        if surface is None:
            raise RegionError(
                f"{arg(file)}: {arg(error)} Or give the mesh that they were painted on as a companion of the file."
            ) from error
    return _carried(decode_json(read_limited(file), surface.probe), surface, content, file)


def _surface_beside(file: File) -> ProbeFile | None:
    """Return the surface that the regions of a file are for, if a PLY file beside it holds it."""
    mesh = parse_json(read_limited(file)).get("mesh")
    wanted = mesh.get("sha256") if isinstance(mesh, dict) else None
    for other in files_beside(file, ".ply"):
        found = load_probe_file(other)
        if mesh_hash(found.probe) == wanted:
            return found
    return None


def _carried(
    regions: RegionSet, old: ProbeFile, new: ProbeFile, file: File
) -> tuple[RegionSet, tuple[RegionReport, ...]]:
    T: Floats = np.eye(4)
    if _origin(old.history) == _origin(new.history):
        # The same mesh: what was painted is a place on it, wherever it lies in S by now.
        T = _placed(new) @ np.linalg.inv(_placed(old))
    before, after = apply(T, old.probe.vertices), new.probe.vertices
    if np.array_equal(old.probe.faces, new.probe.faces) and np.allclose(before, after, rtol=0, atol=_SAME_M):
        cut = regions.cut
        return replace(regions, cut=cut and replace(cut, points=apply(T, cut.points))), ()
    painted = regions.mesh(old.probe)
    there = painted.cut((apply(T, painted.vertices), painted.faces), np.arange(len(painted.faces)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)  # what vanished is told by its report
        moved = transfer(regions, there, new.probe)
    if regions.labels.any() and not moved.regions.labels.any():
        raise RegionError(
            f"{arg(file)}: none of the regions lies on this surface: they were painted on another mesh,"
            " or in another place. Paint them again, or leave them out."
        )
    return moved.regions, moved.report


def _origin(history: Sequence[Mapping[str, Any]]) -> object:
    """Return what says which file the history begins with; never equal for an unknown one."""
    first = history[0] if history else {}
    return first.get("parameters", {}).get("sha256") or object()


def _placed(content: ProbeFile) -> Floats:
    """Return T_SP, (4, 4): every alignment of its history."""
    T: Floats = np.eye(4)
    for step in content.history:
        if step["step"] == "align":
            T = np.array(step["parameters"]["T_SP_m"]) @ T
    return T

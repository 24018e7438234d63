"""
Regions that were painted on a dense shell, put on the shell that there is now.

Regions are painted on the outer surface before it has fewer facets, so that another number of facets does not touch
them. Their file is bound to that surface by its hash. If the surface itself lies beside the file, as its PLY file
with its history, the regions outlive another alignment, another way to close it, and another mesh of the same probe.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import arg
from contactbench.pipeline.files import File, files_beside
from contactbench.pipeline.mesh import MeshWarning
from contactbench.pipeline.mesh.regions import RegionError, RegionSet, transfer
from contactbench.pipeline.mesh.regions.exchange import (
    decode_json,
    load_regions,
    mesh_hash,
    parse_json,
    read_limited,
)
from contactbench.pipeline.mesh.sidecar import load_probe_file

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from typing import Any

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.mesh.arrays import Floats
    from contactbench.pipeline.mesh.regions import RegionReport
    from contactbench.pipeline.mesh.sidecar import ProbeFile

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
    result = {
        "facets": int(np.count_nonzero(regions.labels)),
        "carried": [report.to_json() for report in carried],
    }
    parameters = {"command": "painted", "file": file.name}
    return content.after("region", content.probe, parameters, result, regions=regions)


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
    before, after = old.probe, new.probe
    if _origin(old.history) == _origin(new.history):
        # The same mesh: what was painted is a place on it, wherever it lies in S by now.
        before, after = _taken_back(old), _taken_back(new)
    if np.array_equal(before.faces, after.faces) and np.allclose(
        before.vertices, after.vertices, rtol=0, atol=_SAME_M
    ):
        return RegionSet(regions.regions, regions.labels), ()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)  # what vanished is told by its report
        moved = transfer(regions, before, after)
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


def _taken_back(content: ProbeFile) -> Probe:
    """Return the surface in the mesh's own frame P: every alignment of its history undone."""
    T: Floats = np.eye(4)
    for step in content.history:
        if step["step"] == "align":
            T = np.array(step["parameters"]["T_SP_m"]) @ T
    vertices = (content.probe.vertices - T[:3, 3]) @ T[:3, :3]
    return type(content.probe).from_arrays(
        vertices, content.probe.faces, content.probe.region, name=content.probe.name, check_size=False
    )

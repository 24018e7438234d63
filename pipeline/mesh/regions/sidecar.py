"""A probe with its regions on disk: PLY with a rank per facet, and beside it JSON with names and colours."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pipeline.durable import write_durably
from pipeline.mesh.errors import MeshWarning
from pipeline.mesh.load import load_probe
from pipeline.mesh.regions.errors import RegionError
from pipeline.mesh.regions.exchange import SIZE_LIMIT, parse_json, read_limited, read_region
from pipeline.mesh.regions.region import RegionSet, check_list
from pipeline.mesh.save import save_probe

if TYPE_CHECKING:
    from pipeline.mesh.probe import Probe
    from pipeline.mesh.regions.region import Region

_KEY = "regions"


def sidecar_of(mesh: Path) -> Path:
    """Return the JSON file that belongs to a probe's PLY file."""
    return mesh.with_suffix(".json")


def load_with_regions(mesh: Path) -> tuple[Probe, RegionSet]:
    """
    Read a probe (PLY, metres in S) and the names of its regions.

    Ranks that the sidecar does not name, or all without a sidecar, get names and colours of their own.
    Defects of the mesh are not warned of: they are in ``probe.health``.

    Raises
    ------
    MeshError
        The mesh is not a usable PLY file.
    RegionError
        The sidecar is not a JSON object, or its "regions" are not a list of names and colours.
    """
    if mesh.suffix.lower() != ".ply":
        raise RegionError(
            f"{mesh}: regions are kept in a probe's PLY file: load the mesh and save it as .ply."
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)
        probe = load_probe(mesh, units="m")
    file = sidecar_of(mesh)
    try:
        return probe, RegionSet.from_labels(probe.region, read_list(_read(file)))
    except RegionError as error:
        raise RegionError(f"{file}: {error}") from error


def save_with_regions(probe: Probe, regions: RegionSet, mesh: Path) -> None:
    """
    Write a probe with regions, and their names and colours beside it.

    Everything else in a sidecar that is there stays as it is. The mesh goes first: a power cut between the two
    leaves names for ranks that may have moved, never ranks without a mesh.

    Raises
    ------
    MeshError
        One of the files cannot be written, or there is a sidecar that is no JSON object.
    """
    file = sidecar_of(mesh)
    try:
        document = _read(file)
    except RegionError as error:
        raise RegionError(f"{file}: {error}") from error
    document[_KEY] = [{"name": region.name, "colour": region.colour} for region in regions.regions]
    data = (json.dumps(document, ensure_ascii=False, allow_nan=False, indent=2) + "\n").encode()
    if len(data) > SIZE_LIMIT:
        raise RegionError(f"{file}: the file is larger than {SIZE_LIMIT // 2**20} MiB: move it away.")
    save_probe(probe.with_region(regions.labels), mesh)
    try:
        write_durably(file, data)
    except (OSError, ValueError) as error:
        raise RegionError(f"{file}: the names cannot be written ({error}): check the folder.") from error


def read_list(document: dict[str, Any]) -> tuple[Region, ...]:
    """Return the regions that a sidecar's object names; RegionError if they are not such a list."""
    entries = document.get(_KEY, [])
    if not isinstance(entries, list):
        raise RegionError(f"{_KEY!r} is not a list of names and colours: correct it, or remove the key.")
    regions = tuple(read_region(entry, rank) for rank, entry in enumerate(entries, 1))
    check_list(regions)
    return regions


def _read(file: Path) -> dict[str, Any]:
    return parse_json(read_limited(file)) if file.exists() else {}

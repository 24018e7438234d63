"""
A probe on disk: PLY for the surface, and beside it JSON with the names of its regions and its history.

The history says from which file, by which steps and with which parameters the surface was made, and what each
step achieved. It holds no time and no path: the same steps give the same bytes.
"""

from __future__ import annotations

import hashlib
import json
import os
import warnings
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal, get_args

from contactbench import __version__
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import MeshError, MeshWarning, arg, message
from contactbench.pipeline.files import AnyFile, File, as_file
from contactbench.pipeline.mesh.colours import facet_colours
from contactbench.pipeline.mesh.load import load_probe
from contactbench.pipeline.mesh.ply import encode_ply
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.regions.exchange import (
    SIZE_LIMIT,
    mesh_hash,
    parse_json,
    read_limited,
    read_region,
    write_region,
)
from contactbench.pipeline.mesh.regions.region import Region, RegionError, RegionSet, check_list
from contactbench.pipeline.mesh.regions.transfer import RegionReport

SCHEMA, VERSION = "contactbench.probe", 1
Frame = Literal["P", "S"]
_MOST_STEPS = 10_000


@dataclass(frozen=True, eq=False)
class ProbeFile:
    """
    A probe with what belongs to it.

    Attributes
    ----------
    probe : Probe
        In the frame `frame`, metres; its `untouchable` is what `regions` says.
    regions : RegionSet
        Names, colours and marks of its regions; their ranks are ``probe.region``.
    frame : {"P", "S"}
        P: as the file has it. S: aligned with the sensor.
    history : tuple of mapping
        One JSON object per step, oldest first.
    notes : tuple of str
        What was noticed when it was read, in sentences.
    """

    probe: Probe
    regions: RegionSet
    frame: Frame = "P"
    history: tuple[Mapping[str, Any], ...] = ()
    notes: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        untouchable = self.regions.untouchable
        if self.probe.untouchable != untouchable:
            object.__setattr__(self, "probe", replace(self.probe, untouchable=untouchable))

    @property
    def region_warnings(self) -> tuple[str, ...]:
        """Which regions are not what was painted, by all steps since they were last painted or changed by hand."""
        found: dict[str, RegionReport] = {}
        for step in self.history:
            if step["step"] == "region":
                found = {}
            with suppress(KeyError, TypeError, ValueError, AttributeError):  # written by hand
                result = step["result"]
                carried = result.get("carried", result["regions"] if step["step"] == "shell" else ())
                for each in map(RegionReport.from_json, carried):
                    found[each.name] = found[each.name].after_that(each) if each.name in found else each
        names = {region.name for region in self.regions.regions}
        return tuple(each.warning for each in found.values() if each.warning and each.name in names)

    def after(
        self,
        step: str,
        probe: Probe,
        parameters: Mapping[str, Any],
        result: Mapping[str, Any],
        *,
        regions: RegionSet | None = None,
        frame: Frame | None = None,
    ) -> ProbeFile:
        """
        Return what a step made of it, with the step written down.

        Parameters
        ----------
        step : str
            Its name.
        probe : Probe
            Its result.
        parameters, result : mapping
            What it was asked for and what it achieved: JSON values, lengths in mm with ``_mm`` in the name.
        regions : RegionSet, optional
            Left out: the names stay, the ranks are those of `probe`.
        frame : {"P", "S"}, optional
            Left out: it stays.
        """
        entry = {
            "step": step,
            "tool": f"contactbench {__version__}",
            "parameters": dict(parameters),
            "result": dict(result),
            "input": _brief(self.probe),
            "output": _brief(probe),
        }
        if regions is None:
            regions = RegionSet.from_labels(probe.region, self.regions.regions)
        return replace(
            self,
            probe=probe.with_region(regions.labels, regions.untouchable),
            regions=regions,
            frame=self.frame if frame is None else frame,
            history=(*self.history, entry),
        )


def sidecar_of(mesh: AnyFile) -> AnyFile:
    """Return the JSON file that belongs to a probe's PLY file."""
    return mesh.with_suffix(".json")


def load_probe_file(path: str | os.PathLike[str]) -> ProbeFile:
    """
    Read a probe (PLY, metres) and what stands beside it.

    Ranks that the JSON file does not name, or all without one, get names and colours of their own. Defects of the
    mesh are not warned of: they are in ``probe.health``.

    Raises
    ------
    MeshError
        The mesh is not a usable PLY file.
    RegionError
        The JSON file is not one, or parts of it are not what they should be.
    """
    mesh = as_file(path)
    if mesh.suffix.lower() != ".ply":
        raise RegionError(
            f"{arg(mesh)}: regions are stored in a probe's PLY file: load the mesh and save it as .ply."
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)
        probe = load_probe(mesh, units="m")
    file = sidecar_of(mesh)
    try:
        document = read_document(file)
        regions = RegionSet.from_labels(probe.region, read_list(document), probe.untouchable)
        return ProbeFile(probe, regions, _frame(document), _history(document), _notes(document, mesh))
    except RegionError as error:
        raise RegionError(f"{arg(file)}: {arg(error)}") from error


def save_probe_file(content: ProbeFile, path: str | os.PathLike[str]) -> None:
    """
    Write a probe as PLY and what belongs to it as JSON beside it; keys of an older JSON file that are not its own stay.

    The mesh goes first: a power cut between the two leaves names for ranks that may have moved, and is noticed when
    they are read, never names without a mesh.

    Raises
    ------
    MeshError
        One of the files cannot be written, or there is a JSON file that holds no object.
    """
    mesh = Path(path)
    files = encode_probe_file(content, mesh.name, check_target(mesh))
    for name, data in files.items():
        write_file(mesh.with_name(name), data, MeshError, message("the probe cannot be written"))


def encode_probe_file(
    content: ProbeFile, name: str, document: Mapping[str, Any] | None = None
) -> dict[str, bytes]:
    """Return the files of a probe: its PLY file `name` and, what else `document` has kept, the JSON beside it."""
    file = sidecar_of(Path(name)).name
    regions = content.regions
    colours = [region.colour for region in regions.regions]
    surface = encode_probe(content.probe.with_region(regions.labels, regions.untouchable), colours)
    whole = {
        **(document or {}),
        "schema": SCHEMA,
        "version": VERSION,
        "mesh": {
            "sha256": hashlib.sha256(surface).hexdigest(),
            "facets": len(content.probe.faces),
            "unit": "m",
            "frame": content.frame,
        },
        "regions": [write_region(region) for region in regions.regions],
        "history": [dict(step) for step in content.history],
    }
    data = (json.dumps(whole, ensure_ascii=False, allow_nan=False, indent=2) + "\n").encode()
    if len(data) > SIZE_LIMIT:
        raise RegionError(
            f"{arg(file)}: the file is larger than {arg(SIZE_LIMIT // 2**20)} MiB: move it away."
        )
    return {name: surface, file: data}


def check_target(path: str | os.PathLike[str]) -> dict[str, Any]:
    """
    Refuse a place where a probe cannot be saved, before the work is done; give what the JSON file there holds.

    Raises
    ------
    MeshError
        Another suffix, no such folder, or a JSON file that is not a probe's.
    """
    mesh = _ply_file(path)
    if not mesh.parent.is_dir():
        raise MeshError(
            f"{arg(mesh)}: the probe cannot be written, there is no folder {arg(mesh.parent)}: make it first."
        )
    file = sidecar_of(mesh)
    try:
        return read_document(file)
    except RegionError as error:
        raise RegionError(f"{arg(file)}: {arg(error)}") from error


def read_list(document: Mapping[str, Any]) -> tuple[Region, ...]:
    """Return the regions that a JSON object names; RegionError if they are not such a list."""
    entries = document.get("regions", [])
    if not isinstance(entries, list):
        raise RegionError("'regions' is not a list of names and colours: correct it, or remove the key.")
    regions = tuple(read_region(entry, rank) for rank, entry in enumerate(entries, 1))
    check_list(regions)
    return regions


def read_document(file: File) -> dict[str, Any]:
    """Return the JSON object in a file, an empty one without a file; RegionError for anything else."""
    data = read_limited(file) if file.exists() else b"{}"
    if not data:
        raise RegionError(
            "the file is empty, but belongs to the mesh beside it: if --json output is redirected"
            " here, send it elsewhere; otherwise delete the file."
        )
    document = parse_json(data)
    version = document.get("version", VERSION)
    if document.get("schema", SCHEMA) != SCHEMA or not isinstance(version, int):
        raise RegionError(
            "the JSON file beside the mesh does not belong to a probe: move it away, or rename the mesh."
        )
    if version > VERSION:
        raise RegionError(
            f"the file has the version {arg(version)}, newer than {arg(VERSION)}: use a newer contactbench."
        )
    return document


def _frame(document: Mapping[str, Any]) -> Frame:
    mesh = document.get("mesh", {})
    frame = mesh.get("frame", "P") if isinstance(mesh, dict) else None
    if frame not in get_args(Frame):
        raise RegionError("'mesh' does not say whether the frame is P or S: correct it, or remove the key.")
    return "S" if frame == "S" else "P"


def _history(document: Mapping[str, Any]) -> tuple[Mapping[str, Any], ...]:
    history = document.get("history", [])
    if not isinstance(history, list) or len(history) > _MOST_STEPS:
        raise RegionError(
            f"'history' is not a list of at most {arg(_MOST_STEPS)} steps: correct it, or remove the key."
        )
    for number, step in enumerate(history, 1):
        if not isinstance(step, dict) or not isinstance(step.get("step"), str):
            raise RegionError(
                f"step {arg(number)} of 'history' is not an object with a name: correct it, or remove it."
            )
    return tuple(history)


def _notes(document: Mapping[str, Any], mesh: File) -> tuple[str, ...]:
    known = document.get("mesh", {}).get("sha256")
    if known is None or known == hashlib.sha256(mesh.read_bytes()).hexdigest():
        return ()
    changed = message(
        f"{arg(mesh)} was changed after contactbench wrote it, so the history beside it describes"
        " another surface. Prepare the mesh again unless you know who changed it."
    )
    return (changed,)


def _brief(probe: Probe) -> dict[str, Any]:
    return {"sha256": mesh_hash(probe), "facets": len(probe.faces)}


# ---- write a probe so that a power cut leaves the old file or the new one, never half of one -----


def save_probe(probe: Probe, path: str | os.PathLike[str]) -> None:
    """
    Write a probe as binary PLY: metres in S, double coordinates, and the face properties `region` and `invented`.

    ``load_probe(path, units="m")`` gives the same vertices, faces, region, invented and untouchable, bit for bit.
    Facets are coloured by region, and invented ones apart, so that any viewer shows them.

    Parameters
    ----------
    probe : Probe
        What to write; its name is not in the file.
    path : str or path
        Ends in .ply; a file that is there already is replaced in one step.

    Raises
    ------
    MeshError
        Another suffix, or the folder cannot be written; a file that was there is left as it was.
    """
    write_file(_ply_file(path), encode_probe(probe), MeshError, message("the probe cannot be written"))


def _ply_file(path: str | os.PathLike[str]) -> Path:
    file = Path(path)
    if file.suffix.lower() != ".ply":
        raise MeshError(
            f"{arg(file)}: a probe is saved as PLY, which keeps its regions: end the name in .ply."
        )
    return file


def encode_probe(probe: Probe, colours: Sequence[str] = ()) -> bytes:
    """
    Give the bytes of a probe's file; the same probe and colours give the same bytes.

    Parameters
    ----------
    probe : Probe
    colours : sequence of str
        ``#rrggbb`` per priority; the palette's where they are left out.
    """
    shown = facet_colours(probe.region, probe.invented, colours)
    return encode_ply(probe.vertices, probe.faces, probe.region, probe.invented, shown, probe.untouchable)

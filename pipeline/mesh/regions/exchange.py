"""Regions as files of their own: JSON with names and colours, bound to its mesh; CSV with a rank per facet.

Steps on a probe's regions that outlive the program: in a file beside the probe, ``probe.undo``.

It holds, step by step, the regions as they were before and what the step left in the probe's history. It belongs to the
probe's two files as the last step left them; once something else has changed one of them, no step fits any more.
"""

from __future__ import annotations

import hashlib
import io
import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from contactbench.pipeline.durable import write_durably, write_file
from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.files import File
from contactbench.pipeline.mesh.arrays import Ints, Longs
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.regions.facet_graph import MeshEdit
from contactbench.pipeline.mesh.regions.region import MOST_REGIONS, Region, RegionError, RegionSet
from contactbench.pipeline.tables import TableReader, Wording, read_table

FORMAT, VERSION = "contactbench regions", 1
SIZE_LIMIT = 64 * 2**20  # bytes; half a million scattered facets take a tenth of it

_CSV = Wording(
    header="face,region",
    rows=message("facets and regions"),
    meaning=message("the facet, counted from 0, and the rank of its region, 0 for none"),
    not_finite=message("write the number of a facet or region."),
    error=RegionError,
)


def mesh_hash(probe: Probe) -> str:
    """SHA-256 over the faces, then the vertices, as little-endian int32 and float64: 64 hexadecimal digits."""
    digest = hashlib.sha256(np.ascontiguousarray(probe.faces, dtype="<i4").tobytes())
    digest.update(np.ascontiguousarray(probe.vertices, dtype="<f8").tobytes())
    return digest.hexdigest()


def encode_json(regions: RegionSet, probe: Probe) -> bytes:
    """
    Write regions as JSON: per region its name, colour and marks, and its facets as runs of [first, count].

    Parameters
    ----------
    regions : RegionSet
    probe : Probe
        The mesh that they are kept for; its hash goes into the file.
    """
    document = {
        "format": FORMAT,
        "version": VERSION,
        "mesh": {"sha256": mesh_hash(probe), "facets": len(probe.faces)},
        **({} if regions.cut is None else {"cut": regions.cut.to_json()}),
        "regions": [
            {**write_region(region), "facets": _runs(regions.faces_of(rank))}
            for rank, region in enumerate(regions.regions, 1)
        ],
    }
    return (json.dumps(document, ensure_ascii=False, allow_nan=False) + "\n").encode()


def decode_json(data: bytes, probe: Probe) -> RegionSet:
    """
    Read what `encode_json` wrote.

    Parameters
    ----------
    data : bytes
    probe : Probe
        The mesh that the regions are for.

    Raises
    ------
    RegionError
        Not such a file, of another mesh, or with contents that cannot be: facets out of range or in two
        regions, names or colours that are none.
    """
    document = parse_json(data)
    if _of(document, "format", str) != FORMAT:
        raise RegionError("this JSON file contains no regions: choose a file that was exported as regions.")
    version = _of(document, "version", int)
    if version != VERSION:
        raise RegionError(
            f"these regions have the format {arg(version)}, not {arg(VERSION)}: use a newer contactbench."
        )
    _check_mesh(_of(document, "mesh", dict), probe)
    entries = _of(document, "regions", list)
    if len(entries) > MOST_REGIONS:
        raise RegionError(
            f"the file holds {arg(len(entries))} regions, more than {arg(MOST_REGIONS)}: merge some."
        )
    cut = _read_cut(_of(document, "cut", dict), probe) if "cut" in document else None
    labels = np.zeros(len(probe.faces) if cut is None else cut.count, dtype=np.int32)
    listed = []
    for rank, entry in enumerate(entries, 1):
        listed.append(read_region(entry, rank))
        _fill(labels, rank, _of(entry, "facets", list), listed[-1].name)
    return RegionSet(tuple(listed), labels, cut)


def _read_cut(entry: dict[str, Any], probe: Probe) -> MeshEdit:
    cut = MeshEdit.from_json(entry)
    whole = cut.put_on(probe)
    try:
        type(probe).from_arrays(whole.vertices, whole.faces, check_size=False)
    except MeshError as error:
        raise RegionError(f"the cut facets are no mesh ({arg(error)}): export them again.") from error
    return cut


def parse_json(data: bytes) -> dict[str, Any]:
    """Parse a JSON object; RegionError for anything else, and for a key that occurs twice in one object."""
    try:
        document = json.loads(data.decode("utf-8-sig"), object_pairs_hook=_once, parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:  # UnicodeDecodeError and JSONDecodeError are ValueErrors
        raise RegionError(f"this is not a JSON file ({arg(error)}): copy or export it again.") from error
    if not isinstance(document, dict):
        raise RegionError("the JSON file does not hold one object in {}: choose another file.")
    return document


def write_region(region: Region) -> dict[str, Any]:
    """Return what a file says of one region, its facets apart; touchable ones as files had them before."""
    marks = {"untouchable": True} if region.untouchable else {}
    return {"name": region.name, "colour": region.colour, **marks}


def read_region(entry: object, rank: int) -> Region:
    """Return one region of a file, its facets apart; RegionError without a name or colour, or for another mark."""
    if not isinstance(entry, dict):
        raise RegionError(f"region {arg(rank)} of the file is not an object with a name and a colour.")
    untouchable = "untouchable" in entry and _of(entry, "untouchable", bool)
    return Region(_of(entry, "name", str), _of(entry, "colour", str), untouchable)


def encode_csv(regions: RegionSet) -> bytes:
    """Write a row ``face,region`` for each facet, also those of no region (0)."""
    text = io.StringIO()
    text.write("face,region\n")
    table = np.column_stack((np.arange(len(regions.labels)), regions.labels))
    np.savetxt(text, table, fmt="%d", delimiter=",")
    return text.getvalue().encode()


def decode_csv(source: File | io.BytesIO, facet_count: int) -> Ints:
    """
    Read ranks from a table ``face,region``; facets without a row belong to no region.

    Returns
    -------
    (m,) int32

    Raises
    ------
    RegionError
        Not such a table, numbers that are not whole or out of range, or two rows for one facet.
    """

    def select(reader: TableReader) -> None:
        reader.select(("face", "region"))

    rows = read_table(source, select, _CSV, row_limit=facet_count)
    name = source if isinstance(source, File) else message("the table")
    for column, limit in (("face", facet_count - 1), ("region", MOST_REGIONS)):
        values = rows.column(column)
        bad = (values != np.floor(values)) | (values < 0) | (values > limit)
        if bad.any():
            row = int(np.argmax(bad))
            raise RegionError(
                f"{arg(name)}: line {arg(rows.lines[row])}: {arg(column)} is {arg(values[row]):g}, not a"
                f" whole number from 0 to {arg(limit)}."
            )
    face = rows.column("face").astype(np.int64)
    _, first = np.unique(face, return_index=True)
    if len(first) < len(face):
        row = int(np.setdiff1d(np.arange(len(face)), first)[0])
        raise RegionError(
            f"{arg(name)}: line {arg(rows.lines[row])}: facet {arg(face[row])} occurs twice: keep one row."
        )
    labels = np.zeros(facet_count, dtype=np.int32)
    labels[face] = rows.column("region").astype(np.int32)
    return labels


def save_regions(regions: RegionSet, probe: Probe, file: Path) -> None:
    """Write .json or .csv, in one step; RegionError for another suffix or where that fails."""
    suffix = file.suffix.lower()
    if suffix not in {".json", ".csv"}:
        raise RegionError(f"{arg(file)}: regions are written as .json or .csv: end the name in one of them.")
    data = encode_json(regions, probe) if suffix == ".json" else encode_csv(regions)
    write_file(file, data, RegionError, message("the regions cannot be written"))


def load_regions(file: File, probe: Probe) -> RegionSet:
    """Read .json or .csv for a mesh; RegionError, naming the file, where that fails."""
    suffix = file.suffix.lower()
    if suffix == ".csv":
        return RegionSet.from_labels(decode_csv(file, len(probe.faces)))
    if suffix != ".json":
        raise RegionError(f"{arg(file)}: regions are read from .json or .csv: choose one of them.")
    try:
        return decode_json(read_limited(file), probe)
    except RegionError as error:
        raise RegionError(f"{arg(file)}: {arg(error)}") from error


def read_limited(file: File) -> bytes:
    """Read a file of at most 64 MiB; RegionError if it is larger or cannot be read."""
    try:
        with file.open("rb") as stream:
            data = stream.read(SIZE_LIMIT + 1)
    except (OSError, ValueError) as error:
        raise RegionError(f"the file cannot be read ({arg(error)}): check the path.") from error
    if len(data) > SIZE_LIMIT:
        raise RegionError(
            f"the file is larger than {arg(SIZE_LIMIT // 2**20)} MiB, too large for regions: choose another."
        )
    return data


def _runs(faces: Longs) -> list[list[int]]:
    if len(faces) == 0:
        return []
    first = np.flatnonzero(np.diff(faces, prepend=-2) != 1)
    counts = np.diff(first, append=len(faces))
    return [list(run) for run in zip(faces[first].tolist(), counts.tolist(), strict=True)]


def _fill(labels: Ints, rank: int, runs: list[Any], name: str) -> None:
    for number, run in enumerate(runs):
        if not (isinstance(run, list) and len(run) == 2 and all(type(value) is int for value in run)):
            raise RegionError(
                f"region {arg(name)!r}: facets[{arg(number)}] is not a run [first, count] of two integers."
            )
        first, count = run
        if not (first >= 0 and 0 < count <= len(labels) - first):
            raise RegionError(
                f"region {arg(name)!r}: facets[{arg(number)}] is {arg(str(run)[:60])}, but facets run from 0"
                f" to {arg(len(labels) - 1)}."
            )
        part = labels[first : first + count]
        if part.any():
            face = first + int(np.argmax(part != 0))
            raise RegionError(
                f"region {arg(name)!r}: facet {arg(face)} is listed twice: a facet has at most one region."
            )
        part[:] = rank


def _check_mesh(mesh: dict[str, Any], probe: Probe) -> None:
    facets = _of(mesh, "facets", int)
    remedy = message("Transfer them from their own mesh instead (contactbench probe regions transfer).")
    if facets != len(probe.faces):
        raise RegionError(
            f"the regions are for a mesh of {arg(str(facets)[:20])} facets, this one has"
            f" {arg(len(probe.faces))}. {arg(remedy)}"
        )
    if _of(mesh, "sha256", str) != mesh_hash(probe):
        raise RegionError(
            f"the regions are for another mesh of {arg(facets)} facets: its vertices or faces differ. {arg(remedy)}"
        )


def _of(part: dict[str, Any], key: str, kind: type[Any]) -> Any:
    value = part.get(key)
    if type(value) is not kind:  # True is an int to isinstance
        found = message("is missing") if key not in part else f"is {type(value).__name__}"
        raise RegionError(
            f"{arg(key)!r} {arg(found)} in the JSON file, where {arg(kind.__name__)} belongs: export it again."
        )
    return value


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    result = dict(pairs)
    if len(result) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name, count in Counter(names).items() if count > 1)
        raise RegionError(f"the key {arg(twice[:40])!r} occurs twice in one object: keep one.")
    return result


def _no_constant(text: str) -> float:
    raise RegionError(f"{arg(text)} is not a valid JSON number: export the file again.")


# ---- steps on a probe's regions that outlive the program: in a file beside the probe, ``probe.undo`` ----


STEPS_FORMAT, STEPS_VERSION = "contactbench region steps", 1
MOST_STEPS = 100


@dataclass(frozen=True)
class KeptStep:
    """
    One step, done or undone.

    Attributes
    ----------
    text : str
        What was done: "paint Lens".
    entry : mapping
        What the step wrote into the probe's history.
    other : mapping
        The regions on its other side, as `encode_json` writes them: before it if it is done, after it if it is undone.
    """

    text: str
    entry: Mapping[str, Any]
    other: Mapping[str, Any]

    @classmethod
    def of(cls, text: str, entry: Mapping[str, Any], other: RegionSet, probe: Probe) -> KeptStep:
        """Make one of regions that are kept for the mesh on this side."""
        return cls(text, entry, json.loads(encode_json(other, probe)))

    def regions(self, probe: Probe) -> RegionSet:
        """Return `other` on its mesh; RegionError if they cannot be on this one."""
        return decode_json(json.dumps(self.other).encode(), probe)


@dataclass
class KeptSteps:
    """
    What can be undone and redone.

    Attributes
    ----------
    done, undone : list of KeptStep
        The newest last: the next to be undone, and to be redone.
    changed : bool
        There were steps, but something else has changed the probe since.
    """

    done: list[KeptStep] = field(default_factory=list)
    undone: list[KeptStep] = field(default_factory=list)
    changed: bool = False


def undo_file_of(mesh: Path) -> Path:
    """Return the file of steps that belongs to a probe's PLY file."""
    return mesh.with_suffix(".undo")


def load_steps(files: Sequence[Path]) -> KeptSteps:
    """
    Read the steps of a probe; none without a file, or once something else has changed the probe.

    Parameters
    ----------
    files : sequence of path
        The probe's files, the PLY file first.

    Raises
    ------
    RegionError
        The file is not one of steps.
    """
    file = undo_file_of(files[0])
    if not file.exists():
        return KeptSteps()
    try:
        document = parse_json(read_limited(file))
        steps = KeptSteps(_steps(document, "done"), _steps(document, "undone"))
    except RegionError as error:
        raise RegionError(
            f"{arg(file)}: {arg(error)} Delete the file: the regions stay as they are, but cannot be undone."
        ) from error
    return steps if document.get("files") == _digests(files) else KeptSteps(changed=True)


def save_steps(steps: KeptSteps, files: Sequence[Path]) -> None:
    """
    Write the steps of a probe whose files are written already; the oldest go where there are too many.

    Raises
    ------
    RegionError
        They cannot be written.
    """
    file, done = undo_file_of(files[0]), steps.done[-MOST_STEPS:]
    head = {"format": STEPS_FORMAT, "version": STEPS_VERSION, "files": _digests(files)}
    while len(data := _encoded({**head, "done": done, "undone": steps.undone})) > SIZE_LIMIT and done:
        done = done[1 + len(done) // 2 :]
    try:
        write_durably(file, data)
    except (OSError, ValueError) as error:
        raise RegionError(
            f"{arg(file)}: cannot be written ({arg(error)}): this step cannot be undone."
        ) from error


def _encoded(document: Mapping[str, Any]) -> bytes:
    return (json.dumps(document, ensure_ascii=False, allow_nan=False, default=vars) + "\n").encode()


def _steps(document: Mapping[str, Any], key: str) -> list[KeptStep]:
    found = document.get(key)
    known = document.get("format") == STEPS_FORMAT and document.get("version") == STEPS_VERSION
    if not known or not isinstance(found, list):
        raise RegionError("this file does not contain region steps, or has another version.")
    steps = []
    for number, each in enumerate(found, 1):
        kinds = {"text": str, "entry": dict, "other": dict}
        if not isinstance(each, dict) or any(not isinstance(each.get(k), kind) for k, kind in kinds.items()):
            raise RegionError(f"step {arg(number)} of {arg(key)!r} lacks its text, entry or regions.")
        if not isinstance(each["entry"].get("step"), str):  # it goes into the probe's history
            raise RegionError(f"the entry of step {arg(number)} of {arg(key)!r} has no name.")
        steps.append(KeptStep(each["text"], each["entry"], each["other"]))
    return steps


def _digests(files: Sequence[Path]) -> dict[str, str]:
    """Return the hashes of the files by their suffix: a folder that is copied or renamed keeps its steps."""
    return {file.suffix: hashlib.sha256(file.read_bytes()).hexdigest() for file in files if file.exists()}

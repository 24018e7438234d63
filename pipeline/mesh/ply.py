"""
PLY, binary and text, with an integer property `region` per facet.

A PLY header says how many rows of which properties follow. It is read here first, so that an absurd number is
refused before anything is allocated for it; trimesh then gets a plain header in which only the coordinates,
the vertex indices and the region keep their names, because it gives a meaning to many others (colour, edge).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from pipeline.mesh.errors import MeshError
from pipeline.mesh.parse import NUMBER, RawMesh, run_trimesh

if TYPE_CHECKING:
    import numpy.typing as npt

# `save_probe` writes it; merging or cleaning such a mesh again could renumber what a session refers to.
SETTLED = "contactbench probe 1"

_INTEGERS = {
    "char": 1, "int8": 1, "uchar": 1, "uint8": 1, "short": 2, "int16": 2, "ushort": 2, "uint16": 2,
    "int": 4, "int32": 4, "uint": 4, "uint32": 4, "int64": 8, "uint64": 8,
}  # fmt: skip
_BYTES = _INTEGERS | {"float16": 2, "float": 4, "float32": 4, "double": 8, "float64": 8}

_END = re.compile(rb"^end_header[ \t]*\r?\n", re.M)
_ENCODINGS = ("ascii", "binary_little_endian", "binary_big_endian")
_INDICES = ("vertex_indices", "vertex_index")
_KNOWN = {"vertex": ("x", "y", "z"), "face": ("vertex_indices", "region")}
_ONE_NUMBER = re.compile(NUMBER)


@dataclass(frozen=True)
class _Property:
    name: str
    kind: str
    count_kind: str | None = None  # of a list

    @property
    def fewest_bytes(self) -> int:
        return _BYTES[self.count_kind or self.kind]


# Text is read as float64 and then cut to the type in the header. A number that does not fit is to
# be refused with its row, so it gets room.
_WIDEST = {axis: _Property(axis, "double") for axis in "xyz"} | {
    "vertex_indices": _Property("vertex_indices", "int64", "uchar"),
    "region": _Property("region", "int64"),
}


@dataclass(frozen=True)
class _Element:
    name: str
    count: int
    properties: tuple[_Property, ...]


def read_ply(data: bytes) -> RawMesh:
    """
    Read the content of a PLY file; polygons become fans of triangles that share their polygon's region.

    Parameters
    ----------
    data : bytes
        The whole file.

    Returns
    -------
    RawMesh
        Facets in the file's order.

    Raises
    ------
    MeshError
        Not a PLY file, cut short, without facets, or with properties of an unsuitable type.
    """
    encoding, elements, settled, body = _split(data)
    _check_mesh(elements)
    if encoding == "ascii":
        elements, body = _plain_text(elements, body)
    else:
        _refuse_short(elements, len(body))
    raw = run_trimesh(_header(encoding, elements) + body, "ply").metadata.get("_ply_raw", {})
    return _extract(raw, settled)


def encode_ply(
    vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32], region: npt.NDArray[np.int32]
) -> bytes:
    """
    Encode a mesh as binary little-endian PLY.

    Parameters
    ----------
    vertices : (n, 3) float64
        Metres in S; written as double, so nothing is rounded.
    faces : (m, 3) int32
        Vertex indices.
    region : (m,) int32
        Priority per facet, written as the property `region`.

    Returns
    -------
    bytes
        The whole file.
    """
    rows = np.empty(len(faces), dtype=[("count", "u1"), ("vertex_indices", "<i4", (3,)), ("region", "<i4")])
    rows["count"], rows["vertex_indices"], rows["region"] = 3, faces, region
    header = (
        f"ply\nformat binary_little_endian 1.0\ncomment {SETTLED}\ncomment metres, sensor frame S\n"
        f"element vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nproperty int region\n"
        "end_header\n"
    )
    return header.encode("ascii") + vertices.astype("<f8").tobytes() + rows.tobytes()


def _split(data: bytes) -> tuple[str, list[_Element], bool, bytes]:
    end = _END.search(data)
    if not re.match(rb"ply[ \t]*\r?\n", data):
        raise MeshError(
            "the first line is not 'ply': this is not a PLY file, choose another or export it again."
        )
    if end is None:
        raise MeshError("the PLY header has no 'end_header' line: the file is cut short, export it again.")
    lines = data[: end.start()].decode("latin-1").split("\n")[1:]
    encoding, elements, settled = "", list[_Element](), False
    for number, line in enumerate(lines, start=2):
        match line.split():
            case ["format", kind, "1.0"] if kind in _ENCODINGS:
                encoding = kind
            case ["element", name, count] if re.fullmatch("[0-9]{1,18}", count):
                elements.append(_Element(name, int(count), ()))
            case ["property", *rest] if elements and (found := _property(rest)):
                last = elements[-1]
                elements[-1] = _Element(last.name, last.count, (*last.properties, found))
            case ["comment" | "obj_info", *words]:
                settled = settled or " ".join(words) == SETTLED
            case []:
                pass
            case _:
                raise MeshError(
                    f"line {number} of the PLY header, {line[:60]!r}, cannot be used: export the file again."
                )
    if not encoding:
        raise MeshError("the PLY header has no 'format' line: the file is damaged, export it again.")
    # Elements without rows take no bytes, and without them the header is simpler.
    return encoding, [element for element in elements if element.count], settled, data[end.end() :]


def _property(words: list[str]) -> _Property | None:
    match words:
        case ["list", count_kind, kind, name] if count_kind in _INTEGERS and kind in _BYTES:
            return _Property(name, kind, count_kind)
        case [kind, name] if kind in _BYTES:
            return _Property(name, kind)
        case _:
            return None


def _check_mesh(elements: list[_Element]) -> None:
    """Refuse a header without vertices and facets, or with properties of an unsuitable type."""
    for element in elements:
        names = [_plain(element, prop) for prop in element.properties]
        if not names or len(set(names)) != len(names):
            raise MeshError(
                f"the PLY element '{element.name}' has no property, or one twice: export the file again."
            )
    found = {element.name: {_plain(element, p): p for p in element.properties} for element in elements}
    if len(found) != len(elements):
        raise MeshError("the PLY header names an element twice: export the file again.")
    for axis in "xyz":
        prop = found.get("vertex", {}).get(axis)
        if prop is None or prop.count_kind:
            raise MeshError(
                f"the PLY file holds no vertices with a number '{axis}': export it again as a mesh."
            )
    corners = found.get("face", {}).get("vertex_indices")
    if corners is None:
        raise MeshError("the PLY file holds no facets (a point cloud?): export it again as a surface.")
    if not corners.count_kind or corners.kind not in _INTEGERS:
        raise MeshError("the PLY property 'vertex_indices' is not a list of integers: export the file again.")
    region = found["face"].get("region")
    if region and (region.count_kind or region.kind not in _INTEGERS):
        raise MeshError(
            f"the PLY face property 'region' is {'a list' if region.count_kind else region.kind}: save it as"
            " int, 0 for no region, 1 for the first priority."
        )


def _plain(element: _Element, prop: _Property) -> str:
    return _INDICES[0] if element.name == "face" and prop.name in _INDICES else prop.name


def _refuse_short(elements: list[_Element], size: int) -> None:
    needed = sum(element.count * sum(p.fewest_bytes for p in element.properties) for element in elements)
    if needed > size:
        raise MeshError(
            f"the PLY header announces {_contents(elements)}, at least {needed} bytes, but {size} follow:"
            " the file is cut short, copy or export it again."
        )


def _contents(elements: list[_Element]) -> str:
    return ", ".join(f"{element.count} rows of '{element.name}'" for element in elements)


def _header(encoding: str, elements: list[_Element]) -> bytes:
    lines = ["ply", f"format {encoding} 1.0"]
    for e, element in enumerate(elements):
        known = _KNOWN.get(element.name, ())
        lines.append(f"element {element.name if known else f'skip_{e}'} {element.count}")
        for p, prop in enumerate(element.properties):
            name = _plain(element, prop)
            kind = f"list {prop.count_kind} {prop.kind}" if prop.count_kind else prop.kind
            lines.append(f"property {kind} {name if name in known else f'skip_{p}'}")
    return "\n".join([*lines, "end_header", ""]).encode("ascii")


def _plain_text(elements: list[_Element], body: bytes) -> tuple[list[_Element], bytes]:
    """Check the rows of a text body and keep what the mesh needs, every polygon split into triangles."""
    rows = [row.split() for row in body.splitlines() if row.strip()]
    announced = sum(element.count for element in elements)
    if len(rows) != announced:
        raise MeshError(
            f"the PLY header announces {_contents(elements)}, but {len(rows)} rows follow it: the file is cut"
            " short or damaged, copy or export it again."
        )
    kept, lines, start = [], [], 0
    for element in elements:
        block = rows[start : start + element.count]
        start += element.count
        known = _KNOWN.get(element.name)
        if known is None:
            continue
        chosen = [_fields(element, row, i) for i, row in enumerate(block)]
        names = [n for n in known if any(_plain(element, p) == n for p in element.properties)]
        triangles = [line for row in chosen for line in _lines(row, names)]
        kept.append(_Element(element.name, len(triangles), tuple(_WIDEST[name] for name in names)))
        lines += triangles
    return kept, b"\n".join(lines) + b"\n"


def _fields(element: _Element, row: list[bytes], number: int) -> dict[str, list[bytes]]:
    """Values per property of one text row."""
    fields: dict[str, list[bytes]] = {}
    position = 0
    for prop in element.properties:
        length = 1
        if prop.count_kind:
            length = _whole(row[position : position + 1], element, number)
            position += 1
        values = row[position : position + length]
        position += length
        valid = len(values) == length >= 0 and all(_ONE_NUMBER.fullmatch(value) for value in values)
        if not valid or (prop.kind in _INTEGERS and not all(map(_is_whole, values))):
            raise _bad_row(element, number)
        fields[_plain(element, prop)] = values
    if element.name == "face" and len(fields[_INDICES[0]]) < 3:
        raise MeshError(
            f"row {number} of the PLY element 'face' has fewer than three vertices: export it with triangles"
            " only."
        )
    if position != len(row):
        raise _bad_row(element, number)
    return fields


def _is_whole(value: bytes) -> bool:
    # trimesh reads every number as float64, which is exact for integers of up to 15 digits.
    return re.fullmatch(rb"[+-]?\d{1,15}", value) is not None


def _whole(values: list[bytes], element: _Element, number: int) -> int:
    if not values or not _is_whole(values[0]):
        raise _bad_row(element, number)
    return int(values[0])


def _bad_row(element: _Element, number: int) -> MeshError:
    return MeshError(
        f"row {number} of the PLY element '{element.name}' does not hold the numbers that the header"
        " announces: the file is damaged, export it again."
    )


def _lines(fields: dict[str, list[bytes]], names: list[str]) -> list[bytes]:
    """One row as it goes to trimesh, or one per triangle of the fan where it is a polygon."""
    rest = b" ".join(value for name in names if name != _INDICES[0] for value in fields[name])
    if _INDICES[0] not in names:
        return [rest]
    a, *others = fields[_INDICES[0]]
    return [b"3 %s %s %s %s" % (a, b, c, rest) for b, c in pairwise(others)]


def _extract(raw: dict[str, Any], settled: bool) -> RawMesh:
    vertex, face = (raw.get(name, {}).get("data") for name in ("vertex", "face"))
    if vertex is None or face is None:
        raise MeshError("the PLY file holds no readable facets: it is damaged, export it again.")
    corners = face["vertex_indices"]
    if corners.dtype.names:
        _refuse_mixed(vertex, face)
        corners = corners["f1"]
    if corners.ndim != 2 or corners.shape[1] < 3:
        raise MeshError(
            "the PLY file holds facets with fewer than three vertices: export it with triangles only."
        )
    with np.errstate(invalid="ignore"):  # a signalling NaN; it is refused with its row later
        vertices = np.column_stack([vertex[axis] for axis in "xyz"]).astype(np.float64)
    names = face.dtype.names if isinstance(face, np.ndarray) else face
    region = np.ravel(face["region"]).astype(np.int64) if "region" in names else None
    fans = corners.shape[1] - 2
    return RawMesh(
        vertices,
        _fan(corners.astype(np.int64)),
        region if region is None else np.repeat(region, fans),
        settled,
    )


def _refuse_mixed(*blocks: npt.NDArray[Any]) -> None:
    """Refuse lists of several lengths: trimesh takes the first for all and misplaces every later byte."""
    for block in blocks:
        for name in block.dtype.names or ():
            lengths = block[name]["f0"] if block.dtype[name].names else np.zeros(1)
            if np.any(lengths != lengths[0]):
                raise MeshError(
                    "the PLY facets have different numbers of vertices, or the file is damaged: export it"
                    " with triangles only."
                )


def _fan(polygons: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    first, others = polygons[:, :1], polygons[:, 1:]
    count = polygons.shape[1] - 2
    fans = np.stack((np.repeat(first, count, axis=1), others[:, :-1], others[:, 1:]), axis=2)
    return np.ascontiguousarray(fans.reshape(-1, 3))

"""The rows of a PLY file, binary and text: coordinates, triangles, and integers per triangle."""

from __future__ import annotations

import io
import re
from array import array
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pipeline.mesh.errors import MeshError
from pipeline.mesh.parse import NUMBER, fan, points, refuse_too_many
from pipeline.mesh.ply_header import INDICES, INTEGERS, KINDS

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import numpy.typing as npt

    from pipeline.mesh.ply_header import Element, Header

# Integers per facet that have a meaning here.
LABELS = ("region", "invented")

_ONE_NUMBER = re.compile(NUMBER)
_ONE_INTEGER = re.compile(rb"[+-]?\d{1,18}")


@dataclass(frozen=True, eq=False)
class Body:
    """
    What the rows hold.

    Attributes
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
        Polygons as fans of triangles; indices may be out of range.
    labels : dict of (m,) int64
        For each of `LABELS` that the file has.
    """

    vertices: npt.NDArray[np.float64]
    faces: npt.NDArray[np.int64]
    labels: dict[str, npt.NDArray[np.int64]]


def read_binary(header: Header, data: bytes) -> Body:
    """
    Read a binary body; every list of a property must be as long as its first.

    Parameters
    ----------
    header : Header
        Of the file.
    data : bytes
        The whole file.

    Raises
    ------
    MeshError
        Fewer bytes than announced, lists of several lengths, or facets of fewer than three vertices.
    """
    _refuse_short(header, len(data))
    blocks, at = {}, header.length
    for element in header.elements:
        dtype = _row_type(header, element, data, at)
        needed = at + element.count * dtype.itemsize
        if needed > len(data):
            raise _short(header, needed - header.length, len(data))
        block = np.frombuffer(data, dtype, element.count, at)
        _refuse_mixed(element, block)
        if element.name in ("vertex", "face"):
            blocks[element.name] = block
        at = needed
    vertex, face = blocks["vertex"], blocks["face"]
    corners = face[INDICES]
    if corners.shape[1] < 3:
        raise MeshError(
            "the PLY file holds facets with fewer than three vertices: export it with triangles only."
        )
    fans = corners.shape[1] - 2
    refuse_too_many(fans * len(face))
    with np.errstate(invalid="ignore"):  # a signalling NaN; it is refused with its row later
        vertices = np.column_stack([vertex[axis].astype(np.float64) for axis in "xyz"])
    names = face.dtype.names or ()
    labels = {name: np.repeat(face[name].astype(np.int64), fans) for name in LABELS if name in names}
    return Body(vertices, _fan(corners), labels)


def _refuse_short(header: Header, size: int) -> None:
    needed = sum(e.count * sum(p.fewest_bytes for p in e.properties) for e in header.elements)
    if needed > size - header.length:
        raise _short(header, needed, size)


def _short(header: Header, needed: int, size: int) -> MeshError:
    return MeshError(
        f"the PLY header announces {header.contents}, at least {needed} bytes, but {size - header.length}"
        " follow: the file is cut short, copy or export it again."
    )


def _row_type(header: Header, element: Element, data: bytes, at: int) -> np.dtype[Any]:
    """Type of one row, with lists as long as in the first row, which begins at a byte of the file."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    begin = at
    for prop in element.properties:
        kind = np.dtype(header.order + KINDS[prop.kind])
        if prop.count_kind is None:
            fields.append((prop.name, kind.str))
            begin += kind.itemsize
            continue
        count = np.dtype(header.order + KINDS[prop.count_kind])
        if begin + count.itemsize > len(data):
            raise _short(header, begin + count.itemsize - header.length, len(data))
        length = int(np.frombuffer(data, count, 1, begin)[0])
        begin += count.itemsize + length * kind.itemsize
        # Refused before a type is made of it: those have limits of their own.
        if length < 0 or begin > len(data):
            raise MeshError(
                f"a list of the PLY element '{element.name}' announces {length} numbers, which the file does not"
                " hold: it is damaged or cut short, export it again with triangles only."
            )
        fields += [(f"{prop.name} count", count.str), (prop.name, kind.str, (length,))]
    return np.dtype(fields)


def _refuse_mixed(element: Element, block: npt.NDArray[Any]) -> None:
    for prop in element.properties:
        if prop.count_kind and np.any(block[f"{prop.name} count"] != block[f"{prop.name} count"][0]):
            raise MeshError(
                "the PLY facets have different numbers of vertices, or the file is damaged: export it"
                " with triangles only."
            )


def _fan(polygons: npt.NDArray[np.integer[Any]]) -> npt.NDArray[np.int64]:
    fans = np.empty((len(polygons), polygons.shape[1] - 2, 3), dtype=np.int64)
    fans[:, :, 0], fans[:, :, 1], fans[:, :, 2] = polygons[:, :1], polygons[:, 1:-1], polygons[:, 2:]
    return fans.reshape(-1, 3)


def read_text(header: Header, data: bytes) -> Body:
    """
    Read a text body; polygons may be of any length.

    Parameters
    ----------
    header : Header
        Of the file.
    data : bytes
        The whole file.

    Raises
    ------
    MeshError
        More or fewer rows than announced, or a row that does not hold the numbers it should.
    """
    body = data[header.length :]
    rows = sum(1 for _ in _rows(body))
    if rows != sum(element.count for element in header.elements):
        raise MeshError(
            f"the PLY header announces {header.contents}, but {rows} rows follow it: the file is cut short or"
            " damaged, copy or export it again."
        )
    coordinates, corners = array("d"), array("q")
    labels = {name: array("q") for name in LABELS}
    stream = _rows(body)
    for element in header.elements:
        fields_of = _RowReader(element)
        for number, row in zip(range(element.count), stream, strict=False):
            if element.name == "vertex":
                fields = fields_of(row, number)
                coordinates.extend((float(fields["x"][0]), float(fields["y"][0]), float(fields["z"][0])))
            elif element.name == "face":
                fields = fields_of(row, number)
                triangles = _triangles(fields[INDICES], number)
                corners.extend(triangles)
                for name in LABELS:
                    labels[name].extend([int(v) for v in fields.get(name, ())] * (len(triangles) // 3))
                refuse_too_many(len(corners) // 3)
    present = {name: np.frombuffer(values, np.int64) for name, values in labels.items() if values}
    return Body(points(coordinates), np.frombuffer(corners, np.int64).reshape(-1, 3), present)


def _rows(body: bytes) -> Iterator[bytes]:
    text = body.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in body else body
    return (row for row in io.BytesIO(text) if not row.isspace())


class _RowReader:
    """Numbers per property of one text row after another, triangles quickly."""

    def __init__(self, element: Element) -> None:
        self._element = element
        self._places: dict[str, slice] = {}
        self._quick: re.Pattern[bytes] | None = None
        parts: list[bytes] = []
        place = 0
        for prop in element.properties:
            if prop.count_kind and prop.name != INDICES:
                return
            length = 3 if prop.count_kind else 1
            number = rb"([+-]?\d{1,18})" if prop.kind in INTEGERS else rb"(" + NUMBER + rb")"
            parts += [rb"3"] * bool(prop.count_kind) + [number] * length
            self._places[prop.name] = slice(place, place + length)
            place += length
        self._quick = re.compile(rb"\s*" + rb"\s+".join(parts) + rb"\s*")

    def __call__(self, row: bytes, number: int) -> dict[str, Sequence[bytes]]:
        match = self._quick and self._quick.fullmatch(row)
        if match:
            groups = match.groups()
            return {name: groups[place] for name, place in self._places.items()}
        return _fields(self._element, row.split(), number)


def _fields(element: Element, row: list[bytes], number: int) -> dict[str, Sequence[bytes]]:
    """Numbers per property of one text row."""
    fields: dict[str, Sequence[bytes]] = {}
    position = 0
    for prop in element.properties:
        length = 1
        if prop.count_kind:
            counted = row[position : position + 1]
            if not counted or not _ONE_INTEGER.fullmatch(counted[0]):
                raise _bad_row(element, number)
            length = int(counted[0])
            position += 1
        values = row[position : position + max(length, 0)]
        position += length
        pattern = _ONE_INTEGER if prop.kind in INTEGERS else _ONE_NUMBER
        if len(values) != length or not all(map(pattern.fullmatch, values)):
            raise _bad_row(element, number)
        fields[prop.name] = values
    if position != len(row):
        raise _bad_row(element, number)
    return fields


def _triangles(polygon: Sequence[bytes], number: int) -> list[int]:
    """Corners of the fan, three for each triangle."""
    if len(polygon) < 3:
        raise MeshError(
            f"row {number} of the PLY element 'face' has fewer than three vertices: export it with triangles"
            " only."
        )
    return fan([int(corner) for corner in polygon])


def _bad_row(element: Element, number: int) -> MeshError:
    return MeshError(
        f"row {number} of the PLY element '{element.name}' does not hold the numbers that the header"
        " announces: the file is damaged, export it again."
    )

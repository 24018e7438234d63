"""OFF, the object file format in text: vertices, then polygons that list them."""

from __future__ import annotations

import io
import re
from array import array
from typing import TYPE_CHECKING

from pipeline.mesh.errors import MeshError
from pipeline.mesh.parse import NUMBER, RawMesh, Triangles, points, refuse_too_many

if TYPE_CHECKING:
    from collections.abc import Iterator

# Texture, colour and normal columns follow x y z, so they can be left alone. 4OFF and nOFF have other vertices.
_KEYWORD = re.compile(rb"(?:ST)?C?N?OFF")
_THREE = re.compile(rb"(" + NUMBER + rb")" + (rb"\s+(" + NUMBER + rb")") * 2 + rb"(?!\S)")
_COUNT = re.compile(rb"\d{1,18}")


def read_off(data: bytes) -> RawMesh:
    """
    Read the content of a text OFF file; polygons become fans of triangles.

    Colours, normals, texture coordinates and comments are not looked at.

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
        Not a text OFF file, fewer or more rows than it announces, no facets, or a facet that refers to a
        vertex that does not exist.
    """
    rows = _rows(data)
    vertex_count, facet_count = _head(rows)
    refuse_too_many(facet_count)
    # A row takes two bytes at least: an absurd count is refused before anything is made of it.
    if 2 * (vertex_count + facet_count) > len(data):
        raise _too_short(vertex_count, facet_count)
    coordinates, triangles = array("d"), Triangles("OFF")
    for _ in range(vertex_count):
        number, row = next(rows, (0, b""))
        match = _THREE.match(row)
        if match is None:
            raise _bad_row(number, "a vertex of three numbers", vertex_count, facet_count)
        coordinates.extend(map(float, match.groups()))
    for _ in range(facet_count):
        number, row = next(rows, (0, b""))
        polygon = _polygon(row)
        if polygon is None:
            raise _bad_row(number, "a facet of three or more vertices", vertex_count, facet_count)
        triangles.add(polygon, number)
    _refuse_rest(rows)
    return RawMesh(points(coordinates), triangles.finish(vertex_count))


def _rows(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Lines that hold something besides a comment, with their numbers."""
    text = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    for number, raw in enumerate(io.BytesIO(text), start=1):
        row = raw.partition(b"#")[0].strip()
        if row:
            yield number, row


def _head(rows: Iterator[tuple[int, bytes]]) -> tuple[int, int]:
    """Read the numbers of vertices and facets; they may follow the keyword on its line."""
    _, first = next(rows, (0, b""))
    keyword, *counts = first.split(maxsplit=4) or [b""]
    if _KEYWORD.fullmatch(keyword) is None or counts[:1] == [b"BINARY"]:
        raise MeshError(
            "the first line is not 'OFF': this is not a text OFF file, choose another or export it again."
        )
    if not counts:
        counts = next(rows, (0, b""))[1].split(maxsplit=4)
    if len(counts) not in (2, 3) or not all(_COUNT.fullmatch(count) for count in counts):
        raise MeshError(
            "the OFF text does not announce its numbers of vertices, facets and edges: export it again."
        )
    return int(counts[0]), int(counts[1])


def _polygon(row: bytes) -> list[int] | None:
    tokens = row.split()
    if not tokens or _COUNT.fullmatch(tokens[0]) is None:
        return None
    size = int(tokens[0])
    corners = tokens[1 : 1 + size]
    if size < 3 or len(corners) != size or not all(_COUNT.fullmatch(corner) for corner in corners):
        return None
    return [int(corner) for corner in corners]


def _refuse_rest(rows: Iterator[tuple[int, bytes]]) -> None:
    rest = next(rows, None)
    if rest is not None:
        raise MeshError(
            f"line {rest[0]} of the OFF text follows the last facet that its header announces: it is damaged,"
            " export it again."
        )


def _bad_row(number: int, what: str, vertex_count: int, facet_count: int) -> MeshError:
    if not number:
        return _too_short(vertex_count, facet_count)
    return MeshError(f"line {number} of the OFF text is not {what}: it is damaged, export it again.")


def _too_short(vertex_count: int, facet_count: int) -> MeshError:
    return MeshError(
        f"the OFF header announces {vertex_count} vertices and {facet_count} facets, but the file ends before"
        " them: it is cut short, copy or export it again."
    )

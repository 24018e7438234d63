"""OFF, the object file format in text: vertices, then polygons that list them."""

import io
import re
from array import array
from collections.abc import Iterator
from contextlib import suppress
from itertools import islice

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.mesh.parse import (
    NUMBER,
    RawMesh,
    broken,
    decimal_points,
    plain_text,
    points,
    refuse_too_many,
)
from contactbench.pipeline.mesh.polygons import Polygons

# Texture, colour and normal columns follow x y z, so they can be left alone. 4OFF and nOFF have other vertices. Some
# files forget the blank between the keyword and the counts.
_KEYWORD = re.compile(rb"(?:ST|C|N){0,3}OFF(?=\s|\d|\Z)", re.I)
_THREE = re.compile(rb"(" + NUMBER + rb")" + (rb"\s+(" + NUMBER + rb")") * 2 + rb"(?!\S)")
_COUNT = re.compile(rb"\d{1,18}")
_NUMBERS = re.compile(rb"^[^\n#]+", re.M)


def read_off(data: bytes) -> RawMesh:
    """
    Read the content of a text OFF file; polygons become triangles.

    Colours, normals, texture coordinates, comments and what follows the last facet are not looked at.

    Raises
    ------
    MeshError
        Not a text OFF file, fewer rows or more facets than it announces, no facets, or a facet that refers to a
        vertex that does not exist.
    """
    text, notes = decimal_points(plain_text(data), _NUMBERS)
    try:
        return _read(text, notes)
    except MeshError:
        laid_out = _one_a_row(text)
        if laid_out is not None:
            # What is wrong with it is told of the lines of the file.
            with suppress(MeshError):
                return _read(laid_out, notes)
        raise


def _read(text: bytes, notes: tuple[str, ...]) -> RawMesh:
    rows = _rows(text)
    vertex_count, facet_count = _head(rows)
    refuse_too_many(facet_count)
    # A row takes two bytes at least: an absurd count is refused before anything is made of it.
    if 2 * (vertex_count + facet_count) > len(text):
        raise _too_short(vertex_count, facet_count)
    coordinates, polygons = array("d"), Polygons("OFF")
    for _ in range(vertex_count):
        number, row = next(rows, (0, b""))
        match = _THREE.match(row)
        if match is None:
            raise _bad_row(number, row, message("a vertex of three numbers"), vertex_count, facet_count)
        coordinates.extend(map(float, match.groups()))
    for _ in range(facet_count):
        number, row = next(rows, (0, b""))
        polygon = _polygon(row)
        if polygon is None:
            raise _bad_row(number, row, message("a facet that lists its vertices"), vertex_count, facet_count)
        polygons.add(polygon, number)
    number, row = next(rows, (0, b""))
    if _polygon(row):
        raise MeshError(
            f"line {arg(number)} of the OFF text is one facet more than its header announces: the file"
            " is damaged, export it again."
        )
    if number:
        notes += (
            message(f"Text after the last facet of the OFF file, from line {arg(number)}, was left out."),
        )
    vertices = points(coordinates)
    done = polygons.finish(vertices)
    return RawMesh(vertices, done.faces, notes=notes + done.notes)


def _rows(text: bytes) -> Iterator[tuple[int, bytes]]:
    """Lines that hold something besides a comment, with their numbers."""
    for number, raw in enumerate(io.BytesIO(text), start=1):
        row = raw.partition(b"#")[0].strip()
        if row:
            yield number, row


def _one_a_row(text: bytes) -> bytes | None:
    """Lay out numbers that stand on other lines than usual; None unless they are just as many as announced."""
    words = (word for _, row in _rows(text) for word in row.split())
    head = list(islice(words, 4))
    if len(head) < 4 or head[0].upper() != b"OFF" or not all(map(_COUNT.fullmatch, head[1:])):
        return None
    vertex_count, facet_count = int(head[1]), int(head[2])
    out = bytearray(b" ".join(head) + b"\n")
    for number in range(vertex_count + facet_count):
        size = 3
        if number >= vertex_count:
            first = next(words, b"")
            if _COUNT.fullmatch(first) is None:
                return None
            out += first + b" "
            size = int(first)
        row = list(islice(words, size))
        if len(row) != size:
            return None
        out += b" ".join(row) + b"\n"
    return bytes(out) if next(words, None) is None else None


def _head(rows: Iterator[tuple[int, bytes]]) -> tuple[int, int]:
    """Read the numbers of vertices and facets; they may follow the keyword on its line."""
    _, first = next(rows, (0, b""))
    keyword = _KEYWORD.match(first)
    if keyword is None:
        raise MeshError(
            "the first line is not 'OFF': this is not a text OFF file of points in space, choose another or export"
            " it again."
        )
    counts = first[keyword.end() :].split(maxsplit=4)
    if counts[:1] == [b"BINARY"]:
        raise MeshError(
            "this is a binary OFF file, but only text is supported: save it as text, or as binary PLY."
        )
    if not counts:
        counts = next(rows, (0, b""))[1].split(maxsplit=4)
    if len(counts) not in (2, 3) or not all(_COUNT.fullmatch(count) for count in counts):
        raise MeshError(
            "the OFF text does not state its numbers of vertices, facets and edges: export it again."
        )
    return int(counts[0]), int(counts[1])


def _polygon(row: bytes) -> list[int] | None:
    tokens = row.split()
    if not tokens or _COUNT.fullmatch(tokens[0]) is None:
        return None
    size = int(tokens[0])
    corners = tokens[1 : 1 + size]
    if len(corners) != size or not all(_COUNT.fullmatch(corner) for corner in corners):
        return None
    return [int(corner) for corner in corners]


def _bad_row(number: int, row: bytes, what: str, vertex_count: int, facet_count: int) -> MeshError:
    if not number:
        return _too_short(vertex_count, facet_count)
    return broken(
        message(f"line {arg(number)} of the OFF text"),
        row,
        message(f"line {arg(number)} of the OFF text is not {arg(what)}: it is damaged, export it again."),
    )


def _too_short(vertex_count: int, facet_count: int) -> MeshError:
    return MeshError(
        f"the OFF header announces {arg(vertex_count)} vertices and {arg(facet_count)} facets, but the file ends before"
        " them: it is cut short, copy or export it again."
    )

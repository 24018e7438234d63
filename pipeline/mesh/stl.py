"""STL, binary and text: facets that each bring their own three corners."""

import re
from array import array

import numpy as np

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.mesh.arrays import Longs
from contactbench.pipeline.mesh.parse import (
    NUMBER,
    RawMesh,
    broken,
    decimal_points,
    plain_text,
    points,
    refuse_too_many,
)

_HEADER, _RECORD = 84, 50

# Other bytes than facets, taken as numbers, are far larger than a part's.
_ALIKE = 100

# Normal and attribute bytes are left alone: the corners alone say what the facet is.
_FACET_RECORD = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

_VERTEX = rb"\s+vertex" + (rb"\s+(" + NUMBER + rb")") * 3
# The normal may be anything, or not there; usually the line ends after it.
_FACET = re.compile(
    rb"facet\b(?:[^\n]*\n|(?:\s+[^\s]+){0,4}?\s)\s*outer\s*loop"
    + _VERTEX * 3
    # Some programs write a colour there.
    + rb"\s+endloop(?:\s+color(?:\s+"
    + NUMBER
    + rb"){3,4})?\s+endfacet\b",
    re.I,
)
# A name may be any words, so its line is left out, unless the first facet stands on it too.
_NAME = re.compile(rb"^[ \t]*(end)?solid\b(?![^\n]*\bouter[ \t]*loop\b)[^\n]*", re.I | re.M)
_KEYWORD = re.compile(rb"\bfacet\b", re.I)
_NUMBERS = re.compile(rb"(?<=vertex)\b[^\n]*", re.I)


def read_stl(data: bytes) -> RawMesh:
    """
    Read the content of an STL file; several solids become one mesh.

    Raises
    ------
    MeshError
        Neither a complete binary nor a complete text STL.
    """
    # Many binary files begin with "solid" too, so the size decides before the word does.
    announced = _announced(data)
    end = _HEADER + _RECORD * announced
    if is_binary(data):
        return _read_binary(data, announced)
    text = plain_text(data)
    # Some programs fill the last block of a text with zeros.
    text = text.rstrip(b"\0\x1a \t\n") + b"\n"
    # Some programs leave out the line with the name.
    if text.lstrip()[:5].lower() in (b"solid", b"facet") and b"\0" not in text:
        return _read_text(text)
    whole, extra = divmod(len(data) - _HEADER, _RECORD)
    if announced == 0 and whole > 0 and extra == 0:
        note = message(
            f"The STL header announces no facets, but the file has room for {arg(whole)}; these were read."
        )
        return _read_binary(data, whole, (note,))
    if announced > 0 and end < len(data):
        more = _whole_facets(data, announced)
        if more:
            note = message(
                f"The STL header announces {arg(announced)} facets, but {arg(more)} more complete facets"
                " follow and were also read. Check that no part is missing."
            )
            return _read_binary(data, announced + more, (note,))
        note = message(
            f"Bytes after the last facet of the STL file were left out (bytes: {arg(len(data) - end)})."
        )
        return _read_binary(data, announced, (note,))
    raise _broken_binary(data)


def is_binary(data: bytes) -> bool:
    """Tell whether bytes are as many as the count that they hold makes a binary STL file."""
    return len(data) == _HEADER + _RECORD * _announced(data)


def _announced(data: bytes) -> int:
    return int.from_bytes(data[80:_HEADER], "little") if len(data) >= _HEADER else 0


def _whole_facets(data: bytes, announced: int) -> int:
    """Count the facets that follow those announced; 0 where what follows is something else, such as zeros or words."""
    count = (len(data) - _HEADER) // _RECORD
    with np.errstate(invalid="ignore", over="ignore"):
        corners = np.frombuffer(data, _FACET_RECORD, count, _HEADER)["corners"].astype(np.float64)
        known, more = np.split(corners, [announced])
        a, b, c = np.moveaxis(more, 1, 0)
        flat = ~(np.cross(b - a, c - a) != 0).any(axis=1)
        alike = np.abs(more) <= _ALIKE * np.abs(known).max()
    return len(more) if len(more) and alike.all() and not flat.all() else 0


def _read_binary(data: bytes, facet_count: int, notes: tuple[str, ...] = ()) -> RawMesh:
    if facet_count == 0:
        raise MeshError("the STL file holds no facets: export the part again.")
    refuse_too_many(facet_count)
    corners = np.frombuffer(data, _FACET_RECORD, facet_count, _HEADER)["corners"]
    # A signalling NaN warns when it is converted; it is refused, with its row, like every other NaN.
    with np.errstate(invalid="ignore"):
        vertices = corners.reshape(-1, 3).astype(np.float64)
    return RawMesh(vertices, _own_corners(facet_count), notes=notes)


def _own_corners(facet_count: int) -> Longs:
    return np.arange(3 * facet_count, dtype=np.int64).reshape(-1, 3)


def _broken_binary(data: bytes) -> MeshError:
    if len(data) < _HEADER:
        return MeshError(
            f"{arg(len(data))} bytes are too few for an STL file: it is cut short or is something else."
        )
    announced = _announced(data)
    if announced == 0:
        return MeshError("the STL file holds no facets: export the part again.")
    return MeshError(
        f"the STL header announces {arg(announced)} facets, which take {arg(_HEADER + _RECORD * announced)}"
        f" bytes, but the file has {arg(len(data))}: it is cut short or is not an STL file. Copy or export"
        " it again."
    )


def _read_text(text: bytes) -> RawMesh:
    text, notes = decimal_points(text, _NUMBERS)
    # Names go, and the line ends stay: what is wrong is said with its line.
    bare = _NAME.sub(lambda found: b"endsolid" if found.group(1) else b"solid", text)
    words = bare.lower()
    facets = words.count(b"facet") - words.count(b"endfacet")
    if not facets:
        raise MeshError("the STL text holds no facets: export the part again.")
    refuse_too_many(facets)
    coordinates = array("d")
    for facet in _FACET.finditer(bare):
        coordinates.extend(map(float, facet.groups()))
    ended = 2 * words.count(b"endsolid") >= words.count(b"solid")
    if len(coordinates) != 9 * facets:
        raise _broken_facet(bare, ended)
    if not ended:
        notes += (
            message(
                "The STL text ends before 'endsolid'. All its facets are complete, but if the file"
                " was cut short, some are missing."
            ),
        )
    return RawMesh(points(coordinates), _own_corners(facets), notes=notes)


def _broken_facet(text: bytes, ended: bool) -> MeshError:
    keywords = _KEYWORD.finditer(text)
    wrong = next((found for found in keywords if not _FACET.match(text, found.start())), None)
    if wrong is None:
        return MeshError("the STL text holds facets within facets: export the file again.")
    if not ended and next(keywords, None) is None:
        return MeshError("the STL text ends within a facet: it is cut short, copy or export it again.")
    line = text.count(b"\n", 0, wrong.start()) + 1
    end = text.lower().find(b"endfacet", wrong.end())
    return broken(
        message(f"the facet on line {arg(line)} of the STL text"),
        text[wrong.start() : end if end >= 0 else None],
        message(
            f"the facet on line {arg(line)} of the STL text must be three 'vertex x y z' between 'outer"
            " loop' and 'endloop': repair that facet or export the file again."
        ),
    )

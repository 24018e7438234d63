"""STL, binary and text: facets that each bring their own three corners."""

from __future__ import annotations

import re
from array import array
from typing import TYPE_CHECKING

import numpy as np

from pipeline.mesh.errors import MeshError
from pipeline.mesh.parse import NUMBER, RawMesh, points, refuse_too_many

if TYPE_CHECKING:
    import numpy.typing as npt

_HEADER, _RECORD = 84, 50

# Normal and attribute bytes are left alone: the corners alone say what the facet is.
_FACET_RECORD = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

_VERTEX = rb"vertex" + (rb"[ \t]+(" + NUMBER + rb")") * 3 + rb"[ \t]*\n\s*"
_FACET = re.compile(
    rb"facet\b[^\n]*\n\s*outer[ \t]+loop[ \t]*\n\s*" + _VERTEX * 3 + rb"endloop[ \t]*\n\s*endfacet\b", re.I
)
_SOLID = re.compile(rb"^[ \t]*solid\b", re.I | re.M)
_ENDSOLID = re.compile(rb"^[ \t]*endsolid\b", re.I | re.M)
_FACET_KEYWORD = re.compile(rb"(?<=\n)(?:[ \t]*)(facet)\b", re.I)


def read_stl(data: bytes) -> RawMesh:
    """
    Read the content of an STL file; several solids become one mesh.

    Parameters
    ----------
    data : bytes
        The whole file.

    Returns
    -------
    RawMesh
        Three vertices of its own per facet, as the format has it.

    Raises
    ------
    MeshError
        Neither a complete binary nor a complete text STL.
    """
    # Many binary files begin with "solid" too, so the size decides before the word does.
    if len(data) >= _HEADER:
        announced = int.from_bytes(data[80:_HEADER], "little")
        if len(data) == _HEADER + _RECORD * announced:
            return _read_binary(data, announced)
    if data.lstrip()[:5].lower() == b"solid" and b"\0" not in data:
        return _read_text(data)
    raise _broken_binary(data)


def _read_binary(data: bytes, facet_count: int) -> RawMesh:
    if facet_count == 0:
        raise MeshError("the STL file holds no facets: export the part again.")
    refuse_too_many(facet_count)
    corners = np.frombuffer(data, dtype=_FACET_RECORD, offset=_HEADER)["corners"]
    # A signalling NaN warns when it is converted; it is refused, with its row, like every other NaN.
    with np.errstate(invalid="ignore"):
        vertices = corners.reshape(-1, 3).astype(np.float64)
    return RawMesh(vertices, _own_corners(facet_count))


def _own_corners(facet_count: int) -> npt.NDArray[np.int64]:
    return np.arange(3 * facet_count, dtype=np.int64).reshape(-1, 3)


def _broken_binary(data: bytes) -> MeshError:
    if len(data) < _HEADER:
        return MeshError(
            f"{len(data)} bytes are too few for an STL file: it is cut short or is something else."
        )
    announced = int.from_bytes(data[80:_HEADER], "little")
    expected = _HEADER + _RECORD * announced
    fault = "is cut short" if len(data) < expected else "has bytes after its end"
    return MeshError(
        f"the STL header announces {announced} facets, which take {expected} bytes, but the file has"
        f" {len(data)}: it {fault} or is not an STL file. Copy or export it again."
    )


def _read_text(data: bytes) -> RawMesh:
    text = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    starts, ends = (sum(1 for _ in word.finditer(text)) for word in (_SOLID, _ENDSOLID))
    if ends < starts:
        raise MeshError("the STL text ends before 'endsolid': it is cut short, copy or export it again.")
    facets = sum(1 for _ in _FACET_KEYWORD.finditer(text))
    if not facets:
        raise MeshError("the STL text holds no facets: export the part again.")
    refuse_too_many(facets)
    coordinates = array("d")
    for facet in _FACET.finditer(text):
        coordinates.extend(map(float, facet.groups()))
    if len(coordinates) != 9 * facets:
        raise _broken_facet(text)
    return RawMesh(points(coordinates), _own_corners(facets))


def _broken_facet(text: bytes) -> MeshError:
    for keyword in _FACET_KEYWORD.finditer(text):
        if not _FACET.match(text, keyword.start(1)):
            line = text.count(b"\n", 0, keyword.start(1)) + 1
            return MeshError(
                f"the facet on line {line} of the STL text is not three 'vertex x y z' lines between"
                " 'outer loop' and 'endloop': repair that line or export the file again."
            )
    return MeshError("the STL text holds facets outside their lines: export the file again.")

"""STL, binary and text: what trimesh would misread is refused first."""

from __future__ import annotations

import re

from pipeline.mesh.errors import MeshError
from pipeline.mesh.parse import NUMBER, RawMesh, parse

_HEADER, _RECORD = 84, 50

_VERTEX = rb"vertex[ \t]+" + NUMBER + (rb"[ \t]+" + NUMBER) * 2 + rb"[ \t]*\n\s*"
_FACET = re.compile(
    rb"facet\b[^\n]*\n\s*outer[ \t]+loop[ \t]*\n\s*((?:" + _VERTEX + rb"){3})endloop[ \t]*\n\s*endfacet\b",
    re.I,
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
    return parse(data, "stl", facet_count)


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
    starts, ends = len(_SOLID.findall(text)), len(_ENDSOLID.findall(text))
    if ends < starts:
        raise MeshError("the STL text ends before 'endsolid': it is cut short, copy or export it again.")
    facets = len(_FACET_KEYWORD.findall(text))
    if not facets:
        raise MeshError("the STL text holds no facets: export the part again.")
    loops = _FACET.findall(text)
    if len(loops) != facets:
        raise _broken_facet(text)
    # trimesh looks for the words of the format inside the names of solids too, so it gets none of them.
    return parse(b"solid\n" + b"".join(loops) + b"endsolid\n", "stl", len(loops))


def _broken_facet(text: bytes) -> MeshError:
    for keyword in _FACET_KEYWORD.finditer(text):
        if not _FACET.match(text, keyword.start(1)):
            line = text.count(b"\n", 0, keyword.start(1)) + 1
            return MeshError(
                f"the facet on line {line} of the STL text is not three 'vertex x y z' lines between"
                " 'outer loop' and 'endloop': repair that line or export the file again."
            )
    return MeshError("the STL text holds facets outside their lines: export the file again.")

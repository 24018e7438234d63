"""Wavefront OBJ: only positions and polygons count; everything else in the file is left alone."""

import io
import re
from array import array

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.mesh.parse import NUMBER, RawMesh, broken, decimal_points, plain_text, points
from contactbench.pipeline.mesh.polygons import Polygons

_POSITION = re.compile(rb"v" + (rb"\s+(" + NUMBER + rb")") * 3 + rb"(?!\S)")
_CORNER = re.compile(rb"([+-]?\d{1,18})(?:/[^\s/]*){0,2}")
_NUMBERS = re.compile(rb"^[ \t]*v[ \t][^\n#]*", re.M)


def read_obj(data: bytes) -> RawMesh:
    """
    Read the content of an OBJ file; objects and groups become one mesh, polygons become triangles.

    Materials, textures, normals, colours, weights, lines, points and files that the text refers to are not looked
    at.

    Raises
    ------
    MeshError
        No facets, a vertex that is not three numbers, or a facet that refers to a vertex that does not exist.
    """
    coordinates = array("d")
    polygons = Polygons("OBJ")
    text, notes = decimal_points(plain_text(data), _NUMBERS)
    # A stream gives one line at a time; a list of short lines takes ten times their bytes.
    for number, raw in enumerate(io.BytesIO(text.replace(b"\\\n", b" ")), start=1):
        line = raw.partition(b"#")[0].strip()
        word = line[:2].rstrip()
        if word == b"v":
            coordinates.extend(map(float, _position(line, number)))
        elif word == b"f":
            polygons.add(_polygon(line, number, len(coordinates) // 3), number)
    vertices = points(coordinates)
    done = polygons.finish(vertices)
    return RawMesh(vertices, done.faces, notes=notes + done.notes)


def _position(line: bytes, number: int) -> tuple[bytes, ...]:
    match = _POSITION.match(line)
    if match is None:
        raise broken(
            message(f"line {arg(number)} of the OBJ text"),
            line,
            message(
                f"line {arg(number)} of the OBJ text is a vertex without three numbers: export the file again."
            ),
        )
    return match.groups()


def _polygon(line: bytes, number: int, vertices_so_far: int) -> list[int]:
    matches = [_CORNER.fullmatch(token) for token in line.split()[1:]]
    polygon = [int(match.group(1)) for match in matches if match]
    if len(polygon) != len(matches) or not polygon or 0 in polygon:
        raise MeshError(
            f"line {arg(number)} of the OBJ text is a facet without valid vertex numbers (counted from"
            " 1): repair that line or export the file again."
        )
    # A negative index counts back from the vertex read last, not from the end of the file.
    return [index - 1 if index > 0 else vertices_so_far + index for index in polygon]

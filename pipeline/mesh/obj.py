"""Wavefront OBJ: only positions and polygons count; everything else in the file is left alone."""

from __future__ import annotations

import re
from itertools import pairwise

from pipeline.mesh.errors import MeshError
from pipeline.mesh.parse import NUMBER, RawMesh, parse

_POSITION = re.compile(rb"v" + (rb"\s+" + NUMBER) * 3 + rb"(?!\S)")
_CORNER = re.compile(rb"([+-]?\d{1,18})(?:/[^\s/]*){0,2}")


def read_obj(data: bytes) -> RawMesh:
    """
    Read the content of an OBJ file; objects and groups become one mesh, polygons become fans of triangles.

    Materials, textures, normals and files that the text refers to are not looked at.

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
        No facets, a vertex that is not three numbers, or a facet that refers to a vertex that does not exist.
    """
    positions: list[bytes] = []
    corners: list[tuple[int, int, int]] = []
    where: list[int] = []
    text = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n").replace(b"\\\n", b" ")
    for number, raw in enumerate(text.split(b"\n"), start=1):
        line = raw.partition(b"#")[0].strip()
        word = line[:2].rstrip()
        if word == b"v":
            positions.append(_position(line, number))
        elif word == b"f":
            fan = _fan(line, number, len(positions))
            corners.extend(fan)
            where.extend([number] * len(fan))
    if not corners:
        raise MeshError("the OBJ text holds no facets ('f' lines): export the part again, as a surface.")
    _refuse_missing(corners, where, len(positions))
    return _parse(positions, corners)


def _position(line: bytes, number: int) -> bytes:
    match = _POSITION.match(line)
    if match is None:
        raise MeshError(
            f"line {number} of the OBJ text is a vertex without three numbers: export the file again."
        )
    return match.group()


def _fan(line: bytes, number: int, vertices_so_far: int) -> list[tuple[int, int, int]]:
    matches = [_CORNER.fullmatch(token) for token in line.split()[1:]]
    polygon = [int(match.group(1)) for match in matches if match]
    if len(polygon) != len(matches) or len(polygon) < 3 or 0 in polygon:
        raise MeshError(
            f"line {number} of the OBJ text is a facet that does not list three or more vertices, counted"
            " from 1: repair that line or export the file again."
        )
    # A negative index counts back from the vertex read last; trimesh counts from the end of the file instead.
    absolute = [index if index > 0 else vertices_so_far + 1 + index for index in polygon]
    return [(absolute[0], *pair) for pair in pairwise(absolute[1:])]


def _refuse_missing(corners: list[tuple[int, int, int]], where: list[int], vertex_count: int) -> None:
    for triangle, number in zip(corners, where, strict=True):
        if min(triangle) < 1 or max(triangle) > vertex_count:
            raise MeshError(
                f"line {number} of the OBJ text is a facet that refers to a vertex that is not there (the"
                f" file has {vertex_count}): it is damaged or cut short, export it again."
            )


def _parse(positions: list[bytes], corners: list[tuple[int, int, int]]) -> RawMesh:
    # Names, groups and texture indices change how trimesh orders and splits a mesh: it sees none of them.
    facets = [b"f %d %d %d" % triangle for triangle in corners]
    return parse(b"\n".join((*positions, *facets)) + b"\n", "obj", len(corners))

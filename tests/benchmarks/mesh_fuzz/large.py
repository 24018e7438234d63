"""Large mesh files whose counts are right: what a reader cannot refuse early, and archives that unpack to more."""

from __future__ import annotations

import io
import json
import struct
import zipfile
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import random

# Most stay small enough that ten thousand cases take minutes, not hours.
_USUAL, _RARE = 500_000, 2_000_000
_PLY = (
    "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
    "element face {}\nproperty list {} {} vertex_indices\nend_header\n"
)
_CORE = b'<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'


def swollen(name: str, chance: random.Random) -> tuple[str, bytes]:
    """Make a large file of a format."""
    size = chance.randrange(_USUAL // 5, _USUAL if chance.random() < 0.9 else _RARE)
    match name:
        case "binary.stl":
            facets = size // 50
            body = b"\0" * (50 * facets) if chance.random() < 0.3 else chance.randbytes(50) * facets
            return "large: one facet many times", b"\0" * 80 + struct.pack("<I", facets) + body
        case "text.stl":
            facet = b"facet\nouter loop\nvertex 0 0 0\nvertex 90 0 0\nvertex 0 90 %d\nendloop\nendfacet\n"
            few = [facet % chance.randrange(99) for _ in range(50)]
            return "large: few facets many times", b"solid\n" + b"".join(few) * (size // 4000) + b"endsolid\n"
        case "little.ply" | "big.ply":
            return _large_binary_ply(name, size, chance)
        case "mixed.ply":
            return _large_mixed_ply(size, chance)
        case "text.ply":
            return _large_text_ply(size, chance)
        case "mesh.obj":
            return _large_obj(size, chance)
        case "polygons.obj":
            return _large_polygons(size, chance)
        case "mesh.glb":
            return _large_glb(size, chance)
        case "mesh.off":
            rows = size // 8
            head = b"OFF\n9 %d 0\n" % rows + _corners(b"")
            return "large: one facet many times", head + b"3 0 1 2\n" * rows
        case _:
            return _large_archive(size, chance)


def archive(model: bytes) -> bytes:
    """Pack a model as a 3MF file."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as packed:
        packed.writestr(zipfile.ZipInfo("3D/3dmodel.model"), model, zipfile.ZIP_DEFLATED)
    return out.getvalue()


def glb(text: bytes, content: bytes) -> bytes:
    """Pack a scene and its numbers as a GLB file."""
    chunks = (
        struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(content), b"BIN\0") + content
    )
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def _corners(word: bytes) -> bytes:
    """Nine vertices whose facets all have an area, a row each."""
    return b"".join(b"%s%d %d %d\n" % (word, i, i * i, i**3 // 10) for i in range(9))


def _large_binary_ply(name: str, size: int, chance: random.Random) -> tuple[str, bytes]:
    order, kind = ("<", "binary_little_endian") if name == "little.ply" else (">", "binary_big_endian")
    corners = [struct.pack(order + "3f", i, i * i, i**3 // 10) for i in range(9)]
    if chance.random() < 0.5:
        rows = size // 13
        head = _PLY.format(kind, 9, rows, "uchar", "int").encode()
        return "large: one facet many times", head + b"".join(corners) + struct.pack(
            order + "B3i", 3, 0, 1, 2
        ) * rows
    rows = size // 10
    head = _PLY.format(kind, 9, rows, "uchar", "uchar").encode()
    row = b"\x09" + bytes(range(9))
    return "large: polygons of a byte per corner", head + b"".join(corners) + row * rows


def _large_mixed_ply(size: int, chance: random.Random) -> tuple[str, bytes]:
    """Rows that differ in length, so that each is looked for."""
    points = b"".join(struct.pack("<3f", i, i * i, i**3 // 10) for i in range(9))
    if chance.random() < 0.5:
        rows = [b"\x03\0\1\2", b"\x04\0\1\2\3"] * (size // 9)
        kind = "large: triangles and quads of a byte per corner"
    else:
        rows = [bytes([3 + i % 250, *(k % 9 for k in range(3 + i % 250))]) for i in range(size // 128)]
        kind = "large: polygons of many lengths"
    head = _PLY.format("binary_little_endian", 9, len(rows), "uchar", "uchar").encode()
    return kind, head + points + b"".join(rows)


def _large_polygons(size: int, chance: random.Random) -> tuple[str, bytes]:
    """Polygons that no fan covers: many small ones, or one that crosses itself everywhere."""
    if chance.random() < 0.5:
        notch = b"v 0 0 0\nv 40 0 0\nv 10 10 0\nv 0 40 0\n" + b"f 2 3 4 1\n" * (size // 10)
        return "large: polygons that are not convex", notch
    many = size // 20
    points = b"".join(b"v %d %d 0\n" % (i * i * 7919 % 1009, i * i * 104729 % 1013) for i in range(many))
    return "large: one polygon that crosses itself", points + b"f " + b" ".join(
        b"%d" % (i + 1) for i in range(many)
    )


def _large_glb(size: int, chance: random.Random) -> tuple[str, bytes]:
    """Little data that many nodes, pieces or overlapping rows make much of."""
    content = b"".join(struct.pack("<3f", i, i * i, i**3 // 10) for i in range(9)) + bytes(size)
    count, stride, nodes, pieces = 9, 12, 1, 1
    match chance.randrange(4):
        case 0:
            kind, nodes = "large: one mesh at many nodes", size // 100
        case 1:
            kind, nodes, pieces = "large: many nodes of many pieces", 5000, size // 1000
        case 2:
            kind, count, stride = "large: rows that overlap", size // 4, 4
        case _:
            kind, count = "large: one spot", 9 + size // 12
    scene = {
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0}] * nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5}] * pieces}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(content), "byteStride": stride}],
        "buffers": [{"byteLength": len(content)}],
    }
    return kind, glb(json.dumps(scene).encode(), content)


def _large_text_ply(size: int, chance: random.Random) -> tuple[str, bytes]:
    match chance.randrange(4):
        case 0:
            rows = size // 6
            head = _PLY.format("ascii", rows, 1, "uchar", "int").encode()
            return "large: one vertex many times", head + b"0 0 0\n" * rows + b"3 0 1 2\n"
        case 1:
            rows = size // 8
            head = _PLY.format("ascii", 9, rows, "uchar", "int").encode()
            return "large: one facet many times", head + _corners(b"") + b"3 0 1 2\n" * rows
        case 2:
            rows = size // 20
            head = _PLY.format("ascii", 9, rows, "uchar", "int").encode()
            return "large: polygons", head + _corners(b"") + b"9 0 1 2 3 4 5 6 7 8\n" * rows
        case _:
            return "large: header", b"ply\nformat ascii 1.0\nelement a 1\n" + b"property int b\n" * (
                size // 15
            )


def _large_obj(size: int, chance: random.Random) -> tuple[str, bytes]:
    match chance.randrange(4):
        case 0:
            return "large: one vertex many times", b"v 0 0 0\n" * (size // 8) + b"f 1 2 3\n"
        case 1:
            return "large: one facet many times", _corners(b"v ") + b"f 1 2 3\n" * (size // 8)
        case 2:
            return "large: polygons", _corners(b"v ") + b"f 1 2 3 4 5 6 7 8 9\n" * (size // 20)
        case _:
            return "large: one polygon", _corners(b"v ") + b"f" + b" 1 2 3" * (size // 6) + b"\n"


def _large_archive(size: int, chance: random.Random) -> tuple[str, bytes]:
    size = 20 * size
    match chance.randrange(5):
        case 0:
            return "archive of blanks", archive(_CORE + b" " * size + b"</model>")
        case 1:
            return "archive of zeros", archive(b"\0" * size)
        case 2:
            filler = b'<vertex x="0" y="0" z="0"/>'
            return "archive of one vertex", archive(
                _CORE + b'<object id="1">' + filler * (size // len(filler) // 8)
            )
        case 3:
            entities = b'<!DOCTYPE a [<!ENTITY a "aaaaaaaaaa">' + b"".join(
                b'<!ENTITY %c "%s">' % (98 + i, b"&%c;" % (97 + i) * 10) for i in range(9)
            )
            return "archive of entities", archive(entities + b"]>" + _CORE + b"&j;</model>")
        case _:
            nested = b"".join(
                b'<object id="%d"><components>%s</components></object>'
                % (i, b'<component objectid="%d"/>' % (i + 1) * 9)
                for i in range(1, 30)
            )
            return "archive of copies of copies", archive(
                _CORE + nested + b'<build><item objectid="1"/></build></model>'
            )

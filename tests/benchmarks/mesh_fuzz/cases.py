"""Mesh files with something wrong in them: sound files of every format, changed in the ways files get changed.

A case is a number: the same seed and number give the same bytes.
"""

from __future__ import annotations

import io
import json
import random
import struct
import zipfile
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.mesh_fuzz.large import archive, glb, swollen

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt

# Numbers and words that are right in one place and wrong in most.
PIECES = (
    b"0", b"-1", b"3", b"4", b"9999999999", b"4294967295", b"1e308", b"1e-320", b"nan", b"inf", b"\n", b"\r",
    b" ", b"#", b"/", b"vertex", b"facet", b"endsolid", b"solid", b"element", b"property", b"list", b"end_header",
    b"f ", b"v ", b"OFF", b"<", b"/>", b"&", b"\0", b"\xff" * 4, b"\0" * 4, b"\x7f\xf0\0\0", b"\0\0\xc0\x7f", b"uint",
    b"int64", b"ascii", b"binary_big_endian", b"\\\n", b",", b"null", b"[]", b"{}", b"[0]", b'"mode":5,',
)  # fmt: skip

_LARGE = 1_000_000
_LARGE_SHARE = 0.02


@dataclass(frozen=True)
class FuzzCase:
    """One hostile file."""

    suffix: str  # What its name ends in
    kind: str  # What was done to it
    data: bytes


def make_case(seed: int, number: int) -> FuzzCase:
    """Make one hostile file."""
    chance = random.Random(f"{seed}:{number}")  # noqa: S311 - no secret
    files = sound_files()
    name = chance.choice(sorted(files))
    kind = chance.choices(list(_CHANGES), weights=[weight for weight, _ in _CHANGES.values()])[0]
    _, change = _CHANGES[kind]
    suffix = "." + name.rpartition(".")[2]
    if chance.random() < _LARGE_SHARE:
        kind, data = swollen(name, chance)
        return FuzzCase(suffix, kind, data)
    if suffix == ".3mf" and chance.random() < 0.8:
        # A changed byte of an archive fails its checksum: most changes go inside.
        return FuzzCase(suffix, kind, archive(change(_model(files[name]), chance)))
    return FuzzCase(suffix, kind, change(files[name], chance))


@cache
def sound_files() -> dict[str, bytes]:
    """Sound files of every format, by a name that ends in the suffix; a ball of 48 facets."""
    vertices, faces = _ball()
    polygons = _polygons(faces)
    return {
        "binary.stl": _binary_stl(vertices, faces),
        "text.stl": _text_stl(vertices, faces),
        "little.ply": _binary_ply(vertices, faces, "<"),
        "big.ply": _binary_ply(vertices, faces, ">"),
        "text.ply": _text_ply(vertices, faces),
        "mixed.ply": _mixed_ply(vertices, polygons),
        "mesh.obj": _obj(vertices, faces),
        "polygons.obj": _polygon_obj(vertices, polygons),
        "mesh.off": _off(vertices, faces),
        "mesh.3mf": archive(_xml(vertices, faces)),
        "mesh.glb": _glb(vertices, faces),
    }


def _model(data: bytes) -> bytes:
    with zipfile.ZipFile(io.BytesIO(data)) as packed:
        return packed.read("3D/3dmodel.model")


# ---- sound files -------------------------------------------------------------------------------------


def _ball() -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    rings, around = 4, 8
    polar, turn = np.pi * np.arange(1, rings) / rings, 2 * np.pi * np.arange(around) / around
    p, t = np.meshgrid(polar, turn, indexing="ij")
    ring = np.stack((np.sin(p) * np.cos(t), np.sin(p) * np.sin(t), np.cos(p)), axis=-1).reshape(-1, 3)
    vertices = np.round(np.vstack(([[0, 0, 1.0]], ring, [[0, 0, -1.0]])) * 2048) / 50
    faces = []
    for k in range(around):
        after = (k + 1) % around
        faces.append((0, 1 + k, 1 + after))
        for r in range(rings - 2):
            a, b = 1 + r * around + k, 1 + r * around + after
            faces += [(a, a + around, b), (b, a + around, b + around)]
        last = 1 + (rings - 2) * around
        faces.append((last + k, len(vertices) - 1, last + after))
    return vertices, np.array(faces)


def _polygons(faces: npt.NDArray[np.int64]) -> list[list[int]]:
    """Join facets two by two to quads that are not flat, and leave every third pair apart."""
    joined: list[list[int]] = []
    for pair, (one, two) in enumerate(zip(faces[::2].tolist(), faces[1::2].tolist(), strict=True)):
        shared = [corner for corner in one if corner in two]
        if pair % 3 == 0 or len(shared) != 2:
            joined += [one, two]
            continue
        (tip,) = set(two) - set(shared)
        at = next(k for k in range(3) if {one[k], one[(k + 1) % 3]} == set(shared))
        joined.append([*one[: at + 1], tip, *one[at + 1 :]])
    return joined


def _binary_stl(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> bytes:
    rows = np.zeros(len(faces), [("n", "<f4", (3,)), ("c", "<f4", (3, 3)), ("a", "<u2")])
    rows["c"] = vertices[faces]
    return b"sound".ljust(80, b"\0") + struct.pack("<I", len(faces)) + rows.tobytes()


def _text_stl(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> bytes:
    facets = [
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x:g} {y:g} {z:g}\n" for x, y, z in corners)
        + "endloop\nendfacet\n"
        for corners in vertices[faces].tolist()
    ]
    return ("solid sound\n" + "".join(facets) + "endsolid sound\n").encode()


_PLY = (
    "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
    "element face {}\nproperty list uchar int vertex_indices\nproperty int region\nend_header\n"
)


def _binary_ply(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64], order: str) -> bytes:
    rows = np.zeros(len(faces), [("n", "u1"), ("i", order + "i4", (3,)), ("r", order + "i4")])
    rows["n"], rows["i"], rows["r"] = 3, faces, np.arange(len(faces)) % 3
    kind = "binary_little_endian" if order == "<" else "binary_big_endian"
    head = _PLY.format(kind, len(vertices), len(faces)).encode()
    return head + vertices.astype(order + "f4").tobytes() + rows.tobytes()


def _mixed_ply(vertices: npt.NDArray[np.float64], polygons: list[list[int]]) -> bytes:
    head = _PLY.format("binary_little_endian", len(vertices), len(polygons)).encode()
    rows = [struct.pack(f"<B{len(p) + 1}i", len(p), *p, k % 3) for k, p in enumerate(polygons)]
    return head + vertices.astype("<f4").tobytes() + b"".join(rows)


def _text_ply(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> bytes:
    head = _PLY.format("ascii", len(vertices), len(faces))
    return (head + _rows(vertices, "{:g} {:g} {:g}\n") + _rows(faces, "3 {} {} {} 1\n")).encode()


def _obj(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> bytes:
    return (
        "# sound\n" + _rows(vertices, "v {:g} {:g} {:g}\n") + _rows(faces + 1, "f {} {}/1 {}//2\n")
    ).encode()


def _polygon_obj(vertices: npt.NDArray[np.float64], polygons: list[list[int]]) -> bytes:
    rows = ["f " + " ".join(str(corner + 1) for corner in polygon) + "\n" for polygon in polygons]
    return (_rows(vertices, "v {:g} {:g} {:g}\n") + "".join(rows)).encode()


def _glb(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> bytes:
    content = faces.astype("<u2").tobytes() + vertices.astype("<f4").tobytes()
    scene = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1], "translation": [0, 0, 9]}, {"mesh": 0, "scale": [1, 1, 1]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0, "mode": 4}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5123, "count": faces.size, "type": "SCALAR"},
            {"bufferView": 1, "componentType": 5126, "count": len(vertices), "type": "VEC3"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 2 * faces.size},
            {"buffer": 0, "byteOffset": 2 * faces.size, "byteLength": 12 * len(vertices)},
        ],
        "buffers": [{"byteLength": len(content)}],
    }
    text = json.dumps(scene).encode()
    return glb(text + b" " * (-len(text) % 4), content)


def _off(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> bytes:
    head = f"OFF\n{len(vertices)} {len(faces)} 0\n"
    return (head + _rows(vertices, "{:g} {:g} {:g}\n") + _rows(faces, "3 {} {} {}\n")).encode()


def _xml(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> bytes:
    core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<model unit="millimeter" xmlns="{core}"><resources>\n'
        '<object id="1" type="model"><mesh><vertices>\n'
        + _rows(vertices, '<vertex x="{:g}" y="{:g}" z="{:g}"/>\n')
        + "</vertices><triangles>\n"
        + _rows(faces, '<triangle v1="{}" v2="{}" v3="{}"/>\n')
        + '</triangles></mesh></object>\n<object id="2"><components>\n'
        '<component objectid="1" transform="1 0 0 0 1 0 0 0 1 0 0 9"/></components></object></resources>\n'
        '<build><item objectid="2"/></build></model>\n'
    ).encode()


def _rows(values: npt.NDArray[np.float64] | npt.NDArray[np.int64], row: str) -> str:
    return "".join(row.format(*line) for line in values.tolist())


# ---- what is done to them ----------------------------------------------------------------------------


def _cut(data: bytes, chance: random.Random) -> bytes:
    return data[: chance.randrange(len(data))]


def _flip(data: bytes, chance: random.Random) -> bytes:
    changed = bytearray(data)
    for _ in range(chance.choice([1, 1, 2, 8, 64])):
        changed[chance.randrange(len(changed))] ^= 1 << chance.randrange(8)
    return bytes(changed)


def _edit(data: bytes, chance: random.Random) -> bytes:
    """Replace, insert, double and remove pieces."""
    changed = bytearray(data)
    for _ in range(chance.choice([1, 1, 1, 2, 5, 20])):
        at = chance.randrange(len(changed) + 1)
        to = min(len(changed), at + chance.choice([0, 1, 1, 2, 4, 13, 50]))
        match chance.randrange(4):
            case 0:
                changed[at:to] = b""
            case 1:
                changed[at:to] = chance.choice(PIECES)
            case 2:
                changed[at:to] = chance.randbytes(to - at)
            case _:
                changed[at:at] = changed[at:to]
    return bytes(changed)


def _number(data: bytes, chance: random.Random) -> bytes:
    """Give one number of a text, or four bytes of a binary file, a value that breaks something."""
    if b"\0" in data:
        at = chance.randrange(max(1, len(data) - 4))
        # Numbers stand on multiples of two in every binary format; counts stand at the front more often.
        at = chance.choice([at & ~1, at, min(80, at)])
        value = chance.choice([b"\xff" * 4, b"\xff\xff\xff\x7f", b"\0\0\xc0\x7f", b"\0\0\x80\x7f", b"\0" * 4])
        return data[:at] + value + data[at + 4 :]
    places = [i for i, byte in enumerate(data) if byte in b"0123456789"]
    at = chance.choice(places) if places else 0
    value = chance.choice(
        [b"nan", b"-1", b"inf", b"1e999", b"1e9", b"99999999999", b"0", b"1e-300", b"2147483648"]
    )
    return data[:at] + value + data[at + 1 :]


def _double(data: bytes, chance: random.Random) -> bytes:
    at, to = sorted(chance.randrange(len(data) + 1) for _ in range(2))
    return data[:to] + data[at:to] * chance.choice([1, 2, 10]) + data[to:]


def _splice(data: bytes, chance: random.Random) -> bytes:
    files = sound_files()
    other = files[chance.choice(sorted(files))]
    return data[: chance.randrange(len(data))] + other[chance.randrange(len(other)) :]


def _swap(_: bytes, chance: random.Random) -> bytes:
    """Another format under this suffix."""
    files = sound_files()
    return files[chance.choice(sorted(files))]


def _noise(_: bytes, chance: random.Random) -> bytes:
    return chance.randbytes(chance.choice([1, 83, 84, 134, 5000]))


def _lines(data: bytes, chance: random.Random) -> bytes:
    """Shuffle lines, or drop half of them."""
    lines = data.splitlines(keepends=True)
    if chance.random() < 0.5:
        chance.shuffle(lines)
        return b"".join(lines)
    return b"".join(line for line in lines if chance.random() < 0.5)


def _swell(data: bytes, chance: random.Random) -> bytes:
    """Megabytes of one thing: zeros, blanks, digits, one line, or a row of a polygon."""
    size = chance.randrange(_LARGE // 4, 2 * _LARGE)
    at, to = sorted(chance.randrange(len(data) + 1) for _ in range(2))
    line = data[data.rfind(b"\n", 0, at) + 1 : data.find(b"\n", at) + 1] or b"\n"
    what = chance.choice(
        [b"\0", b" ", b"\n", b"1", b"1 ", b"f 1 2 3\n", line, data[at:to] or b"\t", b"3 0 1 2\n"]
    )
    return data[:at] + what * (size // len(what)) + data[at:]


_CHANGES: dict[str, tuple[int, Callable[[bytes, random.Random], bytes]]] = {
    "cut short": (10, _cut),
    "bits flipped": (15, _flip),
    "pieces changed": (30, _edit),
    "bad number": (20, _number),
    "chunk repeated": (8, _double),
    "two files spliced": (6, _splice),
    "lines shuffled": (6, _lines),
    "wrong suffix": (2, _swap),
    "random bytes": (2, _noise),
    "megabytes of one thing": (1, _swell),
}

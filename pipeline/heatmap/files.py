"""Heatmaps as meshes: PLY and binary glTF with the value at every vertex."""

import json
import struct
from typing import Any

import numpy as np

from contactbench import __version__
from contactbench.pipeline.heatmap.heatmap import Heatmap, colours, linear, vertex_normals

UNKNOWN = -1.0  # stands for "no data" in glTF, which has no NaN; no quantity is negative

_FLOAT, _SHORT, _INTEGER = 5126, 5123, 5125
_VERTICES, _INDICES = 34962, 34963
_Y_UP = [
    -(0.5**0.5),
    0.0,
    0.0,
    0.5**0.5,
]  # glTF's y is up, the sensor's z: turned in the node, not in the numbers


def encode_ply(heatmap: Heatmap) -> bytes:
    """
    Return a heatmap as binary PLY: metres in S, vertex properties ``scalar`` (NaN: no data), red, green, blue.

    Quantity, unit and bandwidth are in comments.
    """
    probe = heatmap.probe
    rows = np.empty(
        len(probe.vertices), dtype=[("at", "<f8", (3,)), ("scalar", "<f4"), ("colour", "u1", (3,))]
    )
    rows["at"], rows["scalar"] = probe.vertices, heatmap.values
    rows["colour"] = np.rint(255 * colours(heatmap))
    faces = np.empty(len(probe.faces), dtype=[("count", "u1"), ("corners", "<i4", (3,))])
    faces["count"], faces["corners"] = 3, probe.faces
    unit = heatmap.unit.replace("²", "2").replace("·", "*")
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment metres, sensor frame S\n"
        f"comment scalar: {heatmap.title}, {unit}, bandwidth {1e3 * heatmap.bandwidth:g} mm; nan: no data\n"
        f"element vertex {len(rows)}\nproperty double x\nproperty double y\nproperty double z\nproperty float scalar\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    return header.encode("ascii") + rows.tobytes() + faces.tobytes()


def encode_glb(heatmap: Heatmap) -> bytes:
    """
    Return a heatmap as binary glTF 2.0, metres in S under a node that turns z up.

    The attribute ``_SCALAR`` holds the value (-1: no data), ``COLOR_0`` its colour; ``extras`` of the mesh say what
    it is.
    """
    probe = heatmap.probe
    shade = np.rint(65535 * linear(colours(heatmap))).astype("<u2")
    opaque = np.column_stack([shade, np.full(len(shade), 65535, dtype="<u2")])
    scalar = np.where(heatmap.known, heatmap.values, UNKNOWN)
    parts: list[tuple[np.ndarray[Any, Any], dict[str, Any], int]] = [
        (probe.vertices.astype("<f4"), {"componentType": _FLOAT, "type": "VEC3"}, _VERTICES),
        (vertex_normals(probe).astype("<f4"), {"componentType": _FLOAT, "type": "VEC3"}, _VERTICES),
        (opaque, {"componentType": _SHORT, "type": "VEC4", "normalized": True}, _VERTICES),
        (scalar.astype("<f4"), {"componentType": _FLOAT, "type": "SCALAR"}, _VERTICES),
        (probe.faces.astype("<u4"), {"componentType": _INTEGER, "type": "SCALAR"}, _INDICES),
    ]
    body, views, accessors = b"", [], []
    for number, (array, kind, target) in enumerate(parts):
        data = array.tobytes()
        views.append({"buffer": 0, "byteOffset": len(body), "byteLength": len(data), "target": target})
        accessors.append({"bufferView": number, "count": _count(array, kind), **kind})
        body += data  # each part is a multiple of four bytes long, as the format asks
    for number in (0, 3):
        table = parts[number][0].reshape(len(scalar), -1)
        accessors[number] |= {"min": table.min(axis=0).tolist(), "max": table.max(axis=0).tolist()}
    return _glb(_document(heatmap, views, accessors, len(body)), body)


def _count(array: np.ndarray[Any, Any], kind: dict[str, Any]) -> int:
    return array.size if kind["type"] == "SCALAR" else len(array)


def _document(
    heatmap: Heatmap, views: list[dict[str, Any]], accessors: list[dict[str, Any]], length: int
) -> dict[str, Any]:
    attributes = {"POSITION": 0, "NORMAL": 1, "COLOR_0": 2, "_SCALAR": 3}
    surface = {"metallicFactor": 0.0, "roughnessFactor": 0.9}
    return {
        "asset": {"version": "2.0", "generator": f"contactbench {__version__}"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "S", "rotation": _Y_UP}],
        "meshes": [
            {
                "name": heatmap.title,
                "primitives": [{"attributes": attributes, "indices": 4, "material": 0}],
                "extras": {"frame": "S", "no_data": UNKNOWN, **heatmap.facts()},
            }
        ],
        "materials": [{"pbrMetallicRoughness": surface, "doubleSided": True}],
        "buffers": [{"byteLength": length}],
        "bufferViews": views,
        "accessors": accessors,
    }


def _glb(document: dict[str, Any], body: bytes) -> bytes:
    text = json.dumps(document, allow_nan=False, ensure_ascii=False, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

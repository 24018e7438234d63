"""
glTF 2.0, binary (GLB) or one JSON text with its data inside: meshes placed by a tree of nodes, in metres.

What the text says is checked before it is used: every index, offset and count may be wrong.
"""

import base64
import binascii
import json
import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.mesh.arrays import Floats, Longs
from contactbench.pipeline.mesh.parse import RawMesh, refuse_too_many, up

_MAGIC, _JSON, _BIN = b"glTF", b"JSON", b"BIN\0"

# A text of this size places thousands of parts; what it becomes takes fifty times the memory.
_LARGEST_TEXT = 2**24

# A probe is a few parts; a mesh that is placed again and again costs time and no bytes.
_MOST_PIECES = 10_000

_KINDS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_INDEX_KINDS = (5121, 5123, 5125)
_WIDTHS = {"SCALAR": 1, "VEC3": 3}

_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_COMPRESSED = {
    "KHR_draco_mesh_compression": "Draco",
    "EXT_meshopt_compression": "meshopt",
    "KHR_meshopt_compression": "meshopt",
}
# Extensions that change neither where a vertex is nor which facets there are, or whose change is read.
_HARMLESS = ("KHR_mesh_quantization", "KHR_texture_transform", "KHR_texture_basisu", "EXT_texture_webp")
_PLAIN = message("export it again as GLB without compression, or as STL or 3MF")


@dataclass
class _File:
    """What is read, a buffer by its bytes or the name of another file, and what comes of it."""

    text: dict[str, Any]
    buffers: list[bytes | str]
    vertices: list[Floats] = field(default_factory=list)
    faces: list[Longs] = field(default_factory=list)
    placed: int = 0
    facets: int = 0
    pieces: int = 0


def read_gltf(data: bytes) -> RawMesh:
    """
    Read the content of a GLB file, or of a glTF text that holds its own data; its scene becomes one mesh, y up.

    Materials, lines, points, skeletons and animations are not looked at.

    Raises
    ------
    MeshError
        Not glTF 2.0, damaged, compressed, morphed, with sparse data or data in another file, or without facets.
    """
    file = _open(data)
    _refuse_compressed(file.text, "extensionsRequired")
    for name in _list(file.text, "extensionsRequired"):
        if not str(name).startswith("KHR_materials_") and name not in _HARMLESS:
            raise MeshError(
                f"the glTF scene needs the extension {arg(str(name)[:60])}, which is not supported:"
                " export it again without it, or as STL or 3MF."
            )
    # A number that is none, or overflows here, is refused, with its row, like every other.
    with np.errstate(over="ignore", invalid="ignore"):
        nodes = list(_nodes(file.text))
        for node, transform in nodes:
            if "mesh" in node:
                _place(file, node, _entry(file.text, "meshes", node["mesh"]), transform)
    if not file.facets:
        raise MeshError("the glTF scene holds no triangles: export the part again, as a surface.")
    posed = message("Parts of the glTF scene are attached to a skeleton; they were read in their rest pose.")
    notes = (posed,) * any("skin" in node for node, _ in nodes)
    return RawMesh(np.concatenate(file.vertices), np.concatenate(file.faces), notes=notes, axes=up("y"))


# ---- the container -----------------------------------------------------------------------------------


def _open(data: bytes) -> _File:
    if not data.startswith(_MAGIC):
        return _filled(_parse(data), b"")
    if len(data) < 20:
        raise MeshError("the GLB file ends within its header: it is cut short, copy or export it again.")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise MeshError(
            f"the GLB file has version {arg(version)}, but only version 2 is supported: export it again"
            " as GLB 2.0."
        )
    if length > len(data):
        raise MeshError(
            f"the GLB header announces {arg(length)} bytes, but the file has {arg(len(data))}: it is cut"
            " short, copy or export it again."
        )
    chunks: dict[bytes, bytes] = {}
    at = 12
    while at + 8 <= length:
        size, kind = struct.unpack_from("<I4s", data, at)
        if at + 8 + size > length:
            raise MeshError(
                "a chunk of the GLB file is longer than the file: it is damaged, export it again."
            )
        chunks.setdefault(kind, data[at + 8 : at + 8 + size])
        at += 8 + size
    if _JSON not in chunks:
        raise MeshError("the GLB file holds no description of its scene: it is damaged, export it again.")
    return _filled(_parse(chunks[_JSON]), chunks.get(_BIN, b""))


def _filled(text: dict[str, Any], binary: bytes) -> _File:
    return _File(
        text, [_content(_entry(text, "buffers", i), binary) for i in range(len(_list(text, "buffers")))]
    )


def _content(buffer: dict[str, Any], binary: bytes) -> bytes | str:
    if "uri" not in buffer:
        return binary
    uri = str(buffer["uri"])
    head, _, body = uri.partition(",")
    if not head.startswith("data:") or not head.endswith(";base64"):
        return uri
    try:
        return base64.b64decode(body, validate=True)
    except (binascii.Error, ValueError) as error:
        raise MeshError(
            f"the data within the glTF file is damaged ({arg(str(error)[:100])}): export it again as GLB."
        ) from error


def _parse(text: bytes) -> dict[str, Any]:
    if len(text) > _LARGEST_TEXT:
        raise MeshError("the description of the glTF scene is over 16 MiB: export the probe alone, as GLB.")
    try:
        # Blanks fill up the chunk; some programs take zeros.
        parsed = json.loads(text.rstrip(b"\0 "))
    except (ValueError, RecursionError) as error:  # also numbers of thousands of digits
        raise MeshError(
            f"the description of the glTF scene is not valid JSON ({arg(str(error)[:100])}): export it"
            " again as GLB."
        ) from error
    if not isinstance(parsed, dict) or not isinstance(parsed.get("asset"), dict):
        raise MeshError("this is not a glTF file: it has no 'asset'. Choose another, or export it again.")
    if not str(parsed["asset"].get("version", "2.0")).startswith("2."):
        raise MeshError("the glTF file is not of version 2: export it again as GLB 2.0.")
    return parsed


def _refuse_compressed(holder: dict[str, Any], names: str) -> None:
    for name in _list(holder, names):
        if isinstance(name, str) and name in _COMPRESSED:
            raise MeshError(
                f"the glTF meshes are compressed with {arg(_COMPRESSED[name])}, which is not supported: {arg(_PLAIN)}."
            )


# ---- the scene ---------------------------------------------------------------------------------------


def _nodes(text: dict[str, Any]) -> Iterator[tuple[dict[str, Any], Floats]]:
    """Yield every node of the scene, or of all where none is named, with where it goes."""
    every = _list(text, "nodes")
    if not every:
        for mesh in range(len(_list(text, "meshes"))):
            yield {"mesh": mesh}, np.eye(4)
        return
    scenes = _list(text, "scenes")
    if scenes:
        scene = _entry(text, "scenes", text.get("scene", 0))
        roots = _list(scene, "nodes")
    else:
        below = {child for node in every if isinstance(node, dict) for child in _numbers(node, "children")}
        roots = [number for number in range(len(every)) if number not in below]
    waiting = [(number, np.eye(4)) for number in reversed(roots)]
    seen = 0
    while waiting:
        number, above = waiting.pop()
        seen += 1
        if seen > _MOST_PIECES:
            raise _too_many()
        if seen > len(every):
            raise MeshError(
                "a node of the glTF scene has several parents, or is its own parent: export it again."
            )
        node = _entry(text, "nodes", number)
        transform = above @ _local(node)
        if not (np.abs(transform) < 1e9).all():
            raise MeshError("the nodes of the glTF scene move or scale a part far too much: export it again.")
        yield node, transform
        waiting += [(child, transform) for child in reversed(_list(node, "children"))]


def _local(node: dict[str, Any]) -> Floats:
    """Give the (4, 4) transform from a node to the one above it."""
    if "matrix" in node:
        matrix = _floats(node, "matrix", 16, ()).reshape(4, 4).T
        if np.abs(matrix[3] - (0, 0, 0, 1)).max() > 1e-6:
            raise MeshError("a matrix of the glTF scene is not a transform of points: export it again.")
        return matrix
    x, y, z, w = _floats(node, "rotation", 4, (0, 0, 0, 1))
    length = x * x + y * y + z * z + w * w
    if not 0.5 < length < 2:
        raise MeshError("a rotation of the glTF scene is not a unit quaternion: export it again.")
    s = 2 / length
    rotation = np.array(
        [
            [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
            [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
            [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
        ]
    )
    local = np.eye(4)
    local[:3, :3] = rotation * _floats(node, "scale", 3, (1, 1, 1))
    local[:3, 3] = _floats(node, "translation", 3, (0, 0, 0))
    return local


def _place(file: _File, node: dict[str, Any], mesh: dict[str, Any], transform: Floats) -> None:
    """Add the triangles of one mesh, moved."""
    if any(_list(node if "weights" in node else mesh, "weights")):
        raise MeshError("the glTF scene morphs its meshes: apply the shapes first, and export it again.")
    for primitive in _list(mesh, "primitives"):
        if not isinstance(primitive, dict):
            raise _wrong("primitives")
        file.pieces += 1
        if file.pieces > _MOST_PIECES:
            raise _too_many()
        mode = primitive.get("mode", _TRIANGLES)
        if mode in (_STRIP, _FAN):
            raise MeshError("the glTF scene has strips or fans: export it again, with separate triangles.")
        if mode != _TRIANGLES:
            continue
        attributes = primitive.get("attributes")
        if not isinstance(attributes, dict) or "POSITION" not in attributes:
            raise _wrong("attributes")
        positions = _accessor(file, attributes["POSITION"], "VEC3", tuple(_KINDS)).astype(np.float64)
        if "indices" in primitive:
            corners = _accessor(file, primitive["indices"], "SCALAR", _INDEX_KINDS)[:, 0].astype(np.int64)
        else:
            corners = np.arange(len(positions))
        if len(corners) % 3:
            raise MeshError("the triangles of the glTF scene are not three vertices each: export it again.")
        file.facets += len(corners) // 3
        file.placed += len(positions)
        refuse_too_many(max(file.facets, file.placed // 3))
        faces = corners.reshape(-1, 3)
        if len(faces) and faces.max() >= len(positions):
            raise MeshError(
                "a facet of the glTF scene refers to a vertex that does not exist: export it again."
            )
        # A mirror turns the facets' outer side in.
        if np.linalg.det(transform[:3, :3]) < 0:
            faces = faces[:, ::-1]
        start = file.placed - len(positions)
        file.vertices.append(positions @ transform[:3, :3].T + transform[:3, 3])
        file.faces.append(faces + start)


# ---- numbers -----------------------------------------------------------------------------------------


def _accessor(file: _File, number: Any, shape: str, kinds: tuple[int, ...]) -> npt.NDArray[Any]:
    """Give the (n, 1) or (n, 3) numbers of an accessor."""
    accessor = _entry(file.text, "accessors", number)
    kind, count = accessor.get("componentType"), _whole(accessor, "count")
    if kind not in kinds or accessor.get("type") != shape:
        raise _wrong("accessors")
    width = _WIDTHS[shape]
    if "sparse" in accessor or "bufferView" not in accessor:
        _refuse_compressed(file.text, "extensionsUsed")
        raise MeshError("an accessor of the glTF scene has no data, or sparse data: export it again.")
    values = _view(file, accessor, kind, count, width)
    if accessor.get("normalized") is True and values.dtype.kind in "iu":
        return np.maximum(values / float(np.iinfo(values.dtype).max), -1.0)
    return values


def _view(file: _File, place: dict[str, Any], kind: int, count: int, width: int) -> npt.NDArray[Any]:
    """Give the (count, width) numbers from a place in a view of a buffer on."""
    view = _entry(file.text, "bufferViews", place.get("bufferView"))
    if isinstance(view.get("extensions"), dict):
        _refuse_compressed({"extensions": list(view["extensions"])}, "extensions")
    content = _buffer(file, view.get("buffer"))
    dtype = np.dtype(_KINDS[kind])
    begin, length = _whole(view, "byteOffset", 0), _whole(view, "byteLength")
    step = _whole(view, "byteStride", 0) or dtype.itemsize * width
    offset = _whole(place, "byteOffset", 0)
    last = offset + (count - 1) * step + dtype.itemsize * width
    if count < 1 or step > 1024 or begin + length > len(content) or last > length:
        raise MeshError(
            "an accessor of the glTF scene reaches beyond its data: the file is damaged or cut short, export it again."
        )
    return np.ndarray((count, width), dtype, content, begin + offset, (step, dtype.itemsize))


def _buffer(file: _File, number: int | None) -> bytes:
    _entry(file.text, "buffers", number)
    assert number is not None  # noqa: S101 - there is no such entry
    content = file.buffers[number]
    if isinstance(content, str):
        raise MeshError(
            f"the glTF file keeps its data in another file ({arg(content[:60])!r}): export it as GLB, which"
            " is one file."
        )
    return content


def _entry(holder: dict[str, Any], name: str, number: Any) -> dict[str, Any]:
    entries = _list(holder, name)
    if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < len(entries):
        raise MeshError(
            f"the glTF scene refers to an entry of '{arg(name)}' that does not exist: export it again."
        )
    entry = entries[number]
    if not isinstance(entry, dict):
        raise _wrong(name)
    return entry


def _list(holder: dict[str, Any], name: str) -> list[Any]:
    values = holder.get(name, [])
    if not isinstance(values, list):
        raise _wrong(name)
    return values


def _numbers(holder: dict[str, Any], name: str) -> list[int]:
    return [value for value in _list(holder, name) if isinstance(value, int)]


def _whole(holder: dict[str, Any], name: str, default: int | None = None) -> int:
    value = holder.get(name, default)
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 2**40:
        raise _wrong(name)
    return value


def _floats(holder: dict[str, Any], name: str, count: int, default: tuple[float, ...]) -> Floats:
    values = holder.get(name, default)
    if not isinstance(values, (list, tuple)) or len(values) != count:
        raise _wrong(name)
    if not all(isinstance(value, (int, float)) and abs(value) < 1e12 for value in values):
        raise _wrong(name)
    return np.array(values, dtype=np.float64)


def _too_many() -> MeshError:
    return MeshError(
        f"the glTF scene has more than {arg(_MOST_PIECES)} nodes or pieces: export the probe alone."
    )


def _wrong(name: str) -> MeshError:
    return MeshError(
        f"the glTF scene contains '{arg(name)}' that violate the format: export it again as GLB."
    )

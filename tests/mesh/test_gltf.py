"""GLB and glTF files: the tree of nodes, accessors, and files made to do harm."""

import base64
import json
import struct
from typing import Any

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import MeshError, MeshWarning, load_probe
from contactbench.pipeline.mesh.inspect import inspect

POINTS = np.array([(0, 0, 0), (0.05, 0, 0), (0, 0.05, 0), (0, 0, 0.05)], "<f4")
OUTWARD = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])


def scene(
    indices: np.ndarray | None = OUTWARD, kind: str = "u2", points: np.ndarray = POINTS
) -> tuple[dict[str, Any], bytes]:
    """One mesh, its indices first and its points after, 4 bytes apart from each other."""
    codes = {"u1": 5121, "u2": 5123, "u4": 5125}
    head = b"" if indices is None else indices.astype("<" + kind).tobytes()
    head += b"\0" * (-len(head) % 4)
    text: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 4}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteOffset": len(head), "byteLength": points.nbytes}],
        "buffers": [{"byteLength": len(head) + points.nbytes}],
    }
    if indices is not None:
        text["meshes"][0]["primitives"][0]["indices"] = 1
        text["accessors"].append(
            {"bufferView": 1, "componentType": codes[kind], "count": indices.size, "type": "SCALAR"}
        )
        text["bufferViews"].append({"buffer": 0, "byteOffset": 0, "byteLength": len(head)})
    return text, head + points.tobytes()


def glb(text: dict[str, Any] | bytes, binary: bytes = b"", version: int = 2) -> bytes:
    said = text if isinstance(text, bytes) else json.dumps(text).encode()
    said += b" " * (-len(said) % 4)
    body = (
        struct.pack("<I4s", len(said), b"JSON") + said + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    )
    return b"glTF" + struct.pack("<II", version, 12 + len(body)) + body


def refuse(path, message: str) -> None:
    with pytest.raises(MeshError, match=message) as caught:
        load_probe(path)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize("kind", ["u1", "u2", "u4"])
def test_indices_of_every_width(write, kind):
    probe = load_probe(write("a.glb", glb(*scene(kind=kind))))
    assert (len(probe.faces), probe.size, probe.health.sentences) == (4, pytest.approx(0.05), ())


def test_no_indices_and_lines(write):
    text, binary = scene(None, points=POINTS[OUTWARD].reshape(-1, 3))
    text["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0}, "mode": 1})
    assert load_probe(write("a.glb", glb(text, binary))).health.watertight


@pytest.mark.parametrize("mirrored", [False, True])
def test_parts_are_placed_like_trimesh_places_them(write, mirrored):
    made = trimesh.Scene()
    transform = trimesh.transformations.rotation_matrix(0.5, [1, 2, 3], point=[0.1, 0.2, 0.3])
    made.add_geometry(trimesh.creation.box(extents=(0.06, 0.04, 0.02)), transform=transform, node_name="a")
    inner = np.diag([-1.0 if mirrored else 1.0, 1, 1, 1])
    inner[0, 3] = 0.3
    made.add_geometry(
        trimesh.creation.icosphere(2, 0.03), transform=inner, node_name="b", parent_node_name="a"
    )
    with pytest.warns(MeshWarning, match="2 separate parts"):
        probe = load_probe(write("a.glb", made.export(file_type="glb")))
    whole = made.to_mesh()
    np.testing.assert_allclose(probe.bounds, whole.bounds, atol=1e-7)
    assert trimesh.Trimesh(probe.vertices, probe.faces).volume == pytest.approx(whole.volume, rel=1e-5)
    assert probe.health.outward


def test_a_node_turns_scales_and_moves_in_this_order(write):
    text, binary = scene()
    half = float(np.sqrt(0.5))
    text["nodes"] = [
        {"children": [1], "translation": [0, 0, 0.1]},
        {"mesh": 0, "rotation": [0, 0, half, half], "scale": [2, 1, 1]},
    ]
    np.testing.assert_allclose(
        load_probe(write("a.glb", glb(text, binary))).bounds, [[-0.05, 0, 0.1], [0, 0.1, 0.15]], atol=1e-8
    )
    # Columns, one after another: x goes to y, y to z, z to x, and then 0.2 along x.
    text["nodes"] = [{"mesh": 0, "matrix": [0, 1, 0, 0, 0, 0, 2, 0, 1, 0, 0, 0, 0.2, 0, 0, 1]}]
    np.testing.assert_allclose(
        load_probe(write("b.glb", glb(text, binary))).bounds, [[0.2, 0, 0], [0.25, 0.05, 0.1]], atol=1e-8
    )


def test_only_the_scene_is_read_and_without_one_all_of_it(write):
    text, binary = scene()
    text["nodes"] = [{"mesh": 0}, {"mesh": 0, "translation": [0.2, 0, 0]}]
    assert len(load_probe(write("a.glb", glb(text, binary))).faces) == 4
    del text["scenes"], text["scene"]
    with pytest.warns(MeshWarning, match="2 separate parts"):
        assert len(load_probe(write("b.glb", glb(text, binary))).faces) == 8
    del text["nodes"]
    assert len(load_probe(write("c.glb", glb(text, binary))).faces) == 4


def test_quantized_positions_and_strides(write):
    text, _ = scene()
    text["accessors"][0] |= {"componentType": 5122, "normalized": True}
    text["bufferViews"][0] |= {"byteStride": 8, "byteLength": 32, "byteOffset": 24}
    text["nodes"][0]["scale"] = [0.05, 0.05, 0.05]
    rows = np.full((4, 4), 7, "<i2")
    rows[:, :3] = np.round(POINTS / 0.05) * 32767
    probe = load_probe(write("a.glb", glb(text, OUTWARD.astype("<u2").tobytes() + rows.tobytes())))
    assert (probe.size, probe.health.sentences) == (pytest.approx(0.05), ())


def test_a_description_filled_up_with_zeros(write):
    text, binary = scene()
    said = json.dumps(text).encode() + b"\0\0\0\0"
    assert len(load_probe(write("a.glb", glb(said, binary))).faces) == 4


def test_text_with_its_data_inside_and_elsewhere(write):
    text, binary = scene()
    text["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    assert len(load_probe(write("a.gltf", json.dumps(text))).faces) == 4
    text["buffers"][0]["uri"] = "probe.bin"
    refuse(
        write("b.gltf", json.dumps(text)), "keeps its data in another file .'probe.bin'.: export it as GLB"
    )
    text["buffers"][0]["uri"] = "data:application/octet-stream;base64,%%%"
    refuse(write("c.gltf", json.dumps(text)), "the data within the glTF file is damaged")


def test_the_unit_is_metres_where_that_can_be(write):
    text, binary = scene(points=POINTS * 2600)
    with pytest.warns(MeshWarning, match="The format is defined in metres, but 130 m is impossible"):
        assert load_probe(write("a.glb", glb(text, binary))).size == pytest.approx(0.13)
    assert load_probe(write("b.glb", glb(text, binary)), "mm").size == pytest.approx(0.13)
    # 0.7 m is not usual, and still what the format says.
    assert load_probe(write("c.glb", glb(*scene(points=POINTS * 14)))).size == pytest.approx(0.7)


def test_skeletons_and_what_is_up_are_told(write):
    text, binary = scene()
    text["nodes"][0]["skin"] = 0
    said = " ".join(each.text for each in inspect(write("a.glb", glb(text, binary))).findings)
    assert "attached to a skeleton; they were read in their rest pose" in said
    assert "y axis points up" in said


def _set(*path: Any, to: Any):
    def change(text: dict[str, Any]) -> None:
        holder: Any = text
        for key in path[:-1]:
            holder = holder[key]
        holder[path[-1]] = to

    return change


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            _set("extensionsRequired", to=["KHR_draco_mesh_compression"]),
            "compressed with Draco, .* without compression",
        ),
        (_set("extensionsRequired", to=["EXT_meshopt_compression"]), "compressed with meshopt"),
        (_set("bufferViews", 0, "extensions", to={"EXT_meshopt_compression": {}}), "compressed with meshopt"),
        (
            _set("extensionsRequired", to=["KHR_materials_unlit", "EXT_mesh_gpu_instancing"]),
            "needs the extension EXT_mesh_gpu_instancing, which is not supported",
        ),
        (_set("extensionsRequired", to=[{}]), "needs the extension"),
        (_set("accessors", 0, "sparse", to={}), "no data, or sparse data"),
        (_set("meshes", 0, "primitives", 0, "mode", to=5), "strips or fans: export it again"),
        (_set("meshes", 0, "weights", to={}), "contains 'weights' that violate"),
        (_set("meshes", 0, "weights", to=[0, 0.5]), "morphs its meshes: apply the shapes first"),
        (_set("accessors", 0, to={"componentType": 5126, "count": 4, "type": "VEC3"}), "has no data"),
        (_set("accessors", 0, "count", to=5), "reaches beyond its data"),
        (_set("accessors", 0, "count", to=10**12), "reaches beyond its data"),
        (_set("accessors", 0, "count", to=0), "reaches beyond its data"),
        (_set("accessors", 0, "count", to=-1), "contains 'count' that violate"),
        (_set("accessors", 0, "byteOffset", to=4), "reaches beyond its data"),
        (_set("accessors", 0, "type", to="VEC2"), "contains 'accessors' that violate"),
        (_set("accessors", 0, "componentType", to=[5126]), "contains 'accessors' that violate"),
        (_set("accessors", 1, "componentType", to=5126), "contains 'accessors' that violate"),
        (_set("accessors", 1, "count", to=11), "not three vertices each"),
        (_set("accessors", 0, "count", to=3), "refers to a vertex that does not exist"),
        (_set("bufferViews", 0, "byteOffset", to=2**39), "reaches beyond its data"),
        (_set("bufferViews", 0, "byteStride", to=10**6), "reaches beyond its data"),
        (_set("bufferViews", 0, "buffer", to=1), "an entry of 'buffers' that does not exist"),
        (_set("bufferViews", to={}), "contains 'bufferViews' that violate"),
        (_set("bufferViews", 0, to=[]), "contains 'bufferViews' that violate"),
        (_set("nodes", 0, "mesh", to=True), "an entry of 'meshes' that does not exist"),
        (_set("nodes", 0, "mesh", to=-1), "an entry of 'meshes' that does not exist"),
        (_set("nodes", 0, "children", to=[0]), "has several parents, or is its own parent"),
        (_set("nodes", 0, "matrix", to=[1] * 16), "not a transform of points"),
        (_set("nodes", 0, "matrix", to=[1, 0, 0, 0] * 3), "contains 'matrix' that violate"),
        (_set("nodes", 0, "scale", to=[1e11, 1, 1]), "far too much"),
        (_set("nodes", 0, "translation", to=[float("nan"), 0, 0]), "contains 'translation' that violate"),
        (_set("nodes", 0, "rotation", to=[0, 0, 0, 0]), "not a unit quaternion"),
        (_set("scene", to=3), "an entry of 'scenes'"),
        (_set("scenes", 0, "nodes", to=["a"]), "an entry of 'nodes'"),
        (_set("meshes", 0, "primitives", to=[]), "holds no triangles"),
        (_set("meshes", 0, "primitives", to=["a"]), "contains 'primitives' that violate"),
        (_set("meshes", 0, "primitives", 0, "attributes", to={}), "contains 'attributes' that violate"),
        (_set("meshes", 0, "primitives", to=[{"mode": 0}] * 10_001), "more than 10000 nodes or pieces"),
        (_set("asset", to={"version": "1.0"}), "not of version 2"),
        (_set("asset", to=None), "not a glTF file"),
    ],
)
def test_damaged_or_hostile(write, change, message):
    text, binary = scene()
    change(text)
    refuse(write("a.glb", glb(text, binary)), message)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"glTF", "ends within its header"),
        (glb(*scene(), version=1), "version 1, but only version 2 is supported"),
        (glb(*scene())[:-8], "announces .* bytes, but the file has"),
        (glb(*scene()).replace(b"JSON", b"NOSJ"), "no description of its scene"),
        (glb(b"{"), "not valid JSON"),
        (glb(b"[" * 100_000), "not valid JSON"),
        (glb(b'{"asset": ' + b"1" * 10_000 + b"}"), "not valid JSON"),
        (b"hello, this is no mesh", "not valid JSON"),
        (b"[1]", "not a glTF file"),
        (glb({"asset": {}}), "holds no triangles"),
        (b"glTF" + struct.pack("<III4s", 2, 20, 2**31, b"JSON"), "longer than the file"),
    ],
)
def test_no_glb(write, data, message):
    refuse(write("a.glb", data), message)


def test_facets_of_copies_count_towards_the_limit(write):
    text, binary = scene(np.resize(OUTWARD, (5000, 3)))
    text["scenes"][0]["nodes"] = list(range(900))
    text["nodes"] = [{"mesh": 0}] * 900
    refuse(write("a.glb", glb(text, binary)), "more than 4000000 facets")

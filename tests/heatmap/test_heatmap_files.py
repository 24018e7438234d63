"""Heatmaps as PLY, glTF and PNG: other programs read the surface and the values back."""

import io
import json
import struct

import numpy as np
import pytest
import trimesh
from matplotlib.image import imread

from contactbench.assets import make
from contactbench.pipeline.heatmap import heatmap
from contactbench.pipeline.heatmap.files import encode_glb, encode_ply
from contactbench.pipeline.heatmap.picture import SurfaceView, encode_png, looks
from contactbench.pipeline.mesh import Probe, load_probe


@pytest.fixture(scope="module")
def made():
    probe = Probe.from_arrays(*make("linear", 3_000), name="linear")
    tip = probe.vertices[np.argmax(probe.vertices[:, 2])]
    points = tip + np.random.default_rng(0).normal(0, 0.003, (200, 3))
    return heatmap(probe, points, bandwidth=0.003)


def test_ply_holds_the_surface_and_the_values(made, tmp_path):
    file = tmp_path / "map.ply"
    file.write_bytes(encode_ply(made))
    read = trimesh.load(file, process=False)
    assert np.array_equal(read.vertices, made.probe.vertices)
    assert np.array_equal(read.faces, made.probe.faces)
    scalar = read.metadata["_ply_raw"]["vertex"]["data"]["scalar"].ravel()
    assert scalar == pytest.approx(made.values, rel=1e-6, nan_ok=True)
    assert b"comment scalar: contact density, 1/mm2, bandwidth 3 mm" in file.read_bytes()
    assert len(load_probe(file, units="m").faces) == len(made.probe.faces)


def test_glb_is_read_back_by_trimesh(made, tmp_path):
    file = tmp_path / "map.glb"
    file.write_bytes(encode_glb(made))
    scene = trimesh.load(file, process=False)
    (mesh,) = scene.geometry.values()
    assert mesh.vertices == pytest.approx(made.probe.vertices, abs=1e-8)
    assert np.array_equal(mesh.faces, made.probe.faces)
    expected = np.where(made.known, made.values, -1)
    assert mesh.vertex_attributes["_SCALAR"].ravel() == pytest.approx(expected, rel=1e-6)
    assert mesh.metadata["unit"] == "1/mm²"
    assert mesh.metadata["bandwidth_mm"] == 3.0
    T, _ = scene.graph[scene.graph.nodes_geometry[0]]
    assert T[:3, :3] @ [0, 0, 1] == pytest.approx([0, 1, 0])  # glTF's up is y


def test_glb_keeps_to_the_letter_of_the_format(made):
    data = encode_glb(made)
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert (size % 4, kind) == (0, b"JSON")
    document = json.loads(data[20 : 20 + size])
    body_size, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert (body_size, kind) == (document["buffers"][0]["byteLength"], b"BIN\0")
    assert 28 + size + body_size == len(data)
    body = data[28 + size :]
    for view in document["bufferViews"]:
        assert view["byteOffset"] % 4 == 0
        assert view["byteOffset"] + view["byteLength"] <= body_size
    position, normal, colour, scalar, indices = document["accessors"]
    start = document["bufferViews"][0]["byteOffset"]
    points = np.frombuffer(body, "<f4", 3 * position["count"], start).reshape(-1, 3)
    assert points.min(axis=0).tolist() == position["min"]
    assert points.max(axis=0).tolist() == position["max"]
    start = document["bufferViews"][1]["byteOffset"]
    normals = np.frombuffer(body, "<f4", 3 * normal["count"], start).reshape(-1, 3)
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1, abs=1e-5)
    assert colour["normalized"]
    assert scalar["type"] == "SCALAR"
    assert indices["count"] == made.probe.faces.size


def test_the_files_are_the_same_every_time(made):
    for encode in (encode_ply, encode_glb, lambda each: encode_png(each, pixels=60)):
        assert encode(made) == encode(made)


def test_the_picture_shows_data_in_colour_and_the_rest_in_grey(made):
    first, second = looks(made)
    assert first.toward @ second.toward < 0.7
    image = SurfaceView(made.probe, first, 120).drawn(made).astype(float)
    saturation = image.max(axis=2) - image.min(axis=2)
    assert 0.02 < (saturation > 40).mean() < 0.9
    assert ((saturation < 12) & (image.max(axis=2) < 240)).mean() > 0.02
    assert imread(io.BytesIO(encode_png(made, pixels=120))).shape[1] == 240

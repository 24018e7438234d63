"""Whatever bytes a file holds, the answer is a sound probe or a MeshError that names the file."""

from __future__ import annotations

import random
import warnings
from typing import TYPE_CHECKING

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.mesh import MeshError, MeshWarning, Probe, load_probe, save_probe

if TYPE_CHECKING:
    from pathlib import Path

# Numbers and words that are right in one place and wrong in most.
PIECES = [
    b"0",
    b"-1",
    b"3",
    b"4",
    b"9999999999",
    b"1e308",
    b"1e-320",
    b"nan",
    b"inf",
    b"\n",
    b"\r",
    b" ",
    b"#",
    b"/",
]
PIECES += [
    b"vertex",
    b"facet",
    b"endsolid",
    b"solid",
    b"element",
    b"property",
    b"list",
    b"end_header",
    b"f ",
    b"v ",
]
PIECES += [
    b"\0",
    b"\xff" * 4,
    b"\0" * 4,
    b"\x7f\xf0\0\0",
    b"uint",
    b"int64",
    b"ascii",
    b"binary_big_endian",
    b"\\\n",
]


def _seeds(folder: Path) -> dict[str, bytes]:
    mesh = trimesh.creation.box(extents=(64, 32, 16))
    region = np.arange(12)
    save_probe(
        Probe.from_arrays(np.asarray(mesh.vertices), mesh.faces, region, check_size=False), folder / "s.ply"
    )
    return {
        "binary.stl": mesh.export(file_type="stl"),
        "text.stl": mesh.export(file_type="stl_ascii").encode(),
        "binary.ply": mesh.export(file_type="ply"),
        "text.ply": mesh.export(file_type="ply", encoding="ascii"),
        "saved.ply": (folder / "s.ply").read_bytes(),
        "mesh.obj": mesh.export(file_type="obj").encode(),
    }


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("fuzz")


@pytest.fixture(scope="module")
def seeds(folder) -> dict[str, bytes]:
    return _seeds(folder)


def sound(path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)
        try:
            probe = load_probe(path)
        except MeshError as error:
            assert str(path) in str(error)  # noqa: PT017 - both outcomes are right
            return
    assert np.isfinite(probe.vertices).all()
    assert 0 <= probe.faces.min() <= probe.faces.max() < len(probe.vertices)
    assert len(probe.region) == len(probe.faces)
    assert probe.region.min() >= 0
    np.testing.assert_allclose(np.linalg.norm(probe.normals, axis=1), 1)
    assert (probe.areas > 0).all()


def mutate(data: bytes, chance: random.Random) -> bytes:
    changed = bytearray(data)
    for _ in range(chance.choice([1, 1, 1, 2, 5, 20])):
        at = chance.randrange(len(changed) + 1)
        to = min(len(changed), at + chance.choice([0, 1, 1, 2, 4, 13, 50]))
        match chance.randrange(5):
            case 0:
                changed[at:to] = b""
            case 1:
                changed[at:to] = chance.choice(PIECES)
            case 2:
                changed[at:to] = chance.randbytes(to - at)
            case 3:
                changed[at:at] = changed[at:to]
            case _ if at < len(changed):
                changed[at] ^= 1 << chance.randrange(8)
    return bytes(changed)


NAMES = st.sampled_from(["binary.stl", "text.stl", "binary.ply", "text.ply", "saved.ply", "mesh.obj"])


@settings(max_examples=300, derandomize=True, deadline=None)
@given(name=NAMES, share=st.floats(0, 1))
def test_truncated_anywhere(folder, seeds, name, share):
    data = seeds[name]
    path = folder / name
    path.write_bytes(data[: int(share * len(data))])
    sound(path)


@settings(max_examples=900, derandomize=True, deadline=None)
@given(name=NAMES, chance=st.randoms(use_true_random=True))
def test_mutated(folder, seeds, name, chance):
    path = folder / name
    path.write_bytes(mutate(seeds[name], chance))
    sound(path)


@settings(max_examples=300, derandomize=True, deadline=None)
@given(name=NAMES, data=st.binary(max_size=300))
def test_random_bytes(folder, name, data):
    path = folder / name
    path.write_bytes(data)
    sound(path)


@settings(max_examples=300, derandomize=True, deadline=None)
@given(
    vertices=st.lists(
        st.lists(st.one_of(st.floats(), st.integers(-2, 2)), min_size=3, max_size=3), min_size=1, max_size=8
    ),
    faces=st.lists(st.lists(st.integers(-1, 8), min_size=3, max_size=3), max_size=8),
)
def test_arrays(vertices, faces):
    try:
        probe = Probe.from_arrays(vertices, faces, check_size=False)
    except MeshError:
        return
    np.testing.assert_allclose(np.linalg.norm(probe.normals, axis=1), 1)
    assert probe.size > 0

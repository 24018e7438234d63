from __future__ import annotations

import os
import stat
from pathlib import Path

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import MeshError, MeshWarning, Probe, load_probe, save_probe


def same(one: Probe, two: Probe) -> None:
    for field in ("vertices", "faces", "region"):
        assert getattr(one, field).tobytes() == getattr(two, field).tobytes(), field
    assert one.health == two.health


def test_round_trip_is_bit_for_bit(ball, tmp_path):
    random = np.random.default_rng(1)
    vertices = ball.vertices / 1000 + random.normal(scale=1e-4, size=ball.vertices.shape)
    probe = Probe.from_arrays(vertices, ball.faces, random.integers(0, 2**31, 320))
    save_probe(probe, tmp_path / "ball.ply")
    same(probe, load_probe(tmp_path / "ball.ply", units="m"))
    save_probe(probe, str(tmp_path / "BALL.PLY"))
    assert (tmp_path / "BALL.PLY").read_bytes() == (tmp_path / "ball.ply").read_bytes()


@pytest.mark.parametrize("ranks", ["", " 0", " -1", " 2 x", " 1.5"])
def test_a_damaged_list_of_untouchable_regions_is_refused(box, tmp_path, ranks):
    file = tmp_path / "box.ply"
    save_probe(Probe.from_arrays(*box, np.arange(12), untouchable=(2, 11)), file)
    assert load_probe(file, units="m").untouchable == (2, 11)
    data = file.read_bytes()
    file.write_bytes(
        data.replace(b"comment untouchable regions 2 11", f"comment untouchable regions{ranks}".encode())
    )
    with pytest.raises(MeshError, match="line 5 of the PLY header"):
        load_probe(file, units="m")


def test_round_trip_neither_merges_nor_renumbers(box, tmp_path):
    # Corners that coincide, a vertex nobody uses, a facet shorter than the merging tolerance.
    vertices = np.vstack((box[0], box[0], [[1.0, 1.0, 1.0]], box[0][:1] + np.array([1e-10, 0, 0])))
    faces = np.vstack((box[1], box[1] + 8, [[0, 1, 17]]))
    probe = Probe.from_arrays(vertices, faces, np.arange(25))
    save_probe(probe, tmp_path / "soup.ply")
    with pytest.warns(MeshWarning):
        loaded = load_probe(tmp_path / "soup.ply", units="m")
    same(probe, loaded)


def test_saved_file_needs_no_units_and_no_wrong_ones_change_it(box, tmp_path):
    save_probe(Probe.from_arrays(*box), tmp_path / "box.ply")
    same(Probe.from_arrays(*box), load_probe(tmp_path / "box.ply"))
    same(Probe.from_arrays(*box), load_probe(tmp_path / "box.ply", "mm"))


def test_other_programs_can_read_it(box, tmp_path):
    save_probe(Probe.from_arrays(*box, np.arange(12)), tmp_path / "box.ply")
    mesh = trimesh.load_mesh(tmp_path / "box.ply", process=False)
    np.testing.assert_array_equal(mesh.vertices, box[0])
    np.testing.assert_array_equal(mesh.faces, box[1])
    head = (tmp_path / "box.ply").read_bytes().partition(b"end_header\n")[0].decode().splitlines()
    assert head[1] == "format binary_little_endian 1.0"
    assert "property double x" in head
    assert "property int region" in head


def test_replaces_in_one_step_and_leaves_nothing_behind(box, tmp_path):
    path = tmp_path / "box.ply"
    path.write_text("old", encoding="utf-8")
    save_probe(Probe.from_arrays(*box), path)
    assert path.read_bytes()[:4] == b"ply\n"
    assert [entry.name for entry in tmp_path.iterdir()] == ["box.ply"]


@pytest.mark.skipif(os.name == "nt", reason="Windows has no file mode")
def test_file_mode_follows_the_umask(box, tmp_path):
    old = os.umask(0o027)
    try:
        save_probe(Probe.from_arrays(*box), tmp_path / "box.ply")
    finally:
        os.umask(old)
    assert stat.S_IMODE((tmp_path / "box.ply").stat().st_mode) == 0o640


@pytest.mark.parametrize("name", ["box.stl", "box", "box.ply.bak"])
def test_other_suffix_is_refused(box, tmp_path, name):
    with pytest.raises(MeshError, match=r"saved as PLY, which keeps its regions: end the name in \.ply"):
        save_probe(Probe.from_arrays(*box), tmp_path / name)


def test_missing_folder_is_refused(box, tmp_path):
    path = tmp_path / "none" / "box.ply"
    with pytest.raises(MeshError, match=r"cannot be written .*choose a folder that exists") as caught:
        save_probe(Probe.from_arrays(*box), path)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize("step", ["fsync", "replace"])
def test_a_failure_leaves_the_old_file_and_no_scratch(box, tmp_path, monkeypatch, step):
    path = tmp_path / "box.ply"
    path.write_text("old", encoding="utf-8")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    if step == "fsync":
        monkeypatch.setattr(os, "fsync", full)
    else:
        monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(MeshError, match="No space left on device"):
        save_probe(Probe.from_arrays(*box), path)
    assert path.read_text(encoding="utf-8") == "old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["box.ply"]

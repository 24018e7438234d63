"""What holds for every format: errors, units, mount, merging, leaving facets out, warning."""

import contextlib
import gzip
import os
import stat
import warnings
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from contactbench.pipeline.mesh import MeshError, MeshWarning, Probe, load_probe, save_probe


@pytest.fixture
def ball_file(ball, encode, write, format_name):
    return write(format_name, encode(ball, format_name))


def soup(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """The same facets, each with three vertices of its own."""
    return trimesh.Trimesh(
        mesh.triangles.reshape(-1, 3), np.arange(3 * len(mesh.faces)).reshape(-1, 3), process=False
    )


def test_every_format_gives_the_same_geometry(ball, ball_file):
    probe = load_probe(ball_file)
    assert probe.name == ball_file.stem
    assert (len(probe.vertices), len(probe.faces)) == (len(ball.vertices), len(ball.faces))
    np.testing.assert_allclose(probe.vertices[probe.faces], ball.triangles / 1000, atol=1e-9)
    assert probe.health.sentences == ()
    assert not probe.region.any()


def test_result_is_owned_and_read_only(ball_file):
    probe = load_probe(ball_file)
    for array in (probe.vertices, probe.faces, probe.region):
        assert array.flags.c_contiguous
        assert not array.flags.writeable


def test_loading_twice_is_bit_identical(ball_file):
    one, two = load_probe(ball_file), load_probe(ball_file)
    assert one.vertices.tobytes() == two.vertices.tobytes()
    assert one.faces.tobytes() == two.faces.tobytes()


def test_suffix_may_be_upper_case_and_the_name_may_be_given(ball, encode, write):
    probe = load_probe(str(write("BALL.STL", encode(ball, "binary.stl"))), name="convex")
    assert probe.name == "convex"


@pytest.mark.parametrize(("units", "factor"), [("m", 1.0), ("cm", 0.01), ("mm", 0.001), ("in", 0.0254)])
def test_units(ball, encode, write, units, factor):
    mesh = trimesh.Trimesh(ball.vertices / 1000 / factor, ball.faces, process=False)
    probe = load_probe(write("ball.obj", encode(mesh, "mesh.obj")), units)
    assert probe.size == pytest.approx(0.08, rel=1e-3)


def test_millimetres_become_the_nearest_metres(write):
    path = write("t.obj", "v 120 0 0\nv 0 0.1 0\nv 0 0 70.3\nf 1 2 3\n")
    with pytest.warns(MeshWarning, match="surface is open"):
        probe = load_probe(path)
    assert probe.vertices.max(axis=0).tolist() == [0.12, 0.0001, 0.0703]


def test_unknown_unit(ball_file):
    with pytest.raises(
        MeshError, match=r"units='inch' is not known: pass one of 'm', 'cm', 'mm', 'in', 'auto'"
    ):
        load_probe(ball_file, units="inch")


@pytest.mark.parametrize(
    ("factor", "units", "message"),
    [
        (1.0, "m", r"probe is 8\d+\.?\d* mm long, more than 2000 mm: are the numbers milli.*Give --units mm"),
        (1e-3, "mm", r"less than 5 mm: are the numbers metres\? Give --units m instead of mm"),
        (1e-3, "in", r"less than 5 mm: are the numbers metres\? Give --units m instead of in"),
        (1e6, "mm", r"no probe has that size in millimetres"),
        (0.0, "mm", r"the probe is 0 mm long"),
    ],
)
def test_wrong_unit_is_named(ball, encode, write, factor, units, message):
    mesh = trimesh.Trimesh(ball.vertices * factor, ball.faces, process=False)
    path = write("ball.ply", encode(mesh, "binary.ply"))
    with pytest.raises(MeshError, match=message) as caught:
        load_probe(path, units)
    assert str(path) in str(caught.value)


# ---------------------------------------------------------------- mount


def rigid(rotation=(0.3, -0.7, 1.1), translation=(0.1, -0.02, 0.3)) -> np.ndarray:
    T_SP = np.eye(4)
    T_SP[:3, :3] = Rotation.from_rotvec(rotation).as_matrix()
    T_SP[:3, 3] = translation
    return T_SP


def test_mount_moves_the_mesh_after_the_units(ball_file):
    T_SP = rigid()
    plain, moved = load_probe(ball_file), load_probe(ball_file, mount=T_SP)
    np.testing.assert_allclose(moved.vertices, plain.vertices @ T_SP[:3, :3].T + T_SP[:3, 3], atol=1e-15)
    np.testing.assert_array_equal(moved.faces, plain.faces)
    np.testing.assert_allclose(moved.normals, plain.normals @ T_SP[:3, :3].T, atol=1e-9)


def test_mount_may_be_nested_lists_and_is_copied(ball_file):
    probe = load_probe(ball_file, mount=np.eye(4, dtype=int).tolist())
    np.testing.assert_array_equal(probe.vertices, load_probe(ball_file).vertices)


def changed(**entries: float) -> np.ndarray:
    T_SP = rigid()
    for key, value in entries.items():
        T_SP[int(key[1]), int(key[2])] = value
    return T_SP


@pytest.mark.parametrize(
    ("mount", "message"),
    [
        (np.eye(3), r"mount has shape \(3, 3\): give a 4 x 4"),
        ("flange", "mount is not a matrix of numbers"),
        ([[1, 0], [0]], "mount is not a matrix of numbers"),
        (changed(_01=np.nan), "mount holds NaN"),
        (changed(_33=np.inf), "mount holds NaN or infinity"),
        (changed(_30=0.5), r"last row .*, not \[0, 0, 0, 1\]: is it transposed\?"),
        (rigid().T, "is it transposed"),
        (rigid() @ np.diag([1, 1, -1, 1]), "mount mirrors the mesh"),
        (rigid() @ np.diag([0.001, 0.001, 0.001, 1]), "mount scales or shears.*units"),
        (rigid() @ np.diag([1, 1, 1.0001, 1]), "mount scales or shears"),
        (np.diag([0.0, 0.0, 0.0, 1.0]), "mount scales or shears"),
        (np.diag([1e200, 1e200, 1e200, 1.0]), "mount scales or shears"),
        (
            rigid(translation=(0.0, 0.0, 120.0)),
            r"mount moves the mesh by .*120.0\] m: give the translation in metres",
        ),
    ],
)
def test_mount_that_is_not_rigid(ball_file, mount, message):
    with pytest.raises(MeshError, match=message):
        load_probe(ball_file, mount=mount)


def test_mount_within_rounding_is_accepted(ball_file):
    assert load_probe(ball_file, mount=np.round(rigid(), 7)).size > 0


# ---------------------------------------------------------------- merging and leaving out


def test_soup_is_merged_in_every_format(ball, encode, write, format_name):
    probe = load_probe(write(format_name, encode(soup(ball), format_name)))
    assert len(probe.vertices) == len(ball.vertices)
    assert probe.health.watertight
    np.testing.assert_allclose(probe.vertices[probe.faces], ball.triangles / 1000, atol=1e-9)


def test_merging_keeps_the_first_and_its_order(ball, encode, write):
    flat = ball.triangles.reshape(-1, 3)
    probe = load_probe(write("soup.ply", encode(soup(ball), "binary.ply")))
    _, first = np.unique(flat, axis=0, return_index=True)
    np.testing.assert_array_equal(probe.vertices, flat[np.sort(first)] / 1000)


def text_obj(vertices: np.ndarray, faces: np.ndarray) -> str:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    return "\n".join(lines)


@pytest.mark.parametrize(("shift", "merged"), [(0.3e-7, True), (3e-7, False)])
@pytest.mark.parametrize("seed", range(5))
def test_merging_tolerance_is_relative_to_the_size(ball, write, seed, shift, merged):
    # Random directions and an odd origin: some pairs fall on both sides of a grid line.
    vertices = ball.triangles.reshape(-1, 3) + np.array([1 / 3, 1 / 7, 0.0])
    random = np.random.default_rng(seed)
    first = ~np.isin(np.arange(len(vertices)), np.unique(vertices, axis=0, return_index=True)[1])
    vertices[first] += random.choice([-1.0, 1.0], (first.sum(), 3)) * shift * 80 / np.sqrt(12)
    path = write("soup.obj", text_obj(vertices, np.arange(len(vertices)).reshape(-1, 3)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)
        probe = load_probe(path)
    assert (len(probe.vertices) == len(ball.vertices)) == merged


def test_merging_many_points_on_one_spot_stays_small(write):
    # Were every pair listed, 20,000 points within the tolerance would take 3 GB.
    spot = np.random.default_rng(0).random((20_000, 3)) * 1e-9
    faces = np.arange(20_001).reshape(-1, 3)
    with pytest.raises(MeshError, match="none of the 6667 facets has an area"):
        load_probe(write("spot.obj", text_obj(np.vstack((spot, [[100.0, 0, 0]])), faces)))


def test_unused_vertices_are_left_out(ball, write):
    vertices = np.vstack(([[1e6, 0, 0]], ball.vertices))
    probe = load_probe(write("ball.obj", text_obj(vertices, ball.faces + 1)))
    assert len(probe.vertices) == len(ball.vertices)
    assert probe.size == pytest.approx(0.08, rel=1e-3)


def with_flat_facets(mesh: trimesh.Trimesh, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The mesh and facets along its edges: corner, middle, corner."""
    corner, other = mesh.vertices[mesh.faces[:count, 0]], mesh.vertices[mesh.faces[:count, 1]]
    middle = len(mesh.vertices) + np.arange(count)
    flat = np.column_stack((mesh.faces[:count, 0], middle, mesh.faces[:count, 1]))
    return np.vstack((mesh.vertices, (corner + other) / 2)), np.vstack((flat[:1], mesh.faces, flat[1:]))


@pytest.mark.parametrize("count", [3, 100])
@pytest.mark.parametrize("mount", [None, rigid()])
def test_facets_without_area_are_left_out_with_a_warning(ball, write, mount, count):
    path = write("ball.obj", text_obj(*with_flat_facets(ball, count)))
    with pytest.warns(MeshWarning, match=rf"Facets without area were left out \(facets: {count}\)") as caught:
        probe = load_probe(path, mount=mount)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert probe.health.dropped_facets == count
    assert len(probe.faces) == len(ball.faces)
    assert probe.health.watertight
    np.testing.assert_array_equal(np.sort(probe.areas) > 1e-9, True)


def test_facets_that_all_have_no_area_are_refused(write):
    with pytest.raises(MeshError, match="none of the 2 facets has an area"):
        load_probe(write("line.obj", "v 0 0 0\nv 100 0 0\nv 50 0 0\nf 1 2 3\nf 1 1 2\n"), "mm")


def divided(mesh: trimesh.Trimesh, edges: int) -> tuple[np.ndarray, np.ndarray]:
    """The mesh with edges divided on one side only, and the seam filled with facets without area."""
    vertices, faces = mesh.vertices.tolist(), mesh.faces.tolist()
    used: set[int] = set()
    neighbours = {(a, b): k for k, f in enumerate(faces) for a, b in zip(f, f[1:] + f[:1], strict=True)}
    for (a, b), k in list(neighbours.items()):
        other = neighbours[b, a]
        if len(used) == 2 * edges or {k, other} & used:
            continue
        used |= {k, other}
        (c,) = set(faces[k]) - {a, b}
        m = len(vertices)
        vertices.append([(x + y) / 2 for x, y in zip(vertices[a], vertices[b], strict=True)])
        faces[k] = [a, m, c]
        faces += [[m, b, c], [m, a, b]]
    return np.array(vertices), np.array(faces)


@pytest.mark.parametrize("name", ["soup", "shared"])
def test_a_seam_of_facets_without_area_stays_closed(write, name):
    box = trimesh.creation.box(extents=(160, 64, 32)).subdivide()
    vertices, faces = divided(box, 15)
    if name == "soup":
        vertices, faces = vertices[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3)
    with pytest.warns(MeshWarning, match=r"left out \(facets: 15\)"):
        probe = load_probe(write("box.obj", text_obj(vertices, faces)), "mm")
    assert probe.health.watertight
    assert probe.health.outward
    assert len(probe.faces) == len(box.faces) + 2 * 15
    assert probe.areas.sum() == pytest.approx(1e-6 * box.area, rel=1e-12)
    volume = trimesh.Trimesh(probe.vertices, probe.faces, process=False).volume
    assert volume == pytest.approx(1e-9 * box.volume, rel=1e-12)


def test_regions_follow_a_divided_facet(write, ply_text):
    # Two quads of different regions beside each other; the second one's side is divided by a facet of a third.
    vertices = ["0 0 0", "100 0 0", "100 100 0", "0 100 0", "50 0 0", "50 -80 0"]
    rows = ["3 0 1 2 1", "3 0 2 3 1", "3 0 4 1 9", "3 0 5 4 2", "3 5 1 4 2"]
    text = ply_text(vertices, rows, face_properties=("list uchar int vertex_indices", "int region"))
    with pytest.warns(MeshWarning, match=r"left out \(facets: 1\)"):
        probe = load_probe(write("a.ply", text), "mm")
    assert sorted(probe.region.tolist()) == [1, 1, 1, 2, 2]
    np.testing.assert_allclose(probe.normals, [[0, 0, 1.0]] * 5)
    # Only the outer rim is open: the seam is not.
    assert probe.health.boundary_edges == 5


def test_stray_points_that_are_not_numbers_are_told(ball, write):
    text = "v nan nan nan\n" + text_obj(ball.vertices, ball.faces + 1) + "\nv inf 0 0\n"
    with pytest.warns(MeshWarning, match=r"that are not numbers were left out \(points: 2\)"):
        probe = load_probe(write("ball.obj", text))
    assert len(probe.vertices) == len(ball.vertices)


def test_facets_that_collapse_in_merging_are_left_out(ball, write):
    near = ball.vertices[0] + 1e-6
    vertices = np.vstack((ball.vertices, [near]))
    faces = np.vstack((ball.faces, [[0, len(ball.vertices), int(ball.faces[ball.faces[:, 0] == 0][0, 1])]]))
    with pytest.warns(MeshWarning, match=r"left out \(facets: 1\)"):
        probe = load_probe(write("ball.obj", text_obj(vertices, faces)))
    assert len(probe.faces) == len(ball.faces)
    assert len(probe.vertices) == len(ball.vertices)


def test_defects_come_as_one_warning(ball, encode, write):
    faces = ball.faces[5:].copy()
    faces[0] = faces[0, ::-1]
    mesh = trimesh.Trimesh(
        np.vstack((ball.vertices, ball.vertices + np.array([200, 0, 0]))),
        np.vstack((faces, ball.faces + len(ball.vertices))),
        process=False,
    )
    path = write("bad.stl", encode(mesh, "binary.stl"))
    with pytest.warns(MeshWarning) as caught:
        probe = load_probe(path)
    assert len(caught) == 1
    text = str(caught[0].message)
    assert text.startswith(str(path))
    assert all(sentence in text for sentence in probe.health.sentences)
    assert len(probe.health.sentences) == 3


def test_inside_out_file_warns(ball, encode, write):
    mesh = trimesh.Trimesh(ball.vertices, ball.faces[:, ::-1], process=False)
    with pytest.warns(MeshWarning, match="inside out"):
        load_probe(write("ball.stl", encode(mesh, "text.stl")))


# ---------------------------------------------------------------- files


def refuse(path, message: str, **options) -> None:
    with pytest.raises(MeshError, match=message) as caught:
        load_probe(path, **options)
    assert str(path) in str(caught.value)


def test_missing_file(tmp_path):
    refuse(tmp_path / "none.stl", "there is no such file: check the path")


def test_folder(tmp_path):
    folder = tmp_path / "probes.stl"
    folder.mkdir()
    refuse(folder, "this is a folder")


def test_empty_file(write):
    refuse(write("empty.obj", b""), "the file is empty")


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("probe.step", b"anything", "a STEP file, but it is cut short.*copy or export it again"),
        ("probe.STP.gz", b"anything", "a STEP file"),
        ("probe.igs", b"anything", "an IGES file.*no triangles"),
        ("probe.stl", b"ISO-10303-21;\nHEADER;\n", "a STEP file"),
        ("probe.stl", b"Made by hand".ljust(72) + b"S      1\n", "an IGES file"),
        (
            "probe.stl",
            b"version https://git-lfs.github.com/spec/v1\noid",
            "a Git LFS pointer.*'git lfs pull'",
        ),
        ("probe.obj", b"\n<!DOCTYPE html>\n<html>", "a web page"),
        ("probe.sldprt", b"anything", "is not one of .stl, .ply, .obj.*the content is none"),
        ("probe", b"anything", "is not one of .stl, .ply, .obj"),
        ("probe.stl.gz", b"\x1f\x8b\x08 and no more", "the gzip file is damaged"),
        ("probe.stl.gz", gzip.compress(b"solid" * 1000, mtime=0)[:-20], "the gzip file is damaged"),
        ("probe.stl.gz", gzip.compress(bytes(2**20 + 1), mtime=0), "more than 512 MiB"),
        ("probe.stl.gz", gzip.compress(b"", mtime=0), "the file is empty"),
    ],
)
def test_what_is_no_mesh_is_named_with_the_remedy(write, monkeypatch, name, data, words):
    monkeypatch.setattr("contactbench.pipeline.mesh.formats._LARGEST_FILE", 2**20)
    refuse(write(name, data), words)


@pytest.mark.parametrize("named", ["a.stl", "a.dat", "a", "a.obj.gz"])
@pytest.mark.parametrize("format_name", ["binary.stl", "text.stl", "binary.ply", "text.ply"])
def test_the_content_decides_and_not_the_name(ball, encode, write, format_name, named):
    data, right = encode(ball, format_name), format_name[-4:]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        expected = load_probe(write(f"b{right}.gz", gzip.compress(data)))
    assert expected.name == "b"
    told = contextlib.nullcontext()
    if not named.startswith(f"a{right}"):
        told = pytest.warns(MeshWarning, match=f"it holds {right[1:].upper()}")
    with told:
        probe = load_probe(write(named, gzip.compress(data) if named.endswith("gz") else data))
    assert (probe.vertices[probe.faces] == expected.vertices[expected.faces]).all()


def test_path_that_cannot_exist(tmp_path):
    refuse(tmp_path / "a\0b.stl", "cannot be reached")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_pipe_is_refused_without_waiting(tmp_path):
    path = tmp_path / "pipe.stl"
    os.mkfifo(path)
    refuse(path, "this is a device or a pipe")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read everything")
def test_unreadable_file(write):
    path = write("secret.stl", b"solid")
    path.chmod(0)
    refuse(path, "cannot be read")


def test_oversized_file_is_refused_before_it_is_read(tmp_path):
    path = tmp_path / "huge.stl"
    with path.open("wb") as stream:
        stream.truncate(2**29 + 1)  # sparse: takes no space
    refuse(path, "more than 512 MiB")


@pytest.mark.parametrize("suffix", [".stl", ".ply", ".obj"])
@pytest.mark.parametrize(
    "data", [b"hello, this is no mesh\n" * 20, bytes(range(256)) * 3, b"\0" * 500, b"\n", b"\xff"]
)
def test_garbage(write, suffix, data):
    refuse(write(f"garbage{suffix}", data), "(STL|PLY|OBJ)")


def test_nan_in_a_file(ball, encode, write, format_name):
    mesh = trimesh.Trimesh(ball.vertices.copy(), ball.faces, process=False)
    mesh.vertices[0, 1] = np.nan
    refuse(
        write(format_name, encode(mesh, format_name)), r"vertex 1 is .*nan.*; . of \d+ vertices .* not finite"
    )


def test_signalling_nan_is_a_nan_like_any_other(ball, write):
    for name in ("ball.stl", "ball.ply"):
        data = bytearray(ball.export(file_type=name[-3:]))
        at = 84 + 12 if name == "ball.stl" else data.index(b"end_header\n") + 11
        data[at : at + 4] = b"\x01\x00\xa0\x7f"
        refuse(write(name, bytes(data)), r"vertex 1 is .* not finite")


@pytest.mark.parametrize("share", [0.3, 0.7, 0.95])
def test_truncated(ball, encode, write, format_name, share):
    data = encode(ball, format_name)
    if format_name == "mesh.obj":
        # Nothing in an OBJ file says how many facets there should be: cut where vertices are missing.
        lines = data.splitlines(keepends=True)
        vertices = [line for line in lines if line.startswith(b"v ")]
        data = b"".join(
            vertices[: int(share * len(vertices))] + [line for line in lines if line[:2] == b"f "]
        )
    else:
        data = data[: int(share * len(data))]
    refuse(write(format_name, data), "cut short|damaged")


# ----  --------------------------------------------------------------------------------------------


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


@pytest.mark.parametrize("name", ["saved.stl", "saved.ply.gz"])
def test_a_saved_probe_keeps_its_suffix(box, tmp_path, write, name):
    save_probe(Probe.from_arrays(*box), tmp_path / "saved.ply")
    data = (tmp_path / "saved.ply").read_bytes()
    refuse(
        write(name, gzip.compress(data) if name.endswith("gz") else data),
        "unpack it, and end its name in .ply",
    )


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

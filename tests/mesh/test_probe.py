import dataclasses
import json
from dataclasses import replace

import numpy as np
import pytest
from contact_cases import bundled

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import MeshError, Probe, load_probe, save_probe
from contactbench.pipeline.mesh.regions.region import Region, RegionError, RegionSet
from contactbench.pipeline.mesh.sidecar import ProbeFile, load_probe_file, save_probe_file


def test_holds_what_it_is_given(box):
    vertices, faces = box
    probe = Probe.from_arrays(vertices, faces, np.arange(12) % 3, name="box")
    assert probe.name == "box"
    np.testing.assert_array_equal(probe.vertices, vertices)
    np.testing.assert_array_equal(probe.faces, faces)
    np.testing.assert_array_equal(probe.region, np.arange(12) % 3)
    assert (probe.vertices.dtype, probe.faces.dtype, probe.region.dtype) == (np.float64, np.int32, np.int32)
    assert probe.health.sentences == ()


def test_region_is_none_by_default(box):
    assert not Probe.from_arrays(*box).region.any()


def test_geometry_of_a_box(box):
    probe = Probe.from_arrays(*box)
    np.testing.assert_allclose(probe.bounds, [[-0.03, -0.02, -0.01], [0.03, 0.02, 0.01]])
    assert probe.size == pytest.approx(0.06)
    assert probe.areas.sum() == pytest.approx(2 * (0.06 * 0.04 + 0.06 * 0.02 + 0.04 * 0.02))
    np.testing.assert_allclose(np.linalg.norm(probe.normals, axis=1), 1)
    centres = probe.vertices[probe.faces].mean(axis=1)
    assert (np.einsum("ij,ij->i", centres, probe.normals) > 0).all()


def test_every_array_is_contiguous_and_read_only(box):
    probe = Probe.from_arrays(np.asfortranarray(box[0]), np.asfortranarray(box[1]))
    for field in ("vertices", "faces", "region", "normals", "areas", "bounds"):
        array = getattr(probe, field)
        assert array.flags.c_contiguous, field
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    with pytest.raises(dataclasses.FrozenInstanceError):
        probe.name = "other"


@pytest.mark.parametrize("index", [0, 1, 2])
def test_inputs_are_copied_even_in_the_right_dtype(box, index):
    arrays = [box[0].copy(), box[1].astype(np.int32), np.ones(12, dtype=np.int32)]
    probe = Probe.from_arrays(*arrays)
    arrays[index][:] = 0
    assert (probe.vertices.any(), probe.faces.any(), probe.region.all()) == (True, True, True)
    assert arrays[index].flags.writeable


def test_with_region_shares_the_surface_and_checks(box):
    probe = Probe.from_arrays(*box)
    painted = probe.with_region(np.ones(12, dtype=np.uint8))
    assert painted.vertices is probe.vertices
    assert painted.region.tolist() == [1] * 12
    assert not probe.region.any()
    with pytest.raises(ValueError, match="read-only"):
        painted.region[0] = 2
    with pytest.raises(MeshError, match="region: row 3 is -1"):
        probe.with_region([0, 0, 0, -1] + [0] * 8)


def test_unused_vertices_stay_but_do_not_count(box):
    vertices = np.vstack((box[0], [[1e6, 0, 0]]))
    probe = Probe.from_arrays(vertices, box[1])
    assert len(probe.vertices) == 9
    assert probe.size == pytest.approx(0.06)
    assert probe.health.components == 1


def test_error_is_an_input_error(box):
    with pytest.raises(InputError):
        Probe.from_arrays(box[0], [])


@pytest.mark.parametrize(
    ("vertices", "message"),
    [
        (np.zeros((8, 2)), r"vertices must have shape \(n, 3\), not \(8, 2\)"),
        (np.zeros(24), r"vertices must have shape \(n, 3\), not \(24,\)"),
        (np.zeros((8, 3), dtype=complex), "vertices must be real numbers in metres, not complex128"),
        (np.zeros((8, 3), dtype=bool), "vertices must be real numbers in metres, not bool"),
        ([["a", "b", "c"]] * 8, "vertices must be real numbers"),
        ([[0, 0, 0], [0, 0]], "vertices cannot be read as an array"),
        (None, "vertices must be real numbers"),
    ],
)
def test_refuses_vertices_of_the_wrong_kind(box, vertices, message):
    with pytest.raises(MeshError, match=message):
        Probe.from_arrays(vertices, box[1])


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_refuses_vertices_that_are_not_finite(box, bad):
    vertices = box[0].copy()
    vertices[5, 1] = vertices[6, 2] = bad
    with pytest.raises(MeshError, match=r"vertices: row 5 .* is not a finite point; 2 of 8 rows"):
        Probe.from_arrays(vertices, box[1])


def test_refuses_vertices_beyond_any_length(box):
    vertices = box[0].copy()
    vertices[2, 0] = 1e300
    with pytest.raises(MeshError, match=r"vertices: row 2 .* is impossibly far away"):
        Probe.from_arrays(vertices, box[1], check_size=False)


@pytest.mark.parametrize(
    ("faces", "message"),
    [
        ([], "there are no facets"),
        (np.zeros((0, 3), dtype=int), "there are no facets"),
        ([[0.0, 1.0, 2.0]], "faces must be integers, not float64"),
        (np.ones((2, 3), dtype=bool), "faces must be integers, not bool"),
        ([[0, 1, 2, 3]], r"faces must have shape \(m, 3\), not \(1, 4\): split polygons"),
        ([0, 1, 2], r"faces must have shape \(m, 3\), not \(3,\)"),
        ([[0, 1, 2], [0, 1]], "faces cannot be read as an array"),
        ([[0, 1, 2], [3, -1, 4]], "faces: row 1 refers to vertex -1, but the indices run from 0 to 7"),
        (
            [[0, 1, 2], [0, 1, 3], [2, 5, 8]],
            "faces: row 2 refers to vertex 8, but the indices run from 0 to 7",
        ),
        (np.array([[0, 1, 2**63]], dtype=np.uint64), "faces: row 0 refers to vertex 9223372036854775808"),
        (np.array([[0, 1, 2**32]]), "faces: row 0 refers to vertex 4294967296"),
    ],
)
def test_refuses_bad_faces(box, faces, message):
    with pytest.raises(MeshError, match=message):
        Probe.from_arrays(box[0], faces)


def test_refuses_a_facet_that_uses_a_vertex_twice(box):
    faces = box[1].copy()
    faces[4] = [1, 1, 2]
    faces[7] = [3, 2, 3]
    with pytest.raises(MeshError, match=r"faces: row 4 \[1, 1, 2\] uses a vertex twice; 2 of 12.*load_probe"):
        Probe.from_arrays(box[0], faces)


@pytest.mark.parametrize("scale", [1e-5, 1.0, 2e4])
def test_refuses_a_facet_without_area_at_any_scale(box, scale):
    # A third of the way along an edge is not a float64: the area is rounding, not zero.
    middle = box[0][0] + (box[0][1] - box[0][0]) / 3
    vertices = np.vstack((box[0], [middle])) * scale
    faces = np.vstack((box[1], [[0, 1, 8]]))
    with pytest.raises(MeshError, match=r"faces: row 12 \[0, 1, 8\] has zero area; 1 of 13"):
        Probe.from_arrays(vertices, faces, check_size=False)


@pytest.mark.parametrize("scale", [1e-5, 1.0, 2e4])
def test_keeps_slivers_that_are_thin_but_real(box, scale):
    # A millionth of a micron high, a thousand times thinner than float32 can tell.
    middle = (box[0][0] + box[0][1]) / 2 + 1e-12 * np.array([1.0, 2.0, 3.0])
    vertices = np.vstack((box[0], [middle])) * scale
    probe = Probe.from_arrays(vertices, np.vstack((box[1], [[0, 1, 8]])), check_size=False)
    assert probe.areas[-1] > 0
    np.testing.assert_allclose(np.linalg.norm(probe.normals, axis=1), 1)


@pytest.mark.parametrize(
    ("region", "message"),
    [
        ([0, 1], r"region has shape \(2,\), but there are 12 facets"),
        (np.zeros((12, 1), dtype=int), r"region has shape \(12, 1\)"),
        (np.zeros(12), "region must be integers, not float64"),
        ([0] * 11 + [-3], "region: row 11 is -3: use 0 for no region"),
        ([2**31] + [0] * 11, "region: row 0 is 2147483648"),
    ],
)
def test_refuses_bad_regions(box, region, message):
    with pytest.raises(MeshError, match=message):
        Probe.from_arrays(*box, region)


def test_refuses_a_probe_that_is_too_large(box):
    with pytest.raises(
        MeshError, match=r"probe is 60000 mm long, more than 2000 mm: is the file in milli.*'mm'"
    ):
        Probe.from_arrays(box[0] * 1000, box[1])


def test_refuses_a_probe_that_is_too_small(box):
    with pytest.raises(MeshError, match=r"probe is 0.06 mm long, less than 5 mm.*check_size=False"):
        Probe.from_arrays(box[0] / 1000, box[1])


@pytest.mark.parametrize("size", [1e-6, 1000.0, 1e-30])
def test_any_size_works_without_the_check(ball, size):
    unit = (ball.vertices - ball.vertices.mean(axis=0)) / 80
    small = Probe.from_arrays(unit * size, ball.faces, check_size=False)
    plain = Probe.from_arrays(unit, ball.faces)
    np.testing.assert_allclose(small.normals, plain.normals, atol=1e-12)
    np.testing.assert_allclose(small.areas / size**2, plain.areas, rtol=1e-9)
    assert small.health == plain.health
    assert small.health.sentences == ()


# ---- A probe on disk: the surface, and beside it names and history -------------------------------


@pytest.fixture
def content():
    probe = bundled("linear", 500)
    labels = np.zeros(len(probe.faces), dtype=np.int32)
    labels[:40], labels[40:60] = 1, 2
    regions = RegionSet.from_labels(labels, (Region("lens", "#112233"), Region("edge", "#445566")))
    invented = np.arange(len(labels)) % 7 == 0
    start = ProbeFile(probe.with_invented(invented).with_region(labels), regions)
    return start.after("paint", start.probe, {"by": "hand"}, {"changed": 60}, frame="S")


def test_everything_comes_back(content, tmp_path):
    save_probe_file(content, tmp_path / "probe.ply")
    back = load_probe_file(tmp_path / "probe.ply")
    assert np.array_equal(back.probe.vertices, content.probe.vertices)
    assert np.array_equal(back.probe.faces, content.probe.faces)
    assert np.array_equal(back.probe.region, content.regions.labels)
    assert np.array_equal(back.probe.invented, content.probe.invented)
    assert [region.name for region in back.regions.regions] == ["lens", "edge"]
    assert (back.frame, back.history, back.notes) == ("S", content.history, ())


def test_what_nothing_can_touch_comes_back_in_both_files(content, tmp_path):
    lens, edge = content.regions.regions
    painted = replace(content.regions, regions=(lens, replace(edge, untouchable=True)))
    marked = replace(content, regions=painted)
    assert marked.probe.untouchable == (2,)
    assert marked.after("simplify", bundled("linear", 100), {}, {}).probe.untouchable == (2,)
    file = tmp_path / "probe.ply"
    save_probe_file(marked, file)
    back = load_probe_file(file)
    assert [region.untouchable for region in back.regions.regions] == [False, True]
    assert back.probe.untouchable == load_probe(file, "m").untouchable == (2,)
    file.with_suffix(".json").unlink()
    alone = load_probe_file(file)
    assert [region.untouchable for region in alone.regions.regions] == [False, True]
    assert alone.probe.untouchable == (2,)


def test_files_from_before_there_were_marks_are_touchable(content, tmp_path):
    save_probe_file(content, tmp_path / "probe.ply")
    assert b"untouchable" not in (tmp_path / "probe.ply").read_bytes()
    assert b"untouchable" not in (tmp_path / "probe.json").read_bytes()
    assert load_probe_file(tmp_path / "probe.ply").probe.untouchable == ()


def test_the_same_content_gives_the_same_bytes(content, tmp_path):
    for name in ("a", "b"):
        save_probe_file(content, tmp_path / f"{name}.ply")
    save_probe_file(load_probe_file(tmp_path / "a.ply"), tmp_path / "c.ply")
    for suffix in (".ply", ".json"):
        assert len({(tmp_path / f"{name}{suffix}").read_bytes() for name in "abc"}) == 1


def test_a_step_knows_what_went_in_and_what_came_out(content):
    smaller = bundled("linear", 100)
    after = content.after("simplify", smaller, {"facets": 100}, {"facets": len(smaller.faces)})
    before, step = after.history
    assert step["step"] == "simplify"
    assert step["input"]["sha256"] == before["output"]["sha256"] != step["output"]["sha256"]
    assert step["output"]["facets"] == len(smaller.faces)
    assert step["tool"].startswith("contactbench ")
    assert after.frame == "S"
    assert [region.name for region in after.regions.regions] == ["lens", "edge"]


def test_a_file_changed_by_another_program_is_noticed(content, tmp_path):
    file = tmp_path / "probe.ply"
    save_probe_file(content, file)
    save_probe(content.probe.with_region(np.zeros(len(content.probe.faces), dtype=int)), file)
    back = load_probe_file(file)
    assert len(back.notes) == 1
    assert "was changed after contactbench wrote it" in back.notes[0]


def test_colours_are_for_viewers(content, tmp_path):
    import trimesh

    save_probe_file(content, tmp_path / "probe.ply")
    seen = trimesh.load_mesh(tmp_path / "probe.ply", process=False)
    raw = seen.metadata["_ply_raw"]["face"]["data"]
    colours = np.column_stack([np.ravel(raw[name]) for name in ("red", "green", "blue")])
    plain = (content.probe.region == 0) & ~content.probe.invented
    assert (colours[plain] == 200).all()
    assert (colours[(content.probe.region == 0) & content.probe.invented] == (70, 70, 70)).all()
    assert (colours[(content.probe.region == 1) & ~content.probe.invented] == (0x11, 0x22, 0x33)).all()
    assert len(np.unique(colours, axis=0)) == 6


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("[]", "does not hold one object"),
        ("{", "not a JSON file"),
        ('{"schema": "other"}', "does not belong to a probe"),
        ('{"version": 2}', "use a newer contactbench"),
        ('{"version": "1"}', "does not belong to a probe"),
        ('{"regions": {}}', "not a list of names"),
        ('{"regions": [{"name": "a"}]}', "colour"),
        ('{"regions": [1]}', "region 1 of the file is not an object"),
        ('{"history": {}}', "not a list of at most"),
        ('{"history": [{"step": 1}]}', "step 1 of 'history'"),
        ('{"mesh": {"frame": "Q"}}', "frame is P or S"),
        ('{"mesh": 1}', "frame is P or S"),
    ],
)
def test_a_broken_history_is_refused_by_name(content, tmp_path, text, match):
    save_probe_file(content, tmp_path / "probe.ply")
    (tmp_path / "probe.json").write_text(text, encoding="utf-8")
    with pytest.raises(RegionError, match=match) as caught:
        load_probe_file(tmp_path / "probe.ply")
    assert str(tmp_path / "probe.json") in str(caught.value)


def test_what_else_the_json_holds_stays(content, tmp_path):
    (tmp_path / "probe.json").write_text('{"serial": 7}', encoding="utf-8")
    save_probe_file(content, tmp_path / "probe.ply")
    document = json.loads((tmp_path / "probe.json").read_text(encoding="utf-8"))
    assert document["serial"] == 7
    assert document["mesh"]["frame"] == "S"


def test_only_ply_in_a_folder_that_exists(content, tmp_path):
    with pytest.raises(MeshError, match=r"end the name in \.ply"):
        save_probe_file(content, tmp_path / "probe.stl")
    with pytest.raises(MeshError, match="cannot be written"):
        save_probe_file(content, tmp_path / "no" / "probe.ply")
    with pytest.raises(RegionError, match="stored in a probe's PLY"):
        load_probe_file(tmp_path / "probe.stl")


def test_invented_facets_are_read_by_load_probe_too(content, tmp_path):
    save_probe(content.probe, tmp_path / "probe.ply")
    assert np.array_equal(load_probe(tmp_path / "probe.ply", "m").invented, content.probe.invented)

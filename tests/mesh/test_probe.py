from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import MeshError, Probe


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

"""Distances between surfaces whose distance is known."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from contactbench.pipeline.mesh import Probe, triangles
from contactbench.pipeline.mesh.deviation import compare, doubled_areas, measure_deviation, sample_surface
from contactbench.pipeline.mesh.triangles import cross_products, first_alike, vertex_normals


def _ball(radius: float, level: int = 3) -> Probe:
    mesh = trimesh.creation.icosphere(level, radius=radius)
    return Probe.from_arrays(mesh.vertices, mesh.faces)


def _box(shift: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Probe:
    mesh = trimesh.creation.box(extents=(0.06, 0.04, 0.02))
    return Probe.from_arrays(np.asarray(mesh.vertices) + shift, mesh.faces)


def _plate(angle_deg: float) -> Probe:
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    corners = np.array([[-0.02, -0.02, 0], [0.02, -0.02, 0], [0.02, 0.02, 0], [-0.02, 0.02, 0]])
    return Probe.from_arrays(corners @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]]), [[0, 1, 2], [0, 2, 3]])


def test_a_surface_is_nowhere_from_itself() -> None:
    deviation = measure_deviation(_ball(0.03), _ball(0.03))
    assert deviation.hausdorff < 1e-15
    assert deviation.normal_mean_deg < 0.1


def test_concentric_balls_are_their_radii_apart() -> None:
    deviation = measure_deviation(_ball(0.030, 4), _ball(0.031, 4))
    assert deviation.hausdorff == pytest.approx(0.001, rel=0.02)
    assert deviation.rms == pytest.approx(0.001, rel=0.02)
    assert deviation.p95 == pytest.approx(0.001, rel=0.02)
    assert deviation.normal_mean_deg < 0.2


def test_either_order_gives_the_same() -> None:
    one, other = measure_deviation(_box(), _ball(0.02)), measure_deviation(_ball(0.02), _box())
    assert one.hausdorff == pytest.approx(other.hausdorff, rel=0.01)
    assert one.rms == pytest.approx(other.rms, rel=0.01)


def test_a_dent_between_all_vertices_of_one_side_is_seen_from_the_other() -> None:
    box = _box()
    top = np.flatnonzero(box.normals[:, 2] > 0.9)[0]
    a, b, c = box.faces[top]
    dented = Probe.from_arrays(
        np.vstack([box.vertices, box.vertices[[a, b, c]].mean(axis=0) - [0, 0, 0.005]]),
        np.vstack([np.delete(box.faces, top, axis=0), [[a, b, 8], [b, c, 8], [c, a, 8]]]),
    )
    assert measure_deviation(box, dented).hausdorff == pytest.approx(0.005, rel=1e-9)
    assert measure_deviation(dented, box).hausdorff == pytest.approx(0.005, rel=1e-9)


@given(st.tuples(*[st.floats(-0.005, 0.005)] * 3))
@settings(max_examples=15, deadline=None)
def test_a_shift_is_never_measured_longer_than_it_is(shift: tuple[float, float, float]) -> None:
    deviation = compare(_box(), _box(shift), uniform=2000).deviation()
    assert deviation is not None
    assert deviation.hausdorff <= np.linalg.norm(shift) + 1e-15
    # Each face that moved outwards is that far from the box.
    assert deviation.hausdorff >= np.abs(shift).max() - 1e-15
    assert deviation.rms <= deviation.hausdorff
    assert deviation.p95 <= deviation.hausdorff


def test_a_tilt_is_the_angle_between_the_normals() -> None:
    deviation = measure_deviation(_plate(0), _plate(10))
    assert deviation.normal_mean_deg == pytest.approx(10)
    assert deviation.normal_p95_deg == pytest.approx(10)
    assert deviation.normal_max_deg == pytest.approx(10)
    # The edge rises by sin 10°; the nearest point of the flat plate is straight below.
    assert deviation.hausdorff == pytest.approx(0.02 * np.sin(np.radians(10)), rel=1e-6)


def test_lengths_scale_with_the_surface_to_the_last_bit() -> None:
    one, other = _ball(0.03), _box()
    small = measure_deviation(one, other)
    large = measure_deviation(
        Probe.from_arrays(one.vertices * 8, one.faces), Probe.from_arrays(other.vertices * 8, other.faces)
    )
    assert (large.hausdorff, large.rms, large.p95) == (8 * small.hausdorff, 8 * small.rms, 8 * small.p95)
    assert large.normal_mean_deg == small.normal_mean_deg


def test_only_the_facets_asked_for_count() -> None:
    ball = _ball(0.03)
    upper = ball.vertices[:, 2] > 0.015
    bumped = Probe.from_arrays(np.where(upper[:, None], 1.1, 1.0) * ball.vertices, ball.faces)
    comparison = compare(ball, bumped)
    calm = (ball.vertices[ball.faces][:, :, 2] < 0).all(axis=1)
    below, above = comparison.deviation(calm, calm), comparison.deviation(~calm, ~calm)
    assert below is not None
    assert above is not None
    assert below.hausdorff < 1e-15
    assert above.hausdorff == pytest.approx(0.003, rel=0.02)
    none = np.zeros(len(ball.faces), dtype=bool)
    assert comparison.deviation(none, none) is None


def test_samples_are_spread_by_area_and_lie_on_their_facets() -> None:
    box = _box()
    samples = sample_surface(box, 6000)
    share = np.bincount(samples.facets[:6000], minlength=12) / 6000
    np.testing.assert_allclose(share, box.areas / box.areas.sum(), atol=1 / 3000)
    corner = box.vertices[box.faces[samples.facets, 0]]
    height = np.einsum("ij,ij->i", samples.points - corner, box.normals[samples.facets])
    assert np.abs(height).max() < 1e-15
    assert samples.spacing == pytest.approx(np.sqrt(box.areas.sum() / 6000))
    assert len(samples.points) == 6000 + 8 + 12
    assert len(sample_surface(box, 100, most=5).points) == 110


def test_vertices_that_no_facet_uses_are_not_on_the_surface() -> None:
    box = _box()
    stray = Probe.from_arrays(np.vstack([box.vertices, [[1.0, 1.0, 1.0]]]), box.faces)
    assert measure_deviation(box, stray).hausdorff < 1e-15


def test_doubled_areas_are_twice_the_areas_over_portions() -> None:
    ball = _ball(0.03, 6)
    assert len(ball.faces) > 1 << 16
    np.testing.assert_allclose(doubled_areas(ball.vertices, ball.faces), 2 * ball.areas, rtol=1e-12)


# ---- plain geometry of triangles -----------------------------------------------------------------


_NUMBERS = st.sampled_from([0.0, -0.0, 1.0, 1.0 + 2**-52, -1.0, 1e-300, 1e300])


@given(st.lists(st.tuples(_NUMBERS, _NUMBERS, _NUMBERS), min_size=1, max_size=40))
def test_each_row_has_the_first_one_that_is_equal(rows):
    found = first_alike(np.array(rows))
    assert found.tolist() == [next(k for k, other in enumerate(rows) if other == row) for row in rows]


@pytest.mark.parametrize("kind", [np.int32, np.float64])
def test_rows_that_only_look_alike_are_told_apart(kind, monkeypatch):
    rows = np.random.default_rng(0).integers(0, 30, (2_000, 3)).astype(kind)
    usual = first_alike(rows)
    # Every row has the same number now, so rows themselves are compared.
    monkeypatch.setattr(triangles, "_MIXER", np.uint64(0))
    np.testing.assert_array_equal(first_alike(rows), usual)
    np.testing.assert_array_equal(rows[usual], rows)


def test_normals_of_vertices_are_those_of_areas_not_of_facets():
    # The side at the back of the corner is cut in two: it counts by its area all the same.
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0], [0, 0.5, 0.5], [9, 9, 9]])
    faces = np.array([[0, 2, 1], [0, 4, 2], [0, 3, 4]], dtype=np.int32)
    normals = vertex_normals(cross_products(vertices, faces), faces, len(vertices))
    assert normals[0] == pytest.approx(-np.array([1, 0, 1]) / np.sqrt(2))
    assert normals[1] == pytest.approx([0, 0, -1])
    assert normals[5] == pytest.approx([0, 0, 0])

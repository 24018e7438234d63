"""Nearest points and rays, against searches over all facets."""

import numpy as np
import pytest
from contact_cases import ball, bundled
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from contactbench.pipeline.kernel import SurfaceIndex


def index_of(probe):
    return SurfaceIndex(probe.vertices, probe.faces)


def distance_to(point, corners):
    """Distance from a point to a triangle: to its plane where it projects inside, otherwise to its sides."""
    a, b, c = corners
    normal = np.cross(b - a, c - a)
    u, v, _ = np.linalg.solve(np.column_stack((b - a, c - a, normal)), point - a)
    if u >= 0 and v >= 0 and u + v <= 1:
        return abs((point - a) @ normal) / np.linalg.norm(normal)
    sides = []
    for start, end in ((a, b), (b, c), (c, a)):
        share = np.clip((point - start) @ (end - start) / ((end - start) @ (end - start)), 0, 1)
        sides.append(np.linalg.norm(point - start - share * (end - start)))
    return min(sides)


def test_closest_is_the_nearest_of_all_facets():
    probe = ball(320)
    rng = np.random.default_rng(0)
    points = probe.vertices.mean(axis=0) + rng.normal(0, 0.03, (40, 3))
    distance, face, place = index_of(probe).closest(points)
    corners = probe.vertices[probe.faces]
    for i, point in enumerate(points):
        every = [distance_to(point, triangle) for triangle in corners]
        assert distance[i] == pytest.approx(min(every), abs=1e-14)
        assert every[face[i]] == pytest.approx(min(every), abs=1e-14)
        assert np.linalg.norm(place[i] - point) == pytest.approx(distance[i], abs=1e-15)
        assert distance_to(place[i], corners[face[i]]) < 1e-14


def test_points_of_the_surface_are_found_where_they_are():
    probe = bundled("t-shape", 2000)
    distance, _, _ = index_of(probe).closest(probe.vertices)
    assert distance.max() == 0
    centres = probe.vertices[probe.faces].mean(axis=1)
    distance, face, place = index_of(probe).closest(centres)
    assert distance.max() < 1e-16
    assert np.array_equal(face, np.arange(len(centres)))
    assert place == pytest.approx(centres, abs=1e-16)


@settings(max_examples=25, deadline=None)
@given(arrays(np.float64, (9, 3), elements=st.floats(-1, 1, width=16)), st.integers(0, 2**32 - 1))
def test_any_triangles_even_flat_ones(vertices, seed):
    rng = np.random.default_rng(seed)
    faces = rng.integers(0, 9, (7, 3)).astype(np.int32)
    points = rng.uniform(-1, 1, (4, 3))
    together, face, place = SurfaceIndex(vertices, faces).closest(points)
    alone = np.array([SurfaceIndex(vertices, faces[i : i + 1]).closest(points)[0] for i in range(len(faces))])
    assert np.array_equal(together, alone.min(axis=0))
    assert np.array_equal(alone[face, np.arange(len(points))], alone.min(axis=0))
    assert np.isfinite(place).all()


def test_the_order_and_number_of_queries_changes_nothing():
    probe = bundled("convex", 2000)
    points = np.random.default_rng(1).uniform(-0.1, 0.2, (20_000, 3))
    index = index_of(probe)
    distance, face, place = index.closest(points)
    turned = np.random.default_rng(2).permutation(len(points))
    other = index.closest(np.ascontiguousarray(points[turned]))
    for one, two in zip((distance, face, place), other, strict=True):
        assert np.array_equal(one[turned], two)


def test_of_facets_around_a_corner_the_lowest_number_answers():
    """At a distance of exactly 0, which every box around the corner has as well; whatever was asked before."""
    probe = bundled("convex", 2000)
    lowest = np.full(len(probe.vertices), len(probe.faces))
    np.minimum.at(lowest, probe.faces.ravel(), np.repeat(np.arange(len(probe.faces)), 3))
    turned = np.random.default_rng(3).permutation(len(lowest))
    distance, face, _ = index_of(probe).closest(np.ascontiguousarray(probe.vertices[turned]))
    assert (distance == 0).all()
    assert np.array_equal(face, lowest[turned])


def test_a_ray_meets_what_a_search_over_all_facets_meets():
    probe = bundled("t-shape", 500)
    rng = np.random.default_rng(3)
    origins = probe.vertices.mean(axis=0) + rng.normal(0, 0.2, (60, 3))
    targets = probe.vertices[rng.integers(len(probe.vertices), size=60)] + rng.normal(0, 0.005, (60, 3))
    t, face = index_of(probe).first_hit(origins, targets - origins)
    a, b, c = (probe.vertices[probe.faces[:, k]] for k in range(3))
    for i in range(60):
        direction = targets[i] - origins[i]
        system = np.stack((b - a, c - a, np.tile(-direction, (len(a), 1))), axis=2)
        u, v, s = np.linalg.solve(system, (origins[i] - a)[..., None])[..., 0].T
        hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (s > 0)
        assert (face[i] >= 0) == hit.any()
        if hit.any():
            assert t[i] == pytest.approx(s[hit].min(), rel=1e-9)


def test_best_aligned_is_the_best_of_all_facets_that_are_near():
    probe = bundled("t-shape", 500)
    rng = np.random.default_rng(4)
    points = probe.vertices[rng.integers(len(probe.vertices), size=60)] + rng.normal(0, 0.002, (60, 3))
    directions = rng.normal(size=(60, 3))
    radius = rng.uniform(0, 0.02, 60)
    cosine, face = index_of(probe).best_aligned(points, directions, radius, probe.normals)
    corners = probe.vertices[probe.faces]
    for i, point in enumerate(points):
        near = np.array([distance_to(point, triangle) <= radius[i] for triangle in corners])
        assert (face[i] >= 0) == near.any()
        if near.any():
            assert near[face[i]]
            assert cosine[i] == pytest.approx((probe.normals[near] @ directions[i]).max(), abs=1e-12)
            assert probe.normals[face[i]] @ directions[i] == pytest.approx(cosine[i])
        else:
            assert cosine[i] == -1
    some, _ = index_of(probe).best_aligned(points, directions, radius, probe.normals, enough=0.5)
    assert ((some == cosine) | (some >= 0.5)).all()
    with pytest.raises(ValueError, match="not one per facet"):
        index_of(probe).best_aligned(points, directions, radius, probe.normals[:-1].copy())
    with pytest.raises(ValueError, match="differ in number"):
        index_of(probe).best_aligned(points, directions, radius[1:].copy(), probe.normals)


def test_no_ray_slips_through_a_closed_surface():
    """Rays at vertices and along edges are where facets that decide alone leave cracks."""
    probe = ball(320)
    inside = np.tile(probe.vertices.mean(axis=0), (len(probe.vertices), 1))
    index = index_of(probe)
    assert not index.escapes(inside, probe.vertices - inside).any()
    middles = (probe.vertices[probe.faces] + probe.vertices[np.roll(probe.faces, 1, axis=1)]).reshape(
        -1, 3
    ) / 2
    assert not index.escapes(np.tile(inside[0], (len(middles), 1)), middles - inside[0]).any()


def test_rays_along_an_axis_and_within_a_plane():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    index = SurfaceIndex(square, np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32))
    origins = np.array(
        [[0.5, 0.25, 1], [0.5, 0.25, -1], [2, 0.5, 1], [-1, 0.5, 0.1], [0.0, 0.5, 3]], dtype=float
    )
    towards = np.array([[0, 0, -1], [0, 0, -1], [0, 0, -1], [1, 0, 0], [0, 0, -2]], dtype=float)
    t, face = index.first_hit(origins, towards)
    assert t.tolist() == [1, np.inf, np.inf, np.inf, 1.5]
    assert face.tolist() == [0, -1, -1, -1, 1]
    assert index.escapes(origins, towards).tolist() == [False, True, True, True, False]
    sides = np.array([[0.0, 0.5, 1], [1.0, 0.5, 1], [0.5, 0.0, 1], [0.5, 1.0, 1]])
    assert not index.escapes(sides, np.tile([0.0, 0, -1], (4, 1))).any()  # 0 * inf, at the sides of the box


def test_wrong_input_is_refused():
    vertices, faces = np.eye(3), np.array([[0, 1, 2]], dtype=np.int32)
    with pytest.raises(ValueError, match="vertices: row 1 is not finite"):
        SurfaceIndex(np.array([[0, 0, 0], [np.nan, 0, 0], [1, 0, 0]]), faces)
    with pytest.raises(ValueError, match="row 0 refers to a vertex that is not there"):
        SurfaceIndex(vertices, np.array([[0, 1, 3]], dtype=np.int32))
    with pytest.raises(ValueError, match="there are none"):
        SurfaceIndex(vertices, np.zeros((0, 3), dtype=np.int32))
    index = SurfaceIndex(vertices, faces)
    assert len(index) == 1
    with pytest.raises(ValueError, match="points: row 0"):
        index.closest(np.array([[np.inf, 0, 0]]))
    with pytest.raises(ValueError, match="differ in number"):
        index.first_hit(vertices, vertices[:2].copy())
    assert [len(part) for part in index.closest(np.zeros((0, 3)))] == [0, 0, 0]

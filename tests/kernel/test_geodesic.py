"""Distances along the surface against exact ones, ways on it, and what a brush covers."""

import math

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from contactbench.pipeline.kernel import Geodesic


def flat(count: int = 1500, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A plane of random points: many obtuse facets."""
    xy = np.random.default_rng(seed).uniform(-0.98, 0.98, (count, 2))
    # An even rim: the hull of random points has slivers as long as a side.
    along = np.linspace(-1, 1, 41)[:-1]
    end = np.ones(40)
    xy[:160] = np.concatenate(
        [np.column_stack(side) for side in ((along, -end), (end, along), (-along, end), (-end, -along))]
    )
    return np.column_stack((xy, np.zeros(count))), Delaunay(xy).simplices.astype(np.int32)


def sphere(level: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """A unit sphere whose facets are irregular."""
    mesh = trimesh.creation.icosphere(level)
    shift = 0.25 * mesh.edges_unique_length.mean()
    vertices = mesh.vertices + np.random.default_rng(1).uniform(-shift, shift, mesh.vertices.shape)
    return vertices / np.linalg.norm(vertices, axis=1, keepdims=True), mesh.faces.astype(np.int32)


def cylinder(count: int = 4000) -> tuple[np.ndarray, np.ndarray]:
    """A tube of radius 1 and length 4 along z, of random points, without caps."""
    rng = np.random.default_rng(2)
    flat = np.column_stack((rng.uniform(0, 2 * math.pi, count), rng.uniform(-2, 2, count)))
    turns = [flat + [2 * math.pi * k, 0] for k in (-1, 0, 1)]
    triangles = Delaunay(np.concatenate(turns)).simplices
    middle = np.concatenate(turns)[triangles].mean(axis=1)[:, 0]
    faces = triangles[(middle >= 0) & (middle < 2 * math.pi)] % count
    faces = faces[[len(set(face)) == 3 for face in faces.tolist()]]
    vertices = np.column_stack((np.cos(flat[:, 0]), np.sin(flat[:, 0]), flat[:, 1]))
    return vertices, faces.astype(np.int32)


def around(geodesic: Geodesic, face: int, point: np.ndarray, limit: float) -> tuple[np.ndarray, np.ndarray]:
    _, found, distance = geodesic.around(np.array([face], dtype=np.int32), point[None], limit)
    return found, distance


def edge_of(vertices: np.ndarray, faces: np.ndarray) -> float:
    return float(np.linalg.norm(vertices[faces[:, 0]] - vertices[faces[:, 1]], axis=1).mean())


def source(
    vertices: np.ndarray, faces: np.ndarray, near: tuple[float, float, float]
) -> tuple[int, np.ndarray]:
    centroids = vertices[faces].mean(axis=1)
    face = int(np.argmin(np.linalg.norm(centroids - near, axis=1)))
    return face, np.ascontiguousarray(centroids[face])


@pytest.mark.parametrize("seed", range(5))
def test_distances_on_a_plane_are_exact(seed: int) -> None:
    vertices, faces = flat(seed=seed)
    face, point = source(vertices, faces, (0, 0, 0))
    found, distance = around(Geodesic(vertices, faces), face, point, 0.7)
    exact = np.linalg.norm(vertices - point, axis=1)
    np.testing.assert_allclose(distance, exact[found], atol=1e-12)
    assert found.tolist() == np.flatnonzero(exact <= 0.7).tolist()


@pytest.mark.parametrize("level", [3, 4, 5])
def test_distances_on_a_sphere_are_within_one_percent(level: int) -> None:
    vertices, faces = sphere(level)
    face, point = source(vertices, faces, (0.3, 0.5, 0.8))
    found, distance = around(Geodesic(vertices, faces), face, point, 1.5)
    exact = np.arccos(np.clip(vertices[found] @ (point / np.linalg.norm(point)), -1, 1))
    far = exact >= 5 * edge_of(vertices, faces)
    assert np.count_nonzero(far) > 100
    np.testing.assert_allclose(distance[far], exact[far], rtol=0.01)


def test_distances_on_a_cylinder_are_within_half_a_percent() -> None:
    vertices, faces = cylinder()
    face, point = source(vertices, faces, (1, 0, 0))
    found, distance = around(Geodesic(vertices, faces), face, point, 1.5)
    turn = np.arctan2(vertices[found, 1], vertices[found, 0]) - np.arctan2(point[1], point[0])
    exact = np.hypot((turn + math.pi) % (2 * math.pi) - math.pi, vertices[found, 2] - point[2])
    far = exact >= 5 * edge_of(vertices, faces)
    assert np.count_nonzero(far) > 100
    np.testing.assert_allclose(distance[far], exact[far], rtol=0.005)


def tube_of_strips() -> tuple[np.ndarray, np.ndarray]:
    """Facets as long as the tube and a hundred times thinner: no corner lies near the middle."""
    n = 200
    angle = np.linspace(0, 2 * math.pi, n, endpoint=False)
    ring = np.column_stack((0.02 * np.cos(angle), 0.02 * np.sin(angle), np.zeros(n)))
    i = np.arange(n)
    j = (i + 1) % n
    faces = np.concatenate((np.column_stack((i, j, j + n)), np.column_stack((i, j + n, i + n))))
    return np.concatenate((ring, ring + [0, 0, 0.1])), faces.astype(np.int32)


def test_long_thin_facets_are_crossed_in_the_middle() -> None:
    vertices, faces = tube_of_strips()
    geodesic = Geodesic(vertices, faces)
    geodesic.begin(0.02, geodesic=True)
    # Centroids alternate between one and two thirds of the length: 17 mm from the middle.
    covered = geodesic.extend(0, (vertices[0] + vertices[201]) / 2, True)
    centroids = vertices[faces].mean(axis=1)
    turn = np.arctan2(centroids[:, 1], centroids[:, 0])
    exact = np.hypot(0.02 * turn, centroids[:, 2] - 0.05)
    assert set(np.flatnonzero(exact < 0.0197)) <= set(covered) <= set(np.flatnonzero(exact < 0.0203))


def test_distances_from_many_points_are_those_from_the_nearest() -> None:
    vertices, faces = flat(4000)
    places = np.column_stack((np.linspace(-0.5, 0.5, 200), np.zeros((2, 200)).T))
    picked = [source(vertices, faces, place) for place in places]
    at, points = np.array([face for face, _ in picked], dtype=np.int32), np.array([p for _, p in picked])
    found, distance = Geodesic(vertices, faces).spread(at, points, 0.4)
    exact = np.linalg.norm(vertices[:, None] - points, axis=2).min(axis=1)
    assert found.tolist() == sorted(found.tolist())
    np.testing.assert_allclose(distance, exact[found], rtol=2e-3, atol=1e-9)
    assert set(np.flatnonzero(exact < 0.399)) <= set(found.tolist())


def test_a_stroke_covers_the_band_around_it() -> None:
    vertices, faces = flat(6000)
    geodesic = Geodesic(vertices, faces)
    centroids = vertices[faces].mean(axis=1)
    for straight in (False, True):
        geodesic.begin(0.2, geodesic=not straight)
        covered: set[int] = set()
        for x in (-0.5, 0.5):
            face, point = source(vertices, faces, (x, 0, 0))
            covered |= set(geodesic.extend(face, point, True).tolist())
        ends = [source(vertices, faces, (x, 0, 0))[1] for x in (-0.5, 0.5)]
        along = ends[1] - ends[0]
        t = np.clip((centroids - ends[0]) @ along / (along @ along), 0, 1)
        exact = np.linalg.norm(centroids - ends[0] - t[:, None] * along, axis=1)
        assert set(np.flatnonzero(exact < 0.19)) <= covered <= set(np.flatnonzero(exact < 0.203))


def test_each_facet_is_told_once_in_a_stroke() -> None:
    vertices, faces = flat()
    geodesic = Geodesic(vertices, faces)
    geodesic.begin(0.3, geodesic=True)
    face, point = source(vertices, faces, (0, 0, 0))
    first = geodesic.extend(face, point, True)
    assert len(first) > 50
    assert len(geodesic.extend(face, point, True)) == 0
    geodesic.begin(0.3, geodesic=True)
    assert geodesic.extend(face, point, True).tolist() == first.tolist()


def test_a_distance_does_not_disturb_a_stroke() -> None:
    vertices, faces = flat()
    face, point = source(vertices, faces, (0, 0, 0))
    other, there = source(vertices, faces, (0.3, 0, 0))
    covered = []
    for disturb in (False, True):
        geodesic = Geodesic(vertices, faces)
        geodesic.begin(0.2, geodesic=True)
        one = geodesic.extend(face, point, True)
        if disturb:
            around(geodesic, other, there, 0.5)
            geodesic.path(other, there, face, point)
        covered.append((one.tolist(), geodesic.extend(other, there, True).tolist()))
    assert covered[0] == covered[1]


def test_many_sources_are_as_each_alone() -> None:
    """More than one thread takes, of which one is beside the other's; and none at all."""
    vertices, faces = flat()
    geodesic = Geodesic(vertices, faces)
    at = np.random.default_rng(5).integers(len(faces), size=2_000).astype(np.int32)
    points = vertices[faces[at]].mean(axis=1)
    first, found, distance = geodesic.around(at, points, 0.1)
    assert first.dtype == np.int64
    assert first[0] == 0
    assert first[-1] == len(found) == len(distance)
    for i, (face, point) in enumerate(zip(at.tolist(), points, strict=True)):
        alone, far = around(geodesic, face, point, 0.1)
        assert found[first[i] : first[i + 1]].tolist() == alone.tolist() == sorted(set(alone.tolist()))
        assert distance[first[i] : first[i + 1]].tolist() == far.tolist()
    first, found, _ = geodesic.around(at[:0], points[:0], 0.1)
    assert (first.tolist(), len(found)) == ([0], 0)


def test_a_way_on_a_sphere_is_the_great_circle() -> None:
    vertices, faces = sphere()
    one, start = source(vertices, faces, (1, 0, 0.1))
    two, end = source(vertices, faces, (0.1, 1, 0.3))
    way = Geodesic(vertices, faces).path(one, start, two, end)
    np.testing.assert_array_equal(way[[0, -1]], [start, end])
    assert (np.linalg.norm(way, axis=1) > 0.99).all()  # on the surface, not through the body
    length = np.linalg.norm(np.diff(way, axis=0), axis=1).sum()
    exact = np.arccos(start @ end / np.linalg.norm(start) / np.linalg.norm(end))
    assert length == pytest.approx(exact, rel=0.01)


def test_there_is_no_way_between_parts() -> None:
    vertices, faces = sphere(2)
    both = np.concatenate((vertices, vertices + [3, 0, 0]))
    twice = np.concatenate((faces, faces + np.int32(len(vertices))))
    one, start = source(both, twice, (1, 0, 0))
    two, end = source(both, twice, (2, 0, 0))
    geodesic = Geodesic(both, twice)
    assert geodesic.path(one, start, two, end).shape == (0, 3)
    geodesic.begin(0.3, geodesic=True)
    geodesic.extend(one, start, True)
    assert (geodesic.extend(two, end, True) >= len(faces)).all()


def test_a_way_leads_around_a_hole() -> None:
    vertices, faces = flat(4000)
    middle = np.linalg.norm(vertices[faces].mean(axis=1), axis=1) > 0.3
    faces = np.ascontiguousarray(faces[middle])
    one, start = source(vertices, faces, (-0.5, 0, 0))
    two, end = source(vertices, faces, (0.5, 0, 0))
    way = Geodesic(vertices, faces).path(one, start, two, end)
    assert len(way) > 10
    assert np.linalg.norm(way, axis=1).min() > 0.28
    assert np.linalg.norm(np.diff(way, axis=0), axis=1).sum() < 1.6  # pi/2 around, and straight bits


def test_neighbours_are_those_across_edges() -> None:
    vertices, faces = sphere(2)
    first, second = Geodesic(vertices, faces).neighbours()
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    expected = {tuple(sorted(pair)) for pair in mesh.face_adjacency.tolist()}
    found = {
        tuple(sorted((f, g))) for f in range(len(faces)) for g in second[first[f] : first[f + 1]].tolist()
    }
    assert found == expected
    assert len(second) == 2 * len(expected)


def test_an_edge_of_many_facets_stays_connected() -> None:
    fins = 40
    angle = np.linspace(0, 2 * math.pi, fins, endpoint=False)
    vertices = np.concatenate(
        ([[0, 0, 0], [0, 0, 1.0]], np.column_stack((np.cos(angle), np.sin(angle), np.full(fins, 0.5))))
    )
    faces = np.array([[0, 1, 2 + k] for k in range(fins)], dtype=np.int32)
    first, second = Geodesic(vertices, faces).neighbours()
    seen, todo = {0}, [0]
    while todo:
        for g in second[first[todo[0]] : first[todo.pop(0) + 1]].tolist():
            if g not in seen:
                seen.add(g)
                todo.append(g)
    assert len(seen) == fins
    assert len(second) <= 8 * fins


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(4, 40), st.integers(1, 120), st.booleans())
def test_any_triangles_end(seed: int, points: int, count: int, geodesic: bool) -> None:
    """Soup: no manifold, slivers, coincident corners; distances are at least the straight ones."""
    rng = np.random.default_rng(seed)
    vertices = np.round(rng.normal(size=(points, 3)), int(rng.integers(0, 4)))
    faces = np.array([rng.choice(points, 3, replace=False) for _ in range(count)], dtype=np.int32)
    surface = Geodesic(vertices, faces)
    face = int(rng.integers(count))
    point = vertices[faces[face]].mean(axis=0)
    found, distance = around(surface, face, point, 2.0)
    straight = np.linalg.norm(vertices[found] - point, axis=1)
    assert np.isfinite(distance).all()
    assert (distance <= 2.0).all()
    connected_by_an_edge = np.isin(found, faces[face])
    np.testing.assert_allclose(distance[connected_by_an_edge], straight[connected_by_an_edge], atol=1e-9)
    surface.begin(0.5, geodesic)
    covered: list[int] = []
    for pick in rng.integers(count, size=5).tolist():
        fresh = surface.extend(pick, vertices[faces[pick]].mean(axis=0), True).tolist()
        covered += fresh
        assert pick in covered
    assert len(covered) == len(set(covered))


@pytest.mark.parametrize("geodesic", [True, False])
def test_a_brush_finer_than_any_facet_covers_the_way(geodesic: bool) -> None:
    """As many stops as a quarter of the radius asks for would fill the memory."""
    vertices, faces = flat()
    surface = Geodesic(vertices, faces)
    surface.begin(1e-12, geodesic)
    one, start = source(vertices, faces, (-0.5, 0, 0))
    two, end = source(vertices, faces, (0.5, 0.1, 0))
    covered = {*surface.extend(one, start, True), *surface.extend(two, end, True)}
    assert {one, two} < covered
    middle = vertices[faces[sorted(covered)]].mean(axis=1)
    assert np.abs(middle[:, 1] - 0.05 - 0.1 * middle[:, 0]).max() < 2 * edge_of(vertices, faces)


@pytest.mark.parametrize(
    ("call", "error"),
    [
        (lambda g: around(g, -1, np.zeros(3), 1.0), IndexError),
        (lambda g: around(g, 10**9, np.zeros(3), 1.0), IndexError),
        (lambda g: around(g, 0, np.array([0, np.nan, 0]), 1.0), ValueError),
        (lambda g: around(g, 0, np.zeros(3), math.inf), ValueError),
        (lambda g: g.around(np.zeros(2, dtype=np.int32), np.zeros((1, 3)), 1.0), ValueError),
        (lambda g: g.around(np.zeros(1), np.zeros((1, 3)), 1.0), TypeError),
        (lambda g: g.spread(np.array([10**6], dtype=np.int32), np.zeros((1, 3)), 1.0), IndexError),
        (lambda g: g.begin(0.0, True), ValueError),
        (lambda g: g.begin(math.nan, True), ValueError),
        (lambda g: g.extend(0, np.zeros(3), True), ValueError),
    ],
)
def test_nonsense_is_refused(call: object, error: type[Exception]) -> None:
    surface = Geodesic(*sphere(1))
    with pytest.raises(error):
        call(surface)  # type: ignore[operator]


def test_broken_meshes_are_refused() -> None:
    vertices = np.eye(3)
    for faces in ([[0, 1, 3]], [[0, 1, -1]], [[0, 1, 1]], np.empty((0, 3))):
        with pytest.raises(ValueError, match="facet"):
            Geodesic(vertices, np.array(faces, dtype=np.int32))
    with pytest.raises(ValueError, match="finite"):
        Geodesic(np.full((3, 3), np.nan), np.array([[0, 1, 2]], dtype=np.int32))

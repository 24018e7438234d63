import time

import numpy as np
import pytest

from contactbench.assets import PROBE_NAMES, make, surface, tessellate
from contactbench.assets.triangulation import Fronts

SIZES = (300, 500, 1000, 1234, 5001, 20_000)


def edges(faces):
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).astype(np.int64)


def facet_normals(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    cross = np.cross(b - a, c - a)
    return cross / np.linalg.norm(cross, axis=1, keepdims=True), np.linalg.norm(cross, axis=1) / 2


def quality(vertices, faces):
    """4 sqrt(3) area / sum of squared sides: 1 for equilateral triangles, 0 for slivers."""
    squares = sum(((vertices[faces[:, k]] - vertices[faces[:, k - 1]]) ** 2).sum(axis=1) for k in range(3))
    return 4 * np.sqrt(3) * facet_normals(vertices, faces)[1] / squares


def volume(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def assert_closed(vertices, faces):
    directed = edges(faces)
    count = len(vertices)
    forward = np.sort(directed[:, 0] * count + directed[:, 1])
    backward = np.sort(directed[:, 1] * count + directed[:, 0])
    assert (np.diff(forward) > 0).all(), "an edge is walked twice in one direction"
    assert np.array_equal(forward, backward), "an edge has no opposite"
    assert np.array_equal(np.unique(faces), np.arange(count)), "a vertex is unused"
    assert count - len(forward) // 2 + len(faces) == 2, "not one sphere-like piece"


@pytest.mark.parametrize("faces", SIZES)
@pytest.mark.parametrize("name", PROBE_NAMES)
def test_mesh_is_closed_oriented_and_of_the_wanted_size(name, faces):
    vertices, triangles = make(name, faces)
    assert vertices.dtype == np.float64
    assert triangles.dtype == np.int32
    assert abs(len(triangles) - faces) <= 0.05 * faces
    assert_closed(vertices, triangles)
    assert volume(vertices, triangles) > 80e-6
    assert len(np.unique(vertices, axis=0)) == len(vertices)


@pytest.mark.parametrize("name", PROBE_NAMES)
def test_every_small_size_is_closed(name):
    for faces in range(100, 700, 31):
        assert_closed(*make(name, faces))


@pytest.mark.parametrize("name", PROBE_NAMES)
def test_no_vertex_star_is_pinched(name):
    """The facets around each vertex form one cycle, so that every vertex is a manifold point."""
    vertices, faces = make(name, 2000)
    following = [{} for _ in vertices]
    for a, b, c in faces.tolist():
        following[a][b], following[b][c], following[c][a] = c, a, b
    for around in following:
        start = at = next(iter(around))
        steps = 0
        while steps == 0 or at != start:
            at, steps = around[at], steps + 1
        assert steps == len(around)


@pytest.mark.parametrize("faces", [500, 5_000])
@pytest.mark.parametrize("name", PROBE_NAMES)
def test_vertices_are_on_the_surface(name, faces):
    vertices, _ = make(name, faces)
    assert np.abs(surface(name).project(vertices)[2]).max() < 1e-9


@pytest.mark.parametrize("name", PROBE_NAMES)
def test_facet_normals_approach_those_of_the_surface(name):
    means = []
    for faces in (1000, 4000, 16_000):
        vertices, triangles = make(name, faces)
        normals, areas = facet_normals(vertices, triangles)
        true = surface(name).project(vertices[triangles].mean(axis=1))[1]
        cosine = np.clip(np.einsum("ij,ij->i", normals, true), -1, 1)
        means.append(np.average(np.degrees(np.arccos(cosine)), weights=areas))
    assert means[0] < 10
    assert (np.divide(means[1:], means[:-1]) < 0.75).all()
    assert means[-1] < 1.6


@pytest.mark.parametrize("name", PROBE_NAMES)
def test_deviation_falls_with_the_square_of_the_facet_size(name):
    deviations = []
    for faces in (2000, 8000, 32_000):
        vertices, triangles = make(name, faces)
        _, areas = facet_normals(vertices, triangles)
        distance = surface(name).project(vertices[triangles].mean(axis=1))[2]
        deviations.append(np.average(np.abs(distance), weights=areas))
    # Four times the facets is half their size: a quarter of the deviation.
    assert np.divide(deviations[1:], deviations[:-1]) == pytest.approx([0.25] * 2, abs=0.06)
    assert deviations[0] < 0.2e-3


@pytest.mark.parametrize("faces", [500, 2000, 20_000])
@pytest.mark.parametrize("name", PROBE_NAMES)
def test_facets_are_well_shaped(name, faces):
    shape = quality(*make(name, faces))
    assert shape.min() > 0.5
    assert np.median(shape) > 0.87


@pytest.mark.parametrize("name", PROBE_NAMES)
def test_same_call_gives_the_same_bytes(name):
    first = make(name, 3000)
    Fronts.of.cache_clear()
    again = make(name, 3000)
    assert all(a.tobytes() == b.tobytes() for a, b in zip(first, again, strict=True))


def test_a_third_of_a_million_facets_are_a_matter_of_seconds():
    start = time.process_time()
    vertices, faces = make("t-shape", 300_000)
    elapsed = time.process_time() - start
    assert abs(len(faces) - 300_000) <= 15_000
    assert_closed(vertices, faces)
    assert quality(vertices, faces).min() > 0.5
    assert elapsed < 10  # less than a second


def test_too_few_facets_are_refused():
    with pytest.raises(ValueError, match="at least 100"):
        tessellate(surface("linear"), 99)

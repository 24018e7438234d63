import time

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.probe import measure_health


def health_of(vertices, faces):
    return Probe.from_arrays(vertices, faces).health


def test_open_box(box):
    health = health_of(box[0], box[1][1:])
    assert not health.watertight
    assert health.boundary_edges == 3
    # An open box still shows which side is outside, wherever one stands in it.
    assert health.outward is True
    assert "surface is open (edges at a hole or gap: 3)" in health.sentences[0]


def test_open_and_inside_out(box):
    assert health_of(box[0], box[1][1:, ::-1]).outward is False


def test_flat_sheet_has_no_outside():
    health = health_of([[0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0], [0, 0.1, 0]], [[0, 1, 2], [0, 2, 3]])
    assert health.outward is None
    assert health.boundary_edges == 4


def test_folded_sheet_has_no_outside():
    health = health_of([[0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0]], [[0, 1, 2], [2, 1, 0]])
    assert health.watertight
    assert health.outward is None
    assert health.duplicate_facets == 0


def test_a_wall_inside_is_not_manifold(box):
    a, b, _ = box[1][0]
    vertices = np.vstack((box[0], [[0.0, 0.0, 0.001]]))
    health = health_of(vertices, np.vstack((box[1], [[a, b, 8]])))
    assert health.nonmanifold_edges == 1
    assert health.boundary_edges == 2
    # The wall runs along its edge in one of two directions: with three facets neither is wrong.
    assert health.winding_consistent
    assert any("More than two facets meet at an edge (edges: 1)" in text for text in health.sentences)


def test_duplicates_count_whichever_corner_comes_first(box):
    extra = [np.roll(box[1][2], 1), np.roll(box[1][2], 2), box[1][5]]
    health = health_of(box[0], np.vstack((box[1], extra)))
    assert health.duplicate_facets == 3
    assert any("(surplus: 3)" in text for text in health.sentences)


@pytest.mark.parametrize("seed", range(20))
def test_agrees_with_trimesh_on_damaged_meshes(seed):
    random = np.random.default_rng(seed)
    mesh = trimesh.creation.icosphere(subdivisions=2, radius=0.05)
    faces = mesh.faces[random.random(len(mesh.faces)) > 0.05 * (seed % 3)]
    flip = random.random(len(faces)) < 0.01 * (seed % 4)
    faces = np.where(flip[:, None], faces[:, ::-1], faces)
    ours = health_of(mesh.vertices, faces)
    theirs = trimesh.Trimesh(mesh.vertices, faces, process=False)
    assert ours.watertight == theirs.is_watertight
    assert ours.winding_consistent == theirs.is_winding_consistent
    edges, counts = np.unique(theirs.edges_sorted, axis=0, return_counts=True)
    assert ours.boundary_edges == np.count_nonzero(counts == 1)
    assert len(edges) == len(theirs.edges_unique)
    if ours.watertight and ours.winding_consistent:
        assert ours.outward == (theirs.volume > 0)


def test_is_quick_enough_for_a_quarter_million_facets():
    mesh = trimesh.creation.icosphere(subdivisions=7, radius=0.05)
    vertices, faces = np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32)
    began = time.process_time()
    measure_health(vertices, faces)
    # 0.15 s where this was written.
    assert time.process_time() - began < 1.5

"""Smaller facets of the same surface."""

import gc
import weakref

import numpy as np
import pytest
from benchmarks.preparation.shapes import bundled

from contactbench.pipeline.heatmap.subdivide import drawing_of, finer


@pytest.fixture(scope="module")
def probe():
    coarse = bundled("t-shape", 500)
    region = np.arange(len(coarse.faces)) % 3
    return coarse.with_region(region)


def longest(probe):
    corners = probe.vertices[probe.faces]
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max()


@pytest.mark.parametrize("edge", [20e-3, 5e-3, 1.5e-3])
def test_no_edge_is_longer_and_the_surface_is_the_same(probe, edge):
    made = finer(probe, edge)
    assert longest(made) <= edge
    assert made.areas.sum() == pytest.approx(probe.areas.sum(), rel=1e-12)
    assert np.array_equal(made.vertices[: len(probe.vertices)], probe.vertices)
    for priority in range(3):
        assert made.areas[made.region == priority].sum() == pytest.approx(
            probe.areas[probe.region == priority].sum(), rel=1e-12
        )


def test_no_gap_opens_and_no_facet_turns(probe):
    made = finer(probe, 2e-3)
    assert made.health.boundary_edges == probe.health.boundary_edges == 0
    volume = [
        np.einsum(
            "ij,ij->",
            np.cross(*np.moveaxis(each.vertices[each.faces][:, :2], 1, 0)),
            each.vertices[each.faces][:, 2],
        )
        for each in (probe, made)
    ]
    assert volume[1] == pytest.approx(volume[0], rel=1e-9)
    assert (np.linalg.norm(made.normals, axis=1) > 0.99).all()


def test_a_fine_mesh_is_itself_and_a_large_one_gets_no_more_than_a_picture_needs(probe):
    assert finer(probe, 1.0) is probe
    assert 30_000 < len(finer(probe, 1e-5).faces) < 300_000


def test_the_drawing_is_made_once_and_goes_with_its_probe():
    probe = bundled("linear", 500)
    drawing = drawing_of(probe)
    assert drawing_of(probe) is drawing is not probe
    assert drawing_of(drawing) is drawing
    gone = weakref.ref(probe)
    del probe
    gc.collect()
    assert gone() is None

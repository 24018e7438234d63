"""Smooth normals: what they solve, and what they leave as it is."""

import numpy as np
import pytest
from benchmarks.ablation.reading import drawn
from benchmarks.ablation.smooth import SmoothNormals, vertex_normals
from benchmarks.plane import FlatFace, _block

from contactbench.pipeline.contact import ContactSolver, WrenchNoise
from contactbench.pipeline.simulation.marker_touches import model_of

QUIET = WrenchNoise(1e-6, 1e-8)


@pytest.fixture(scope="module")
def coarse():
    """A coarse mesh of a curved probe, touches of the exact surface, and what flat facets make of them."""
    probe = model_of("convex", 500)
    touches = drawn("convex", 600, np.random.default_rng(3), torsion=0.001)
    return probe, touches, ContactSolver(probe, QUIET).locate_batch(touches.contacts)


def test_normals_at_vertices_are_of_length_1_and_point_outward():
    probe = model_of("linear", 500)
    normals = vertex_normals(probe)
    assert np.allclose(np.linalg.norm(normals, axis=1), 1.0)
    at_facets = normals[probe.faces].sum(axis=1)
    assert (np.einsum("md,md->m", at_facets, probe.normals) > 0).all()


def test_what_is_refined_solves_the_equation_with_the_interpolated_normal(coarse):
    probe, touches, found = coarse
    smooth = SmoothNormals(probe)
    points = smooth.refine(touches.contacts, found)
    normals = vertex_normals(probe)
    solved = 0
    for w, p, flat, facet in zip(touches.contacts, points, found.points, found.faces, strict=True):
        if facet < 0 or np.array_equal(p, flat):
            continue
        a, b, c = probe.vertices[probe.faces[facet]]
        weights = np.linalg.lstsq(
            np.vstack([np.column_stack([a, b, c]), np.ones(3)]), np.append(p, 1.0), rcond=None
        )[0]
        if weights.min() < 0:
            continue  # it has walked to a neighbour
        n = weights @ normals[probe.faces[facet]]
        left = w[3:] - np.cross(p, w[:3])
        assert np.linalg.norm(np.cross(left, n)) < 1e-4 * np.linalg.norm(w[3:])
        solved += 1
    assert solved > 300


def test_bulged_facets_halve_the_error_of_a_coarse_mesh_and_normals_alone_do_not(coarse):
    probe, touches, found = coarse
    smooth = SmoothNormals(probe)
    flat, normals, bulged = (
        np.linalg.norm(points - touches.points, axis=1)[found.accepted].mean()
        for points in (
            found.points,
            smooth.refine(touches.contacts, found),
            smooth.refine(touches.contacts, found, bulge=True),
        )
    )
    assert found.accepted.mean() > 0.99
    assert bulged < 0.6 * flat
    assert normals == pytest.approx(flat, rel=0.1)


def test_on_a_plane_nothing_changes_far_from_its_rim_and_what_is_not_found_stays_so():
    probe = _block()
    points, _ = FlatFace().sample(50, np.random.default_rng(0))
    forces = np.broadcast_to([0.0, 0.0, -9.0], points.shape)
    wrenches = np.hstack([forces, np.cross(points, forces)])
    wrenches[7] = 0.0
    found = ContactSolver(probe, QUIET).locate_batch(wrenches)
    refined = SmoothNormals(probe).refine(wrenches, found)
    assert np.isnan(refined[7]).all()
    kept = np.delete(np.arange(50), 7)
    # Without torque about the force the normals do not count.
    assert np.allclose(refined[kept], points[kept], atol=1e-9)

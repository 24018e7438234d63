"""Contacts against independent truths: the 4x4 system, the exhaustive scan, ray libraries, symmetry."""

import numpy as np
import pytest
from contact_cases import ball, bundled, random_wrenches

from pipeline.contact import ContactSolver, Gates, Reason, WrenchNoise, methods
from pipeline.mesh import Probe
from pipeline.simulation import add_noise, draw_slide, draw_touches


def solve_4x4(wrench, normal, offset):
    """Eq. 6, by a general solver."""
    fx, fy, fz = wrench[:3]
    system = np.zeros((4, 4))
    system[:3, :3] = [[0, fz, -fy], [-fz, 0, fx], [fy, -fx, 0]]
    system[:3, 3] = system[3, :3] = normal
    return np.linalg.solve(system, [*wrench[3:], offset])


def test_equals_the_4x4_system(bundled_solver):
    probe = bundled_solver.probe
    rng = np.random.default_rng(1)
    answered = 0
    for wrench in random_wrenches(probe, 400, rng, pitch=0.002, angle=60):
        contact = bundled_solver.locate(wrench)
        if contact.reason != Reason.OK:
            continue
        offset = contact.normal @ probe.vertices[probe.faces[contact.face][0]]
        *point, k = solve_4x4(wrench, contact.normal, offset)
        assert np.allclose(contact.point, point, rtol=1e-9, atol=1e-9 * probe.size)
        assert np.isclose(contact.torque, k, rtol=1e-9, atol=1e-12)
        answered += 1
    assert answered > 300


@pytest.mark.parametrize("cos_cap", [0.0, np.cos(np.radians(75))])
def test_pruned_equals_exhaustive(bundled_solver, cos_cap):
    rng = np.random.default_rng(2)
    wrenches = random_wrenches(bundled_solver.probe, 30_000, rng, pitch=0.02, angle=85)
    assert bundled_solver.search_differences(wrenches, cos_cap) == 0


def test_pruned_equals_exhaustive_on_real_probes(real_probe):
    rng = np.random.default_rng(3)
    wrenches = random_wrenches(real_probe, 1_500, rng, pitch=0.02, angle=85)
    assert ContactSolver(real_probe).search_differences(wrenches, 0.0) == 0


def test_whole_answers_equal_the_exhaustive_ones(bundled_solver):
    rng = np.random.default_rng(4)
    for wrench in random_wrenches(bundled_solver.probe, 500, rng, pitch=0.005, angle=85):
        fast, slow = bundled_solver.locate(wrench), bundled_solver.locate_exhaustively(wrench)
        assert fast.reason == slow.reason
        assert fast.face == slow.face
        assert fast.vertex == slow.vertex
        assert len(fast.candidates) == len(slow.candidates)


@pytest.mark.parametrize("pitch", [0.0, 1e-4, 0.01, 1.0, 100.0])
def test_a_convex_probe_is_always_answered(pitch):
    solver = ContactSolver(ball(), gates=Gates(friction_angle=89.99))
    assert solver.convex
    rng = np.random.default_rng(5)
    count = 3_000
    force = rng.standard_normal((count, 3))
    force *= 10 / np.linalg.norm(force, axis=1, keepdims=True)
    # Through the silhouette: the axis passes the centre within the insphere of the mesh.
    across = np.cross(force, rng.standard_normal((count, 3)))
    across *= (0.029 * np.sqrt(rng.random(count)) / np.linalg.norm(across, axis=1))[:, None]
    at = across + [0, 0, 0.1]
    signs = rng.choice([-1, 1], count)[:, None]
    batch = solver.locate_batch(np.hstack([force, np.cross(at, force) + signs * pitch * force]))
    assert set(np.unique(batch.reasons)) <= {Reason.OK, Reason.VERTEX, Reason.TANGENTIAL}
    # What the cone leaves out is within 0.01 degrees of edge-on.
    assert np.mean(batch.reasons == Reason.TANGENTIAL) < 1e-3
    if pitch >= 0.01:
        assert np.any(batch.reasons == Reason.VERTEX)


def test_zero_torque_equals_a_ray_library():
    pytest.importorskip("embreex", reason="Embree's bindings (extra 'rivals') are not installed")
    probe = bundled("t-shape", 2000)
    rng = np.random.default_rng(6)
    wrenches = random_wrenches(probe, 2_000, rng, pitch=0.0, angle=60)
    ours = ContactSolver(probe).locate_batch(wrenches)
    rays = methods.wrench_axis(probe).locate_batch(wrenches)
    alone = (ours.candidates == 1) & (ours.reasons == Reason.OK) & (rays.reasons == Reason.OK)
    # The first facet entered can be steeper than the friction cone allows; then it is no candidate.
    alone &= np.einsum("ij,ij->i", rays.normals, wrenches[:, :3]) < -0.26 * np.linalg.norm(
        wrenches[:, :3], axis=1
    )
    assert alone.sum() > 1_000
    assert np.abs(ours.points - rays.points)[alone].max() < 1e-9


def test_a_plane_through_the_sensor_origin_solves():
    vertices = np.array([[0.05, 0, 0], [-0.03, 0.05, 0], [-0.03, -0.05, 0], [0, 0, -0.04]])
    probe = Probe.from_arrays(vertices, np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]))
    point, force, k = np.array([0.01, 0.005, 0.0]), np.array([1.0, 0.5, -9.0]), 2e-3
    contact = ContactSolver(probe).locate(np.hstack([force, np.cross(point, force) + [0, 0, k]]))
    assert contact.reason == Reason.OK
    assert np.allclose(contact.point, point, atol=1e-12)
    assert contact.torque == pytest.approx(k, abs=1e-12)


@pytest.mark.parametrize("scale", [1e-5, 1e3, 1e4])
def test_units_do_not_matter(scale):
    probe = bundled("t-shape", 1000)
    other = Probe.from_arrays(scale * probe.vertices, probe.faces, check_size=False)
    rng = np.random.default_rng(7)
    wrenches = random_wrenches(probe, 500, rng, pitch=0.001, angle=60)
    scaled = wrenches * [1, 1, 1, scale, scale, scale]
    near = Gates(rival_sigmas=0.0)
    far = Gates(rival_sigmas=0.0, ambiguity_distance=0.005 * scale, follow_distance=0.01 * scale)
    a = ContactSolver(probe, gates=near).locate_batch(wrenches)
    b = ContactSolver(other, gates=far).locate_batch(scaled)
    assert np.array_equal(a.faces, b.faces)
    assert np.allclose(a.points, b.points / scale, rtol=0, atol=1e-9 * probe.size, equal_nan=True)


def test_rotating_everything_rotates_the_answer():
    probe = bundled("convex", 1000)
    rng = np.random.default_rng(8)
    rotation, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    rotation *= np.sign(np.linalg.det(rotation))
    turned = Probe.from_arrays(probe.vertices @ rotation.T, probe.faces)
    wrenches = random_wrenches(probe, 1_000, rng, pitch=0.001, angle=60)
    a = ContactSolver(probe).locate_batch(wrenches)
    b = ContactSolver(turned).locate_batch(
        np.hstack([wrenches[:, :3] @ rotation.T, wrenches[:, 3:] @ rotation.T])
    )
    assert np.array_equal(a.reasons, b.reasons)
    assert np.allclose(a.points @ rotation.T, b.points, atol=1e-9, equal_nan=True)
    expected = rotation @ a.covariances @ rotation.T
    assert np.allclose(expected, b.covariances, atol=1e-12, equal_nan=True)


def test_the_order_of_facets_does_not_matter():
    probe = bundled("t-shape", 1000, regions=True)
    rng = np.random.default_rng(9)
    order = rng.permutation(len(probe.faces))
    shuffled = Probe.from_arrays(probe.vertices, probe.faces[order], probe.region[order])
    wrenches = add_noise(random_wrenches(probe, 3_000, rng, pitch=0.005, angle=75), WrenchNoise(), rng)
    a, b = ContactSolver(probe).locate_batch(wrenches), ContactSolver(shuffled).locate_batch(wrenches)
    assert np.array_equal(a.reasons, b.reasons)
    assert np.allclose(a.points, b.points, atol=1e-12, equal_nan=True)


@pytest.mark.parametrize("name", ["linear", "convex", "t-shape"])
@pytest.mark.parametrize("facets", [500, 20_000])
def test_tracking_equals_cold_solves(name, facets):
    import assets
    from pipeline.study.speed import stream_differences

    rng = np.random.default_rng(10)
    slide = draw_slide(assets.surface(name), 20_000, rng, force=(0.3, 15.0), legs=30)
    wrenches = add_noise(slide.wrenches, WrenchNoise(), rng)
    solver = ContactSolver(bundled(name, facets, regions=True))
    assert stream_differences(solver, wrenches) == 0
    # A comparison of nothing would pass too: most of the stream is contact, some of it is not.
    reasons = solver.locate_batch(wrenches).reasons
    assert 0.6 < np.mean(reasons <= Reason.VERTEX) < 0.999


def test_tracking_one_by_one_equals_the_batch():
    import assets

    rng = np.random.default_rng(11)
    wrenches = add_noise(draw_slide(assets.surface("t-shape"), 500, rng).wrenches, WrenchNoise(), rng)
    solver = ContactSolver(bundled("t-shape", 1000))
    batch = solver.track_batch(wrenches)
    solver.reset()
    for i, wrench in enumerate(wrenches):
        before = solver.previous
        contact = solver.track(wrench)
        again = solver.locate(wrench, before)
        assert contact.reason == again.reason == batch.reasons[i]
        if contact.point is not None:
            assert np.array_equal(contact.point, again.point)
            assert np.array_equal(contact.point, batch.points[i])


@pytest.mark.parametrize("name", ["linear", "convex", "t-shape"])
def test_noise_free_touches_are_found_within_the_mesh_error(name):
    import assets

    touches = draw_touches(assets.surface(name), 5_000, np.random.default_rng(12), above=0.02)
    batch = ContactSolver(bundled(name, 20_000)).locate_batch(touches.wrenches)
    error = np.linalg.norm(batch.points - touches.points, axis=1)
    sure = batch.reasons <= Reason.VERTEX
    assert sure.mean() > 0.9
    assert error[sure].max() < 1e-3
    assert error[sure].mean() < 5e-5


def test_wrong_answers_are_flagged_on_the_t_shape():
    import assets

    rng = np.random.default_rng(13)
    touches = draw_touches(assets.surface("t-shape"), 20_000, rng, above=0.02)
    wrenches = add_noise(touches.wrenches, WrenchNoise(), rng)
    probe = bundled("t-shape", 2000)
    ours, paper = (
        ContactSolver(probe).locate_batch(wrenches),
        methods.algorithm1(probe).locate_batch(wrenches),
    )

    def wrong(batch):
        with np.errstate(invalid="ignore"):
            return np.linalg.norm(batch.points - touches.points, axis=1) > 0.010

    assert np.mean(wrong(ours) & (ours.reasons <= Reason.VERTEX)) <= 1e-4
    assert np.mean(ours.reasons == Reason.AMBIGUOUS) < 0.08
    assert np.mean(wrong(paper)) > 0.005

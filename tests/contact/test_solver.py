"""Contacts against independent truths: every facet, the 4x4 system, ray libraries, symmetry."""

from typing import Any

import numpy as np
import pytest
from contact_cases import ball, bundled, random_wrenches
from slides import draw_slide

from contactbench import assets
from contactbench.pipeline.contact import (
    Contact,
    ContactSolver,
    Gates,
    Reason,
    TouchModel,
    WrenchNoise,
    methods,
)
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation import add_noise, draw_touches


def solve_4x4(wrench, normal, offset):
    """Eq. 6, by a general solver."""
    fx, fy, fz = wrench[:3]
    system = np.zeros((4, 4))
    system[:3, :3] = [[0, fz, -fy], [-fz, 0, fx], [fy, -fx, 0]]
    system[:3, 3] = system[3, :3] = normal
    return np.linalg.solve(system, [*wrench[3:], offset])


EXACT = WrenchNoise(force=1e-6, torque=1e-7)
NOTHING_LEFT_OUT = WrenchNoise(force=0.0, torque=0.0)


def limit_of(arm: float) -> TouchModel:
    """A touch with that torsion arm on a body that truly has flat facets."""
    return TouchModel(torsion_arm=arm, model_error=NOTHING_LEFT_OUT, mesh_curved=False)


# ---- limits ----------------------------------------------------------------------------------------


def test_a_huge_torsion_arm_is_the_closed_form(bundled_solver):
    """Inside a facet the answer is the solution of the 4x4 system, and what the exhaustive scan finds there."""
    probe = bundled_solver.probe
    wrenches = random_wrenches(probe, 2_000, np.random.default_rng(1), pitch=0.002, angle=60)
    gates = Gates(first_odds=1)
    batch = ContactSolver(probe, EXACT, gates, limit_of(1000.0)).locate_batch(wrenches)
    scan = methods.scan(probe, gates=gates).locate_batch(wrenches)
    alone = (batch.reasons == Reason.OK) & (batch.candidates == 1) & (scan.faces == batch.faces)
    assert alone.sum() > 800
    for row in np.flatnonzero(alone):
        normal = batch.normals[row]
        *point, k = solve_4x4(
            wrenches[row], normal, normal @ probe.vertices[probe.faces[batch.faces[row]][0]]
        )
        assert np.allclose(batch.points[row], point, rtol=0, atol=1e-7 * probe.size)
        assert np.isclose(batch.torques[row], k, rtol=1e-4, atol=1e-7)
    assert np.allclose(batch.points[alone], scan.points[alone], rtol=0, atol=1e-7 * probe.size)
    assert np.allclose(batch.torques[alone], scan.torques[alone], rtol=1e-4, atol=1e-7)


def test_the_scan_has_a_solution_wherever_the_limit_explains_the_wrench(bundled_solver):
    probe = bundled_solver.probe
    wrenches = random_wrenches(probe, 2_000, np.random.default_rng(2), pitch=0.002, angle=60)
    batch = ContactSolver(probe, EXACT, model=limit_of(1000.0)).locate_batch(wrenches)
    scan = methods.scan(probe).locate_batch(wrenches)
    interior = (batch.reasons == Reason.OK) & (batch.misfits < 1e-6)
    assert interior.sum() > 1_000
    assert (scan.reasons[interior] == Reason.OK).mean() > 0.99


def test_no_torsion_arm_is_the_wrench_axis():
    pytest.importorskip("embreex", reason="Embree's bindings (extra 'rivals') are not installed")
    probe = bundled("t-shape", 2000)
    wrenches = random_wrenches(probe, 2_000, np.random.default_rng(6), pitch=0.0, angle=60)
    ours = ContactSolver(probe, EXACT, model=limit_of(0.0)).locate_batch(wrenches)
    rays = methods.wrench_axis(probe).locate_batch(wrenches)
    alone = (ours.candidates == 1) & (ours.reasons == Reason.OK) & (rays.reasons == Reason.OK)
    # The first facet entered can be steeper than the friction cone allows; then it is no candidate.
    alone &= np.einsum("ij,ij->i", rays.normals, wrenches[:, :3]) < -0.26 * np.linalg.norm(
        wrenches[:, :3], axis=1
    )
    assert alone.sum() > 1_000
    assert np.abs(ours.points - rays.points)[alone].max() < 1e-7
    assert np.abs(ours.torques[alone]).max() < 1e-12


def test_any_torque_about_the_force_is_implausible_without_a_torsion_arm():
    probe = bundled("linear", 1000)
    tip = np.array([0.001, 0.001, probe.vertices[:, 2].max()])
    wrench = np.hstack([[0, 0, -9.0], np.cross(tip, [0, 0, -9.0])])
    solver = ContactSolver(probe, EXACT, model=limit_of(0.0))
    assert solver.locate(wrench).reason == Reason.OK
    assert solver.locate(wrench + [0, 0, 0, 0, 0, 1e-3]).reason == Reason.IMPLAUSIBLE


# ---- the search ------------------------------------------------------------------------------------

LAST = [None, (0.0, 0.0, 0.12), (0.01, 0.004, 0.09)]


def mixed_wrenches(probe: Probe, count: int, rng: np.random.Generator) -> np.ndarray:
    """Touches with usual and with too much torsion, noisy and exact, and lines of force beside the probe."""
    usual = add_noise(random_wrenches(probe, count, rng, pitch=0.002, angle=85), WrenchNoise(), rng)
    twisted = random_wrenches(probe, count // 4, rng, pitch=0.02, angle=85)
    beside = usual[: count // 4].copy()
    beside[:, 3:] += np.cross(rng.normal(0, 0.02, (len(beside), 3)), beside[:, :3])
    return np.vstack([usual, twisted, beside])


@pytest.mark.parametrize("regions", [None, "declared", "untouchable"])
@pytest.mark.parametrize("name", ["linear", "convex", "t-shape"])
def test_pruned_equals_every_facet(name, regions):
    probe = bundled(name, 1000, regions=regions is not None)
    if regions == "untouchable":
        probe = probe.with_region(probe.region, untouchable=(1,))
    solver = ContactSolver(probe)
    wrenches = mixed_wrenches(probe, 2_000, np.random.default_rng(2))
    for last in LAST:
        given = None if last is None else np.array(last)
        assert solver.search_differences(wrenches, given).size == 0
    # A comparison of refusals would pass too.
    assert np.isfinite(solver.locate_batch(wrenches).points[:, 0]).mean() > 0.5


@pytest.mark.parametrize(
    ("noise", "model"),
    [
        (EXACT, limit_of(0.001)),
        (WrenchNoise(0.5, 0.02), TouchModel()),
        (WrenchNoise((0.01, 0.05, 0.2), (0.02, 0.001, 0.005)), TouchModel(torsion_arm=0.005)),
        (WrenchNoise(), TouchModel(mesh_deviation=0.001)),
    ],
    ids=["exact", "loud", "uneven", "coarse mesh"],
)
def test_pruned_equals_every_facet_whatever_the_noise(bundled_solver, noise, model):
    probe = bundled_solver.probe
    solver = ContactSolver(probe, noise, model=model)
    wrenches = mixed_wrenches(probe, 800, np.random.default_rng(3))
    assert solver.search_differences(wrenches, None).size == 0
    assert solver.search_differences(wrenches, np.array(LAST[1])).size == 0


def test_pruned_equals_every_facet_on_real_probes(real_probe):
    wrenches = mixed_wrenches(real_probe, 120, np.random.default_rng(3))
    solver = ContactSolver(real_probe)
    assert solver.search_differences(wrenches, None).size == 0
    assert solver.search_differences(wrenches, np.array(LAST[1])).size == 0


def test_single_answers_equal_the_exhaustive_ones(bundled_solver):
    for wrench in mixed_wrenches(bundled_solver.probe, 300, np.random.default_rng(4)):
        assert same_contact(bundled_solver.locate(wrench), bundled_solver.locate_exhaustively(wrench))


def same_contact(a: Contact, b: Contact) -> bool:
    """Agree in everything, to the last bit."""
    scalars = ("torque", "region", "friction_angle", "misfit", "left_over", "arm", "confidence", "sigma_max")
    arrays = ("point", "normal", "second", "covariance", "ellipse", "wrench")
    each = ("torque", "face", "vertex", "region", "friction_angle", "distance", "misfit", "delta", "why")

    def equal(x: Any, y: Any) -> bool:
        return bool(x == y or (x != x and y != y))

    return (
        (a.reason, a.accepted, a.face, a.vertex) == (b.reason, b.accepted, b.face, b.vertex)
        and all(equal(getattr(a, name), getattr(b, name)) for name in scalars)
        and all(np.array_equal(getattr(a, name), getattr(b, name)) for name in arrays)
        and len(a.candidates) == len(b.candidates)
        and all(
            np.array_equal(x.point, y.point)
            and np.array_equal(x.normal, y.normal)
            and all(equal(getattr(x, name), getattr(y, name)) for name in each)
            for x, y in zip(a.candidates, b.candidates, strict=True)
        )
    )


@pytest.mark.parametrize("regions", [False, True])
def test_rows_of_a_batch_are_single_answers_with_their_candidates(regions):
    probe = bundled("t-shape", 1000, regions=regions)
    solver = ContactSolver(probe)
    wrenches = mixed_wrenches(probe, 600, np.random.default_rng(5))
    batch = solver.locate_batch(wrenches)
    singles = [solver.locate(wrench) for wrench in wrenches]
    assert all(same_contact(batch[row], single) for row, single in enumerate(singles))
    assert sum(len(single.candidates) > 0 for single in singles) > 20
    assert np.array_equal(batch.candidates > 1, [len(single.candidates) > 0 for single in singles])
    after = np.tile(LAST[1], (len(wrenches), 1))
    after[::2] = np.nan
    followed = solver.locate_batch_after(wrenches, after)
    for row, wrench in enumerate(wrenches):
        previous = None if row % 2 == 0 else np.array(LAST[1])
        assert same_contact(followed[row], solver.locate(wrench, previous))


# ---- answers ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("pitch", [0.0, 1e-4, 1e-3])
def test_a_convex_probe_is_always_answered(pitch):
    solver = ContactSolver(ball())
    rng = np.random.default_rng(5)
    count = 3_000
    force = rng.standard_normal((count, 3))
    force *= 10 / np.linalg.norm(force, axis=1, keepdims=True)
    # Inside the friction cone: within 0.9 radii of the axis through the centre it is under 65 degrees.
    across = np.cross(force, rng.standard_normal((count, 3)))
    across *= (0.027 * np.sqrt(rng.random(count)) / np.linalg.norm(across, axis=1))[:, None]
    at = across + [0, 0, 0.1]
    signs = rng.choice([-1, 1], count)[:, None]
    batch = solver.locate_batch(np.hstack([force, np.cross(at, force) + signs * pitch * force]))
    assert set(np.unique(batch.reasons)) <= {Reason.OK, Reason.VERTEX}
    assert batch.confidences.min() == 1.0


def test_a_plane_through_the_sensor_origin_solves():
    vertices = np.array([[0.05, 0, 0], [-0.03, 0.05, 0], [-0.03, -0.05, 0], [0, 0, -0.04]])
    probe = Probe.from_arrays(vertices, np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]))
    point, force, k = np.array([0.01, 0.005, 0.0]), np.array([1.0, 0.5, -9.0]), 2e-3
    wrench = np.hstack([force, np.cross(point, force) + [0, 0, k]])
    exact = ContactSolver(probe, EXACT, model=limit_of(1000.0)).locate(wrench)
    assert exact.reason == Reason.OK
    assert np.allclose(exact.point, point, atol=1e-8)
    assert exact.torque == pytest.approx(k, abs=1e-8)
    # By its likelihood k is a little smaller, and the point a little off.
    contact = ContactSolver(probe).locate(wrench)
    assert contact.reason == Reason.OK
    assert np.allclose(contact.point, point, atol=1e-5)
    assert 0.8 * k < contact.torque < k


@pytest.mark.parametrize("scale", [1e-5, 1e3, 1e4])
def test_units_do_not_matter(scale):
    probe = bundled("t-shape", 1000)
    other = Probe.from_arrays(scale * probe.vertices, probe.faces, check_size=False)
    wrenches = random_wrenches(probe, 500, np.random.default_rng(7), pitch=0.001, angle=60)
    scaled = wrenches * [1, 1, 1, scale, scale, scale]

    lengths = {"ambiguity_distance": 0.005, "follow_distance": 0.01, "depth_distance": 0.002}

    def solver(body: Probe, unit: float) -> ContactSolver:
        return ContactSolver(
            body,
            WrenchNoise(0.05, 0.002 * unit),
            # What lies behind is judged in metres: without odds for the first surface it does not matter.
            Gates(first_odds=1, **{name: value * unit for name, value in lengths.items()}),
            TouchModel(0.001 * unit, WrenchNoise(0.05, 0.001 * unit)),
        )

    a, b = solver(probe, 1).locate_batch(wrenches), solver(other, scale).locate_batch(scaled)
    assert np.array_equal(a.reasons, b.reasons)
    assert np.allclose(a.misfits, b.misfits, rtol=1e-6, atol=1e-9, equal_nan=True)
    sure = a.reasons != Reason.AMBIGUOUS  # between places that explain it equally well rounding may choose
    assert np.isfinite(a.points[sure, 0]).sum() > 300
    assert np.allclose(a.points[sure], b.points[sure] / scale, rtol=0, atol=1e-9 * probe.size, equal_nan=True)
    assert np.allclose(
        a.covariances[sure], b.covariances[sure] / scale**2, rtol=0, atol=1e-12, equal_nan=True
    )


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
def test_tracking_equals_locating_after_the_previous_contact(name, facets):
    rng = np.random.default_rng(10)
    slide = draw_slide(assets.surface(name), 6_000, rng, force=(0.3, 15.0), legs=3)
    wrenches = add_noise(slide.wrenches, WrenchNoise(), rng)
    solver = ContactSolver(bundled(name, facets, regions=True))
    batch = solver.track_batch(wrenches)
    solver.reset()
    compared = 0
    for row, wrench in enumerate(wrenches):
        before = solver.previous
        contact = solver.track(wrench)
        assert contact.reason == batch.reasons[row]
        if contact.reason != Reason.TWO_TOUCHES:
            compared += 1
            assert same_contact(contact, batch[row])
            assert same_contact(contact, solver.locate(wrench, before))
    # A comparison of nothing would pass too: most of the stream is contact, some of it is not.
    assert compared > 0.9 * len(wrenches)
    assert 0.6 < np.mean(batch.accepted) < 0.999


@pytest.mark.parametrize("name", ["linear", "convex", "t-shape"])
def test_noise_free_touches_are_found_within_the_mesh_error(name):
    touches = draw_touches(assets.surface(name), 5_000, np.random.default_rng(12), above=0.02)
    batch = ContactSolver(bundled(name, 20_000)).locate_batch(touches.wrenches)
    error = np.linalg.norm(batch.points - touches.points, axis=1)
    sure = batch.reasons <= Reason.VERTEX
    assert sure.mean() > 0.9
    assert error[sure].max() < 1e-3
    assert error[sure].mean() < 5e-5


def test_wrong_answers_are_flagged_on_the_t_shape():
    rng = np.random.default_rng(13)
    touches = draw_touches(assets.surface("t-shape"), 10_000, rng, above=0.02)
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


@pytest.mark.parametrize("threads", [2, 5, 0])
def test_a_batch_on_several_threads_has_the_same_bits_in_the_same_order(threads):
    """More rows than a thread takes at a time, so that every thread works; reasons of every kind among them."""
    probe = bundled("linear", 500)
    wrenches = random_wrenches(probe, 3000, np.random.default_rng(3), pitch=0.01, angle=60)
    wrenches[::7] = 0.0
    solver = ContactSolver(probe)
    alone = solver.locate_batch(wrenches)
    previous = np.where(np.arange(3000)[:, None] % 3 == 0, np.nan, alone.points[::-1])
    for one, several in (
        (alone, solver.locate_batch(wrenches, threads)),
        (
            solver.locate_batch_after(wrenches, previous),
            solver.locate_batch_after(wrenches, previous, threads),
        ),
    ):
        for name in (
            "points",
            "reasons",
            "faces",
            "confidences",
            "misfits",
            "candidates",
            "covariances",
            "sigma_max",
        ):
            assert getattr(one, name).tobytes() == getattr(several, name).tobytes(), name
    assert len(set(alone.reasons.tolist())) > 2

"""Reason codes, gates, priorities and what a caller may pass."""

import numpy as np
import pytest
from contact_cases import ball, bundled

from pipeline.contact import ContactSolver, Gates, Reason, methods
from pipeline.errors import InputError
from pipeline.mesh import Probe

TOP = np.array([0.0, 0.0, 0.13])


def push(force=(0.0, 0.0, -10.0), point=TOP, torque=0.0) -> np.ndarray:
    force = np.asarray(force, dtype=float)
    return np.hstack([force, np.cross(point, force) + torque * np.array([0, 0, 1.0])])


@pytest.fixture(scope="module")
def solver() -> ContactSolver:
    return ContactSolver(ball())


def two_blocks(region=None) -> Probe:
    """Two boxes one above the other, 40 mm apart: a push from above enters both squarely."""
    import trimesh

    low = trimesh.creation.box([0.04, 0.04, 0.02])
    high = low.copy()
    high.apply_translation([0, 0, 0.06])
    both = trimesh.util.concatenate([low, high])
    return Probe.from_arrays(np.asarray(both.vertices), np.asarray(both.faces), region)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("channel", range(6))
def test_not_finite(solver, bad, channel):
    wrench = push()
    wrench[channel] = bad
    contact = solver.locate(wrench)
    assert contact.reason == Reason.NOT_FINITE
    assert contact.point is None
    assert contact.covariance is None
    assert np.isnan(contact.torque)


@pytest.mark.parametrize("force", [0.0, 1e-310, 0.49])
def test_low_force(solver, force):
    assert solver.locate(push((0, 0, -force))).reason == Reason.LOW_FORCE


def test_a_force_of_zero_is_low_even_without_a_gate():
    assert ContactSolver(ball(), gates=Gates(min_force=0.0)).locate(np.zeros(6)).reason == Reason.LOW_FORCE


@pytest.mark.parametrize("channel", range(6))
def test_saturated(channel):
    limits = (50.0, 50.0, 100.0, 4.0, 4.0, 4.0)
    solver = ContactSolver(ball(), gates=Gates(saturation=limits))
    wrench = push()
    wrench[channel] = -limits[channel]
    assert solver.locate(wrench).reason == Reason.SATURATED
    assert solver.locate(push()).accepted


def test_numbers_beyond_squaring_are_saturated(solver):
    assert solver.locate(push((0, 0, -1e200))).reason == Reason.SATURATED


def test_off_surface(solver):
    contact = solver.locate(push(point=(0.2, 0, 0.1)))
    assert contact.reason == Reason.OFF_SURFACE
    assert contact.face is None


def test_tangential_lists_what_it_refused():
    plate = two_blocks()
    angle = np.radians(80)
    contact = ContactSolver(plate).locate(
        push(10 * np.array([np.sin(angle), 0, -np.cos(angle)]), point=(0, 0, 0.07))
    )
    # The side wall behind may be met head-on; a wall this thin is passed by.
    kinds = {c.why for c in contact.candidates}
    assert contact.reason in {Reason.TANGENTIAL, Reason.OK, Reason.AMBIGUOUS}
    wide = ContactSolver(plate, gates=Gates(friction_angle=89.0)).locate(contact.wrench)
    found = [wide.point, *(c.point for c in wide.candidates)]
    assert any(np.allclose(p, (0, 0, 0.07), atol=1e-9) for p in found)
    assert "outside the friction cone" in kinds or contact.reason != Reason.TANGENTIAL


def test_grazing_a_ball_is_tangential():
    angle = np.radians(80)
    point = np.array([0.0, 0.0, 0.13])
    force = 10 * np.array([np.sin(angle), 0, -np.cos(angle)])
    contact = ContactSolver(ball(5120)).locate(push(force, point))
    assert contact.reason == Reason.TANGENTIAL
    assert contact.point is None
    assert [c.why for c in contact.candidates] == ["outside the friction cone"]
    assert contact.candidates[0].friction_angle == pytest.approx(80, abs=3)


def test_two_far_candidates_are_ambiguous_and_the_first_met_is_given():
    contact = ContactSolver(two_blocks()).locate(push(point=(0.005, 0.003, 0)))
    assert contact.reason == Reason.AMBIGUOUS
    assert not contact.accepted
    assert np.allclose(contact.point, [0.005, 0.003, 0.07])
    [other] = contact.candidates
    assert other.why == "met later along the force"
    assert other.distance == pytest.approx(0.06)


def test_a_region_settles_it():
    region = np.repeat([1, 0], 12)
    contact = ContactSolver(two_blocks(region)).locate(push(point=(0.005, 0.003, 0)))
    assert contact.reason == Reason.OK
    assert contact.region == 1
    assert np.allclose(contact.point, [0.005, 0.003, 0.01])
    assert contact.candidates[0].why == "outside the priority region"


def test_regions_rank_by_number():
    contact = ContactSolver(two_blocks(np.repeat([2, 1], 12))).locate(push(point=(0.005, 0.003, 0)))
    assert contact.reason == Reason.OK
    assert contact.point[2] == pytest.approx(0.07)


def test_region_only():
    solver = ContactSolver(two_blocks(), gates=Gates(region_only=True, rival_sigmas=0.0))
    contact = solver.locate(push(point=(0.005, 0.003, 0)))
    assert contact.reason == Reason.OUTSIDE_REGION
    assert contact.point is None


def test_the_previous_contact_settles_it():
    solver = ContactSolver(two_blocks())
    contact = solver.locate(push(point=(0.005, 0.003, 0)), np.array([0.005, 0.002, 0.01]))
    assert contact.reason == Reason.OK
    assert contact.point[2] == pytest.approx(0.01)
    assert contact.candidates[0].why == "far from the previous contact"


def test_tracking_forgets_after_recent_samples():
    solver = ContactSolver(two_blocks(), gates=Gates(recent_samples=3))
    # From the side only the lower block is there to push: an unambiguous start.
    side = np.array([0.02, 0.0, 0.0])
    start = np.hstack([[-10, 0, 0], np.cross(side, [-10.0, 0, 0])])
    assert solver.track(start).accepted
    for _ in range(3):
        assert solver.track(np.zeros(6)).reason == Reason.LOW_FORCE
        assert solver.previous is not None
    solver.track(np.zeros(6))
    assert solver.previous is None


def test_stale_samples_are_not_used(solver):
    solver.reset()
    assert solver.track(push(), 0.05).accepted
    for age in (0.2, float("nan"), float("inf")):
        assert solver.track(push(), age).reason == Reason.STALE
    reasons = solver.track_batch(np.tile(push(), (2, 1)), np.array([0.0, 1.0])).reasons
    assert list(reasons) == [
        Reason.VERTEX if solver.locate(push()).vertex is not None else Reason.OK,
        Reason.STALE,
    ]


@pytest.mark.parametrize(
    "wrench", [[1, 2, 3], np.zeros(7), "abcdef", None, [1, 2, 3, 4, 5, "x"], np.zeros((2, 6))]
)
def test_what_is_no_wrench_is_refused(solver, wrench):
    with pytest.raises(TypeError):
        solver.locate(wrench)


@pytest.mark.parametrize("rows", [np.zeros((3, 5)), np.zeros(6), [["a"] * 6], None])
def test_what_are_no_wrenches_is_refused(solver, rows):
    with pytest.raises(TypeError, match=r"\(n, 6\)"):
        solver.locate_batch(rows)


def test_lists_and_other_types_are_taken(solver):
    exact = solver.locate(push((0.1, 0.2, -10), (0.001, 0.002, 0.13)))
    assert np.array_equal(solver.locate(list(exact.wrench)).point, exact.point)
    strided = np.zeros((6, 2))[:, 0]
    strided[:] = exact.wrench
    assert np.array_equal(solver.locate(strided).point, exact.point)
    assert solver.locate(exact.wrench.astype(np.float32)).accepted
    assert len(solver.locate_batch(np.zeros((0, 6)))) == 0


def test_batch_views_cannot_be_written(solver):
    batch = solver.locate_batch(push()[None])
    with pytest.raises(ValueError, match="read-only"):
        batch.points[0, 0] = 1.0
    with pytest.raises(IndexError):
        batch[1]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"min_force": -1}, "min_force"),
        ({"friction_angle": 90}, "friction_angle"),
        ({"friction_angle": 0}, "friction_angle"),
        ({"torque_ratio": 0.5}, "torque_ratio"),
        ({"recent_samples": -1}, "recent_samples"),
        ({"recent_samples": 1.5}, "recent_samples"),
        ({"rival_sigmas": float("inf")}, "rival_sigmas"),
        ({"saturation": (1, 1, 1)}, "six"),
        ({"saturation": (1, 1, 1, 1, 1, 0)}, "positive"),
        ({"max_age": float("nan")}, "max_age"),
    ],
)
def test_impossible_gates_are_refused(arguments, said):
    with pytest.raises(InputError, match=said):
        Gates(**arguments)


@pytest.mark.parametrize("name", list(methods.METHODS))
def test_every_method_has_the_same_signature(name):
    if name == "wrench_axis":
        pytest.importorskip("embreex", reason="Embree's bindings (extra 'rivals') are not installed")
    probe = bundled("convex", 2000, regions=True)
    method = methods.make(name, probe)
    tip = np.array([0.002, 0.001, probe.vertices[:, 2].max()])
    wrench = np.hstack([[0, 0, -9.0], np.cross(tip, [0, 0, -9.0])])
    contact = method.locate(wrench)
    assert contact.reason == Reason.OK
    assert np.linalg.norm(contact.point[:2] - tip[:2]) < 5e-4
    batch = method.locate_batch(np.array([wrench, np.zeros(6), np.full(6, np.nan)]))
    assert list(batch.reasons) == [Reason.OK, Reason.LOW_FORCE, Reason.NOT_FINITE]
    assert np.allclose(batch.points[0], contact.point, atol=1e-12)
    assert np.isnan(batch.points[1:]).all()
    assert list(batch.faces[1:]) == [-1, -1]


def test_iterative_by_scipy_equals_the_compiled_one():
    probe = bundled("convex", 2000, regions=True)
    rng = np.random.default_rng(1)
    points = np.column_stack(
        [rng.uniform(-0.015, 0.015, 40), rng.uniform(-0.004, 0.004, 40), np.full(40, 0.138)]
    )
    force = np.tile([0.5, 0.2, -9.0], (40, 1))
    wrenches = np.hstack([force, np.cross(points, force)])
    compiled = methods.iterative(probe).locate_batch(wrenches)
    library = methods.iterative(probe, library="scipy").locate_batch(wrenches)
    assert np.array_equal(compiled.reasons, library.reasons)
    assert np.allclose(compiled.points, library.points, atol=1e-9, equal_nan=True)


def test_algorithm1_takes_priority_planes_first():
    probe = two_blocks(np.repeat([0, 1], 12))
    contact = methods.algorithm1(probe).locate(push(point=(0.005, 0.003, 0)))
    assert contact.point[2] == pytest.approx(0.07)
    other = methods.algorithm1(two_blocks(np.repeat([1, 0], 12))).locate(push(point=(0.005, 0.003, 0)))
    assert other.point[2] == pytest.approx(0.01)


def test_unknown_methods_are_refused():
    with pytest.raises(InputError, match="contactbench, scan, algorithm1"):
        methods.make("magic", ball())


def test_repr_reads_well(solver):
    text = repr(solver.locate(push((0.1, 0.2, -10), (0.001, 0.002, 0.13))))
    assert "mm" in text
    assert "OK" in text
    assert "no point" in repr(solver.locate(np.zeros(6)))


def test_more_noise_never_makes_a_t_shape_surer():
    from pipeline.contact import WrenchNoise

    wrench = push((0.0, 0.0, -9.0), bundled("t-shape", 1000).vertices.max(axis=0) * [0, 0, 1])
    assert ContactSolver(bundled("t-shape", 1000)).locate(wrench).accepted
    drowned = ContactSolver(bundled("t-shape", 1000), WrenchNoise(force=2.0)).locate(wrench)
    assert drowned.reason == Reason.AMBIGUOUS
    assert ContactSolver(ball(), WrenchNoise(force=2.0)).locate(push()).accepted  # convex: no rival anywhere


def test_rows_of_a_batch_carry_what_single_contacts_do():
    probe = bundled("convex", 1000, regions=True)
    solver = ContactSolver(probe)
    tip = np.array([0.002, 0.001, probe.vertices[:, 2].max()])
    wrench = push((0.0, 0.0, -9.0), tip)
    single, row = solver.locate(wrench), solver.locate_batch(wrench[None])[0]
    assert (row.region, row.face, row.vertex) == (single.region, single.face, single.vertex)
    assert single.region == 1
    fitted = methods.iterative(probe).locate_batch(wrench[None])[0]
    assert fitted.face is None
    assert fitted.region == 0
    assert fitted.point is not None


def test_a_solver_can_be_shared_between_threads():
    from concurrent.futures import ThreadPoolExecutor

    import assets
    from pipeline.simulation import draw_slide

    wrenches = draw_slide(assets.surface("t-shape"), 20_000, np.random.default_rng(1)).wrenches
    solver = ContactSolver(bundled("t-shape", 1000))
    with ThreadPoolExecutor(2) as pool:
        first, second = pool.map(solver.track_batch, [wrenches, wrenches[::-1]])
    missing = [
        np.isnan(b.points[:, 0]) != np.isnan(solver.locate_batch(w).points[:, 0])
        for b, w in ((first, wrenches), (second, wrenches[::-1]))
    ]
    assert not np.any(missing)


def test_bytes_are_no_wrench(solver):
    with pytest.raises(TypeError, match="bytes"):
        solver.locate(b"123456")

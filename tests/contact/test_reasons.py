"""Reason codes, gates, priorities and what a caller may pass."""

from itertools import pairwise

import numpy as np
import pytest
from contact_cases import ball, bundled, random_wrenches
from slides import draw_slide

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver, Gates, Reason, TouchModel, WrenchNoise, methods
from contactbench.pipeline.contact.methods import fit_contact_face
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation import add_noise, draw_touches

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


def sheet() -> Probe:
    """A square of 80 mm at z = 0.1, that faces up; nothing faces down."""
    corners = np.array([[-0.04, -0.04, 0.1], [0.04, -0.04, 0.1], [0.04, 0.04, 0.1], [-0.04, 0.04, 0.1]])
    return Probe.from_arrays(corners, np.array([[0, 1, 2], [0, 2, 3]]))


def test_off_surface_is_a_force_that_no_facet_faces():
    contact = ContactSolver(sheet()).locate(push((0, 0, 10.0)))
    assert contact.reason == Reason.OFF_SURFACE
    assert contact.face is None
    assert contact.point is None
    assert np.isnan(contact.misfit)
    assert contact.confidence == 0.0


# ---- implausible ---------------------------------------------------------------------------------


def test_an_axis_beside_the_probe_is_implausible_and_says_by_how_much(solver):
    contact = solver.locate(push(point=(0.2, 0, 0.1)))
    assert contact.reason == Reason.IMPLAUSIBLE
    assert not contact.accepted
    assert contact.point is None
    assert contact.confidence == 0.0
    # The line of force passes the ball's rim at 0.17 m and its middle at 0.2 m, with 10 N.
    assert 1.65 < contact.left_over <= 2.0
    assert contact.misfit > Gates().implausible_misfit


@pytest.mark.parametrize("name", assets.PROBE_NAMES)
def test_an_arm_of_two_metres_is_no_torsion(name):
    probe = bundled(name, 1000)
    wrench = push((0, 0, -9.0), [0.001, 0.001, probe.vertices[:, 2].max()])
    assert ContactSolver(probe).locate(wrench).point is not None
    contact = ContactSolver(probe).locate(wrench + [0, 0, 0, 0, 0, 20.0])
    assert contact.reason == Reason.IMPLAUSIBLE
    assert abs(contact.arm) == pytest.approx(20 / 9, rel=1e-6)
    assert contact.left_over > 1
    assert contact.misfit > 1e6


@pytest.mark.parametrize("name", assets.PROBE_NAMES)
def test_two_opposite_touches_are_implausible(name):
    probe, rng = bundled(name, 1000), np.random.default_rng(2)
    touches = draw_touches(assets.surface(name), 2_000, rng, above=0.02, angle=(0, 20), force=(3, 12))
    force = touches.wrenches[:, :3] / np.linalg.norm(touches.wrenches[:, :3], axis=1, keepdims=True)
    pairs = touches.wrenches[:1000] + touches.wrenches[1000:]
    opposed = np.einsum("ij,ij->i", force[:1000], force[1000:]) < -0.5
    opposed &= np.linalg.norm(touches.points[:1000] - touches.points[1000:], axis=1) > 0.04
    batch = ContactSolver(probe).locate_batch(add_noise(pairs[opposed], WrenchNoise(), rng))
    assert opposed.sum() > 100
    assert np.mean(batch.reasons == Reason.IMPLAUSIBLE) > 0.8
    assert np.mean(batch.accepted) < 0.15


def test_what_is_implausible_follows_the_probability():
    wrench = push(point=(0.031, 0, 0.1))  # 1 mm beside the ball
    loose = ContactSolver(ball(), gates=Gates(implausible_probability=1e-9))
    strict = ContactSolver(ball(), gates=Gates(implausible_probability=0.5))
    assert Gates().implausible_misfit == pytest.approx(10.83, abs=0.01)
    misfit = strict.locate(wrench).misfit
    assert Gates(implausible_probability=0.5).implausible_misfit < misfit < loose.gates.implausible_misfit
    assert strict.locate(wrench).reason == Reason.IMPLAUSIBLE
    assert loose.locate(wrench).accepted
    assert loose.locate(wrench).misfit == misfit


# ---- the friction cone ---------------------------------------------------------------------------


def test_grazing_a_ball_is_tangential():
    angle = np.radians(80)
    point = np.array([0.0, 0.0, 0.13])
    force = 10 * np.array([np.sin(angle), 0, -np.cos(angle)])
    narrow = ContactSolver(ball(5120), gates=Gates(friction_angle=60)).locate(push(force, point))
    assert narrow.reason == Reason.TANGENTIAL
    assert narrow.point is None
    assert narrow.misfit > Gates().implausible_misfit
    wide = ContactSolver(ball(5120), gates=Gates(friction_angle=89)).locate(push(force, point))
    assert wide.accepted
    assert wide.friction_angle == pytest.approx(80, abs=5)


# ---- two places ----------------------------------------------------------------------------------

ON_BOTH = push(point=(0.005, 0.003, 0))


def test_two_far_places_are_ambiguous_and_the_first_met_is_given():
    contact = ContactSolver(two_blocks()).locate(ON_BOTH)
    assert contact.reason == Reason.AMBIGUOUS
    assert not contact.accepted
    assert np.allclose(contact.point, [0.005, 0.003, 0.07], atol=1e-6)
    [other] = contact.candidates
    assert other.why == "met later along the force"
    assert other.distance == pytest.approx(0.06)
    assert other.delta == pytest.approx(2 * np.log(Gates().first_odds), abs=1e-6)


def test_the_odds_of_what_is_met_first_can_settle_it():
    contact = ContactSolver(two_blocks(), gates=Gates(first_odds=1e3)).locate(ON_BOTH)
    assert contact.reason == Reason.OK
    assert contact.candidates[0].why == "explains the wrench less well"


def test_a_region_settles_it_and_the_answer_says_so():
    contact = ContactSolver(two_blocks(np.repeat([1, 0], 12))).locate(ON_BOTH)
    assert contact.reason == Reason.BY_REGION
    assert contact.accepted
    assert contact.region == 1
    assert np.allclose(contact.point, [0.005, 0.003, 0.01], atol=1e-6)
    assert contact.candidates[0].why == "less likely to be touched, as declared"
    strict = Gates(accept_by_region=False)
    doubted = ContactSolver(two_blocks(np.repeat([1, 0], 12)), gates=strict).locate(ON_BOTH)
    assert (doubted.reason, doubted.accepted) == (Reason.BY_REGION, False)


def test_by_region_is_said_only_where_it_would_be_ambiguous_without_it():
    region = np.repeat([1, 0], 12)
    side = np.hstack([[-10.0, 0, 0], np.cross([0.02, 0.0, 0.0], [-10.0, 0, 0])])  # meets the lower block only
    alone = ContactSolver(two_blocks(region)).locate(side)
    assert (alone.reason, alone.region) == (Reason.OK, 1)
    probe = bundled("convex", 1000, regions=True)
    rng = np.random.default_rng(5)
    wrenches = add_noise(random_wrenches(probe, 3_000, rng, pitch=0.001, angle=60), WrenchNoise(), rng)
    declared = ContactSolver(probe).locate_batch(wrenches)
    # The same gates, and a region that is worth nothing.
    plain = ContactSolver(probe, gates=Gates(region_odds=1)).locate_batch(wrenches)
    by_region = declared.reasons == Reason.BY_REGION
    assert by_region.sum() > 30
    # A region draws touches at its border inwards, as far as the noise lets it: that is the same touch.
    radius = np.maximum(Gates().ambiguity_distance, 4.5 * plain.sigma_max)
    elsewhere = np.linalg.norm(declared.points - plain.points, axis=1) > radius
    # Without the region another place is as likely, or one that explains the wrench better was the answer.
    overruled = declared.misfits > plain.misfits + 0.5
    assert np.all((plain.reasons[by_region] == Reason.AMBIGUOUS) | overruled[by_region])
    assert np.mean(plain.reasons[by_region] == Reason.AMBIGUOUS) > 0.5
    sure = np.isin(declared.reasons, (Reason.OK, Reason.VERTEX))
    assert sure.sum() > 1_000
    assert np.isin(plain.reasons[sure], (Reason.OK, Reason.VERTEX)).mean() > 0.999
    assert not elsewhere[sure].any()
    assert Reason.BY_REGION not in plain.reasons


def test_regions_rank_by_number():
    contact = ContactSolver(two_blocks(np.repeat([2, 1], 12))).locate(ON_BOTH)
    assert contact.point[2] == pytest.approx(0.07)
    swapped = ContactSolver(two_blocks(np.repeat([1, 2], 12)), gates=Gates(first_odds=1)).locate(ON_BOTH)
    assert swapped.point[2] == pytest.approx(0.01)


def test_an_untouchable_place_turns_the_answer():
    """The upper block is behind a clamp: the lower one is touched, though the line of force meets it later."""
    hidden = two_blocks(np.repeat([0, 1], 12))
    hidden = hidden.with_region(hidden.region, untouchable=(1,))
    contact = ContactSolver(hidden).locate(ON_BOTH)
    assert contact.reason == Reason.BY_REGION
    assert np.allclose(contact.point, [0.005, 0.003, 0.01], atol=1e-6)
    assert contact.candidates[0].why == "less likely to be touched, as declared"
    assert contact.candidates[0].region == 1


def test_what_is_untouchable_is_still_given_where_nothing_else_explains_it():
    hidden = two_blocks(np.repeat([0, 1], 12))
    hidden = hidden.with_region(hidden.region, untouchable=(1,))
    side = np.hstack([[-10.0, 0, 0], np.cross([0.02, 0.0, 0.06], [-10.0, 0, 0])])
    contact = ContactSolver(hidden).locate(side)
    assert (contact.reason, contact.region) == (Reason.OK, 1)


def test_region_only():
    contact = ContactSolver(two_blocks(), gates=Gates(region_only=True)).locate(ON_BOTH)
    assert contact.reason == Reason.OUTSIDE_REGION
    assert contact.point is None
    assert contact.confidence == 0.0


def test_the_previous_contact_settles_it():
    previous = np.array([0.005, 0.002, 0.01])
    contact = ContactSolver(two_blocks()).locate(ON_BOTH, previous)
    assert contact.reason == Reason.OK
    assert contact.point[2] == pytest.approx(0.01)
    # With less trust in it there is a doubt, but the same answer.
    less = ContactSolver(two_blocks(), gates=Gates(follow_odds=100)).locate(ON_BOTH, previous)
    assert less.reason == Reason.AMBIGUOUS
    assert less.point[2] == pytest.approx(0.01)
    assert [c.why for c in less.candidates] == ["far from the previous contact"]
    assert ContactSolver(two_blocks(), gates=Gates(follow_distance=2e-3)).locate(ON_BOTH, previous).point[
        2
    ] == pytest.approx(0.01)
    assert ContactSolver(two_blocks(), gates=Gates(follow_distance=0.5e-3)).locate(ON_BOTH, previous).point[
        2
    ] == pytest.approx(0.07)


# ---- confidence ----------------------------------------------------------------------------------


@pytest.mark.parametrize("regions", [False, True])
@pytest.mark.parametrize("name", assets.PROBE_NAMES)
def test_confidence_is_that_of_the_rivals(name, regions):
    probe, rng = bundled(name, 1000, regions=regions), np.random.default_rng(6)
    solver = ContactSolver(probe)
    wrenches = add_noise(random_wrenches(probe, 1_500, rng, pitch=0.001, angle=80), WrenchNoise(), rng)
    batch = solver.locate_batch(wrenches)
    assert batch.confidences.min() >= 0
    assert batch.confidences.max() <= 1
    rivalled = 0
    for row in np.flatnonzero(np.isfinite(batch.points[:, 0])):
        contact = batch[row]
        least = solver.gates.depth_distance * np.cos(np.radians(contact.friction_angle))  # off its plane
        assert all(c.distance > least for c in contact.candidates)
        deltas = np.array([c.delta for c in contact.candidates])
        rivalled += len(deltas) > 0
        assert contact.confidence == pytest.approx(1 / (1 + np.exp(-deltas / 2).sum()), rel=1e-12)
        near = deltas <= 2 * np.log(solver.gates.rival_odds)
        assert (contact.reason == Reason.AMBIGUOUS) == bool(near.any())
        if contact.accepted:
            assert contact.confidence > 0.9
    assert rivalled > 30


# ---- tracking ------------------------------------------------------------------------------------


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
        ({"rival_odds": 0.5}, "rival_odds"),
        ({"region_odds": float("nan")}, "region_odds"),
        ({"untouchable_odds": 1e10}, "untouchable_odds"),
        ({"follow_odds": 0}, "follow_odds"),
        ({"implausible_probability": 0}, "implausible_probability"),
        ({"recent_samples": -1}, "recent_samples"),
        ({"recent_samples": 1.5}, "recent_samples"),
        ({"first_odds": float("inf")}, "first_odds"),
        ({"saturation": (1, 1, 1)}, "saturation"),
        ({"saturation": (1, 1, 1, 1, 1, 0)}, "saturation.5"),
        ({"max_age": float("nan")}, "max_age"),
    ],
)
def test_impossible_gates_are_refused(arguments, said):
    with pytest.raises(InputError, match=said):
        Gates(**arguments)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"torsion_arm": -1e-3}, "torsion_arm"),
        ({"torsion_arm": float("inf")}, "torsion_arm"),
        ({"mesh_deviation": float("nan")}, "mesh_deviation"),
    ],
)
def test_impossible_touches_are_refused(arguments, said):
    with pytest.raises(InputError, match=f"TouchModel.{said}"):
        TouchModel(**arguments)


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


def test_iterative_answers_explain_the_wrench_on_the_fitted_surface():
    probe = bundled("convex", 2000, regions=True)
    rng = np.random.default_rng(1)
    x, y = rng.uniform(-0.015, 0.015, 40), rng.uniform(-0.004, 0.004, 40)
    F = np.tile([0.5, 0.2, -9.0], (40, 1))
    M = np.cross(np.column_stack([x, y, np.full(40, 0.138)]), F)
    found, surface = methods.iterative(probe).locate_batch(np.hstack([F, M])), fit_contact_face(probe)
    given = np.isfinite(found.points[:, 0])
    assert given.mean() > 0.8
    x, y, z = ((found.points[given] - surface.origin_S) @ surface.axes_S.T).T
    c = surface.coefficients
    assert np.allclose(c[0] + c[1] * x + c[2] * y + c[3] * x * x + c[4] * x * y + c[5] * y * y, z, atol=1e-12)
    slopes = -c[1] - 2 * c[3] * x - c[4] * y, -c[2] - c[4] * x - 2 * c[5] * y
    normals = np.column_stack([*slopes, np.ones_like(x)]) @ surface.axes_S
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    left = (M - np.cross(found.points, F))[given]
    assert np.allclose(found.torques[given, None] * normals, left, atol=1e-9)


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


@pytest.mark.parametrize("accept_by_region", [True, False])
@pytest.mark.parametrize("way", ["locate_batch", "track_batch"])
def test_asking_for_nearness_changes_what_is_accepted_and_no_place(way, accept_by_region):
    probe, rng, asked = bundled("t-shape", 1000, regions=True), np.random.default_rng(4), 0.002
    touches = draw_touches(assets.surface("t-shape"), 600, rng, force=(0.6, 12.0), above=0.1)
    wrenches = add_noise(touches.wrenches, WrenchNoise(), rng)
    kinds = {"accept_by_region": accept_by_region}
    plain, near = (ContactSolver(probe, gates=Gates(**kinds, **more)) for more in ({}, {"sigma_max": asked}))
    before, after = getattr(plain, way)(wrenches), getattr(near, way)(wrenches)
    wide = before.accepted & (before.sigma_max > asked)
    assert 50 < wide.sum() < before.accepted.sum() - 50
    assert (Reason.BY_REGION in before.reasons[wide]) is accept_by_region
    assert (after.reasons == np.where(wide, Reason.UNCERTAIN, before.reasons)).all()
    assert (after.accepted == (before.accepted & ~wide)).all()
    for each in ("points", "sigma_max", "confidences", "misfits", "candidates", "faces", "seconds"):
        np.testing.assert_array_equal(getattr(after, each), getattr(before, each))
    contact = after[int(np.argmax(wide))]
    assert (contact.reason, contact.accepted) == (Reason.UNCERTAIN, False)
    covariances = before.covariances[before.accepted]
    deep = [
        c.normal @ c.covariance @ c.normal for c in map(before.__getitem__, map(int, np.flatnonzero(wide)))
    ]
    assert max(deep) > 1e-6  # off the surface, too, where one layer lies close before another
    np.testing.assert_allclose(
        before.sigma_max[before.accepted], np.sqrt(np.linalg.eigvalsh(covariances)[:, -1]), rtol=1e-12
    )
    assert contact.within == pytest.approx(np.sqrt(-2 * np.log(0.05)) * contact.sigma_max)
    assert near.search_differences(wrenches, None).size == 0


def test_an_uncertain_touch_is_followed_and_the_methods_of_others_are_asked_the_same():
    near, light = (
        ContactSolver(ball(), gates=Gates(sigma_max=0.002)),
        push((0.01, 0.02, -0.6), (0.001, 0.002, 0.13)),
    )
    assert near.track(push()).accepted
    assert {near.track(light).reason for _ in range(30)} == {Reason.UNCERTAIN}
    assert near.previous is not None, "a touch that is there is not lost, however long it is light"
    for name, sigma_max, reason in (("scan", 0.002, Reason.UNCERTAIN), ("scan", 0.0, Reason.OK)):
        method = methods.make(name, ball(), gates=Gates(sigma_max=sigma_max))
        assert method.locate(light).reason == reason


def test_more_noise_never_makes_a_touch_surer():
    probe, rng = bundled("t-shape", 1000), np.random.default_rng(8)
    wrenches = random_wrenches(probe, 1_000, rng, pitch=0.001, angle=60)
    batches = [
        ContactSolver(probe, WrenchNoise(0.05 * n, 0.002 * n)).locate_batch(wrenches) for n in (1, 4, 16)
    ]
    for quiet, loud in pairwise(batches):
        # Where both give the same place, its uncertainty has grown.
        same = np.linalg.norm(quiet.points - loud.points, axis=1) < 1e-3
        assert same.sum() > 500
        assert np.all(loud.sigma_max[same] > quiet.sigma_max[same])
    doubted = [np.mean(batch.reasons == Reason.AMBIGUOUS) for batch in batches[:2]]
    assert doubted[1] > doubted[0]


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

"""The arm that a run learns: from one touch that is followed, by time, and never from a second touch."""

import numpy as np
import pytest
from benchmarks import torsion
from contact_cases import bundled

from contactbench.pipeline.config.runtime.model import TouchModelPart
from contactbench.pipeline.config.runtime.values import touch_model_of
from contactbench.pipeline.contact import ContactSolver, Reason, TouchModel, WrenchNoise
from contactbench.pipeline.simulation import add_noise
from contactbench.pipeline.touch_settings import arm_of

POINT, NORMAL = np.array([0.0, 0.0, 0.03]), np.array([0.0, 0.0, 1.0])
QUIET = WrenchNoise(1e-6, 1e-7)
SURE = TouchModel(model_error=QUIET)


def ball() -> ContactSolver:
    from contact_cases import ball as made

    return ContactSolver(made(height=0.0), QUIET, model=SURE)


def press(force=8.0, pitch=0.0, point=POINT):
    """A press of a ball about the origin, along the normal."""
    normal = point / np.linalg.norm(point)
    return np.concatenate([-force * normal, -pitch * force * normal])


def track(solver, wrenches, step=0.005):
    return solver.track_batch(wrenches, np.zeros(len(wrenches)), np.full(len(wrenches), step))


@pytest.mark.parametrize("rate", [100.0, 1000.0])
def test_the_arm_follows_the_pitch_by_time_and_forgets(rate):
    solver, seconds = ball(), 0.5
    count = int(seconds * rate)
    arms = 1e3 * track(solver, np.tile(press(pitch=0.002), (count + 1, 1)), 1 / rate).torsion_arms
    # The first sample is followed by the rest; then the weight of so many seconds, forgotten over one.
    weight = 1 - np.exp(-seconds)
    assert arms[0] == 1.0
    assert arms[-1] == pytest.approx(np.sqrt((0.5 + 2.5 * 4 * weight) / (0.5 + weight)), rel=0.02)
    quiet = track(solver, np.tile(press(), (int(6 * rate), 1)), 1 / rate)
    assert quiet.torsion_arms[-1] == 0.001


def test_without_times_or_where_it_is_fixed_nothing_is_learned():
    wrenches = np.tile(press(pitch=0.002), (100, 1))
    for solver, steps in (
        (ball(), np.zeros(100)),
        (ball(), np.full(100, np.nan)),
        (
            ContactSolver(ball().probe, QUIET, model=TouchModel(model_error=QUIET, torsion_learned=False)),
            None,
        ),
    ):
        batch = solver.track_batch(wrenches, np.zeros(100), np.full(100, 0.005) if steps is None else steps)
        assert (batch.torsion_arms == 0.001).all()
    assert np.isnan(solver.track(wrenches[0], 0.0, 0.005).torsion_since)
    learned = ball()
    track(learned, wrenches)
    assert learned.locate(wrenches[0]).torsion_arm == 0.001


def test_one_reading_that_is_wild_does_not_reach_the_cap():
    solver = ball()
    wild = np.tile(press(), (100, 1))
    wild[50] = press(pitch=1.0)
    assert 1.0 < 1e3 * track(solver, wild).torsion_arms[51] < 1.7
    assert 1e3 * track(solver, np.tile(press(pitch=0.008), (800, 1))).torsion_arms.max() <= 9.0


def test_noise_of_a_light_touch_is_no_torsion():
    rng, probe = np.random.default_rng(0), bundled("convex", 1000)
    top = probe.vertices[probe.vertices[:, 2].argmax()]
    push = np.array([0.2, 0.0, -1.0])
    wrench = np.concatenate([push, np.cross(top, push)])
    batch = track(ContactSolver(probe), add_noise(np.tile(wrench, (2000, 1)), WrenchNoise(), rng))
    assert np.sqrt(np.mean(batch.arms**2)) > 0.0019  # of the noise alone
    assert np.quantile(batch.torsion_arms, 0.9) < 0.0035


def test_it_is_forgotten_where_the_touch_is_lost_or_a_second_one_steps_in():
    solver = ball()

    def see(wrench, times):
        for _ in range(times):
            contact = solver.track(wrench, 0.0, 0.005)
        return contact

    assert see(press(pitch=0.002), 100).torsion_since == pytest.approx(0.495)
    see(np.zeros(6), solver.gates.recent_samples + 2)
    again = see(press(), 1)
    assert (again.torsion_arm, again.torsion_since) == (0.001, 0.0)
    see(press(pitch=0.002), 100)
    side = press(6.0, point=0.03 * np.array([np.sqrt(0.75), 0, 0.5]))
    both = see(press(pitch=0.002) + side, 2)
    assert both.reason == Reason.TWO_TOUCHES
    assert (both.torsion_arm, both.torsion_since) == (0.001, 0.0)
    solver.reset()
    assert see(press(), 1).torsion_since == 0.0


def test_the_ellipse_grows_along_the_slide_by_what_was_learned():
    solver, slope = ball(), np.array([0.5, 0.0])
    force = 8.0 * np.array([*slope, -1.0])
    wrench = np.concatenate([force, np.cross(POINT, force) + 0.016 * NORMAL])
    batch = track(solver, np.tile(wrench, (200, 1)))
    contact = batch[199]
    fixed = ContactSolver(solver.probe, QUIET, model=TouchModel(contact.torsion_arm, QUIET)).locate(wrench)
    assert np.allclose(fixed.point, contact.point)
    grown = contact.covariance - fixed.covariance
    cosine = -contact.normal @ force / np.linalg.norm(force)
    along = force / np.linalg.norm(force) / cosine + contact.normal
    assert np.allclose(grown, (contact.torsion_arm**2 - 1e-6) / 2.5 * np.outer(along, along), atol=1e-12)
    assert np.allclose(batch.covariances[199], contact.covariance)


def test_a_scene_says_where_the_arm_begins_and_a_length_counts_more():
    assert arm_of(None, None) == TouchModel().torsion_arm == 0.001
    assert [arm_of(None, scene) for scene in ("dry", "gel", "bone")] == [0.002, 0.001, 0.0005]
    assert arm_of(0.003, "dry") == 0.003


def test_a_bundle_of_before_keeps_its_arm_fixed():
    part = {
        "torsion_arm_m": 0.001,
        "model_error": {"force_N": [0.05] * 3, "torque_Nm": [0.001] * 3, "measured": False},
        "mesh_deviation_m": 0.0,
        "mesh_curved": True,
    }
    before = TouchModelPart.model_validate(part)
    assert not touch_model_of(before).torsion_learned
    assert before.model_dump(mode="json") == part
    assert touch_model_of(TouchModelPart.model_validate({**part, "torsion": "learned"})).torsion_learned


@pytest.mark.parametrize("name", ["convex", "linear", "t-shape"])
def test_a_touch_that_spins_is_neither_refused_nor_moved(name):
    found = torsion.spin(name, 0.032, 6, 500, np.random.default_rng(1))
    assert found["fixed, refused"] > 15
    assert found["learned, refused"] <= 1.5
    assert found["learned, mean error"] < 0.6 * found["wrench_axis, mean error"]
    assert found["learned, mean error"] < found["iterative, mean error"] + 0.05


def test_a_second_touch_that_grows_slowly_is_not_learned_as_torsion():
    found = torsion.second("convex", 1.0, 120, np.random.default_rng(1))
    assert found["learned, from both"] <= found["fixed, from both"] + 6

"""A second touch that joins the one that is followed: told, with both places; and nothing else is taken for one."""

import numpy as np
import pytest
from contact_cases import bundled
from slides import draw_slide

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver, Reason, WrenchNoise
from contactbench.pipeline.simulation import add_noise, draw_touches

FORCE_N, SECOND_N = 8.0, 5.0
BEFORE, RAMP, AFTER = 60, 10, 60  # samples; 50 ms of ramp at 200 Hz


def pairs(name: str, count: int, rng: np.random.Generator):
    """Two touches, at least 30 mm apart, of which the first alone is sure."""
    surface, solver = assets.surface(name), ContactSolver(bundled(name, 2000))
    first = draw_touches(surface, count, rng, above=0.02, force=(FORCE_N, FORCE_N))
    second = draw_touches(surface, count, rng, above=0.02, force=(SECOND_N, SECOND_N))
    alone = solver.locate_batch(first.wrenches)
    good = np.linalg.norm(first.points - second.points, axis=1) > 0.03
    good &= alone.accepted & (alone.confidences > 0.999)
    return [
        (first.points[i], second.points[i], first.wrenches[i], second.wrenches[i])
        for i in np.flatnonzero(good)
    ]


@pytest.mark.parametrize("name", assets.PROBE_NAMES)
def test_a_second_touch_is_told_with_both_places(name):
    rng = np.random.default_rng(1)
    solver = ContactSolver(bundled(name, 2000))
    growing = np.concatenate([np.zeros(BEFORE), np.linspace(0, 1, RAMP + 1)[1:], np.ones(AFTER)])[:, None]
    told, near, cases = 0, 0, pairs(name, 120, rng)
    assert len(cases) > 40
    for p, q, first, second in cases:
        solver.reset()
        batch = solver.track_batch(add_noise(first + growing * second, WrenchNoise(), rng))
        pair = batch.reasons == Reason.TWO_TOUCHES
        assert not batch.accepted[pair].any()
        assert np.isfinite(batch.seconds[pair]).all()
        assert np.isnan(batch.seconds[~pair]).all()
        # From when it is fully there; the first touch is the reference for as long as nothing else is accepted.
        steady = np.flatnonzero(pair[BEFORE + RAMP : BEFORE + RAMP + 20]) + BEFORE + RAMP
        told += len(steady) >= 18
        off_first = np.linalg.norm(batch.points[steady] - p, axis=1)
        off_second = np.linalg.norm(batch.seconds[steady] - q, axis=1)
        near += len(steady) > 0 and np.median(off_first) < 0.005 and np.median(off_second) < 0.005
    assert told >= 0.9 * len(cases)
    assert near >= 0.9 * len(cases)


def test_a_second_touch_that_leaves_gives_the_first_back():
    name, rng = "convex", np.random.default_rng(2)
    solver = ContactSolver(bundled(name, 2000))
    there = np.concatenate([np.zeros(BEFORE), np.ones(30), np.zeros(60)])[:, None]
    came_back, cases = 0, pairs(name, 40, rng)
    for p, _, first, second in cases:
        solver.reset()
        batch = solver.track_batch(add_noise(first + there * second, WrenchNoise(), rng))
        if not (batch.reasons[BEFORE : BEFORE + 30] == Reason.TWO_TOUCHES).all():
            continue
        came_back += 1
        assert batch.accepted[-30:].all()
        assert np.linalg.norm(batch.points[-30:] - p, axis=1).max() < 0.005
    assert came_back > 0.7 * len(cases)


@pytest.mark.parametrize("name", assets.PROBE_NAMES)
def test_a_growing_force_is_one_touch(name):
    rng = np.random.default_rng(3)
    touches = draw_touches(assets.surface(name), 100, rng, above=0.02, force=(10, 10))
    share = np.concatenate([np.zeros(5), np.linspace(0, 1, 60), np.ones(30)])[:, None]
    solver = ContactSolver(bundled(name, 2000))
    told = 0
    for wrench in touches.wrenches:
        solver.reset()
        batch = solver.track_batch(add_noise(share * wrench, WrenchNoise(), rng))
        told += bool((batch.reasons == Reason.TWO_TOUCHES).any())
    assert told == 0


@pytest.mark.parametrize("name", assets.PROBE_NAMES)
@pytest.mark.parametrize("legs", [1, 3])
def test_a_slide_is_one_touch(name, legs):
    """As long as it is slower than 10 mm in 20 samples; that is what tells a slide from a step."""
    rng = np.random.default_rng(4)
    slide = draw_slide(assets.surface(name), 6_000, rng, force=(2.0, 15.0), legs=legs, lifted=0.0)
    assert np.linalg.norm(slide.points[20:] - slide.points[:-20], axis=1).max() < 0.009
    batch = ContactSolver(bundled(name, 2000)).track_batch(add_noise(slide.wrenches, WrenchNoise(), rng))
    assert np.count_nonzero(batch.reasons == Reason.TWO_TOUCHES) == 0


def test_locating_alone_never_tells_two():
    rng = np.random.default_rng(5)
    first = draw_touches(assets.surface("linear"), 2_000, rng, above=0.02).wrenches
    second = draw_touches(assets.surface("linear"), 2_000, rng, above=0.02).wrenches
    batch = ContactSolver(bundled("linear", 2000)).locate_batch(first + second)
    assert Reason.TWO_TOUCHES not in batch.reasons
    assert np.isnan(batch.seconds).all()

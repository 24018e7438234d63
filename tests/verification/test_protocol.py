from dataclasses import replace

import numpy as np
import pytest
from verification.touch_cases import MODEL, NOISE, Push, markers, probe, protocol, stream, touches

from contactbench import assets
from contactbench.pipeline.contact import TouchModel
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.verification.figures import TouchFigure, VerificationLimits
from contactbench.pipeline.verification.markers import TouchLocator, make_markers, with_normals
from contactbench.pipeline.verification.protocol import UNRESOLVED, ProtocolSettings, ProtocolState, Why
from contactbench.pipeline.verification.verdict import unresolved


def only(found):
    assert len(found) == 1
    return found[0]


def test_a_settled_press_is_accepted_at_its_marker():
    touch = only(touches(Push(marker=2)))
    assert touch.why is None
    assert touch.placed.marker == 2
    assert np.linalg.norm(touch.located.point - markers()[2].point_S) < 5e-4
    assert touch.force == pytest.approx(9.0, abs=0.1)
    assert touch.window == (8.0, 10.0)


@pytest.mark.parametrize(
    ("push", "why"),
    [
        (Push(force=5.0), Why.FORCE),
        (Push(force=14.0), Why.FORCE),
        (Push(held=0.3), Why.SHORT),
        (Push(held=0.08), Why.SHORT),
        (Push(rise=0.6, force=9.9, held=0.6), Why.UNSETTLED),
        (Push(slide=0.02), Why.SLIPPED),
        (Push(shift=0.005), Why.AMBIGUOUS),
    ],
)
def test_a_press_is_rejected_with_the_reason(push, why):
    assert only(touches(push)).why is why


def test_a_press_far_from_every_marker_is_of_none_of_them():
    touch = only(touches(Push(marker=2, shift=0.016)))
    assert touch.why is Why.FAR
    assert touch.placed.far


def test_a_clipped_reading_rejects_the_press():
    assert only(touches(Push(), saturated=[90])).why is Why.SATURATED


def test_a_wrench_that_meets_no_surface_misses_the_probe():
    assert only(touches(Push(marker=1, shift=0.2))).why is Why.MISSED


def test_a_torque_that_no_tip_gives_is_no_touch_but_its_marker_is_told():
    touch = only(touches(Push(marker=2, twist=0.008)))
    assert touch.why is Why.IMPLAUSIBLE
    assert touch.why in UNRESOLVED
    assert touch.placed.marker == 2
    assert touch.located.torque == pytest.approx(0.008 * 9.0, rel=0.1)
    nowhere = only(touches(Push(marker=2, shift=0.016, twist=0.008)))
    assert (nowhere.why, nowhere.placed, nowhere.located) == (Why.IMPLAUSIBLE, None, None)


def test_a_touch_that_only_its_region_makes_sure_is_accepted():
    linear = Probe.from_arrays(*assets.make("linear", 2_000))
    top = (linear.normals[:, 2] > 0.5) & (linear.vertices[linear.faces, 2].mean(axis=1) > 0.14)
    found = []
    for told in (linear, linear.with_region(top.astype(np.int32))):
        foot = told.bounds[1] * [0.5, 0.0, 1.0]
        targets = with_normals(make_markers([foot]), told)[0]
        F = np.array([0.0, 0.0, -9.0])
        wrenches = np.tile(np.hstack([F, np.cross(foot, F)]), (50, 1))
        located = TouchLocator(told, targets, MODEL, NOISE).locate(wrenches, np.tile(np.eye(3), (50, 1, 1)))
        found.append((located.ambiguous, located.implausible))
    assert found == [(True, False), (False, False)]


def test_the_model_error_that_is_assumed_is_not_averaged_away():
    """What drifts is the same in all samples."""
    floor = TouchModel().model_error.covariance
    for samples in (4, 400):
        solver = TouchLocator(probe(), markers(), MODEL, NOISE, samples).solver
        np.testing.assert_allclose(solver.covariance, NOISE.covariance / samples + floor, rtol=1e-12)


def test_the_order_is_free_unless_it_is_given():
    pushes = (Push(marker=2), Push(marker=0), Push(marker=1))
    assert [touch.placed.marker for touch in touches(*pushes)] == [2, 0, 1]
    found = touches(*pushes, settings=ProtocolSettings(order=("left", "right", "middle")))
    assert [touch.why for touch in found] == [None] * 3
    assert [touch.placed.marker for touch in found] == [0, 2, 1]  # the expected ones, however far off
    assert [touch.placed.far for touch in found] == [True, True, False]


def test_several_windows_each_take_their_own():
    settings = ProtocolSettings(windows=((4.0, 6.0), (8.0, 10.0)))
    found = touches(Push(force=5.0), Push(force=9.0), Push(force=7.0), settings=settings)
    assert [touch.window for touch in found] == [(4.0, 6.0), (8.0, 10.0), None]
    assert found[2].why is Why.FORCE


def test_events_do_not_depend_on_the_blocks():
    times, wrenches, R_WS = stream(Push(), Push(force=5.0), Push(marker=0))
    whole, pieces = protocol(), protocol()
    expected = [*whole.feed(times, wrenches, R_WS), *whole.finish()]
    got = []
    for part in np.array_split(np.arange(len(times)), 97):
        got += pieces.feed(times[part], wrenches[part], R_WS[part])
    got += pieces.finish()
    assert [(event.time, event.state) for event in got] == [(event.time, event.state) for event in expected]
    states = [event.state for event in expected]
    assert states[:4] == [
        ProtocolState.TOUCHING,
        ProtocolState.SETTLED,
        ProtocolState.ACCEPTED,
        ProtocolState.ARMED,
    ]
    assert ProtocolState.REJECTED in states


def test_the_state_is_told_while_it_happens():
    followed = protocol()
    times, wrenches, R_WS = stream(Push())
    seen = []
    for row in range(len(times)):
        followed.feed(times[row : row + 1], wrenches[row : row + 1], R_WS[row : row + 1])
        if not seen or seen[-1] is not followed.state:
            seen.append(followed.state)
    assert seen == [
        ProtocolState.ARMED,
        ProtocolState.TOUCHING,
        ProtocolState.SETTLED,
        ProtocolState.ACCEPTED,
        ProtocolState.ARMED,
    ]


def test_a_stream_that_ends_or_pauses_while_touching_still_gives_its_touch():
    times, wrenches, R_WS = stream(Push())
    cut = slice(0, 100)
    followed = protocol()
    followed.feed(times[cut], wrenches[cut], R_WS[cut])
    ended = [event.touch for event in followed.finish() if event.touch]
    assert only(ended).why is Why.SHORT
    followed = protocol()
    followed.feed(times[cut], wrenches[cut], R_WS[cut])
    paused = followed.feed(times[cut] + 10.0, wrenches[cut], R_WS[cut])
    assert [event.touch.why for event in paused if event.touch] == [Why.SHORT]


def test_samples_without_numbers_or_out_of_order_are_left_out():
    times, wrenches, R_WS = stream(Push())
    wrenches[80] = np.nan
    times[85] = times[70]
    events = protocol().feed(times, wrenches, R_WS)
    assert [event.touch.why for event in events if event.touch] == [None]


@pytest.mark.parametrize(
    "wrong",
    [
        {"windows": ()},
        {"windows": ((1.0, 3.0),)},
        {"windows": ((9.0, 8.0),)},
        {"samples": 1},
        {"repeats": 0},
        {"release_N": 5.0},
        {"settle_s": 0.0},
    ],
)
def test_settings_out_of_range_are_refused(wrong):
    with pytest.raises(InputError):
        ProtocolSettings(**wrong)


def test_an_order_of_unknown_markers_is_refused():
    with pytest.raises(InputError, match="nowhere"):
        protocol(ProtocolSettings(order=("nowhere",)))


def test_a_slow_hand_is_taken_once_it_rests():
    touch = only(touches(Push(rise=2.5, held=4.0)))
    assert touch.why is None
    assert touch.span[0] > 2.0


def test_fifty_samples_at_a_kilohertz_are_not_enough():
    touch = only(touches(Push(held=0.9), settings=ProtocolSettings(samples=8)))
    assert touch.span[1] - touch.span[0] > 0.24


def test_a_probe_that_moves_on_without_release_takes_its_touch_back():
    times, wrenches, R_WS = stream(Push(held=0.6), Push(marker=0, held=1.0))
    first, second = 60, 60 + 120 + 60
    joined = np.r_[
        0 : first + 120, second + 20 : len(times)
    ]  # without the pause between, nor the second's rise
    followed = protocol()
    times = times[: len(joined)]
    events = [*followed.feed(times, wrenches[joined], R_WS[joined]), *followed.finish()]
    told = [event.touch for event in events if event.touch]
    assert [touch.why for touch in told] == [None, Why.MOVED]
    assert told[0].start == told[1].start
    assert told[1].time > told[0].time


def test_a_probe_that_stays_keeps_its_touch():
    assert only(touches(Push(held=3.0))).why is None


@pytest.mark.parametrize(("mm", "count"), [(1.9, 0), (2.1, 1), (None, 1)])
def test_an_ambiguous_touch_is_unresolved_unless_its_first_answer_was_right(mm, count):
    sure = TouchFigure(1, 0.0, 1.0, True, "", "M1", 1, 9.0, distance_mm=0.1)
    doubtful = replace(sure, accepted=False, reason=Why.AMBIGUOUS, distance_mm=mm)
    assert unresolved([sure, doubtful], VerificationLimits(max_m=0.002)).touches == count

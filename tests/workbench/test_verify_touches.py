"""Live touches: what the protocol hears, whose turn it is, and that a recording is judged by the same order."""

import numpy as np
import pytest
from verification.touch_cases import MODEL, NOISE, Push, markers, probe, stream

from contactbench.pipeline.verification.protocol import ProtocolSettings, ProtocolState
from contactbench.pipeline.verification.verify import VerifySettings
from contactbench.pipeline.workbench.live import LiveBlock
from contactbench.pipeline.workbench.verify_touches import LiveTouches, TouchOrder, live_noise


def following(**protocol):
    return LiveTouches(probe(), MODEL, markers(), VerifySettings(ProtocolSettings(**protocol)), (NOISE, 1.0))


def play(touches, *pushes, start=0.0, seed=0, poses=True):
    """Feed pushes as a stream would, in small blocks of raw readings; return when the next may begin, s."""
    times, wrenches, R_WS = stream(*pushes, seed=seed)
    raw = wrenches - MODEL.compensate(R_WS, 0 * wrenches)
    if not poses:
        R_WS = np.full_like(R_WS, np.nan)
    clear = np.zeros(len(times), dtype=bool)
    for row in range(0, len(times), 7):
        part = slice(row, row + 7)
        touches.feed(LiveBlock(start + times[part], raw[part], R_WS[part], clear[part]))
    return start + times[-1] + 0.005


def states(touches):
    return [event.state for event in touches.take_events()]


def test_a_touch_is_heard_from_beginning_to_end():
    touches = following()
    assert touches.view().next_one == 0
    play(touches, Push(1))
    assert states(touches) == [
        ProtocolState.TOUCHING,
        ProtocolState.SETTLED,
        ProtocolState.ACCEPTED,
        ProtocolState.ARMED,
    ]
    assert states(touches) == []
    view = touches.view()
    assert (view.accepted, view.wanted, view.next_one) == (1, 3, 0)
    assert view.last.marker == "middle"
    assert view.last.size_mm < 1.0
    assert view.last.ratio == pytest.approx(view.last.size_mm / view.last.sigma_mm)
    assert [row.state for row in view.rows] == ["open", "done", "open"]
    assert view.mean_mm == pytest.approx(view.errors_mm[0])
    assert view.sd_mm is None
    ((start, end, covariance),) = view.contacts
    assert covariance.shape == (3, 3)
    assert np.linalg.norm(end - start) * 1e3 == pytest.approx(view.last.size_mm)


def test_with_a_zero_that_follows_a_lift_is_asked_for_and_told():
    settings = VerifySettings(ProtocolSettings(), follow=True)
    touches = LiveTouches(probe(), MODEL, markers(), settings, (NOISE, 1.0))
    assert touches.view().notice == "Lift the probe clear for half a second: the zero follows."
    end = play(touches, Push(1))
    assert touches.view().accepted == 1
    assert touches.view().notice == "The zero was seen: touch the next marker."
    times, raw, R_WS = end + 0.005 * np.arange(400), MODEL.predict(np.eye(3)[None]), np.eye(3)
    lean = np.repeat(raw + np.array([0.4, 0, 0, 0, 0, 0]), 400, axis=0)
    turned = np.repeat(R_WS[None], 400, axis=0)
    touches.feed(LiveBlock(times, lean, turned, np.zeros(400, dtype=bool)))
    assert "Zero has stopped following" in touches.view().notice


def test_a_touch_that_does_not_count_says_why_and_changes_nothing():
    touches = following()
    play(touches, Push(0, force=4.0))
    view = touches.view()
    assert view.accepted == 0
    assert view.last.why == "force out of window"
    assert view.rows[0].state == "open"


def test_an_error_beyond_the_limit_is_shown():
    touches = following()
    play(touches, Push(1, shift=0.003))
    view = touches.view()
    assert view.accepted == 1
    assert view.rows[1].state == "failed"
    assert view.rows[1].max_mm == pytest.approx(3.0, abs=0.5)


def test_markers_can_be_left_out_and_touched_once_more():
    touches = following()
    assert touches.skip() == "left"
    assert touches.view().next_one == 1
    end = play(touches, Push(1), Push(2))
    assert touches.view().next_one is None
    touches.repeat("middle")
    view = touches.view()
    assert view.next_one == 1
    assert view.rows[1].wanted == 2
    play(touches, Push(1), start=end, seed=1)
    view = touches.view()
    assert view.next_one is None
    assert view.rows[1].touches == 2
    assert view.rows[0].state == "skipped"
    touches.repeat("left")
    assert touches.view().rows[0].state == "open"


def test_each_force_window_is_asked_for():
    touches = following(windows=((4.0, 6.0), (8.0, 10.0)))
    play(touches, Push(0, force=9.0))
    view = touches.view()
    assert (view.next_one, view.window, view.wanted) == (0, (4.0, 6.0), 6)


def test_in_a_given_order_a_touch_is_of_the_next_marker():
    touches = following(order=("left", "middle", "right"))
    end = play(touches, Push(0))
    assert touches.skip() == "middle"
    end = play(touches, Push(2), start=end, seed=1)
    view = touches.view()
    assert [row.touches for row in view.rows] == [1, 0, 1]
    assert view.next_one is None
    touches.repeat("left")
    play(touches, Push(0), start=end, seed=2)
    # What the recording must be judged by is what was asked for, touch by touch.
    assert touches.order == ("left", "right", "left")
    assert [row.touches for row in touches.view().rows] == [2, 0, 1]


def test_turns_go_round_once_per_repeat():
    turns = TouchOrder.of(("a", "b"), 2, 1)
    assert turns.names == ["a", "b", "a", "b"]
    assert turns.skip(3)
    assert turns.names == ["a", "b", "a"]
    assert turns.skip(3) is False
    assert turns.skip(0)  # this time and all others
    assert turns.names == ["b"]
    assert turns.skip(0)
    assert turns.skip(0) is False


def test_the_last_of_an_order_can_be_left_out_too():
    touches = following(order=("left", "middle", "right"))
    play(touches, Push(0), Push(1))
    assert touches.skip("nothing reaches it", "left") is None, "it is not the next one"
    assert touches.skip("nothing reaches it", "right") == "right"
    assert touches.view().next_one is None
    assert touches.view().rows[2].state == "skipped"
    assert touches.left_out == {"right": "nothing reaches it"}
    assert touches.order == ("left", "middle")
    touches.repeat("right")
    assert touches.left_out == {}


def test_a_press_that_goes_on_ends_with_the_stream():
    touches = following()
    times, wrenches, R_WS = stream(Push(1, held=5.0))
    part = slice(0, 90)
    raw = wrenches[part] - MODEL.compensate(R_WS[part], 0 * wrenches[part])
    touches.feed(LiveBlock(times[part], raw, R_WS[part], np.zeros(90, dtype=bool)))
    assert touches.view().state is ProtocolState.SETTLED
    touches.end()
    assert touches.view().last.why


def test_what_is_in_the_way_is_said():
    touches = following()
    play(touches, Push(1), poses=False)
    assert "No pose" in touches.view().notice
    leaning = following()
    times = np.arange(60) / 200
    R_WS = np.tile(np.eye(3), (60, 1, 1))
    wrench = np.tile([0.0, 0.0, 1.5, 0.0, 0.0, 0.0], (60, 1))
    raw = wrench - MODEL.compensate(R_WS, 0 * wrench)
    leaning.feed(LiveBlock(times, raw, R_WS, np.zeros(60, dtype=bool)))
    assert "1.5 N" in leaning.view().notice
    fresh = following()
    assert fresh.view().notice == ""
    assert np.isnan(fresh.view().force)


def test_noise_is_told_from_a_run_of_samples():
    white = np.random.default_rng(1).standard_normal((200, 6)) * np.repeat([0.05, 0.002], 3)
    noise, correlation = live_noise(white)
    assert np.asarray(noise.force) == pytest.approx(np.full(3, 0.05), rel=0.3)
    assert correlation == pytest.approx(1.0, abs=0.2)
    assert live_noise(white[:10]) is None
    assert live_noise(np.cumsum(white, axis=0))[1] > 2

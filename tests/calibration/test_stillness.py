"""The detector against recordings whose truth is known, live against offline, and its advice against formulas."""

import time
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from calibration.streams import MODEL, WHITE, find_captures, stream
from hypothesis import given, settings
from hypothesis import strategies as st

from contactbench.pipeline.calibration import PoseNoise, calibrate
from contactbench.pipeline.calibration.poses import PoseError
from contactbench.pipeline.calibration.stillness import StillnessDetector, StillnessSettings, StillState
from contactbench.pipeline.calibration.stillness.quiet import NoiseFloor
from contactbench.pipeline.errors import InputError

RATE = 200.0


def still(seconds=10.0, seed=0, rate=RATE, white=WHITE):
    """White noise around one reading: times and samples."""
    rng = np.random.default_rng(seed)
    n = int(seconds * rate)
    return np.arange(n) / rate, [3, -4, -3, 0.1, 0.3, -0.2] + rng.standard_normal((n, 6)) * white


def live(t, wrenches, R_WS=None, **options):
    """Feed sample by sample; return the detector, and every state with its time."""
    detector = StillnessDetector(**options)
    states = [
        (time, detector.update(time, wrench, None if R_WS is None else R_WS[i]))
        for i, (time, wrench) in enumerate(zip(t.tolist(), wrenches, strict=True))
    ]
    return detector, states


def same(first, second):
    return all(
        np.array_equal(value, vars(second)[name])
        if isinstance(value, np.ndarray)
        else value == vars(second)[name]
        for name, value in vars(first).items()
    )


class Tally:
    """Captures of many recordings against their truth."""

    def __init__(self, seeds, *, use_R=False, model=None, chosen=None, **kinds):
        self.poses = self.missed = self.false = self.bumped = self.touched = 0
        errors = []
        for seed in seeds:
            recording = stream(seed, **kinds)
            R_WS = recording.R_WS if use_R else None
            report = find_captures(recording.t, recording.wrenches, chosen, R_WS, model)
            touched = {event.start for event in recording.events if event.kind == "touch"}
            wanted = {dwell.start for dwell in recording.dwells} - touched
            self.poses += len(wanted)
            for capture in report.captures:
                # One sample of motion is no capture in motion.
                dwell = recording.dwell_at(capture.start, capture.stop - 2 / recording.rate)
                if dwell is None:
                    self.false += 1
                    continue
                if dwell.start in touched:
                    self.touched += 1
                    continue
                self.bumped += any(
                    event.start < capture.stop - 0.02 and event.stop > capture.start + 0.02
                    for event in recording.events
                )
                wanted.discard(dwell.start)
                inside = (recording.t >= capture.start) & (recording.t <= capture.stop)
                # What a perfect sensor with this drift reads on average, untouched.
                truth = dwell.wrench + recording.drift[inside].mean(axis=0)
                errors.append((capture.mean - truth) / capture.standard_error)
            self.missed += len(wanted)
        self.errors = np.array(errors)

    @property
    def rms(self):
        return float(np.sqrt((self.errors**2).mean()))


# ---- captures against the truth --------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kinds", "seeds"),
    [
        ({}, 2),
        ({"hum": 0.3, "quantised": True, "missing": 0.05}, 2),
        ({"hum": 0.3, "mains": 60.0, "jitter": 0.3}, 2),
        ({"spikes": 0.005}, 2),
        ({"corner": 1.0}, 2),
        ({"corner": 0.05}, 2),
        ({"rate": 100.0}, 2),
        *(
            ({"rate": rate, "dwell": 14.0, "vertical": 0.0, "jitter": 0.1}, 6)
            for rate in (5.0, 10.0, 16.0, 25.0)
        ),
        ({"rate": 1000.0, "poses": 4}, 1),
        ({"white": WHITE / 20, "quantised": True}, 2),  # the median deviation is 0
    ],
    ids=lambda value: "-".join(value) or "clean" if isinstance(value, dict) else None,
)
def test_every_pose_is_captured_with_the_error_predicted(kinds, seeds):
    tally = Tally(range(100, 100 + seeds), **kinds)
    assert tally.false == 0
    assert tally.missed <= 0.02 * tally.poses
    assert tally.rms == pytest.approx(1.0, abs=0.3)
    assert np.abs(tally.errors).max() < 6.5


def test_hum_does_not_count_against_a_floor_that_was_given():
    chosen = StillnessSettings(floor_force=0.05, floor_torque=0.0014)
    tally = Tally(range(2), chosen=chosen, hum=0.5)
    assert (tally.false, tally.missed) == (0, 0)


def test_a_sensor_that_filters_its_readings_is_learnt():
    t, w = still(30.0)
    for i in range(1, len(w)):  # a low-pass of first order at 8 Hz
        w[i] = w[i - 1] + 0.22 * (w[i] - w[i - 1])
    report = find_captures(t, w)
    assert len(report.captures) == 1
    assert not report.rejected


def test_bumps_are_not_captured():
    tally = Tally(range(2), bumps=1.0, dwell=6.0)
    assert tally.poses == 16
    assert (tally.false, tally.bumped) == (0, 0)
    assert tally.missed <= 1


def test_touches_are_refused_once_there_is_a_model():
    tally = Tally(range(2), touches=0.4, use_R=True, model=MODEL)
    assert (tally.false, tally.touched, tally.missed) == (0, 0, 0)
    assert tally.poses < 16


def test_captures_calibrate():
    poses, errors = [], []
    for seed in (1, 2):
        recording = stream(seed, drift=0.0)
        report = find_captures(recording.t, recording.wrenches, R_WS=recording.R_WS)
        poses += [capture.to_pose(name=f"{seed}.{i}") for i, capture in enumerate(report.captures)]
        errors += [capture.standard_error for capture in report.captures]
    sigma = np.sqrt((np.array(errors) ** 2).mean(axis=0))
    calibration = calibrate(poses, PoseNoise(sigma[:3], sigma[3:]))
    assert len(calibration.rejected) <= 1  # 1/f noise has tails
    off = calibration.model.vector - MODEL.vector
    assert off @ np.linalg.solve(calibration.covariance, off) < 33  # chi-square of 12: one in 1000


# ---- live and offline ------------------------------------------------------------------------------


@pytest.mark.parametrize("use_R", [False, True])
def test_live_and_offline_agree_to_the_last_bit(use_R):
    recording = stream(7, poses=4, bumps=0.5, touches=0.3, missing=0.05, spikes=0.003, jitter=0.3)
    R_WS = recording.R_WS if use_R else None
    model = MODEL if use_R else None
    report = find_captures(recording.t, recording.wrenches, None, R_WS, model)
    detector, states = live(recording.t, recording.wrenches, R_WS, model=model)
    detector.finish()
    assert report.captures
    assert len(report.captures) == len(detector.captures)
    assert all(same(a, b) for a, b in zip(report.captures, detector.captures, strict=True))
    assert list(report.rejected) == detector.rejected
    told = [state.captured for _, state in states if state.captured]
    assert all(any(a is b for b in detector.captures) for a in told)


@given(cuts=st.lists(st.integers(0, 2400), max_size=8), seed=st.integers(0, 3))
@settings(max_examples=12, deadline=None)
def test_blocks_of_samples_may_be_cut_anywhere(cuts, seed):
    recording = stream(seed, poses=2, missing=0.1, dwell=4.0)
    edges = [0, *sorted(min(cut, len(recording.t)) for cut in cuts), len(recording.t)]
    detector = StillnessDetector()
    for start, stop in pairwise(edges):
        detector.update_block(recording.t[start:stop], recording.wrenches[start:stop])
    detector.finish()
    report = find_captures(recording.t, recording.wrenches)
    assert all(same(a, b) for a, b in zip(report.captures, detector.captures, strict=True))
    assert list(report.rejected) == detector.rejected


def test_samples_cost_little():
    recording = stream(1, rate=1000.0, poses=2)
    samples = list(zip(recording.t.tolist(), recording.wrenches, strict=True))
    detector = StillnessDetector(1000.0)
    begin = time.process_time()
    for t, wrench in samples:
        detector.update(t, wrench)
    assert (time.process_time() - begin) / len(samples) < 50e-6  # 5 % of a core at 1 kHz
    begin = time.process_time()
    find_captures(recording.t, recording.wrenches)
    assert (time.process_time() - begin) / len(samples) < 25e-6


@pytest.mark.parametrize("clock", ["epoch", "batches"])
def test_clocks_of_all_sorts(clock):
    recording = stream(5, poses=3)
    t = recording.t + 1.7e9
    if clock == "batches":  # eight samples arrive at a time and get the time of arrival
        t = np.ceil(recording.t / 0.04) * 0.04
    report = find_captures(t, recording.wrenches)
    usual = find_captures(recording.t, recording.wrenches)
    assert len(report.captures) == 3
    for capture, other in zip(report.captures, usual.captures, strict=True):
        assert capture.mean == pytest.approx(other.mean, abs=3 * other.standard_error.max())


# ---- states ----------------------------------------------------------------------------------------


def test_states_follow_a_pose():
    recording = stream(3, poses=2)
    _, states = live(recording.t, recording.wrenches)
    dwell = recording.dwells[1]
    moving = [state.state for t, state in states if dwell.start - 0.6 < t < dwell.start - 0.3]
    assert set(moving) <= {StillState.MOVING, StillState.SETTLING}
    settling = [
        state for t, state in states if dwell.start < t < dwell.stop and state.state is StillState.SETTLING
    ]
    waits = [state.seconds_until_still for state in settling[-60:]]
    assert waits == sorted(waits, reverse=True)
    captured = [(t, state) for t, state in states if state.captured and t > dwell.start]
    t, state = captured[0]
    assert dwell.settled < t < dwell.settled + 2.5
    assert state.state is StillState.STILL
    assert "Captured" in state.sentence
    assert "cannot be detected" in state.sentence  # a touch, without a model
    assert state.sd == pytest.approx(WHITE, rel=0.3)
    assert (np.abs(state.slope) < 4 * state.slope_sigma).all()


def test_a_bump_drops_the_capture_and_says_why():
    t, w = still()
    w[800:830, 2] += 2 * np.sin(np.linspace(0, np.pi, 30))
    detector, states = live(t, w, settings=StillnessSettings(min_duration=4.0))
    assert StillState.BUMPED in {state.state for _, state in states}
    first = detector.rejected[0]
    assert first.state is StillState.BUMPED
    assert "jumped by" in first.reason or "shook by" in first.reason
    assert first.stop <= t[829]
    assert [capture.start > t[829] for capture in detector.captures] == [True]
    bumped = next(time for time, state in states if state.state is StillState.BUMPED)
    assert 4.0 <= bumped <= 4.25  # the next block's end


def test_a_step_drops_the_capture_too():
    t, w = still()
    w[800:, 0] += 0.5
    detector, _ = live(t, w, settings=StillnessSettings(min_duration=4.0))
    assert detector.rejected[0].state is StillState.BUMPED
    assert all(capture.start > 4.0 or capture.stop < 4.0 for capture in detector.captures)


def test_leaving_early_keeps_what_is_long_enough():
    t, w = still()
    shake = np.sin(2 * np.pi * 9 * t[1000:]) * np.linspace(1, 5, 1000)
    w[1000:, :3] += shake[:, None]
    chosen = StillnessSettings(min_duration=2.0, target_force=1e-4, target_torque=1e-6, horizon=10.0)
    detector, _ = live(t, w, settings=chosen)
    (capture,) = detector.captures
    assert capture.stop <= 5.0
    detector, _ = live(t, w, settings=replace(chosen, min_duration=6.0))
    assert not detector.captures
    assert detector.rejected[0].state is StillState.MOVING
    assert "moved on after" in detector.rejected[0].reason


def test_spikes_are_excluded_and_counted():
    t, w = still()
    hit = np.arange(130, 2000, 150)
    w[hit, 1] += 25.0
    (capture,) = find_captures(t, w, StillnessSettings(min_duration=8.0)).captures
    inside = (hit >= capture.start_index) & (hit < capture.stop_index)
    assert capture.spikes == inside.sum() > 5
    assert capture.count + capture.spikes == capture.stop_index - capture.start_index
    assert abs(capture.mean[1] + 4) < 4 * capture.standard_error[1]


def test_too_many_spikes_are_a_fault():
    t, w = still()
    w[::30, 1] += 25.0
    report = find_captures(t, w)
    assert not report.captures
    assert "spikes" in report.rejected[0].reason


@pytest.mark.parametrize("how", ["missing", "nan"])
def test_a_gap_interrupts(how):
    t, w = still()
    gone = slice(700, 900)
    if how == "nan":
        w[gone] = np.nan
    else:
        t, w = np.delete(t, gone), np.delete(w, gone, axis=0)
    detector, states = live(t, w, settings=StillnessSettings(min_duration=4.0))
    assert detector.rejected[0].state is StillState.STALE
    assert [capture.start > 4.4 for capture in detector.captures] == [True]
    if how == "nan":
        assert StillState.STALE in {state.state for _, state in states}


def test_short_gaps_and_nan_are_bridged():
    t, w = still()
    w[700:730] = np.nan
    w[::17, 3] = np.nan
    (capture,) = find_captures(t, w, StillnessSettings(min_duration=6.0)).captures
    assert capture.count < capture.stop_index - capture.start_index
    assert np.isfinite(capture.mean).all()


def test_silence_is_stale():
    detector = StillnessDetector(RATE)
    assert detector.poll(1.0).state is StillState.SETTLING
    t, w = still(1.0)
    detector.update_block(t, w)
    assert detector.poll(1.1).state is not StillState.STALE
    state = detector.poll(2.5)
    assert state.state is StillState.STALE
    assert "plug" in state.sentence


def test_a_creeping_arm_is_not_still():
    t, w = still(20.0)
    w[:, 0] += 0.3 * t
    assert not find_captures(t, w).captures
    _, states = live(t, w)
    assert "Moving slowly" in states[-1][1].sentence


def test_a_turn_about_the_vertical_shows_by_the_orientation():
    recording = stream(3, poses=2, vertical=1.0)
    report = find_captures(recording.t, recording.wrenches, R_WS=recording.R_WS)
    assert len(report.captures) == 2
    assert np.allclose(report.captures[0].R_WS, recording.dwells[0].R_WS)


def test_what_was_captured_in_motion_is_withdrawn():
    rng = np.random.default_rng(0)
    t = np.arange(3000) / RATE
    w = rng.standard_normal((3000, 6)) * WHITE
    # From the very beginning a steady shaking that looks like noise, then quiet.
    w[:1200] += rng.standard_normal((1200, 6)) * 9 * WHITE
    detector, states = live(t, w)
    assert any(state.captured for time, state in states if time < 6)
    withdrawn = [rejected for rejected in detector.rejected if "withdrawn" in rejected.reason]
    assert withdrawn
    assert all(capture.start > 5.9 for capture in detector.captures)
    assert detector.captures


def test_touch_without_orientation_is_said_to_be_invisible():
    t, w = still(3.0)
    _, states = live(t, w, model=MODEL)
    assert "without the orientation" in next(state for _, state in states if state.captured).sentence


def test_touched_says_by_how_much_and_ends_with_the_touch():
    t, w = still(12.0)
    R = np.eye(3)
    w += MODEL.predict(R) - [3, -4, -3, 0.1, 0.3, -0.2]
    w[:1200, 2] -= 2.0
    detector, states = live(t, w, np.broadcast_to(R, (len(t), 3, 3)), model=MODEL)
    touched = [state for _, state in states if state.state is StillState.TOUCHED]
    assert "2 N" in touched[-1].sentence
    (refused,) = [rejected for rejected in detector.rejected if rejected.state is StillState.TOUCHED]
    assert 5.0 < refused.stop <= 6.1
    assert [capture.start > 6.0 for capture in detector.captures] == [True]


def test_constant_readings_work():
    t, w = still(4.0)
    w[:] = [1, 2, 3, 0.1, 0.2, 0.3]
    (capture,) = find_captures(t, w).captures
    assert capture.mean == pytest.approx([1, 2, 3, 0.1, 0.2, 0.3], abs=1e-12)
    w[100:400:7, 0] += 0.01  # now the step shows, and with it what rounding hides
    (capture,) = find_captures(t, w).captures
    assert capture.standard_error[0] > 0


# ---- to a pose -------------------------------------------------------------------------------------


def test_to_pose():
    t, w = still(4.0)
    (capture,) = find_captures(t, w).captures
    with pytest.raises(InputError, match="give R_WS"):
        capture.to_pose()
    with pytest.raises(PoseError, match="not a rotation"):
        capture.to_pose(2 * np.eye(3))
    pose = capture.to_pose(np.eye(3), "up", 25.0)
    assert (pose.name, pose.temperature, pose.count) == ("up", 25.0, capture.count)
    assert pose.time == pytest.approx(0.5 * (capture.start + capture.stop))
    assert np.array_equal(np.concatenate([pose.force, pose.torque]), capture.mean)
    assert np.array_equal(np.concatenate([pose.force_sd, pose.torque_sd]), capture.sd)


# ---- how long to average ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("flicker", "walk", "target", "duration"),
    [
        (0.0, 0.0, 0.02, 6.25),  # white noise alone: the square root of time
        (0.0, 0.0, 1e-3, 10.0),  # the longest that is allowed
        (0.01, 0.0, 1e-3, 1.0),  # 1/f noise hardly averages out
        (0.0, 0.01, 1e-3, 1.0),  # drift makes a longer mean worse
        (0.0, 2.5e-5, 1e-3, 5.1),  # until twice the time gains less than a tenth
    ],
)
def test_averaging_lasts_until_the_target_or_while_it_helps(flicker, walk, target, duration):
    each = np.ones(6)
    noise = NoiseFloor(0.0025 * each, flicker * each, walk * each, 0 * each, 120.0)
    assert noise.advise(target * each, 1.0, 10.0) == pytest.approx(duration, rel=0.04)


# ---- wrong input -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"window": 0.0}, "window"),
        ({"window": 0.2}, "window"),
        ({"floor_force": -1.0}, "floor_force"),
        ({"slope_torque": np.nan}, "slope_torque"),
        ({"min_duration": 20.0}, "max_duration"),
    ],
)
def test_wrong_settings(wrong, says):
    with pytest.raises(InputError, match=says):
        StillnessSettings(**wrong)


def test_wrong_samples():
    detector = StillnessDetector()
    with pytest.raises(InputError, match="six numbers"):
        detector.update(0.0, [1, 2, 3])
    with pytest.raises(InputError, match="R_WS"):
        detector.update(0.0, np.zeros(6), np.zeros(3))
    detector.update(1.0, np.zeros(6))
    for t in (0.5, np.nan, np.inf):
        with pytest.raises(InputError, match="must not decrease"):
            detector.update(t, np.zeros(6))
    t, w = still(1.0)
    with pytest.raises(InputError, match="rows of six"):
        find_captures(t, w[:, :3])
    with pytest.raises(InputError, match="one for each"):
        find_captures(t[1:], w)
    with pytest.raises(InputError, match="sample 2"):
        find_captures(t[::-1], w)
    with pytest.raises(InputError, match="rate_hz"):
        StillnessDetector(0.0)
    with pytest.raises(InputError, match="check that the times are in s"):
        find_captures(1e3 * still(10.0)[0], still(10.0)[1])

"""The closed loop: what it notes is what happened, and the same seeds give the same course."""

import json
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.bundle_example import example_config
from benchmarks.faulty_line import FaultKind, FaultyLine, ScriptedFault

from contactbench.pipeline.control.frames import (
    BEGIN,
    END,
    FRAME,
    Beginning,
    LoopFrame,
    beginning_of,
    frame_of,
    line_of,
    read_line,
)
from contactbench.pipeline.control.loop import Loop, run_loop
from contactbench.pipeline.control.settings import ControlSettings
from contactbench.pipeline.control.states import ControlState
from contactbench.pipeline.control.virtual import virtual_robot
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.scenes.platform import PlatformMotion
from contactbench.pipeline.study.gain_trials import foundation_of, make_rig

MOTION = PlatformMotion.along("ry", np.radians(5), 4.0, 3.0)


def rig(**changes):
    settings = replace(ControlSettings.for_probe(foundation_of("t-shape")), taring=0.1)
    return make_rig("platform", "t-shape", settings, 0, motion=MOTION, coarse=True, **changes)


def run(seconds, **options):
    made = rig()
    return run_loop(made.scene, made.controller, made.sensor, seconds, **options)


@pytest.fixture(scope="module")
def whole():
    return run(8.0, stop_after=4.5)


def test_it_touches_tracks_and_comes_back(whole):
    assert [str(each.after) for each in whole.changes] == ["contact", "track", "retract", "safe"]
    assert whole.ended is ControlState.SAFE
    tracking = whole.between(3.0, 4.5)
    assert tracking.was(ControlState.TRACK).all()
    assert np.abs(tracking.force - 7.0).max() < 0.5
    assert np.degrees(tracking.tilt).max() < 3.0
    assert whole.time[-1] < 8.0  # it ended when it was safe


def test_periods_are_even_and_peaks_are_peaks(whole):
    np.testing.assert_allclose(np.diff(whole.time), 0.02, atol=1e-9)
    assert (whole.peak >= whole.force - 1e-9).all()


def test_phantom_and_probe_are_told_in_one_frame(whole):
    at = whole.between(3.0, 4.5)
    wanted = 5 * np.sin(2 * np.pi * (at.time - 3.0) / 4.0)
    np.testing.assert_allclose(np.degrees(at.phantom[:, 1]), wanted, atol=0.05)
    # The difference of the two tilts is the angle error, and the tip is in the tissue.
    np.testing.assert_allclose(
        np.abs(at.phantom[:, 1] - at.probe[:, 1]), np.abs(at.angles[:, 0]), atol=np.radians(0.05)
    )
    assert ((at.probe[:, 0] - at.phantom[:, 0]) < 0).all()
    assert (whole.probe[0, 0] - whole.phantom[0, 0]) == pytest.approx(0.003, abs=1e-4)


def test_the_sensed_place_is_near_the_true_one(whole):
    at = whole.between(3.2, 4.5)
    off = 1e3 * (at.offset - at.place)
    assert np.sqrt(np.nanmean(off**2)) < 2.0
    assert np.isfinite(at.offset).mean() > 0.95


def test_the_same_seeds_give_the_same_course():
    one, other = run(1.0), run(1.0)
    assert one.csv() == other.csv()
    other_seed = rig()
    other_seed.sensor._rng = np.random.default_rng(99)
    assert run_loop(other_seed.scene, other_seed.controller, other_seed.sensor, 1.0).csv() != one.csv()


def test_csv_has_a_row_for_each_period(whole):
    lines = whole.csv().splitlines()
    assert len(lines) == len(whole) + 1
    heads = lines[0].split(",")
    assert all(len(line.split(",")) == len(heads) for line in lines)
    assert lines[-1].endswith("safe")


def test_a_dropout_has_it_hold_and_go_back():
    dropout = ScriptedFault(FaultKind.DROPOUT, 1.5, float("inf"))
    trace = run(6.0, line=FaultyLine((dropout,)).carry)
    assert trace.ended is ControlState.SAFE
    assert not trace.between(1.5 + 0.1).was(ControlState.TRACK).any()
    assert "stale" in " ".join(each.reason for each in trace.changes)


def test_a_watch_sees_every_step_and_may_end_it():
    seen = []

    def watch(command, loop):
        assert isinstance(loop, Loop)
        seen.append(command.state)
        return len(seen) == 10

    assert len(run(1.0, watch=watch)) == 10


@pytest.mark.parametrize("seconds", [0.0, -1.0, float("nan"), 1e9])
def test_impossible_times_are_refused(seconds):
    made = rig()
    with pytest.raises(InputError, match="closed loop"):
        run_loop(made.scene, made.controller, made.sensor, seconds)


def test_nothing_happened_is_said():
    made = rig()
    with pytest.raises(InputError, match="nothing has happened"):
        Loop(made.scene, made.controller, made.sensor).trace()


def test_late_poses_are_those_of_periods_before():
    made, told = rig(), []
    step = made.controller.step

    def listening(now, joints, samples):
        told.append((now, joints.copy(), made.scene.joints))
        return step(now, joints, samples)

    made.controller.step = listening
    run_loop(made.scene, made.controller, made.sensor, 0.8, poses_late=0.1)
    np.testing.assert_array_equal(told[-1][1], told[-6][2])
    assert np.abs(told[-1][1] - told[-1][2]).max() > 0


# ---- lines of a closed loop: what is written is read, and what is not one of them is refused -----


@pytest.fixture(scope="module")
def watched():
    """A loop on the platform that has begun to press."""
    made = virtual_robot(example_config(300, rate=200.0), "virtual://platform")
    loop = Loop(made.scene, made.controller, made.sensor)
    frames = []
    for _ in range(100):
        frames.append(frame_of(loop.step(), loop))
        if frames[-1].force_N > 2.0:
            break
    return loop, frames


def test_a_frame_says_where_things_are(watched):
    loop, frames = watched
    beginning, frame = beginning_of(loop, "virtual://platform"), frames[-1]
    assert (beginning.variant, beginning.wanted_N, beginning.limit_N) == ("aware", 5.0, 30.0)
    assert frame.state == ControlState.CONTACT
    assert [each.state for each in frames if each.reason is not None] == [ControlState.CONTACT]
    R_BS = np.array(frame.R_BS).reshape(3, 3)
    assert np.allclose(R_BS, np.diag([1.0, -1.0, -1.0]), atol=1e-3)
    # The tip is on the phantom, pressed in by less than a few mm; the force on it points up.
    tip_B = np.array(frame.sensor_B_m) + loop.scene.top * R_BS[:, 2]
    assert tip_B == pytest.approx(frame.phantom_B_m, abs=0.006)
    assert tip_B[2] < frame.phantom_B_m[2]
    assert frame.normal_B == pytest.approx((0.0, 0.0, 1.0), abs=1e-3)
    assert R_BS @ np.array(frame.force_S_N) == pytest.approx((0.0, 0.0, frame.force_N), abs=0.5)
    assert np.array(frame.point_S_m)[2] == pytest.approx(loop.scene.top, abs=0.002)
    assert frames[0].point_S_m is None
    # As in the beginning, but for the press.
    assert frame.sensor_B_m == pytest.approx(beginning.rest_B_m, abs=0.006)


def test_what_is_written_is_read(watched):
    loop, frames = watched
    beginning = beginning_of(loop, "virtual://platform")
    assert read_line(line_of(BEGIN, beginning)) == beginning
    for frame in (frames[0], frames[-1]):
        assert read_line(line_of(FRAME, frame).encode()) == frame
    assert read_line(line_of(END, {"ended": "safe"})) == {"ended": "safe"}
    assert isinstance(beginning, Beginning)
    assert isinstance(frames[0], LoopFrame)


@pytest.mark.parametrize(
    "change",
    [
        lambda _: b"",
        lambda _: b"[]",
        lambda _: b"\xff",
        lambda line: line[:-20],
        lambda line: line.replace("frame", "film", 1),
        lambda line: json.dumps({**json.loads(line), "extra": 1}),
        lambda line: json.dumps({**json.loads(line), "normal_B": ["up"]}),
        lambda line: line.replace('"time_s":', '"time_s":NaN,"time":'),
        lambda line: json.dumps({key: value for key, value in json.loads(line).items() if key != "state"}),
    ],
)
def test_other_lines_are_refused(watched, change):
    with pytest.raises(InputError, match="line of a closed loop"):
        read_line(change(line_of(FRAME, watched[1][-1])))

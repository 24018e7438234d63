"""Lines of a closed loop: what is written is read, and what is not one of them is refused."""

import json

import numpy as np
import pytest
from benchmarks.bundle_example import example_config

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
from contactbench.pipeline.control.loop import Loop
from contactbench.pipeline.control.states import ControlState
from contactbench.pipeline.control.virtual import virtual_robot
from contactbench.pipeline.errors import InputError


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

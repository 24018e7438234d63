"""A closed loop in a process of its own: it is followed, stopped, ended, and says why it could not begin."""

import os
from pathlib import Path

import numpy as np
import pytest
from waiting import until

from contactbench.pipeline.control.frames import Beginning, LoopFrame
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.workbench.motion import MotionChoice, MotionRun, placed

PLATFORM = "virtual://platform"


@pytest.fixture
def begin(bundle):
    """Begin runs that are ended with the test."""
    made = []

    def run(choice=None, of=bundle):
        made.append(MotionRun(of, choice or MotionChoice(robot=PLATFORM, period=2.0)))
        return made[-1]

    yield run
    for each in made:
        each.close()


def test_the_command_is_given_what_was_chosen():
    chosen = MotionChoice(motion="vertical", period=5.0, size=8.0, variant="plain")
    assert " ".join(chosen.arguments(Path("b.zip"))) == (
        "bench control run b.zip --robot virtual://arm --motion vertical --period 5 --size 8 --seconds 600"
        " --variant plain --unverified --real-time --frames"
    )
    assert "--mount 0,0,0" in " ".join(MotionChoice(unturned=True).arguments(Path("b.zip")))
    assert "--variant" not in MotionChoice().arguments(Path("b.zip"))


@pytest.mark.parametrize(
    "wrong",
    [
        {"robot": "elfin+tcp://10.0.0.2"},
        {"motion": "sideways"},
        {"variant": "bold"},
        {"period": 0.1},
        {"size": 31.0},
    ],
    ids=lambda wrong: next(iter(wrong)),
)
def test_a_wrong_choice_is_refused(wrong):
    with pytest.raises(InputError, match=f"parameter {next(iter(wrong))}: Input should be"):
        MotionChoice.checked(wrong)


def test_it_is_followed_and_stopped(begin):
    run = begin()
    assert run.running
    assert run.pace is None
    until(lambda: run.newest is not None and run.newest.state == "track")
    assert run.beginning.wanted_N == 5.0
    run.stop()
    until(lambda: not run.running)
    assert run.failure == ""
    assert run.outcome["ended"] == "safe"
    assert run.outcome["faults"] == []
    assert [each.state for each in run.changes] == ["contact", "track", "retract", "safe"]
    course = run.course(1000.0)
    assert len(course.times) == len(course.forces) == len(course.angles) > 100
    assert np.allclose(np.diff(course.times), 0.02)
    assert course.forces.max() == pytest.approx(run.outcome["peak_N"], abs=0.2)
    assert run.course(0.5).times[0] == pytest.approx(course.times[-1] - 0.5, abs=0.03)
    # At real time: never faster.
    assert run.pace < 1.1


def test_what_cannot_run_says_why(begin, tmp_path):
    run = begin(of=tmp_path / "nowhere.zip")
    until(lambda: not run.running)
    assert run.outcome is None
    assert "there is no such folder or zip file" in run.failure


def test_it_can_be_ended_at_once(begin):
    run = begin()
    process = run._process
    run.close()
    assert not run.running
    if os.name == "posix":
        assert process.returncode == -9
    run.stop()  # of no effect, no error


def test_an_upright_probe_on_a_phantom_at_rest_is_at_the_origin():
    down = (1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0)
    beginning = Beginning(PLATFORM, "aware", 7.0, 30.0, 0.02, (0.3, 0.0, 0.25))
    frame = LoopFrame(
        1.0,
        "track",
        None,
        7.0,
        (0.0, 0.0),
        down,
        (0.3, 0.0, 0.26),
        (0.3, 0.0, 0.1),
        (0.0, 0.0, 1.0),
        None,
        None,
    )
    where = placed(beginning, frame)
    assert where.p_WS_W == pytest.approx([0.0, 0.0, 0.01])
    # In S, which points down, the phantom is 160 mm along z, and its normal points back.
    assert where.phantom_S == pytest.approx([0.0, 0.0, 0.16])
    assert where.normal_S == pytest.approx([0.0, 0.0, -1.0])

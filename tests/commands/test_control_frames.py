"""``contactbench bench control run --frames``: each period as it happens, and an end when nobody reads any more."""

import subprocess
import sys

import pytest
from terminal import command, invoke

from contactbench.pipeline.control.frames import Beginning, LoopFrame, read_line


def arguments(bundle, *more):
    return ["bench", "control", "run", str(bundle), "--robot", "virtual://platform", "--seconds", "2", *more]


def test_each_period_is_a_line_and_the_last_one_says_what_came_of_it(bundle):
    result = invoke(*arguments(bundle, "--frames", "--variant", "plain"))
    told = [read_line(line) for line in result.stdout.splitlines()]
    beginning, *frames, end = told
    assert isinstance(beginning, Beginning)
    assert beginning.variant == "plain"
    assert all(isinstance(each, LoopFrame) for each in frames)
    assert frames[0].time_s == pytest.approx(0.02)
    assert frames[-1].time_s == pytest.approx(end["seconds"])
    assert [each.state for each in frames if each.reason] == [each["to"] for each in end["states"]]
    assert end["ended"] == "safe"
    assert (result.exit_code == 0) == (end["faults"] == [])


def test_frames_and_json_are_not_both_given(bundle):
    result = invoke(*arguments(bundle, "--frames", "--json"))
    assert result.exit_code == 2
    assert "cannot be combined" in result.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="a pipe there breaks otherwise")
def test_it_goes_back_when_nobody_reads_any_more(bundle):
    words = command(*arguments(bundle, "--frames", "--real-time"))
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert isinstance(read_line(process.stdout.readline()), Beginning)
        process.stdout.close()
        said = process.stderr.read().decode()
        process.wait(60)
    assert "it was stopped" in said
    assert "Ended safe" in said

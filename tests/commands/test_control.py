"""``contactbench bench control``: a bundle on a virtual robot, and never on a real one."""

import json
from functools import partial

import pytest
import terminal
from benchmarks.bundle_example import example_config

from contactbench.pipeline.config.runtime import RuntimeConfig

run = partial(terminal.invoke, "bench", "control")


def test_a_bundle_tracks_on_the_virtual_arm_and_ends_safe(bundle, tmp_path):
    course = tmp_path / "trace.csv"
    result = run(
        "run", bundle, "--robot", "virtual://arm", "--seconds", 5, "--period", 4, "--out", course, "--json"
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    facts = json.loads(result.stdout)
    assert facts["ended"] == "safe"
    assert [each["to"] for each in facts["states"]] == ["contact", "track", "retract", "safe"]
    wanted = RuntimeConfig.load(bundle).model.controller.desired_force_N
    assert facts["force_N"] == pytest.approx([wanted, wanted], abs=0.7)
    assert facts["peak_N"] < facts["limit_N"]
    assert "track" in result.output
    assert course.read_text(encoding="utf-8").startswith("time_s,force_N")


@pytest.mark.parametrize("address", ["elfin+tcp://10.0.0.2", "ur+tcp://10.0.0.2", "virtual://bench", ""])
def test_other_robots_are_never_moved(bundle, address):
    result = run("run", bundle, "--robot", address)
    assert result.exit_code == 2
    assert "never to a real one" in result.output


def test_giving_up_is_exit_code_one(bundle):
    # The phantom is too far away to be met: it looks for it, and goes back.
    result = run("run", bundle, "--robot", "virtual://arm", "--motion", "none", "--seconds", 1, "--json")
    assert result.exit_code == 1
    facts = json.loads(result.stdout)
    assert facts["ended"] == "safe"
    assert facts["faults"] == ["it never started tracking."]


@pytest.mark.parametrize(
    "wrong",
    [
        ("--seconds", "0"),
        ("--motion", "sideways"),
        ("--period", "0"),
        ("--variant", "none"),
        ("--method", "none"),
        ("--stiffness", "-1"),
    ],
)
def test_wrong_options_are_one_sentence(bundle, wrong):
    result = run("run", bundle, "--robot", "virtual://arm", *wrong)
    assert result.exit_code == 2
    assert "rror" in result.output


def test_an_unverified_bundle_needs_to_be_asked_for(tmp_path):
    file = tmp_path / "trial.zip"
    example_config(500, verified=False).write(file)
    result = run("run", file, "--robot", "virtual://arm")
    assert result.exit_code == 2
    assert "--unverified" in result.output


def test_tune_wants_one_variant():
    result = run("tune", "--variant", "both")
    assert result.exit_code == 2
    assert "give plain or aware" in result.output

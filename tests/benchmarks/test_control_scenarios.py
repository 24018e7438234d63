"""Scenarios, one probe each: the force keeps its limit, what must follow follows, and what it tells is in words."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.control_safety import draw, run_start
from benchmarks.control_scenarios import EVENT_S, SCENARIOS, Course, Path, report_of, run, run_scenario

# What each says from the event on, all of it, in words of the states' reasons; nothing: it goes on.
TOLD = {
    "rib x3": ("convex",),
    "rib x6": ("linear",),
    "rib x12": ("t-shape",),
    "sliding over ribs": ("t-shape",),
    "creep": ("convex",),
    "edge": ("linear", "retract: it has turned by", "safe: fully"),
    "bubble": ("convex", "approach: the tissue was lost", "retract: ", "safe: fully"),
    "cough": ("convex", "track: degraded: the force is 4.", "track: the force is back in its band"),
    "sensor frozen in the press": ("linear", "hold: the sensor is stuck", "retract: ", "safe: fully"),
    "poses 100 ms late": ("t-shape", "retract: the poses are", "safe: fully"),
}


def test_every_scenario_is_tried():
    assert set(TOLD) == set(SCENARIOS)


@pytest.mark.parametrize("name", TOLD)
def test_a_scenario_ends_as_it_must(name):
    probe, *says = TOLD[name]
    course, trace = run_scenario(name, probe, 0, scene="arm")
    assert trace is not None
    assert course.safe
    assert course.peak < 0.8 * course.limit
    told = course.told.split("; ") if course.told else []
    assert len(told) == len(says)
    assert all(map(str.startswith, told, says))
    if SCENARIOS[name].follows:
        assert course.tracked == 1.0
        assert max(course.off, course.swing) < SCENARIOS[name].follows


def test_a_path_goes_through_its_poses_smoothly():
    path = Path((1.0, 2.0, 3.0), np.outer([0.0, 0.02, 0.0], np.eye(6)[2]))
    assert [path.at(t)[2] for t in (0.0, 1.0, 1.5, 2.0, 3.0, 9.0)] == pytest.approx([0, 0, 0.01, 0.02, 0, 0])
    assert path.speed(1.5)[2] == pytest.approx(0.02 * np.pi / 2, rel=1e-3)
    assert [path.speed(t)[2] for t in (0.5, 2.0, 4.0)] == pytest.approx([0, 0, 0], abs=1e-4)


def test_what_misses_is_said():
    told = {"told": "", "silent": 0.1}
    good = Course("arm", "rib x6", "convex", 0, 9.0, 30.0, 0.1, 0.1, 1.0, "track", safe=True, **told)
    assert report_of([good], {}).passed
    for wrong in (
        {"peak": 24.1},
        {"off": 0.31},
        {"swing": 0.31},
        {"safe": False},
        {"silent": 0.52},
        {"off": float("nan")},
    ):
        assert not report_of([replace(good, **wrong)], {}).passed
    assert not report_of([replace(good, scenario="sensor frozen in the press")], {}).passed


def test_a_report_has_a_row_for_each_run():
    report = run(
        ["convex"], scenarios=["sensor frozen in the press"], scenes=["platform"], seeds=1, workers=1
    )
    assert report.passed
    worst, each = report.sheets
    assert len(each.rows) == 1
    assert worst.rows == each.rows
    assert EVENT_S > 0


def test_tissue_that_changes_is_drawn_beside_the_rest():
    starts = [draw(number, changing=True) for number in range(50)]
    assert [replace(each, course=None) for each in starts] == [draw(number) for number in range(50)]
    assert {len(each.course.times) for each in starts} == {3, 5, 7}
    factors = [each.course.factors[-1] for each in starts]
    assert 1 / 6 <= min(factors) < 0.3
    assert 5 < max(factors) <= 12


@pytest.mark.parametrize(("number", "scene"), [(0, "arm"), (3, "platform"), (5, "arm")])
def test_a_few_starts_on_tissue_that_changes_are_safe(number, scene):
    assert run_start(replace(draw(number, 11, changing=True), scene=scene)).safe

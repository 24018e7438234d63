"""The dynamic experiments: better than the paper where it must be, and files that say what was measured."""

import json
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.reproduce.dynamic import (
    IN_PLANE,
    OUT_OF_PLANE,
    START_S,
    VERTICAL,
    Cell,
    measure,
    order_notes,
    outcome_of,
    report_of,
    run_cell,
)

from contactbench.pipeline.control.settings import ControlSettings, Variant
from contactbench.pipeline.study.gain_trials import make_rig


@pytest.fixture(scope="module")
def result():
    return measure("t-shape", periods=(2.0,), methods=("contactbench",), seeds=1, quick=True, workers=1)


def outcome(result, variant, motion, method="contactbench"):
    wanted = (variant, motion, method)
    return next(o for o in result.outcomes if (o.cell.variant, o.cell.motion, o.cell.method) == wanted)


def test_every_motion_is_followed_if_it_is_led(result):
    assert len(result.outcomes) == 2 * 3
    aware = [each for each in result.outcomes if each.cell.variant is Variant.AWARE]
    assert all(each.followed == 1.0 for each in aware)
    assert all(each.lost == 0 for each in aware)
    assert all(0 < each.speed < 1 for each in result.outcomes)
    assert all(6.5 < each.first < 8.05 for each in result.outcomes)


def test_what_the_plain_variant_cannot_follow_is_said(result):
    # 31 mm/s on the broad face: its force comes near the limit, and it goes back.
    one = outcome(result, Variant.PLAIN, VERTICAL)
    assert one.followed < 0.5
    assert "limit" in one.ended


def test_leading_the_motion_helps_where_it_moves(result):
    for motion in (IN_PLANE, OUT_OF_PLANE):
        plain, aware = (outcome(result, v, motion) for v in Variant)
        assert aware.angle[0] < 0.7 * plain.angle[0]
        assert aware.angle[0] < 4.0  # what is asked for at 2 s
    plain, aware = (outcome(result, v, VERTICAL) for v in Variant)
    assert aware.force[2] - aware.force[0] < 0.8 * (plain.force[2] - plain.force[0])


def test_the_moved_axis_is_the_one_that_errs(result):
    for motion in (IN_PLANE, OUT_OF_PLANE):
        one = outcome(result, Variant.PLAIN, motion)
        assert one.angle[0] > 2 * one.other[0]


def test_the_arm_follows_the_quickest_turns_within_its_limits():
    # Its joints are asked for nearly all they can: a servo without a reserve fell behind, and the loop swung.
    cell = Cell("arm", "convex", "contactbench", Variant.AWARE, IN_PLANE, 2.0, 0, quick=True)
    one, trace = run_cell(cell)
    assert one.followed == 1.0
    assert [str(each.after) for each in trace.changes] == ["contact", "track"]
    assert one.angle[0] < 4.0
    assert 6.5 < one.force[0] < one.force[2] < 7.5
    assert 0.3 < one.speed < 1.0


def test_all_is_written_and_is_json(result, tmp_path):
    report = report_of(result)
    report.write(tmp_path)
    names = {each.name for each in tmp_path.iterdir()}
    tables = {"table-1.csv", "table-2.csv", "runs.csv"}
    assert names == {"report.md", "course.png", "methods.png", "traces", *tables}
    assert len(list((tmp_path / "traces").iterdir())) == 6
    json.dumps(report.to_json(), allow_nan=False)


def of_methods(result, errors):
    """The runs in plane and out of plane again, for three methods with these errors."""
    one = [outcome(result, Variant.PLAIN, motion) for motion in (IN_PLANE, OUT_OF_PLANE)]
    return [
        replace(each, cell=replace(each.cell, method=method, seed=seed), angle=(error + 0.001 * seed, 0.1))
        for each in one
        for method, error in errors.items()
        for seed in range(3)
    ]


def test_the_order_of_methods_is_told_as_it_is(result):
    kept = order_notes(of_methods(result, {"contactbench": 1.0, "wrench_axis": 2.0, "iterative": 3.0}))
    assert "holds in 2 of 2 cases; in 2 does another method differ" in kept[0]
    equal = order_notes(of_methods(result, {"contactbench": 1.0, "wrench_axis": 1.0, "iterative": 1.0}))
    assert "holds in 0 of 2 cases; in 0 does another" in equal[0]
    assert "cannot come from it" in equal[-1]
    twisted = of_methods(result, {"contactbench": 1.0, "wrench_axis": 1.0, "iterative": 1.0})
    told = order_notes([replace(each, torsion=(50.0, 9.0)) for each in twisted])
    assert "moves the wrench's axis by 9.00 mm" in told[-1]
    assert "enough to tell" in told[-1]
    assert order_notes(result.outcomes) == []


def test_a_run_that_gave_up_did_not_follow(result):
    cell, trace = next((c, t) for c, t in result.traces.items() if c.motion == IN_PLANE)
    scene = make_rig("platform", "t-shape", ControlSettings(), 0, coarse=True).scene
    early = outcome_of(cell, trace.between(0.0, START_S + 1.0), scene)
    assert early.followed == pytest.approx(0.5, abs=0.02)
    never = outcome_of(cell, trace.between(0.0, START_S - 1.0), scene)
    assert never.followed == 0.0
    assert np.isnan(never.angle[0])


def test_a_phantom_that_slides_and_spins_twists_the_probe():
    cell = Cell("platform", "convex", "contactbench", Variant.PLAIN, OUT_OF_PLANE, 2.0, 0, quick=True)
    flat, twisted = (run_cell(replace(cell, phantom=name))[0] for name in ("flat", "twisting"))
    assert flat.torsion[0] < 1.0
    assert twisted.torsion[0] > 5.0
    assert twisted.torsion[1] > 10 * flat.torsion[1]  # the wrench's axis is moved only if it slides, too

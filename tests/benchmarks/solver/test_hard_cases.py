"""The hard cases pass, and a case that goes wrong is not called passed."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.solver import hard_cases
from benchmarks.solver import hard_meshes as hm
from benchmarks.solver.hard_trials import (
    HardCase,
    HardOutcome,
    HardTrial,
    Rule,
    certified,
    complete,
    exact,
    like,
    refused,
    within,
)

from contactbench.pipeline.contact import Gates, Reason
from contactbench.pipeline.study.stability import Drawn, press

GOOD = HardOutcome(1.0, 1e-9, 1e-8, {"OK": 10}, 0.0)


@pytest.fixture(scope="module")
def spoken() -> list[str]:
    return []


@pytest.fixture(scope="module")
def cases(spoken: list[str]) -> list[HardCase]:
    return hard_cases.cases(100, 1, spoken.append)


def test_every_case_passes(cases: list[HardCase]) -> None:
    failed = {case.name: case.faults for case in cases if not case.passed}
    assert not failed
    assert all(case.tries > 0 for case in cases)


def test_names_are_unique_and_every_group_is_announced(cases: list[HardCase], spoken: list[str]) -> None:
    names = [case.name for case in cases]
    assert len(set(names)) == len(names) >= 35
    assert spoken == list(hard_cases.GROUPS)


def test_the_literal_loop_breaks_where_it_should(cases: list[HardCase]) -> None:
    literal = {case.name: case.algorithm1 for case in cases}
    assert literal["gaps at vertices"].answered == 0.0
    assert literal["ambiguity, noise"].wrong_unflagged > 0.01
    assert literal["on edges, k = 0"].answered < 1.0


def test_same_seed_gives_the_same_cases_and_the_report_has_them(
    cases: list[HardCase], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hard_cases, "GROUPS", dict(list(hard_cases.GROUPS.items())[:4]))
    again = hard_cases.cases(100, 1)
    assert again == cases[: len(again)]
    report = hard_cases.run(samples=100, seed=1)
    assert report.passed
    assert [row["case"] for row in report.sheets[0].to_json()] == [case.name for case in again]


@pytest.mark.parametrize(
    ("rule", "wrong", "words"),
    [
        (exact("1 m"), replace(GOOD, answered=0.99), "answered"),
        (exact("1 m"), replace(GOOD, wrong=0.001), "wrong"),
        (exact("1 m"), replace(GOOD, broken=1), "own check"),
        (Rule("", unflagged=2e-4), replace(GOOD, wrong_unflagged=3e-4), "not flagged"),
        (Rule("", reasons=(Reason.VERTEX,)), replace(GOOD, reasons={"VERTEX": 9, "OK": 1}), "belong"),
        (refused(Reason.LOW_FORCE), GOOD, "answered"),
        (refused(Reason.LOW_FORCE), HardOutcome(0.0, None, None, {"OFF_SURFACE": 1}, 0.0), "belong"),
        (exact("1 m"), replace(GOOD, answered=float("nan")), "answered"),
    ],
)
def test_a_rule_names_what_is_wrong(rule: Rule, wrong: HardOutcome, words: str) -> None:
    assert words in " ".join(rule.faults(wrong))


def test_a_rule_accepts_what_is_right() -> None:
    assert exact("1 m").faults(GOOD) == ()
    assert refused(Reason.LOW_FORCE).faults(HardOutcome(0.0, None, None, {"LOW_FORCE": 3}, 0.0)) == ()


@pytest.fixture
def trial(rng: np.random.Generator) -> HardTrial:
    body = hm.ellipsoid(2)
    drawn = press(*hm.places(body, 50, rng), rng)
    return HardTrial("name", "what", exact("1e-9 m"), body.probe(), drawn)


def test_a_trial_passes_only_against_the_right_truth(trial: HardTrial) -> None:
    assert trial.run().passed
    off = Drawn(trial.drawn.wrenches, trial.drawn.points + 2e-9)
    assert replace(trial, drawn=off).run().contactbench.wrong == 1.0
    assert not replace(trial, drawn=off).run().passed


def test_a_trial_without_wrenches_fails(trial: HardTrial) -> None:
    case = replace(trial, drawn=trial.drawn.take(slice(0, 0))).run()
    assert not case.passed
    assert "more samples" in case.faults[0]


def test_only_a_mesh_that_says_so_excuses_wrong_answers(trial: HardTrial) -> None:
    inside_out = HardTrial(
        "", "", Rule("", (0.0, 1.0)), hm.ellipsoid(2).probe(hm.ellipsoid(2).faces[:, ::-1]), trial.drawn
    )
    assert not inside_out.run().passed
    assert replace(inside_out, known_bad_mesh=True).run().passed
    sound = replace(trial, drawn=Drawn(trial.drawn.wrenches, -trial.drawn.points), known_bad_mesh=True)
    assert sound.run().contactbench.wrong_unflagged == 1.0


def test_checks_refuse_answers_to_other_wrenches(trial: HardTrial) -> None:
    body = hm.ellipsoid(2)
    count = len(trial.drawn)
    turned = trial.drawn.take(np.roll(np.arange(count), 1))
    # The check belongs to one set of wrenches and is asked about another.
    for check in (
        certified(body, turned.wrenches),
        complete(Drawn(trial.drawn.wrenches, turned.points)),
        within(Drawn(trial.drawn.wrenches, turned.points)),
    ):
        assert replace(trial, check=check).run().contactbench.broken == count
    for check in (certified(body, trial.drawn.wrenches), complete(trial.drawn), within(trial.drawn)):
        assert replace(trial, check=check).run().contactbench.broken == 0
    assert replace(trial, check=like(trial, lambda p: p, body.size)).run().contactbench.broken == 0
    assert replace(trial, check=like(trial, lambda p: p + 1e-9, body.size)).run().contactbench.broken == count


def test_complete_notices_a_lost_candidate(rng: np.random.Generator) -> None:
    """A friction cone that is narrower for the solver than for the touches loses candidates."""
    body = hm.bundled("t-shape", 500)
    drawn = press(*hm.places(body, 40, rng), rng, angle=(30.0, 40.0))
    wide = HardTrial("", "", Rule("", unflagged=1.0), body.probe(), drawn, gates=Gates(friction_angle=89.0))
    assert replace(wide, check=complete(drawn)).run().passed
    narrow = replace(wide, gates=Gates(friction_angle=25.0), check=complete(drawn)).run()
    assert narrow.contactbench.broken == 40


def test_bodies_are_closed_and_face_outwards() -> None:
    for body in (hm.ellipsoid(), hm.box(), hm.bundled("t-shape", 1000)):
        health = body.probe().health
        assert health.watertight
        assert health.outward
        assert body.holds(body.vertices.mean(axis=0).astype(np.longdouble))
        assert not body.holds(np.array([1.0, 1.0, 1.0], np.longdouble))
    assert hm.soup(hm.box()).probe().health.boundary_edges == 3 * len(hm.box().faces)


def test_brute_force_finds_the_contact_of_a_box_by_hand() -> None:
    """A force of 8 N down on the top at (1/64, 1/32, 1/16) m with a local torque of 0.01 N·m."""
    body = hm.box()
    point, force, normal = (
        np.array([1 / 60, 1 / 33, 1 / 16]),
        np.array([0.0, 0.0, -8.0]),
        np.array([0.0, 0.0, 1.0]),
    )
    found = hm.solve(body, np.hstack([force, np.cross(point, force) + 0.01 * normal]))
    assert found.points == pytest.approx(point[None], abs=1e-15)
    assert found.angles == pytest.approx([0.0])


def test_the_wrench_axis_enters_where_the_ray_does(rng: np.random.Generator) -> None:
    body = hm.ellipsoid(2)
    drawn = press(*hm.places(body, 20, rng), rng, arm=0.0)
    entered = np.array([hm.entry(body, wrench) for wrench in drawn.wrenches])
    assert entered == pytest.approx(drawn.points, abs=1e-12)
    away = np.array([0.0, 0.0, -5.0, 5.0, 5.0, 0.0])
    assert np.isnan(hm.entry(body, away)).all()

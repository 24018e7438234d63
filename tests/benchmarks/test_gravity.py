"""The gravity study in short: its figures hold, and could fail."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks import gravity
from benchmarks.gravity import BLIND_SETS, BlindSet, try_blind
from scipy.spatial.transform import Rotation
from weighing_files import draw_weighing

from contactbench.pipeline.calibration import Calibration, Level, calibrate
from contactbench.pipeline.study.report import Figure
from contactbench.pipeline.timing import Timing


def fooled(off_sigmas: float = 0.0, width: float = 1.0):
    """Calibrate with an error of so many stated sigmas along every parameter, and another stated width."""

    def wrong(poses, noise=None) -> Calibration:
        calibration = calibrate(poses, noise)
        model = calibration.model
        theta = model.vector + off_sigmas * np.sqrt(np.diag(model.covariance))
        return replace(calibration, model=model.from_vector(theta, width * model.covariance))

    return wrong


def test_errors_keep_to_the_bound():
    """Limits of the full study, wider by what chance does to 100 trials and twelve parameters; 60 keep to them."""
    worst, mean, known, estimated = gravity.efficiency(60, 1)
    assert worst.measured < 1.05 + 3.5 / np.sqrt(2 * 100)
    assert mean.measured == pytest.approx(1.0, abs=0.08)
    for figure in (known, estimated):
        assert 95 - 330 * np.sqrt(0.05 * 0.95 / 100) <= figure.measured


@pytest.mark.parametrize(("options", "failing"), [({"off_sigmas": 1.0}, [0, 2]), ({"width": 0.3}, [2, 3])])
def test_a_biased_or_overconfident_calibration_misses(monkeypatch, options, failing):
    monkeypatch.setattr(gravity, "calibrate", fooled(**options))
    figures = gravity.efficiency(20, 1)
    assert not any(figures[index].passed for index in failing)


def test_the_bound_is_smaller_for_more_poses():
    weighing = draw_weighing(np.random.default_rng(2), poses=(10, 10))
    full, part = gravity._bound(weighing), gravity._bound(weighing, np.arange(10) < 6)
    assert (np.linalg.eigvalsh(part - full) > -1e-9 * part.max()).all()


def test_bumped_poses_are_named_and_do_no_harm(monkeypatch):
    figures = gravity.bumped_poses(20, 2)
    for named, alarms, _, ratio in (figures[:4], figures[4:]):
        assert named.measured == 100
        assert alarms.measured <= 100 * 2 / 20  # 1 % is expected; 2 of 20 happen once in fifty
        assert ratio.measured < 1.2 + 3.5 / np.sqrt(2 * 20)
    monkeypatch.setattr(
        gravity, "calibrate", lambda poses, noise=None: replace(calibrate(poses, noise), rejected=())
    )
    assert not gravity.bumped_poses(8, 2)[0].passed


def test_a_light_load_is_not_pulled_towards_the_sensor():
    ours, papers = gravity.light_load(50, 1)  # held to what chance does to 100
    assert abs(ours.measured) < 0.1 + 3 / np.sqrt(100)
    assert papers.measured < -1.0


@pytest.mark.parametrize("kind", BLIND_SETS, ids=lambda kind: kind.name)
def test_blind_sets_are_refused_in_the_right_words(kind: BlindSet):
    tried = try_blind(kind, 15, np.random.default_rng(4))
    assert (tried.name, tried.tries, tried.silent, tried.wrong) == (kind.name, 15, 0, 0)


def test_a_set_that_is_not_blind_counts_as_silent(monkeypatch):
    plain = BlindSet("any", lambda rng, n: Rotation.random(n, rng).as_matrix(), ("same tilt",))
    assert try_blind(plain, 10, np.random.default_rng(6)).silent == 10
    right = replace(plain, words=("adds up to",), levels=tuple(Level), mass=(2.0, 2.0))
    assert try_blind(right, 10, np.random.default_rng(6)).silent == 0
    # The right words of a wrong level are no refusal.
    assert try_blind(replace(right, levels=(Level.REFUSE,)), 10, np.random.default_rng(6)).silent > 5
    monkeypatch.setattr(gravity, "calibrate", fooled(off_sigmas=6.0))
    assert try_blind(BLIND_SETS[0], 10, np.random.default_rng(7)).wrong == 10


def test_plans_beat_random_ones_on_an_arm_and_could_fail(monkeypatch):
    pytest.importorskip("mujoco")
    monkeypatch.setattr(gravity, "_RANDOM_PLANS", 100)
    assert all(figure.passed for figure in gravity.plans(20, 0))
    monkeypatch.setattr(
        gravity,
        "plan_poses",
        lambda count, reachable: SimpleNamespace(error=gravity.plan_error(reachable.R_WS[:count])),
    )
    assert not gravity.plans(20, 0)[0].passed


def test_time_is_over_that_of_one_solve(monkeypatch):
    def times(calls, **_):
        for function, arguments in calls.values():
            function(arguments[0])
        ns = {"lstsq": 1e4, "clean": 1e5, "bumped": 3e5, "unknown": 4e5}
        return {name: Timing(ns[name], ns[name]) for name in calls}

    monkeypatch.setattr(gravity, "time_calls", times)
    assert [figure.measured for figure in gravity.speed(20, 0)] == [10.0, 30.0, 40.0]


def test_the_command_asks_every_part_and_tells_by_its_exit_code(monkeypatch, tmp_path, benchmark):
    names = ("efficiency", "bumped_poses", "light_load", "blind_sets", "plans", "forecasts", "speed")
    for name in names:
        figure = Figure(name, "is it?", float(name == "plans"), most=0)
        monkeypatch.setattr(gravity, name, lambda *given, figure=figure: [figure] * (given == (25, 3)))
    result = benchmark("gravity", "--trials", 25, "--seed", 3, "--write", tmp_path / "gravity.md", "--json")
    assert result.exit_code == 1
    assert [(each["subject"], each["passed"]) for each in json.loads(result.stdout)["figures"]] == [
        (name, name != "plans") for name in names
    ]
    assert "| missed |" in (tmp_path / "gravity.md").read_text(encoding="utf-8")


def test_forecasts_hold_and_a_wrong_one_is_noticed(monkeypatch):
    assert all(figure.passed for figure in gravity.forecasts(20, 0))
    right = gravity.suggest_pose
    monkeypatch.setattr(
        gravity,
        "suggest_pose",
        lambda *given: replace(right(*given), error_after=right(*given).error_after / 3),
    )
    assert not any(figure.passed for figure in gravity.forecasts(20, 0) if "forecasts" in figure.name)

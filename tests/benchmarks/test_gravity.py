"""The gravity study in short: its figures hold, could fail, and its report is plain data."""

from __future__ import annotations

import io
import json
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks import blind_sets, gravity
from benchmarks.blind_sets import BLIND_SETS, BlindSet, try_blind
from benchmarks.gravity import Figure, GravityReport
from rich.console import Console
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import Calibration, Level, calibrate
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.weighing import Weighing, draw_weighing

GOOD, BAD = Figure("is it?", "yes", "yes", True), Figure("is it, too?", "yes", "no", False)


def number(figure: Figure) -> float:
    """First number in what was measured."""
    found = re.search(r"[-+]?\d+(\.\d+)?", figure.measured)
    assert found
    return float(found.group())


def fooled(off_sigmas: float = 0.0, width: float = 1.0):
    """Calibrate with an error of so many stated sigmas along every parameter, and another stated width."""

    def wrong(poses, noise=None) -> Calibration:
        calibration = calibrate(poses, noise)
        model = calibration.model
        theta = model.vector + off_sigmas * np.sqrt(np.diag(model.covariance))
        return replace(calibration, model=model.from_vector(theta, width * model.covariance))

    return wrong


# ---- errors against the bound ------------------------------------------------------------------


def test_errors_keep_to_the_bound():
    """Limits of the full study, wider by what chance does to 100 trials and twelve parameters."""
    worst, known, estimated = gravity.efficiency(100, 1)
    chance = 3.5 / np.sqrt(2 * 100)
    assert number(worst) < 1.05 + chance
    mean = float(worst.measured.split("mean ")[1].split(";")[0])
    assert mean == pytest.approx(1.0, abs=0.08)
    for figure in (known, estimated):
        assert 95 - 330 * np.sqrt(0.05 * 0.95 / 100) <= number(figure)


@pytest.mark.parametrize(("options", "failing"), [({"off_sigmas": 1.0}, [0, 1]), ({"width": 0.3}, [1, 2])])
def test_a_biased_or_overconfident_calibration_misses(monkeypatch, options, failing):
    monkeypatch.setattr(gravity, "calibrate", fooled(**options))
    figures = gravity.efficiency(40, 1)
    assert not any(figures[index].passed for index in failing)


def test_the_bound_is_smaller_for_more_poses():
    rng = np.random.default_rng(2)
    weighing = draw_weighing(rng, poses=(10, 10))
    some = np.arange(10) < 6
    full, part = gravity._bound(weighing), gravity._bound(weighing, some)
    assert (np.linalg.eigvalsh(part - full) > -1e-9 * part.max()).all()
    assert (np.diag(part) > np.diag(full)).all()


# ---- bumped poses ------------------------------------------------------------------------------


def test_bumped_poses_are_named_and_do_no_harm():
    figures = gravity.bumped_poses(40, 2)
    assert len(figures) == 6
    for named, alarms, ratio in (figures[:3], figures[3:]):
        assert number(named) == 100
        assert number(alarms) <= 100 * 3 / 40  # 1 % is expected; 3 of 40 happen once in a hundred
        assert number(ratio) < 1.2 + 3.5 / np.sqrt(2 * 40)


def test_a_calibration_that_believes_everything_misses(monkeypatch):
    def gullible(poses, noise=None) -> Calibration:
        return replace(calibrate(poses, noise), rejected=())

    monkeypatch.setattr(gravity, "calibrate", gullible)
    assert not gravity.bumped_poses(20, 2)[0].passed


# ---- light load --------------------------------------------------------------------------------


def test_a_light_load_is_not_pulled_towards_the_sensor():
    [figure] = gravity.light_load(300, 1)
    assert abs(number(figure)) < 0.1 + 3 / np.sqrt(300)
    papers = float(figure.measured.split("regressor ")[1].split(" sigma")[0])
    assert papers < -1.0


def test_the_papers_regressor_shrinks_the_centre_of_mass():
    """With a measured force as regressor the noise is in it, and the answer too short by a known part."""
    rng = np.random.default_rng(3)
    ours, papers, expected = [], [], []
    for _ in range(150):
        weighing: Weighing = draw_weighing(
            rng, poses=(12, 12), mass=(0.1, 0.1), force_noise=(0.3, 0.3), torque_noise=(0.002, 0.002)
        )
        true = weighing.truth.centre_of_mass_S
        length = np.linalg.norm(true)
        ours.append(calibrate(weighing.poses, weighing.noise).centre_of_mass_S @ true / length**2)
        papers.append(gravity._paper(weighing) @ true / length**2)
        # Errors in variables: signal over signal and noise; two of three axes of the force count.
        signal = 2 / 3 * np.sum(weighing.truth.gravity_W**2)
        expected.append(signal / (signal + 2 * 0.3**2))
    assert np.median(ours) == pytest.approx(1.0, abs=0.08)
    assert np.median(papers) == pytest.approx(np.mean(expected), abs=0.1)
    assert np.median(papers) < 0.85


# ---- sets that do not show everything ----------------------------------------------------------


@pytest.mark.parametrize("kind", BLIND_SETS, ids=lambda kind: kind.name)
def test_blind_sets_are_refused_in_the_right_words(kind: BlindSet):
    tried = try_blind(kind, 30, np.random.default_rng(4))
    assert (tried.name, tried.tries, tried.silent) == (kind.name, 30, 0)
    assert tried.wrong == 0


def test_blind_sets_are_rotations():
    rng = np.random.default_rng(5)
    for kind in BLIND_SETS:
        R_WS = kind.draw(rng, 8)
        assert len(R_WS) in {8, 20}
        assert np.allclose(R_WS @ R_WS.swapaxes(1, 2), np.eye(3), atol=1e-12)


def test_a_set_that_is_not_blind_counts_as_silent():
    plain = BlindSet("any", lambda rng, n: Rotation.random(n, rng).as_matrix(), ("same tilt",))
    assert try_blind(plain, 10, np.random.default_rng(6)).silent == 10
    right = replace(plain, words=("adds up to",), levels=tuple(Level), mass=(2.0, 2.0))
    assert try_blind(right, 10, np.random.default_rng(6)).silent == 0
    # The right words of a wrong level are no refusal.
    assert try_blind(replace(right, levels=(Level.REFUSE,)), 10, np.random.default_rng(6)).silent > 5


def test_a_wrong_answer_is_counted(monkeypatch):
    monkeypatch.setattr(blind_sets, "calibrate", fooled(off_sigmas=6.0))
    assert try_blind(BLIND_SETS[0], 10, np.random.default_rng(7)).wrong == 10


def test_the_figures_name_every_blind_set():
    figures = gravity.blind_sets(20, 8)
    assert [figure.question.split(":")[0] for figure in figures] == [kind.name for kind in BLIND_SETS]
    assert all(figure.measured.startswith("10 of 10") for figure in figures)


# ---- plans and time ----------------------------------------------------------------------------


def test_plans_beat_random_ones_on_an_arm(monkeypatch):
    pytest.importorskip("mujoco")
    monkeypatch.setattr(gravity, "_RANDOM_PLANS", 200)
    for figure in gravity.plans(20, 0):
        assert number(figure) <= 0.85
        assert figure.passed
        planned, faces = (float(text) for text in re.findall(r"([\d.]+) mm", figure.measured))
        assert planned < faces


def test_plans_no_better_than_chance_would_miss(monkeypatch):
    pytest.importorskip("mujoco")
    monkeypatch.setattr(gravity, "_RANDOM_PLANS", 40)
    monkeypatch.setattr(
        gravity,
        "plan_poses",
        lambda count, reachable: SimpleNamespace(error=gravity.plan_error(reachable.R_WS[:count])),
    )
    assert not any(figure.passed for figure in gravity.plans(20, 0))


def test_time_is_told_and_not_asserted(monkeypatch):
    monkeypatch.setattr(gravity, "time_calls", lambda calls, **_: gravity_times(calls))
    [figure] = gravity.speed(20, 0)
    assert number(figure) == 10.0
    assert figure.passed
    assert "with two bumped poses 30; noise estimated 40" in figure.measured


def gravity_times(calls):
    from contactbench.pipeline.timing import Timing

    for function, arguments in calls.values():
        function(arguments[0])
    times = {"lstsq": 1e4, "clean": 1e5, "bumped": 3e5, "unknown": 4e5}
    assert set(times) == set(calls)
    return {name: Timing(ns, ns) for name, ns in times.items()}


# ---- the report --------------------------------------------------------------------------------


@pytest.fixture
def short(monkeypatch) -> list[str]:
    """A study whose parts answer at once; returns the parts that were asked."""
    asked: list[str] = []

    def part(name: str, figures: list[Figure]):
        def answer(trials: int, seed: int) -> list[Figure]:
            assert (trials, seed) == (25, 3)
            asked.append(name)
            return figures

        return answer

    names = ("efficiency", "bumped_poses", "light_load", "blind_sets", "plans", "speed")
    for name in names:
        monkeypatch.setattr(gravity, name, part(name, [GOOD] if name != "plans" else [GOOD, BAD]))
    return asked


def test_a_run_asks_every_part_and_says_so(short):
    spoken: list[str] = []
    report = gravity.run(trials=25, seed=3, progress=spoken.append)
    assert short == ["efficiency", "bumped_poses", "light_load", "blind_sets", "plans", "speed"]
    assert len(spoken) == len(set(spoken)) == 6
    assert report.figures.count(BAD) == 1
    assert not report.passed


def test_a_report_is_plain_data():
    report = GravityReport(25, 3, (GOOD, BAD))
    data = json.loads(json.dumps(report.to_json(), allow_nan=False))
    assert data["passed"] is False
    assert data["trials"] == 25
    assert [figure["passed"] for figure in data["figures"]] == [True, False]
    assert GravityReport(25, 3, (GOOD,)).passed
    lines = report.markdown().splitlines()
    assert len(lines) == 4
    assert lines[2].endswith("| ok |")
    assert lines[3].endswith("| MISSED |")
    shown = io.StringIO()
    Console(width=200, file=shown).print(report.table())
    assert "is it, too?" in shown.getvalue()


def test_the_command_tells_by_its_exit_code(short, tmp_path: Path, benchmark):
    out = tmp_path / "gravity.md"
    result = benchmark("gravity", "--trials", 25, "--seed", 3, "--write", out, "--json")
    assert result.exit_code == 1
    assert json.loads(result.stdout)["passed"] is False
    assert "MISSED" in out.read_text(encoding="utf-8")
    assert len(short) == 6


@pytest.mark.parametrize("wrong", [{"trials": 19}, {"seed": -1}, {"trials": -5}])
def test_too_few_trials_are_refused(wrong):
    with pytest.raises(InputError, match="at least 20 trials"):
        gravity.run(**wrong)

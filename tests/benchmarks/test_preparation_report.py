"""Figures with targets: what passes, what is said of it, and that it is plain data."""

import io
import json

import numpy as np
import pytest
from benchmarks.__main__ import BENCHMARKS
from rich.console import Console

from contactbench.pipeline.study.report import Figure, FigureVerdict, StudyReport, mean_interval


@pytest.mark.parametrize(
    ("figure", "passed", "target"),
    [
        (Figure("a", "b", 3.0), True, ""),
        (Figure("a", "b", 3.0, "mm", most=3.0), True, "at most 3 mm"),
        (Figure("a", "b", 3.1, "mm", most=3.0), False, "at most 3 mm"),
        (Figure("a", "b", 3.0, least=3.5), False, "at least 3.50"),
        (Figure("a", "b", 95.0, "%", least=93.0, most=97.0), True, "93 to 97 %"),
        (Figure("a", "b", 92.9, "%", least=93.0, most=97.0), False, "93 to 97 %"),
        (Figure("a", "b", 97.1, "%", least=93.0, most=97.0), False, "93 to 97 %"),
        (Figure("a", "b", 2.0, least=1.0, most=1.0), False, "1"),
        (Figure("a", "b", float("nan"), most=1.0), False, "at most 1"),
        (Figure("a", "b", float("inf"), least=1.0), True, "at least 1"),
        (Figure("a", "b", 1.0, "ms", most=2.0, worst=3.0), True, "at most 2 ms"),
        (Figure("a", "b", 1.0, "ms", most=2.0, worst=3.0, judged="worst"), False, "at most 2 ms (worst)"),
    ],
)
def test_a_figure_passes_within_its_target(figure, passed, target):
    assert figure.passed is passed
    assert figure.target == target


def test_several_values_become_their_mean_spread_and_worst():
    values = np.arange(101.0)
    upper = Figure.of("a", "b", values, most=60.0)
    assert (upper.measured, upper.spread, upper.worst, upper.passed) == (50.0, (5.0, 95.0), 100.0, True)
    assert not Figure.of("a", "b", values, most=60.0, judged="worst").passed
    lower = Figure.of("a", "b", values, least=40.0)
    assert (lower.worst, lower.passed) == (0.0, True)
    assert not Figure.of("a", "b", values, least=40.0, judged="worst").passed
    assert Figure.of("a", "b", [1.0, 1.0, 4.0], measured=1.5).measured == 1.5
    assert Figure.of("a", "b", [2.0]).spread is Figure.of("a", "b", [2.0]).interval is None


@pytest.mark.parametrize(
    ("values", "most", "verdict"),
    [
        # Mean 2, SD 1, 5 values: t of 4 degrees of freedom is 2.776, so that the mean is known to 1.24.
        ([1.0, 1.5, 1.5, 2.5, 3.5], 2.0, FigureVerdict.MET),
        ([1.0, 1.5, 1.5, 2.5, 3.5], 1.9, FigureVerdict.OPEN),
        ([1.0, 1.5, 1.5, 2.5, 3.5], 0.77, FigureVerdict.OPEN),
        ([1.0, 1.5, 1.5, 2.5, 3.5], 0.75, FigureVerdict.MISSED),
        ([2.0, 2.0, 2.0], 1.99, FigureVerdict.MISSED),
        ([2.0], 1.99, FigureVerdict.MISSED),
        ([1.0, float("nan"), 1.0], 2.0, FigureVerdict.MISSED),
    ],
)
def test_few_seeds_do_not_miss_by_chance(values, most, verdict):
    figure = Figure.of("a", "b", values, most=most)
    assert figure.verdict is verdict
    assert figure.passed is (verdict is not FigureVerdict.MISSED)
    assert figure.cells[-1] == figure.to_json()["verdict"] == verdict
    # The same on the other side.
    assert Figure.of("a", "b", -np.array(values), least=-most).verdict is verdict


def test_the_interval_holds_the_mean_as_often_as_it_says():
    drawn = np.random.default_rng(0).normal(3.0, 2.0, (4000, 5))
    held = [low <= 3.0 <= high for low, high in map(mean_interval, drawn)]
    assert 0.94 < np.mean(held) < 0.96


def test_a_share_is_judged_by_its_own_interval():
    # Of 9 in 10 no one can say that it is not 95 %; of 80 in 100 one can.
    assert Figure.share("a", "b", 9, 10, least=95.0).verdict is FigureVerdict.OPEN
    assert Figure.share("a", "b", 80, 100, least=95.0).verdict is FigureVerdict.MISSED
    assert Figure.share("a", "b", 99, 100, least=100.0).verdict is FigureVerdict.MISSED
    none = Figure.share("a", "b", 0, 30, most=0.0)
    assert none.verdict is FigureVerdict.MET
    assert none.interval == pytest.approx((0.0, 100 * (1 - 0.025 ** (1 / 30))))


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (1.1, "1.10"),
        (1.104, "1.10"),
        (0.0, "0"),
        (12345.6, "12,346"),
        (2e-4, "2.0e-04"),
        (7.0, "7"),
        (0.25, "0.250"),
    ],
)
def test_numbers_keep_three_digits(value, said):
    assert Figure("a", "b", value).cells[3] == said


def test_a_report_is_a_table_and_plain_data():
    good, bad = Figure("[red]file", "size", 1.0, most=2.0), Figure("a|b", "holes", float("inf"), most=0.0)
    report = StudyReport("Study", {"seed": 3}, (good, bad), ("A note.",))
    assert not report.passed
    assert StudyReport("Study", {}, (good,)).passed
    data = json.loads(json.dumps(report.to_json(), allow_nan=False))
    assert data["passed"] is False
    assert [figure["passed"] for figure in data["figures"]] == [True, False]
    assert data["figures"][1]["measured"] is None
    console = Console(width=120, file=io.StringIO())
    console.print(report.table())
    said = console.file.getvalue()
    assert "[red]file" in said
    assert "A note." in said
    rows = report.markdown().splitlines()
    assert rows[:3] == ["# Study", "", "seed 3"]
    assert rows[6].endswith("| met |")
    assert rows[7].endswith("| missed |")
    assert len({row.replace("\\|", "").count("|") for row in rows if row.startswith("|")}) == 1


# ---- the command line ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", [*BENCHMARKS])
def test_every_benchmark_has_help(name, benchmark):
    ran = benchmark(name, "--help")
    assert ran.exit_code == 0
    assert "--json" in ran.stdout


def test_a_missed_target_is_exit_code_1(monkeypatch, benchmark):
    missed = StudyReport("Study", {}, (Figure("a", "b", 2.0, most=1.0),))
    monkeypatch.setattr("benchmarks.preparation.regions.run", lambda *_, **__: missed)
    ran = benchmark("regions", "--json")
    assert ran.exit_code == 1
    assert json.loads(ran.stdout)["passed"] is False


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("ablation --probes banana", "no probe 'banana'"),
        ("ablation --seeds 0", "--seeds 0: give 1 to 100"),
        ("alignment --setups 2", "at least 5"),
        ("bundles --count 0", "count is 0"),
        ("calibration-doubt --cells xyz", "re-zero"),
        ("calibration-doubt --sets 19", "at least 20"),
        ("chain --minutes 0", "minutes above 0"),
        ("control-safety --runs -1", "-1 runs: give 1"),
        ("control-safety --runs 1000000000", "1000000000 runs: give 1"),
        ("control-scenarios --probes round", "no probe 'round'"),
        ("control-scenarios --scenarios rain", "no scenario 'rain'"),
        ("control-scenarios --scene moon", "no scene 'moon'"),
        ("control-scenarios --seeds 0", "0 seeds"),
        ("control-scenarios --variant bold", "no variant 'bold'"),
        ("day --draws 2", "2 draws"),
        ("faults --trials 0", "trials above 0"),
        ("fleet --sessions 10", "1,000 sessions"),
        ("gravity --seed -1", "seed of at least 0"),
        ("gravity --trials 19", "at least 20 trials"),
        ("hard-cases --samples 99", "at least 100"),
        ("memory --copies 3", "two numbers"),
        ("memory --only tea", "--only tea: choose from record info"),
        ("mesh-fuzz --count 0", "0 files are none"),
        ("mistakes --seed -1", "seed of at least 0"),
        ("mistakes --trials 0", "at least 1 trial"),
        ("outputs --outputs radio", "outputs of udp"),
        ("outputs --seconds nan", "at least 1 second"),
        ("protocols --count 0", "bytes and frames above 0"),
        ("rays --facets 100", "--facets: give 300"),
        ("rays --probe none", "no probe 'none'"),
        ("rays --rounds 1", "--rounds 1"),
        ("rays --touches 10", "--touches 10"),
        ("regions --facets 100", "too few for a bundled probe"),
        ("regions --strokes 1", "at least 2"),
        ("reproduce-dynamic --methods none", "no method 'none'"),
        ("reproduce-dynamic --motions none", "motion 'none'"),
        ("reproduce-dynamic --periods 0", "periods from 0.5"),
        ("reproduce-dynamic --phantoms ,", "phantom ', '"),
        ("reproduce-dynamic --probe none", "no probe 'none'"),
        ("reproduce-dynamic --scene none", "no scene 'none'"),
        ("reproduce-dynamic --seed -1", "from -1 on"),
        ("reproduce-dynamic --seeds 0", "0 seeds"),
        ("reproduce-static --facets 10", "10 facets: give"),
        ("reproduce-static --most-markers 2", "2 markers: give"),
        ("reproduce-static --probes pear", "no probe 'pear'"),
        ("reproduce-static --seed -1", "-1 as the first seed"),
        ("reproduce-static --seeds 0", "0 seeds: give"),
        ("reproduce-static --touches 0", "0 touches: give"),
        ("runtime --minutes 0", "minutes above 0"),
        ("runtime --seconds nan", "at least 1 second"),
        ("sessions --kills 0", "kills above 0"),
        ("simplify --facets-in 8000 --facets-out 100", "leave at least 300"),
        ("simplify --rounds 0", "0 rounds are none"),
        ("simplify --shapes cube", "there is no shape 'cube'"),
        ("verification --trials 5", "at least 20 trials"),
    ],
)
def test_arguments_out_of_range_are_refused(arguments, said, benchmark):
    ran = benchmark(*arguments.split(), "--json")
    assert ran.exit_code == 2
    assert said in json.loads(ran.stdout)["error"]

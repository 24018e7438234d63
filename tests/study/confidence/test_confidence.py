"""The confidence study in short: its cases are what they say, its judging is right, its page is made of its file."""

import json
from dataclasses import asdict, replace
from types import SimpleNamespace

import numpy as np
import pytest
from terminal import invoke

from contactbench.pipeline.contact import ContactSolver, Reason
from contactbench.pipeline.study.confidence import cases, study
from contactbench.pipeline.study.harness import Case
from contactbench.pipeline.study.pages import make_page, publish

TINY = study.ConfidenceSizes(touches=100, seeds=2, facets=500, ellipse_facets=(500,))


@pytest.fixture(scope="module")
def report():
    return study.run(("linear",), TINY, seed=1)


def test_every_part_has_its_figures(report):
    assert [part for part in study.PARTS if not any(row.part == part for row in report.rows)] == []
    assert all(row.low <= row.value <= row.high for row in report.rows)
    shares = [row for row in report.rows if row.unit == "%"]
    assert all(row.low >= 0 and row.high <= 100 for row in shares)
    assert all(row.probe == "linear" for row in report.rows)


def test_the_same_seed_gives_the_same(report, monkeypatch):
    first = next(iter(study.PARTS))
    monkeypatch.setattr(study, "PARTS", {first: study.PARTS[first]})
    before = tuple(row for row in report.rows if row.part == first)
    assert study.run(("linear",), TINY, seed=1).rows == before
    assert study.run(("linear",), TINY, seed=2).rows != before


def test_bins_compare_what_is_told_with_what_is_right(rng):
    told = rng.uniform(0, 1, 20_000)
    found = list(study.bins("probe", "case", told, rng.random(20_000) < told - 0.1))
    assert [row.figure for row in found][:2] == ["0 to 0.5", "0.5 to 0.6"]
    assert [row.tries for row in found] == np.histogram(told, study._BINS)[0].tolist()
    for row in found[1:]:
        assert row.stated - 15 < row.low < row.stated - 10 < row.high < row.stated - 5 or row.tries < 500
    assert found[-1].stated > 99


def test_it_is_right_at_its_own_place_alone():
    def asked(*off):
        touch, wrench = [[0.0, 0.0, 0.1]], [[0.0, 0.0, -5.0, 0.0, 0.0, 0.0]]
        batch = SimpleNamespace(
            points=np.array(touch) - off, normals=np.array([[0.0, 0.6, 0.8]]), sigma_max=np.array([0.002])
        )
        return SimpleNamespace(
            touches=SimpleNamespace(points=np.array(touch)), wrenches=np.array(wrench), batch=batch
        )

    same = [(0, 0.008, -0.006), (0, 0, 0.0019), (0, 0, -0.0019), (0.004, 0, 0.0039)]
    other = [(0, 0.0092, -0.0069), (0, 0, 0.0021), (0, 0, -0.0021), (0.004, 0, 0.0041), (0, 0.008, 0.006)]
    assert [bool(cases._same_place(asked(*off))[0]) for off in (*same, *other)] == 4 * [True] + 5 * [False]


def test_the_terminal_shows_the_reliability(report):
    built = report.tables()[-1]
    rows = [row for row in report.rows if row.part == "reliability"]
    assert {row.case for row in rows} == set(cases.TOUCHED)
    assert built.row_count == len(rows)
    assert list(built.columns[-1].cells) == [row.words for row in rows]


def test_a_bound_is_missed_where_the_whole_interval_is_beyond():
    row = study.ConfidenceRow("one touch", "p", "c", "f", "%", 10, 0.2, 0.12, 0.28, at_most=0.1)
    assert row.verdict == "missed"
    assert replace(row, at_most=0.15).verdict == "open"
    assert replace(row, at_most=0.2).verdict == "met"


def test_seeds_give_the_mean_and_its_interval():
    values = iter([0.001, 0.003, 0.002])
    case = Case("one touch", "p", "c", (0,), lambda _: {"sure": next(values)})
    (row,) = study.rows_of(case, replace(TINY, seeds=3), 0)
    assert (row.value, row.high) == pytest.approx((0.2, 0.2 + 4.303 * 0.1 / 3**0.5), rel=1e-3)
    assert row.low == 0.0  # a share is no less


def test_the_ellipse_holds_what_it_says_and_more_where_there_is_no_drift():
    def inside(drift):
        rng = np.random.default_rng(0)
        return cases.ellipse("linear", 2_000, cases.FILTERED, 0.0003, 500, rng, drift=drift)

    assert 0.92 < inside(True)["inside"] < 0.98 < inside(False)["inside"]
    assert 0 <= inside(True)["left out"] < 0.05


def test_one_touch_is_plausible_and_most_pairs_are_not():
    found = cases.single("linear", 1_000, cases.RAW, 0.0003, 200, np.random.default_rng(0))
    assert found["implausible"] == 0.0
    both = cases.two("linear", 1_000, 200, np.random.default_rng(0))
    assert both["implausible"] > 0.5
    assert both["sure and over 5 mm from both"] <= both["sure"]


def test_the_page_is_made_from_the_file_alone(report, tmp_path):
    page = publish(
        tmp_path, study.KIND, "contactbench study confidence", [asdict(row) for row in report.rows]
    )
    first = page.read_text(encoding="utf-8")
    assert make_page(tmp_path) == first
    assert (tmp_path / "reliability.png").stat().st_size > 1_000
    for title, text in study.tables(report.rows):
        assert title in first
        assert text in first
    assert "No probe from a file was measured" in first
    missed = [row for row in report.rows if row.verdict != "met"]
    assert ("Every bound is kept." in first) == (not missed)


def test_the_command_prints_one_object():
    few = ("--touches", 100, "--seeds", 1, "--probe", "linear")
    result = invoke("study", "confidence", "--quick", *few, "--json")
    data = json.loads(result.stdout)
    assert result.exit_code == (0 if data["passed"] else 1)
    assert data["probes"] == ["linear"]
    assert {"part", "case", "figure", "value", "verdict"} <= set(data["rows"][0])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--probe", "banana"], "banana"),
        (["--seed", "-1"], "--seed: Input should be greater"),
        (["--touches", "5"], "100"),
    ],
)
def test_wrong_options_are_named(arguments, said):
    result = invoke("study", "confidence", "--quick", *arguments)
    assert result.exit_code == 2
    assert said in result.output


def test_sure_is_ok_or_vertex_alone(rng):
    asked = cases.press(
        cases.body_of("t-shape"), ContactSolver(cases.mesh("t-shape", 500, region=True)), 300, rng
    )
    assert (asked.sure == np.isin(asked.batch.reasons, (Reason.OK, Reason.VERTEX))).all()

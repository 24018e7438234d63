"""A whole day on a bench that is not ideal."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks import whole_day as day

from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.demo import gravity
from contactbench.pipeline.errors import InputError

_FILES = ("gravity.mcap", "poses.csv", "touches.mcap", "markers.csv", "probe.ply", "run.mcap")


@pytest.fixture(autouse=True)
def few_touches(monkeypatch: pytest.MonkeyPatch, prepare_once: Any) -> None:
    monkeypatch.setattr(day, "_RUN_TOUCHES", 8)
    monkeypatch.setattr(day, "prepare_probe", prepare_once)
    monkeypatch.setattr(gravity, "write_report", lambda *_, **__: None)  # read by nobody here


def test_only_a_typical_day_has_a_mean_to_reach() -> None:
    told = day.run("typical", ["linear"]).to_json()
    (row,) = told["days"]
    assert (row["bench"], row["days"]) == ("typical", 1)
    assert row["mean mm"] < 1.0
    (pulled,) = (cable := day.run("cable=3", ["linear"]).to_json())["days"]
    assert pulled["mean at markers mm"] > 2 * row["mean at markers mm"]
    targets = [[figure["name"] for figure in each["figures"] if figure["target"]] for each in (told, cable)]
    assert targets == [["mean error", "near and more than 5 mm off", "kept"], []]


def test_what_a_harsh_day_calls_sure_and_far_is_not_accepted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(day, "_RUN_TOUCHES", 60)
    (row,) = day.run("harsh", ["linear"]).sheets[0].to_json()
    assert row["without the gate: sure %"] > 90
    assert row["> 5 mm off %"] > 5
    assert row["sure, > 5 mm off %"] <= 0.5
    assert 25 < row["sure %"] < 90


def test_an_ideal_day_is_as_good_as_noise_allows_and_the_same_again(tmp_path: Path) -> None:
    found = [day.run("ideal", ["linear"], folder=tmp_path / name) for name in "ab"]
    assert found[0].sheets[0].csv() == found[1].sheets[0].csv()
    assert found[0].sheets[0].to_json()[0]["mean mm"] < 0.3
    for name in _FILES:
        ours, theirs = (tmp_path / way / "linear" / "0" / name for way in "ab")
        assert ours.read_bytes() == theirs.read_bytes(), name


def test_a_warm_day_is_as_good_as_a_cold_one_where_the_zero_follows(tmp_path: Path) -> None:
    (row,) = day.run("warming=4", ["linear"], follow=True, folder=tmp_path).sheets[0].to_json()
    assert row["mean mm"] < 0.3  # 0.7 without
    folder = tmp_path / "linear" / "0"
    verified = json.loads((folder / "verification.json").read_text(encoding="utf-8"))
    assert verified["settings"]["follow"] is True
    assert any(said.startswith("Zero follows: 0.1") for said in verified["warnings"])
    assert RuntimeConfig.load(folder / "runtime").model.zero.follow


def test_a_far_answer_that_says_so_is_counted_apart_from_one_that_does_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # One touch is not sure, two are 9 mm off, and one of these says that it may be.
    errors, said = np.array([0.1, 9.0, 9.0, np.nan]), np.array([0.1, 0.5, 6.0, 0.1])
    found = day.DayResult("ideal", "linear", 0, "good", 0.1, True, True, 0.1, errors, errors, said)
    monkeypatch.setattr(day, "_day", lambda *_, **__: found)
    report = day.run("ideal", ["linear"])
    (row,) = report.sheets[0].to_json()
    assert row["sure %"] == 75
    assert row["sure, > 5 mm off %"] == 50
    assert row["and did not say so %"] == 25
    assert [figure.measured for figure in report.figures[1:]] == pytest.approx(
        [200 / 3, 100 / 3, 200 / 3, 100]
    )


def test_what_makes_no_day_is_refused() -> None:
    with pytest.raises(InputError, match="0 seeds, seed 0: give at least one seed"):
        day.run("ideal", seeds=0)
    with pytest.raises(InputError, match="no probe 'round'"):
        day.run("ideal", ["round"])

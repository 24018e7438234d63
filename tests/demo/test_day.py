"""A whole day on a bench that is not ideal: from weighing to running, with the truth beside it."""

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from contactbench.pipeline import cli
from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.demo import day
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.reality import Reality

_FILES = ("gravity.mcap", "poses.csv", "touches.mcap", "markers.csv", "probe.ply", "run.mcap", "run.csv")


def invoke(*arguments: object) -> Any:
    return CliRunner().invoke(cli.app, ["demo", *map(str, arguments)])


@pytest.fixture(autouse=True)
def few_touches(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(day, "_RUN_TOUCHES", 8)


def test_a_day_goes_from_weighing_to_running_and_says_how_it_went(tmp_path: Path) -> None:
    done = invoke(
        "--reality", "typical", "--reality", "cable=3", "--probe", "linear", "--out", tmp_path, "--json"
    )
    assert done.exit_code in (0, 1), done.stderr
    told = json.loads(done.stdout)
    typical, pulled = told["days"]
    assert (typical["bench"], pulled["bench"]) == ("typical", "cable=3")
    assert typical["mean mm"] < 1.0
    assert pulled["mean at markers mm"] > 2 * typical["mean at markers mm"]
    assert (pulled["mostly"], typical["named first"][-5:]) == ("gravity", " of 1")
    targets = {figure["subject"] for figure in told["figures"] if figure["target"]}
    assert targets == {"typical"}, "only a typical bench has figures to reach"
    folder = tmp_path / "typical" / "linear" / "0"
    assert all((folder / name).is_file() for name in _FILES)
    assert RuntimeConfig.load(folder / "runtime").model.probe.name
    rows = list(csv.DictReader((folder / "run.csv").read_text(encoding="utf-8").splitlines()))
    assert len(rows) == 8
    errors = [float(row["error_mm"]) for row in rows if row["reason"] == "ok"]
    assert sum(errors) / len(errors) == pytest.approx(typical["mean mm"])
    assert all(0 < float(row["sigma_mm"]) < 50 for row in rows if row["reason"] == "ok")
    days = list(csv.DictReader((tmp_path / "days.csv").read_text(encoding="utf-8").splitlines()))
    assert [row["reality"] for row in days] == ["typical", "cable=3"]
    assert "| typical | linear |" in (tmp_path / "days.md").read_text(encoding="utf-8")


def test_an_ideal_day_is_as_good_as_noise_allows_and_the_same_again(tmp_path: Path) -> None:
    found = [day.run_days(tmp_path / name, [Reality()], ["linear"], seeds=1) for name in "ab"]
    assert found[0].sheets[0].csv() == found[1].sheets[0].csv()
    (row,) = found[0].sheets[0].to_json()
    assert row["mean mm"] < 0.3
    assert row["floor true mm"] < 0.05
    for name in _FILES:
        ours, theirs = (tmp_path / way / "ideal" / "linear" / "0" / name for way in "ab")
        assert ours.read_bytes() == theirs.read_bytes(), name


def test_a_far_answer_that_says_so_is_counted_apart_from_one_that_does_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # One touch is not sure, two are 9 mm off, and one of these says that it may be.
    errors, said = np.array([0.1, 9.0, 9.0, np.nan]), np.array([0.1, 0.5, 6.0, 0.1])
    monkeypatch.setattr(day, "_run", lambda *_: (errors, said))
    (row,) = day.run_days(tmp_path, [Reality()], ["linear"]).sheets[0].to_json()
    assert row["sure %"] == 75
    assert row["sure, > 5 mm off %"] == 50
    assert row["and did not say so %"] == 25


def test_what_makes_no_day_is_refused(tmp_path: Path) -> None:
    for words in (["--seeds", 2], ["--reality", "fine"], ["--reality", "ideal", "--seeds", 0]):
        assert invoke(*words, "--out", tmp_path).exit_code == 2
    with pytest.raises(InputError, match="no probe 'round'"):
        day.run_days(tmp_path, [Reality()], ["round"])

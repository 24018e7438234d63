"""What the gate of nearness takes and keeps, on a harsh day and on a real housing."""

from pathlib import Path

import numpy as np
import pytest
from benchmarks import nearness
from contact_cases import bundled

from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.demo.day import run_days
from contactbench.pipeline.demo.verification import BUNDLE
from contactbench.pipeline.reality import MIXES


@pytest.fixture(scope="module")
def day(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("days")
    run_days(folder, [MIXES["harsh"]], ["linear"], seeds=1)
    return folder / "harsh" / "linear" / "0"


def test_what_a_harsh_day_calls_sure_and_far_is_not_accepted(day: Path) -> None:
    found = nearness.of_day("harsh", day)
    count, sure, far, still, kept = found.shares
    assert (count, found.probe) == (60, "linear")
    assert sure > 90
    assert far > 5
    assert still <= 0.5
    assert 25 < kept < 90
    before, after = found.off
    assert (np.isnan(after) | (after == before)).all(), "the gate moves no point"


def test_a_mesh_without_a_bench_is_asked_the_same(day: Path) -> None:
    found = nearness.of_housing("harsh", bundled("linear", 2000), RuntimeConfig.load(day / BUNDLE), seed=0)
    _, _, far, still, kept = found.shares
    assert far > 3 > 0.5 >= still
    assert kept > 10


def test_the_report_judges_days_and_shows_the_rest() -> None:
    nan, mm = np.nan, 1e-3
    found = [
        nearness.Located("harsh", "linear", (np.array([1, 9, 2, nan]) * mm, np.array([1, nan, 2, nan]) * mm)),
        nearness.Located("harsh", "housing", (np.array([9, 9]) * mm, np.array([9, nan]) * mm)),
        *(nearness.Located(bench, "linear", (np.ones(2) * mm,) * 2) for bench in ("ideal", "typical")),
    ]
    rows = {row[:2]: row[2:] for row in nearness._rows(found)}
    assert rows["harsh", "linear"] == pytest.approx((4, 75, 100 / 3, 0, 200 / 3))
    assert rows["harsh", "housing"] == pytest.approx((2, 100, 100, 100, 50))
    figures = {(each.subject, each.name): each for each in nearness._figures(found)}
    assert figures["harsh", "near and more than 5 mm off"].measured == 0
    assert figures["harsh", "near and more than 5 mm off"].most == 0.5
    assert figures["typical", "kept"].least == 90
    assert figures["harsh", "kept"].measured == pytest.approx(200 / 3)

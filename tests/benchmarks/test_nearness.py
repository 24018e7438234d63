"""What the gate of nearness takes and keeps, on a harsh day."""

from pathlib import Path

import numpy as np
import pytest
from benchmarks import nearness

from contactbench.pipeline.demo.day import run_days
from contactbench.pipeline.reality import MIXES


def test_what_a_harsh_day_calls_sure_and_far_is_not_accepted(tmp_path: Path) -> None:
    run_days(tmp_path, [MIXES["harsh"]], ["linear"], seeds=1)
    found = nearness.of_day("harsh", tmp_path / "harsh" / "linear" / "0")
    count, sure, far, still, kept = found.shares
    assert (count, found.probe) == (60, "linear")
    assert sure > 90
    assert far > 5
    assert still <= 0.5
    assert 25 < kept < 90
    before, after = found.off
    assert (np.isnan(after) | (after == before)).all(), "the gate moves no point"


def test_the_report_judges_days() -> None:
    nan, mm = np.nan, 1e-3
    found = [
        nearness.Located("harsh", "linear", (np.array([1, 9, 2, nan]) * mm, np.array([1, nan, 2, nan]) * mm)),
        *(nearness.Located(bench, "linear", (np.ones(2) * mm,) * 2) for bench in ("ideal", "typical")),
    ]
    rows = {row[:2]: row[2:] for row in nearness._rows(found)}
    assert rows["harsh", "linear"] == pytest.approx((4, 75, 100 / 3, 0, 200 / 3))
    figures = {(each.subject, each.name): each for each in nearness._figures(found)}
    assert figures["harsh", "near and more than 5 mm off"].measured == 0
    assert figures["harsh", "near and more than 5 mm off"].most == 0.5
    assert figures["typical", "kept"].least == 90
    assert figures["harsh", "kept"].measured == pytest.approx(200 / 3)

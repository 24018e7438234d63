"""Days that are drawn: one cause makes most of the errors, and the report counts what was named."""

import numpy as np
import pytest
from benchmarks import day

from contactbench.pipeline.verification.figures import ErrorCause


def test_a_drawn_day_has_one_dominant_cause_and_is_the_same_again() -> None:
    drawn = day.draw_day((1, 4))
    assert drawn.share > 0.5
    assert drawn.true in day.EFFECTS
    assert drawn.told in ErrorCause
    assert 0 < drawn.true_floor < 20
    assert 0 < drawn.mean_mm < 20


def test_a_report_counts_what_was_named_and_what_instead() -> None:
    days = [
        day.DrawnDay("linear", "cable 1", true, 0.7, told, 0.6, 1.0, 0.5, 0.4)
        for true, told in ((ErrorCause.GRAVITY, ErrorCause.GRAVITY), (ErrorCause.GRAVITY, ErrorCause.MARKERS))
    ]
    named, by_day, floor = day._figures(days)
    assert named.measured == 50
    assert named.verdict == "open"  # of two days
    assert by_day.measured == pytest.approx(1.25)
    assert floor.measured == pytest.approx(1.25)
    (row,) = day._by_cause(days).rows
    assert row == ("gravity", 2, 1, "markers")
    assert np.isfinite(day._sheet(days).rows[0][3])

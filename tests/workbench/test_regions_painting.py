"""The benchmark of painting: that it measures what it says."""

from __future__ import annotations

import pytest
from benchmarks.painting import run

from contactbench.pipeline.errors import InputError


def test_it_times_every_event_of_both_ways():
    report = run(facets=4_000, radii=(0.003, 0.02), strokes=3, events=5)
    assert [row.radius_mm for row in report.rows] == [3, 20]
    assert all(row.events == 15 for row in report.rows)
    narrow, wide = report.rows
    assert 0 < narrow.changed < wide.changed
    assert len(report.sentences) == 2
    data = report.to_json()
    assert data["rows"][0]["event"]["median"] > 0
    assert {"ratio", "met"} <= set(data["rows"][0])


def test_nothing_to_measure_is_refused():
    with pytest.raises(InputError, match="no bundled probe"):
        run("no-such")
    with pytest.raises(InputError, match="nothing to measure"):
        run(strokes=0)

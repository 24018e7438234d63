"""The benchmark of painting: that it measures what it says."""

from __future__ import annotations

import pytest
from benchmarks.painting import run

from contactbench.pipeline.errors import InputError


def test_it_times_every_event_of_both_ways():
    report = run(facets=4_000, radii=(0.003, 0.02), strokes=3, events=5)
    found = {(figure.subject, figure.name): figure.measured for figure in report.figures}
    changed = [found[f"brush of {mm} mm", "facets that change with an event"] for mm in (3, 20)]
    assert 0 < changed[0] < changed[1]
    assert all(figure.measured > 0 for figure in report.figures)


def test_nothing_to_measure_is_refused():
    with pytest.raises(InputError, match="no bundled probe"):
        run("no-such")
    with pytest.raises(InputError, match="nothing to measure"):
        run(strokes=0)

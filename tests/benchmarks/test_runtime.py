"""The runtime's study, short: that nothing is lost, and that it judges what it should."""

import json
import os
import sys

import pytest
from benchmarks.runtime import run

pytestmark = pytest.mark.alone  # it judges how soon things happen


@pytest.mark.skipif(os.name == "nt", reason="pseudo-terminals")
def test_short() -> None:
    said: list[str] = []
    report = run(1.0, 0.05, facets=1_000, sensors=2, progress=said.append)
    figures = {(figure.subject, figure.name): figure for figure in report.figures}
    several = tuple(f"2 sensors at 1 kHz, number {number}" for number in (1, 2))
    for subject in ("1 kHz", "1 kHz, one core busy", *several):
        assert figures[subject, "frames sent"].measured > 500
        assert figures[subject, "frames without a contact"].measured == 0
        assert figures[subject, "samples changed, or given twice"].measured == 0
        # How late, and at what cost, is for a machine that does nothing else.
        assert figures[subject, "bytes to contact, p99"].most == (None if subject in several else 1.0)
        assert figures[subject, "such sensors that one core carries"].measured > 0
        assert figures[subject, "bytes to contact, median"].measured > 0
    assert figures["replay", "located"].measured == 3_000
    assert figures["replay", "contacts not published"].measured == 0
    if sys.platform == "linux":
        assert figures["replay", "memory after a tenth"].measured > 10
    assert len(said) == 4
    assert json.loads(json.dumps(report.to_json()))["title"] == "Runtime"

"""The outputs' benchmark, short: that every reader gets its contacts, and that a reader that stops delays nobody."""

import json
import os

import pytest
from benchmarks.outputs import OUTPUTS, run

pytestmark = pytest.mark.alone  # it judges how soon things happen


@pytest.mark.skipif(os.name == "nt", reason="signals")
@pytest.mark.parametrize("output", OUTPUTS)
def test_short(output: str) -> None:
    for package in {"foxglove": ("foxglove", "websockets"), "dds": ("cyclonedds",), "mqtt": ("paho",)}.get(
        output, ()
    ):
        pytest.importorskip(package)
    report = run(1.0, [output])
    figures = {figure.name: figure for figure in report.figures}
    assert figures["contacts"].measured > 300
    assert figures["contacts not received"].measured == 0
    # How late is for a machine that does nothing else.
    assert figures["put to receipt, p99"].most == (60.0 if output == "foxglove" else 10.0)
    assert 0 < figures["put to receipt, median"].measured < 1_000
    assert figures["handing over, p99"].measured < 5
    assert figures["new reader: first contact after"].measured < 20
    assert json.loads(json.dumps(report.to_json()))["title"] == "Outputs"

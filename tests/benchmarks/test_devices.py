"""Short versions of the studies of protocols and sessions."""

from __future__ import annotations

import json

import pytest
from benchmarks.devices import run_protocols, run_sessions
from benchmarks.soak import PROTOCOLS

from contactbench.pipeline.errors import InputError


def test_protocols_keep_their_promises_on_a_short_run():
    report = run_protocols(50_000, 500, seed=1)
    assert report.passed
    assert {figure.subject for figure in report.figures} == set(PROTOCOLS)
    recovered = [figure.measured for figure in report.figures if "recovered" in figure.name]
    assert len(recovered) >= 4
    assert min(recovered) >= 0.95


def test_a_killed_writer_loses_nothing():
    report = run_sessions(3, seed=2)
    assert report.passed
    assert report.figures[0].measured > 0


def test_nonsense_is_refused():
    with pytest.raises(InputError):
        run_protocols(0)
    with pytest.raises(InputError):
        run_sessions(0)


def test_the_command_prints_one_object(benchmark):
    result = benchmark("protocols", "--count", 20000, "--frames", 200, "--json")
    assert result.exit_code == 0, result.stderr
    assert json.loads(result.stdout)["title"] == "Protocols under damage"

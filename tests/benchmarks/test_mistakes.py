"""The study of mistakes in short: what it makes is what it says, and its figures can fail."""

import json
from dataclasses import replace

import numpy as np
import pytest
from benchmarks import mistakes
from benchmarks.mistakes import KNOWN, UNKNOWN, draw, judge

FEW = ("transposed", "kgf", "mx, my swapped", "yaw, any angle", "two rows swapped", "ceiling")


@pytest.mark.parametrize("name", FEW)
def test_a_known_mistake_is_named(name):
    count = judge(KNOWN[name], np.random.default_rng(1), 4)
    assert (count.first, count.wrong, count.consistent) == (4, 0, 0), count


@pytest.mark.parametrize("name", ["random readings", "half of the rows transposed"])
def test_an_unknown_mistake_gets_no_name(name):
    count = judge(UNKNOWN[name], np.random.default_rng(1), 4)
    assert (count.wrong, count.consistent) == (0, 0), count
    assert count.instead["none"] >= 3


def test_each_mistake_changes_the_poses_and_keeps_them_poses():
    rng = np.random.default_rng(2)
    for make in [make for _, make in {**KNOWN, **UNKNOWN}.values()]:
        truth, _, _ = draw(rng)
        made = make(truth, rng)
        assert made.R_WS.shape == truth.R_WS.shape
        np.testing.assert_allclose(
            made.R_WS @ made.R_WS.swapaxes(1, 2), np.broadcast_to(np.eye(3), made.R_WS.shape), atol=1e-9
        )
        assert not (np.allclose(made.R_WS, truth.R_WS) and np.allclose(made.wrenches, truth.wrenches))


def test_the_study_notices_a_check_that_names_a_wrong_cause(monkeypatch):
    right = mistakes.diagnose

    def wrong(*args, **options):
        found = right(*args, **options)
        return replace(found, odds={**found.odds, "fx_negated": 0.9}, consistent=True)

    monkeypatch.setattr(mistakes, "diagnose", wrong)
    count = judge(KNOWN["transposed"], np.random.default_rng(1), 2)
    assert (count.wrong, count.consistent) == (2, 2)


def test_the_command_judges_every_mistake(monkeypatch, benchmark):
    monkeypatch.setattr(mistakes, "KNOWN", {"transposed": KNOWN["transposed"]})
    monkeypatch.setattr(mistakes, "UNKNOWN", {"random readings": UNKNOWN["random readings"]})
    ran = benchmark("mistakes", "--trials", 2, "--json")
    assert ran.exit_code == 0, ran.stderr
    report = json.loads(ran.stdout)
    subjects = dict.fromkeys(figure["subject"] for figure in report["figures"])
    assert list(subjects) == ["no mistake", "transposed", "random readings"]
    assert report["passed"]

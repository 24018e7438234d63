"""The study of mistakes in short: what it makes is what it says, and its figures can fail."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks import mistakes
from benchmarks.mistakes import KNOWN, UNKNOWN, judge

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


def test_the_study_notices_a_check_that_names_a_wrong_cause(monkeypatch):
    right = mistakes.diagnose

    def wrong(*args, **options):
        found = right(*args, **options)
        return replace(found, odds={**found.odds, "fx_negated": 0.9}, consistent=True)

    monkeypatch.setattr(mistakes, "diagnose", wrong)
    count = judge(KNOWN["transposed"], np.random.default_rng(1), 2)
    assert (count.wrong, count.consistent) == (2, 2)

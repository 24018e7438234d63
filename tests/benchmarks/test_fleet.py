"""A small fleet: what was planted is found, and hardly anything else."""

import pytest
from benchmarks import fleet

pytest.importorskip("pyarrow")


def test_what_was_planted_is_found() -> None:
    figures = {each.name: each for each in fleet.run(sessions=2_000, folders=3).figures}
    assert figures["outliers found of those planted"].measured == 100
    assert figures["drifts found of those planted"].measured == 100
    assert figures["drifts told of none"].measured == 0
    assert figures["outliers told of all others"].measured < 0.1

"""Mutated bundles: a short run, and the set that other loaders are fed with."""

import json

import pytest
from benchmarks.bundle_fuzz import mutants, run

from contactbench.pipeline.errors import InputError


def test_every_mutant_is_refused_with_a_typed_error_or_is_what_it_was():
    report = run(300, seed=5)
    assert report.failures == ()
    assert report.refused > 240
    assert len(report.kinds) == 34
    assert report.refused + report.same + report.other == report.count == 300
    assert json.loads(json.dumps(report.to_json()))["passed"]


def test_the_same_seed_gives_the_same_mutants():
    assert list(mutants(20, 3)) == list(mutants(20, 3))
    assert list(mutants(20, 3)) != list(mutants(20, 4))
    with pytest.raises(InputError):
        run(0)

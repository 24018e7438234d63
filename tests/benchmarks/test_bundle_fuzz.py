"""Mutated bundles: a short run, and the set that other loaders are fed with."""

import pytest
from benchmarks.bundle_fuzz import mutants, run

from contactbench.pipeline.errors import InputError


def test_every_mutant_is_refused_with_a_typed_error_or_is_what_it_was():
    report = run(300, seed=5)
    tried, refused, same, other, _, wrong, *_ = (figure.measured for figure in report.figures)
    assert wrong == 0, report.notes
    assert refused > 240
    assert report.settings["kinds"] == 32
    assert refused + same + other == tried == 300


def test_the_same_seed_gives_the_same_mutants():
    assert list(mutants(20, 3)) == list(mutants(20, 3))
    assert list(mutants(20, 3)) != list(mutants(20, 4))
    with pytest.raises(InputError):
        run(0)

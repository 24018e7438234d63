"""Mutated bundles: a short run, and the set that other loaders are fed with."""

import json

import pytest

from pipeline.config.runtime import ConfigError, RuntimeConfig
from pipeline.errors import InputError
from pipeline.study.bundle_fuzz import mutants, run, write_mutants


def test_every_mutant_is_refused_with_a_typed_error_or_is_what_it_was():
    report = run(300, seed=5)
    assert report.failures == ()
    assert report.refused > 280
    assert len(report.kinds) == 23
    assert report.refused + report.same + report.other == report.count == 300
    assert json.loads(json.dumps(report.to_json()))["passed"]


def test_the_same_seed_gives_the_same_mutants():
    assert list(mutants(20, 3)) == list(mutants(20, 3))
    assert list(mutants(20, 3)) != list(mutants(20, 4))
    with pytest.raises(InputError):
        run(0)


def test_mutants_as_folders_behave_as_said(tmp_path):
    written = write_mutants(tmp_path / "set", 60, seed=1)
    folders = sorted(each for each in (tmp_path / "set").iterdir() if each.is_dir())
    assert 30 < written == len(folders) < 60
    for folder in folders:
        about = json.loads(folder.with_suffix(".json").read_text())
        try:
            RuntimeConfig.load(folder)
            outcome = "loaded"
        except ConfigError:
            outcome = "refused"
        assert outcome == about["python"]
        assert about["expected"] == "any" or outcome == "refused"

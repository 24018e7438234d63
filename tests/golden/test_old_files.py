"""A session and a bundle that an earlier build wrote are read; its results are computed again in test_commands."""

from __future__ import annotations

import zipfile

import pytest

from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.archive import import_archive
from contactbench.pipeline.session.check import check

from .conftest import OLD


@pytest.fixture
def folder(tmp_path):
    import_archive(OLD / "session.zip", tmp_path / "s")
    return tmp_path / "s"


def test_an_old_session_is_sound_and_nothing_in_it_is_stale(folder):
    assert check(folder).problems == ()
    with Session.open(folder) as session:
        assert not any(session.stale().values())


def test_an_old_bundle_is_read_and_written_alike():
    with zipfile.ZipFile(OLD / "bundle.zip") as bundle:
        files = {name: bundle.read(name) for name in bundle.namelist()}
    assert RuntimeConfig.from_files(files).encoded() == files

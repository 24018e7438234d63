import pytest

from contactbench.pipeline.session import Session


@pytest.fixture
def folder(tmp_path):
    Session.create(tmp_path / "s", by="ada").close()
    return tmp_path / "s"

import pytest

from contactbench.pipeline.session import Session
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.live import Live
from contactbench.pipeline.workbench.probe import ProbeWork


@pytest.fixture
def live():
    found = Live()
    yield found
    found.close()


@pytest.fixture
def desk(tmp_path):
    desk = Desk(Session.create(tmp_path / "s", by="ada"))
    yield desk
    desk.close()


@pytest.fixture
def work(desk):
    work = ProbeWork(desk)
    yield work
    work.close()

"""Opened again, also after a kill: the window is where it was, and what was done can be undone."""

from __future__ import annotations

import shutil

import pytest
from workbench.gravity_bench import batches, record
from workbench.touch_session import make_session

from contactbench.pipeline.session import Session
from contactbench.pipeline.session.check import check
from contactbench.pipeline.workbench.gravity_results import finish

from .failures import whole
from .test_failures_results import close, force, leave_out, plain, same, spread, use_devices

pytestmark = pytest.mark.usefixtures("qtbot")


@pytest.fixture(scope="module")
def calibrated(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made")
    (folder / "files").mkdir()
    return make_session(folder / "calibrated", folder / "files")


def prepared_for(what, calibrated, folder):
    if what is leave_out:
        with Session.create(folder) as session:
            record(session, "gravity-1.mcap", batches())
            finish(session, "gravity-1.mcap")
        return folder
    shutil.copytree(calibrated, folder)
    with Session.open(folder) as session:
        session.set_parameter("config.rate", 200.0)
    return folder


@pytest.mark.parametrize("what", [use_devices, spread, force, leave_out])
def test_undone_and_done_again_after_the_session_was_opened_again(qtbot, calibrated, tmp_path, what):
    folder = prepared_for(what, calibrated, tmp_path / "s")
    with whole(qtbot, tmp_path) as made:
        bench = made.open(folder)
        made.idle()
        assert not made.window.menus.undo.isEnabled()
        before = plain(bench)
        what(made)
        made.idle()
        after, text = plain(bench), bench.undo.undoText()
        assert after != before
        close(made)
    with whole(qtbot, tmp_path) as made:
        bench, menus = made.open(folder), made.window.menus
        made.idle()
        assert bench.undo.undoText() == text
        assert same(plain(bench), after)  # to have it there again changes nothing
        menus.undo.trigger()
        made.wait(lambda: same(plain(bench), before))
        assert not made.unexpected
        close(made)
    with whole(qtbot, tmp_path) as made:  # what was taken back can be done again
        bench, menus = made.open(folder), made.window.menus
        made.idle()
        assert not menus.undo.isEnabled()
        assert bench.undo.redoText() == text
        menus.redo.trigger()
        made.wait(lambda: same(plain(bench), after))
        assert not made.unexpected
        close(made)
    assert not check(folder).problems

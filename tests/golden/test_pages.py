"""What the six pages show of a session: every widget's class, name, text and whether it can be used."""

import zipfile

import pytest
from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from contactbench.app.window_pages import page_class
from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.archive import import_archive
from contactbench.pipeline.session.check import check
from contactbench.pipeline.steps import Step
from contactbench.widgets.scene import Scene

from ..app.page_window import PageWindow
from .conftest import OLD

_TEXTS = ("title", "text", "plainText", "currentText", "placeholderText", "toolTip")


# Takes all that a page tells its scene, and draws nothing.
_Paper = type(
    "Paper",
    (QWidget,),
    {
        name: given if isinstance(given, Signal) else lambda *_, **__: None
        for name, given in vars(Scene).items()
        if isinstance(given, Signal) or (callable(given) and not name.startswith("_"))
    },
)


def tree(widget, depth=0):
    """Return a widget and all in it, a line each."""
    told = [type(widget).__name__, widget.objectName(), widget.accessibleName()]
    told += [str(widget.property(name) or "") for name in _TEXTS]
    told += ["" if widget.isEnabledTo(widget.window()) else "disabled", "hidden" if widget.isHidden() else ""]
    lines = [f"{'  ' * depth}{' | '.join(' '.join(each.split()) for each in told if each)}"]
    for child in widget.children():
        if isinstance(child, QWidget):
            lines += tree(child, depth + 1)
    return lines


@pytest.mark.parametrize("step", Step)
def test_a_page_shows_what_it_showed(qtbot, pin, tmp_path, monkeypatch, step):
    monkeypatch.setenv("CONTACTBENCH_HOME", str(tmp_path / "home"))
    monkeypatch.setattr("contactbench.app.pages.devices.list_ports", list)
    import_archive(OLD / "session.zip", tmp_path / "s")
    with Session.open(tmp_path / "s") as session:
        window = PageWindow(qtbot, session, page_class(step), _Paper())
        window.enter()
        window.wait(lambda: not window.bench.jobs.running)
        window.page.tick()
        window.wait(lambda: not window.bench.jobs.running)
        lines = tree(window.page)
        window.close()
    pin(f"page-{step}", "\n".join(lines).replace(str(tmp_path), "FOLDER") + "\n")


# ---- A session and a bundle that an earlier build wrote are read ---------------------------------


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

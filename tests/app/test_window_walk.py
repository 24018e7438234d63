"""Every page of the real window, in both languages, at four sizes and two scales: nothing is cut, covered or moved."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import trimesh
from benchmarks.window.layout_faults import access_faults, layout_faults, pale
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QPalette
from PySide6.QtWidgets import (
    QButtonGroup,
    QLabel,
    QMainWindow,
    QPushButton,
    QScrollArea,
    QToolButton,
    QWidget,
)

from contactbench.app.window_docks import SMALLEST, first_size
from contactbench.pipeline.steps import Step
from contactbench.widgets.action_bar import ActionBar
from contactbench.widgets.theme import use_theme

from .conftest import beats, shown

LEAST = 4.5  # contrast, as WCAG 2.1 asks for
LONG_S = 500


@pytest.fixture(scope="module")
def made(sessions, tmp_path_factory):
    """A session that is verified, and a mesh to begin another probe with."""
    folder = tmp_path_factory.mktemp("walk")
    shutil.copytree(sessions / "verified", folder / "bench 1")
    trimesh.creation.icosphere(2, radius=50).export(folder / "ball.stl")
    return folder


@pytest.mark.timeout(LONG_S + 60)
@pytest.mark.parametrize(
    ("scale", "more"),
    [
        ("1", ["--languages", "de", "--sizes", "640x340"]),  # where there is least room
        pytest.param("1", ["--access"], marks=pytest.mark.window),
        pytest.param("2", [], marks=pytest.mark.window),
    ],
)
def test_every_page_is_whole_at_every_size(made, tmp_path, scale, more):
    here = Path(__file__).parent.parent
    command = [sys.executable, "-m", "benchmarks.window.walk", str(made / "bench 1"), str(made / "ball.stl")]
    surroundings = os.environ | {"QT_SCALE_FACTOR": scale, "CONTACTBENCH_HOME": str(tmp_path / "home")}
    done = subprocess.run(
        [*command, *more],
        cwd=here,
        env=surroundings,
        capture_output=True,
        text=True,
        timeout=LONG_S,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    found = json.loads(done.stdout)["found"]
    assert not found, "\n".join(f"{what} ({', '.join(where)})" for what, where in found.items())


def test_pages_without_anything_are_whole(qtbot, make_window, tmp_path):
    use_theme("light")
    window = make_window()
    window.resize(*SMALLEST)
    window.start.question.ask("What shall be done with it?", (("This", lambda: None), ("That", lambda: None)))
    assert lasting(qtbot, window) == []
    accented = [each.text() for each in window.start.findChildren(QPushButton) if each.property("primary")]
    assert accented == ["This"]
    shown(qtbot, window, lambda: window.sessions.new(tmp_path / "a session"))
    for step in Step:
        window.show_step(step)
        qtbot.waitUntil(lambda: not window.bench.jobs.running, timeout=60_000)
        assert lasting(qtbot, window) == [], step
        page = window.pages.current
        assert page.bar.primary.text(), step
        accented = [each for each in page.findChildren(QPushButton) if each.property("primary")]
        assert [each for each in accented if each.isVisible()] in ([], [page.bar.primary]), "one thing to do"


def lasting(qtbot, window):
    """Faults that are still there when everything has found its place."""
    for _ in range(20):
        beats(qtbot, window, 2)
        found = layout_faults(window)
        if not found:
            break
    return found


class Screen:
    def __init__(self, width, height):
        self._size = QSize(width, height)

    def availableSize(self):
        return self._size


@pytest.mark.parametrize("screen", [(1366, 768), (1920, 1080), (2560, 1440)])
@pytest.mark.parametrize("scale", [1.0, 1.25, 1.5, 2.0])
def test_the_first_window_lies_within_the_screen(screen, scale):
    room = [int(each / scale) for each in screen]

    class Somewhere:
        def screen(self):
            return Screen(*room)

    size = first_size(Somewhere()).toTuple()
    for given, there, least, frame in zip(size, room, SMALLEST, (4, 36), strict=True):
        assert least <= given <= there - frame
    assert size[0] >= min(1280, room[0] - 4), "as large as it is of use"


def test_the_foot_of_a_page_never_moves(qtbot):
    use_theme("light")
    bar = ActionBar()
    qtbot.addWidget(bar)
    bar.resize(320, bar.sizeHint().height())
    bar.show()
    qtbot.waitExposed(bar)
    bar.offer("Start", list)
    places = [each.geometry().translated(0, -bar.height()) for each in (bar.primary, bar.second)]
    bar.say("A sentence that is much longer than the two lines that there are for it. " * 4, bad=True)
    bar.offer("Computing with a much longer text than there is room", list, enabled=False)
    bar.offer_second("Something else that can be done now")
    assert [each.geometry().translated(0, -bar.height()) for each in (bar.primary, bar.second)] == places
    assert bar.height() == bar.sizeHint().height()
    bar.resize(320, 700)  # where there is room the remedy, which is last, is seen
    bar.say("A sentence that is longer than the two lines that there usually are for it. " * 3, bad=True)
    assert QLabel.text(bar._message).replace("\n", " ") == bar.words
    assert bar.primary.text() == "Computing with a much longer text than there is room"
    assert "\n" in QPushButton.text(bar.primary)
    pressed = []
    bar.offer("Go", lambda: pressed.append(1))
    bar.primary.click()
    assert pressed == [1]


def test_the_checks_find_what_they_are_for(qtbot):
    root = QMainWindow()
    qtbot.addWidget(root)
    inside = QWidget()
    root.setCentralWidget(inside)
    root.resize(300, 300)
    QPushButton("much too long for its width", inside).setGeometry(0, 0, 60, 36)
    QLabel("over it", inside).setGeometry(30, 10, 100, 30)
    QLabel("words that go on and on and that nobody can read", inside).setGeometry(0, 100, 90, 20)
    mouse_only = QToolButton(inside)
    mouse_only.setGeometry(0, 150, 30, 30)
    mouse_only.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    QPushButton("out", inside).setGeometry(280, 150, 60, 30)
    area = QScrollArea(inside)
    area.setGeometry(0, 200, 100, 60)
    wide = QWidget()
    wide.setMinimumWidth(300)
    area.setWidget(wide)
    grey = QLabel("hardly there", inside)
    grey.setGeometry(150, 200, 90, 20)
    colour = grey.palette()
    colour.setColor(QPalette.ColorRole.WindowText, colour.color(QPalette.ColorRole.Window).darker(110))
    grey.setPalette(colour)
    grey.setAutoFillBackground(True)
    root.show()
    qtbot.waitExposed(root)
    found = "\n".join((*layout_faults(root), *access_faults(root, inside), *pale(root)))
    for words in (
        "button is cut", "words are cut", "overlap", "has no name", "sideways", "reaches out", "by keys", "too pale"
    ):  # fmt: skip
        assert words in found, (words, found)


def test_buttons_that_exclude_each_other_need_one_stop(qtbot):
    root = QMainWindow()
    qtbot.addWidget(root)
    inside = QWidget()
    root.setCentralWidget(inside)
    group = QButtonGroup(inside)
    buttons = [QPushButton(name, inside, checkable=True) for name in ("one", "two")]
    for number, each in enumerate(buttons):
        group.addButton(each)
        each.setGeometry(0, 50 * number, 100, 40)
    buttons[1].setFocusPolicy(Qt.FocusPolicy.ClickFocus)
    root.show()
    qtbot.waitExposed(root)

    def missed():
        return [fault for fault in access_faults(root, inside) if "by keys" in fault]

    assert missed() == []
    buttons[0].setEnabled(False)  # the stop
    assert len(missed()) == 1
    buttons[0].setEnabled(True)
    group.setExclusive(False)
    assert len(missed()) == 1

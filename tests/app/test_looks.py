"""Everything that can be judged of the window's looks without eyes, at its usual size, in both themes."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtGui import QPalette
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractScrollArea,
    QAbstractSlider,
    QAbstractSpinBox,
    QCheckBox,
    QComboBox,
    QDockWidget,
    QLabel,
    QLineEdit,
    QListView,
    QMainWindow,
    QPushButton,
    QScrollArea,
    QScrollBar,
    QStackedWidget,
    QStyle,
    QStyleOptionButton,
    QStyleOptionComboBox,
    QTabBar,
    QToolButton,
    QWidget,
)
from workbench.region_sessions import make_session
from workbench.touch_session import ADDRESS, weighed

from contactbench.pipeline.calibration.files.calibration_file import save_calibration
from contactbench.pipeline.session import Session
from contactbench.pipeline.workbench.steps import Step
from contactbench.widgets.scene import Scene
from contactbench.widgets.theme import colours, contrast, use_theme

from .conftest import beats, shown

THEMES = ("light", "dark")
LONG = 60_000
CONTROLS = (QAbstractButton, QComboBox, QAbstractSpinBox, QLineEdit, QAbstractSlider, QListView)
LEAST = 4.5  # contrast, as WCAG 2.1 asks for


@pytest.fixture(scope="module")
def calibrated(tmp_path_factory):
    scratch = tmp_path_factory.mktemp("made")
    folder = make_session(scratch)
    save_calibration(weighed(), scratch / "calibration.json")
    content = {"calibration.json": (scratch / "calibration.json").read_bytes()}
    with Session.open(folder, by="ada") as session:
        for key in ("devices.sensor", "devices.poses"):
            session.set_parameter(key, ADDRESS)
        session.add_result("calibration", "calibration.json", content, {}, {})
    return folder


@pytest.fixture(params=("empty", "calibrated"))
def window(request, qtbot, make_window, tmp_path):
    """A window of the usual size with a session in it."""
    use_theme("light")  # as the application does: before there is a window
    made = make_window()
    made.resize(1280, 800)
    if request.param == "empty":
        shown(qtbot, made, lambda: made.sessions.new(tmp_path / "a session"))
    else:
        folder = request.getfixturevalue("calibrated")
        shown(qtbot, made, lambda: made.sessions.open(folder))
        qtbot.waitUntil(lambda: made.bench.connected, timeout=LONG)
    yield made
    use_theme("light")


@pytest.mark.parametrize("theme", THEMES)
def test_every_page_is_whole(qtbot, window, theme):
    use_theme(theme)
    complaints = []
    for step in Step:
        window.show_step(step)
        page = window.pages.current
        qtbot.waitUntil(lambda page=page: not window.bench.jobs.running and page.isVisible(), timeout=LONG)
        for tabs in [None, *range(_tabs(page).count() if _tabs(page) else 0)]:
            if tabs is not None:
                _tabs(page).setCurrentIndex(tabs)
            complaints += [f"{step}: {words}" for words in _lasting(qtbot, window)]
    assert (window.width(), window.height()) == (1280, 800), "a page asks for more room than there is"
    assert not complaints, "\n".join(sorted(set(complaints)))


@pytest.mark.parametrize("theme", THEMES)
def test_the_first_page_is_whole(qtbot, make_window, theme):
    use_theme(theme)
    window = make_window()
    window.resize(1280, 800)
    assert _lasting(qtbot, window) == []
    window.start.question.ask("What shall be done with it?", (("This", lambda: None), ("That", lambda: None)))
    assert _lasting(qtbot, window) == []
    accented = [each.text() for each in _seen(window, QPushButton) if each.property("primary")]
    assert accented == ["This"]
    use_theme("light")


@pytest.mark.parametrize("theme", THEMES)
def test_what_is_written_stands_out_from_what_it_is_written_on(theme):
    c = colours(theme == "dark")
    for ground in (c.panel, c.background):
        for name in ("text", "muted", "accent", "good", "warning", "bad", "stale"):
            assert contrast(getattr(c, name), ground) >= LEAST, (name, ground)
    assert contrast(c.panel, c.accent) >= LEAST  # on the primary button
    for ground in (c.panel,):  # lines are told by their shape, too: 3:1 is what signs need
        assert all(contrast(line, ground) >= 2.0 for line in c.series)


def test_the_checks_find_what_they_are_for(qtbot):
    root = QMainWindow()
    qtbot.addWidget(root)
    inside = QWidget()
    root.setCentralWidget(inside)
    root.resize(300, 300)
    cut = QPushButton("much too long for its width", inside)
    cut.setGeometry(0, 0, 60, 36)
    QLabel("over it", inside).setGeometry(30, 10, 100, 30)
    QLabel("words that go on and on and that nobody can read", inside).setGeometry(0, 100, 90, 20)
    QToolButton(inside).setGeometry(0, 150, 30, 30)
    area = QScrollArea(inside)
    area.setGeometry(0, 200, 100, 60)
    wide = QWidget()
    wide.setMinimumWidth(300)
    area.setWidget(wide)
    root.show()
    qtbot.waitExposed(root)
    found = "\n".join(_faults(root))
    for words in ("button is cut", "words are cut", "overlap", "has no name", "sideways"):
        assert words in found, found


def _tabs(page):
    return getattr(page, "tabs", None)


# ---- what is looked for --------------------------------------------------------------------------------


def _lasting(qtbot, window):
    """Faults that are still there when everything has found its place."""
    for _ in range(100):
        beats(qtbot, window)
        found = _faults(window)
        if not found:
            break
    return found


def _faults(window: QWidget) -> list[str]:
    return [
        *_cut(window),
        *_sideways(window),
        *_overlaps(window),
        *_nameless(window),
        *_out_of_reach(window),
        *_pale(window),
    ]


def _seen(window, kind):
    """Visible widgets of a kind, without the insides of other controls and of the 3D view."""
    return [each for each in window.findChildren(kind) if each.isVisibleTo(window) and not _inside(each)]


def _inside(widget):
    parent = widget.parentWidget()
    while parent is not None:
        if isinstance(parent, (QComboBox, QAbstractSpinBox, QTabBar)):
            return True
        parent = parent.parentWidget()
    return isinstance(widget, QScrollBar) or widget.objectName().startswith("qt_")


def _what(widget):
    text = widget.text() if hasattr(widget, "text") else ""
    return f"{type(widget).__name__} {text or widget.accessibleName() or widget.objectName()!r}"


def _cut(window):
    for button in _seen(window, QAbstractButton):
        if not button.text() or not isinstance(button, (QPushButton, QToolButton, QCheckBox)):
            continue
        only_icon = isinstance(button, QToolButton) and not button.icon().isNull()
        if only_icon and button.toolButtonStyle() is Qt.ToolButtonStyle.ToolButtonIconOnly:
            continue
        if button.fontMetrics().size(Qt.TextFlag.TextShowMnemonic, button.text()).width() > _room(button):
            yield f"a button is cut: {_what(button)}"
    for label in _seen(window, QLabel):
        if label.text() and not _fits(label):
            yield f"words are cut: {_what(label)[:80]} ({label.width()} x {label.height()})"
    for box in _seen(window, QComboBox):
        option = QStyleOptionComboBox()
        box.initStyleOption(option)
        field = box.style().subControlRect(
            QStyle.ComplexControl.CC_ComboBox, option, QStyle.SubControl.SC_ComboBoxEditField, box
        )
        if box.fontMetrics().horizontalAdvance(box.currentText()) > field.width():
            yield f"a choice is cut: {box.currentText()}"
    for spin in _seen(window, QAbstractSpinBox):
        if spin.fontMetrics().horizontalAdvance(spin.text()) > spin.lineEdit().width() - 4:
            yield f"a number is cut: {spin.text()}"


def _room(button):
    if isinstance(button, QPushButton):
        option = QStyleOptionButton()
        button.initStyleOption(option)
        inner = button.style().subElementRect(QStyle.SubElement.SE_PushButtonContents, option, button)
        used = 0 if button.icon().isNull() else button.iconSize().width() + 4
        return min(inner.width(), button.width() - 4) - used
    if isinstance(button, QCheckBox):
        return button.width() - 18
    return button.width()


def _fits(label):
    room = label.contentsRect()
    if label.wordWrap() or "<" in label.text():
        needed = label.heightForWidth(label.width()) if label.wordWrap() else label.sizeHint().height()
        return needed <= label.height() + 2 and (
            label.wordWrap() or label.sizeHint().width() <= label.width() + 4
        )
    size = label.fontMetrics().size(0, label.text())
    return size.width() <= room.width() + 1 and size.height() <= room.height() + 2


def _sideways(window):
    for area in _seen(window, QAbstractScrollArea):
        bar = area.horizontalScrollBar()
        wide = (
            isinstance(area, QScrollArea)
            and area.widget()
            and area.widget().width() > area.viewport().width()
        )
        if bar.isVisibleTo(window) or wide:
            yield f"scrolls sideways: {_what(area)}"


def _overlaps(window):
    parents = [window, *window.findChildren(QWidget)]
    for parent in parents:
        if (
            isinstance(parent, (Scene, QStackedWidget, QMainWindow))
            or not parent.isVisibleTo(window)
            or _inside(parent)
        ):
            continue
        children = [
            each
            for each in parent.children()
            if isinstance(each, QWidget) and each.isVisibleTo(window) and not each.isWindow() and _drawn(each)
        ]
        for number, one in enumerate(children):
            for other in children[:number]:
                common = one.geometry() & other.geometry()
                if common.width() > 2 and common.height() > 2:
                    yield f"overlap: {_what(one)[:60]} and {_what(other)[:60]}"


def _drawn(widget):
    see_through = widget.testAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
    return not see_through and isinstance(widget, (*CONTROLS, QLabel, QAbstractScrollArea))


def _nameless(window):
    for control in _seen(window, QWidget):
        if isinstance(control, CONTROLS) and control.isEnabled() and not _named(control):
            yield f"has no name: {type(control).__name__} {control.objectName()} in {type(control.parent()).__name__}"


def _named(control):
    if control.accessibleName() or (isinstance(control, QAbstractButton) and control.text()):
        return True
    labels = control.parentWidget().findChildren(QLabel) if control.parentWidget() else []
    return any(label.buddy() is control for label in labels)


def _out_of_reach(window):
    """Controls that the tabulator key never comes to."""
    chain, at = set(), window
    while at not in chain:
        chain.add(at)
        at = at.nextInFocusChain()
    for control in _seen(window, QWidget):
        if not isinstance(control, CONTROLS) or not control.isEnabled() or isinstance(control, QListView):
            continue
        if isinstance(control.parentWidget(), QDockWidget) or _in_dock_title(control):
            continue
        alone = not isinstance(control, QToolButton)  # what a tool bar holds can be reached in the menus
        if control not in chain or (alone and not control.focusPolicy() & Qt.FocusPolicy.TabFocus):
            yield f"cannot be reached by keys: {_what(control)}"


def _in_dock_title(control):
    return isinstance(control.parent(), QDockWidget)


def _pale(window):
    """Words whose colour hardly differs from the ground that they stand on, as painted."""
    for label in _seen(window, QLabel):
        words = label.palette().color(QPalette.ColorRole.WindowText).name()
        top = label.mapTo(window, QPoint(0, 0))
        if not label.text() or not window.rect().contains(QRect(top, label.size())) or "<" in label.text():
            continue
        picture = label.grab().toImage()
        ground = picture.pixelColor(0, 0).name()
        if label.isEnabled() and picture.pixelColor(0, 0).alpha() == 255 and contrast(words, ground) < LEAST:
            yield f"too pale: {_what(label)[:60]} {words} on {ground}"

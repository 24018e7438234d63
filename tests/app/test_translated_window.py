"""The real window, small, in every language: no word is cut."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QCoreApplication, QPoint, Qt, QTranslator
from PySide6.QtWidgets import (
    QAbstractButton,
    QCheckBox,
    QComboBox,
    QLabel,
    QPushButton,
    QRadioButton,
    QScrollArea,
    QTabBar,
    QToolButton,
    QWidget,
)

from contactbench.app import translation
from contactbench.pipeline.workbench.steps import Step

from .conftest import beats, shown

_AROUND_PX = {QCheckBox: 24, QRadioButton: 24, QComboBox: 26}


@pytest.fixture
def spoken(qapp):
    """Have the application speak a language until the test ends."""
    before = _translators(qapp)
    yield lambda code: translation.load(qapp, code)
    for each in _translators(qapp):
        if each not in before:
            QCoreApplication.removeTranslator(each)
    translation.load(qapp, "en")


def _translators(application):
    return [each for each in application.children() if isinstance(each, QTranslator)]


@pytest.mark.parametrize("language", translation.LANGUAGES)
def test_no_word_is_cut_at_the_smallest_size(qtbot, make_window, spoken, tmp_path, language):
    assert spoken(language) == language
    window = make_window()
    window.resize(1280, 800)
    shown(qtbot, window, lambda: window.sessions.try_virtual(tmp_path / "virtual bench"))
    found = []
    for step in Step:
        window.show_step(step)
        qtbot.waitUntil(lambda step=step: window.pages.step is step)
        for _ in _tabs(window.pages.current):
            found += [f"{step}: {each}" for each in _still_cut(qtbot, window)]
    assert found == [], "\n".join(found)


def test_what_is_cut_is_found(qtbot):
    area = QScrollArea(widgetResizable=False)
    qtbot.addWidget(area)
    inside = QWidget()
    for text, x, wide in (("A button", 0, 20), ("Fits", 0, 90), ("Far to the right", 250, 200)):
        button = QPushButton(text, inside)
        button.setGeometry(x, 0, wide, 30)
    QLabel("many words that need many lines", inside, wordWrap=True).setGeometry(0, 40, 60, 20)
    inside.resize(500, 100)
    area.setWidget(inside)
    area.resize(300, 200)
    area.show()
    qtbot.waitExposed(area)
    assert [each.partition("'")[2].partition("'")[0] for each in cut(area)] == [
        "A button",
        "Far to the right",
        "many words that need many lines",
    ]


def _still_cut(qtbot, window):
    """Return what is cut once the page is laid out and filled: both take a moment."""
    for _ in range(100):
        beats(qtbot, window)
        if not (found := list(cut(window))):
            break
    return found


def _tabs(page):
    """Show every tab of a page, one after the other; once where there are none."""
    bars = page.findChildren(QTabBar)
    yield 0
    for bar in bars:
        for index in range(1, bar.count()):
            bar.setCurrentIndex(index)
            yield index


def cut(window):
    """Return what is seen and does not fit: a text wider than its control, or a control wider than the page."""
    for each in (
        window.findChildren(QAbstractButton) + window.findChildren(QLabel) + window.findChildren(QComboBox)
    ):
        text = each.currentText() if isinstance(each, QComboBox) else each.text()
        if not text or _only_icon(each) or not each.isVisible():
            continue
        if _needs(each, text) > each.width() or _beside(each):
            yield f"{type(each).__name__} {text!r} ({each.width()} px wide)"
        elif (
            isinstance(each, QLabel)
            and each.wordWrap()
            and each.heightForWidth(each.width()) > each.height() + 1
        ):
            yield f"{type(each).__name__} {text!r} ({each.height()} px high)"


def _only_icon(widget):
    style = Qt.ToolButtonStyle.ToolButtonIconOnly
    return (
        isinstance(widget, QToolButton) and widget.toolButtonStyle() == style and not widget.icon().isNull()
    )


def _needs(widget, text):
    """Return how many px a text and what stands beside it are wide."""
    if isinstance(widget, QLabel) and (widget.wordWrap() or "<" in text):
        return 0
    plain = text.replace("&", "")
    wide = max(widget.fontMetrics().horizontalAdvance(line) for line in plain.split("\n"))
    if isinstance(widget, QAbstractButton) and not widget.icon().isNull():
        wide += widget.iconSize().width() + 4
    return wide + next((px for kind, px in _AROUND_PX.items() if isinstance(widget, kind)), 0)


def _beside(widget):
    """Return whether a part of a control lies beside what its scroll area shows; below is what scrolling is for."""
    area = widget.parent()
    while area is not None and not isinstance(area, QScrollArea):
        area = area.parent()
    if area is None or area.widget() is None or not area.widget().isAncestorOf(widget):
        return False
    left = widget.mapTo(area.viewport(), QPoint(0, 0)).x()
    return left < 0 or left + widget.width() > area.viewport().width()

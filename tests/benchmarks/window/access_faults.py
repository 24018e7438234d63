"""What those miss in a window who cannot see, point, or tell colours apart; nothing where all is well."""

from __future__ import annotations

from itertools import chain, pairwise

from benchmarks.window.layout_faults import CONTROLS, VisibleWidgets, what
from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtGui import QAccessible, QPalette
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QDockWidget,
    QLabel,
    QScrollArea,
    QToolBar,
    QToolButton,
    QWidget,
)

from contactbench.widgets.theme import contrast

LEAST = 4.5  # contrast, as WCAG 2.1 asks for
_LINE_PX = 12  # what lies in one line


def access_faults(window: QWidget, page: QWidget) -> list[str]:
    """Return what has no name, cannot be reached by keys or in an odd order, or does not show the focus."""
    seen = VisibleWidgets(window)
    return list(chain(_nameless(seen), _out_of_reach(seen), _disordered(page), _unseen_focus(page)))


def _nameless(seen: VisibleWidgets):
    """Controls that a screen reader has no word for, as Qt gives them to it."""
    for control in seen.of(*CONTROLS):
        if not control.isEnabled():
            continue
        interface = QAccessible.queryAccessibleInterface(control)
        if interface is None or not interface.text(QAccessible.Text.Name).strip():
            yield f"has no name: {what(control)} in {type(control.parent()).__name__}"
        elif interface.role() in (QAccessible.Role.NoRole, QAccessible.Role.Client):
            yield f"has no role: {what(control)}"
        if isinstance(control, QToolButton) and not control.text() and not control.toolTip():
            yield f"an icon without words: {what(control)}"


def _chain(window: QWidget) -> list[QWidget]:
    found, at = [], window
    while True:
        found.append(at)
        at = at.nextInFocusChain()
        if at is window:
            return found


def _out_of_reach(seen: VisibleWidgets):
    """Controls that the tabulator key never comes to."""
    order = set(_chain(seen.window))
    for control in seen.of(*CONTROLS):
        if not control.isEnabled() or isinstance(control.parentWidget(), (QDockWidget, QToolBar)):
            continue  # what these hold is in the menus
        if not any(
            each in order and each.focusPolicy() & Qt.FocusPolicy.TabFocus for each in _together(control)
        ):
            yield f"cannot be reached by keys: {what(control)}"


def _together(control: QWidget) -> list[QWidget]:
    """Return what can be reached from one another by arrows: of buttons that exclude each other one is a stop."""
    group = control.group() if isinstance(control, QAbstractButton) else None
    members = group.buttons() if group is not None and group.exclusive() else []
    return [control, *(each for each in members if each.isEnabled() and each.isVisible())]


def _stops(page: QWidget) -> list[QWidget]:
    """Return where the tabulator key stops on a page, in its order."""
    return [
        each
        for each in _chain(page.window())
        if page.isAncestorOf(each)
        and each.focusPolicy() & Qt.FocusPolicy.TabFocus
        and each.isEnabled()
        and each.isVisibleTo(page)
        and each.focusProxy() is None
    ]


def _disordered(page: QWidget):
    """Places where the tabulator key goes up, or back in a line."""
    at = {each: each.mapTo(page, QPoint(0, 0)) for each in _stops(page)}
    for one, other in pairwise(at):
        up = at[other].y() < at[one].y() - _LINE_PX
        back = abs(at[other].y() - at[one].y()) <= _LINE_PX and at[other].x() < at[one].x()
        if (up or back) and _scrolled(one) is _scrolled(other):  # else they move against each other
            yield f"the tabulator key goes back: from {what(one)} to {what(other)}"


def _scrolled(widget: QWidget) -> QWidget | None:
    parent = widget.parentWidget()
    while parent is not None and not isinstance(parent, QScrollArea):
        parent = parent.parentWidget()
    return parent


def _unseen_focus(page: QWidget):
    """Controls that look the same with the focus and without; one of each kind."""
    before = QApplication.focusWidget()
    kinds = {
        (type(each), bool(each.property("primary"))): each
        for each in _stops(page)
        if isinstance(each, CONTROLS)
    }
    for control in kinds.values():
        page.window().setFocus()
        plain = control.grab().toImage()
        control.setFocus(Qt.FocusReason.TabFocusReason)
        if control.hasFocus() and control.grab().toImage() == plain:
            yield f"does not show the focus: {what(control)}"
    if before is not None:
        before.setFocus()


def pale(window: QWidget):
    """Return words whose colour hardly differs from the ground that they stand on, as painted."""
    seen = VisibleWidgets(window)
    for each in seen.of(QLabel, QAbstractButton):
        role = QPalette.ColorRole.WindowText if isinstance(each, QLabel) else QPalette.ColorRole.ButtonText
        words, top = each.palette().color(role).name(), each.mapTo(seen.window, QPoint(0, 0))
        shown = seen.window.rect().contains(QRect(top, each.size())) and each.isVisible()
        if not each.text() or not shown or not each.isEnabled() or "<" in each.text():
            continue
        picture = each.grab().toImage()
        place = (10, 6) if isinstance(each, QAbstractButton) else (0, 0)
        ground = picture.pixelColor(*place)
        if ground.alpha() == 255 and contrast(words, ground.name()) < LEAST:
            yield f"too pale: {what(each)} {words} on {ground.name()}"

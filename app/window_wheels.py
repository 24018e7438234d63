"""The mouse wheel scrolls a page; it changes a number only where that was clicked before."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtWidgets import QAbstractSlider, QAbstractSpinBox, QComboBox, QScrollBar, QWidget

_KINDS = (QAbstractSpinBox, QComboBox, QAbstractSlider)


class _Guard(QObject):
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Wheel and isinstance(watched, QWidget) and not watched.hasFocus():
            event.ignore()  # it goes to what is behind: the scroll area
            return True
        return False


def guard_wheels(root: QWidget) -> None:
    """Let the wheel change no value in `root` that does not have the focus; a second time does nothing more."""
    guard = root.findChild(_Guard, options=Qt.FindChildOption.FindDirectChildrenOnly) or _Guard(root)
    for kind in _KINDS:
        for widget in root.findChildren(kind):
            if not isinstance(widget, QScrollBar):
                widget.setFocusPolicy(
                    Qt.FocusPolicy.StrongFocus
                )  # the usual one takes the focus by the wheel
                widget.installEventFilter(guard)

"""What is wrong with the session, on top of the page that rests on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QBoxLayout, QFrame, QHBoxLayout

from contactbench.pipeline.steps import StepState
from contactbench.widgets.controls import sentence_label
from contactbench.widgets.icons import Sign, state_icon
from contactbench.widgets.messages import translated

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget

    from contactbench.pipeline.steps import StepStatus

_ICON_PX = 22


class TroubleNotice(QFrame):
    """A sign and a sentence: the same sentence that the list of steps and the export have."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("trouble")
        self.setProperty("role", "card")
        self._sign, self.words = Sign(_ICON_PX), sentence_label(role="bad")
        self._sign.show_icon(state_icon(StepState.FAILED))
        layout = QHBoxLayout(self)
        layout.addWidget(self._sign, 0, Qt.AlignmentFlag.AlignTop)
        layout.addWidget(self.words, 1)
        self.hide()

    def say(self, sentence: str) -> None:
        """Show a sentence; empty: nothing is wrong."""
        if sentence != self.words.text():
            self.words.setText(sentence)
            self.setAccessibleName(sentence)
        self.setVisible(bool(sentence))


def show_trouble(page: QWidget, status: StepStatus) -> None:
    """Have a page say what is wrong with what it rests on, while something is."""
    notice = page.findChild(TroubleNotice, "trouble", Qt.FindChildOption.FindDirectChildrenOnly)
    layout = page.layout()
    if notice is None:
        if not status.broken or not isinstance(layout, QBoxLayout):
            return
        notice = TroubleNotice(page)
        layout.insertWidget(0, notice)
    notice.say(translated(status.sentence) if status.broken else "")

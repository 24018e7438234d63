"""A list of what is done, stale or missing, each with what to do and a way there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QPushButton, QSizePolicy, QWidget

from contactbench.widgets.icons import Sign, icon
from contactbench.widgets.phrases import said

if TYPE_CHECKING:
    from collections.abc import Sequence

_ICONS = {
    "done": ("done", "good"),
    "stale": ("stale", "stale"),
    "missing": ("ready", "warning"),
    "failed": ("failed", "bad"),
    "left out": ("remove", "muted"),
}
_ICON = 22


@dataclass(frozen=True)
class ShownCheck:
    """
    A line.

    Attributes
    ----------
    name : str
    state : {"done", "stale", "missing", "failed", "left out"}
    sentence : str
    target : object
        What `wanted` hands on.
    holds : bool
        Nothing has to be done about it.
    """

    name: str
    state: str
    sentence: str
    target: object
    holds: bool


class Checklist(QFrame):
    """Shows lines; each can be gone to."""

    wanted = Signal(object)  # target of the line

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setHorizontalSpacing(8)
        self._grid.setVerticalSpacing(8)
        self._grid.setColumnStretch(1, 1)
        self._shown: tuple[ShownCheck, ...] = ()

    def show_items(self, items: Sequence[ShownCheck]) -> None:
        """Show other lines."""
        if tuple(items) == self._shown:
            return
        self._shown = tuple(items)
        while (item := self._grid.takeAt(0)) is not None:
            widget = item.widget()
            if widget is not None:
                widget.hide()
                widget.deleteLater()
        for row, each in enumerate(self._shown):
            self._line(row, each)

    def _line(self, row: int, item: ShownCheck) -> None:
        sign = Sign(_ICON)
        sign.show_icon(icon(*_ICONS[item.state]))
        sign.setAccessibleName(self.word(item.state))
        self._grid.addWidget(sign, row, 0, Qt.AlignmentFlag.AlignTop)
        words = QLabel(f"<b>{item.name}</b> · {self.word(item.state)}<br>{_plain(said(item.sentence))}")
        words.setTextFormat(Qt.TextFormat.RichText)
        words.setWordWrap(True)
        words.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Minimum)
        self._grid.addWidget(words, row, 1)
        if not item.holds:
            go = QPushButton(self.tr("Go there"))
            go.setMinimumHeight(36)
            go.setAccessibleName(self.tr("Go to {name}").format(name=item.name))
            go.clicked.connect(lambda _=False, target=item.target: self.wanted.emit(target))
            self._grid.addWidget(go, row, 2, Qt.AlignmentFlag.AlignTop)

    def word(self, state: str) -> str:
        """Return a state in a word."""
        return {
            "done": self.tr("done"),
            "stale": self.tr("stale"),
            "missing": self.tr("missing"),
            "failed": self.tr("not passed"),
            "left out": self.tr("left out"),
        }[state]


def _plain(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")

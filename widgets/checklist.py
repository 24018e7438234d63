"""A list of what is done, stale or missing, each with what to do and a way there."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QPushButton, QSizePolicy, QWidget

from contactbench.widgets.messages import translated
from contactbench.widgets.theme import Sign, icon

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.session.why import CheckItem

_ICONS = {
    "done": ("done", "good"),
    "stale": ("stale", "stale"),
    "missing": ("ready", "warning"),
    "failed": ("failed", "bad"),
    "left out": ("remove", "muted"),
}
_ICON = 22


class Checklist(QFrame):
    """Shows lines; each can be gone to."""

    wanted = Signal(object)  # Step of the line

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setHorizontalSpacing(8)
        self._grid.setVerticalSpacing(8)
        self._grid.setColumnStretch(1, 1)
        self._shown: tuple[CheckItem, ...] = ()

    def show_items(self, items: Sequence[CheckItem]) -> None:
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

    def _line(self, row: int, item: CheckItem) -> None:
        sign = Sign(_ICON)
        sign.show_icon(icon(*_ICONS[item.state]))
        sign.setAccessibleName(self.word(item.state))
        self._grid.addWidget(sign, row, 0, Qt.AlignmentFlag.AlignTop)
        name = self.name_of(item)
        words = QLabel(f"<b>{name}</b> · {self.word(item.state)}<br>{_plain(translated(item.sentence))}")
        words.setTextFormat(Qt.TextFormat.RichText)
        words.setWordWrap(True)
        words.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Minimum)
        self._grid.addWidget(words, row, 1)
        if not item.holds:
            go = QPushButton(self.tr("Open step"))
            go.setMinimumHeight(36)
            go.setAccessibleName(self.tr("Open {name}").format(name=name))
            go.clicked.connect(lambda _=False, step=item.step: self.wanted.emit(step))
            self._grid.addWidget(go, row, 2, Qt.AlignmentFlag.AlignTop)

    def name_of(self, item: CheckItem) -> str:
        """Return what a line is called."""
        return {
            "Sensor": self.tr("Sensor"),
            "Calibration": self.tr("Calibration"),
            "Probe": self.tr("Probe"),
            "Regions": self.tr("Regions"),
            "Verification": self.tr("Verification"),
            "Known weight": self.tr("Known weight"),
            "Known touch": self.tr("Known touch"),
            "Report": self.tr("Report"),
        }.get(item.name, item.name)

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

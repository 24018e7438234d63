"""The cheat sheet: the keys that really are in the window, and what tables, charts and the scene take themselves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHeaderView,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
)

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget


@dataclass(frozen=True)
class Key:
    """What a key does, for people."""

    keys: str
    words: str


def keys_of(window: QWidget) -> tuple[Key, ...]:
    """Return every key of a window: of its actions, and of shortcuts that say what they do (`whatsThis`)."""
    found: dict[str, str] = {}
    # The window's own first, then those of pages, which hold only there.
    for action in sorted(window.findChildren(QAction), key=lambda each: each.parent() is not window):
        words = action.text().replace("&", "").rstrip("…")
        keys = [key.toString(QKeySequence.SequenceFormat.NativeText) for key in action.shortcuts()]
        if keys and words:
            found.setdefault(", ".join(keys), words)
    for shortcut in window.findChildren(QShortcut):
        keys_text = shortcut.key().toString(QKeySequence.SequenceFormat.NativeText)
        if shortcut.whatsThis() and keys_text:
            found.setdefault(keys_text, shortcut.whatsThis())
    return tuple(Key(keys, words) for keys, words in found.items())


class CheatSheet(QDialog):
    """A table of keys; goes when it is closed."""

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(self.tr("Shortcuts"))
        keys = (*keys_of(window), *self._handled())
        self.table = QTableWidget(len(keys), 2)
        self.table.setHorizontalHeaderLabels([self.tr("Key"), self.tr("What it does")])
        self.table.verticalHeader().hide()
        self.table.setShowGrid(False)
        self.table.setSelectionMode(QTableWidget.SelectionMode.NoSelection)
        self.table.horizontalHeader().setDefaultAlignment(
            Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        )
        self.table.setEditTriggers(QTableWidget.EditTrigger.NoEditTriggers)
        self.table.setAccessibleName(self.tr("Shortcuts"))
        for row, key in enumerate(keys):
            self.table.setItem(row, 0, QTableWidgetItem(key.keys))
            self.table.setItem(row, 1, QTableWidgetItem(key.words))
        self.table.horizontalHeader().setSectionResizeMode(0, QHeaderView.ResizeMode.ResizeToContents)
        self.table.horizontalHeader().setStretchLastSection(True)
        buttons = QDialogButtonBox()
        buttons.addButton(self.tr("Close"), QDialogButtonBox.ButtonRole.RejectRole)
        buttons.rejected.connect(self.close)
        layout = QVBoxLayout(self)
        layout.addWidget(self.table, 1)
        layout.addWidget(buttons)
        self.resize(560, 620)

    def _handled(self) -> tuple[Key, ...]:
        """Return what widgets take themselves where they have the focus or the pointer; no action stands for it."""
        return (
            Key(self.tr("Delete"), self.tr("Leave out the selected poses; remove the selected markers")),
            Key(self.tr("Return"), self.tr("Take the selected poses back")),
            Key(
                self.tr("Arrow keys"),
                self.tr("Choose a point of the chart of facets; move a handle of a range"),
            ),
            Key(self.tr("Left or right button, dragged"), self.tr("Turn the view")),
            Key(self.tr("Middle button, dragged"), self.tr("Move the view")),
            Key(self.tr("Wheel"), self.tr("Nearer or farther")),
            Key(self.tr("Ctrl and wheel"), self.tr("Larger or smaller brush")),
            Key(self.tr("Shift, held"), self.tr("The brush erases, the eraser paints")),
            Key(self.tr("P"), self.tr("Play or pause (heatmap viewer)")),
            Key(self.tr("Ctrl+S"), self.tr("Save a picture (heatmap viewer)")),
        )

"""The list of messages: plain sentences, newest first, with what is behind them on demand."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime

from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtGui import (
    QColor,
    QGuiApplication,
    QKeySequence,
    QPainter,
    QPaintEvent,
    QResizeEvent,
    QShortcut,
)
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHBoxLayout,
    QListWidget,
    QListWidgetItem,
    QPlainTextEdit,
    QSizePolicy,
    QSplitter,
    QToolButton,
    QWidget,
)

from contactbench.pipeline.errors import message
from contactbench.widgets.controls import beside, called, choice, column, tool_button
from contactbench.widgets.messages import time_of_day, translated
from contactbench.widgets.theme import colours, icon, is_dark

_KEPT_MESSAGES = 500
_NEWEST = 6  # a device that comes and goes tells a few things in turn
# Weight -> icon, colour of the theme; word.
_ICONS = {
    "info": ("info", "muted"),
    "good": ("done", "good"),
    "warning": ("warning", "warning"),
    "error": ("failed", "bad"),
}
_WORDS = {
    "info": message("Note"),
    "good": message("Good"),
    "warning": message("Warning"),
    "error": message("Error"),
}
_RANK = {"info": 0, "good": 0, "warning": 1, "error": 2}
_ROW = Qt.ItemDataRole.UserRole


@dataclass
class _Told:
    weight: str
    text: str
    details: str
    at: datetime
    times: int = 1


class _List(QListWidget):
    """A list that says something while it is empty."""

    def __init__(self, words: str) -> None:
        super().__init__()
        self._words = words

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        if not self.count():
            painter = QPainter(self.viewport())
            painter.setPen(QColor(colours(is_dark()).muted))
            inside = self.viewport().rect().adjusted(8, 4, -8, -4)
            painter.drawText(inside, Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, self._words)
            painter.end()


class NewestMessage(QToolButton):
    """
    The newest message that matters, in one line that never grows; a press shows the list.

    Parameters
    ----------
    show_list : callable
    """

    def __init__(self, show_list: Callable[[], None]) -> None:
        super().__init__()
        self._words = self._weight = ""
        self.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName(self.tr("Newest message"))
        self.setStyleSheet("padding: 0px 4px; min-height: 20px;")  # the status bar is as low as it is
        self.clicked.connect(lambda _=False: self.forget(show_list))
        kept = self.sizePolicy()
        kept.setRetainSizeWhenHidden(True)
        self.setSizePolicy(kept)
        self.hide()

    def show_message(self, weight: str, text: str) -> None:
        """Show a message instead of the one before."""
        self._words, self._weight = translated(text), weight
        self.setToolTip(self._words)
        self.setAccessibleDescription(self._words)
        self.setIcon(icon(*_ICONS[weight]))
        self.show()
        self._elide()

    def forget_if(self, text: str) -> None:
        """Show a message no longer."""
        if translated(text) == self._words:
            self.forget()

    def forget(self, then: Callable[[], None] | None = None) -> None:
        """Show none any more: it was read."""
        self.hide()
        if then is not None:
            then()

    def minimumSizeHint(self) -> QSize:
        """Return the room for its icon."""
        return QSize(40, super().minimumSizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Show what fits."""
        super().resizeEvent(event)
        self._elide()

    def changeEvent(self, event: QEvent) -> None:
        """Take the colours of another theme."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and self._weight:
            self.setIcon(icon(*_ICONS[self._weight]))

    def _elide(self) -> None:
        room = self.width() - self.iconSize().width() - 20
        self.setText(self.fontMetrics().elidedText(self._words, Qt.TextElideMode.ElideRight, room))


class MessageList(QWidget):
    """Messages of the weights "info", "good", "warning" and "error"; the oldest of more than 500 go."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._numbers: Counter[str] = Counter()
        self._list = _List(self.tr("No messages."))
        self._list.setWordWrap(True)
        self.setFocusProxy(self._list)
        self._list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._list.setResizeMode(QListWidget.ResizeMode.Adjust)
        self._list.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self._list.setAccessibleName(self.tr("Messages"))
        self._list.itemSelectionChanged.connect(self._show_details)
        self._details = called(QPlainTextEdit(readOnly=True), self.tr("Message details"))
        self._details.hide()
        both = QSplitter(Qt.Orientation.Horizontal)
        both.addWidget(self._list)
        both.addWidget(self._details)
        column(self, self._controls(), (both, 1), margins=(6, 4, 6, 4), space=-1)
        shortcut = QShortcut(QKeySequence(QKeySequence.StandardKey.Copy), self._list)
        shortcut.setContext(Qt.ShortcutContext.WidgetShortcut)
        shortcut.setWhatsThis(self.tr("Copy selected messages"))
        shortcut.activated.connect(self.copy)
        self._count()

    def _controls(self) -> QHBoxLayout:
        tip = self.tr("Filter: all messages, warnings and errors, or errors only")
        self._filter = choice(((each, None) for each in self._words()), self.tr("Message filter"), tip=tip)
        self._filter.currentIndexChanged.connect(self._sift)
        tip = self.tr("Show details of the selected message")
        self._more = tool_button("", "", tip=tip, words=self.tr("Details"))
        self._more.setCheckable(True)
        self._more.toggled.connect(self._show_details)
        tip = self.tr("Copy selected messages with details")
        copy = tool_button("copy", self.tr("Copy messages"), self.copy, tip=tip)
        return beside(None, self._filter, 1, self._more, copy)

    def add(self, weight: str, text: str, details: str = "", at: datetime | None = None) -> None:
        """Put a message on top; the same one again, among the newest, is counted and moved there."""
        text, at = translated(text), at or datetime.now().astimezone()
        for row in range(min(self._list.count(), _NEWEST)):
            told = self._told(row)
            if (told.weight, told.text) == (weight, text):
                told.times, told.at, told.details = told.times + 1, at, details or told.details
                self._raise(row, told)
                return
        item = QListWidgetItem()
        self._list.insertItem(0, item)
        self._write(item, _Told(weight, text, details, at))
        item.setHidden(_RANK[weight] < self._filter.currentIndex())
        self._numbers[weight] += 1
        while self._list.count() > _KEPT_MESSAGES:
            self._numbers[self._told(self._list.count() - 1).weight] -= 1
            self._list.takeItem(self._list.count() - 1)
        self._count()

    def texts(self) -> tuple[str, ...]:
        """Return the sentences that are there, newest first."""
        return tuple(self._told(index).text for index in range(self._list.count()))

    def weights(self) -> tuple[str, ...]:
        """Return the weights of the messages, newest first."""
        return tuple(self._told(index).weight for index in range(self._list.count()))

    def clear(self) -> None:
        """Empty it."""
        self._list.clear()
        self._numbers.clear()
        self._show_details()
        self._count()

    def copy(self) -> None:
        """Copy the selected messages, or all, with their details."""
        chosen = self._list.selectedItems() or [self._list.item(row) for row in range(self._list.count())]
        rows: list[_Told] = [item.data(_ROW) for item in chosen]
        lines = [
            f"{row.at:%Y-%m-%d %H:%M:%S} {row.weight}: {row.text}\n{row.details}".strip() for row in rows
        ]
        QGuiApplication.clipboard().setText("\n".join(lines))

    def _told(self, row: int) -> _Told:
        result: _Told = self._list.item(row).data(_ROW)
        return result

    def _write(self, item: QListWidgetItem, told: _Told) -> None:
        again = self.tr(" ({} times)").format(told.times) if told.times > 1 else ""
        item.setText(f"{time_of_day(told.at)}  {translated(_WORDS[told.weight])}: {told.text}{again}")
        item.setIcon(icon(*_ICONS[told.weight]))
        item.setData(_ROW, told)

    def _raise(self, row: int, told: _Told) -> None:
        """Move a message to the top, as it was: selected or not, shown or not."""
        chosen, hidden = self._list.item(row).isSelected(), self._list.item(row).isHidden()
        item = self._list.takeItem(row)
        self._list.insertItem(0, item)
        self._write(item, told)
        item.setSelected(chosen)
        item.setHidden(hidden)

    def _sift(self) -> None:
        least = self._filter.currentIndex()
        for row in range(self._list.count()):
            self._list.item(row).setHidden(_RANK[self._told(row).weight] < least)

    def _count(self) -> None:
        errors = self._numbers["error"]
        numbers = (self._list.count(), self._numbers["warning"] + errors, errors)
        for row, (words, number) in enumerate(zip(self._words(), numbers, strict=True)):
            self._filter.setItemText(row, f"{words} ({number})" if number else words)

    def _words(self) -> tuple[str, str, str]:
        return self.tr("All"), self.tr("Warnings"), self.tr("Errors")

    def _show_details(self, *_: object) -> None:
        chosen = self._list.selectedItems()
        told: _Told | None = chosen[0].data(_ROW) if chosen else None
        words = self.tr("Select a message.")
        if told is not None:
            words = told.details or self.tr("No further details.")
        self._details.setPlainText(words)
        self._details.setVisible(self._more.isChecked())

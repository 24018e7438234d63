"""The help: a page with a picture for each step, a tutorial, and a search through all of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, QUrl
from PySide6.QtGui import QImage, QKeySequence, QShortcut, QTextCursor, QTextDocument
from PySide6.QtWidgets import (
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QTextBrowser,
    QTextEdit,
    QWidget,
)

from contactbench.app.dialogs import ShowDialog
from contactbench.app.translation import in_use
from contactbench.widgets.controls import beside, called, column

TUTORIAL = "tutorial"
# In the order in which they are listed.
PAGES = (
    TUTORIAL, "start", "devices", "gravity", "probe", "regions", "verify", "export", "motion", "heatmap",
)  # fmt: skip
_MARGIN_PX, _LIST_PX = 16, 190


@dataclass(frozen=True)
class HelpPage:
    """A page of the help, in the language of the window where there is one."""

    name: str
    text: str  # Markdown

    @property
    def title(self) -> str:
        """Its heading."""
        return self.text.partition("\n")[0].lstrip("# ").strip()

    def has(self, words: list[str]) -> bool:
        """Tell whether all the words, in lower case, are on it."""
        return all(word in self.text.lower() for word in words)


@cache
def page(name: str, language: str) -> HelpPage:
    """Return a page; in English where it is not there in this language."""
    for file in (f"{name}.{language}.md", f"{name}.md"):
        found = files("contactbench.app") / "help" / file
        if found.is_file():
            return HelpPage(name, found.read_text(encoding="utf-8"))
    raise ValueError(f"there is no help page {name!r}")


class _Browser(QTextBrowser):
    """Shows a page; its pictures are never wider than there is room."""

    def loadResource(self, kind: int, name: QUrl | str) -> Any:
        if kind != QTextDocument.ResourceType.ImageResource.value:
            return super().loadResource(kind, name)
        image = QImage(str(files("contactbench.app") / "help" / "pictures" / Path(QUrl(name).path()).name))
        room = self.viewport().width() - 3 * _MARGIN_PX
        if image.isNull() or image.width() <= room:
            return image
        ratio = self.devicePixelRatioF()
        scaled = image.scaledToWidth(int(room * ratio), Qt.TransformationMode.SmoothTransformation)
        scaled.setDevicePixelRatio(ratio)
        return scaled


class HelpBook(ShowDialog):
    """
    All pages; stays beside the window, so that what it says can be done there.

    Parameters
    ----------
    name : str
        One of `PAGES`, to begin with.
    parent : QWidget, optional
    """

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__("", (860, 640), parent)
        self.setWindowTitle(self.tr("Help"))
        self.setModal(False)
        self.search = QLineEdit(placeholderText=self.tr("Search"), clearButtonEnabled=True)
        self.search.setAccessibleName(self.tr("Search the help"))
        self.list = called(QListWidget(), self.tr("Pages"))
        self.list.setFixedWidth(_LIST_PX)
        self.none = QLabel(self.tr("No page has these words."), wordWrap=True)
        self.none.hide()
        self.view = _Browser(openExternalLinks=True)
        self.view.document().setDocumentMargin(_MARGIN_PX)
        self.view.setOpenLinks(False)
        self.view.anchorClicked.connect(self._follow)
        left = column(None, self.search, self.none, self.list, space=-1)
        body = QWidget()
        beside(body, left, (self.view, 1))
        self.fill(body)
        for each in PAGES:
            item = QListWidgetItem(page(each, in_use()).title, self.list)
            item.setData(Qt.ItemDataRole.UserRole, each)
        self.list.currentItemChanged.connect(lambda _now, _before: self._show())
        self.search.textChanged.connect(self._find)
        find = QShortcut(QKeySequence(QKeySequence.StandardKey.Find), self)
        find.activated.connect(self.search.setFocus)
        self.turn_to(name)

    @classmethod
    def beside(cls, window: QWidget, name: str) -> HelpBook:
        """Show a page of the help beside a window, in the book that is open there if there is one."""
        book = window.findChild(cls)
        if book is None:
            book = cls(name, window)
        else:
            book.turn_to(name)
        book.show()
        book.raise_()
        book.activateWindow()
        return book

    @property
    def name(self) -> str:
        """The page that is shown."""
        item = self.list.currentItem()
        return "" if item is None else str(item.data(Qt.ItemDataRole.UserRole))

    def turn_to(self, name: str) -> None:
        """Show a page."""
        self.list.setCurrentRow(PAGES.index(name))

    def _follow(self, link: QUrl) -> None:
        """Follow a link to another page, such as ``gravity.md``."""
        name = Path(link.path()).stem
        if name in PAGES:
            self.search.clear()
            self.turn_to(name)

    def _words(self) -> list[str]:
        return self.search.text().lower().split()

    def _find(self) -> None:
        """List the pages that have all words, and show the first of them if the one that is shown has not."""
        words = self._words()
        fits = [page(each, in_use()).has(words) for each in PAGES]
        for row, fit in enumerate(fits):
            self.list.item(row).setHidden(not fit)
        self.none.setVisible(not any(fits))
        if any(fits) and not fits[self.list.currentRow()]:
            self.list.setCurrentRow(fits.index(True))
        self._mark()

    def _show(self) -> None:
        if self.name:
            self.view.setMarkdown(page(self.name, in_use()).text)
            self.view.setAccessibleName(page(self.name, in_use()).title)
            self._mark()

    def _mark(self) -> None:
        """Mark the words that are searched, and show the first."""
        marks = []
        for word in self._words():
            cursor = QTextCursor(self.view.document())
            while not (cursor := self.view.document().find(word, cursor)).isNull():
                mark = QTextEdit.ExtraSelection()
                mark.cursor = cursor
                mark.format.setBackground(self.palette().highlight())
                mark.format.setForeground(self.palette().highlightedText())
                marks.append(mark)
        self.view.setExtraSelections(marks)
        if marks:
            first = min((mark.cursor for mark in marks), key=lambda each: each.position())
            seen = QTextCursor(self.view.document())
            seen.setPosition(first.selectionStart())
            self.view.setTextCursor(seen)
            self.view.ensureCursorVisible()

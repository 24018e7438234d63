"""Pages of which one is shown, and which take no more room than that one needs."""

from __future__ import annotations

from PySide6.QtWidgets import QVBoxLayout, QWidget


class HeightStack(QWidget):
    """A stack as high as its current page; a `QStackedWidget` is as high as its highest."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._pages: list[QWidget] = []
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)

    def add(self, page: QWidget) -> None:
        """Add a page; the first one is shown."""
        page.setVisible(not self._pages)
        self._pages.append(page)
        self._column.addWidget(page)

    def show_page(self, number: int) -> None:
        """Show another page."""
        for each, page in enumerate(self._pages):
            page.setVisible(each == number)

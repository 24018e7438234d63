"""Dialogs that show text: a help page, the log, what is in a session."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QFontDatabase
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QPlainTextEdit, QTextBrowser, QVBoxLayout, QWidget

_MARGIN_PX = 16


class TextDialog(QDialog):
    """
    Shows text, which can be copied; goes when it is closed.

    Parameters
    ----------
    title, text : str
    parent : QWidget, optional
    markdown : bool
        Whether the text is Markdown; plain lines otherwise.
    """

    def __init__(
        self, title: str, text: str, parent: QWidget | None = None, *, markdown: bool = False
    ) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(title)
        self.view: QTextBrowser | QPlainTextEdit
        if markdown:
            self.view = QTextBrowser(openExternalLinks=True)
            self.view.setMarkdown(text)
            self.view.document().setDocumentMargin(_MARGIN_PX)
        else:
            self.view = QPlainTextEdit(text, readOnly=True)
            self.view.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        self.view.setAccessibleName(title)
        buttons = QDialogButtonBox()
        close = buttons.addButton(self.tr("Close"), QDialogButtonBox.ButtonRole.RejectRole)
        close.setDefault(True)
        buttons.rejected.connect(self.close)
        layout = QVBoxLayout(self)
        layout.addWidget(self.view, 1)
        layout.addWidget(buttons)
        self.resize(720, 560)

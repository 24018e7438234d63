"""Dialogs that only show something: the log, the keys that there are."""

import re
from dataclasses import dataclass
from importlib.metadata import Distribution, PackageNotFoundError, distribution

from PySide6.QtCore import QCoreApplication, QSize, Qt
from PySide6.QtGui import QAction, QFontDatabase, QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHeaderView,
    QLabel,
    QPlainTextEdit,
    QTableWidget,
    QTableWidgetItem,
    QTextBrowser,
    QVBoxLayout,
    QWidget,
)

from contactbench import __version__
from contactbench.widgets.controls import called, plain_label

_MARGIN_PX, _FRAME_PX = 16, 40


class ShowDialog(QDialog):
    """
    Shows widgets one below the other, the last one as large as there is room; goes when it is closed.

    Parameters
    ----------
    title : str
    size : (int, int)
        Px.
    parent : QWidget, optional
    """

    def __init__(self, title: str, size: tuple[int, int], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(title)
        self.resize(QSize(*size).boundedTo(self.screen().availableSize() - QSize(_MARGIN_PX, _FRAME_PX)))

    def fill(self, *widgets: QWidget) -> None:
        """Put widgets above the button that closes it."""
        buttons = QDialogButtonBox()
        close = buttons.addButton(self.tr("Close"), QDialogButtonBox.ButtonRole.RejectRole)
        close.setDefault(True)
        buttons.rejected.connect(self.close)
        layout = QVBoxLayout(self)
        for widget in widgets:
            layout.addWidget(widget, int(widget is widgets[-1]))
        layout.addWidget(buttons)


class TextDialog(ShowDialog):
    """Shows plain lines, which can be copied."""

    def __init__(self, title: str, text: str, parent: QWidget | None = None) -> None:
        super().__init__(title, (720, 560), parent)
        self.view = QPlainTextEdit(text, readOnly=True)
        self.view.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        self.view.setAccessibleName(title)
        self.fill(self.view)


# ---- keys ------------------------------------------------------------------------------------------


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


class CheatSheet(ShowDialog):
    """The keys that really are in the window, and what tables, charts and the scene take themselves."""

    def __init__(self, window: QWidget) -> None:
        super().__init__("", (560, 620), window)
        self.setWindowTitle(self.tr("Shortcuts"))
        keys = (*keys_of(window), *self._handled())
        self.table = QTableWidget(len(keys), 2)
        self.table.setHorizontalHeaderLabels([self.tr("Key"), self.tr("Action")])
        self.table.verticalHeader().hide()
        self.table.setShowGrid(False)
        self.table.setSelectionMode(QTableWidget.SelectionMode.NoSelection)
        self.table.setEditTriggers(QTableWidget.EditTrigger.NoEditTriggers)
        self.table.setAccessibleName(self.tr("Shortcuts"))
        for row, key in enumerate(keys):
            self.table.setItem(row, 0, QTableWidgetItem(key.keys))
            self.table.setItem(row, 1, QTableWidgetItem(key.words))
        header = self.table.horizontalHeader()
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.ResizeToContents)
        header.setStretchLastSection(True)
        self.fill(self.table)

    def _handled(self) -> tuple[Key, ...]:
        """Return what widgets take themselves where they have the focus or the pointer; no action stands for it."""
        return (
            Key(self.tr("Enter"), self.tr("Do what the button at the foot of the page says")),
            Key(self.tr("Backspace"), self.tr("Press the second button (bench mode)")),
            Key(self.tr("Page Up, Page Down"), self.tr("Previous or next step (bench mode)")),
            Key(self.tr("Delete"), self.tr("Leave out the selected poses; remove the selected markers")),
            Key(self.tr("Return"), self.tr("Restore the selected poses")),
            Key(self.tr("Arrow keys"), self.tr("Choose a point in the facets chart; move a range handle")),
            Key(self.tr("Drag with the left or right button"), self.tr("Rotate the view")),
            Key(self.tr("Drag with the middle button"), self.tr("Pan the view")),
            Key(self.tr("Wheel"), self.tr("Zoom in or out")),
            Key(self.tr("Ctrl + wheel"), self.tr("Larger or smaller brush")),
            Key(self.tr("Hold Shift"), self.tr("Swap brush and eraser")),
            Key(self.tr("Esc"), self.tr("Have the probe go back (motion control)")),
            Key(self.tr("P"), self.tr("Play or pause (heatmap viewer)")),
            Key(self.tr("Ctrl+S"), self.tr("Save a picture (heatmap viewer)")),
        )


# ---- what this is, which version, and under which licences its parts are -------------------------


_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")
_LONGEST_LICENCE = 60
_DEVELOPING = re.compile(r"""extra *== *['"]dev['"]""")  # tools, not parts
_BUNDLED = ("vtk",)  # needed by a part, and large enough to be named


@dataclass(frozen=True)
class LicensedPart:
    """A part that is installed: its name, version and licence."""

    name: str
    version: str
    licence: str


def parts() -> tuple[LicensedPart, ...]:
    """Return what contactbench needs and is there, as their own metadata say."""
    try:
        needed = distribution("contactbench").requires or []
    except PackageNotFoundError:
        needed = []
    used = [each for each in needed if _DEVELOPING.search(each) is None]
    names = {match.group() for each in used if (match := _NAME.match(each))} | set(_BUNDLED)
    found = []
    for name in sorted(names - {"contactbench"}, key=str.lower):
        try:
            part = distribution(name)
        except PackageNotFoundError:
            continue
        found.append(LicensedPart(name, part.version, _licence(part)))
    return tuple(found)


def _licence(part: Distribution) -> str:
    meta = part.metadata
    given = (meta.get_all("License-Expression") or [""])[0]
    if not given:
        classes = [each for each in meta.get_all("Classifier") or [] if each.startswith("License ::")]
        given = ", ".join(each.rpartition(":: ")[2] for each in classes)
    if not given:
        given = (meta.get_all("License") or [""])[0].strip().partition("\n")[0]
    if given.startswith("Copyright"):  # the text of a licence, not its name
        given = ""
    return given[:_LONGEST_LICENCE] or QCoreApplication.translate(
        "AboutDialog", "see the package's own files"
    )


class AboutDialog(ShowDialog):
    """The version, and the licences of the parts."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__("", (620, 520), parent)
        self.setWindowTitle(self.tr("About contactbench"))
        title = plain_label(self.tr("contactbench {}").format(__version__), "title")
        words = QLabel(
            self.tr(
                "Locates contacts on a probe from a single force/torque sensor and states how certain"
                " each one is. Licensed under the Apache License 2.0. For bench work and research only:"
                " not a medical device."
            ),
            wordWrap=True,
        )
        self.licences = called(QTextBrowser(), self.tr("Component licences"))
        rows = "".join(
            f"<tr><td>{part.name}&nbsp;&nbsp;</td><td>{part.version}&nbsp;&nbsp;</td><td>{part.licence}</td></tr>"
            for part in parts()
        )
        self.licences.setHtml(f"<table>{rows}</table>")
        self.fill(title, words, QLabel(self.tr("Components and their licences:")), self.licences)

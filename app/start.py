"""The first page: the virtual bench, a new session, an open one, the recent ones; and what hinders opening one."""

from collections.abc import Callable, Collection, Sequence
from datetime import datetime
from pathlib import Path

from PySide6.QtCore import QBuffer, QCoreApplication, QPoint, QRect, QSize, Qt, Signal
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QIcon, QPixmap
from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QListWidget, QListWidgetItem, QPushButton, QWidget

from contactbench.app.opening import holds_session
from contactbench.app.settings import Recent
from contactbench.widgets.controls import (
    STYLED,
    FoldRow,
    PanelScroll,
    accent,
    beside,
    called,
    column,
    plain_label,
    sentence_label,
)
from contactbench.widgets.messages import date_and_time, translated
from contactbench.widgets.theme import Sign, icon

_WIDTH = 720
_PICTURE = QSize(108, 72)  # px


class StartPage(QWidget):
    """
    What is shown while no session is open.

    Parameters
    ----------
    picture_of : callable, optional
        Returns the file with the picture of a session's folder, which need not exist.

    Signals
    -------
    chosen : Path
        A session's folder.
    """

    chosen = Signal(object)

    def __init__(
        self, picture_of: Callable[[Path], Path] = lambda folder: folder, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._picture_of = picture_of
        inner = QWidget(maximumWidth=_WIDTH)
        title = plain_label(self.tr("contactbench"), "number")
        words = QLabel(
            self.tr(
                "Calibrate a force/torque sensor behind a probe, prepare the probe mesh, verify contacts"
                " on the bench, and export a bundle."
            ),
            wordWrap=True,
        )
        words.setProperty("role", "muted")
        lines = column(inner, 1, title, words, margins=STYLED, space=10)
        lines.addSpacing(8)
        lines.addLayout(self._buttons())
        self.question = QuestionCard()
        self.question.asked.connect(lambda on: accent(self.virtual_button, not on))
        self.question.asked.connect(
            lambda on: self.virtual_button.setIcon(icon("play", "text" if on else "panel"))
        )
        lines.addWidget(self.question)
        lines.addSpacing(8)
        self._heading = plain_label(self.tr("Recent sessions"), "title")
        lines.addWidget(self._heading)
        self._recent = called(QListWidget(), self.tr("Recent sessions"))
        self._recent.setMinimumHeight(190)
        self._recent.setIconSize(_PICTURE)
        self._recent.setWordWrap(True)
        self._recent.itemActivated.connect(self._open_recent)
        self._recent.itemClicked.connect(self._open_recent)
        lines.addWidget(self._recent, 3)
        hint = QLabel(self.tr("You can also drop a session folder on this window."), wordWrap=True)
        hint.setProperty("role", "muted")
        lines.addWidget(hint)
        lines.addStretch(1)
        middle = QWidget()
        beside(middle, 1, (inner, 8), 1, margins=STYLED)
        column(self, PanelScroll(middle))
        self.show_recent(())

    def _buttons(self) -> FoldRow:
        self.virtual_button = QPushButton(icon("play", "panel"), self.tr("Try the virtual bench"))
        self.virtual_button.setProperty("primary", True)
        self.virtual_button.setToolTip(self.tr("Simulated sensor, robot and probe; no hardware needed"))
        self.new_button = QPushButton(icon("add"), self.tr("New session"))
        self.new_button.setToolTip(self.tr("Start with an empty folder for one sensor and one probe"))
        self.open_button = QPushButton(icon("folder"), self.tr("Open session"))
        self.open_button.setToolTip(self.tr("Open an existing session"))
        buttons = FoldRow()
        for button in (self.virtual_button, self.new_button, self.open_button):
            button.setProperty("large", True)
            buttons.add(button, 1)
        return buttons

    def show_recent(self, recent: Sequence[Recent], missing: Collection[str] = ()) -> None:
        """Show sessions that were open; those whose folder is missing are grey and say so."""
        self._recent.clear()
        for each in recent:
            there = each.folder not in missing
            words = [self._when(each.opened), each.done if there else self.tr("missing: moved or deleted")]
            item = QListWidgetItem(f"{Path(each.folder).name}\n{' · '.join(filter(None, words))}")
            photo = QPixmap(str(self._picture_of(Path(each.folder)))) if there else QPixmap()
            plain = icon("folder" if there else "cross", "accent" if there else "muted")
            item.setIcon(plain if photo.isNull() else QIcon(photo))
            item.setToolTip(each.folder)
            item.setData(Qt.ItemDataRole.UserRole, each.folder)
            if not there:
                item.setFlags(item.flags() & ~Qt.ItemFlag.ItemIsEnabled)
            self._recent.addItem(item)
        for widget in (self._heading, self._recent):
            widget.setVisible(bool(recent))

    def set_busy(self, busy: bool) -> None:
        """Lock what begins something while a session is being opened."""
        for widget in (self.virtual_button, self.new_button, self.open_button, self._recent):
            widget.setEnabled(not busy)

    def _when(self, text: str) -> str:
        try:
            moment = datetime.fromisoformat(text)
        except ValueError:
            return ""
        return date_and_time(moment)

    def _open_recent(self, item: QListWidgetItem) -> None:
        self.chosen.emit(Path(item.data(Qt.ItemDataRole.UserRole)))


class QuestionCard(QFrame):
    """A sentence with what can be done about it; stays where it is until something is chosen."""

    asked = Signal(bool)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setProperty("role", "card")
        self._icon, self._words = Sign(28), sentence_label()
        self._weighed, self._buttons = QGridLayout(), FoldRow()
        self._weighed.setColumnStretch(1, 1)
        words = column(None, self._words, self._weighed, self._buttons, space=-1)
        beside(self, (self._icon, 0, Qt.AlignmentFlag.AlignTop), (words, 1), margins=STYLED)
        self._answers: list[QPushButton] = []
        self._costs: list[QLabel] = []
        self.hide()

    @property
    def sentence(self) -> str:
        """What is asked; empty while nothing is."""
        return "" if self.isHidden() else self._words.text()

    @property
    def costs(self) -> tuple[str, ...]:
        """What the first answers cost."""
        return tuple(each.text() for each in self._costs)

    def ask(
        self,
        sentence: str,
        answers: Sequence[tuple[str, Callable[[], None]]],
        kind: str = "warning",
        costs: Sequence[str] = (),
    ) -> None:
        """
        Show a sentence and one button for each answer, the first of them the accented one.

        `costs` says of the first answers what they cost: it stands beside their buttons.
        """
        self.clear()
        self._icon.show_icon(icon(kind, "warning" if kind == "warning" else "accent"))
        self._words.setText(translated(sentence))
        for number, (words, action) in enumerate(answers):
            button = QPushButton(words)
            button.setProperty("primary", number == 0)
            button.clicked.connect(lambda _=False, action=action: self._answer(action))
            self._answers.append(button)
            if number < len(costs):
                cost = sentence_label(costs[number])
                self._costs.append(cost)
                self._weighed.addWidget(button, number, 0)
                self._weighed.addWidget(cost, number, 1)
                button.setAccessibleDescription(costs[number])
            else:
                self._buttons.add(button)
            if number == 0:
                button.setFocus()
        self.setAccessibleName(sentence)
        self.show()
        self.asked.emit(True)

    def answers(self) -> tuple[QPushButton, ...]:
        """Return the buttons."""
        return tuple(self._answers)

    def clear(self) -> None:
        """Ask nothing."""
        for widget in (*self._answers, *self._costs):
            widget.hide()
            widget.deleteLater()
        self._answers, self._costs = [], []
        for layout in (self._weighed, self._buttons):
            while layout.count():
                layout.takeAt(0)
        self.hide()
        self.asked.emit(False)

    def _answer(self, action: Callable[[], None]) -> None:
        self.clear()
        action()


def thumbnail(photo: QPixmap) -> bytes:
    """Return a photo of the scene as a small PNG, as it stands beside a recent session."""
    modes = Qt.AspectRatioMode.KeepAspectRatioByExpanding, Qt.TransformationMode.SmoothTransformation
    size = _PICTURE * 2  # for a screen of twice the density
    small = photo.scaled(size * 1.5, *modes)  # the middle of it: the probe, without scales
    cut = QRect(QPoint(0, 0), size)
    cut.moveCenter(small.rect().center())
    out = QBuffer()
    out.open(QBuffer.OpenModeFlag.WriteOnly)
    small.copy(cut).save(out, "PNG")
    return bytes(out.data().data())


def dropped_folder(event: QDragEnterEvent | QDropEvent) -> Path | None:
    """Return the session's folder that is being dropped, if it is one."""
    for url in event.mimeData().urls():
        folder = Path(url.toLocalFile())
        if folder.name == "journal":  # the file in it will do
            folder = folder.parent
        if holds_session(folder):
            return folder
    return None


def session_name(folder: Path) -> str:
    """Return what a session is called."""
    return folder.name or QCoreApplication.translate("StartPage", "session")

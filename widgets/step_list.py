"""The list of steps: number, name, and how each stands, as icon and word."""

from collections.abc import Mapping

from PySide6.QtCore import QRect, QSignalBlocker, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPaintEvent
from PySide6.QtWidgets import QAbstractButton, QButtonGroup, QSizePolicy, QWidget

from contactbench.pipeline.steps import Step, StepState, StepStatus
from contactbench.widgets.controls import called, column
from contactbench.widgets.messages import translated
from contactbench.widgets.theme import colours, is_dark, smooth_painter, state_colour, state_icon

_HEIGHT, _WIDTH, _ICON, _MARGIN = 58, 148, 18, 10
_LOWEST, _TWO_LINES = 26, 46  # px: the least of a row, and the least that takes its word, too


class StepList(QWidget):
    """
    The steps, one under the other; one of them is shown.

    Signals
    -------
    chosen : Step
        Somebody wants to see it; also a locked one, whose page says what is missing.
    """

    chosen = Signal(object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName(self.tr("Steps"))
        group = QButtonGroup(self)
        layout = column(self, margins=(6, 4, 6, 4), space=3)
        self._rows: dict[Step, _Row] = {}
        self._toggled: Step | None = None
        for number, step in enumerate(Step, 1):
            row = _Row(number, self.name_of(step))
            # By the accessibility bus a button that can be checked is toggled, and never clicked.
            row.toggled.connect(lambda on, step=step: self._choose(step, on))
            row.clicked.connect(lambda _=False, step=step: self._clicked(step))
            group.addButton(row)
            layout.addWidget(row, 1)
            self._rows[step] = row
        layout.addStretch(1)
        self.show_statuses({})

    def name_of(self, step: Step) -> str:
        """Return what a step is called."""
        return {
            Step.DEVICES: self.tr("Devices"),
            Step.GRAVITY: self.tr("Gravity"),
            Step.PROBE: self.tr("Probe"),
            Step.REGIONS: self.tr("Regions"),
            Step.VERIFY: self.tr("Verify"),
            Step.EXPORT: self.tr("Export"),
        }[step]

    def show_statuses(self, statuses: Mapping[Step, StepStatus]) -> None:
        """Show how the steps stand; one that is missing counts as locked."""
        for step, row in self._rows.items():
            row.show_status(statuses.get(step, StepStatus(StepState.LOCKED, "")))

    def show_step(self, step: Step) -> None:
        """Show which step is looked at."""
        with QSignalBlocker(self._rows[step]):
            self._rows[step].setChecked(True)
        self._rows[step].update()
        # The tabulator key stops at one of them, arrows go on from there: Qt leaves it where the focus was last.
        for each, row in self._rows.items():
            row.setFocusPolicy(Qt.FocusPolicy.StrongFocus if each is step else Qt.FocusPolicy.ClickFocus)

    def _choose(self, step: Step, on: bool) -> None:
        if on:
            self._toggled = step
            self.chosen.emit(step)

    def _clicked(self, step: Step) -> None:
        """Choose the step that is looked at once more; another one was toggled just before."""
        toggled, self._toggled = self._toggled, None
        if toggled is not step:
            self.chosen.emit(step)

    def row(self, step: Step) -> QAbstractButton:
        """Return the button of a step."""
        return self._rows[step]


class _Row(QAbstractButton):
    def __init__(self, number: int, name: str) -> None:
        super().__init__()
        self.setCheckable(True)
        self.setText(name)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Maximum)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self._number, self._word, self._state = number, "", StepState.LOCKED

    def sizeHint(self) -> QSize:
        bold = QFont(self.font())
        bold.setBold(True)
        wide = QFontMetrics(bold).horizontalAdvance(self._title()) + 4 * _MARGIN + _ICON
        return QSize(max(_WIDTH - 12, wide), _HEIGHT)

    def minimumSizeHint(self) -> QSize:
        return QSize(self.sizeHint().width(), _LOWEST)  # asked again when the font is known: no name is cut

    def _title(self) -> str:
        return f"{self._number}   {self.text()}"

    def show_status(self, status: StepStatus) -> None:
        word, sentence = translated(status.state), translated(status.sentence)
        self._state, self._word = status.state, word
        called(self, f"{self._number} {self.text()}: {word}", f"{word}: {sentence}" if sentence else word)
        self.setAccessibleDescription(sentence)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002 - Qt's signature
        c, painter = colours(is_dark()), smooth_painter(self)
        self._ground(painter)
        left, width = 2 * _MARGIN, self.width() - 3 * _MARGIN
        bold = QFont(self.font())
        bold.setBold(True)
        painter.setFont(bold)
        locked = self._state is StepState.LOCKED
        painter.setPen(QColor(c.muted if locked else c.text))
        two = self.height() >= _TWO_LINES
        upper = (
            QRect(left, 6, width, (self.height() - 12) // 2) if two else self.rect().adjusted(left, 0, 0, 0)
        )
        painter.drawText(upper, Qt.AlignmentFlag.AlignVCenter, self._title())
        lower = upper.translated(0, upper.height()) if two else upper
        across = lower.left() if two else self.width() - _MARGIN - _ICON
        painter.setFont(self.font())
        painter.setPen(QColor(getattr(c, state_colour(self._state))))
        state_icon(self._state).paint(
            painter, QRect(across, lower.center().y() - _ICON // 2 + 1, _ICON, _ICON)
        )
        if two:
            painter.drawText(lower.adjusted(_ICON + 6, 0, 0, 0), Qt.AlignmentFlag.AlignVCenter, self._word)
        painter.end()

    def _ground(self, painter: QPainter) -> None:
        c, box = colours(is_dark()), self.rect().adjusted(1, 1, -1, -1)
        painter.setPen(QColor(c.accent if self.hasFocus() or self.underMouse() else c.line))
        painter.setBrush(QColor(c.panel if self.isChecked() else c.background))
        painter.drawRoundedRect(box, 6, 6)
        if self.isChecked():  # a bar, so that it is not told by colour alone
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(c.accent))
            painter.drawRoundedRect(QRect(box.left() + 3, box.top() + 6, 5, box.height() - 11), 2, 2)

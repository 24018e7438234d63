"""What is to be done next: one accented button and at most one beside it, always in the same place, below a message."""

from collections.abc import Callable

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QGridLayout, QSizePolicy, QWidget

from contactbench.widgets.controls import ElidedLabel, FoldButton, accent, called, set_role
from contactbench.widgets.messages import translated

_HIGH_PX = 46  # two lines, and what a glove can press
_LINES, _MOST_LINES = 2, 6  # an error names its remedy last
_SHARES = (2, 3)  # of the width: the second button, the first one


class ActionButton(FoldButton):
    """A button of a size that does not depend on its words."""

    def __init__(self, high: int = _HIGH_PX, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._high = high
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.setFixedHeight(high)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # clicked, it leaves Enter to the first button
        self.setStyleSheet("padding: 2px 6px;")

    def sizeHint(self) -> QSize:
        """Return the size that it has anyway."""
        return QSize(_HIGH_PX, self._high)

    minimumSizeHint = sizeHint

    def _around(self) -> int:
        return super()._around() - 16


class ActionBar(QWidget):
    """
    The foot of a page. Its buttons stay where they are; it grows upwards for long messages.

    Attributes
    ----------
    primary, second : QPushButton
        What to do, and what else can be done; see `offer`.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName(self.tr("What to do next"))
        self._message = called(ElidedLabel(lines=_LINES, most=_MOST_LINES), self.tr("Message"))
        self.second, self.primary = ActionButton(), ActionButton()
        self._does: list[Callable[[], object] | None] = [None, None]
        for number, button in enumerate((self.primary, self.second)):
            button.clicked.connect(lambda _=False, number=number: self._press(number))
            kept = button.sizePolicy()
            kept.setRetainSizeWhenHidden(True)  # else the other would move
            button.setSizePolicy(kept)
        self.second.hide()
        grid = QGridLayout(self)
        grid.setContentsMargins(8, 4, 8, 8)
        grid.setSpacing(6)
        grid.addWidget(self._message, 0, 0, 1, 2)
        grid.addWidget(self.second, 1, 0)
        grid.addWidget(self.primary, 1, 1)
        for column, share in enumerate(_SHARES):
            grid.setColumnStretch(column, share)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)

    @property
    def words(self) -> str:
        """What the message says."""
        return self._message.text()

    def say(self, words: str, bad: bool = False) -> None:
        """Show a message instead of the one before; empty: none."""
        words = translated(words)
        if words != self._message.text():
            self._message.setText(words)
        role = "bad" if bad else ""
        if self._message.property("role") != role:
            set_role(self._message, role)

    def offer(
        self,
        words: str,
        does: Callable[[], object],
        *,
        enabled: bool = True,
        accented: bool = True,
        tip: str = "",
        picture: str = "",
    ) -> None:
        """Say what to do next; not `accented`: something on the page should be done first."""
        accent(self.primary, accented, picture)
        self._put(0, words, does, enabled, tip)

    def offer_second(
        self,
        words: str = "",
        does: Callable[[], object] | None = None,
        *,
        enabled: bool = True,
        tip: str = "",
    ) -> None:
        """Say what else can be done; no words: nothing."""
        self._put(1, words, does, enabled, tip)
        self.second.setVisible(bool(words))

    def _put(
        self, number: int, words: str, does: Callable[[], object] | None, enabled: bool, tip: str
    ) -> None:
        button = (self.primary, self.second)[number]
        self._does[number] = does
        button.setText(words)
        button.setEnabled(enabled and does is not None)
        button.setToolTip(tip)
        button.setAccessibleDescription(tip)

    def _press(self, number: int) -> None:
        does = self._does[number]
        if does is not None:
            does()

"""A list of what is done, stale or missing, each with what to do and a way there."""

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QPushButton, QSizePolicy, QWidget

from contactbench.pipeline.errors import message
from contactbench.pipeline.session.why import CheckItem
from contactbench.widgets.messages import translated
from contactbench.widgets.theme import Sign, icon

# State -> icon, colour of the theme, word.
_LOOKS = {
    "done": ("done", "good", message("done")),
    "stale": ("stale", "stale", message("stale")),
    "missing": ("ready", "warning", message("missing")),
    "failed": ("failed", "bad", message("not passed")),
    "left out": ("remove", "muted", message("left out")),
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
            if (widget := item.widget()) is not None:
                widget.hide()
                widget.deleteLater()
        for row, each in enumerate(self._shown):
            self._line(row, each)

    def _line(self, row: int, item: CheckItem) -> None:
        *look, state = _LOOKS[item.state]
        sign, word, name = Sign(_ICON), translated(state), translated(item.name)
        sign.show_icon(icon(*look))
        sign.setAccessibleName(word)
        self._grid.addWidget(sign, row, 0, Qt.AlignmentFlag.AlignTop)
        words = QLabel(f"<b>{name}</b> · {word}<br>{_plain(translated(item.sentence))}")
        words.setTextFormat(Qt.TextFormat.RichText)
        words.setWordWrap(True)
        words.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Minimum)
        self._grid.addWidget(words, row, 1)
        if not item.holds:
            go = QPushButton(self.tr("Open step"))
            go.setMinimumHeight(36)
            go.clicked.connect(lambda _=False, step=item.step: self.wanted.emit(step))
            go.setAccessibleName(self.tr("Open {name}").format(name=name))
            self._grid.addWidget(go, row, 2, Qt.AlignmentFlag.AlignTop)


def _plain(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")

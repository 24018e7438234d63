"""The small parts that every panel is made of: buttons that a glove can press, fields, labels, rows, scrolling."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from PySide6.QtCore import QEvent, QObject, QSignalBlocker, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import (
    QAbstractSlider,
    QAbstractSpinBox,
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QFrame,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QScrollBar,
    QSizePolicy,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from contactbench.widgets.icons import icon

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from PySide6.QtWidgets import QLayout, QProgressBar

HIGH = 36  # px: what a glove can press
_TEXT_PX = 6
_Field = TypeVar("_Field", bound=QWidget)


# ---- parts -----------------------------------------------------------------------------------------


def push_button(
    words: str,
    does: Callable[[], object] | None = None,
    picture: str = "",
    *,
    tip: str = "",
    high: int = HIGH,
    least: int = 0,
    primary: bool = False,
) -> QPushButton:
    """Return a button; `least`: it may be as narrow as that, px; `primary`: the one thing to press."""
    made = QPushButton(words)
    if picture:
        made.setIcon(icon(picture, "panel" if primary else "text"))
    made.setMinimumHeight(high)
    made.setToolTip(tip)
    if primary:
        made.setProperty("primary", True)
    if least:
        narrow(made, least)
    if does is not None:
        made.clicked.connect(lambda _=False: does())
    return made


def sentence_label(words: str = "", role: str = "") -> QLabel:
    """Return a label that breaks its lines, and can be copied from."""
    made = QLabel(words)
    made.setWordWrap(True)
    made.setTextFormat(Qt.TextFormat.PlainText)
    made.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    if role:
        made.setProperty("role", role)
    return made


def plain_label(words: str, role: str = "") -> QLabel:
    """Return a label of one line; `role`: of the style sheet, such as "title" or "muted"."""
    made = QLabel(words)
    if role:
        made.setProperty("role", role)
    return made


def named(field: _Field, name: str, *, least: int = 0, tip: str | None = None) -> _Field:
    """Make a field as high as a glove needs it, call it by a name, and let it speak when it is complete."""
    field.setMinimumHeight(HIGH)
    field.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    field.setAccessibleName(name)
    field.setToolTip(name if tip is None else tip)
    if isinstance(field, QAbstractSpinBox):
        field.setKeyboardTracking(False)
    if least:
        narrow(field, least)
    return field


def choice(
    entries: Iterable[tuple[str, Any]], name: str, *, least: int = 0, tip: str | None = None
) -> QComboBox:
    """Return a list of choices: words and what they stand for."""
    made = QComboBox()
    for words, value in entries:
        made.addItem(words, value)
    return named(made, name, least=least, tip=tip)


def narrow(field: QWidget, least: int) -> None:
    """Let a field be as narrow as `least` px: its own wish is for the longest that it could ever hold."""
    field.setMinimumWidth(least)
    field.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)


def row(*parts: QWidget | tuple[QWidget, int], space: int = 6) -> QHBoxLayout:
    """Return parts beside each other; one with a number is stretched."""
    made = QHBoxLayout()
    made.setSpacing(space)
    for each in parts:
        made.addWidget(*each) if isinstance(each, tuple) else made.addWidget(each)
    return made


def column(
    owner: QWidget,
    *parts: QWidget | QLayout,
    margins: tuple[int, int, int, int] = (0, 0, 0, 0),
    space: int = 8,
) -> QVBoxLayout:
    """Lay the parts of a panel out one below the other."""
    made = QVBoxLayout(owner)
    made.setContentsMargins(*margins)
    made.setSpacing(space)
    for each in parts:
        made.addWidget(each) if isinstance(each, QWidget) else made.addLayout(each)
    return made


def form(owner: QWidget | None = None, *, top: int = 0) -> QFormLayout:
    """Return a form whose fields are as wide as there is room."""
    made = QFormLayout(owner) if owner is not None else QFormLayout()
    made.setContentsMargins(0, top, 0, 0)
    made.setRowWrapPolicy(QFormLayout.RowWrapPolicy.DontWrapRows)
    made.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
    return made


def add_key(owner: QWidget, words: str, keys: str, does: Callable[[], object]) -> None:
    """Have a key do something while its owner is shown; the cheat sheet lists it."""
    made = QAction(words, owner)
    made.setShortcut(QKeySequence(keys))
    made.triggered.connect(lambda _=False: does())
    owner.addAction(made)


# ---- what they show --------------------------------------------------------------------------------


def show_quietly(field: QWidget, value: Any) -> None:
    """Show a value in a field without asking for anything."""
    with QSignalBlocker(field):
        if isinstance(field, QDoubleSpinBox | QSpinBox):
            field.setValue(value)
        elif isinstance(field, QCheckBox):
            field.setChecked(value)
        elif isinstance(field, QComboBox):
            field.setCurrentIndex(value)
        elif isinstance(field, QLineEdit) and field.text() != value:
            field.setText(value)


def set_role(widget: QWidget, role: str) -> None:
    """Have a label look as another role, such as "bad"."""
    widget.setProperty("role", role)
    _restyle(widget)


def accent(button: QPushButton, on: bool = True, picture: str = "") -> None:
    """Make a button the accented one of its state, or a plain one again; `picture`: its icon, coloured to suit."""
    if picture:
        button.setIcon(icon(picture, "panel" if on else "text"))
    if bool(button.property("primary")) != on:
        button.setProperty("primary", on)
        _restyle(button)


def _restyle(widget: QWidget) -> None:
    widget.style().unpolish(widget)
    widget.style().polish(widget)


def show_value(bar: QProgressBar, value: int) -> None:
    """
    Show a value with the next frame.

    `QProgressBar.setValue` paints at once, and with it the whole window with its 3D view: without a graphics card
    30 ms for each step of a work that tells of many.
    """
    if value == bar.value():
        return
    bar.setUpdatesEnabled(False)
    bar.setValue(value)
    bar.setUpdatesEnabled(True)  # which asks for a frame


# ---- panels ----------------------------------------------------------------------------------------


class PanelScroll(QScrollArea):
    """Shows one panel as wide as itself: it is scrolled up and down, never sideways."""

    def __init__(self, panel: QWidget | None = None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        if panel is not None:
            self.setWidget(panel)


class HeightStack(QWidget):
    """A stack as high as its current page; a `QStackedWidget` is as high as its highest."""

    def __init__(self, *pages: QWidget) -> None:
        super().__init__()
        self._pages = pages
        column(self, *pages)
        self.show_page(0)

    def show_page(self, number: int) -> None:
        """Show another page."""
        for each, page in enumerate(self._pages):
            page.setVisible(each == number)


def finish(root: QWidget) -> None:
    """Give everything in `root` what no style sheet reaches; a second time does nothing more."""
    for spin in root.findChildren(QAbstractSpinBox):
        spin.lineEdit().setTextMargins(_TEXT_PX, 0, 0, 0)
    for each in root.findChildren(QFormLayout):
        if each.rowWrapPolicy() is not QFormLayout.RowWrapPolicy.WrapAllRows:
            _line_up(each)


def _line_up(layout: QFormLayout) -> None:
    """Make labels as high as their fields: Qt puts a small one near the top of a tall one."""
    for number in range(layout.rowCount()):
        label, field = (
            layout.itemAt(number, role)
            for role in (QFormLayout.ItemRole.LabelRole, QFormLayout.ItemRole.FieldRole)
        )
        words = None if label is None else label.widget()
        if isinstance(words, QLabel) and field is not None:
            words.setMinimumHeight(field.sizeHint().height())


class _Guard(QObject):
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Wheel and isinstance(watched, QWidget) and not watched.hasFocus():
            event.ignore()  # it goes to what is behind: the scroll area
            return True
        return False


def guard_wheels(root: QWidget) -> None:
    """Let the wheel change no value in `root` that does not have the focus; a second time does nothing more."""
    guard = root.findChild(_Guard, options=Qt.FindChildOption.FindDirectChildrenOnly) or _Guard(root)
    for kind in (QAbstractSpinBox, QComboBox, QAbstractSlider):
        for widget in root.findChildren(kind):
            if not isinstance(widget, QScrollBar):
                widget.setFocusPolicy(
                    Qt.FocusPolicy.StrongFocus
                )  # the usual one takes the focus by the wheel
                widget.installEventFilter(guard)

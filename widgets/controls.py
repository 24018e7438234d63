"""The small parts that every panel is made of: buttons that a glove can press, fields, labels, rows, scrolling."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from PySide6.QtCore import (
    QAbstractTableModel,
    QEvent,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    QRect,
    QSignalBlocker,
    QSize,
    Qt,
)
from PySide6.QtGui import QAction, QDropEvent, QFontMetrics, QKeySequence, QResizeEvent
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSlider,
    QAbstractSpinBox,
    QBoxLayout,
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QFileDialog,
    QFormLayout,
    QFrame,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLayout,
    QLayoutItem,
    QLineEdit,
    QProgressBar,
    QPushButton,
    QScrollArea,
    QScrollBar,
    QSizePolicy,
    QSpinBox,
    QTableView,
    QTabWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)
from shiboken6 import isValid

from contactbench.widgets.theme import icon

HIGH = 36  # px: what a glove can press
_TEXT_PX = 6
_SHORT = 12  # characters of a list of choices whose words somebody else chose
_BESIDE_PX, _CHECK_PX = 34, 30  # of a button, of a check box
_IGNORED = QSizePolicy.Policy.Ignored
STYLED = (-1, -1, -1, -1)  # margins as the style has them; likewise a space of -1
_Field = TypeVar("_Field", bound=QWidget)
_Pressed = TypeVar("_Pressed", bound=QAbstractButton)
_Box = TypeVar("_Box", bound=QBoxLayout)
_Margins = tuple[int, int, int, int]
_Index = QModelIndex | QPersistentModelIndex
_Part = QWidget | QLayout | int | tuple[QWidget | QLayout, int] | tuple[QWidget, int, Qt.AlignmentFlag]
if TYPE_CHECKING:
    _Button = QAbstractButton
else:
    _Button = object  # with two Qt classes as its bases a button crashes


# ---- parts -----------------------------------------------------------------------------------------


def push_button(
    words: str, does: Callable[[], object] | None = None, picture: str = "", *, tip: str = ""
) -> QPushButton:
    """Return a button; see `accent` for the one thing to press."""
    made = _foldable(FoldButton(), words, tip)
    made.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # clicked, it leaves Enter to the page's action
    if picture:
        made.setIcon(icon(picture))
    if does is not None:
        made.clicked.connect(lambda _=False: does())
    return made


def folded(words: str, metrics: QFontMetrics, room: float) -> str:
    """Return words in one line where there is room, or else in the two lines that are shortest."""
    parts = words.split(" ")
    if len(parts) == 1 or metrics.horizontalAdvance(words) <= room:
        return words
    splits = [(" ".join(parts[:at]), " ".join(parts[at:])) for at in range(1, len(parts))]
    return "\n".join(min(splits, key=lambda lines: max(map(metrics.horizontalAdvance, lines))))


class Folding(_Button):
    """What lets the words of a button take two lines where one is too short; goes before the kind of button."""

    _words = ""

    def text(self) -> str:
        """Return the words, in one line."""
        return self._words

    def setText(self, words: str) -> None:
        """Show other words."""
        if words != self._words:
            self._words = words
            self._fold()

    def minimumSizeHint(self) -> QSize:
        """Return the room of two lines."""
        one, metrics = super().sizeHint(), self.fontMetrics()
        lines = folded(self._words, metrics, 0).split("\n")
        shown = max(map(metrics.horizontalAdvance, QAbstractButton.text(self).split("\n")))
        return QSize(one.width() - shown + max(map(metrics.horizontalAdvance, lines)), one.height())

    def sizeHint(self) -> QSize:
        """Return the room of one line, or the height of those that there are."""
        one, metrics = super().sizeHint(), self.fontMetrics()
        shown = max(map(metrics.horizontalAdvance, QAbstractButton.text(self).split("\n")))
        return QSize(one.width() - shown + metrics.horizontalAdvance(self._words), one.height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Break the line where it must be."""
        super().resizeEvent(event)
        self._fold()

    def changeEvent(self, event: QEvent) -> None:
        """Break it anew in another font."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._fold()

    def _around(self) -> int:
        """Return how many px beside the words are not theirs."""
        icon_px = 0 if self.icon().isNull() else self.iconSize().width() + 6
        return icon_px + (_CHECK_PX if isinstance(self, QCheckBox) else _BESIDE_PX)

    def _fold(self) -> None:
        shown = folded(self._words, self.fontMetrics(), self.width() - self._around())
        if QAbstractButton.text(self) != shown:
            super().setText(shown)


class FoldButton(Folding, QPushButton):
    """A push button whose words take two lines where one is too short."""


class FoldCheck(Folding, QCheckBox):
    """A check box whose words take two lines where one is too short."""


def tool_button(
    picture: str, name: str, does: Callable[[], object] | None = None, *, tip: str = "", words: str = ""
) -> QToolButton:
    """Return a small button, with a picture or words; its tip is its name unless there is another."""
    made = called(QToolButton(), name, tip or name)
    made.setText(words)
    if picture:
        made.setIcon(icon(picture))
    if does is not None:
        made.clicked.connect(lambda _=False: does())
    return made


def check_box(words: str, *, tip: str = "") -> QCheckBox:
    """Return a check box that a glove can press."""
    return _foldable(FoldCheck(), words, tip)


def _foldable(made: _Pressed, words: str, tip: str) -> _Pressed:
    """Give a button words and a tip; it may become narrower than its words in one line."""
    made.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
    made.setText(words)
    made.setToolTip(tip)
    made.setMinimumHeight(HIGH)
    return made


def sentence_label(words: str = "", role: str = "") -> QLabel:
    """Return a label that breaks its lines, and can be copied from."""
    made = plain_label(words, role)
    made.setWordWrap(True)
    made.setTextFormat(Qt.TextFormat.PlainText)
    made.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    return made


def plain_label(words: str, role: str = "", buddy: QWidget | None = None) -> QLabel:
    """Return a label of one line; `role`: of the style sheet, such as "muted"; `buddy`: the field it is of."""
    made = QLabel(words)
    if buddy is not None:
        made.setBuddy(buddy)
    if role:
        made.setProperty("role", role)
    return made


_HIGH_WINDOW_PX = 600


class ElidedLabel(QLabel):
    """
    A label that takes the room of some lines and no more; words that are longer end in "…" and are in the tool tip.

    Parameters
    ----------
    words : str
    lines : int
        Whose room it always takes, also while it says nothing.
    most : int
        Up to so many it grows for longer words, in a window that is high enough.
    """

    def __init__(self, words: str = "", *, lines: int = 1, most: int = 1, role: str = "") -> None:
        super().__init__()
        self._words, self._lines, self._least, self._most = words, lines, lines, max(lines, most)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setSizePolicy(
            QSizePolicy.Policy.Ignored if lines > 1 else QSizePolicy.Policy.Maximum, QSizePolicy.Policy.Fixed
        )
        self.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        if role:
            self.setProperty("role", role)

    def text(self) -> str:
        """Return all the words."""
        return self._words

    def setText(self, words: str) -> None:
        """Show other words; the same ones ask for no new layout."""
        if words == self._words:
            return
        self._words = words
        self.updateGeometry()
        self._elide()

    def sizeHint(self) -> QSize:
        """Return the room for all the words, in as many lines as there may be."""
        margins, metrics = self.contentsMargins(), self.fontMetrics()
        wide = metrics.horizontalAdvance(self._words) + margins.left() + margins.right() + 2
        return QSize(wide if self._lines == 1 else 40, self._lines * metrics.lineSpacing() + 2)

    def minimumSizeHint(self) -> QSize:
        """Return the room for a few of them."""
        return QSize(min(self.sizeHint().width(), 40), self.sizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Show what fits."""
        super().resizeEvent(event)
        self._elide()

    def changeEvent(self, event: QEvent) -> None:
        """Show what fits in another font."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._elide()

    def _elide(self) -> None:
        room, metrics = self.contentsRect().width(), self.fontMetrics()
        shown: list[str] = []
        rest, most = self._words, self._most if self.window().height() > _HIGH_WINDOW_PX else self._least
        while rest and len(shown) < most - 1:
            line, rest = _first_line(rest, metrics, room)
            shown.append(line)
        whole = metrics.horizontalAdvance(rest) <= room and "\n" not in rest
        shown.append(
            rest if whole else metrics.elidedText(rest.replace("\n", " "), Qt.TextElideMode.ElideRight, room)
        )
        text = "\n".join(shown).rstrip("\n")
        if QLabel.text(self) != text:
            super().setText(text)
        if self._lines != (tall := max(self._least, text.count("\n") + 1)):
            self._lines = tall
            self.updateGeometry()
        self.setToolTip("" if whole else self._words)
        self.setAccessibleDescription(self._words)


def _first_line(words: str, metrics: QFontMetrics, room: int) -> tuple[str, str]:
    """Return the words that fit into a line, and those that do not."""
    line, _, below = words.partition("\n")
    parts, count = line.split(" "), 1
    while count < len(parts) and metrics.horizontalAdvance(" ".join(parts[: count + 1])) <= room:
        count += 1
    left = " ".join(parts[count:])
    return " ".join(parts[:count]), f"{left}\n{below}" if left and below else left or below


def called(widget: _Field, name: str, tip: str = "") -> _Field:
    """Tell a screen reader what a widget is called, and the pointer what it is for."""
    widget.setAccessibleName(name)
    if tip:
        widget.setToolTip(tip)
    return widget


def named(field: _Field, name: str, *, tip: str | None = None) -> _Field:
    """Make a field as high as a glove needs it, call it by a name, and let it speak when it is complete."""
    field.setMinimumHeight(HIGH)
    field.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    called(field, name, name if tip is None else tip)
    if isinstance(field, QAbstractSpinBox):
        field.setKeyboardTracking(False)
    return field


def choice(
    entries: Iterable[tuple[str, Any]], name: str, *, short: bool = False, tip: str | None = None
) -> QComboBox:
    """Return a list of choices, words and what they stand for; `short`: it may be narrower than its longest words."""
    made = QComboBox()
    for words, value in entries:
        made.addItem(words, value)
    made.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)  # also in a font that comes later
    if short:
        made.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        made.setMinimumContentsLength(_SHORT)
        made.currentTextChanged.connect(made.setToolTip)
    return named(made, name, tip=tip)


class FoldRow(QLayout):
    """Parts beside each other while there is room, and the others in lines below; each line is as wide as there is."""

    def __init__(self, space: int = 6) -> None:
        super().__init__()
        self.parts: list[QWidget] = []  # for who only wants to know them: items belong to Qt
        self._items: list[QLayoutItem] = []
        self._stretches: list[int] = []
        self.setSpacing(space)
        self.setContentsMargins(0, 0, 0, 0)

    def add(self, part: QWidget, stretch: int = 0, alignment: Qt.AlignmentFlag | None = None) -> None:
        """Put a part at the end; `stretch`: its share of the room that is left."""
        self.addWidget(part)
        self._stretches[-1] = stretch
        self.parts.append(part)
        if alignment is not None:
            self._items[-1].setAlignment(alignment)

    # ---- what Qt asks for --------------------------------------------------------------------------

    def addItem(self, item: QLayoutItem) -> None:
        """Take an item."""
        self._items.append(item)
        self._stretches.append(0)

    def count(self) -> int:
        """Return how many there are."""
        self._forget_deleted()
        return len(self._items)

    def itemAt(self, index: int) -> QLayoutItem | None:
        """Return one of them."""
        self._forget_deleted()
        return self._items[index] if 0 <= index < len(self._items) else None

    def takeAt(self, index: int) -> QLayoutItem | None:
        """Take one out."""
        self._forget_deleted()
        if not 0 <= index < len(self._items):
            return None
        del self._stretches[index]
        return self._items.pop(index)

    def expandingDirections(self) -> Qt.Orientation:
        """Return that it takes the width."""
        return Qt.Orientation.Horizontal

    def hasHeightForWidth(self) -> bool:
        """Return that it folds."""
        return True

    def heightForWidth(self, width: int) -> int:
        """Return how high its lines are together."""
        return self._lay(QRect(0, 0, width, 0), place=False)

    def sizeHint(self) -> QSize:
        """Return the size of one line."""
        shown = [item.sizeHint() for item in self._shown()]
        return self._around(
            sum(each.width() for each in shown) + self.spacing() * max(len(shown) - 1, 0),
            max((each.height() for each in shown), default=0),
        )

    def minimumSize(self) -> QSize:
        """Return the size of its widest part alone."""
        shown = [item.minimumSize() for item in self._shown()]
        return self._around(
            max((each.width() for each in shown), default=0),
            max((each.height() for each in shown), default=0),
        )

    def setGeometry(self, rect: QRect) -> None:
        """Put every part into its place."""
        super().setGeometry(rect)
        self._lay(rect, place=True)

    # ---- lines -------------------------------------------------------------------------------------

    def _forget_deleted(self) -> None:
        """Forget items that went with the widget that they lie in: Qt asks once more while it takes that down."""
        if not all(map(isValid, self._items)):
            there = [pair for pair in zip(self._items, self._stretches, strict=True) if isValid(pair[0])]
            self._items, self._stretches = [each for each, _ in there], [each for _, each in there]

    def _shown(self) -> list[QLayoutItem]:
        self._forget_deleted()
        return [item for item in self._items if not item.isEmpty()]

    def _around(self, width: int, height: int) -> QSize:
        margins = self.contentsMargins()
        return QSize(width + margins.left() + margins.right(), height + margins.top() + margins.bottom())

    def _lay(self, rect: QRect, *, place: bool) -> int:
        margins, space = self.contentsMargins(), self.spacing()
        left, wide = rect.x() + margins.left(), rect.width() - margins.left() - margins.right()
        top = rect.y() + margins.top()
        for line in self._lines(wide):
            needs = [min(_least_width(item), wide) for item, _ in line]
            spare = max(wide - sum(needs) - space * (len(line) - 1), 0)
            shares = [stretch for _, stretch in line]
            if not any(shares):  # nobody asks: a part that takes what it gets, or else all
                shares = [int(_takes_width(item)) for item, _ in line]
            widths = _shared(needs, spare, shares)
            heights = [
                item.heightForWidth(width) if item.hasHeightForWidth() else item.sizeHint().height()
                for (item, _), width in zip(line, widths, strict=True)
            ]
            high, x = max(heights), left
            for (item, _), width in zip(line, widths, strict=True):
                if place:
                    item.setGeometry(QRect(x, top, width, high))
                x += width + space
            top += high + space
        return max(top - space, rect.y() + margins.top()) - rect.y() + margins.bottom()

    def _lines(self, wide: int) -> list[list[tuple[QLayoutItem, int]]]:
        self._forget_deleted()
        lines: list[list[tuple[QLayoutItem, int]]] = []
        left = -1
        for item, stretch in zip(self._items, self._stretches, strict=True):
            if item.isEmpty():
                continue
            need = _least_width(item)
            if left < need or not lines:
                lines.append([])
                left = wide
            lines[-1].append((item, stretch))
            left -= need + self.spacing()
        return lines


def _least_width(item: QLayoutItem) -> int:
    """Return how narrow a part may be: a button as its words are long, though Qt would let it be narrower."""
    widget = item.widget()
    hint = item.minimumSize().width()
    if isinstance(widget, QAbstractButton) and widget.sizePolicy().horizontalPolicy() is not _IGNORED:
        hint = max(hint, widget.sizeHint().width())
    return hint


def _takes_width(item: QLayoutItem) -> bool:
    widget = item.widget()
    return isinstance(widget, QPushButton) or bool(item.expandingDirections() & Qt.Orientation.Horizontal)


def _shared(needs: list[int], spare: int, shares: list[int]) -> list[int]:
    """Return widths: each what it needs; those with a share grow towards their part of the whole."""
    whole = sum(shares)
    if not whole:
        return needs
    total = spare + sum(need for need, share in zip(needs, shares, strict=True) if share)
    widths, open_ones = list(needs), [at for at, share in enumerate(shares) if share]
    while open_ones:
        unit = total / sum(shares[at] for at in open_ones)
        short = [at for at in open_ones if needs[at] > unit * shares[at]]
        if not short:
            for at in open_ones:
                widths[at] = int(unit * shares[at])
            break
        for at in short:
            total -= needs[at]
            open_ones.remove(at)
    return widths


def row(
    *parts: QWidget | tuple[QWidget, int] | tuple[QWidget, int, Qt.AlignmentFlag], space: int = 6
) -> FoldRow:
    """Return parts beside each other, which fold into lines where that is too wide; one with a number is stretched."""
    made = FoldRow(space)
    for each in parts:
        made.add(*each) if isinstance(each, tuple) else made.add(each)
    return made


def column(
    owner: QWidget | None, *parts: _Part, margins: _Margins = (0, 0, 0, 0), space: int = 8
) -> QVBoxLayout:
    """Lay parts out one below the other; one with a number is stretched, a number alone is room that is."""
    return _filled(QVBoxLayout() if owner is None else QVBoxLayout(owner), parts, margins, space)


def beside(
    owner: QWidget | None, *parts: _Part, margins: _Margins = (0, 0, 0, 0), space: int = -1
) -> QHBoxLayout:
    """Lay parts out beside each other, always in one line; numbers are as in `column`."""
    return _filled(QHBoxLayout() if owner is None else QHBoxLayout(owner), parts, margins, space)


def _filled(made: _Box, parts: Iterable[_Part], margins: _Margins, space: int) -> _Box:
    made.setContentsMargins(*margins)
    made.setSpacing(space)
    for each in parts:
        part, *how = each if isinstance(each, tuple) else (each,)
        add: Any = made.addWidget if isinstance(part, QWidget) else made.addLayout
        if isinstance(part, int):
            add = made.addStretch
        add(part, *how)
    return made


def stacked(owner: QWidget, *parts: _Part) -> QVBoxLayout:
    """Lay parts out one below the other, with the margins and the space that the style has."""
    return column(owner, *parts, margins=STYLED, space=-1)


def panel(*parts: _Part, margins: _Margins = (0, 0, 0, 0), space: int = 8) -> QWidget:
    """Return parts one below the other as one widget; see `column`."""
    made = QWidget()
    column(made, *parts, margins=margins, space=space)
    return made


def form(
    owner: QWidget | None = None,
    *,
    top: int = 0,
    space: int = -1,
    wrap: QFormLayout.RowWrapPolicy = QFormLayout.RowWrapPolicy.WrapLongRows,
) -> QFormLayout:
    """Return a form: fields as wide as there is room, and below their labels where that is too little."""
    made = QFormLayout(owner) if owner is not None else QFormLayout()
    made.setContentsMargins(0, top, 0, 0)
    made.setSpacing(space)
    made.setRowWrapPolicy(wrap)
    made.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
    return made


def asked_file(owner: QWidget, title: str, kinds: str, place: str = "", *, save: bool = False) -> Path | None:
    """Ask for a file to open or to save; None: none was chosen."""
    ask = QFileDialog.getSaveFileName if save else QFileDialog.getOpenFileName
    name, _ = ask(owner, title, place, kinds)
    return Path(name) if name else None


def dropped_files(event: QDropEvent) -> list[Path]:
    """Accept files that are dragged or dropped, and return them; what else there is stays refused."""
    files = [Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()]
    if files:
        event.acceptProposedAction()
    return files


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

    def minimumSizeHint(self) -> QSize:
        """Return the room of one line: the rest is scrolled to."""
        return QSize(super().minimumSizeHint().width(), HIGH)


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
    _order_keys(root)


def _order_keys(root: QWidget) -> None:
    """Let the tabulator key go through the layouts as they are read, not as their parts happened to be made."""
    stops = [each for each in _as_laid_out(root) if each.focusPolicy() & Qt.FocusPolicy.TabFocus]
    for one, other in pairwise(stops):
        QWidget.setTabOrder(one, other)


def _as_laid_out(widget: QWidget) -> Iterator[QWidget]:
    yield widget
    below: Sequence[QWidget | None]
    if isinstance(widget, QScrollArea):
        below = [widget.widget()]
    elif isinstance(widget, QTabWidget):
        below = [widget.tabBar(), *(widget.widget(index) for index in range(widget.count()))]
    else:
        below = _parts(widget.layout())
    for each in below:
        if each is not None:
            yield from _as_laid_out(each)


def _parts(layout: QLayout | None) -> list[QWidget]:
    if isinstance(layout, FoldRow):
        return [each for each in layout.parts if isValid(each)]
    found: list[QWidget] = []
    for index in range(0 if layout is None else layout.count()):
        item = layout.itemAt(index)  # type: ignore[union-attr]
        if item is not None and (widget := item.widget()) is not None:
            found.append(widget)
        elif item is not None:
            found += _parts(item.layout())
    return found


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


class StretchedColumn(QObject):
    """
    Lets one column of a table take the room that is left; where there is none, all are whole and the table scrolls.

    Parameters
    ----------
    table : QTableView
    column : int
    """

    def __init__(self, table: QTableView, column: int) -> None:
        super().__init__(table)
        self._table, self._column = table, column
        header = table.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        table.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAsNeeded)
        table.setHorizontalScrollMode(QTableView.ScrollMode.ScrollPerPixel)
        header.sectionResized.connect(lambda number, _before, _now: self._fit() if number != column else None)
        table.viewport().installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Fit it with the table."""
        if event.type() == QEvent.Type.Resize:
            self._fit()
        return super().eventFilter(watched, event)

    def _fit(self) -> None:
        header, mode = self._table.horizontalHeader(), QHeaderView.ResizeMode
        others = sum(header.sectionSize(each) for each in range(header.count()) if each != self._column)
        need = max(header.sectionSizeHint(self._column), self._table.sizeHintForColumn(self._column))
        wanted = mode.Stretch if others + need <= self._table.viewport().width() else mode.ResizeToContents
        if header.sectionResizeMode(self._column) != wanted:
            header.setSectionResizeMode(self._column, wanted)


class RowsModel(QAbstractTableModel):
    """A table of rows that are put in as a whole; what a cell shows is its heirs' matter."""

    rows: tuple[Any, ...] = ()
    columns = 4

    def show_rows(self, rows: tuple[Any, ...]) -> None:
        """Show other rows; where their number stays, a view keeps what is chosen or being edited in it."""
        if len(rows) != len(self.rows):
            self.beginResetModel()
            self.rows = rows
            self.endResetModel()
        elif rows != self.rows:
            self.rows = rows
            self.dataChanged.emit(self.index(0, 0), self.index(len(rows) - 1, self.columns - 1))

    def rowCount(self, parent: _Index = QModelIndex()) -> int:  # noqa: B008
        """Return how many rows there are."""
        return 0 if parent.isValid() else len(self.rows)

    def columnCount(self, parent: _Index = QModelIndex()) -> int:  # noqa: B008
        """Return how many columns there are."""
        return 0 if parent.isValid() else self.columns


def plain_table(table: QTableView) -> None:
    """Have a table look as all do: whole rows, no grid, low lines; the tabulator key leaves it."""
    table.setSelectionBehavior(QTableView.SelectionBehavior.SelectRows)
    table.setShowGrid(False)
    table.setTabKeyNavigation(False)
    table.verticalHeader().hide()
    table.verticalHeader().setDefaultSectionSize(28)
    table.horizontalHeader().setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)


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
                # The usual one takes the focus by the wheel.
                widget.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
                widget.installEventFilter(guard)

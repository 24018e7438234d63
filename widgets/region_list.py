"""The list of regions: names, colours, areas, what nothing can touch, and their priority, which is their order."""

from collections.abc import Callable, Collection, Sequence
from typing import Any

from PySide6.QtCore import (
    QItemSelectionModel,
    QMimeData,
    QModelIndex,
    QPersistentModelIndex,
    QSignalBlocker,
    QSize,
    Qt,
    Signal,
)
from PySide6.QtGui import QColor, QIcon, QPen, QPixmap
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QColorDialog,
    QHeaderView,
    QMenu,
    QToolButton,
    QTreeView,
    QWidget,
)

from contactbench.pipeline.mesh.colours import PALETTE
from contactbench.pipeline.workbench.regions import RegionRow
from contactbench.widgets.controls import FoldRow, RowsModel, add_key, column, push_button, row, tool_button
from contactbench.widgets.messages import filled, number
from contactbench.widgets.theme import colours, is_dark, smooth_painter

Index = QModelIndex | QPersistentModelIndex


PRIORITY, NAME, AREA, FACETS = range(4)
_MIME = "application/x-contactbench-region"
_SWATCH, _HIGH = 20, 32  # px
_SHORTEST, _TALLEST = 4, 8  # rows that the list is high
_NARROWEST_PX = 56  # of a column: four digits and a point


def swatch(colour: str, dark: bool, crossed: bool = False) -> QIcon:
    """Return a patch of a colour with a border that shows on any ground; crossed out like the facets in the scene."""
    image = QPixmap(QSize(2 * _SWATCH, 2 * _SWATCH))
    image.setDevicePixelRatio(2)
    image.fill(Qt.GlobalColor.transparent)
    painter = smooth_painter(image)
    painter.setPen(QPen(QColor(colours(dark).muted), 1))
    painter.setBrush(QColor(colour))
    painter.drawRoundedRect(1, 1, _SWATCH - 2, _SWATCH - 2, 4, 4)
    if crossed:
        painter.setPen(QPen(QColor("#2b2f33"), 1.5))
        low, high = 4, _SWATCH - 4
        painter.drawLine(low, low, high, high)
        painter.drawLine(low, high, high, low)
    painter.end()
    icon = QIcon()
    # A chosen row must not tint the colour that the patch is there to show.
    for mode in (QIcon.Mode.Normal, QIcon.Mode.Selected, QIcon.Mode.Active):
        icon.addPixmap(image, mode)
    return icon


class RegionRows(RowsModel):
    """What `RegionListWidget` shows; edits are asked for by signals, never made here."""

    renamed = Signal(int, str)  # rank, name
    moved = Signal(int, int)  # rank, new rank

    rows: tuple[RegionRow, ...]

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        """Qt's."""
        if orientation is not Qt.Orientation.Horizontal:
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return (self.tr("Priority"), self.tr("Name"), self.tr("cm²"), self.tr("Facets"))[section]
        if role == Qt.ItemDataRole.TextAlignmentRole and section >= AREA:
            return Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        return None

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """Qt's."""
        row, column = self.rows[index.row()], index.column()
        if role == Qt.ItemDataRole.DisplayRole:
            name = self.tr("✕ {0} (untouchable)").format(row.name) if row.untouchable else row.name
            return (str(index.row() + 1), name, number(1e4 * row.area, ".2f"), number(row.facets, ","))[
                column
            ]
        if role == Qt.ItemDataRole.EditRole and column == NAME:
            return row.name
        if role == Qt.ItemDataRole.DecorationRole and column == PRIORITY:
            return swatch(row.colour, is_dark(), row.untouchable)
        if role == Qt.ItemDataRole.TextAlignmentRole and column >= AREA:
            return Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        if role == Qt.ItemDataRole.SizeHintRole:
            return QSize(_SWATCH, _HIGH)
        if role == Qt.ItemDataRole.ToolTipRole:
            return self._tip(index.row(), column)
        if role == Qt.ItemDataRole.AccessibleTextRole:
            words = self.tr("{0}, priority {1}, {2:.2f} cm²")
            if row.untouchable:
                words = self.tr("{0}, untouchable, priority {1}, {2:.2f} cm²")
            return filled(words, row.name, index.row() + 1, 1e4 * row.area)
        return None

    def _tip(self, row: int, column: int) -> str:
        if column == PRIORITY:
            return self.tr("Priority {0}, colour {1}. Click to choose another colour.").format(
                row + 1, self.rows[row].colour
            )
        if column == NAME:
            return self.tr("Double-click to rename. Drag or press Alt+Up or Alt+Down to change the priority.")
        return filled(
            self.tr("Area: {0:.1f} mm²; facets: {1:,}."), 1e6 * self.rows[row].area, self.rows[row].facets
        )

    def setData(self, index: Index, value: Any, role: int = Qt.ItemDataRole.EditRole) -> bool:
        """Ask for another name."""
        if role != Qt.ItemDataRole.EditRole or index.column() != NAME:
            return False
        if str(value) != self.rows[index.row()].name:
            self.renamed.emit(index.row() + 1, str(value))
        return True

    def flags(self, index: Index) -> Qt.ItemFlag:
        """Qt's."""
        flag = Qt.ItemFlag
        if not index.isValid():
            return flag.ItemIsDropEnabled
        usual = flag.ItemIsEnabled | flag.ItemIsSelectable | flag.ItemIsDragEnabled
        return usual | flag.ItemIsEditable if index.column() == NAME else usual

    # ---- dragging ----------------------------------------------------------------------------

    def supportedDropActions(self) -> Qt.DropAction:
        """Qt's."""
        return Qt.DropAction.MoveAction

    def mimeTypes(self) -> list[str]:
        """Qt's."""
        return [_MIME]

    def mimeData(self, indexes: Sequence[QModelIndex]) -> QMimeData:
        """Qt's."""
        data = QMimeData()
        data.setData(_MIME, str(indexes[0].row() + 1).encode())
        return data

    def dropMimeData(
        self, data: QMimeData, _action: Qt.DropAction, row: int, _column: int, parent: Index
    ) -> bool:
        """Ask for another order; False in any case, or the view would remove the row that was dragged."""
        if data.hasFormat(_MIME):
            rank = int(bytes(data.data(_MIME).data()))
            before = row if row >= 0 else (parent.row() if parent.isValid() else len(self.rows))
            to = before + 1 if before < rank else before
            if to != rank:
                self.moved.emit(rank, to)
        return False


class ColourMenu(QMenu):
    """
    A menu of colours.

    Parameters
    ----------
    present : str
        The colour that there is, ``#rrggbb``.
    taken : collection of str
        Colours of other regions: they are said to be in use.
    """

    chosen = Signal(str)  # #rrggbb

    def __init__(self, present: str, taken: Collection[str], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._present = present
        for colour, name in zip(PALETTE, self._names(), strict=True):
            text = self.tr("{0} (in use)").format(name) if colour in taken else name
            action = self.addAction(swatch(colour, is_dark()), text)
            action.setCheckable(True)
            action.setChecked(colour == present)
            action.triggered.connect(lambda _=False, colour=colour: self.chosen.emit(colour))
        self.addSeparator()
        self.addAction(self.tr("Other colour…")).triggered.connect(self._ask)

    def _names(self) -> tuple[str, ...]:
        return (
            self.tr("Orange"),
            self.tr("Sky blue"),
            self.tr("Green"),
            self.tr("Yellow"),
            self.tr("Blue"),
            self.tr("Red-orange"),
            self.tr("Pink"),
        )

    def _ask(self) -> None:
        parent = self.parentWidget()
        colour = QColorDialog.getColor(QColor(self._present), parent, self.tr("Region colour"))
        if colour.isValid():
            self.chosen.emit(colour.name())


class RegionListWidget(QWidget):
    """
    Regions that can be chosen, named, coloured, marked, put in order, added and removed.

    It changes nothing itself: it asks by signals, and shows what it is given by `show_rows`. Ranks count from 1.
    """

    chosen = Signal(int)  # rank; 0: none
    renamed = Signal(int, str)
    recoloured = Signal(int, str)  # rank, #rrggbb
    marked = Signal(int, bool)  # rank, whether nothing can touch it
    moved = Signal(int, int)  # rank, new rank
    add_asked = Signal()
    remove_asked = Signal(int)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.rows = RegionRows()
        self.view = self._make_view()
        column(self, self.view, self._make_buttons(), self._make_mark(), space=6)
        self.rows.renamed.connect(self.renamed)
        self.rows.moved.connect(self.moved)
        self.show_rows(())

    # ---- what it shows -----------------------------------------------------------------------

    @property
    def rank(self) -> int:
        """Of the region that is chosen; 0: none."""
        index = self.view.currentIndex()
        return index.row() + 1 if index.isValid() else 0

    def show_rows(self, rows: tuple[RegionRow, ...], rank: int | None = None) -> None:
        """Show these regions and choose the one of a rank; left out, the choice stays as far as it can."""
        before = self.rank
        self.rows.show_rows(rows)
        wanted = min(before if rank is None else rank, len(rows))
        if wanted != self.rank:
            self.choose(wanted)
        elif self.rank != before:  # a reset takes the choice without a word
            self.chosen.emit(self.rank)
        self._show_buttons()
        self._fit_height()

    def choose(self, rank: int) -> None:
        """Choose a region; 0: none."""
        index = self.rows.index(rank - 1, NAME) if rank else QModelIndex()
        flag = QItemSelectionModel.SelectionFlag
        self.view.selectionModel().setCurrentIndex(index, flag.ClearAndSelect | flag.Rows)

    # ---- its parts ---------------------------------------------------------------------------

    def _make_view(self) -> QTreeView:
        view = QTreeView(rootIsDecorated=False, uniformRowHeights=True, allColumnsShowFocus=True)
        view.setModel(self.rows)
        view.setIconSize(QSize(20, 20))
        view.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        view.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        view.setDragDropMode(QAbstractItemView.DragDropMode.InternalMove)
        view.setDropIndicatorShown(True)
        edit = QAbstractItemView.EditTrigger
        view.setEditTriggers(edit.DoubleClicked | edit.EditKeyPressed)
        view.setAccessibleName(self.tr("Regions, highest priority first"))
        header = view.header()
        header.setStretchLastSection(False)
        header.setSectionsMovable(False)
        header.setMinimumSectionSize(_NARROWEST_PX)
        for place in (PRIORITY, AREA, FACETS):
            header.setSectionResizeMode(place, QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(NAME, QHeaderView.ResizeMode.Stretch)
        view.clicked.connect(self._clicked)
        view.selectionModel().currentRowChanged.connect(self._chosen)
        return view

    def _make_buttons(self) -> FoldRow:
        self.add_button = push_button(
            self.tr("Add"), self.add_asked.emit, "add", tip=self.tr("Add a region with the lowest priority")
        )
        self.colour_button = self._tool("", self.tr("Choose colour"), self._ask_colour)
        self.colour_button.setText(self.tr("Colour"))
        self.up_button = self._tool("up", self.tr("Raise the priority (Alt+Up)"), lambda: self._move(-1))
        self.down_button = self._tool("down", self.tr("Lower the priority (Alt+Down)"), lambda: self._move(1))
        self.remove_button = self._tool(
            "remove", self.tr("Remove the region; its facets become unassigned"), self._remove
        )
        add_key(self, self.tr("Raise region priority"), "Alt+Up", lambda: self._move(-1))
        add_key(self, self.tr("Lower region priority"), "Alt+Down", lambda: self._move(1))
        tools = (self.colour_button, self.up_button, self.down_button, self.remove_button)
        return row((self.add_button, 1), *tools, space=4)

    def _make_mark(self) -> QCheckBox:
        tip = self.tr(
            "These facets cannot be touched, for example under a clamp or drape. Contacts there are"
            " treated as 1000 times less likely."
        )
        self.untouchable = QCheckBox(self.tr("Untouchable"))
        self.untouchable.setToolTip(tip)
        self.untouchable.setMinimumHeight(36)
        self.untouchable.toggled.connect(self._mark)  # by the accessibility bus it is never clicked
        return self.untouchable

    def _tool(self, picture: str, tip: str, action: Callable[[], None]) -> QToolButton:
        button = tool_button(picture, tip, action)
        button.setMinimumSize(36, 36)
        button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        return button

    # ---- what is done to it ------------------------------------------------------------------

    def _clicked(self, index: QModelIndex) -> None:
        if index.column() == PRIORITY:
            self._ask_colour()

    def _ask_colour(self) -> None:
        rank = self.rank
        if not rank:
            return
        rows = self.rows.rows
        others = {row.colour for number, row in enumerate(rows, 1) if number != rank}
        menu = ColourMenu(rows[rank - 1].colour, others, self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.chosen.connect(lambda colour: self.recoloured.emit(rank, colour))
        rect = self.view.visualRect(self.rows.index(rank - 1, PRIORITY))
        menu.popup(self.view.viewport().mapToGlobal(rect.bottomLeft()))

    def _move(self, by: int) -> None:
        rank = self.rank
        if rank and 1 <= rank + by <= len(self.rows.rows):
            self.moved.emit(rank, rank + by)

    def _mark(self, on: bool) -> None:
        if self.rank:
            self.marked.emit(self.rank, on)

    def _remove(self) -> None:
        if self.rank:
            self.remove_asked.emit(self.rank)

    def _chosen(self, *_: object) -> None:
        self._show_buttons()
        self.chosen.emit(self.rank)

    def _show_buttons(self) -> None:
        rank = self.rank
        self.up_button.setEnabled(rank > 1)
        self.down_button.setEnabled(0 < rank < len(self.rows.rows))
        self.colour_button.setEnabled(rank > 0)
        self.remove_button.setEnabled(rank > 0)
        self.untouchable.setEnabled(rank > 0)
        with QSignalBlocker(self.untouchable):
            self.untouchable.setChecked(rank > 0 and self.rows.rows[rank - 1].untouchable)

    def _fit_height(self) -> None:
        count = min(max(len(self.rows.rows), _SHORTEST), _TALLEST)
        row = max(self.view.sizeHintForRow(0), 30)
        self.view.setFixedHeight(self.view.header().sizeHint().height() + count * row + 4)

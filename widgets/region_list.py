"""The list of regions: names, colours, areas, what nothing can touch, and their priority, which is their order."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QItemSelectionModel, QModelIndex, QSize, Qt, Signal
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QHBoxLayout,
    QHeaderView,
    QPushButton,
    QToolButton,
    QTreeView,
    QVBoxLayout,
    QWidget,
)

from contactbench.widgets.icons import icon
from contactbench.widgets.region_list_colour import ColourMenu
from contactbench.widgets.region_list_rows import AREA, FACETS, NAME, PRIORITY, RegionRows

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.workbench.regions import RegionRow

_SHORTEST, _TALLEST = 4, 8  # rows that the list is high
_NARROWEST_PX = 56  # of a column: four digits and a point


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
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addWidget(self.view)
        layout.addLayout(self._make_buttons())
        layout.addWidget(self._make_mark())
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

    def edit_name(self) -> None:
        """Let the name of the chosen region be typed."""
        if self.rank:
            self.view.setFocus()
            self.view.edit(self.rows.index(self.rank - 1, NAME))

    # ---- its parts ---------------------------------------------------------------------------

    def _make_view(self) -> QTreeView:
        view = QTreeView()
        view.setModel(self.rows)
        view.setRootIsDecorated(False)
        view.setUniformRowHeights(True)
        view.setAllColumnsShowFocus(True)
        view.setIconSize(QSize(20, 20))
        view.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        view.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        view.setDragDropMode(QAbstractItemView.DragDropMode.InternalMove)
        view.setDropIndicatorShown(True)
        edit = QAbstractItemView.EditTrigger
        view.setEditTriggers(edit.DoubleClicked | edit.EditKeyPressed)
        view.setAccessibleName(self.tr("Regions, the first priority first"))
        header = view.header()
        header.setStretchLastSection(False)
        header.setSectionsMovable(False)
        header.setMinimumSectionSize(_NARROWEST_PX)
        for column in (PRIORITY, AREA, FACETS):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(NAME, QHeaderView.ResizeMode.Stretch)
        view.clicked.connect(self._clicked)
        view.selectionModel().currentRowChanged.connect(self._chosen)
        return view

    def _make_buttons(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(4)
        self.add_button = QPushButton(self.tr("Add"))
        self.add_button.setToolTip(self.tr("Add a region with the last priority"))
        self.add_button.setMinimumHeight(36)
        self.add_button.clicked.connect(self.add_asked)
        row.addWidget(self.add_button, 1)
        self.colour_button = self._tool(self.tr("Colour"), self.tr("Choose the colour"), self._ask_colour)
        self.up_button = self._tool("", self.tr("Raise the priority (Alt+Up)"), lambda: self._move(-1))
        self.down_button = self._tool("", self.tr("Lower the priority (Alt+Down)"), lambda: self._move(1))
        self.remove_button = self._tool(
            "", self.tr("Remove the region; its facets belong to none then"), self._remove
        )
        for button in (self.colour_button, self.up_button, self.down_button, self.remove_button):
            row.addWidget(button)
        self._icons = (
            (self.add_button, "add"),
            (self.up_button, "up"),
            (self.down_button, "down"),
            (self.remove_button, "remove"),
        )
        for each, name in self._icons:
            each.setIcon(icon(name))
        self._act(self.tr("Raise the region's priority"), "Alt+Up", lambda: self._move(-1))
        self._act(self.tr("Lower the region's priority"), "Alt+Down", lambda: self._move(1))
        return row

    def _make_mark(self) -> QCheckBox:
        self.untouchable = QCheckBox(self.tr("Untouchable"))
        self.untouchable.setToolTip(
            self.tr(
                "Nothing can touch these facets: a clamp or a drape hides them. Contacts there count as 1000 times"
                " less likely."
            )
        )
        self.untouchable.setMinimumHeight(36)
        self.untouchable.clicked.connect(self._mark)
        return self.untouchable

    def _tool(self, text: str, tip: str, action: Callable[[], None]) -> QToolButton:
        button = QToolButton()
        button.setText(text)
        button.setToolTip(tip)
        button.setAccessibleName(tip)
        button.setMinimumSize(36, 36)
        button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        button.clicked.connect(lambda _=False: action())
        return button

    def _act(self, text: str, keys: str, action: Callable[[], None]) -> None:
        made = QAction(text, self)
        made.setShortcut(QKeySequence(keys))
        made.triggered.connect(lambda _=False: action())
        self.addAction(made)

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
        self.untouchable.setChecked(rank > 0 and self.rows.rows[rank - 1].untouchable)

    def _fit_height(self) -> None:
        count = min(max(len(self.rows.rows), _SHORTEST), _TALLEST)
        row = max(self.view.sizeHintForRow(0), 30)
        self.view.setFixedHeight(self.view.header().sizeHint().height() + count * row + 4)

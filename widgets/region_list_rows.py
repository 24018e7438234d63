"""The rows of a list of regions, for a view that can be edited and rearranged by dragging."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import (
    QAbstractTableModel,
    QMimeData,
    QModelIndex,
    QPersistentModelIndex,
    QSize,
    Qt,
    Signal,
)
from PySide6.QtGui import QColor, QIcon, QPainter, QPen, QPixmap

from contactbench.widgets.theme import colours, is_dark

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.workbench.regions import RegionRow

    Index = QModelIndex | QPersistentModelIndex

PRIORITY, NAME, AREA, FACETS = range(4)
_MIME = "application/x-contactbench-region"
_SWATCH, _HIGH = 20, 32  # px


def swatch(colour: str, dark: bool, crossed: bool = False) -> QIcon:
    """Return a patch of a colour with a border that shows on any ground; crossed out like the facets in the scene."""
    image = QPixmap(QSize(2 * _SWATCH, 2 * _SWATCH))
    image.setDevicePixelRatio(2)
    image.fill(Qt.GlobalColor.transparent)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
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


class RegionRows(QAbstractTableModel):
    """What `RegionListWidget` shows; edits are asked for by signals, never made here."""

    renamed = Signal(int, str)  # rank, name
    moved = Signal(int, int)  # rank, new rank

    def __init__(self) -> None:
        super().__init__()
        self.rows: tuple[RegionRow, ...] = ()

    def show_rows(self, rows: tuple[RegionRow, ...]) -> None:
        """Show other rows; where their number stays, a view keeps what is chosen or being edited in it."""
        if rows == self.rows:
            return
        if len(rows) != len(self.rows):
            self.beginResetModel()
            self.rows = rows
            self.endResetModel()
            return
        self.rows = rows
        self.dataChanged.emit(self.index(0, 0), self.index(len(rows) - 1, FACETS))

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        """Qt's."""
        return 0 if parent.isValid() else len(self.rows)

    def columnCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        """Qt's."""
        return 0 if parent.isValid() else 4

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
            return (str(index.row() + 1), name, f"{1e4 * row.area:.2f}", f"{row.facets:,}")[column]
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
            words = (
                self.tr("{0}, untouchable, priority {1}, {2:.2f} cm²")
                if row.untouchable
                else self.tr("{0}, priority {1}, {2:.2f} cm²")
            )
            return words.format(row.name, index.row() + 1, 1e4 * row.area)
        return None

    def _tip(self, row: int, column: int) -> str:
        if column == PRIORITY:
            return self.tr("Priority {0}, colour {1}. Click to choose another colour.").format(
                row + 1, self.rows[row].colour
            )
        if column == NAME:
            return self.tr("Double-click to rename; drag, or Alt+Up and Alt+Down, to change the priority.")
        return self.tr("Area: {0:.1f} mm²; facets: {1:,}.").format(
            1e6 * self.rows[row].area, self.rows[row].facets
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

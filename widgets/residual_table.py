"""The poses of a gravity calibration, and how far each is from what the others say."""

import math

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QPoint, QRect, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter
from PySide6.QtWidgets import (
    QMenu,
    QSizePolicy,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableView,
    QWidget,
)

from contactbench.pipeline.workbench.gravity_fit import PoseRow, PoseState
from contactbench.widgets.controls import RowsModel, StretchedColumn, plain_table
from contactbench.widgets.messages import filled, translated
from contactbench.widgets.theme import colours, icon, is_dark

NAME, STANDS, SIGMAS, STATE = range(4)
_FULL = 6.0  # sigmas that fill the bar
_FEW = 3.0  # beyond, a pose is worth a look
_BAR = Qt.ItemDataRole.UserRole
_Index = QModelIndex | QPersistentModelIndex


class PoseModel(RowsModel):
    """Poses as rows: number, how the sensor stood, residual in sigmas, state."""

    rows: tuple[PoseRow, ...]

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> object:
        """Return what a column is called."""
        if orientation is not Qt.Orientation.Horizontal:
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return (self.tr("Pose"), self.tr("Tilt"), self.tr("Residual"), self.tr("State"))[section]
        if role == Qt.ItemDataRole.ToolTipRole and section == SIGMAS:
            return self.tr(
                "Deviation of the reading from the fit to all poses, in standard deviations. About 1 is"
                " normal; check poses above 3."
            )
        return None

    def data(self, index: _Index, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        """Return what a cell shows."""
        row, column = self.rows[index.row()], index.column()
        match role:
            case Qt.ItemDataRole.DisplayRole:
                name, word = row.name.removeprefix("pose "), self._looks()[row.state][0]
                return (name, translated(row.words), self._sigmas(row), word)[column]
            case Qt.ItemDataRole.DecorationRole if column == STATE:
                return icon(*self._looks()[row.state][1:])
            case Qt.ItemDataRole.ToolTipRole:
                return self._tip(row)
            case Qt.ItemDataRole.AccessibleTextRole:
                return self.tr("{name}, {words}, residual {sigmas} sigma, {state}").format(
                    name=row.name,
                    words=translated(row.words),
                    sigmas=self._sigmas(row),
                    state=self._looks()[row.state][0],
                )
            case _ if role == _BAR:
                return row.sigmas
        return None

    def _tip(self, row: PoseRow) -> str:
        parts = [translated(row.reason)]
        if not math.isnan(row.sigmas):
            words = self.tr("force {force:.1f} sigma, torque {torque:.1f} sigma")
            parts.append(filled(words, force=row.force_sigmas, torque=row.torque_sigmas))
        if row.earlier:
            parts.append(self.tr("From the interrupted recording."))
        return "\n".join(part for part in parts if part)

    def _sigmas(self, row: PoseRow) -> str:
        return "-" if math.isnan(row.sigmas) else filled("{:.1f} σ", row.sigmas)

    def _looks(self) -> dict[PoseState, tuple[str, str, str]]:
        """Return a word for each state, its icon, and the theme's colour for that."""
        return {
            PoseState.TAKEN: (self.tr("captured"), "check", "good"),
            PoseState.LEFT_OUT: (self.tr("left out"), "remove", "muted"),
            PoseState.REJECTED: (self.tr("rejected"), "cross", "bad"),
        }


class _Bar(QStyledItemDelegate):
    """Draws a bar behind the number."""

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: _Index) -> None:
        value = index.data(_BAR)
        rect: QRect = option.rect
        if isinstance(value, float) and not math.isnan(value):
            c = colours(is_dark())
            colour = QColor(c.good if value < _FEW else c.warning)
            colour.setAlpha(90)
            width = int((rect.width() - 6) * min(value / _FULL, 1.0))
            painter.fillRect(
                QRect(rect.left() + 3, rect.top() + 5, max(width, 2), rect.height() - 10), colour
            )
        super().paint(painter, option, index)


class ResidualTable(QTableView):
    """
    Poses; Delete, Return or the menu leave the selected ones out or take them back.

    Signals
    -------
    leave_out, take_back : tuple of PoseRow
    """

    leave_out = Signal(object)
    take_back = Signal(object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._poses = PoseModel(self)
        self.setModel(self._poses)
        self.setItemDelegateForColumn(SIGMAS, _Bar(self))
        plain_table(self)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)  # it grows with its rows
        self.setAccessibleName(self.tr("Poses"))
        self.setIconSize(QSize(14, 14))
        self.horizontalHeader().setHighlightSections(False)
        StretchedColumn(self, STANDS)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.customContextMenuRequested.connect(self._open_menu)

    @property
    def rows(self) -> tuple[PoseRow, ...]:
        """What it shows."""
        return self._poses.rows

    def show_rows(self, rows: tuple[PoseRow, ...]) -> None:
        """Show other rows."""
        grew = len(rows) != len(self._poses.rows)
        self._poses.show_rows(rows)
        if grew:
            self.setFixedHeight(self.sizeHint().height())

    def sizeHint(self) -> QSize:
        """Return the height of all rows."""
        rows = max(self._poses.rowCount(), 1) * 28
        return QSize(330, rows + self.horizontalHeader().sizeHint().height() + 18)

    def selected(self) -> tuple[PoseRow, ...]:
        """Return the rows that are selected and can be changed."""
        chosen = sorted(index.row() for index in self.selectionModel().selectedRows())
        return tuple(self.rows[row] for row in chosen if self.rows[row].changeable)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Delete leaves out, Return takes back."""
        rows = self.selected()
        if event.key() in {Qt.Key.Key_Delete, Qt.Key.Key_Backspace} and rows:
            self.leave_out.emit(rows)
        elif event.key() in {Qt.Key.Key_Return, Qt.Key.Key_Enter} and rows:
            self.take_back.emit(rows)
        else:
            super().keyPressEvent(event)

    def menu(self) -> QMenu:
        """Return the menu for what is selected."""
        rows, menu = self.selected(), QMenu(self)
        out = menu.addAction(self.tr("Leave out"), lambda: self.leave_out.emit(rows))
        back = menu.addAction(self.tr("Restore"), lambda: self.take_back.emit(rows))
        out.setEnabled(any(row.state is not PoseState.LEFT_OUT for row in rows))
        back.setEnabled(any(row.state is PoseState.LEFT_OUT for row in rows))
        return menu

    def _open_menu(self, at: QPoint) -> None:
        menu = self.menu()
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(self.viewport().mapToGlobal(at))

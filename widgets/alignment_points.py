"""Places picked on the mesh, and where each of them lies in the sensor frame."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QHBoxLayout,
    QHeaderView,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from contactbench.widgets.numbers import number

FEWEST = 3
_ROW_PX, _ROWS = 30, 4


class PointTable(QWidget):
    """One row per place: what was picked in the mesh, mm, and three numbers to type, mm."""

    changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._points: list[NDArray[np.float64]] = []
        self.table = QTableWidget(0, 4)
        self.table.setHorizontalHeaderLabels([self.tr("on the mesh"), "x", "y", "z"])
        self.table.setAccessibleName(self.tr("Matching points: on the mesh and in the sensor frame, mm"))
        self.table.setToolTip(self.tr("Enter each point's position in the sensor frame, mm"))
        header = self.table.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.ResizeToContents)
        self.table.verticalHeader().setDefaultSectionSize(_ROW_PX)
        self.table.setMinimumHeight(_ROW_PX * (_ROWS + 1) + 6)
        self.table.itemChanged.connect(lambda _item: self.changed.emit())
        self.remove = QPushButton(self.tr("Remove this point"))
        self.remove.clicked.connect(self._remove)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.table)
        row = QHBoxLayout()
        row.addWidget(self.remove)
        row.addStretch()
        layout.addLayout(row)

    @property
    def complete(self) -> bool:
        """Whether there are enough places, each with three numbers."""
        return len(self._points) >= FEWEST and all(
            math.isfinite(value) for row in range(len(self._points)) for value in self._typed(row)
        )

    def add(self, point_P: NDArray[np.float64]) -> None:
        """Add a place in the mesh's frame, m."""
        self._points.append(np.array(point_P, dtype=np.float64))
        row = self.table.rowCount()
        self.table.insertRow(row)
        shown = QTableWidgetItem("  ".join(number(1e3 * value, ".1f") for value in point_P))
        shown.setFlags(Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable)
        self.table.setItem(row, 0, shown)
        for column in (1, 2, 3):
            self.table.setItem(row, column, QTableWidgetItem(""))
        self.table.setCurrentCell(row, 1)
        self.changed.emit()

    def type_in(self, row: int, millimetres: tuple[float, float, float]) -> None:
        """Write where a place lies in the sensor frame."""
        for column, value in enumerate(millimetres, 1):
            self._item(row, column).setText(number(value, "g"))

    def pairs(self) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Return places on the mesh and in the sensor frame, m."""
        return [(point, np.array(self._typed(row)) / 1e3) for row, point in enumerate(self._points)]

    def clear(self) -> None:
        """Remove all."""
        self._points.clear()
        self.table.setRowCount(0)
        self.changed.emit()

    def _remove(self) -> None:
        row = self.table.currentRow()
        if 0 <= row < len(self._points):
            del self._points[row]
            self.table.removeRow(row)
            self.changed.emit()

    def _item(self, row: int, column: int) -> QTableWidgetItem:
        item = self.table.item(row, column)
        if item is None:
            item = QTableWidgetItem("")
            self.table.setItem(row, column, item)
        return item

    def _typed(self, row: int) -> tuple[float, ...]:
        found = []
        for column in (1, 2, 3):
            item = self.table.item(row, column)
            try:
                found.append(float((item.text() if item is not None else "").replace(",", ".")))
            except ValueError:
                found.append(math.nan)
        return tuple(found)

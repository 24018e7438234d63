"""The ways to say where the mesh lies in the sensor frame: numbers, points, the flange face, touches, shape, a file."""

import math
from collections.abc import Sequence
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHeaderView, QPushButton, QTableWidget, QTableWidgetItem, QWidget

from contactbench.widgets.controls import (
    HeightStack,
    asked_file,
    beside,
    called,
    choice,
    column,
    form,
    named,
    panel,
    plain_label,
    push_button,
    row,
    sentence_label,
    show_quietly,
)
from contactbench.widgets.messages import NumberBox, number, typed_number


class Way(IntEnum):
    """How one says where the mesh lies; in the order of the list."""

    NUMBERS = 0
    POINTS = 1
    FLANGE = 2
    TOUCHES = 3
    SHAPE = 4
    FILE = 5


class AlignmentPanel(QWidget):
    """
    Asks where the mesh lies.

    It changes nothing itself: its signals say what is asked for. Places on the mesh come in by `pick`, in the mesh's
    own frame, m.
    """

    numbers_typed = Signal()
    numbers_given = Signal(object)  # six floats: mm, then degrees
    points_given = Signal(object)  # list of (point_P, point_S), m
    flange_given = Signal(int, object, float, float)  # facet, point towards +x or None (P, m), degrees, mm
    touches_given = Signal(object)  # Path
    shape_given = Signal(float)  # offset, mm
    file_given = Signal(object)  # Path
    picking = Signal(bool)  # whether places on the mesh are asked for

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._facet = -1
        self._toward: NDArray[np.float64] | None = None
        ways = (
            self.tr("Enter numbers"),
            self.tr("Match points"),
            self.tr("Mounting face"),
            self.tr("Touch marked points"),
            self.tr("Estimate from shape"),
            self.tr("Load from file"),
        )
        name = self.tr("Alignment method")
        self.way = choice(((each, None) for each in ways), name, short=True)
        self.stack = HeightStack(
            self._numbers_page(),
            self._points_page(),
            self._flange_page(),
            self._touches_page(),
            self._shape_page(),
            self._file_page(),
        )
        column(self, self.way, self.stack, space=6)
        self.way.currentIndexChanged.connect(self._show_way)

    @property
    def wants_picks(self) -> bool:
        """Whether a click on the mesh means something here."""
        return self.way.currentIndex() in {Way.POINTS, Way.FLANGE}

    @property
    def typed(self) -> tuple[float, ...]:
        """The six numbers, mm and degrees, as they are typed."""
        return tuple(spin.value() for spin in self.numbers)

    @property
    def pending(self) -> bool:
        """Whether numbers are typed that are not applied."""
        return self.typed != self._applied

    def type_numbers(self, numbers: Sequence[float]) -> None:
        """Put six numbers into the fields as if they were typed: mm, then degrees about the fixed axes."""
        for spin, value in zip(self.numbers, numbers, strict=True):
            show_quietly(spin, value)
        self.numbers_typed.emit()

    def show_numbers(self, numbers: Sequence[float]) -> None:
        """Show where the mesh lies: mm, then degrees about the fixed axes."""
        for spin, value in zip(self.numbers, numbers, strict=True):
            show_quietly(spin, value)
        self._applied = self.typed

    def pick(self, point_P: NDArray[np.float64], facet: int) -> None:
        """Take a place on the mesh that was clicked."""
        if self.way.currentIndex() == Way.POINTS:
            self.points.add(point_P)
        elif self.way.currentIndex() == Way.FLANGE:
            if self._facet < 0:
                self._facet = facet
            else:
                self._toward = point_P
            self._show_flange()

    def clear_picks(self) -> None:
        """Forget places on a mesh that is not there any more."""
        self.points.clear()
        self._forget_flange()

    def _show_way(self, index: int) -> None:
        self.stack.show_page(index)
        self.picking.emit(self.wants_picks)

    # ---- the ways ----------------------------------------------------------------------------

    def _numbers_page(self) -> QWidget:
        along = self.tr("Mesh origin along sensor {}, mm")
        turned = self.tr("Rotation about the sensor's fixed {} axis, degrees; applied in the order x, y, z")
        self.numbers = (
            *(self._number(1e4, " mm", 2, along.format(axis)) for axis in "xyz"),
            *(self._number(360.0, "°", 2, turned.format(axis)) for axis in "xyz"),
        )
        rows = []
        for axis, moved, angle in zip("xyz", self.numbers[:3], self.numbers[3:], strict=True):
            rows.append(row(plain_label(axis, buddy=moved), (moved, 1), (angle, 1)))
        words = self.tr("Position of the mesh in the sensor frame, and rotation about its axes:")
        for each in self.numbers:
            each.valueChanged.connect(self.numbers_typed)
        self._applied = self.typed
        self.place_numbers = push_button(self.tr("Apply placement"), self.give_numbers)
        return panel(sentence_label(words), *rows, self.place_numbers, space=6)

    def _points_page(self) -> QWidget:
        words = self.tr(
            "Click a point on the mesh, then enter its position in the sensor frame. Use three widely"
            " spaced points; a fourth reveals errors."
        )
        self.points = PointTable()
        self.place_points = push_button(
            self.tr("Align to these points"), lambda: self.points_given.emit(self.points.pairs())
        )
        self.place_points.setEnabled(False)
        self.points.changed.connect(lambda: self.place_points.setEnabled(self.points.complete))
        return panel(sentence_label(words), self.points, self.place_points, space=6)

    def _flange_page(self) -> QWidget:
        self.flange_words, rows = sentence_label(), form()
        angle = self.tr("Angle of the second point about +z, from the sensor's +x, degrees")
        height = self.tr("Height of the mounting plane above the sensor origin, mm")
        self.clock = self._number(360.0, "°", 2, angle)
        self.height_mm = self._number(1e3, " mm", 3, height)
        rows.addRow(self.tr("Second point at"), self.clock)
        rows.addRow(self.tr("Face height"), self.height_mm)
        self.place_flange = push_button(self.tr("Align this face"), self._give_flange)
        self.forget = push_button(self.tr("Pick again"), self._forget_flange)
        page = panel(self.flange_words, rows, self.place_flange, self.forget, space=6)
        self._show_flange()
        return page

    def _touches_page(self) -> QWidget:
        words = self.tr(
            "Touch marked points on the probe, then choose the table: px, py, pz in the mesh frame in mm,"
            " and fx to mz in the sensor frame. The search starts from the placement above."
        )
        title, kinds = self.tr("Touches"), self.tr("Tables (*.csv)")
        choose = push_button(self.tr("Choose touches…"), lambda: self._ask(title, kinds, self.touches_given))
        return panel(sentence_label(words), choose, space=6)

    def _shape_page(self) -> QWidget:
        words = self.tr(
            "Puts the longest axis along z and the middle one along x. This is only a first guess: check"
            " it, then correct it by numbers or touches."
        )
        name = self.tr("Height of the probe's lowest point above the sensor origin, mm")
        self.lowest, rows = self._number(1e3, " mm", 3, name), form()
        rows.addRow(self.tr("Lowest point at"), self.lowest)
        place = push_button(self.tr("Align by shape"), lambda: self.shape_given.emit(self.lowest.value()))
        return panel(sentence_label(words), rows, place, space=6)

    def _file_page(self) -> QWidget:
        words = self.tr("An alignment saved by contactbench.")
        title, kinds = self.tr("Alignment"), self.tr("Alignments (*.json)")
        choose = push_button(self.tr("Choose alignment…"), lambda: self._ask(title, kinds, self.file_given))
        return panel(sentence_label(words), choose, space=6)

    # ---- what is asked for -----------------------------------------------------------------------

    def give_numbers(self) -> None:
        """Ask for the placement that is typed."""
        self._applied = self.typed
        self.numbers_given.emit(self.typed)

    def _give_flange(self) -> None:
        self.flange_given.emit(self._facet, self._toward, self.clock.value(), self.height_mm.value())

    def _forget_flange(self) -> None:
        self._facet, self._toward = -1, None
        self._show_flange()

    def _show_flange(self) -> None:
        if self._facet < 0:
            words = self.tr("Click the flat face of the mesh that sits on the sensor.")
        elif self._toward is None:
            words = self.tr(
                "Face selected. If you can, click a second point that shows the rotation about z."
            )
        else:
            words = self.tr("Face and second point selected.")
        self.flange_words.setText(words)
        self.place_flange.setEnabled(self._facet >= 0)
        self.forget.setEnabled(self._facet >= 0)

    def _ask(self, title: str, kinds: str, signal: object) -> None:
        if file := asked_file(self, title, kinds):
            signal.emit(file)  # type: ignore[attr-defined]

    def _number(self, largest: float, unit: str, decimals: int, name: str) -> NumberBox:
        return named(NumberBox(decimals=decimals, minimum=-largest, maximum=largest, suffix=unit), name)


# ---- places picked on the mesh, and where each of them lies in the sensor frame ------------------


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
        tip = self.tr("Enter each point's position in the sensor frame, mm")
        called(self.table, self.tr("Matching points: on the mesh and in the sensor frame, mm"), tip)
        header = self.table.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.ResizeToContents)
        self.table.verticalHeader().setDefaultSectionSize(_ROW_PX)
        self.table.setMinimumHeight(_ROW_PX * (_ROWS + 1) + 6)
        self.table.itemChanged.connect(lambda _item: self.changed.emit())
        self.remove = QPushButton(self.tr("Remove this point"))
        self.remove.clicked.connect(self._remove)
        column(self, self.table, beside(None, self.remove, 0), space=-1)

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
        for place in (1, 2, 3):
            self.table.setItem(row, place, QTableWidgetItem(""))
        self.table.setCurrentCell(row, 1)
        self.changed.emit()

    def type_in(self, row: int, millimetres: tuple[float, float, float]) -> None:
        """Write where a place lies in the sensor frame."""
        for place, value in enumerate(millimetres, 1):
            self._item(row, place).setText(number(value, "g"))

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

    def _item(self, row: int, place: int) -> QTableWidgetItem:
        item = self.table.item(row, place)
        if item is None:
            item = QTableWidgetItem("")
            self.table.setItem(row, place, item)
        return item

    def _typed(self, row: int) -> tuple[float, ...]:
        found = []
        for place in (1, 2, 3):
            item = self.table.item(row, place)
            found.append(typed_number(item.text() if item is not None else ""))
        return tuple(found)

"""The ways to say where the mesh lies in the sensor frame: numbers, points, the flange face, touches, shape, a file."""

from __future__ import annotations

from enum import IntEnum
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QDoubleSpinBox,
    QFileDialog,
    QLabel,
    QWidget,
)

from contactbench.widgets.alignment_points import PointTable
from contactbench.widgets.controls import (
    HeightStack,
    choice,
    column,
    form,
    named,
    push_button,
    row,
    sentence_label,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray
    from PySide6.QtWidgets import QLayout


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
            self.tr("By numbers"),
            self.tr("By matching points"),
            self.tr("By the face on the sensor"),
            self.tr("By touches of marked points"),
            self.tr("By its shape"),
            self.tr("From a file"),
        )
        name = self.tr("How the place of the mesh is given")
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

    def show_numbers(self, numbers: Sequence[float]) -> None:
        """Show where the mesh lies: mm, then degrees about the fixed axes."""
        for spin, value in zip(self.numbers, numbers, strict=True):
            spin.setValue(value)

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
        along = self.tr("The mesh's origin along {} of the sensor, in mm")
        turned = self.tr("Turned about the fixed axis {} of the sensor, in degrees; x first, then y, then z")
        self.numbers = (
            *(self._number(1e4, " mm", 2, along.format(axis)) for axis in "xyz"),
            *(self._number(360.0, "°", 2, turned.format(axis)) for axis in "xyz"),
        )
        rows = []
        for axis, moved, angle in zip("xyz", self.numbers[:3], self.numbers[3:], strict=True):
            labels = QLabel(axis), QLabel(self.tr("about {}").format(axis))
            for label, field in zip(labels, (moved, angle), strict=True):
                label.setBuddy(field)
            rows.append(row(labels[0], (moved, 1), labels[1], (angle, 1)))
        words = self.tr("Where the mesh's origin lies, and how the mesh is turned:")
        self.place_numbers = push_button(self.tr("Place it so"), self._give_numbers)
        return _page(sentence_label(words), *rows, self.place_numbers)

    def _points_page(self) -> QWidget:
        words = self.tr(
            "Click a place on the mesh, then type where it lies in the sensor frame. Three places, far from"
            " one another; a fourth shows a wrong one."
        )
        self.points = PointTable()
        self.place_points = push_button(
            self.tr("Place it by these points"), lambda: self.points_given.emit(self.points.pairs())
        )
        self.place_points.setEnabled(False)
        self.points.changed.connect(lambda: self.place_points.setEnabled(self.points.complete))
        return _page(sentence_label(words), self.points, self.place_points)

    def _flange_page(self) -> QWidget:
        self.flange_words, rows = sentence_label(), form()
        angle = self.tr("Angle of the second place from +x of the sensor about +z, degrees")
        height = self.tr("Height of the mounting plane above the sensor's origin, mm")
        self.clock = self._number(360.0, "°", 2, angle)
        self.height_mm = self._number(1e3, " mm", 3, height)
        rows.addRow(self.tr("Second place at"), self.clock)
        rows.addRow(self.tr("Height of the face"), self.height_mm)
        self.place_flange = push_button(self.tr("Put this face on the sensor"), self._give_flange)
        self.forget = push_button(self.tr("Pick again"), self._forget_flange)
        page = _page(self.flange_words, rows, self.place_flange, self.forget)
        self._show_flange()
        return page

    def _touches_page(self) -> QWidget:
        words = self.tr(
            "Touch marked points of the probe, and choose the table of them: px, py, pz in the mesh, mm, and"
            " fx to mz in the sensor frame. The place above is where the search begins."
        )
        title, kinds = self.tr("Touches"), self.tr("Tables (*.csv)")
        choose = push_button(
            self.tr("Choose the touches..."), lambda: self._ask(title, kinds, self.touches_given)
        )
        return _page(sentence_label(words), choose)

    def _shape_page(self) -> QWidget:
        words = self.tr(
            "The longest axis along z, the middle one along x. A guess that is good to begin with: look at it,"
            " and correct it by numbers or touches."
        )
        name = self.tr("Height of the probe's lowest point above the sensor's origin, mm")
        self.lowest, rows = self._number(1e3, " mm", 3, name), form()
        rows.addRow(self.tr("Lowest point at"), self.lowest)
        place = push_button(
            self.tr("Place it by its shape"), lambda: self.shape_given.emit(self.lowest.value())
        )
        return _page(sentence_label(words), rows, place)

    def _file_page(self) -> QWidget:
        words = self.tr("An alignment that contactbench wrote before.")
        title, kinds = self.tr("Alignment"), self.tr("Alignments (*.json)")
        choose = push_button(
            self.tr("Choose the alignment..."), lambda: self._ask(title, kinds, self.file_given)
        )
        return _page(sentence_label(words), choose)

    # ---- what is asked for -----------------------------------------------------------------------

    def _give_numbers(self) -> None:
        self.numbers_given.emit(tuple(spin.value() for spin in self.numbers))

    def _give_flange(self) -> None:
        self.flange_given.emit(self._facet, self._toward, self.clock.value(), self.height_mm.value())

    def _forget_flange(self) -> None:
        self._facet, self._toward = -1, None
        self._show_flange()

    def _show_flange(self) -> None:
        if self._facet < 0:
            words = self.tr("Click the plane face of the mesh that sits on the sensor.")
        elif self._toward is None:
            words = self.tr(
                "The face is chosen. Click a second place that shows how the probe is turned about z, if you can."
            )
        else:
            words = self.tr("The face and the second place are chosen.")
        self.flange_words.setText(words)
        self.place_flange.setEnabled(self._facet >= 0)
        self.forget.setEnabled(self._facet >= 0)

    def _ask(self, title: str, kinds: str, signal: object) -> None:
        name, _ = QFileDialog.getOpenFileName(self, title, "", kinds)
        if name:
            signal.emit(Path(name))  # type: ignore[attr-defined]

    def _number(self, largest: float, unit: str, decimals: int, name: str) -> QDoubleSpinBox:
        field = QDoubleSpinBox(decimals=decimals, minimum=-largest, maximum=largest, suffix=unit)
        return named(field, name)


def _page(*parts: QWidget | QLayout) -> QWidget:
    page = QWidget()
    column(page, *parts, space=6)
    return page

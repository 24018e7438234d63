"""What changes the chosen region as a whole: mirror, grow, shrink, smooth, clear."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Signal
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QComboBox, QGridLayout, QGroupBox, QPushButton, QSpinBox, QWidget

from contactbench.app.pages.regions_fields import AXES, length_field, unit_vector
from contactbench.pipeline.workbench.regions import Clear, Grow, Mirror, Shrink, Smooth
from contactbench.widgets.icons import icon

if TYPE_CHECKING:
    from contactbench.pipeline.workbench.regions import Tool


class ShapePanel(QGroupBox):
    """Asks for what is to be done with the chosen region; does nothing itself."""

    asked = Signal(object)  # Tool

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("The chosen region"))
        grid = QGridLayout(self)
        grid.setSpacing(4)
        grid.setContentsMargins(2, 2, 2, 2)
        self._make_mirror(grid)
        self._make_amounts(grid)
        mirror = QAction(self.tr("Mirror the chosen region"), self)
        mirror.setShortcut(QKeySequence("M"))
        mirror.triggered.connect(lambda _=False: self.mirror_button.click())
        self.addAction(mirror)

    def _make_mirror(self, grid: QGridLayout) -> None:
        self.mirror_button = self._button(
            self.tr("Mirror"), self.tr("Also take what lies on the other side of the plane (M)")
        )
        self.mirror_button.setIcon(icon("mirror"))
        self.mirror_button.setIconSize(QSize(20, 20))
        self.mirror_button.clicked.connect(lambda _=False: self.asked.emit(self._mirror()))
        self.across = QComboBox()
        self.across.setMinimumHeight(36)
        self.across.setAccessibleName(self.tr("Plane to mirror at"))
        self.across.addItems([self.tr("at {0} =").format(axis) for axis in AXES])
        self.at = length_field(-2000, 2000, self.tr("Where the mirror plane is, mm in the sensor frame S"))
        for column, widget in enumerate((self.mirror_button, self.across, self.at)):
            grid.addWidget(widget, 0, column)

    def _make_amounts(self, grid: QGridLayout) -> None:
        self.amount = length_field(0.1, 100, self.tr("How far to grow or shrink, mm along the surface"))
        self.amount.setValue(1)
        self.rings = QSpinBox(minimum=1, maximum=50, value=2, prefix=self.tr("Rings: "))
        self.rings.setMinimumHeight(36)
        self.rings.setMinimumWidth(84)
        self.rings.setAccessibleName(self.tr("How many rings of facets to smooth over"))
        self.rings.setToolTip(self.tr("What is narrower than about this many facets goes"))
        grow = self._button(self.tr("Grow"), self.tr("Move the border outwards; other regions stay"))
        shrink = self._button(self.tr("Shrink"), self.tr("Move the border inwards"))
        smooth = self._button(self.tr("Smooth"), self.tr("Straighten the border, fill holes, remove specks"))
        clear = self._button(self.tr("Clear"), self.tr("Take all facets out of the region"))
        grow.clicked.connect(lambda _=False: self.asked.emit(Grow(self.amount.value() / 1000)))
        shrink.clicked.connect(lambda _=False: self.asked.emit(Shrink(self.amount.value() / 1000)))
        smooth.clicked.connect(lambda _=False: self.asked.emit(Smooth(self.rings.value())))
        clear.clicked.connect(lambda _=False: self.asked.emit(Clear()))
        for row, widgets in enumerate(((grow, shrink, self.amount), (smooth, clear, self.rings)), 1):
            for column, widget in enumerate(widgets):
                grid.addWidget(widget, row, column)
        grid.setColumnStretch(2, 1)  # numbers need the room, words do not
        self.grow_button, self.shrink_button = grow, shrink
        self.smooth_button, self.clear_button = smooth, clear

    def _button(self, text: str, tip: str) -> QPushButton:
        button = QPushButton(text)
        button.setToolTip(tip)
        button.setMinimumHeight(36)
        return button

    def _mirror(self) -> Tool:
        axis = self.across.currentIndex()
        return Mirror(unit_vector(axis, self.at.value() / 1000), unit_vector(axis, 1.0))

"""The tools that work in the scene: brush, eraser, fill, box and plane, with what can be set for each."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker, QSize, Qt, Signal
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import (
    QButtonGroup,
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSlider,
    QStackedWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from contactbench.app.pages.regions_fields import AXES, length_field, muted, unit_vector
from contactbench.pipeline.workbench.regions import Box, Flood, Plane
from contactbench.widgets.icons import icon
from contactbench.widgets.region_brush import LARGEST, SMALLEST, USUAL

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.workbench.regions import Tool
    from contactbench.widgets.scene.scene import Pick

LOOK, BRUSH, ERASER, FILL, BOX, PLANE = "look", "brush", "eraser", "fill", "box", "plane"
_MARGIN = 1.0  # mm around picked corners: two picks on a flat side span no box


class ToolPanel(QWidget):
    """
    Choosing a tool and what it does; it touches neither the scene nor the regions.

    Attributes
    ----------
    tool : str
        LOOK, BRUSH, ERASER, FILL, BOX or PLANE.
    """

    tool_changed = Signal(str)
    radius_changed = Signal(float)  # m
    protect_changed = Signal(bool)
    asked = Signal(object, bool)  # Tool, whether to take away
    planned = Signal(object)  # Tool whose numbers were changed, or None: nothing to show beforehand

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.tool = LOOK
        self._buttons: dict[str, QToolButton] = {}
        self._corner: tuple[float, float, float] | None = None
        self._stack = QStackedWidget()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addLayout(self._make_buttons())
        layout.addWidget(self._stack)
        self.protect = QCheckBox(self.tr("Protect other regions"))
        self.protect.setToolTip(self.tr("Facets that belong to another region stay there"))
        self.protect.setMinimumHeight(32)
        self.protect.toggled.connect(self.protect_changed)
        layout.addWidget(self.protect)
        self._pages = {
            LOOK: self._make_look(),
            BRUSH: self._make_brush(),
            FILL: self._make_fill(),
            BOX: self._make_box(),
            PLANE: self._make_plane(),
        }
        self._pages[ERASER] = self._pages[BRUSH]
        for page in dict.fromkeys(self._pages.values()):
            self._stack.addWidget(page)
        self.choose(LOOK)

    # ---- choosing ----------------------------------------------------------------------------

    def choose(self, tool: str, _checked: bool = True) -> None:
        """Choose a tool."""
        self.tool = tool
        self._buttons[tool].setChecked(True)
        page = self._pages[tool]
        self._stack.setCurrentWidget(page)
        self._stack.setFixedHeight(page.sizeHint().height())
        self._corner = None
        self.tool_changed.emit(tool)
        self.plan()

    def show_radius(self, radius: float) -> None:
        """Show the brush's radius, m."""
        with QSignalBlocker(self.radius), QSignalBlocker(self.radius_slider):
            self.radius.setValue(1000 * radius)
            self.radius_slider.setValue(round(100 * math.log(radius / SMALLEST)))

    def show_plan(self, text: str) -> None:
        """Say what the box or plane would take."""
        for label in (self.box_plan, self.plane_plan):
            label.setText(text)

    def picked(self, pick: Pick) -> None:
        """Take a place that was clicked on the probe."""
        if self.tool == FILL:
            self.asked.emit(Flood(pick.face, math.radians(self.crease.value())), self.fill_erase.isChecked())
        elif self.tool == BOX:
            self._corner_picked(1000 * float(pick.point[0]), *(1000 * float(x) for x in pick.point[1:]))
        elif self.tool == PLANE:
            axis = self.side.currentIndex() // 2
            self.position.setValue(1000 * float(pick.point[axis]))

    def _corner_picked(self, *corner: float) -> None:
        x, y, z = corner
        other, self._corner = self._corner, None if self._corner else (x, y, z)
        first = other or corner
        for axis in range(3):
            low, high = sorted((first[axis], corner[axis]))
            for field, value in ((self.lows[axis], low - _MARGIN), (self.highs[axis], high + _MARGIN)):
                with QSignalBlocker(field):
                    field.setValue(value)
        hint = self.tr("Now click the opposite corner.") if self._corner else self._box_words()
        self.box_hint.setText(hint)
        self.plan()

    def planned_tool(self) -> Tool | None:
        """Return the box or plane of the numbers as they are; None for other tools, or numbers that are no box."""
        if self.tool == BOX:
            low, high = ([field.value() / 1000 for field in fields] for fields in (self.lows, self.highs))
            if all(one < other for one, other in zip(low, high, strict=True)):
                return Box((low[0], low[1], low[2]), (high[0], high[1], high[2]))
        if self.tool == PLANE:
            axis, sign = divmod(self.side.currentIndex(), 2)
            at = self.position.value() / 1000
            return Plane(unit_vector(axis, at), unit_vector(axis, -1.0 if sign else 1.0))
        return None

    def plan(self) -> None:
        """Ask for what the numbers would take to be shown."""
        if self.tool in (BOX, PLANE):
            planned = self.planned_tool()
            self.planned.emit(planned)
            if planned is None:
                self.show_plan(self.tr("Each low number must be below the high one."))
        else:
            self.planned.emit(None)

    def _give(self, erase: bool) -> None:
        planned = self.planned_tool()
        if planned is not None:
            self.asked.emit(planned, erase)

    # ---- its parts ---------------------------------------------------------------------------

    def _make_buttons(self) -> QGridLayout:
        grid = QGridLayout()
        grid.setSpacing(4)
        group = QButtonGroup(self)
        self._icons = {
            LOOK: "camera",
            BRUSH: "brush",
            ERASER: "eraser",
            FILL: "flood",
            BOX: "box",
            PLANE: "down",
        }
        entries = (
            (LOOK, self.tr("Look"), "L", self.tr("Turn the view with the left button")),
            (BRUSH, self.tr("Brush"), "B", self.tr("Paint the chosen region")),
            (ERASER, self.tr("Eraser"), "E", self.tr("Take facets out of their region")),
            (FILL, self.tr("Fill"), "F", self.tr("Fill up to sharp edges")),
            (BOX, self.tr("Box"), "X", self.tr("Everything between two corners")),
            (PLANE, self.tr("Half"), "H", self.tr("Everything on one side of a plane")),
        )
        for number, (tool, text, key, tip) in enumerate(entries):
            button = QToolButton()
            button.setText(text)
            button.setIcon(icon(self._icons[tool]))
            button.setIconSize(QSize(20, 20))
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
            button.setCheckable(True)
            button.setMinimumSize(96, 36)
            button.setToolTip(f"{tip} ({key})")
            button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            button.clicked.connect(partial(self.choose, tool))
            group.addButton(button)
            grid.addWidget(button, number // 3, number % 3)
            self._buttons[tool] = button
            self._act(self.tr("{0} (regions)").format(text), key, partial(self.choose, tool))
        return grid

    def _act(self, text: str, key: str, action: Callable[[], None]) -> None:
        made = QAction(text, self)
        made.setShortcut(QKeySequence(key))
        made.triggered.connect(lambda _=False: action())
        self.addAction(made)

    def _make_look(self) -> QWidget:
        page, layout = _page()
        layout.addWidget(muted(self.tr("Choose a tool. The right button always turns the view.")))
        return page

    def _make_brush(self) -> QWidget:
        page, layout = _page()
        row = QHBoxLayout()
        label = QLabel(self.tr("Radius"))
        self.radius_slider = QSlider(Qt.Orientation.Horizontal)
        self.radius_slider.setRange(0, round(100 * math.log(LARGEST / SMALLEST)))
        self.radius_slider.setAccessibleName(self.tr("Radius of the brush"))
        self.radius_slider.setToolTip(self.tr("[ and ], or Ctrl and the wheel"))
        self.radius = length_field(1000 * SMALLEST, 1000 * LARGEST, self.tr("Radius of the brush, mm"))
        label.setBuddy(self.radius)
        self.radius_slider.valueChanged.connect(
            lambda value: self.radius_changed.emit(SMALLEST * math.exp(value / 100))
        )
        self.radius.valueChanged.connect(lambda value: self.radius_changed.emit(value / 1000))
        for widget in (label, self.radius_slider, self.radius):
            row.addWidget(widget)
        layout.addLayout(row)
        layout.addWidget(
            muted(self.tr("Drag over the probe. Shift: the other way. Esc: take the stroke back."))
        )
        self.show_radius(USUAL)
        return page

    def _make_fill(self) -> QWidget:
        page, layout = _page()
        row = QHBoxLayout()
        label = QLabel(self.tr("Edges over"))
        self.crease_slider = QSlider(Qt.Orientation.Horizontal)
        self.crease_slider.setRange(1, 90)
        self.crease_slider.setAccessibleName(self.tr("Sharpest edge that is crossed"))
        self.crease = QDoubleSpinBox(minimum=1, maximum=90, decimals=0, suffix=" °")
        self.crease.setMinimumHeight(36)
        self.crease.setAccessibleName(self.tr("Sharpest edge that is crossed, degrees"))
        self.crease.setToolTip(self.tr("Edges sharper than this stop the fill, degrees"))
        self.crease_slider.valueChanged.connect(lambda value: self.crease.setValue(value))
        self.crease.valueChanged.connect(lambda value: self.crease_slider.setValue(round(value)))
        self.crease.setValue(30)
        label.setBuddy(self.crease)
        for widget in (label, self.crease_slider, self.crease):
            row.addWidget(widget)
        layout.addLayout(row)
        self.fill_erase = QCheckBox(self.tr("Take away instead"))
        self.fill_erase.setMinimumHeight(32)
        layout.addWidget(self.fill_erase)
        layout.addWidget(muted(self.tr("Click on the probe: everything up to such edges is filled.")))
        return page

    def _make_box(self) -> QWidget:
        page, layout = _page()
        self.box_hint = muted(self._box_words())
        layout.addWidget(self.box_hint)
        grid = QGridLayout()
        grid.setSpacing(4)
        self.lows: list[QDoubleSpinBox] = []
        self.highs: list[QDoubleSpinBox] = []
        for axis, name in enumerate(AXES):
            label = QLabel(name)
            grid.addWidget(label, axis, 0)
            for column, fields, end in ((1, self.lows, self.tr("low")), (2, self.highs, self.tr("high"))):
                words = self.tr("{0} {1}, mm in the sensor frame S").format(name, end)
                field = length_field(-2000, 2000, words)
                field.setValue(-10 if fields is self.lows else 10)
                field.valueChanged.connect(self.plan)
                fields.append(field)
                grid.addWidget(field, axis, column)
        grid.setColumnStretch(1, 1)
        grid.setColumnStretch(2, 1)
        layout.addLayout(grid)
        self.box_plan = muted("")
        layout.addWidget(self.box_plan)
        layout.addLayout(self._make_giving())
        return page

    def _make_plane(self) -> QWidget:
        page, layout = _page()
        layout.addWidget(muted(self.tr("Click on the probe to move the plane there, or type the number.")))
        row = QHBoxLayout()
        self.side = QComboBox()
        self.side.setMinimumHeight(36)
        self.side.setAccessibleName(self.tr("Which side of the plane"))
        for name in AXES:
            self.side.addItem(self.tr("{0} above").format(name))
            self.side.addItem(self.tr("{0} below").format(name))
        self.side.setCurrentIndex(4)
        self.position = length_field(-2000, 2000, self.tr("Where the plane is, mm in the sensor frame S"))
        self.side.currentIndexChanged.connect(self.plan)
        self.position.valueChanged.connect(self.plan)
        row.addWidget(self.side, 1)
        row.addWidget(self.position, 1)
        layout.addLayout(row)
        self.plane_plan = muted("")
        layout.addWidget(self.plane_plan)
        layout.addLayout(self._make_giving())
        return page

    def _make_giving(self) -> QHBoxLayout:
        row = QHBoxLayout()
        for text, erase in ((self.tr("Add"), False), (self.tr("Take away"), True)):
            button = QPushButton(text)
            button.setMinimumHeight(36)
            button.setToolTip(
                self.tr("Take these facets out of the chosen region")
                if erase
                else self.tr("Give these facets to the chosen region")
            )
            button.clicked.connect(lambda _=False, erase=erase: self._give(erase))
            row.addWidget(button)
        return row

    def _box_words(self) -> str:
        return self.tr("Click two opposite corners on the probe, or type the numbers.")


def _page() -> tuple[QWidget, QVBoxLayout]:
    page = QWidget()
    layout = QVBoxLayout(page)
    layout.setContentsMargins(0, 0, 0, 0)
    layout.setSpacing(6)
    return page, layout

"""The tools of the Regions page: those that work in the scene, and those that change a region as a whole."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, auto
from functools import partial

from PySide6.QtCore import QSignalBlocker, QSize, Qt, Signal
from PySide6.QtWidgets import (
    QButtonGroup,
    QGroupBox,
    QLabel,
    QPushButton,
    QSlider,
    QSpinBox,
    QToolButton,
    QWidget,
)

from contactbench.pipeline.session.why import RegionsState
from contactbench.pipeline.steps import Step, StepState
from contactbench.pipeline.workbench.regions import (
    Box,
    Clear,
    Flood,
    Grow,
    Mirror,
    Plane,
    Shrink,
    Smooth,
    Tool,
)
from contactbench.widgets.action_bar import ActionBar
from contactbench.widgets.controls import (
    HIGH,
    FoldRow,
    HeightStack,
    PanelScroll,
    add_key,
    called,
    check_box,
    choice,
    column,
    named,
    panel,
    plain_label,
    push_button,
    row,
    sentence_label,
    show_quietly,
    tool_button,
)
from contactbench.widgets.messages import NumberBox, translated
from contactbench.widgets.region_brush import LARGEST, SMALLEST, USUAL
from contactbench.widgets.region_list import RegionListWidget
from contactbench.widgets.scene.scene import Pick
from contactbench.widgets.theme import Sign, state_icon

LOOK, BRUSH, ERASER, FILL, BOX, PLANE = "look", "brush", "eraser", "fill", "box", "plane"
_AXES = ("x", "y", "z")
_MARGIN = 1.0  # mm around picked corners: two picks on a flat side span no box
_PAGES = (LOOK, BRUSH, FILL, BOX, PLANE)


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
    asked = Signal(object, bool)  # Tool, whether to take away
    planned = Signal(object)  # Tool whose numbers were changed, or None: nothing to show beforehand

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.tool = LOOK
        self._buttons: dict[str, QToolButton] = {}
        self._corner: tuple[float, float, float] | None = None
        tip = self.tr("Facets of other regions are not changed")
        self.protect = check_box(self.tr("Protect other regions"), tip=tip)
        look = sentence_label(self.tr("Choose a tool. The right button always rotates the view."), "muted")
        buttons = self._make_buttons()
        self._stack = HeightStack(
            look, self._make_brush(), self._make_fill(), self._make_box(), self._make_plane()
        )
        column(self, buttons, self._stack, self.protect, space=6)
        self.choose(LOOK)

    # ---- choosing --------------------------------------------------------------------------------

    def choose(self, tool: str, _checked: bool = True) -> None:
        """Choose a tool."""
        self.tool = tool
        with QSignalBlocker(self._buttons[tool]):
            self._buttons[tool].setChecked(True)
        self._stack.show_page(_PAGES.index(BRUSH if tool == ERASER else tool))
        self._corner = None
        self.tool_changed.emit(tool)
        self.plan()

    def show_radius(self, radius: float) -> None:
        """Show the brush's radius, m."""
        show_quietly(self.radius, 1000 * radius)
        with QSignalBlocker(self.radius_slider):
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
            show_quietly(self.lows[axis], low - _MARGIN)
            show_quietly(self.highs[axis], high + _MARGIN)
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
            return Plane(_along(axis, at), _along(axis, -1.0 if sign else 1.0))
        return None

    def plan(self) -> None:
        """Ask for what the numbers would take to be shown."""
        if self.tool in (BOX, PLANE):
            planned = self.planned_tool()
            self.planned.emit(planned)
            if planned is None:
                self.show_plan(self.tr("Each lower limit must be below the upper limit."))
        else:
            self.planned.emit(None)

    def _give(self, erase: bool) -> None:
        planned = self.planned_tool()
        if planned is not None:
            self.asked.emit(planned, erase)

    # ---- its parts -------------------------------------------------------------------------------

    def _make_buttons(self) -> FoldRow:
        tools = FoldRow(4)
        group = QButtonGroup(self)
        entries = (
            (LOOK, "camera", self.tr("Navigate"), "L", self.tr("Rotate the view with the left button")),
            (BRUSH, "brush", self.tr("Brush"), "B", self.tr("Paint the selected region")),
            (ERASER, "eraser", self.tr("Eraser"), "E", self.tr("Remove facets from their region")),
            (FILL, "flood", self.tr("Fill"), "F", self.tr("Fill up to sharp edges")),
            (BOX, "box", self.tr("Box"), "X", self.tr("Select everything between two corners")),
            (PLANE, "down", self.tr("Half"), "H", self.tr("Select everything on one side of a plane")),
        )
        for tool, picture, text, key, tip in entries:
            button = tool_button(picture, "", tip=f"{tip} ({key})", words=text)
            button.setIconSize(QSize(20, 20))
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
            button.setCheckable(True)
            button.setMinimumSize(92, HIGH)
            button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            # A screen reader toggles it, and never clicks.
            button.toggled.connect(lambda on, tool=tool: self.choose(tool) if on else None)
            group.addButton(button)
            tools.add(button, 1)
            self._buttons[tool] = button
            add_key(self, self.tr("{0} (regions)").format(text), key, partial(self.choose, tool))
        return tools

    def _make_brush(self) -> QWidget:
        self.radius_slider = QSlider(Qt.Orientation.Horizontal)
        self.radius_slider.setRange(0, round(100 * math.log(LARGEST / SMALLEST)))
        called(self.radius_slider, self.tr("Brush radius"), self.tr("[ and ], or Ctrl + wheel"))
        self.radius = _length(1000 * SMALLEST, 1000 * LARGEST, self.tr("Brush radius, mm"))
        self.radius_slider.valueChanged.connect(
            lambda value: self.radius_changed.emit(SMALLEST * math.exp(value / 100))
        )
        self.radius.valueChanged.connect(lambda value: self.radius_changed.emit(value / 1000))
        self.show_radius(USUAL)
        words = self.tr("Drag over the probe. Shift erases. Esc cancels the stroke.")
        line = _labelled(self.tr("Radius"), self.radius_slider, self.radius)
        return panel(line, sentence_label(words, "muted"), space=6)

    def _make_fill(self) -> QWidget:
        self.crease_slider = QSlider(Qt.Orientation.Horizontal)
        self.crease_slider.setRange(1, 90)
        self.crease_slider.setAccessibleName(self.tr("Sharpest edge to cross"))
        self.crease = NumberBox(minimum=1, maximum=90, decimals=0, suffix=" °")
        self.crease.setMinimumHeight(HIGH)
        tip = self.tr("The fill stops at edges sharper than this, degrees")
        called(self.crease, self.tr("Sharpest edge to cross, degrees"), tip)
        self.crease_slider.valueChanged.connect(lambda value: self.crease.setValue(value))
        self.crease.valueChanged.connect(lambda value: self.crease_slider.setValue(round(value)))
        self.crease.setValue(30)
        self.fill_erase = check_box(self.tr("Remove instead"))
        words = self.tr("Click the probe to fill up to the nearest sharp edges.")
        line = _labelled(self.tr("Edge limit"), self.crease_slider, self.crease)
        return panel(line, self.fill_erase, sentence_label(words, "muted"), space=6)

    def _make_box(self) -> QWidget:
        self.box_hint, self.box_plan = sentence_label(self._box_words(), "muted"), sentence_label("", "muted")
        lines = []
        self.lows: list[NumberBox] = []
        self.highs: list[NumberBox] = []
        for name in _AXES:
            for fields, end in ((self.lows, self.tr("low")), (self.highs, self.tr("high"))):
                words = self.tr("{0} {1}, mm in the sensor frame S").format(name, end)
                field = _length(-2000, 2000, words)
                field.setValue(-10 if fields is self.lows else 10)
                field.valueChanged.connect(self.plan)
                fields.append(field)
            lines.append(row(QLabel(name), (self.lows[-1], 1), (self.highs[-1], 1), space=4))
        return panel(self.box_hint, *lines, self.box_plan, self._make_giving(), space=6)

    def _make_plane(self) -> QWidget:
        words = self.tr("Click the probe to move the plane there, or enter a number.")
        sides = [
            (text.format(name), None)
            for name in _AXES
            for text in (self.tr("above {0}"), self.tr("below {0}"))
        ]
        self.side = choice(sides, self.tr("Side of the plane"), tip="")
        self.side.setCurrentIndex(4)
        self.position = _length(-2000, 2000, self.tr("Position of the plane, mm in the sensor frame S"))
        self.side.currentIndexChanged.connect(self.plan)
        self.position.valueChanged.connect(self.plan)
        self.plane_plan = sentence_label("", "muted")
        line = row((self.side, 1), (self.position, 1))
        return panel(sentence_label(words, "muted"), line, self.plane_plan, self._make_giving(), space=6)

    def _make_giving(self) -> FoldRow:
        give = self.tr("Add these facets to the selected region")
        take = self.tr("Remove these facets from the selected region")
        return row(
            push_button(self.tr("Add"), lambda: self._give(False), tip=give),
            push_button(self.tr("Remove facets"), lambda: self._give(True), tip=take),
        )

    def _box_words(self) -> str:
        return self.tr("Click two opposite corners on the probe, or enter the numbers.")


class ShapePanel(QGroupBox):
    """Asks for what is to be done with the chosen region as a whole; does nothing itself."""

    asked = Signal(object)  # Tool

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("Selected region"))
        self.across = choice(
            [(self.tr("at {0} =").format(axis), None) for axis in _AXES], self.tr("Mirror plane"), tip=""
        )
        self.at = _length(-2000, 2000, self.tr("Position of the mirror plane, mm in the sensor frame S"))
        self.amount = _length(0.1, 100, self.tr("Distance to grow or shrink along the surface, mm"))
        self.amount.setValue(1)
        self.rings = QSpinBox(minimum=1, maximum=50, value=2, prefix=self.tr("Rings: "))
        tip = self.tr("Removes details narrower than about this many facets")
        named(self.rings, self.tr("Smoothing width in rings of facets"), tip=tip)
        tip = self.tr("Add the mirror image across the plane (M)")
        self.mirror_button = self._button(self.tr("Mirror"), self._mirror, tip, "mirror")
        self.mirror_button.setIconSize(QSize(20, 20))
        tip = self.tr("Move the border outwards; other regions are unchanged")
        self.grow_button = self._button(self.tr("Grow"), lambda: Grow(self.amount.value() / 1000), tip)
        tip = self.tr("Move the border inwards")
        self.shrink_button = self._button(self.tr("Shrink"), lambda: Shrink(self.amount.value() / 1000), tip)
        tip = self.tr("Straighten the border, fill holes, remove specks")
        self.smooth_button = self._button(self.tr("Smooth"), lambda: Smooth(self.rings.value()), tip)
        tip = self.tr("Remove all facets from the region")
        self.clear_button = self._button(self.tr("Clear"), Clear, tip)
        column(
            self,
            row(self.mirror_button, self.across, (self.at, 1), space=4),
            row(self.grow_button, self.shrink_button, (self.amount, 1), space=4),
            row(self.smooth_button, self.clear_button, (self.rings, 1), space=4),
            margins=(2, 2, 2, 2),
            space=4,
        )
        add_key(self, self.tr("Mirror the selected region"), "M", self.mirror_button.click)

    def _button(self, words: str, tool: Callable[[], Tool], tip: str, picture: str = "") -> QPushButton:
        return push_button(words, lambda: self.asked.emit(tool()), picture, tip=tip)

    def _mirror(self) -> Tool:
        axis = self.across.currentIndex()
        return Mirror(_along(axis, self.at.value() / 1000), _along(axis, 1.0))


def _length(least: float, most: float, words: str) -> NumberBox:
    """Return a field for a length in mm."""
    return named(NumberBox(decimals=1, minimum=least, maximum=most, singleStep=0.5, suffix=" mm"), words)


def _labelled(words: str, slider: QSlider, field: NumberBox) -> FoldRow:
    return row(plain_label(words, buddy=field), slider, field)


def _along(axis: int, length: float) -> tuple[float, float, float]:
    """Return a vector along an axis."""
    x, y, z = (length if each == axis else 0.0 for each in range(3))
    return (x, y, z)


# ---- what the Regions page shows, and in which state ---------------------------------------------


_THREE_LINES_PX = 54


class Mode(Enum):
    """What can be done on the page."""

    LOCKED = auto()  # there is nothing to paint on
    OPENING = auto()
    FAILED = auto()
    READY = auto()


@dataclass(frozen=True)
class RegionsView:
    """Everything that decides what the page looks like."""

    mode: Mode
    sentence: str = ""  # Why it is locked or failed
    regions: int = 0  # How many there are
    chosen: bool = False  # Whether one of them is
    painted: bool = False  # Whether a facet belongs to one
    standing: RegionsState = RegionsState.NONE
    dirty: bool = False  # There are changes that the session does not have yet
    busy: bool = False  # Something is being computed
    unkept: str = ""  # Why the regions could not be kept; empty if they could
    # What sets the probe's regions apart from the painted ones; empty: hardly anything; None: not known yet
    unlike: str | None = None


class RegionsPanel(PanelScroll):
    """
    The controls of the page; `show_view` is the one place that decides what is seen.

    Parameters
    ----------
    bar : ActionBar
        Of the page.
    """

    apply_asked = Signal()
    go_asked = Signal(object)  # Step
    page_asked = Signal()  # what is next is done with the page's own tools

    def __init__(self, bar: ActionBar, parent: QWidget | None = None) -> None:
        super().__init__(parent=parent)
        self._bar = bar
        self.state_mark, self.state_text = Sign(24), sentence_label()
        self.state_text.setObjectName("regions_state")
        self.state_text.setMinimumHeight(_THREE_LINES_PX)  # what lies below stays where it is
        tip = self.tr("Replace all regions with those in a JSON or CSV file")
        self.import_button = push_button(self.tr("Import…"), tip=tip)
        tip = self.tr("Save the regions to a JSON or CSV file")
        self.export_button = push_button(self.tr("Export…"), tip=tip)
        self.regions, self.tools, self.shape = RegionListWidget(), ToolPanel(), ShapePanel()
        intro = self.tr(
            "Mark the areas meant to be touched, most important first. If a reading fits several places,"
            " these areas are preferred. Regions are optional."
        )
        state = row((self.state_mark, 0, Qt.AlignmentFlag.AlignTop), (self.state_text, 1))
        files = row(self.import_button, self.export_button)
        self.body = panel(self.regions, self.tools, self.shape, files)
        head = (plain_label(self.tr("Regions"), "title"), sentence_label(intro, "muted"), state)
        self.setWidget(panel(*head, self.body, 1, margins=(10, 10, 10, 10)))

    # ---- what is seen ------------------------------------------------------------------------

    def show_view(self, view: RegionsView) -> None:
        """Show all of it."""
        ready = view.mode is Mode.READY
        state, text = self._said(view)
        self.state_mark.show_icon(state_icon(state))
        self.state_mark.setAccessibleName(state.value)
        self.state_text.setText(translated(text))
        self.body.setVisible(ready)
        self.body.setEnabled(ready and not view.busy)
        self.tools.setEnabled(view.chosen)
        self.shape.setEnabled(view.chosen)
        self.export_button.setEnabled(view.regions > 0)
        self._offer(view)

    def _offer(self, view: RegionsView) -> None:
        """Offer what is to be done next."""
        bar, free = self._bar, view.mode is Mode.READY and not view.busy
        applied = view.standing is RegionsState.APPLIED and not view.dirty
        on = self.tr("Next: Verify") if applied else self.tr("Next: Verify, without regions")
        verify, none = partial(self.go_asked.emit, Step.VERIFY), view.mode is Mode.READY and not view.regions
        bar.offer_second(on if none else "", verify, enabled=free)
        planned = view.mode is Mode.READY and view.painted and view.standing is RegionsState.PLANNED
        if planned or view.mode in (Mode.LOCKED, Mode.FAILED):
            bar.offer(self.tr("Open Probe"), lambda: self.go_asked.emit(Step.PROBE))
        elif view.painted and not applied:
            tip = self.tr("Recompute the probe with more facets in the regions")
            bar.offer(self.tr("Apply regions"), self.apply_asked.emit, enabled=free, tip=tip)
        elif none:
            bar.offer(self.tr("Add a region"), self._add, enabled=free)
        else:
            bar.offer(on, verify, enabled=free, accented=applied)

    def _add(self) -> None:
        self.page_asked.emit()
        self.regions.add_button.click()

    def _said(self, view: RegionsView) -> tuple[StepState, str]:
        """Return the state and its sentence."""
        if view.mode is Mode.LOCKED:
            return StepState.LOCKED, view.sentence
        if view.mode is Mode.FAILED:
            return StepState.FAILED, view.sentence
        if view.mode is Mode.OPENING:
            return StepState.RUNNING, self.tr("Preparing the surface for painting…")
        if view.busy:
            return StepState.RUNNING, self.tr("Computing…")
        if view.unkept:
            return StepState.FAILED, self.tr(
                "The regions were not saved: {0} The next change tries again."
            ).format(view.unkept)
        if not view.regions:
            return StepState.READY, self.tr("No regions yet. Add one, then paint it on the probe.")
        if not view.chosen:
            return StepState.READY, self.tr("Select a region in the list, then paint it on the probe.")
        if not view.painted:
            return StepState.READY, self.tr("Nothing painted yet. Choose the brush and drag over the probe.")
        return self._of_painted(view)

    def _of_painted(self, view: RegionsView) -> tuple[StepState, str]:
        if view.dirty:
            return StepState.READY, self.tr("Saving…")
        if view.standing is RegionsState.APPLIED and view.unlike:
            return StepState.STALE, self.tr("Applied, but {0}").format(view.unlike)
        if view.standing is RegionsState.APPLIED:
            has = self.tr("The probe has these regions.")
            return StepState.DONE, has if view.unlike == "" else self.tr("Applied to the probe.")
        if view.standing is RegionsState.PLANNED:
            return StepState.READY, self.tr("Saved. The regions are applied when the probe is prepared.")
        return StepState.STALE, self.tr("Saved, but not yet applied to the probe.")

"""The markers of the Verify page: where they come from, and the table of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QDoubleSpinBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QSpinBox,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from contactbench.widgets.icons import icon
from contactbench.widgets.marker_table import MarkerTable, ShownMarker

if TYPE_CHECKING:
    from collections.abc import Sequence

_TALL = 36


def narrow(field: QWidget, least: int) -> None:
    """Let a field be as narrow as `least` px: its own wish is for the longest that it could ever hold."""
    field.setMinimumWidth(least)
    field.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)


class MarkersPanel(QWidget):
    """
    Asks for markers; does nothing by itself.

    Attributes
    ----------
    table : MarkerTable
    """

    spread_wanted = Signal(int, object)  # count, region or None
    grid_wanted = Signal(float, object)  # pitch, m; region or None
    typed = Signal(object)  # (3,) tuple, m
    pick_toggled = Signal(bool)
    import_wanted = Signal()
    export_wanted = Signal()
    remove_wanted = Signal(list)
    snap_wanted = Signal()
    touch_wanted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 8, 0, 0)
        column.setSpacing(8)
        column.addLayout(self._making())
        self.table = MarkerTable()
        self.table.setMinimumHeight(190)
        self.table.remove_wanted.connect(self.remove_wanted)
        column.addWidget(self.table, 1)
        column.addLayout(self._editing())
        column.addLayout(self._typing())
        self._empty = QLabel(
            self.tr(
                "No markers yet. Spread some over the probe, click on it, or import a table of measured ones."
            )
        )
        self._empty.setWordWrap(True)
        self._empty.setProperty("role", "muted")
        column.insertWidget(1, self._empty)
        self.go_on = QPushButton(icon("play", "panel"), self.tr("Go on: touch them"))
        self.go_on.setProperty("primary", True)
        self.go_on.setMinimumHeight(_TALL)
        self.go_on.hide()
        self.go_on.clicked.connect(lambda _=False: self.touch_wanted.emit())
        column.insertWidget(2, self.go_on)

    def _making(self) -> QGridLayout:
        grid = QGridLayout()
        grid.setSpacing(6)
        self.region = QComboBox()
        self.region.setMinimumHeight(_TALL)
        self.region.setAccessibleName(self.tr("Where markers are placed"))
        self.show_regions(())
        grid.addWidget(QLabel(self.tr("Place them on")), 0, 0)
        grid.addWidget(self.region, 0, 1, 1, 2)
        self.count = QSpinBox()
        self.count.setRange(1, 1000)
        self.count.setValue(12)
        self.count.setAccessibleName(self.tr("How many markers"))
        self.spread = self._button(self.tr("Spread evenly"), "add", self._spread)
        grid.addWidget(self.count, 1, 0)
        grid.addWidget(self.spread, 1, 1, 1, 2)
        self.pitch = QDoubleSpinBox()
        self.pitch.setRange(0.5, 200.0)
        self.pitch.setValue(10.0)
        self.pitch.setSuffix(" mm")
        self.pitch.setAccessibleName(self.tr("Distance of the lines of the grid, mm"))
        self.grid = self._button(self.tr("On a grid"), "add", self._grid)
        grid.addWidget(self.pitch, 2, 0)
        grid.addWidget(self.grid, 2, 1, 1, 2)
        for each in (self.count, self.pitch, self.region):
            narrow(each, 84)
        for each in (self.count, self.pitch):
            each.setMinimumHeight(_TALL)
            each.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        grid.setColumnStretch(2, 1)
        return grid

    def _editing(self) -> QGridLayout:
        grid = QGridLayout()
        grid.setSpacing(6)
        self.pick = QPushButton(icon("add"), self.tr("Click on it"))
        self.pick.setCheckable(True)
        narrow(self.pick, 100)
        self.pick.setMinimumHeight(_TALL)
        self.pick.setToolTip(
            self.tr("Every click on the probe adds a marker; with one marker selected, it moves there")
        )
        self.pick.toggled.connect(self.pick_toggled)
        self.remove = self._button(
            self.tr("Remove"), "remove", lambda: self.remove_wanted.emit(self.table.selected_names)
        )
        self.importing = self._button(self.tr("Import…"), "folder", self.import_wanted.emit)
        self.exporting = self._button(self.tr("Save as…"), "export", self.export_wanted.emit)
        self.snap = self._button(self.tr("Onto the surface"), "down", self.snap_wanted.emit)
        self.snap.setToolTip(self.tr("Move every marker to the nearest point of the probe"))
        for place, button in enumerate((self.pick, self.remove, self.importing, self.exporting, self.snap)):
            grid.addWidget(button, place // 2, place % 2)
        grid.setColumnStretch(0, 1)
        grid.setColumnStretch(1, 1)
        return grid

    def _typing(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(4)
        self.coordinates = []
        for axis in ("x", "y", "z"):
            field = QDoubleSpinBox()
            field.setRange(-2000.0, 2000.0)
            field.setDecimals(1)
            field.setPrefix(f"{axis} ")
            field.setMinimumHeight(_TALL)
            narrow(field, 84)
            field.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            field.setAccessibleName(self.tr("{axis} of a marker in the sensor frame S, mm").format(axis=axis))
            field.setToolTip(field.accessibleName())
            self.coordinates.append(field)
            row.addWidget(field, 1)
        self.add = QToolButton()
        self.add.setIcon(icon("add"))
        self.add.setMinimumSize(_TALL, _TALL)
        self.add.setAccessibleName(self.tr("Add a marker at these coordinates"))
        self.add.setToolTip(self.add.accessibleName())
        self.add.clicked.connect(lambda _=False: self._type())
        row.addWidget(self.add)
        return row

    def _button(self, text: str, name: str, action: object) -> QPushButton:
        button = QPushButton(icon(name), text)
        button.setMinimumHeight(_TALL)
        narrow(button, 100)
        button.clicked.connect(lambda _=False: action())  # type: ignore[operator]
        return button

    def _spread(self) -> None:
        self.spread_wanted.emit(self.count.value(), self.region.currentData())

    def _grid(self) -> None:
        self.grid_wanted.emit(1e-3 * self.pitch.value(), self.region.currentData())

    def _type(self) -> None:
        x, y, z = (1e-3 * field.value() for field in self.coordinates)
        self.typed.emit((x, y, z))

    # ---- what is shown -----------------------------------------------------------------------

    def show_regions(self, regions: Sequence[tuple[int, str]]) -> None:
        """Offer the regions (rank, name) of the probe, the first of them chosen; without any the whole probe."""
        known = [(self.region.itemData(row), self.region.itemText(row)) for row in range(self.region.count())]
        wanted: list[tuple[int | None, str]] = [*regions, (None, self.tr("the whole probe"))]
        if known == wanted:
            return
        self.region.clear()
        for rank, name in wanted:
            self.region.addItem(name, rank)

    def show_markers(self, rows: Sequence[ShownMarker]) -> None:
        """Show the table."""
        self._empty.setVisible(not rows)
        self.go_on.setVisible(bool(rows))
        self.exporting.setEnabled(bool(rows))
        self.table.show_rows(rows)

    def lock(self, locked: bool) -> None:
        """Allow no changes, as while they are touched."""
        for each in (
            self.spread, self.grid, self.pick, self.remove, self.importing, self.snap, self.add, self.region,
            self.count, self.pitch,
        ):  # fmt: skip
            each.setEnabled(not locked)
        if locked:
            self.pick.setChecked(False)

"""What the probe's page is made of: the mesh, its outer surface, where it lies, how many facets."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import (
    QFormLayout,
    QGroupBox,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from contactbench.pipeline.mesh.load import NAMES
from contactbench.pipeline.settings import ProbeSettings
from contactbench.widgets.controls import (
    check_box,
    choice,
    form,
    named,
    plain_label,
    push_button,
    sentence_label,
)
from contactbench.widgets.mesh_report import MeshReport
from contactbench.widgets.numbers import NumberBox, filled
from contactbench.widgets.settings_rows import rows_of
from contactbench.widgets.tradeoff_chart import TradeoffChart

if TYPE_CHECKING:
    from contactbench.pipeline.workbench.probe import Mesh

_CLOSINGS = ("", "fair", "ruled", "hull", "open")  # as `contactbench.pipeline.mesh.shell.Closing` has them
_HIGH = 38  # px
_TARGETS = ("facets", "max_deviation", "max_contact_error")


class MeshSection(QGroupBox):
    """The mesh file: chosen, looked at, and its unit asked for."""

    unit_said = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("1  Mesh"))
        layout = QVBoxLayout(self)
        self.name = sentence_label()
        self.choose = push_button(
            self.tr("Choose mesh…"),
            tip=self.tr("STL, PLY, OBJ, OFF or 3MF; you can also drop a file on the window"),
            high=_HIGH,
        )
        self.housing = push_button(self.tr("Use virtual bench housing"), high=_HIGH)
        self.question = sentence_label()
        self.report = MeshReport()
        self._units = QVBoxLayout()
        for each in (self.name, self.choose, self.housing, self.question):
            layout.addWidget(each)
        layout.addLayout(self._units)
        layout.addWidget(self.report)
        self.unit_buttons: dict[str, QPushButton] = {}
        self._shown: tuple[Mesh | None, bool | None] = (None, None)
        self.show_mesh(None, asked=False)

    def show_mesh(self, mesh: Mesh | None, asked: bool) -> None:
        """Show a mesh; `asked`: whether its unit is to be said."""
        if self._shown == (mesh, asked):
            return
        self._shown = (mesh, asked)
        self.name.setText(
            mesh.file.name
            if mesh is not None
            else self.tr("Drop the probe mesh from CAD or a scanner here, or choose a file.")
        )
        self.report.show_inspection(None if mesh is None else mesh.inspection)
        for button in self.unit_buttons.values():
            self._units.removeWidget(button)
            button.deleteLater()
        self.unit_buttons = {}
        guess = None if mesh is None or not asked else mesh.inspection.unit
        self.question.setVisible(guess is not None)
        if mesh is None or guess is None:
            return
        self.question.setText(self.tr("How long is the probe? The file does not state its unit."))
        for unit in (guess.units, *guess.alternatives):
            length = mesh.inspection.size_m * _metres(unit) / _metres(guess.units)
            words = filled(self.tr("{:.4g} mm long ({})"), 1e3 * length, NAMES[unit])
            button = push_button(words, partial(self.unit_said.emit, unit), high=_HIGH)
            self._units.addWidget(button)
            self.unit_buttons[unit] = button


class SurfaceSection(QGroupBox):
    """How the outer surface is made."""

    changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("2  Outer surface"))
        layout = QVBoxLayout(self)
        rows = form()
        ways = (
            self.tr("Automatic"),
            self.tr("Smooth surface"),
            self.tr("Straight lines"),
            self.tr("Hull of the rim"),
            self.tr("Leave open"),
        )
        tip = self.tr("Method for closing openings such as the cable outlet")
        self.close_by = choice(zip(ways, _CLOSINGS, strict=True), self.tr("Close openings"), tip=tip)
        rows.addRow(self.tr("Close openings"), self.close_by)
        self.alpha = rows_of(ProbeSettings, ("alpha",))["alpha"]
        rows.addRow(self.alpha.title, self.alpha.field)
        layout.addLayout(rows)
        self.report = MeshReport(1)
        layout.addWidget(self.report)
        self.close_by.activated.connect(lambda _index: self.changed.emit())
        self.alpha.changed.connect(lambda _value: self.changed.emit())

    def show_plan(self, close: tuple[str, ...], alpha: float | None) -> None:
        """Show what is chosen."""
        self.close_by.setCurrentIndex(_CLOSINGS.index(close[0]) if close else 0)
        self.alpha.show(alpha)

    @property
    def closings(self) -> tuple[str, ...]:
        """How openings are closed, as `Plan.close`."""
        chosen = _CLOSINGS[self.close_by.currentIndex()]
        return (chosen,) if chosen else ()


class FacetsSection(QGroupBox):
    """How many facets to keep, and what that costs."""

    changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("4  Facets"))
        layout = QVBoxLayout(self)
        self.number = plain_label("", "number")
        self.meaning = sentence_label()
        self.chart = TradeoffChart()
        for each in (self.number, self.meaning, self.chart):
            layout.addWidget(each)
        layout.addLayout(self._target_form())
        self.overlay = check_box(self.tr("Overlay the original"))
        tip = self.tr("Distance from the outer surface to the simplified surface, mm")
        self.deviation = check_box(self.tr("Colour by deviation"), tip=tip)
        layout.addWidget(self.overlay)
        layout.addWidget(self.deviation)
        self.report = MeshReport(1)
        layout.addWidget(self.report)
        self.show_result(None, "")

    def _target_form(self) -> QFormLayout:
        rows = form()
        self._targets = rows_of(ProbeSettings, _TARGETS)
        self.target = choice(
            ((row.title, name) for name, row in self._targets.items()), self.tr("Limit by"), tip=""
        )
        self.value = named(NumberBox(), self.tr("Number of facets, or mm"), tip="")
        rows.addRow(self.tr("Limit by"), self.target)
        rows.addRow(self.tr("Limit"), self.value)
        self.ratio = rows_of(ProbeSettings, ("region_ratio",))["region_ratio"]
        self.ratio_label = QLabel(self.ratio.title)
        rows.addRow(self.ratio_label, self.ratio.field)
        self.painted = check_box(self.tr("Copy painted regions"))
        self.painted.setChecked(True)
        rows.addRow(self.painted)
        self.target.activated.connect(self._target_changed)
        for spin in (self.value, self.ratio.field):
            spin.valueChanged.connect(lambda _value: self.changed.emit())
        self.painted.toggled.connect(
            lambda _on: self.changed.emit()
        )  # by the accessibility bus it is never clicked
        return rows

    def _target_changed(self, index: int) -> None:
        self._show_target(index, self._targets[_TARGETS[index]].row.start)
        self.changed.emit()

    def _show_target(self, index: int, value: float) -> None:
        self.target.setCurrentIndex(index)
        target = self._targets[_TARGETS[index]]
        self.value.setToolTip(target.name)
        with QSignalBlocker(self.value):
            target.put_into(self.value)
            self.value.setValue(value)

    def show_plan(self, target: dict[str, float], ratio: float, regions: bool, painted: bool) -> None:
        """Show what is chosen; `regions`: whether there are any."""
        name = next(iter(target), "max_contact_error")
        self._show_target(_TARGETS.index(name), target.get(name, 0.1))
        self.ratio.show(ratio)
        with QSignalBlocker(self.painted):
            self.painted.setChecked(painted)
        for each in (self.ratio.field, self.ratio_label, self.painted):
            each.setVisible(regions)

    @property
    def chosen(self) -> dict[str, Any]:
        """What is chosen, as fields of a `Plan`."""
        value = self.value.value()
        wanted = dict.fromkeys(_TARGETS) | {
            _TARGETS[self.target.currentIndex()]: round(value) if self.target.currentIndex() == 0 else value
        }
        return {
            **wanted,
            "region_ratio": self.ratio.value,
            "painted": self.painted.isChecked(),
        }

    def show_result(self, facets: int | None, meaning: str) -> None:
        """Show how many facets there are now, and what that means; None: nothing yet."""
        self.number.setText("" if facets is None else filled(self.tr("{:,} facets"), facets))
        self.number.setVisible(facets is not None)
        self.meaning.setText(meaning)
        self.meaning.setVisible(bool(meaning))
        for each in (self.overlay, self.deviation):
            each.setEnabled(facets is not None)


def _metres(unit: str) -> float:
    return {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254}[unit]

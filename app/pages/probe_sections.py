"""What the probe's page is made of: the mesh, its outer surface, where it lies, how many facets; and what is next."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QGroupBox,
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from contactbench.pipeline.mesh.units import NAMES
from contactbench.widgets.alignment_panel import AlignmentPanel
from contactbench.widgets.controls import show_value
from contactbench.widgets.mesh_report import MeshReport
from contactbench.widgets.phrases import said
from contactbench.widgets.tradeoff_chart import TradeoffChart

if TYPE_CHECKING:
    from contactbench.pipeline.workbench.probe import Mesh

_CLOSINGS = ("", "fair", "ruled", "hull", "open")  # as `contactbench.pipeline.mesh.shell.Closing` has them
_TARGETS = ("facets", "max_deviation", "max_contact_error")


class MeshSection(QGroupBox):
    """The mesh file: chosen, looked at, and its unit asked for."""

    unit_said = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("1  Mesh"))
        layout = QVBoxLayout(self)
        self.name = wrapped("")
        self.choose = big(QPushButton(self.tr("Choose a mesh...")))
        self.choose.setToolTip(self.tr("STL, PLY, OBJ, OFF or 3MF; a file can also be dropped on the window"))
        self.housing = big(QPushButton(self.tr("Use the virtual bench's housing")))
        self.question = wrapped("")
        self.report = MeshReport()
        self._units = QVBoxLayout()
        layout.addWidget(self.name)
        layout.addWidget(self.choose)
        layout.addWidget(self.housing)
        layout.addWidget(self.question)
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
            else self.tr(
                "Drop the mesh of the probe here, as it came from CAD or from a scanner, or choose it."
            )
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
        self.question.setText(self.tr("How long is the probe? The file does not say in which unit it is."))
        for unit in (guess.units, *guess.alternatives):
            length = mesh.inspection.size_m * _metres(unit) / _metres(guess.units)
            button = big(QPushButton(self.tr("{:.4g} mm long ({})").format(1e3 * length, NAMES[unit])))
            button.clicked.connect(lambda _checked=False, unit=unit: self.unit_said.emit(unit))
            self._units.addWidget(button)
            self.unit_buttons[unit] = button


class SurfaceSection(QGroupBox):
    """How the outer surface is made."""

    changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("2  Outer surface"))
        layout = QVBoxLayout(self)
        form = QFormLayout()
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        self.close_by = narrow(QComboBox())
        self.close_by.addItems(
            [
                self.tr("as it seems best"),
                self.tr("by a fair surface"),
                self.tr("by straight lines"),
                self.tr("by the hull of the rim"),
                self.tr("leave them open"),
            ]
        )
        self.close_by.setToolTip(self.tr("How openings are closed, such as the one for the cable"))
        form.addRow(self.tr("Close openings"), self.close_by)
        self.alpha = number(0.0, 50.0, " mm", 2)
        self.alpha.setSpecialValueText(self.tr("by the size"))
        self.alpha.setToolTip(
            self.tr("Size of the outer surface's facets, mm; 0: a 190th of the probe's length")
        )
        form.addRow(self.tr("Facet size"), self.alpha)
        layout.addLayout(form)
        self.report = MeshReport(1)
        layout.addWidget(self.report)
        self.close_by.activated.connect(lambda _index: self.changed.emit())
        self.alpha.valueChanged.connect(lambda _value: self.changed.emit())

    def show_plan(self, close: tuple[str, ...], alpha: float | None) -> None:
        """Show what is chosen."""
        self.close_by.setCurrentIndex(_CLOSINGS.index(close[0]) if close else 0)
        quietly(self.alpha, alpha or 0.0)

    @property
    def closings(self) -> tuple[str, ...]:
        """How openings are closed, as `Plan.close`."""
        chosen = _CLOSINGS[self.close_by.currentIndex()]
        return (chosen,) if chosen else ()


class PlaceSection(QGroupBox):
    """Where the mesh lies in the sensor frame."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("3  Place on the sensor"))
        layout = QVBoxLayout(self)
        self.panel = AlignmentPanel()
        self.report = MeshReport(1)
        layout.addWidget(self.panel)
        layout.addWidget(self.report)


class FacetsSection(QGroupBox):
    """How many facets to keep, and what that costs."""

    changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("4  Facets"))
        layout = QVBoxLayout(self)
        self.number = QLabel("")
        self.number.setProperty("role", "number")
        self.meaning = wrapped("")
        self.chart = TradeoffChart()
        for each in (self.number, self.meaning, self.chart):
            layout.addWidget(each)
        layout.addLayout(self._target_form())
        self.overlay = QCheckBox(self.tr("Show the original over it"))
        self.deviation = QCheckBox(self.tr("Show the deviation as colours"))
        self.deviation.setToolTip(self.tr("How far the outer surface is from the simplified one, in mm"))
        layout.addWidget(self.overlay)
        layout.addWidget(self.deviation)
        self.report = MeshReport(1)
        layout.addWidget(self.report)
        self.show_result(None, "")

    def _target_form(self) -> QFormLayout:
        form = QFormLayout()
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        self.target = narrow(QComboBox())
        self.target.addItems(
            [
                self.tr("a number of facets"),
                self.tr("a largest deviation"),
                self.tr("a largest contact error"),
            ]
        )
        self.value = number(4.0, 2e6, "", 0)
        self.value.setAccessibleName(self.tr("Number of facets, or mm"))
        form.addRow(self.tr("Keep to"), self.target)
        form.addRow(self.tr("Up to"), self.value)
        self.ratio = number(1.0, 100.0, " : 1", 1)
        self.ratio.setToolTip(self.tr("Facets per area inside the regions over that outside"))
        self.ratio_label = QLabel(self.tr("Finer in regions"))
        form.addRow(self.ratio_label, self.ratio)
        self.painted = QCheckBox(self.tr("Put the painted regions on it"))
        self.painted.setChecked(True)
        form.addRow(self.painted)
        self.target.activated.connect(self._target_changed)
        for spin in (self.value, self.ratio):
            spin.valueChanged.connect(lambda _value: self.changed.emit())
        self.painted.clicked.connect(lambda _checked: self.changed.emit())
        return form

    def _target_changed(self, index: int) -> None:
        self._show_target(index, (2_000.0, 0.1, 0.1)[index])
        self.changed.emit()

    def _show_target(self, index: int, value: float) -> None:
        self.target.setCurrentIndex(index)
        self.value.blockSignals(True)
        self.value.setDecimals(0 if index == 0 else 3)
        self.value.setSuffix("" if index == 0 else " mm")
        self.value.setRange(*((4.0, 2e6) if index == 0 else (0.001, 50.0)))
        self.value.setSingleStep((100.0, 0.01, 0.01)[index])
        self.value.setToolTip(
            (
                self.tr("Number of facets"),
                self.tr("Largest distance, mm"),
                self.tr("Of 95 % of contacts, mm"),
            )[index]
        )
        self.value.setValue(value)
        self.value.blockSignals(False)

    def show_plan(self, target: dict[str, float], ratio: float, regions: bool, painted: bool) -> None:
        """Show what is chosen; `regions`: whether there are any."""
        name = next(iter(target), "max_contact_error")
        self._show_target(_TARGETS.index(name), target.get(name, 0.1))
        quietly(self.ratio, ratio)
        self.painted.setChecked(painted)
        for each in (self.ratio, self.ratio_label, self.painted):
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
            "region_ratio": self.ratio.value(),
            "painted": self.painted.isChecked(),
        }

    def show_result(self, facets: int | None, meaning: str) -> None:
        """Show how many facets there are now, and what that means; None: nothing yet."""
        self.number.setText("" if facets is None else self.tr("{:,} facets").format(facets))
        self.number.setVisible(facets is not None)
        self.meaning.setText(meaning)
        self.meaning.setVisible(bool(meaning))
        for each in (self.overlay, self.deviation):
            each.setEnabled(facets is not None)


class NextBar(QWidget):
    """What runs or what is next: one button, always in the same place."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 6, 8, 8)
        self.words = wrapped("")
        self.bar = QProgressBar()
        self.bar.setRange(0, 1000)
        self.bar.setAccessibleName(self.tr("How far the work is"))
        self.cancel = QPushButton(self.tr("Cancel"))
        self.next = big(QPushButton(""))
        self.next.setProperty("primary", True)
        row = QHBoxLayout()
        row.addWidget(self.bar, 1)
        row.addWidget(self.cancel)
        layout.addWidget(self.words)
        layout.addLayout(row)
        layout.addWidget(self.next)
        self.show_idle()

    def show_working(self, title: str) -> None:
        """Show what runs."""
        self.say(title)
        show_value(self.bar, 0)
        self.bar.setVisible(True)
        self.cancel.setVisible(True)
        self.next.setEnabled(False)

    def show_share(self, share: float) -> None:
        """Show how far it is."""
        show_value(self.bar, round(1000 * share))

    def show_idle(self) -> None:
        """Show that nothing runs."""
        self.bar.setVisible(False)
        self.cancel.setVisible(False)

    def say(self, words: str, bad: bool = False) -> None:
        """Show a sentence."""
        self.words.setText(said(words))
        self.words.setProperty("role", "bad" if bad else "")
        self.words.style().unpolish(self.words)
        self.words.style().polish(self.words)
        self.words.setVisible(bool(words))


def wrapped(words: str) -> QLabel:
    """Return a label that breaks its lines."""
    label = QLabel(words)
    label.setWordWrap(True)
    label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    return label


def big(button: QPushButton) -> QPushButton:
    """Make a button high enough for a glove."""
    button.setMinimumHeight(38)
    return button


def narrow(choice: QComboBox) -> QComboBox:
    """Let a list of choices be narrower than its longest one."""
    choice.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    choice.setMinimumContentsLength(6)
    return choice


def number(low: float, high: float, unit: str, decimals: int) -> QDoubleSpinBox:
    """Return a field for a number that speaks when it is complete."""
    spin = QDoubleSpinBox()
    spin.setDecimals(decimals)
    spin.setRange(low, high)
    spin.setSuffix(unit)
    spin.setKeyboardTracking(False)
    spin.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
    spin.setMinimumWidth(80)
    spin.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return spin


def quietly(spin: QDoubleSpinBox, value: float) -> None:
    """Show a number without asking for anything."""
    spin.blockSignals(True)
    spin.setValue(value)
    spin.blockSignals(False)


def _metres(unit: str) -> float:
    return {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254}[unit]

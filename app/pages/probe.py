"""The step in which the mesh of a probe becomes the surface that contacts are found on."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QSignalBlocker, QTimer, Signal
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QHideEvent, QShowEvent
from PySide6.QtWidgets import QFormLayout, QGroupBox, QLabel, QPushButton, QVBoxLayout, QWidget

from contactbench.app.bench import Bench, Page
from contactbench.app.pages.probe_stages import TARGETS, ProbeStages, Shown
from contactbench.app.pages.virtual_mesh import bench_address
from contactbench.app.undo import Exchange
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.formats import SUFFIXES
from contactbench.pipeline.mesh.load import NAMES, in_metres
from contactbench.pipeline.preparation.alignment.alignment import (
    Alignment,
    AlignmentMethod,
    from_angles,
    load_alignment,
)
from contactbench.pipeline.settings import MESH_FORMATS_SAID, ProbeSettings
from contactbench.pipeline.steps import Step, StepStatus
from contactbench.pipeline.workbench.probe import (
    Mesh,
    back_to_mesh,
    by_axes,
    by_flange,
    by_points,
    by_touches,
    numbers_of,
)
from contactbench.widgets.alignment_panel import AlignmentPanel, Way
from contactbench.widgets.controls import (
    PanelScroll,
    asked_file,
    check_box,
    choice,
    dropped_files,
    form,
    named,
    panel,
    plain_label,
    push_button,
    sentence_label,
    stacked,
)
from contactbench.widgets.mesh_report import PICTURE, MeshReport, size_icon
from contactbench.widgets.messages import NumberBox, filled, translated
from contactbench.widgets.scene import Pick
from contactbench.widgets.settings_rows import rows_of
from contactbench.widgets.tradeoff_chart import TradeoffChart


class ProbePage(Page):
    """A view over the stages: four sections one below the other, and one button for what is next."""

    step = Step.PROBE

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(bench, parent)
        self._here = False
        self.mesh_section, self.surface = MeshSection(), SurfaceSection()
        self.facets = FacetsSection()
        self.stages = ProbeStages(bench, self.bar, self)
        self.place = PlaceSection(self.stages)
        self._lay_out()
        self._connect()
        self.setAcceptDrops(True)
        self._show()

    def _lay_out(self) -> None:
        title = plain_label(self.tr("Probe"), "title")
        parts = (title, self.mesh_section, self.surface, self.place, self.facets)
        self.area = PanelScroll(panel(*parts, 0, margins=(10, 8, 10, 8), space=6))
        self.fill(self.area)

    def _connect(self) -> None:
        stages = self.stages
        stages.changed.connect(self._show)
        stages.redraw.connect(self._draw)
        # Once the section has its place.
        stages.ready.connect(
            lambda: QTimer.singleShot(0, self, lambda: self.area.ensureWidgetVisible(self.facets.chart))
        )
        self.mesh_section.choose.clicked.connect(self._choose)
        self.mesh_section.housing.clicked.connect(stages.take_housing)
        self.mesh_section.unit_said.connect(stages.say_unit)
        self.mesh_section.tolerance.changed.connect(stages.say_tolerance)
        self.surface.changed.connect(lambda: stages.close_by(self.surface.closings, self.surface.alpha.value))
        self.facets.changed.connect(lambda: stages.aim(replace(stages.plan, **self.facets.chosen)))
        self.facets.chart.chosen.connect(stages.keep)
        self.facets.overlay.toggled.connect(self._show_overlay)
        self.facets.deviation.toggled.connect(self._show_deviation)

    def _choose(self) -> None:
        kinds = " ".join(f"*{suffix}" for suffix in SUFFIXES)
        if file := asked_file(self, self.tr("Probe mesh"), self.tr("Meshes") + f" ({kinds})"):
            self.stages.take(file)

    def _next(self) -> tuple[str, Callable[[], object]]:
        """Return what the button says, and what it does."""
        stages = self.stages
        if stages.using:
            return self.tr("Saving probe"), stages.use
        if stages.in_use:
            return self.tr("Next: Regions"), partial(self.bench.go_to.emit, Step.REGIONS)
        if stages.mesh is None and bench_address(self.bench.desk.state) is not None:
            return self.tr("Use virtual bench housing"), stages.take_housing
        if stages.mesh is None:
            return self.tr("Choose mesh…"), self._choose
        if stages.asked:
            return self.tr("Enter probe length (1)"), partial(self._ask, self.mesh_section.question)
        if stages.dense is None:
            return self.tr("Create outer surface"), stages.make_surface
        if self.place.pending:
            return self.tr("Apply placement"), self.place.panel.give_numbers
        if not stages.in_sensor_frame:
            return self.tr("Align with sensor (3)"), partial(self._ask, self.place)
        if stages.preview is None:
            return self.tr("Prepare probe"), stages.measure
        return self.tr("Use this probe"), stages.use

    def _ask(self, section: QWidget) -> None:
        """Show what must be answered by hand."""
        self.bench.page_wanted.emit()
        self.area.ensureWidgetVisible(section)

    def _show(self) -> None:
        """Show how things stand: the one place that does."""
        words, do = self._next()
        shell = None if self.stages.dense is None else self.stages.dense.shell
        mended = shell is not None and not shell.faults
        self.mesh_section.show_mesh(self.stages.mesh, self.stages.asked, mended)
        if not self.stages.worker.busy:
            self.mesh_section.tolerance.show(self.stages.plan.tolerance)
        virtual, none = bench_address(self.bench.desk.state) is not None, self.stages.mesh is None
        self.mesh_section.housing.setVisible(virtual and not none)
        self.mesh_section.choose.setVisible(not none)  # else it is what is next
        free = not (self.stages.using or self.stages.worker.busy)
        self.bar.offer(words, do, enabled=free)
        other = self.tr("Choose mesh…") if virtual and none else ""
        self.bar.offer_second(other, self._choose, enabled=free)
        self.surface.show_plan(self.stages.plan.close, self.stages.plan.alpha)
        told, doubt = ((), "") if shell is None else (shell.sentences, shell.left_open)
        self.surface.report.show_sentences([("doubt" if each == doubt else "note", each) for each in told])
        mesh = self.stages.mesh
        known = mesh is not None and not self.stages.asked
        self.surface.setVisible(known)
        # What lies in the sensor frame would be moved twice.
        self.place.setVisible(known and mesh is not None and mesh.original.frame == "P")
        self.facets.setVisible(known and self.stages.in_sensor_frame)
        self._show_facets()

    def _show_facets(self) -> None:
        plan, preview = self.stages.plan, self.stages.preview
        target = {name: value for name in TARGETS if (value := getattr(plan, name)) is not None}
        painted = self.bench.desk.state.newest("regions") is not None
        self.facets.show_plan(target, plan.region_ratio, painted, plan.painted)
        self.facets.chart.setVisible(self.stages.trade is not None)
        count = None if preview is None else len(preview.done.content.probe.faces)
        self.facets.chart.show_trade(self.stages.trade, count or plan.facets or 0)
        meaning = ""
        sentences: tuple[str, ...] = ()
        if preview is not None:
            meaning = self.tr("{} from the outer surface.").format(
                translated(preview.done.simplified.deviation.sentence)
            )
            carried = (each.sentence for each in preview.done.carried)
            sentences = (*preview.done.simplified.sentences, *carried)
        elif self.stages.view.used is not None and self.stages.in_use:
            count, meaning = len(self.stages.view.used.faces), self.tr("Probe of this session.")
        self.facets.show_result(count, meaning)
        reason = () if self.stages.trade is None else (self.stages.trade.reason,)
        self.facets.report.show_sentences([("note", each) for each in (*reason, *sentences)])

    def _draw(self, fit: bool) -> None:
        if self._here:
            self.stages.view.draw(fit=fit)

    def _show_overlay(self, on: bool) -> None:
        self.stages.view.overlay = on
        self._draw(False)

    def _show_deviation(self, on: bool) -> None:
        self.stages.view.deviation = on
        self._draw(False)

    def _picked(self, pick: Pick) -> None:
        self.place.pick(pick.point, pick.face, self.stages.view.shown)

    def enter(self) -> None:
        """Show the mesh, and take files and places from the scene."""
        if not self._here:
            self.bench.scene.dropped.connect(self.stages.take)
            self.bench.scene.picked.connect(self._picked)
        self._here = True
        self.place.choose_tool()
        if not self.stages.up_to_date and not self.stages.worker.busy:
            self.stages.reload()
        self._draw(True)
        self._show()

    def leave(self) -> None:
        """Leave the scene to another page; what is computed goes on."""
        if not self._here:
            return
        self._here = False
        if self.place.pending:  # nothing that is typed is lost
            self.place.panel.give_numbers()
        self.bench.scene.dropped.disconnect(self.stages.take)
        self.bench.scene.picked.disconnect(self._picked)
        self.bench.scene.set_tool("turn")
        self.stages.view.forget()

    def show_state(self, status: StepStatus) -> None:
        """Show what changed in the session, unless it is this page's own doing."""
        self.setAccessibleDescription(translated(status.sentence))
        stages = self.stages
        if stages.worker.busy:
            return
        if self._here and not (stages.up_to_date or stages.using):
            stages.reload()
        else:
            self._show()

    def close_page(self) -> None:
        """Stop what runs, and remove the copies of meshes."""
        self.leave()
        self.stages.close()

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take files."""
        dropped_files(event)

    def dropEvent(self, event: QDropEvent) -> None:
        """Take the first of the files."""
        if files := dropped_files(event):
            self.stages.take(files[0])


# ---- where the mesh lies: from what is asked for in the panel to an alignment --------------------


class PlaceSection(QGroupBox):
    """Where the mesh lies in the sensor frame."""

    def __init__(self, stages: ProbeStages, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("3  Alignment with sensor"))
        self._stages, self.panel, self.report = stages, AlignmentPanel(), MeshReport(1)
        self._ghost = False  # whether one is shown
        self._middle = np.zeros(3)  # of the mesh, P, m: there the handle stands
        self._before: tuple[float, ...] | None = None  # what was typed before the handle was moved
        stacked(self, self.panel, self.report)
        stages.begun.connect(self.panel.clear_picks)
        stages.aligned.connect(self.show_alignment)
        panel = self.panel
        panel.numbers_given.connect(lambda six: self._try(lambda: from_angles(list(six[:3]), list(six[3:]))))
        panel.numbers_typed.connect(self._preview)
        panel.points_given.connect(lambda pairs: self._try(lambda: by_points(pairs)))
        panel.flange_given.connect(self._by_flange)
        panel.shape_given.connect(self._by_shape)
        panel.touches_given.connect(self._by_touches)
        panel.file_given.connect(lambda file: self._work(lambda _progress: (load_alignment(file), ())))
        panel.picking.connect(lambda _on: self.choose_tool())
        panel.picking.connect(lambda _on: self._draw())
        stages.bench.scene.handle_moved.connect(self._handled)
        stages.bench.scene.handle_dropped.connect(self._dropped)

    def choose_tool(self) -> None:
        """Let clicks on the mesh pick places, where places are asked for."""
        self._stages.bench.scene.set_tool("pick" if self.panel.wants_picks else "turn")

    def pick(self, point: NDArray[np.float64], facet: int, shown: Shown) -> None:
        """Take a place on the mesh that was clicked, as it is shown."""
        if self.panel.wants_picks:
            self.panel.pick(back_to_mesh(point, shown.alignment), facet)

    @property
    def pending(self) -> bool:
        """Whether a placement is typed that is not applied."""
        mesh = self._stages.mesh
        return mesh is not None and mesh.original.frame == "P" and self.panel.pending

    def _preview(self) -> None:
        """Show what is typed, and what can be done next."""
        self._draw()
        self._stages.changed.emit()

    def _draw(self) -> None:
        """
        Show the mesh see-through where it would lie by the numbers that are typed, and the handle that fills them.

        The handle is there while the numbers are seen: not in bench mode, nor while there is nothing to move.
        """
        scene, mesh, six = self._stages.bench.scene, self._stages.mesh, self.panel.typed
        try:
            T = None if mesh is None else from_angles(list(six[:3]), list(six[3:])).T_SP
        except InputError:
            T = None
        shown, ghost = self._stages.view.shown.alignment, T if self.pending else None
        # A mesh that does not lie by its numbers yet, as while its surface is made, has no handle.
        seen = self.isVisible() and not (shown is None and ghost is None and any(six))
        if mesh is None or T is None or not seen or self.panel.way.currentIndex() != Way.NUMBERS:
            scene.show_handle(None)
        else:
            self._middle = np.mean(mesh.original.probe.bounds, axis=0)
            scene.show_handle(T[:3, :3], T[:3, :3] @ self._middle + T[:3, 3])
        if ghost is not None:
            moved = ghost if shown is None else ghost @ np.linalg.inv(shown.T_SP)
            scene.show_ghost(moved[:3, :3], moved[:3, 3])
        elif self._ghost:  # one of another page stays
            scene.show_ghost(None)
        self._ghost = ghost is not None

    def showEvent(self, event: QShowEvent) -> None:
        """Show the handle."""
        super().showEvent(event)
        self._draw()

    def hideEvent(self, event: QHideEvent) -> None:
        """Hide the handle."""
        super().hideEvent(event)
        self._draw()

    def _handled(self, T: NDArray[np.float64]) -> None:
        """Fill in the numbers by which the mesh lies as the handle does."""
        self._before = self._before or self.panel.typed
        T_SP = T.copy()
        T_SP[:3, 3] -= T[:3, :3] @ self._middle
        self.panel.type_numbers(numbers_of(Alignment(T_SP, AlignmentMethod.TYPED)))

    def _dropped(self) -> None:
        """Let what the handle did be undone by itself: the placement need not be applied for it."""
        before, after, self._before = self._before, self.panel.typed, None
        if before not in (None, after):
            text, bench = self.tr("move the mesh"), self._stages.bench
            bench.undo.push(Exchange(bench, text, before, after, self.panel.type_numbers))

    def show_alignment(self, alignment: Alignment | None, notes: tuple[str, ...] = ()) -> None:
        """Show where the mesh lies, and what to know about it."""
        self.panel.show_numbers(numbers_of(alignment))
        self._preview()
        said: list[tuple[str, str]] = []
        if alignment is not None:
            said += [("doubt", each) for each in alignment.warnings]
            said += [("note", each) for each in (*notes, *alignment.how)]
        self.report.show_sentences(said)

    # ---- the ways --------------------------------------------------------------------------------

    def _by_shape(self, lowest_mm: float) -> None:
        mesh = self._mesh()
        if mesh is not None:
            self._work(lambda _progress: (by_axes(mesh, lowest_mm), ()))

    def _by_flange(
        self, facet: int, toward: NDArray[np.float64] | None, clock: float, height_mm: float
    ) -> None:
        mesh = self._mesh()
        if mesh is not None:
            self._work(lambda _progress: (by_flange(mesh, facet, toward, clock, height_mm), ()))

    def _by_touches(self, file: Path) -> None:
        mesh, mount = self._mesh(), self._stages.plan.alignment
        if mesh is not None:
            self._work(lambda progress: by_touches(mesh, file, mount, progress))

    def _mesh(self) -> Probe | None:
        """Return the mesh in its own frame with the facets that are shown: those that were picked."""
        stages = self._stages
        if stages.dense is not None:
            return stages.dense.content.probe
        return None if stages.mesh is None else stages.mesh.original.probe

    def _try(self, align: Callable[[], Alignment]) -> None:
        """Align by what takes no time."""
        try:
            self._stages.put(align())
        except InputError as error:
            self._stages.bar.say(str(error), bad=True)

    def _work(self, align: Callable[[Callable[[float], None]], tuple[Alignment, tuple[str, ...]]]) -> None:
        self._stages.worker.start(
            self.tr("Aligning mesh"),
            lambda monitor: align(monitor.tell),
            lambda found: self._stages.put(*found),
        )


# ---- what the probe's page is made of ------------------------------------------------------------


# As `contactbench.pipeline.mesh.shell.Closing` has them; the first: none is said.
_CLOSINGS = ("", "auto", "fair", "ruled", "hull", "open")
_TARGETS = ("facets", "max_deviation", "max_contact_error")


class MeshSection(QGroupBox):
    """The mesh file: chosen, looked at, and its unit asked for."""

    unit_said = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("1  Mesh"))
        self.name = sentence_label()
        tip = filled(self.tr("{}; you can also drop a file on the window"), MESH_FORMATS_SAID)
        self.choose = push_button(self.tr("Choose mesh…"), tip=tip)
        self.housing = push_button(self.tr("Use virtual bench housing"))
        self.question = sentence_label()
        self.report = MeshReport()
        self._units, self._how = QVBoxLayout(), form()
        self.tolerance = rows_of(ProbeSettings, ("tolerance",))["tolerance"]
        self._how.addRow(self.tolerance.title, self.tolerance.field)
        stacked(
            self, self.name, self.choose, self.housing, self.question, self._units, self._how, self.report
        )
        self.unit_buttons: dict[str, QPushButton] = {}
        self._shown: tuple[object, ...] = ()
        self.show_mesh(None, asked=False, mended=False)

    def show_mesh(self, mesh: Mesh | None, asked: bool, mended: bool) -> None:
        """Show a mesh; `asked`: whether its unit is to be said; `mended`: its outer surface has no faults."""
        if self._shown == (mesh, asked, mended):
            return
        self._shown = (mesh, asked, mended)
        none = self.tr("Drop the probe mesh from CAD or a scanner here, or choose a file.")
        self.name.setText(none if mesh is None else mesh.file.name)
        self.report.show_inspection(None if mesh is None else mesh.inspection, mended)
        self._how.setRowVisible(0, mesh is not None and mesh.tessellated)
        for button in self.unit_buttons.values():
            self._units.removeWidget(button)
            button.deleteLater()
        self.unit_buttons = {}
        guess = None if mesh is None or not asked else mesh.inspection.unit
        self.question.setVisible(guess is not None)
        if mesh is None or guess is None:
            return
        self.question.setText(
            self.tr(
                "How long is the probe? The file leaves its unit open. The grey card is a bank card of 86 mm."
            )
        )
        for unit in (guess.units, *guess.alternatives):
            scale = 1e3 * in_metres(1.0, unit) / in_metres(1.0, guess.units)
            words = filled(self.tr("{:.4g} mm long ({})"), scale * mesh.inspection.size_m, NAMES[unit])
            button = push_button(words, partial(self.unit_said.emit, unit))
            button.setMinimumHeight(PICTURE.height() + 8)
            button.setIcon(size_icon(scale * mesh.outline))
            button.setIconSize(PICTURE)
            self._units.addWidget(button)
            self.unit_buttons[unit] = button


class SurfaceSection(QGroupBox):
    """How the outer surface is made."""

    changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTitle(self.tr("2  Outer surface"))
        rows = form()
        ways = (
            self.tr("Only if the mesh is open"),
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
        self.report = MeshReport(1)
        stacked(self, rows, self.report)
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
        self.number = plain_label("", "number")
        self.meaning = sentence_label()
        self.chart = TradeoffChart()
        target = self._target_form()
        self.overlay = check_box(self.tr("Overlay the original"))
        tip = self.tr("Distance from the outer surface to the simplified surface, mm")
        self.deviation = check_box(self.tr("Colour by deviation"), tip=tip)
        self.report = MeshReport(1)
        shown = (self.number, self.meaning, self.chart)
        stacked(self, *shown, target, self.overlay, self.deviation, self.report)
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
        # By the accessibility bus it is never clicked.
        self.painted.toggled.connect(lambda _on: self.changed.emit())
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
        return {**wanted, "region_ratio": self.ratio.value, "painted": self.painted.isChecked()}

    def show_result(self, facets: int | None, meaning: str) -> None:
        """Show how many facets there are now, and what that means; None: nothing yet."""
        self.number.setText("" if facets is None else filled(self.tr("{:,} facets"), facets))
        self.number.setVisible(facets is not None)
        self.meaning.setText(meaning)
        self.meaning.setVisible(bool(meaning))
        for each in (self.overlay, self.deviation):
            each.setEnabled(facets is not None)

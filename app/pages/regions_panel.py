"""What the Regions page shows, and in which state."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from contactbench.app.pages.regions_fields import muted
from contactbench.app.pages.regions_shape import ShapePanel
from contactbench.app.pages.regions_tools import ToolPanel
from contactbench.pipeline.workbench.regions_session import Standing
from contactbench.pipeline.workbench.steps import StepState
from contactbench.widgets.controls import PanelScroll, show_value
from contactbench.widgets.icons import Sign, icon, state_icon
from contactbench.widgets.phrases import said
from contactbench.widgets.region_list import RegionListWidget


class Mode(Enum):
    """What can be done on the page."""

    LOCKED = auto()  # there is nothing to paint on
    OPENING = auto()
    FAILED = auto()
    READY = auto()


@dataclass(frozen=True)
class View:
    """
    Everything that decides what the page looks like.

    Attributes
    ----------
    mode : Mode
    sentence : str
        Why it is locked or failed.
    regions : int
        How many there are.
    chosen : bool
        Whether one of them is.
    painted : bool
        Whether a facet belongs to one.
    standing : Standing
    dirty : bool
        There are changes that the session does not have yet.
    busy : bool
        Something is being computed.
    unkept : str
        Why the regions could not be kept; empty if they could.
    """

    mode: Mode
    sentence: str = ""
    regions: int = 0
    chosen: bool = False
    painted: bool = False
    standing: Standing = Standing.NONE
    dirty: bool = False
    busy: bool = False
    unkept: str = ""


class RegionsPanel(PanelScroll):
    """The controls of the page; `show_view` is the one place that decides what is seen."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent=parent)
        inside = QWidget()
        layout = QVBoxLayout(inside)
        layout.setContentsMargins(10, 10, 10, 10)
        layout.setSpacing(8)
        title = QLabel(self.tr("Regions"))
        title.setProperty("role", "title")
        layout.addWidget(title)
        layout.addWidget(
            muted(
                self.tr(
                    "Mark the parts that are meant to be touched, the most important first: where a reading fits"
                    " several places, the contact is looked for there. Regions are optional."
                )
            )
        )
        layout.addLayout(self._make_state())
        self.body = self._make_body()
        layout.addWidget(self.body)
        layout.addStretch(1)
        self.setWidget(inside)

    def _make_state(self) -> QVBoxLayout:
        column, row, busy = QVBoxLayout(), QHBoxLayout(), QHBoxLayout()
        self.state_mark = Sign(24)
        self.state_text = QLabel()
        self.state_text.setWordWrap(True)
        self.state_text.setObjectName("regions_state")
        row.addWidget(self.state_mark, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(self.state_text, 1)
        column.addLayout(row)
        self.progress = QProgressBar()
        self.progress.setRange(0, 100)
        self.progress.setAccessibleName(self.tr("How far it is"))
        self.cancel_button = QPushButton(self.tr("Cancel"))
        self.cancel_button.setMinimumHeight(36)
        busy.addWidget(self.progress, 1)
        busy.addWidget(self.cancel_button)
        column.addLayout(busy)
        self.go_button = QPushButton(self.tr("Go to Probe"))
        self.apply_button = QPushButton(self.tr("Give them to the probe"))
        self.apply_button.setToolTip(self.tr("Computes the probe again, with more facets in the regions"))
        self.next_button = QPushButton()
        for button in (self.go_button, self.apply_button, self.next_button):
            button.setMinimumHeight(40)
            column.addWidget(button)
        return column

    def _make_body(self) -> QWidget:
        body = QWidget()
        layout = QVBoxLayout(body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(8)
        self.regions = RegionListWidget()
        self.tools = ToolPanel()
        self.shape = ShapePanel()
        files = QHBoxLayout()
        self.import_button = QPushButton(self.tr("Import..."))
        self.import_button.setToolTip(self.tr("Replace all regions by those of a JSON or CSV file"))
        self.export_button = QPushButton(self.tr("Export..."))
        self.export_button.setToolTip(self.tr("Write the regions to a JSON or CSV file"))
        for button in (self.import_button, self.export_button):
            button.setMinimumHeight(36)
            files.addWidget(button)
        for part in (self.regions, self.tools, self.shape):
            layout.addWidget(part)
        layout.addLayout(files)
        return body

    # ---- what is seen ------------------------------------------------------------------------

    def show_share(self, share: float) -> None:
        """Show how far what is being computed is, 0 to 1."""
        self.progress.setRange(0, 100)
        show_value(self.progress, round(100 * share))

    def show_view(self, view: View) -> None:
        """Show all of it."""
        ready = view.mode is Mode.READY
        state, text = self._said(view)
        self.state_mark.show_icon(state_icon(state))
        self.state_mark.setAccessibleName(state.value)
        self.state_text.setText(said(text))
        self.body.setVisible(ready)
        self.body.setEnabled(ready and not view.busy)
        self.tools.setEnabled(view.chosen)
        self.shape.setEnabled(view.chosen)
        self.export_button.setEnabled(view.regions > 0)
        busy = view.busy or view.mode is Mode.OPENING
        if busy and not self.progress.isVisibleTo(self):
            self.progress.setRange(0, 0)
        self.progress.setVisible(busy)
        self.cancel_button.setVisible(busy)
        self.go_button.setVisible(view.mode in (Mode.LOCKED, Mode.FAILED))
        waiting = ready and view.painted and view.standing is not Standing.PLANNED
        applied = view.standing is Standing.APPLIED and not view.dirty
        self.apply_button.setVisible(waiting and not applied)
        self.apply_button.setEnabled(not view.busy)
        self.next_button.setVisible(ready and (applied or not view.painted))
        self.next_button.setText(self.tr("Go on to Verify") if applied else self.tr("Go on without regions"))
        self._accent(self.go_button, self.go_button.isVisibleTo(self))
        self._accent(self.apply_button, waiting and not applied)
        self._accent(self.next_button, applied)
        self._accent(self.regions.add_button, ready and view.regions == 0)
        self.regions.add_button.setIcon(icon("add", "panel" if ready and view.regions == 0 else "text"))

    def _said(self, view: View) -> tuple[StepState, str]:
        """Return the state and its sentence."""
        if view.mode is Mode.LOCKED:
            return StepState.LOCKED, view.sentence
        if view.mode is Mode.FAILED:
            return StepState.FAILED, view.sentence
        if view.mode is Mode.OPENING:
            return StepState.RUNNING, self.tr("The surface to paint on is being made.")
        if view.busy:
            return StepState.RUNNING, self.tr("Computing.")
        if view.unkept:
            return StepState.FAILED, self.tr(
                "The regions are not kept in the session: {0} The next change tries again."
            ).format(view.unkept)
        if not view.regions:
            return StepState.READY, self.tr("There are no regions yet: add one, then paint it on the probe.")
        if not view.chosen:
            return StepState.READY, self.tr("Choose a region in the list, then paint it on the probe.")
        if not view.painted:
            return StepState.READY, self.tr("Nothing is painted yet: take the brush and drag over the probe.")
        return self._of_painted(view)

    def _of_painted(self, view: View) -> tuple[StepState, str]:
        if view.dirty:
            return StepState.READY, self.tr("Painted; it is kept in the session in a moment.")
        if view.standing is Standing.APPLIED:
            return StepState.DONE, self.tr("The probe has these regions.")
        if view.standing is Standing.PLANNED:
            return StepState.READY, self.tr(
                "Kept in the session. The probe takes them along when it is made."
            )
        return StepState.STALE, self.tr("Kept in the session, but the probe does not have them yet.")

    @staticmethod
    def _accent(button: QPushButton, on: bool) -> None:
        if bool(button.property("primary")) != on:
            button.setProperty("primary", on)
            button.style().unpolish(button)
            button.style().polish(button)

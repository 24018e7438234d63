"""What the Regions page shows, and in which state."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QProgressBar, QWidget

from contactbench.app.pages.region_tools import ShapePanel, ToolPanel
from contactbench.pipeline.workbench.regions_session import Standing
from contactbench.pipeline.workbench.steps import StepState
from contactbench.widgets.controls import (
    PanelScroll,
    accent,
    column,
    plain_label,
    push_button,
    row,
    sentence_label,
    show_value,
)
from contactbench.widgets.icons import Sign, state_icon
from contactbench.widgets.phrases import said
from contactbench.widgets.region_list import RegionListWidget


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
    standing: Standing = Standing.NONE
    dirty: bool = False  # There are changes that the session does not have yet
    busy: bool = False  # Something is being computed
    unkept: str = ""  # Why the regions could not be kept; empty if they could


class RegionsPanel(PanelScroll):
    """The controls of the page; `show_view` is the one place that decides what is seen."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent=parent)
        self.state_mark, self.state_text = Sign(24), sentence_label()
        self.state_text.setObjectName("regions_state")
        self.progress = QProgressBar()
        self.progress.setRange(0, 100)
        self.progress.setAccessibleName(self.tr("How far it is"))
        self.cancel_button = push_button(self.tr("Cancel"))
        self.go_button = push_button(self.tr("Go to Probe"), high=40)
        self.apply_button = push_button(
            self.tr("Give them to the probe"),
            tip=self.tr("Computes the probe again, with more facets in the regions"),
            high=40,
        )
        self.next_button = push_button("", high=40)
        self.import_button = push_button(
            self.tr("Import..."), tip=self.tr("Replace all regions by those of a JSON or CSV file")
        )
        self.export_button = push_button(
            self.tr("Export..."), tip=self.tr("Write the regions to a JSON or CSV file")
        )
        self.regions, self.tools, self.shape = RegionListWidget(), ToolPanel(), ShapePanel()
        intro = self.tr(
            "Mark the parts that are meant to be touched, the most important first: where a reading fits"
            " several places, the contact is looked for there. Regions are optional."
        )
        state = row()
        state.addWidget(self.state_mark, 0, Qt.AlignmentFlag.AlignTop)
        state.addWidget(self.state_text, 1)
        inside, self.body = QWidget(), QWidget()
        column(self.body, self.regions, self.tools, self.shape, row(self.import_button, self.export_button))
        column(
            inside, plain_label(self.tr("Regions"), "title"), sentence_label(intro, "muted"), state,
            row((self.progress, 1), self.cancel_button), self.go_button, self.apply_button, self.next_button,
            self.body, margins=(10, 10, 10, 10),
        ).addStretch(1)  # fmt: skip
        self.setWidget(inside)

    # ---- what is seen ------------------------------------------------------------------------

    def show_share(self, share: float) -> None:
        """Show how far what is being computed is, 0 to 1."""
        self.progress.setRange(0, 100)
        show_value(self.progress, round(100 * share))

    def show_view(self, view: RegionsView) -> None:
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
        accent(self.go_button, self.go_button.isVisibleTo(self))
        accent(self.apply_button, waiting and not applied)
        accent(self.next_button, applied)
        accent(self.regions.add_button, ready and view.regions == 0, "add")

    def _said(self, view: RegionsView) -> tuple[StepState, str]:
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

    def _of_painted(self, view: RegionsView) -> tuple[StepState, str]:
        if view.dirty:
            return StepState.READY, self.tr("Painted; it is kept in the session in a moment.")
        if view.standing is Standing.APPLIED:
            return StepState.DONE, self.tr("The probe has these regions.")
        if view.standing is Standing.PLANNED:
            return StepState.READY, self.tr(
                "Kept in the session. The probe takes them along when it is made."
            )
        return StepState.STALE, self.tr("Kept in the session, but the probe does not have them yet.")

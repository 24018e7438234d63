"""What the Regions page shows, and in which state."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QWidget

from contactbench.app.pages.region_tools import ShapePanel, ToolPanel
from contactbench.pipeline.session.why import RegionsState
from contactbench.pipeline.steps import Step, StepState
from contactbench.widgets.controls import (
    PanelScroll,
    accent,
    column,
    plain_label,
    push_button,
    row,
    sentence_label,
)
from contactbench.widgets.icons import Sign, state_icon
from contactbench.widgets.numbers import translated
from contactbench.widgets.region_list import RegionListWidget

if TYPE_CHECKING:
    from contactbench.widgets.action_bar import ActionBar

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

    def __init__(self, bar: ActionBar, parent: QWidget | None = None) -> None:
        super().__init__(parent=parent)
        self._bar = bar
        self.state_mark, self.state_text = Sign(24), sentence_label()
        self.state_text.setObjectName("regions_state")
        self.state_text.setMinimumHeight(_THREE_LINES_PX)  # what lies below stays where it is
        self.import_button = push_button(
            self.tr("Import…"), tip=self.tr("Replace all regions with those in a JSON or CSV file")
        )
        self.export_button = push_button(
            self.tr("Export…"), tip=self.tr("Save the regions to a JSON or CSV file")
        )
        self.regions, self.tools, self.shape = RegionListWidget(), ToolPanel(), ShapePanel()
        intro = self.tr(
            "Mark the areas meant to be touched, most important first. If a reading fits several places,"
            " these areas are preferred. Regions are optional."
        )
        state = row()
        state.add(self.state_mark, 0, Qt.AlignmentFlag.AlignTop)
        state.add(self.state_text, 1)
        inside, self.body = QWidget(), QWidget()
        column(self.body, self.regions, self.tools, self.shape, row(self.import_button, self.export_button))
        column(
            inside, plain_label(self.tr("Regions"), "title"), sentence_label(intro, "muted"), state, self.body,
            margins=(10, 10, 10, 10),
        ).addStretch(1)  # fmt: skip
        self.setWidget(inside)

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
        accent(self.regions.add_button, ready and view.regions == 0, "add")

    def _offer(self, view: RegionsView) -> None:
        """Offer what is to be done next."""
        bar, free = self._bar, view.mode is Mode.READY and not view.busy
        applied = view.standing is RegionsState.APPLIED and not view.dirty
        bar.offer_second()
        planned = view.mode is Mode.READY and view.painted and view.standing is RegionsState.PLANNED
        if planned or view.mode in (Mode.LOCKED, Mode.FAILED):
            bar.offer(self.tr("Open Probe"), lambda: self.go_asked.emit(Step.PROBE))
        elif view.painted and not applied:
            tip = self.tr("Recompute the probe with more facets in the regions")
            bar.offer(self.tr("Apply regions"), self.apply_asked.emit, enabled=free, tip=tip)
        else:
            words = self.tr("Next: Verify") if applied else self.tr("Next: Verify, without regions")
            bar.offer(words, lambda: self.go_asked.emit(Step.VERIFY), enabled=free, accented=applied)

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
        if view.standing is RegionsState.APPLIED:
            return StepState.DONE, self.tr("The probe has these regions.")
        if view.standing is RegionsState.PLANNED:
            return StepState.READY, self.tr("Saved. The regions are applied when the probe is prepared.")
        return StepState.STALE, self.tr("Saved, but not yet applied to the probe.")

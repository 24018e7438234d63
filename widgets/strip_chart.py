"""Strip charts of what is live: force, torque, their size, and the contact point."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QAction, QResizeEvent
from PySide6.QtWidgets import (
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QMenu,
    QSizePolicy,
    QToolButton,
    QWidget,
)

from contactbench.pipeline.workbench.live import Live
from contactbench.widgets.controls import beside, called, column, tool_button
from contactbench.widgets.messages import filled
from contactbench.widgets.strip_chart_pane import Curves, Pane

_SPANS = (5.0, 10.0, 30.0, 60.0, 120.0)
_LONGEST_SPAN = _SPANS[-1]
_PANE_PX = (215, 105)  # the least that a pane needs to be read


def _none() -> NDArray[np.float64]:
    return np.empty(0)


@dataclass(frozen=True, eq=False)
class ChartHistory:
    """What the charts show."""

    times: NDArray[np.float64]  # (n,): s, on any clock, ascending
    # raw, compensated: (n, 6): N and N·m; NaN where there is none
    raw: NDArray[np.float64]
    compensated: NDArray[np.float64]
    contact_times: NDArray[np.float64] = field(default_factory=_none)  # (k,): s, on the same clock
    # (k, 3): S, m; NaN where nothing touches
    contacts: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 3)))


class StripChart(QWidget):
    """
    The charts. Feed them with `refresh`, or give them a `Live` and call `tick` up to 30 times a second.

    The wheel zooms the time, dragging moves it: both hold the picture, as `Pause` does, until `Back to live`.
    """

    def __init__(self, live: Live | None = None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._live = live
        self._held: ChartHistory | None = None  # what is looked at while time goes on
        self._shown: ChartHistory | None = None
        self._view: tuple[float, float] | None = None  # s before the newest, while held
        self._chosen_panes = self._chosen_kind = False
        self.panes = (
            Pane(Curves(self.tr("Force"), ("Fx", "Fy", "Fz"), "N", 2, 0.5), self),
            Pane(Curves(self.tr("Torque"), ("Mx", "My", "Mz"), "N·m", 3, 0.02, 3), self),
            Pane(Curves(self.tr("Force magnitude"), ("|F|",), "N", 2, 0.5), self),
            Pane(Curves(self.tr("Contact point"), ("x", "y", "z"), "mm", 1, 5.0), self),
        )
        self._grid = QGridLayout()
        self._grid.setSpacing(4)
        column(self, self._bar(), (self._grid, 1), margins=(4, 2, 4, 2), space=2)
        for pane in self.panes:
            pane.pointed.connect(self._point)
            pane.stretched.connect(self._stretch)
        self._hint = QLabel(self.tr("No measurements yet. Choose devices first."), self)
        self._hint.setProperty("role", "card")
        self._hint.setStyleSheet("padding: 4px 10px;")
        self._hint.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setMinimumSize(_PANE_PX[0], _PANE_PX[1] + 40)
        self._arrange()

    # ---- controls ----------------------------------------------------------------------------------

    def _bar(self) -> QHBoxLayout:
        self.kind = QComboBox()
        self.kind.addItems([self.tr("Raw"), self.tr("Compensated")])
        tip = self.tr("Raw: sensor readings. Compensated: bias and weight removed.")
        called(self.kind, self.tr("Raw or compensated wrenches in the charts"), tip)
        self.kind.activated.connect(self._choose_kind)
        self.span = QComboBox()
        for seconds in _SPANS:
            self.span.addItem(filled(self.tr("{seconds:g} s"), seconds=seconds), seconds)
        self.span.setCurrentIndex(1)
        called(self.span, self.tr("Time range of the charts"), self.tr("Time range in seconds"))
        self.span.activated.connect(self.back_to_live)
        self.pause_button = tool_button(
            "pause", self.tr("Pause"), tip=self.tr("Freeze the charts; recording continues")
        )
        self.pause_button.setCheckable(True)
        self.pause_button.toggled.connect(self._pause)  # by the accessibility bus it is never clicked
        self.live_button = tool_button(
            "play", self.tr("Resume live view"), self.back_to_live, tip=self.tr("Show current measurements")
        )
        self.live_button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.live_button.setText(self.tr("Resume live view"))
        self.live_button.setVisible(False)
        self.panes_button = tool_button(
            "settings", self.tr("Charts shown"), tip=self.tr("Choose which charts to show")
        )
        self.panes_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.panes_button.setMenu(self._menu())
        shown = (self.kind, self.span, self.pause_button, self.live_button)
        return beside(None, *shown, 1, self.panes_button, space=4)

    def _menu(self) -> QMenu:
        menu = QMenu(self)
        self._toggles: list[QAction] = []
        for pane in self.panes:
            toggle = menu.addAction(pane.curves.title)
            toggle.setCheckable(True)
            toggle.triggered.connect(self._choose_panes)
            self._toggles.append(toggle)
        return menu

    # ---- what is shown -----------------------------------------------------------------------------

    @property
    def held(self) -> bool:
        """Whether the picture is held while time goes on."""
        return self._held is not None

    def follow(self, live: Live | None) -> None:
        """Show another source from now on; None: none."""
        self._live = live
        self._chosen_kind = False
        self.back_to_live()
        if live is None:
            self._draw(ChartHistory(_none(), np.empty((0, 6)), np.empty((0, 6))))

    def tick(self) -> None:
        """Show the newest of what is followed."""
        if self._live is None or self.held:
            return
        if self._live.pair is None and self._shown is not None:
            return  # nothing new: what was last measured stays in view
        self.refresh(self._history(self._span()))

    def refresh(self, history: ChartHistory) -> None:
        """Show another history, unless the picture is held."""
        if not self.held:
            self._draw(history)

    def back_to_live(self) -> None:
        """Show what is measured now."""
        self._held = self._view = None
        self._show_held()
        self.tick()

    def _history(self, seconds: float) -> ChartHistory:
        live = self._live
        assert live is not None  # noqa: S101 - asked by its callers
        live.reading()  # that is what finds contacts
        times, raw, compensated = live.history(seconds)
        return ChartHistory(times, raw, compensated, *live.contacts(seconds))

    def _span(self) -> float:
        return float(self.span.currentData())

    def _draw(self, history: ChartHistory) -> None:
        self._shown = history
        compensated = bool(len(history.times)) and bool(np.isfinite(history.compensated[-1]).all())
        if not self._chosen_kind:  # what is more useful, until somebody chooses
            self.kind.setCurrentIndex(int(compensated))
        wrenches = history.compensated if self.kind.currentIndex() else history.raw
        newest = history.times[-1] if len(history.times) else 0.0
        self._hint.setVisible(not len(history.times))
        begin, end = self._view or (-self._span(), 0.0)
        times = history.times - newest
        size = np.linalg.norm(wrenches[:, :3], axis=1, keepdims=True)
        for pane, values in zip(self.panes, (wrenches[:, :3], wrenches[:, 3:], size), strict=False):
            if pane.isVisibleTo(self):
                pane.show_data(times, values, begin, end)
        if self.panes[3].isVisibleTo(self):
            self.panes[3].show_data(history.contact_times - newest, 1e3 * history.contacts, begin, end)

    # ---- held --------------------------------------------------------------------------------------

    def _pause(self, pressed: bool) -> None:
        if pressed:
            self._hold()
        else:
            self.back_to_live()

    def _hold(self) -> None:
        if self._held is None:
            # All there is: what is zoomed out to must be there.
            self._held = self._shown if self._live is None else self._history(_LONGEST_SPAN)
            self._view = (-self._span(), 0.0)
        self._show_held()

    def _show_held(self) -> None:
        self.pause_button.setChecked(self.held)
        self.live_button.setVisible(self.held)

    def _stretch(self, begin: float, end: float) -> None:
        self._hold()
        self._view = (begin, end)
        if self._held is not None:
            self._draw(self._held)

    def _point(self, moment: float | None) -> None:
        for pane in self.panes:
            pane.show_cursor(moment)

    def _choose_kind(self) -> None:
        self._chosen_kind = True
        if self._shown is not None:
            self._draw(self._shown)

    # ---- the panes ---------------------------------------------------------------------------------

    def _choose_panes(self) -> None:
        self._chosen_panes = True
        self._arrange()
        if self._shown is not None:
            self._draw(self._shown)

    def _arrange(self) -> None:
        """Show as many panes as there is room for, or those that were chosen, side by side while that goes."""
        wide, high = max(self.width() // _PANE_PX[0], 1), max((self.height() - 40) // _PANE_PX[1], 1)
        if not self._chosen_panes:
            for index, toggle in enumerate(self._toggles):
                toggle.setChecked(index < wide * high)
        chosen = [pane for pane, toggle in zip(self.panes, self._toggles, strict=True) if toggle.isChecked()]
        columns = max(1, min(wide, -(-len(chosen) // high), len(chosen) or 1))
        for pane in self.panes:
            self._grid.removeWidget(pane)
            pane.setVisible(pane in chosen)
            pane.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Ignored)
        for index, pane in enumerate(chosen):
            self._grid.addWidget(pane, index // columns, index % columns)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Use the room that there is."""
        super().resizeEvent(event)
        self._arrange()
        self._hint.adjustSize()
        self._hint.move((self.width() - self._hint.width()) // 2, 20 + (self.height() - 20) // 2)
        self._hint.raise_()

    def changeEvent(self, event: QEvent) -> None:
        """Take the colours of another theme."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "panes"):
            for pane in self.panes:
                pane.dress()

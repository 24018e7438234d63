"""The known point of the Verify page: which marker, one press."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtWidgets import QLabel, QWidget

from contactbench.app.pages.known_check import KnownCheckPanel
from contactbench.pipeline.verification.known_check import TOUCH
from contactbench.pipeline.workbench.known_checks import PressReading
from contactbench.widgets.controls import accent, choice, push_button, row, sentence_label

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.app.bench import Bench
    from contactbench.pipeline.calibration import GravityModel

_PRESS_N, _PRESS_S = 10.0, 1.3  # on the virtual bench


class PointPanel(KnownCheckPanel):
    """Press one known point: which marker, one press."""

    kind = TOUCH

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(bench, "", parent)
        self.setTitle(self.tr("Known point"))
        self.model: GravityModel | None = None
        self._points: dict[str, list[float]] = {}
        intro = sentence_label(
            self.tr(
                "Press one marker on the side of the probe with a finger. This reveals wrong torque signs"
                " or units, and a probe rotated on the sensor."
            )
        )
        self.point = choice((), self.tr("Marker"), tip="")
        label = QLabel(self.tr("Marker"))
        label.setBuddy(self.point)
        self.start = push_button(self.tr("Record press"), self._record, "play")
        self.lay_out(intro, row(label, (self.point, 1)), self.start)

    def show_markers(
        self, markers: Sequence[tuple[str, Sequence[float]]], model: GravityModel | None
    ) -> None:
        """Take the markers, name and point (m, S), and what compensates the sensor."""
        points = {name: [1e3 * value for value in point] for name, point in markers}
        self.model = model
        if points != self._points:
            chosen, self._points = self.point.currentText(), points
            self.point.clear()
            self.point.addItems(list(points))
            # The one that is farthest off the axis tells most of the torques.
            best = max(points, key=lambda name: np.hypot(points[name][0], points[name][1]), default="")
            self.point.setCurrentText(chosen if chosen in points else best)
        self.allow()

    def _record(self) -> None:
        name = self.point.currentText()
        if self.model is None or name not in self._points:
            return
        point = self._points[name]

        def pressed(recording: str) -> None:
            self.hint.setText("")
            self.judge({"touch": recording}, {"point": point})

        self.take(PressReading(self.model), pressed)

    def began(self) -> None:
        """Have the virtual bench press, where there is one."""
        bench, name = self.bench.live.bench, self.point.currentText()
        if bench is not None and name in self._points:
            point = np.array(self._points[name]) / 1e3
            bench.touch(point_S=point, force=_PRESS_N, seconds=_PRESS_S)

    def allow(self) -> None:
        """Say which buttons do something now."""
        super().allow()
        ready = bool(self._points) and self.model is not None
        self.start.setEnabled(ready and not self.busy)
        self.point.setEnabled(ready and not self.busy)
        self.start.setToolTip("" if self._points else self.tr("Place a marker on the Markers tab first."))
        accent(self.start, ready and not self.busy and self.outcome is None, "play")

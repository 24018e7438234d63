"""What the panels of a known weight and a known point have in common."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from PySide6.QtCore import Signal
from PySide6.QtWidgets import QGroupBox, QLayout, QWidget

from contactbench.app.bench import Bench, Weight
from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.errors import message
from contactbench.pipeline.verification.known_check import TOUCH, CheckOutcome
from contactbench.pipeline.workbench.verify import (
    KnownChecks,
    KnownOutcome,
    PressReading,
    StillReading,
    known_outcome,
)
from contactbench.widgets.controls import choice, column, plain_label, push_button, row, sentence_label
from contactbench.widgets.messages import translated
from contactbench.widgets.verdict_box import GOOD, LOCKED, REFUSE, USABLE, VerdictBox

# Outcome -> level of the verdict, weight of its message, word.
_LOOKS = {
    CheckOutcome.PASSED: (GOOD, Weight.GOOD, message("Passed")),
    CheckOutcome.UNDECIDED: (USABLE, Weight.WARNING, message("Inconclusive")),
    CheckOutcome.FAILED: (REFUSE, Weight.ERROR, message("Failed")),
}


class KnownCheckPanel(QGroupBox):
    """
    What both have in common: one reading at a time, its recording, and the verdict.

    Attributes
    ----------
    outcome : KnownOutcome or None
        That the session has.
    """

    kind = ""
    changed = Signal()

    def __init__(self, bench: Bench, title: str, parent: QWidget | None = None) -> None:
        super().__init__(title, parent)
        self.bench = bench
        self.work = KnownChecks(bench.desk, bench.live)
        self.outcome: KnownOutcome | None = None
        self._busy = False
        self._read_at = -1
        self._then: Callable[[str], None] | None = None
        self.hint, self.verdict = sentence_label(role="muted"), VerdictBox()
        self.cancel = push_button(self.tr("Cancel"), self.discard, "cross")

    def lay_out(self, *parts: QWidget | QLayout) -> None:
        """Put the parts of a check above what all of them have."""
        layout = column(self, *parts, self.cancel, self.hint, self.verdict)
        layout.setContentsMargins(9, 9, 9, 9)
        self.allow()

    # ---- what the page calls -----------------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether a reading or a computation goes on."""
        return self._busy or self.work.reading is not None

    def read(self) -> None:
        """Read the session's check, if the session changed."""
        desk = self.bench.desk
        state, stale = desk.state, desk.stale
        if state.count == self._read_at or self.bench.ending:
            return
        self._read_at = state.count

        def came(found: KnownOutcome | None) -> None:
            if self._read_at == state.count:
                self.have(found)

        self.bench.jobs.start(
            self.tr("Loading check"),
            lambda *_: known_outcome(desk.folder, state, stale, self.kind),
            came,
            self._wrong,
        )

    def poll(self) -> None:
        """Look at the reading that goes on; called with every tick."""
        reading = self.work.reading
        if reading is None or self._busy:
            return
        if reading.done:
            self._keep()
        elif reading.sentence:
            self.hint.setText(translated(reading.sentence))

    def close_panel(self) -> None:
        """End it: a reading that is not complete is thrown away."""
        if self.work.reading is not None:
            self.bench.jobs.start(self.tr("Stopping recording"), lambda *_: self.work.discard())

    # ---- readings ----------------------------------------------------------------------------------

    def take(self, reading: StillReading | PressReading, then: Callable[[str], None]) -> None:
        """Begin a reading; `then` gets the name of its recording once it is kept."""
        if self.busy:
            return
        self._then = then
        self._do(self.tr("Starting recording"), lambda: self.work.start(reading), lambda _: self.began())

    def began(self) -> None:
        """Be told that a reading has begun."""

    def _keep(self) -> None:
        then, self._then = self._then, None
        self._do(self.tr("Saving recording"), self.work.keep, lambda name: then(name) if then else None)

    def discard(self) -> None:
        """Throw the reading away."""
        self._then = None
        self._do(self.tr("Stopping recording"), self.work.discard, lambda _: self.hint.setText(""))

    def judge(self, recordings: Mapping[str, str], given: Mapping[str, Any]) -> None:
        """Have the session compute the check."""

        def judged(found: KnownOutcome) -> None:
            self._read_at = self.bench.desk.state.count
            self.have(found)
            self.bench.tell(_LOOKS[found.outcome][1], f"{self.title()}: {translated(found.sentence)}")

        self._do(self.tr("Computing check"), lambda: self.work.compute(self.kind, recordings, given), judged)

    def _do(self, title: str, work: Callable[[], Any], done: Callable[[Any], None]) -> None:
        self._busy = True
        self.allow()

        def over(then: Callable[[Any], None], what: object) -> None:
            self._busy = False
            then(what)
            self.allow()

        self.bench.jobs.start(title, lambda *_: work(), partial(over, done), partial(over, self._wrong))

    def _wrong(self, error: BaseException) -> None:
        self.bench.tell_error(error)
        self.hint.setText(translated(str(error)))

    # ---- what it shows -----------------------------------------------------------------------------

    def have(self, found: KnownOutcome | None) -> None:
        """Show a check; None: there is none."""
        self.outcome = found
        self.verdict.setVisible(found is not None)
        if found is not None:
            level, _, word = _LOOKS[found.outcome]
            if found.stale:
                self.verdict.show_verdict(LOCKED, [found.stale], self.tr("Outdated: check again"))
            else:
                self.verdict.show_verdict(level, [found.sentence], translated(word))
            self.show_parameters(found.parameters)
        self.allow()

    def show_parameters(self, parameters: Mapping[str, Any]) -> None:
        """Show what a check was made with."""

    def allow(self) -> None:
        """Say which buttons do something now."""
        self.verdict.setVisible(self.outcome is not None and not self.busy)
        self.cancel.setVisible(self.work.reading is not None)
        self.cancel.setEnabled(not self._busy)
        self.hint.setVisible(bool(self.hint.text()))
        self.changed.emit()


# ---- the known point of the Verify page: which marker, one press ---------------------------------


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
        label = plain_label(self.tr("Marker"), buddy=self.point)
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

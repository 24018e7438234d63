"""One heatmap in the viewer, and what of the contacts is shown: quantity, bandwidth, force; and what is saved of it."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker, Qt, QTimer, Signal
from PySide6.QtWidgets import QFormLayout, QLabel, QProgressBar, QPushButton, QSizePolicy, QSlider, QWidget

from contactbench.app.heatmap_viewer.reading_options import ReadingBox
from contactbench.pipeline.colour_ramp import ColourScale
from contactbench.pipeline.errors import InputError
from contactbench.widgets.controls import (
    HIGH,
    ElidedLabel,
    PanelScroll,
    accent,
    beside,
    called,
    check_box,
    choice,
    column,
    finish,
    form,
    plain_label,
    push_button,
    row,
    sentence_label,
    set_role,
    show_value,
)
from contactbench.widgets.messages import NumberBox, filled, translated
from contactbench.widgets.scene import Pick, Scene
from contactbench.widgets.time_bar import RangeSlider

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.heatmap.selection import HeatmapFrame, Playback, Selection

_LEAST_MM, _MOST_MM = 0.5, 20.0
_PATIENCE = 200  # ms without a change before the bells are made again


class HeatmapControls(QWidget):
    """The panel on the right of the viewer."""

    changed = Signal()  # the quantity, what it adds up to, or the range of force
    widened = Signal(float)  # another bandwidth, m, and no further change of it for a moment
    asked_open = Signal(bool)  # True: the folder of a session
    asked_save = Signal(str)  # "picture", "film" or "mesh"

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.quantity = choice(
            (
                (self.tr("Contact density"), "density"),
                (self.tr("Mean force"), "force"),
                (self.tr("Peak force"), "peak"),
                (self.tr("Mean error"), "error"),
                (self.tr("Uncertainty (1 sigma)"), "uncertainty"),
            ),
            self.tr("Quantity"),
            tip=self.tr("Meaning of the colours. Density: per mm2; forces: N; error and uncertainty: mm."),
        )
        self.per = choice(
            (
                (self.tr("contact count"), "contacts"),
                (self.tr("contact time in s"), "seconds"),
                (self.tr("contacts per second"), "rate"),
            ),
            self.tr("Density normalisation"),
            tip=self.tr("The integral of the density over the whole surface."),
        )
        self.bandwidth = NumberBox(
            decimals=1, minimum=_LEAST_MM, maximum=_MOST_MM, singleStep=0.5, suffix=" mm", value=2.0
        )
        self.bandwidth.setMinimumSize(112, HIGH)
        self.fine = QSlider(Qt.Orientation.Horizontal)
        self.fine.setRange(round(10 * _LEAST_MM), round(10 * _MOST_MM))
        self.fine.setValue(20)
        for each in (self.bandwidth, self.fine):
            tip = self.tr(
                "Standard deviation of the Gaussian that spreads each contact along the surface, mm."
            )
            called(each, self.tr("Bandwidth in mm"), tip)
        self.force, self.force_words = RangeSlider(), QLabel()
        tip = self.tr("Use only contacts with a force in this range, N.")
        called(self.force, self.tr("Force range in N"), tip)
        self.by_confidence = check_box(self.tr("Weight by confidence"))
        tip = self.tr("Equal factors are equal steps of colour, so that few contacts show beside many.")
        self.logarithmic = check_box(self.tr("Logarithmic colours"), tip=tip)
        tip = self.tr("Show a second heatmap with the same view and colour scale.")
        self.compare = check_box(self.tr("Compare side by side"), tip=tip)
        self.clock = choice(
            ((self.tr("from the first contact"), True), (self.tr("from each one's beginning"), False)),
            self.tr("Time of two that are compared"),
            tip=self.tr(
                "Whether both times count from where the probe was touched first, or from where each file begins."
            ),
        )
        self.later = NumberBox(decimals=1, minimum=-3600.0, maximum=3600.0, singleStep=0.1, suffix=" s")
        self.later.setMinimumSize(112, HIGH)
        tip = self.tr("Moves the second one against the first in time.")
        called(self.later, self.tr("How much later the second one is shown, s"), tip)
        self.message, self.reading = sentence_label(), ReadingBox()
        self.bar, self.stop = QProgressBar(), QPushButton(self.tr("Cancel"))
        self._confidences = False
        self._patience = QTimer(self, interval=_PATIENCE, singleShot=True)
        self._lay_out()
        self._connect()
        finish(self)
        self.set_confidences(False)
        self.show_force()
        self.show_work(None)

    def _lay_out(self) -> None:
        tip = self.tr("Recordings with their calibration and probe, contacts, or verifications.")
        files = self._button(self.tr("Open files"), "folder", tip, partial(self.asked_open.emit, False))
        tip = self.tr("Latest recording and verification of a session.")
        session = self._button(self.tr("Open session"), "folder", tip, partial(self.asked_open.emit, True))
        self._opening = [files, session]
        tip = self.tr("Save the current view from two sides as .png.")
        picture = self._button(self.tr("Picture"), "camera", tip, partial(self.asked_save.emit, "picture"))
        tip = self.tr("Save the time window at the chosen speed as .mp4 or .gif.")
        film = self._button(self.tr("Film"), "play", tip, partial(self.asked_save.emit, "film"))
        tip = self.tr("Save the vertex values as .ply or .glb (glTF).")
        mesh = self._button(self.tr("Mesh"), "export", tip, partial(self.asked_save.emit, "mesh"))
        self._saving = [picture, film, mesh]
        self._saving_tips = [button.toolTip() for button in self._saving]
        rows = form(wrap=QFormLayout.RowWrapPolicy.WrapAllRows, space=4)
        rows.addRow(self.tr("Quantity"), self.quantity)
        rows.addRow(self.tr("Normalise to"), self.per)
        rows.addRow(self.tr("Bandwidth"), row((self.fine, 1), self.bandwidth))
        rows.addRow(self.tr("Force"), self.force)
        self._per_label = rows.labelForField(self.per)
        self._two = QWidget()
        two = form(self._two, wrap=QFormLayout.RowWrapPolicy.WrapAllRows, space=4)
        two.addRow(self.tr("Time"), self.clock)
        two.addRow(self.tr("Second one later by"), self.later)
        self._two.hide()
        inside = QWidget()
        layout = column(
            inside, plain_label(self.tr("Heatmap"), "title"), row(*((each, 1) for each in self._opening)),
            rows, self.force_words, self.by_confidence, self.logarithmic, self.compare, self._two,
            plain_label(self.tr("Save"), "title"),
            row(*((each, 1) for each in self._saving)), self.message, self.reading,
            margins=(12, 10, 12, 8),
        )  # fmt: skip
        layout.addStretch(1)
        layout.addLayout(row((self.bar, 1), self.stop))
        column(self, PanelScroll(inside))
        self.setFixedWidth(348)

    def _button(self, text: str, picture: str, tip: str, does: Callable[[], object]) -> QPushButton:
        button = push_button(text, does, picture, tip=tip)
        button.setStyleSheet("padding: 4px 6px;")
        return button

    def _connect(self) -> None:
        self.quantity.currentIndexChanged.connect(lambda _index: self._quantity_changed())
        self.per.currentIndexChanged.connect(lambda _index: self.changed.emit())
        self.force.changed.connect(lambda _low, _high: self.show_force())
        self.force.changed.connect(lambda _low, _high: self.changed.emit())
        for box in (self.by_confidence, self.logarithmic):
            box.toggled.connect(lambda _on: self.changed.emit())
        self.fine.valueChanged.connect(lambda value: self.bandwidth.setValue(value / 10))
        self.bandwidth.valueChanged.connect(self._bandwidth_changed)
        self._patience.timeout.connect(lambda: self.widened.emit(self.bandwidth_m()))
        self.compare.toggled.connect(self._two.setVisible)

    # ---- what is chosen ----------------------------------------------------------------------------

    def bandwidth_m(self) -> float:
        """Return the bandwidth, m."""
        return round(self.bandwidth.value(), 1) / 1000

    def selection(self, start: float | None, end: float | None) -> Selection:
        """Return what is chosen, in a window of time, s."""
        from contactbench.pipeline.heatmap.selection import Selection

        least: float | None = None
        most: float | None = None
        if self.force.isEnabled():
            low, high = self.force.values()
            limits = self.force.limits()
            least = low if low > limits[0] else None
            most = high if high < limits[1] else None
        return Selection(
            self.quantity.currentData(),
            self.per.currentData(),
            self.bandwidth_m(),
            start,
            end,
            least,
            most,
            by_confidence=self.by_confidence.isEnabled() and self.by_confidence.isChecked(),
            logarithmic=self.logarithmic.isChecked(),
        )

    def set_bandwidth(self, metres: float) -> None:
        """Show a bandwidth; tells nobody."""
        self.bandwidth.setValue(1000 * metres)
        self._patience.stop()

    def set_forces(self, largest: float | None, profile: NDArray[np.float64] | None = None) -> None:
        """Offer forces up to the largest, N; None: they are unknown. What was chosen stays as far as it can."""
        low, high = self.force.values()
        before = None if self.force.whole() else (low, high)
        self.force.setEnabled(largest is not None)
        self.force.set_limits(0.0, largest or 1.0)
        self.force.set_profile(profile)
        if before is not None:
            self.force.set_values(*before)
        self.show_force()

    def set_confidences(self, known: bool) -> None:
        """Offer to weigh by confidence where it is known."""
        self._confidences = known
        self._allow_weight()

    def _allow_weight(self) -> None:
        peak = self.quantity.currentData() == "peak"
        self.by_confidence.setEnabled(self._confidences and not peak)
        tip = self.tr("Give uncertain contacts less weight.")
        if peak:
            tip = self.tr("A peak is the largest force: nothing is weighed in it.")
        elif not self._confidences:
            tip = self.tr("What is shown does not say how sure its contacts are: locate them again.")
        self.by_confidence.setToolTip(tip)

    def show_force(self) -> None:
        """Say the range of force."""
        if not self.force.isEnabled():
            self.force_words.setText(self.tr("Forces unknown."))
            return
        low, high = self.force.values()
        self.force_words.setText(filled(self.tr("{low:.1f} to {high:.1f} N"), low=low, high=high))

    def _quantity_changed(self) -> None:
        density = self.quantity.currentData() == "density"
        self.per.setVisible(density)
        self._per_label.setVisible(density)
        self._allow_weight()
        self.changed.emit()

    def _bandwidth_changed(self, value: float) -> None:
        with QSignalBlocker(self.fine):
            self.fine.setValue(round(10 * value))
        self._patience.start()

    # ---- what goes on ------------------------------------------------------------------------------

    def set_ready(self, ready: bool) -> None:
        """Say whether there is something to show and to save."""
        for each in (
            self.quantity,
            self.per,
            self.bandwidth,
            self.fine,
            self.logarithmic,
            self.compare,
            *self._saving,
        ):
            each.setEnabled(ready)
        for button, tip in zip(self._saving, self._saving_tips, strict=True):
            button.setToolTip(
                tip if ready else self.tr("Nothing is shown yet: open files or a session first.")
            )
        # one accented button: before anything is open that one, later the one that plays
        accent(self._opening[0], not ready, "folder")
        if not ready:
            self.set_confidences(False)
            self.force.setEnabled(False)
            self.force_words.setText("")

    def say(self, text: str, bad: bool = False) -> None:
        """Show a sentence."""
        set_role(self.message, "bad" if bad else "")
        self.message.setText(translated(text))

    def show_work(self, title: str | None, share: float = 0.0) -> None:
        """Show long work, how far it is, 0 to 1, and a way to stop it; None: there is none."""
        self.bar.setVisible(title is not None)
        self.stop.setVisible(title is not None)
        if title is not None:
            self.bar.setRange(0, 1000)
            show_value(self.bar, round(1000 * share))
            self.bar.setFormat(self.tr("{title}: {percent}").format(title=title, percent="%p %"))
            self.bar.setAccessibleName(title)


class Side(QWidget):
    """
    One heatmap.

    Attributes
    ----------
    scene : Scene
    playback : Playback or None
        What is shown; None: nothing yet.
    frame : HeatmapFrame or None
        What is seen.
    """

    chosen = Signal(int)  # another source, by its number
    pointed = Signal(object)  # Pick or None: where the mouse is

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.scene = Scene(self)
        self.playback: Playback | None = None
        self.frame: HeatmapFrame | None = None
        self._selection: Selection | None = None
        self._pick: Pick | None = None
        self._probe_of: object = None
        self.source = choice((), self.tr("Displayed quantity"), short=True, tip="")
        self.source.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.words = QLabel(self, wordWrap=True)
        self.value = called(plain_label("", "title"), self.tr("Value at the pointer"))
        self.value.setMinimumHeight(28)  # an empty one takes as much room: the scene must not jump
        self.value.setToolTip(
            self.tr(
                "± 1 sigma. Density: from the number of touches.\nMeans: spread of the averaged values."
                " Peak force: sensor noise."
            )
        )
        self.place = ElidedLabel(role="muted")
        self._lay_out()
        self.source.activated.connect(self.chosen)
        self.scene.hovered.connect(self.read_at)
        self.scene.hovered.connect(self.pointed)
        self._show_value()

    def _lay_out(self) -> None:
        foot = beside(None, self.value, (self.place, 1))
        column(self, self.source, (self.scene, 1), foot, self.words, margins=(6, 6, 6, 4), space=4)

    def set_sources(self, names: Sequence[str], current: int) -> None:
        """Offer sources."""
        self.source.clear()
        self.source.addItems(list(names))
        self.source.setCurrentIndex(current)

    def set_playback(self, playback: Playback) -> None:
        """Show another one."""
        self.playback, self._pick = playback, None
        if self._probe_of is not playback.probe:
            first = self._probe_of is None
            self._probe_of = playback.probe
            self.scene.show_field(None)
            self.scene.show_probe(playback.probe)
            if first:
                self.scene.look("fit")

    def scale(self, selection: Selection, window: float | None) -> ColourScale:
        """Return its own colours; they end at 0 where nothing is shown."""
        if self.playback is None:
            return ColourScale(0.0)
        try:
            return self.playback.scale(selection, window)
        except InputError:
            return ColourScale(0.0)

    def show_selection(self, selection: Selection, scale: ColourScale) -> None:
        """Show what is selected, in these colours; or say why there is nothing."""
        self._selection, self.frame = selection, None
        if self.playback is None:
            return
        try:
            frame = self.playback.frame(selection)
        except InputError as error:
            self.scene.show_field(None)
            self._say(self.tr("Nothing to show: {why}").format(why=translated(error)))
            return
        self.frame = frame
        title = f"{self._title(selection)}, {frame.unit}"
        self.scene.show_field(frame.values, title, scale if scale.top > 0 else None)
        self._say(self._said(frame))

    def _said(self, frame: HeatmapFrame) -> str:
        if self.playback is None or not frame.contacts:
            return self.tr("No contacts in this time window and force range. Widen one of them.")
        contacts = self.playback.contacts
        touches = contacts.counted == "touches"
        text = self.tr("Samples: {count:,} of {all:,}; grey: no data")
        if touches:
            text = self.tr("Touches: {count:,} of {all:,}; grey: no data")
        return filled(text, count=frame.contacts, all=len(contacts.points))

    def _title(self, selection: Selection) -> str:
        return {
            "density": self.tr("contact density"),
            "force": self.tr("mean force"),
            "peak": self.tr("peak force"),
            "error": self.tr("mean error"),
            "uncertainty": self.tr("uncertainty"),
        }[selection.quantity]

    def _say(self, text: str) -> None:
        if self.words.text() != text:
            self.words.setText(text)
        self._show_value()

    def read_at(self, pick: Pick | None) -> None:
        """Read the value at a place on the probe; None: at none."""
        self._pick = pick
        self._show_value()

    def _show_value(self) -> None:
        pick, frame = self._pick, self.frame
        if pick is None or frame is None or self.playback is None or self._selection is None:
            self.value.setText("")
            self.place.setText(self.tr("point at the probe to read a value"))
            return
        said = self.playback.at(self._selection, frame, pick.face, pick.point)
        if math.isnan(said.value):
            self.value.setText(self.tr("no data"))
        else:
            self.value.setText(number_with_unit(said.value, said.plus_minus, said.unit))
        x, y, z = (1e3 * pick.point).tolist()
        self.place.setText(filled(self.tr("at {x:.1f}, {y:.1f}, {z:.1f} mm"), x=x, y=y, z=z))


def number_with_unit(value: float, plus_minus: float, unit: str) -> str:
    """Return a number as people read it: no more digits than its uncertainty allows."""
    if math.isnan(plus_minus) or plus_minus <= 0:
        return filled("{:.3g} {}", value, unit)
    digits = max(0, 1 - math.floor(math.log10(plus_minus)))
    if digits > 6:
        return filled("{:.3g} ± {:.1g} {}", value, plus_minus, unit)
    return filled("{:.{digits}f} ± {:.{digits}f} {}", value, plus_minus, unit, digits=digits)

"""One heatmap in the viewer: whose it is, the scene, and the value under the cursor."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QLabel, QSizePolicy, QWidget

from contactbench.pipeline.colour_ramp import ColourScale
from contactbench.pipeline.errors import InputError
from contactbench.widgets.controls import ElidedLabel, beside, called, choice, column, plain_label
from contactbench.widgets.messages import translated
from contactbench.widgets.numbers import filled
from contactbench.widgets.scene import Pick, Scene

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.heatmap.playback import HeatmapFrame, Playback
    from contactbench.pipeline.heatmap.selection import Selection


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

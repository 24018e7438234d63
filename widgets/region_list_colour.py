"""Choosing a region's colour: first those that everybody can tell apart, then any."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QColorDialog, QMenu

from contactbench.pipeline.mesh.regions import PALETTE
from contactbench.widgets.region_list_rows import swatch
from contactbench.widgets.theme import is_dark

if TYPE_CHECKING:
    from collections.abc import Collection

    from PySide6.QtWidgets import QWidget


class ColourMenu(QMenu):
    """
    A menu of colours.

    Parameters
    ----------
    present : str
        The colour that there is, ``#rrggbb``.
    taken : collection of str
        Colours of other regions: they are said to be in use.
    """

    chosen = Signal(str)  # #rrggbb

    def __init__(self, present: str, taken: Collection[str], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._present = present
        for colour, name in zip(PALETTE, self._names(), strict=True):
            text = self.tr("{0} (in use)").format(name) if colour in taken else name
            action = self.addAction(swatch(colour, is_dark()), text)
            action.setCheckable(True)
            action.setChecked(colour == present)
            action.triggered.connect(lambda _=False, colour=colour: self.chosen.emit(colour))
        self.addSeparator()
        self.addAction(self.tr("Another colour...")).triggered.connect(self._ask)

    def _names(self) -> tuple[str, ...]:
        return (
            self.tr("Orange"),
            self.tr("Sky blue"),
            self.tr("Green"),
            self.tr("Yellow"),
            self.tr("Blue"),
            self.tr("Red-orange"),
            self.tr("Pink"),
        )

    def _ask(self) -> None:
        parent = self.parentWidget()
        colour = QColorDialog.getColor(QColor(self._present), parent, self.tr("Colour of the region"))
        if colour.isValid():
            self.chosen.emit(colour.name())

"""A view with two axes: what the charts draw on."""

from collections.abc import Sequence
from typing import Any

import pyqtgraph as pg
from PySide6.QtWidgets import QWidget

from contactbench.widgets.messages import local


class LocalAxis(pg.AxisItem):  # type: ignore[misc]
    """An axis whose numbers are as the reader writes them."""

    def tickStrings(self, values: Sequence[float], scale: float, spacing: float) -> list[str]:
        """Return what is written at the ticks."""
        return [local(each) for each in super().tickStrings(values, scale, spacing)]


class PlotFrame(pg.GraphicsView):  # type: ignore[misc]
    """
    A view of its own scale between a left and a bottom axis.

    pyqtgraph's PlotWidget brings menus, buttons and titles that no chart here has, and takes four times as long to
    make: a window that opens waits for six of them.

    Attributes
    ----------
    box : pyqtgraph.ViewBox
        Takes the items.
    left, bottom : pyqtgraph.AxisItem
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.box: Any = pg.ViewBox(enableMenu=False, defaultPadding=0.0)
        self.box.disableAutoRange()
        self.left: Any = LocalAxis("left")
        self.bottom: Any = LocalAxis("bottom")
        frame = pg.GraphicsLayout()
        frame.setContentsMargins(0, 0, 0, 0)
        frame.setSpacing(0)
        for item, row, column in ((self.left, 0, 0), (self.box, 0, 1), (self.bottom, 1, 1)):
            frame.addItem(item, row, column)
        for axis in (self.left, self.bottom):
            axis.linkToView(self.box)
        self.setCentralItem(frame)

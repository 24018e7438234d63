"""Progress bars that do not hold up the window."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from PySide6.QtWidgets import QProgressBar


def show_value(bar: QProgressBar, value: int) -> None:
    """
    Show a value with the next frame.

    `QProgressBar.setValue` paints at once, and with it the whole window with its 3D view: without a graphics card
    30 ms for each step of a work that tells of many.
    """
    if value == bar.value():
        return
    bar.setUpdatesEnabled(False)
    bar.setValue(value)
    bar.setUpdatesEnabled(True)  # which asks for a frame

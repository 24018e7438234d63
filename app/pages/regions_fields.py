"""Small parts of the Regions page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDoubleSpinBox, QLabel

if TYPE_CHECKING:
    from contactbench.pipeline.workbench.regions import Vector

AXES = ("x", "y", "z")


def length_field(least: float, most: float, words: str) -> QDoubleSpinBox:
    """Return a field for a length in mm."""
    field = QDoubleSpinBox(minimum=least, maximum=most, decimals=1, singleStep=0.5, suffix=" mm")
    field.setMinimumHeight(36)
    field.setMinimumWidth(84)  # its own would be for the longest number that it could hold
    field.setKeyboardTracking(False)
    field.setAccessibleName(words)
    field.setToolTip(words)
    field.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return field


def muted(text: str) -> QLabel:
    """Return a sentence that stands back."""
    label = QLabel(text)
    label.setWordWrap(True)
    label.setProperty("role", "muted")
    return label


def unit_vector(axis: int, length: float) -> Vector:
    """Return a vector along an axis."""
    x, y, z = (length if each == axis else 0.0 for each in range(3))
    return (x, y, z)

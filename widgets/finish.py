"""What no style sheet reaches: room in number fields, and labels that stand in line with their fields."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QAbstractSpinBox, QFormLayout, QLabel

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget

_TEXT_PX = 6


def finish(root: QWidget) -> None:
    """Give everything in `root` its last touch; a second time does nothing more."""
    for spin in root.findChildren(QAbstractSpinBox):
        spin.lineEdit().setTextMargins(_TEXT_PX, 0, 0, 0)
    for form in root.findChildren(QFormLayout):
        if form.rowWrapPolicy() is not QFormLayout.RowWrapPolicy.WrapAllRows:
            _line_up(form)


def _line_up(form: QFormLayout) -> None:
    """Make labels as high as their fields: Qt puts a small one near the top of a tall one."""
    for row in range(form.rowCount()):
        label, field = (
            form.itemAt(row, role)
            for role in (QFormLayout.ItemRole.LabelRole, QFormLayout.ItemRole.FieldRole)
        )
        words = None if label is None else label.widget()
        if isinstance(words, QLabel) and field is not None:
            words.setMinimumHeight(field.sizeHint().height())

"""Rows of a form, made of declared settings: words, unit, range and steps are those of `pipeline.settings.Row`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.pipeline.settings import Row
from contactbench.widgets.controls import named, show_quietly
from contactbench.widgets.numbers import NumberBox
from contactbench.widgets.phrases import said

if TYPE_CHECKING:
    from collections.abc import Collection

    from PySide6.QtCore import SignalInstance

    from contactbench.pipeline.settings import Settings


class SettingRow:
    """
    The field of one setting, and the words beside it.

    Parameters
    ----------
    row : Row
    name : str
        What the setting is, one sentence.

    Attributes
    ----------
    row : Row
    title : str
    name : str
        The sentence without its stop and its default, in the reader's language.
    field : NumberBox
    """

    def __init__(self, row: Row, name: str) -> None:
        told, self.row = said(name).removesuffix("."), row
        self.title, self.name = said(row.title), told.partition(" [")[0]
        self.field = named(NumberBox(), self.name, tip=told)
        put_row(self.field, row)

    @property
    def changed(self) -> SignalInstance:
        """Emitted, with the number that is shown, when a person has changed it."""
        return self.field.valueChanged

    @property
    def value(self) -> float | int | None:
        """The setting; None: nothing is given."""
        shown = self.field.value()
        if self.row.none and shown == self.row.span[0]:
            return None
        return shown if self.row.decimals else round(shown)

    def show(self, value: float | None) -> None:
        """Show a value, without a signal; None: nothing is given."""
        show_quietly(self.field, self.row.span[0] if value is None else value)


def put_row(field: NumberBox, row: Row) -> None:
    """Give a field the range, the steps and the unit of a setting."""
    field.setDecimals(row.decimals)
    field.setRange(*row.span)
    field.setSingleStep(row.step)
    field.setSuffix(row.unit and f" {row.unit}")
    field.setSpecialValueText(said(row.none))


def rows_of(model: type[Settings], names: Collection[str] = ()) -> dict[str, SettingRow]:
    """
    Return the rows of settings by their names.

    Parameters
    ----------
    model : type of Settings
    names : collection of str
        Left out: all that have a row. They come in the order of their declaration.
    """
    return {
        name: SettingRow(each, field.description or "")
        for name, field in model.model_fields.items()
        for each in field.metadata
        if isinstance(each, Row) and (not names or name in names)
    }

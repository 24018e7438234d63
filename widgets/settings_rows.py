"""Rows of a form, made of declared settings: words, unit, range and steps are those of `pipeline.settings.Row`."""

from collections.abc import Collection
from typing import Any

from pydantic.fields import FieldInfo
from PySide6.QtCore import SignalInstance

from contactbench.pipeline.knobs import Row, Settings, with_unit
from contactbench.widgets.controls import named, show_quietly
from contactbench.widgets.messages import NumberBox, translated


class SettingRow:
    """
    The field of one setting, and the words beside it.

    Parameters
    ----------
    row : Row
    setting : FieldInfo
        Made by `knob`.

    Attributes
    ----------
    row : Row
    title : str
    name : str
        What the setting is, with its unit, in the reader's language.
    unit : str
    field : NumberBox
    """

    def __init__(self, row: Row, setting: FieldInfo) -> None:
        extra: Any = setting.json_schema_extra
        text, self.unit, self._scale = translated(setting.description or ""), extra["unit"], extra["scale"]
        none = "" if extra["none"] in ("", row.none) else f" [{translated(extra['none'])}]"
        self.title, self.row = translated(row.title), row
        self.name = with_unit(text, self.unit).removesuffix(".")
        tip = with_unit(text, self.unit, none).removesuffix(".")
        self.field = named(NumberBox(), self.name, tip=tip)
        self.put_into(self.field)

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
        return shown / self._scale if self.row.decimals else round(shown)

    def put_into(self, field: NumberBox) -> None:
        """Give a field the range, the steps and the unit of the setting."""
        field.setDecimals(self.row.decimals)
        field.setRange(*self.row.span)
        field.setSingleStep(self.row.step)
        suffix = self.row.suffix or self.unit
        field.setSuffix(suffix and f" {suffix}")
        field.setSpecialValueText(translated(self.row.none))

    def show(self, value: float | None) -> None:
        """Show a value, without a signal; None: nothing is given."""
        show_quietly(self.field, self.row.span[0] if value is None else value * self._scale)


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
        name: SettingRow(each, field)
        for name, field in model.model_fields.items()
        for each in field.metadata
        if isinstance(each, Row) and (not names or name in names)
    }

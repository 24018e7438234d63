"""Rows of a form, made of declared settings."""

from typing import Annotated

import pytest

from contactbench.pipeline.knobs import Row, Settings, knob
from contactbench.widgets.settings_rows import rows_of


class Given(Settings):
    """Two with a row, one without."""

    size: Annotated[float | None, Row("Size", (0.5, 9.0), 1, none="Automatic")] = knob(
        None, "Size.", unit="mm", none="2"
    )
    count: Annotated[int, Row("Count", (1, 5))] = knob(2, "How many.")
    other: int = knob(0, "Not asked for.")


@pytest.mark.usefixtures("qtbot")
def test_rows_are_as_declared():
    rows = rows_of(Given)
    assert list(rows) == ["size", "count"]
    size, count = rows.values()
    heard: list[float] = []
    size.changed.connect(heard.append)
    size.show(None)
    assert (size.value, size.field.text(), size.name, size.field.toolTip()) == (
        None, "Automatic", "Size, mm", "Size, mm [2]",
    )  # fmt: skip
    size.show(99.0)
    assert (size.value, size.field.text(), heard) == (9.0, "9.0 mm", [])
    size.field.setValue(3.0)
    count.show(4)
    assert (heard, count.value, count.field.text()) == ([3.0], 4, "4")
    assert isinstance(count.value, int)

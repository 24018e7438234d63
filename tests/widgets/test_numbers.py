"""Numbers and dates as the reader writes them; what is typed with a point is no other number."""

import math
import re
from datetime import datetime
from pathlib import Path

import pytest
from PySide6.QtCore import QLocale, Qt

from contactbench.pipeline.errors import REPAIR, arg, message
from contactbench.widgets.controls import named
from contactbench.widgets.messages import (
    NumberBox,
    date_and_time,
    filled,
    local_numbers,
    number,
    time_of_day,
    translated,
    typed_number,
)
from contactbench.widgets.plot_frame import LocalAxis

ROOT = Path(__file__).parents[2]


@pytest.fixture
def german(qapp):  # noqa: ARG001 - axes need an application
    before = QLocale()
    QLocale.setDefault(QLocale("de_DE"))
    yield
    QLocale.setDefault(before)


@pytest.mark.usefixtures("german")
def test_a_german_reads_commas():
    assert number(0.73, ".2f") == "0,73"
    assert number(-1234.5, ",.1f") == "-1.234,5"
    assert (
        filled("{} mm, {:.1f} N, {:,}, {name}", 3, 2.25, 10_000, name="v1.2") == "3 mm, 2,2 N, 10.000, v1.2"
    )
    assert filled("{:.{}f}", 0.12345, 3) == "0,123"
    axis = LocalAxis("left")
    assert axis.tickStrings([0.5, 1.0], 1.0, 0.5) == ["0,5", "1,0"]


@pytest.mark.usefixtures("german")
@pytest.mark.parametrize(
    ("english", "expected"),
    [
        ("0.73 mm (95 % CI 0.06–0.14 mm).", "0,73 mm (95 % CI 0,06–0,14 mm)."),
        ("Turn it by -12.5°, ±0.5 N, at 1,000 Hz.", "Turn it by -12,5°, ±0,5 N, at 1.000 Hz."),
        ("5 poses, 3,4 of them", "5 poses, 3,4 of them"),
        # a window names its own action in the place of a command
        (
            message(f"2.5 s: {arg(REPAIR)} to recover it"),
            "2,5 s: choose Reload session in the File menu to recover it",
        ),
    ],
)
def test_sentences_of_the_pipeline_have_commas_too(english, expected):
    assert translated(english) == expected


@pytest.mark.usefixtures("german")
@pytest.mark.parametrize(
    "kept",
    [
        "Python 3.11.2 is too old.",
        "ur://192.168.0.5:30004 does not answer.",
        "probe-1.5.stl is empty.",
        "192.168.0.5",
        "/home/a/1.5/b is no folder.",
        "12:30:45.5",
        "v0.73",
    ],
)
def test_versions_addresses_and_files_stay_as_they_are(kept):
    assert local_numbers(kept) == kept


def test_in_english_nothing_changes():
    before = QLocale()
    QLocale.setDefault(QLocale("en_US"))
    try:
        assert number(1234.5, ",.1f") == "1,234.5"
        assert local_numbers("0.73 mm") == "0.73 mm"
        assert (
            time_of_day(datetime(2026, 3, 1, 15, 4, 5)).replace("\N{NARROW NO-BREAK SPACE}", " ")
            == "3:04:05 PM"
        )
    finally:
        QLocale.setDefault(before)


@pytest.mark.usefixtures("german")
def test_dates_and_times():
    moment = datetime(2026, 3, 1, 15, 4, 5)
    assert time_of_day(moment) == "15:04:05"
    assert date_and_time(moment).startswith("01.03.26")


@pytest.mark.parametrize("locale", ["de_DE", "en_US", "fr_FR"])
@pytest.mark.parametrize(
    ("typed", "taken"),
    [("0.5", 0.5), ("0,5", 0.5), ("0,750", 0.75), ("2.50", 2.5), ("1,0005", 1.0005), ("-1,5", -1.5)],
)
def test_a_point_or_a_comma_that_is_typed_is_a_decimal_mark_in_every_language(qtbot, locale, typed, taken):
    assert _typed(qtbot, locale, typed) == (taken, taken)


@pytest.mark.parametrize(("locale", "typed"), [("en_US", "1,000"), ("de_DE", "1.000"), ("fr_FR", "12.345")])
def test_what_could_be_thousands_is_refused(qtbot, locale, typed):
    value, cell = _typed(qtbot, locale, typed, pasted=True)  # of what is typed each mark is seen at once
    assert value == 7
    assert math.isnan(cell)


def _typed(qtbot, locale, typed, pasted=False):
    before = QLocale()
    QLocale.setDefault(QLocale(locale))
    try:
        box = named(NumberBox(decimals=4, minimum=-100.0, maximum=5000.0, value=7.0, suffix=" mm"), "length")
        qtbot.addWidget(box)
        box.show()
        box.lineEdit().selectAll()
        if pasted:
            box.lineEdit().insert(typed)
        else:
            qtbot.keyClicks(box.lineEdit(), typed)
        qtbot.keyClick(box.lineEdit(), Qt.Key.Key_Return)
        return box.value(), typed_number(typed)
    finally:
        QLocale.setDefault(before)


# A number that is given digits by a format.
_FORMATTED = re.compile(
    r"""f["'][^"'\n]*\{[^{}"'\n]+:[-+ z,]*\d*\.?\d*[fge,]\}"""
    r"""|\{[^{}]*:[+z,]*\.?\d*[fge]\}[^\n]*"\)\.format\("""
)


def test_every_number_on_the_screen_goes_through_here():
    found = [
        f"{file.relative_to(ROOT)}: {line.strip()}"
        for folder in ("app", "widgets")
        for file in sorted((ROOT / folder).rglob("*.py"))
        for line in file.read_text("utf-8").splitlines()
        if _FORMATTED.search(line) and "number(" not in line
    ]
    assert not found, "write it by contactbench.widgets.messages"

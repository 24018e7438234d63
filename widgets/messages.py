"""Messages of `pipeline` in the language of the window; numbers, dates and times as the reader writes them.

Only what is shown goes through here. Files, logs and what is copied from the window have points and ISO 8601.
"""

import math
import numbers
import re
import string
from datetime import datetime
from typing import Any

from PySide6.QtCore import QCoreApplication, QDateTime, QLocale
from PySide6.QtGui import QValidator
from PySide6.QtWidgets import QDoubleSpinBox

from contactbench.pipeline.errors import (
    ALIGN,
    CUT_OFF,
    DIAGNOSE,
    REPAIR,
    SALVAGE,
    Message,
    message,
    said_lately,
)

# A decimal number, or one in groups of three, that stands alone: no part of a version, an address or a file's name.
_IN_WORDS = re.compile(r"(?<![\w.,:/\\])(\d{1,3}(?:,\d{3})+(?:\.\d+)?|\d+\.\d+)(?![\w/\\]|[.,:]\w)")
# Thousands in one notation, thousandths in another.
_EITHER = re.compile(r"[+-]?[1-9]\d{0,2}[.,]\d{3}")
CONTEXT = "pipeline"
"""Where a language's file has them."""

_HERE = {
    ALIGN: message("align it on the Probe page"),
    DIAGNOSE: message("check Orientation on the Devices page"),
    REPAIR: message("choose Reload session in the File menu"),
    CUT_OFF: message("choose Open up to the damage"),
    SALVAGE: message("choose Salvage a copy, or restore a backup"),
}
"""What a window says in the place of a command."""


def translated(said: object) -> str:
    """Return a message, the text of an error, or a plain text where a language has it; others stay English."""
    text = said_lately(str(said))
    return local_numbers(text.translated(_known) if isinstance(text, Message) else _known(text))


def _known(template: str) -> str:
    return QCoreApplication.translate(CONTEXT, _HERE.get(template, template)) if template else ""


def number(value: float, spec: str) -> str:
    """Return a number by a format specification such as ".2f"."""
    return local(format(value, spec))


def filled(template: str, *values: Any, **named: Any) -> str:
    """Return a template filled as by `str.format`, with its numbers as the reader writes them."""
    return _FORMATTER.vformat(template, values, named)


def local(text: str) -> str:
    """Return the text of one number, as Python writes it, with the reader's marks."""
    locale = QLocale()
    marks = {".": locale.decimalPoint(), ",": locale.groupSeparator()}
    return "".join(marks.get(each, each) for each in text)


def local_numbers(sentence: str) -> str:
    """Return a sentence with the numbers in it as the reader writes them."""
    if QLocale().decimalPoint() == "." and QLocale().groupSeparator() == ",":
        return sentence
    return _IN_WORDS.sub(lambda found: local(found[0]), sentence)


def date_and_time(moment: datetime) -> str:
    """Return a date with its time."""
    return QLocale().toString(
        QDateTime.fromSecsSinceEpoch(round(moment.timestamp())), QLocale.FormatType.ShortFormat
    )


def time_of_day(moment: datetime) -> str:
    """Return a time to the second."""
    locale = QLocale()
    without_zone = locale.timeFormat(QLocale.FormatType.LongFormat).replace("t", "").strip()
    return locale.toString(QDateTime.fromSecsSinceEpoch(int(moment.timestamp())), without_zone)


class _Local(string.Formatter):
    def format_field(self, value: Any, format_spec: str) -> str:
        text: str = super().format_field(value, format_spec)
        return local(text) if format_spec and isinstance(value, numbers.Real) else text


_FORMATTER = _Local()


class NumberBox(QDoubleSpinBox):
    """
    A field for a number, which shows the reader's decimal mark and takes a point and a comma alike.

    Qt takes the other one for the mark of groups: of 0.5, typed in German, or 0,5, typed in English, it would make 5.
    A number such as 1,000 that could be either is refused.
    """

    def validate(self, text: str, position: int) -> tuple[QValidator.State, str, int]:
        """Look at what was typed."""
        bare = text.removeprefix(self.prefix()).removesuffix(self.suffix()).strip()
        if _EITHER.fullmatch(bare) and self.locale().decimalPoint() not in bare:
            return QValidator.State.Intermediate, text, position
        found: tuple[QValidator.State, str, int] = super().validate(self._marked(text), position)
        return found

    def fixup(self, text: str) -> str:  # noqa: ARG002 - Qt's signature
        """Return to the value before: of what was refused Qt would drop the marks of groups."""
        return f"{self.prefix()}{self.textFromValue(self.value())}{self.suffix()}"

    def valueFromText(self, text: str) -> float:
        """Return what was typed."""
        return super().valueFromText(self._marked(text))

    def _marked(self, text: str) -> str:
        point = self.locale().decimalPoint()
        return text.replace(".", point).replace(",", point)


def typed_number(text: str) -> float:
    """Return a number that was typed with a point or a comma; NaN: it is none, or could be two."""
    bare = text.strip()
    if _EITHER.fullmatch(bare) and QLocale().decimalPoint() not in bare:
        return math.nan
    try:
        return float(bare.replace(",", "."))
    except ValueError:
        return math.nan

"""Options of an address: how each is read. A reader raises ValueError that says what to give instead."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from contactbench.pipeline.errors import arg, message


def write_option(value: object) -> str:
    """Return an option's value as an address has it."""
    if isinstance(value, tuple):
        return ",".join(map(write_option, value))
    return str(int(value)) if isinstance(value, float) and value.is_integer() else str(value)


@dataclass(frozen=True)
class Option:
    """One option of a driver's address."""

    help: str  # one sentence for the person who types it
    read: Callable[[str], Any]  # text to value; raises ValueError that says what to give instead
    default: Any = None  # None: there is none
    write: Callable[[Any], str] = write_option  # value to the text that `read` reads back


def number(unit: str) -> Callable[[str], float]:
    """Return the reader of a positive number of a unit."""

    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not 1e-3 <= value <= 1e9:
            raise ValueError(message(f"give a positive number of {arg(unit)}"))
        return value

    return read


def numbers(fewest: int, most: int, largest: float) -> Callable[[str], tuple[float, ...]]:
    """Return the reader of so many numbers, none of which is beyond `largest`."""

    def read(text: str) -> tuple[float, ...]:
        try:
            values = tuple(map(float, text.split(",")[: most + 1]))
        except ValueError:
            values = ()
        if not fewest <= len(values) <= most or not all(abs(value) <= largest for value in values):
            many = str(fewest) if fewest == most else message(f"{arg(fewest)} to {arg(most)}")
            raise ValueError(
                message(f"give {arg(many)} numbers separated by commas, none beyond {arg(largest):g}")
            )
        return values

    return read


def whole(fewest: int, most: int, remedy: str) -> Callable[[str], int]:
    """Return the reader of a whole number in a range."""

    def read(text: str) -> int:
        # isdigit alone lets superscripts through.
        if not (text.isascii() and text.isdigit() and len(text) <= 15 and fewest <= int(text) <= most):
            raise ValueError(remedy)
        return int(text)

    return read


def name(text: str) -> str:
    """Read a name or a path."""
    if not text.strip() or not text.isprintable():
        raise ValueError(message("give its name, or leave the option out"))
    return text


def choice(*names: str) -> Callable[[str], str]:
    """Return the reader of one of some names."""

    def read(text: str) -> str:
        if text not in names:
            raise ValueError(message(f"choose one of {arg(', '.join(names))}"))
        return text

    return read


read_baud = whole(50, 12_000_000, message("give a whole number of bit/s such as 115200"))
read_rate = number("Hz")

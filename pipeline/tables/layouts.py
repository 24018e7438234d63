"""Tables as laboratories write them: what stands before the rows, how cells are separated, what columns mean.

A table that is not written as contactbench writes it is rewritten while it is read; everything behind reads one form.
"""

import codecs
import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import zip_longest
from typing import BinaryIO

from contactbench.pipeline.units import FORCES, TIMES, TORQUES

_PEEK = 2**16
_BOMS = ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"))
_SEPARATORS = "\t;,| "  # the last: any number of spaces
_SURE_ROWS, _FEWEST_NAMES = 3, 3
_DATE = re.compile(
    r"(?P<Y>\d{4})-(?P<m>\d\d)-(?P<d>\d\d)[T ](?P<H>\d\d):(?P<M>\d\d):(?P<S>\d\d)(?P<f>\.\d{1,9})?Z?"
    r"|(?P<d2>\d\d)\.(?P<m2>\d\d)\.(?P<Y2>\d{4}) (?P<H2>\d\d):(?P<M2>\d\d):(?P<S2>\d\d)(?P<f2>\.\d{1,9})?"
)

# What columns are called, by our name for them; \1 is an axis. In a header, the names of bags and programs end so.
_MEANINGS: tuple[tuple[str, str], ...] = tuple(
    (rf"(?:.*[/. ])?(?:{pattern})", name)
    for pattern, name in (
        (r"t|__time|time|timestamp|x_value|zeit|time stamp", "t"),
        (r"f_?([xyz])|(?:force|kraft)[/._ ]?([xyz])", "f{}"),
        (r"m_?([xyz])|(?:torque|moment)[/._ ]?([xyz])", "m{}"),
        (r"q(?:uat)?_?([0-7])|(?:orientation|rotation|quat|quaternion)[/._ \[]?([0-4])\]?", "q{}"),
        (r"(?:[rm]|rot)?_?([xyz])_?([xyz])", "r{}"),
        (r"q_?([wxyz])|(?:orientation|rotation|quat|quaternion)[/._ ]?([wxyz])", "q{}"),
        (r"(?:[rm]|rot)_?([1-3])_?([1-3])", "r{}"),
        (r"j_?(\d)|joint[_ ]?(\d)", "j{}"),
    )
)
_ELEMENT = r"(?:[rm]|rot)_?([0-3])_?([0-3])"
# Numbers of columns q: a quaternion in an unknown order, or joints; what makes q1 or j1 of the first.
_NUMBERED = {"0123": ("q", 1), "1234": ("q", 0), "123456": ("j", 0), "012345": ("j", 1), "1234567": ("j", 0)}
_TORQUES = re.compile(r"t_?([xyz])")  # unless there are others: elsewhere this is a translation

# Of a unit in a header, by what it multiplies: the first letter of our column.
UNITS: Mapping[str, Mapping[str, float]] = {
    "f": FORCES | {"mn": 1e-3, "kp": FORCES["kgf"], "newton": 1.0},
    "m": TORQUES
    | {"mnm": 1e-3, "inlbf": TORQUES["lbfin"], "inlb": TORQUES["lbfin"], "ftlbf": TORQUES["lbfft"]}
    | {"ozfin": TORQUES["lbfin"] / 16, "ozin": TORQUES["lbfin"] / 16},
    "t": TIMES
    | {"sec": 1.0, "seconds": 1.0, "µs": 1e-6, "100ns": 1e-7, "min": 60.0, "h": 3600.0, "d": 86_400.0},
}
_UNIT = re.compile(r"(.*?)\s*/?\s*(?:\[(?!\d\])(.+)\]|\((.+)\))\s*")
_SUFFIX = re.compile(r"(.*)(?:\s*[/_,]\s*| in )([^/_,]+)")
_POINTED = re.compile(r"[-+]?\d*\.\d+(?:e[-+]?\d+)?", re.IGNORECASE)
_COUNTS = {
    "f": re.compile(r"Counts per Unit Force:\s*([\d.]+)"),
    "m": re.compile(r"Counts per Unit Torque:\s*([\d.]+)"),
}
_NAMED = {"f": re.compile(r"Force Units:\s*([\w-]+)"), "m": re.compile(r"Torque Units:\s*([\w-]+)")}


@dataclass(frozen=True)
class Layout:
    """How a table is written."""

    encoding: str
    separator: str
    decimal: str
    header: int  # the line of the names, from 1
    first: int  # the line of the first row
    names: tuple[str, ...]  # as the table has them
    columns: tuple[str, ...]  # what they are called here; the same where no meaning is known
    scales: Mapping[str, float]  # of the columns that are in another unit: what makes N, N·m and s of them
    unknown: Mapping[str, str]  # of columns in a unit that is not known: that
    returns: bool = False  # lines end with a carriage return alone

    @property
    def plain(self) -> bool:
        """It is written as contactbench writes tables."""
        as_it_is = (self.encoding in ("utf-8", "utf-8-sig"), self.separator == ",", self.first == 2)
        return all(as_it_is) and self.names == self.columns and not self.scales and not self.returns


def layout_of(begin: bytes) -> Layout | None:
    """Return how a table is written, by its first 64 KiB; None: no line has names of columns that are known."""
    encoding = _encoding(begin)
    text = begin.decode(encoding, "replace")
    lines = text.splitlines()
    places = ((number, separator) for separator in _SEPARATORS for number in range(len(lines)))
    # A line with fewer separators has too few names, whatever they mean.
    places = (place for place in places if lines[place[0]].count(place[1]) >= _FEWEST_NAMES - 1)
    found = ((*place, named) for place in places if (named := _named(lines, *place)))
    header, separator, (names, units, first) = next(found, (0, "", ([], [], 0)))
    if not names:
        return None
    rows = [_split(line, separator) for line in lines[first:]]
    comma = separator != "," and not any(_POINTED.fullmatch(cell) for row in rows for cell in row)
    sure = [row for row in rows[:_SURE_ROWS] if row]
    widest = max(map(len, sure), default=len(names))
    if any(any(row[len(names) :]) or (separator == " " and len(row) < len(names)) for row in sure):
        return None  # which column has no name, or which cell a space, the file does not say
    if len(names) < widest or not any(map(_meaning, names[widest:])):
        names = [*names, *[""] * widest][:widest]
    parts = [_without_unit(*part) for part in zip_longest(names, units[: len(names)], fillvalue="")]
    columns = _columns(names, [name for name, _ in parts])
    scales, unknown = _scales(columns, [unit for _, unit in parts], "\n".join(lines[:first]))
    lines_at = header + 1, first + 1
    mark, returns = "," if comma else ".", "\n" not in text
    return Layout(encoding, separator, mark, *lines_at, tuple(names), columns, scales, unknown, returns)


def _named(lines: list[str], number: int, separator: str) -> tuple[list[str], list[str], int] | None:
    """Return the names in a line, the units below them, and the line of the first row; None: there are no names."""
    # NumPy and MATLAB put a mark before the names.
    around = ["", *lines, ""][number : number + 3]
    above, cells, below = (_split(line.lstrip("#% "), separator) for line in around)
    if len(cells) > 2 and set(cells[::2]) == {"Name"}:  # TwinCAT: a time before each value
        units = [_without_unit(below[0], "")[1]] if below else []
        names = [name if place % 2 else "t" * (not place) for place, name in enumerate(cells)]
        return names, units, number + 2
    # Motive has in the line above of what the axes are.
    alike = len(above) == len(cells)
    joined = [f"{kind} {name}" for kind, name in zip(above, cells, strict=True)] if alike else []
    for names in (cells, joined):
        if sum(_meaning(_without_unit(name, "")[0]) is not None for name in names) >= _FEWEST_NAMES:
            row = not any(below) or any(map(_is_number, below))
            units = [] if row or (separator == " " and len(below) != len(names)) else below
            return [name.strip() for name in names], units, number + 1 + bool(units)
    return None


def _encoding(begin: bytes) -> str:
    for bom, name in _BOMS:
        if begin.startswith(bom):
            return name
    if begin[1:200:2].count(0) > begin[0:200:2].count(0) + 20:
        return "utf-16-le"
    try:
        begin[: begin.rfind(b"\n") + 1].decode()
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8"


def _split(line: str, separator: str) -> list[str]:
    try:
        found = csv.reader([line.strip(" ")], delimiter=separator, skipinitialspace=True)
        return [cell.strip() for cell in next(found, [])]
    except csv.Error:  # who reads the table says so
        return []


def _bare(unit: str) -> str:
    return re.sub(r"[\s·*.\-\[\]()]", "", unit).lower()


def _without_unit(name: str, unit: str) -> tuple[str, str]:
    if found := _UNIT.fullmatch(name):
        return found[1], _bare(found[2] or found[3])
    found = None if _meaning(name) else _SUFFIX.fullmatch(name)
    kind = (
        "" if not found else "m" if _TORQUES.fullmatch(found[1].lower()) else (_meaning(found[1]) or "")[:1]
    )
    if found and _bare(found[2]) in UNITS.get(kind, ()):
        return found[1], _bare(found[2])
    return name, _bare(unit)


def _is_number(cell: str) -> bool:
    return _POINTED.fullmatch(cell.replace(",", ".")) is not None or cell.strip("+-").isdigit()


def _columns(names: list[str], bare: list[str]) -> tuple[str, ...]:
    """Return what the columns are called here; names of ours stay."""
    meanings = [_meaning(name) or "" for name in bare]
    torques = not any(name.startswith("m") for name in meanings)
    from_0 = any(re.fullmatch(_ELEMENT, name.lower()) and "0" in name for name in bare)
    parts = "".join(sorted(name[1] for name in meanings if re.fullmatch(r"q\d", name)))
    letter, offset = _NUMBERED.get(parts, ("", 0))
    for place, name in enumerate(bare):
        if torques and (axis := _TORQUES.fullmatch(name.lower())):
            meanings[place] = f"m{axis[1]}"
        elif re.fullmatch(r"q\d", meanings[place]):
            meanings[place] = letter and f"{letter}{int(meanings[place][1]) + offset}"
        elif from_0 and (element := re.fullmatch(_ELEMENT, name.lower())):
            meanings[place] = f"r{int(element[1]) + 1}{int(element[2]) + 1}"
    return tuple(
        meaning if meaning and meanings.count(meaning) == 1 else name
        for name, meaning in zip(names, meanings, strict=True)
    )


def _meaning(name: str) -> str | None:
    name = name.lower().strip()
    for pattern, meaning in _MEANINGS:
        found = re.fullmatch(pattern, name)
        if found:
            return meaning.format("".join(filter(None, found.groups())))
    return None


def _scales(
    columns: tuple[str, ...], units: list[str], above: str
) -> tuple[dict[str, float], dict[str, str]]:
    scales, unknown = {}, {}
    for column, unit in zip(columns, units, strict=True):
        kind = column[:1] if column == "t" or re.fullmatch(r"[fm][xyz]", column) else ""
        if kind in _NAMED and not unit and (named := _NAMED[kind].search(above)):
            unit = _bare(named[1])
        if kind and unit and unit not in UNITS[kind]:
            unknown[column] = unit
        scale = UNITS.get(kind, {}).get(unit, 1.0)
        if kind in _COUNTS and (counts := _COUNTS[kind].search(above)):
            scale /= float(counts[1])
        if scale != 1:
            scales[column] = scale
    return scales, unknown


class LabTable:
    """
    A table in another layout as a binary file in ours; lines keep their numbers.

    Parameters
    ----------
    stream : binary file
        At its beginning.
    """

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream
        self._begin = stream.read(_PEEK)
        self.layout = layout_of(self._begin)
        self.scales: Mapping[str, float] = {} if self.layout is None else self.layout.scales
        self._decode = None
        if self.layout is not None and not self.layout.plain:
            self._decode = codecs.getincrementaldecoder(self.layout.encoding)()
            self._left = self.layout.first - 1  # lines before the rows
            self._rest = ""
            names = ",".join(f'"{name}"' if "," in name else name for name in self.layout.columns)
            self._head = names.encode() + b"\n" + b"\n" * (self.layout.first - 2)

    def read(self, size: int) -> bytes:
        """Return the next bytes, about `size` of them, and none at the end."""
        data = self._next(size)
        if self._decode is None:
            return data
        while (
            not (rows := self._rewritten(self._decode.decode(data, final=not data), final=not data)) and data
        ):
            data = self._next(size)
        return rows

    def _next(self, size: int) -> bytes:
        begin, self._begin = self._begin[:size], self._begin[size:]
        return begin or self._stream.read(size)

    def _rewritten(self, text: str, *, final: bool) -> bytes:
        text = self._rest + text
        held = "" if final else text[len(text.rstrip("\r")) :]  # a line feed may follow
        text = text.removesuffix(held).replace("\r\n", "\n").replace("\r", "\n")
        cut = len(text) if final else text.rfind("\n") + 1
        text, self._rest = text[:cut], text[cut:] + held
        while self._left and (end := text.find("\n") + 1):
            text, self._left = text[end:], self._left - 1
        if not final and (self._left or not text):
            return b""
        assert self.layout is not None  # noqa: S101
        if self.layout.decimal == ",":
            text = text.replace(",", ".")
        if self.layout.separator == " ":
            text = re.sub(" +", " ", re.sub("^ +| +$", "", text, flags=re.MULTILINE))
        elif '"' in text:
            text = re.sub(rf"(?<={re.escape(self.layout.separator)}) +(?=\")", "", text)
        if self.layout.separator != ",":
            text = text.replace(",", " ").replace(self.layout.separator, ",")
        if "t" in self.layout.columns:
            text = _DATE.sub(_seconds, text)
        head, self._head = self._head, b""
        return head + text.encode()


def _seconds(found: re.Match[str]) -> str:
    *date, rest = (found[key] or found[f"{key}2"] for key in "YmdHMSf")
    year, month, day, hour, minute, second = map(int, date)
    try:
        whole = datetime(year, month, day, hour, minute, second, tzinfo=UTC)
    except ValueError:  # the 32nd of a month
        return found[0]
    return f"{whole.timestamp():.0f}{rest or ''}"

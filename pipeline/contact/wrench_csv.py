"""Wrenches from CSV: blocks of rows, fast where the file is plain, careful where it is not.

A block whose lines all have as many commas as the header goes through NumPy as a whole. Any other block
(quoted or blank cells, blank lines, anything wrong) is read once more, cell by cell: that reading either
succeeds or knows the line and the column to name.
"""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy.typing as npt

CHANNELS = ("fx", "fy", "fz", "mx", "my", "mz")
COLUMNS = ("t", *CHANNELS)

# About 64,000 rows of seven columns: large enough for NumPy, small enough for the processor's cache.
BLOCK_BYTES = 4 * 2**20

# Longer than any line of numbers. Without such limits a file that is no CSV would fill the memory.
_LONGEST_LINE = 2**20
_LONGEST_TIME = 256

_NOT_FINITE_REMEDY = "remove the row, or pass --allow-nan to have it answered with not_finite."

_COMMA, _NEWLINE, _QUOTE = b',\n"'
_BOM = b"\xef\xbb\xbf"  # some programs put it before UTF-8


class WrenchFileError(InputError):
    """A file of wrenches or contacts that cannot be used: names the file, the line, and the remedy."""


@dataclass(frozen=True)
class WrenchRows:
    """
    Consecutive rows of a file.

    Attributes
    ----------
    times : (n,) bytes
        The cells of column t as they stand in the file, UTF-8.
    t : (n,) float64 or None
        The same as numbers, s; None when nobody asked for them.
    wrenches : (n, 6) float64
        Fx Fy Fz Mx My Mz in S, N and N·m about the sensor origin.
    lines : (n,) int64
        The line of each row in the file; the header is line 1.
    """

    times: npt.NDArray[np.bytes_]
    t: npt.NDArray[np.float64] | None
    wrenches: npt.NDArray[np.float64]
    lines: npt.NDArray[np.int64]


class WrenchReader:
    """
    Iterate over the rows of a CSV file in blocks.

    Parameters
    ----------
    stream : binary file
        At its beginning; need not be seekable.
    name : str
        What messages call the file.
    timed : bool
        Column t must hold finite numbers too.
    allow_nan : bool
        NaN, infinity and empty cells are let through (an empty cell as NaN).
    block_bytes : int
        How much is read at a time.

    Raises
    ------
    WrenchFileError
        The header is unusable; when iterated: a row is, or there is none.
    """

    def __init__(
        self,
        stream: BinaryIO,
        name: str,
        *,
        timed: bool = False,
        allow_nan: bool = False,
        block_bytes: int = BLOCK_BYTES,
    ) -> None:
        self.bytes_read = 0
        self._stream = stream
        self._name = name
        self._allow_nan = allow_nan
        self._block_bytes = block_bytes
        self._line = 1  # of the next block's first row
        self._blocks = self._complete_lines()
        self._pending = b""
        names = self._header()
        self._cells = len(names)
        self._time = names.index("t")
        wanted = COLUMNS if timed else CHANNELS
        self._numbers = [(names.index(column), column) for column in wanted]

    def __iter__(self) -> Iterator[WrenchRows]:
        """Yield blocks of at least one row."""
        empty = True
        while self._pending:
            rows = self._parse(self._pending)
            if len(rows.wrenches):
                empty = False
                self._refuse_not_finite(rows)
                yield rows
            self._line += self._pending.count(b"\n")
            self._pending = next(self._blocks, b"")
        if empty:
            raise self._error("there is a header but no row below it: record again or choose another file.")

    def _error(self, what: str, line: int | None = None) -> WrenchFileError:
        return WrenchFileError(f"{self._name}: " + ("" if line is None else f"line {line}: ") + what)

    # ---- bytes -------------------------------------------------------------------------------

    def _complete_lines(self) -> Iterator[bytes]:
        """Yield text that ends with a line feed, about a block at a time."""
        rest = b""
        while data := self._read():
            cut = data.rfind(b"\n") + 1
            if cut:
                yield self._clean(rest + data[:cut])
                rest = data[cut:]
            else:
                rest += data
            if len(rest) > _LONGEST_LINE:
                raise self._error("a line is longer than 1 MiB: this is not a CSV file of wrenches.")
        if rest:
            yield self._clean(rest + b"\n")

    def _read(self) -> bytes:
        try:
            data = self._stream.read(self._block_bytes)
        except OSError as error:
            raise self._error(f"the file cannot be read ({error}): copy it to another place.") from error
        self.bytes_read += len(data)
        return data

    def _clean(self, block: bytes) -> bytes:
        bad = block.find(b"\0")
        if bad < 0 and not block.isascii():
            try:
                block.decode()
            except UnicodeDecodeError as error:
                bad = error.start
        if bad >= 0:
            line = self._line + block.count(b"\n", 0, bad)
            raise self._error("this is not UTF-8 text: save the table as CSV (UTF-8).", line)
        return block.replace(b"\r\n", b"\n")

    # ---- header ------------------------------------------------------------------------------

    def _header(self) -> list[str]:
        block = next(self._blocks, b"").removeprefix(_BOM)
        if not block.strip():
            raise self._error("the file is empty: it needs the header t,fx,fy,fz,mx,my,mz and rows below it.")
        end = block.index(b"\n") + 1
        names = [cell.strip() for cell in self._split(block[: end - 1].decode(), 1)]
        self._line = 2
        self._pending = block[end:] or next(self._blocks, b"")
        self._check_names(names)
        return names

    def _check_names(self, names: list[str]) -> None:
        missing = [column for column in COLUMNS if column not in names]
        if missing:
            found = ", ".join(name if name else "(no name)" for name in names)
            what = f"column{'s' * (len(missing) > 1)} {', '.join(missing)} missing; found: {found[:200]}."
            raise self._error(f"{what} {_header_remedy(names)}", 1)
        for column in COLUMNS:
            if names.count(column) > 1:
                what = f"column {column} occurs {names.count(column)} times: keep one and rename the others."
                raise self._error(what, 1)

    # ---- rows --------------------------------------------------------------------------------

    def _parse(self, block: bytes) -> WrenchRows:
        if _QUOTE not in block:
            rows = self._parse_plain(block)
            if rows is not None:
                return rows
        return self._parse_carefully(block)

    def _parse_plain(self, block: bytes) -> WrenchRows | None:
        """Read a block in which every line has as many cells as the header, or return None."""
        data = np.frombuffer(block, dtype=np.uint8)
        newlines = data == _NEWLINE
        ends = np.flatnonzero(newlines | (data == _COMMA))
        count, surplus = divmod(len(ends), self._cells)
        if (
            surplus
            or np.count_nonzero(newlines) != count
            or not newlines[ends[self._cells - 1 :: self._cells]].all()
        ):
            return None
        times = self._plain_times(data, ends)
        if times is None:
            return None
        try:
            numbers = np.loadtxt(
                io.StringIO(block.decode()),
                delimiter=",",
                comments=None,
                usecols=[index for index, _ in self._numbers],
                ndmin=2,
            )
        except ValueError:
            return None
        if len(numbers) != count:  # a carriage return inside a line
            return None
        return self._rows(times, numbers, np.arange(self._line, self._line + count))

    def _plain_times(
        self, data: npt.NDArray[np.uint8], ends: npt.NDArray[np.int64]
    ) -> npt.NDArray[np.bytes_] | None:
        last = ends[self._time :: self._cells]
        if self._time:
            first = ends[self._time - 1 :: self._cells] + 1
        else:
            first = np.concatenate(([0], ends[self._cells - 1 : -1 : self._cells] + 1))
        lengths = last - first
        width = max(int(lengths.max()), 1)
        if width > _LONGEST_TIME:
            return None
        place = np.arange(width)
        texts = data.take(first[:, None] + place, mode="clip")
        texts[place >= lengths[:, None]] = 0
        return texts.view(f"S{width}")[:, 0]

    def _parse_carefully(self, block: bytes) -> WrenchRows:
        times: list[bytes] = []
        numbers: list[list[float]] = []
        lines: list[int] = []
        for line, text in enumerate(block.decode().split("\n")[:-1], self._line):
            if not text.strip():
                continue
            cells = self._split(text, line)
            self._check_count(cells, line)
            numbers.append([self._number(cells[index], column, line) for index, column in self._numbers])
            times.append(self._time_text(cells[self._time], line))
            lines.append(line)
        table = np.array(numbers, dtype=np.float64).reshape(-1, len(self._numbers))
        return self._rows(np.array(times, dtype=np.bytes_), table, np.array(lines, dtype=np.int64))

    def _rows(
        self, times: npt.NDArray[np.bytes_], table: npt.NDArray[np.float64], lines: npt.NDArray[np.int64]
    ) -> WrenchRows:
        wrenches = np.ascontiguousarray(table[:, -len(CHANNELS) :])
        t = table[:, 0] if len(self._numbers) > len(CHANNELS) else None
        return WrenchRows(times, t, wrenches, lines)

    def _split(self, text: str, line: int) -> list[str]:
        try:
            return next(csv.reader([text], strict=True), [])
        except csv.Error as error:
            what = f"the cells cannot be told apart ({error}): check the quotes and the line ends."
            raise self._error(what, line) from None

    def _check_count(self, cells: list[str], line: int) -> None:
        if len(cells) == self._cells:
            return
        what = f"{len(cells)} cell{'s' * (len(cells) != 1)}, but the header has {self._cells}"
        if len(cells) < self._cells:
            raise self._error(f"{what}: complete the row or remove it.", line)
        raise self._error(f"{what}: remove what is too much, and write decimals with a point.", line)

    def _number(self, cell: str, column: str, line: int) -> float:
        text = cell.strip()
        if not text:
            if self._allow_nan:
                return math.nan
            raise self._error(f"column {column} is empty: {_NOT_FINITE_REMEDY}", line)
        try:
            # Python also takes 1_000 and the digits of other scripts, which no other reader does.
            return float(text if text.isascii() and "_" not in text else "no number")
        except ValueError:
            what = f"column {column} holds {text[:40]!r}, which is not a number: correct or remove the row."
            raise self._error(what, line) from None

    def _time_text(self, cell: str, line: int) -> bytes:
        text = cell.encode()
        if len(text) > _LONGEST_TIME:
            what = f"column t has {len(text)} bytes, more than {_LONGEST_TIME}: it should hold a time."
            raise self._error(what, line)
        if any(mark in cell for mark in ',"\r'):
            return b'"' + text.replace(b'"', b'""') + b'"'
        return text

    def _refuse_not_finite(self, rows: WrenchRows) -> None:
        table = rows.wrenches if rows.t is None else np.column_stack((rows.t, rows.wrenches))
        if self._allow_nan or np.isfinite(table).all():
            return
        row, place = (int(index) for index in np.argwhere(~np.isfinite(table))[0])
        what = f"column {self._numbers[place][1]} holds {table[row, place]}: {_NOT_FINITE_REMEDY}"
        raise self._error(what, int(rows.lines[row]))


def _header_remedy(names: list[str]) -> str:
    header = ",".join(COLUMNS)
    if any(mark in name for name in names for mark in ";\t"):
        return f"Separate the columns with commas and write decimals with a point: {header}"
    try:
        float(names[0] if names else "")
    except ValueError:
        return f"Name the columns {header}: forces in N, torques in N·m, in the sensor frame S."
    return f"The first line holds numbers: put the header {header} above it."

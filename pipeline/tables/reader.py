"""Tables from CSV: blocks of rows, fast where the file is plain, careful where it is not.

A block whose lines all have as many commas as the header goes through the kernel, see `numbers_of`. Any other
block (quoted or blank cells, blank lines, anything wrong) is read once more, cell by cell: that reading either
succeeds or knows the line and the column to name.
"""

import csv
import math
from collections.abc import Collection, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.kernel import plain_rows
from contactbench.pipeline.tables.layouts import LabTable


def numbers_of(
    block: bytes,
    cells: int,
    columns: Sequence[int],
    required: Sequence[bool],
    text: int | None = None,
    longest_text: int = 256,
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.bytes_] | None] | None:
    """
    Read lines of cells without quotes.

    Parameters
    ----------
    block : bytes
        Whole lines.
    cells : int
        In each of them.
    columns : sequence of int
        Those of the k columns of numbers.
    required : sequence of bool
        Of each of them: whether no cell may be empty, which else is NaN.
    text : int, optional
        A column to pass on as it stands.
    longest_text : int
        In bytes.

    Returns
    -------
    The numbers (n, k), and the texts (n,) if there are any; None: a line is not like that.
    """
    found = plain_rows(
        block, cells, list(columns), list(required), -1 if text is None else text, longest_text
    )
    if found is None:
        return None
    numbers, unsure, where, texts = found
    cells_left = [block[first:last] for first, last in where.tolist()]
    try:
        # Python also takes 1_000, which no other reader does.
        numbers.ravel()[unsure] = [float(b"no number" if b"_" in each else each) for each in cells_left]
    except ValueError:
        return None
    return numbers, None if texts is None else texts.view(f"S{texts.shape[1]}")[:, 0]


def floats_of(cells: Sequence[bytes]) -> npt.NDArray[np.float64]:
    """Read texts (n,) without commas as numbers; NaN where one is empty, and ValueError where one is no number."""
    found = numbers_of(b"".join((b"\n".join(cells), b"\n")), 1, (0,), (False,)) if cells else None
    if found is None or len(found[0]) != len(cells):
        raise ValueError(message("one of the cells is no number"))
    return found[0][:, 0]


# About 64,000 rows of seven columns: large enough to be split, small enough for the processor's cache.
BLOCK_BYTES = 4 * 2**20

# Longer than any line of numbers. Without such limits a file that is no CSV would fill the memory.
_LONGEST_LINE = 2**20
_LONGEST_TEXT = 256

_BOM = b"\xef\xbb\xbf"  # some programs put it before UTF-8


class TableError(InputError):
    """A table that cannot be used: names the file, the line, and the remedy."""


@dataclass(frozen=True)
class Wording:
    """What messages say about a kind of table."""

    header: str  # The header that such a file needs, as one would type it
    rows: str = "numbers"  # What the rows are, in the plural
    meaning: str = ""  # Units and frames of the columns; follows "Name the columns t,x,y,z: "
    # What to do about a NaN, an infinity or an empty cell: a remedy with a full stop
    not_finite: str = message("correct or remove the row.")
    text: str = message("a short text")  # What the text column should hold
    error: type[InputError] = TableError  # What is raised


@dataclass(frozen=True)
class TableRows:
    """Consecutive rows of a table."""

    columns: tuple[str, ...]  # The names of the k columns of numbers
    numbers: npt.NDArray[np.float64]  # (n, k) the cells of these columns
    # (n,) the cells of the text column as they stand in the file, UTF-8; None without such a column
    text: npt.NDArray[np.bytes_] | None
    lines: npt.NDArray[np.int64]  # (n,) the line of each row in the file; the header is line 1

    def column(self, name: str) -> npt.NDArray[np.float64]:
        """Return the (n,) numbers of one column; KeyError if it was not selected or is not there."""
        if name not in self.columns:
            raise KeyError(name)
        return self.numbers[:, self.columns.index(name)]


class TableReader:
    """
    Read the header of a CSV file, then, after `select`, iterate once over its rows in blocks.

    Parameters
    ----------
    stream : binary file
        At its beginning; need not be seekable.
    name : str
        What messages call the file.
    wording : Wording
        What messages say about its content.
    block_bytes : int
        How much is read at a time. The rows do not depend on it, only their division into blocks does.

    Attributes
    ----------
    names : tuple of str
        The header, without the spaces around its cells.
    columns : tuple of str
        The columns of numbers that were selected and are there.
    bytes_read : int
        From the stream so far.

    Raises
    ------
    wording.error
        The header is unusable; when iterated: a row is, or there is none.
    """

    def __init__(
        self, stream: BinaryIO | LabTable, name: str, wording: Wording, *, block_bytes: int = BLOCK_BYTES
    ) -> None:
        self.bytes_read = 0
        self.columns: tuple[str, ...] = ()
        self._stream = stream
        layout = stream.layout if isinstance(stream, LabTable) else None
        self._scales, self._unknown = ({}, {}) if layout is None else (layout.scales, layout.unknown)
        self._names_line = 1 if layout is None else layout.header
        self._name = name
        self._wording = wording
        self._block_bytes = block_bytes
        self._line = 1  # of the next block's first row
        self._blocks = self._complete_lines()
        self._pending = b""
        self.names = self._header()
        self._lost: dict[str, tuple[int, int]] = {}  # by column: the first line, and how many

    def select(
        self,
        required: Sequence[str],
        *,
        optional: Sequence[str] = (),
        text: str | None = None,
        allow_nan: Collection[str] = (),
        leave_out: Collection[str] | None = None,
    ) -> None:
        """
        Choose the columns to read; all others are ignored.

        Parameters
        ----------
        required : sequence of str
            Columns of numbers, in the order that the rows will have.
        optional : sequence of str
            Further ones, which come after them where they are there.
        text : str, optional
            A column that is passed on as it stands. May be one of numbers too.
        allow_nan : collection of str
            Columns in which NaN, infinity and empty cells are let through (an empty cell as NaN).
        leave_out : collection of str, optional
            Columns without whose number a row is left out. Then so is a row that ends early or has something else than
            a number in any column that was chosen; `left_out` tells them.

        Raises
        ------
        wording.error
            A column is missing, or occurs twice.
        """
        self.columns = (*required, *(column for column in optional if column in self.names))
        if not self.columns:
            raise ValueError(message("select at least one column of numbers"))
        wanted = dict.fromkeys(self.columns if text is None else (text, *self.columns))
        self._check_names([column for column in wanted if column not in self.names], list(wanted))
        if column := next(filter(self._unknown.get, wanted), None):
            what = message(
                f"column {arg(column)} is in {arg(self._unknown[column])}, a unit that is not known: write it in N,"
                " N·m or s, and change the header."
            )
            raise self.error(what, 1)
        self._indices = [self.names.index(column) for column in self.columns]
        self._lenient, needed = leave_out is not None, leave_out or ()
        self._needed = np.array([column in needed for column in self.columns])
        self._finite = ~self._needed & [column not in allow_nan for column in self.columns]
        self._text = None if text is None else self.names.index(text)

    def __iter__(self) -> Iterator[TableRows]:
        """Yield blocks of at least one row."""
        if not self.columns:
            raise RuntimeError(message("select columns before reading rows"))
        empty = True
        while self._pending:
            rows = self._parse(self._pending)
            if self._needed.any():
                rows = self._with_all_needed(rows)
            if len(rows.lines):
                empty = False
                self._refuse_not_finite(rows)
                yield self._in_our_units(rows) if self._scales else rows
            self._pending = next(self._blocks, b"")
        for column, lines in self._lost.items() if empty else ():
            what = message(
                f"column {arg(column)} is empty or no number, and no row is complete: fill in the cells, or choose"
                " another file."
            )
            raise self.error(what, lines[0])
        if empty:
            raise self.error(
                message("there is a header but no row below it: record again or choose another file.")
            )

    def _in_our_units(self, rows: TableRows) -> TableRows:
        text, scale = rows.text, self._scales.get(self.names[self._text or 0], 1.0)
        if text is not None and scale != 1.0:
            with suppress(ValueError):  # a name
                text = np.array([repr(float(cell) * scale) for cell in text.tolist()], dtype=np.bytes_)
        numbers = rows.numbers * [self._scales.get(column, 1.0) for column in self.columns]
        return TableRows(rows.columns, numbers, text, rows.lines)

    def left_out(self) -> Iterator[str]:
        """Yield how many rows were left out, by the first column that failed: sentences."""
        for column, (line, count) in self._lost.items():
            yield message(
                f"{arg(count):,} rows left out: column {arg(column)} is empty or no number, first in line {arg(line)}."
            )

    def error(self, what: str, line: int | None = None) -> InputError:
        """Return the error to raise about this file, for what only the caller can find wrong; line 1 is the header."""
        if line is None:
            return self._wording.error(message(f"{arg(self._name)}: {arg(what)}"))
        line = self._names_line if line == 1 else line
        return self._wording.error(message(f"{arg(self._name)}: line {arg(line)}: {arg(what)}"))

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
                what = message(
                    f"a line is longer than 1 MiB, so this is not a CSV file of {arg(self._wording.rows)}:"
                    " choose another."
                )
                raise self.error(what)
        if rest:
            yield self._clean(rest + b"\n")

    def _read(self) -> bytes:
        try:
            data = self._stream.read(self._block_bytes)
        except OSError as error:
            raise self.error(
                message(f"the file cannot be read ({arg(error)}): copy it to another location.")
            ) from error
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
            raise self.error(message("this is not UTF-8 text: save the table as CSV (UTF-8)."), line)
        return block.replace(b"\r\n", b"\n") if b"\r" in block else block

    # ---- header ------------------------------------------------------------------------------

    def _header(self) -> tuple[str, ...]:
        block = next(self._blocks, b"").removeprefix(_BOM)
        if not block.strip():
            what = message(
                f"the file is empty: it needs the header {arg(self._wording.header)} and rows below it."
            )
            raise self.error(what)
        end = block.index(b"\n") + 1
        names = tuple(cell.strip() for cell in self._split(block[: end - 1].decode(), 1))
        self._line = 2
        self._pending = block[end:] or next(self._blocks, b"")
        return names

    def _check_names(self, missing: Sequence[str], wanted: Sequence[str]) -> None:
        if missing:
            found = ", ".join(name if name else message("(no name)") for name in self.names)
            lost = message("column") if len(missing) == 1 else message("columns")
            what = message(f"{arg(lost)} {arg(', '.join(missing))} missing; found: {arg(found[:200])}.")
            raise self.error(message(f"{arg(what)} {arg(self._header_remedy())}"), 1)
        for column in wanted:
            if (count := self.names.count(column)) > 1:
                what = message(
                    f"column {arg(column)} occurs {arg(count)} times: keep one and rename the others."
                )
                raise self.error(what, 1)

    def _header_remedy(self) -> str:
        header = self._wording.header
        if any(mark in name for name in self.names for mark in ";\t"):
            return message(f"Separate the columns with commas and write decimals with a point: {arg(header)}")
        try:
            float(self.names[0] if self.names else "")
        except ValueError:
            if meaning := self._wording.meaning:
                return message(f"Name the columns {arg(header)}: {arg(meaning)}.")
            return message(f"Name the columns {arg(header)}.")
        return message(f"The first line contains numbers: put the header {arg(header)} above it.")

    # ---- rows --------------------------------------------------------------------------------

    def _parse(self, block: bytes) -> TableRows:
        # A carriage return inside a line is refused in words.
        if b'"' not in block and b"\r" not in block:
            rows = self._parse_plain(block)
            if rows is not None:
                return rows
        return self._parse_carefully(block)

    def _parse_plain(self, block: bytes) -> TableRows | None:
        """Read a block in which every line has as many cells as the header, or return None."""
        cells = len(self.names)
        required = [cells == 1 or finite for finite in self._finite.tolist()]
        found = numbers_of(block, cells, self._indices, required, self._text, _LONGEST_TEXT)
        if found is None:
            return None
        numbers, text = found
        begin = self._line
        self._line += len(numbers)
        return TableRows(self.columns, numbers, text, np.arange(begin, self._line))

    def _parse_carefully(self, block: bytes) -> TableRows:
        texts: list[bytes] = []
        numbers: list[list[float]] = []
        lines: list[int] = []
        for line, row in enumerate(block.decode().split("\n")[:-1], self._line):
            if not row.strip():
                continue
            cells = self._split(row, line)
            if self._lenient and (column := self._failing(cells)) is not None:
                self._lose(column, line, 1)
                continue
            self._check_count(cells, line)
            numbers.append([self._number(cells[at], i, line) for i, at in enumerate(self._indices)])
            if self._text is not None:
                texts.append(self._text_cell(cells[self._text], line))
            lines.append(line)
        self._line += block.count(b"\n")
        table = np.array(numbers, dtype=np.float64).reshape(-1, len(self.columns))
        text = None if self._text is None else np.array(texts, dtype=np.bytes_)
        return TableRows(self.columns, table, text, np.array(lines, dtype=np.int64))

    def _failing(self, cells: list[str]) -> str | None:
        """Return the first column that a row does not reach, or in which it has something else than a number."""
        if len(cells) < len(self.names):
            return self.names[len(cells)]
        wrong = (cell for cell in self._indices if (text := cells[cell].strip()) and _number_in(text) is None)
        return next((self.names[cell] for cell in wrong), None)

    def _with_all_needed(self, rows: TableRows) -> TableRows:
        lacking = ~np.isfinite(rows.numbers) & self._needed
        whole = ~lacking.any(axis=1)
        if whole.all():
            return rows
        first, lines = lacking[~whole].argmax(axis=1), rows.lines[~whole]
        for place in np.unique(first).tolist():
            self._lose(self.columns[place], int(lines[first == place][0]), int((first == place).sum()))
        text = None if rows.text is None else rows.text[whole]
        return TableRows(rows.columns, rows.numbers[whole], text, rows.lines[whole])

    def _lose(self, column: str, line: int, count: int) -> None:
        begin, before = self._lost.get(column, (line, 0))
        self._lost[column] = min(begin, line), before + count

    def _split(self, text: str, line: int) -> list[str]:
        try:
            return next(csv.reader([text], strict=True), [])
        except csv.Error as error:
            what = message(
                f"the cells cannot be separated ({arg(error)}): check the quotes and the line ends."
            )
            raise self.error(what, line) from None

    def _check_count(self, cells: list[str], line: int) -> None:
        if len(cells) == len(self.names):
            return
        what = message(
            f"{arg(len(cells))} cell{arg('s' * (len(cells) != 1))}, but the header has {arg(len(self.names))}"
        )
        if len(cells) < len(self.names):
            raise self.error(message(f"{arg(what)}: complete the row or remove it."), line)
        raise self.error(message(f"{arg(what)}: remove the surplus, and write decimals with a point."), line)

    def _number(self, cell: str, place: int, line: int) -> float:
        text = cell.strip()
        if not text and not self._finite[place]:
            return math.nan
        if not text:
            what = message(f"column {arg(self.columns[place])} is empty: {arg(self._wording.not_finite)}")
            raise self.error(what, line)
        if (number := _number_in(text)) is None:
            what = message(f"holds {arg(text[:40])!r}, which is not a number: correct or remove the row.")
            raise self.error(message(f"column {arg(self.columns[place])} {arg(what)}"), line)
        return number

    def _text_cell(self, cell: str, line: int) -> bytes:
        text = cell.encode()
        if len(text) > _LONGEST_TEXT:
            what = message(
                f"has {arg(len(text))} bytes, more than {arg(_LONGEST_TEXT)}: it should hold {arg(self._wording.text)}."
            )
            raise self.error(message(f"column {arg(self.names[self._text or 0])} {arg(what)}"), line)
        if any(mark in cell for mark in ',"\r'):
            return b'"' + text.replace(b'"', b'""') + b'"'
        return text

    def _refuse_not_finite(self, rows: TableRows) -> None:
        if not self._finite.any() or np.isfinite(rows.numbers).all():
            return
        bad = np.argwhere(~np.isfinite(rows.numbers) & self._finite)
        if len(bad):
            row, place = bad[0].tolist()
            what = message(f"holds {arg(rows.numbers[row, place])}: {arg(self._wording.not_finite)}")
            raise self.error(message(f"column {arg(self.columns[place])} {arg(what)}"), int(rows.lines[row]))


def _number_in(text: str) -> float | None:
    """Return the number that a text is; None: it is none."""
    try:
        # Python also takes 1_000 and the digits of other scripts, which no other reader does.
        return float(text) if text.isascii() and "_" not in text else None
    except ValueError:
        return None

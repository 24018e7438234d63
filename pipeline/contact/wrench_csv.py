"""Wrenches from CSV, block by block."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.tables import BLOCK_BYTES, TableError, TableReader, Wording
from contactbench.pipeline.tables.layouts import LabTable

CHANNELS = ("fx", "fy", "fz", "mx", "my", "mz")
COLUMNS = ("t", *CHANNELS)
RAW_COLUMNS = (
    "qw",
    "qx",
    "qy",
    "qz",
    "status",
    "sequence",
)  # a recording has them, compensated wrenches do not


class WrenchFileError(TableError):
    """A file of wrenches or contacts that cannot be used: names the file, the line, and the remedy."""


_WORDING = Wording(
    header=",".join(COLUMNS),
    rows="wrenches",
    meaning=message("forces in N, torques in N·m, in the sensor frame S"),
    not_finite=message("remove the row, or pass --allow-nan to get the answer not_finite."),
    text="a time",
    error=WrenchFileError,
)


@dataclass(frozen=True)
class WrenchBlock:
    """Consecutive rows of a file."""

    times: npt.NDArray[np.bytes_]  # (n,) the cells of column t as they stand in the file, UTF-8
    t: npt.NDArray[np.float64] | None  # (n,) the same as numbers, s; None when nobody asked for them
    wrenches: npt.NDArray[np.float64]  # (n, 6) fx Fy Fz Mx My Mz in S, N and N·m about the sensor origin
    lines: npt.NDArray[np.int64]  # (n,) the line of each row in the file; the header is line 1


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
        stream: BinaryIO | LabTable,
        name: str,
        *,
        timed: bool = False,
        allow_nan: bool = False,
        block_bytes: int = BLOCK_BYTES,
    ) -> None:
        self._table = TableReader(stream, name, _WORDING, block_bytes=block_bytes)
        wanted = COLUMNS if timed else CHANNELS
        self._table.select(wanted, text="t", allow_nan=wanted if allow_nan else ())
        self._timed = timed

    def refuse_raw(self) -> None:
        """
        Refuse a recording that nobody compensated: `contactbench calibrate compensate` does not write such columns.

        Raises
        ------
        WrenchFileError
            It looks like one.
        """
        raw = [name for name in self._table.names if name in RAW_COLUMNS]
        if raw:
            what = message(
                f"column{arg('s' * (len(raw) > 1))} {arg(', '.join(raw))}: this is a raw recording that"
                " includes the tool's weight and the sensor's offset. Compensate it first:"
                " contactbench calibrate compensate calibration.json RECORDING --out WRENCHES; or"
                " pass --compensated if that is done."
            )
            raise self._table.error(what, 1)

    @property
    def bytes_read(self) -> int:
        """Bytes read from the stream so far."""
        return self._table.bytes_read

    def __iter__(self) -> Iterator[WrenchBlock]:
        """Yield blocks of at least one row."""
        for rows in self._table:
            assert rows.text is not None  # noqa: S101  (the table was asked for it)
            t = rows.numbers[:, 0] if self._timed else None
            wrenches = np.ascontiguousarray(rows.numbers[:, -len(CHANNELS) :])
            yield WrenchBlock(rows.text, t, wrenches, rows.lines)

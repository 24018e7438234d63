"""Tables as files: opened with an explanation, and small ones read at once."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import BinaryIO

import numpy as np

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.files import File
from contactbench.pipeline.tables.layouts import LabTable
from contactbench.pipeline.tables.reader import BLOCK_BYTES, TableError, TableReader, TableRows, Wording

ROW_LIMIT = 100_000


@contextmanager
def open_table(
    source: File | BinaryIO, error: type[InputError] = TableError, *, lab: bool = False
) -> Iterator[tuple[BinaryIO | LabTable, str, int]]:
    """
    Open a table for reading, unless it is open, and say why where that fails.

    Parameters
    ----------
    source : path or binary file
    error : type of InputError
        What is raised.
    lab : bool
        It may be written as a laboratory writes tables, see `contactbench.pipeline.tables.layouts`.

    Yields
    ------
    stream : binary file
    name : str
        What messages should call it.
    size : int
        In bytes; 0 if that is unknown.
    """
    if not isinstance(source, File):
        yield LabTable(source) if lab else source, message("standard input"), 0
        return
    try:
        stream = source.open("rb")
    except FileNotFoundError:
        raise error(message(f"{arg(source)}: there is no such file: check the path.")) from None
    except IsADirectoryError:
        raise error(message(f"{arg(source)}: this is a folder: choose a CSV file inside it.")) from None
    except (OSError, ValueError) as fault:
        raise error(
            message(f"{arg(source)}: the file cannot be opened ({arg(fault)}): check its permissions.")
        ) from fault
    with stream:
        yield LabTable(stream) if lab else stream, str(source), os.fstat(stream.fileno()).st_size


def read_table(
    source: File | BinaryIO,
    select: Callable[[TableReader], None],
    wording: Wording,
    *,
    row_limit: int = ROW_LIMIT,
    block_bytes: int = BLOCK_BYTES,
    lab: bool = False,
) -> TableRows:
    """
    Read a small table as a whole.

    Parameters
    ----------
    source : path or binary file
        A CSV file.
    select : callable
        Gets the reader, whose `names` are known, and calls its `select`.
    wording : Wording
        What messages say about its content.
    row_limit : int
        More rows are refused: the wrong file should not fill the memory.
    block_bytes : int
        How much is read at a time.
    lab : bool
        As for `open_table`.

    Raises
    ------
    wording.error
        The file cannot be used, or is too long.
    """
    blocks: list[TableRows] = []
    room = row_limit
    with open_table(source, wording.error, lab=lab) as (stream, name, _):
        reader = TableReader(stream, name, wording, block_bytes=block_bytes)
        select(reader)
        for rows in reader:
            if len(rows.lines) > room:
                what = message(
                    f"more than {arg(row_limit):,} rows of {arg(wording.rows)}: choose the right file or shorten it."
                )
                raise reader.error(what, int(rows.lines[room]))
            room -= len(rows.lines)
            blocks.append(rows)
    texts = [rows.text for rows in blocks if rows.text is not None]
    return TableRows(
        reader.columns,
        np.concatenate([rows.numbers for rows in blocks]),
        np.concatenate(texts) if texts else None,
        np.concatenate([rows.lines for rows in blocks]),
    )

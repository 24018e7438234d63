"""
The table of sessions, as Apache Parquet.

Parquet and not a database: the table is made anew from the sessions at each run and is never edited, it is one file
that pandas, DuckDB and MATLAB read, and pyarrow is what studies keep their results with already.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date, datetime
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.fleet.row import FleetRow, column_types, hash_of, summarize, unchanged
from contactbench.pipeline.fleet.source import NoSessionError, opened

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

_META, _VERSION = b"contactbench.fleet", b"2"


@dataclass(frozen=True)
class Skipped:
    """A folder or archive that is not in the table, and why."""

    place: str
    reason: str
    damaged: bool = False  # Not merely a copy, or no session


@dataclass(frozen=True)
class Fleet:
    """
    What was read.

    Attributes
    ----------
    table : pyarrow.Table
        A row a session; columns as `FleetRow`.
    skipped : tuple of Skipped
    read : int
        Sessions that were read now; the others were known.
    """

    table: Any
    skipped: tuple[Skipped, ...]
    read: int


def schema() -> Any:
    """Return the table's Arrow schema."""
    import pyarrow as pa

    kinds = {
        str: pa.string(),
        int: pa.int64(),
        float: pa.float64(),
        bool: pa.bool_(),
        date: pa.date32(),
        datetime: pa.timestamp("us", "UTC"),
    }
    columns = [(name, kinds[kind]) for name, kind in column_types().items()]
    return pa.schema(columns, metadata={_META: _VERSION})


def table_of(rows: Sequence[FleetRow]) -> Any:
    """Return rows as an Arrow table."""
    import pyarrow as pa

    form = schema()
    columns = [pa.array([_plain(getattr(row, each.name)) for row in rows], each.type) for each in form]
    return pa.Table.from_arrays(columns, schema=form)


def _plain(value: Any) -> Any:
    """Return a text that UTF-8 can hold, as names of files may not be; anything else as it is."""
    return value.encode("utf-8", "backslashreplace").decode() if isinstance(value, str) else value


def read_fleet(
    places: Sequence[Path], known: Any = None, progress: Callable[[int, int], None] = lambda *_: None
) -> Fleet:
    """
    Read sessions; what is damaged or no session is told and left out.

    Parameters
    ----------
    places : sequence of Path
        Folders and archives, as `find` yields them.
    known : pyarrow.Table, optional
        An earlier table: a session whose journal is in it, and whose files have the size and time of then,
        is not read again.
    progress : callable
        Gets how many are through, and of how many.
    """
    import pyarrow as pa

    index = {} if known is None else {sha: row for row, sha in enumerate(known["journal"].to_pylist())}
    files = [] if known is None else known["files"].to_pylist()
    rows: list[FleetRow] = []
    kept: list[tuple[int, str]] = []
    skipped = []
    for number, place in enumerate(places):
        progress(number, len(places))
        try:
            with opened(place) as source:
                journal = source.journal()
                row = index.get(hash_of(journal))
                if row is None or not unchanged(source, files[row]):
                    rows.append(summarize(source, journal))
                else:
                    kept.append((row, _plain(str(place))))
        except InputError as error:
            damaged = not isinstance(error, NoSessionError)
            skipped.append(Skipped(_plain(str(place)), _plain(str(error)), damaged))
    table = table_of(rows)
    if known is not None and kept:
        rows_kept, where = zip(*kept, strict=True)
        moved = pa.array(where, pa.string())
        old = known.take(rows_kept).set_column(known.schema.get_field_index("place"), "place", moved)
        table = pa.concat_tables([old.cast(schema()), table])
    table, copies = _without_copies(table)
    return Fleet(table, (*skipped, *copies), len(rows))


def _without_copies(table: Any) -> tuple[Any, list[Skipped]]:
    """Leave one of several states of the same session: that with the most records."""
    if not table.num_rows:
        return table, []
    order = [("session", "ascending"), ("records", "descending"), ("place", "ascending")]
    table = table.sort_by(order)
    stay, copies, last, place = [], [], None, ""
    sessions = zip(table["session"].to_pylist(), table["place"].to_pylist(), strict=True)
    for number, (session, where) in enumerate(sessions):
        if session == last:
            copies.append(Skipped(where, f"{where}: a copy of the session in {place}, which is no older."))
            continue
        last, place = session, where
        stay.append(number)
    order = [(name, "ascending") for name in ("sensor", "tool", "calibrated", "place")]
    return table.take(stay).sort_by(order), copies


def load_table(file: Path) -> Any:
    """
    Return an earlier table; None: there is none, or one of another version, which is made anew.

    Raises
    ------
    InputError
        The file is something else.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    if not file.exists():
        return None
    try:
        table = pq.read_table(file)
    except (OSError, pa.ArrowException) as error:
        raise InputError(
            f"{file}: this file exists and is no table of a fleet: choose another name."
        ) from error
    metadata = table.schema.metadata or {}
    if _META not in metadata:
        raise InputError(f"{file}: this file exists and is no table of a fleet: choose another name.")
    same = metadata[_META] == _VERSION and table.schema.equals(schema())
    return table if same else None


def save_table(table: Any, file: Path) -> None:
    """Write a table, whole or not at all; InputError."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    sink = pa.BufferOutputStream()
    pq.write_table(table, sink, compression="zstd")
    try:
        write_durably(file, sink.getvalue().to_pybytes())
    except (OSError, ValueError) as error:
        raise InputError(f"{file}: the table cannot be written ({error}): choose another folder.") from error

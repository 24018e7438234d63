"""Where a sweep's results are kept: each cell as it is done, and all of them as one Parquet file."""

from __future__ import annotations

import json
import os
import platform
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from pipeline.durable import make_folder, write_durably
from pipeline.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path
    from types import TracebackType
    from typing import Self

    import pyarrow as pa

    from pipeline.study.sweep.plan import Plan

DONE, RESULTS = "done.jsonl", "results.parquet"
_META = b"contactbench"
_VERSION = 1


class Store:
    """
    The cells of a sweep that are done, in a folder; use it in a ``with`` statement.

    A line for each cell is appended when it is done; a last line that a crash cut off is dropped. Cells of other plans
    may lie beside: a cell is known by what it is.

    Parameters
    ----------
    folder : Path
        Made if it is not there.

    Raises
    ------
    InputError
        It cannot be read or written, or holds something else.
    """

    def __init__(self, folder: Path) -> None:
        make_folder(folder)
        self.folder = folder
        self._file = folder / DONE
        self.rows: dict[str, dict[str, Any]] = {}
        whole = self._read()
        try:
            self._stream = self._file.open("r+b" if self._file.exists() else "w+b")
            self._stream.seek(whole)
            self._stream.truncate()
        except OSError as error:
            raise InputError(
                f"{self._file}: results cannot be kept ({error}): choose another folder."
            ) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stream.close()

    def keep(self, row: dict[str, Any]) -> None:
        """Keep a cell's figures; they are on the disk when this returns."""
        self.rows[row["key"]] = row
        self._stream.write(json.dumps(row, sort_keys=True).encode() + b"\n")
        self._stream.flush()
        os.fsync(self._stream.fileno())

    def _read(self) -> int:
        """Read what is done; return the length of what is whole."""
        if not self._file.exists():
            return 0
        try:
            content = self._file.read_bytes()
        except OSError as error:
            raise InputError(f"{self._file}: cannot be read ({error}): check the rights.") from error
        whole = content.rfind(b"\n") + 1
        for number, line in enumerate(content[:whole].splitlines(), 1):
            try:
                row = json.loads(line)
                self.rows[str(row["key"])] = row
            except (ValueError, KeyError, TypeError) as error:
                raise InputError(
                    f"{self._file}, line {number}: no result of a study ({error}): choose an empty folder."
                ) from error
        return whole


def environment(workers: int, scheduler: str) -> dict[str, Any]:
    """Return what results were computed with: versions, processor, number of workers, when."""
    from importlib.metadata import version

    from pipeline import __version__, kernel

    return {
        "contactbench": __version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "processor": _processor(),
        "cores": os.cpu_count(),
        "kernel": kernel.variant,
        "compiler": kernel.compiler,
        "workers": workers,
        "scheduler": scheduler,
        "finished": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        **{name: version(name) for name in ("numpy", "scipy", "dask", "pyarrow")},
    }


def _processor() -> str:
    try:
        with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as lines:  # noqa: PTH123 - a device
            for line in lines:
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
    except OSError:
        pass  # not Linux
    return platform.processor() or platform.machine()


def write_results(file: Path, plan: Plan, rows: list[dict[str, Any]], facts: dict[str, Any]) -> None:
    """Write a plan's rows, in its order, with the plan and the environment, as Parquet."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    names = list(dict.fromkeys(name for row in rows for name in row))
    table = pa.table({name: pa.array([row.get(name) for row in rows]) for name in names})
    about = {"version": _VERSION, "plan": plan.model_dump(mode="json"), "environment": facts}
    table = table.replace_schema_metadata({_META: json.dumps(about, sort_keys=True).encode()})
    sink = pa.BufferOutputStream()
    pq.write_table(table, sink, compression="zstd")
    write_durably(file, sink.getvalue().to_pybytes())


def read_results(file: Path) -> tuple[pa.Table, Plan, dict[str, Any]]:
    """
    Read results.

    Returns
    -------
    table : pyarrow.Table
        A row for each cell.
    plan : Plan
    environment : dict

    Raises
    ------
    InputError
        It is no such file.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    from pipeline.study.sweep.plan import Plan

    try:
        table = pq.read_table(file)
        about = json.loads((table.schema.metadata or {})[_META])
        version, plan, facts = about["version"], about["plan"], about["environment"]
    except (OSError, pa.ArrowException, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{file}: no results of a study ({error}): give a {RESULTS}.") from error
    if version != _VERSION:
        raise InputError(f"{file}: results of version {version}: use the contactbench that wrote them.")
    return table, Plan.of(plan, str(file)), dict(facts)

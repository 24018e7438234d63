"""
The results of a study: a folder with one Parquet file, which knows what it was computed with.

Everything that is shown of a study is made from this file alone, by `contactbench.pipeline.study.pages`.
"""

from __future__ import annotations

import json
import os
import platform
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.installation import processor

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

Row = dict[str, Any]  # plain values

RESULTS = "results.parquet"
_META, _VERSION = b"contactbench", 1
PASSING = ("finished", "load")  # of an environment: what differs from hour to hour
_LIBRARIES = ("numpy", "scipy", "dask", "pyarrow")


@dataclass(frozen=True)
class Results:
    """What a study measured."""

    kind: str  # which study: one that `contactbench.pipeline.study.pages` knows
    command: str  # what repeats it, as it is typed
    rows: tuple[Row, ...]  # plain values; a row has None where others have a figure
    environment: Mapping[str, Any]  # see `environment`
    about: Mapping[str, Any] = field(default_factory=dict)  # whatever else belongs to it, plain values


def cores() -> int:
    """Return how many this machine has."""
    return os.cpu_count() or 1


def environment(**more: Any) -> dict[str, Any]:
    """Return what results are computed with: versions, processor, cores and their load, when, and what is given."""
    from importlib.metadata import PackageNotFoundError, version

    from contactbench import __version__
    from contactbench.pipeline import kernel

    facts: dict[str, Any] = {
        "contactbench": __version__,
        "python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}, {' '.join(platform.libc_ver())}",
        "processor": processor(),
        "cores": cores(),
        "load": round(os.getloadavg()[2], 1) if hasattr(os, "getloadavg") else None,
        "kernel": kernel.variant,
        "compiler": kernel.compiler,
        "finished": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
    }
    for name in _LIBRARIES:
        try:
            facts[name] = version(name)
        except PackageNotFoundError:
            facts[name] = "none"
    return facts | more


def write_results(
    folder: Path,
    kind: str,
    command: str,
    rows: Sequence[Mapping[str, Any]],
    facts: Mapping[str, Any],
    about: Mapping[str, Any] | None = None,
) -> Path:
    """
    Write the results of a study to its folder, as Parquet.

    Parameters
    ----------
    folder : Path
        It is there.
    kind, command, rows, facts, about
        See `Results`; `facts` is its environment.

    Returns
    -------
    Path
        Of the file.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    names = list(dict.fromkeys(name for row in rows for name in row))
    table = pa.table({name: pa.array([row.get(name) for row in rows]) for name in names})
    meta = {"version": _VERSION, "kind": kind, "command": command, "environment": facts, "about": about or {}}
    table = table.replace_schema_metadata({_META: json.dumps(meta, sort_keys=True).encode()})
    sink = pa.BufferOutputStream()
    pq.write_table(table, sink, compression="zstd")
    file = folder / RESULTS
    write_file(file, sink.getvalue().to_pybytes())
    return file


def read_results(place: Path) -> Results:
    """
    Read the results of a study.

    Parameters
    ----------
    place : Path
        Its folder, or the file in it.

    Raises
    ------
    InputError
        They are not there, or are no results of this version.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    file = place / RESULTS if place.is_dir() else place
    try:
        table = pq.read_table(file)
        meta = json.loads((table.schema.metadata or {})[_META])
        version = meta["version"]
        found = Results(
            str(meta["kind"]),
            str(meta["command"]),
            tuple(table.to_pylist()),
            dict(meta["environment"]),
            dict(meta["about"]),
        )
    except (OSError, pa.ArrowException, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{file}: no results of a study ({error}): give the folder of a finished one."
        ) from error
    if version != _VERSION:
        raise InputError(f"{file}: results of version {version}: use the contactbench that wrote them.")
    return found

"""Where the cells of a sweep are kept, each as it is done."""

from __future__ import annotations

import json
import os
from collections import Counter
from contextlib import suppress
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from contactbench.pipeline.durable import make_folder
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.results import PASSING

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path
    from types import TracebackType
    from typing import Self

_STEM, _SUFFIX = "done", ".jsonl"
DONE = _STEM + _SUFFIX  # of the first that writes; the others' names are longer


class Store:
    """
    The cells of a sweep that are done, in a folder; use it in a ``with`` statement.

    A file begins with the plan and the environment of who writes it. A line for each cell is appended when it is
    done; a last line that a crash cut off is not read. Cells of other plans may lie beside: a cell is known by what
    it is. Several processes, on several machines, may write into one folder: each has a file of its own there,
    because file systems of networks do not append for two.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    about : mapping
        What is said of the cells that are kept here: their ``plan`` and ``environment``, plain values.

    Raises
    ------
    InputError
        It cannot be read or written, or holds something else.
    """

    def __init__(self, folder: Path, about: Mapping[str, Mapping[str, Any]]) -> None:
        make_folder(folder)
        self.folder = folder
        self.rows: dict[str, dict[str, Any]] = {}
        self.about: dict[str, Mapping[str, Mapping[str, Any]]] = {}  # of each file, by its name
        self._mine = about
        self._source: dict[str, str] = {}  # key of a cell -> name of its file
        self._read: dict[Path, int] = {}  # bytes of each file that are known
        self.look()
        self._file = folder / DONE
        try:
            try:
                self._stream = self._file.open("xb")
            except FileExistsError:
                self._file = folder / f"{_STEM}-{uuid4().hex[:12]}{_SUFFIX}"
                self._stream = self._file.open("xb")
        except OSError as error:
            raise self._unkept(error) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        empty = not self._stream.tell()
        # What is kept is on the disk; what a full one did not take is tried once more.
        with suppress(OSError):
            self._stream.close()
        if empty:
            with suppress(OSError):
                self._file.unlink()

    def keep(self, row: dict[str, Any]) -> None:
        """Keep a cell's figures; they are on the disk when this returns. InputError: it is full, or the like."""
        self._take(row, self._file.name)
        first = not self._stream.tell()
        try:
            for line in ({"about": self._mine}, row) if first else (row,):
                self._stream.write(json.dumps(line, sort_keys=True).encode() + b"\n")
            self._stream.flush()
            os.fsync(self._stream.fileno())
        except OSError as error:
            raise self._unkept(error) from error

    def look(self) -> None:
        """Read what others have done meanwhile."""
        for file in sorted(self.folder.glob(f"{_STEM}*{_SUFFIX}")):
            known = self._read.get(file, 0)
            try:
                with file.open("rb") as stream:
                    stream.seek(known)
                    content = stream.read()
            except OSError as error:
                raise InputError(f"{file}: cannot be read ({error}): check the rights.") from error
            whole = content.rfind(b"\n") + 1  # what follows is torn, or is being written
            for number, line in enumerate(content[:whole].splitlines(), 1):
                try:
                    row = json.loads(line)
                    if "about" in row:
                        self.about[file.name] = {
                            name: dict(row["about"][name]) for name in ("plan", "environment")
                        }
                    else:
                        self._take(row | {"key": str(row["key"]), "failed": str(row["failed"])}, file.name)
                except (ValueError, KeyError, TypeError, RecursionError) as error:
                    raise InputError(
                        f"{file}, line {number}: no result of a study ({error}): choose an empty folder."
                    ) from error
            self._read[file] = known + whole

    def machines(self, keys: Iterable[str]) -> list[dict[str, Any]]:
        """Return the environments in which cells were computed, each once, with the number of ``cells``."""
        found: dict[str, dict[str, Any]] = {}
        for name, count in Counter(self._source[key] for key in keys).items():
            facts = self.about[name]["environment"] if name in self.about else {}
            lasting = {what: value for what, value in facts.items() if what not in PASSING}
            known = found.setdefault(json.dumps(lasting, sort_keys=True), {"cells": 0, **facts})
            known["cells"] += count
            known["load"] = max(known.get("load") or 0, facts.get("load") or 0)
        return list(found.values())

    def _unkept(self, error: OSError) -> InputError:
        return InputError(
            f"{self._file}: results cannot be kept ({error}): free disk space, or choose another folder."
        )

    def _take(self, row: dict[str, Any], name: str) -> None:
        before = self.rows.get(row["key"])
        if before is None or before["failed"] or not row["failed"]:  # one machine may lack what another has
            self.rows[row["key"]] = row
            self._source[row["key"]] = name

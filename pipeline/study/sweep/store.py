"""Where the cells of a sweep are kept, each as it is done."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.durable import make_folder
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path
    from types import TracebackType
    from typing import Self

DONE = "done.jsonl"


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

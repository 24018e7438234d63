"""A file to read: a path, or the place of a file that people know by another name."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from io import BufferedReader
from pathlib import Path, PurePath
from typing import Any, Literal, TypeVar

from contactbench.pipeline.errors import InputError, arg, message


@dataclass(frozen=True)
class NamedFile:
    """
    A file that is read where it lies, under the name that its user gave it.

    Readers take it as they take a path: its name decides the format and stands in messages and in what is computed,
    its place is what is opened.
    """

    path: Path
    name: str
    # Name -> path of the files that belong to it
    beside: Mapping[str, Path] = field(default_factory=dict, compare=False)

    def __str__(self) -> str:
        """Return the name: messages are for its user."""
        return self.name

    def __fspath__(self) -> str:
        """Return where it lies."""
        return str(self.path)

    @property
    def suffix(self) -> str:
        """Ending of its name."""
        return PurePath(self.name).suffix

    @property
    def stem(self) -> str:
        """Its name without the ending."""
        return PurePath(self.name).stem

    def open(self, mode: Literal["rb"]) -> BufferedReader:
        """Open it for reading."""
        return self.path.open(mode)

    def read_bytes(self) -> bytes:
        """Return its content."""
        return self.path.read_bytes()

    def stat(self) -> os.stat_result:
        """Return what the file system knows about it."""
        return self.path.stat()

    def exists(self) -> bool:
        """Tell whether it is there."""
        return self.path.exists()

    def is_file(self) -> bool:
        """Tell whether it is there, and a regular file."""
        return self.path.is_file()

    def with_suffix(self, suffix: str) -> NamedFile:
        """Return the file beside it whose name has another ending; one that does not exist if there is none."""
        name = PurePath(self.name).with_suffix(suffix).name
        return NamedFile(self.beside.get(name, self.path / name), name, self.beside)


File = Path | NamedFile
AnyFile = TypeVar("AnyFile", Path, NamedFile, File)
Progress = Callable[[int, int], None]  # gets what is done, and how much there is (0 if that is unknown)


def unheard(_done: int, _whole: int) -> None:
    """Take the progress of what nobody waits for."""


def as_file(path: str | os.PathLike[str]) -> File:
    """Return a file as it was named, or a path."""
    return path if isinstance(path, NamedFile) else Path(path)


def read_bytes(file: File, most: int, error: type[InputError] = InputError) -> bytes:
    """Return what a file holds, no more than one byte over `most`; `error` where it cannot be read."""
    try:
        with file.open("rb") as stream:
            return stream.read(most + 1)
    except FileNotFoundError:
        raise error(f"{arg(file)}: there is no such file: check the path.") from None
    except (OSError, ValueError) as fault:  # ValueError: a path that no file system can hold
        raise error(
            message(f"{arg(file)}: the file cannot be read ({arg(fault)}): check the path.")
        ) from fault


def files_beside(file: File, ending: str) -> Sequence[File]:
    """Return the files that belong to a named one, or all in the folder of a path, that end so; by name."""
    if isinstance(file, Path):
        return sorted(file.parent.glob(f"*{ending}"))
    found = sorted(each for each in file.beside.items() if each[0].endswith(ending))
    return [NamedFile(path, name, file.beside) for name, path in found]


def not_of_kind(content: Any, schema: str, version: int, what: str) -> str:
    """Say why parsed JSON is not of a schema, or of a newer version of it than is known; empty: it is."""
    found = content.get("schema") if isinstance(content, dict) else None
    if found != schema:
        said = message(f"the schema is {arg(ascii(found[:60]))}") if isinstance(found, str) else ""
        missing = message("the schema is missing")
        return message(f"{arg(said or missing)}; expected {arg(schema)!r}: choose {arg(what)}.")
    written = content.get("version")
    if isinstance(written, int) and not isinstance(written, bool) and written > version:
        return message(
            f"written by a newer contactbench (version above {arg(version)}): update contactbench."
        )
    return ""

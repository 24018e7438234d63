"""Files that are written as a whole or not at all, and are there after a power cut."""

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from contactbench.pipeline.errors import InputError, arg, message


def write_durably(file: Path, data: bytes) -> None:
    """Put `data` in `file` in one step: whoever reads it sees the old content or the new.

    Raises
    ------
    OSError, ValueError
        It cannot be written (ValueError: a path that no file system can hold). What was there stays.
    """
    with whole_file(file) as stream:
        stream.write(data)


@contextmanager
def whole_file(file: Path) -> Iterator[BinaryIO]:
    """Open a file that appears as a whole at the end, or not at all. Raises as `write_durably`."""
    scratch = scratch_beside(file)
    try:
        with scratch.open("xb") as stream:
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        scratch.replace(file)
    except BaseException:
        scratch.unlink(missing_ok=True)
        raise
    sync_folder(file.parent)


def write_file(
    file: Path,
    data: bytes,
    error: type[InputError] = InputError,
    what: str = message("the file cannot be written"),
) -> None:
    """Put `data` in `file` in one step, see `write_durably`; raises as `whole_or_raise`."""
    with whole_or_raise(file, error, what) as stream:
        stream.write(data)


@contextmanager
def whole_or_raise(file: Path, error: type[InputError], what: str) -> Iterator[BinaryIO]:
    """Open a file as `whole_file`; where it cannot be written, `error` says `what`: the poses cannot be written."""
    try:
        with whole_file(file) as stream:
            yield stream
    except (OSError, ValueError) as fault:
        if isinstance(fault, error):
            raise
        raise error(
            message(
                f"{arg(file)}: {arg(what)} ({arg(fault)}): choose a folder that exists, is writable and has space."
            )
        ) from fault


def scratch_beside(file: Path) -> Path:
    """Return a name for a temporary file: in the same folder, because a rename is atomic only there."""
    return file.with_name(f".{file.name}.{secrets.token_hex(8)}.tmp")


def sync_folder(folder: Path) -> None:
    """Bring a folder's names to the disk: a rename is durable only then. Windows cannot open folders."""
    if os.name == "nt":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def make_folder(folder: Path) -> None:
    """Make a folder, and those above it.

    Raises
    ------
    InputError
        It is a file, or cannot be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError) as error:
        taken = next((path for path in (folder, *folder.parents) if path.is_file()), folder)
        raise InputError(
            f"{arg(folder)}: {arg(taken)} is a file: choose another name for the folder."
        ) from error
    except (OSError, ValueError) as error:  # ValueError: a path that no file system can hold
        raise InputError(
            f"{arg(folder)}: the folder cannot be made ({arg(error)}): choose one in a place that is writable."
        ) from error

"""Sessions in folders and in archives, read alike: the journal, and single small files. Nothing is unpacked."""

from __future__ import annotations

import hashlib
import zipfile
import zlib
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session.errors import ArchiveError, SessionError
from contactbench.pipeline.session.files import own_file
from contactbench.pipeline.session.journal import JOURNAL, LARGEST, read_journal

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from contactbench.pipeline.session.actions import FileRef

ENDINGS = (".zip", ".contactbench")
_LARGEST_FILE = 64 * 2**20


class SessionSource(Protocol):
    """Where a session lies."""

    place: Path

    def journal(self) -> bytes:
        """Return its journal; InputError."""

    def read(self, ref: FileRef) -> bytes:
        """Return a file as the journal says it is; InputError."""


class _Folder:
    def __init__(self, place: Path) -> None:
        self.place = place

    def journal(self) -> bytes:
        return read_journal(self.place)

    def read(self, ref: FileRef) -> bytes:
        with own_file(self.place / ref.path).open("rb") as stream:
            return _as_told(stream.read(_LARGEST_FILE + 1), ref, self.place)


class _Archive:
    def __init__(self, place: Path, packed: zipfile.ZipFile) -> None:
        self.place, self._packed = place, packed

    def journal(self) -> bytes:
        data = self._member(JOURNAL, LARGEST)
        if len(data) > LARGEST:
            raise ArchiveError(f"{self.place}: its journal is larger than {LARGEST >> 20} MiB.")
        return data

    def read(self, ref: FileRef) -> bytes:
        return _as_told(self._member(ref.path, _LARGEST_FILE), ref, self.place)

    def _member(self, name: str, most: int) -> bytes:
        try:
            with self._packed.open(name) as stream:
                return stream.read(most + 1)
        except KeyError:
            raise ArchiveError(f"{self.place}: it contains no {name}: this is not a session.") from None


def _as_told(data: bytes, ref: FileRef, place: Path) -> bytes:
    if len(data) != ref.size or hashlib.sha256(data).hexdigest() != ref.sha256:
        raise SessionError(
            f"{place}: the content of {ref.path} does not match the journal: run `contactbench session verify`."
        )
    return data


@contextmanager
def opened(place: Path) -> Iterator[SessionSource]:
    """
    Open a session's folder or archive for reading.

    Raises
    ------
    InputError
        It is none, or is damaged; also while it is read.
    """
    try:
        if place.is_dir():
            yield _Folder(place)
            return
        with zipfile.ZipFile(place) as packed:
            yield _Archive(place, packed)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError) as error:
        # RuntimeError: it is encrypted
        raise ArchiveError(f"{place}: not an intact archive ({error}): copy it again.") from error
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise SessionError(
            f"{place}: the session cannot be read ({error}): check the permissions."
        ) from error


def find(places: Iterable[Path]) -> Iterator[Path]:
    """
    Yield sessions, and what looks as if it should be one, in a fixed order; links are not followed below `places`.

    A place that is given, and a folder just below it, in which there is no session is yielded too: reading it says so.

    Raises
    ------
    InputError
        A place that is given is not there.
    """
    for place in places:
        if not place.exists():
            raise InputError(f"{place}: there is no such folder or archive: check the path.")
        if not place.is_dir() or _has_journal(place):
            yield place
            continue
        inside = [session for child in _children(place) for session in _below(child) or [child]]
        yield from inside or [place]


def _below(place: Path) -> list[Path]:
    """Return what is a session, or should be, at a place and below it."""
    if not place.is_dir() or _has_journal(place):
        return [place]
    return [session for child in _children(place) for session in _below(child)]


def _children(folder: Path) -> list[Path]:
    """Return the folders and archives in a folder, sorted; empty: it cannot be listed."""
    try:
        return [
            each
            for each in sorted(folder.iterdir())
            if not each.name.startswith(".")
            and not each.is_symlink()
            and (each.is_dir() or _is_archive(each))
        ]
    except OSError:
        return []


def _has_journal(folder: Path) -> bool:
    try:
        return (folder / JOURNAL).is_file()
    except OSError:  # nobody may look into it
        return False


def _is_archive(file: Path) -> bool:
    return file.suffix.lower() in ENDINGS and file.is_file()

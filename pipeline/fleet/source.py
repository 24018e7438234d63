"""Sessions in folders and in archives, read alike: the journal, and single small files. Nothing is unpacked."""

import hashlib
import lzma
import os
import zipfile
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session.actions import FileRef
from contactbench.pipeline.session.files import FOLDERS, own_file
from contactbench.pipeline.session.journal import JOURNAL, LARGEST, ArchiveError, SessionError, read_journal

ENDINGS = (".zip", ".contactbench")
_LARGEST_FILE = 64 * 2**20


class NoSessionError(SessionError):
    """A folder or archive that is no session, and no damaged one."""


class _Folder:
    def __init__(self, place: Path) -> None:
        self.place = place

    def journal(self) -> bytes:
        """Return its journal; InputError."""
        if not (os.path.lexists(self.place / JOURNAL) or _is_session(self.place)):
            raise NoSessionError(f"{self.place}: this folder is not a session: check the path.")
        return read_journal(self.place)

    def read(self, ref: FileRef) -> bytes:
        """Return a file as the journal says it is; InputError."""
        with own_file(self.place / ref.path).open("rb") as stream:
            return _as_told(stream.read(_LARGEST_FILE + 1), ref, self.place)

    def stamp(self, path: str) -> str:
        """Return size and time of what holds a file, which tell that it was changed; OSError, InputError."""
        return _stamp(own_file(self.place / path))


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

    def stamp(self, path: str) -> str:  # noqa: ARG002 - an archive is one file
        return _stamp(self.place)

    def _member(self, name: str, most: int) -> bytes:
        try:
            with self._packed.open(name) as stream:
                return stream.read(most + 1)
        except KeyError:
            begins = {each.partition("/")[0] for each in self._packed.namelist()}
            if begins & set(FOLDERS):
                raise ArchiveError(f"{self.place}: it contains no {name}: copy it again.") from None
            raise NoSessionError(f"{self.place}: it contains no {name}: this is not a session.") from None


# Where a session lies.
SessionSource = _Folder | _Archive


def _stamp(file: Path) -> str:
    found = file.stat()
    return f"{found.st_size} {found.st_mtime_ns}"


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
    except (
        zipfile.BadZipFile,
        zlib.error,
        lzma.LZMAError,
        EOFError,
        NotImplementedError,
        RuntimeError,
    ) as error:
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

    Each is yielded once, however often it is given.

    A place that is given, and a folder just below it, in which there is no session is yielded too: reading it says so.

    Raises
    ------
    InputError
        A place that is given is not there.
    """
    seen: set[str] = set()
    for place in _found(places):
        real = os.path.realpath(place)
        if real not in seen:
            seen.add(real)
            yield place


def _found(places: Iterable[Path]) -> Iterator[Path]:
    for place in places:
        if not place.exists():
            raise InputError(f"{place}: there is no such folder or archive: check the path.")
        if not place.is_dir() or _is_session(place):
            yield place
            continue
        inside = [session for child in _children(place) for session in _below(child) or [child]]
        yield from inside or [place]


def session_around(file: Path) -> Path | None:
    """Return the session's folder that a file lies in, or would; None: in none."""
    return next((folder for folder in Path(os.path.realpath(file)).parents if _is_session(folder)), None)


def _below(place: Path) -> list[Path]:
    """Return what is a session, or should be, at a place and below it."""
    if not place.is_dir() or _is_session(place):
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


def _is_session(folder: Path) -> bool:
    """Tell whether a folder is a session, or was one: its journal is gone, and its own folders are there."""
    return _has_journal(folder) or all((folder / name).is_dir() for name in FOLDERS)


def _is_archive(file: Path) -> bool:
    return file.suffix.lower() in ENDINGS and file.is_file()

"""The session's files: on the disk, whole and under their hash, before any record speaks of them."""

import hashlib
import os
import re
import stat
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path

from contactbench.pipeline.durable import scratch_beside, sync_folder
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.files import AnyFile, File
from contactbench.pipeline.session.actions import FileRef
from contactbench.pipeline.session.journal import SessionError, write_all

FOLDERS = ("raw", "meshes", "results")
# A recording in the session's folder until it is closed and journaled; never deleted as long as it holds samples.
UNFINISHED = "unfinished-"
_CHUNK = 2**20
_ROOM = 256 * 2**10  # bytes: some hundred records
_LONGEST_NAME = 80  # of a name in the folder
_SCRATCH = re.compile(r"\..+\.[0-9a-f]{16}\.tmp")
_BINARY = getattr(os, "O_BINARY", 0)


def chunks_of(file: File) -> Iterator[bytes]:
    """Read a file piece by piece."""
    with file.open("rb") as stream:
        while chunk := stream.read(_CHUNK):
            yield chunk


def digest_of(file: File) -> tuple[str, int]:
    """Return the SHA-256 of a file, 64 hexadecimal digits, and its size. OSError if it cannot be read."""
    digest, size = hashlib.sha256(), 0
    for chunk in chunks_of(file):
        digest.update(chunk)
        size += len(chunk)
    return digest.hexdigest(), size


def store(session: Path, folder: str, name: str, chunks: Iterable[bytes]) -> FileRef:
    """
    Put content into a session's folder, durably, under its hash and its name.

    The same content and name give the same place: what a crash left behind before its record was written is
    taken up when the action is repeated.

    Raises
    ------
    OSError
        It cannot be read or written; nothing is there under its name then.
    """
    target = session / folder
    scratch = scratch_beside(target / "stored")
    try:
        digest, size = _write(scratch, chunks)
        place = f"{folder}/{digest[:12]}-{_plain(name)}"
        os.replace(scratch, session / place)  # noqa: PTH105 the tests make this very call fail
    except BaseException:
        scratch.unlink(missing_ok=True)
        raise
    sync_folder(target)
    return FileRef(path=place, sha256=digest, size=size)


def take_in(session: Path, folder: str, file: Path, name: str) -> FileRef:
    """
    Give a file that was written in the session its place there, durably; it stays where it is as well.

    Raises
    ------
    OSError
        It cannot be read, or its place not be made.
    """
    with file.open("rb+") as stream:
        os.fsync(stream.fileno())
    sha256, size = digest_of(file)
    place = f"{folder}/{sha256[:12]}-{_plain(name)}"
    try:
        os.link(file, session / place)
    except OSError:  # it is there already, or the file system knows no links
        return store(session, folder, name, chunks_of(file))
    sync_folder(session / folder)
    return FileRef(path=place, sha256=sha256, size=size)


def try_room(session: Path) -> None:
    """Write as much as a session's actions need, and remove it again. OSError: the disk does not take it."""
    scratch = scratch_beside(session / "room")
    try:
        _write(scratch, (bytes(_ROOM),))
    finally:
        scratch.unlink(missing_ok=True)


def write_file(file: Path, chunks: Iterable[bytes]) -> int:
    """Write a new file and bring it to the disk, not its name; return its size. OSError if that fails."""
    return _write(file, chunks)[1]


def _write(scratch: Path, chunks: Iterable[bytes]) -> tuple[str, int]:
    digest, size = hashlib.sha256(), 0
    descriptor = os.open(scratch, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _BINARY, 0o644)
    try:
        for chunk in chunks:
            write_all(descriptor, chunk)
            digest.update(chunk)
            size += len(chunk)
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
    return digest.hexdigest(), size


def _plain(name: str) -> str:
    """Return a name that every file system and zip program takes; its ending stays."""
    # In small letters: the same content as A.csv and a.csv is one place on every file system.
    plain = re.sub(r"[^a-z0-9._-]", "_", name.lower()).lstrip(".") or "_"
    return plain[-_LONGEST_NAME:].lstrip(".") or "_"


def regular(file: AnyFile) -> AnyFile:
    """Refuse what is not a file that can be copied: folders, devices, pipes that never end."""
    try:
        mode = file.stat().st_mode
    except (OSError, ValueError) as error:  # ValueError: a path that no file system can hold
        raise SessionError(f"{arg(file)}: the file cannot be read ({arg(error)}): check the path.") from error
    if not stat.S_ISREG(mode):
        raise SessionError(f"{arg(file)}: not a regular file: choose a file.")
    return file


def own_file(file: Path) -> Path:
    """Refuse what lies in the session under a file's name and is none, or a link that leads out of it."""
    if file.is_symlink():
        raise SessionError(f"{arg(file)}: a link; a session holds only files: put the file itself there.")
    return regular(file)


def refuse_links(session: Path) -> None:
    """
    Refuse a session whose folders are links, or no folders: what is kept there would be elsewhere.

    Raises
    ------
    SessionError
        One is. One that is missing is no harm.
    """
    for name in FOLDERS:
        try:
            mode = (session / name).lstat().st_mode
        except FileNotFoundError:
            continue
        except (OSError, ValueError) as error:
            raise SessionError(
                f"{arg(session / name)}: the folder cannot be read ({arg(error)}): check the permissions."
            ) from error
        if not stat.S_ISDIR(mode):
            raise SessionError(
                f"{arg(session / name)}: a link or a file, not a folder: put the folder itself there."
            )


def wrong_with(session: Path, ref: FileRef) -> str:
    """Say what is wrong with a file of the session; empty if it is what the journal says."""
    file = session / ref.path
    try:
        if file.is_symlink() or not stat.S_ISREG(file.stat().st_mode):
            return message(f"{arg(ref.path)} is not a regular file")
        sha256, size = digest_of(file)
    except FileNotFoundError:
        return message(f"{arg(ref.path)} is missing")
    except OSError as error:
        return message(f"{arg(ref.path)} cannot be read ({arg(error)})")
    if size != ref.size:
        return message(f"{arg(ref.path)} has {arg(size)} bytes, not {arg(ref.size)}")
    return (
        "" if sha256 == ref.sha256 else message(f"the content of {arg(ref.path)} does not match the journal")
    )


def file_problem(folder: Path, ref: FileRef) -> str:
    """Say what is wrong with a file, and the remedy; empty: nothing. Reads all of it."""
    wrong = wrong_with(folder, ref)
    return message(f"{arg(wrong)}: restore it from an archive, or add the original again.") if wrong else ""


def touched_mark(file: Path) -> tuple[int, int, int] | None:
    """Return what changes when a file is touched; None: it is not there."""
    try:
        found = file.lstat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def unfinished(session: Path) -> list[str]:
    """Return the recordings that are being made or ended abruptly, as places in the session, oldest name first."""
    return sorted(f"raw/{file.name}" for file in (session / "raw").glob(f"{UNFINISHED}*"))


def unclaimed(session: Path, known: Collection[str]) -> list[str]:
    """Return the places of files that are not among the `known` ones; unfinished recordings are in it."""
    places = [f"{name}/{file.name}" for name in FOLDERS for file in sorted((session / name).glob("*"))]
    return [place for place in places if place not in known]


def remove_scratch(session: Path) -> None:
    """Delete what a crash left half written; only for the holder of the lock."""
    for folder in (session, *(session / name for name in FOLDERS)):
        for file in folder.glob(".*.tmp"):
            if _SCRATCH.fullmatch(file.name):
                file.unlink(missing_ok=True)

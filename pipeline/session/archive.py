"""
A session as one zip file, and back.

What is unpacked comes from anywhere: only names that a session has are taken, into a new folder that gets its
name once every byte of it was checked against its journal.
"""

from __future__ import annotations

import re
import secrets
import shutil
import stat
import zipfile
import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pipeline.durable import scratch_beside, sync_folder
from pipeline.session.actions import files_of
from pipeline.session.check import check
from pipeline.session.errors import ArchiveError, SessionError
from pipeline.session.files import FOLDERS, chunks_of, write_file
from pipeline.session.frames import scan
from pipeline.session.journal import JOURNAL, read_journal
from pipeline.session.migrate import original_of
from pipeline.session.reading import read_content
from pipeline.session.state import fold

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_MEMBER = re.compile(
    r"journal(\.v[0-9]{1,4})?|(raw|meshes|results)/[0-9a-f]{12}-[A-Za-z0-9_-][A-Za-z0-9._-]{0,119}"
)
_EPOCH = (1980, 1, 1, 0, 0, 0)  # the same session gives the same archive
_CHUNK = 2**20
_METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
_ENCRYPTED = 0x1


@dataclass(frozen=True)
class ArchiveLimits:
    """
    What an archive may ask of the one who unpacks it.

    Attributes
    ----------
    members : int
    size : int
        Of all that is unpacked, bytes.
    ratio : int
        Of unpacked to packed size, for files above 1 MiB. Text of numbers reaches 10, text of zeros 1000.
    """

    members: int = 10_000
    size: int = 64 * 2**30
    ratio: int = 200


def export_archive(folder: Path, out: Path) -> int:
    """
    Pack a session into a zip file; return how many files went in. The session may be in use.

    Raises
    ------
    SessionError
        Something is wrong with the session, so that no one could import it; or `out` cannot be written.
    """
    if out.absolute().is_relative_to(folder.absolute()):
        raise SessionError(f"{out}: this is inside the session: put the archive elsewhere.")
    found = check(folder)
    if not found.sound:
        raise SessionError(f"{folder}: not packed, for something is wrong with it: {found.problems[0]}")
    content = read_content(folder)
    data = read_journal(folder)
    data = data[: scan(data).end]
    names = sorted({ref.path for record in content.records for ref in files_of(record.action)})
    kept = [original_of(folder, version).name for version in fold(content.records).origins]
    scratch = scratch_beside(out)
    try:
        with zipfile.ZipFile(scratch, "x") as packed:
            packed.writestr(_described(JOURNAL), data)
            for name in (*kept, *names):
                with packed.open(_described(name), "w", force_zip64=True) as stream:
                    for chunk in chunks_of(folder / name):
                        stream.write(chunk)
        _sync(scratch)
        scratch.replace(out)
        sync_folder(out.absolute().parent)
    except OSError as error:
        raise SessionError(
            f"{out}: the archive cannot be written ({error}): choose another place."
        ) from error
    finally:
        scratch.unlink(missing_ok=True)
    return 1 + len(kept) + len(names)


def _described(name: str) -> zipfile.ZipInfo:
    member = zipfile.ZipInfo(name, _EPOCH)
    member.compress_type = zipfile.ZIP_DEFLATED
    member.create_system = 3
    member.external_attr = (stat.S_IFREG | 0o644) << 16
    return member


def _sync(file: Path) -> None:
    import os

    with file.open("rb+") as stream:
        os.fsync(stream.fileno())


def import_archive(archive: Path, out: Path, limits: ArchiveLimits | None = None) -> None:
    """
    Unpack a session into a new folder; whatever is wrong with it, nothing is left of it.

    Raises
    ------
    ArchiveError
        It is no zip file, holds names that no session has (also paths that lead elsewhere, links, one name
        twice), is too large, or is not whole.
    SessionError
        `out` is there already, or cannot be written.
    """
    limits = ArchiveLimits() if limits is None else limits
    if out.exists() or out.is_symlink():
        raise SessionError(f"{out}: there is something already: choose another name.")
    scratch = out.with_name(f".{out.name}.{secrets.token_hex(8)}.tmp")
    try:
        with zipfile.ZipFile(archive) as packed:
            members = _members(packed, archive, limits)
            for folder in (scratch, *(scratch / name for name in FOLDERS)):
                folder.mkdir()
            _unpack(packed, members, scratch, limits)
        _refuse_strangers(scratch, archive, {member.filename for member in members})
        scratch.rename(out)
        sync_folder(out.absolute().parent)
    except (zipfile.BadZipFile, zipfile.LargeZipFile, zlib.error, EOFError, NotImplementedError) as error:
        raise ArchiveError(f"{archive}: no sound zip file ({error}): copy it again.") from error
    except (OSError, ValueError) as error:
        if isinstance(error, SessionError):
            raise
        raise SessionError(
            f"{out}: the archive cannot be unpacked ({error}): check paths and space."
        ) from error
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def _members(packed: zipfile.ZipFile, archive: Path, limits: ArchiveLimits) -> list[zipfile.ZipInfo]:
    """Return the files of an archive, after refusing all that must not be unpacked."""
    everything = packed.infolist()
    if len(everything) > limits.members:
        raise ArchiveError(
            f"{archive}: {len(everything)} files, more than {limits.members}: this is no session."
        )
    members = [each for each in everything if each.filename not in {f"{name}/" for name in FOLDERS}]
    seen: set[str] = set()
    for member in members:
        if wrong := _refused(member, limits):
            raise ArchiveError(
                f"{archive}: {member.filename!r:.200}: {wrong}: this is no session, or not a safe one."
            )
        if member.filename.casefold() in seen:
            raise ArchiveError(f"{archive}: {member.filename} is in it twice: this is no session.")
        seen.add(member.filename.casefold())
    if sum(member.file_size for member in members) > limits.size:
        raise ArchiveError(
            f"{archive}: unpacked it is larger than {limits.size >> 20} MiB: this is no session."
        )
    if sum(member.compress_size for member in members) > archive.stat().st_size:
        raise ArchiveError(f"{archive}: its files lie over one another: this is no session.")
    if JOURNAL not in seen:
        raise ArchiveError(f"{archive}: there is no journal in it: this is no session.")
    return members


def _refused(member: zipfile.ZipInfo, limits: ArchiveLimits) -> str:
    # orig_filename too: zipfile itself cuts names at a NUL and turns separators.
    if not (_MEMBER.fullmatch(member.filename) and member.orig_filename == member.filename):
        return "no name of a session's file"
    if stat.S_IFMT(member.external_attr >> 16) not in {0, stat.S_IFREG}:
        return "a link or a device, not a file"
    if member.flag_bits & _ENCRYPTED or member.compress_type not in _METHODS:
        return "encrypted or packed in an unusual way"
    if member.file_size > max(_CHUNK, limits.ratio * member.compress_size):
        return f"more than {limits.ratio} times its packed size"
    return ""


def _unpack(
    packed: zipfile.ZipFile, members: list[zipfile.ZipInfo], target: Path, limits: ArchiveLimits
) -> None:
    left = limits.size
    for member in members:
        left -= write_file(target / member.filename, _content(packed, member, left))
    for name in (*FOLDERS, "."):
        sync_folder(target / name)


def _content(packed: zipfile.ZipFile, member: zipfile.ZipInfo, left: int) -> Iterator[bytes]:
    """Read a file of an archive; sizes are counted, because those that are stated may lie."""
    left = min(left, member.file_size)
    with packed.open(member) as stream:
        while chunk := stream.read(_CHUNK):
            left -= len(chunk)
            if left < 0:
                raise ArchiveError(f"{member.filename}: larger than the archive says: this is no session.")
            yield chunk


def _refuse_strangers(folder: Path, archive: Path, names: set[str]) -> None:
    found = check(folder)
    if not found.sound:
        raise ArchiveError(
            f"{archive}: not a whole session: {found.problems[0].replace(str(folder), 'in it')}"
        )
    content = read_content(folder)
    known = {ref.path for record in content.records for ref in files_of(record.action)}
    known |= {JOURNAL, *(original_of(folder, version).name for version in fold(content.records).origins)}
    if strangers := sorted(names - known):
        raise ArchiveError(
            f"{archive}: {strangers[0]} belongs to no record of its journal: this is no session."
        )

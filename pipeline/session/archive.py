"""
A session as one zip file, and back.

What is unpacked comes from anywhere: only names that a session has are taken, into a new folder that gets its
name once every byte of it was checked against its journal.
"""

import re
import secrets
import shutil
import stat
import zipfile
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from contactbench.pipeline.durable import sync_folder, whole_file
from contactbench.pipeline.errors import REPAIR, arg, message
from contactbench.pipeline.session.actions import files_of
from contactbench.pipeline.session.check import check_journal
from contactbench.pipeline.session.files import FOLDERS, chunks_of, regular, unfinished, write_file
from contactbench.pipeline.session.journal import JOURNAL, ArchiveError, SessionError, read_journal
from contactbench.pipeline.session.lock import written_now
from contactbench.pipeline.session.state import original_of

_MEMBER = re.compile(
    r"journal(\.v[0-9]{1,4})?|(raw|meshes|results)/[0-9a-f]{12}-[A-Za-z0-9_-][A-Za-z0-9._-]{0,119}"
)
_EPOCH = (1980, 1, 1, 0, 0, 0)  # the same session gives the same archive
_CHUNK = 2**20
_METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
_ENCRYPTED = 0x1


@dataclass(frozen=True)
class ArchiveLimits:
    """What an archive may ask of the one who unpacks it."""

    members: int = 100_000
    size: int = 64 * 2**30  # Of all that is unpacked, bytes
    # Of unpacked to packed size, for files above 1 MiB. Text of numbers reaches 10, text of zeros 1000.
    ratio: int = 200


@dataclass(frozen=True)
class ArchiveSummary:
    """What was packed."""

    files: int
    notes: tuple[str, ...]  # What is worth knowing of the session, in sentences
    left_out: tuple[str, ...]  # Places of recordings that are being made: they are not in the archive


def export_archive(folder: Path, out: Path, limits: ArchiveLimits | None = None) -> ArchiveSummary:
    """
    Pack a session into a zip file that `import_archive` takes.

    The session may be in use; what is added meanwhile is not in it.

    Raises
    ------
    SessionError
        Something is wrong with the session, so that no one could import it; a recording in it ended abruptly, and is
        not adopted yet; or `out` cannot be written, or is there and no archive.
    """
    limits = ArchiveLimits() if limits is None else limits
    _refuse_place(folder, out)
    left_out = tuple(unfinished(folder))
    if left_out and not written_now(folder):
        raise SessionError(
            f"{arg(folder / left_out[0])}: this recording ended abruptly and would be left out: {arg(REPAIR)} to"
            " recover it, then pack again."
        )
    data = read_journal(folder)
    found, content = check_journal(folder, data)
    if content is None or not found.sound:
        raise SessionError(
            f"{arg(folder)}: not packed because the session has a problem: {arg(found.problems[0])}"
        )
    data = data[: content.found.end]
    sizes = {ref.path: ref.size for record in content.records for ref in files_of(record.action)}
    names = sorted(sizes)
    kept = [original_of(folder, version).name for version in content.origins]
    _refuse_size(folder, 1 + len(kept) + len(names), len(data) + sum(sizes.values()), limits)
    try:
        with whole_file(out) as stream, zipfile.ZipFile(stream, "w") as packed:
            packed.writestr(_described(JOURNAL, (data,), limits), data)
            for name in (*kept, *names):
                with packed.open(
                    _described(name, chunks_of(folder / name), limits), "w", force_zip64=True
                ) as place:
                    for chunk in chunks_of(folder / name):
                        place.write(chunk)
    except OSError as error:
        raise SessionError(
            f"{arg(out)}: the archive cannot be written ({arg(error)}): choose another location."
        ) from error
    return ArchiveSummary(1 + len(kept) + len(names), found.notes, left_out)


def _refuse_place(folder: Path, out: Path) -> None:
    """Refuse to write into the session, also by another name of its folder, or over what is no archive."""
    try:
        inside = (out.parent.resolve() / out.name).is_relative_to(folder.resolve())
        inside |= out.resolve().is_relative_to(folder.resolve())
        taken = (out.exists() or out.is_symlink()) and not (out.is_file() and zipfile.is_zipfile(out))
    except (OSError, ValueError, RuntimeError) as error:  # RuntimeError: links in a circle
        raise SessionError(
            f"{arg(out)}: an archive cannot be made here ({arg(error)}): choose another location."
        ) from error
    if inside:
        raise SessionError(f"{arg(out)}: this is inside the session: save the archive elsewhere.")
    if taken:
        raise SessionError(f"{arg(out)}: this file exists and is not an archive: choose another name.")


def _refuse_size(folder: Path, members: int, size: int, limits: ArchiveLimits) -> None:
    if members > limits.members or size > limits.size:
        raise SessionError(
            f"{arg(folder)}: {arg(members)} files of {arg(size >> 20)} MiB: an archive holds at most"
            f" {arg(limits.members)} files and {arg(limits.size >> 20)} MiB: copy the folder instead."
        )


def _described(name: str, chunks: Iterable[bytes], limits: ArchiveLimits) -> zipfile.ZipInfo:
    member = zipfile.ZipInfo(name, _EPOCH)
    member.compress_type = zipfile.ZIP_STORED if _stays(name, chunks, limits) else zipfile.ZIP_DEFLATED
    member.create_system = 3
    member.external_attr = (stat.S_IFREG | 0o644) << 16
    return member


def _stays(name: str, chunks: Iterable[bytes], limits: ArchiveLimits) -> bool:
    """Tell whether a file is stored as it is: it is packed already, or shrinks so much that it looks like a bomb."""
    if name.endswith(".mcap"):
        return True
    packer, size, packed = zlib.compressobj(wbits=-zlib.MAX_WBITS), 0, 0
    for chunk in chunks:
        if len(chunk) < _CHUNK and not size:  # small files are never refused
            return False
        size += len(chunk)
        packed += len(packer.compress(chunk))
    # Half, because not every zlib packs as well as this one.
    return size > limits.ratio // 2 * (packed + len(packer.flush()))


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
    regular(archive)
    if out.exists() or out.is_symlink():
        raise SessionError(f"{arg(out)}: this already exists: choose another name.")
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
        raise ArchiveError(
            f"{arg(archive)}: not an intact zip file ({arg(error)}): copy it again."
        ) from error
    except (OSError, ValueError) as error:
        if isinstance(error, SessionError):
            raise
        raise SessionError(
            f"{arg(out)}: the archive cannot be unpacked ({arg(error)}): check the path and the free space."
        ) from error
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def _members(packed: zipfile.ZipFile, archive: Path, limits: ArchiveLimits) -> list[zipfile.ZipInfo]:
    """Return the files of an archive, after refusing all that must not be unpacked."""
    everything = packed.infolist()
    if len(everything) > limits.members:
        raise ArchiveError(
            f"{arg(archive)}: {arg(len(everything))} files, more than {arg(limits.members)}: this is not a session."
        )
    members = [each for each in everything if each.filename not in {f"{name}/" for name in FOLDERS}]
    seen: dict[str, zipfile.ZipInfo] = {}
    for member in members:
        if wrong := _refused(member, limits):
            raise ArchiveError(
                f"{arg(archive)}: {arg(repr(member.filename)[:200])}: {arg(wrong)}: this is not a session, or not"
                " a safe one."
            )
        # A.csv and a.csv of one content are one file where names have no case, and no harm.
        other = seen.setdefault(member.filename.casefold(), member)
        if other is not member and (other.filename == member.filename or not _alike(other, member)):
            raise ArchiveError(
                f"{arg(archive)}: it contains {arg(member.filename)} twice: this is not a session."
            )
    if sum(member.file_size for member in members) > limits.size:
        raise ArchiveError(
            f"{arg(archive)}: unpacked it would be larger than {arg(limits.size >> 20)} MiB: this is not a session."
        )
    if sum(member.compress_size for member in members) > archive.stat().st_size:
        raise ArchiveError(f"{arg(archive)}: its files overlap: this is not a session.")
    if JOURNAL not in seen:
        raise ArchiveError(f"{arg(archive)}: it contains no journal: this is not a session.")
    return members


def _alike(one: zipfile.ZipInfo, other: zipfile.ZipInfo) -> bool:
    return (one.file_size, one.CRC) == (other.file_size, other.CRC)


def _refused(member: zipfile.ZipInfo, limits: ArchiveLimits) -> str:
    # orig_filename too: zipfile itself cuts names at a NUL and turns separators.
    if not (_MEMBER.fullmatch(member.filename) and member.orig_filename == member.filename):
        return message("not a name that a session uses")
    if stat.S_IFMT(member.external_attr >> 16) not in {0, stat.S_IFREG}:
        return message("a link or a device, not a file")
    if member.flag_bits & _ENCRYPTED or member.compress_type not in _METHODS:
        return message("encrypted or packed in an unusual way")
    if member.file_size > max(_CHUNK, limits.ratio * member.compress_size):
        return message(f"more than {arg(limits.ratio)} times its packed size")
    return ""


def _unpack(
    packed: zipfile.ZipFile, members: list[zipfile.ZipInfo], target: Path, limits: ArchiveLimits
) -> None:
    left = limits.size
    for member in members:
        place = target / member.filename
        if (
            not place.exists()
        ):  # there is one already only where names have no case; the journal's hashes decide
            left -= write_file(place, _content(packed, member, left))
    for name in (*FOLDERS, "."):
        sync_folder(target / name)


def _content(packed: zipfile.ZipFile, member: zipfile.ZipInfo, left: int) -> Iterator[bytes]:
    """Read a file of an archive; sizes are counted, because those that are stated may lie."""
    left = min(left, member.file_size)
    with packed.open(member) as stream:
        while chunk := stream.read(_CHUNK):
            left -= len(chunk)
            if left < 0:
                raise ArchiveError(
                    f"{arg(member.filename)}: larger than the archive declares: this is not a session."
                )
            yield chunk


def _refuse_strangers(folder: Path, archive: Path, names: set[str]) -> None:
    found, content = check_journal(folder, read_journal(folder))
    if content is None or not found.sound:
        raise ArchiveError(
            f"{arg(archive)}: not a complete session: {arg(found.problems[0].replace(str(folder), 'in it'))}"
        )
    known = {ref.path for record in content.records for ref in files_of(record.action)}
    known |= {JOURNAL, *(original_of(folder, version).name for version in content.origins)}
    if strangers := sorted(names - known):
        raise ArchiveError(
            f"{arg(archive)}: {arg(strangers[0])} belongs to no record in its journal: this is not a session."
        )

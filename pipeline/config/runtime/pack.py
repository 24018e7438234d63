"""
The files of a bundle, in a folder or a zip file: bounded before they are read, and no others than there should be.

A folder or zip file comes from anywhere. Nothing in it is believed, neither a name nor a size.
"""

import io
import os
import stat
import time
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import BinaryIO

from contactbench.pipeline.config.runtime.swap import put_aside
from contactbench.pipeline.errors import ConfigError, arg, message

CONFIG, CHECKSUM = "contactbench.json", "contactbench.sha256"
PROBE, PLANES, ROS2, FT_CALIB, REPORT = "probe.ply", "planes.csv", "ros2.yaml", "ft_calib.yaml", "report.html"
SELF_TEST = "self_test.csv"
NEEDED = (CONFIG, CHECKSUM, PROBE, PLANES, ROS2)
KNOWN = (*NEEDED, FT_CALIB, SELF_TEST, REPORT)

MOST_FILES = 50
LARGEST_FILE = 200 * 2**20
LARGEST_CONFIG = 2**20  # what the runtime in C++ takes
LARGEST_RATIO = 200
_LARGEST_ZIP = 500 * 2**20
_EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest that a zip file can hold
_METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
_AGAIN = message("copy or export the bundle again.")
_MOST_TRIES, _PAUSE_S = 50, 0.005
# No link, and no waiting for whoever writes to a pipe.
_READ = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


def read_bundle(path: Path) -> dict[str, bytes]:
    """
    Read all files of a bundle.

    Parameters
    ----------
    path : path
        A folder or a zip file. Where it is missing because an export was killed between two renames, the bundle that
        was there before is read.

    Raises
    ------
    ConfigError
        It is missing, no bundle, too large, holds a file that does not belong there or lacks one, or cannot be read.
    """
    try:
        return _read_settled(path)
    except (OSError, ValueError) as error:  # ValueError: a path that no file system can hold
        if isinstance(error, ConfigError):
            raise
        raise ConfigError(f"{arg(path)}: the bundle cannot be read ({arg(error)}): {arg(_AGAIN)}") from error


def read_zip(stream: BinaryIO, name: str) -> dict[str, bytes]:
    """Read all files of a zipped bundle; ConfigError as `read_bundle`."""
    if stream.seek(0, io.SEEK_END) > _LARGEST_ZIP:
        raise ConfigError(
            f"{arg(name)}: the file is larger than {arg(_LARGEST_ZIP >> 20)} MiB: not a bundle."
        )
    try:
        with zipfile.ZipFile(stream) as packed:
            members = packed.infolist()
            check_names([member.orig_filename for member in members], name)
            for member in members:
                _check_member(member, name)
            if sum(member.file_size for member in members) > _LARGEST_ZIP:
                raise ConfigError(
                    f"{arg(name)}: the files are larger than {arg(_LARGEST_ZIP >> 20)} MiB: not a bundle."
                )
            return {member.filename: _unpacked(packed, member, name) for member in members}
    # What the zipfile module lets through of damaged files.
    except (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, OSError, ValueError) as error:
        if isinstance(error, ConfigError):
            raise
        raise ConfigError(
            f"{arg(name)}: not an intact zip file ({arg(str(error)[:200])}): {arg(_AGAIN)}"
        ) from error


def encode_zip(files: Mapping[str, bytes]) -> bytes:
    """Pack files; stored, because compressors differ, so that the same files give the same bytes everywhere."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_STORED) as packed:
        for name in sorted(files, key=lambda name: (name not in (CONFIG, CHECKSUM), name)):
            member = zipfile.ZipInfo(name, _EPOCH)
            member.create_system, member.external_attr = 3, (stat.S_IFREG | 0o644) << 16
            packed.writestr(member, files[name])
    return out.getvalue()


def check_names(names: list[str], where: str) -> None:
    """Refuse names that are not those of a bundle's files, each once, none missing; ConfigError names the first."""
    if len(names) > MOST_FILES:
        raise ConfigError(
            f"{arg(where)}: there are {arg(len(names))} files, more than {arg(MOST_FILES)}: not a bundle."
        )
    for name in names:
        if name not in KNOWN:
            raise ConfigError(
                f"{arg(where)}: the file {arg(ascii(name)[:120])} does not belong in a bundle: remove it."
            )
        if names.count(name) > 1:
            raise ConfigError(f"{arg(where)}: the file {arg(name)} appears twice: {arg(_AGAIN)}")
    missing = [name for name in NEEDED if name not in names]
    if missing:
        raise ConfigError(f"{arg(where)}: the file {arg(missing[0])} is missing: {arg(_AGAIN)}")


def check_size(name: str, size: int, where: str) -> None:
    """Refuse a file that is larger than any of a bundle; ConfigError."""
    largest = LARGEST_CONFIG if name == CONFIG else LARGEST_FILE
    if size > largest:
        raise ConfigError(
            f"{arg(where)}: {arg(name)} has {arg(size)} bytes, more than {arg(largest >> 20)} MiB: {arg(_AGAIN)}"
        )


def _read_settled(path: Path) -> dict[str, bytes]:
    """Read a bundle; once more if another took its place meanwhile, for the old one is removed then."""
    for _ in range(_MOST_TRIES):
        before = _identity(path)
        try:
            return _read_now(path)
        except (OSError, ConfigError):
            if _identity(path) == before:
                raise
            time.sleep(_PAUSE_S)
    return _read_now(path)


def _identity(path: Path) -> tuple[int, ...] | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_dev, status.st_ino, status.st_ctime_ns


def _read_now(path: Path) -> dict[str, bytes]:
    if not os.path.lexists(path) and (aside := put_aside(path)).is_dir():
        return _read_folder(aside)
    if path.is_dir():
        return _read_folder(path)
    if not path.is_file():
        raise ConfigError(f"{arg(path)}: there is no such folder or zip file: check the path.")
    with path.open("rb") as stream:
        return read_zip(stream, str(path))


def _read_folder(folder: Path) -> dict[str, bytes]:
    if os.open not in os.supports_dir_fd or os.listdir not in os.supports_fd:  # Windows
        return _read_files(folder, None)
    # Opened once: all files are of the same folder, whatever takes its name meanwhile.
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        return _read_files(folder, descriptor)
    finally:
        os.close(descriptor)


def _read_files(folder: Path, descriptor: int | None) -> dict[str, bytes]:
    names = sorted(os.listdir(folder if descriptor is None else descriptor))  # noqa: PTH208  (a descriptor)
    check_names(names, str(folder))
    files = {}
    for name in names:
        place = str(folder / name) if descriptor is None else name
        status = os.stat(place, dir_fd=descriptor, follow_symlinks=False)
        if not stat.S_ISREG(status.st_mode):
            raise ConfigError(
                f"{arg(folder)}: {arg(name)} is a link, folder or device, not a file: {arg(_AGAIN)}"
            )
        check_size(name, status.st_size, str(folder))
        with os.fdopen(os.open(place, _READ, dir_fd=descriptor), "rb") as stream:
            files[name] = stream.read(LARGEST_FILE + 1)
        check_size(name, len(files[name]), str(folder))
    return files


def _check_member(member: zipfile.ZipInfo, where: str) -> None:
    what = ""
    kind = stat.S_IFMT(member.external_attr >> 16)
    if member.flag_bits & 0x1:
        what = message("is encrypted")
    elif member.compress_type not in _METHODS:
        what = message("is compressed in an unusual way")
    elif kind not in (0, stat.S_IFREG) or member.filename != member.orig_filename:
        what = message("is a link or device, not a file")
    elif member.file_size > LARGEST_RATIO * max(member.compress_size, 1):
        what = message(f"expands more than {arg(LARGEST_RATIO)} times when unpacked")
    if what:
        raise ConfigError(
            f"{arg(where)}: {arg(member.filename)} {arg(what)}: pack the bundle's files with a common program."
        )
    check_size(member.filename, member.file_size, where)


def _unpacked(packed: zipfile.ZipFile, member: zipfile.ZipInfo, where: str) -> bytes:
    with packed.open(member) as stream:
        content = stream.read(member.file_size + 1)
    if len(content) != member.file_size:
        raise ConfigError(
            f"{arg(where)}: {arg(member.filename)} does not have its declared length: {arg(_AGAIN)}"
        )
    return content

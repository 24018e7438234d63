"""
A folder that takes another's place in one step.

Two renames would leave a moment without either folder. Linux can exchange two names at once. Elsewhere the old folder
is put aside under a name that readers know, so that it is found until the new one is in its place.
"""

import ctypes
import errno
import os
from collections.abc import Collection, Mapping
from contextlib import suppress
from pathlib import Path

from contactbench.pipeline.durable import scratch_beside, sync_folder
from contactbench.pipeline.errors import ConfigError, arg

_HERE, _EXCHANGE = -100, 2  # AT_FDCWD, RENAME_EXCHANGE
# A kernel or file system that does not know how.
_UNABLE = {errno.ENOSYS, errno.EINVAL, errno.ENOTSUP, errno.EPERM}


def put_aside(folder: Path) -> Path:
    """Return where the folder that was there before lies, if an exchange by two renames was cut short."""
    return folder.with_name(f".{folder.name}.aside")


def write_folder(folder: Path, files: Mapping[str, bytes], known: Collection[str]) -> None:
    """
    Put files in a folder in one step: whoever reads it sees all old ones or all new ones, also after a power cut.

    Parameters
    ----------
    folder : path
        New, empty, or one that holds nothing but files with `known` names, which it then loses.
    files : mapping
        Name -> content.
    known : collection of str

    Raises
    ------
    ConfigError
        Something else is there.
    OSError
        It cannot be written; there are the old files or the new ones.
    """
    _refuse_others(folder, known)
    scratch = scratch_beside(folder)
    try:
        _fill(scratch, files)
        _take_place(scratch, folder)
    finally:
        # Now the old files, or the new ones if it failed.
        _remove(scratch)
    with suppress(OSError):  # what is left over is in nobody's way
        _remove(put_aside(folder))
    sync_folder(folder.absolute().parent)


def _fill(folder: Path, files: Mapping[str, bytes]) -> None:
    folder.mkdir()
    for name, content in files.items():
        with (folder / name).open("xb") as stream:
            stream.write(content)
            stream.flush()
            os.fsync(stream.fileno())
    sync_folder(folder)


def _take_place(new: Path, folder: Path) -> None:
    if not os.path.lexists(folder):
        new.rename(folder)
    elif not exchange(new, folder):
        aside = put_aside(folder)
        _remove(aside)
        folder.rename(aside)
        try:
            new.rename(folder)
        except BaseException:
            aside.rename(folder)
            raise
    sync_folder(folder.absolute().parent)


def exchange(one: Path, other: Path) -> bool:
    """
    Exchange the names of two folders in one step; False where that is not possible.

    Raises
    ------
    OSError
        It is possible, and failed.
    """
    try:
        rename = ctypes.CDLL(None, use_errno=True).renameat2
    except (AttributeError, OSError, TypeError):  # another C library or operating system
        return False
    if rename(_HERE, os.fsencode(one), _HERE, os.fsencode(other), _EXCHANGE) == 0:
        return True
    code = ctypes.get_errno()
    if code in _UNABLE:
        return False
    raise OSError(code, os.strerror(code), str(other))


def _refuse_others(folder: Path, known: Collection[str]) -> None:
    if not os.path.lexists(folder):
        return
    if folder.is_symlink() or not folder.is_dir():
        raise ConfigError(
            f"{arg(folder)}: a file or a link has this name: choose another folder, or a .zip name."
        )
    strangers = sorted(file.name for file in folder.iterdir() if file.name not in known)
    if strangers:
        raise ConfigError(
            f"{arg(folder)}: the folder contains {arg(ascii(strangers[0])[:120])}, which belongs to no bundle:"
            " choose a new or empty folder."
        )


def _remove(folder: Path) -> None:
    """Remove a folder of files, if it is there."""
    if not folder.is_dir():
        return
    # A hidden folder that stays does no harm; an error now would deny that the new one is there.
    with suppress(OSError):
        for file in folder.iterdir():
            file.unlink()
        folder.rmdir()

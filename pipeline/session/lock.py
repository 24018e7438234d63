"""One writer at a time: a lock that the operating system takes back when its process dies, however it dies."""

import errno
import os
import stat
import sys
from pathlib import Path

from contactbench.pipeline.errors import arg
from contactbench.pipeline.session.files import FOLDERS
from contactbench.pipeline.session.journal import (
    JOURNAL,
    SessionError,
    SessionLockedError,
    SessionReadOnlyError,
)

LOCK = "lock"
_LONGEST_OWNER = 256
# Windows locks bytes, and forbids others to read them: one far behind the text that tells who writes.
_BYTE = 1 << 20
_OURS = b"process "
_NO_LINK = getattr(os, "O_NOFOLLOW", 0)  # the text goes into this very file
_TAKEN = {errno.EWOULDBLOCK, errno.EAGAIN, errno.EACCES, errno.EDEADLK}


class Lock:
    """
    The right to write a session, held until `release` or the end of the process.

    The file stays when the lock is gone. Deleting it would let two processes lock two files of that name.

    Raises
    ------
    SessionLockedError
        Another process holds it; the message says which.
    SessionReadOnlyError
        The folder cannot be written; no lock is left in it.
    SessionError
        The lock cannot be used.
    """

    def __init__(self, folder: Path) -> None:
        self._folder, self._file = folder, folder / LOCK
        for name in ("", JOURNAL, *FOLDERS):
            if not writable(folder / name):
                raise SessionReadOnlyError(
                    f"{arg(folder / name)}: not writable: open the session read-only, make it writable,"
                    " or work on a copy of its folder."
                )
        try:
            self._descriptor = os.open(self._file, os.O_RDWR | os.O_CREAT | _NO_LINK, 0o644)
        except OSError as error:
            raise _not_locked(folder, error) from error
        try:
            self._take_over()
        except BaseException:
            self.release()
            raise

    def _take_over(self) -> None:
        try:
            _take(self._descriptor)
        except OSError as error:
            if error.errno not in _TAKEN:
                raise _not_locked(self._folder, error) from error
            holder = self._text().decode("ascii", "replace").strip()
            raise SessionLockedError(
                f"{arg(self._folder)}: another process is writing to this session"
                f" ({arg(holder or 'unknown')}): close it there first. Reading is always possible."
            ) from error
        text = self._text()
        # A full disk may have left a part of the text.
        if text[: len(_OURS)] != _OURS[: len(text)] or len(text) >= _LONGEST_OWNER:
            raise SessionError(
                f"{arg(self._file)}: this file belongs to another program: move it away, or choose another folder."
            )
        self._say_who()

    def _text(self) -> bytes:
        try:
            # What is no regular file could be read without end.
            if not stat.S_ISREG(os.fstat(self._descriptor).st_mode):
                raise SessionError(
                    f"{arg(self._file)}: not a regular file: move it away, or choose another folder."
                )
            os.lseek(self._descriptor, 0, os.SEEK_SET)
            return os.read(self._descriptor, _LONGEST_OWNER)
        except OSError as error:
            raise _not_locked(self._folder, error) from error

    @property
    def held(self) -> bool:
        """Whether it was not released yet."""
        return self._descriptor >= 0

    def check(self) -> None:
        """
        Refuse to go on when the lock's file was deleted or replaced: another process may hold the new one.

        Raises
        ------
        SessionError
            It was, or cannot be looked at.
        """
        try:
            same = os.path.samestat(os.fstat(self._descriptor), self._file.lstat())
        except OSError:
            same = False
        if not same:
            raise SessionError(
                f"{arg(self._file)}: the lock was removed or replaced, so others may be writing: reload"
                " the session."
            )

    def _say_who(self) -> None:
        try:
            os.ftruncate(self._descriptor, 0)
            os.lseek(self._descriptor, 0, os.SEEK_SET)
            os.write(self._descriptor, _OURS + f"{os.getpid()}\n".encode())
        except OSError:  # a full disk: the name is only for people, the lock holds without it
            return

    def release(self) -> None:
        """Let others write; a second time does nothing."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1


def writable(path: Path) -> bool:
    """Tell whether this user and this disk let a path be written; what is not there yet can be."""
    return os.access(path, os.W_OK) or not os.path.lexists(path)


def written_now(folder: Path) -> bool:
    """Tell whether a process holds the lock of a session; changes nothing."""
    try:
        descriptor = os.open(folder / LOCK, os.O_RDWR | _NO_LINK)
    except OSError:  # no lock, or none that could be taken here
        return False
    try:
        _take(descriptor)
    except OSError as error:
        return error.errno in _TAKEN
    finally:
        os.close(descriptor)
    return False


def _not_locked(folder: Path, error: OSError) -> SessionError:
    return SessionError(
        f"{arg(folder)}: the session cannot be locked ({arg(error)}): make the folder writable, or open the"
        " session read-only."
    )


if sys.platform == "win32":
    import msvcrt

    def _take(descriptor: int) -> None:
        os.lseek(descriptor, _BYTE, os.SEEK_SET)
        try:
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        finally:
            os.lseek(descriptor, 0, os.SEEK_SET)

else:
    import fcntl

    def _take(descriptor: int) -> None:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)

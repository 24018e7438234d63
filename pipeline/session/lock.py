"""One writer at a time: a lock that the operating system takes back when its process dies, however it dies."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from pipeline.session.errors import SessionError, SessionLockedError

if TYPE_CHECKING:
    from pathlib import Path

LOCK = "lock"
_LONGEST = 256
# Windows locks bytes, and forbids others to read them: one far behind the text that tells who writes.
_BYTE = 1 << 20


class Lock:
    """
    The right to write a session, held until `release` or the end of the process.

    The file stays when the lock is gone. Deleting it would let two processes lock two files of that name.

    Raises
    ------
    SessionLockedError
        Another process holds it; the message says which.
    SessionError
        The folder cannot be written.
    """

    def __init__(self, folder: Path) -> None:
        file = folder / LOCK
        try:
            self._descriptor = os.open(file, os.O_RDWR | os.O_CREAT, 0o644)
        except OSError as error:
            raise SessionError(
                f"{folder}: the session cannot be locked ({error}): make the folder writable, or only read it."
            ) from error
        try:
            _take(self._descriptor)
        except OSError as error:
            holder = os.read(self._descriptor, _LONGEST).decode("ascii", "replace").strip()
            os.close(self._descriptor)
            raise SessionLockedError(
                f"{folder}: another process writes this session ({holder or 'unknown'}): close it there first."
                " Reading is possible all the time."
            ) from error
        self._say_who()

    def _say_who(self) -> None:
        try:
            os.ftruncate(self._descriptor, 0)
            os.write(self._descriptor, f"process {os.getpid()}\n".encode())
        except OSError:  # a full disk: the name is only for people, the lock holds without it
            return

    def release(self) -> None:
        """Let others write; a second time does nothing."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1


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

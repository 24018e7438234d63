"""The journal file: read by anyone, appended to by one, every record on the disk before it is acknowledged."""

from __future__ import annotations

import os
import stat
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.session import frames
from contactbench.pipeline.session.errors import JournalError, SessionError

if TYPE_CHECKING:
    from pathlib import Path

JOURNAL = "journal"
LARGEST = 256 * 2**20
_BINARY = getattr(os, "O_BINARY", 0)


def read_journal(folder: Path) -> bytes:
    """
    Return the journal's bytes as they are now.

    Raises
    ------
    SessionError
        There is none, it cannot be read, or it is far too large.
    """
    file = folder / JOURNAL
    try:
        # A pipe would be waited for; a link leads out of the session.
        if not stat.S_ISREG(file.lstat().st_mode):
            raise JournalError(f"{arg(file)}: not a regular file: choose a session folder.")
        with file.open("rb") as stream:
            data = stream.read(LARGEST + 1)
    except FileNotFoundError:
        raise SessionError(
            f"{arg(folder)}: this folder is not a session: check the path, or create one with"
            " `contactbench session new`."
        ) from None
    except (OSError, ValueError) as error:  # ValueError: a path that no file system can hold
        if isinstance(error, SessionError):
            raise
        raise SessionError(
            f"{arg(file)}: the journal cannot be read ({arg(error)}): choose a session folder."
        ) from error
    if len(data) > LARGEST:
        raise SessionError(f"{arg(file)}: larger than {arg(LARGEST >> 20)} MiB: start a new session.")
    return data


def refuse_damage(folder: Path, found: frames.Scan) -> None:
    """Raise JournalError for damage that no crash explains."""
    if found.damage:
        remedy = (
            message("`contactbench session repair` sets this record aside")
            if found.last
            else message(
                "`contactbench session salvage` copies everything intact into a new session; or"
                " restore the session from a backup"
            )
        )
        raise JournalError(
            f"{arg(folder / JOURNAL)}: {arg(found.damage)}: {arg(remedy)}; run `session verify` for details."
        )
    if not found.frames:
        raise JournalError(
            f"{arg(folder / JOURNAL)}: no intact record: restore the session from an archive or a backup."
        )


class JournalWriter:
    """
    Appends records. Whoever has one holds the session's lock.

    A write that fails is taken back, and the writer refuses all that follows until `mend`: after a failed fsync
    nobody knows what the disk holds, and only reading it again tells.

    Parameters
    ----------
    folder : path
        Of the session.
    found : Scan
        What the journal holds; behind it the file is cut.
    """

    def __init__(self, folder: Path, found: frames.Scan) -> None:
        self._file = folder / JOURNAL
        self._end, self._chain = found.end, found.chain
        self._broken = self._foreign = False
        self._open()

    def _open(self) -> None:
        try:
            self._descriptor = os.open(
                self._file, os.O_RDWR | os.O_APPEND | _BINARY | getattr(os, "O_NOFOLLOW", 0)
            )
        except OSError as error:
            raise SessionError(
                f"{arg(self._file)}: the journal cannot be written ({arg(error)}): check the permissions."
            ) from error
        try:
            if os.fstat(self._descriptor).st_size != self._end:
                os.ftruncate(self._descriptor, self._end)
                os.fsync(self._descriptor)
        except OSError as error:
            self.close()
            raise SessionError(
                f"{arg(self._file)}: the unfinished record cannot be cut off ({arg(error)})."
            ) from error

    @property
    def broken(self) -> bool:
        """Whether a write has failed, and nothing was mended since."""
        return self._broken

    def mend(self) -> None:
        """
        Go on after a write that failed: read again what was acknowledged, and cut off what may lie behind it.

        Raises
        ------
        SessionError
            The journal is not what was acknowledged, or the disk still fails; all that follows stays refused.
        """
        if self._foreign:
            raise self._changed()
        data = read_journal(self._file.parent)
        found = frames.scan(data[: self._end])
        if found.end != self._end or found.chain != self._chain:
            self._foreign = True
            raise self._changed()
        self.close()
        self._open()
        self._broken = False

    def append(self, payload: bytes) -> bytes:
        """
        Put a record on the disk; return its hash once it is there.

        Raises
        ------
        SessionError
            It is not there, or nobody knows: see `mend`. What was acknowledged before is there.
        """
        if self._descriptor < 0 or self._broken:
            raise SessionError(f"{arg(self._file)}: closed, or an earlier write failed: reload the session.")
        self._refuse_others()
        data = frames.encode(payload, self._chain)
        if self._end + len(data) > LARGEST:
            raise SessionError(
                f"{arg(self._file)}: the journal is full ({arg(LARGEST >> 20)} MiB): start a new session."
            )
        try:
            write_all(self._descriptor, data)
            os.fsync(self._descriptor)
        except BaseException as error:
            self._take_back()
            if not isinstance(error, OSError):
                raise
            raise SessionError(
                f"{arg(self._file)}: the action was not recorded ({arg(error)}): free disk space or check"
                " the disk, then repeat it. Everything recorded before is safe."
            ) from error
        self._chain = frames.chained(self._chain, payload)
        self._end += len(data)
        return self._chain

    def _refuse_others(self) -> None:
        """Whatever locks say: a record goes only behind the one that it is bound to."""
        try:
            mine, there = os.fstat(self._descriptor), self._file.lstat()
            same = os.path.samestat(mine, there) and mine.st_size == self._end
        except OSError:
            same = False
        if not same:
            self._broken = self._foreign = True
            raise self._changed()

    def _changed(self) -> SessionError:
        return SessionError(
            f"{arg(self._file)}: another program changed the journal, so the action was not recorded:"
            " reload the session."
        )

    def _take_back(self) -> None:
        self._broken = True
        try:
            os.ftruncate(self._descriptor, self._end)
            os.fsync(self._descriptor)
        except OSError:  # what is left is whole, or a torn tail: reading tells
            return

    def close(self) -> None:
        """Close the file; a second time does nothing."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1


def write_all(descriptor: int, data: bytes) -> None:
    """Write all of it: one call may write a part."""
    rest = memoryview(data)
    while rest:
        rest = rest[os.write(descriptor, rest) :]

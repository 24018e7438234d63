"""A session's folder: reading it, and adding to it so that nothing acknowledged is ever lost."""

from __future__ import annotations

import errno
import secrets
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Literal, Self

from contactbench.pipeline.durable import make_folder, sync_folder, write_durably
from contactbench.pipeline.errors import REPAIR, arg, message
from contactbench.pipeline.files import File
from contactbench.pipeline.session import journal
from contactbench.pipeline.session.actions import (
    NOWHERE,
    Action,
    DeviceRezeroed,
    FileRef,
    InputAdded,
    MeshChanged,
    Note,
    ParameterSet,
    Record,
    ResultAdded,
    ResultMarked,
    SessionCreated,
    checked,
    entry,
    files_of,
    payload_of,
    user,
)
from contactbench.pipeline.session.files import (
    FOLDERS,
    chunks_of,
    file_problem,
    own_file,
    refuse_links,
    regular,
    remove_scratch,
    store,
    take_in,
    try_room,
    unfinished,
)
from contactbench.pipeline.session.journal import JOURNAL, JournalWriter, SessionError
from contactbench.pipeline.session.lock import LOCK, Lock
from contactbench.pipeline.session.remains import read_damaged
from contactbench.pipeline.session.state import MESH, Content, Input, Result, State, fold, read_content
from contactbench.pipeline.session.why import stale_results

_NO_ROOM = {errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC), errno.EROFS}


class Session:
    """
    A session, open for reading or, by one process at a time, for writing.

    Make one with `create` or `open`; use it in a ``with`` statement. Every method that adds something returns once
    it is on the disk, files before the record that refers to them. One thread at a time may use it.

    Attributes
    ----------
    folder : Path
    notes : tuple of str
        What was noticed when it was opened, in sentences.
    damage : str
        What is wrong with its journal, if it was opened nevertheless; empty otherwise.
    """

    def __init__(
        self, folder: Path, read: Content, lock: Lock | None, writer: JournalWriter | None, by: str
    ) -> None:
        self.folder, self.notes, self.damage = folder, read.notes, read.found.damage
        if left := unfinished(folder):
            words = message(
                f"{arg(folder / left[0])}: this recording ended abruptly: {arg(REPAIR)} to recover it."
            )
            self.notes = (
                *self.notes,
                words if lock else message(f"{arg(words)} Ignore this if it is still being recorded."),
            )
        self._records = list(read.records)
        self._lock, self._writer, self._by = lock, writer, by
        self._full = False  # Whether the disk took no more of a file
        self._state: State | None = None

    @classmethod
    def create(cls, folder: Path, *, by: str | None = None) -> Session:
        """
        Make a session in a folder that is new or empty.

        Raises
        ------
        SessionError, InputError
            There is something in the folder, or it cannot be made.
        """
        make_folder(folder)
        _refuse_content(folder)  # before there is a lock: nothing is left in a folder that is somebody else's
        lock = Lock(folder)
        try:
            _refuse_content(folder)  # another process may have made one meanwhile
            for name in FOLDERS:
                (folder / name).mkdir(exist_ok=True)
            by = user() if by is None else by
            first = entry(SessionCreated(id=secrets.token_hex(16)), by, None)
            write_durably(folder / JOURNAL, journal.encode_all([payload_of(first)]))
            sync_folder(folder.absolute().parent)
        except OSError as error:
            raise SessionError(
                f"{arg(folder)}: the session cannot be created ({arg(error)}): choose another location."
            ) from error
        finally:
            lock.release()
        return cls.open(folder, by=by)

    @classmethod
    def open(
        cls, folder: Path, *, write: bool = True, damaged: bool = False, by: str | None = None
    ) -> Session:
        """
        Open a session; for writing, a torn record at the end is cut off and an older version migrated.

        Parameters
        ----------
        folder : path
        write : bool
            Whether to add to it. Reading changes nothing and is possible while another process writes.
        damaged : bool
            Also read what is whole of a damaged journal; see `read_damaged`. Only for reading.
        by : str, optional
            Who; left out, the name of the computer's user.

        Raises
        ------
        SessionError
            No session, a damaged one (JournalError), of a newer version (SchemaError), locked
            (SessionLockedError), or one that cannot be written (SessionReadOnlyError).
        """
        read = read_damaged(folder) if damaged and not write else read_content(folder)
        refuse_links(folder)
        if not write:
            return cls(folder, read, None, None, "")
        lock, writer = Lock(folder), None
        try:
            # Once more: before the lock was taken, another process may have written.
            read = read_content(folder, settle=True)
            writer = JournalWriter(folder, read.found)
            for name in FOLDERS:
                (folder / name).mkdir(exist_ok=True)
            remove_scratch(folder)
        except BaseException as error:
            if writer is not None:
                writer.close()
            lock.release()
            if not isinstance(error, OSError):
                raise
            raise SessionError(
                f"{arg(folder)}: the session cannot be written ({arg(error)}): check the permissions."
            ) from error
        return cls(folder, read, lock, writer, user() if by is None else by)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Let others write; a second time does nothing."""
        if self._writer is not None:
            self._writer.close()
        if self._lock is not None:
            self._lock.release()

    @property
    def records(self) -> tuple[Record, ...]:
        """Everything that happened, oldest first."""
        return tuple(self._records)

    @property
    def state(self) -> State:
        """What the records amount to."""
        if self._state is None:
            self._state = fold(self._records)
        return self._state

    def stale(self) -> dict[tuple[str, str], tuple[str, ...]]:
        """Say of each current result why it is stale; see `stale_results`."""
        return stale_results(self.state)

    # ---- adding ------------------------------------------------------------------------------------

    def add_input(
        self,
        file: File | bytes,
        kind: str,
        *,
        name: str | None = None,
        sensor: str | None = None,
        companions: Mapping[str, Path | bytes] | None = None,
        about: Mapping[str, Any] | None = None,
    ) -> Record:
        """
        Copy a raw input into the session; one of the kind ``mesh`` becomes the mesh in use.

        Parameters
        ----------
        file : path or bytes
            The file, or what would be in it.
        kind : str
        name : str, optional
            Left out: that of the file; bytes have none.
        sensor : str, optional
            Serial number of the sensor that it was recorded with.
        companions : mapping, optional
            Name -> file, or its bytes, that computations find beside it; see `companions_of`.
        about : mapping, optional
            What is known about it, JSON values; ``started``: when it was recorded, ISO 8601. Not for a mesh.
        """
        if name is None:
            name = "" if isinstance(file, bytes) else file.name
        source = _chunks(file)
        beside = {each: _chunks(there) for each, there in (companions or {}).items()}
        action, folder, given = _input(kind, sensor, about or {})
        # Refused before anything is copied.
        checked(action, name=name, file=NOWHERE, companions=dict.fromkeys(beside, NOWHERE), **given)
        ref, refs = self._store(folder, name, source), self._store_all(folder, beside)
        return self._append(
            checked(action, name=name, file=ref, companions=refs, **given), given.get("sensor")
        )

    def adopt(
        self, file: Path, kind: str, *, name: str, sensor: str | None, about: Mapping[str, Any]
    ) -> Record:
        """Make a file that was written in the session's own folder an input; it gets its place there, and no copy."""
        given = {"kind": kind, "name": name, "sensor": sensor, "about": dict(about)}
        checked(InputAdded, file=NOWHERE, **given)
        self.check_writable()
        try:
            ref = take_in(self.folder, "raw", own_file(file), name)
        except OSError as error:
            self._full = self._full or error.errno in _NO_ROOM
            raise SessionError(
                f"{arg(file)}: the file cannot be added to the session ({arg(error)}): free disk space or"
                f" check the disk, then {arg(REPAIR)}. Nothing is lost."
            ) from error
        record = self._append(checked(InputAdded, file=ref, **given), sensor)
        # Only now: a crash before leaves it for `repair`.
        with suppress(OSError):
            file.unlink()
        return record

    def set_parameter(self, key: str, value: Any) -> Record:
        """Set ``kind.parameter`` to a JSON value."""
        return self._append(checked(ParameterSet, key=key, value=value))

    def add_result(
        self,
        kind: str,
        name: str,
        files: Mapping[str, bytes],
        inputs: Mapping[str, str],
        parameters: Mapping[str, Any],
        *,
        created: str | None = None,
    ) -> Record:
        """
        Record a result with its files.

        Parameters
        ----------
        kind, name : str
            A result of the same kind and name is replaced by this one; the old one stays in the journal.
        files : mapping
            Name -> content; others refer to the one with the result's name, or else the first.
        inputs : mapping
            Role -> hash of what it was computed from: `Input.content` or `Result.content`; a file's also does.
        parameters : mapping
            JSON values with which it was computed.
        created : str, optional
            The time that is written in the files, if there is one: needed to make the same bytes again.

        Raises
        ------
        SessionError
            Something is not what it should be, unknown, or cannot be written.
        """
        given = {
            "kind": kind,
            "name": name,
            "inputs": dict(inputs),
            "parameters": dict(parameters),
            "created": created,
        }
        checked(ResultAdded, files=dict.fromkeys(files, NOWHERE), **given)
        for role, sha256 in inputs.items():
            if self.state.input_with(sha256) is None and self.state.result_with(sha256) is None:
                raise SessionError(
                    f"{arg(role)}: the session contains nothing with the hash {arg(sha256[:12])}: add it first."
                )
        refs = self._store_all("results", {each: (content,) for each, content in files.items()})
        return self._append(checked(ResultAdded, files=refs, **given))

    def add_again(self, there: Input | Result) -> Record:
        """
        Add what the session had once more, with the very files that it has, and say of it what was said last.

        Raises
        ------
        SessionError
            One of its files is not what the journal says, or the journal cannot be written.
        """
        action: Action
        given: dict[str, Any] = {}
        if isinstance(there, Result):
            action = there.action
        else:
            make, _, given = _input(there.kind, there.sensor, there.about)
            action = make(name=there.name, file=there.file, companions=dict(there.companions), **given)
        for ref in files_of(action):
            if wrong := file_problem(self.folder, ref):
                raise SessionError(f"{arg(self.folder)}: {arg(wrong)}")
        record = self._append(action, given.get("sensor"))
        return record if there.mark is None else self._append(there.mark)

    def mark(
        self, kind: str, name: str, mark: Literal["accepted", "rejected", "stale"], reason: str = ""
    ) -> Record:
        """Say something of the newest result of this kind and name."""
        if (kind, name) not in self.state.current_results:
            raise SessionError(
                f"{arg(self.folder)}: there is no result {arg(kind)} {arg(name)}: `session info` lists the results."
            )
        return self._append(checked(ResultMarked, kind=kind, name=name, mark=mark, reason=reason))

    @property
    def writable(self) -> bool:
        """Whether it was opened for writing."""
        return self._writer is not None

    def note(self, text: str, *, sensor: str | None = None) -> Record:
        """Write words into the journal; `sensor`: the serial number of the one that they are about."""
        return self._append(checked(Note, text=text), sensor)

    def rezeroed(self, sensor: str, reason: str = "") -> Record:
        """Record that a sensor's zero was moved; what rests on older recordings of it becomes stale."""
        return self._append(checked(DeviceRezeroed, sensor=sensor, reason=reason), sensor)

    def _store(self, folder: str, name: str, chunks: Iterable[bytes]) -> FileRef:
        self.check_writable()
        try:
            ref = store(self.folder, folder, name, chunks)
        except OSError as error:
            self._full = self._full or error.errno in _NO_ROOM  # else it may be the file that is copied
            raise SessionError(
                f"{arg(self.folder)}: {arg(name)} cannot be copied into the session ({arg(error)}): free disk"
                " space or check the disk. Nothing was recorded."
            ) from error
        self._full = False
        return ref

    def _store_all(self, folder: str, files: Mapping[str, Iterable[bytes]]) -> dict[str, FileRef]:
        return {name: self._store(folder, name, chunks) for name, chunks in files.items()}

    @property
    def refuses(self) -> bool:
        """Whether a write has failed, and the disk was not looked at since; see `recover`."""
        return self._writer is not None and (self._writer.broken or self._full)

    def recover(self) -> None:
        """
        Go on after a write that failed, as on a full disk; an action does so by itself, but tries no room before.

        Raises
        ------
        SessionError
            The disk still takes nothing, or the journal is not what was acknowledged.
        """
        writer = self.check_writable()
        if self.refuses:
            try:
                try_room(self.folder)
            except OSError as error:
                raise SessionError(
                    f"{arg(self.folder)}: the disk still rejects writes ({arg(error)}): free disk space or"
                    " check the disk."
                ) from error
            self._full = False
        if writer.broken:
            writer.mend()

    def _append(self, action: Action, sensor: str | None = None) -> Record:
        writer = self.check_writable()
        if writer.broken:
            writer.mend()
        made = entry(action, self._by, sensor)
        digest = writer.append(payload_of(made))
        record = Record(len(self._records) + 1, digest.hex(), made)
        self._records.append(record)
        self._state = None
        return record

    def check_writable(self) -> JournalWriter:
        """Return what writes; SessionError if nothing can: it is open for reading only, or its lock is gone."""
        if self._writer is None or self._lock is None:
            raise SessionError(f"{arg(self.folder)}: the session is open read-only: open it for writing.")
        if self._lock.held:  # a closed one says so itself
            self._lock.check()
        return self._writer


def _input(
    kind: str, sensor: str | None, about: Mapping[str, Any]
) -> tuple[type[InputAdded | MeshChanged], str, dict[str, Any]]:
    """Return the action that adds an input of a kind, the folder of its files, and what is said of it."""
    if kind == MESH:
        return MeshChanged, "meshes", {}
    return InputAdded, "raw", {"kind": kind, "sensor": sensor, "about": dict(about)}


def _chunks(file: File | bytes) -> Iterable[bytes]:
    return (file,) if isinstance(file, bytes) else chunks_of(regular(file))


def _refuse_content(folder: Path) -> None:
    # What a crash leaves before the journal is there may be taken up again.
    try:
        other = sorted(each.name for each in folder.iterdir() if each.name not in {LOCK, *FOLDERS})
    except OSError as error:
        raise SessionError(
            f"{arg(folder)}: the folder cannot be read ({arg(error)}): choose another location."
        ) from error
    if JOURNAL in other:
        raise SessionError(f"{arg(folder)}: there is already a session here: choose another folder.")
    if any(not name.startswith(f".{JOURNAL}.") for name in other):
        raise SessionError(f"{arg(folder)}: the folder contains {arg(other[0])}: choose an empty one.")
    refuse_links(folder)

"""A session's folder: reading it, and adding to it so that nothing acknowledged is ever lost."""

from __future__ import annotations

import secrets
from typing import TYPE_CHECKING, Any, Literal, Self

from pipeline.durable import make_folder, sync_folder, write_durably
from pipeline.session import frames
from pipeline.session.actions import (
    DeviceRezeroed,
    InputAdded,
    MeshChanged,
    Note,
    ParameterSet,
    Record,
    ResultAdded,
    ResultMarked,
    SessionCreated,
    payload_of,
)
from pipeline.session.entries import NOWHERE, checked, entry, user
from pipeline.session.errors import SessionError
from pipeline.session.files import FOLDERS, chunks_of, regular, remove_scratch, store
from pipeline.session.journal import JOURNAL, JournalWriter
from pipeline.session.lock import LOCK, Lock
from pipeline.session.reading import Content, read_content
from pipeline.session.stale import stale_results
from pipeline.session.state import MESH, State, fold

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path
    from types import TracebackType

    from pipeline.session.actions import Action, FileRef


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
    """

    def __init__(
        self, folder: Path, read: Content, lock: Lock | None, writer: JournalWriter | None, by: str
    ) -> None:
        self.folder, self.notes = folder, read.notes
        self._records = list(read.records)
        self._lock, self._writer, self._by = lock, writer, by
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
        lock = Lock(folder)
        try:
            # What a crash leaves before the journal is there may be taken up again.
            other = sorted(each.name for each in folder.iterdir() if each.name not in {LOCK, *FOLDERS})
            if JOURNAL in other:
                raise SessionError(f"{folder}: there is a session already: choose another folder.")
            if any(not name.startswith(f".{JOURNAL}.") for name in other):
                raise SessionError(f"{folder}: the folder holds {other[0]}: choose an empty one.")
            for name in FOLDERS:
                (folder / name).mkdir(exist_ok=True)
            by = user() if by is None else by
            first = entry(SessionCreated(id=secrets.token_hex(16)), by, None)
            write_durably(folder / JOURNAL, frames.encode_all([payload_of(first)]))
            sync_folder(folder.absolute().parent)
        except OSError as error:
            raise SessionError(
                f"{folder}: the session cannot be made ({error}): choose another place."
            ) from error
        finally:
            lock.release()
        return cls.open(folder, by=by)

    @classmethod
    def open(cls, folder: Path, *, write: bool = True, by: str | None = None) -> Session:
        """
        Open a session; for writing, a torn record at the end is cut off and an older version migrated.

        Parameters
        ----------
        folder : path
        write : bool
            Whether to add to it. Reading changes nothing and is possible while another process writes.
        by : str, optional
            Who; left out, the name of the computer's user.

        Raises
        ------
        SessionError
            No session, a damaged one (JournalError), of a newer version (SchemaError), or locked
            (SessionLockedError).
        """
        read = read_content(folder)
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
                f"{folder}: the session cannot be written ({error}): check the rights."
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
        self, file: Path, kind: str, *, name: str | None = None, sensor: str | None = None
    ) -> Record:
        """Copy a raw input into the session; one of the kind ``mesh`` becomes the mesh in use."""
        name = file.name if name is None else name
        source = chunks_of(regular(file))
        if kind == MESH:
            return self.change_mesh(name, source)
        # Refused before anything is copied.
        checked(InputAdded, kind=kind, name=name, file=NOWHERE, sensor=sensor)
        ref = self._store("raw", name, source)
        return self._append(checked(InputAdded, kind=kind, name=name, file=ref, sensor=sensor), sensor)

    def change_mesh(self, name: str, chunks: Iterable[bytes]) -> Record:
        """Use another mesh from now on; what was computed from the one before becomes stale."""
        checked(MeshChanged, name=name, file=NOWHERE)
        return self._append(checked(MeshChanged, name=name, file=self._store("meshes", name, chunks)))

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
            Role -> SHA-256 of what it was computed from: inputs, meshes, files of other results.
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
                    f"{role}: the session holds nothing with the hash {sha256[:12]}: add it first."
                )
        refs = {each: self._store("results", each, (content,)) for each, content in files.items()}
        return self._append(checked(ResultAdded, files=refs, **given))

    def mark(
        self, kind: str, name: str, mark: Literal["accepted", "rejected", "stale"], reason: str = ""
    ) -> Record:
        """Say something of the newest result of this kind and name."""
        if (kind, name) not in self.state.current_results:
            raise SessionError(f"{self.folder}: there is no result {kind} {name}: `session info` lists them.")
        return self._append(checked(ResultMarked, kind=kind, name=name, mark=mark, reason=reason))

    def note(self, text: str) -> Record:
        """Write words into the journal."""
        return self._append(checked(Note, text=text))

    def rezeroed(self, sensor: str, reason: str = "") -> Record:
        """Record that a sensor's zero was moved; what rests on older recordings of it becomes stale."""
        return self._append(checked(DeviceRezeroed, sensor=sensor, reason=reason), sensor)

    def _store(self, folder: str, name: str, chunks: Iterable[bytes]) -> FileRef:
        self._needs_writer()
        try:
            return store(self.folder, folder, name, chunks)
        except OSError as error:
            raise SessionError(
                f"{self.folder}: {name} cannot be copied into the session ({error}): free space or check the disk;"
                " nothing was recorded."
            ) from error

    def _append(self, action: Action, sensor: str | None = None) -> Record:
        writer = self._needs_writer()
        made = entry(action, self._by, sensor)
        digest = writer.append(payload_of(made))
        record = Record(len(self._records) + 1, digest.hex(), made)
        self._records.append(record)
        self._state = None
        return record

    def _needs_writer(self) -> JournalWriter:
        if self._writer is None:
            raise SessionError(f"{self.folder}: the session is open for reading only: open it for writing.")
        return self._writer

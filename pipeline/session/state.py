"""What a session amounts to: a pure fold over its records."""

import hashlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime
from pathlib import Path
from typing import Any, ClassVar, Generic, TypeVar

from pydantic import ValidationError

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.session import journal
from contactbench.pipeline.session.actions import (
    SCHEMA,
    VERSION,
    DeviceRezeroed,
    FileRef,
    InputAdded,
    MeshChanged,
    Note,
    Origin,
    ParameterSet,
    Record,
    ResultAdded,
    ResultMarked,
    SessionCreated,
    content_hash,
    input_hash,
    main_file,
    parse_payload,
    records_of,
)
from contactbench.pipeline.session.journal import (
    JOURNAL,
    SchemaError,
    SessionError,
    read_journal,
    refuse_damage,
)

Payloads = list[dict[str, Any]]
Migration = Callable[[Payloads], Payloads]

MESH = "mesh"


@dataclass(frozen=True)
class Input:
    """A raw input or a mesh."""

    # A mesh is of the kind ``mesh``; the session has one at a time, whatever its name
    kind: str
    name: str
    file: FileRef
    sensor: str | None  # Serial number of the sensor that it was recorded with; None if nobody said
    number: int  # Of its record
    at: str  # When, UTC
    companions: Mapping[str, FileRef] = field(default_factory=dict)  # Name -> file that lay beside it
    # What is known about it: JSON values, such as the counters of a recording
    about: Mapping[str, Any] = field(default_factory=dict)
    # Nobody says anything of what is brought in.
    mark: ClassVar[None] = None
    rejected: ClassVar[bool] = False

    @property
    def content(self) -> str:
        """SHA-256 that results refer to it by; also over its companions, if it has any."""
        return input_hash(self.file, self.companions)

    @property
    def slot(self) -> tuple[str, str]:
        """What a later input must have in common with this one to take its place."""
        return (self.kind, "" if self.kind == MESH else self.name)


@dataclass(frozen=True)
class Result:
    """A result as it was recorded."""

    action: ResultAdded
    number: int  # Of its record
    at: str  # When, UTC
    tool: str  # Which version made it
    marks: tuple[ResultMarked, ...] = ()  # What people said of it, oldest first

    @property
    def slot(self) -> tuple[str, str]:
        """Kind and name: a later result with the same ones takes its place."""
        return (self.action.kind, self.action.name)

    @property
    def kind(self) -> str:
        """What it is."""
        return self.action.kind

    @property
    def title(self) -> str:
        """For people."""
        return f"{self.action.kind} {self.action.name}"

    @property
    def file(self) -> FileRef:
        """Its main file: the one that others are computed from."""
        return self.action.files[main_file(self.action)]

    @property
    def content(self) -> str:
        """Its hash: of kind, name, inputs, parameters and files, without any time."""
        return content_hash(self.action)

    @property
    def known_as(self) -> set[str]:
        """What others may refer to it by: its hash, and those of its files."""
        return {self.content, *(file.sha256 for file in self.action.files.values())}

    @property
    def outcome(self) -> dict[str, str]:
        """Name -> SHA-256 of its files."""
        return {name: file.sha256 for name, file in self.action.files.items()}

    @property
    def mark(self) -> ResultMarked | None:
        """The newest thing that was said of it."""
        return self.marks[-1] if self.marks else None

    @property
    def rejected(self) -> bool:
        """Whether the newest thing that was said of it is that it does not count."""
        return self.mark is not None and self.mark.mark == "rejected"


def minute_of(at: str) -> str:
    """Return a record's time for people, to the minute."""
    return at[:16].replace("T", " ") + " UTC"


@dataclass(frozen=True)
class Setting:
    """A parameter's value, and since which record, when."""

    value: Any
    number: int
    at: str


@dataclass(frozen=True)
class RezeroRecord:
    """A sensor's zero was moved."""

    sensor: str
    reason: str
    number: int
    at: str


@dataclass(frozen=True)
class State:
    """
    Everything that the records say, newest word on each thing.

    Attributes
    ----------
    id : str
        Of the session.
    origins : dict
        Version -> SHA-256 of the journal that it was migrated from.
    inputs : tuple of Input
        All, oldest first, also those that others took the place of.
    results : tuple of Result
        The same of results.
    settings : dict
        Key -> Setting.
    rezeros : tuple of RezeroRecord
    notes : tuple of Note
    count : int
        Of records.
    """

    id: str = ""
    origins: dict[int, str] = field(default_factory=dict)
    inputs: tuple[Input, ...] = ()
    results: tuple[Result, ...] = ()
    settings: dict[str, Setting] = field(default_factory=dict)
    rezeros: tuple[RezeroRecord, ...] = ()
    notes: tuple[Note, ...] = ()
    count: int = 0

    @property
    def current_inputs(self) -> dict[tuple[str, str], Input]:
        """Slot -> the newest input of it."""
        return {each.slot: each for each in self.inputs}

    @property
    def current_results(self) -> dict[tuple[str, str], Result]:
        """Slot -> the newest result of it."""
        return {each.slot: each for each in self.results}

    @property
    def mesh(self) -> Input | None:
        """The mesh in use."""
        return self.current_inputs.get((MESH, ""))

    def newest(self, kind: str) -> Result | Input | None:
        """Return the newest result of a kind, or input that was brought in as one."""
        every: tuple[Result | Input, ...] = (*self.results, *self.inputs)
        found = (each for each in every if each.kind == kind)
        return max(found, key=lambda each: each.number, default=None)

    def made(self, kind: str) -> Result | None:
        """Return the newest of the current results of a kind that nobody rejected; None: there is none."""
        found = [each for each in self.current_results.values() if each.kind == kind and not each.rejected]
        return max(found, key=lambda each: each.number, default=None)

    def setting(self, key: str) -> Any:
        """Return the value of a setting; None: it was never set."""
        found = self.settings.get(key)
        return None if found is None else found.value

    def named(self, kind: str) -> dict[str, Setting]:
        """Return the settings ``kind.parameter``: parameter -> setting."""
        known = self.settings.items()
        return {key.partition(".")[2]: each for key, each in known if key.startswith(f"{kind}.")}

    def input_with(self, sha256: str, before: int | None = None) -> Input | None:
        """Return the newest input of this `Input.content`, of those before a record."""
        for each in reversed(self.inputs):
            if (before is None or each.number < before) and each.content == sha256:
                return each
        return None

    def result_with(self, sha256: str, before: int | None = None) -> Result | None:
        """Return the newest result of this `Result.content`, or with such a file, of those before a record."""
        for each in reversed(self.results):
            if (before is None or each.number < before) and sha256 in each.known_as:
                return each
        return None


def fold(records: Iterable[Record]) -> State:
    """Return what records amount to; the same records always give the same state."""
    # Lists that grow, so that long journals take linear time.
    name, number = "", 0
    origins: dict[int, str] = {}
    inputs: list[Input] = []
    results: list[Result] = []
    marks: dict[int, list[ResultMarked]] = {}
    newest: dict[tuple[str, str], int] = {}
    settings: dict[str, Setting] = {}
    rezeros: list[RezeroRecord] = []
    notes: list[Note] = []
    for record in records:
        number, at = record.number, record.entry.at
        match record.action:
            case SessionCreated() as action:
                name, origin = action.id, action.migrated_from
                origins = {} if origin is None else {origin.version: origin.sha256}
            case InputAdded() as new:
                inputs.append(
                    Input(new.kind, new.name, new.file, new.sensor, number, at, new.companions, new.about)
                )
            case MeshChanged() as mesh:
                inputs.append(Input(MESH, mesh.name, mesh.file, None, number, at, mesh.companions))
            case ResultAdded() as action:
                newest[action.kind, action.name] = len(results)
                results.append(Result(action, number, at, record.entry.tool))
            case ResultMarked() as action:
                if (action.kind, action.name) in newest:
                    marks.setdefault(newest[action.kind, action.name], []).append(action)
            case ParameterSet(key=key, value=value):
                settings[key] = Setting(value, number, at)
            case DeviceRezeroed(sensor=sensor, reason=reason):
                rezeros.append(RezeroRecord(sensor, reason, number, at))
            case Note() as note:
                notes.append(note)
    for index, said in marks.items():
        results[index] = replace(results[index], marks=tuple(said))
    return State(name, origins, tuple(inputs), tuple(results), settings, tuple(rezeros), tuple(notes), number)


# ---- what results were computed from --------------------------------------------------------------


_T = TypeVar("_T", Input, Result)


@dataclass(frozen=True)
class InputSource:
    """What an input of a result may have been; more than one, if the same content was there under several names."""

    inputs: tuple[Input, ...]
    results: tuple[Result, ...]

    @property
    def lost(self) -> bool:
        """Whether no earlier record holds it: no session writes that, but a salvaged one can lack records."""
        return not self.inputs and not self.results


def sources_of(state: State) -> dict[int, tuple[InputSource, ...]]:
    """Return what each result was computed from: number of its record -> its inputs. What came later is none."""
    inputs: _Shelf[Input] = _Shelf()
    results: _Shelf[Result] = _Shelf()
    found: dict[int, tuple[InputSource, ...]] = {}
    added = iter(state.inputs)
    following = next(added, None)
    for result in state.results:
        while following is not None and following.number < result.number:
            inputs.put(following, {following.content})
            following = next(added, None)
        found[result.number] = tuple(
            InputSource(_of_kind(role, inputs.get(sha256)), results.get(sha256))
            for role, sha256 in result.action.inputs.items()
        )
        results.put(result, result.known_as)
    return found


class _Shelf(Generic[_T]):
    """What is in each slot now, found by what others call it."""

    def __init__(self) -> None:
        self._now: dict[tuple[str, str], tuple[_T, set[str]]] = {}
        self._by_hash: dict[str, dict[tuple[str, str], _T]] = {}
        self._newest: dict[str, _T] = {}

    def put(self, new: _T, known_as: set[str]) -> None:
        _, before = self._now.get(new.slot, (new, set[str]()))
        for sha256 in before - known_as:
            self._by_hash[sha256].pop(new.slot, None)
        for sha256 in known_as:
            self._by_hash.setdefault(sha256, {})[new.slot] = new
            self._newest[sha256] = new
        self._now[new.slot] = (new, known_as)

    def get(self, sha256: str) -> tuple[_T, ...]:
        """Return what has this hash now or, if nothing has, the last that had it."""
        there = tuple(self._by_hash.get(sha256, {}).values())
        return there or ((self._newest[sha256],) if sha256 in self._newest else ())


def _of_kind(role: str, found: tuple[Input, ...]) -> tuple[Input, ...]:
    # A copy that was added as something else, such as a backup, is not what was computed from.
    return tuple(each for each in found if each.kind == role) or found


class Recorded:
    """When files were recorded, and with which sensors: adding one once more makes it no newer."""

    def __init__(self, inputs: Iterable[Input]) -> None:
        self._first: dict[str, int] = {}
        self._sensors: dict[str, dict[str, None]] = {}
        self._started: dict[str, datetime] = {}
        for each in inputs:
            key = each.file.sha256
            self._first.setdefault(key, each.number)
            if each.sensor is not None:
                self._sensors.setdefault(key, {})[each.sensor] = None
            started = _time(each.about.get("started"))
            if started is not None:
                self._started[key] = min(started, self._started.get(key, started))

    def sensors(self, used: Input) -> tuple[str, ...]:
        """Return the serial numbers that were ever said of it."""
        return tuple(self._sensors.get(used.file.sha256, ()))

    def is_before(self, used: Input, rezero: RezeroRecord) -> bool:
        """Tell whether it was recorded before a sensor was re-zeroed, by the journal or by its own clock."""
        key = used.file.sha256
        if self._first[key] < rezero.number:
            return True
        started, moved = self._started.get(key), _time(rezero.at)
        return started is not None and moved is not None and started < moved


def _time(text: object) -> datetime | None:
    try:
        found = datetime.fromisoformat(text) if isinstance(text, str) else None
    except ValueError:
        return None
    return found if found is not None and found.tzinfo is not None else None


# ---- reading a session without changing it -------------------------------------------------------


# version -> what makes the next version's payloads of all payloads of that one, the first with its new version.
# Version 2 has companions of inputs, and what is known about them: version 1 has neither, and needs no change.
MIGRATIONS: dict[int, Migration] = {1: lambda payloads: payloads}


def version_of(folder: Path, found: journal.Scan) -> int:
    """
    Return the version of a journal.

    Raises
    ------
    SchemaError
        It is newer than this program, or no session's.
    """
    first = parse_payload(found.frames[0].payload, 1)
    action = first.get("action")
    version = action.get("version") if isinstance(action, dict) else None
    if not isinstance(action, dict) or action.get("schema_id") != SCHEMA or type(version) is not int:
        raise SchemaError(
            f"{arg(folder / JOURNAL)}: its first record does not state {arg(SCHEMA)}: choose a session folder."
        )
    if version > VERSION:
        raise SchemaError(
            f"{arg(folder)}: the session has version {arg(version)}, but this contactbench knows at most"
            f" {arg(VERSION)}: use a newer contactbench. Nothing was changed."
        )
    return version


def migrated(folder: Path, data: bytes, found: journal.Scan, version: int) -> list[bytes]:
    """
    Return the payloads of an older journal as this version writes them; writes nothing.

    Raises
    ------
    SchemaError
        There is no way from that version to this one.
    """
    payloads = [parse_payload(frame.payload, number) for number, frame in enumerate(found.frames, 1)]
    for step in range(version, VERSION):
        if step not in MIGRATIONS:
            raise SchemaError(
                f"{arg(folder)}: the session has version {arg(version)}, too old for this contactbench: open"
                f" it with a contactbench that migrates version {arg(step)}."
            )
        payloads = MIGRATIONS[step](payloads)
    digest = hashlib.sha256(data[: found.end]).hexdigest()
    payloads[0]["action"] |= {"version": VERSION, "migrated_from": {"version": version, "sha256": digest}}
    return [journal.canonical(payload) for payload in payloads]


def kept_origins(folder: Path, found: journal.Scan) -> dict[int, str]:
    """
    Return what an older journal says is kept of the one before it: version -> SHA-256.

    Raises
    ------
    SchemaError
        What it says makes no sense.
    """
    said = parse_payload(found.frames[0].payload, 1)["action"].get("migrated_from")
    if said is None:
        return {}
    try:
        origin = Origin.model_validate(said)
    except ValidationError as error:
        raise SchemaError(
            f"{arg(folder / JOURNAL)}: its first record does not state the version it was migrated"
            " from: restore the session from a backup."
        ) from error
    return {origin.version: origin.sha256}


def original_of(folder: Path, version: int) -> Path:
    """Return where the journal of an older version is kept."""
    return folder / f"{JOURNAL}.v{version}"


def write_migrated(
    folder: Path, data: bytes, found: journal.Scan, version: int, payloads: list[bytes]
) -> None:
    """
    Keep the original beside, then replace the journal in one step; only for the holder of the lock.

    Raises
    ------
    SessionError
        It cannot be written: the old journal is still the journal.
    """
    try:
        write_durably(original_of(folder, version), data[: found.end])
        write_durably(folder / JOURNAL, journal.encode_all(payloads))
    except OSError as error:
        raise SessionError(
            f"{arg(folder)}: the session cannot be migrated to version {arg(VERSION)} ({arg(error)}): free disk"
            " space or check the permissions. The original is unchanged."
        ) from error


def origin_problems(folder: Path, origins: Mapping[int, str]) -> list[str]:
    """Say which kept originals are missing or changed; `origins` maps versions to hashes."""
    problems = []
    for version, sha256 in origins.items():
        file = original_of(folder, version)
        try:
            digest = hashlib.sha256(file.read_bytes()).hexdigest()
        except OSError as error:
            problems.append(
                message(f"{arg(file.name)}, the journal before its migration, cannot be read ({arg(error)})")
            )
            continue
        if digest != sha256:
            problems.append(message(f"{arg(file.name)}, the journal before its migration, was changed"))
    return problems


@dataclass(frozen=True)
class Content:
    """What a journal says."""

    records: tuple[Record, ...]
    notes: tuple[str, ...]  # What was noticed, in sentences
    found: journal.Scan  # Of the file as it is now
    # Version -> SHA-256 of the journals that the one on the disk says are kept beside it. One that was only
    # migrated in memory has kept nothing yet.
    origins: Mapping[int, str]


def read_content(folder: Path, *, settle: bool = False) -> Content:
    """
    Read a journal; one of an older version as this version would write it.

    Parameters
    ----------
    folder : path
    settle : bool
        Write the migrated journal, and keep the old one; only for the holder of the lock. A torn record at the
        end is left to `JournalWriter`.

    Raises
    ------
    SessionError
        No session, a damaged one, of a newer version or of one that cannot be migrated.
    """
    return content_of(folder, read_journal(folder), settle=settle)


def content_of(folder: Path, data: bytes, *, settle: bool = False) -> Content:
    """Read the bytes of a journal; see `read_content`."""
    found = journal.scan(data)
    refuse_damage(folder, found)
    fate = message("has been cut off") if settle else message("has been left out")
    torn = message(f"{arg(folder / JOURNAL)}: {arg(found.torn)}: it was never confirmed and {arg(fate)}.")
    notes = [torn] if found.torn else []
    version = version_of(folder, found)
    if version == VERSION:
        records = records_of(found.frames)
        return Content(records, tuple(notes), found, fold(records[:1]).origins)
    payloads = migrated(folder, data, found, version)
    renewed = journal.scan(journal.encode_all(payloads))
    records = records_of(renewed.frames)  # what could not be read again is not written
    if not settle:
        notes.append(
            message(f"{arg(folder)}: older version {arg(version)}; it will be migrated on the next write.")
        )
        return Content(records, tuple(notes), found, kept_origins(folder, found))
    write_migrated(folder, data, found, version, payloads)
    notes.append(
        message(
            f"{arg(folder)}: migrated from version {arg(version)} to {arg(VERSION)}; results are as they were, and"
            " `session replay` tells how far contacts move. The previous journal is kept as"
            f" {arg(original_of(folder, version).name)}."
        )
    )
    return Content(records, tuple(notes), renewed, fold(records[:1]).origins)

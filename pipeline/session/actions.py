"""What can happen in a session, as typed records; and who did it, when, with what."""

import getpass
import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Annotated, Any, Literal, Self, TypeVar

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    JsonValue,
    StringConstraints,
    ValidationError,
    field_validator,
    model_validator,
)

from contactbench import __version__
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.session.journal import JournalError, JournalFrame, SessionError, canonical

SCHEMA, VERSION = "contactbench.session", 2

Sha256 = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{64}$")]
_WORD = r"^[a-z][a-z0-9_-]{0,63}$"
Word = Annotated[str, StringConstraints(pattern=_WORD)]
Text = Annotated[str, StringConstraints(max_length=10_000)]
Short = Annotated[str, StringConstraints(min_length=1, max_length=200)]
# What no file system takes for a path, a drive, a stream or a hidden file.
_NAME = r'^[^./\\:*?"<>|\x00-\x1f\x7f][^/\\:*?"<>|\x00-\x1f\x7f]{0,199}$'
Name = Annotated[str, StringConstraints(pattern=_NAME)]
# Pattern -> what it asks for, for people.
_RULES = {
    _WORD: message(
        "must begin with a small letter and contain only small letters, digits, - and _, at most 64"
    ),
    _NAME: message(
        'must have 1 to 200 characters, no control characters and none of / \\\\ : * ? " < > |, and'
        " must not begin with a dot"
    ),
}
Place = Annotated[
    str, StringConstraints(pattern=r"^(raw|meshes|results)/[0-9a-f]{12}-[A-Za-z0-9_-][A-Za-z0-9._-]{0,119}$")
]
_A = TypeVar("_A", bound=BaseModel)

TOOL = f"contactbench {__version__}"


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class FileRef(_Part):
    """A file of the session: where it lies in the folder, and what must be in it."""

    path: Place
    sha256: Sha256
    size: Annotated[int, Field(ge=0)]


# Stands for a file while all else of an action is checked, before the file is copied.
NOWHERE = FileRef(path="raw/000000000000-_", sha256="0" * 64, size=0)


class Origin(_Part):
    """The journal that this one was migrated from."""

    version: int
    sha256: Sha256


class SessionCreated(_Part):
    """Always the first."""

    type: Literal["session_created"] = "session_created"
    schema_id: Literal["contactbench.session"] = "contactbench.session"
    version: Annotated[int, Field(ge=0)] = VERSION
    id: Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{32}$")]
    migrated_from: Origin | None = None


class _WithCompanions(_Part):
    """A file, and those that lay beside it under names that it is read with, such as a probe's JSON."""

    name: Name
    file: FileRef
    companions: Annotated[dict[Name, FileRef], Field(max_length=100)] = {}

    @model_validator(mode="after")
    def _names_differ(self) -> Self:
        names = [self.name, *self.companions]
        if len({name.casefold() for name in names}) < len(names):
            raise ValueError(message("two files of one input have the same name"))
        return self


class InputAdded(_WithCompanions):
    """A raw input; one of the same kind and name, but of other content, takes its place."""

    type: Literal["input_added"] = "input_added"
    kind: Word
    sensor: Short | None = None
    about: dict[Short, JsonValue] = {}


class MeshChanged(_WithCompanions):
    """The probe's mesh from now on."""

    type: Literal["mesh_changed"] = "mesh_changed"


class ParameterSet(_Part):
    """A setting; ``kind.parameter`` is one that results of that kind are computed with."""

    type: Literal["parameter_set"] = "parameter_set"
    key: Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_-]{0,63}\.[a-z][a-zA-Z0-9_-]{0,63}$")]
    value: JsonValue


class ResultAdded(_Part):
    """A result and all that it follows from. `inputs`: role -> hash of an input, a mesh or another result."""

    type: Literal["result_added"] = "result_added"
    kind: Word
    name: Name
    files: Annotated[dict[Name, FileRef], Field(min_length=1, max_length=100)]
    inputs: Annotated[dict[Word, Sha256], Field(max_length=1000)]
    parameters: dict[Short, JsonValue]
    created: Short | None = None


class ResultMarked(_Part):
    """What a person says of a result; the newest one of this kind and name is meant."""

    type: Literal["result_marked"] = "result_marked"
    kind: Word
    name: Name
    mark: Literal["accepted", "rejected", "stale"]
    reason: Text = ""


class Note(_Part):
    """Words."""

    type: Literal["note"] = "note"
    text: Text


class DeviceRezeroed(_Part):
    """The sensor's zero was moved, on the device or by its owner; the session only hears of it."""

    type: Literal["device_rezeroed"] = "device_rezeroed"
    sensor: Short
    reason: Text = ""


Action = (
    SessionCreated
    | InputAdded
    | MeshChanged
    | ParameterSet
    | ResultAdded
    | ResultMarked
    | Note
    | DeviceRezeroed
)


class JournalEntry(_Part):
    """An action with who, when (UTC, ISO 8601), with which tool and which sensor."""

    at: str
    by: Text
    tool: Short
    sensor: Short | None = None
    action: Annotated[Action, Field(discriminator="type")]

    @field_validator("at")
    @classmethod
    def _is_utc(cls, value: str) -> str:
        time = datetime.fromisoformat(value)
        if time.utcoffset() != timedelta(0):
            raise ValueError(message("is not a time in UTC"))
        return value


@dataclass(frozen=True)
class Record:
    """An entry in its place."""

    number: int  # From 1
    hash: str  # Of the chain up to here, 64 hexadecimal digits
    entry: JournalEntry

    @property
    def action(self) -> Action:
        """What happened."""
        return self.entry.action


def files_of(action: Action) -> tuple[FileRef, ...]:
    """Return the files that an action refers to; the main one of an input comes first."""
    if isinstance(action, InputAdded | MeshChanged):
        return (action.file, *action.companions.values())
    return tuple(action.files.values()) if isinstance(action, ResultAdded) else ()


def payload_of(entry: JournalEntry) -> bytes:
    """Return an entry as canonical JSON."""
    return canonical(entry.model_dump(mode="json"))


def parse_payload(payload: bytes, number: int) -> dict[str, Any]:
    """Return the JSON object of a record; JournalError if it holds none."""
    try:
        value = json.loads(payload)
    except (ValueError, RecursionError) as error:
        raise JournalError(
            f"record {arg(number)} contains invalid JSON ({arg(error)}): restore the session from a backup."
        ) from error
    if not isinstance(value, dict):
        raise JournalError(f"record {arg(number)} is not a JSON object: restore the session from a backup.")
    return value


def read_entry(value: dict[str, Any], number: int) -> JournalEntry:
    """Return the entry that a JSON object is; JournalError, with the field, if it is none."""
    try:
        entry = JournalEntry.model_validate(value)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = ".".join(map(str, first["loc"]))
        raise JournalError(
            f"record {arg(number)}: {arg(where)}: {arg(first['msg'])}: restore the session from a backup, or use"
            " the contactbench that wrote it."
        ) from error
    if isinstance(entry.action, SessionCreated) != (number == 1):
        raise JournalError(
            f"record {arg(number)}: session_created must be the first record and appear only once."
        )
    return entry


def records_of(found: tuple[JournalFrame, ...]) -> tuple[Record, ...]:
    """Return the records of frames; JournalError if one is none."""
    return tuple(
        Record(number, frame.chain.hex(), read_entry(parse_payload(frame.payload, number), number))
        for number, frame in enumerate(found, 1)
    )


def main_file(action: ResultAdded) -> str:
    """Return the name of the file that other results refer to: the one named after the result, or the first."""
    return action.name if action.name in action.files else min(action.files)


def content_hash(action: ResultAdded) -> str:
    """SHA-256 over kind, name, inputs, parameters and files: 64 hexadecimal digits. No time goes into it."""
    content = {
        "kind": action.kind,
        "name": action.name,
        "inputs": action.inputs,
        "parameters": action.parameters,
        "files": {name: file.sha256 for name, file in action.files.items()},
    }
    return hashlib.sha256(canonical(content)).hexdigest()


def input_hash(file: FileRef, companions: Mapping[str, FileRef]) -> str:
    """Return what results refer to an input by: its file's SHA-256 or, with companions, one over all of them."""
    if not companions:
        return file.sha256
    content = {
        "file": file.sha256,
        "companions": {name: companion.sha256 for name, companion in companions.items()},
    }
    return hashlib.sha256(canonical(content)).hexdigest()


def checked(action: type[_A], /, **fields: Any) -> _A:
    """Return an action of these fields; SessionError, with the field, if they are wrong."""
    try:
        return action(**fields)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"] if part != "[key]")
        rule = _RULES.get(first.get("ctx", {}).get("pattern", ""), first["msg"])
        raise SessionError(
            f"{arg(where)}: {arg(repr(first['input'])[:100])}: {arg(rule)}: correct it."
        ) from error


def entry(action: Action, by: str, sensor: str | None) -> JournalEntry:
    """Return an action with who, when and with what."""
    at = datetime.now(UTC).isoformat(timespec="microseconds")
    return checked(JournalEntry, at=at, by=by, tool=TOOL, sensor=sensor, action=action)


def user() -> str:
    """Return the name of the computer's user, or a dash."""
    try:
        return getpass.getuser()
    except (KeyError, ImportError, OSError):  # no name for this number; Windows without its variables
        return "-"

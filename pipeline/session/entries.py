"""Entries made from what a caller gives, checked before anything is written."""

from __future__ import annotations

import getpass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any, TypeVar

from pydantic import BaseModel, ValidationError

from contactbench import __version__
from contactbench.pipeline.session.actions import RULES, Entry, FileRef
from contactbench.pipeline.session.errors import SessionError

if TYPE_CHECKING:
    from contactbench.pipeline.session.actions import Action

_A = TypeVar("_A", bound=BaseModel)

TOOL = f"contactbench {__version__}"
# Stands for a file while all else of an action is checked, before the file is copied.
NOWHERE = FileRef(path="raw/000000000000-_", sha256="0" * 64, size=0)


def checked(action: type[_A], /, **fields: Any) -> _A:
    """Return an action of these fields; SessionError, with the field, if they are wrong."""
    try:
        return action(**fields)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"] if part != "[key]")
        rule = RULES.get(first.get("ctx", {}).get("pattern", ""), first["msg"])
        raise SessionError(f"{where}: {first['input']!r:.100}: {rule}: correct it.") from error


def entry(action: Action, by: str, sensor: str | None) -> Entry:
    """Return an action with who, when and with what."""
    at = datetime.now(UTC).isoformat(timespec="microseconds")
    return checked(Entry, at=at, by=by, tool=TOOL, sensor=sensor, action=action)


def user() -> str:
    """Return the name of the computer's user, or a dash."""
    try:
        return getpass.getuser()
    except (KeyError, ImportError, OSError):  # no name for this number; Windows without its variables
        return "-"

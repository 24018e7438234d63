"""What helps to find out what went wrong: versions, log and journal, without data and without names of people."""

import getpass
import json
import os
import platform
import re
import zipfile
from collections import Counter
from dataclasses import asdict
from pathlib import Path
from typing import Any

from contactbench.app.heartbeat import Stalls
from contactbench.app.settings import Remembered
from contactbench.pipeline.commands.info import facts
from contactbench.pipeline.durable import whole_or_raise
from contactbench.pipeline.errors import InputError, message
from contactbench.pipeline.session import Session, SessionError

_SHORTEST = 3  # a shorter name of a user or computer would blank out parts of words
_ADDRESS = re.compile(r"\b\d{1,3}(?:\.\d{1,3}){3}\b")
_USER_IN_PATH = re.compile(r"((?:/home|/Users|[A-Za-z]:\\Users)[/\\])[^/\\\s\"']+")
_MOST_RECORDS = 2_000


def save_diagnostics(
    file: Path, session: Path | None, log: str, settings: Remembered, stalls: Stalls | None = None
) -> None:
    """
    Write a zip file; `contactbench info` and `contactbench session info` say the same.

    Parameters
    ----------
    file : path
    session : path, optional
        The session that is open; only which actions it had, and its files' sizes, are told.
    log : str
    settings : Remembered
    stalls : Stalls, optional

    Raises
    ------
    InputError
        The file cannot be written.
    """
    content = {
        "info.json": json.dumps(facts(), indent=1, default=str),
        "settings.json": json.dumps(_settings(settings), indent=1),
        "log.txt": log,
        "window.json": json.dumps(None if stalls is None else asdict(stalls)),
    }
    if session is not None:
        content["session.json"] = json.dumps(journal_summary(session), indent=1)
    with (
        whole_or_raise(file, InputError, message("the diagnostics cannot be written")) as stream,
        zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive,
    ):
        for name, text in content.items():
            archive.writestr(name, scrubbed(text, session))


def journal_summary(folder: Path) -> dict[str, Any]:
    """Return which actions a session had, when, and how large its files are; no content and no words of people."""
    try:
        with Session.open(folder, write=False) as session:
            records, stale, notes = session.records, session.stale(), session.notes
    except SessionError as error:
        return {"problem": str(error)}
    rows = [
        {
            "number": each.number,
            "at": each.entry.at,
            "tool": each.entry.tool,
            "what": type(each.action).__name__,
        }
        for each in records[-_MOST_RECORDS:]
    ]
    return {
        "records": len(records),
        "kinds": Counter(type(each.action).__name__ for each in records),
        "newest": rows,
        "stale": {f"{kind} {name}": list(why) for (kind, name), why in stale.items()},
        "notes": list(notes),
        "bytes": {
            str(each.relative_to(folder)): each.stat().st_size
            for each in sorted(folder.rglob("*"))
            if each.is_file() and not each.is_symlink()
        },
    }


def scrubbed(text: str, session: Path | None = None) -> str:
    """Replace what names people, computers and places: home, user, host, network addresses, the session's folder."""
    places = [(str(Path.home()), "<home>")]
    if session is not None:
        places = [
            (str(session.absolute()), "<session>"),
            (str(session.absolute().parent), "<folder>"),
            *places,
        ]
    for place, word in places:
        for written in (place, place.replace("\\", "\\\\")):
            if len(written) > _SHORTEST:
                text = text.replace(written, word)
    text = _USER_IN_PATH.sub(r"\1<user>", text)
    for name, word in ((_user(), "<user>"), (platform.node(), "<computer>")):
        if len(name) >= _SHORTEST:
            text = re.sub(rf"(?<![A-Za-z0-9]){re.escape(name)}(?![A-Za-z0-9])", word, text)
    return _ADDRESS.sub("<address>", text)


def _settings(settings: Remembered) -> dict[str, Any]:
    # How many recent sessions there are, and not which.
    return {"theme": settings.theme, "language": settings.language, "recent": len(settings.recent)}


def _user() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):
        return os.environ.get("USERNAME", "")

"""What the window remembers from one start to the next: never anything that belongs to a session."""

import hashlib
import json
import os
import threading
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import platformdirs

from contactbench.pipeline.durable import write_durably

VERSION = 1
_MOST_RECENT = 10
_HOME = "CONTACTBENCH_HOME"  # a folder for settings, logs and sessions, instead of the computer's own places


@dataclass(frozen=True)
class Recent:
    """A session that was open."""

    folder: str
    opened: str = ""  # When, ISO 8601, UTC
    page: str = ""  # The step that was shown
    done: str = ""  # How far it was, for people
    camera: str = ""  # How the scene was looked at, JSON


@dataclass(frozen=True)
class Remembered:
    """What is in the file."""

    theme: str = "system"  # "system", "light" or "dark"
    language: str = ""  # Such as "de"; empty: the computer's
    # geometry, docks: Of the window, as Qt gives them, in base 64
    geometry: str = ""
    docks: str = ""
    recent: tuple[Recent, ...] = field(default_factory=tuple)  # Newest first


def own_folder(kind: str) -> Path:
    """Return the folder for "config", "log" or "sessions", which need not exist."""
    if home := os.environ.get(_HOME):
        return Path(home) / kind
    if kind == "config":
        return platformdirs.user_config_path("contactbench", appauthor=False)
    if kind == "log":
        return platformdirs.user_log_path("contactbench", appauthor=False)
    return platformdirs.user_documents_path() / "contactbench"


class WindowSettings:
    """
    The file with what is remembered. One that is missing, damaged or of another version counts as empty.

    Parameters
    ----------
    folder : path, optional
        Left out: the computer's place for such files.

    Attributes
    ----------
    sessions : path
        Where new sessions are offered to be made.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self.file = (folder or own_folder("config")) / "window.json"
        self.sessions = own_folder("sessions")
        self.now, self._lock = _read(self.file), threading.Lock()

    def change(self, *, write: bool = True, **values: Any) -> None:
        """Remember other values, and write them unless that is done later."""
        self.now = replace(self.now, **values)
        if write:
            self.write()

    def write(self) -> None:
        """Write what is remembered, in any thread; a disk that fails is no reason to stop working."""
        with self._lock:
            content = {"version": VERSION, **asdict(self.now)}
            try:
                self.file.parent.mkdir(parents=True, exist_ok=True)
                write_durably(self.file, json.dumps(content, indent=1).encode())
            except OSError:
                return

    def opened(self, folder: Path, page: str, done: str, camera: str = "", *, write: bool = True) -> None:
        """Put a session first among the recent ones."""
        place = str(folder.absolute())
        new = Recent(place, datetime.now(UTC).isoformat(timespec="seconds"), page, done, camera)
        others = [each for each in self.now.recent if each.folder != place]
        self.change(write=write, recent=(new, *others)[:_MOST_RECENT])

    def picture_of(self, folder: Path) -> Path:
        """Return the file with the picture of a recent session; it need not exist."""
        name = hashlib.sha256(str(folder.absolute()).encode()).hexdigest()[:16]
        return self.file.parent / "pictures" / f"{name}.png"

    def keep_picture(self, folder: Path, png: bytes) -> None:
        """Keep the picture of a session, and those of the other recent ones; a disk that fails loses only that."""
        file, recent = (
            self.picture_of(folder),
            {self.picture_of(Path(each.folder)) for each in self.now.recent},
        )
        with suppress(OSError):
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(png)
            for other in file.parent.glob("*.png"):
                if other not in recent:
                    other.unlink()

    def recent_of(self, folder: Path) -> Recent:
        """Return what is remembered of a session; where nothing is, its texts are empty."""
        place = str(folder.absolute())
        return next((each for each in self.now.recent if each.folder == place), Recent(place))


def _read(file: Path) -> Remembered:
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return Remembered()
    if not isinstance(content, dict) or content.get("version") != VERSION:
        return Remembered()
    texts = {name: content.get(name) for name in ("theme", "language", "geometry", "docks")}
    known = {name: value for name, value in texts.items() if isinstance(value, str)}
    rows = content.get("recent")
    recent = tuple(_recent(row) for row in rows if isinstance(row, dict)) if isinstance(rows, list) else ()
    return Remembered(**known, recent=tuple(each for each in recent if each.folder))


def _recent(row: dict[str, Any]) -> Recent:
    return Recent(*(str(row.get(name, "")) for name in ("folder", "opened", "page", "done", "camera")))

"""
What was made of a mesh before, in the user's cache folder: the same mesh and settings need no second wait.

An entry is found by a hash of all that has a say: the bytes that went in, the settings, and the versions of
contactbench and of the libraries. One that is lost, damaged or foreign costs no more than doing the work again.

``CONTACTBENCH_CACHE`` names another folder; ``off``: nothing is kept, and nothing is looked for.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import platform
import stat
import sys
import threading
import time
import warnings
from collections import OrderedDict
from functools import cache
from importlib.metadata import distributions
from pathlib import Path
from typing import TYPE_CHECKING, Any

import contactbench
from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.installation import component_folders
from contactbench.pipeline.preparation.cache_entry import EntryError, decode, encode

if TYPE_CHECKING:
    from collections.abc import Callable

VARIABLE = "CONTACTBENCH_CACHE"
_OFF = "off"
_SUFFIX = ".kept"
_MOST_BYTES = 512 * 2**20  # of all entries; those that were used longest ago go first
_LARGEST = 64 * 2**20  # of one
_STALE_S = 3600.0  # nobody writes for so long
_MOST_HELD = 2
_LIBRARIES = ("numpy", "scipy", "manifold3d", "pymeshlab", "libigl")

_held: OrderedDict[str, tuple[Any, ...]] = OrderedDict()
_lock = threading.Lock()


def made_once(
    given: Callable[[], object],
    make: Callable[[], tuple[Any, ...]],
    types: tuple[Any, ...],
    *,
    held: bool = False,
) -> tuple[Any, ...]:
    """
    Return what was made before of the same, or make it.

    Parameters
    ----------
    given : callable
        Returns what decides the result, as JSON values; bytes by their hash. Asked again at the end: what was made of
        files that changed meanwhile is not kept.
    make : callable
        Makes the values: of the classes in `cache_entry`, or plain ones.
    types : tuple of type
        Of the values, each, as in an annotation.
    held : bool
        Whether this process is to hold them, too: they are then the same objects again, and need no folder.
    """
    folder = _folder()
    key = None if folder is None and not held else _key(given)
    if key is None:
        return make()
    with _lock:
        known = _held.get(key)
    if known is not None:
        return known
    file = None if folder is None else folder / f"{key}{_SUFFIX}"
    values = None if file is None else _read(file, key, types)
    if values is None:
        values = make()
        if _key(given) != key:
            return values
        if file is not None:
            _keep(file, encode(key, values))
    if held:
        with _lock:
            _held[key] = values
            while len(_held) > _MOST_HELD:
                _held.popitem(last=False)
    return values


def _folder() -> Path | None:
    said = os.environ.get(VARIABLE, "")
    if said.lower() == _OFF:
        return None
    if said:
        folder = Path(said)
    else:
        from platformdirs import user_cache_path

        folder = user_cache_path("contactbench", appauthor=False) / "preparation"
    try:
        state = folder.stat()
    except OSError:  # it is not there yet, or can be of no use
        return folder
    if _own(state) and (os.name != "posix" or not state.st_mode & (stat.S_IWGRP | stat.S_IWOTH)):
        return folder
    mine = os.name == "posix" and state.st_uid == os.getuid()
    remedy = f"chmod go-w '{folder}'" if mine else message(f"name a folder of your own in {arg(VARIABLE)}")
    warnings.warn(
        message(f"{arg(folder)}: what is kept there is not used, for others can write it: {arg(remedy)}."),
        stacklevel=3,
    )
    return None


def _own(state: os.stat_result) -> bool:
    """Tell whether something is this user's or the system's; only POSIX systems say."""
    return os.name != "posix" or state.st_uid in (0, os.getuid())


def _key(given: Callable[[], object]) -> str | None:
    try:
        said = {"given": given(), "versions": _versions()}
    except OSError:  # a file that cannot be read, or no more: its reader says so, if it matters
        return None
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()


@cache
def _versions() -> dict[str, str]:
    """Return the versions of all that has a say in the result."""
    folders = [*sys.path, *map(str, component_folders("meshlab"))]
    installed = {}
    for name in _LIBRARIES:
        found = next(iter(distributions(name=name, path=folders)), None)
        installed[name] = "" if found is None else found.version
    return {
        **installed,
        "contactbench": contactbench.__version__,
        "modules": _modules(),
        "python": platform.python_version(),
        "machine": f"{sys.platform} {platform.machine()}",
    }


def _modules() -> str:
    """Return a hash that changes with the modules of a checkout: there the version stays while they are worked on."""
    root = Path(contactbench.__file__).parent / "pipeline"
    stated = hashlib.sha256()
    for file in sorted(root.rglob("*.py")):
        state = file.stat()
        stated.update(f"{file.relative_to(root)} {state.st_size} {state.st_mtime_ns}\n".encode())
    from contactbench.pipeline import kernel

    compiled = Path(sys.modules[kernel.Geodesic.__module__].__file__ or "")
    if compiled.is_file():
        stated.update(f"{compiled.stat().st_size} {compiled.stat().st_mtime_ns}".encode())
    return stated.hexdigest()


def _read(file: Path, key: str, types: tuple[Any, ...]) -> tuple[Any, ...] | None:
    try:
        if not file.is_file():  # a pipe would be waited for
            return None
        with file.open("rb") as opened:
            if not _own(os.fstat(opened.fileno())):  # others could write here once
                return None
            data = opened.read(_LARGEST + 1)
        if len(data) > _LARGEST:
            return None
        values = decode(data, key, types)
    except (OSError, EntryError):
        return None
    with contextlib.suppress(OSError):  # a folder that others filled for us may be read-only
        os.utime(file)
    return values


def _keep(file: Path, data: bytes) -> None:
    """Write an entry, and make room for it; a folder that cannot be written costs only the next wait."""
    if len(data) > _LARGEST:
        return
    with contextlib.suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        for scratch in file.parent.glob(
            f".*{_SUFFIX}.*.tmp"
        ):  # of a writer that was killed, unless it is at it
            if time.time() - scratch.stat().st_mtime > _STALE_S:
                scratch.unlink(missing_ok=True)
        room = _MOST_BYTES - len(data)
        entries = [(each.stat(), each) for each in file.parent.glob(f"*{_SUFFIX}")]
        for state, each in sorted(entries, key=lambda entry: entry[0].st_mtime_ns, reverse=True):
            room -= state.st_size
            if room < 0:
                each.unlink(missing_ok=True)
        write_durably(file, data)

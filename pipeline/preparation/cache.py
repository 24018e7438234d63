"""
What was made of a mesh before, in the user's cache folder: the same mesh and settings need no second wait.

An entry is found by a hash of all that has a say: the bytes that went in, the settings, and the versions of
contactbench and of the libraries. One that is lost, damaged or foreign costs no more than doing the work again.

``CONTACTBENCH_CACHE`` names another folder; ``off``: nothing is kept, and nothing is looked for.

Results of a preparation as bytes and back: a JSON tree of their fields, and the arrays behind it.

Nothing is executed and no length, number or name is believed: the bytes have their own hash in front, only the classes
that are named here are made, and meshes are checked like those of a stranger. The same results give the same bytes.
"""

import builtins
import collections.abc
import contextlib
import hashlib
import io
import json
import math
import os
import platform
import stat
import sys
import threading
import time
import types
import typing
import warnings
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import cache
from importlib.metadata import distributions
from pathlib import Path
from typing import Any, get_args, get_origin, get_type_hints

import numpy as np
import numpy.typing as npt

import contactbench
from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.installation import component_folders
from contactbench.pipeline.mesh import MeshHealth, Probe, arrays
from contactbench.pipeline.mesh.deviation import Deviation
from contactbench.pipeline.mesh.engines.wire import WireError, WireMessage, read_message, write_message
from contactbench.pipeline.mesh.probe import check_faces, check_vertices
from contactbench.pipeline.mesh.regions.facet_graph import MeshEdit
from contactbench.pipeline.mesh.regions.region import Region, RegionSet
from contactbench.pipeline.mesh.regions.transfer import RegionReport
from contactbench.pipeline.mesh.shell import Closing, Shell
from contactbench.pipeline.mesh.shell.result import ClosedOpening
from contactbench.pipeline.mesh.shell.rim import Opening
from contactbench.pipeline.mesh.shell.wrap import ShellFit
from contactbench.pipeline.mesh.sidecar import ProbeFile
from contactbench.pipeline.mesh.simplify import Simplified
from contactbench.pipeline.mesh.soundness import Soundness

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


# ---- results of a preparation as bytes and back --------------------------------------------------


_CLASSES: dict[str, type[Any]] = {
    each.__name__: each
    for each in (
        ClosedOpening,
        Deviation,
        MeshEdit,
        MeshHealth,
        Opening,
        Probe,
        ProbeFile,
        Region,
        RegionReport,
        RegionSet,
        Shell,
        ShellFit,
        Simplified,
        Soundness,
    )
}
# What their annotations name, and is not there when they run.
_NAMES: dict[str, Any] = {**_CLASSES, **vars(arrays), "Mapping": collections.abc.Mapping, "npt": npt}
_NANS = ("normal_deviation_deg",)  # where there is nothing to compare with
_MAGIC = b"contactbench kept 3\n"
_HASH = 32


class EntryError(ValueError):
    """The bytes are no such entry, or it is damaged; nobody is told, for the work is then done again."""


def encode(key: str, values: tuple[Any, ...]) -> bytes:
    """Return the bytes of values that belong to a key; TypeError: one is of a class that is not known here."""
    writer = _Writer()
    tree = {"values": [writer.node(value) for value in values]}
    body = io.BytesIO()
    write_message(body, WireMessage(key, tree, writer.arrays))
    return _MAGIC + hashlib.sha256(body.getvalue()).digest() + body.getvalue()


def decode(data: bytes, key: str, kinds: tuple[Any, ...]) -> tuple[Any, ...]:
    """
    Return the values in bytes that `encode` made for a key; `kinds` are their types, as in annotations.

    Raises
    ------
    EntryError
        The bytes are damaged, belong to another key, or hold values of other types.
    """
    start = len(_MAGIC) + _HASH
    body = io.BytesIO(data[start:])
    if data[: len(_MAGIC)] != _MAGIC or hashlib.sha256(body.getvalue()).digest() != data[len(_MAGIC) : start]:
        raise EntryError
    try:
        read = read_message(body, len(data), len(data), len(data))
        reader = _Reader({} if read is None else read.arrays)
        values = () if read is None else tuple(reader.value(node) for node in read.fields["values"])
    except EntryError:
        raise
    # What is hashed rightly but made wrongly can go wrong in any of these ways.
    except (
        InputError,
        WireError,
        ValueError,
        TypeError,
        LookupError,
        AttributeError,
        RecursionError,
    ) as error:
        raise EntryError from error
    if (
        read is None
        or body.read(1)
        or read.kind != key
        or len(values) != len(kinds)
        or not all(map(_fits, values, kinds))
    ):
        raise EntryError
    return values


class _Writer:
    """Makes the tree; an object that occurs again is only referred to, so that it is one object again later."""

    def __init__(self) -> None:
        self.arrays: dict[str, npt.NDArray[Any]] = {}
        self._known: dict[int, int] = {}
        self._held: list[Any] = []  # a number of an object is its own only as long as it lives

    def node(self, value: Any) -> Any:
        match value:
            case Closing():
                return {"closing": value.value}
            case None | bool() | int() | float() | str():
                return value
            case np.generic():
                return value.item()
            case tuple():
                return {"tuple": [self.node(each) for each in value]}
            case list():
                return [self.node(each) for each in value]
            case dict():
                return {"map": [[self.node(name), self.node(each)] for name, each in value.items()]}
        if id(value) in self._known:
            return {"again": self._known[id(value)]}
        node = self._array(value) if isinstance(value, np.ndarray) else self._object(value)
        self._known[id(value)] = len(self._held)
        self._held.append(value)
        return node

    def _array(self, value: npt.NDArray[Any]) -> Any:
        name = str(len(self.arrays))
        self.arrays[name] = value
        return {"array": name, "writable": value.flags.writeable}

    def _object(self, value: Any) -> Any:
        name = type(value).__name__
        if _CLASSES.get(name) is not type(value) or not is_dataclass(value):
            raise TypeError(f"{name} cannot be kept")
        return {"class": name, "fields": [self.node(getattr(value, each.name)) for each in fields(value)]}


class _Reader:
    """Makes the values again, in the order in which they were written."""

    def __init__(self, arrays: dict[str, npt.NDArray[Any]]) -> None:
        self._arrays = arrays
        self._held: list[Any] = []

    def value(self, node: Any) -> Any:
        match node:
            case None | bool() | int() | float() | str():
                return node
            case list():
                return [self.value(each) for each in node]
            case {"tuple": parts}:
                return tuple(self.value(each) for each in parts)
            case {"map": pairs}:
                return {self.value(name): self.value(each) for name, each in pairs}
            case {"closing": way}:
                return Closing(way)
            case {"again": int(number)} if number >= 0:
                return self._held[number]
            case {"array": str(name), "writable": bool(writable)}:
                made: Any = self._arrays[name]
                made.flags.writeable = writable
            case {"class": str(name), "fields": parts}:
                made = self._object(_CLASSES[name], [self.value(each) for each in parts])
            case _:
                raise EntryError
        self._held.append(made)
        return made

    def _object(self, kind: type[Any], parts: list[Any]) -> Any:
        hints = get_type_hints(kind, localns=_NAMES)
        given = dict(zip((each.name for each in fields(kind)), parts, strict=True))
        if not all(_fits(each, hints[name], finite=name not in _NANS) for name, each in given.items()):
            raise EntryError
        made = kind(**given)
        if not _consistent(made):
            raise EntryError
        return made


def _fits(value: Any, hint: Any, *, finite: bool = True) -> bool:
    """Tell whether a value is what an annotation says; floats are numbers, and finite."""
    origin, parts = get_origin(hint), get_args(hint)
    match origin or hint:
        case builtins.float:
            return type(value) in (float, int) and (not finite or math.isfinite(value))
        case builtins.int | builtins.bool | builtins.str:
            return type(value) is hint
        case types.UnionType | typing.Union:
            return any(_fits(value, each) for each in parts)
        case typing.Literal:
            return value in parts
        case collections.abc.Mapping:
            return isinstance(value, dict) and all(
                _fits(name, parts[0]) and _fits(each, parts[1]) for name, each in value.items()
            )
        case builtins.tuple if parts:  # of any length
            return isinstance(value, tuple) and all(_fits(each, parts[0]) for each in value)
        case np.ndarray if parts:
            return (
                isinstance(value, np.ndarray)
                and value.dtype == get_args(parts[1])[0]
                and (not finite or bool(np.isfinite(value).all()))
            )
        case typing.Any:
            return True
    return isinstance(value, origin or hint)


def _consistent(made: Any) -> bool:
    """Tell whether the shapes and the indices of an object's arrays are those of its surface."""
    match made:
        case Probe():
            check_faces(made.faces, len(check_vertices(made.vertices)))
            return made.region.shape == made.invented.shape == made.faces.shape[:1]
        case ProbeFile():
            return made.regions.labels.shape == made.probe.region.shape
        case Opening():
            shapes = made.rim.shape[1:], made.centre.shape, made.axes.shape
            return shapes == ((3,), (3,), (3, 3))
        case Soundness():
            lists = (made.nested_facets, made.pinched_vertices, made.flat_facets, made.folded_facets)
            lines = (*lists, made.kinds, made.normal_deviation_deg)
            return all(each.ndim == 1 for each in lines) and made.pairs.shape == (len(made.kinds), 2)
        case (
            Shell(soundness=Soundness() as found, probe=probe)
            | Simplified(soundness=Soundness() as found, probe=probe)
        ):
            of_facets = (found.nested_facets, found.flat_facets, found.folded_facets, found.pairs)
            indices: list[tuple[npt.NDArray[Any], int]] = [(each, len(probe.faces)) for each in of_facets]
            indices.append((found.pinched_vertices, len(probe.vertices)))
            return len(found.normal_deviation_deg) == len(probe.faces) and all(
                ((each >= 0) & (each < count)).all() for each, count in indices
            )
    return True

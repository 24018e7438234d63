"""
Results of a preparation as bytes and back: a JSON tree of their fields, and the arrays behind it.

Nothing is executed and no length, number or name is believed: the bytes have their own hash in front, only the classes
that are named here are made, and meshes are checked like those of a stranger. The same results give the same bytes.
"""

from __future__ import annotations

import hashlib
import json
import struct
from dataclasses import fields, is_dataclass
from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import MeshHealth, Probe
from contactbench.pipeline.mesh.deviation import Deviation
from contactbench.pipeline.mesh.probe import check_faces, check_vertices
from contactbench.pipeline.mesh.regions import Region, RegionReport, RegionSet
from contactbench.pipeline.mesh.shell import Closing, Shell
from contactbench.pipeline.mesh.shell.fit import ShellFit
from contactbench.pipeline.mesh.shell.openings import Opening
from contactbench.pipeline.mesh.shell.result import ClosedOpening
from contactbench.pipeline.mesh.sidecar import ProbeFile
from contactbench.pipeline.mesh.simplify import Simplified
from contactbench.pipeline.mesh.soundness import Soundness

if TYPE_CHECKING:
    import numpy.typing as npt

_CLASSES: dict[str, type[Any]] = {
    each.__name__: each
    for each in (
        ClosedOpening,
        Deviation,
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
_DTYPES = ("<f8", "<i8", "<i4", "|i1", "|u1", "|b1")
_MAGIC = b"contactbench kept 1\n"
_HASH = 32
_LENGTH = struct.Struct("<I")


class EntryError(ValueError):
    """The bytes are no such entry, or it is damaged; nobody is told, for the work is then done again."""


def encode(key: str, values: tuple[Any, ...]) -> bytes:
    """Return the bytes of values that belong to a key; TypeError: one is of a class that is not known here."""
    writer = _Writer()
    tree = {"key": key, "values": [writer.node(value) for value in values], "arrays": writer.layout}
    text = json.dumps(tree, separators=(",", ":")).encode()
    body = b"".join((_LENGTH.pack(len(text)), text, *writer.data))
    return _MAGIC + hashlib.sha256(body).digest() + body


def decode(data: bytes, key: str, types: tuple[type[Any], ...]) -> tuple[Any, ...]:
    """
    Return the values in bytes that `encode` made for a key.

    Raises
    ------
    EntryError
        The bytes are damaged, belong to another key, or hold values of other types.
    """
    start = len(_MAGIC) + _HASH
    body = memoryview(data)[start:]
    if data[: len(_MAGIC)] != _MAGIC or hashlib.sha256(body).digest() != data[len(_MAGIC) : start]:
        raise EntryError
    try:
        (length,) = _LENGTH.unpack_from(body)
        text, rest = bytes(body[_LENGTH.size : _LENGTH.size + length]), body[_LENGTH.size + length :]
        tree = json.loads(text)
        reader = _Reader(tree["arrays"], rest)
        values = tuple(reader.value(node) for node in tree["values"])
        named = tree["key"]
    except EntryError:
        raise
    # What is hashed rightly but made wrongly can go wrong in any of these ways.
    except (
        InputError,
        struct.error,
        ValueError,
        TypeError,
        LookupError,
        AttributeError,
        RecursionError,
    ) as error:
        raise EntryError from error
    if named != key or len(values) != len(types) or not all(map(isinstance, values, types)):
        raise EntryError
    return values


class _Writer:
    """Makes the tree; an object that occurs again is only referred to, so that it is one object again later."""

    def __init__(self) -> None:
        self.layout: list[tuple[str, tuple[int, ...], bool]] = []
        self.data: list[bytes] = []
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
        array = np.ascontiguousarray(value, dtype=value.dtype.newbyteorder("<"))
        if array.dtype.str not in _DTYPES:
            raise TypeError(f"an array of {array.dtype} cannot be kept")
        self.layout.append((array.dtype.str, value.shape, bool(value.flags.writeable)))
        self.data.append(array.tobytes())
        return {"array": len(self.layout) - 1}

    def _object(self, value: Any) -> Any:
        name = type(value).__name__
        if _CLASSES.get(name) is not type(value) or not is_dataclass(value):
            raise TypeError(f"{name} cannot be kept")
        return {"class": name, "fields": [self.node(getattr(value, each.name)) for each in fields(value)]}


class _Reader:
    """Makes the values again, in the order in which they were written."""

    def __init__(self, layout: Any, data: memoryview) -> None:
        self._arrays: list[npt.NDArray[Any]] = []
        for dtype, shape, writable in layout:
            if dtype not in _DTYPES or not all(type(n) is int and n >= 0 for n in shape):
                raise EntryError
            size = np.dtype(dtype).itemsize * prod(shape)
            if size > len(data):
                raise EntryError
            array = (
                np.frombuffer(data[:size], dtype=dtype)
                .reshape(shape)
                .astype(np.dtype(dtype).newbyteorder("="))
            )
            array.flags.writeable = bool(writable)
            self._arrays.append(array)
            data = data[size:]
        if len(data):
            raise EntryError
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
            case {"array": int(number)} if number >= 0:
                made: Any = self._arrays[number]
            case {"class": str(name), "fields": parts}:
                made = self._object(_CLASSES[name], [self.value(each) for each in parts])
            case _:
                raise EntryError
        self._held.append(made)
        return made

    def _object(self, kind: type[Any], parts: list[Any]) -> Any:
        names = [each.name for each in fields(kind)]
        made = kind(**dict(zip(names, parts, strict=True)))
        if isinstance(made, Probe):
            check_faces(made.faces, len(check_vertices(made.vertices)))
            if not made.region.shape == made.invented.shape == made.faces.shape[:1]:
                raise EntryError
        return made

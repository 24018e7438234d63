"""
What the readers share: the bare mesh that every format ends as, text and the numbers in it, and the limits.

A reader checks the structure of the bytes before it takes numbers from them, and holds no more than a small
multiple of the file in memory: numbers go to compact arrays as they are read, and counting stops at a limit.
"""

from __future__ import annotations

import codecs
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.mesh.monitor import NOBODY, Monitor

if TYPE_CHECKING:
    from array import array

    from contactbench.pipeline.mesh.arrays import Floats, Longs
    from contactbench.pipeline.mesh.load import Units

# Four times what the whole chain is meant for. A polygon of a text file turns two bytes into a facet, so the
# file's size alone does not bound the memory that its facets take.
LARGEST_FACETS = 4_000_000

# The vertices of one corner differ by float32 rounding between facets, 6e-8 of the coordinate.
MERGE = 1e-7

# No two parts can match the same text, so that a megabyte of digits or spaces costs no more than a megabyte.
NUMBER = rb"[+-]?(?:(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?|(?i:nan|inf(?:inity)?))"

_COMMA_NUMBER = re.compile(rb"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")
_COMMA = re.compile(rb"[+-]?[\d.]*,[\d.,]*(?:[eE][+-]?\d+)?")
# One thousand two hundred, or 1.2 with three decimals: nobody can tell.
_THOUSANDS = re.compile(rb"[+-]?[1-9]\d{0,2},\d{3}")


@dataclass(frozen=True)
class Reading:
    """How a file is to be read."""

    tolerance: float = 2e-5  # m: of curved surfaces
    monitor: Monitor = field(default=NOBODY, compare=False)  # while another process reads


@dataclass(frozen=True, eq=False)
class RawMesh:
    """
    What a file holds, unchecked beyond its structure.

    Attributes
    ----------
    vertices : (n, 3) float64
        In the file's unit and frame P.
    faces : (m, 3) int64
        May be out of range.
    region : (m,) int64 or None
        Priority per facet, where the file holds one.
    settled : bool
        Written by `save_probe`: merged and cleaned already, to be taken as it is.
    invented : (m,) int64 or None
        1 for facets that the original did not hold, where the file says so.
    stated : {"mm", "m", "cm", "in"} or None
        The unit of the numbers, where the file must state it.
    untouchable : tuple of int
        Regions that nothing can touch, where the file says so.
    notes : tuple of str
        What was repaired or left out while it was read, in sentences.
    axes : tuple of str
        What is to be known of its axes, in sentences, see `up`.
    """

    vertices: Floats
    faces: Longs
    region: Longs | None = None
    settled: bool = False
    invented: Longs | None = None
    stated: Units | None = None
    untouchable: tuple[int, ...] = ()
    notes: tuple[str, ...] = ()
    axes: tuple[str, ...] = ()


def plain_text(data: bytes) -> bytes:
    """Give a text in bytes that begin with ASCII, without a byte order mark, its lines ended by a line feed."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        data = data.decode("utf-16", errors="replace").encode()
    data = data.removeprefix(codecs.BOM_UTF8)
    return data.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in data else data


def decimal_points(text: bytes, row: re.Pattern[bytes]) -> tuple[bytes, tuple[str, ...]]:
    """
    Turn decimal commas into points, where every comma can be nothing else.

    Parameters
    ----------
    text : bytes
    row : re.Pattern
        Matches what holds numbers between blanks.

    Returns
    -------
    text : bytes
        As it was, where a number has a point, or a comma that may set thousands apart.
    notes : tuple of str
        A sentence where commas were turned.
    """
    if b"," not in text:
        return text, ()
    certain = False
    for found in row.finditer(text):
        for token in found.group().split():
            if b"," in token:
                if _COMMA_NUMBER.fullmatch(token) is None:
                    return text, ()
                certain = certain or _THOUSANDS.fullmatch(token) is None
            elif b"." in token:
                return text, ()
    if not certain:
        return text, ()
    note = message("The file's numbers have decimal commas, which were read as decimal points.")
    return row.sub(lambda found: found.group().replace(b",", b"."), text), (note,)


def broken(where: str, row: bytes, why: str) -> MeshError:
    """Say why a row of text cannot be read; its commas, where it has any, are the cause."""
    comma = next((word.decode("latin-1")[:20] for word in row.split() if _COMMA.fullmatch(word)), None)
    if comma is None:
        return MeshError(why)
    return MeshError(
        f"{arg(where)} has the number {arg(comma)!r}, whose comma may be a decimal point or a thousands"
        " separator: export the file again with decimal points."
    )


def up(axis: str) -> tuple[str, ...]:
    """Say that coordinates stay as they are where an axis other than z points up: RViz does so, Blender turns them."""
    note = message(f"The file's {arg(axis)} axis points up: coordinates are used as they are, as RViz does.")
    return () if axis == "z" else (note,)


def points(coordinates: array[float]) -> Floats:
    """View a flat array of coordinates as (n, 3) points, without a copy."""
    return np.frombuffer(coordinates, dtype=np.float64).reshape(-1, 3)


def refuse_too_many(facet_count: int) -> None:
    """
    Refuse a number of facets whose arrays could fill the memory.

    Raises
    ------
    MeshError
        More than four million.
    """
    if facet_count > LARGEST_FACETS:
        raise MeshError(
            f"the file has more than {arg(LARGEST_FACETS)} facets: export the part with fewer. A"
            " tolerance of 0.01 mm is finer than any probe needs."
        )

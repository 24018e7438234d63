"""Which unit a mesh file's numbers are in: from what the file says, and from what size a probe can have."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Literal, get_args

from contactbench.pipeline.mesh.errors import MeshError
from contactbench.pipeline.mesh.probe import LARGEST_M, SMALLEST_M

Units = Literal["m", "cm", "mm", "in"]

# Metres per unit as a fraction: 120 / 1000 is the float nearest to 0.12, 120 * 0.001 need not be.
METRES: dict[Units, tuple[int, int]] = {"m": (1, 1), "cm": (1, 100), "mm": (1, 1000), "in": (127, 5000)}

NAMES: dict[Units, str] = {"mm": "millimetres", "m": "metres", "cm": "centimetres", "in": "inches"}

# How often CAD programs and scanners write them.
_USUAL: tuple[Units, ...] = ("mm", "m", "cm", "in")

# A probe's largest extent is nearly always between these.
LIKELY_M = (0.03, 0.6)
_TYPICAL_M = 0.07

# Metres up to which a thing of that extent is called so.
_CALLED = (
    (0.0005, "a speck of dust"), (0.005, "a grain of rice"), (0.03, "a button"), (0.6, "a probe"),
    (2.0, "a table"), (6.0, "a car"), (200.0, "a house"), (1000.0, "a street"), (float("inf"), "a town"),
)  # fmt: skip

_WORDS = (
    ("mm", rb"mm|millimet(?:er|re)s?"),
    ("cm", rb"cm|centimet(?:er|re)s?"),
    ("in", rb"inch(?:es)?"),
    ("m", rb"met(?:er|re)s?"),
)
# "in" and "m" alone are a word and a letter, so they count only where a unit is announced.
_ANNOUNCED = re.compile(rb"\b(?:file[ _-]?)?units?[ \t]*(?:[:=]|\bis\b|\bare\b)?[ \t]*(mm|cm|m|in)\b", re.I)
_NOTED = 2**16


@dataclass(frozen=True)
class UnitGuess:
    """
    The unit that a file's numbers are most likely in.

    Attributes
    ----------
    units : {"mm", "m", "cm", "in"}
        The best guess.
    certain : bool
        Nothing else makes sense; where False, a person has to say.
    reason : str
        In sentences; where not certain they end in the question.
    alternatives : tuple of units
        Others that are possible, the more usual first.
    """

    units: Units
    certain: bool
    reason: str
    alternatives: tuple[Units, ...]


def notes_in(data: bytes, suffix: str) -> bytes:
    """
    Give the part of a file that is meant for people: comments, or an STL file's header.

    Parameters
    ----------
    data : bytes
        The whole file.
    suffix : str
        ".stl", ".ply", ".obj" or ".off"; another has no such part. ".glb" and ".gltf" are in metres by their
        format, which many programs forget.

    Returns
    -------
    bytes
        At most 64 KiB.
    """
    head = data[:_NOTED]
    match suffix:
        case ".stl":
            return head[:80].partition(b"\n")[0]
        case ".ply":
            header = head.partition(b"end_header")[0]
            return b"\n".join(re.findall(rb"^(?:comment|obj_info)\b(.*)$", header, re.M))
        case ".obj" | ".off":
            return b"\n".join(re.findall(rb"#(.*)", head))
        case ".glb" | ".gltf":
            return b"unit: m"
        case _:
            return b""


def guess_units(
    span: float, *, notes: bytes = b"", farthest: float = 0.0, stated: Units | None = None
) -> UnitGuess:
    """
    Guess the unit of a mesh file's numbers.

    Parameters
    ----------
    span : float
        Largest extent of the surface along an axis, in the file's numbers.
    notes : bytes
        What the file says to people, see `notes_in`.
    farthest : float
        Largest absolute coordinate in the file's numbers: a probe lies within some metres of its origin.
    stated : {"mm", "m", "cm", "in"}, optional
        The unit that the format itself states.

    Returns
    -------
    UnitGuess

    Raises
    ------
    MeshError
        With no unit is the size that of a probe, 5 mm to 2 m.
    """
    if stated is not None:
        return UnitGuess(stated, True, f"The file states that its numbers are {NAMES[stated]}.", ())
    possible = [unit for unit in _USUAL if SMALLEST_M <= in_metres(span, unit) <= LARGEST_M]
    if not possible:
        raise MeshError(
            f"the numbers span {span:.4g}, which is no probe in millimetres, metres, centimetres or inches (5 mm"
            " to 2 m). Check the part that was exported."
        )
    noted = _noted(notes)
    if noted in possible:
        others = tuple(unit for unit in possible if unit != noted)
        reason = f"The file speaks of {NAMES[noted]}, and {_says(span, noted)}."
        return UnitGuess(noted, True, reason, others)
    likely = [unit for unit in possible if LIKELY_M[0] <= in_metres(span, unit) <= LIKELY_M[1]]
    # Where millimetres and metres are out of the question, the size of the usual probe decides.
    likely.sort(key=lambda unit: (unit not in _USUAL[:2], abs(math.log(in_metres(span, unit) / _TYPICAL_M))))
    near = [unit for unit in likely if in_metres(farthest, unit) <= 5 * LARGEST_M]
    ranked = [*near, *(u for u in likely if u not in near), *(u for u in possible if u not in likely)]
    contradiction = "" if noted is None else f" It speaks of {NAMES[noted]}, which cannot be."
    # Few programs write centimetres or inches; alone the size is too little to believe it. And nothing is as sure as
    # that where another unit makes a small probe, or the hub of a needle.
    smaller = any(in_metres(span, unit) < LIKELY_M[0] for unit in possible)
    certain = len(near or likely) == 1 and ranked[0] in ("mm", "m") and noted is None and not smaller
    if certain:
        return UnitGuess(ranked[0], True, _contrast(span, ranked[0]), tuple(ranked[1:]))
    return UnitGuess(ranked[0], False, _question(span, ranked) + contradiction, tuple(ranked[1:]))


def in_metres(length: float, units: Units) -> float:
    """Convert a length in a file's numbers to metres."""
    numerator, denominator = METRES[units]
    return length * numerator / denominator


def _noted(notes: bytes) -> Units | None:
    """Find the one unit that notes speak of; None where they speak of none, or of several."""
    announced = _ANNOUNCED.search(notes)
    if announced:
        word = announced.group(1).decode("ascii").lower()
        return next(unit for unit in get_args(Units) if unit == word)
    found = [
        unit
        for unit, words in _WORDS
        if re.search(rb"(?<![A-Za-z])(?:" + words + rb")(?![A-Za-z])", notes, re.I)
    ]
    return next((unit for unit in get_args(Units) if [unit] == found), None)


def _says(span: float, unit: Units) -> str:
    return f"{_number(span)} {unit} is {_called(in_metres(span, unit))}"


def _contrast(span: float, unit: Units) -> str:
    other: Units = "m" if unit == "mm" else "mm"
    return f"The numbers span {_number(span)}: {_says(span, unit)}, {_says(span, other)}."


def _question(span: float, ranked: list[Units]) -> str:
    lengths = [f"{in_metres(span, unit) * 1000:.4g} mm" for unit in ranked[:3]]
    first, *others = (f"{length} if they are {NAMES[u]}" for length, u in zip(lengths, ranked, strict=False))
    choices = "".join(f", {other}" for other in others) if others else ", an unusual size"
    return (
        f"The numbers span {_number(span)}: the longest side is {first}{choices}."
        f" {NAMES[ranked[0]].capitalize()} are assumed; measure the probe, and say the units if it is not"
        f" {lengths[0]} long."
    )


def _number(span: float) -> str:
    return f"{span:.4g}" if span < 1e5 else f"{span:.0f}"


def _called(metres: float) -> str:
    return next(name for limit, name in _CALLED if metres <= limit)

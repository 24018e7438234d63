"""Which unit a mesh file's numbers are in: from what the file says, and from what size a probe can have."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Literal

from contactbench.pipeline.errors import arg, capitalised, join, message
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

_NAMED: dict[Units, str] = {
    "mm": r"mm|millimet(?:er|re)s?", "cm": r"cm|centimet(?:er|re)s?", "in": r"inch(?:es)?", "m": r"met(?:er|re)s?",
}  # fmt: skip
_WORD = "|".join(_NAMED.values())

# A unit in a comment may be that of a tolerance or a screw: only a declaration tells what the numbers are. "in" and "m"
# alone are a word and a letter, so they count only right after it.
_DECLARED = re.compile(
    r"(?<![a-z])(?:(?:length|linear|file)[ _-]?)?units?(?:[ _-]of[ _-](?:length|measure(?:ment)?))?"
    r"(?:[ \t]*[:=(][ \t]*|[ \t]+(?:is|are)[ \t]+(?:in[ \t]+)?|[ \t]+in[ \t]+|[ \t]+)"
    rf"({_WORD}|(?:m|in)(?![ \t]*[a-z0-9]))(?![a-z])"
    r"|(?<![a-z])(?:exported|saved|written|modelled|drawn|lengths?|dimensions?|coordinates?|vertices|numbers|values)"
    rf"[ \t]+(?:is[ \t]+|are[ \t]+)?(?:given[ \t]+)?in[ \t]+({_WORD})(?![a-z])",
    re.I | re.ASCII,
)  # fmt: skip
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
    usual : tuple of units
        Those that make a probe of usual size. More than one, and not certain: nobody but the user can tell.
    """

    units: Units
    certain: bool
    reason: str
    alternatives: tuple[Units, ...]
    usual: tuple[Units, ...] = ()

    @property
    def doubt(self) -> str:
        """What to say to whoever goes on with the guess; empty where it is certain."""
        return (
            ""
            if self.certain
            else message(f"{arg(self.reason)} {arg(capitalised(NAMES[self.units]))} are assumed.")
        )

    @property
    def must_be_given(self) -> bool:
        """Whether several units are as likely, so that a probe must not be made of a guess."""
        return not self.certain and len(self.usual) > 1


def notes_in(data: bytes, suffix: str) -> bytes:
    """
    Give the part of a file that is meant for people: comments, or an STL file's header.

    Parameters
    ----------
    data : bytes
        The whole file.
    suffix : str
        ".stl", ".ply", ".obj" or ".off"; another has no such part.

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
        case _:
            return b""


def guess_units(
    span: float,
    *,
    notes: bytes = b"",
    farthest: float = 0.0,
    stated: Units | None = None,
    defined: Units | None = None,
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
        The unit that the file itself states.
    defined : {"mm", "m", "cm", "in"}, optional
        The unit that every file of the format should have, which many programs forget.

    Returns
    -------
    UnitGuess

    Raises
    ------
    MeshError
        With no unit is the size that of a probe, 5 mm to 2 m.
    """
    if stated is not None:
        return UnitGuess(
            stated, True, message(f"The file states that its numbers are {arg(NAMES[stated])}."), ()
        )
    possible = [unit for unit in _USUAL if SMALLEST_M <= in_metres(span, unit) <= LARGEST_M]
    if not possible:
        raise MeshError(
            f"the numbers span {arg(span):.4g}, which cannot be a probe in millimetres, metres,"
            " centimetres or inches (5 mm to 2 m). Check that the right part was exported."
        )
    likely = [unit for unit in possible if LIKELY_M[0] <= in_metres(span, unit) <= LIKELY_M[1]]
    # Where millimetres and metres are out of the question, the size of the usual probe decides.
    likely.sort(key=lambda unit: (unit not in _USUAL[:2], abs(math.log(in_metres(span, unit) / _TYPICAL_M))))
    near = [unit for unit in likely if in_metres(farthest, unit) <= 5 * LARGEST_M]
    ranked = [*near, *(u for u in likely if u not in near), *(u for u in possible if u not in likely)]
    usual = tuple(near or likely)
    declared = {defined} if defined else _declared(notes)
    declared = {defined} if defined else _declared(notes)
    if len(declared) == 1:
        (unit,) = declared
        others = tuple(other for other in ranked if other != unit)
        if unit in likely or (unit in possible and not likely):
            return UnitGuess(
                unit, True, message(f"{arg(_declares(unit, defined))}, and {arg(_says(span, unit))}."), others
            )
        said = message(
            f" {arg(_declares(unit, defined))}, but {arg(_unlikely(span, unit, unit in possible))}."
        )
        return UnitGuess(ranked[0], False, _question(span, ranked) + said, tuple(ranked[1:]), usual)
    said = ""
    if declared:
        said = message(
            f" The file declares several units: {arg(', '.join(NAMES[unit] for unit in NAMES if unit in declared))}."
        )
    # Few programs write centimetres or inches; alone the size is too little to believe it. And nothing is as sure as
    # that where another unit makes a small probe, or the hub of a needle.
    smaller = any(in_metres(span, unit) < LIKELY_M[0] for unit in possible)
    if len(usual) == 1 and ranked[0] in ("mm", "m") and not declared and not smaller:
        return UnitGuess(ranked[0], True, _contrast(span, ranked), tuple(ranked[1:]))
    return UnitGuess(ranked[0], False, _question(span, ranked) + said, tuple(ranked[1:]), usual)


def in_metres(length: float, units: Units) -> float:
    """Convert a length in a file's numbers to metres."""
    numerator, denominator = METRES[units]
    return length * numerator / denominator


def _declared(notes: bytes) -> set[Units]:
    """Find the units that notes declare."""
    words = [first or second for first, second in _DECLARED.findall(notes.decode("latin-1"))]
    return {
        unit
        for unit, names in _NAMED.items()
        if any(word.lower() == unit or re.fullmatch(names, word, re.I) for word in words)
    }


def _declares(unit: Units, defined: Units | None) -> str:
    return (
        message(f"glTF is defined in {arg(NAMES[unit])}")
        if defined
        else message(f"The file declares {arg(NAMES[unit])}")
    )


def _unlikely(span: float, unit: Units, possible: bool) -> str:
    size = _size(span, unit)
    if not possible:
        return message(f"{arg(size)} is impossible")
    return (
        message(f"{arg(size)} is small for a probe")
        if in_metres(span, unit) < LIKELY_M[0]
        else message(f"{arg(size)} is large for a probe")
    )


def _says(span: float, unit: Units) -> str:
    return message(f"{arg(_size(span, unit))} is a probe")


def _contrast(span: float, ranked: list[Units]) -> str:
    others = join(
        "",
        (
            message(f"; it is {arg(_millimetres(span, unit))} long if they are {arg(NAMES[unit])}")
            for unit in ranked[1:]
        ),
    )
    return message(f"The numbers span {arg(_number(span))}: {arg(_says(span, ranked[0]))}{arg(others)}.")


def _question(span: float, ranked: list[Units]) -> str:
    first, *others = (
        message(f"{arg(_millimetres(span, unit))} if they are {arg(NAMES[unit])}") for unit in ranked[:3]
    )
    choices = (
        join("", (message(f", {arg(other)}") for other in others)) if others else message(", an unusual size")
    )
    options = ", ".join(ranked[:3])
    options = " or ".join(options.rsplit(", ", 1))
    return message(
        f"The numbers span {arg(_number(span))}: the longest side is {arg(first)}{arg(choices)}."
        f" Measure the probe and give --units {arg(options)}."
    )


def _millimetres(span: float, unit: Units) -> str:
    return f"{in_metres(span, unit) * 1000:.4g} mm"


def _size(span: float, unit: Units) -> str:
    return f"{_number(span)} {unit}"


def _number(span: float) -> str:
    return f"{span:.4g}" if span < 1e5 else f"{span:.0f}"

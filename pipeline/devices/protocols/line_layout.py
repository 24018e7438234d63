"""What stands where in the lines of a text stream: declared by the person who opens it, not guessed."""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from contactbench.pipeline.devices.options import Option, choice, name, whole
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.units import ANGLES, FORCES, LENGTHS, TIMES, TORQUES, unit_factor

WRENCH = ("fx", "fy", "fz", "mx", "my", "mz")
POSITION = ("x", "y", "z")
QUATERNION = ("qw", "qx", "qy", "qz")
TURN = ("rx", "ry", "rz")
JOINTS = tuple(f"q{number}" for number in range(1, 8))
TIME, COUNT, STATUS, IGNORED, REST = "t", "n", "status", "-", "*"
ROLES = (TIME, COUNT, STATUS, *WRENCH, *POSITION, *QUATERNION, *TURN, *JOINTS)
SEPARATORS = {"auto": None, "comma": ",", "semicolon": ";", "tab": "\t", "space": " "}

_MOST_FIELDS = 200
_LONGEST_PATH = 100
_LONGEST_WORDS = 200
_LARGEST_FILE = 64_000
_ESCAPES = {"\\r": "\r", "\\n": "\n", "\\t": "\t", "\\\\": "\\"}

Fields = tuple[tuple[str, str], ...]
"""Role and, for JSON, the path to its value."""


def _read_fields(text: str) -> Fields:
    entries = [entry.strip() for entry in text.split(",")]
    if len(entries) > _MOST_FIELDS:
        raise ValueError(message(f"give at most {arg(_MOST_FIELDS)}"))
    pairs = tuple((role, path) for role, _, path in (entry.partition(":") for entry in entries))
    if len({":" in entry for entry in entries}) > 1:
        raise ValueError(
            message("give names alone for columns, or a key after each, as in fx:force.x, for JSON")
        )
    is_json = ":" in entries[0]
    allowed = ROLES if is_json else (*ROLES, IGNORED, REST)
    for role, path in pairs:
        if role not in allowed:
            raise ValueError(message(f"{arg(role)!r} is unknown: choose from {arg(', '.join(allowed))}"))
        if is_json and not (0 < len(path) <= _LONGEST_PATH and path.isprintable()):
            raise ValueError(message(f"{arg(role)}: give its key, as in {arg(role)}:data.{arg(role)}"))
    used = [role for role, _ in pairs if role != IGNORED]
    twice = next((role for role in used if used.count(role) > 1), None)
    if twice is not None:
        raise ValueError(message(f"{arg(twice)} appears twice"))
    if REST in used[:-1] or (used[-1:] == [REST] and pairs[-1][0] != REST):
        raise ValueError(message(f"{arg(REST)} stands for all columns that follow: put it last"))
    return pairs


def _write_fields(fields: Fields) -> str:
    return ",".join(f"{role}:{path}" if path else role for role, path in fields)


def _unit(units: dict[str, float], what: str) -> Callable[[str], str]:
    """Return the reader of a unit, or of a number of them; it stays as it was typed."""

    def read(text: str) -> str:
        if _factor(units, text) is None:
            raise ValueError(
                message(
                    f"give a unit ({arg(', '.join(units))}) or how many {arg(what)} one is, such as -1 to"
                    " change the sign"
                )
            )
        return text

    return read


def units_of(role: str) -> dict[str, float]:
    """Return the units that a role may have."""
    if role in (*TURN, *JOINTS):
        return ANGLES
    groups = ((FORCES, WRENCH[:3]), (TORQUES, WRENCH[3:]), (LENGTHS, POSITION), (TIMES, (TIME,)))
    return next((units for units, roles in groups if role in roles), {})


def _factor(units: dict[str, float], text: str) -> float | None:
    known = unit_factor(units, text)
    if known is not None:
        return known
    try:
        value = float(text)
    except ValueError:
        return None
    return value if 1e-12 <= abs(value) <= 1e12 else None


def _flipped(text: str) -> tuple[str, ...]:
    names = tuple(part.strip() for part in text.split(","))
    if not set(names) <= set(WRENCH):
        raise ValueError(message(f"give some of {arg(', '.join(WRENCH))}"))
    return names


def _words(text: str) -> str:
    if not 0 < len(text) <= _LONGEST_WORDS or not (text.isascii() and text.isprintable()):
        raise ValueError(
            message(f"give at most {arg(_LONGEST_WORDS)} printable characters; \\r and \\n end a line")
        )
    return text


OPTIONS: Mapping[str, Option] = {
    "fields": Option(
        "What each column is (t,fx,fy,fz,mx,my,mz; - for one to ignore, * for all that follow), or in JSON"
        " each name with its key (t:time,fx:force.0,...).",
        _read_fields,
        write=_write_fields,
    ),
    "layout": Option("TOML or JSON file with these options.", name),
    "separator": Option("Between columns: auto, comma, semicolon, tab or space.", choice(*SEPARATORS)),
    "force": Option("Unit of fx, fy, fz (N), or how many newtons one is.", _unit(FORCES, message("newtons"))),
    "torque": Option(
        "Unit of mx, my, mz (Nm), or how many newton metres one is.", _unit(TORQUES, message("newton metres"))
    ),
    "flip": Option("Channels with the opposite sign, such as fx,fy,fz.", _flipped),
    "time": Option("Unit of t (s), or how many seconds one is.", _unit(TIMES, message("seconds"))),
    "bits": Option(
        "Width of the count n: it runs round after so many bits (32).",
        whole(1, 53, "give a whole number from 1 to 53"),
    ),
    "ok": Option("What status is when all is well (0).", name),
    "length": Option("Unit of x, y, z (m), or how many metres one is.", _unit(LENGTHS, message("metres"))),
    "angle": Option("Unit of angles (rad), or how many radians one is.", _unit(ANGLES, message("radians"))),
    "rotation": Option(
        "What rx, ry, rz are: vector (axis times angle) or rpy (turns about the fixed x, then y, then z axis).",
        choice("vector", "rpy"),
    ),
    "robot": Option("Robot whose joints q1, q2, ... are.", name),
    "listen": Option(
        "UDP port of this computer that the device sends to by itself.",
        whole(1, 65_535, "give a whole number from 1 to 65535"),
    ),
    "start": Option("Text to send before anything comes; \\r and \\n end a line.", _words),
    "stop": Option("Text to send at the end; \\r and \\n end a line.", _words),
}
"""Of an address; without a default, so that what an address leaves out may stand in the layout's file."""


def with_file(values: Mapping[str, Any]) -> dict[str, Any]:
    """
    Return the options with those of the layout's file, which the address overrules; no file is named then.

    Raises
    ------
    ValueError
        The file cannot be read, or an option in it cannot be that.
    """
    given = {key: value for key, value in values.items() if value is not None}
    where = given.pop("layout", None)
    told = {} if where is None else _read_file(where)
    return {**dict.fromkeys(OPTIONS), **told, **given}


def _read_file(where: str) -> dict[str, Any]:
    if not Path(where).is_file():  # a pipe would wait for its writer
        raise ValueError(message(f"layout {arg(where)!r}: there is no such file: give a TOML or JSON file"))
    try:
        with Path(where).open("rb") as file:
            data = file.read(_LARGEST_FILE + 1)
        if len(data) > _LARGEST_FILE:
            raise ValueError(
                message(f"layout {arg(where)!r}: more than {arg(_LARGEST_FILE)} bytes: choose another file")
            )
        text = data.decode("utf-8")
        found: Any = json.loads(text) if where.endswith(".json") else tomllib.loads(text)
    except (OSError, UnicodeDecodeError, json.JSONDecodeError, tomllib.TOMLDecodeError) as error:
        raise ValueError(message(f"layout {arg(where)!r}: {arg(error)}: give a TOML or JSON file")) from error
    read = {}
    for key, value in (found if isinstance(found, dict) else {}).items():
        if key not in OPTIONS or key == "layout":
            raise ValueError(
                message(
                    f"layout {arg(where)!r}: unknown option {arg(key[:80])!r}. Possible: {arg(', '.join(OPTIONS))}"
                )
            )
        text = ",".join(map(str, value)) if isinstance(value, list) else str(value)
        try:
            read[key] = OPTIONS[key].read(text)
        except ValueError as error:
            raise ValueError(
                message(f"layout {arg(where)!r}: {arg(key)} {arg(text[:80])!r}: {arg(error)}")
            ) from error
    return read


def unescaped(text: str | None) -> bytes:
    r"""Return what a text with ``\r``, ``\n`` and ``\t`` stands for."""
    return re.sub(r"\\[rnt\\]", lambda found: _ESCAPES[found[0]], text or "").encode("ascii")


@dataclass(frozen=True)
class Layout:
    """
    What stands where, and in which units.

    Raises
    ------
    ValueError
        Of `of`: the declaration contradicts itself or is not enough; says what to give.
    """

    fields: Fields
    is_json: bool
    separator: str | None  # None: whichever of commas, semicolons and tabs a line has, else blanks
    factors: Mapping[str, float]  # from the number in the line to SI, by role
    bits: int
    ok: str
    rotation: str | None  # of rx, ry, rz
    robot: str | None

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> Layout:
        """Return the layout that an address declares, by its options as `with_file` returns them."""
        fields: Fields | None = options["fields"]
        if not fields:
            raise ValueError(
                message(
                    "fields: say what the columns are, as in fields=t,fx,fy,fz,mx,my,mz, or name a file"
                    " that does with layout"
                )
            )
        units = {
            "force": _factor(FORCES, options["force"] or "N"),
            "torque": _factor(TORQUES, options["torque"] or "Nm"),
            "length": _factor(LENGTHS, options["length"] or "m"),
            "angle": _factor(ANGLES, options["angle"] or "rad"),
            "time": _factor(TIMES, options["time"] or "s"),
        }
        groups = {"force": WRENCH[:3], "torque": WRENCH[3:], "length": POSITION, "time": (TIME,)}
        factors = {role: units[unit] or math.nan for unit, roles in groups.items() for role in roles}
        # A rotation vector's numbers are angles too.
        factors |= dict.fromkeys((*TURN, *JOINTS), units["angle"] or math.nan)
        for role in options["flip"] or ():
            factors[role] = -factors[role]
        made = cls(
            fields,
            bool(fields[0][1]),
            SEPARATORS[options["separator"] or "auto"],
            factors,
            options["bits"] or 32,
            options["ok"] or "0",
            options["rotation"],
            options["robot"],
        )
        made._check()
        return made

    @property
    def roles(self) -> frozenset[str]:
        """What a line tells."""
        return frozenset(role for role, _ in self.fields) - {IGNORED, REST}

    @property
    def gives_wrenches(self) -> bool:
        """Whether a line tells a force and a torque."""
        return self.roles.issuperset(WRENCH)

    @property
    def gives_poses(self) -> bool:
        """Whether a line tells an orientation, or the joints of a robot."""
        return any(self.roles.issuperset(each) for each in (QUATERNION, TURN)) or bool(self.joints)

    @property
    def joints(self) -> tuple[str, ...]:
        """The roles of the joints in their order; empty: none are told."""
        return tuple(role for role in JOINTS if role in self.roles)

    def _check(self) -> None:
        roles = self.roles
        for group in (WRENCH, POSITION, QUATERNION, TURN):
            missing = [role for role in group if role not in roles]
            if missing and len(missing) < len(group):
                raise ValueError(
                    message(f"fields: {arg(', '.join(missing))} missing: give all of {arg(', '.join(group))}")
                )
        if not (self.gives_wrenches or self.gives_poses):
            raise ValueError(
                message(
                    "fields: give fx,fy,fz,mx,my,mz of a sensor, or of a robot qw,qx,qy,qz, rx,ry,rz or q1,q2,..."
                )
            )
        if sum((roles.issuperset(QUATERNION), roles.issuperset(TURN), bool(self.joints))) > 1:
            raise ValueError(message("fields: give one of a quaternion, rx,ry,rz and joints"))
        if roles.issuperset(TURN) != (self.rotation is not None):
            raise ValueError(message("rotation: give vector or rpy with rx,ry,rz, and only with these"))
        if self.joints != JOINTS[: len(self.joints)]:
            raise ValueError(message("fields: joints begin at q1, without a gap"))
        if bool(self.joints) != (self.robot is not None):
            raise ValueError(message("robot: name the robot of q1,q2,..., and only with these"))

"""What a person does at the bench, as values: they are queued, acknowledged, written down and done again."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, ClassVar, Final

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.simulation.scenes.indenter import MOST_BUMP_N, MOST_LEVER_M, TipPress
from contactbench.pipeline.simulation.scenes.physics import SceneMoment

Three = tuple[float, float, float]
_MOST_S = 1e6
_LONGEST_VALUE = 60


class CommandError(InputError):
    """A command that the bench cannot do; the message says why and what to do first."""


@dataclass(frozen=True)
class TurnTo:
    """Turn the wrist."""

    name: ClassVar[str] = "turn_to"
    # degrees about the fixed x, then y, then z axis of the world: how the sensor S stands
    rpy: Three | None = None
    # 3 rows of 3 floats or None: The same as a matrix; one of the two
    R_WS: tuple[Three, Three, Three] | None = None
    seconds: float | None = None  # how long the turn takes; None: at 60 degrees a second

    def __post_init__(self) -> None:
        if (self.rpy is None) == (self.R_WS is None):
            raise CommandError("turn_to: give either rpy (three angles in degrees) or R_WS.")
        if self.rpy is not None:
            object.__setattr__(self, "rpy", _numbers(self, "rpy"))
        else:
            rows = np.asarray(_array(self, "R_WS", (3, 3)))
            if not np.allclose(rows @ rows.T, np.eye(3), atol=1e-6) or np.linalg.det(rows) < 0:
                raise CommandError(
                    "turn_to: R_WS is not a rotation: its rows must be right-handed unit vectors."
                )
            object.__setattr__(self, "R_WS", tuple(tuple(row) for row in rows.tolist()))
        _check_seconds(self)

    @property
    def rotation(self) -> Floats:
        """R_WS, (3, 3)."""
        if self.rpy is None:
            return np.array(self.R_WS)
        return np.asarray(Rotation.from_euler("xyz", self.rpy, degrees=True).as_matrix())


@dataclass(frozen=True)
class TouchCommand:
    """Press a tip on a place of the probe."""

    name: ClassVar[str] = "touch"
    marker: int | None = None  # number of a marker, from 1
    point_S: Three | None = None  # or a place in S, m: the nearest point of the surface is pressed
    # force, tilt, azimuth, torsion: as for `TipPress`: N, degrees, degrees, N·m
    force: float = 9.0
    tilt: float = 0.0
    azimuth: float = 0.0
    torsion: float = 0.0
    seconds: float | None = None  # after which the tip goes away; None: it stays until `Release`

    def __post_init__(self) -> None:
        if (self.marker is None) == (self.point_S is None):
            raise CommandError("touch: give either marker (a number from 1) or point_S (three lengths, m).")
        if self.marker is not None and (isinstance(self.marker, bool) or not isinstance(self.marker, int)):
            raise CommandError(f"touch: marker {arg(self.marker)!r}: give a whole number from 1.")
        if self.point_S is not None:
            object.__setattr__(self, "point_S", _numbers(self, "point_S"))
        for part in ("force", "tilt", "azimuth", "torsion"):
            object.__setattr__(self, part, _number(self, part))
        _ = self.press
        _check_seconds(self)

    @property
    def press(self) -> TipPress:
        """How the tip presses."""
        return TipPress(self.force, self.tilt, self.azimuth, self.torsion)


@dataclass(frozen=True)
class Release:
    """Take the tip away."""

    name: ClassVar[str] = "release"


@dataclass(frozen=True)
class Bump:
    """Push the tool."""

    name: ClassVar[str] = "bump"
    force: Three  # N, in S; at most 1000 N
    seconds: float = 0.2  # for how long
    lever: Three = (0.0, 0.0, 0.1)  # where, in S, m; at most 10 m away

    def __post_init__(self) -> None:
        object.__setattr__(self, "force", _numbers(self, "force"))
        object.__setattr__(self, "lever", _numbers(self, "lever"))
        if self.seconds is None:
            raise CommandError("bump: seconds null: give a positive number, or leave it out.")
        if math.hypot(*self.force) > MOST_BUMP_N:
            raise CommandError(
                f"bump: {arg(math.hypot(*self.force)):g} N: give at most {arg(MOST_BUMP_N):g} N."
            )
        if math.hypot(*self.lever) > MOST_LEVER_M:
            raise CommandError(
                f"bump: a lever of {arg(math.hypot(*self.lever)):g} m: give at most {arg(MOST_LEVER_M):g} m."
            )
        _check_seconds(self)


@dataclass(frozen=True)
class Warm:
    """Let what the sensor stands on get warmer."""

    name: ClassVar[str] = "warm"
    kelvin: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "kelvin", _number(self, "kelvin"))
        if abs(self.kelvin) > 100:
            raise CommandError(f"warm: {arg(self.kelvin):g} K: give at most 100 K either way.")


@dataclass(frozen=True)
class SecretRezero:
    """Zero the sensor behind everybody's back: nothing but the truth tells."""

    name: ClassVar[str] = "rezero"


@dataclass(frozen=True)
class End:
    """End the run."""

    name: ClassVar[str] = "end"


Command = TurnTo | TouchCommand | Release | Bump | Warm | SecretRezero | End
_COMMANDS: Final[dict[str, type[Any]]] = {
    kind.name: kind for kind in (TurnTo, TouchCommand, Release, Bump, Warm, SecretRezero, End)
}


def read_command(given: Mapping[str, object]) -> Command:
    """
    Return the command that fields say, such as ``{"do": "touch", "marker": 3, "force": 9}``.

    Raises
    ------
    InputError
        There is no such command, or a field of it is missing, unknown or impossible.
    """
    name = given.get("do")
    kind = _COMMANDS.get(name) if isinstance(name, str) else None
    if kind is None:
        raise CommandError(f"do {arg(name)!r}: choose one of {arg(', '.join(_COMMANDS))}.")
    known = [field.name for field in fields(kind)]
    values = {key: value for key, value in given.items() if key != "do"}
    for key in values:
        if key not in known:
            raise CommandError(
                f"{arg(name)}: unknown key {arg(key)!r}. Possible: {arg(', '.join(known) or 'nothing')}."
            )
    try:
        command: Command = kind(**values)
    except TypeError as error:
        raise CommandError(f"{arg(name)}: some of these are missing: {arg(', '.join(known))}.") from error
    return command


def command_fields(command: Command) -> dict[str, Any]:
    """Return what `read_command` reads; only what was given."""
    values = {field.name: getattr(command, field.name) for field in fields(command)}
    return {"do": command.name} | {name: value for name, value in values.items() if value is not None}


def _number(command: Any, part: str) -> float:
    value = getattr(command, part)
    if not is_finite(value):
        raise CommandError(f"{arg(command.name)}: {arg(part)} {arg(shortened(value))}: give a finite number.")
    return float(value)


def is_finite(value: object) -> bool:
    """Whether a value of JSON is a number that a double can hold: an integer may have hundreds of digits."""
    try:
        return not isinstance(value, bool) and isinstance(value, (int, float)) and math.isfinite(value)
    except OverflowError:
        return False


def shortened(value: object) -> str:
    """Return a value for a message: as it was written, but no longer than a line."""
    text = repr(value)
    return text if len(text) <= _LONGEST_VALUE else f"{text[:_LONGEST_VALUE]}..."


def _array(command: Any, part: str, shape: tuple[int, ...]) -> list[Any]:
    value = getattr(command, part)
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        array = np.empty(0)
    if array.shape != shape or not np.isfinite(array).all():
        many = " rows of ".join(map(str, shape))
        raise CommandError(
            f"{arg(command.name)}: {arg(part)} {arg(shortened(value))}: give {arg(many)} finite numbers."
        )
    numbers: list[Any] = array.tolist()
    return numbers


def _numbers(command: Any, part: str) -> tuple[float, ...]:
    return tuple(_array(command, part, (3,)))


def _check_seconds(command: Any) -> None:
    if command.seconds is None:
        return
    if not 0 < _number(command, "seconds") < _MOST_S:
        raise CommandError(f"{arg(command.name)}: seconds {arg(command.seconds)!r}: give a positive number.")


# ---- A script for the bench: one timed command a line, as JSON -----------------------------------


_LONGEST_LINE, _MOST_LINES = 10_000, 100_000
LONGEST_S = 24 * 3600.0
"""Of the bench's clock: what would come later is refused, s."""


class ScriptError(InputError):
    """A script that cannot be run; the message names the line and the remedy."""


@dataclass(frozen=True)
class Timed:
    """A command and when it is due."""

    command: Command
    at: float | None = None  # s since the bench was switched on
    # s after the command before it was over: a turn at its end, a touch when the tip leaves; one of the two
    after: float | None = None
    where: str = "script"  # for messages, such as "bench.jsonl, line 3"


def read_script(path: Path) -> tuple[Timed, ...]:
    """
    Read a script.

    Every line is a JSON object with `at` or `after` (s), `do`, and what the command needs:
    ``{"at": 2.0, "do": "touch", "marker": 3, "force": 9, "seconds": 1}``. Empty lines and those that begin with
    ``#`` say nothing.

    Raises
    ------
    ScriptError
        It cannot be read, or a line is wrong.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise ScriptError(
            f"{arg(path)}: it cannot be read ({arg(error)}): give a text file of commands."
        ) from error
    return parse_script(text, str(path))


def parse_script(text: str, name: str = "script") -> tuple[Timed, ...]:
    """Return the commands of a text; `name` is for messages.

    Raises
    ------
    ScriptError
        A line is wrong.
    """
    found: list[Timed] = []
    lines = text.splitlines()
    if len(lines) > _MOST_LINES:
        raise ScriptError(
            f"{arg(name)}: {arg(len(lines)):,} lines are more than {arg(_MOST_LINES):,}: split the script."
        )
    latest = earliest = 0.0
    for number, line in enumerate(lines, 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        timed = _read_line(line, f"{name}, line {number}")
        if timed.at is not None:
            if timed.at < latest:
                raise ScriptError(
                    f"{arg(timed.where)}: at {arg(timed.at):g} s is before {arg(latest):g} s of a line"
                    " above: put them in order."
                )
            latest = timed.at
        # It may be later yet, by how long the commands above take.
        earliest = timed.at if timed.at is not None else earliest + (timed.after or 0.0)
        if earliest > LONGEST_S:
            raise ScriptError(
                f"{arg(timed.where)}: it is due after {arg(LONGEST_S):,.0f} s, the longest run: split the script."
            )
        found.append(timed)
    if not found:
        raise ScriptError(f'{arg(name)}: it has no commands: add a line such as {{"at": 1, "do": "end"}}.')
    return tuple(found)


def _read_line(line: str, where: str) -> Timed:
    if len(line) > _LONGEST_LINE:
        raise ScriptError(
            f"{arg(where)}: longer than {arg(_LONGEST_LINE):,} characters: check that it is a script."
        )
    fields = read_object(line, where)
    when = {key: fields.pop(key) for key in ("at", "after") if key in fields}
    if len(when) != 1:
        raise ScriptError(f"{arg(where)}: give either at or after, s.")
    ((key, seconds),) = when.items()
    if not is_finite(seconds) or not 0 <= seconds <= LONGEST_S:
        raise ScriptError(
            f"{arg(where)}: {arg(key)} {arg(shortened(seconds))}: give seconds, 0 or more and at most"
            f" {arg(LONGEST_S):,.0f}."
        )
    try:
        command = read_command(fields)
    except InputError as error:
        raise ScriptError(f"{arg(where)}: {arg(error)}") from error
    return Timed(command, where=where, **{key: float(seconds)})


def read_object(line: str, where: str) -> dict[str, Any]:
    """Return the JSON object of a line.

    Raises
    ------
    ScriptError
        It is none.
    """
    try:
        value = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise ScriptError(
            f'{arg(where)}: not valid JSON ({arg(error)}): write {{"at": 2, "do": "release"}} or the like.'
        ) from error
    if not isinstance(value, dict):
        raise ScriptError(f'{arg(where)}: not a JSON object: write {{"at": 2, "do": "release"}} or the like.')
    return value


# ---- what the bench gives: samples, the truth beside them, and what was done to it ---------------


@dataclass(frozen=True)
class Done:
    """A command that took effect."""

    time: float  # when, s of the bench's clock
    command: Command
    until: float  # when it is over: a turn at its end, a touch when the tip leaves by itself; else `time`

    @property
    def secret(self) -> bool:
        """Whether nobody but the truth may tell of it."""
        return isinstance(self.command, SecretRezero)


@dataclass(frozen=True)
class Slip:
    """A tip that was told to press and touched nothing for half a second: it slid off, or never met the probe."""

    time: float  # when that was found, s of the bench's clock
    touch: Done  # the command


@dataclass(frozen=True)
class Batch:
    """What the bench gave over some time, each by increasing time."""

    wrenches: tuple[WrenchSample, ...] = ()
    flanges: tuple[FlangeSample, ...] = ()
    truths: tuple[SceneMoment, ...] = ()  # one for every wrench
    done: tuple[Done, ...] = ()  # commands that took effect
    slips: tuple[Slip, ...] = ()  # touches that were found to press nothing

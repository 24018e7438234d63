"""What a person does at the bench, as values: they are queued, acknowledged, written down and done again."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.simulation.scenes import TipPress
from contactbench.pipeline.simulation.scenes.bench import MOST_BUMP_N, MOST_LEVER_M

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

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
    def rotation(self) -> NDArray[np.float64]:
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
    found: dict[str, Any] = {"do": command.name}
    for field in fields(command):
        value = getattr(command, field.name)
        if value is not None:
            found[field.name] = value
    return found


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

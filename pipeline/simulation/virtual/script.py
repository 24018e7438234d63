"""A script for the bench: one timed command a line, as JSON."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.simulation.virtual.commands import (
    Command,
    command_fields,
    is_finite,
    read_command,
    shortened,
)

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

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


def script_text(commands: Iterable[Timed]) -> str:
    """Return a script that `parse_script` reads back."""
    lines = []
    for timed in commands:
        when = {"after": timed.after} if timed.at is None else {"at": timed.at}
        lines.append(json.dumps(when | command_fields(timed.command)) + "\n")
    return "".join(lines)


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

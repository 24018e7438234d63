"""Frames of a closed loop on standard output, for who watches it from another process."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer

from contactbench.pipeline.control.frames import BEGIN, END, FRAME, beginning_of, frame_of, line_of

if TYPE_CHECKING:
    from contactbench.pipeline.control.command import Command
    from contactbench.pipeline.control.loop import Loop


class Frames:
    """
    Writes them, until nobody reads them any more.

    Parameters
    ----------
    robot : str
        Its address.
    """

    def __init__(self, robot: str) -> None:
        self._robot = robot
        self._begun = self._gone = False

    def take(self, command: Command, loop: Loop) -> bool:
        """Write a period; returns whether somebody still reads."""
        if not self._begun:
            self._begun = True
            self._write(line_of(BEGIN, beginning_of(loop, self._robot)))
        if not self._gone:
            self._write(line_of(FRAME, frame_of(command, loop)))
        return not self._gone

    def end(self, facts: dict[str, Any]) -> None:
        """Write what came of it."""
        if not self._gone:
            self._write(line_of(END, facts))

    def _write(self, line: str) -> None:
        try:
            typer.echo(line, nl=False)
        except OSError:
            self._gone = True

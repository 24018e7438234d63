"""Writing the scripts that the virtual bench reads."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from contactbench.pipeline.simulation.virtual.commands import command_fields

if TYPE_CHECKING:
    from collections.abc import Iterable

    from contactbench.pipeline.simulation.virtual.commands import Timed


def script_text(commands: Iterable[Timed]) -> str:
    """Return a script that `parse_script` reads back."""
    lines = []
    for timed in commands:
        when = {"after": timed.after} if timed.at is None else {"at": timed.at}
        lines.append(json.dumps(when | command_fields(timed.command)) + "\n")
    return "".join(lines)

"""What every command shares: sentences on standard error, one JSON object on standard output, progress."""

from __future__ import annotations

import json
import sys
import time
from contextvars import ContextVar
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import TracebackType

    from rich.table import Table

_JSON = "contactbench.json"
_PATIENCE_S = 0.5
_CONTROLS = {code: "\N{REPLACEMENT CHARACTER}" for code in (*range(0x20), *range(0x7F, 0xA0)) if code != 0x0A}


_running: ContextVar[typer.Context] = ContextVar("running")


def _remember(ctx: typer.Context, value: bool) -> bool:
    ctx.meta[_JSON] = value  # shared by all levels of commands
    _running.set(ctx)
    return value


JsonOption = Annotated[
    bool,
    typer.Option(
        "--json", help="Print one JSON object on standard output.", callback=_remember, is_eager=True
    ),
]


def wants_json(ctx: Any) -> bool:
    """Tell whether the command that runs was given ``--json``."""
    return bool(ctx.meta.get(_JSON))


def running_command() -> tuple[str, Mapping[str, Any]]:
    """Return the name of the command that runs, and its parameters; only for commands with ``--json``."""
    context = _running.get()
    return context.info_name or "", context.params


def print_json(value: Mapping[str, Any]) -> None:
    """Write one JSON object on standard output."""
    typer.echo(json.dumps(value, allow_nan=False))


def say(text: str, style: str = "") -> None:
    """Write one line on standard error, styled where that is a terminal."""
    from rich.console import Console
    from rich.text import Text

    # File names need be neither printable nor UTF-8.
    line = " ".join(text.encode("utf-8", "replace").decode().splitlines())
    Console(stderr=True).print(Text(printable(line), style=style), soft_wrap=True)


def printable(text: str) -> str:
    """Replace control characters, all but the line feed: a name in a stranger's file shall not steer a terminal."""
    return text.translate(_CONTROLS)


def show_tables(*tables: Table) -> None:
    """Write tables on standard error, as wide as they are: a number cut short by a narrow terminal is wrong."""
    from rich.console import Console

    console = Console(stderr=True)
    for table in tables:
        needed = console.measure(table, options=console.options.update(width=1000)).maximum
        console.width = max(console.width, needed)
    for table in tables:
        console.print(table)


def report_error(message: str, *, as_json: bool) -> None:
    """Write a red line on standard error and, when asked for, ``{"error": ...}`` on standard output."""
    say(f"error: {message}", "red")
    if as_json:
        print_json({"error": message})


class Bar:
    """A progress bar, on a terminal only, and only once the work has taken half a second.

    Parameters
    ----------
    what : str
        The word in front of it.
    counted : bool
        Steps are counted, not bytes.
    """

    def __init__(self, what: str, *, counted: bool = False) -> None:
        self._what = what
        self._counted = counted
        self._begin = time.perf_counter()
        self._progress: Any = None
        self._task: Any = None

    def __enter__(self) -> Bar:
        return self

    def __call__(self, done: int, total: int) -> None:
        """Show that `done` of `total` bytes or steps are through; a total of 0 is unknown."""
        late = time.perf_counter() - self._begin > _PATIENCE_S
        if self._progress is None and late and sys.stderr.isatty():
            self._start(total)
        if self._progress is not None:
            self._progress.update(self._task, completed=done)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._progress is not None:
            self._progress.stop()

    def _start(self, total: int) -> None:
        from rich import progress
        from rich.console import Console

        self._progress = progress.Progress(
            progress.TextColumn("{task.description}"),
            progress.BarColumn(),
            progress.MofNCompleteColumn() if self._counted else progress.DownloadColumn(),
            progress.TimeRemainingColumn(),
            console=Console(stderr=True),
            transient=True,
        )
        self._task = self._progress.add_task(self._what, total=total or None)
        self._progress.start()

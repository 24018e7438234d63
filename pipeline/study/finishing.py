"""What the commands of ``contactbench study`` share: options, and how a report ends one."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Protocol

import typer

from contactbench.pipeline.console import print_json
from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from typing import Any

    from rich.table import Table

NOT_GOOD_ENOUGH = 1

SeedOption = Annotated[int, typer.Option(help="Seed of the touches and the noise.")]
MarkdownOption = Annotated[
    Path | None, typer.Option("--out", help="Also write the tables to this Markdown file.")
]


class Report(Protocol):
    """What a study gives."""

    @property
    def passed(self) -> bool:
        """Whether every figure reached its target."""
        ...

    def to_json(self) -> dict[str, Any]:
        """Return it as plain values."""
        ...

    def table(self) -> Table:
        """Return it for a terminal."""
        ...

    def markdown(self) -> str:
        """Return it for a file."""
        ...


def finish(report: Report, out: Path | None, *, as_json: bool) -> None:
    """Write, print, and leave with the exit code of a report that says whether it reached its targets."""
    if out:
        write(out, report.markdown())
    if as_json:
        print_json(report.to_json())
    else:
        show([report.table()])
    if not report.passed:
        raise typer.Exit(NOT_GOOD_ENOUGH)


def show(tables: list[Table]) -> None:
    """Print tables on standard output."""
    from rich.console import Console

    console = Console()
    for table in tables:
        console.print(table)


def write(path: Path, text: str) -> None:
    """Write a file; InputError if that cannot be."""
    try:
        write_durably(path, text.encode())
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be written ({error}); choose another --out") from error

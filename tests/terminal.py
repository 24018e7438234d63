"""The command line as a person types it."""

import sys
from typing import Any

from typer.testing import CliRunner

from contactbench.pipeline import cli


def invoke(*words: object) -> Any:
    """Run a command in this process."""
    return CliRunner().invoke(cli.app, list(map(str, words)))


def command(*words: object) -> list[str]:
    """Return a command for a process of its own."""
    return [sys.executable, "-P", "-m", "contactbench.app.cli", *map(str, words)]


def said(result: Any) -> str:
    """Return what a command said, without the breaks of lines."""
    return " ".join(result.output.split())

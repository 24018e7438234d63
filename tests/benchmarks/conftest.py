"""Benchmarks as the command that runs them."""

from typing import NamedTuple

import pytest
from benchmarks.__main__ import main


class Done(NamedTuple):
    exit_code: int
    stdout: str
    stderr: str


@pytest.fixture
def benchmark(capsys):
    """Run a benchmark by its name and options; give its exit code and what it printed."""

    def run(*words: object) -> Done:
        capsys.readouterr()
        try:
            code = main([*map(str, words)])
        except SystemExit as end:
            code = end.code
        return Done(code, *capsys.readouterr())

    return run

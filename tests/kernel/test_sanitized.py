"""The kernel's own C++ tests and its fuzzer, under the address and undefined-behaviour sanitizers."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "packaging" / "sanitize"
COMPILER = os.environ.get("CXX", "g++")

needs_compiler = pytest.mark.skipif(shutil.which(COMPILER) is None, reason=f"no C++ compiler {COMPILER}")


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([SCRIPT, *arguments], capture_output=True, text=True, check=False, timeout=550)


@needs_compiler
def test_tests_and_fuzzer_pass_under_the_sanitizers() -> None:
    result = run("500")
    report = result.stdout + result.stderr
    assert result.returncode == 0, report
    passed = re.search(r"^(\d+) checks passed$", result.stdout, re.MULTILINE)
    assert passed is not None, report
    assert int(passed[1]) > 100_000
    assert "sanitize: passed, 500 inputs fuzzed, no sanitizer report" in result.stdout
    assert "runtime error" not in report
    assert "AddressSanitizer" not in report


def test_help_shows_an_example() -> None:
    result = run("--help")
    assert result.returncode == 0
    assert "Example" in result.stdout


def test_nonsense_is_refused() -> None:
    result = run("many")
    assert result.returncode == 2
    assert "'many'" in result.stderr

"""Wrong lines of the kernel, and whether its C++ tests notice them: packaging/mutants."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HEADERS = ROOT / "pipeline" / "kernel" / "include" / "contactbench"
COMPILER = os.environ.get("CXX", "g++")

needs_compiler = pytest.mark.skipif(shutil.which(COMPILER) is None, reason=f"no C++ compiler {COMPILER}")


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    script = ROOT / "packaging" / "mutants"
    return subprocess.run([script, *arguments], capture_output=True, text=True, check=False, timeout=550)


def headers() -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(HEADERS.glob("*.hpp"))}


@needs_compiler
def test_a_wrong_line_is_noticed_a_harmless_one_survives_and_the_checkout_stays_as_it_is(
    tmp_path: Path,
) -> None:
    before = headers()
    table = tmp_path / "mutants.toml"
    line = "inline constexpr int reason_count = 15;"
    table.write_text(
        f'[harmless]\nfile = "answer.hpp"\nold = "{line}"\nnew = "{line}  // the same"\n'
        '[wrong]\nfile = "answer.hpp"\nold = "others += std::exp(-0.5 * delta);"\n'
        'new = "others += std::exp(-delta);"\n',
        encoding="utf-8",
    )
    result = run("--table", str(table))
    assert result.returncode == 1, result.stdout + result.stderr
    assert headers() == before
    assert re.search(r"^harmless +SURVIVED$", result.stdout, re.MULTILINE)
    assert re.search(r"^wrong +\w+\.hpp:\d+: .+$", result.stdout, re.MULTILINE), result.stdout
    assert "mutants: 1 of 2 noticed" in result.stdout


def test_every_line_of_the_table_is_in_its_header_once() -> None:
    assert run("--check").returncode == 0, run("--check").stderr


@pytest.mark.parametrize(
    ("file", "old", "says"),
    [
        ("answer.hpp", "int nowhere = 0;", "answer.hpp has 0 lines that read"),
        ("answer.hpp", "}", "lines that read"),
        ("choice.hpp", "}", "there is no file choice.hpp"),
    ],
)
def test_a_line_that_is_not_there_once_is_refused(tmp_path: Path, file: str, old: str, says: str) -> None:
    table = tmp_path / "mutants.toml"
    table.write_text(f'[stale]\nfile = "{file}"\nold = "{old}"\nnew = ""\n', encoding="utf-8")
    result = run("--table", str(table))
    assert result.returncode == 2
    assert "mutants: stale: " in result.stderr
    assert says in result.stderr


def test_a_table_without_a_line_to_change_is_refused(tmp_path: Path) -> None:
    table = tmp_path / "mutants.toml"
    table.write_text('[half]\nfile = "answer.hpp"\nold = "}"\n', encoding="utf-8")
    result = run("--table", str(table))
    assert result.returncode == 2
    assert "[half] needs file, old and new" in result.stderr


def test_an_unknown_name_is_refused() -> None:
    result = run("no-such-mutant")
    assert result.returncode == 2
    assert "no mutant is called 'no-such-mutant'" in result.stderr


def test_help_shows_an_example() -> None:
    result = run("--help")
    assert result.returncode == 0
    assert "Example: packaging/mutants" in result.stdout

"""Wrong lines, and whether tests notice them: packaging/mutants. Its own table is run by `packaging/run test`."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
COMPILER = os.environ.get("CXX", "g++")
NUMBER = 'file = "answer.hpp"\nold = "inline constexpr int reason_count = 16;"\n'
SHARE = 'file = "pipeline/calibration/payload.py"\nold = "_LARGEST_SHARE, _LARGEST_OFFSET_M = 0.1, 0.01"\n'


def run(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    script = ROOT / "packaging" / "mutants"
    return subprocess.run([script, *arguments], capture_output=True, text=True, check=False, timeout=550)


def refused(folder: Path, table: str) -> str:
    (folder / "mutants.toml").write_text(table, encoding="utf-8")
    result = run("--table", folder / "mutants.toml")
    assert result.returncode == 2, result.stdout
    return result.stderr


@pytest.mark.skipif(shutil.which(COMPILER) is None, reason=f"no C++ compiler {COMPILER}")
@pytest.mark.skipif(not (ROOT / ".venv").exists(), reason="modules are tried in .venv")
def test_a_wrong_line_is_noticed_a_harmless_one_survives_and_the_checkout_stays_as_it_is(
    tmp_path: Path,
) -> None:
    files = [
        ROOT / "pipeline" / "kernel" / "include" / "contactbench" / "answer.hpp",
        ROOT / "pipeline" / "kernel" / "include" / "contactbench" / "table.hpp",
        ROOT / "pipeline" / "calibration" / "payload.py",
    ]
    before = [file.read_bytes() for file in files]
    table, payload = tmp_path / "mutants.toml", "tests/calibration/test_payload.py"
    table.write_text(
        f'[harmless]\n{NUMBER}new = "inline constexpr int reason_count = 16 + 0;"\ntests = ["check_decimals"]\n'
        '[wrong]\nfile = "table.hpp"\nold = "if (count == 0 || count > most_digits) return {};"\n'
        'new = "if (count == 0) return {};"\ntests = ["check_decimals"]\n'
        f'[harmless-module]\n{SHARE}new = "_LARGEST_SHARE, _LARGEST_OFFSET_M = 0.1, 1e-2"\ntests = ["{payload}"]\n'
        f'[wrong-module]\n{SHARE}new = "_LARGEST_SHARE, _LARGEST_OFFSET_M = 0.0, 0.01"\ntests = ["{payload}"]\n',
        encoding="utf-8",
    )
    result = run("--table", table)
    assert result.returncode == 1, result.stdout + result.stderr
    assert [file.read_bytes() for file in files] == before
    assert re.search(r"^harmless +SURVIVED$", result.stdout, re.MULTILINE)
    assert re.search(r"^wrong +\w+\.hpp:\d+: .+$", result.stdout, re.MULTILINE), result.stdout
    assert re.search(r"^harmless-module +SURVIVED$", result.stdout, re.MULTILINE)
    assert re.search(rf"^wrong-module +{payload}::\w+", result.stdout, re.MULTILINE), result.stdout
    assert "mutants: 2 of 4 noticed" in result.stdout


@pytest.mark.parametrize(
    ("file", "old", "says"),
    [
        ("answer.hpp", "int nowhere = 0;", "answer.hpp has 0 lines that read"),
        ("answer.hpp", "}", "lines that read"),
        ("choice.hpp", "}", "there is no file choice.hpp"),
    ],
)
def test_a_line_that_is_not_there_once_is_refused_and_so_is_every_other(
    tmp_path: Path, file: str, old: str, says: str
) -> None:
    row = f'file = "{file}"\nold = "{old}"\nnew = ""\ntests = ["check_fit"]\n'
    words = refused(tmp_path, f"[stale]\n{row}[other]\n{row}")
    assert "mutants: stale: " in words
    assert "\nother: " in words
    assert says in words


def test_tests_that_do_not_import_the_file_are_refused(tmp_path: Path) -> None:
    words = refused(tmp_path, f'[unseen]\n{SHARE}new = ""\ntests = ["tests/packaging/test_house.py"]\n')
    assert "unseen: its tests do not import the file" in words


def test_a_table_without_a_line_to_change_is_refused(tmp_path: Path) -> None:
    assert "[half] needs file, old, new and tests" in refused(tmp_path, f'[half]\n{NUMBER}new = ""\n')


def test_an_unknown_name_is_refused() -> None:
    result = run("no-such-mutant")
    assert result.returncode == 2
    assert "no mutant is called 'no-such-mutant'" in result.stderr


def test_help_shows_an_example() -> None:
    result = run("--help")
    assert result.returncode == 0
    assert "Example: packaging/mutants" in result.stdout

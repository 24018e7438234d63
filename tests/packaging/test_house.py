"""The figures of a checkout, and the limits that they keep: packaging/house."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FILES = {
    "app/a.py": '"""Docstring."""\n\nfrom contactbench.app import b  # a comment\n\n_MOST = 3\n',
    "app/b.py": "def later():\n    '''Return c.'''\n    import contactbench.app.c\n\n\n_MOST = 4\n",
    "app/c.py": "if TYPE_CHECKING:\n    import contactbench.app.a\ntyper.Option()\n",
    "pipeline/d.hpp": "/* one\n two */\nint d; // three\n",
    "tests/test_a.py": "assert True\n",
}
LIMITS = {"product": 9, "tests": 1, "files": 4, "circles": 0, "options": 1, "constants": 2, "subjects": 0}


def git(folder, *words):
    name = ("-c", "user.name=a", "-c", "user.email=a@b")
    return subprocess.run(
        ["git", *name, *words], cwd=folder, check=True, capture_output=True, text=True
    ).stdout


def house(folder, base, changed=()):
    """Run it on a checkout with these limits."""
    limits = "".join(f"{name} = {value}\n" for name, value in (LIMITS | dict(changed)).items())
    table = f'[tool.contactbench.house]\nbase = "{base}"\nlongest_subject = 20\n'
    (folder / "pyproject.toml").write_text(f"{table}[tool.contactbench.house.limits]\n{limits}")
    git(folder, "add", ".")
    command = [ROOT / "packaging" / "house", "--root", folder]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


@pytest.fixture
def checkout(tmp_path):
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    git(tmp_path, "init", "-q")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "-qm", "A subject that is longer than twenty letters")
    return tmp_path


def test_a_house_within_its_limits_passes(checkout):
    code, said = house(checkout, git(checkout, "rev-parse", "HEAD").strip())
    assert code == 0, said
    assert "constant: _MOST in 2 files" in said


@pytest.mark.parametrize("name", [name for name in LIMITS if LIMITS[name]])
def test_one_more_than_the_limit_is_too_much(checkout, name):
    code, said = house(checkout, "HEAD", {name: LIMITS[name] - 1})
    assert code == 1
    assert [line.split()[0] for line in said.splitlines() if "EXCEEDED" in line] == [name]


def test_an_import_inside_a_function_closes_a_circle(checkout):
    (checkout / "app" / "c.py").write_text("import contactbench.app.a\n\nx, y = typer.Option(), 0\n")
    code, said = house(checkout, "HEAD")
    assert code == 1
    assert "circle: contactbench.app.a, contactbench.app.b, contactbench.app.c" in said


def test_a_long_subject_is_told_only_since_the_base(checkout):
    git(checkout, "commit", "-qm", "Twenty letters or so", "--allow-empty")
    assert house(checkout, "HEAD~1")[0] == 0
    git(checkout, "commit", "-qm", "Twenty-one letters, so", "--allow-empty")
    code, said = house(checkout, "HEAD~2")
    assert code == 1
    assert "Twenty-one letters, so" in said
    code, said = house(checkout, "0123456789")
    assert code == 0
    assert "this clone does not have 0123456789" in said

"""What README and docs print can be typed, and where they point there is something."""

import re
import shlex
from pathlib import Path

import pytest
import typer
from benchmarks.__main__ import BENCHMARKS, function_of, options_of

from contactbench import __version__
from contactbench.app.cli import app

ROOT = Path(__file__).parents[1]
PAGES = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md"))]
LINK = re.compile(r"\]\(([^)#\s]+)")
BLOCK = re.compile(r"^```sh\n(.*?)^```", re.MULTILINE | re.DOTALL)


def commands():
    """Yield page and words of each command that is printed."""
    for page in PAGES:
        for block in BLOCK.findall(page.read_text("utf-8")):
            for line in block.replace("\\\n", " ").splitlines():
                words = shlex.split(line, comments=True)
                for start in [0, *(n + 1 for n, word in enumerate(words) if word in {"&&", "|"})]:
                    stop = next(
                        (n for n in range(start, len(words)) if words[n] in {"&&", "|", ">"}), len(words)
                    )
                    if words[start:stop]:
                        yield pytest.param(
                            words[start:stop], id=f"{page.name}: {' '.join(words[start:stop])[:60]}"
                        )


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_leads_somewhere(page):
    for link in LINK.findall(page.read_text("utf-8")):
        if "://" not in link:
            assert (page.parent / link).exists(), link


def test_the_readme_can_be_read_in_a_minute():
    assert len((ROOT / "README.md").read_text("utf-8").splitlines()) <= 150


@pytest.mark.parametrize("words", list(commands()))
def test_every_command_that_is_printed_exists_with_its_options(words):
    if words[:2] == ["packaging/run", "benchmark"]:
        name, rest = words[2], words[3:]
        assert name in BENCHMARKS
        known = {
            option
            for action in options_of(name, function_of(name))._actions
            for option in action.option_strings
        }
    elif words[0] == "contactbench":
        command, rest = typer.main.get_command(app), words[1:]
        while hasattr(command, "get_command") and rest and not rest[0].startswith("-"):
            command, rest = command.get_command(None, rest[0]), rest[1:]
            assert command is not None, " ".join(words)
        known = {option for each in command.params for option in (*each.opts, *each.secondary_opts)} | {
            "--help",
            "--json",
        }
    else:
        assert (
            (ROOT / words[0]).exists()
            or words[0] in {"cmake", "export", "pip", "sha256sum"}
            or "=" in words[0]
        ), words[0]
        return
    for word in rest:
        if word.startswith("--"):
            assert word.partition("=")[0] in known, word


def test_a_citation_has_the_version_that_is_installed():
    cited = re.search(r"^version: (.+)$", (ROOT / "CITATION.cff").read_text("utf-8"), re.MULTILINE)
    assert cited is not None
    assert cited[1] == __version__

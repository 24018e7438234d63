"""What README and docs print can be typed, what can be run is run, and where they point there is something."""

import hashlib
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from itertools import groupby, takewhile
from pathlib import Path

import pytest
import typer
from benchmarks.__main__ import BENCHMARKS, function_of, options_of
from waiting import until

from contactbench import __version__
from contactbench.app.cli import app
from contactbench.pipeline.cli import ENTRIES
from contactbench.pipeline.contact import Reason

ROOT = Path(__file__).parents[1]
README = ROOT / "README.md"
PAGES = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md"))]
LINK = re.compile(r"\]\(([^)#\s]+)")
BLOCK = re.compile(
    r"^(?P<indent> *)(?:<!-- (?P<mark>not run|exit code (?P<code>\d+)): (?P<why>.+?) -->\n *)?"
    r"```sh\n(?P<text>.*?)^ *```",
    re.MULTILINE | re.DOTALL,
)
SNIPPET = re.compile(r"^```python\n(?P<text>.*?)^```", re.MULTILINE | re.DOTALL)
HERE = re.compile(r"<<'END'\n.*?^END\n", re.MULTILINE | re.DOTALL)
# A command within a sentence, with or without the program's name.
INLINE = re.compile(rf"`(?:contactbench )?((?:{'|'.join(ENTRIES)})(?: [^`\n]*)?)`")
# Pages that are made by `packaging/pages.py` when the documentation is built.
MADE = re.compile(r"(reference/(commands/.*|modules)|examples/.*)\.md$")


@dataclass(frozen=True)
class Block:
    """Commands that a page prints."""

    text: str
    skipped: str | None  # why it is not run
    code: int  # with which its last command ends


def blocks(page):
    """Return the blocks of a page, in its order."""
    return [
        Block(
            re.sub(rf"^{found['indent']}", "", found["text"], flags=re.MULTILINE),
            found["why"] if found["mark"] == "not run" else None,
            int(found["code"] or 0),
        )
        for found in BLOCK.finditer(page.read_text("utf-8"))
    ]


def named(page):
    return str(page.relative_to(ROOT))


RUNNABLE = [page for page in PAGES if page != README and any(not b.skipped for b in blocks(page))]


def commands():
    """Yield page and words of each command that is printed; what the changelog says within sentences may be gone."""
    for page in PAGES:
        printed = "".join(HERE.sub("", block.text.replace("\\\n", " ")) for block in blocks(page))
        said = INLINE.findall(page.read_text("utf-8") if page.name != "CHANGELOG.md" else "")
        for line in [*printed.splitlines(), *(f"contactbench {each}" for each in said)]:
            words = shlex.split(line, comments=True)
            for between, part in groupby(words, {"&&", "|"}.__contains__):
                if not between:
                    command = [*takewhile(">".__ne__, part)]
                    yield pytest.param(command, id=f"{page.name}: {' '.join(command)[:60]}")


# ---- what is printed ---------------------------------------------------------------------------


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_every_link_leads_somewhere(page):
    for link in LINK.findall(page.read_text("utf-8")):
        if "://" not in link and not MADE.search(link):
            assert (page.parent / link).exists(), link


def test_the_readme_can_be_read_in_a_minute():
    assert len(README.read_text("utf-8").splitlines()) <= 140


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
            or words[0] in {".", "cat", "cd", "cmake", "export", "pip", "sha256sum"}
            or words[0].startswith("~/contactbench/")
            or "=" in words[0]
        ), words[0]
        return
    for word in takewhile(lambda word: word != "--", rest):
        if word.startswith("--"):
            assert word.partition("=")[0] in known, word


# ---- what is run -------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def shell(tmp_path_factory):
    """Return what runs the blocks of a page in one shell, in their order; each has to end as the page says."""
    pytest.importorskip("mujoco", reason="the sample data comes from the virtual bench (extra sim)")
    folder = tmp_path_factory.mktemp("bin")
    place, prompt = folder / "socket", ROOT / "tests" / "prompt.py"
    (folder / "contactbench").write_text(f'#!/bin/sh\nexec {sys.executable} -S -E {prompt} {place} "$@"\n')
    (folder / "contactbench").chmod(0o755)
    path = f"{folder}{os.pathsep}{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = os.environ | {"PATH": path, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    with subprocess.Popen([sys.executable, str(prompt), "serve", str(place)], env=environment) as server:
        until(lambda: place.exists() or server.poll() is not None)

        def run(page, folder, known=frozenset()):
            done = subprocess.run(
                ["bash"],
                input=script(page, known),
                cwd=folder,
                env=environment,
                capture_output=True,
                encoding="utf-8",  # whatever the locale is
            )
            assert done.returncode == 0, f"{named(page)}:\n{done.stderr[-3000:]}"

        yield run
        server.kill()


def script(page, known):
    """Return the blocks of a page for a shell, without lines that are known to do what they say."""
    lines = ["set -eo pipefail"]
    for number, block in enumerate(blocks(page), 1):
        if block.skipped is not None:
            continue
        assert "&&" not in block.text, "a failure before && would go unseen: write two lines"
        text = "".join(line for line in block.text.splitlines(keepends=True) if line not in known)
        lines.append(f"echo '=== block {number}' >&2")
        lines += (
            ["set +e", f"( set -e\n{text})", f"[ $? -eq {block.code} ] || exit 1", "set -e"]
            if block.code
            else [text]
        )
    return "\n".join(lines)


@pytest.fixture(scope="module")
def followed(shell, tmp_path_factory):
    """Follow the README from nothing; return the folder of the sample data, with what its commands made."""
    folder = tmp_path_factory.mktemp("readme")
    shell(README, folder)
    return folder / "sample"


def test_the_readme_leads_from_nothing_to_contacts(followed):
    contacts = [json.loads(line) for line in (followed / "contacts.jsonl").read_text("utf-8").splitlines()]
    touched = sum(each["reason"] != "low_force" for each in contacts)
    assert sum(each["accepted"] for each in contacts) > 0.8 * touched > 0.3 * len(contacts)


@pytest.mark.parametrize("page", RUNNABLE, ids=named)
def test_every_command_of_a_page_runs_on_the_sample_data(page, shell, followed, tmp_path):
    """A page begins where the README ends; what the README has too, word for word, is done."""
    shutil.copytree(followed, tmp_path, dirs_exist_ok=True)
    shell(page, tmp_path, {line for block in blocks(README) for line in block.text.splitlines(keepends=True)})


def snippets(page):
    text = page.read_text("utf-8")
    if page.suffix == ".md":
        return [found["text"] for found in SNIPPET.finditer(text)]
    return ["".join(cell["source"]) for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]


NOTEBOOKS = sorted((ROOT / "docs" / "examples").glob("*.ipynb"))


@pytest.mark.parametrize("page", [*filter(snippets, [*PAGES, *NOTEBOOKS])], ids=named)
def test_the_python_of_a_page_runs_on_the_sample_data(page, followed, monkeypatch, capsys):
    monkeypatch.chdir(followed)
    names: dict[str, object] = {"__name__": "__main__"}
    for number, text in enumerate(snippets(page), 1):
        exec(compile(text, f"{page.name}, block {number}", "exec"), names)  # noqa: S102 - the project's own pages
    assert capsys.readouterr().out


# ---- what is built -----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Build the documentation as `packaging/run docs` does: strictly, a warning ends it."""
    folder = tmp_path_factory.mktemp("site")
    words = [sys.executable, "-m", "mkdocs", "build", "--site-dir", str(folder)]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, encoding="utf-8")
    assert done.returncode == 0, done.stderr[-3000:]
    return folder


def test_the_documentation_loads_nothing_from_elsewhere(site):
    loaded = re.compile(r"<(?:script|img|iframe|link)\b[^>]*\s(?:src|href)=\"?https?:|url\(\s*[\"']?https?:")
    for file in (*site.rglob("*.html"), *site.rglob("*.css")):
        found = loaded.search(file.read_text("utf-8"))
        assert found is None, f"{file.relative_to(site)}: {found and found[0]}"


def test_the_documentation_is_small_enough_to_ship_and_can_be_searched(site):
    assert sum(file.stat().st_size for file in site.rglob("*") if file.is_file()) < 10e6
    assert "calibrate captures" in (site / "search" / "search_index.js").read_text("utf-8")


def test_the_reference_has_every_option_and_every_public_name(site):
    probe = (site / "reference" / "commands" / "probe.html").read_text("utf-8")
    assert "--max-contact-error" in probe
    modules = (site / "reference" / "modules.html").read_text("utf-8")
    assert 'id="contactbench.pipeline.calibration.calibrate.calibrate"' in modules
    for name in ("Solver.locate_batch", "Solver.locate", "Contact.sigma_max"):
        assert f'id="contactbench.pipeline.kernel.{name}"' in modules, name


def test_every_reason_is_explained():
    page = (ROOT / "docs" / "reference" / "reasons.md").read_text("utf-8")
    for reason in Reason:
        assert f"`{reason.name.lower()}`" in page, reason


def test_a_citation_has_the_version_that_is_installed():
    cited = re.search(r"^version: (.+)$", (ROOT / "CITATION.cff").read_text("utf-8"), re.MULTILINE)
    assert cited is not None
    assert cited[1] == __version__


def test_a_validation_page_says_whether_the_kernel_has_changed_since():
    sources = sorted((ROOT / "pipeline" / "kernel" / "include").rglob("*.hpp"))
    now = hashlib.sha256(b"".join(file.read_bytes() for file in sources)).hexdigest()[:12]
    for page in sorted((ROOT / "docs" / "validation").rglob("*.md")):
        told = ("**Older than the code:**", f"kernel sources `{now}`")
        assert any(words in page.read_text("utf-8")[:400] for words in told), f"{page}: say one of {told}"

"""Pages of the documentation that are made: of the command line, the modules and the notebooks. A hook of MkDocs."""

from __future__ import annotations

import inspect
import json
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer
from mkdocs.structure.files import File

from contactbench.app.cli import app
from contactbench.pipeline.cli import ENTRIES
from contactbench.pipeline.console import summary

if TYPE_CHECKING:
    from collections.abc import Iterator

    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files

_COMMANDS = "reference/commands"
_NOTEBOOKS = Path(__file__).parents[1] / "docs" / "examples"
# What other programs may import; the rest may change without notice.
MODULES = (
    "contactbench.pipeline.api",
    "contactbench.pipeline.mesh",
    "contactbench.pipeline.contact",
    "contactbench.pipeline.calibration",
    # These two have the name of their own module, which hides them.
    "contactbench.pipeline.calibration.calibrate.calibrate",
    "contactbench.pipeline.verification",
    "contactbench.pipeline.verification.verify.verify",
    "contactbench.pipeline.recording",
    "contactbench.pipeline.streams",
    "contactbench.pipeline.config.runtime",
    "contactbench.pipeline.filtering",
    "contactbench.pipeline.errors",
)
# Answers come from the compiled kernel, which has types but no docstrings.
_KERNEL = """::: contactbench.pipeline.kernel
    options:
      show_if_no_docstring: true
      members: [Solver, Contact, Candidate, Batch, Reason, Runtime, RuntimeContact, Zero]
"""


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Put the pages of the commands into the navigation."""
    reference = next(part["Reference"] for part in config.nav or () if "Reference" in part)
    reference[0] = {"Command line": [f"{_COMMANDS}/{name}.md" for name in ("index", *ENTRIES)]}
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that are made."""
    for name, text in pages().items():
        files.append(File.generated(config, name, content=text))
    return files


def on_post_build(config: MkDocsConfig) -> None:
    """Leave out what only debuggers of the theme read."""
    for each in Path(config.site_dir).rglob("*.map"):
        each.unlink()


def pages() -> dict[str, str]:
    """Return all of them: path -> Markdown."""
    made = {f"{_COMMANDS}/{name}.md": _noun(name) for name in ENTRIES}
    rows = "\n".join(f"| [`{name}`]({name}.md) | {ENTRIES[name].text} |" for name in ENTRIES)
    about = f"{app.info.help} Every command has `--help`, and nearly every one `--json` and `--quiet`."
    exits = "Exit codes: 0 good, 1 the result is not good enough, 2 wrong input, 130 interrupted."
    made[f"{_COMMANDS}/index.md"] = (
        f"# Command line\n\n{about}\n\n{exits}\n\n| command | |\n|---|---|\n{rows}\n"
    )
    listed = "\n\n".join(f"::: {module}" for module in MODULES)
    made["reference/modules.md"] = f"# Modules\n\n{listed}\n\n{_KERNEL}"
    return made | {f"examples/{file.stem}.md": _notebook(file) for file in _NOTEBOOKS.glob("*.ipynb")}


def _notebook(file: Path) -> str:
    parts = []
    for cell in json.loads(file.read_text("utf-8"))["cells"]:
        text = "".join(cell["source"])
        parts.append(f"```python\n{text}\n```" if cell["cell_type"] == "code" else text)
    return "\n\n".join([*parts, f"[Download this notebook]({file.name})\n"])


def _noun(name: str) -> str:
    root: Any = typer.main.get_command(app)
    command = root.get_command(None, name)
    told = [text for words, each in _commands(command, ("contactbench", name)) for text in _page(words, each)]
    return f"# {name}\n\n{summary(command)}.\n\n" + "\n".join(told) + "\n"


def _commands(command: Any, words: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Any]]:
    if not hasattr(command, "list_commands"):
        yield words, command
        return
    for name in command.list_commands(None):
        below = command.get_command(None, name)
        if not below.hidden:
            yield from _commands(below, (*words, name))


def _page(words: tuple[str, ...], command: Any) -> Iterator[str]:
    context = command.make_context(" ".join(words), [], resilient_parsing=True)
    yield f"## {' '.join(words[1:])}\n"
    usage = " ".join(command.collect_usage_pieces(context))
    yield f"```text\n{' '.join(words)} {usage}\n```\n"
    yield f"{inspect.cleandoc(command.help or '')}\n"
    rows = [record for each in command.get_params(context) if (record := each.get_help_record(context))]
    if rows:
        yield "| option | meaning |\n|---|---|"
        yield from (f"| <code>{_cell(left)}</code> | {_cell(right)} |" for left, right in rows)
        yield ""
    for line in (command.epilog or "").splitlines():
        yield f"```text\n{line.removeprefix('Example: ')}\n```\n"


def _cell(text: str) -> str:
    return escape(" ".join(text.split())).replace("|", "&#124;")

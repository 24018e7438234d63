"""
The results page: a chapter for each study, made from the study's Parquet file alone.

A study is a folder with ``results.parquet`` (see `contactbench.pipeline.study.results`). Its module in `CHAPTERS` has
``make(results, folder)``: it writes PNG files into the folder and returns the chapter as Markdown, which names them by
their bare file names and begins with a heading of the second level. Here they are put together as one page.
"""

from __future__ import annotations

import re
import shlex
from importlib import import_module
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.durable import make_folder, write_durably
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.results import environment, read_results, write_results

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from contactbench.pipeline.study.results import Results

PAGE, TOGETHER = "page.md", "results.md"
# Kind of a study -> the module that makes its chapter.
CHAPTERS = {
    "sweep": "sweep.page",
    "stability": "stability",
    "ablation": "ablation.page",
    "rivals": "rivals.page",
    "confidence": "confidence.page",
}
_BUSY = 1.5  # processes for each core: beyond, times are those of a shared machine
_PICTURE = re.compile(r"(!\[[^\]]*\]\()([A-Za-z0-9_.-]+\.png\))")


def make_page(folder: Path) -> str:
    """
    Write a study's chapter, ``page.md``, and its pictures into its folder.

    Parameters
    ----------
    folder : Path
        With ``results.parquet``.

    Returns
    -------
    str
        The chapter, Markdown.

    Raises
    ------
    InputError
        There are no results, or of a study that is not known.
    """
    results = read_results(folder)
    if results.kind not in CHAPTERS:
        raise InputError(f"{folder}: a study of kind {results.kind!r}: known are {', '.join(CHAPTERS)}.")
    chapter = import_module(f"contactbench.pipeline.study.{CHAPTERS[results.kind]}").make(results, folder)
    text = f"{chapter.rstrip()}\n\n{_origin(results)}\n"
    _write(folder / PAGE, text.encode())
    return text


def publish(folder: Path, kind: str, words: Sequence[str], rows: Sequence[Mapping[str, Any]]) -> Path:
    """
    Write a study's results, its page and its pictures.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    kind : str
        A key of `CHAPTERS`.
    words : sequence of str
        What repeats it, as it is typed after ``contactbench study``.
    rows : sequence of mapping
        See `contactbench.pipeline.study.results.Results`.

    Returns
    -------
    Path
        Of the page.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    make_folder(folder)
    write_results(folder, kind, shlex.join(["contactbench", "study", *words]), rows, environment())
    make_page(folder)
    return folder / PAGE


def gather(folders: Sequence[Path], out: Path) -> Path:
    """
    Write one page of several studies, with their pictures.

    Parameters
    ----------
    folders : sequence of Path
        Of studies; their names must differ.
    out : Path
        Folder; made if it is not there.

    Returns
    -------
    Path
        Of the page.

    Raises
    ------
    InputError
        A study cannot be read, or two have the same name.
    """
    names = [folder.resolve().name for folder in folders]
    if len(set(names)) < len(names):
        raise InputError(f"{', '.join(names)}: two folders have the same name: rename one.")
    make_folder(out)
    chapters = []
    for folder, name in zip(folders, names, strict=True):
        chapter = make_page(folder)
        for picture in {found.group(2)[:-1] for found in _PICTURE.finditer(chapter)}:
            _write(out / f"{name}-{picture}", _read(folder / picture))
        chapters.append(_PICTURE.sub(rf"\g<1>{name}-\g<2>", chapter))
    page = out / TOGETHER
    _write(page, "\n".join([_HEAD, _contents(chapters), *chapters]).encode())
    return page


def _contents(chapters: Sequence[str]) -> str:
    """Return links to the chapters, as GitHub and others name headings."""
    titles = [line[3:] for chapter in chapters for line in chapter.splitlines() if line.startswith("## ")]
    anchors = [re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles]
    return "\n".join(f"- [{title}](#{anchor})" for title, anchor in zip(titles, anchors, strict=True)) + "\n"


_HEAD = """# Results

Made by `contactbench study page` from the Parquet files of the studies below; each says how to repeat it. Times are
those of the machine that is named with them: only ratios travel to another one. Errors are the same on every machine,
whatever the number of workers.
"""


def _origin(results: Results) -> str:
    """Return when and with what results were computed, and how to repeat them."""
    facts = results.environment
    machine = f"{facts.get('processor', 'unknown processor')}, {facts.get('cores', '?')} cores"
    versions = ", ".join(
        f"{name} {facts[name]}" for name in ("contactbench", "python", "numpy", "scipy") if name in facts
    )
    load, cores = facts.get("load"), facts.get("cores")
    if load and cores and load > _BUSY * cores:
        machine += f", which other programs kept busy (load {load:g}: times are no better than upper bounds)"
    compiler = str(facts.get("compiler", "?"))
    compiler = f"GCC {compiler}" if compiler[:1].isdigit() else compiler
    return (
        f"*Computed {str(facts.get('finished', 'at an unknown time'))[:10]} on {machine},"
        f" {facts.get('kernel', '?')} kernel, {compiler}; {versions}."
        f" Repeat with `{results.command}`.*"
    )


def _read(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        raise InputError(f"{file}: cannot be read ({error}): make the page again.") from error


def _write(file: Path, data: bytes) -> None:
    try:
        write_durably(file, data)
    except OSError as error:
        raise InputError(f"{file}: cannot be written ({error}): choose another folder.") from error

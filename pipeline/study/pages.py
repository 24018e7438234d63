"""
The results pages: one for each study, made from the study's Parquet file alone.

A study is a folder with ``results.parquet`` (see `Results`). Its module in `CHAPTERS` has
``make(results, folder)``: it writes PNG files into the folder and returns the chapter as Markdown, which names them by
their bare file names and begins with a heading of the second level. Here they become pages of the documentation, one
for each study.

The results of a study: a folder with one Parquet file, which knows what it was computed with.

Everything that is shown of a study is made from this file alone, by `contactbench.pipeline.study.pages`.
"""

import base64
import json
import os
import platform
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from html import unescape
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import Any

from contactbench.pipeline.durable import make_folder, write_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.installation import processor
from contactbench.pipeline.page import render
from contactbench.pipeline.page.palette import SERIES

PAGE = "page.md"
_HTML = ".html"  # ending of the same page in the design of the reports
# Kind of a study -> the module that makes its chapter.
CHAPTERS = {"sweep": "sweep.page", "stability": "stability", "confidence": "confidence.study"}
_BUSY = 1.5  # processes for each core: beyond, times are those of a shared machine
_DETAILS = re.compile(r"<details><summary>(.*?)</summary>")
_NUMBERS = re.compile(r'<(t[hd]) style="text-align:right">')
_IMAGE = re.compile(r'<img src="([A-Za-z0-9_.-]+\.png)"')
_PICTURE = re.compile(r"(!\[[^\]]*\]\()([A-Za-z0-9_.-]+\.png\))")


COLOURS = SERIES
STYLE: dict[Any, Any] = {
    "font.size": 8.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e3e5e7",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.3,
    "lines.markersize": 4.0,
    "legend.frameon": False,
}


def chapter(
    title: str,
    about: str,
    tables: Sequence[tuple[str, str]],
    pictures: Mapping[str, bytes],
    said: Mapping[str, str],
    folder: Path,
) -> str:
    """
    Write pictures into a folder and return a chapter: a heading, what it is about, tables, pictures with captions.

    Parameters
    ----------
    tables : sequence of (str, str)
        Titles and Markdown.
    pictures : mapping
        File name -> PNG.
    said : mapping
        File name -> caption.

    Raises
    ------
    InputError
        A picture cannot be written.
    """
    parts = [f"## {title}", about]
    for heading, text in tables:
        parts += [f"### {heading}", text]
    for name, data in pictures.items():
        write_file(folder / name, data)
        parts.append(f"![{said[name]}]({name})\n\n{said[name]}")
    return "\n\n".join(parts)


def png(figure: Any) -> bytes:
    """Return a Matplotlib figure as a PNG image; the same figure gives the same bytes."""
    data = BytesIO()
    figure.savefig(data, format="png", metadata={"Software": None}, pil_kwargs={"optimize": True})
    return data.getvalue()


def table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table; columns of figures are flush right."""
    figures = [any(row[i][:1].isdigit() or row[i][:1] in "-–" for row in rows) for i in range(len(columns))]
    lines = ["| " + " | ".join(columns) + " |", "|" + "".join("---:|" if f else "---|" for f in figures)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def number(value: float | None, digits: str = ".3g") -> str:
    """Return a figure, an en dash where there is none."""
    return "–" if value is None or value != value else format(value, digits)


def make_page(folder: Path) -> str:
    """
    Write a study's page, ``page.md`` and ``page.html``, and its pictures into its folder.

    Parameters
    ----------
    folder : Path
        With ``results.parquet``.

    Returns
    -------
    str
        The page, Markdown.

    Raises
    ------
    InputError
        There are no results, or of a study that is not known.
    """
    results = read_results(folder)
    if results.kind not in CHAPTERS:
        raise InputError(f"{folder}: a study of kind {results.kind!r}: known are {', '.join(CHAPTERS)}.")
    chapter = import_module(f"contactbench.pipeline.study.{CHAPTERS[results.kind]}").make(results, folder)
    text = f"{chapter.rstrip()}\n\n{origin(results.environment, results.command)}\n"
    _write(folder / PAGE, text)
    return text


def _write(file: Path, text: str) -> None:
    """Write a page as Markdown and, beside it, as one HTML file that needs nothing else."""
    write_file(file, text.encode())
    write_file(file.with_suffix(_HTML), study_html(text, file.parent).encode())


def study_html(text: str, folder: Path) -> str:
    """
    Return a page of Markdown in the design of the reports, with its pictures inside.

    Parameters
    ----------
    text : str
    folder : Path
        Where the pictures are that it names.

    Raises
    ------
    InputError
        A picture cannot be read.
    """
    from markdown_it import MarkdownIt  # not for those who only compute

    # No markup comes through from names in the results; the one that the pages themselves have is a heading here.
    plain = _DETAILS.sub(lambda found: f"\n### {found[1]}\n", text).replace("</details>", "")
    body = MarkdownIt("commonmark", {"html": False}).enable("table").render(plain)
    body = body.replace("<table>", '<div class="scroll"><table>').replace("</table>", "</table></div>")
    body = _NUMBERS.sub(r'<\1 class="number">', body)
    body = _IMAGE.sub(lambda found: f'<img src="{_inside(folder / found[1])}"', body)
    heading = re.search(r"<h[12]>(.*?)</h[12]>", body)
    title = unescape(heading[1]) if heading else "Results"
    return render(__package__, title=title, body=body)


def _inside(picture: Path) -> str:
    return "data:image/png;base64," + base64.b64encode(_read(picture)).decode()


def publish(folder: Path, kind: str, command: str, rows: Sequence[Mapping[str, Any]]) -> Path:
    """
    Write a study's results, its page and its pictures; returns the page.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    kind : str
        A key of `CHAPTERS`.
    command : str
        What repeats it, as it is typed.
    rows : sequence of mapping
        See `contactbench.pipeline.study.pages.Results`.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    make_folder(folder)
    write_results(folder, kind, command, rows, environment())
    make_page(folder)
    return folder / PAGE


def gather(folders: Sequence[Path], out: Path) -> list[Path]:
    """
    Put the pages of several studies into one folder, each under its study's name, with their pictures.

    Parameters
    ----------
    folders : sequence of Path
        Of studies; their names must differ.
    out : Path
        Folder; made if it is not there.

    Returns
    -------
    list of Path
        The pages.

    Raises
    ------
    InputError
        A study cannot be read, or two have the same name.
    """
    names = [folder.resolve().name for folder in folders]
    if len(set(names)) < len(names):
        raise InputError(f"{', '.join(names)}: two folders have the same name: rename one.")
    make_folder(out)
    pages = []
    for folder, name in zip(folders, names, strict=True):
        text = make_page(folder)
        for picture in {found.group(2)[:-1] for found in _PICTURE.finditer(text)}:
            write_file(out / f"{name}-{picture}", _read(folder / picture))
        pages.append(out / f"{name}.md")
        write_file(pages[-1], _PICTURE.sub(rf"\g<1>{name}-\g<2>", _alone(text)).encode())
    return pages


def _alone(chapter: str) -> str:
    """Return a chapter as a page of its own: headings a level higher, and Markdown in what can be folded away."""
    raised = re.sub(r"^#(#+ )", r"\1", chapter, flags=re.MULTILINE)
    return raised.replace("<details>", '<details markdown="1">')


def origin(facts: Mapping[str, Any], command: str) -> str:
    """
    Return when and with what results were computed, and how to repeat them.

    Parameters
    ----------
    facts : mapping
        Of `contactbench.pipeline.study.pages.environment`.
    command : str
        As it is typed.
    """
    machines = facts.get("machines") or [facts]
    where = _machine(machines[0])
    if len(machines) > 1:
        names = dict.fromkeys(name for each in machines for name in each if name not in (*PASSING, "cells"))
        differ = [name for name in names if len({str(each.get(name)) for each in machines}) > 1]
        listed = (f"({i}) {_machine(each)}: {each['cells']:,} cells" for i, each in enumerate(machines, 1))
        where = (
            f"{len(machines)} machines that differ in {', '.join(differ)}, so that times of one are not those of"
            f" another: {'; '.join(listed)}"
        )
    finished = str(facts.get("finished", "at an unknown time"))[:10]
    return f"*Computed {finished} on {where}. Repeat with `{command}`.*"


def _machine(facts: Mapping[str, Any]) -> str:
    machine = f"{facts.get('processor', 'unknown processor')}, {facts.get('cores', '?')} cores"
    versions = ", ".join(
        f"{name} {facts[name]}" for name in ("contactbench", "python", "numpy", "scipy") if name in facts
    )
    load, cores = facts.get("load"), facts.get("cores")
    if load and cores and load > _BUSY * cores:
        machine += f", which other programs kept busy (load {load:g}: times are no better than upper bounds)"
    compiler = str(facts.get("compiler", "?"))
    compiler = f"GCC {compiler}" if compiler[:1].isdigit() else compiler
    return f"{machine}, {facts.get('kernel', '?')} kernel, {compiler}; {versions}"


def _read(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        raise InputError(f"{file}: cannot be read ({error}): make the page again.") from error


# ---- the results of a study: a folder with one Parquet file, which knows what it was computed with ----


Row = dict[str, Any]  # plain values

RESULTS = "results.parquet"
_META, _VERSION = b"contactbench", 1
PASSING = ("finished", "load")  # of an environment: what differs from hour to hour
_LIBRARIES = ("numpy", "scipy", "dask", "pyarrow")


@dataclass(frozen=True)
class Results:
    """What a study measured."""

    kind: str  # which study: one that `contactbench.pipeline.study.pages` knows
    command: str  # what repeats it, as it is typed
    rows: tuple[Row, ...]  # plain values; a row has None where others have a figure
    environment: Mapping[str, Any]  # see `environment`
    about: Mapping[str, Any] = field(default_factory=dict)  # whatever else belongs to it, plain values


def cores() -> int:
    """Return how many this machine has."""
    return os.cpu_count() or 1


def environment(**more: Any) -> dict[str, Any]:
    """Return what results are computed with: versions, processor, cores and their load, when, and what is given."""
    from importlib.metadata import PackageNotFoundError, version

    from contactbench import __version__
    from contactbench.pipeline import kernel

    facts: dict[str, Any] = {
        "contactbench": __version__,
        "python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}, {' '.join(platform.libc_ver())}",
        "processor": processor(),
        "cores": cores(),
        "load": round(os.getloadavg()[2], 1) if hasattr(os, "getloadavg") else None,
        "kernel": kernel.variant,
        "compiler": kernel.compiler,
        "finished": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
    }
    for name in _LIBRARIES:
        try:
            facts[name] = version(name)
        except PackageNotFoundError:
            facts[name] = "none"
    return facts | more


def write_results(
    folder: Path,
    kind: str,
    command: str,
    rows: Sequence[Mapping[str, Any]],
    facts: Mapping[str, Any],
    about: Mapping[str, Any] | None = None,
) -> Path:
    """
    Write the results of a study to its folder, as Parquet.

    Parameters
    ----------
    folder : Path
        It is there.
    kind, command, rows, facts, about
        See `Results`; `facts` is its environment.

    Returns
    -------
    Path
        Of the file.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    names = list(dict.fromkeys(name for row in rows for name in row))
    table = pa.table({name: pa.array([row.get(name) for row in rows]) for name in names})
    meta = {"version": _VERSION, "kind": kind, "command": command, "environment": facts, "about": about or {}}
    table = table.replace_schema_metadata({_META: json.dumps(meta, sort_keys=True).encode()})
    sink = pa.BufferOutputStream()
    pq.write_table(table, sink, compression="zstd")
    file = folder / RESULTS
    write_file(file, sink.getvalue().to_pybytes())
    return file


def read_results(place: Path) -> Results:
    """
    Read the results of a study.

    Parameters
    ----------
    place : Path
        Its folder, or the file in it.

    Raises
    ------
    InputError
        They are not there, or are no results of this version.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    file = place / RESULTS if place.is_dir() else place
    try:
        table = pq.read_table(file)
        meta = json.loads((table.schema.metadata or {})[_META])
        version = meta["version"]
        found = Results(
            str(meta["kind"]),
            str(meta["command"]),
            tuple(table.to_pylist()),
            dict(meta["environment"]),
            dict(meta["about"]),
        )
    except (OSError, pa.ArrowException, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{file}: no results of a study ({error}): give the folder of a finished one."
        ) from error
    if version != _VERSION:
        raise InputError(f"{file}: results of version {version}: use the contactbench that wrote them.")
    return found

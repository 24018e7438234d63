"""
The sentences of `pipeline`, found in its source: what the phrase book of another language has to hold.

`pipeline` speaks English, and knows of no other language: what it writes into files, journals and logs is the same
everywhere. What it says is translated where a window shows it, by `contactbench.widgets.phrases`, from the
templates found here.
"""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

# Rooms and files: what they say is seen in a terminal or in a document, not in a window.
_NOT_SHOWN = {
    *("commands", "study", "demo", "report", "page", "kernel", "fleet"),
    *("calibration/report", "heatmap/page.py"),
}
_HOLE = re.compile(r"\{[^{}]*\}")
_WORD = re.compile(r"[A-Za-z]{2,}")
_CODE = re.compile(r"[<>]\w|\w\(|__|\\|^\s*[-#]|\n\s|://|%[sd]|\w=\w")
_LEAST_WORDS = 2  # one is a key or a name, but for what begins and ends as a sentence does
# What sentences are made of, too short to be told from keys and names.
PARTS = (
    *(
        "{0} and {1}",
        "{0} by {1}",
        "{0} in {1}",
        "{0} on {1}",
        "{0} or {1}",
        "{0} to 1",
        "1 to {0}",
        "{0} with {1}",
    ),
    *("{0} ({1} kg)", "{0} negated", "pose {0}", "row {0}"),
    *(
        "Automatic",
        "Low-pass",
        "Readings",
        "Samples",
        "none",
        "degrees",
        "forces",
        "next",
        "previous",
        "radians",
        "torques",
        "transposed",
    ),
    "Correct the sensor's mounting: R_WS becomes R_WS · Rz({0}).",
)


def templates(pipeline: Path) -> tuple[str, ...]:
    """
    Return what a package says, sorted; what is filled in is {0}, {1}, ...

    Parameters
    ----------
    pipeline : Path
        Its folder.
    """
    found = set(PARTS)
    for file in sorted(pipeline.rglob("*.py")):
        place = file.relative_to(pipeline)
        if not _NOT_SHOWN & {each.as_posix() for each in (place, *place.parents)}:
            found.update(_spoken(ast.parse(file.read_text("utf-8"))))
    return tuple(sorted(found))


def _spoken(tree: ast.Module) -> Iterator[str]:
    silent = _silent(tree)
    for node in ast.walk(tree):
        if id(node) in silent:
            continue
        if isinstance(node, ast.JoinedStr):
            text = _joined(node)
            silent.update(id(part) for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            text = _numbered(node.value)
        else:
            continue
        if _is_speech(text):
            yield text


def _silent(tree: ast.Module) -> set[int]:
    """Return the strings that nobody reads: of documentation, of what cannot happen, and of formats."""
    silent: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            silent.add(id(node.value))
        elif isinstance(node, ast.FormattedValue) and node.format_spec is not None:
            silent.update(id(part) for part in ast.walk(node.format_spec))
        elif isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            raised = node.exc.func
            if isinstance(raised, ast.Name) and raised.id in (
                "AssertionError",
                "NotImplementedError",
                "TypeError",
            ):
                silent.update(id(part) for part in ast.walk(node.exc))
    return silent


def _joined(node: ast.JoinedStr) -> str:
    text, holes = "", 0
    for part in node.values:
        if isinstance(part, ast.Constant):
            text += str(part.value)
        else:
            text += f"{{{holes}}}"
            holes += 1
    return text


def _numbered(text: str) -> str:
    numbers = iter(range(len(text)))
    return _HOLE.sub(lambda _: f"{{{next(numbers)}}}", text)


def _is_speech(text: str) -> bool:
    plain = _HOLE.sub("", text)
    words, bare = len(_WORD.findall(plain)), text.strip()
    whole = bare[:1].isupper() and bare[-1:] == "."
    return " " in bare and (words >= _LEAST_WORDS or (words == 1 and whole)) and not _CODE.search(plain)

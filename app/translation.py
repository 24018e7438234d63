"""
Other languages: loading them, and keeping them complete.

``python -m contactbench.app.translation update`` takes new strings of `app` and `widgets` and messages of
`pipeline` into every language's .ts file and makes the .qm files that the window loads; ``check`` says what is not
translated, with exit code 1 if anything.
"""

import ast
import itertools
import json
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree as ET

from PySide6.QtCore import QCoreApplication, QLibraryInfo, QLocale, QTranslator

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import all_said_lately, say_again
from contactbench.widgets.messages import CONTEXT

LANGUAGES = {"en": "English", "de": "Deutsch"}
"""Code to name, each in its own words."""
_HERE = Path(__file__).parent
_FOLDER = _HERE / "translations"
_SOURCE = "en"
_IN_USE = "language"
_SAID, _MOST_SAID = "messages.json", 2**23
# Rooms whose texts are seen in a terminal or in a document, not in a window.
_IN_TERMINALS = {("pipeline", room) for room in ("commands", "study", "demo", "report", "page", "fleet")}
_OF_SETTINGS = {"knob": 1, "Row": 0, "MeshFinding": 1}  # which argument has the words that are shown
_WORD = re.compile(r"[A-Za-z]{2}", re.ASCII)


def load(application: QCoreApplication, language: str = "") -> str:
    """
    Have an application speak a language, as far as it is known.

    Parameters
    ----------
    application : QCoreApplication
    language : str
        Such as "de"; empty: that of the computer.

    Returns
    -------
    str
        The code of the language in use.
    """
    locale = QLocale(language) if language else QLocale.system()
    code = locale.name().partition("_")[0]
    if code not in LANGUAGES:
        code = _SOURCE
    QLocale.setDefault(_readers(code))
    application.setProperty(_IN_USE, _SOURCE)
    if code == _SOURCE:
        return code
    own = QTranslator(application)
    if not own.load(str(_FOLDER / f"contactbench_{code}.qm")):
        return _SOURCE
    application.installTranslator(own)
    qt = QTranslator(application)
    if qt.load(f"qtbase_{code}", QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath)):
        application.installTranslator(qt)
    application.setProperty(_IN_USE, code)
    return code


def _readers(code: str) -> QLocale:
    """Return how those who read a language write numbers and dates: as on this computer, where it speaks it too."""
    system = QLocale.system()
    return system if system.name().partition("_")[0] == code else QLocale(code)


def in_use() -> str:
    """Return the code of the language that the running application speaks."""
    application = QCoreApplication.instance()
    return _SOURCE if application is None else str(application.property(_IN_USE) or _SOURCE)


def keep_said(folder: Path) -> None:
    """Keep the messages said lately for the next start: a session's files have their English text alone."""
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        said = list(all_said_lately().items())
        sizes = itertools.accumulate(len(json.dumps(dict([each]))) for each in reversed(said))
        fit = sum(size <= _MOST_SAID - 2 for size in sizes)  # the latest: more the next start would not read
        write_durably(folder / _SAID, json.dumps(dict(said[len(said) - fit :])).encode())


def recall_said(folder: Path) -> None:
    """Take what `keep_said` kept; a file that is missing, damaged or too long counts as empty."""
    with suppress(OSError, ValueError):
        with (folder / _SAID).open("rb") as stream:
            said = json.loads(stream.read(_MOST_SAID))
        if isinstance(said, dict):
            say_again({text: marked for text, marked in said.items() if isinstance(marked, str)})


def unfinished(language: str) -> tuple[str, ...]:
    """Return the strings of a language that are not translated, as "context: text"."""
    tree = ET.parse(_file(language))  # noqa: S314 - our own file
    missing = []
    for context in tree.iter("context"):
        name = context.findtext("name", "")
        for message in context.iter("message"):
            made = message.find("translation")
            if made is None or not (made.text or "").strip() or made.get("type") == "unfinished":
                missing.append(f"{name}: {message.findtext('source', '')}")
    return tuple(missing)


def messages() -> frozenset[str]:
    """Return the templates of all messages; what is filled in is {0}, {1}, ..."""
    nodes = [
        each
        for folder in ("app", "widgets", "pipeline")
        for file in (_HERE.parent / folder).rglob("*.py")
        if file.relative_to(_HERE.parent).parts[:2] not in _IN_TERMINALS
        for each in ast.walk(ast.parse(file.read_text("utf-8")))
        if isinstance(each, ast.Call | ast.ClassDef)
    ]
    return frozenset(text for text in _texts(nodes, {"message", *_errors(nodes)}) if _WORD.search(text))


def _errors(nodes: list[ast.Call | ast.ClassDef]) -> set[str]:
    """Return the names of the errors whose text is a message."""
    found = {"InputError"}
    bases: defaultdict[str, set[str]] = defaultdict(set)
    for each in nodes:
        if isinstance(each, ast.ClassDef):
            bases[each.name].update(base.id for base in each.bases if isinstance(base, ast.Name))
    while more := {name for name, those in bases.items() if those & found} - found:
        found |= more
    return found


def _texts(nodes: list[ast.Call | ast.ClassDef], kinds: set[str]) -> Iterator[str]:
    for each in nodes:
        if not isinstance(each, ast.Call) or not isinstance(each.func, ast.Name):
            continue
        place = 0 if each.func.id in kinds else _OF_SETTINGS.get(each.func.id)
        if place is None:
            continue
        words = [key.value for key in each.keywords if key.arg == "none" and each.func.id in _OF_SETTINGS]
        for text in (*each.args[place : place + 1], *words):
            if isinstance(text, ast.JoinedStr):
                yield _template(text)
            elif isinstance(text, ast.Constant) and isinstance(text.value, str):
                yield text.value


def _template(text: ast.JoinedStr) -> str:
    template, place = "", itertools.count()
    for part in text.values:
        if isinstance(part, ast.FormattedValue):
            if not (isinstance(part.value, ast.Call) and ast.unparse(part.value.func) == "arg"):
                raise ValueError(f"{ast.unparse(text)}: each value in a message is given as arg(value)")
            template += f"{{{next(place)}}}"
        elif isinstance(part, ast.Constant):
            template += str(part.value)
    return template


def update(language: str) -> None:
    """Take new strings into a language's file, drop those that are gone, and make what the window loads."""
    sources = sorted(
        str(file) for folder in ("app", "widgets") for file in (_HERE.parent / folder).rglob("*.py")
    )
    with TemporaryDirectory() as folder:
        ours = Path(folder, "pipeline.py")  # Qt's tool reads neither f-strings nor what they are given to
        ours.write_text(
            "".join(f"translate({json.dumps(CONTEXT)}, {json.dumps(each)})\n" for each in sorted(messages())),
            "utf-8",
        )
        options = ("-ts", str(_file(language)), "-no-obsolete", "-locations", "none")
        _run("pyside6-lupdate", *sources, str(ours), *options)
    release(language)


def release(language: str) -> None:
    """Make the .qm file of a language."""
    file = _file(language)
    _run("pyside6-lrelease", str(file), "-qm", str(file.with_suffix(".qm")))


def _file(language: str) -> Path:
    return _FOLDER / f"contactbench_{language}.ts"


def _run(program: str, *arguments: str) -> None:
    subprocess.run([str(Path(sys.executable).with_name(program)), *arguments], check=True)  # noqa: S603


def main(arguments: list[str]) -> int:
    """Do ``update``, ``release`` or ``check``; returns the exit code."""
    actions = {"update": update, "release": release}
    languages = [code for code in LANGUAGES if code != _SOURCE]
    if len(arguments) != 1 or arguments[0] not in {*actions, "check"}:
        sys.stderr.write("usage: python -m contactbench.app.translation update|release|check\n")
        return 2
    if arguments[0] != "check":
        for code in languages:
            actions[arguments[0]](code)
        return 0
    missing = [f"{code}: {each}" for code in languages for each in unfinished(code)]
    sys.stdout.write("".join(f"{each}\n" for each in missing))
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

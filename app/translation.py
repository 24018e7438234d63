"""
Other languages: loading them, and keeping them complete.

``python -m contactbench.app.translation update`` takes new strings of `app` and `widgets` into every
language's .ts file and makes
the .qm files that the window loads, and new sentences of `pipeline` into its phrase book; ``check`` says what is not
translated, with exit code 1 if anything.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

from PySide6.QtCore import QCoreApplication, QLibraryInfo, QLocale, QTranslator

from contactbench.app.sentences import templates
from contactbench.widgets import phrases

LANGUAGES = {"en": "English", "de": "Deutsch"}
"""Code to name, each in its own words."""
_HERE = Path(__file__).parent
_FOLDER = _HERE / "translations"
_PIPELINE = _HERE.parent / "pipeline"
_SOURCE = "en"
_IN_USE = "language"


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
    phrases.use(None)
    if code == _SOURCE:
        return code
    own = QTranslator(application)
    if not own.load(str(_FOLDER / f"contactbench_{code}.qm")):
        return _SOURCE
    application.installTranslator(own)
    qt = QTranslator(application)
    if qt.load(f"qtbase_{code}", QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath)):
        application.installTranslator(qt)
    phrases.use(phrases.PhraseBook(sentences(code)))
    application.setProperty(_IN_USE, code)
    return code


def _readers(code: str) -> QLocale:
    """Return how those who read a language write numbers and dates: as on this computer, where it speaks it too."""
    system = QLocale.system()
    return system if system.name().partition("_")[0] == code else QLocale(code)


def sentences(language: str) -> dict[str, str]:
    """Return the phrase book of a language: the templates of what `pipeline` says, and what they are in it."""
    file = _book_file(language)
    return dict(json.loads(file.read_text("utf-8"))) if file.is_file() else {}


def in_use() -> str:
    """Return the code of the language that the running application speaks."""
    application = QCoreApplication.instance()
    return _SOURCE if application is None else str(application.property(_IN_USE) or _SOURCE)


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
    known = sentences(language)
    return (*missing, *(f"pipeline: {each}" for each in templates(_PIPELINE) if not known.get(each)))


def update(language: str) -> None:
    """Take new strings into a language's file, drop those that are gone, and make what the window loads."""
    sources = sorted(
        str(file) for folder in ("app", "widgets") for file in (_HERE.parent / folder).rglob("*.py")
    )
    file = _file(language)
    _run("pyside6-lupdate", *sources, "-ts", str(file), "-no-obsolete", "-locations", "none")
    release(language)
    known = sentences(language)
    book = {each: known.get(each, "") for each in templates(_PIPELINE)}
    _book_file(language).write_text(json.dumps(book, ensure_ascii=False, indent=1) + "\n", "utf-8")


def release(language: str) -> None:
    """Make the .qm file of a language."""
    file = _file(language)
    _run("pyside6-lrelease", str(file), "-qm", str(file.with_suffix(".qm")))


def _file(language: str) -> Path:
    return _FOLDER / f"contactbench_{language}.ts"


def _book_file(language: str) -> Path:
    return _FOLDER / f"sentences_{language}.json"


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

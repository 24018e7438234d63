"""
Other languages: loading them, and keeping them complete.

``python -m app.translation update`` takes new strings of `app` and `widgets` into every language's .ts file and makes
the .qm files that the window loads; ``check`` says which strings are not translated, with exit code 1 if any.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

from PySide6.QtCore import QCoreApplication, QLibraryInfo, QLocale, QTranslator

LANGUAGES = {"en": "English", "de": "Deutsch"}
"""Code to name, each in its own words."""
_HERE = Path(__file__).parent
_FOLDER = _HERE / "translations"
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
    # Numbers have a decimal point in every language, as in files and reports: a comma in a spin box beside a point
    # in a sentence would be read as another number.
    QLocale.setDefault(QLocale(QLocale.Language.English, QLocale.Country.UnitedStates))
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
    return tuple(missing)


def update(language: str) -> None:
    """Take new strings into a language's file, drop those that are gone, and make what the window loads."""
    sources = sorted(
        str(file) for folder in ("app", "widgets") for file in (_HERE.parent / folder).rglob("*.py")
    )
    file = _file(language)
    _run("pyside6-lupdate", *sources, "-ts", str(file), "-no-obsolete", "-locations", "none")
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
        sys.stderr.write("usage: python -m app.translation update|release|check\n")
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

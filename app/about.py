"""What this is, which version, and under which licences its parts are."""

from __future__ import annotations

import re
from dataclasses import dataclass
from importlib.metadata import Distribution, PackageNotFoundError, distribution

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QLabel, QTextBrowser, QWidget

from contactbench import __version__
from contactbench.app.dialogs import ShowDialog
from contactbench.widgets.controls import plain_label

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")
_LONGEST = 60
_DEVELOPING = re.compile(r"""extra *== *['"]dev['"]""")  # tools, not parts
_BUNDLED = ("vtk",)  # needed by a part, and large enough to be named


@dataclass(frozen=True)
class LicensedPart:
    """A part that is installed: its name, version and licence."""

    name: str
    version: str
    licence: str


def parts() -> tuple[LicensedPart, ...]:
    """Return what contactbench needs and is there, as their own metadata say."""
    try:
        needed = distribution("contactbench").requires or []
    except PackageNotFoundError:
        needed = []
    used = [each for each in needed if _DEVELOPING.search(each) is None]
    names = {match.group() for each in used if (match := _NAME.match(each))} | set(_BUNDLED)
    found = []
    for name in sorted(names - {"contactbench"}, key=str.lower):
        try:
            part = distribution(name)
        except PackageNotFoundError:
            continue
        found.append(LicensedPart(name, part.version, _licence(part)))
    return tuple(found)


def _licence(part: Distribution) -> str:
    meta = part.metadata
    given = (meta.get_all("License-Expression") or [""])[0]
    if not given:
        classes = [each for each in meta.get_all("Classifier") or [] if each.startswith("License ::")]
        given = ", ".join(each.rpartition(":: ")[2] for each in classes)
    if not given:
        given = (meta.get_all("License") or [""])[0].strip().partition("\n")[0]
    if given.startswith("Copyright"):  # the text of a licence, not its name
        given = ""
    return given[:_LONGEST] or QCoreApplication.translate("AboutDialog", "see the package's own files")


class AboutDialog(ShowDialog):
    """The version, and the licences of the parts."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__("", (620, 520), parent)
        self.setWindowTitle(self.tr("About contactbench"))
        title = plain_label(self.tr("contactbench {}").format(__version__), "title")
        words = QLabel(
            self.tr(
                "Locates contacts on a probe from a single force/torque sensor and states how certain"
                " each one is. Licensed under the Apache License 2.0. For bench work and research only:"
                " not a medical device."
            ),
            wordWrap=True,
        )
        self.licences = QTextBrowser()
        self.licences.setAccessibleName(self.tr("Component licences"))
        rows = "".join(
            f"<tr><td>{part.name}&nbsp;&nbsp;</td><td>{part.version}&nbsp;&nbsp;</td><td>{part.licence}</td></tr>"
            for part in parts()
        )
        self.licences.setHtml(f"<table>{rows}</table>")
        self.fill(title, words, QLabel(self.tr("Components and their licences:")), self.licences)

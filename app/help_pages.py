"""The help pages: one short text for each step, and one for the first page."""

from __future__ import annotations

from importlib.resources import files

from PySide6.QtCore import QCoreApplication

from contactbench.app.translation import in_use


def page_text(name: str) -> str:
    """Return a help page, Markdown, in the language of the window where there is one."""
    folder = files("contactbench.app") / "help"
    for file in (f"{name}.{in_use()}.md", f"{name}.md"):
        page = folder / file
        if page.is_file():
            return page.read_text(encoding="utf-8")
    return QCoreApplication.translate("Help", "There is no help on this page yet.")

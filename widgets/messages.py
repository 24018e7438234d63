"""Messages of `pipeline` in the language of the window, with numbers as the reader writes them."""

from PySide6.QtCore import QCoreApplication

from contactbench.pipeline.errors import (
    ALIGN,
    CUT_OFF,
    DIAGNOSE,
    REPAIR,
    SALVAGE,
    Message,
    message,
    said_lately,
)
from contactbench.widgets.numbers import local_numbers

CONTEXT = "pipeline"
"""Where a language's file has them."""

_HERE = {
    ALIGN: message("align it on the Probe page"),
    DIAGNOSE: message("check Orientation on the Devices page"),
    REPAIR: message("choose Reload session in the File menu"),
    CUT_OFF: message("choose Open up to the damage"),
    SALVAGE: message("choose Salvage a copy, or restore a backup"),
}
"""What a window says in the place of a command."""


def translated(said: object) -> str:
    """Return a message, the text of an error, or a plain text where a language has it; others stay English."""
    text = said_lately(str(said))
    return local_numbers(text.translated(_known) if isinstance(text, Message) else _known(text))


def _known(template: str) -> str:
    return QCoreApplication.translate(CONTEXT, _HERE.get(template, template)) if template else ""

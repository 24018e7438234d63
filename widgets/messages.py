"""Messages of `pipeline` in the language of the window, with numbers as the reader writes them."""

from PySide6.QtCore import QCoreApplication

from contactbench.pipeline.errors import Message, said_lately
from contactbench.widgets.numbers import local_numbers

CONTEXT = "pipeline"
"""Where a language's file has them."""


def translated(said: object) -> str:
    """Return a message, the text of an error, or a plain text where a language has it; others stay English."""
    text = said_lately(str(said))
    return local_numbers(text.translated(_known) if isinstance(text, Message) else _known(text))


def _known(template: str) -> str:
    return QCoreApplication.translate(CONTEXT, template) if template else ""

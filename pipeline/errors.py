"""
What is said to people: messages, and the errors that wrong input causes, those that several rooms tell apart.

A message is English text that keeps the template it was made from and what was filled in.
``message(f"{arg(file)}: row {arg(row)} has no time")`` is "touches.csv: row 7 has no time" wherever a string is of
use: in a file, a log or a terminal. A window asks for it in another language, by the template
"{0}: row {1} has no time". The text of an `InputError` is a message by itself.
"""

from __future__ import annotations

import re
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from functools import lru_cache
from typing import Self, SupportsIndex

# Noncharacters, which Unicode keeps for use inside a program: they show where a message and what is filled in begin
# and end, and what is done to the next one in every language.
_OPEN, _CLOSE, _FILL, _FILLED = "\ufdd0", "\ufdd1", "\ufdd2", "\ufdd3"
_CAPITAL, _STRIP = "\ufdd4", "\ufdd5"
_MARK = re.compile("([\ufdd0-\ufdd5])")
_FIELD = re.compile(r"\{(\d+)\}")
# Texts said or asked for lately -> with marks, the latest last: files and Qt keep the text alone.
_LATELY: OrderedDict[str, str] = OrderedDict()
_AT_MOST = 10_000


class Message(str):
    """A text that a window can show in another language; everything else sees English."""

    __slots__ = ("_marked",)
    _marked: str

    def __new__(cls, marked: str) -> Self:
        """Take a text with its marks."""
        made = super().__new__(cls, _said(marked, str))
        made._marked = marked
        _note(made)
        return made

    def __reduce_ex__(self, protocol: SupportsIndex) -> tuple[type[Message], tuple[str]]:
        del protocol
        return Message, (self._marked,)

    def __str__(self) -> str:
        return self

    def __format__(self, spec: str) -> str:
        return format(self[:], spec) if spec else self

    def strip(self, characters: str | None = None) -> str:
        """Return it without blanks at its ends, in any language."""
        if characters is not None:
            return super().strip(characters)
        return Message(f"{_STRIP}{self._marked}{_FILLED}")

    def __add__(self, other: str) -> str:
        return join("", (self, other))

    def __radd__(self, other: str) -> str:
        return join("", (other, self))

    def translated(self, of: Callable[[str], str]) -> str:
        """
        Return it in another language.

        Parameters
        ----------
        of : callable
            Gives the template or the word of the other language for an English one, or what it was given.
        """
        return _said(self._marked, of)


class _Argument:
    """A value within a message."""

    __slots__ = ("_value",)

    def __init__(self, value: object) -> None:
        self._value = value

    def __format__(self, spec: str) -> str:
        return _filled(format(self._value, spec))

    def __str__(self) -> str:
        return _filled(str(self._value))

    def __repr__(self) -> str:
        return _filled(repr(self._value))


def message(text: str) -> str:
    """
    Return a text as a `Message`.

    Parameters
    ----------
    text : str
        An f-string in which each value is given as `arg`. A message stays as it is.
    """
    return text if isinstance(text, Message) else _note(_made(_OPEN + text + _CLOSE))


def arg(value: object) -> _Argument:
    """Return a value for use in the f-string of a message; an own message keeps what it knows."""
    return _Argument(value)


def said_lately(text: str) -> str:
    """Return a text that came back from a file or from Qt as the message that it was, if it was said lately."""
    marked = None if isinstance(text, Message) else _LATELY.get(text)
    return text if marked is None else Message(marked)


def all_said_lately() -> dict[str, str]:
    """Return the texts said lately, each with its marks: what `say_again` takes when the next program starts."""
    return dict(_LATELY)


def say_again(said: Mapping[str, str]) -> None:
    """Count texts as said lately that an earlier program said; one that its marks do not give is left out."""
    for text, marked in said.items():
        with suppress(RecursionError):
            if _said(marked, str) == text:
                Message(marked)


def join(separator: str, parts: Iterable[str]) -> str:
    """Return parts one after the other, as `str.join` does; messages among them keep what they know."""
    return Message(separator.join(map(_filled, parts)))


def capitalised(text: str) -> str:
    """Return a text with a capital letter first, a message in any language."""
    return Message(f"{_CAPITAL}{_filled(text)}{_FILLED}")


class InputError(ValueError):
    """
    Input that cannot be used: the message names where it is wrong and the remedy.

    Commands turn it into exit code 2. Modules derive their own error from it, here or where it is raised,
    when a caller may want to tell them apart.

    Parameters
    ----------
    text : str
        An f-string in which each value is given as `arg`, a plain text, or a message.
    """

    def __init__(self, text: str = "") -> None:
        super().__init__(message(text))


class ConfigError(InputError):
    """A runtime config that cannot be made, written or trusted: names the file, the field, and the remedy."""


class RateUnknownError(ConfigError):
    """Nobody has said how many readings a second the sensor is set to."""


class UnverifiedError(ConfigError):
    """
    An export that is refused because nobody has shown that its contacts are right.

    Attributes
    ----------
    reasons : tuple of str
        Each in a sentence.
    """

    def __init__(self, reasons: tuple[str, ...]) -> None:
        super().__init__(
            message("the config is not verified and was not written: ")
            + join(" ", reasons)
            + message(" Correct that, or export it as unverified, for trials without a person.")
        )
        self.reasons = reasons


class MeshError(InputError):
    """A mesh, or a file that should hold one, that cannot be used: names where it is wrong and the remedy."""


class MeshWarning(UserWarning):
    """A usable mesh with defects that may spoil contacts: says what, why it matters, and what to do."""


class RecordingError(InputError):
    """A recording that cannot be written or read: names the file, what is wrong, and the remedy."""


class SampleError(RecordingError):
    """One sample or event that cannot be recorded; the recording goes on without it."""


class RunError(InputError):
    """A bundle that must not be run, or an option that cannot be: says which, and the remedy."""


class OutputError(InputError):
    """Contacts that cannot be published: names where to, and the remedy."""


class ReaderGoneError(OutputError):
    """Whoever read the contacts has closed the pipe."""


def _note(said: Message) -> Message:
    _LATELY.pop(said[:], None)
    _LATELY[said[:]] = said._marked
    if len(_LATELY) > _AT_MOST:
        _LATELY.popitem(last=False)
    return said


@lru_cache(1000)  # a loop says the same thing again and again
def _made(marked: str) -> Message:
    return Message(marked)


def _filled(text: str) -> str:
    return f"{_FILL}{text._marked if isinstance(text, Message) else _MARK.sub('', text)}{_FILLED}"


def _said(marked: str, of: Callable[[str], str]) -> str:
    return _text(iter(_MARK.split(marked)), of)


def _text(tokens: Iterator[str], of: Callable[[str], str]) -> str:
    """Return what stands before the end of what is filled in."""
    text = ""
    for token in tokens:
        if token == _FILLED:
            break
        if token == _CAPITAL:
            words = _text(tokens, of)
            text += words[:1].upper() + words[1:]
        elif token == _STRIP:
            text += _text(tokens, of).strip()
        elif token == _OPEN:
            text += _message(tokens, of)
        else:
            text += _text(tokens, of) if token == _FILL else of(token)
    return text


def _message(tokens: Iterator[str], of: Callable[[str], str]) -> str:
    template = ""
    values: list[str] = []
    for token in tokens:
        if token == _CLOSE:
            break
        if token == _FILL:
            template += f"{{{len(values)}}}"
            values.append(_text(tokens, of))
        else:
            template += token
    known = dict(enumerate(values))
    return _FIELD.sub(lambda field: known.get(int(field[1]), field[0]), of(template))


# ---- remedies that are a command in a terminal: a window names its own in their place, see `widgets.messages` ----

ALIGN = message("run `contactbench probe align`")
DIAGNOSE = message("run `contactbench calibrate diagnose`")
REPAIR = message("run `contactbench session repair`")
CUT_OFF = message("run `contactbench session repair` to set this record aside")
SALVAGE = message("run `contactbench session salvage` to copy everything intact, or restore a backup")

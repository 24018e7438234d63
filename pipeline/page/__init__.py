"""Pages for people: one HTML file that needs nothing beside itself, in one style; the same content, the same bytes."""

import re
from datetime import UTC, datetime
from importlib.resources import files
from typing import Any

from contactbench.pipeline.errors import InputError

_PARTS = "parts.html.jinja"  # macros, as `parts` in every page
_SHARED = ("base.html.jinja", _PARTS)
# Text of a page, and in it what keeps a number and its unit on one line.
_TEXT = re.compile(r">[^<]+<")
_UNITS = "mm²|mm|cm|µm|m|mN·m/h|mN·m|N·m|N/h|N|kg|g|ms|µs|min|s|h|kHz|Hz|MiB|%|×|°C|sigma|UTC"
_BEFORE_UNIT = re.compile(rf"(?<=\d) (?=(?:{_UNITS})(?![\w·²]))|(?<=\d) (?=± \d)|(?<=±) (?=\d)")
# Control characters, halves of characters, and what turns the direction of writing.
_UNPRINTABLE = re.compile("[\0-\x1f\x7f-\x9f\ud800-\udfff\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")


def render(package: str, **content: Any) -> str:
    """
    Return a page.

    Parameters
    ----------
    package : str
        Whose ``page.html.jinja`` fills the blocks of ``base.html.jinja`` here, with the macros of ``parts``.
    **content
        What the templates name.
    """
    from jinja2 import (  # takes a while, and most runs write no page
        Environment,
        FunctionLoader,
        StrictUndefined,
    )

    def source(name: str) -> str:
        place = __package__ if name in _SHARED else package
        return files(place).joinpath(name).read_text("utf-8")

    environment = Environment(
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=_finalize,
        loader=FunctionLoader(source),
    )
    parts = environment.get_template(_PARTS).module
    page: str = environment.get_template("page.html.jinja").render(parts=parts, **content)
    return _TEXT.sub(lambda match: _BEFORE_UNIT.sub("\N{NO-BREAK SPACE}", match[0]), page)


def printable(text: str) -> str:
    """Replace what no page can hold."""
    return _UNPRINTABLE.sub(lambda match: " " if match[0].isspace() else "\N{REPLACEMENT CHARACTER}", text)


def moment(created: datetime | None) -> str | None:
    """Return a time as pages have it; InputError if it has no time zone."""
    if created is None:
        return None
    if created.tzinfo is None:
        raise InputError("created: the time has no zone: use datetime.now(UTC).")
    return created.astimezone(UTC).strftime("%Y-%m-%d %H:%M UTC")


def _finalize(value: Any) -> Any:
    """Replace what no page can hold; markup, a class of its own, stays as it is."""
    return printable(value) if type(value) is str else value

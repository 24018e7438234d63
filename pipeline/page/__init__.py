"""Pages for people: one HTML file that needs nothing else, in one style, or a PDF; equal content, equal bytes."""

import re
from datetime import UTC, datetime
from importlib import import_module
from importlib.resources import files
from importlib.util import find_spec
from typing import Any

from contactbench.pipeline.errors import InputError

APPENDIX = '<div id="appendix"></div>'  # stands between a report's first page and what follows it
_SIZES = ("", "tight", "tightest")  # classes of the page, until its first part fits on one sheet
_SVG = re.compile(r"<svg.*?</svg>", re.DOTALL)
_ROOT = re.compile(r":root \{(.*?)\}", re.DOTALL)
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


def print_pdf(html: str) -> bytes:
    """
    Print a page to PDF, A4; what comes before `APPENDIX` is made to fit on the first sheet.

    Raises
    ------
    InputError
        WeasyPrint, an optional package, is missing or cannot work here.
    """
    weasyprint = _weasyprint()
    # Pictures stand in the page itself; nothing is fetched from outside.
    fetcher = weasyprint.urls.URLFetcher(allowed_protocols=["data"])
    html = in_plain_colours(html)
    first, appendix, _ = html.partition(APPENDIX)
    for size in _SIZES:
        alone = weasyprint.HTML(string=_sized(first, size), url_fetcher=fetcher)
        if not appendix or len(alone.render().pages) == 1:
            break
    data: bytes = weasyprint.HTML(string=_sized(html, size), url_fetcher=fetcher).write_pdf()
    return data


def _sized(html: str, size: str) -> str:
    return html.replace("<html ", f'<html class="{size}" ', 1) if size else html


def in_plain_colours(html: str) -> str:
    """Return a page whose pictures have colours instead of the style sheet's variables, which PDFs do not know."""
    root = _ROOT.search(html)
    colours = dict(re.findall(r"--([a-z-]+): (#[0-9a-f]{6})", root[1] if root else ""))

    def drawn(match: re.Match[str]) -> str:
        text = match[0].replace("currentColor", colours.get("ink", "#000000"))
        return re.sub(r"var\(--([a-z-]+)\)", lambda role: colours.get(role[1], role[0]), text)

    return _SVG.sub(drawn, html)


def _weasyprint() -> Any:
    remedy = "pip install 'contactbench[pdf]', or print the HTML file with a browser."
    if find_spec("weasyprint") is None:
        raise InputError(f"a PDF needs the package WeasyPrint: {remedy}")
    try:
        return import_module("weasyprint")
    except OSError as error:  # it loads Pango, a library of the system
        raise InputError(
            f"WeasyPrint cannot load Pango ({error}): on Debian and Ubuntu apt-get install libpango-1.0-0"
            " libpangoft2-1.0-0; or print the HTML file with a browser."
        ) from error

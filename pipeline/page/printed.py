"""A page on paper: PDF, A4, by WeasyPrint."""

import re
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from contactbench.pipeline.errors import InputError

APPENDIX = '<div id="appendix"></div>'  # stands between a report's first page and what follows it
_SIZES = ("", "tight", "tightest")  # classes of the page, until its first part fits on one sheet
_SVG = re.compile(r"<svg.*?</svg>", re.DOTALL)
_ROOT = re.compile(r":root \{(.*?)\}", re.DOTALL)


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

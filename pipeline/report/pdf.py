"""The page on paper."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

from contactbench.pipeline.report.errors import ReportError


def report_pdf(html: str) -> bytes:
    """
    Print a report's page to PDF, A4.

    Raises
    ------
    ReportError
        WeasyPrint, an optional package, is missing or cannot work here.
    """
    remedy = "pip install 'contactbench[pdf]', or print the HTML file with a browser."
    if find_spec("weasyprint") is None:
        raise ReportError(f"a PDF needs the package WeasyPrint: {remedy}")
    try:
        weasyprint = import_module("weasyprint")
    except OSError as error:  # it loads Pango, a library of the system
        raise ReportError(
            f"WeasyPrint cannot load Pango ({error}): on Debian and Ubuntu apt-get install libpango-1.0-0"
            " libpangoft2-1.0-0; or print the HTML file with a browser."
        ) from error
    # Pictures stand in the page itself; nothing is fetched from outside.
    fetcher = weasyprint.urls.URLFetcher(allowed_protocols=["data"])
    data: bytes = weasyprint.HTML(string=html, url_fetcher=fetcher).write_pdf()
    return data

"""How a session makes a report; the same inputs, parameters and time give the same bytes."""

from __future__ import annotations

from datetime import datetime
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from pydantic import Field

from contactbench.pipeline.calibration.parameters import Parameters, check_roles, sha256_of
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.verification.known_check import TOUCH, WEIGHT, read_check

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

_ROLES = ("verification", "probe", "calibration", WEIGHT, TOUCH)


class ReportParameters(Parameters):
    """Who made the report, and of what: as `ReportContent`."""

    endings = (".html", ".pdf")

    name: str = "report.html"
    operator: str = ""
    session: str = ""
    serials: dict[str, str] = Field(default_factory=dict)


def report(
    inputs: Mapping[str, Path], parameters: Mapping[str, Any], created: str | None
) -> dict[str, bytes]:
    """
    Make the report of ``verification`` on ``probe``; ``calibration`` and the two checks may be left out.

    Raises
    ------
    InputError
        An input is missing, unusable or not the one that was verified, or a parameter is wrong.
    """
    from contactbench.pipeline.calibration.files.calibration_file import load_record
    from contactbench.pipeline.mesh.sidecar import load_probe_file
    from contactbench.pipeline.report.page import ReportContent, report_html
    from contactbench.pipeline.report.verification_file import read_verification

    given = ReportParameters.checked(parameters)
    check_roles(inputs, _ROLES[:2], _ROLES[2:])
    verification = read_verification(inputs["verification"])
    hashes = {role: sha256_of(inputs[role]) for role in _ROLES if role in inputs}
    check_sources(verification.sources, hashes, inputs)
    content = ReportContent(
        verification,
        load_probe_file(inputs["probe"]),
        load_record(inputs["calibration"]) if "calibration" in inputs else None,
        None if created is None else datetime.fromisoformat(created),
        given.operator,
        given.session,
        given.serials,
        {f"{role} ({inputs[role].name})": sha256 for role, sha256 in hashes.items()},
        {kind: read_check(kind, inputs[kind]) for kind in (WEIGHT, TOUCH) if kind in inputs},
    )
    page = report_html(content)
    return {given.name: report_pdf(page) if given.name.endswith(".pdf") else page.encode()}


def report_pdf(html: str) -> bytes:
    """
    Print a report's page to PDF, A4.

    Raises
    ------
    InputError
        WeasyPrint, an optional package, is missing or cannot work here.
    """
    remedy = "pip install 'contactbench[pdf]', or print the HTML file with a browser."
    if find_spec("weasyprint") is None:
        raise InputError(f"a PDF needs the package WeasyPrint: {remedy}")
    try:
        weasyprint = import_module("weasyprint")
    except OSError as error:  # it loads Pango, a library of the system
        raise InputError(
            f"WeasyPrint cannot load Pango ({error}): on Debian and Ubuntu apt-get install libpango-1.0-0"
            " libpangoft2-1.0-0; or print the HTML file with a browser."
        ) from error
    # Pictures stand in the page itself; nothing is fetched from outside.
    fetcher = weasyprint.urls.URLFetcher(allowed_protocols=["data"])
    data: bytes = weasyprint.HTML(string=html, url_fetcher=fetcher).write_pdf()
    return data


def check_sources(sources: Mapping[str, str], hashes: Mapping[str, str], files: Mapping[str, Path]) -> None:
    """
    Refuse files that are not those of a verification.

    Parameters
    ----------
    sources : mapping of str to str
        SHA-256 of what was verified, by role.
    hashes : mapping of str to str
        SHA-256 of the files, by role.
    files : mapping of str to Path
        For the message.

    Raises
    ------
    InputError
        A probe or a calibration is another one. What the verification does not tell cannot be compared.
    """
    for role in ("probe", "calibration"):
        if role in hashes and sources.get(role, hashes[role]) != hashes[role]:
            raise InputError(
                f"{files[role]}: this is not the {role} that was verified (SHA-256 {hashes[role][:12]}, verified:"
                f" {sources[role][:12]}): give the {role} that {files['verification'].name} was made with, or verify"
                " again with this one."
            )

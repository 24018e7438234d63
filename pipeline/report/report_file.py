"""How a session makes a report; the same inputs, parameters and time give the same bytes."""

from collections.abc import Mapping
from datetime import datetime
from typing import Any

from pydantic import Field

from contactbench.pipeline.calibration.parameters import Parameters, check_roles, sha256_of
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.files import File
from contactbench.pipeline.page import print_pdf
from contactbench.pipeline.page.details import ReportDetails
from contactbench.pipeline.settings import ReportSettings
from contactbench.pipeline.verification.known_check import TOUCH, WEIGHT, read_check

_ROLES = ("verification", "probe", "calibration", WEIGHT, TOUCH)


class ReportParameters(ReportSettings, Parameters):
    """Who made the report, and of what: as `ReportContent`."""

    endings = (".html", ".pdf")

    name: str = "report.html"
    session: str = ""
    serials: dict[str, str] = Field(default_factory=dict)


def report(
    inputs: Mapping[str, File], parameters: Mapping[str, Any], created: str | None
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
        ReportDetails(given.operator, given.sensor, given.certificate, given.due, given.serials),
        given.session,
        {f"{role} ({inputs[role].name})": sha256 for role, sha256 in hashes.items()},
        {kind: read_check(kind, inputs[kind]) for kind in (WEIGHT, TOUCH) if kind in inputs},
    )
    page = report_html(content)
    return {given.name: print_pdf(page) if given.name.endswith(".pdf") else page.encode()}


def check_sources(sources: Mapping[str, str], hashes: Mapping[str, str], files: Mapping[str, File]) -> None:
    """
    Refuse files that are not those of a verification.

    Parameters
    ----------
    sources : mapping of str to str
        SHA-256 of what was verified, by role.
    hashes : mapping of str to str
        SHA-256 of the files, by role.
    files : mapping of str to File
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

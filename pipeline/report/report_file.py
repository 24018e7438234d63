"""How a session reads a verification and makes a report; the same inputs, parameters and time give the same bytes."""

import json
from collections.abc import Mapping
from datetime import datetime
from typing import Any

from pydantic import Field, TypeAdapter, ValidationError

from contactbench.pipeline.calibration.parameters import Parameters, check_roles, sha256_of
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.files import File, read_bytes
from contactbench.pipeline.page import print_pdf
from contactbench.pipeline.page.details import ReportDetails
from contactbench.pipeline.settings import ReportSettings
from contactbench.pipeline.verification.figures import SCHEMA, VERSION, Verification
from contactbench.pipeline.verification.known_check import TOUCH, WEIGHT, read_check

_LARGEST = 64 * 2**20
_REMEDY = "choose a file that `contactbench verify touches --out` wrote."


def read_verification(file: File) -> Verification:
    """
    Read what ``contactbench verify touches --out`` wrote.

    Raises
    ------
    InputError
        The file is missing, too large, not JSON, of another kind or a newer version, or a field is wrong.
    """
    data = read_bytes(file, _LARGEST)
    if len(data) > _LARGEST:
        raise InputError(f"{file}: larger than {_LARGEST >> 20} MiB: {_REMEDY}")
    return parse_verification(data, str(file))


def parse_verification(data: bytes, name: str) -> Verification:
    """Return the verification of a JSON text; InputError."""
    try:
        content: Any = json.loads(data, parse_constant=_refuse)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{name}: this is not JSON ({error}): {_REMEDY}") from error
    if not isinstance(content, dict) or content.get("schema") != SCHEMA:
        raise InputError(f"{name}: this is no verification: {_REMEDY}")
    if content.get("version") != VERSION:
        raise InputError(
            f"{name}: version {content.get('version')} is unknown, this program reads {VERSION}: update contactbench."
        )
    try:
        return TypeAdapter(Verification).validate_python(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"]))
        raise InputError(f"{name}: {where}: {first['msg']}: {_REMEDY}") from error


def _refuse(constant: str) -> None:
    raise ValueError(f"{constant} is no number")


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

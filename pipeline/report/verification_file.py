"""Verifications from their JSON files."""

import json
from typing import Any

from pydantic import TypeAdapter, ValidationError

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.files import File, read_bytes
from contactbench.pipeline.verification.figures import SCHEMA, VERSION, Verification

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

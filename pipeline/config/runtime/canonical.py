"""
JSON with one spelling, and a reader that takes nothing ambiguous.

Canonical: UTF-8, keys in the order of their code points, no spaces, numbers as Python's ``repr`` writes them (the
shortest digits that read back as the same double), one line feed at the end. The same content gives the same bytes.
"""

import json
from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from contactbench.pipeline.config.runtime.migrate import migrated
from contactbench.pipeline.config.runtime.model import SCHEMA, VERSION, RuntimeModel
from contactbench.pipeline.errors import ConfigError, arg, message
from contactbench.pipeline.files import not_of_kind

_REMEDY = message("export the config again.")
_LONGEST = 60


def encode_json(content: Mapping[str, Any]) -> bytes:
    """
    Write a JSON object in its one spelling.

    Raises
    ------
    ConfigError
        A number is not finite, or a text is no Unicode.
    """
    try:
        return _spelled(content)
    except ValueError as error:
        raise ConfigError(f"the config cannot be written ({arg(error)}): {arg(_REMEDY)}") from error


def decode_json(data: bytes, name: str) -> tuple[RuntimeModel, int]:
    """
    Read a config of this version or an older one; returns the version, too, in which it was written.

    Parameters
    ----------
    data : bytes
    name : str
        What messages call it.

    Raises
    ------
    ConfigError
        It is no JSON object in its one spelling, is of another kind or a newer version, or a field is missing,
        unknown, of the wrong type or out of range.
    """
    written = _checked_kind(_parse(data, name), name)
    try:
        return RuntimeModel.model_validate(migrated(written, name)), written["version"]
    except ValidationError as error:
        raise ConfigError(f"{arg(name)}: {arg(fault_of(error))}: {arg(_REMEDY)}") from None


def json_schema() -> bytes:
    """Return the JSON Schema of a config, as it is checked in."""
    schema = RuntimeModel.model_json_schema(by_alias=True)
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "$id": f"{SCHEMA}.{VERSION}"}
    return (json.dumps({**head, **schema}, indent=1, sort_keys=True, ensure_ascii=False) + "\n").encode()


def first_difference(one: bytes, other: bytes) -> int:
    """Return the place of the first byte in which two texts differ; the shorter one's end if that is all."""
    pairs = enumerate(zip(one, other, strict=False))
    return next((place for place, (a, b) in pairs if a != b), min(len(one), len(other)))


def fault_of(error: ValidationError) -> str:
    """Return the first thing that a schema found wrong: the field, the value, and why."""
    fault = error.errors(include_url=False, include_context=False)[0]
    where = ".".join(str(part) for part in fault["loc"]) or message("the content")
    value = fault["input"]
    shown = (
        "" if isinstance(value, dict | list) or fault["type"] == "missing" else f" is {value!a:.{_LONGEST}}"
    )
    return message(f"{arg(where)}{arg(shown)}: {arg(fault['msg'])}")


def _parse(data: bytes, name: str) -> dict[str, Any]:
    try:
        content = json.loads(data.decode())
        spelled = _spelled(content)
    except (ValueError, RecursionError) as error:
        raise ConfigError(f"{arg(name)}: not valid JSON ({arg(str(error)[:200])}): {arg(_REMEDY)}") from None
    if not isinstance(content, dict):
        raise ConfigError(f"{arg(name)}: not a JSON object: {arg(_REMEDY)}")
    # Readers differ in what they make of a key that occurs twice, of 1e999 or of a byte after the end.
    if spelled != data:
        raise ConfigError(
            f"{arg(name)}: byte {arg(first_difference(data, spelled))} differs from what contactbench writes"
            " (a space, a duplicate or misplaced key, or another spelling of a number or a text):"
            f" {arg(_REMEDY)}"
        )
    return content


def _spelled(content: object) -> bytes:
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return (text + "\n").encode()


def _checked_kind(content: dict[str, Any], name: str) -> dict[str, Any]:
    if why := not_of_kind(content, SCHEMA, VERSION, message("a runtime config")):
        raise ConfigError(f"{arg(name)}: {arg(why)}")
    version = content.get("version")
    if isinstance(version, bool) or not isinstance(version, int):
        raise ConfigError(
            f"{arg(name)}: version is {arg(ascii(version)[:_LONGEST])}, not a whole number: {arg(_REMEDY)}"
        )
    return content

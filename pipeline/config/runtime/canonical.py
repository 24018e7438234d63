"""
JSON with one spelling, and a reader that takes nothing ambiguous.

Canonical: UTF-8, keys in the order of their code points, no spaces, numbers as Python's ``repr`` writes them (the
shortest digits that read back as the same double), one line feed at the end. The same content gives the same bytes.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError
from pydantic_core import from_json

from pipeline.config.runtime.errors import ConfigError
from pipeline.config.runtime.migrate import migrated
from pipeline.config.runtime.model import SCHEMA, VERSION, RuntimeModel

if TYPE_CHECKING:
    from collections.abc import Mapping

_REMEDY = "export the config again."
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
        text = json.dumps(content, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
        return (text + "\n").encode()
    except ValueError as error:
        raise ConfigError(f"the config cannot be written ({error}): {_REMEDY}") from error


def decode_json(data: bytes, name: str) -> RuntimeModel:
    """
    Read a config of this version or an older one.

    Parameters
    ----------
    data : bytes
    name : str
        What messages call it.

    Raises
    ------
    ConfigError
        It is no JSON object, names a key twice, is of another kind or a newer version, or a field is missing,
        unknown, of the wrong type or out of range.
    """
    content = migrated(_checked_kind(_parse(data, name), name), name)
    try:
        return RuntimeModel.model_validate(content)
    except ValidationError as error:
        raise ConfigError(f"{name}: {fault_of(error)}: {_REMEDY}") from None


def json_schema() -> bytes:
    """Return the JSON Schema of a config, as it is checked in."""
    schema = RuntimeModel.model_json_schema(by_alias=True)
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "$id": f"{SCHEMA}.{VERSION}"}
    return (json.dumps({**head, **schema}, indent=1, sort_keys=True, ensure_ascii=False) + "\n").encode()


def fault_of(error: ValidationError) -> str:
    """Return the first thing that a schema found wrong: the field, the value, and why."""
    fault = error.errors(include_url=False, include_context=False)[0]
    where = ".".join(str(part) for part in fault["loc"]) or "the content"
    value = fault["input"]
    shown = (
        "" if isinstance(value, dict | list) or fault["type"] == "missing" else f" is {value!a:.{_LONGEST}}"
    )
    return f"{where}{shown}: {fault['msg']}"


def _parse(data: bytes, name: str) -> dict[str, Any]:
    try:
        from_json(data, allow_inf_nan=False)  # first: it bounds the depth, and takes nothing but UTF-8
        content = json.loads(data.decode(), object_pairs_hook=_once, parse_constant=_no_number)
    except (ValueError, RecursionError) as error:
        raise ConfigError(f"{name}: this is not sound JSON ({error!s:.200}): {_REMEDY}") from None
    if not isinstance(content, dict):
        raise ConfigError(f"{name}: this is no JSON object: {_REMEDY}")
    return content


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return an object; whoever reads the first of two values, and who the last, would not agree."""
    content = dict(pairs)
    if len(content) < len(pairs):
        names = [key for key, _ in pairs]
        twice = next(key for key in names if names.count(key) > 1)
        raise ValueError(f"the key {twice!a:.{_LONGEST}} is there twice")
    return content


def _no_number(text: str) -> float:
    raise ValueError(f"{text} is no number")


def _checked_kind(content: dict[str, Any], name: str) -> dict[str, Any]:
    schema, version = content.get("schema"), content.get("version")
    if schema != SCHEMA:
        raise ConfigError(
            f"{name}: schema is {schema!a:.{_LONGEST}}, not {SCHEMA!r}: choose a runtime config."
        )
    if isinstance(version, bool) or not isinstance(version, int):
        raise ConfigError(f"{name}: version is {version!a:.{_LONGEST}}, not a whole number: {_REMEDY}")
    if version > VERSION:
        raise ConfigError(
            f"{name}: version is {version}, and this contactbench reads up to {VERSION}: update contactbench."
        )
    return content

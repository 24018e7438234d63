"""Configs of older versions: what each step to the next version changes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pipeline.config.runtime.errors import ConfigError
from pipeline.config.runtime.model import VERSION

if TYPE_CHECKING:
    from collections.abc import Callable

# Version -> what turns its JSON object into one of the next version. Version 1 is the first.
STEPS: dict[int, Callable[[dict[str, Any]], dict[str, Any]]] = {}


def migrated(content: dict[str, Any], name: str) -> dict[str, Any]:
    """
    Return a JSON object of the present version.

    Parameters
    ----------
    content : dict
        Of this version or an older one; its version is a whole number.
    name : str
        What messages call it.

    Raises
    ------
    ConfigError
        There never was such a version, or its content cannot be carried over.
    """
    while content["version"] < VERSION:
        version = content["version"]
        step = STEPS.get(version)
        if step is None:
            raise ConfigError(f"{name}: there is no version {version}: export the config again.")
        try:
            content = {**step(content), "version": version + 1}
        except (KeyError, TypeError, ValueError) as error:
            raise ConfigError(
                f"{name}: this config of version {version} cannot be carried over ({error!r:.100}): export it again."
            ) from error
    return content

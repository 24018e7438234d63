"""What belongs to an input: files beside it, and what it says about itself."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.mesh.sidecar import SCHEMA, read_document, sidecar_of
from contactbench.pipeline.recording import RecordingReader
from contactbench.pipeline.session.journal import SessionError

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path


def companions_of(file: Path, more: Iterable[Path] = ()) -> dict[str, Path]:
    """
    Return what belongs beside a file: name -> path. The JSON file of a probe's PLY file is found by itself.

    Raises
    ------
    SessionError
        Two of them, or one and the file, have the same name.
    """
    found = [*more]
    if _has_sidecar(file) and sidecar_of(file).name not in {each.name for each in found}:
        found.append(sidecar_of(file))
    names = [each.name.casefold() for each in (file, *found)]
    if len(set(names)) < len(names):
        raise SessionError(f"{arg(file)}: two files of one input have the same name: rename one.")
    return {each.name: each for each in found}


def _has_sidecar(file: Path) -> bool:
    """Tell whether a JSON file beside a PLY file says that it is a probe's."""
    if file.suffix.lower() != ".ply" or not sidecar_of(file).is_file():
        return False
    try:
        return read_document(sidecar_of(file)).get("schema") == SCHEMA
    except InputError:  # another program's file; who needs it names it
        return False


def about_of(file: Path) -> dict[str, str]:
    """Return what is known about an input by itself: of a recording, when it was started. Empty for other files."""
    if file.suffix.lower() != ".mcap":
        return {}
    try:
        with RecordingReader(file) as reader:
            started_ns = reader.info.started_ns
        return {"started": datetime.fromtimestamp(started_ns / 1e9, UTC).isoformat()}
    except (InputError, ValueError, OverflowError, OSError):  # whoever computes from it says what is wrong
        return {}

"""What a result is, apart from when and by whom it was made."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

from contactbench.pipeline.session.frames import canonical

if TYPE_CHECKING:
    from collections.abc import Mapping

    from contactbench.pipeline.session.actions import FileRef, ResultAdded


def main_file(action: ResultAdded) -> str:
    """Return the name of the file that other results refer to: the one named after the result, or the first."""
    return action.name if action.name in action.files else min(action.files)


def content_hash(action: ResultAdded) -> str:
    """SHA-256 over kind, name, inputs, parameters and files: 64 hexadecimal digits. No time goes into it."""
    content = {
        "kind": action.kind,
        "name": action.name,
        "inputs": action.inputs,
        "parameters": action.parameters,
        "files": {name: file.sha256 for name, file in action.files.items()},
    }
    return hashlib.sha256(canonical(content)).hexdigest()


def input_hash(file: FileRef, companions: Mapping[str, FileRef]) -> str:
    """Return what results refer to an input by: its file's SHA-256 or, with companions, one over all of them."""
    if not companions:
        return file.sha256
    content = {
        "file": file.sha256,
        "companions": {name: companion.sha256 for name, companion in companions.items()},
    }
    return hashlib.sha256(canonical(content)).hexdigest()

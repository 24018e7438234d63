"""
Steps on a probe's regions that outlive the program: in a file beside the probe, ``probe.undo``.

It holds, step by step, the regions as they were before and what the step left in the probe's history. It belongs to the
probe's two files as the last step left them; once something else has changed one of them, no step fits any more.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import arg
from contactbench.pipeline.mesh.regions.exchange import (
    SIZE_LIMIT,
    decode_json,
    encode_json,
    parse_json,
    read_limited,
)
from contactbench.pipeline.mesh.regions.region import RegionError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from contactbench.pipeline.mesh.probe import Probe
    from contactbench.pipeline.mesh.regions.region import RegionSet

FORMAT, VERSION = "contactbench region steps", 1
MOST_STEPS = 100


@dataclass(frozen=True)
class KeptStep:
    """
    One step, done or undone.

    Attributes
    ----------
    text : str
        What was done: "paint Lens".
    entry : mapping
        What the step wrote into the probe's history.
    other : mapping
        The regions on its other side, as `encode_json` writes them: before it if it is done, after it if it is undone.
    """

    text: str
    entry: Mapping[str, Any]
    other: Mapping[str, Any]

    @classmethod
    def of(cls, text: str, entry: Mapping[str, Any], other: RegionSet, probe: Probe) -> KeptStep:
        """Make one of regions on a mesh."""
        return cls(text, entry, json.loads(encode_json(other, probe)))

    def regions(self, probe: Probe) -> RegionSet:
        """Return `other` on its mesh; RegionError if they cannot be on this one."""
        return decode_json(json.dumps(self.other).encode(), probe)


@dataclass
class KeptSteps:
    """
    What can be undone and redone.

    Attributes
    ----------
    done, undone : list of KeptStep
        The newest last: the next to be undone, and to be redone.
    changed : bool
        There were steps, but something else has changed the probe since.
    """

    done: list[KeptStep] = field(default_factory=list)
    undone: list[KeptStep] = field(default_factory=list)
    changed: bool = False


def undo_file_of(mesh: Path) -> Path:
    """Return the file of steps that belongs to a probe's PLY file."""
    return mesh.with_suffix(".undo")


def load_steps(files: Sequence[Path]) -> KeptSteps:
    """
    Read the steps of a probe; none without a file, or once something else has changed the probe.

    Parameters
    ----------
    files : sequence of path
        The probe's files, the PLY file first.

    Raises
    ------
    RegionError
        The file is not one of steps.
    """
    file = undo_file_of(files[0])
    if not file.exists():
        return KeptSteps()
    try:
        document = parse_json(read_limited(file))
        steps = KeptSteps(_steps(document, "done"), _steps(document, "undone"))
    except RegionError as error:
        raise RegionError(
            f"{arg(file)}: {arg(error)} Delete the file: the regions stay as they are, but cannot be undone."
        ) from error
    return steps if document.get("files") == _digests(files) else KeptSteps(changed=True)


def save_steps(steps: KeptSteps, files: Sequence[Path]) -> None:
    """
    Write the steps of a probe whose files are written already; the oldest go where there are too many.

    Raises
    ------
    RegionError
        They cannot be written.
    """
    file, done = undo_file_of(files[0]), steps.done[-MOST_STEPS:]
    head = {"format": FORMAT, "version": VERSION, "files": _digests(files)}
    while len(data := _encoded({**head, "done": done, "undone": steps.undone})) > SIZE_LIMIT and done:
        done = done[1 + len(done) // 2 :]
    try:
        write_durably(file, data)
    except (OSError, ValueError) as error:
        raise RegionError(
            f"{arg(file)}: cannot be written ({arg(error)}): this step cannot be undone."
        ) from error


def _encoded(document: Mapping[str, Any]) -> bytes:
    return (json.dumps(document, ensure_ascii=False, allow_nan=False, default=vars) + "\n").encode()


def _steps(document: Mapping[str, Any], key: str) -> list[KeptStep]:
    found = document.get(key)
    known = document.get("format") == FORMAT and document.get("version") == VERSION
    if not known or not isinstance(found, list):
        raise RegionError("this file does not contain region steps, or has another version.")
    steps = []
    for number, each in enumerate(found, 1):
        kinds = {"text": str, "entry": dict, "other": dict}
        if not isinstance(each, dict) or any(not isinstance(each.get(k), kind) for k, kind in kinds.items()):
            raise RegionError(f"step {arg(number)} of {arg(key)!r} lacks its text, entry or regions.")
        if not isinstance(each["entry"].get("step"), str):  # it goes into the probe's history
            raise RegionError(f"the entry of step {arg(number)} of {arg(key)!r} has no name.")
        steps.append(KeptStep(each["text"], each["entry"], each["other"]))
    return steps


def _digests(files: Sequence[Path]) -> dict[str, str]:
    """Return the hashes of the files by their suffix: a folder that is copied or renamed keeps its steps."""
    return {file.suffix: hashlib.sha256(file.read_bytes()).hexdigest() for file in files if file.exists()}

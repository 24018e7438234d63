"""Runs that are done, kept in files: a long table goes on where it was stopped."""

from __future__ import annotations

import hashlib
import json
import zlib
from dataclasses import asdict, dataclass, fields
from functools import cache
from importlib import metadata
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import BadZipFile

import numpy as np
from benchmarks.reproduce.dynamic_cells import Cell, Outcome
from pydantic import TypeAdapter

from contactbench import pipeline
from contactbench.pipeline.control.states import Change, State
from contactbench.pipeline.control.trace import Trace
from contactbench.pipeline.durable import make_folder
from contactbench.pipeline.study.sheets import write_bytes

if TYPE_CHECKING:
    from contactbench.pipeline.control.settings import ControlSettings

# What a run computes with; other parts may change, and it stays what it was.
_SOURCES = ("control", "simulation", "contact", "study/control_rig.py")
_UNUSED = ("control/bundle.py", "control/virtual.py", "control/tuning.py", "control/margins.py")


@dataclass(frozen=True)
class Store:
    """
    A folder of runs.

    A run is found again only with the same cell and gains, computed by the same code and the same MuJoCo: all are in
    the name of its file. A file that is damaged counts as none.
    """

    folder: Path
    settings: ControlSettings | None = None

    def take(self, cell: Cell, *, traced: bool) -> tuple[Outcome, Trace | None] | None:
        """Return a run that was kept, with its trace if that is wanted; None: it is to be done."""
        name = self._name(cell)
        try:
            told = json.loads((self.folder / f"{name}.json").read_bytes())
            outcome = _OUTCOMES.validate_python(told["outcome"])
            trace = _trace(self.folder / f"{name}.npz", told["changes"]) if traced else None
        except (OSError, ValueError, KeyError, TypeError, EOFError, BadZipFile, zlib.error):
            return None
        return (outcome, trace) if outcome.cell == cell else None

    def keep(self, outcome: Outcome, trace: Trace | None) -> None:
        """Keep a run."""
        make_folder(self.folder)
        name = self._name(outcome.cell)
        changes = [] if trace is None else [asdict(each) for each in trace.changes]
        if trace is not None:
            data = BytesIO()
            np.savez_compressed(data, **_columns(trace))
            write_bytes(self.folder / f"{name}.npz", data.getvalue())
        told = {"outcome": asdict(outcome), "changes": changes}
        write_bytes(self.folder / f"{name}.json", (json.dumps(told, indent=1) + "\n").encode())

    def _name(self, cell: Cell) -> str:
        gains = None if self.settings is None else asdict(self.settings)
        text = json.dumps(
            [asdict(cell), gains, code_print(Path(__file__).with_name("dynamic_cells.py"))], sort_keys=True
        )
        return hashlib.sha256(text.encode()).hexdigest()[:32]


@cache
def code_print(*more: Path) -> str:
    """Return a hash of the code that a closed loop is computed by, and of more files."""
    home = Path(pipeline.__file__).parent
    sources = sorted(
        file
        for each in _SOURCES
        for file in ([home / each] if each.endswith(".py") else (home / each).rglob("*.py"))
    )
    made = hashlib.sha256(metadata.version("mujoco").encode())
    for file in sources:
        name = file.relative_to(home).as_posix()
        if name not in _UNUSED:
            made.update(name.encode() + file.read_bytes())
    for file in more:
        made.update(file.name.encode() + file.read_bytes())
    return made.hexdigest()


def _columns(trace: Trace) -> dict[str, Any]:
    return {each.name: getattr(trace, each.name) for each in fields(trace) if each.name != "changes"}


def _trace(file: Path, changes: list[dict[str, Any]]) -> Trace:
    with np.load(file, allow_pickle=False) as found:
        columns = {name: found[name] for name in found.files}
    told = [
        Change(each["time"], State(each["before"]), State(each["after"]), each["reason"]) for each in changes
    ]
    return Trace(**columns, changes=tuple(told))


_OUTCOMES = TypeAdapter(Outcome)

"""The child process of the mesh fuzz: reads hostile files and says what came of each, a line of JSON per file.

Started as ``python -m benchmarks.mesh_fuzz.worker seed first last``. It says which file it
begins with before
it does, so that whoever started it knows which one it died of.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
import tracemalloc
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.mesh_fuzz.cases import make_case, sound_files

from contactbench.pipeline.mesh import MeshError, MeshWarning, Probe, load_probe, save_probe
from contactbench.pipeline.mesh.probe import degenerate_facets

if TYPE_CHECKING:
    from benchmarks.mesh_fuzz.cases import FuzzCase

    from contactbench.pipeline.mesh.load import Units

# Far more than any of the files may take, far less than would make the machine swap.
_ADDRESS_SPACE = 4 * 2**30


def main(seed: int, first: int, last: int) -> None:
    """Read the cases from first to last, not included, and write one line for each to standard output."""
    _limit_memory()
    warnings.simplefilter("error")
    warnings.simplefilter("ignore", MeshWarning)
    with tempfile.TemporaryDirectory() as folder:
        _warm_up(Path(folder))
        for number in range(first, last):
            case = make_case(seed, number)
            _say({"begins": number, "suffix": case.suffix, "kind": case.kind, "bytes": len(case.data)})
            _say(try_case(case, Path(folder), "auto" if number % 2 else "mm"))


def try_case(case: FuzzCase, folder: Path, units: Units | str) -> dict[str, Any]:
    """Read one file and judge what comes of it."""
    path = folder / f"case{case.suffix}"
    path.write_bytes(case.data)
    # Of the processor: a busy machine is not the file's fault.
    began = time.process_time()
    outcome, why = _read(path, units)
    seconds = time.process_time() - began
    tracemalloc.start()
    again, _ = _read(path, units)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    if again != outcome:
        outcome, why = "wrong", f"{outcome} at first, {again} when read again"
    if outcome == "valid":
        fault = _fault(load_probe(path, units), folder)  # type: ignore[arg-type]
        outcome, why = ("wrong", fault) if fault else (outcome, why)
    return {"outcome": outcome, "why": why, "seconds": seconds, "peak": peak}


def _read(path: Path, units: str) -> tuple[str, str]:
    try:
        load_probe(path, units)  # type: ignore[arg-type]
    except MeshError as error:
        named = str(error).startswith(f"{path}: ") and len(str(error)) < 2000
        return ("refused", "") if named else ("wrong", f"an error that does not name the file: {error}"[:300])
    except Exception as error:  # noqa: BLE001 - that it is none of these is what is tested
        return "wrong", f"{type(error).__name__}: {error}"[:300]
    return "valid", ""


def _fault(probe: Probe, folder: Path) -> str:
    """Say what is wrong with a mesh that was read; nothing for a valid one."""
    vertices, faces = probe.vertices, probe.faces
    if not np.isfinite(vertices).all():
        return "a coordinate is not finite"
    if faces.min() < 0 or faces.max() >= len(vertices):
        return "an index is out of range"
    if degenerate_facets(vertices, faces).any():
        return "a facet has no area"
    if len(probe.region) != len(faces) or probe.region.min() < 0:
        return "the regions do not fit"
    saved = folder / "saved.ply"
    save_probe(probe, saved)
    same = load_probe(saved, "m")
    for ours, theirs in ((vertices, same.vertices), (faces, same.faces), (probe.region, same.region)):
        if ours.dtype != theirs.dtype or ours.tobytes() != theirs.tobytes():
            return "saved and read again it is another"
    return ""


def _warm_up(folder: Path) -> None:
    """Read every sound file once: what is imported on the way counts for no case."""
    for name, data in sound_files().items():
        path = folder / name
        path.write_bytes(data)
        load_probe(path, "mm")


def _limit_memory() -> None:
    try:
        import resource
    except ImportError:  # Windows: the parent's time limit is all there is
        return
    resource.setrlimit(resource.RLIMIT_AS, (_ADDRESS_SPACE, _ADDRESS_SPACE))


def _say(line: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(line) + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main(*map(int, sys.argv[1:4]))

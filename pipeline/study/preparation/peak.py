"""
Peak memory of simplifying a large mesh, in a fresh process that has done nothing else.

``python -m pipeline.study.preparation.peak make FACETS FILE``, then ``... measure COUNT FILE``: making the mesh takes
memory too, so it is done in a process of its own.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import assets
from pipeline.errors import InputError
from pipeline.mesh import Probe, engines
from pipeline.mesh.simplify import Count, simplify
from pipeline.study.preparation.shapes import bumpy_sphere

_SHAPE = "t-shape"


@dataclass(frozen=True)
class Peak:
    """
    What a simplification took.

    Attributes
    ----------
    facets : int
        Of the mesh given.
    own, engine : float
        Largest resident memory of the process and of its engine's, bytes.
    seconds : float
    """

    facets: int
    own: float
    engine: float
    seconds: float


def measure_peak(facets: int, count: int, folder: Path) -> Peak:
    """
    Simplify a bundled probe in a fresh process and take both processes' peaks.

    Parameters
    ----------
    facets, count : int
        Before and after.
    folder : Path
        For the mesh's file.

    Raises
    ------
    InputError
        This system does not tell a process's peak, or the processes failed.
    """
    file = str(folder / "large.npz")
    _in_a_process("make", str(facets), file)
    return Peak(**_in_a_process("measure", str(count), file))


def _in_a_process(*words: str) -> dict[str, Any]:
    command = [sys.executable, "-m", "pipeline.study.preparation.peak", *words]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603 - our own module
    if ran.returncode:
        why = ran.stderr.strip().splitlines()[-1:] or ["no reason given"]
        raise InputError(f"memory cannot be measured here ({why[0]}): leave --memory out")
    answer: dict[str, Any] = json.loads(ran.stdout)
    return answer


# ---- in the child --------------------------------------------------------------------------------


def _make(facets: int, file: str) -> dict[str, Any]:
    vertices, faces = assets.make(_SHAPE, facets)
    np.savez(file, vertices=vertices, faces=faces)
    return {}


def _measure(count: int, file: str) -> dict[str, Any]:
    simplify(bumpy_sphere(2_000), Count(500))  # starts the engine; making a bundled probe would take memory
    with np.load(file, allow_pickle=False) as arrays:
        probe = Probe.from_arrays(arrays["vertices"], arrays["faces"])
    began = time.perf_counter()
    simplify(probe, Count(count))
    seconds = time.perf_counter() - began
    own, engine = _peaks()
    return {"facets": len(probe.faces), "own": own, "engine": engine, "seconds": seconds}


def _peaks() -> tuple[float, float]:
    """Give the peaks of this process and of its engines, bytes."""
    pids = [engines.engine_pid(library) for library in engines.Library]
    try:
        # What getrusage tells of a process is never less than its parent had when it started it; this is.
        return _resident("self"), sum(_resident(str(pid)) for pid in pids if pid is not None)
    except OSError:  # no /proc
        import resource  # not on Windows

        engines.stop_engines()  # a child's peak is known when it has ended
        unit = 1 if sys.platform == "darwin" else 1024
        own, engine = (
            resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
        )
        return unit * own, unit * engine


def _resident(pid: str) -> float:
    for line in Path(f"/proc/{pid}/status").read_text(encoding="ascii", errors="replace").splitlines():
        if line.startswith("VmHWM:"):
            return 1024 * float(line.split()[1])
    raise OSError(f"/proc/{pid}/status does not tell the peak")


if __name__ == "__main__":
    _, what, number, place = sys.argv
    sys.stdout.write(json.dumps((_make if what == "make" else _measure)(int(number), place)))

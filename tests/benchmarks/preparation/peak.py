"""
Peak memory of simplifying a large mesh, in a fresh process that has done nothing else.

``python -m benchmarks.preparation.peak make FACETS FILE``, then ``... measure COUNT FILE``:
making the mesh takes
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
from benchmarks.preparation.shapes import bumpy_sphere

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.simplify import Count, simplify

_SHAPE = "t-shape"


@dataclass(frozen=True)
class Peak:
    """What a simplification took."""

    facets: int  # Of the mesh given
    memory: float  # Largest resident memory of the process, bytes
    seconds: float


def measure_peak(facets: int, count: int, folder: Path) -> Peak:
    """Simplify a bundled probe in a fresh process and take its peak."""
    file = str(folder / "large.npz")
    _in_a_process("make", str(facets), file)
    return Peak(**_in_a_process("measure", str(count), file))


def _in_a_process(*words: str) -> dict[str, Any]:
    command = [sys.executable, "-m", "benchmarks.preparation.peak", *words]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
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
    simplify(bumpy_sphere(2_000), Count(500))  # loads all that there is to load
    with np.load(file, allow_pickle=False) as arrays:
        probe = Probe.from_arrays(arrays["vertices"], arrays["faces"])
    began = time.perf_counter()
    simplify(probe, Count(count))
    seconds = time.perf_counter() - began
    return {"facets": len(probe.faces), "memory": _peak(), "seconds": seconds}


def _peak() -> float:
    """Give the peak of this process, bytes."""
    try:
        # What getrusage tells of a process is never less than its parent had when it started it; this is.
        for line in Path("/proc/self/status").read_text(encoding="ascii", errors="replace").splitlines():
            if line.startswith("VmHWM:"):
                return 1024 * float(line.split()[1])
    except OSError:
        pass
    import resource  # not on Windows

    return float(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) * (
        1 if sys.platform == "darwin" else 1024
    )


if __name__ == "__main__":
    _, what, number, place = sys.argv
    sys.stdout.write(json.dumps((_make if what == "make" else _measure)(int(number), place)))

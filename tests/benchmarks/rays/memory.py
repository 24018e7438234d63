"""
Memory of a solver's model in a process of its own: ``python -m benchmarks.rays.memory PROBE FACETS``.

The last line that it writes is JSON: ``bytes`` a facet, beyond the probe's own arrays.
"""

import ctypes
import json
import subprocess
import sys

from benchmarks.live.reader import resident

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.mesh import Probe


def bytes_per_facet(probe: str, facets: int) -> float:
    """Build a model in a fresh process and tell what it takes; NaN where the system does not say."""
    command = [sys.executable, "-m", "benchmarks.rays.memory", probe, str(facets)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return float(json.loads(done.stdout.splitlines()[-1])["bytes"])


def _measure(probe: str, facets: int) -> float:
    ContactSolver(Probe.from_arrays(*assets.make(probe, 500)))  # loads all that there is to load
    mesh = Probe.from_arrays(*assets.make(probe, facets))
    mesh.normals, mesh.bounds  # noqa: B018 - worked out once, and no part of the model
    before = _in_use()
    solver = ContactSolver(mesh)
    after = _in_use()
    return (after - before) / len(solver.probe.faces)


def _in_use() -> float:
    """Resident memory, bytes, without what was given back to the allocator."""
    try:
        ctypes.CDLL(None).malloc_trim(0)
    except AttributeError:
        return float("nan")  # not glibc: what is free cannot be told from what is used
    return float(resident() or "nan")


if __name__ == "__main__":
    sys.stdout.write(json.dumps({"bytes": _measure(sys.argv[1], int(sys.argv[2]))}) + "\n")

"""Solve wrenches from a file: ``python -m contactbench.pipeline.study.stability.repeat_child IN OUT``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.study.stability import builds

if TYPE_CHECKING:
    from numpy.typing import NDArray


def write_task(file: Path, solver: ContactSolver, wrenches: NDArray[np.float64]) -> None:
    """Write what a process is to solve: a probe with default noise and gates, wrenches (n, 6), N and N·m in S."""
    np.savez(file, vertices=solver.probe.vertices, faces=solver.probe.faces, wrenches=wrenches)


def tracked(solver: ContactSolver, wrenches: NDArray[np.float64]) -> builds.Rows:
    """Return the answers to wrenches as one stream, from its beginning."""
    solver.reset()
    return builds.kernel_rows(solver.track_batch(wrenches))


def main(given: str, out: str) -> None:
    """Solve a task: each wrench on its own, then all as one stream."""
    with np.load(given, allow_pickle=False) as task:
        solver = ContactSolver(Probe.from_arrays(task["vertices"], task["faces"]))
        wrenches = task["wrenches"]
    located = builds.kernel_rows(solver.locate_batch(wrenches))
    Path(out).write_bytes(located.tobytes() + tracked(solver, wrenches).tobytes())


if __name__ == "__main__":
    main(*sys.argv[1:])

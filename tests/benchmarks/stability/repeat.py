"""The same bits again: from run to run, thread to thread, process to process, and whatever compiled the solver."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contactbench import assets
from contactbench.pipeline import kernel
from contactbench.pipeline.contact import ContactSolver, WrenchNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation import add_noise, draw_slide
from contactbench.pipeline.study import hard_meshes as hm

from . import builds
from .builds import tracked, write_task
from .theory import Row, count

if TYPE_CHECKING:
    from contactbench.pipeline.study.hard_meshes import Float

    from .builds import Rows, Workshop

PART = "repeatability"
DIFFER, APART, REASON = "answers that differ in any bit", "points, apart", "answers with another reason"
THREADS, WORKERS = (2, 4, 8), (1, 2, 3)
LOCATED, TRACKED = "each on its own", "tracked as one stream"
_SECONDS = 600


def inputs(samples: int, seed: int) -> tuple[ContactSolver, Float]:
    """
    Return a solver and wrenches (n, 6), N and N·m in S: a noisy slide, borders, grazes, large torques, any numbers.
    """
    body, rng = hm.bundled("t-shape", 1000), np.random.default_rng(seed)
    slide = add_noise(draw_slide(assets.surface("t-shape"), samples, rng).wrenches, WrenchNoise(), rng)
    drawn = [
        hm.press(*hm.places(body, samples, rng, "edge"), rng),
        hm.press(*hm.places(body, samples, rng, "vertex"), rng, arm=0.0),
        hm.press(*hm.places(body, samples, rng), rng, angle=(70.0, 89.9)),
        hm.press(*hm.places(body, samples, rng), rng, pitch=10.0 ** rng.uniform(-4, 2, samples)),
    ]
    wild = rng.standard_normal((samples, 6)) * 10.0 ** rng.uniform(-3, 3, (samples, 1))
    return ContactSolver(body.probe()), np.vstack([slide, *(d.wrenches for d in drawn), wild])


def run(samples: int, seed: int, workshop: Workshop | None, *, quick: bool = False) -> list[Row]:
    """Compare answers bit for bit."""
    solver, wrenches = inputs(samples, seed)
    base = builds.kernel_rows(solver.locate_batch(wrenches))
    stream = tracked(solver, wrenches)
    rows = [
        _row("again in the same process", base, builds.kernel_rows(solver.locate_batch(wrenches))),
        _row("again in the same process", stream, tracked(solver, wrenches), TRACKED),
        _row(
            "wrenches in reverse order", base, builds.kernel_rows(solver.locate_batch(wrenches[::-1]))[::-1]
        ),
    ]
    rows += [
        _row(f"{threads} threads", base, _threaded(solver, wrenches, threads))
        for threads in (THREADS[:1] if quick else THREADS)
    ]
    for workers in WORKERS[1:2] if quick else WORKERS:
        located, _ = _in_processes(solver, wrenches, workers)
        rows.append(_row(f"{workers} new process{'es' if workers > 1 else ''}", base, located))
    for variant in _other_variants():
        located, followed = _in_processes(solver, wrenches, 1, variant)
        name = f"kernel {variant} beside {kernel.variant}"
        rows += [_row(name, base, located), _row(name, stream, followed, TRACKED)]
    if workshop is not None:
        for build in builds.available(quick=quick):
            located, followed = workshop.solve(build, solver, wrenches)
            rows += _build_rows(build, base, located, LOCATED)
            rows += _build_rows(build, stream, followed, TRACKED)
    return rows


def _threaded(solver: ContactSolver, wrenches: Float, threads: int) -> Rows:
    with ThreadPoolExecutor(threads) as pool:
        # More parts than threads, so that they take turns.
        parts = pool.map(solver.locate_batch, np.array_split(wrenches, 5 * threads))
        return np.concatenate([builds.kernel_rows(part) for part in parts])


def _in_processes(
    solver: ContactSolver, wrenches: Float, workers: int, variant: str = ""
) -> tuple[Rows, Rows]:
    """Share the wrenches out among new processes that run at once; each tracks its share as one stream."""
    environment = os.environ | ({"CONTACTBENCH_KERNEL": variant} if variant else {})
    with tempfile.TemporaryDirectory(prefix="contactbench-repeat-") as folder:
        running, files = [], [Path(folder) / f"{i}.out" for i in range(workers)]
        for file, share in zip(files, np.array_split(wrenches, workers), strict=True):
            task = file.with_suffix(".npz")
            write_task(task, solver, share)
            command = [sys.executable, builds.__file__, str(task), str(file)]
            running.append(subprocess.Popen(command, env=environment))
        try:
            codes = [child.wait(_SECONDS) for child in running]
            if any(codes):
                raise InputError("repeatability: a process failed: see its message above.")
        finally:
            for child in running:
                child.kill()
                child.wait()
        found = [np.split(np.fromfile(file, builds.ROW), 2) for file in files]
    return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])


def _other_variants() -> list[str]:
    """Return the kernels that any machine can run beside the one that is loaded."""
    return ["base"] if kernel.variant != "base" else []


def _build_rows(build: builds.Build, base: Rows, found: Rows, case: str) -> list[Row]:
    rows = [_row(build.name, base, found, case, judged=build.same_bits)]
    if not build.same_bits:
        off = 1e3 * np.linalg.norm(found["point"] - base["point"], axis=1)
        rows.append(Row.of(PART, case, build.name, APART, "mm", off))
        reasons = int((found["reason"] != base["reason"]).sum())
        rows.append(count(PART, case, build.name, REASON, reasons, len(base)))
    return rows


def _row(by: str, base: Rows, found: Rows, case: str = LOCATED, *, judged: bool = True) -> Row:
    different = int(builds.differing(np.ascontiguousarray(found), base).sum())
    return count(PART, case, by, DIFFER, different, len(base), most=0.0 if judged else None)

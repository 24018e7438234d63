"""The solver's bits: the same from run to run, thread to thread, process to process, and whatever compiled it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.solver import hard_meshes as hm
from slides import draw_slide

from contactbench import assets
from contactbench.pipeline import kernel
from contactbench.pipeline.contact import ContactSolver, WrenchNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.gates import BEHIND_M
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation import add_noise
from contactbench.pipeline.study.stability import StabilityRow as Row
from contactbench.pipeline.study.stability import press

if TYPE_CHECKING:
    from types import TracebackType
    from typing import Self

    from numpy.typing import NDArray

    from contactbench.pipeline.contact import Batch, Gates

    Rows = NDArray[np.void]
    from contactbench.pipeline.study.stability import Float

# Where on an axis a figure belongs: `x`, `axis`, and `most`.
Where = dict[str, Any]
ROW = np.dtype(
    [
        ("reason", "<i4"),
        ("face", "<i4"),
        ("vertex", "<i4"),
        ("candidates", "<i4"),
        ("point", "<f8", 3),
        ("normal", "<f8", 3),
        ("torque", "<f8"),
        ("covariance", "<f8", (3, 3)),
    ]
)
# As pipeline/kernel/CMakeLists.txt says.
RULES = ("-std=c++20", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math", "-Wno-psabi")
_SOURCE = Path(__file__).with_name("solve_rows.cpp")
INCLUDE = Path(kernel.__file__).with_name("include")
_COMPILE_SECONDS, _RUN_SECONDS = 300, 600


@dataclass(frozen=True)
class Build:
    """One way to compile the solver."""

    name: str  # For people
    compiler: str  # Command
    options: tuple[str, ...]  # Beside those of the kernel's own build, which come first
    same_bits: bool = True  # Whether it must give the kernel's bits


def available(*, quick: bool = False) -> list[Build]:
    """
    Return the builds to compare, of the compilers that are there.

    The last, with fused multiply-adds, breaks a rule of the kernel's build on purpose: it is shown, not judged.
    """
    found = []
    for compiler, fast in (("g++", "-O0"), ("clang++", "-O2")):
        if shutil.which(compiler) is None:
            continue
        levels = (fast,) if quick else ("-O0", "-O1", "-O2", "-O3", "-Os")
        found += [Build(f"{compiler} {level}", compiler, (level,)) for level in levels]
        if not quick:
            native = ("-O3", "-march=native")
            found.append(Build(f"{compiler} {' '.join(native)}", compiler, native))
            fused = (*native, "-ffp-contract=fast")
            found.append(Build(f"{compiler} {' '.join(fused)}", compiler, fused, same_bits=False))
    return found


class Workshop:
    """A folder for programs and their files; use it in a ``with`` statement. Each build is compiled once."""

    def __init__(self) -> None:
        self._programs: dict[Build, Path] = {}

    @cached_property
    def _folder(self) -> tempfile.TemporaryDirectory[str]:
        return tempfile.TemporaryDirectory(prefix="contactbench-builds-")

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if "_folder" in self.__dict__:
            self._folder.cleanup()

    def solve(self, build: Build, solver: ContactSolver, wrenches: NDArray[np.float64]) -> tuple[Rows, Rows]:
        """Answer wrenches (n, 6), N and N·m in S, by a build with a solver's probe, noise and gates."""
        program = self._program(build)
        given, taken = (Path(self._folder.name) / name for name in ("in", "out"))
        given.write_bytes(_packed(solver, wrenches))
        run_tool([str(program), str(given), str(taken)], _RUN_SECONDS, build)
        rows = np.fromfile(taken, ROW)
        return rows[: len(wrenches)], rows[len(wrenches) :]

    def _program(self, build: Build) -> Path:
        if build not in self._programs:
            program = Path(self._folder.name) / f"solve_{len(self._programs)}"
            command = [
                build.compiler,
                *RULES,
                *build.options,
                f"-I{INCLUDE}",
                str(_SOURCE),
                "-o",
                str(program),
            ]
            run_tool(command, _COMPILE_SECONDS, build)
            self._programs[build] = program
        return self._programs[build]


def count(part: str, case: str, by: str, figure: str, found: int, tries: int, **more: Any) -> Row:
    """Give a count."""
    return Row(part, case, by, figure, "", tries, float(found), float(found), **more)


def kernel_rows(batch: Batch) -> Rows:
    """Return the answers of the kernel that is loaded, as a build gives them."""
    rows = np.empty(len(batch), ROW)
    rows["reason"], rows["face"], rows["vertex"] = batch.reasons, batch.faces, batch.vertices
    rows["candidates"], rows["point"], rows["normal"] = batch.candidates, batch.points, batch.normals
    rows["torque"], rows["covariance"] = batch.torques, batch.covariances
    return rows


def differing(a: Rows, b: Rows) -> NDArray[np.bool_]:
    """Tell which of two times (n,) rows differ in any bit; one NaN is as good as another."""
    different = np.zeros(len(a), dtype=bool)
    for name in ROW.names or ():
        x, y = (rows[name].reshape(len(a), -1) for rows in (a, b))
        bits = (x.view(f"i{x.dtype.itemsize}"), y.view(f"i{y.dtype.itemsize}"))
        same = bits[0] == bits[1]
        if x.dtype.kind == "f":
            same |= np.isnan(x) & np.isnan(y)
        different |= ~same.all(axis=1)
    return different


def _packed(solver: ContactSolver, wrenches: NDArray[np.float64]) -> bytes:
    probe, gates = solver.probe, solver.gates
    if gates.region_only or probe.region.any() or np.isfinite(gates.saturation).any():
        raise InputError("builds are compared without regions and saturation: leave them out.")
    model = solver.model
    numbers = [
        *solver.covariance.ravel(),
        *gate_numbers(gates),
        model.torsion_arm,
        model.mesh_deviation,
        model.mesh_curved,
    ]
    return b"".join(
        np.ascontiguousarray(values, dtype).tobytes()
        for values, dtype in (
            ([len(probe.vertices), len(probe.faces), len(wrenches)], "<i8"),
            (numbers, "<f8"),
            (probe.vertices, "<f8"),
            (probe.faces, "<i4"),
            (wrenches, "<f8"),
        )
    )


def gate_numbers(gates: Gates) -> list[float]:
    given = {**gates.kernel_values(), "behind_distance": BEHIND_M}
    names = (
        "min_force cos_friction implausible_misfit rival_cost ambiguity_distance behind_cost behind_distance"
    )
    names += " follow_cost follow_distance depth_distance"
    return [float(given[name]) for name in names.split()]


def run_tool(command: list[str], seconds: float, build: Build) -> None:
    """Run a compiler, or what it made; InputError if it cannot be run, fails or takes longer."""
    try:
        done: subprocess.CompletedProcess[Any] = subprocess.run(
            command, capture_output=True, text=True, check=False, timeout=seconds
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise InputError(
            f"{build.name}: {command[0]} cannot be run ({error}): leave this build out."
        ) from error
    if done.returncode:
        raise InputError(
            f"{build.name}: {command[0]} failed ({done.stderr.strip()[-600:]}): leave this build out."
        )


def write_task(file: Path, solver: ContactSolver, wrenches: NDArray[np.float64]) -> None:
    """Write what a process is to solve: a probe with default noise and gates, wrenches (n, 6), N and N·m in S."""
    np.savez(file, vertices=solver.probe.vertices, faces=solver.probe.faces, wrenches=wrenches)


def tracked(solver: ContactSolver, wrenches: NDArray[np.float64]) -> Rows:
    """Return the answers to wrenches as one stream, from its beginning."""
    solver.reset()
    return kernel_rows(solver.track_batch(wrenches))


def main(given: str, out: str) -> None:
    """Solve a task: each wrench on its own, then all as one stream."""
    with np.load(given, allow_pickle=False) as task:
        solver = ContactSolver(Probe.from_arrays(task["vertices"], task["faces"]))
        wrenches = task["wrenches"]
    located = kernel_rows(solver.locate_batch(wrenches))
    Path(out).write_bytes(located.tobytes() + tracked(solver, wrenches).tobytes())


PART = "repeatability"
DIFFER, APART, REASON = "answers that differ in any bit", "points, apart", "answers with another reason"
THREADS, WORKERS = (2, 4, 8), (1, 2, 3)
LOCATED, TRACKED = "each on its own", "tracked as one stream"
_SECONDS = 600


def hard_wrenches(samples: int, seed: int) -> tuple[ContactSolver, Float]:
    """
    Return a solver and wrenches (n, 6), N and N·m in S: a noisy slide, borders, grazes, large torques, any numbers.
    """
    body, rng = hm.bundled("t-shape", 1000), np.random.default_rng(seed)
    slide = add_noise(draw_slide(assets.surface("t-shape"), samples, rng).wrenches, WrenchNoise(), rng)
    drawn = [
        press(*hm.places(body, samples, rng, "edge"), rng),
        press(*hm.places(body, samples, rng, "vertex"), rng, arm=0.0),
        press(*hm.places(body, samples, rng), rng, angle=(70.0, 89.9)),
        press(*hm.places(body, samples, rng), rng, pitch=10.0 ** rng.uniform(-4, 2, samples)),
    ]
    wild = rng.standard_normal((samples, 6)) * 10.0 ** rng.uniform(-3, 3, (samples, 1))
    return ContactSolver(body.probe()), np.vstack([slide, *(d.wrenches for d in drawn), wild])


def bit_rows(samples: int, seed: int, workshop: Workshop | None, *, quick: bool = False) -> list[Row]:
    """Compare answers bit for bit."""
    solver, wrenches = hard_wrenches(samples, seed)
    base = kernel_rows(solver.locate_batch(wrenches))
    stream = tracked(solver, wrenches)
    rows = [
        _row("again in the same process", base, kernel_rows(solver.locate_batch(wrenches))),
        _row("again in the same process", stream, tracked(solver, wrenches), TRACKED),
        _row("wrenches in reverse order", base, kernel_rows(solver.locate_batch(wrenches[::-1]))[::-1]),
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
        for build in available(quick=quick):
            located, followed = workshop.solve(build, solver, wrenches)
            rows += _build_rows(build, base, located, LOCATED)
            rows += _build_rows(build, stream, followed, TRACKED)
    return rows


def _threaded(solver: ContactSolver, wrenches: Float, threads: int) -> Rows:
    with ThreadPoolExecutor(threads) as pool:
        # More parts than threads, so that they take turns.
        parts = pool.map(solver.locate_batch, np.array_split(wrenches, 5 * threads))
        return np.concatenate([kernel_rows(part) for part in parts])


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
            command = [sys.executable, __file__, str(task), str(file)]
            running.append(subprocess.Popen(command, env=environment))
        try:
            codes = [child.wait(_SECONDS) for child in running]
            if any(codes):
                raise InputError("repeatability: a process failed: see its message above.")
        finally:
            for child in running:
                child.kill()
                child.wait()
        found = [np.split(np.fromfile(file, ROW), 2) for file in files]
    return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])


def _other_variants() -> list[str]:
    """Return the kernels that any machine can run beside the one that is loaded."""
    return ["base"] if kernel.variant != "base" else []


def _build_rows(build: Build, base: Rows, found: Rows, case: str) -> list[Row]:
    rows = [_row(build.name, base, found, case, judged=build.same_bits)]
    if not build.same_bits:
        off = 1e3 * np.linalg.norm(found["point"] - base["point"], axis=1)
        rows.append(Row.of(PART, case, build.name, APART, "mm", off))
        reasons = int((found["reason"] != base["reason"]).sum())
        rows.append(count(PART, case, build.name, REASON, reasons, len(base)))
    return rows


def _row(by: str, base: Rows, found: Rows, case: str = LOCATED, *, judged: bool = True) -> Row:
    different = int(differing(np.ascontiguousarray(found), base).sum())
    return count(PART, case, by, DIFFER, different, len(base), most=0.0 if judged else None)


if __name__ == "__main__":
    main(*sys.argv[1:])

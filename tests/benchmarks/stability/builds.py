"""The solver's headers, built by one compiler and set of options after another, to compare the bits of answers."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline import kernel
from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe

if TYPE_CHECKING:
    from types import TracebackType
    from typing import Self

    from numpy.typing import NDArray

    from contactbench.pipeline.contact import Batch, Gates

    Rows = NDArray[np.void]

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
_RULES = ("-std=c++20", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math", "-Wno-psabi")
_SOURCE = Path(__file__).with_name("solve_rows.cpp")
_INCLUDE = Path(kernel.__file__).with_name("include")
_COMPILE_SECONDS, _RUN_SECONDS = 300, 600


@dataclass(frozen=True)
class Build:
    """One way to compile the solver."""

    name: str  # For people
    compiler: str  # Command
    options: tuple[str, ...]  # Beside those of the kernel's own build, which come first
    same_bits: bool = True  # Whether it must give the kernel's bits


SINGLE = Build(
    "single",
    "g++",
    ("-O1", "-DCONTACTBENCH_SINGLE", "-fsingle-precision-constant", "-Wno-narrowing"),
    same_bits=False,
)


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
        _run([str(program), str(given), str(taken)], _RUN_SECONDS, build)
        rows = np.fromfile(taken, ROW)
        return rows[: len(wrenches)], rows[len(wrenches) :]

    def _program(self, build: Build) -> Path:
        if build not in self._programs:
            program = Path(self._folder.name) / f"solve_{len(self._programs)}"
            command = [
                build.compiler,
                *_RULES,
                *build.options,
                f"-I{_INCLUDE}",
                str(_SOURCE),
                "-o",
                str(program),
            ]
            _run(command, _COMPILE_SECONDS, build)
            self._programs[build] = program
        return self._programs[build]


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
        *_gates(gates),
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


def _gates(gates: Gates) -> list[float]:
    given = gates.kernel_arguments()
    names = (
        "min_force",
        "cos_friction",
        "implausible_misfit",
        "rival_cost",
        "ambiguity_distance",
        "behind_cost",
        "behind_distance",
        "follow_cost",
        "follow_distance",
    )
    return [float(given[name]) for name in names]


def _run(command: list[str], seconds: float, build: Build) -> None:
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


if __name__ == "__main__":
    main(*sys.argv[1:])

"""Prepare many mesh files as a user would, and look at what comes out as a stranger would.

Every shape goes through the public commands `probe inspect`, `shell` and `prepare` in processes of their own.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.study.report import Figure, Sheet, StudyReport

from . import shapes as catalogue
from .contact_error import ContactError, distances, draw_touches, locate, visible_points
from .solids import Mesh, joined
from .stranger import look, normal_deviations, read_prepared, sample

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.pipeline.study.report import Cell

    from .shapes import Shape
    from .stranger import Prepared

_COMMAND = Path(sys.executable).with_name("contactbench")
_PATIENCE_S = 600
_SAMPLES = 60_000
_TOUCHES = 4_000

# A small process runs the command: what is measured of a child begins with the memory of the process that forked it.
_WATCH = """
import json, pathlib, resource, subprocess, sys, time
began = time.perf_counter()
code = subprocess.run(sys.argv[2:]).returncode
used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
pathlib.Path(sys.argv[1]).write_text(json.dumps([code, time.perf_counter() - began, used]))
"""

# The figures that are to be reached.
MOST_FOLD_DEG = 60.0
MOST_P95_MM = 0.02
MOST_OVER_BOUND = 1.10
MOST_GROWTH = 1.02
# Of the touches that are sure on the exact original, so many may be doubtful on what was made of it.
MOST_LOST = 0.02
MOST_ASTRAY = 0.001
# Of what the file says all about: rounding of areas, no more.
MOST_INVENTED = 1e-9


@dataclass(frozen=True)
class Ran:
    """A command that was run: its exit code (124: it took too long), words, JSON, seconds and peak memory."""

    exit: int
    words: str
    found: dict[str, Any] = field(repr=False)
    seconds: float
    peak_mb: float


@dataclass(frozen=True)
class Judged:
    """A written mesh against its original."""

    facets: int
    sound: bool
    wrong: str  # What the stranger saw; "" when nothing
    parts: int
    invented: float  # Share of its area
    p95_mm: float  # From the visible outside to the mesh
    most_mm: float  # From the visible outside to the mesh
    back_mm: float  # From what the mesh did not invent to the outside, largest
    fold_deg: float  # Largest deviation of a normal from the original's own, where it did not invent
    folded: int  # Facets beyond what is allowed


@dataclass(frozen=True)
class Row:
    """All that was measured of one shape; `faults` are the figures that it misses, in words."""

    name: str
    closed: bool
    body: bool
    inspected: Ran
    shelled: Ran
    prepared: Ran
    checked: Ran | None
    shell: Judged | None
    result: Judged | None
    exact: ContactError | None
    contact: ContactError | None
    faults: tuple[str, ...] = ()


def run_command(arguments: Sequence[str | Path], command: Path = _COMMAND) -> Ran:
    """Run a command of contactbench in a process of its own."""
    with tempfile.TemporaryDirectory() as scratch:
        used = Path(scratch) / "used.json"
        line = [sys.executable, "-c", _WATCH, used, "timeout", "-k", "5", _PATIENCE_S, command, *arguments]
        done = subprocess.run(
            [str(word) for word in line],
            capture_output=True,
            env={**os.environ, "COLUMNS": "10000"},
            check=True,
        )
        exit_code, seconds, peak_mb = json.loads(used.read_text(encoding="utf-8"))
    told, words = (text.decode(errors="replace").strip() for text in (done.stdout, done.stderr))
    return Ran(exit_code, words, json.loads(told) if told.startswith("{") else {}, seconds, peak_mb)


def measure(shape: Shape, folder: Path, command: Path = _COMMAND) -> Row:
    """Prepare a shape and judge the result; its files stay in the folder."""
    file = shape.write(folder)
    shell_file, result_file = folder / f"{shape.name}-shell.ply", folder / f"{shape.name}-prepared.ply"
    for old in (shell_file, result_file):
        old.unlink(missing_ok=True)
    units = ("--units", "mm")
    inspected = run_command(["probe", "inspect", file, *units, "--json"], command)
    shelled = run_command(["probe", "shell", file, *units, "--out", shell_file, "--json"], command)
    prepared = run_command(["probe", "prepare", file, *units, "--out", result_file, "--json"], command)
    checked = (
        run_command(["probe", "inspect", result_file, "--json"], command) if result_file.exists() else None
    )
    shell = _judge(shape, read_prepared(shell_file)) if shell_file.exists() else None
    result = exact = contact = None
    touches = draw_touches(shape, _TOUCHES)
    if shape.solid is not None:
        exact = locate(shape.solid, touches, shape.outside)
    if result_file.exists():
        made = read_prepared(result_file)
        result = _judge(shape, made)
        contact = locate(made.mesh, touches, shape.outside)
    row = Row(
        shape.name,
        shape.closed,
        shape.body,
        inspected,
        shelled,
        prepared,
        checked,
        shell,
        result,
        exact,
        contact,
    )
    return replace(row, faults=tuple(_faults(row)))


def _judge(shape: Shape, made: Prepared) -> Judged:
    seen = look(made.mesh)
    there = distances(visible_points(shape, _SAMPLES), made.mesh)
    # Of what the outside is not known all over, only distances to the result can be told.
    own = made.mesh.chosen(~made.invented & (not shape.partly))
    outside = _both_ways(shape.outside) if not shape.known else shape.outside
    back = distances(sample(own, _SAMPLES, np.random.default_rng(3))[0], outside) if len(own.faces) else there
    # A lip or a step of some micrometres that the file has is no fold.
    own_normals = isinstance(shape.file, Mesh) and shape.oriented and shape.known
    fold = normal_deviations(own, joined(outside, shape.file) if own_normals else outside)
    areas = made.mesh.areas
    return Judged(
        facets=len(made.mesh.faces),
        sound=seen.sound,
        wrong=seen.words(),
        parts=seen.parts,
        invented=float(areas[made.invented].sum() / areas.sum()),
        p95_mm=float(np.percentile(there, 95)),
        most_mm=float(there.max()),
        back_mm=float(back.max()),
        fold_deg=float(fold.max(initial=0.0)),
        folded=int((fold > MOST_FOLD_DEG).sum()),
    )


def _both_ways(mesh: Mesh) -> Mesh:
    return mesh._replace(faces=np.concatenate([mesh.faces, mesh.faces[:, ::-1]]))


def _faults(row: Row) -> list[str]:
    found = []
    for name, ran in (("inspect", row.inspected), ("shell", row.shelled), ("prepare", row.prepared)):
        refused = not row.body and ran.exit == 2
        if (ran.exit not in (0, 1) and not refused) or "Traceback" in ran.words:
            found.append(f"{name} ended with {ran.exit}: {ran.words.splitlines()[-1] if ran.words else ''}")
    if not row.body:
        return found if row.prepared.exit in (1, 2) else [*found, "prepare calls ready what has no inside"]
    if row.prepared.exit == 1 and row.result and row.result.sound and row.result.parts == 1:
        found.append("prepare ended with 1, yet nothing is wrong")
    if row.shell and row.shelled.exit == 0:
        found += _unsound("shell", row.shell)
    if row.shell and row.closed:
        if row.shell.invented > MOST_INVENTED:
            found.append(f"shell: {100 * row.shell.invented:.2g} % invented of a closed input")
        if row.shell.p95_mm > MOST_P95_MM:
            found.append(f"shell: visible p95 {row.shell.p95_mm:.3f} mm")
    return found + (_shipped(row) if row.prepared.exit == 0 else [])


def _shipped(row: Row) -> list[str]:
    """Name what is wrong with a mesh that prepare calls ready."""
    found = _unsound("prepared", row.result) if row.result else ["prepare wrote nothing"]
    if row.checked and row.checked.exit != 0:
        found.append("inspect complains about what prepare shipped")
    if row.contact:
        # Between thin walls and in grooves the exact original itself errs by more than its bound.
        most = max(MOST_OVER_BOUND, MOST_GROWTH * row.exact.over_bound if row.exact else 0.0)
        if not row.contact.over_bound <= most:
            found.append(f"contact error {row.contact.over_bound:.2f} times the bound")
        if row.exact and row.contact.sure < row.exact.sure - MOST_LOST:
            found.append(
                f"{100 * row.contact.sure:.0f} % sure, {100 * row.exact.sure:.0f} % on the exact original"
            )
        if row.contact.astray > max(MOST_ASTRAY, row.exact.astray if row.exact else 0.0):
            found.append(f"{100 * row.contact.astray:.2g} % sure and more than 10 mm off")
    return found


def _unsound(name: str, judged: Judged) -> list[str]:
    found = [] if judged.sound else [f"{name}: {judged.wrong}"]
    if judged.folded:
        found.append(f"{name}: {judged.folded} facets turned, up to {judged.fold_deg:.0f}°")
    return found


def run(
    shapes: Sequence[str] = (),
    *,
    folder: Path | None = None,
    command: Path = _COMMAND,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Prepare each shape, all of them unless told otherwise; their files stay in the folder, if there is one."""
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        place = folder or Path(scratch)
        place.mkdir(parents=True, exist_ok=True)
        for name in shapes or catalogue.names():
            rows.append(measure(catalogue.make(name), place, command))
            progress(f"{name}: {'; '.join(rows[-1].faults) or 'all figures reached'}")
    figures = tuple(Figure(row.name, "figures missed", len(row.faults), most=0) for row in rows)
    columns = (
        "shape", "exit", "facets", "s", "MB", "sound", "invented %", "shell p95 mm", "shell back mm",
        "prepared max mm", "turned °", "error/bound", "on exact", "sure %", "sure on exact %", "astray %", "misses",
    )  # fmt: skip
    sheet = Sheet("shapes", "Prepared meshes", columns, tuple(map(_cells, rows)))
    return StudyReport("Prepared meshes", {"shapes": len(rows)}, figures, (), (sheet,))


def _cells(row: Row) -> tuple[Cell, ...]:
    shell, result, contact, exact = row.shell, row.result, row.contact, row.exact
    return (
        row.name + ("" if row.closed else " (open)"),
        row.prepared.exit,
        result and result.facets,
        row.prepared.seconds,
        row.prepared.peak_mb,
        result and ("yes" if result.sound else "no"),
        shell and 100 * shell.invented,
        shell and shell.p95_mm,
        shell and shell.back_mm,
        result and result.most_mm,
        result and result.fold_deg,
        contact and contact.over_bound,
        exact and exact.over_bound,
        contact and 100 * contact.sure,
        exact and 100 * exact.sure,
        contact and 100 * contact.astray,
        "; ".join(row.faults),
    )

"""Is simplification ahead of the libraries, each called bare? Contacts on what each makes, and its time."""

from __future__ import annotations

import sys
import tempfile
import time
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.contact_error import draw_touches, locate
from benchmarks.memory import peak
from benchmarks.preparation.rivals import LIBRARIES, Rival
from benchmarks.preparation.shapes import BUMPY, bumpy_sphere, bundled
from benchmarks.shapes import Shape
from benchmarks.solids import Mesh

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.kernel import collapse_edges
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.deviation import Reference, doubled_areas
from contactbench.pipeline.mesh.load import load_probe
from contactbench.pipeline.mesh.simplify import Count, simplify
from contactbench.pipeline.mesh.soundness import check_soundness
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Sequence

    import numpy.typing as npt
    from benchmarks.contact_error import Touches


SHAPES = (*assets.PROBE_NAMES, BUMPY)

_SLOWER = 1.0
_CONTACT, _UNSOUND = "contact p95 over ours", ", unsound"
_TOUCHES = 12_000
_MEMORY_MB, _MEMORY_FACETS = 1e3, 1_000_000
# Dense enough that a change of one per cent in the Hausdorff distance shows.
_UNIFORM = 100_000


def run(
    facets_in: int = 50_000,
    facets_out: int = 2_000,
    *,
    shapes: Sequence[str] = SHAPES,
    files: Sequence[str | os.PathLike[str]] = (),
    rivals: Sequence[str] = LIBRARIES,
    interpreter: Path | None = None,
    rounds: int = 5,
    memory: bool = False,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Measure every figure; `interpreter` is the Python that has the rivals."""
    _check(facets_in, facets_out, shapes, rounds)
    figures: list[Figure] = []
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        if memory:
            progress(f"memory at {_MEMORY_FACETS:,} facets")
            figures += _memory(facets_out, folder)
        probes = [
            bumpy_sphere(facets_in) if shape == BUMPY else bundled(shape, facets_in) for shape in shapes
        ]
        loaded = [replace(load_probe(Path(file)), name=Path(file).stem) for file in files]
        children = [stack.enter_context(Rival(library, folder, interpreter)) for library in rivals]
        figures += _beside(probes + loaded, facets_out, rounds, children, progress)
    settings = {"facets": f"{facets_in:,} to {facets_out:,}", "rounds": rounds}
    return StudyReport("Simplifiers side by side", settings, tuple(figures), (_NOTE,))


_NOTE = (
    "Libraries are called bare in a process of their own; time is the processor's, theirs that of the calls alone."
    " Contact p95: of touches without noise, located on the simplified mesh, 95 % of the sure answers are as near."
    " Unsound: open, crossing, folded, of more than two facets at an edge, or of more facets than asked for."
)


def _check(facets_in: int, facets_out: int, shapes: Sequence[str], rounds: int) -> None:
    for shape in shapes:
        if shape not in SHAPES:
            raise InputError(f"there is no shape {shape!r}; choose of {', '.join(SHAPES)}")
    if not 300 <= facets_out <= facets_in / 2:
        raise InputError(
            f"{facets_in} to {facets_out} facets: leave at least 300, and begin with at least twice as many"
        )
    if rounds < 1:
        raise InputError(f"{rounds} rounds are none; give at least 1")


def _beside(
    probes: list[Probe], count: int, rounds: int, rivals: list[Rival], progress: Callable[[str], None]
) -> list[Figure]:
    """Simplify every probe with every library in turn, and locate the same touches on what each makes."""
    figures: list[Figure] = []
    ratios: dict[tuple[str, str], list[float]] = {}
    for probe in probes:
        progress(f"{probe.name}: beside the rivals")
        reference, whole = Reference(probe, uniform=_UNIFORM), Mesh(1e3 * probe.vertices, probe.faces)
        touches = draw_touches(Shape(probe.name, b"", whole, whole), _TOUCHES)
        touches = replace(touches, torques=0 * touches.torques)
        canonical, nowhere = _scaled(probe), np.zeros(len(probe.faces), dtype=np.bool_)
        ours = simplify(probe, Count(count)).probe
        own = _found(ours, touches, whole, reference)
        what = f"{probe.name}, {len(probe.faces):,} to {len(ours.faces):,} facets"
        figures += [Figure(what, "contact p95", own[0], "mm"), Figure(what, "Hausdorff", own[1], "mm")]
        for number in range(rounds):
            began = time.process_time()
            simplify(probe, Count(count))
            between = time.process_time()
            collapse_edges(canonical, probe.faces, (count, 0), nowhere, lambda _: None)
            taken = {"with": between - began, "without": time.process_time() - between}
            for rival in rivals:
                made = rival.simplify(canonical, probe.faces, count)
                for checks, seconds in taken.items():
                    of = (rival.library, f"our time {checks} checks over its")
                    ratios.setdefault(of, []).append(seconds / made.seconds)
                if number:
                    continue
                faces = made.faces[doubled_areas(made.vertices, made.faces) > 0]
                back = made.vertices * (probe.size / 100) + probe.bounds.mean(axis=0)
                rough = Probe.from_arrays(back, faces, check_size=False)
                sound = len(faces) <= count and check_soundness(rough.vertices, rough.faces).sound
                theirs = _found(rough, touches, whole, reference)
                for name, a, b in zip((_CONTACT, "Hausdorff over ours"), theirs, own, strict=True):
                    of = (rival.library, name if sound else name + _UNSOUND)
                    ratios.setdefault(of, []).append(a / b)
    for (library, name), values in sorted(ratios.items()):
        limits = {"least": 1.0, "judged": "worst"} if name == _CONTACT else {}
        if (library, name) == ("vtk", "our time without checks over its"):
            limits = {"most": _SLOWER}
        figures.append(Figure.of(f"{library}, {len(values)} times", name, values, **limits))
    return figures


def _found(made: Probe, touches: Touches, whole: Mesh, reference: Reference) -> tuple[float, float]:
    """Return p95 of the contact error, and the Hausdorff distance, mm."""
    contact = locate(Mesh(1e3 * made.vertices, made.faces), touches, whole, seed=None)
    return contact.p95, 1e3 * _hausdorff(reference, made)


# The first call loads all that there is to load.
_SIMPLIFY = """
import sys, numpy as np
from benchmarks.preparation.shapes import bumpy_sphere
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.simplify import Count, simplify
simplify(bumpy_sphere(2_000), Count(500))
with np.load(sys.argv[1]) as arrays:
    simplify(Probe.from_arrays(arrays["vertices"], arrays["faces"]), Count(int(sys.argv[2])))
"""


def peak_memory(facets: int, count: int, folder: Path) -> float:
    """Return the most memory of a process that does nothing but simplify a T-shape of so many facets, MB."""
    vertices, faces = assets.make("t-shape", facets)
    np.savez(folder / "large.npz", vertices=vertices, faces=faces)
    return peak([sys.executable, "-c", _SIMPLIFY, str(folder / "large.npz"), str(count)], (0,))


def _memory(count: int, folder: Path) -> list[Figure]:
    most = peak_memory(_MEMORY_FACETS, count, folder)
    return [Figure(f"{_MEMORY_FACETS:,} facets", "peak memory", most, "MB", most=_MEMORY_MB)]


def _scaled(probe: Probe) -> npt.NDArray[np.float64]:
    """Vertices centred and 100 units long, as the engines get them: another size is another amount of work."""
    return np.asarray((probe.vertices - probe.bounds.mean(axis=0)) * (100 / probe.size))


def _hausdorff(reference: Reference, made: Probe) -> float:
    deviation = reference.compare(made).deviation()
    assert deviation is not None
    return deviation.hausdorff

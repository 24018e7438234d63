"""Is simplification as fast and as faithful as it says? Each figure beside the libraries called bare."""

from __future__ import annotations

import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.memory import peak
from benchmarks.preparation.rivals import RIVALS, Rival
from benchmarks.preparation.shapes import BUMPY, bumpy_sphere, bundled, painted

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.deviation import Reference
from contactbench.pipeline.mesh.simplify import Count, simplify
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy.typing as npt


SHAPES = (*assets.PROBE_NAMES, BUMPY)

_SLOWER = 1.0
_FARTHER = 1.1
_SAME = 1e-6
_PAINTED, _RATIO = 0.1, 8.0
# A painted part cannot keep more facets than it has: coarse meshes get fewer than these.
_PAINTED_FACETS, _PAINTED_SHARE = 1_000, 20
_DENSER, _RMS_INSIDE = 4.0, 0.5
_MEMORY_MB, _MEMORY_FACETS = 1e3, 1_000_000
# Dense enough that a change of one per cent in the Hausdorff distance shows.
_UNIFORM = 100_000


def run(
    facets_in: int = 100_000,
    facets_out: int = 500,
    *,
    shapes: Sequence[str] = SHAPES,
    rounds: int = 7,
    memory: bool = False,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Measure every figure."""
    _check(facets_in, facets_out, shapes, rounds)
    figures: list[Figure] = []
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        if memory:
            progress(f"memory at {_MEMORY_FACETS:,} facets")
            figures += _memory(facets_out, folder)
        rivals = [stack.enter_context(Rival(library, folder)) for library in RIVALS]
        for shape in shapes:
            probe = bumpy_sphere(facets_in) if shape == BUMPY else bundled(shape, facets_in)
            progress(f"{shape}: time")
            figures += _time(probe, facets_out, rounds, rivals)
            progress(f"{shape}: distance")
            figures += _distance(probe, facets_out, rivals)
            figures.append(_units(probe, facets_out))
            progress(f"{shape}: region")
            rng = np.random.default_rng([seed, SHAPES.index(shape)])
            figures += _region(painted(probe, _PAINTED, rng))
    settings = {"facets": f"{facets_in:,} to {facets_out:,}", "rounds": rounds, "seed": seed}
    note = (
        "Rivals are called bare in a process of their own; their time is that of the library's calls alone."
    )
    return StudyReport("Simplification", settings, tuple(figures), (note,))


def _check(facets_in: int, facets_out: int, shapes: Sequence[str], rounds: int) -> None:
    for shape in shapes:
        if shape not in SHAPES:
            raise InputError(f"there is no shape {shape!r}; choose of {', '.join(SHAPES)}")
    if not 300 <= facets_out <= facets_in / 2:
        raise InputError(
            f"{facets_in} to {facets_out} facets: leave at least 300, and begin with at least twice as many"
        )
    if facets_in < 300 * _PAINTED_SHARE:
        raise InputError(
            f"{facets_in} facets are too few for the figures; give at least {300 * _PAINTED_SHARE}"
        )
    if rounds < 1:
        raise InputError(f"{rounds} rounds are none; give at least 1")


def _time(probe: Probe, count: int, rounds: int, rivals: list[Rival]) -> list[Figure]:
    """Time simplify beside the bare calls, each in turn; the measuring of the result is included."""
    canonical = _scaled(probe)
    taken: dict[str, list[float]] = {"ours": [], **{rival.library: [] for rival in rivals}}
    for counted in [False, *[True] * rounds]:
        began = time.perf_counter()
        simplify(probe, Count(count))
        seconds = {"ours": time.perf_counter() - began}
        for rival in rivals:
            seconds[rival.library] = rival.simplify(canonical, probe.faces, count).seconds
        if counted:  # the first round warms everything up
            for name, value in seconds.items():
                taken[name].append(value)
    ours = np.array(taken["ours"])
    figures = [Figure.of(probe.name, "time", 1e3 * ours, "ms")]
    for rival in rivals:
        most = _SLOWER if rival.library == "pymeshlab" else None
        ratios = ours / np.array(taken[rival.library])
        figures.append(Figure.of(probe.name, f"time over {rival.library}, bare", ratios, most=most))
    return figures


def _distance(probe: Probe, count: int, rivals: list[Rival]) -> list[Figure]:
    """Compare Hausdorff distances with the better of the rivals, in the unit that suits it best."""
    reference = Reference(probe, uniform=_UNIFORM)
    bare: dict[str, float] = {}
    for rival in rivals:
        for unit, scale in (("m", 1.0), ("mm", 1e3), ("100 units", 100 / probe.size)):
            made = rival.simplify(scale * probe.vertices, probe.faces, count)
            rough = Probe.from_arrays(made.vertices / scale, made.faces, check_size=False)
            bare[f"{rival.library} in {unit}"] = _hausdorff(reference, rough)
    best = min(bare, key=lambda name: bare[name])
    figures = [Figure(probe.name, f"Hausdorff of the best rival, {best}", 1e3 * bare[best], "mm")]
    ours = _hausdorff(reference, simplify(probe, Count(count)).probe)
    return [*figures, Figure(probe.name, "Hausdorff over it", ours / bare[best], most=_FARTHER)]


def _units(probe: Probe, count: int) -> Figure:
    """Give the same mesh in millimetres: the same facets must come out."""
    metres = simplify(probe, Count(count)).probe
    thousandfold = Probe.from_arrays(1e3 * probe.vertices, probe.faces, name=probe.name, check_size=False)
    millimetres = simplify(thousandfold, Count(count)).probe
    same = np.array_equal(metres.faces, millimetres.faces)
    off = np.abs(metres.vertices - 1e-3 * millimetres.vertices).max() / probe.size if same else np.inf
    return Figure(probe.name, "mm against m, of the size", float(off), most=_SAME)


def _region(probe: Probe) -> list[Figure]:
    """Ask for eight times the facets per area in a tenth of the area."""
    reference = Reference(probe, uniform=_UNIFORM)
    count = min(_PAINTED_FACETS, len(probe.faces) // _PAINTED_SHARE)
    even = simplify(probe, Count(count)).probe
    dense = simplify(probe, Count(count), region_ratio=_RATIO).probe
    inside = dense.region > 0
    density = np.array([np.count_nonzero(part) / dense.areas[part].sum() for part in (inside, ~inside)])
    within, without = (_rms(reference, dense, rank) / _rms(reference, even, rank) for rank in (1, 0))
    of = f"{_RATIO:g}-fold region of {100 * _PAINTED:g} %, {count:,} facets"
    return [
        Figure(probe.name, f"{of}: density over the rest's", float(density[0] / density[1]), least=_DENSER),
        Figure(probe.name, f"{of}: RMS inside over an even spread's", within, most=_RMS_INSIDE),
        Figure(probe.name, f"{of}: RMS elsewhere over an even spread's", without),
    ]


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


def _rms(reference: Reference, made: Probe, rank: int) -> float:
    deviation = reference.compare(made).deviation(reference.probe.region == rank, made.region == rank)
    return float("inf") if deviation is None else deviation.rms

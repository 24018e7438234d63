"""Simplification of meshes: ours beside the libraries called bare."""

from __future__ import annotations

import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.deviation import Reference
from contactbench.pipeline.mesh.simplify import Count, simplify
from contactbench.pipeline.study.preparation.rivals import LIBRARIES, Rival
from contactbench.pipeline.study.reproduce.touching import model_of
from contactbench.pipeline.study.rivals.rows import OURS, Contender, Row, known, missing, timed

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from contactbench.pipeline.mesh.deviation import Deviation

FAMILY = "simplification"
_PACKAGES = {"open3d": "open3d-cpu", "point_cloud_utils": "point-cloud-utils"}
_NAMES = {"open3d": "Open3D", "point_cloud_utils": "point-cloud-utils"}
_UNIFORM = 50_000


def engine_rows(
    probes: Sequence[str], facets_in: int, facets_out: Sequence[int], rounds: int
) -> Iterator[Row]:
    """
    Simplify bundled probes with everything that is there.

    Rivals get the mesh about its centre and 100 units long, which suits them best, and what they need to start is not
    counted.

    Parameters
    ----------
    probes : sequence of str
    facets_in : int
    facets_out : sequence of int
    rounds : int

    Yields
    ------
    dict
        Errors: distances to what was simplified, mm; times in µs.
    """
    yield known(FAMILY, Contender(OURS))
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        rivals: dict[str, Rival] = {}
        for library in LIBRARIES:
            contender = Contender(_NAMES.get(library, library), _PACKAGES.get(library, library))
            try:
                rivals[contender.name] = stack.enter_context(Rival(library, folder))
            except InputError as error:
                yield missing(FAMILY, contender, error)
            else:
                yield known(FAMILY, contender)
        for probe in probes:
            for count in facets_out:
                yield from _simplified(model_of(probe, facets_in), count, rivals, rounds)


def _simplified(probe: Probe, count: int, rivals: dict[str, Rival], rounds: int) -> Iterator[Row]:
    reference = Reference(probe, uniform=_UNIFORM)
    middle, scale = probe.bounds.mean(axis=0), 100 / probe.size
    scaled = (probe.vertices - middle) * scale
    taken: dict[str, list[float]] = {OURS: [], **{name: [] for name in rivals}}
    made: dict[str, Probe] = {}
    for number in range(rounds + 1):  # the first warms everything up
        began = time.perf_counter()
        made[OURS] = simplify(probe, Count(count)).probe
        seconds = {OURS: time.perf_counter() - began}
        for name, rival in list(rivals.items()):
            try:
                bare = rival.simplify(scaled, probe.faces, count)
            except InputError:
                continue
            seconds[name] = bare.seconds
            made[name] = Probe.from_arrays(bare.vertices / scale + middle, bare.faces, check_size=False)
        if number:
            for name, value in seconds.items():
                taken[name].append(1e6 * value)
    subject = f"{probe.name}, {len(probe.faces):,} to {count:,}"
    for name, mesh in made.items():
        yield timed(FAMILY, name, subject, "one mesh", taken[name])
        yield _deviation(name, subject, reference.compare(mesh).deviation(), len(mesh.faces))


def _deviation(name: str, subject: str, found: Deviation | None, facets: int) -> Row:
    row: Row = {
        "kind": "error",
        "family": FAMILY,
        "contender": name,
        "subject": subject,
        "condition": "shape",
    }
    row |= {"facets": facets, "answered": float(found is not None)}
    if found is None:
        return row
    return row | {
        "mean_mm": 1e3 * found.rms,
        "p95_mm": 1e3 * found.p95,
        "max_mm": 1e3 * found.hausdorff,
        "normal_deg": found.normal_mean_deg,
    }

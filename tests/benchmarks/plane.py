"""Contacts on a plane: the case of Bota's public estimator, and what becomes of it where a probe is no plane."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver, WrenchNoise
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation import draw_touches
from contactbench.pipeline.study.ablation.effects import NOISES
from contactbench.pipeline.study.ablation.locating import sigmas_of
from contactbench.pipeline.study.marker_touches import model_of
from contactbench.pipeline.study.rivals.interleave import medians
from contactbench.pipeline.study.rivals.rows import OURS, SURE, Contender, Row, erred, known, missing, timed

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

FAMILY = "contact on a plane"
BOTA = Contender("Bota tactile sensing utils", "bota-tactile-sensing-utils")
FLAT = "flat face"
ONE = "one wrench, from Python"
_HALF_M, _TOP_M = 0.03, 0.1
_FACING = 0.7
_QUIETEST = np.repeat([1e-6, 1e-8], 3)
_TIMED = 1_000
FACETS = 20_000


class BotaPlane:
    """Bota's estimator for a plane across the sensor's z axis; ImportError where it cannot be had."""

    def __init__(self, height: float) -> None:
        library: Any = import_module("bota_tactile_sensing_utils")
        settings = library.BotaContactPointConfig()
        settings.geometry.dz = height
        self._estimator = library.BotaContactPoint(settings)
        self._point = np.zeros(3)

    def locate(self, wrench: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the point (3,), m; the same array every time, as the library wants it."""
        self._estimator.update(wrench, self._point)
        return self._point

    def locate_batch(self, wrenches: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the points (n, 3), m; NaN without contact."""
        points = np.full((len(wrenches), 3), np.nan)
        for row, wrench in enumerate(wrenches):
            point = self.locate(wrench)
            if self._estimator.in_contact():
                points[row] = point
        return points


class FlatFace:
    """A square plane across z: what is touched."""

    def sample(self, count: int, rng: np.random.Generator) -> Sequence[NDArray[np.float64]]:
        """Give points (count, 3), m, and outward normals (count, 3)."""
        points = np.column_stack([rng.uniform(-_HALF_M, _HALF_M, (count, 2)), np.full(count, _TOP_M)])
        return points, np.broadcast_to([0.0, 0.0, 1.0], (count, 3))


def plane_rows(touches: int, rounds: int, seed: int) -> Iterator[Row]:
    """
    Measure Bota's estimator and ours on a flat face, and on the acoustic faces of the bundled probes.

    It is told how high the foremost place of the probe is; we get the probe's mesh.
    """
    try:
        BotaPlane(_TOP_M)
    except ImportError as error:
        yield missing(FAMILY, BOTA, error)
        theirs = False
    else:
        theirs = True
        yield known(FAMILY, BOTA)
    yield known(FAMILY, Contender(OURS))
    for subject in (FLAT, *assets.PROBE_NAMES):
        surface: Any = FlatFace() if subject == FLAT else assets.surface(subject)
        mesh = _block() if subject == FLAT else model_of(subject, FACETS)
        rng = np.random.default_rng([seed, 22])
        truth = draw_touches(surface, touches, rng, above=0.02, facing=_FACING)
        drawn = rng.standard_normal(truth.wrenches.shape)
        top = float(mesh.vertices[:, 2].max())
        for noise, times in NOISES.items():
            sigmas = np.maximum(sigmas_of(times), _QUIETEST)
            solver = ContactSolver(mesh, WrenchNoise(sigmas[:3], sigmas[3:]))
            wrenches = truth.wrenches + sigmas_of(times) * drawn
            found = solver.locate_batch(wrenches)
            ours = np.linalg.norm(found.points - truth.points, axis=1)
            yield erred(FAMILY, OURS, subject, noise, ours, ours)
            sure = np.where(found.accepted, ours, np.nan)
            yield erred(FAMILY, SURE, subject, noise, sure, ours)
            if theirs:
                points = BotaPlane(top).locate_batch(wrenches)
                off = np.linalg.norm(points - truth.points, axis=1)
                yield erred(FAMILY, BOTA.name, subject, noise, off, ours)
            if noise == "filtered":
                yield from _times(subject, solver, top, wrenches[:_TIMED], theirs, rounds)


def _times(
    subject: str,
    solver: ContactSolver,
    height: float,
    wrenches: NDArray[np.float64],
    theirs: bool,
    rounds: int,
) -> Iterator[Row]:
    calls: dict[str, Any] = {OURS: (solver.locate, list(wrenches))}
    if theirs:
        calls[BOTA.name] = (BotaPlane(height).locate, list(wrenches))
    for name, us in medians(calls, rounds).items():
        yield timed(FAMILY, name, subject, ONE, us)


def _block() -> Probe:
    """Return a box whose top is the plane, 12 facets."""
    low, high = np.array([-_HALF_M, -_HALF_M, 0.0]), np.array([_HALF_M, _HALF_M, _TOP_M])
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=np.float64)
    faces = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4]]
    faces += [[2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]
    return Probe.from_arrays(low + corners * (high - low), faces, name=FLAT)

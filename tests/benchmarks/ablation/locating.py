"""Choices of how a wrench is located: local torque, smooth normals, and the gate on the friction angle."""

from __future__ import annotations

import time
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.ablation.smooth import SmoothNormals

from contactbench.pipeline.contact import ContactSolver, Gates, WrenchNoise
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation.marker_touches import model_of
from contactbench.pipeline.simulation.sensor_model import preset
from contactbench.pipeline.timing import time_batches

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.kernel import Batch

LOCAL_TORQUE, SMOOTH, BULGE, FINER, GATE = CHOICES = (
    "local torque",
    "smooth normals",
    "smooth normals and bulged facets",
    "ten times the facets",
    "friction-cone gate",
)
SMOOTHED = (SMOOTH, BULGE)
_FINER = 10
SENSOR = "paper"
_QUIETEST = np.repeat([1e-6, 1e-8], 3)  # a solver needs some noise to weigh candidates by
_OPEN_DEG = 89.9
_BLOCK = 500


def sigmas_of(noise: float) -> NDArray[np.float64]:
    """Return the standard deviation (6,), N and N·m, of a wrench whose noise is so many times that of one reading."""
    return np.asarray(noise * preset(SENSOR).noise, dtype=np.float64)


class Locators:
    """
    Our solver as it is, and without each of the choices.

    Parameters
    ----------
    probe : Probe
        The mesh.
    finer : Probe
        The same with ten times the facets.
    noise : float
        Of the wrenches to come, times that of one reading.
    """

    def __init__(self, probe: Probe, finer: Probe, noise: float) -> None:
        sigmas = np.maximum(sigmas_of(noise), _QUIETEST)
        told = WrenchNoise(sigmas[:3], sigmas[3:])
        self.ours = ContactSolver(probe, told)
        self._open = ContactSolver(probe, told, Gates(friction_angle=_OPEN_DEG))
        self._finer = ContactSolver(finer, told)
        self._smooth = SmoothNormals(probe)

    def pair(self, choice: str, wrenches: NDArray[np.float64]) -> tuple[Batch, Batch]:
        """Return what is located without a choice, and with it; for those of SMOOTHED see `smoothed`."""
        ours = self.ours.locate_batch(wrenches)
        match choice:
            case "local torque":
                return self.ours.locate_batch(without_axial(wrenches)), ours
            case "ten times the facets":
                return ours, self._finer.locate_batch(wrenches)
            case _:
                return self._open.locate_batch(wrenches), ours

    def smoothed(self, choice: str, wrenches: NDArray[np.float64]) -> tuple[Batch, NDArray[np.float64]]:
        """Return what flat facets give, and the points (n, 3) of smooth ones."""
        flat = self.ours.locate_batch(wrenches)
        return flat, self._smooth.refine(wrenches, flat, bulge=choice == BULGE)

    def costs(self, wrenches: NDArray[np.float64], rounds: int) -> dict[str, tuple[float, float]]:
        """
        Time a solve without each choice and with it, µs, medians; interleaved.

        The smooth normals are what they add as NumPy on a whole batch, shared by its rows: compiled, they would cost
        less.
        """
        timers: dict[str, Any] = {
            "ours": (self.ours.time_each, wrenches, _BLOCK),
            LOCAL_TORQUE: (self.ours.time_each, without_axial(wrenches), _BLOCK),
            FINER: (self._finer.time_each, wrenches, _BLOCK),
            GATE: (self._open.time_each, wrenches, _BLOCK),
        }
        flat = self.ours.locate_batch(wrenches)
        more: dict[str, list[float]] = {choice: [] for choice in SMOOTHED}

        def refine(_: int) -> None:
            for choice, taken in more.items():
                began = time.perf_counter()
                self._smooth.refine(wrenches, flat, bulge=choice == BULGE)
                taken.append(1e6 * (time.perf_counter() - began) / len(wrenches))

        timed = time_batches(timers, rounds=rounds, after_round=refine)
        us = {name: timing.median / 1e3 for name, timing in timed.items()}
        return {
            **{choice: (us[choice], us["ours"]) for choice in (LOCAL_TORQUE, GATE)},
            FINER: (us["ours"], us[FINER]),
            **{name: (us["ours"], us["ours"] + float(np.median(taken))) for name, taken in more.items()},
        }


@lru_cache(maxsize=64)
def locators(probe: str, facets: int, noise: float) -> Locators:
    """Return those of a bundled probe."""
    return Locators(model_of(probe, facets), model_of(probe, _FINER * facets), noise)


def without_axial(wrenches: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return wrenches (n, 6) without torque about their own axis: for them no local torque is left to explain."""
    F, M = wrenches[:, :3], wrenches[:, 3:]
    pitch = np.einsum("nd,nd->n", M, F) / np.einsum("nd,nd->n", F, F)
    return np.hstack([F, M - pitch[:, None] * F])

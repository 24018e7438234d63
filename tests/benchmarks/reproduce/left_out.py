"""What the scene of a touch leaves out or chooses, and how far that moves the contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.reproduce.locating import OURS, solver_for
from benchmarks.reproduce.statistics import distances_mm

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.scenes import BenchScene, Press, Tip, TouchScene
from contactbench.pipeline.simulation.scenes.touch import STEP_S
from contactbench.pipeline.study.marker_touches import ANGLES, TRUE_FACETS, held, truth_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.simulation.scenes import Moment
    from contactbench.pipeline.study.paper_setup import Bench

_FORCE_N = 9.0
_REST_S = 1.0


@dataclass(frozen=True)
class Effect:
    """One change of the scene, over some markers and all angles; mm."""

    change: str
    shift: float  # How far the true contact moves: mean and largest
    most: float  # How far the true contact moves: mean and largest
    # Distance from the true contact to what is located from its wrench, without noise, on the true mesh:
    # mean and largest
    located: float
    # Distance from the true contact to what is located from its wrench, without noise, on the true mesh:
    # mean and largest
    most_located: float


def effects(name: str, markers_S: NDArray[np.float64], bench: Bench) -> list[Effect]:
    """Press some markers (n, 3) in the scene as it is, and in changed ones."""
    truth = truth_of(name)
    makers: dict[str, Callable[[NDArray[np.float64], Press], Moment]] = {
        "as it is": lambda at, press: _rested(TouchScene(truth, at), press),
        "half the time step": lambda at, press: _rested(TouchScene(truth, at, step=STEP_S / 2), press),
        "tip of 3 mm instead of 1.5": lambda at, press: _rested(TouchScene(truth, at, tip=Tip(0.003)), press),
        "on a wrist that yields": lambda at, press: _on_wrist(BenchScene(truth), at, press),
    }
    presses = [Press(_FORCE_N, tilt, azimuth) for tilt, azimuth in ANGLES.values()]
    moments = {
        change: [make(at, press) for at in markers_S for press in presses] for change, make in makers.items()
    }
    standing = np.array([held(moment.contact) for moment in moments["as it is"]])
    method = solver_for(OURS, name, TRUE_FACETS, bench, standing)
    places = {change: np.array([moment.point_S for moment in each]) for change, each in moments.items()}
    found = []
    for change, each in moments.items():
        moved = distances_mm(places[change], places["as it is"])
        points = method.locate_batch(np.array([moment.contact for moment in each])).points
        off = distances_mm(points, places[change])
        found.append(
            Effect(change, float(moved.mean()), float(moved.max()), float(off.mean()), float(off.max()))
        )
    return found


def _rested(scene: TouchScene, press: Press) -> Moment:
    scene.press(press)
    moment = scene.settle()
    if moment is None:
        raise InputError(
            f"the tip slips at {np.round(1e3 * scene.marker_S, 1)} mm: choose a marker with more face around it."
        )
    return moment


def _on_wrist(scene: BenchScene, marker_S: NDArray[np.float64], press: Press) -> Moment:
    scene.aim(marker_S)
    scene.press(press)
    scene.advance(_REST_S)
    return scene.moment()

"""A real bench in use: the poses that its tool is weighed in, and how its markers are pressed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from contactbench.pipeline.calibration.reachable import by_hand
from contactbench.pipeline.calibration.suggest import plan_poses
from contactbench.pipeline.simulation.loads import orientations_in_use
from contactbench.pipeline.simulation.scenes.touch import draw_press
from contactbench.pipeline.simulation.virtual.markers import markers

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.simulation.reality.bench import RealBench, RealTouch
    from contactbench.pipeline.simulation.scenes.indenter import TipPress

    Array = NDArray[np.float64]

POSES, TILTS = 9, (0.0, 30.0)  # to weigh a tool in; degrees between the force and the inward normal
VERIFIED_S = 7200.0  # when markers are pressed, s since the sensor was switched on


@cache
def planned_poses() -> Array:
    """Return the orientations (n, 3, 3) that a tool is weighed in, in the robot's base."""
    return plan_poses(POSES, by_hand()).R_WS


@dataclass(frozen=True, eq=False)
class MarkedPresses:
    """Presses of markers, n of them."""

    markers: Sequence[int]  # from 1
    presses: Sequence[TipPress]
    R_WS: Array  # (n, 3, 3)

    @classmethod
    def drawn(cls, name: str, rng: np.random.Generator) -> MarkedPresses:
        """Draw how every marker of a bundled probe is pressed, straight and at 30 degrees, with the tool in use."""
        places = [(marker, tilt) for marker in range(1, len(markers(name)) + 1) for tilt in TILTS]
        presses = [draw_press(rng, tilt) for _, tilt in places]
        return cls([marker for marker, _ in places], presses, orientations_in_use(len(places), rng))

    def on(self, bench: RealBench) -> list[RealTouch]:
        """Return what they are on a bench."""
        return [bench.marked(m, press) for m, press in zip(self.markers, self.presses, strict=True)]

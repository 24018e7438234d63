"""
The smallest scene: a probe on its sensor, held still, and a tip that presses one place of it.

Left out: the arm, the room, the probe's own bending, tissue. The sensor does not move, so there is no inertia. What
stays is what a touch of a marker is made of: a contact with friction and torsion on the true surface, the probe's
weight, and a tip that comes to rest.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.simulation.scenes.indenter import (
    PROBE_BIT,
    TIP_BIT,
    Indenter,
    Tip,
    TipPress,
    add_indenter,
)
from contactbench.pipeline.simulation.scenes.physics import (
    Payload,
    PhysicsScene,
    TrueSurface,
    new_spec,
    sensed_body,
)
from contactbench.pipeline.simulation.scenes.pieces import add_facets, facets_near

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.simulation.scenes.physics import SceneMoment

STEP_S = 0.0005
PATCH_M = 0.005  # how much of the surface a tip can reach that slips
_SETTLED_MPS = 5e-5
_LONGEST_S = 3.0
FORCE_N = (8.0, 10.0)
_TORSION_M = 0.0003  # N·m per N: torsional friction of a patch of 1.5 mm
_MOST_TORSION_M = 0.0006  # more would turn the tip


class TouchScene(PhysicsScene):
    """
    A tip above one point of a probe.

    Parameters
    ----------
    truth : TrueSurface
        The true surface.
    marker_S : array_like (3,)
        m; the tip aims at the nearest point of the surface, along the normal there.
    payload : Payload, optional
        Its weight is in the readings.
    R_WS : (3, 3), optional
        How the sensor is held; upright when left out.
    tip : Tip, optional
    step : float
        s.

    Raises
    ------
    InputError
        MuJoCo is missing, or the surface is not there or too fine.
    """

    def __init__(
        self,
        truth: TrueSurface,
        marker_S: ArrayLike,
        *,
        payload: Payload | None = None,
        R_WS: NDArray[np.float64] | None = None,
        tip: Tip | None = None,
        step: float = STEP_S,
    ) -> None:
        R = np.eye(3) if R_WS is None else np.asarray(R_WS, dtype=np.float64)
        tip = tip or Tip()
        self.marker_S, normal_S = truth.nearest(marker_S)
        spec = new_spec(step)
        held = spec.worldbody.add_body(quat=Rotation.from_matrix(R).as_quat(scalar_first=True))
        body = sensed_body(spec, held, payload or Payload())
        bits = {"contype": PROBE_BIT, "conaffinity": TIP_BIT}
        near = facets_near(truth, self.marker_S, PATCH_M)
        add_facets(spec, body, truth.probe, near, "facet", **bits, **tip.geometry(step))
        add_indenter(spec, tip, step)
        super().__init__(spec, truth)
        self.indenter = Indenter(self.model, self.data)
        self.indenter.place(R @ self.marker_S, R @ normal_S, R @ along(normal_S))

    def control(self) -> None:
        """Push the tip."""
        self.indenter.control()

    def press(self, press: TipPress) -> None:
        """Press so from now on; see `settle`."""
        self.indenter.press(press)

    def settle(self) -> SceneMoment | None:
        """Go on until the tip rests, and return the truth then; None when it does not within 3 s: it slips."""
        stop = self.time + _LONGEST_S
        while self.time < stop:
            self.advance(0.05)
            if not self.indenter.steady:
                continue
            speed = float(np.linalg.norm(self.data.qvel[:3]))
            if self.data.ncon and speed < _SETTLED_MPS:
                return self.moment()
        return None


def draw_press(rng: np.random.Generator, tilt: float, azimuth: float | None = None) -> TipPress:
    """Draw the force, 8 to 10 N, and the torsion of a press so tilted, degrees; the azimuth too, if it is left out."""
    force = rng.uniform(*FORCE_N)
    bearing = rng.uniform(0.0, 360.0) if azimuth is None else azimuth
    arm = float(np.clip(_TORSION_M * rng.standard_normal(), -_MOST_TORSION_M, _MOST_TORSION_M))
    return TipPress(force, tilt, bearing, arm * force)


def along(normal_S: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the direction of azimuth 0: S's x axis, the image plane of a probe; y where the surface faces along x."""
    return np.array([1.0, 0.0, 0.0]) if abs(normal_S[0]) < 0.9 else np.array([0.0, 1.0, 0.0])

"""
A probe against a flat soft phantom that is moved under it as a hand would.

The phantom is a bed of springs: each place of the face is pushed by its own depth times the foundation modulus, and by
nothing else. Left out: what tissue does sideways and between its places, the arm, and the probe's inertia.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.simulation.scenes.motion import Motion, hand_motion
from contactbench.pipeline.simulation.scenes.physics import OTHER, Payload, TrueSurface, new_spec
from contactbench.pipeline.simulation.scenes.tissue import (
    PLACES,
    Tissue,
    TissueScene,
    add_phantom,
    add_probe,
    add_six_joints,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

PRESS_STEP_S = 0.001
SERVO = 150.0  # rad/s, how stiffly the moved side follows


class PressScene(TissueScene):
    """
    A probe upright on its sensor, and a phantom above it that comes down.

    A contact of some area has no one point. `SceneMoment.point_S` is where its line of action - through the centroid of
    the forces, along their sum - leaves the true surface: the centroid of a bulged area lies inside the probe, and
    with friction the nearest point to it is not on that line. Contact location without noise, on the true mesh, is
    0.17 mm (T-shape), 0.08 mm (linear) and 0.03 mm (convex) off it, RMS: the forces of an area also twist about axes
    other than the normal, which no single point explains.

    Parameters
    ----------
    truth : TrueSurface
    payload : Payload, optional
    tissue : Tissue, optional
    motion : Motion, optional
        Of the phantom's top, from where it just touches; `hand_motion` when left out.
    step : float
        s.
    places : int
        About how many places of the face feel the tissue.

    Raises
    ------
    InputError
        MuJoCo is missing.
    """

    def __init__(
        self,
        truth: TrueSurface,
        *,
        payload: Payload | None = None,
        tissue: Tissue | None = None,
        motion: Motion | None = None,
        step: float = PRESS_STEP_S,
        places: int = PLACES,
    ) -> None:
        tissue = tissue or Tissue()
        self.motion = motion or hand_motion()
        spec = new_spec(step)
        carrier = spec.worldbody.add_body(name="carrier")
        where, area = add_probe(spec, carrier, truth, payload or Payload(), tissue, places)
        top = float(truth.probe.vertices[:, 2].max())
        other = spec.worldbody.add_body(name=OTHER, pos=[0, 0, top])
        add_six_joints(other)
        add_phantom(other, tissue)
        super().__init__(spec, truth, tissue, where, area)
        self.data.qpos[:] = self.motion.at(0.0)
        self.data.qvel[:] = self._speed(0.0)

    def control(self) -> None:
        """Pull the moved side to where it should be, with the forces that this takes."""
        self._change_tissue()
        now = self.time
        wanted, speed = self.motion.at(now), self._speed(now)
        ahead = (self._speed(now + 1e-4) - self._speed(now - 1e-4)) / 2e-4
        acceleration = ahead + SERVO**2 * (wanted - self.data.qpos) + 2 * SERVO * (speed - self.data.qvel)
        force = np.empty(6)
        self.mujoco.mj_mulM(self.model, self.data, force, acceleration)
        self.data.qfrc_applied[:] = force + self.data.qfrc_bias

    def _speed(self, time: float) -> NDArray[np.float64]:
        return (self.motion.at(time + 1e-5) - self.motion.at(time - 1e-5)) / 2e-5

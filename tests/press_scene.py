"""A probe upright on its sensor, and a phantom above it that is pressed on it.

Its motion: time, s -> x, y, z (m) and turns (rad) from where it just touches.
"""

import numpy as np
from scipy.optimize import brentq

from contactbench.pipeline.contact.patch import FACE_DEPTH_M, spread
from contactbench.pipeline.simulation.scenes import platform as bed
from contactbench.pipeline.simulation.scenes.physics import OTHER, Payload, TrueSurface, new_spec
from contactbench.pipeline.simulation.scenes.platform import Tissue

_SERVO = 150.0  # rad/s, how stiffly the phantom follows


def still(*pose):
    return lambda _time: np.array(pose)


def hand():
    """Return slow slides and turns, up to 8 degrees, and a tremor on top."""
    rng, whole, turn = np.random.default_rng(1), 2 * np.pi, np.radians(8.0)
    shares = rng.uniform(0.3, 1.0, (3, 6))
    slow = np.array([0.004, 0.004, 0.002, turn, turn, turn / 3]) * shares / shares.sum(axis=0)
    sizes = np.vstack([slow, np.repeat([1e-4, 0.0], 3) * rng.uniform(0.3, 1.0, (1, 6))])
    rates = whole * np.vstack([rng.uniform(0.1, 0.6, (3, 6)), rng.uniform(8.0, 12.0, (1, 6))])
    phases = rng.uniform(0, whole, rates.shape)
    return lambda time: [0, 0, -0.004, 0, 0, 0] + (sizes * np.sin(rates * time + phases)).sum(axis=0)


def depth_for(truth: TrueSurface, force: float) -> float:
    """Return the depth, m, at which tissue pushes with a force, N."""
    places, normals, area = spread(truth.probe, bed.PLACES)
    low = places[:, 2] - truth.probe.vertices[:, 2].max() + bed.BALL_M * (1 - normals[:, 2])
    return brentq(lambda d: Tissue().modulus * area * np.maximum(low + d, 0).sum() - force, 0, FACE_DEPTH_M)


class PressScene(bed.TissueScene):
    def __init__(self, truth: TrueSurface, motion, tissue=None, *, step=0.001, places=bed.PLACES) -> None:
        self._motion, tissue, spec = motion, tissue or Tissue(), new_spec(step)
        body = spec.worldbody.add_body(name="carrier")
        where, area = bed.add_probe(spec, body, truth, Payload(), tissue, places)
        other = spec.worldbody.add_body(name=OTHER, pos=[0, 0, truth.probe.vertices[:, 2].max()])
        bed.add_six_joints(other)
        bed.add_phantom(other, tissue)
        super().__init__(spec, truth, tissue, where, area)
        self.data.qpos[:], self.data.qvel[:] = motion(0.0), self._speed(0.0)

    def control(self) -> None:
        self._change_tissue()
        now = self.time
        ahead = (self._speed(now + 1e-4) - self._speed(now - 1e-4)) / 2e-4
        off, slow = self._motion(now) - self.data.qpos, self._speed(now) - self.data.qvel
        self._push(ahead + _SERVO**2 * off + 2 * _SERVO * slow)

    def _speed(self, time: float) -> np.ndarray:
        return (self._motion(time + 1e-5) - self._motion(time - 1e-5)) / 2e-5

"""A hand-like press on a soft phantom: what the sensor reads, where the contact truly is, and what is located."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.reproduce.locating import OURS

from contactbench.pipeline.calibration.contact_error import contact_sensitivity
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.contact.methods import make
from contactbench.pipeline.filtering import KalmanFilter
from contactbench.pipeline.simulation.scenes import PressScene, depth_for, hand_motion
from contactbench.pipeline.simulation.sensor_model import SensorModel
from contactbench.pipeline.study.marker_touches import model_of, truth_of
from contactbench.pipeline.study.paper_setup import RATE_HZ, WARM_S, draw_bench

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.kernel import Batch
    from contactbench.pipeline.simulation.scenes import Motion, Truth

FORCE_N = 7.0  # mean, as the paper presses
_ROUNDS = 5  # depth and heave depend on each other
_BEGIN_S = 1.0  # until the phantom has come to its motion


@dataclass(frozen=True, eq=False)
class Slide:
    """A recording, n samples at 200 Hz."""

    true_mm: NDArray[np.float64]  # (n, 2). Contact centroid projected on the probe, x and y of S.
    quiet_mm: NDArray[np.float64]  # (n, 2). Located from the true wrench.
    # (n, 2). Located from the compensated reading; NaN without an accepted answer.
    raw_mm: NDArray[np.float64]
    kalman_mm: NDArray[np.float64]  # (n, 2). The same after the paper's Kalman filter of wrenches.
    # Predicted standard deviation of the noise in `raw_mm`, root mean square over the recording: the
    # sensor's noise alone, at any torsion. What the answers' covariances add for model and mesh is no
    # noise.
    sigma_mm: NDArray[np.float64]
    force: NDArray[np.float64]  # (n,). True, N.
    depth: float  # How deep the hand presses on average, m


def slide(name: str, facets: int, seconds: float, seed: int, progress: Callable[[int, int], None]) -> Slide:
    """Press, read and locate; a sample per reading of the sensor."""
    bench = draw_bench(seed)
    motion = _hand(truth_of(name), seed)
    contacts, points = _pressed(name, round(seconds * RATE_HZ), motion, progress)
    count = len(contacts)
    R_WS = np.broadcast_to(np.eye(3), (count, 3, 3))  # the phantom moves, the probe stands
    times = WARM_S + np.arange(count) / RATE_HZ
    weight = bench.truth.predict(R_WS) - bench.settings.bias
    model = SensorModel(bench.settings, np.random.default_rng([seed, 4]))
    net = bench.calibration.model.compensate(R_WS, model.read(times, weight + contacts).wrenches)
    sigma = np.sqrt(bench.settings.noise**2 + bench.settings.resolution**2 / 12)
    # Noise alone: what the calibration leaves is an offset, not part of the spectrum's floor.
    noise = WrenchNoise(sigma[:3], sigma[3:])
    method = make(OURS, model_of(name, facets), noise)
    quiet = method.locate_batch(contacts)
    return Slide(
        1e3 * points[:, :2],
        _sure(quiet),
        _sure(method.locate_batch(net)),
        _sure(method.locate_batch(KalmanFilter(RATE_HZ).filter(net))),
        1e3 * _sigma(quiet, contacts, noise),
        np.linalg.norm(contacts[:, :3], axis=1),
        float(-motion.offset[2]),
    )


def _hand(truth: Truth, seed: int) -> Motion:
    """Draw a motion that pushes with the wanted mean force, and heaves by half its depth: no probe is lifted off."""
    depth = depth_for(truth, FORCE_N)
    for _ in range(_ROUNDS):
        heave = depth / 2
        depth = depth_for(truth, FORCE_N, motion=hand_motion(seed, heave=heave))
    return hand_motion(seed, depth=depth, heave=heave)


def _pressed(
    name: str, count: int, motion: Motion, progress: Callable[[int, int], None]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return true wrenches (n, 6) and contacts (n, 3)."""
    scene = PressScene(truth_of(name), motion=motion)
    scene.advance(_BEGIN_S)
    contacts, points = np.empty((count, 6)), np.empty((count, 3))
    for number in range(count):
        scene.advance(1 / RATE_HZ)
        moment = scene.moment()
        contacts[number], points[number] = moment.contact, moment.point_S
        if number % 100 == 0:
            progress(number, count)
    return contacts, points


def _sigma(quiet: Batch, contacts: NDArray[np.float64], noise: WrenchNoise) -> NDArray[np.float64]:
    rows = np.flatnonzero(quiet.accepted)
    along = [
        contact_sensitivity(quiet.points[i], quiet.normals[i], contacts[i, None, :3])[0][:2] for i in rows
    ]
    return np.asarray(np.sqrt(np.mean([np.diag(J @ noise.covariance @ J.T) for J in along], axis=0)))


def _sure(batch: Batch) -> NDArray[np.float64]:
    return np.where(batch.accepted[:, None], 1e3 * batch.points[:, :2], np.nan)

"""Choices of how a wrench is read: the sensor's crosstalk, its rotation on the flange, and its drift."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.ablation.locating import SENSOR, sigmas_of
from benchmarks.marker_touches import press_markers
from press_scene import depth_for
from scipy.spatial.transform import Rotation

from contactbench import assets
from contactbench.pipeline import kernel
from contactbench.pipeline.calibration import GravityModel, PoseNoise, PoseSample, calibrate
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.calibration.mount import estimate_mount
from contactbench.pipeline.calibration.suggest import by_hand, plan_poses
from contactbench.pipeline.simulation import draw_touches
from contactbench.pipeline.simulation.marker_touches import truth_of
from contactbench.pipeline.simulation.scenes.arm import ArmScene
from contactbench.pipeline.simulation.scenes.physics import Payload
from contactbench.pipeline.simulation.scenes.platform import PlatformMotion, PlatformScene
from contactbench.pipeline.simulation.sensor_model import preset
from contactbench.pipeline.simulation.virtual.markers import markers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.simulation.scenes.physics import SceneMoment, TrueSurface

    Read = tuple[NDArray[np.float64], NDArray[np.float64]]

DRIFT, MOUNT, CROSSTALK = CHOICES = ("drift model", "mount rotation", "sensor crosstalk")
# What each is: K, degrees, % of full scale.
AMOUNTS = {DRIFT: 4.0, MOUNT: 2.0, CROSSTALK: 0.5}
_POSES, _MEANED = 12, 200  # readings of a pose: a second
_FREE_S, _FREE = (60.0, 3600.0), 12
_FLOOR = np.repeat([1e-4, 2e-6], 3)  # N, N·m: below it a calibration would find no noise at all


def read(choice: str, record: SceneRecord, amount: float, noise: float, rng: np.random.Generator) -> Read:
    """
    Read a record with a sensor that is not perfect: (n, 6) wrenches without the choice, and with it, S, N and N·m.

    Parameters
    ----------
    choice : str
        Of CHOICES.
    amount : float
        See AMOUNTS.
    noise : float
        Times that of one reading.
    """
    drawn = sigmas_of(noise) * rng.standard_normal(record.contacts.shape)
    return {DRIFT: _drift, MOUNT: _mount, CROSSTALK: _crosstalk}[choice](record, amount, drawn, rng)


def crosstalk_of(percent: float) -> NDArray[np.float64]:
    """Return the matrix (6, 6) of a sensor with so much crosstalk: the pattern of the noisy preset, scaled."""
    pattern = preset("noisy").crosstalk - np.eye(6)
    return np.asarray(np.eye(6) + percent / 0.5 * pattern)


def _crosstalk(
    record: SceneRecord, amount: float, drawn: NDArray[np.float64], rng: np.random.Generator
) -> Read:
    C = crosstalk_of(amount)
    back = np.linalg.inv(C)
    bias, noise = _bias(), _pose_noise()
    R = _orientations()
    still = WEIGHT.predict(R) @ C.T + bias + noise.sigmas * rng.standard_normal((_POSES, 6))
    readings = (record.contacts + WEIGHT.predict(record.R_WS)) @ C.T + bias + drawn
    plain = calibrate(_poses(R, still)).model
    mended = calibrate(_poses(R, still @ back.T)).model
    return plain.compensate(record.R_WS, readings), mended.compensate(record.R_WS, readings @ back.T)


def _mount(record: SceneRecord, amount: float, drawn: NDArray[np.float64], rng: np.random.Generator) -> Read:
    axis = rng.standard_normal(3)
    R_SE = Rotation.from_rotvec(np.radians(amount) * axis / np.linalg.norm(axis)).as_matrix()
    bias, noise, R_WE = _bias(), _pose_noise(), _orientations()
    still = WEIGHT.predict(R_WE @ R_SE.T) + bias + noise.sigmas * rng.standard_normal((_POSES, 6))
    poses = _poses(R_WE, still)  # their orientations are the flange's
    readings = record.contacts + WEIGHT.predict(record.R_WS) + bias + drawn
    used = record.R_WS @ R_SE  # R_WE while it is used
    believed, estimated = calibrate(poses), estimate_mount(poses)
    mended = estimated.calibration.model.compensate(used @ estimated.R_SE.T, readings)
    return believed.model.compensate(used, readings), mended


def _drift(record: SceneRecord, amount: float, drawn: NDArray[np.float64], rng: np.random.Generator) -> Read:
    drift, bias, noise = preset(SENSOR).drift, _bias(), _pose_noise()
    R = _orientations()
    still = WEIGHT.predict(R) + bias + noise.sigmas * rng.standard_normal((_POSES, 6))
    model = calibrate(_poses(R, still)).model
    watch = _watch(model)
    first, last = _FREE_S
    for number, t in enumerate(np.linspace(first, last, _FREE)):
        warmer, turn = amount * (t - first) / (last - first), R[number % _POSES]
        free = WEIGHT.predict(turn) + bias + warmer * drift
        _see(watch, float(t), turn, model.compensate(turn, free), rng)
    zero = watch.at(last).offset
    moved = np.zeros(6) if zero is None else zero
    readings = record.contacts + WEIGHT.predict(record.R_WS) + bias + amount * drift + drawn
    compensated = model.compensate(record.R_WS, readings)
    return compensated, compensated - moved


def _watch(model: GravityModel) -> kernel.ZeroWatch:
    """Watch the zero of a sensor whose probe is touched 100 mm away from it."""
    return kernel.ZeroWatch(
        model.vector, model.covariance, np.tile([0.0, 0.0, 0.1], (6, 1)), orientation_sigma=0.0, min_force=0.5
    )


def _see(
    watch: kernel.ZeroWatch,
    t: float,
    R_WS: NDArray[np.float64],
    wrench: NDArray[np.float64],
    rng: np.random.Generator,
) -> None:
    """Show it a moment without contact: a second of readings about a compensated wrench (6,), S."""
    times = t + np.arange(_MEANED + 1) / _MEANED
    noise = preset(SENSOR).noise * rng.standard_normal((len(times), 6))
    watch.see(wrench + noise, np.repeat(R_WS[None], len(times), axis=0), times)


def _bias() -> NDArray[np.float64]:
    return preset(SENSOR).bias


def _pose_noise() -> PoseNoise:
    sigmas = np.maximum(preset(SENSOR).noise / np.sqrt(_MEANED), _FLOOR)
    return PoseNoise(sigmas[:3], sigmas[3:])


def _poses(R: NDArray[np.float64], readings: NDArray[np.float64]) -> list[PoseSample]:
    return [PoseSample(each, w[:3], w[3:]) for each, w in zip(R, readings, strict=True)]


@cache
def _orientations() -> NDArray[np.float64]:
    return plan_poses(_POSES, by_hand()).R_WS


# ---- what the scenes give: true contacts and what a perfect sensor reads of them -----------------


# Touches drawn over the whole head: no physics, but every curvature. Tips on markers. Beside a phantom that moves.
ANYWHERE, TOUCH, PLATFORM, ARM = SCENES = ("whole head", "touch", "platform", "arm")
PAYLOAD = Payload()
WEIGHT = GravityModel(
    np.array([0.0, 0.0, -STANDARD_GRAVITY * PAYLOAD.mass]), np.zeros(3), PAYLOAD.centre_of_mass_S, np.zeros(3)
)
_FORCE_N, _PERIOD_S = 7.0, 2.0  # beside a phantom; tips press with 8 to 10 N
_REST_S, _STEP_S = 0.5, 0.02
_LEAST_N = 1.0  # less is no touch that anybody would locate


@dataclass(frozen=True, eq=False)
class SceneRecord:
    """Contacts of one probe in one scene, one row each; S, SI units."""

    scene: str
    probe: str
    # contacts, felt: (n, 6) True wrench on the probe, and what a perfect sensor reads beside the weight:
    # the contact, and inertia where something moves
    contacts: NDArray[np.float64]
    felt: NDArray[np.float64]
    points: NDArray[np.float64]  # (n, 3) True place of the contact
    R_WS: NDArray[np.float64]  # (n, 3, 3)

    def __len__(self) -> int:
        return len(self.contacts)


def record(scene: str, probe: str, tips: int) -> SceneRecord:
    """Run a scene with physics: press the first markers, or move for 2 s; InputError without MuJoCo."""
    if scene == TOUCH:
        touched = press_markers(probe, markers(probe)[:tips], (0,), 1)
        return SceneRecord(TOUCH, probe, touched.contacts, touched.contacts, touched.points, touched.R_WS)
    kind = PlatformScene if scene == PLATFORM else ArmScene
    moments = [moment for moment in _ridden(kind, truth_of(probe)) if moment.force > _LEAST_N]
    R_WS = np.array([moment.R_WS for moment in moments])
    return SceneRecord(
        scene,
        probe,
        np.array([moment.contact for moment in moments]),
        np.array([moment.reading for moment in moments]) - WEIGHT.predict(R_WS),
        np.array([moment.point_S for moment in moments]),
        R_WS,
    )


def _ridden(kind: type[PlatformScene | ArmScene], truth: TrueSurface) -> list[SceneMoment]:
    """Return what a probe meets that follows nine tenths of a phantom's turning, every 5 ms after a quarter period."""
    depth = depth_for(truth, _FORCE_N)
    size, seen = np.radians(10), list["SceneMoment"]()
    scene = kind(truth, motion=PlatformMotion.along("ry", size, _PERIOD_S, _REST_S), gap=-depth)
    followed = PlatformMotion.along("ry", 0.9 * size, _PERIOD_S, _REST_S)
    q = scene.start
    for k in range(1, round((_REST_S + 1.25 * _PERIOD_S) / _STEP_S) + 1):
        q = scene.joints_for(*scene.held_at(-depth, followed.at(k * _STEP_S)), q)
        scene.command(q)
        for _ in range(4):
            scene.advance(_STEP_S / 4)
            if k > round((_REST_S + 0.25 * _PERIOD_S) / _STEP_S):
                seen.append(scene.moment())
    return seen


def drawn(probe: str, count: int, rng: np.random.Generator, *, torsion: float = 0.0003) -> SceneRecord:
    """Draw touches of the exact surface up to 30 degrees, without physics; torsion is the deviation of k / |F|, m."""
    surface = assets.surface(probe)
    touches = draw_touches(surface, count, rng, torsion_arm=torsion, angle=(0.0, 30.0), above=0.02)
    upright = np.broadcast_to(np.diag([1.0, -1.0, -1.0]), (count, 3, 3))
    return SceneRecord(ANYWHERE, probe, touches.wrenches, touches.wrenches, touches.points, upright)

"""A closed loop on a bundled probe: scene, a sensor that was calibrated on the virtual bench, and the controller."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from contactbench.pipeline.calibration import Calibration, PoseSample, calibrate
from contactbench.pipeline.calibration.reachable import by_hand
from contactbench.pipeline.calibration.suggest import plan_poses
from contactbench.pipeline.control.command import SensorMount
from contactbench.pipeline.control.controller import Controller
from contactbench.pipeline.control.foundation import Foundation
from contactbench.pipeline.control.intake import SampleIntake
from contactbench.pipeline.control.loop import Rig, arm_of
from contactbench.pipeline.simulation.loads import LoadedSensor, draw_load
from contactbench.pipeline.simulation.marker_touches import model_of, truth_of
from contactbench.pipeline.simulation.scenes import ArmScene, Payload, PlatformScene, Tissue
from contactbench.pipeline.simulation.sensor_model import SensorModel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.control.settings import ControlSettings
    from contactbench.pipeline.simulation.scenes import PlatformMotion

SceneName = Literal["platform", "arm"]
SCENES: tuple[SceneName, ...] = ("platform", "arm")
FACETS = 2_000
POSES, RATE_HZ = 8, 200.0
WARM_S = 3600.0  # since the sensor was switched on
_POSE_S, _BETWEEN_S = 1.0, 5.0
_MASS_KG = (0.3, 0.8)
COARSE: dict[str, Any] = {"step": 0.002, "places": 40}  # quicker; figures are for a first look


@dataclass(frozen=True, eq=False)
class CalibratedSensor(LoadedSensor):
    """A sensor, its load, and the gravity calibration that was made of it."""

    seed: int = 0
    calibration: Calibration = field(kw_only=True)


def draw_sensor(seed: int, sensor: str = "paper", calibrated_at: float = WARM_S) -> CalibratedSensor:
    """
    Draw load and biases, and calibrate.

    Each pose is a second of readings of weight, bias and noise. The physics is left out there: at rest it gives just
    these sums.

    Parameters
    ----------
    sensor : str
        A preset.
    calibrated_at : float
        s since the sensor was switched on; a cold one drifts afterwards.
    """
    rng = np.random.default_rng([seed, 1])
    loaded = LoadedSensor(draw_load(rng, _MASS_KG), sensor)
    model = SensorModel(loaded.settings, rng)
    poses = []
    for number, R_WS in enumerate(_orientations()):
        times = calibrated_at + _BETWEEN_S * number + np.arange(0.0, _POSE_S, 1 / RATE_HZ)
        read = model.read(times, np.tile(loaded.weight(R_WS), (len(times), 1))).wrenches
        mean, scatter = read.mean(axis=0), read.std(axis=0, ddof=1)
        poses.append(PoseSample(R_WS, mean[:3], mean[3:], len(read), scatter[:3], scatter[3:]))
    return CalibratedSensor(loaded.load, sensor, seed, calibration=calibrate(poses))


@cache
def _orientations() -> NDArray[np.float64]:
    return plan_poses(POSES, by_hand()).R_WS


@cache
def foundation_of(probe: str) -> Foundation:
    """Return what is known of a bundled probe's press."""
    return Foundation(model_of(probe, FACETS))


def make_rig(
    scene: SceneName,
    probe: str,
    settings: ControlSettings,
    seed: int,
    *,
    method: str = "contactbench",
    tissue: Tissue | None = None,
    motion: PlatformMotion | None = None,
    gap: float = 0.003,
    coarse: bool = False,
) -> Rig:
    """
    Put one together.

    Parameters
    ----------
    probe : str
        One of assets.PROBE_NAMES.
    seed : int
        Of load, biases, calibration and noise: the calibration is made from readings, it is not the truth.
    gap : float
        m between probe and phantom at the beginning.
    coarse : bool
        Physics with a step of 2 ms and fewer places.

    Raises
    ------
    InputError
        Something needed is missing, such as MuJoCo or Embree.
    """
    bench = draw_sensor(seed)
    made = ArmScene if scene == "arm" else PlatformScene
    world = made(
        truth_of(probe),
        payload=Payload(bench.load.mass, bench.load.centre_of_mass_S),
        tissue=tissue or Tissue(friction=0.1),
        motion=motion,
        gap=gap,
        **(COARSE if coarse else {}),
    )
    model = model_of(probe, FACETS)
    noise = bench.settings.wrench_noise
    intake = SampleIntake(model, bench.calibration.model, noise, method=method, stale=settings.stale)
    mount = SensorMount(world.R_ES, world.p_ES_E)
    controller = Controller(settings, arm_of(world), model, intake, mount, world.start)
    return Rig(world, controller, SensorModel(bench.settings, np.random.default_rng([seed, 3])))

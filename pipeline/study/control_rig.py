"""A closed loop on a bundled probe: scene, a sensor that was calibrated on the virtual bench, and the controller."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from contactbench.pipeline.control.command import Mount
from contactbench.pipeline.control.controller import Controller
from contactbench.pipeline.control.foundation import Foundation
from contactbench.pipeline.control.loop import arm_of
from contactbench.pipeline.control.sensing import Intake
from contactbench.pipeline.simulation.scenes import ArmScene, MovedScene, Payload, PlatformScene, Tissue
from contactbench.pipeline.simulation.sensor_model import SensorModel
from contactbench.pipeline.study.marker_touches import model_of, truth_of
from contactbench.pipeline.study.paper_setup import draw_bench

if TYPE_CHECKING:
    from contactbench.pipeline.control.settings import ControlSettings
    from contactbench.pipeline.simulation.scenes import PlatformMotion

SceneName = Literal["platform", "arm"]
SCENES: tuple[SceneName, ...] = ("platform", "arm")
FACETS = 2_000
COARSE: dict[str, Any] = {"step": 0.002, "places": 40}  # quicker; figures are for a first look


@dataclass(frozen=True, eq=False)
class Rig:
    """What a closed loop is made of: see `run_loop`."""

    scene: MovedScene
    controller: Controller
    sensor: SensorModel


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
    bench = draw_bench(seed)
    made = ArmScene if scene == "arm" else PlatformScene
    world = made(
        truth_of(probe),
        payload=Payload(bench.truth.mass, bench.truth.centre_of_mass_S),
        tissue=tissue or Tissue(friction=0.1),
        motion=motion,
        gap=gap,
        **(COARSE if coarse else {}),
    )
    model = model_of(probe, FACETS)
    noise = bench.settings.wrench_noise
    intake = Intake(model, bench.calibration.model, noise, method=method, stale=settings.stale)
    mount = Mount(world.R_ES, world.p_ES_E)
    controller = Controller(settings, arm_of(world), model, intake, mount, world.start)
    return Rig(world, controller, SensorModel(bench.settings, np.random.default_rng([seed, 3])))

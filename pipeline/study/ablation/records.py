"""What the scenes give: true contacts and what a perfect sensor reads of them."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench import assets
from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation import draw_touches
from contactbench.pipeline.simulation.marker_touches import ANGLES, press_markers, truth_of
from contactbench.pipeline.simulation.scenes import (
    BenchScene,
    Payload,
    PressScene,
    TipPress,
    depth_for,
    hand_motion,
)
from contactbench.pipeline.simulation.scenes.press import PRESS_STEP_S
from contactbench.pipeline.simulation.virtual.markers import markers
from contactbench.pipeline.study import scene_limits

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.simulation.scenes import MovedScene, SceneMoment, TrueSurface

TOUCH, PRESS, BENCH, PLATFORM, ARM = SCENES = ("touch", "press", "bench", "platform", "arm")
ANYWHERE = "whole head"  # touches drawn over the whole head: no physics, but every curvature
PAYLOAD = Payload()
WEIGHT = GravityModel(
    np.array([0.0, 0.0, -STANDARD_GRAVITY * PAYLOAD.mass]), np.zeros(3), PAYLOAD.centre_of_mass_S, np.zeros(3)
)
FORCE_N = 7.0  # of the scenes with tissue; tips press with 8 to 10
SAMPLE_S = 0.025
LEAST_N = 1.0  # less is no touch that anybody would locate
_PERIOD_S = 2.0
_BEGIN_S, _REST_S = 1.0, 1.0
_TIP_N = 9.0
_ROUNDS = 3  # depth and heave depend on each other


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
    seconds: float  # that computing a row took

    def __len__(self) -> int:
        return len(self.contacts)


def record(scene: str, probe: str, size: int) -> SceneRecord:
    """
    Run a scene.

    Parameters
    ----------
    scene : str
        Of SCENES.
    probe : str
        A bundled one.
    size : int
        How much of it: markers of the scenes with a tip, fifths of a second of a press; a platform moves for 2 s.

    Raises
    ------
    InputError
        There is no such scene, or MuJoCo is missing.
    """
    match scene:
        case "touch":
            return _touched(probe, size)
        case "bench":
            return _timed(scene, probe, lambda: _benched(probe, size))
        case "press":
            return _timed(scene, probe, lambda: pressed(truth_of(probe), size)[1])
        case "platform" | "arm":
            change = scene_limits.AS_IT_IS if scene == "platform" else scene_limits.ARM
            make = scene_limits.changes(truth_of(probe))[change].make
            return _timed(scene, probe, lambda: ridden(truth_of(probe), make, "in plane")[1])
        case _:
            raise InputError(f"there is no scene {scene!r}: choose one of {', '.join(SCENES)}.")


def drawn(
    probe: str, count: int, rng: np.random.Generator, *, torsion: float = 0.0003, angle: float = 30.0
) -> SceneRecord:
    """
    Draw touches of the exact surface, without physics: as in the static experiments, if nothing else is said.

    Parameters
    ----------
    torsion : float
        Standard deviation of k / |F|, m.
    angle : float
        Largest friction angle, degrees.
    """
    began = time.perf_counter()
    touches = draw_touches(
        assets.surface(probe), count, rng, torsion_arm=torsion, angle=(0.0, angle), above=0.02
    )
    upright = np.broadcast_to(np.diag([1.0, -1.0, -1.0]), (count, 3, 3))
    spent = time.perf_counter() - began
    return SceneRecord(
        ANYWHERE, probe, touches.wrenches, touches.wrenches, touches.points, upright, spent / count
    )


def ridden(
    truth: TrueSurface, make: Callable[..., MovedScene], motion: str
) -> tuple[scene_limits.Ride, list[SceneMoment]]:
    """Move a probe beside a phantom for 2 s; return what was met, and the moments, every 5 ms."""
    moments: list[SceneMoment] = []
    axis, amplitude = scene_limits.MOTIONS[motion]
    depth = depth_for(truth, FORCE_N)
    met, _ = scene_limits.ride(make, axis, amplitude, _PERIOD_S, depth, seen=moments.append)
    return met, moments


def pressed(
    truth: TrueSurface, size: int, *, step: float = PRESS_STEP_S
) -> tuple[PressScene, list[SceneMoment]]:
    """Press by hand for `size` fifths of a second, with 7 N in the mean; return the scene and a moment every 25 ms."""
    depth = depth_for(truth, FORCE_N)
    for _ in range(_ROUNDS):
        heave = depth / 2
        depth = depth_for(truth, FORCE_N, motion=hand_motion(heave=heave))
    scene = PressScene(truth, motion=hand_motion(depth=depth, heave=heave), step=step)
    scene.advance(_BEGIN_S)
    moments = []
    for _ in range(round(0.2 * size / SAMPLE_S)):
        scene.advance(SAMPLE_S)
        moments.append(scene.moment())
    return scene, moments


def _touched(probe: str, size: int) -> SceneRecord:
    began = time.perf_counter()
    touched = press_markers(probe, markers(probe)[:size], (0,), 1)
    spent = (time.perf_counter() - began) / len(touched)
    return SceneRecord(TOUCH, probe, touched.contacts, touched.contacts, touched.points, touched.R_WS, spent)


def _benched(probe: str, size: int) -> list[SceneMoment]:
    scene = BenchScene(truth_of(probe), payload=PAYLOAD)
    moments = []
    for marker in markers(probe)[:size]:
        for tilt, azimuth in ANGLES.values():
            scene.aim(marker)
            scene.press(TipPress(_TIP_N, tilt, azimuth, 0.0003 * _TIP_N))
            scene.advance(_REST_S)
            moments.append(scene.moment())
            scene.release()
    return moments


def _timed(scene: str, probe: str, run: Callable[[], Sequence[SceneMoment]]) -> SceneRecord:
    began = time.perf_counter()
    moments = [moment for moment in run() if moment.force > LEAST_N]
    spent = (time.perf_counter() - began) / max(len(moments), 1)
    R_WS = np.array([moment.R_WS for moment in moments])
    readings = np.array([moment.reading for moment in moments])
    return SceneRecord(
        scene,
        probe,
        np.array([moment.contact for moment in moments]),
        readings - WEIGHT.predict(R_WS),
        np.array([moment.point_S for moment in moments]),
        R_WS,
        spent,
    )

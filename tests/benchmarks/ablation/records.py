"""What the scenes give: true contacts and what a perfect sensor reads of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench import assets
from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.simulation import draw_touches
from contactbench.pipeline.simulation.marker_touches import press_markers, truth_of
from contactbench.pipeline.simulation.scenes import Payload, depth_for
from contactbench.pipeline.simulation.virtual.markers import markers
from contactbench.pipeline.study import scene_limits

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.simulation.scenes import SceneMoment

# Touches drawn over the whole head: no physics, but every curvature. Tips on markers. Beside a phantom that moves.
ANYWHERE, TOUCH, PLATFORM, ARM = SCENES = ("whole head", "touch", "platform", "arm")
PAYLOAD = Payload()
WEIGHT = GravityModel(
    np.array([0.0, 0.0, -STANDARD_GRAVITY * PAYLOAD.mass]), np.zeros(3), PAYLOAD.centre_of_mass_S, np.zeros(3)
)
_FORCE_N, _PERIOD_S = 7.0, 2.0  # beside a phantom; tips press with 8 to 10 N
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
    truth = truth_of(probe)
    change = scene_limits.AS_IT_IS if scene == PLATFORM else scene_limits.ARM
    make, seen = scene_limits.changes(truth)[change].make, list["SceneMoment"]()
    axis, size = scene_limits.MOTIONS["in plane"]
    scene_limits.ride(make, axis, size, _PERIOD_S, depth_for(truth, _FORCE_N), seen=seen.append)
    moments = [moment for moment in seen if moment.force > _LEAST_N]
    R_WS = np.array([moment.R_WS for moment in moments])
    return SceneRecord(
        scene,
        probe,
        np.array([moment.contact for moment in moments]),
        np.array([moment.reading for moment in moments]) - WEIGHT.predict(R_WS),
        np.array([moment.point_S for moment in moments]),
        R_WS,
    )


def drawn(probe: str, count: int, rng: np.random.Generator, *, torsion: float = 0.0003) -> SceneRecord:
    """Draw touches of the exact surface up to 30 degrees, without physics; torsion is the deviation of k / |F|, m."""
    surface = assets.surface(probe)
    touches = draw_touches(surface, count, rng, torsion_arm=torsion, angle=(0.0, 30.0), above=0.02)
    upright = np.broadcast_to(np.diag([1.0, -1.0, -1.0]), (count, 3, 3))
    return SceneRecord(ANYWHERE, probe, touches.wrenches, touches.wrenches, touches.points, upright)

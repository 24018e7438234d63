"""
Scenes in MuJoCo, each with only what its question needs, and the truth about every contact in them.

The smallest is `TouchScene`: one tip on one place of a probe that is held still. `PressScene` is a probe against soft
tissue, `BenchScene` a tool on a wrist; `PlatformScene` and `ArmScene` follow set-points over a phantom that moves.
"""

from contactbench.pipeline.simulation.scenes.arm import ArmScene
from contactbench.pipeline.simulation.scenes.bench import BenchScene
from contactbench.pipeline.simulation.scenes.indenter import Tip, TipPress, TouchScene
from contactbench.pipeline.simulation.scenes.motion import Motion, hand_motion
from contactbench.pipeline.simulation.scenes.physics import (
    Payload,
    PhysicsError,
    PhysicsScene,
    SceneMoment,
    TrueSurface,
)
from contactbench.pipeline.simulation.scenes.platform import (
    MovedScene,
    PlatformMotion,
    PlatformScene,
    PressScene,
)
from contactbench.pipeline.simulation.scenes.setpoints import ServoSettings
from contactbench.pipeline.simulation.scenes.tissue import Tissue, TissueCourse, depth_for

__all__ = [
    "ArmScene",
    "BenchScene",
    "Motion",
    "MovedScene",
    "Payload",
    "PhysicsError",
    "PhysicsScene",
    "PlatformMotion",
    "PlatformScene",
    "PressScene",
    "SceneMoment",
    "ServoSettings",
    "Tip",
    "TipPress",
    "Tissue",
    "TissueCourse",
    "TouchScene",
    "TrueSurface",
    "depth_for",
    "hand_motion",
]

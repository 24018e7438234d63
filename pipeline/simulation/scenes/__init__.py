"""
Scenes in MuJoCo, each with only what its question needs, and the truth about every contact in them.

The smallest is `TouchScene`: one tip on one place of a probe that is held still. `BenchScene` is a tool on a
wrist; `PlatformScene` and `ArmScene` follow set-points over a phantom of soft tissue that moves.
"""

from contactbench.pipeline.simulation.scenes.arm import ArmScene
from contactbench.pipeline.simulation.scenes.bench import BenchScene
from contactbench.pipeline.simulation.scenes.indenter import Tip, TipPress, TouchScene
from contactbench.pipeline.simulation.scenes.physics import (
    Payload,
    PhysicsError,
    PhysicsScene,
    SceneMoment,
    TrueSurface,
)
from contactbench.pipeline.simulation.scenes.platform import MovedScene, PlatformMotion, PlatformScene
from contactbench.pipeline.simulation.scenes.setpoints import ServoSettings
from contactbench.pipeline.simulation.scenes.tissue import Tissue, TissueCourse

__all__ = [
    "ArmScene",
    "BenchScene",
    "MovedScene",
    "Payload",
    "PhysicsError",
    "PhysicsScene",
    "PlatformMotion",
    "PlatformScene",
    "SceneMoment",
    "ServoSettings",
    "Tip",
    "TipPress",
    "Tissue",
    "TissueCourse",
    "TouchScene",
    "TrueSurface",
]

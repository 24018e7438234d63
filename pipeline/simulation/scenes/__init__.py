"""
Scenes in MuJoCo, each with only what its question needs, and the truth about every contact in them.

The smallest is `TouchScene`: one tip on one place of a probe that is held still. `PressScene` is a probe against soft
tissue, `BenchScene` a tool on a wrist; `PlatformScene` and `ArmScene` follow set-points over a phantom that moves.
"""

from pipeline.simulation.scenes.arm import ArmScene
from pipeline.simulation.scenes.bench import BenchScene
from pipeline.simulation.scenes.depth import depth_for
from pipeline.simulation.scenes.indenter import Press, Tip
from pipeline.simulation.scenes.motion import Motion, hand_motion
from pipeline.simulation.scenes.physics import Moment, Payload, PhysicsError, Scene, Truth
from pipeline.simulation.scenes.platform import MovedScene, PlatformScene
from pipeline.simulation.scenes.platform_motion import PlatformMotion
from pipeline.simulation.scenes.press import PressScene
from pipeline.simulation.scenes.servo import ServoSettings
from pipeline.simulation.scenes.tissue import Tissue
from pipeline.simulation.scenes.touch import TouchScene

__all__ = [
    "ArmScene",
    "BenchScene",
    "Moment",
    "Motion",
    "MovedScene",
    "Payload",
    "PhysicsError",
    "PlatformMotion",
    "PlatformScene",
    "Press",
    "PressScene",
    "Scene",
    "ServoSettings",
    "Tip",
    "Tissue",
    "TouchScene",
    "Truth",
    "depth_for",
    "hand_motion",
]

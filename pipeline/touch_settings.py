"""What is known of a touch before it is located."""

from typing import Literal

from contactbench.pipeline.knobs import Settings, knob

# What is known of a touch if nobody says more: one sigma of its torsion over its force, and of the model error.
TORSION_ARM_M, DEFAULT_FORCE_N, DEFAULT_TORQUE_NM = 0.001, 0.05, 0.001

Scene = Literal["dry", "gel", "bone"]
TorsionWay = Literal["learned", "fixed"]
_SCENE_ARMS_M: dict[Scene, float] = {"dry": 0.002, "gel": 0.001, "bone": 0.0005}


def arm_of(given: float | None, scene: Scene | None) -> float:
    """Return one sigma of a touch's torsion over its force, m: as it is given, or as usual in the scene."""
    if given is not None:
        return given
    return TORSION_ARM_M if scene is None else _SCENE_ARMS_M[scene]


class TorsionSettings(Settings):
    """What is known of torsion before a touch is located."""

    scene: Scene | None = knob(
        None,
        "What is touched: dry skin, skin with gel, or what is as hard as bone. Unless it is given, the torsion arm is"
        " then 2, 1 or 0.5 mm.",
        none="not known",
    )
    torsion: TorsionWay = knob(
        "learned", "Whether the torsion arm is learned while a touch is followed, or stays fixed."
    )


class TouchModelSettings(TorsionSettings):
    """What is known of a wrench and of a touch before one is located."""

    noise_force: float = knob(0.05, "Standard deviation of a force.", unit="N")
    noise_torque: float = knob(0.002, "Standard deviation of a torque.", unit="N·m")
    torsion_arm: float | None = knob(
        None,
        "Torsion that a touch may have, 1 sigma: local torque over force. A hard tip has 0.3, soft tissue 1 to 5.",
        unit="mm",
        scale=1000,
        none="1, or that of the scene",
    )
    model_force: float = knob(
        DEFAULT_FORCE_N, "Error that drift, cable and hysteresis leave in a force, 1 sigma.", unit="N"
    )
    model_torque: float = knob(DEFAULT_TORQUE_NM, "The same for a torque.", unit="mN·m", scale=1000)

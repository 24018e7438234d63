"""What is known of a touch before it is located."""

from __future__ import annotations

from contactbench.pipeline.knobs import Settings, knob

# What is known of a touch if nobody says more: one sigma of its torsion over its force, and of the model error.
TORSION_ARM_M, DEFAULT_FORCE_N, DEFAULT_TORQUE_NM = 0.001, 0.05, 0.001


class TouchModelSettings(Settings):
    """What is known of a wrench and of a touch before one is located."""

    noise_force: float = knob(0.05, "Standard deviation of a force.", unit="N")
    noise_torque: float = knob(0.002, "Standard deviation of a torque.", unit="N·m")
    torsion_arm: float = knob(
        TORSION_ARM_M,
        "Torsion that a touch may have, 1 sigma: local torque over force. A hard tip has 0.3, soft tissue 1 to 5.",
        unit="mm",
        scale=1000,
    )
    model_force: float = knob(
        DEFAULT_FORCE_N, "Error that drift, cable and hysteresis leave in a force, 1 sigma.", unit="N"
    )
    model_torque: float = knob(DEFAULT_TORQUE_NM, "The same for a torque.", unit="mN·m", scale=1000)

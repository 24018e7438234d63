"""What a person chooses for an export, once: options of the command, ``config.*`` of a session, rows of the window."""

from typing import Annotated, ClassVar

from pydantic import Field

from contactbench.pipeline.gates import GateSettings, SigmaMax, sigma_max_knob
from contactbench.pipeline.knobs import Row, knob
from contactbench.pipeline.settings import MountSettings
from contactbench.pipeline.touch_settings import TorsionSettings

_Positive = Annotated[float, Field(gt=0, le=1e9, allow_inf_nan=False)]
_Arm = Annotated[float, Field(ge=0, le=100, allow_inf_nan=False)]
_Name = Annotated[str, Field(min_length=1, max_length=200)]


class ExportKnobs(GateSettings, MountSettings, TorsionSettings):
    """What goes into a bundle beside calibration and probe; None: what the session or the files know."""

    overlay: ClassVar[bool] = True

    sigma_max: SigmaMax = sigma_max_knob(0.002)
    sensor: _Name = knob("unknown", "Model of the sensor.", option="--model")
    serial: _Name | None = knob(None, "Serial number of the sensor.", none="the one in the session")
    rate: Annotated[_Positive | None, Row("Readings", (0.0, 10e3), 1, none="as verified")] = knob(
        None, "Readings per second.", unit="Hz", none="as verified, if the verification states it"
    )
    noise_force: _Positive | None = knob(
        None, "Standard deviation of one reading.", unit="N", none="from the poses"
    )
    noise_torque: _Positive | None = knob(None, "The same for a torque; give both or neither.", unit="N·m")
    cutoff: Annotated[_Positive | None, Row("Low-pass", (0.0, 5e3), 1, none="none")] = knob(
        None, "Low-pass cutoff of the contact point.", unit="Hz", none="none"
    )
    no_filter: bool = knob(False, "Do not filter the wrench.", none="filter", option="--no-filter/--filter")
    paper_filter: bool = knob(
        False,
        "Filter the wrench with the paper's fixed values: contacts then lag by 68 ms at 200 Hz, and a release is"
        " noticed up to 0.2 s late.",
        none="a filter that follows changes",
        option="--paper-filter/--adaptive-filter",
    )
    follow: bool | None = knob(
        None,
        "Whether a runtime subtracts what the sensor reads in moments without touch (the zero follows).",
        none="as verified",
        option="--follow/--no-follow",
    )
    torsion_arm_mm: _Arm | None = knob(
        None,
        "Usual local torque over the force: hard tip 0.3, soft tissue 1 to 5.",
        unit="mm",
        none="1, or that of the scene",
    )
    max_force: Annotated[_Positive, Row("Maximum force", (0.1, 1e3), 1)] = knob(
        30.0, "Force limit for the controller.", unit="N"
    )
    max_torque: Annotated[_Positive, Row("Maximum torque", (0.1, 100.0), 1)] = knob(
        3.0, "Torque limit for the controller.", unit="N·m"
    )
    max_speed: _Positive | None = knob(
        None, "Speed of the tip that a controller must never exceed.", unit="m/s", none="none"
    )
    max_turn: _Positive | None = knob(
        None, "Turning speed that a controller must never exceed.", unit="rad/s", none="none"
    )
    sensor_frame: _Name = knob("ft_sensor", "Name of frame S in the robot description.")
    world_frame: _Name = knob("base_link", "Name of frame W in the robot description.")
    sensor_name: _Name | None = knob(
        None,
        "Name of the sensor in the robot description's ros2_control tag, for ros2.yaml.",
        none="a placeholder",
        metavar="NAME",
    )
    operator: _Name | None = knob(
        None, "Responsible person.", none="the author of the session's newest result"
    )

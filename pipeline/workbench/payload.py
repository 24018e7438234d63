"""The robot's payload in the window: what ``contactbench bundle payload`` prints for the bundle to be written."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.payload import payload_in_mm
from contactbench.pipeline.config.runtime.build import calibration_refused
from contactbench.pipeline.config.runtime.values import rotation_ES
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.settings import PayloadSettings

if TYPE_CHECKING:
    from contactbench.pipeline.calibration.payload import Payload
    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.session import State

KIND = "payload"
"""The settings of a session begin with it: ``payload.sensor_at``."""


@dataclass(frozen=True)
class PayloadText:
    """What a robot is told."""

    line: str  # As its controller takes it
    payload: Payload
    mount_known: bool  # Somebody said how the sensor is turned on the flange; False: taken as not turned


def stored_payload(state: State) -> PayloadSettings:
    """Return what a session's settings say; InputError, with the first that is wrong."""
    names = PayloadSettings.model_fields
    return PayloadSettings.checked(
        {
            name: state.settings[f"{KIND}.{name}"].value
            for name in names
            if f"{KIND}.{name}" in state.settings and state.settings[f"{KIND}.{name}"].value is not None
        }
    )


def payload_text(config: RuntimeConfig, settings: PayloadSettings) -> PayloadText:
    """
    Return the payload that a bundle's calibration gives.

    Raises
    ------
    InputError
        The calibration was refused, or has no load.
    """
    if calibration_refused(config.model):
        raise InputError("The calibration is refused: calibrate again before you tell a robot its payload.")
    R_ES = rotation_ES(config.model.frames.quaternion_ES)
    made = payload_in_mm(
        config.gravity, np.eye(3) if R_ES is None else R_ES, settings.sensor_at, settings.sensor_body
    )
    return PayloadText(made.text(settings.robot), made, R_ES is not None)

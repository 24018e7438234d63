"""What a session says of how its gravity calibration is computed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.calibration import ContactTask, PoseNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session.make_calibration import CalibrationParameters
from contactbench.pipeline.session.making import mount_rotation, read_parameters

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.session import State

MOUNT, INVERSE, TILT = "devices.mount", "calibration.inverse", "devices.max_tilt"
DOWN, ORIENTATION_NOISE = "calibration.down", "calibration.orientation_noise"
CALIBRATION_FILE, POSES_FILE = "calibration.json", "poses.csv"
_KIND = "calibration."


@dataclass(frozen=True)
class GravitySettings:
    """
    How poses are read and calibrated.

    Attributes
    ----------
    parameters : CalibrationParameters
        Those with which the session will compute its calibration; `mount` is R_ES as angles in degrees.
    max_tilt : float
        Largest angle between the sensor's z axis and straight down that can be reached, degrees.
    """

    parameters: CalibrationParameters
    max_tilt: float = 180.0

    @property
    def given(self) -> dict[str, Any]:
        """What differs from the usual, as the session is told: JSON values, without the name."""
        given: dict[str, Any] = self.parameters.model_dump(
            mode="json", exclude={"name"}, exclude_defaults=True
        )
        return given

    @property
    def R_ES(self) -> NDArray[np.float64]:
        """(3, 3) orientation of the sensor on the flange."""
        R = mount_rotation(self.parameters.mount)
        return np.eye(3) if R is None else R

    @property
    def noise(self) -> PoseNoise | None:
        """Of a pose's mean; None: it is estimated from the poses."""
        force, torque = self.parameters.noise_force, self.parameters.noise_torque
        return None if force is None or torque is None else PoseNoise(force, torque)

    @property
    def orientation_sigma(self) -> float | None:
        """Of the poses' orientations, rad; None: it is estimated."""
        degrees = self.parameters.orientation_noise
        return None if degrees is None else float(np.radians(degrees))

    @property
    def down_W(self) -> tuple[float, float, float]:
        """Where gravity points in W."""
        return self.parameters.down

    @property
    def task(self) -> ContactTask:
        """The touches that the calibration is for, as the session's computation takes them."""
        tip = np.array(self.parameters.tip) / 1000
        normal = np.array([0.0, 0.0, -1.0 if tip[2] < 0 else 1.0])
        return ContactTask(tip, normal, self.parameters.contact_force)

    def sensor_orientations(self, R_WE: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return R_WS (n, 3, 3) of the flange's orientations as the source of poses gives them."""
        read = R_WE.swapaxes(-1, -2) if self.parameters.inverse else R_WE
        R: NDArray[np.float64] = read @ self.R_ES
        return R


def gravity_settings(state: State) -> GravitySettings:
    """
    Return what a session's parameters say.

    Raises
    ------
    InputError
        One of them makes no sense.
    """
    given = {
        key.removeprefix(_KIND): setting.value
        for key, setting in state.settings.items()
        if key.startswith(_KIND)
    }
    mount, own = state.settings.get(MOUNT), state.settings.get(f"{_KIND}mount")
    if mount is not None and (own is None or own.number < mount.number):  # the newest word counts
        given["mount"] = mount.value if mount.value and any(mount.value) else None
    if given.get("estimate_mount"):
        given.pop("mount", None)
    parameters = read_parameters(CalibrationParameters, {**given, "name": CALIBRATION_FILE})
    tilt = state.settings.get(TILT)
    degrees = 180.0 if tilt is None else tilt.value
    if not isinstance(degrees, int | float) or not 0 < degrees <= 180:
        raise InputError(f"{TILT}: {degrees!r} is no angle from above 0 to 180 degrees: set it again.")
    return GravitySettings(parameters, float(degrees))

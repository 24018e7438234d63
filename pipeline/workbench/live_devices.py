"""What can be chosen as a sensor and as a source of its orientation, and the addresses that this makes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from contactbench.pipeline.devices.driver import AddressError, Carrier
from contactbench.pipeline.devices.protocols.registry import drivers
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.session.why import CERTIFICATE, DUE, MOUNT, POSES, SENSOR, SERIAL
from contactbench.pipeline.settings import ReportSettings, mount_rotation

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.session import State


# Fields of `Devices`, by the settings of a session that they are.
_TEXTS = {"sensor": SENSOR, "poses": POSES, "serial": SERIAL, "certificate": CERTIFICATE, "due": DUE}


@dataclass(frozen=True)
class Devices:
    """The devices of a session, as its settings say."""

    sensor: str = ""  # Address; empty: none is chosen
    poses: str | None = None  # Address; None: nothing tells the orientation
    # (float, float, float); Angles of R_ES about the fixed axes x, y, z, degrees
    mount: tuple[float, float, float] = (0.0, 0.0, 0.0)
    serial: str = ""  # Serial number of the sensor; empty: nobody said
    certificate: str = ""  # Number of the sensor's calibration certificate; empty: nobody said
    due: str = ""  # Until when that is valid, ISO 8601; empty: nobody said

    @classmethod
    def of(cls, state: State) -> Devices:
        """Return what a session's settings say; what makes no sense counts as not set."""
        said = {name: state.setting(key) for name, key in _TEXTS.items()}
        texts = {name: text for name, text in said.items() if isinstance(text, str) and text}
        return cls(**texts, mount=_angles(state.setting(MOUNT)))

    @property
    def settings(self) -> dict[str, Any]:
        """The session's settings that say the same."""
        texts = {key: getattr(self, name) or None for name, key in _TEXTS.items()}
        return {**texts, SENSOR: self.sensor, MOUNT: list(self.mount) if any(self.mount) else None}

    @property
    def R_ES(self) -> NDArray[np.float64] | None:
        """How the sensor is mounted on the flange, (3, 3); None: as the flange."""
        return mount_rotation(self.mount) if any(self.mount) else None


def _angles(value: Any) -> tuple[float, float, float]:
    if isinstance(value, list | tuple) and len(value) == 3 and all(isinstance(x, int | float) for x in value):
        return float(value[0]), float(value[1]), float(value[2])
    return 0.0, 0.0, 0.0


def virtual_address(probe: str) -> str:
    """Return the address of a virtual bench with one of the bundled probes."""
    return f"virtual://bench?probe={quote(probe)}&sensor=paper"


def serial_sensors() -> dict[str, str]:
    """Return the title of each sensor that needs nothing but its serial port, by its scheme."""
    return {
        scheme: driver.title
        for scheme, driver in drivers().items()
        if any(way.carrier is Carrier.SERIAL for way in driver.ways)
        and not problem_of(serial_address(scheme, "/port"))
    }


def serial_address(scheme: str, path: str) -> str:
    """Return the address of a sensor at a serial port."""
    return f"{scheme}+serial://{path}"


def replay_address(file: Path) -> str:
    """Return the address of a recording that is played back at its own pace."""
    return f"replay://{quote(str(file.absolute()))}"


def poses_address(file: Path) -> str:
    """Return the address of a file of poses."""
    return f"poses://{quote(str(file.absolute()))}"


def still_address(roll: float, pitch: float, yaw: float) -> str:
    """Return the address of a flange that stands still, turned about the fixed axes x, y, z; degrees."""
    return f"still://?rpy={roll:g},{pitch:g},{yaw:g}"


def due_problem(due: str) -> str:
    """Say why a text is no date until which a certificate is valid; empty: it is one, or nobody said."""
    try:
        ReportSettings.checked({"due": due})
    except InputError:
        return message(
            f"The certificate's date {arg(due)!r} is not a date: write it as 2027-03-31, or leave it empty."
        )
    return ""


def problem_of(address: str, *, poses: bool = False) -> str:
    """Say why an address is none of a sensor, or of a source of poses; empty: it is one."""
    if not address.strip():
        what = message("of the robot, such as ur+tcp://192.168.0.10") if poses else message("of the sensor")
        return message(f"Give the address {arg(what)}.")
    try:
        parsed = DeviceAddress.parse(address.strip())
    except AddressError as error:
        return str(error)
    if not (parsed.gives_poses if poses else parsed.gives_wrenches):
        return (
            message(
                f"{arg(parsed.protocol)} gives no poses: give the address of a robot, such as ur+tcp://192.168.0.10."
            )
            if poses
            else message(
                f"{arg(parsed.protocol)} is not a force/torque sensor: give the address of a sensor, such"
                " as sri+tcp://192.168.0.108."
            )
        )
    return ""


def gives_poses(address: str) -> bool:
    """Whether a sensor's address also gives its orientation, as a virtual bench and most recordings do."""
    return not problem_of(address) and DeviceAddress.parse(address.strip()).gives_poses

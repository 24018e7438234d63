"""How good the devices are that are open: rate, gaps, noise and margin, measured from what came last."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.devices.driver import AddressError, Carrier
from contactbench.pipeline.devices.protocols.registry import drivers
from contactbench.pipeline.devices.stream import Health, StreamState
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.session import State
from contactbench.pipeline.session.why import CERTIFICATE, DUE, MOUNT, POSES, SENSOR, SERIAL
from contactbench.pipeline.settings import ReportSettings, mount_rotation
from contactbench.pipeline.workbench.live import Live

_LOOK_S = 5.0
_FEWEST = 50  # readings before a noise is told
_GAP = 2.5  # times the usual interval
_CLOSE = 0.8  # of the range
_GONE = {
    StreamState.SILENT: message(
        "The sensor has gone silent. Check its cable and power; it resumes automatically."
    ),
    StreamState.LOST: message("The sensor is disconnected: plug it in again. It resumes automatically."),
}
_NO_POSES = message(
    "No poses arrive, so the orientation is unknown: check the robot's address and cable. They"
    " resume automatically."
)


@dataclass(frozen=True, eq=False)
class ConnectionTrial:
    """What is measured of open devices."""

    state: StreamState  # Of the sensor
    rate: float | None  # Of the sensor, Hz
    pose_rate: float | None  # Hz; None: there are no poses, or not yet
    samples: int  # Since they were opened
    lost: int  # Samples that the sensor counted and that never came
    gaps: int  # Silences in the last five seconds
    longest_gap: float  # s; 0 without one
    # (6,); Noise floor: standard deviation of one reading, N and N·m, of what is quicker than a hand; NaN:
    # not yet known
    noise: NDArray[np.float64]
    largest: NDArray[np.float64]  # (6,); Largest reading of either sign, N and N·m
    # (6,); Share of the sensor's range that `largest` is; None: the range is not known
    range_used: NDArray[np.float64] | None
    sentences: tuple[str, ...]  # What is wrong, and what to do; empty when nothing is


def trial_of(live: Live) -> ConnectionTrial | None:
    """Measure the devices that are open; None: none is."""
    health, pair = live.health, live.pair
    if health is None or pair is None:
        return None
    sensor, poses = health
    times, raw, _ = live.history(_LOOK_S)
    gaps, longest = _gaps(times)
    noise, largest = np.full(6, np.nan), np.full(6, np.nan)
    if len(raw) >= _FEWEST:
        # Differences of neighbours: what a hand does in between is slow, and drops out.
        noise = np.diff(raw, axis=0).std(axis=0) / np.sqrt(2)
    if len(raw):
        largest = np.abs(raw).max(axis=0)
    bench = pair.bench
    limits = None if bench is None else bench.sensor.settings.limit
    used = None if limits is None else largest / limits
    return ConnectionTrial(
        sensor.state,
        sensor.rate,
        None if poses is None else poses.rate,
        sensor.samples,
        sensor.counters.lost,
        gaps,
        longest,
        noise,
        largest,
        used,
        tuple(dict.fromkeys((*_states(sensor, poses, pair.finished), *_measured(noise, used)))),
    )


def gone(live: Live) -> str:
    """Say that a device went away that was there, and what to do; empty: none did."""
    health, pair = live.health, live.pair
    if health is None or pair is None or pair.finished:
        return ""
    sensor, poses = health
    if sensor.state in _GONE:
        return _GONE[sensor.state]
    return _NO_POSES if poses is not None and poses.state in _GONE else ""


def _gaps(times: NDArray[np.float64]) -> tuple[int, float]:
    if len(times) < 3:
        return 0, 0.0
    steps = np.diff(times)
    long = steps[steps > max(_GAP * float(np.median(steps)), 0.02)]
    return len(long), float(long.max()) if len(long) else 0.0


def _states(sensor: Health, poses: Health | None, finished: bool) -> list[str]:
    said = []
    if finished:
        said.append(message("End of the recording: choose it again to replay it."))
    elif sensor.state is StreamState.CONNECTING:
        said.append(message("The sensor does not respond yet: check its power and cable."))
    elif sensor.state in _GONE:
        said.append(_GONE[sensor.state])
    said += [*sensor.findings, *sensor.suspicions]
    if poses is not None and not finished:
        if poses.state in {StreamState.CONNECTING, StreamState.SILENT, StreamState.LOST}:
            said.append(_NO_POSES)
        said += [*poses.findings, *poses.suspicions]
    return said


def _measured(noise: NDArray[np.float64], used: NDArray[np.float64] | None) -> list[str]:
    said = []
    if used is not None and np.nanmax(used, initial=0.0) >= _CLOSE:
        said.append(
            message(
                f"A channel is at {arg(100 * np.nanmax(used)):.0f} % of its range; it clips at 100 %."
                " Reduce the load, or re-zero the sensor."
            )
        )
    if np.isfinite(noise).all() and (noise == 0).all():
        said.append(
            message("All readings are exactly the same: the sensor may be frozen. Touch it to check.")
        )
    return said


# ---- what can be chosen as a sensor and as a source of its orientation ---------------------------


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


def network_devices(*, poses: bool = False) -> dict[str, str]:
    """Return title and port of each device that needs nothing but its host, by what its addresses begin with."""
    return {
        begin: message(f"{arg(driver.title)}, port {arg(way.port)}")
        for scheme, driver in drivers().items()
        for way in driver.ways
        if way.port is not None
        and not problem_of(f"{(begin := f'{scheme}+{way.carrier}://')}host", poses=poses)
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

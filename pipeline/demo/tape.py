"""Recordings of the virtual bench: a sensor and a robot, as a real bench leaves them."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter
from contactbench.pipeline.recording.messages import FLANGE_TOPIC, WRENCH_TOPIC
from contactbench.pipeline.simulation import Touches
from contactbench.pipeline.simulation.loads import LoadedSensor, draw_load
from contactbench.pipeline.simulation.scenes.physics import Payload, PhysicsScene, SceneMoment
from contactbench.pipeline.simulation.sensor_model import SensorModel, SensorReadings

SENSOR_MODEL = "virtual, paper-like"
OPERATOR = "contactbench demo"
RATE_HZ = 200
WARM_S = 3600.0  # since the sensor was switched on: as long as one should wait before a calibration

_MASS = (0.3, 0.8)  # kg
_BASE_TILT = np.radians(0.5)


@dataclass(frozen=True, eq=False)
class DemoTool(LoadedSensor):
    """A probe with its holder on a warm sensor, on a robot whose base B stands not quite upright."""

    # what the robot does not know: half a degree from the identity
    R_BW: Floats = field(kw_only=True)

    @cached_property
    def truth(self) -> GravityModel:
        """What a calibration should find: of the warm sensor, gravity in B."""
        warmer = float(SensorModel(self.settings).temperature(WARM_S)[0]) - self.settings.ambient
        bias = self.settings.bias + warmer * self.settings.drift
        return GravityModel(
            self.R_BW @ self.load.gravity_W,
            bias[:3],
            self.load.centre_of_mass_S,
            bias[3:],
            self.load.covariance,
        )

    @property
    def payload(self) -> Payload:
        """The load as physics wants it."""
        return Payload(self.load.mass, self.load.centre_of_mass_S)


def draw_tool(rng: np.random.Generator) -> DemoTool:
    """Draw a load and biases."""
    tilt = Rotation.from_rotvec(_BASE_TILT * np.array([0.6, -0.8, 0.0])).as_matrix()
    return DemoTool(draw_load(rng, _MASS), R_BW=tilt)


STEP_S = 1 / RATE_HZ
_STARTED_NS = 1_700_000_000 * 10**9  # any day, but always the same: the same seed gives the same bytes


@dataclass(eq=False)
class DemoTape:
    """What a perfect sensor and the robot would say, sample by sample."""

    times: list[float] = field(default_factory=list)  # s
    # list of (6,): Contact, weight and inertia, S
    readings: list[Floats] = field(default_factory=list)
    R_WS: list[Floats] = field(default_factory=list)  # list of (3, 3)

    @property
    def end(self) -> float:
        """Time of the last sample, s; 0 for an empty tape."""
        return self.times[-1] if self.times else 0.0

    def run(self, scene: PhysicsScene, seconds: float, start: float | None = None) -> None:
        """Let a scene go on, and record it at 200 Hz, from `start` (s) or after the last sample."""
        begin = self.end + STEP_S if start is None else start
        for number in range(round(seconds / STEP_S)):
            scene.advance(STEP_S)
            moment = scene.moment()
            self.times.append(begin + number * STEP_S)
            self.readings.append(moment.reading)
            self.R_WS.append(moment.R_WS)

    def rest(self, reading: Floats, R_WS: Floats, seconds: float) -> None:
        """Record that nothing happens: the same reading (6,) and orientation (3, 3), after the last sample."""
        for _ in range(round(seconds / STEP_S)):
            self.times.append(self.end + STEP_S if self.times else 0.0)
            self.readings.append(reading)
            self.R_WS.append(R_WS)

    def write(self, file: Path, tool: DemoTool, rng: np.random.Generator) -> None:
        """
        Write what the tool's sensor made of it, and the robot's poses in its base, as an MCAP file.

        Raises
        ------
        InputError
            The file cannot be written; a file that was there is left as it was.
        """
        times = np.array(self.times)
        read = SensorModel(tool.settings, rng).read(WARM_S + times, np.array(self.readings))
        write_tape(file, self.times, read, tool.R_BW @ np.array(self.R_WS))


def write_tape(file: Path, times: Sequence[float], read: SensorReadings, R_BS: Floats) -> None:
    """
    Write readings at times (n,), s, and the robot's poses (n, 3, 3), as an MCAP file.

    Raises
    ------
    InputError
        The file cannot be written; a file that was there is left as it was.
    """
    part = file.with_name(f"{file.name}.tmp")
    try:
        part.unlink(missing_ok=True)  # recordings are never written over
        with RecordingWriter(part, _about(), clock=lambda: 0.0) as writer:  # no chunks by the host's clock
            rows = zip(times, read.wrenches.tolist(), read.saturated, read.temperatures, strict=True)
            for number, (time, wrench, saturated, kelvin) in enumerate(rows):
                status = Status.OVERRANGE if saturated else Status.OK
                force, torque = (wrench[0], wrench[1], wrench[2]), (wrench[3], wrench[4], wrench[5])
                # The pose first: a runtime takes the newest that it has heard.
                writer.flange(FlangeSample(time, R_BS[number], np.full(3, np.nan)))
                writer.wrench(WrenchSample(time, force, torque, number, status, temperature=float(kelvin)))
        part.replace(file)
    except OSError as error:
        raise InputError(
            f"{file}: the file cannot be written ({error}): choose a folder that is writable and has space."
        ) from error
    finally:
        part.unlink(missing_ok=True)


def _about() -> RecordingInfo:
    devices = (
        DeviceInfo("wrench", WRENCH_TOPIC, "virtual://bench?sensor=paper", SENSOR_MODEL, rate=RATE_HZ),
        DeviceInfo("flange", FLANGE_TOPIC, "virtual://bench", "virtual bench", rate=RATE_HZ),
    )
    return RecordingInfo(_STARTED_NS, 0.0, devices, note="contactbench demo")


# ---- the demo's files: written as a whole or not at all, the same bytes for the same seed --------


_CHANNELS = ("fx", "fy", "fz", "mx", "my", "mz")


def write_csv(file: Path, columns: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table; numbers as ``repr`` gives them, so that reading them back loses nothing; None empty."""
    lines = [",".join(columns), *(",".join(map(_cell, row)) for row in rows)]
    write_file(file, ("\n".join(lines) + "\n").encode())


def write_recording(file: Path, readings: Floats, R_WS: Floats) -> None:
    """Write raw readings (n, 6), S, N and N·m, and orientations (n, 3, 3) as quaternions, at 200 Hz."""
    quaternions = Rotation.from_matrix(R_WS).as_quat(canonical=True, scalar_first=True)
    values = np.column_stack([readings, quaternions]).tolist()
    rows = ((t, *row) for t, row in zip(_times(len(readings)), values, strict=True))
    write_csv(file, ("t", *_CHANNELS, "qw", "qx", "qy", "qz"), rows)


def write_truth(file: Path, touches: Touches, where: Sequence[str]) -> None:
    """Write what was simulated: point (S, m), outward normal, local torque k (N·m), and the part touched."""
    values = np.column_stack([touches.points, touches.normals, touches.torques]).tolist()
    rows = ((t, *row, part) for t, row, part in zip(_times(len(touches)), values, where, strict=True))
    write_csv(file, ("t", "x", "y", "z", "nx", "ny", "nz", "k", "where"), rows)


def write_marked(
    file: Path, rows: Sequence[tuple[float, int, float]], moments: Sequence[SceneMoment]
) -> None:
    """
    Write the truth about touches of markers.

    Parameters
    ----------
    rows : sequence of (time, marker, tilt)
        s, from 1, degrees.
    """
    columns = ("t", "marker", "tilt", "x", "y", "z", "nx", "ny", "nz", *_CHANNELS, "k")
    cells = (
        (*row, *moment.point_S.tolist(), *moment.normal_S.tolist(), *moment.contact.tolist(), moment.torsion)
        for row, moment in zip(rows, moments, strict=True)
    )
    write_csv(file, columns, cells)


def write_wrenches(file: Path, times: Floats, wrenches: Floats) -> None:
    """Write wrenches (n, 6), S, N and N·m, with their times (n,), s."""
    write_csv(file, ("t", *_CHANNELS), np.column_stack([times, wrenches]).tolist())


def _times(count: int) -> list[float]:
    return [row / RATE_HZ for row in range(count)]


def _cell(value: object) -> str:
    return "" if value is None else repr(value) if isinstance(value, float) else str(value)

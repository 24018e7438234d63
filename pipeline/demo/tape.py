"""Recordings of the virtual bench: a sensor and a robot, as a real bench leaves them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.demo.tool import RATE_HZ, SENSOR_MODEL, WARM_S
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter
from contactbench.pipeline.recording.info import FLANGE_TOPIC, WRENCH_TOPIC
from contactbench.pipeline.simulation.sensor_model import SensorModel

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from contactbench.pipeline.demo.tool import DemoTool
    from contactbench.pipeline.simulation.scenes import PhysicsScene
    from contactbench.pipeline.simulation.sensor_model import SensorReadings

STEP_S = 1 / RATE_HZ
_STARTED_NS = 1_700_000_000 * 10**9  # any day, but always the same: the same seed gives the same bytes


@dataclass(eq=False)
class DemoTape:
    """What a perfect sensor and the robot would say, sample by sample."""

    times: list[float] = field(default_factory=list)  # s
    # list of (6,): Contact, weight and inertia, S
    readings: list[NDArray[np.float64]] = field(default_factory=list)
    R_WS: list[NDArray[np.float64]] = field(default_factory=list)  # list of (3, 3)

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

    def rest(self, reading: NDArray[np.float64], R_WS: NDArray[np.float64], seconds: float) -> None:
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


def write_tape(file: Path, times: Sequence[float], read: SensorReadings, R_BS: NDArray[np.float64]) -> None:
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

"""How good the devices are that are open: rate, gaps, noise and margin, measured from what came last."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.devices.stream import Health
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

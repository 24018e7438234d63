"""Streams for the runtime's tests: a probe that slides, lifts and turns, with gravity and noise."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline import kernel
    from contactbench.pipeline.config.runtime import RuntimeConfig


def stream(
    config: RuntimeConfig, count: int, *, rate: float = 1_000.0, seed: int = 3
) -> tuple[NDArray[Any], ...]:
    """Return raw readings (n, 6), R_WS (n, 3, 3) and times (n,): touches of a second or so, with lifts between."""
    rng = np.random.default_rng(seed)
    times = np.cumsum(rng.uniform(0.9, 1.1, count)) / rate
    turns = 0.3 * np.column_stack([np.sin(0.7 * times), np.cos(0.5 * times), np.sin(0.3 * times)])
    R = Rotation.from_rotvec(turns).as_matrix()
    probe = config.probe
    corners = probe.vertices[probe.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    low, high = probe.bounds
    phase = np.column_stack([np.sin(1.1 * times), np.sin(0.8 * times), np.ones(count)])
    wanted = 0.5 * (low + high) + 0.5 * (high - low) * phase
    facet = cKDTree(corners.mean(axis=1)).query(wanted)[1]
    force = -np.maximum(8.0 * np.sin(3.0 * times), 0.0)[:, None] * normals[facet]
    torque = np.cross(corners[facet].mean(axis=1), force)
    readings = np.concatenate([force, torque], axis=1) + config.gravity.predict(R)
    return readings + rng.normal(0, [0.05] * 3 + [0.002] * 3, (count, 6)), R, times


def with_faults(readings: NDArray[Any], R: NDArray[Any], times: NDArray[Any]) -> None:
    """Put in, in place, what a stream should not hold: NaN, repeated times, mirrors, saturation, gaps."""
    readings[11::97, 2] = np.nan
    times[13::101] = times[12::101][: len(times[13::101])]
    R[17::103] = np.diag([1.0, 1.0, -1.0])
    R[19::107, 0, 0] = np.inf
    readings[23::109, 1] = 500.0
    times[len(times) // 2 :] += 1.0


def with_surprises(config: RuntimeConfig, readings: NDArray[Any], seed: int = 4) -> None:
    """Put in, in place, what is not one touch: now a second one for a while, now a torque that no touch explains."""
    rng = np.random.default_rng(seed)
    probe = config.probe
    for begin in range(300, len(readings) - 200, 400):
        rows = slice(begin, begin + 150)
        facet = int(rng.integers(len(probe.faces)))
        force = -6.0 * probe.normals[facet]
        torque = np.cross(probe.vertices[probe.faces[facet]].mean(axis=0), force)
        readings[rows] += [*force, *torque] if begin % 800 < 400 else [0, 0, 0, *rng.normal(0, 0.3, 3)]


COLUMNS = (
    "reasons",
    "faces",
    "vertices",
    "regions",
    "candidates",
    "times",
    "points",
    "normals",
    "torques",
    "wrenches",
    "covariances",
    "filtered_points",
    "accepted",
    "misfits",
    "left_overs",
    "arms",
    "confidences",
    "runners_up",
    "seconds",
)


def columns(batch: kernel.RuntimeBatch) -> dict[str, NDArray[Any]]:
    """Return every column of a batch."""
    return {name: getattr(batch, name) for name in COLUMNS}

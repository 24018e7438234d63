"""The demo's files: written as a whole or not at all, the same bytes for the same seed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.demo.tool import RATE_HZ
from contactbench.pipeline.durable import write_file

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from contactbench.pipeline.simulation import Touches
    from contactbench.pipeline.simulation.scenes import SceneMoment


_CHANNELS = ("fx", "fy", "fz", "mx", "my", "mz")


def write_csv(file: Path, columns: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table; numbers as ``repr`` gives them, so that reading them back loses nothing; None empty."""
    lines = [",".join(columns), *(",".join(map(_cell, row)) for row in rows)]
    write_file(file, ("\n".join(lines) + "\n").encode())


def write_recording(file: Path, readings: NDArray[np.float64], R_WS: NDArray[np.float64]) -> None:
    """Write raw readings (n, 6), S, N and N·m, and orientations (n, 3, 3) as quaternions, at 200 Hz."""
    quaternions = Rotation.from_matrix(R_WS).as_quat(canonical=True)[:, [3, 0, 1, 2]]
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


def write_wrenches(file: Path, times: NDArray[np.float64], wrenches: NDArray[np.float64]) -> None:
    """Write wrenches (n, 6), S, N and N·m, with their times (n,), s."""
    write_csv(file, ("t", *_CHANNELS), np.column_stack([times, wrenches]).tolist())


def _times(count: int) -> list[float]:
    return [row / RATE_HZ for row in range(count)]


def _cell(value: object) -> str:
    return "" if value is None else repr(value) if isinstance(value, float) else str(value)

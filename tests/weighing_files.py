"""Files of poses and recordings with a known truth, written as users write them."""

import csv
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel, PoseNoise
from contactbench.pipeline.calibration.suggest import by_hand, plan_poses
from contactbench.pipeline.simulation.loads import Weighing, draw_load, weigh

TRUTH = GravityModel(
    np.array([0.0, 0.0, -6.1]),
    np.array([3.0, -2.0, 8.0]),
    np.array([0.004, -0.002, 0.062]),
    np.array([0.2, -0.1, 0.05]),
)
LOAD = GravityModel([0.1, -0.2, -6.0], [5.0, -3.0, 2.0], [0.01, 0.0, 0.06], [0.1, 0.2, 0.3])
NOISE = PoseNoise(0.05, 0.002)
Range = tuple[float, float]


def draw_noise(
    rng: np.random.Generator, force: Range = (0.02, 0.2), torque: Range = (0.0005, 0.01)
) -> PoseNoise:
    """Draw the standard deviations of a pose's mean, N and N·m, uniform."""
    return PoseNoise(rng.uniform(*force), rng.uniform(*torque))


def draw_weighing(
    rng: np.random.Generator,
    *,
    poses: tuple[int, int] = (4, 12),
    mass: Range = (0.1, 2.0),
    force_noise: Range = (0.02, 0.2),
    torque_noise: Range = (0.0005, 0.01),
) -> Weighing:
    """Draw a load, its noise, and orientations spread over all rotations."""
    count = int(rng.integers(poses[0], poses[1] + 1))
    R_WS = Rotation.random(count, rng).as_matrix()
    return weigh(draw_load(rng, mass), R_WS, draw_noise(rng, force_noise, torque_noise), rng)


@cache
def planned(count: int) -> Any:
    """Orientations that are well chosen: a search of seconds, done once."""
    return plan_poses(count, by_hand()).R_WS


def weighed(count: int = 9, seed: int = 4) -> Weighing:
    """A 0.62 kg tool in well chosen poses."""
    return weigh(TRUTH, planned(count), NOISE, np.random.default_rng(seed))


def spun(count: int = 6, seed: int = 4) -> Weighing:
    """The same, but every pose has the same tilt."""
    turns = Rotation.from_euler("z", np.arange(count, dtype=float)[:, None])
    tilted = Rotation.from_euler("x", 0.7)
    return weigh(TRUTH, (turns * tilted).as_matrix(), NOISE, np.random.default_rng(seed))


def write_euler(file: Path, weighing: Weighing, order: str = "xyz", *, transposed: bool = False) -> Path:
    """Write poses with rx,ry,rz in degrees; `transposed`: of R_SW, as some exporters do."""
    R = np.array([pose.R_WS for pose in weighing.poses])
    angles = Rotation.from_matrix(R.transpose(0, 2, 1) if transposed else R).as_euler(order, degrees=True)
    return _write(file, weighing, ("rx", "ry", "rz"), angles)


def write_quaternions(file: Path, weighing: Weighing) -> Path:
    """Write poses with qw,qx,qy,qz."""
    R = np.array([pose.R_WS for pose in weighing.poses])
    return _write(
        file, weighing, ("qw", "qx", "qy", "qz"), np.roll(Rotation.from_matrix(R).as_quat(), 1, axis=1)
    )


def _write(file: Path, weighing: Weighing, columns: tuple[str, ...], values: Any) -> Path:
    with file.open("w", encoding="utf-8", newline="") as stream:
        rows = csv.writer(stream)
        rows.writerow(["t", "fx", "fy", "fz", "mx", "my", "mz", *columns])
        for number, (pose, cells) in enumerate(zip(weighing.poses, values, strict=True)):
            rows.writerow([10.0 * number, *pose.force, *pose.torque, *cells])
    return file


def columns(file: Path) -> dict[str, list[str]]:
    """Read a table by its columns."""
    with file.open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    return {name: [row[name] for row in rows] for name in rows[0]}

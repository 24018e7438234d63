"""Weighing the tool: on the virtual bench, which leaves a recording, or by formula where there is no physics."""

from __future__ import annotations

from functools import cache
from math import ceil, pi
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import PoseNoise
from contactbench.pipeline.calibration.files.capture_file import capture_poses
from contactbench.pipeline.calibration.files.pose_csv import write_poses
from contactbench.pipeline.calibration.reachable import by_hand
from contactbench.pipeline.calibration.suggest import plan_poses
from contactbench.pipeline.demo.tape import STEP_S, Tape
from contactbench.pipeline.simulation.scenes import BenchScene
from contactbench.pipeline.simulation.weighing import bump, weigh

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from contactbench.pipeline.demo.tool import Tool
    from contactbench.pipeline.simulation.scenes import Truth

POSES = 9
_HOLD_S = 2.5
_TURN_RAD_S = pi / 2
_STEP_S = 0.0025  # nothing is touched: what turns the wrist needs no finer step
_PUSH_N = (4.0, 12.0)
_LEVER_M = (0.08, 0.16)
_POSE_NOISE = PoseNoise(0.02, 0.0008)  # what a second of averaging leaves: drift and hum, not white noise


def weigh_on_bench(folder: Path, tool: Tool, truth: Truth, rng: np.random.Generator) -> tuple[str, ...]:
    """
    Turn the wrist to planned poses while somebody leans on one of them: gravity.mcap, and poses.csv out of it.

    Parameters
    ----------
    folder : Path
    tool : Tool
    truth : Truth
        The probe.
    rng : numpy.random.Generator

    Returns
    -------
    tuple of str
        Names of the poses that somebody leaned on.

    Raises
    ------
    InputError
        MuJoCo is missing, or a file cannot be written.
    """
    # What the robot is told is in its own base.
    planned = tool.R_BW.T @ _planned()
    tape, pushed = Tape(), int(rng.integers(POSES))
    spans: list[tuple[float, float]] = []
    scene = BenchScene(truth, payload=tool.payload, R_WS=planned[0], step=_STEP_S)
    for number, R_WS in enumerate(planned):
        begin = tape.end
        seconds = scene.turn_to(R_WS, _turning_time(planned[max(number - 1, 0)], R_WS))
        if number == pushed:
            # A steady push is worse than a knock: the sensor stands as still as in the other poses.
            force = rng.uniform(*_PUSH_N) * Rotation.random(None, rng).as_matrix()[0]
            scene.bump(force, seconds + _HOLD_S, [0.0, 0.0, rng.uniform(*_LEVER_M)])
        tape.run(scene, seconds + _HOLD_S)
        spans.append((begin, tape.end))
    tape.write(folder / "gravity.mcap", tool, rng)
    # From here on only the files count: what works here works for files from elsewhere.
    found = capture_poses(folder / "gravity.mcap")
    write_poses(folder / "poses.csv", found.poses)
    starts = [capture.start for capture in found.captures]
    begin, end = spans[pushed]
    return tuple(
        pose.name or "" for pose, start in zip(found.poses, starts, strict=True) if begin < start <= end
    )


def weigh_by_formula(folder: Path, tool: Tool, rng: np.random.Generator) -> tuple[str, ...]:
    """
    Write poses.csv as a calm bench would give it, with noise and one pose bumped.

    Returns
    -------
    tuple of str
        Names of the poses that were bumped.
    """
    weighing = bump(weigh(tool.truth, _planned(), _POSE_NOISE, rng), 1 / POSES, rng)
    write_poses(folder / "poses.csv", weighing.poses)
    return tuple(f"pose {index + 1}" for index in np.flatnonzero(weighing.bumped))


@cache
def _planned() -> NDArray[np.float64]:
    return plan_poses(POSES, by_hand()).R_WS


def _turning_time(before: NDArray[np.float64], after: NDArray[np.float64]) -> float:
    """Return how long a turn takes, s; in whole samples, so that the tape and the scene stay together."""
    angle = float(Rotation.from_matrix(before.T @ after).magnitude())
    return max(0.5, STEP_S * ceil(angle / _TURN_RAD_S / STEP_S))

"""Weighing the tool, on the virtual bench or by formula where there is no physics, and the calibration out of it."""

from dataclasses import dataclass
from functools import cache
from math import ceil, pi
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import Calibration, GravityModel, Level, PoseNoise, calibrate
from contactbench.pipeline.calibration.files.calibration_file import SourceFile, save_calibration
from contactbench.pipeline.calibration.files.capture_file import capture_poses
from contactbench.pipeline.calibration.files.pose_csv import read_poses, write_poses
from contactbench.pipeline.calibration.report.page import write_report
from contactbench.pipeline.calibration.suggest import by_hand, plan_poses
from contactbench.pipeline.demo.tape import OPERATOR, SENSOR_MODEL, STEP_S, DemoTape, DemoTool
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.page.details import ReportDetails
from contactbench.pipeline.simulation.loads import bump, weigh
from contactbench.pipeline.simulation.scenes.indenter import BenchScene
from contactbench.pipeline.simulation.scenes.physics import TrueSurface

_POSES = 9  # to weigh a tool in
_HOLD_S = 2.5
_TURN_RAD_S = pi / 2
_STEP_S = 0.0025  # nothing is touched: what turns the wrist needs no finer step
_PUSH_N = (4.0, 12.0)
_LEVER_M = (0.08, 0.16)
_POSE_NOISE = PoseNoise(0.02, 0.0008)  # what a second of averaging leaves: drift and hum, not white noise


@cache
def planned_poses() -> Floats:
    """Return the orientations (n, 3, 3) that a tool is weighed in, in the robot's base."""
    return plan_poses(_POSES, by_hand()).R_WS


def weigh_on_bench(
    folder: Path, tool: DemoTool, truth: TrueSurface, rng: np.random.Generator
) -> tuple[str, ...]:
    """
    Turn the wrist to planned poses while somebody leans on one of them: gravity.mcap, and poses.csv out of it.

    Parameters
    ----------
    truth : TrueSurface
        The probe.

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
    planned = tool.R_BW.T @ planned_poses()
    tape, pushed = DemoTape(), int(rng.integers(_POSES))
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


def weigh_by_formula(folder: Path, tool: DemoTool, rng: np.random.Generator) -> tuple[str, ...]:
    """
    Write poses.csv as a calm bench would give it, with noise and one pose bumped.

    Returns
    -------
    tuple of str
        Names of the poses that were bumped.
    """
    weighing = bump(weigh(tool.truth, planned_poses(), _POSE_NOISE, rng), 1 / _POSES, rng)
    write_poses(folder / "poses.csv", weighing.poses)
    return tuple(f"pose {index + 1}" for index in np.flatnonzero(weighing.bumped))


def _turning_time(before: Floats, after: Floats) -> float:
    """Return how long a turn takes, s; in whole samples, so that the tape and the scene stay together."""
    angle = float(Rotation.from_matrix(before.T @ after).magnitude())
    return max(0.5, STEP_S * ceil(angle / _TURN_RAD_S / STEP_S))


# ---- the calibration --------------------------------------------------------------------------------


@dataclass(frozen=True)
class GravityResult:
    """How the calibration did."""

    poses: int  # found in the recording
    # mass, mass_sigma, true_mass: kg
    mass: float
    mass_sigma: float
    true_mass: float
    contact_error_mm: float  # the calibration's share of the contact error, worst 1 sigma
    verdict: str
    # bumped, named: poses that were bumped, and that the calibration named
    bumped: tuple[str, ...]
    named: tuple[str, ...]
    # squared distance of the parameters from the truth, over what 95 % of calibrations stay within
    far: float

    @property
    def verified(self) -> bool:
        """Whether the bumped poses were named and the truth is where the calibration says, or nearly."""
        return self.verdict != Level.REFUSE and self.bumped == self.named and self.far < _TOO_FAR

    def sentence(self, probe: str) -> str:
        """Say it in words."""
        named = ", ".join(self.named) or "none"
        found = (
            f"{probe}: weighed in {self.poses} poses (bumped: {', '.join(self.bumped)}; named: {named}):"
            f" {self.mass:.4f} ± {self.mass_sigma:.4f} kg (true {self.true_mass:.4f}). The calibration is"
            f" {self.verdict}: it adds up to {self.contact_error_mm:.2f} mm (1 sigma) to a contact point"
        )
        return f"{found}." if self.verified else f"{found}. FAILED: the error exceeds its stated uncertainty."


_TOO_FAR = 2.0  # times the 95 % limit: once in 100,000


def calibrate_folder(
    folder: Path, truth: GravityModel, bumped: tuple[str, ...]
) -> tuple[Calibration, GravityResult]:
    """
    Write calibration.json and calibration.html: what calibrating makes of poses.csv.

    Parameters
    ----------
    bumped : tuple of str
        Names of the poses that were bumped.
    """
    poses = read_poses(folder / "poses.csv").poses
    calibration = calibrate(poses)
    source = SourceFile.of(folder / "poses.csv")
    save_calibration(calibration, folder / "calibration.json", source=source)
    details = ReportDetails(OPERATOR, SENSOR_MODEL)
    write_report(calibration, folder / "calibration.html", source=source, details=details)
    off = calibration.model.vector - truth.vector
    far = float(off @ np.linalg.solve(calibration.covariance, off))
    result = GravityResult(
        len(poses),
        calibration.mass,
        calibration.model.mass_sigma,
        truth.mass,
        1e3 * calibration.contact_error,
        calibration.verdict.level.value,
        bumped,
        tuple(rejection.name for rejection in calibration.rejected),
        far / calibration.ellipsoid(0.95),
    )
    return calibration, result

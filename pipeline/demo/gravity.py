"""The demo's first step: calibrate gravity from poses, one of them bumped, and compensate a recording."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from pipeline.calibration import Calibration, GravityModel, Level, PoseNoise, calibrate
from pipeline.calibration.files.calibration_file import Source, save_calibration
from pipeline.calibration.files.compensate_file import compensate_file
from pipeline.calibration.files.pose_csv import read_poses, write_poses
from pipeline.calibration.reachable import by_hand
from pipeline.calibration.report.page import write_report
from pipeline.calibration.suggest import plan_poses
from pipeline.demo.files import write_recording
from pipeline.simulation.weighing import bump, draw_load, weigh

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from pipeline.contact import WrenchNoise

POSES = 9
_POSE_NOISE = PoseNoise(0.02, 0.0008)  # what a second of averaging leaves: drift and hum, not white noise
_BASE_TILT = np.radians(0.5)
_USE_TILT = np.radians(45.0)
_MASS = (0.3, 0.8)  # kg


@dataclass(frozen=True)
class GravityResult:
    """How the calibration did.

    Attributes
    ----------
    mass, mass_sigma, true_mass : float
        kg.
    contact_error_mm : float
        The calibration's share of the contact error, worst 1 sigma.
    verdict : str
    bumped, named : tuple of str
        Poses that were bumped, and that the calibration named.
    far : float
        Squared distance of the parameters from the truth, over what 95 % of calibrations stay within.
    """

    mass: float
    mass_sigma: float
    true_mass: float
    contact_error_mm: float
    verdict: str
    bumped: tuple[str, ...]
    named: tuple[str, ...]
    far: float

    @property
    def verified(self) -> bool:
        """Whether the bumped poses were named and the truth is where the calibration says, or nearly."""
        return self.verdict != Level.REFUSE and self.bumped == self.named and self.far < _TOO_FAR

    def sentence(self, probe: str) -> str:
        """Say it in words."""
        named = ", ".join(self.named) or "none"
        found = (
            f"{probe}: weighed in {POSES} poses (bumped: {', '.join(self.bumped)}; named: {named}):"
            f" {self.mass:.4f} ± {self.mass_sigma:.4f} kg (true {self.true_mass:.4f}). The calibration is"
            f" {self.verdict}: it adds up to {self.contact_error_mm:.2f} mm (1 sigma) to a contact point"
        )
        return f"{found}." if self.verified else f"{found}. FAILED: it is not what its uncertainty says."


_TOO_FAR = 2.0  # times the 95 % limit: once in 100,000


def weigh_and_compensate(
    folder: Path, contact: NDArray[np.float64], sensor: WrenchNoise, rng: np.random.Generator
) -> tuple[GravityResult, NDArray[np.float64]]:
    """Write poses.csv and recording.csv, and what calibrating and compensating make of them.

    Parameters
    ----------
    folder : Path
        Gets poses.csv, calibration.json, calibration.html, recording.csv and wrenches.csv too.
    contact : (n, 6)
        True wrenches of the touches, S, N and N·m.
    sensor : WrenchNoise
        Of a single reading.
    rng : numpy.random.Generator
        Source of chance.

    Returns
    -------
    GravityResult
    (6, 6) ndarray
        What the calibration leaves uncertain in the compensated wrenches, on average over the touches.
    """
    load = draw_load(rng, _MASS)
    tilt = Rotation.from_rotvec(_BASE_TILT * np.array([0.6, -0.8, 0.0])).as_matrix()
    truth = GravityModel(
        tilt @ load.gravity_W, load.force_bias, load.centre_of_mass_S, load.torque_bias, load.covariance
    )
    weighing = bump(weigh(truth, plan_poses(POSES, by_hand()).R_WS, _POSE_NOISE, rng), 1 / POSES, rng)
    write_poses(folder / "poses.csv", weighing.poses)
    # From here on only the files count: what works here works for files from elsewhere.
    calibration = calibrate(read_poses(folder / "poses.csv").poses)
    source = Source.of(folder / "poses.csv")
    save_calibration(calibration, folder / "calibration.json", source=source)
    write_report(calibration, folder / "calibration.html", source=source)
    R_WS = _orientations(len(contact), rng)
    noise = rng.multivariate_normal(np.zeros(6), sensor.covariance, len(contact), method="cholesky")
    write_recording(folder / "recording.csv", contact + truth.predict(R_WS) + noise, R_WS)
    compensate_file(calibration, folder / "recording.csv", folder / "wrenches.csv")
    bumped = tuple(f"pose {index + 1}" for index in np.flatnonzero(weighing.bumped))
    left = calibration.model.wrench_covariance(R_WS).mean(axis=0)
    return _result(calibration, truth, bumped), left


def _result(calibration: Calibration, truth: GravityModel, bumped: tuple[str, ...]) -> GravityResult:
    off = calibration.model.vector - truth.vector
    far = float(off @ np.linalg.solve(calibration.covariance, off))
    return GravityResult(
        calibration.mass,
        calibration.model.mass_sigma,
        truth.mass,
        1e3 * calibration.contact_error,
        calibration.verdict.level.value,
        bumped,
        tuple(rejection.name for rejection in calibration.rejected),
        far / calibration.ellipsoid(0.95),
    )


def _orientations(count: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """Draw R_WS (n, 3, 3) of a probe in use: pointing down, or tilted from that by up to 45 degrees."""
    bearing, tilt = rng.uniform(0, 2 * np.pi, count), _USE_TILT * np.sqrt(rng.random(count))
    axes = np.column_stack([np.cos(bearing), np.sin(bearing), np.zeros(count)])
    spin = Rotation.from_rotvec(np.outer(rng.uniform(0, 2 * np.pi, count), [0.0, 0.0, 1.0]))
    down = Rotation.from_rotvec([np.pi, 0.0, 0.0])
    return (Rotation.from_rotvec(tilt[:, None] * axes) * down * spin).as_matrix()

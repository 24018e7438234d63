"""The demo's first step: calibrate gravity from poses, one of which somebody leaned on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration import Calibration, GravityModel, Level, calibrate
from contactbench.pipeline.calibration.files.calibration_file import SourceFile, save_calibration
from contactbench.pipeline.calibration.files.pose_csv import read_poses
from contactbench.pipeline.calibration.report.page import write_report

if TYPE_CHECKING:
    from pathlib import Path


@dataclass(frozen=True)
class GravityResult:
    """How the calibration did.

    Attributes
    ----------
    poses : int
        Found in the recording.
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

    poses: int
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
            f"{probe}: weighed in {self.poses} poses (bumped: {', '.join(self.bumped)}; named: {named}):"
            f" {self.mass:.4f} ± {self.mass_sigma:.4f} kg (true {self.true_mass:.4f}). The calibration is"
            f" {self.verdict}: it adds up to {self.contact_error_mm:.2f} mm (1 sigma) to a contact point"
        )
        return f"{found}." if self.verified else f"{found}. FAILED: it is not what its uncertainty says."


_TOO_FAR = 2.0  # times the 95 % limit: once in 100,000


def calibrate_folder(
    folder: Path, truth: GravityModel, bumped: tuple[str, ...]
) -> tuple[Calibration, GravityResult]:
    """
    Write calibration.json and calibration.html: what calibrating makes of poses.csv.

    Parameters
    ----------
    folder : Path
    truth : GravityModel
    bumped : tuple of str
        Names of the poses that were bumped.
    """
    poses = read_poses(folder / "poses.csv").poses
    calibration = calibrate(poses)
    source = SourceFile.of(folder / "poses.csv")
    save_calibration(calibration, folder / "calibration.json", source=source)
    write_report(calibration, folder / "calibration.html", source=source)
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

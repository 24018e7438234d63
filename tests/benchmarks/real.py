"""Strangers' recordings: what the product says of them, beside least squares of its own, and held-out halves."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration import PoseSample, calibrate
from contactbench.pipeline.calibration.diagnosis.diagnose import diagnose
from contactbench.pipeline.calibration.files.capture_file import capture_poses
from contactbench.pipeline.calibration.files.pose_csv import is_recorded_table, read_poses
from contactbench.pipeline.calibration.model import predict, prediction_jacobian
from contactbench.pipeline.calibration.poses import stack
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport

RECORDINGS = Path(__file__).parents[2].parent / "shared" / "data" / "recordings"
_MENDED = ("wrench_in_base", "force_in_base")  # readings that are put right before anything is compared
_GRAVITY = 9.80665  # m/s²
_NOTES = (
    (
        "- Made by `packaging/run benchmark real --write docs/validation/real.md`. The recordings are not part of the"
        " project: KUKA LBR Med 14 with an ATI Gamma, A. Skrede (2024), Zenodo 10.5281/zenodo.11096791, CC BY 4.0; ATI"
        " Axia80 with a gripper, github.com/leledeyuan00/Gravity-Compensation-F-T-sensor, whose wrench is logged along"
        " the base's axes and whose zero drifts, as the author says."
    ),
    (
        "- Least squares is NumPy's alone, with a linear drift where a drift is told. Held-out halves:"
        " each half of the poses is predicted by a calibration of the other; the residuals are counted in the standard"
        " deviations that this calibration tells, so 1 is right, and more is too sure."
    ),
)


def read(file: Path) -> tuple[Sequence[PoseSample], str]:
    """Return the poses of a table or a recording, and what of them was put right: what the diagnosis is sure of."""
    poses = capture_poses(file).poses if is_recorded_table(file) else read_poses(file).poses
    found = diagnose(poses)
    if found.best.hypothesis not in _MENDED or found.none_known:
        return poses, "-"
    return found.corrected(found.best.hypothesis), found.best.title


def least_squares(
    poses: Sequence[PoseSample], *, drifts: bool
) -> tuple[float, NDArray[np.float64], float, float]:
    """Return mass (kg), centre of mass (m) and rms residuals (N, N·m), by NumPy alone; a drift is linear."""
    R = np.array([pose.R_WS.T for pose in poses])
    F, M = np.array([pose.force for pose in poses]), np.array([pose.torque for pose in poses])
    bias = np.tile(np.eye(3), (len(R), 1, 1))
    if drifts:
        bias = np.concatenate([bias, bias * np.linspace(0, 1, len(R))[:, None, None]], axis=2)
    A = np.concatenate([R, bias], axis=2).reshape(F.size, -1)
    x = np.linalg.lstsq(A, F.ravel(), rcond=None)[0]
    w = R @ x[:3]
    cross = np.array([[[0, c, -b], [-c, 0, a], [b, -a, 0]] for a, b, c in w])
    B = np.concatenate([cross, bias], axis=2).reshape(F.size, -1)
    y = np.linalg.lstsq(B, M.ravel(), rcond=None)[0]
    left = [
        float(np.sqrt(((b - A_ @ x_) ** 2).sum() / len(R)))
        for b, A_, x_ in ((F.ravel(), A, x), (M.ravel(), B, y))
    ]
    return float(np.linalg.norm(x[:3])) / _GRAVITY, y[:3], left[0], left[1]


def held_out(poses: Sequence[PoseSample]) -> tuple[float, float]:
    """Return the seen over the told error of forces and torques: each half is predicted by the other."""
    ratios = []
    for first in (0, 1):
        fitted = calibrate(poses[first::2])
        theta, rest = fitted.model.vector, stack(poses[1 - first :: 2])
        J = prediction_jacobian(rest.R_SW, theta)
        V = fitted.noise.covariances(rest.R_SW, theta) + J @ fitted.covariance @ J.swapaxes(1, 2)
        r = rest.wrenches - predict(rest.R_SW, theta)
        numbers = np.arange(len(poses))
        r -= np.stack(
            [np.interp(numbers[1 - first :: 2], numbers[first::2], each) for each in fitted.offsets.T], axis=1
        )
        ratios.append(
            [
                (np.linalg.solve(V[:, h, h], r[:, h, None])[..., 0] * r[:, h]).sum() / r[:, h].size
                for h in (slice(0, 3), slice(3, 6))
            ]
        )
    force, torque = np.sqrt(np.mean(ratios, axis=0))
    return float(force), float(torque)


def run(*, folder: Path = RECORDINGS) -> StudyReport:
    """Judge every recording of a folder."""
    files = sorted(folder.glob("*.csv"))
    if not files:
        raise InputError(f"{folder}: there are no recordings here: give their folder.")
    figures, rows, notes = [], [], [*_NOTES]
    for file in files:
        try:
            poses, mended = read(file)
        except (InputError, AttributeError) as error:
            notes.append(f"- {file.stem}: not read ({error}).")
            continue
        calibration = calibrate(poses)
        cause = calibration.causes[0]
        mass, L, force, torque = least_squares(
            poses, drifts=calibration.drift_rate is not None or cause.key == "drift"
        )
        rows.append(
            (
                file.stem,
                len(poses),
                mended,
                str(calibration.verdict.level),
                f"{cause.key} {100 * cause.odds:.0f} %",
                calibration.mass,
                mass,
                1e3 * float(np.linalg.norm(calibration.centre_of_mass_S)),
                1e3 * float(np.linalg.norm(L)),
                force,
                1e3 * torque,
            )
        )
        notes.append(f"- {file.stem}: {cause.sentence}")
        figures.append(
            Figure(
                file.stem, "mass over that of least squares", calibration.mass / mass, least=0.98, most=1.02
            )
        )
        if len(poses) >= 12:
            for half, ratio in zip(("force", "torque"), held_out(poses), strict=True):
                figures.append(
                    Figure(
                        file.stem,
                        f"seen over told error, held-out halves, {half}",
                        ratio,
                        least=0.8,
                        most=1.25,
                    )
                )
    columns = (
        "recording", "poses", "put right", "verdict", "first cause", "mass, kg", "least squares, kg",
        "centre of mass, mm", "least squares, mm", "its residuals, N", "mN·m",
    )  # fmt: skip
    sheet = Sheet("recordings", "What the product says, beside least squares", columns, tuple(rows))
    return StudyReport("Real recordings", {}, tuple(figures), tuple(notes), (sheet,))

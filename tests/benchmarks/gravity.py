"""Is gravity calibration as good as it says? Efficiency, coverage, bumped poses, blind sets, plans, speed."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.blind_sets import BLIND_SETS, try_blind

from contactbench.pipeline.calibration import Calibration, calibrate
from contactbench.pipeline.calibration.fit import parameter_covariance
from contactbench.pipeline.calibration.model import CENTRE_OF_MASS, cross_matrix, prediction_jacobian
from contactbench.pipeline.calibration.poses import stack
from contactbench.pipeline.calibration.reachable import by_robot
from contactbench.pipeline.calibration.suggest import plan_error, plan_poses
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.robot import Robot
from contactbench.pipeline.simulation.weighing import Weighing, bump, draw_weighing
from contactbench.pipeline.timing import time_calls

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray
    from rich.table import Table


@dataclass(frozen=True)
class Figure:
    """One measured figure and what it must reach."""

    question: str
    target: str
    measured: str
    passed: bool


@dataclass(frozen=True)
class GravityReport:
    """All figures of a run."""

    trials: int
    seed: int
    figures: tuple[Figure, ...]

    @property
    def passed(self) -> bool:
        """Whether every figure reached its target."""
        return all(figure.passed for figure in self.figures)

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        return {"passed": self.passed, **asdict(self)}

    def table(self) -> Table:
        """Build the table for the terminal."""
        from rich.table import Table

        built = Table(title=f"Gravity calibration, {self.trials:,} trials, seed {self.seed}")
        for heading in ("question", "target", "measured"):
            built.add_column(heading)
        for figure in self.figures:
            built.add_row(
                figure.question, figure.target, figure.measured, style="" if figure.passed else "red"
            )
        return built

    def markdown(self) -> str:
        """Write the table as Markdown."""
        lines = ["| question | target | measured | |", "|---|---|---|---|"]
        lines += [
            f"| {figure.question} | {figure.target} | {figure.measured} | {'ok' if figure.passed else 'MISSED'} |"
            for figure in self.figures
        ]
        return "\n".join(lines) + "\n"


def run(
    *, trials: int = 2000, seed: int = 0, progress: Callable[[str], None] = lambda _: None
) -> GravityReport:
    """Measure every figure."""
    if trials < 20 or seed < 0:
        raise InputError(f"{trials} trials, seed {seed}: give at least 20 trials and a seed of at least 0")
    figures: list[Figure] = []
    for say, part in (
        ("errors against the bound", efficiency),
        ("bumped poses", bumped_poses),
        ("a light load", light_load),
        ("sets of poses that do not show everything", blind_sets),
        ("plans", plans),
        ("time", speed),
    ):
        progress(say)
        figures += part(trials, seed)
    return GravityReport(trials, seed, tuple(figures))


# ---- efficiency and coverage -------------------------------------------------------------------


def efficiency(trials: int, seed: int) -> list[Figure]:
    """Compare errors with the Cramer-Rao bound, and the truth with the stated ellipsoids."""
    rng = np.random.default_rng([seed, 1])
    scaled, known, estimated = [], [], []
    for _ in range(trials):
        weighing = draw_weighing(rng)
        calibration = calibrate(weighing.poses, weighing.noise)
        scaled.append(_error(calibration, weighing) / np.sqrt(np.diag(_bound(weighing))))
        known.append(_covers(calibration, weighing))
        estimated.append(_covers(calibrate(weighing.poses), weighing))
    ratios = np.sqrt(np.mean(np.square(scaled), axis=0))
    share, share_estimated = float(np.mean(known)), float(np.mean(estimated))
    chance = 1 / np.sqrt(2 * trials)
    return [
        Figure(
            "RMSE over the Cramér-Rao bound, worst of the twelve parameters",
            "at most 1.05",
            f"{ratios.max():.3f} (mean {ratios.mean():.3f}; chance alone ± {chance:.3f})",
            bool(ratios.max() <= 1.05),
        ),
        Figure(
            "95 % ellipsoid holds the truth, noise known",
            "93-97 %",
            f"{100 * share:.1f} %",
            0.93 <= share <= 0.97,
        ),
        Figure(
            "95 % ellipsoid holds the truth, noise estimated from the poses",
            "93-97 %",
            f"{100 * share_estimated:.1f} %",
            0.93 <= share_estimated <= 0.97,
        ),
    ]


def _error(calibration: Calibration, weighing: Weighing) -> NDArray[np.float64]:
    return calibration.model.vector - weighing.truth.vector


def _bound(weighing: Weighing, kept: NDArray[np.bool_] | None = None) -> NDArray[np.float64]:
    """Return the Cramér-Rao bound (12, 12) of the poses, or of those `kept`."""
    R_SW = stack(weighing.poses).R_SW
    J = prediction_jacobian(R_SW if kept is None else R_SW[kept], weighing.truth.vector)
    return parameter_covariance(J / weighing.noise.sigmas[:, None])


def _covers(calibration: Calibration, weighing: Weighing) -> bool:
    error = _error(calibration, weighing)
    return bool(error @ np.linalg.solve(calibration.covariance, error) < calibration.ellipsoid(0.95))


# ---- bumped poses ------------------------------------------------------------------------------


def bumped_poses(trials: int, seed: int) -> list[Figure]:
    """Bump a fifth of 8 to 12 poses: all must be named, and the others must not suffer."""
    figures = []
    for known in (True, False):
        rng = np.random.default_rng([seed, 2])
        missed = false_sets = false_poses = clean = 0
        scaled = []
        for _ in range(trials):
            weighing = bump(draw_weighing(rng, poses=(8, 12)), 0.2, rng)
            calibration = calibrate(weighing.poses, weighing.noise if known else None)
            named = ~calibration.kept
            missed += bool((weighing.bumped & ~named).any())
            false_sets += bool((named & ~weighing.bumped).any())
            false_poses += int((named & ~weighing.bumped).sum())
            clean += int((~weighing.bumped).sum())
            bound = _bound(weighing, ~weighing.bumped)
            scaled.append(_error(calibration, weighing) / np.sqrt(np.diag(bound)))
        ratio = float(np.sqrt(np.mean(np.square(scaled), axis=0)).max())
        noise = "noise known" if known else "noise estimated"
        figures += [
            Figure(
                f"sets in which every bumped pose is named, {noise}",
                "100 %",
                f"{100 * (1 - missed / trials):.2f} %",
                missed == 0,
            ),
            Figure(
                f"sets with a false alarm, {noise}",
                "under 2 %",
                f"{100 * false_sets / trials:.2f} % (of clean poses {100 * false_poses / clean:.2f} %)",
                false_sets < 0.02 * trials,
            ),
            Figure(
                f"RMSE over the bound of the clean poses, worst parameter, {noise}",
                "at most 1.2",
                f"{ratio:.3f}",
                ratio <= 1.2,
            ),
        ]
    return figures


# ---- light load --------------------------------------------------------------------------------


def light_load(trials: int, seed: int) -> list[Figure]:
    """Weigh 0.1 kg with 0.2 N of noise: the centre of mass must not be pulled towards the sensor."""
    rng = np.random.default_rng([seed, 3])
    ours, papers = [], []
    for _ in range(trials):
        weighing = draw_weighing(
            rng, poses=(8, 12), mass=(0.1, 0.1), force_noise=(0.2, 0.2), torque_noise=(0.002, 0.002)
        )
        true = weighing.truth.centre_of_mass_S
        # Along the true centre of mass, in units of the bound in that direction.
        along = true / np.linalg.norm(true)
        sigma = float(np.sqrt(along @ _bound(weighing)[CENTRE_OF_MASS, CENTRE_OF_MASS] @ along))
        found = calibrate(weighing.poses, weighing.noise).centre_of_mass_S
        ours.append(float(along @ (found - true)) / sigma)
        papers.append(float(along @ (_paper(weighing) - true)) / sigma)
    bias, paper_bias = float(np.mean(ours)), float(np.mean(papers))
    spread = float(np.std(ours) / np.sqrt(trials))
    return [
        Figure(
            "light load (0.1 kg, 0.2 N): bias of the centre of mass along itself",
            "under 0.1 sigma",
            f"{bias:+.3f} ± {spread:.3f} sigma; with the paper's regressor {paper_bias:+.2f} sigma",
            abs(bias) < 0.1,
        )
    ]


def measured_regressor(R_SW: NDArray[np.float64], F: NDArray[np.float64], M: NDArray[np.float64]) -> Any:
    """Return the parameters (12,) by two plain least squares, the second on the *measured* force (Eq. 2)."""
    n = len(R_SW)
    identity = np.broadcast_to(np.eye(3), (n, 3, 3))
    forces = np.concatenate([R_SW, identity], axis=2).reshape(-1, 6)
    first = np.linalg.lstsq(forces, F.ravel(), rcond=None)[0]
    torques = np.concatenate([-cross_matrix(F - first[3:]), identity], axis=2).reshape(-1, 6)
    return np.concatenate([first, np.linalg.lstsq(torques, M.ravel(), rcond=None)[0]])


def _paper(weighing: Weighing) -> NDArray[np.float64]:
    """Return the centre of mass by the paper's second stage, whose regressor is the *measured* force (Eq. 2)."""
    arrays = stack(weighing.poses)
    found = measured_regressor(arrays.R_SW, arrays.F, arrays.M)
    return np.asarray(found[CENTRE_OF_MASS], dtype=np.float64)


# ---- sets that do not show everything ----------------------------------------------------------


def blind_sets(trials: int, seed: int) -> list[Figure]:
    """Give sets of poses that leave something open: each must be refused or flagged, in the right words."""
    rng = np.random.default_rng([seed, 4])
    tried = [try_blind(kind, max(trials // 5, 10), rng) for kind in BLIND_SETS]
    return [
        Figure(
            f"{kind.name}: refused or flagged in the right words",
            "always",
            f"{kind.tries - kind.silent} of {kind.tries}; truth beyond 5 stated sigma in {kind.wrong}",
            kind.silent == 0 and kind.wrong <= 0.005 * kind.tries,
        )
        for kind in tried
    ]


# ---- plans -------------------------------------------------------------------------------------

_ARM = np.array([0.0, -0.3, 1.2, 0.0, 0.9, 0.0])  # an Elfin3 that holds its tool over a table
_FACES = np.array([[0, 0, 0], [2, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]]) * np.pi / 2
_RANDOM_PLANS = 1000


def plans(trials: int, seed: int) -> list[Figure]:
    """Compare six planned poses with random ones and with the faces of a cube, within joint limits."""
    from scipy.spatial.transform import Rotation

    del trials
    rng = np.random.default_rng([seed, 5])
    faces = plan_error(Rotation.from_rotvec(_FACES).as_matrix())
    figures = []
    for wrist_only in (True, False):
        reachable = by_robot(Robot.named("elfin3"), _ARM, wrist_only=wrist_only)
        drawn = [rng.choice(len(reachable), 6, replace=False) for _ in range(_RANDOM_PLANS)]
        usual = float(np.median([plan_error(reachable.R_WS[chosen]) for chosen in drawn]))
        planned = plan_poses(6, reachable).error
        figures.append(
            Figure(
                f"six planned poses, Elfin3, {'wrist only' if wrist_only else 'all joints'}: contact error over"
                " the median of 1,000 random plans",
                "at most 0.85, and below six faces",
                f"{planned / usual:.3f} ({1e3 * planned:.3f} mm; six faces {1e3 * faces:.3f} mm)",
                planned <= 0.85 * usual and planned < faces,
            )
        )
    return figures


# ---- time --------------------------------------------------------------------------------------


def speed(trials: int, seed: int) -> list[Figure]:
    """Time a calibration of 12 poses beside one bare least-squares solve of the same 72 x 12 system."""
    del trials
    rng = np.random.default_rng([seed, 6])
    weighing = draw_weighing(rng, poses=(12, 12))
    bumped = bump(weighing, 0.2, rng)
    arrays = stack(weighing.poses)
    rows = prediction_jacobian(arrays.R_SW, weighing.truth.vector).reshape(-1, 12)
    wrenches = arrays.wrenches.ravel()
    nothing = [None] * 50
    times = time_calls(
        {
            "lstsq": (lambda _: np.linalg.lstsq(rows, wrenches, rcond=None), nothing),
            "clean": (lambda _: calibrate(weighing.poses, weighing.noise), nothing),
            "bumped": (lambda _: calibrate(bumped.poses, weighing.noise), nothing),
            "unknown": (lambda _: calibrate(weighing.poses), nothing),
        },
        rounds=10,
        block=20,
    )
    base = times["lstsq"].median
    clean, two, unknown = (times[name].median / base for name in ("clean", "bumped", "unknown"))
    return [
        Figure(
            "time of a calibration of 12 poses over one numpy.linalg.lstsq of that size",
            "under 20",
            f"{clean:.1f} ({times['clean'].median / 1e3:.0f} µs); with two bumped poses {two:.0f};"
            f" noise estimated {unknown:.0f}",
            clean < 20,
        )
    ]

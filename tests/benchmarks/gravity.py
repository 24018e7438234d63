"""Is gravity calibration as good as it says? Efficiency, coverage, bumped poses, blind sets, plans, speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.real_bench import RealBench
from scipy.spatial.transform import Rotation
from weighing_files import draw_noise, draw_weighing

from contactbench.pipeline.calibration import (
    Calibration,
    ContactTask,
    GravityModel,
    Level,
    PoseNoise,
    calibrate,
)
from contactbench.pipeline.calibration.model import (
    CENTRE_OF_MASS,
    cross_matrix,
    parameter_covariance,
    prediction_jacobian,
)
from contactbench.pipeline.calibration.poses import stack
from contactbench.pipeline.calibration.suggest import (
    USUAL_LOAD,
    USUAL_NOISE,
    by_hand,
    by_robot,
    plan_poses,
    suggest_pose,
    usual_task,
    worst_sigma,
)
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.reality import MIXES
from contactbench.pipeline.robot import Robot
from contactbench.pipeline.simulation.loads import LoadedSensor, Weighing, bump, draw_load, weigh
from contactbench.pipeline.study.report import Figure, StudyReport
from contactbench.pipeline.timing import time_calls

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Draw = Callable[[np.random.Generator, int], NDArray[np.float64]]


def plan_error(
    R_WS: NDArray[np.float64], *, noise: PoseNoise = USUAL_NOISE, task: ContactTask | None = None
) -> float:
    """Predict the share of the calibration in the contact error after poses R_WS (n, 3, 3), m."""
    J = prediction_jacobian(R_WS.swapaxes(1, 2), USUAL_LOAD.vector) / noise.sigmas[:, None]
    A = (task or usual_task()).parameter_sensitivity(USUAL_LOAD.vector)
    return worst_sigma(A, parameter_covariance(J))


def run(
    *, trials: int = 2000, seed: int = 0, progress: Callable[[str], None] = lambda _: None
) -> StudyReport:
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
        ("forecasts of one more pose", forecasts),
        ("time", speed),
    ):
        progress(say)
        figures += part(trials, seed)
    return StudyReport("Gravity calibration", {"trials": trials, "seed": seed}, tuple(figures))


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
    held = "95 % ellipsoid holds the truth"
    return [
        Figure(
            "errors",
            "RMSE over the Cramér-Rao bound, worst of the twelve parameters",
            ratios.max(),
            most=1.05,
        ),
        Figure("errors", "RMSE over the Cramér-Rao bound, mean", ratios.mean()),
        Figure.share("noise known", held, sum(known), trials, least=93, most=97),
        Figure.share("noise estimated from the poses", held, sum(estimated), trials, least=93, most=97),
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
            Figure.share(
                noise, "sets in which every bumped pose is named", trials - missed, trials, least=100
            ),
            Figure.share(noise, "sets with a false alarm", false_sets, trials, most=2),
            Figure.share(noise, "clean poses called bumped", false_poses, clean),
            Figure(noise, "RMSE over the bound of the clean poses, worst parameter", ratio, most=1.2),
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
    along = "bias of the centre of mass along itself, of sigma"
    return [
        Figure("0.1 kg, 0.2 N of noise", along, float(np.mean(ours)), least=-0.1, most=0.1),
        Figure("0.1 kg, 0.2 N of noise", f"{along}, with the paper's regressor", float(np.mean(papers))),
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
    figures = []
    for kind in tried:
        said = kind.tries - kind.silent
        figures += [
            Figure.share(kind.name, "refused or flagged in the right words", said, kind.tries, least=100),
            Figure.share(kind.name, "truth beyond 5 stated sigma", kind.wrong, kind.tries, most=0.5),
        ]
    return figures


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
        subject = f"six planned poses, Elfin3, {'wrist only' if wrist_only else 'all joints'}"
        figures += [
            Figure(subject, "error over the median of 1,000 random plans", planned / usual, most=0.85),
            Figure(subject, "error over that of six faces of a cube", planned / faces, most=1.0),
        ]
    return figures


def forecasts(trials: int, seed: int) -> list[Figure]:
    """Follow the suggestions on benches, and compare what each promises with what the pose then brings."""
    figures = []
    for name in ("ideal", "typical"):
        ratios, low = [], []
        for number in range(min(20, trials // 20)):
            load = draw_load(np.random.default_rng([seed, 6, number]), (0.3, 0.8))
            bench = RealBench("convex", MIXES[name], seed + number, LoadedSensor(load))
            reach = by_hand(300)
            poses = bench.weigh(plan_poses(3, reach).R_WS).poses()
            while len(poses) < 9:
                told = suggest_pose(calibrate(poses), reach)
                poses += bench.weigh(told.R_WS[None]).poses()
                ratios.append(calibrate(poses).contact_error / told.error_after)
            low.append(sum(-pose.R_WS[2, 2] > np.cos(np.radians(38)) for pose in poses[:6]))
        subject = f"one more pose, {name} bench"
        within = float(np.mean([0.5 <= ratio <= 2 for ratio in ratios]))
        figures += [
            Figure(subject, "forecasts of the error right within a factor of two", within, least=0.9),
            Figure(subject, "of the first six poses within 38° of down, most", float(max(low)), most=3),
        ]
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
    name = "time of a calibration of 12 poses over one numpy.linalg.lstsq of that size"
    limits = {"clean": 20.0, "bumped": None, "unknown": None}
    return [Figure(each, name, times[each].median / base, most=most) for each, most in limits.items()]


@dataclass(frozen=True)
class BlindSet:
    """A way to choose poses badly."""

    name: str
    draw: Draw  # (rng, n) -> R_WS (n, 3, 3)
    words: tuple[str, ...]  # What the verdict must say: one of these
    levels: tuple[Level, ...] = (Level.REFUSE,)  # What the verdict may be
    mass: tuple[float, float] = (0.1, 2.0)  # Of the load, kg


def _spun(rng: np.random.Generator, n: int) -> NDArray[np.float64]:
    spins = Rotation.from_rotvec(np.outer(rng.uniform(0, 2 * np.pi, n), [0.0, 0.0, 1.0]))
    return (spins * Rotation.random(None, rng)).as_matrix()


def _one_axis(rng: np.random.Generator, n: int) -> NDArray[np.float64]:
    bearing = rng.uniform(0, 2 * np.pi)
    axis = np.array([np.cos(bearing), np.sin(bearing), 0.0])
    return (
        Rotation.from_rotvec(np.outer(np.linspace(0, 2.5, n), axis)) * Rotation.random(None, rng)
    ).as_matrix()


def _nearby(rng: np.random.Generator, n: int) -> NDArray[np.float64]:
    axes = rng.standard_normal((n, 3))
    axes *= np.radians(rng.uniform(0, 2.5, n) / np.linalg.norm(axes, axis=1))[:, None]
    return (Rotation.from_rotvec(axes) * Rotation.random(None, rng)).as_matrix()


def _two_repeated(rng: np.random.Generator, n: int) -> NDArray[np.float64]:
    del n
    return np.tile(Rotation.random(2, rng).as_matrix(), (10, 1, 1))


def _same(rng: np.random.Generator, n: int) -> NDArray[np.float64]:
    return np.tile(Rotation.random(None, rng).as_matrix(), (n, 1, 1))


def _anywhere(rng: np.random.Generator, n: int) -> NDArray[np.float64]:
    return Rotation.random(n, rng).as_matrix()


BLIND_SETS = (
    BlindSet("spins about the vertical", _spun, ("same tilt",)),
    BlindSet("one tilt axis", _one_axis, ("one horizontal axis",)),
    BlindSet("all within 5 degrees", _nearby, ("of one another",), (Level.REFUSE, Level.USABLE)),
    BlindSet("two poses ten times", _two_repeated, ("only two directions", "of one another")),
    BlindSet("one pose many times", _same, ("same orientation",)),
    BlindSet("no load", _anywhere, ("feels no weight",), (Level.REFUSE, Level.USABLE), (0.0, 0.0)),
)

_FAR_SIGMAS = 5.0  # sigmas: once in a million


@dataclass(frozen=True)
class Blindness:
    """How one kind of set was dealt with."""

    name: str
    # Sets tried; of those, called better than they are or in other words; and with a parameter further from
    # the truth than its stated uncertainty allows
    tries: int
    # Sets tried; of those, called better than they are or in other words; and with a parameter further from
    # the truth than its stated uncertainty allows
    silent: int
    # Sets tried; of those, called better than they are or in other words; and with a parameter further from
    # the truth than its stated uncertainty allows
    wrong: int


def try_blind(kind: BlindSet, tries: int, rng: np.random.Generator) -> Blindness:
    """Calibrate from `tries` sets of one kind, of 6 to 12 poses."""
    silent = wrong = 0
    for _ in range(tries):
        truth = draw_load(rng, kind.mass)
        poses = weigh(truth, kind.draw(rng, int(rng.integers(6, 13))), noise := draw_noise(rng), rng).poses
        calibration = calibrate(poses, noise)
        silent += not _says(calibration, kind)
        wrong += not _honest(calibration, truth)
    return Blindness(kind.name, tries, silent, wrong)


def _says(calibration: Calibration, kind: BlindSet) -> bool:
    verdict = calibration.verdict
    said = any(words in reason for words in kind.words for reason in verdict.reasons)
    return said and verdict.level in kind.levels


def _honest(calibration: Calibration, truth: GravityModel) -> bool:
    off = np.abs(calibration.model.vector - truth.vector) / np.sqrt(np.diag(calibration.covariance))
    return bool(off.max() < _FAR_SIGMAS)

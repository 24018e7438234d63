"""Sets of poses that do not show everything: each must be refused or flagged, in the right words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import Calibration, GravityModel, Level, calibrate
from contactbench.pipeline.simulation.weighing import draw_load, draw_noise, weigh

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Draw = Callable[[np.random.Generator, int], NDArray[np.float64]]


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


def _close(rng: np.random.Generator, n: int) -> NDArray[np.float64]:
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
    BlindSet("all within 5 degrees", _close, ("of one another",), (Level.REFUSE, Level.USABLE)),
    BlindSet("two poses ten times", _two_repeated, ("only two directions", "of one another")),
    BlindSet("one pose many times", _same, ("same orientation",)),
    BlindSet("no load", _anywhere, ("feels no weight",), (Level.REFUSE, Level.USABLE), (0.0, 0.0)),
)

_FAR = 5.0  # sigmas: once in a million


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
    return bool(off.max() < _FAR)

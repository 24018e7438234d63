"""Does a calibration notice when its own model is wrong? Drift, re-zero, cables, mounts and wrong noise.

Each cell draws sessions with one thing wrong (`benchmarks.wrong_models`), calibrates them,
and compares what
the calibration says with the truth at the session's end.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial, reduce
from typing import TYPE_CHECKING, Any
from zlib import crc32

import numpy as np
from benchmarks import wrong_models as wrong
from benchmarks.trials import in_processes

from contactbench.pipeline.calibration import Level, calibrate
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Sequence

    from benchmarks.wrong_models import Session
    from numpy.typing import NDArray

    from contactbench.pipeline.calibration import Calibration

_BLOCK = 10  # sets that one worker takes at a time
# A good verdict lies if a contact is off by this many claimed sigmas, or by this much, m.
_DECEIVED, _FAR = 3.0, 0.0015
_SURE = 0.75  # odds of 3 to 1
_NONE = "none"  # of the known causes explains the residuals: a right answer to a fault that none of them is
_STEP = 1e-9  # N, N·m: less is no step


@dataclass(frozen=True, eq=False)
class Trial:
    """What one session came to."""

    cause: str  # The most probable cause, and its probability
    odds: float  # The most probable cause, and its probability
    adopted: str  # What was added beside the model: a drift, a rezero, or nothing
    steps: tuple[int, ...]  # Poses, from 0, before which a re-zero is told
    rezeroed: tuple[int, ...]  # Poses before which the zero did jump
    level: str  # Of the verdict
    covered: bool  # The ellipsoid of 95 % holds the truth
    scaled: NDArray[np.float64]  # Errors over the sigmas of the Cramér-Rao bound
    wrongly_bumped: bool  # A clean pose was left out; a bumped one was not
    missed: bool  # A clean pose was left out; a bumped one was not
    error: float  # Largest shift of a contact, and what is claimed for it, m
    claimed: float  # Largest shift of a contact, and what is claimed for it, m
    seconds: float

    @property
    def deceives(self) -> bool:
        """Whether the verdict is good and the contact is not."""
        return self.level == Level.GOOD and (self.error > _FAR or self.error > _DECEIVED * self.claimed)

    @property
    def alarmed(self) -> bool:
        """Whether something was added to the model, or a cause named at odds over 3:1."""
        return bool(self.adopted) or (self.cause not in {"", "plain"} and self.odds > _SURE)


@dataclass(frozen=True)
class Cell:
    """One way to draw sessions, and what must come of them."""

    name: str
    draw: Callable[[np.random.Generator], Session]  # Draws a session from a random generator
    noise: float | None = None  # The noise is given, as so many times the true one; left out: it is not given
    # The orientations' noise is given, degrees; left out: it is not given
    orientation_deg: float | None = None
    # Keys of the causes that are right to tell; without any, the plain model must be
    told: tuple[str, ...] = ()
    # tuple of (measure, comparison, percent or ratio). What must be reached.
    bounds: tuple[tuple[str, str, float], ...] = ()
    timed: bool = True  # The poses have times

    def tried(self, seed: int, numbers: range) -> list[Trial]:
        """Draw and calibrate the sessions of these numbers."""
        made = []
        for number in numbers:
            rng = np.random.default_rng([seed, crc32(self.name.encode()), number])
            session = self.draw(rng)
            begun = time.perf_counter()
            made.append(judged(session, self.calibrated(session), time.perf_counter() - begun))
        return made

    def calibrated(self, session: Session) -> Calibration:
        """Calibrate a session with what this cell tells of it."""
        return calibrate(
            session.poses(timed=self.timed),
            None if self.noise is None else session.noise(self.noise),
            orientation_sigma=None
            if self.orientation_deg is None
            else float(np.radians(self.orientation_deg)),
        )


def judged(session: Session, calibration: Calibration, seconds: float) -> Trial:
    """Compare what a calibration says with the truth."""
    e = calibration.model.vector - session.truth
    distance = float(e @ np.linalg.solve(calibration.covariance, e))
    named, bumped = ~calibration.kept, session.bumped
    offsets = calibration.offsets
    moved = np.flatnonzero((np.abs(np.diff(offsets, axis=0)) > _STEP).any(axis=1)) + 1
    adopted = "" if not moved.size else "drift" if calibration.drift_rate is not None else "rezero"
    first = calibration.causes[0]
    return Trial(
        cause=first.key,
        odds=first.odds,
        adopted=adopted,
        steps=tuple(moved.tolist()) if adopted == "rezero" else (),
        rezeroed=tuple(sorted(session.rezeroed)),
        level=str(calibration.verdict.level),
        covered=distance < calibration.ellipsoid(0.95),
        scaled=e / np.sqrt(np.diag(session.bound())),
        wrongly_bumped=bool((named & ~bumped).any()),
        missed=bool((bumped & ~named).any()),
        error=session.contact_error(calibration.model.vector),
        claimed=calibration.contact_error,
        seconds=seconds,
    )


# ---- measures ----------------------------------------------------------------------------------


Measure = Callable[["Cell", "Sequence[Trial]", str], Figure]


def _share(pick: Callable[[Cell, Trial], bool]) -> Measure:
    return lambda cell, trials, question: Figure.share(
        cell.name, question, sum(pick(cell, trial) for trial in trials), len(trials)
    )


def _over_bound(cell: Cell, trials: Sequence[Trial], question: str) -> Figure:
    ratios = np.sqrt(np.mean([trial.scaled**2 for trial in trials], axis=0))
    return Figure(cell.name, question, float(ratios.mean()), worst=float(ratios.max()))


def _off(cell: Cell, trials: Sequence[Trial], question: str) -> Figure:
    errors = 1e3 * np.array([trial.error for trial in trials])
    return Figure(cell.name, question, float(np.percentile(errors, 95)), "mm", worst=float(errors.max()))


MEASURES = {
    "told": ("the cause is told first", _share(lambda cell, trial: trial.cause in cell.told)),
    "pose": ("told before the right pose", _share(lambda _, trial: trial.steps == trial.rezeroed)),
    "alarmed": ("a cause told or adopted", _share(lambda _, trial: trial.alarmed)),
    "wrong": (
        "a wrong cause told above 3:1",
        _share(lambda cell, trial: trial.alarmed and trial.cause not in {*cell.told, _NONE}),
    ),
    "covered": ("95 % ellipsoid holds the truth at the end", _share(lambda _, trial: trial.covered)),
    "bumped": ("a clean pose called bumped", _share(lambda _, trial: trial.wrongly_bumped)),
    "missed": ("a bumped pose not named", _share(lambda _, trial: trial.missed)),
    "bound": ("RMSE over the Cramér-Rao bound, mean of twelve parameters", _over_bound),
    "deceived": (
        "verdict good and a contact off by 3 claimed sigmas or 1.5 mm",
        _share(lambda _, trial: trial.deceives),
    ),
    "refused": ("refused", _share(lambda _, trial: trial.level == Level.REFUSE)),
    "error": ("largest shift of a contact, 95th percentile", _off),
}


_ALSO = {"alarmed", "covered", "bumped", "deceived", "refused", "error"}


def figures_of(cell: Cell, trials: Sequence[Trial]) -> list[Figure]:
    """Measure what the cell is bound to, then everything that is told without a bound."""
    figures = []
    for measure, comparison, limit in cell.bounds:
        question, of = MEASURES[measure]
        bound = {"least" if comparison == ">=" else "most": limit}
        figures.append(replace(of(cell, trials, question), **bound))
    return figures + [
        of(cell, trials, question)
        for measure, (question, of) in MEASURES.items()
        if (measure in _ALSO or (measure == "told" and cell.told))
        and measure not in {bound for bound, _, _ in cell.bounds}
    ]


# ---- cells -------------------------------------------------------------------------------------


def _with(*faults: Callable[..., Session], **how: Any) -> Callable[[np.random.Generator], Session]:
    """Return what draws a session with `wrong_models.draw(rng, **how)` and puts the faults in."""

    def drawn(rng: np.random.Generator) -> Session:
        return reduce(lambda session, fault: fault(session, rng), faults, wrong.draw(rng, **how))

    return drawn


_TEN: dict[str, Any] = {"poses": (10, 10)}
_ROBOT: dict[str, Any] = {"orientation_deg": 0.05}
_FEW: dict[str, Any] = {"poses": (6, 8), **_ROBOT}
_CLEAN = (
    ("alarmed", "<=", 2.0),
    ("covered", ">=", 92.0),
    ("bumped", "<=", 3.0),
    ("bound", "<=", 1.05),
    ("deceived", "<=", 3.0),
)
_DRIFT = (("told", ">=", 95.0), ("covered", ">=", 92.0), ("deceived", "<=", 3.0))
_REZERO = (("told", ">=", 95.0), ("pose", ">=", 90.0), ("covered", ">=", 92.0), ("deceived", "<=", 3.0))
_TURNED = (("covered", ">=", 92.0), ("covered", "<=", 97.0), ("bumped", "<=", 3.0), ("deceived", "<=", 3.0))
_MISJUDGED = (("told", ">=", 95.0), ("covered", ">=", 90.0), ("bumped", "<=", 3.0), ("deceived", "<=", 3.0))
_WRONG, _RARELY = ("wrong", "<=", 5.0), ("wrong", "<=", 2.0)
_ODD = (("deceived", "<=", 3.0), _WRONG)


def _cells() -> tuple[Cell, ...]:
    cells = []
    for words, noise in (("noise given", 1.0), ("noise estimated", None)):
        add = partial(Cell, noise=noise)
        cells += [
            add(f"clean, exact orientations, {words}", _with(), bounds=_CLEAN),
            add(f"clean, robot's orientations, {words}", _with(**_ROBOT), bounds=_CLEAN),
            add(
                f"drift 0.3 N, 10 mN·m, 10 poses, {words}",
                _with(wrong.drift, **_TEN, **_ROBOT),
                told=("drift",),
                bounds=_DRIFT,
            ),
            add(
                f"drift that is a warm-up, 10 poses, {words}",
                _with(partial(wrong.drift, warm_up=0.3), **_TEN, **_ROBOT),
                told=("drift",),
                bounds=_ODD,
            ),
            add(
                f"re-zero 0.3 N, 10 mN·m, {words}",
                _with(wrong.rezero, **_ROBOT),
                told=("rezero",),
                bounds=_REZERO,
            ),
        ]
        cells += [
            add(
                f"orientations off by 0.2 deg, {told} given, {words}",
                _with(orientation_deg=0.2),
                orientation_deg=deg,
                bounds=_TURNED,
            )
            for told, deg in (("0.2 deg", 0.2), ("nothing", None))
        ]
        cells += [
            add(f"{name}, {words}", _with(fault, **_ROBOT), told=told, bounds=_ODD)
            for name, told, fault in (
                ("cable like a spring 0.5 N", ("cable", "noise"), wrong.spring),
                ("cable that pulls aside 0.5 N", ("cable",), wrong.side_pull),
                ("cable with friction 0.3 N", ("cable", "noise", "filter"), wrong.hysteresis),
                ("mount turned by 1 deg", ("mount",), partial(wrong.turned_mount, deg=1.0)),
                ("mount turned by 5 deg", ("mount",), wrong.turned_mount),
            )
        ]
        cells += [
            add(
                # A gain acts on the touches too: no pose shows that, a known weight does.
                f"gain of a channel 2 % off, {words}",
                _with(wrong.scale, **_ROBOT),
                told=("channel", "crosstalk"),
                bounds=(_WRONG,),
            ),
            add(
                f"one pose bumped, {words}",
                _with(wrong.bump, **_ROBOT),
                told=("plain",),
                bounds=(("missed", "<=", 3.0), ("bumped", "<=", 3.0), ("deceived", "<=", 3.0)),
            ),
        ]
        # Few poses leave much room: a gain must not be made of noise, nor missed.
        cells += [
            add(f"6 to 8 poses, {name}, {words}", _with(*faults, **_FEW), told=told, bounds=(_RARELY,))
            for name, told, faults in (
                ("nothing wrong", (), ()),
                ("noise that wanders", ("drift", "noise"), (wrong.wander,)),
                ("a gain 5 % off", ("channel", "crosstalk", "noise"), (partial(wrong.scale, by=1.05),)),
            )
        ]
    cells += [
        Cell(f"noise given times {factor:g}", _with(**_ROBOT), factor, told=("noise",), bounds=_MISJUDGED)
        for factor in (0.5, 2.0)
    ]
    return tuple(cells)


CELLS = _cells()


# ---- the run -----------------------------------------------------------------------------------


def run(
    *,
    sets: int = 300,
    cells: str = "",
    workers: int | None = None,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Measure every cell."""
    if sets < 20 or seed < 0:
        raise InputError(f"{sets} sets, seed {seed}: give at least 20 sets and a seed of at least 0")
    chosen = [cell for cell in CELLS if cells in cell.name]
    if not chosen:
        raise InputError(
            f"--cells: no cell has {cells!r} in its name; there are: {'; '.join(c.name for c in CELLS)}"
        )
    jobs = [
        (CELLS.index(cell), seed, range(start, min(start + _BLOCK, sets)))
        for cell in chosen
        for start in range(0, sets, _BLOCK)
    ]
    trials: dict[str, list[Trial]] = {cell.name: [] for cell in chosen}
    for done, (name, made) in enumerate(in_processes(_block, jobs, workers), 1):
        trials[name] += made
        if len(trials[name]) == sets:
            progress(f"{done} of {len(jobs)} blocks: {name}")
    figures = tuple(figure for cell in chosen for figure in figures_of(cell, trials[cell.name]))
    return StudyReport("Calibration doubt", {"sets": sets, "seed": seed}, figures)


def _block(job: tuple[int, int, range]) -> tuple[str, list[Trial]]:
    index, seed, numbers = job
    cell = CELLS[index]
    return cell.name, cell.tried(seed, numbers)

"""Why does no touch of the probe explain most wrenches of a file? The usual mistakes, each tried on some rows."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from itertools import permutations, product
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.kernel import Batch, Reason, SurfaceIndex

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy.typing as npt

    from contactbench.pipeline.contact.stream import Locator
    from contactbench.pipeline.mesh import Probe

UNEXPLAINED = (Reason.IMPLAUSIBLE, Reason.TANGENTIAL, Reason.OFF_SURFACE)
NOT_LOCATED = (Reason.LOW_FORCE, Reason.SATURATED, Reason.STALE, Reason.NOT_FINITE)

ROWS = 200  # a share of them is known to 4 per cent; ten thousand solves at most take a second
_FEWEST_ROWS = 10  # rows that a mistake has to explain: fewer could be chance
_MOST_BY_CHANCE = 0.75  # of the rows: a turn of the mount by chance reaches two thirds
_SAME_N, _SAME_NM = 0.3, 0.015  # wrenches nearer than this are of a sensor at rest
_RESTING = 0.05  # share of such rows that makes a rest
_CLOSE = 0.05  # shares nearer than this cannot be told apart by so few rows
_FAR = 3.0  # reaches of the probe: no touch has an arm this long
_VERTICES = 4000  # of a large mesh, enough for its distance to a line
_HEAVY_N = 1.0  # a sensor at rest, compensated, shows far less


@dataclass(frozen=True)
class MistakeTrial:
    """One mistake, undone."""

    name: str  # ``torques_in_Nmm``, ``reversed``, ``turned`` or ``not_compensated``
    cause: str  # A clause that says what would be wrong
    remedy: str  # A sentence
    # How many wrenches were tried, and how many a touch of the probe then explains
    rows: int
    plausible: int

    @property
    def share(self) -> float:
        """Of the rows, how many a touch explains."""
        return self.plausible / max(self.rows, 1)


@dataclass(frozen=True)
class Plausibility:
    """Figures of a file that no touch explains, and what the usual mistakes would make of it."""

    # Wrenches with force that were looked at, and how many a touch explains as they are
    rows: int
    plausible: int
    arm_m: float  # Median of the torque over the force, m
    reach_m: float  # From the sensor origin to the farthest point of the probe, m
    miss_m: float  # Median distance at which the line of force passes the probe, m; 0 where it meets it
    smallest_force_N: float  # In the whole file
    trials: tuple[MistakeTrial, ...]  # The mistakes, those that explain most first

    @property
    def likely(self) -> tuple[MistakeTrial, ...]:
        """The mistake that makes most wrenches plausible, and those that cannot be told from it; none: empty."""
        good = [
            trial
            for trial in self.trials
            if trial.plausible >= _FEWEST_ROWS and trial.share > _MOST_BY_CHANCE
        ]
        return tuple(trial for trial in good if trial.share >= good[0].share - _CLOSE)

    def facts(self) -> dict[str, Any]:
        """Return everything as values that JSON knows."""
        return {**asdict(self), "likely": [trial.name for trial in self.likely]}

    def sentences(self) -> tuple[str, ...]:
        """Return what is wrong, the likeliest cause, and the remedy."""
        figures = message(
            f"No single touch of the probe explains most of the wrenches: {arg(self.plausible)} of"
            f" {arg(self.rows)} rows tried are plausible. Median arm (torque over force):"
            f" {arg(self.arm_m):.3g} m; the probe reaches {arg(self.reach_m):.2g} m. The line of force"
            f" misses the probe by {arg(1e3 * self.miss_m):.0f} mm (median). Smallest force in the"
            f" file: {arg(self.smallest_force_N):.2g} N."
        )
        if not self.likely:
            return (figures, _NO_CAUSE)
        first, *others = self.likely
        also = (
            message(
                f" Equally many fit if {arg(join(message(' or if '), (trial.cause for trial in others[:2])))}."
            )
            if others
            else ""
        )
        cause = message(
            f"Most likely {arg(first.cause)}: {arg(first.plausible)} of {arg(first.rows)} rows"
            f" ({arg(100 * first.share):.0f} %) are then plausible. {arg(first.remedy)}{arg(also)}"
        )
        return (figures, cause)


_NO_CAUSE = message(
    "None of the usual mistakes makes most of them plausible (torques in N·mm, reversed forces, a"
    " mount turned by right angles, uncompensated weight). Check the position in --place, and"
    " that nothing else touches or pulls the probe: two touches at once, or a cable, look like"
    " this."
)


class Sample:
    """Some wrenches with force of a stream, evenly over it, and its least force; the same whatever its blocks are."""

    def __init__(self) -> None:
        self._kept: list[npt.NDArray[np.float64]] = []
        self._stride = 1
        self._seen = 0
        self._least_N = np.inf

    def add(self, wrenches: npt.NDArray[np.float64], reasons: npt.NDArray[np.uint8]) -> None:
        """Take rows (n, 6), S, N and N·m, with their reasons (n,)."""
        good = wrenches[~np.isin(reasons, (Reason.NOT_FINITE, Reason.SATURATED))]
        if len(good):
            self._least_N = min(self._least_N, float(np.linalg.norm(good[:, :3], axis=1).min()))
        forced = wrenches[~np.isin(reasons, NOT_LOCATED)]
        first = -self._seen % self._stride
        self._kept.extend(forced[first :: self._stride].copy())
        self._seen += len(forced)
        while len(self._kept) >= 2 * ROWS:
            self._kept = self._kept[::2]
            self._stride *= 2

    def judge(self, locator: Locator, probe: Probe) -> Plausibility:
        """Try the usual mistakes on the sample; it holds a row at least."""
        kept = np.array(self._kept)
        wrenches = kept[np.linspace(0, len(kept) - 1, min(ROWS, len(kept))).astype(int)]
        force = np.linalg.norm(wrenches[:, :3], axis=1)
        reach = float(np.linalg.norm(probe.vertices, axis=1).max())
        arm = float(np.median(np.linalg.norm(wrenches[:, 3:], axis=1) / force))
        _, plausible = _count(locator, wrenches)
        trials = [
            MistakeTrial(name, cause, remedy, *_count(locator, undone))
            for name, cause, remedy, undone in _mistakes(wrenches, arm / reach)
        ]
        trials.sort(key=lambda trial: -trial.share)  # of equals the simpler one stays first
        miss = float(np.median(_misses(wrenches, probe)))
        return Plausibility(len(wrenches), plausible, arm, reach, miss, self._least_N, tuple(trials))


def unexplained(reasons: dict[str, int]) -> bool:
    """Tell whether no touch explains more than half of the rows that were worth locating."""
    none = sum(reasons[reason.name.lower()] for reason in UNEXPLAINED)
    idle = sum(reasons[reason.name.lower()] for reason in NOT_LOCATED)
    return 2 * none > sum(reasons.values()) - idle


def _count(locator: Locator, wrenches: npt.NDArray[np.float64]) -> tuple[int, int]:
    """Return how many rows are worth locating, and how many of these a touch explains."""
    if not len(wrenches):
        return 0, 0
    answers: Batch = locator.locate_batch(np.ascontiguousarray(wrenches))
    located = ~np.isin(answers.reasons, NOT_LOCATED)
    return int(located.sum()), int((located & ~np.isin(answers.reasons, UNEXPLAINED)).sum())


def _mistakes(
    wrenches: npt.NDArray[np.float64], reaches: float
) -> Iterator[tuple[str, str, str, npt.NDArray[np.float64]]]:
    """Yield name, cause, remedy, and the wrenches with the mistake undone; the simplest first."""
    # Torques divided by a thousand point every line of force at the flange, which would explain anything: only where
    # an arm could not be a touch's.
    if reaches > _FAR:
        yield (
            "torques_in_Nmm",
            message("the torques are in N·mm"),
            message("Divide mx, my and mz by 1000."),
            wrenches * [1, 1, 1, 1e-3, 1e-3, 1e-3],
        )
    yield (
        "reversed",
        message("the signs are reversed"),
        message("Negate all six channels: the file must contain the force of the tissue on the probe."),
        -wrenches,
    )
    rest = _at_rest(wrenches)
    if np.linalg.norm(rest[:3]) > _HEAVY_N:
        yield (
            "not_compensated",
            message(
                f"weight or offset is still in the wrenches ({arg(np.linalg.norm(rest[:3])):.2g} N, repeatedly)"
            ),
            message(
                "Compensate them first: contactbench calibrate compensate calibration.json RECORDING --out WRENCHES."
            ),
            wrenches - rest,
        )
    for name, turn in _TURNS:
        yield (
            "turned",
            message(f"the mount is off by a turn of {arg(name)}"),
            message(f"Turn the mesh by {arg(name)}, in --place or with `contactbench probe align`."),
            np.hstack([wrenches[:, :3] @ turn, wrenches[:, 3:] @ turn]),
        )


def _at_rest(wrenches: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return the wrench (6,) that is read most often: a tool that hangs untouched; 0 where none recurs."""
    scaled = wrenches / ([_SAME_N] * 3 + [_SAME_NM] * 3)
    near = np.abs(scaled[:, None] - scaled).max(axis=2) < 1
    most = near[near.sum(axis=1).argmax()]
    return np.asarray(wrenches[most].mean(axis=0) if most.mean() >= _RESTING else np.zeros(6))


def _right_angled_turns() -> list[tuple[str, npt.NDArray[np.float64]]]:
    """Return the 23 rotations of a cube, (3, 3), about z first, with names."""
    found = []
    for order, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3)):
        turn = np.zeros((3, 3))
        turn[range(3), order] = signs
        if np.linalg.det(turn) > 0 and not np.array_equal(turn, np.eye(3)):
            found.append(turn)
    named = [(_name(turn), turn) for turn in found]
    return sorted(named, key=lambda each: ("about" not in each[0], each[0][-1:] != "z", each[0]))


def _name(turn: npt.NDArray[np.float64]) -> str:
    axes = np.flatnonzero(np.diag(turn) == 1)
    if len(axes):
        axis = int(axes[0])
        i, j = (axis + 1) % 3, (axis + 2) % 3
        degrees = round(np.degrees(np.arctan2(turn[j, i], turn[i, i])))
        return f"{degrees}° about {'xyz'[axis]}"
    images = ("-" * int(turn[i, j] < 0) + "xyz"[i] for j, i in enumerate(np.abs(turn).argmax(axis=0)))
    return "x, y, z to " + ", ".join(images)


_TURNS = _right_angled_turns()


def _misses(wrenches: npt.NDArray[np.float64], probe: Probe) -> npt.NDArray[np.float64]:
    """Distance (n,) at which each line of force passes the probe's nearest vertex, m; 0 where it meets the surface."""
    force = np.linalg.norm(wrenches[:, :3], axis=1, keepdims=True)
    along = wrenches[:, :3] / force
    foot = np.cross(along, wrenches[:, 3:] / force)
    far = 2 * (np.linalg.norm(foot, axis=1, keepdims=True) + np.linalg.norm(probe.vertices, axis=1).max())
    _, faces = SurfaceIndex(probe.vertices, probe.faces).first_hit(foot - far * along, along)
    some = probe.vertices[:: max(1, len(probe.vertices) // _VERTICES)]
    return np.array(
        [
            0.0 if face >= 0 else np.linalg.norm(np.cross(some - at, direction), axis=1).min()
            for face, at, direction in zip(faces, foot, along, strict=True)
        ]
    )

"""Every scripted fault with every protocol on live lines, and how sure the suspicion of a re-zero is."""

from __future__ import annotations

import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.fault_lines import LINES, FaultLine, Outcome, cases, run_case

from contactbench.pipeline.devices.faults import Fault
from contactbench.pipeline.devices.readings import RezeroDetector
from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

_MOST_MS = 200.0
_CAUGHT = 0.95
_WORKERS = 6
# A pause of the machine this long is itself a fault to a stream, s.
_PAUSE_S, _TICK_S = 0.03, 0.005
_TRIES = 3
_RATES = (100.0, 200.0, 1000.0)
_SHORT = (
    *((LINES[1], fault) for fault in (Fault.MERGED, Fault.BAD_CHECKSUM, Fault.STALL, Fault.REZERO)),
    *((LINES[7], fault) for fault in (Fault.SPLIT, Fault.GARBAGE, Fault.DISCONNECT, Fault.CLOCK_JUMP)),
)


@dataclass(frozen=True)
class Measured:
    """All outcomes."""

    outcomes: tuple[Outcome, ...]
    repeated: int  # Runs that were made again because this machine paused in them


def run(
    *,
    short: bool = False,
    trials: int = 300,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Play every fault to every protocol, and judge what was shown, what came back and what was made up."""
    if trials < 1:
        raise InputError("give a number of trials above 0.")
    measured = measure(list(_SHORT if short else cases()), seed=seed, progress=progress)
    progress(f"suspicion of a re-zero: {trials} trials")
    figures = (*_figures(measured.outcomes), *rezero_figures(trials, seed))
    settings = {"cases": len(measured.outcomes), "trials": trials, "seed": seed}
    return StudyReport("Faults on live lines", settings, figures, _notes(measured))


def measure(
    chosen: Sequence[tuple[FaultLine, Fault]],
    *,
    seed: int = 0,
    workers: int = _WORKERS,
    progress: Callable[[str], None] = lambda _: None,
) -> Measured:
    """
    Run cases, some at a time.

    A case that does not come out as it must, while this machine paused, is run again.
    """
    repeated: list[FaultLine] = []

    def once(case: tuple[FaultLine, Fault]) -> Outcome:
        for _ in range(_TRIES):
            begun = time.monotonic()
            outcome = run_case(*case, seed=seed)
            if outcome.good or max(outcome.late, pauses.longest(begun)) < _PAUSE_S:
                break
            repeated.append(case[0])
        return outcome

    outcomes = []
    with _Pauses() as pauses, ThreadPoolExecutor(workers) as pool:
        for number, outcome in enumerate(pool.map(once, chosen), 1):
            outcomes.append(outcome)
            if number % 10 == 0 or number == len(chosen):
                progress(f"{number} of {len(chosen)} faults played")
    return Measured(tuple(outcomes), len(repeated))


def matrix(outcomes: Sequence[Outcome]) -> str:
    """Write one row per fault and line as Markdown."""
    rows = [
        "| line | fault | shown after | samples again | all well | made up | shown as |",
        "|---" * 7 + "|",
    ]
    for each in outcomes:
        shown = each.shown or each.expected.replace("unseen", "costs nothing")
        cells = (
            str(each.line),
            each.fault.value,
            *map(_milliseconds, (each.detected, each.flowing, each.well)),
            f"{each.made_up} of {each.samples}",
            shown.replace("|", "\\|"),
        )
        rows.append("| " + " | ".join(cells) + " |")
    return "\n".join(rows) + "\n"


def rezero_figures(trials: int, seed: int) -> tuple[Figure, ...]:
    """Measure how many re-zeros under 5 N are suspected, and how often touches and taps are."""
    rng = np.random.default_rng(seed)
    caught = sum(_caught(rng, _RATES[k % 3]) for k in range(trials))
    false = sum(
        _alarms(_touched(rng, 30.0, _RATES[k % 3], _rest(rng, k)), _RATES[k % 3]) for k in _some(trials)
    )
    return (
        Figure("re-zero under 5 N", "suspected", caught / trials, least=_CAUGHT),
        Figure("touches and taps", f"suspected in {len(_some(trials)) / 2:.0f} min", false, most=0),
    )


def _some(trials: int) -> range:
    # Half minutes cost a thousand times what one re-zero does.
    return range(max(2, trials // 25))


# ---- the report ----------------------------------------------------------------------------------


def _figures(outcomes: Sequence[Outcome]) -> Iterator[Figure]:
    for each in outcomes:
        if each.expected == "shown":
            after = np.inf if each.detected is None else 1e3 * each.detected
            yield Figure(str(each.line), f"{each.fault}: shown after", after, "ms", most=_MOST_MS)
        elif each.expected == "unseen":
            cost = each.lost + (each.detected is not None)
            yield Figure(str(each.line), f"{each.fault}: samples lost, or shown", cost, most=0)
    for line in dict.fromkeys(each.line for each in outcomes):
        mine = [each for each in outcomes if each.line == line]
        made_up, given = sum(each.made_up for each in mine), sum(each.samples for each in mine)
        yield Figure(str(line), f"made up, of {given} samples", made_up, most=0)
        yield Figure(
            str(line), "faults that it did not get over", sum(each.well is None for each in mine), most=0
        )
        again = [1e3 * each.flowing for each in mine if each.flowing is not None]
        if again:
            yield Figure.of(str(line), "samples again after the end", again, "ms")


def _notes(measured: Measured) -> tuple[str, ...]:
    notes = []
    for fault in Fault:
        found = [o for o in measured.outcomes if o.fault is fault and o.expected not in ("shown", "unseen")]
        for words in dict.fromkeys(outcome.expected for outcome in found):
            lines = ", ".join(str(outcome.line) for outcome in found if outcome.expected == words)
            notes.append(f"{fault} of {lines}: {words}.")
    notes.append(f"Runs repeated because this machine paused: {measured.repeated}.")
    notes.append(
        "A re-zero is suspected from rest to rest only, and never once the sensor had rested at zero."
    )
    return tuple(notes)


def _milliseconds(seconds: float | None) -> str:
    return "-" if seconds is None else f"{1e3 * seconds:.0f} ms"


class _Pauses:
    """Notices when this process gets no time."""

    def __init__(self) -> None:
        self._pauses: list[tuple[float, float]] = []
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name="pauses", daemon=True)

    def __enter__(self) -> _Pauses:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()

    def longest(self, since: float) -> float:
        """Return the longest pause since then, s."""
        return max((length for when, length in list(self._pauses) if when >= since), default=0.0)

    def _run(self) -> None:
        last = time.monotonic()
        while not self._stop.wait(_TICK_S):
            now = time.monotonic()
            if now - last > _PAUSE_S:
                self._pauses.append((now, now - last))
            last = now


# ---- re-zeros and touches ------------------------------------------------------------------------


def _rest(rng: np.random.Generator, number: int) -> NDArray[np.float64]:
    """Return the wrench at rest, (6,): under 5 N, under little, and of a bare sensor at zero."""
    return _load(rng, (5.0, 0.5, 0.0)[number % 3])


def _load(rng: np.random.Generator, force: float) -> NDArray[np.float64]:
    """Return a force of any direction with its torque, (6,) N and N·m."""
    direction = rng.normal(size=3)
    vector = force * direction / np.linalg.norm(direction)
    return np.concatenate([vector, np.cross(rng.uniform(-0.1, 0.1, 3), vector)])


def _noise(rng: np.random.Generator, rows: int) -> NDArray[np.float64]:
    sigma = rng.uniform(0.01, 0.1)
    return rng.normal(size=(rows, 6)) * ([sigma] * 3 + [sigma / 30] * 3)


def _touched(
    rng: np.random.Generator, seconds: float, rate: float, rest: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return rest, interrupted by taps and touches that begin and end slowly or within a sample, (n, 6)."""
    rows = int(seconds * rate)
    readings = rest + _noise(rng, rows)
    position = int(0.3 * rate)
    while position < rows:
        shape = _tap(rng, rate) if rng.random() < 0.5 else _touch(rng, rate)
        shape = shape[: rows - position]
        readings[position : position + len(shape)] += shape[:, None] * _load(rng, rng.uniform(2.0, 30.0))
        position += len(shape) + int(rng.uniform(0.05, 1.0) * rate)
    return readings


def _tap(rng: np.random.Generator, rate: float) -> NDArray[np.float64]:
    steps = max(1, int(rng.uniform(0.005, 0.06) * rate))
    pulse: NDArray[np.float64] = np.sin(np.pi * (np.arange(steps) + rng.uniform(0.2, 0.8)) / steps)
    return pulse


def _touch(rng: np.random.Generator, rate: float) -> NDArray[np.float64]:
    up, down = (int(rng.choice([0.001, 0.02, 0.3]) * rate) for _ in range(2))
    hold = np.ones(max(1, int(rng.uniform(0.1, 1.5) * rate)))
    return np.concatenate([np.linspace(0, 1, up + 1)[1:], hold, np.linspace(1, 0, down + 1)[1:]])


def _alarms(readings: NDArray[np.float64], rate: float) -> int:
    detector = RezeroDetector()
    found = 0
    for number, (fx, fy, fz, mx, my, mz) in enumerate(readings.tolist()):
        found += detector.feed(WrenchSample(number / rate, (fx, fy, fz), (mx, my, mz))) is not None
    return found


def _caught(rng: np.random.Generator, rate: float) -> bool:
    """Zero a sensor under 5 N, at rest after some touches."""
    rest = _load(rng, 5.0)
    before, still = _touched(rng, 2.0, rate, rest), rest + _noise(rng, int(0.8 * rate))
    at = len(still) // 2
    still[at:] -= still[at - 10 : at].mean(axis=0)
    return _alarms(np.concatenate([before, still]), rate) == 1

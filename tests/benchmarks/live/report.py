"""Several sensors read at once: what is lost, how late samples are, what it costs; and how fast the parsers are."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.live.parsing import PROTOCOLS, parse_speed
from benchmarks.live.trial import run_trial

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from benchmarks.live.trial import Trial

MOST_SENSORS = 16
SHORTEST_S = 1.0
LONGEST_S = 7_200.0

# Of one core, for one sensor; of the time from a frame's bytes to its sample, ms; of memory, MB.
_CORE = 15.0
_LATE_MS = 5.0
_GROWTH_MB = 8.0
_PACE_OFF = 0.005  # a sensor that does not keep its rate has not been read at that rate
_MS, _MB = 1e3, 1e6


def run(
    seconds: float = 600.0,
    sensors: int = 3,
    *,
    rate: float = 1000.0,
    busy: bool = False,
    frames: int = 50_000,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """
    Read emulated SRI sensors on pseudo-terminals, each in a process of its own, in one process, all at once.
    """
    _check(seconds, sensors, rate, frames)
    figures: list[Figure] = []
    notes = [
        "Latency is from the frame given to the line to the sample given to its reader.",
        "No reader is earlier than the machine wakes it: what else runs shows in the bare sleep.",
        "The share of a core includes writing each sample to a file.",
    ]
    for spinning in (False, True) if busy else (False,):
        with_what = ", one core busy" if spinning else ""
        progress(f"{_counted(sensors)} at {rate:g} Hz for {seconds:g} s{with_what}")
        trial = run_trial(seconds, sensors, rate, busy=spinning)
        figures += _figures(trial, rate, f"{_counted(sensors)}{with_what}")
        notes += _one_of_each(trial.cost.findings)
    if frames:
        figures += _speeds(frames, seed, progress)
        notes.append(
            "numpy.frombuffer unpacks whole frames back to back: it finds no header, and checks no sum."
        )
    settings = {
        "seconds": seconds,
        "sensors": sensors,
        "rate": f"{rate:g} Hz",
        "frames": frames,
        "seed": seed,
    }
    return StudyReport("Live sensors", settings, tuple(figures), tuple(dict.fromkeys(notes)))


def _counted(sensors: int) -> str:
    return f"{sensors} sensor" + ("s" if sensors > 1 else "")


def _check(seconds: float, sensors: int, rate: float, frames: int) -> None:
    if not SHORTEST_S <= seconds <= LONGEST_S:
        raise InputError(f"seconds {seconds:g}: give {SHORTEST_S:g} to {LONGEST_S:g}.")
    if not 1 <= sensors <= MOST_SENSORS:
        raise InputError(f"sensors {sensors}: give 1 to {MOST_SENSORS}.")
    if not 10 <= rate <= 2500 or rate != round(rate):
        raise InputError(f"rate {rate:g}: give whole Hz from 10 to 2500.")
    if frames < 0:
        raise InputError(f"frames {frames}: give 0 or more.")


def _figures(trial: Trial, rate: float, subject: str) -> list[Figure]:
    pairs, cost = trial.sensors, trial.cost
    late = _MS * np.concatenate([pair.latency for pair in pairs])
    middle, high, most = np.percentile(late, [50, 99, 100]).tolist()
    slowest = min(pair.pace for pair in pairs)
    fastest = max(pair.pace for pair in pairs)
    jitter = _MS * max(pair.jitter for pair in pairs)
    processor = 100 * cost.processor / cost.seconds / len(pairs)
    figures = [
        Figure(subject, "frames sent", sum(pair.sent for pair in pairs), least=1),
        Figure(subject, "slowest sensor", slowest, "Hz", least=rate * (1 - _PACE_OFF)),
        Figure(subject, "fastest sensor", fastest, "Hz", most=rate * (1 + _PACE_OFF)),
        Figure(subject, "frames lost", sum(pair.lost for pair in pairs), most=0),
        Figure(subject, "samples changed", sum(pair.changed for pair in pairs), most=0),
        Figure(subject, "share of one core for one sensor", processor, "%", most=_CORE),
        Figure(subject, "latency, median", middle, "ms"),
        Figure(subject, "latency, 99th percentile", high, "ms", most=_LATE_MS),
        Figure(subject, "latency, largest", most, "ms"),
        Figure(subject, "a bare sleep of 1 ms, late, 99th percentile", _MS * trial.machine_late, "ms"),
        Figure(subject, "jitter", jitter, "ms"),
    ]
    if cost.resident_early is not None and cost.resident_end is not None:
        growth = (cost.resident_end - cost.resident_early) / _MB
        figures.append(
            Figure(subject, "memory added after a tenth of the run", growth, "MB", most=_GROWTH_MB)
        )
    return figures


def _speeds(frames: int, seed: int, progress: Callable[[str], None]) -> list[Figure]:
    figures = []
    for protocol in PROTOCOLS:
        progress(f"{protocol}: {frames:,} frames from memory")
        speed = parse_speed(protocol, frames, seed)
        figures += [
            Figure(protocol, "parser", speed.parser / _MB, "MB/s"),
            Figure(protocol, "parser, samples", speed.parser / speed.frame_bytes, "/s"),
            Figure(protocol, "numpy.frombuffer", speed.unpacking / _MB, "MB/s"),
        ]
    return figures


def _one_of_each(findings: Sequence[str]) -> list[str]:
    """Return the first finding of each kind, and how many more there were: they differ in their numbers alone."""
    kinds: dict[str, list[str]] = {}
    for finding in findings:
        kinds.setdefault(re.sub(r"[0-9.]+|sri\+serial:\S+", "#", finding), []).append(finding)
    return [
        each[0] + (f" (And {len(each) - 1} times more.)" if len(each) > 1 else "") for each in kinds.values()
    ]

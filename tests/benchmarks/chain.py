"""The C library in a controller's place: how long a frame takes to its published contact, and what is never done."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import native
import numpy as np
from benchmarks.bundle_example import example_config
from benchmarks.live.trial import busy_process
from kernel.runtime_cases import stream

from contactbench.pipeline import kernel
from contactbench.pipeline.config.runtime.values import kernel_arguments
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.config.runtime import RuntimeConfig

TIMES = np.dtype([(name, "<i8") for name in ("sent", "received", "located", "published", "used")])
_RECORD = np.dtype([("head", ">u4", 3), ("counts", ">i4", 6), ("R_WS", "<f8", 9)])
_COUNTS = 1e6  # per N and per N·m
_FRAMES = 10_000  # then again from the first
_RATE_HZ = 1_000.0
_TAIL = 10.0
_SLOWEST_NS = 1_000_000
_MARGIN_S = 60.0  # processes start and stop in much less


@dataclass(frozen=True)
class Way:
    """How frames come."""

    period: int = 1_000_000  # ns; 0: each after the contact of the one before
    busy: bool = False  # A process that never waits is on the same core
    urgent: bool = False  # The chain has real-time priority, as a controller's loop should


def run(
    seconds: float = 60.0,
    minutes: float = 60.0,
    *,
    facets: int = 20_000,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Seal it, then time it: minutes of 1 kHz frame after frame, and seconds at 1 kHz, beside a busy process too."""
    if not seconds >= 0.1 or not minutes > 0:
        raise InputError("give at least 0.1 seconds, and a number of minutes above 0.")
    config = example_config(facets)
    figures: list[Figure] = []
    rows: list[tuple[str | float, ...]] = []
    with TemporaryDirectory(prefix="contactbench-") as name:
        folder = Path(name)
        config.write(folder / "bundle")
        expected = write_frames(folder / "frames", config, _FRAMES)
        program = build(folder)
        said = sealed(program, folder)
        figures += [
            Figure("sealed", "frames", said["updates"], least=_FRAMES),
            Figure("sealed", "requests to the heap", said["requests"], most=0),
            Figure("sealed", "locks taken", said["locks"], most=0),
            Figure("sealed", "accepted otherwise than by Python", abs(said["accepted"] - expected), most=0),
        ]
        paced = round(seconds * _RATE_HZ)
        for subject, count, way in (
            ("frame after frame", round(60 * minutes * _RATE_HZ), Way(0)),
            ("1 kHz", paced, Way(urgent=True)),
            ("1 kHz, its core busy", paced, Way(busy=True)),
            ("1 kHz, its core busy, real-time priority", paced, Way(busy=True, urgent=True)),
        ):
            progress(f"{subject}: {count} frames")
            times, said = timed(program, folder, count, way)
            chain = (times["published"] - times["received"]) / 1e3
            tail = float(np.percentile(chain, 99.9) / np.median(chain))
            figures += [
                Figure(subject, "frames without a contact at the reader", count - said["came"], most=0),
                *([Figure(subject, "real-time priority given", said["urgent"])] if way.urgent else []),
                Figure(subject, "page faults", said["faults"]),
                Figure(subject, "times that the core was taken away", said["switched"]),
                Figure(subject, "chain, p99.9 over its median", tail, most=None if way.busy else _TAIL),
            ]
            for span, ns in (
                ("cb_update", times["located"] - times["received"]),
                ("chain", times["published"] - times["received"]),
                ("chain, processor", times["used"]),
                ("in all", times["published"] - times["sent"]),
            ):
                rows.append((subject, span, *np.percentile(ns / 1e3, [50, 99, 99.9, 100]).tolist()))
    columns = ("of", "span", "median, µs", "p99, µs", "p99.9, µs", "longest, µs")
    note = (
        "Sealed: the first system call would have killed the process. Else an RDT record comes on a UDP socket, is"
        " decoded and located, and its contact is sent by UDP. `chain` is from the record taken from the socket to its"
        " contact given to it, `processor` the thread's own time in that. `in all` begins where the sensor gives the"
        " record to the line: how soon the machine wakes two processes is in it."
    )
    sheets = (Sheet("times", "How long a frame takes", columns, tuple(rows)),)
    settings = {"seconds": seconds, "minutes": minutes, "facets": facets}
    return StudyReport("Chain", settings, tuple(figures), (note,), sheets=sheets)


def build(folder: Path) -> Path:
    """Compile the program beside the library of this checkout."""
    compiler = os.environ.get("CXX") or shutil.which("g++")
    if sys.platform != "linux" or native.CMAKE is None or compiler is None:
        raise InputError("this needs Linux, cmake and g++: install them, or use such a machine.")
    library, program = native.built(), folder / "chain"
    source = Path(__file__).with_suffix(".cpp")
    include = [f"-I{native.SOURCE}/{part}" for part in ("include", "tools")]
    command = [compiler, "-std=c++20", "-O2", "-rdynamic", source, *include]
    command += [f"-L{library}", "-lcontactbench_runtime", f"-Wl,-rpath,{library}", "-o", program]
    done = native.run(*command)
    if done.returncode != 0:
        raise InputError(f"{source}: does not compile: {done.stderr[-1000:]}")
    return program


def write_frames(path: Path, config: RuntimeConfig, count: int) -> int:
    """Write touches as records and orientations; return how many the Python runtime accepts."""
    readings, R, _ = stream(config, count)
    frames = np.zeros(count, _RECORD)
    frames["head"][:, 0] = np.arange(count)
    frames["counts"] = np.round(readings * _COUNTS)
    frames["R_WS"] = R.reshape(-1, 9)
    path.write_bytes(frames.tobytes())
    times = np.arange(1, count + 1) * (1 / _RATE_HZ)
    batch = kernel.Runtime(**kernel_arguments(config)).update_batch(frames["counts"] / _COUNTS, R, times)
    return int(np.count_nonzero(batch.accepted))


def sealed(program: Path, folder: Path, fault: str = "") -> dict[str, int]:
    """Run all frames where any system call kills the process; `fault` is malloc, lock or syscall."""
    done = native.run(program, "sealed", folder / "bundle", folder / "frames", *filter(None, [fault]))
    if done.returncode not in (0, 1):
        raise InputError(f"the sealed process ended with {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def timed(program: Path, folder: Path, count: int, way: Way) -> tuple[NDArray[np.void], dict[str, int]]:
    """Send frames; return what each that came took, and what the process said at its end."""
    # The last core: the first ones serve most interrupts.
    other, core = [0, *sorted(os.sched_getaffinity(0))][-2:]
    words = [program, "run", folder / "bundle", folder / "frames", count, way.period, core, other]
    at_most = count * max(way.period, _SLOWEST_NS) / 1e9 + _MARGIN_S
    with busy_process(at_most, core) if way.busy else nullcontext():
        done = subprocess.run(
            [*map(str, words), str(folder / "times"), str(int(way.urgent))],
            capture_output=True,
            text=True,
            timeout=at_most,
            check=False,
        )
    if done.returncode != 0:
        raise InputError(f"the process that runs the bundle failed: {done.stderr.strip()}")
    times = np.fromfile(folder / "times", TIMES)
    return times[times["published"] > 0], json.loads(done.stdout)

"""Hostile mesh files: whatever bytes a file holds, the answer is a valid mesh or a typed error, soon, in little memory.

Each file is read in a child process with limits on memory and time, so that a crash or a hang is caught, laid to
the file that caused it, and the rest goes on.
"""

import json
import subprocess
import sys
import threading
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import IO, Any

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.report import Figure, StudyReport

# The bounds that a case must keep. 3MF is packed: its model may be 100 times the file and 1 MiB more.
SECONDS_PER_MB = 2.0
SECONDS = 2.0
# However large the file.
MOST_SECONDS, MOST_BYTES = 5.0, 1e9
# A polygon of a PLY file can make a facet of every byte, and a facet takes some 300 bytes on its way.
BYTES_PER_BYTE = 350
BYTES = 50e6
_UNPACKED = 100

# A case that takes longer hangs.
_HANGS_S = 60.0
_BATCH = 500
_WORKER = (sys.executable, "-m", "benchmarks.mesh_fuzz.worker")
_LISTED = 20


@dataclass
class Tally:
    """What came of the files so far."""

    count: int
    seed: int
    refused: Counter[str] = field(default_factory=Counter)  # per suffix
    valid: Counter[str] = field(default_factory=Counter)
    failures: list[str] = field(
        default_factory=list
    )  # crashes, hangs, other errors, invalid meshes, broken bounds
    worst_seconds_per_mb: float = 0.0  # of the files over 100 kB
    worst_seconds: float = 0.0
    worst_memory_ratio: float = 0.0  # of the files over 100 kB that are not packed, over the file's bytes
    worst_memory: float = 0.0  # bytes
    worst_file: str = "none"  # what took the most memory for its size

    def report(self) -> StudyReport:
        """Judge it."""
        judged = self.refused.total() + self.valid.total()
        figures = [
            Figure("all", "files that gave a mesh or a typed error", float(judged), least=float(self.count)),
            Figure("all", "failures", float(len(self.failures)), most=0.0),
            # A file passes within a time and a time per megabyte together, so each alone is only shown.
            Figure(
                "all",
                f"slowest file (allowed {SECONDS:g} s + {SECONDS_PER_MB:g} s/MB)",
                self.worst_seconds,
                "s",
            ),
            Figure("over 100 kB", "slowest per megabyte", self.worst_seconds_per_mb, "s/MB"),
            Figure(
                "all",
                f"most memory (allowed {BYTES / 1e6:.0f} MB + {BYTES_PER_BYTE} times the file)",
                self.worst_memory / 1e6,
                "MB",
            ),
            Figure("over 100 kB", "most memory over the file", self.worst_memory_ratio),
        ]
        for suffix in sorted({*self.refused, *self.valid}):
            refused, valid = float(self.refused[suffix]), float(self.valid[suffix])
            figures.append(Figure(suffix, "refused with an error that names the file", refused))
            figures.append(Figure(suffix, "read as a valid mesh", valid))
        notes = [f"The most memory for its size took: {self.worst_file}.", *self.failures[:_LISTED]]
        if len(self.failures) > _LISTED:
            notes.append(f"And {len(self.failures) - _LISTED} more failures.")
        settings = {"files": f"{self.count:,}", "seed": self.seed}
        return StudyReport("Hostile mesh files", settings, tuple(figures), tuple(notes))


def run(
    count: int = 10_000, seed: int = 0, progress: Callable[[int, int], None] | None = None
) -> StudyReport:
    """Read hostile mesh files in child processes: each must give a valid mesh or a typed error, soon."""
    if count < 1:
        raise InputError(f"count: {count} files are none; give at least 1")
    report = Tally(count, seed)
    number = 0
    while number < count:
        number = _batch(report, number, min(number + _BATCH, count), progress or (lambda *_: None))
    return report.report()


def _batch(report: Tally, first: int, last: int, progress: Callable[[int, int], None]) -> int:
    """Run one child; give the number to go on with."""
    command = [*_WORKER, *map(str, (report.seed, first, last))]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert child.stdout is not None
    assert child.stderr is not None
    errors: list[str] = []
    listener = threading.Thread(target=_keep_end, args=(child.stderr, errors), daemon=True)
    listener.start()
    case: dict[str, Any] | None = None
    hung = threading.Event()
    done = first
    while line := _line_in_time(child, child.stdout, hung):
        said = json.loads(line)
        if case is None:
            case = said
            continue
        _count(report, case, said)
        case, done = None, done + 1
        progress(done, report.count)
    child.kill()
    code = child.wait()
    listener.join(timeout=5)
    child.stdout.close()
    if done == last:
        return last
    why = f"it hangs: not read in {_HANGS_S:g} s" if hung.is_set() else f"the process died, exit code {code}"
    case = case or {"begins": done, "suffix": "none", "kind": "before the file was read"}
    end = "".join(errors)[-300:].strip()
    report.failures.append(f"Case {done} ({case['suffix']}, {case['kind']}): {why}. {end}".strip())
    return done + 1


def _line_in_time(child: subprocess.Popen[str], stream: IO[str], hung: threading.Event) -> str:
    def stop() -> None:
        hung.set()
        child.kill()

    timer = threading.Timer(_HANGS_S, stop)
    timer.start()
    try:
        return stream.readline()
    finally:
        timer.cancel()


def _keep_end(stream: IO[str], kept: list[str]) -> None:
    with stream:
        for line in stream:
            kept[:] = [*kept[-20:], line]


def _count(report: Tally, case: dict[str, Any], said: dict[str, Any]) -> None:
    suffix, size = case["suffix"], case["bytes"]
    unpacked = size if suffix != ".3mf" else _UNPACKED * size + 2**20
    why = said["why"] if said["outcome"] == "wrong" else ""
    if said["seconds"] > min(MOST_SECONDS, SECONDS + SECONDS_PER_MB * unpacked / 1e6):
        why = f"it took {said['seconds']:.1f} s for {size} bytes"
    if said["peak"] > min(MOST_BYTES, BYTES + BYTES_PER_BYTE * unpacked):
        why = f"it took {said['peak'] / 1e6:.0f} MB of memory for {size} bytes"
    if why:
        report.failures.append(f"Case {case['begins']} ({suffix}, {case['kind']}): {why}.")
    elif said["outcome"] == "valid":
        report.valid[suffix] += 1
    else:
        report.refused[suffix] += 1
    report.worst_seconds = max(report.worst_seconds, said["seconds"])
    report.worst_memory = max(report.worst_memory, said["peak"])
    if size > 100_000:
        report.worst_seconds_per_mb = max(report.worst_seconds_per_mb, said["seconds"] / size * 1e6)
        if suffix != ".3mf":
            ratio = said["peak"] / size
            if ratio > report.worst_memory_ratio:
                report.worst_memory_ratio, report.worst_file = ratio, f"{suffix}, {case['kind']}"

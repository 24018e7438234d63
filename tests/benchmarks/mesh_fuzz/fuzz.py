"""Hostile mesh files: whatever bytes a file holds, the answer is a valid mesh or a typed error, soon, in little memory.

Each file is read in a child process with limits on memory and time, so that a crash or a hang is caught, laid to
the file that caused it, and the rest goes on.
"""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from collections import Counter
from dataclasses import asdict, dataclass, field
from typing import IO, TYPE_CHECKING, Any

from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

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


@dataclass(frozen=True)
class Failure:
    """A file that broke something: which, what was done to it, and what happened."""

    number: int
    suffix: str
    kind: str
    why: str


@dataclass
class FuzzReport:
    """What came of the files."""

    count: int  # The series
    seed: int  # The series
    refused: Counter[str] = field(default_factory=Counter)  # Typed errors and valid meshes per suffix
    valid: Counter[str] = field(default_factory=Counter)  # Typed errors and valid meshes per suffix
    # Crashes, hangs, other errors, invalid meshes, and bounds that were broken
    failures: list[Failure] = field(default_factory=list)
    worst_seconds_per_mb: float = 0.0  # Of the files over 100 kB
    worst_seconds: float = 0.0  # Of all files
    # Memory held at most over the file's bytes, of the files over 100 kB that are not packed
    worst_memory_ratio: float = 0.0
    worst_memory: float = 0.0  # Bytes, of all files
    worst_file: str = ""  # What took the most memory for its size

    @property
    def passed(self) -> bool:
        """Whether every file gave a typed error or a valid mesh within the bounds."""
        return not self.failures and self.refused.total() + self.valid.total() == self.count

    @property
    def sentences(self) -> tuple[str, ...]:
        """What came of it, in sentences."""
        files = (
            f"{self.count:,} hostile files: {self.refused.total():,} refused with an error that names the file,"
            f" {self.valid.total():,} read as a valid mesh, {len(self.failures):,} failures."
        )
        time = (
            f"The slowest took {self.worst_seconds:.2f} s; of files over 100 kB the slowest took"
            f" {self.worst_seconds_per_mb:.2f} s per MB (allowed: {SECONDS:g} s and {SECONDS_PER_MB:g} s per MB,"
            f" {MOST_SECONDS:g} s at most)."
        )
        memory = (
            f"The most memory was {self.worst_memory / 1e6:.0f} MB; of files over 100 kB the most was"
            f" {self.worst_memory_ratio:.0f} times the file (allowed: {BYTES / 1e6:.0f} MB and"
            f" {BYTES_PER_BYTE} times, {MOST_BYTES / 1e9:g} GB at most). It was: {self.worst_file or 'none'}."
        )
        said = [files, time, memory]
        said += [f"Case {f.number} ({f.suffix}, {f.kind}): {f.why}." for f in self.failures[:_LISTED]]
        if len(self.failures) > _LISTED:
            said.append(f"And {len(self.failures) - _LISTED} more failures.")
        return tuple(said)

    def to_json(self) -> dict[str, Any]:
        """Give everything as plain data."""
        return {
            **asdict(self),
            "refused": dict(self.refused),
            "valid": dict(self.valid),
            "passed": self.passed,
            "sentences": list(self.sentences),
        }


def run(count: int = 10_000, seed: int = 0, progress: Callable[[int, int], None] | None = None) -> FuzzReport:
    """Read hostile files in child processes."""
    if count < 1:
        raise InputError(f"count: {count} files are none; give at least 1")
    report = FuzzReport(count, seed)
    number = 0
    while number < count:
        number = _batch(report, number, min(number + _BATCH, count), progress or (lambda *_: None))
    return report


def _batch(report: FuzzReport, first: int, last: int, progress: Callable[[int, int], None]) -> int:
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
    report.failures.append(Failure(done, case["suffix"], case["kind"], f"{why}. {end}".strip()))
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


def _count(report: FuzzReport, case: dict[str, Any], said: dict[str, Any]) -> None:
    suffix, size = case["suffix"], case["bytes"]
    unpacked = size if suffix != ".3mf" else _UNPACKED * size + 2**20
    why = said["why"] if said["outcome"] == "wrong" else ""
    if said["seconds"] > min(MOST_SECONDS, SECONDS + SECONDS_PER_MB * unpacked / 1e6):
        why = f"it took {said['seconds']:.1f} s for {size} bytes"
    if said["peak"] > min(MOST_BYTES, BYTES + BYTES_PER_BYTE * unpacked):
        why = f"it took {said['peak'] / 1e6:.0f} MB of memory for {size} bytes"
    if why:
        report.failures.append(Failure(case["begins"], suffix, case["kind"], why))
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

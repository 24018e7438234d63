"""What came of the hostile mesh files, as figures with targets."""

from __future__ import annotations

from typing import TYPE_CHECKING

from benchmarks import mesh_fuzz
from benchmarks.mesh_fuzz.fuzz import BYTES, BYTES_PER_BYTE, SECONDS, SECONDS_PER_MB

from contactbench.pipeline.study.report import Figure, Report

if TYPE_CHECKING:
    from collections.abc import Callable

    from benchmarks.mesh_fuzz import FuzzReport


def run(count: int = 10_000, seed: int = 0, progress: Callable[[int, int], None] | None = None) -> Report:
    """Read hostile mesh files in child processes: each must give a valid mesh or a typed error, soon."""
    return summarise(mesh_fuzz.run(count, seed, progress))


def summarise(report: FuzzReport) -> Report:
    """Put a fuzz report in the form of the other studies."""
    suffixes = sorted({*report.refused, *report.valid})
    judged = report.refused.total() + report.valid.total()
    figures = [
        Figure("all", "files that gave a mesh or a typed error", float(judged), least=float(report.count)),
        Figure("all", "failures", float(len(report.failures)), most=0.0),
        # A file passes within a time and a time per megabyte together, so each alone is only shown.
        Figure(
            "all",
            f"slowest file (allowed {SECONDS:g} s + {SECONDS_PER_MB:g} s/MB)",
            report.worst_seconds,
            "s",
        ),
        Figure("over 100 kB", "slowest per megabyte", report.worst_seconds_per_mb, "s/MB"),
        Figure(
            "all",
            f"most memory (allowed {BYTES / 1e6:.0f} MB + {BYTES_PER_BYTE} times the file)",
            report.worst_memory / 1e6,
            "MB",
        ),
        Figure("over 100 kB", "most memory over the file", report.worst_memory_ratio),
    ]
    for suffix in suffixes:
        figures.append(
            Figure(suffix, "refused with an error that names the file", float(report.refused[suffix]))
        )
        figures.append(Figure(suffix, "read as a valid mesh", float(report.valid[suffix])))
    settings = {"files": f"{report.count:,}", "seed": report.seed}
    return Report("Hostile mesh files", settings, tuple(figures), report.sentences)

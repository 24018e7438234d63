"""Hostile mesh files: made by the thousand, read in child processes, judged."""

from benchmarks.mesh_fuzz.fuzz import BYTES, BYTES_PER_BYTE, Failure, FuzzReport, run

__all__ = ["BYTES", "BYTES_PER_BYTE", "Failure", "FuzzReport", "run"]

"""Fewer facets for the same shape: by count, by deviation, or by any error that a caller can measure."""

from contactbench.pipeline.mesh.simplify.job import (
    Count,
    MaxDeviation,
    MaxError,
    Simplified,
    Target,
    check_ratio,
    simplify,
)

__all__ = ["Count", "MaxDeviation", "MaxError", "Simplified", "Target", "check_ratio", "simplify"]

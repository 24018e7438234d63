"""Bundles for tests: the bundled T-shape, weighed in simulation."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from pipeline.study.bundle_example import example_config

if TYPE_CHECKING:
    from pathlib import Path

    from pipeline.config.runtime import RuntimeConfig


@cache
def example(facets: int = 1_000, *, rate: float = 1_000.0, verified: bool = True) -> RuntimeConfig:
    """Return the example; made once."""
    return example_config(facets, rate=rate, verified=verified)


def example_bundle(
    folder: Path, facets: int = 1_000, *, rate: float = 1_000.0, verified: bool = True
) -> RuntimeConfig:
    """Write the example to a folder, or a zip file if its name ends in .zip, and return it."""
    config = example(facets, rate=rate, verified=verified)
    config.write(folder)
    return config

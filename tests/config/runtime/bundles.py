"""Bundles for tests: the bundled T-shape, weighed in simulation."""

from __future__ import annotations

import json
from functools import cache
from typing import TYPE_CHECKING

from pipeline.study.bundle_example import example_config
from pipeline.study.bundle_mutations import seal

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


OLD_GAINS = {
    "desired_force_N": 5.0,
    "force_mass_kg": 1.0,
    "force_damping_Nspm": 80.0,
    "force_stiffness_Npm": 0.5,
    "angle_inertia": 0.05,
    "angle_damping": 1.0,
    "angle_stiffness": 0.25,
}


def of_version_1(files: dict[str, bytes], controller: object = OLD_GAINS) -> dict[str, bytes]:
    """Return a bundle as contactbench wrote it before version 2: with one gain for both turns."""
    content = json.loads(files["contactbench.json"])
    content |= {"version": 1, "controller": controller}
    return seal({**files, "contactbench.json": json.dumps(content).encode()})

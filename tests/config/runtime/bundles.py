"""Bundles for tests: the bundled T-shape, weighed in simulation."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from benchmarks.bundle_example import example_config
from benchmarks.bundle_mutations import seal

from contactbench.pipeline.calibration.calibrate import DOWN_W
from contactbench.pipeline.mesh.sidecar import encode_probe

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.config.runtime import RuntimeConfig


def example(
    facets: int = 1_000,
    *,
    rate: float = 1_000.0,
    verified: bool = True,
    clamped: bool = False,
    down_W: tuple[float, float, float] = DOWN_W,
) -> RuntimeConfig:
    """Return the example; made once."""
    return example_config(facets, rate=rate, verified=verified, clamped=clamped, down_W=down_W)


def example_bundle(
    folder: Path, facets: int = 1_000, *, rate: float = 1_000.0, verified: bool = True, clamped: bool = False
) -> RuntimeConfig:
    """Write the example to a folder, or a zip file if its name ends in .zip, and return it."""
    config = example(facets, rate=rate, verified=verified, clamped=clamped)
    config.write(folder)
    return config


def with_invented(config: RuntimeConfig, invented: NDArray[np.bool_]) -> dict[str, bytes]:
    """Return the files of a bundle whose mesh file lacked some facets (m,)."""
    colours = [region.colour for region in config.model.regions]
    surface = encode_probe(config.probe.with_invented(invented), colours)
    return seal({**config.encoded(), "probe.ply": surface})


OLD_GAINS = {
    "desired_force_N": 5.0,
    "force_mass_kg": 1.0,
    "force_damping_Nspm": 80.0,
    "force_stiffness_Npm": 0.5,
    "angle_inertia": 0.05,
    "angle_damping": 1.0,
    "angle_stiffness": 0.25,
}


def of_version_3(files: dict[str, bytes], **changes: object) -> dict[str, bytes]:
    """Return a bundle as contactbench wrote it before version 4: down was -z of W."""
    content = json.loads(files["contactbench.json"])
    for name in ("world", "zero", "checks"):
        del content[name]
    del content["noise"]["orientation_rad"]
    content["frames"]["world"] = "W, z up"
    content |= {"version": 3, **changes}
    return seal({**files, "contactbench.json": json.dumps(content).encode()})


def of_version_2(files: dict[str, bytes], **changes: object) -> dict[str, bytes]:
    """Return a bundle as contactbench wrote it before version 3: touches were ranked by rules."""
    content = json.loads(of_version_3(files)["contactbench.json"])
    for name in ("touch", "streams", "self_test"):
        del content[name]
    new = [
        "implausible_misfit",
        "rival_odds",
        "first_odds",
        "follow_odds",
        "accept_by_region",
        "depth_distance_m",
    ]
    old = {name: value for name, value in content["gates"].items() if name not in new}
    content["gates"] = {**old, "torque_ratio": 1.5, "rival_sigmas": 3.0}
    for region in content["regions"]:
        del region["odds"], region["untouchable"]
    content |= {"version": 2, **changes}
    files = {name: data for name, data in files.items() if name != "self_test.csv"}
    return seal({**files, "contactbench.json": json.dumps(content).encode()})


def of_version_1(files: dict[str, bytes], controller: object = OLD_GAINS) -> dict[str, bytes]:
    """Return a bundle as contactbench wrote it before version 2: with one gain for both turns."""
    return of_version_2(files, version=1, controller=controller)

"""
docs/bundle.md is complete: a runtime written from it alone gives the answers of the compiled one, sample by sample.

``CONTACTBENCH_REFERENCE_SAMPLES=8000`` compares more samples than the suite does.
"""

from __future__ import annotations

import os
from collections import Counter
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from config.runtime.bundle_reference import Answer, Reference
from config.runtime.bundles import example

from contactbench import assets
from contactbench.pipeline.config.runtime.self_test import StreamPose, synthetic_stream
from contactbench.pipeline.config.runtime.values import make_runtime
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.sidecar import encode_probe

if TYPE_CHECKING:
    from pathlib import Path

    from contactbench.pipeline import kernel
    from contactbench.pipeline.config.runtime import RuntimeConfig

SAMPLES = int(os.environ.get("CONTACTBENCH_REFERENCE_SAMPLES", "1500"))
NEAR_M = 1e-7
ALWAYS = {"ok", "low_force", "stale", "not_finite", "implausible", "unhealthy"}
ALWAYS |= {f"health {bits}" for bits in (0, 1, 4, 8, 16)}
SOMETIMES = {
    "as exported": {"ambiguous", "by_region", "vertex", "two_touches", "saturated"},
    "unfiltered, in regions only": {"outside_region", "tangential"},
    "a zero that follows": {"following"},
    "still, without a mount": {"uncertain"},
}
TURNED = [0.5, 0.5, -0.5, 0.5]


@dataclass(frozen=True)
class Variant:
    """A change of an example: its probe, and fields by their path."""

    probe: str
    facets: int
    clamped: bool = False
    fields: dict[str, Any] = field(default_factory=dict)


VARIANTS = {
    "as exported": Variant("t-shape", 300, clamped=True),
    "unfiltered, in regions only": Variant(
        "convex",
        200,
        fields={
            "filters": {"wrench": None, "location": None},
            "frames.quaternion_ES": TURNED,
            "gates.region_only": True,
            "touch.mesh_curved": False,
            "touch.torsion": "fixed",
            "touch.mesh_deviation_m": 2e-4,
        },
    ),
    "a zero that follows": Variant("t-shape", 300, clamped=True, fields={"zero.follow": True}),
    "still, without a mount": Variant(
        "t-shape",
        400,
        clamped=True,
        fields={
            "frames.quaternion_ES": None,
            "streams.motion": None,
            "filters.wrench.per_sample": True,
            "gates.accept_by_region": False,
            "gates.recent_samples": 5,
            "gates.friction_angle_rad": 0.9,
            "gates.ambiguity_distance_m": 0.001,
            "gates.follow_odds": 30.0,
            "gates.sigma_max_m": 0.0008,
            "touch.torsion_arm_m": 0.0003,
        },
    ),
    "another probe, without limits": Variant(
        "linear", 250, fields={"gates.max_age_s": 0.03, "gates.saturation": [None] * 6}
    ),
}


def bundle_of(variant: Variant) -> RuntimeConfig:
    config = changed(example(variant.facets, clamped=variant.clamped), variant.fields)
    if variant.probe == "t-shape":
        return config
    vertices, faces = assets.make(variant.probe, variant.facets)
    probe = Probe.from_arrays(
        vertices, faces, assets.contact_region(variant.probe, vertices, faces), name=variant.probe
    )
    return replace(config, probe=probe, files={**config.files, "probe.ply": encode_probe(probe)})


def changed(config: RuntimeConfig, fields: dict[str, Any]) -> RuntimeConfig:
    content = config.model.to_json()
    for path, value in fields.items():
        *outer, last = path.split(".")
        part = content
        for name in outer:
            part = part[name]
        part[last] = value
    return replace(config, model=type(config.model).model_validate(content))


def same(here: kernel.RuntimeContact, there: Answer) -> bool:
    """All that a controller reads; points to NEAR_M, the rest to rounding."""
    if (here.reason_name, here.accepted, here.health) != (there.reason, there.accepted, there.health):
        return False
    if (here.region, here.candidates) != (there.region, there.candidates):
        return False
    points = [
        (here.point, there.point),
        (here.filtered_point, there.filtered),
        (here.runner_up, there.runner_up),
        (here.second, there.second),
    ]
    rest = [
        (here.normal, there.normal),
        (here.wrench, there.wrench),
        *covariances(here, there),
        *(
            (np.array([one]), np.array([other]))
            for one, other in (
                (here.torque, there.k),
                (here.confidence, there.confidence),
                (here.misfit, there.misfit),
                (here.left_over, there.left_over),
                (here.arm, there.arm),
                (here.torsion_arm, there.torsion_arm),
                (here.torsion_since, there.torsion_since),
                (here.pose_age, there.pose_age),
                (here.latency, there.latency),
            )
        ),
    ]
    return all(close(*pair, NEAR_M, 0.0) for pair in points) and all(
        close(*pair, 1e-7, 1e-7) for pair in rest
    )


def covariances(here: kernel.RuntimeContact, there: Answer) -> list[tuple[Any, Any]]:
    """In cm²."""
    return [(None if here.covariance is None else 1e4 * here.covariance, 1e4 * there.covariance)]


def close(here: Any, there: Any, absolute: float, relative: float) -> bool:
    here = np.full(np.shape(there), np.nan) if here is None else here
    return bool(np.allclose(here, there, rtol=relative, atol=absolute, equal_nan=True))


@pytest.mark.parametrize("name", VARIANTS)
def test_every_sample_is_answered_alike(name: str, tmp_path: Path) -> None:
    config = bundle_of(VARIANTS[name])
    config.write(tmp_path / "bundle")
    compiled, reference = make_runtime(config), Reference(tmp_path / "bundle")
    seen: Counter[str] = Counter()
    for number, row in enumerate(synthetic_stream(config, SAMPLES // len(VARIANTS), seed=7)):
        if isinstance(row, StreamPose):
            R, p = np.array(row.R).reshape(3, 3), np.array(row.p)
            assert compiled.pose(R, p, row.time) == reference.pose(R, p, row.time), number
            continue
        here = compiled.locate(np.array(row.wrench), row.time, row.arrival, row.flags)
        there = reference.sample(np.array(row.wrench), row.time, row.arrival, row.flags)
        assert same(here, there), (number, row, here.reason_name, here.point, there)
        seen.update({here.reason_name: 1, f"health {here.health}": 1, compiled.zero().follows: 1})
        for later in (0.01, 0.5):
            assert (compiled.silent(row.time + later) is not None) == reference.silent(row.time + later)
    # Nothing was compared if nothing happened.
    assert ALWAYS | SOMETIMES.get(name, set()) <= set(seen), seen

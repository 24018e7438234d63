"""An example of a runtime config: the bundled T-shape, weighed and verified in simulation."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench import assets
from contactbench.pipeline.calibration import GravityModel, PoseNoise, calibrate
from contactbench.pipeline.calibration.model import DOWN_W
from contactbench.pipeline.config.runtime import Filters, RuntimeConfig, build_config
from contactbench.pipeline.config.runtime.checks import NONE_DONE
from contactbench.pipeline.config.runtime.model import (
    ChecksPart,
    KnownTouchPart,
    KnownWeightPart,
    LimitsPart,
    SensorPart,
    SourcePart,
    VerificationPart,
)
from contactbench.pipeline.contact.touch_model import TouchModel, WrenchNoise
from contactbench.pipeline.control.settings import ControlSettings, Foundation, controller_of
from contactbench.pipeline.filtering import KalmanFilter, LowPass
from contactbench.pipeline.gates import Gates
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions.region import Region, RegionSet
from contactbench.pipeline.mesh.sidecar import ProbeFile
from contactbench.pipeline.simulation.loads import weigh

_CLAMP_M = 0.02
_DRIFT = np.array([1e-5, -2e-5, 3e-5, 1e-7, 0.0, -2e-7])  # N/s, N·m/s
_CHECKED = ChecksPart(
    known_weight=KnownWeightPart(
        mass_kg=1.0,
        mass_sigma_kg=0.0001,
        certificate="W-17",
        measured_kg=1.002,
        measured_sigma_kg=0.003,
        outcome="passed",
        created="2026-01-01T13:00:00Z",
    ),
    known_touch=KnownTouchPart(
        point_S_m=[0.0, 0.01, 0.12],
        located_S_m=[0.0, 0.0105, 0.12],
        error_m=0.0005,
        sigma_m=0.0006,
        outcome="passed",
        created=None,
    ),
)


def example_config(
    facets: int = 1_000,
    *,
    rate: float = 1_000.0,
    seed: int = 1,
    verified: bool = True,
    clamped: bool = False,
    down_W: tuple[float, float, float] = DOWN_W,
) -> RuntimeConfig:
    """Make a config of the bundled T-shape; the same arguments give the same bytes."""
    rng = np.random.default_rng(seed)
    truth = GravityModel(
        _leaning(down_W),
        np.array([1.5, -2.0, 0.7]),
        np.array([0.004, -0.002, 0.09]),
        np.array([0.03, 0.05, -0.02]),
    )
    noise = PoseNoise(0.02, 0.0008)
    calibration = calibrate(
        weigh(truth, Rotation.random(12, rng).as_matrix(), noise, rng).poses, noise, down_W=down_W
    )
    if clamped:
        calibration = replace(calibration, drift_rate=_DRIFT, drift_rate_sigma=0.1 * np.abs(_DRIFT))
    vertices, faces = assets.make("t-shape", facets)
    region = assets.contact_region("t-shape", vertices, faces)
    painted = [Region("acoustic face", "#1f77b4")]
    if clamped:
        region = np.where(vertices[faces].mean(axis=1)[:, 2] < _CLAMP_M, 2, region)
        painted.append(Region("clamp", "#ff7f0e", untouchable=True))
    probe = Probe.from_arrays(vertices, faces, region, name="t-shape")
    regions = RegionSet.from_labels(probe.region, painted)
    error = WrenchNoise((0.04, 0.05, 0.06), (0.001, 0.0012, 0.0009))
    return build_config(
        calibration,
        ProbeFile(probe, regions, "S"),
        sensor=SensorPart(model="virtual", serial="V-0001", rate_Hz=rate),
        noise=WrenchNoise(0.05, 0.002),
        filters=Filters(KalmanFilter(rate), LowPass(20.0, rate)),
        gates=Gates(saturation=(200.0, 200.0, 200.0, 8.0, 8.0, 8.0)),
        mount=(1.0, 0.0, 0.0, 0.0),
        limits=LimitsPart(max_force_N=30.0, max_torque_Nm=3.0, max_speed_mps=0.1, max_turn_radps=None),
        controller=controller_of(ControlSettings.for_probe(Foundation(probe), desired_force=5.0)),
        verification=_verification() if verified else None,
        report=b"<!doctype html><title>Verification</title><p>Simulated.</p>\n",
        operator="simulation",
        session=None,
        created=datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC),
        sources=[SourcePart(role="mesh", name="t-shape", sha256="0" * 64)],
        model=TouchModel(0.002, error, 5e-5) if clamped else None,
        measured=clamped,
        zeroed=datetime(2026, 1, 1, 12, tzinfo=UTC) if clamped else None,
        checks=_CHECKED if clamped else NONE_DONE,
        unverified=not verified,
    )


def _leaning(down_W: tuple[float, float, float]) -> NDArray[np.float64]:
    """Return the weight in W, N: nearly along down, for no base is level."""
    turn, _ = Rotation.align_vectors([down_W], [DOWN_W])
    weight: NDArray[np.float64] = turn.apply([0.1, -0.05, -6.2])
    return weight


def _verification() -> VerificationPart:
    return VerificationPart(
        touches=60,
        markers=20,
        mean_error_m=0.0004,
        sd_error_m=0.0002,
        p95_error_m=0.0008,
        max_error_m=0.0011,
        ratio=1.1,
        p99_time_s=2e-5,
        limit_mean_m=0.001,
        limit_max_m=0.002,
        passed=True,
        diagnosis="The errors are what the noise explains.",
    )

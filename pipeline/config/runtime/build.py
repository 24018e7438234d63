"""A runtime config, and its ``planes.csv``, from what the bench knows."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import ValidationError

from contactbench import __version__
from contactbench.pipeline.calibration import Calibration, GravityModel
from contactbench.pipeline.config.consumers import ft_calib_yaml, ros2_yaml, vertical_residual
from contactbench.pipeline.config.runtime.canonical import fault_of
from contactbench.pipeline.config.runtime.check import check_config
from contactbench.pipeline.config.runtime.checks import NONE_DONE, failed_checks
from contactbench.pipeline.config.runtime.config import RuntimeConfig
from contactbench.pipeline.config.runtime.model import (
    SCHEMA,
    VERSION,
    ChecksPart,
    ControllerPart,
    DriftPart,
    LimitsPart,
    MotionPart,
    RuntimeModel,
    SensorPart,
    SourcePart,
    StreamsPart,
    VerificationPart,
    WorldPart,
    ZeroPart,
)
from contactbench.pipeline.config.runtime.pack import FT_CALIB, PLANES, PROBE, REPORT, ROS2
from contactbench.pipeline.config.runtime.self_test import with_self_test
from contactbench.pipeline.config.runtime.values import low_pass_sections, wrench_covariance
from contactbench.pipeline.contact.touch_model import TouchModel, WrenchNoise
from contactbench.pipeline.devices.pose_source import LONGEST_AHEAD_S, LONGEST_GAP_S
from contactbench.pipeline.devices.sample import FROZEN_CHANCE
from contactbench.pipeline.devices.watch import SILENCE_S
from contactbench.pipeline.errors import ConfigError, UnverifiedError, arg, message
from contactbench.pipeline.filtering import KalmanFilter, LowPass
from contactbench.pipeline.gates import Gates
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.sidecar import ProbeFile, encode_probe

_CORNERS = tuple(f"{axis}{corner}" for corner in "123" for axis in "xyz")
COLUMNS = ("index", "nx", "ny", "nz", "d", "region", *_CORNERS)
_MOST_ORDER = 8
_UNITS = {"force": "N", "torque": "N*m", "length": "m", "time": "s", "angle": "rad"}
_FRAMES = {
    "sensor": "S",
    "world": "W",
    "rotation": "R_WS: v_W = R_WS v_S",
    "wrench": message("what the tissue does to the probe, about the origin of S"),
}


@dataclass(frozen=True)
class RobotNames:
    """What a robot description calls the frames S and W, and the sensor itself; for the files of other programs."""

    sensor: str = "ft_sensor"
    world: str = "base_link"
    sensor_name: str | None = None


@dataclass(frozen=True)
class Filters:
    """Of the compensated wrench, and of the contact point; None for none."""

    wrench: KalmanFilter | None
    location: LowPass | None = None
    adaptive: bool = True  # The one of the wrench follows changes; otherwise it is the paper's fixed one


def build_config(
    calibration: Calibration,
    probe_file: ProbeFile,
    *,
    sensor: SensorPart,
    noise: WrenchNoise,
    filters: Filters,
    gates: Gates,
    mount: ArrayLike | None,
    limits: LimitsPart,
    controller: ControllerPart | None,
    verification: VerificationPart | None,
    report: bytes | None,
    operator: str,
    session: str | None,
    created: datetime,
    sources: Sequence[SourcePart],
    model: TouchModel | None = None,
    measured: bool = False,
    zeroed: datetime | None = None,
    follow: bool = False,
    checks: ChecksPart = NONE_DONE,
    stale: Sequence[str] = (),
    names: RobotNames | None = None,
    unverified: bool = False,
) -> RuntimeConfig:
    """
    Put together a runtime config.

    Parameters
    ----------
    calibration : Calibration
    probe_file : ProbeFile
        In S.
    sensor : SensorPart
    noise : WrenchNoise
        Of one reading, without the calibration's share (`extra`), which is added here.
    filters : Filters
    gates : Gates
    mount : (4,) array_like, optional
        Quaternion (w, x, y, z) that turns S into the flange E; None: the controller is given R_WS itself.
    limits : LimitsPart
    controller : ControllerPart, optional
    verification : VerificationPart, optional
    report : bytes, optional
        The verification report, HTML.
    operator : str
    session : str, optional
        Its identity.
    created : datetime
        With a time zone.
    sources : sequence of SourcePart
    model : TouchModel, optional
        Torsion, mesh, and what the wrench's model leaves out.
    measured : bool
        Whether a verification has measured the model error.
    zeroed : datetime, optional
        When the bias was measured, with a time zone; None: nobody knows.
    follow : bool
        Whether the zero follows: a runtime subtracts what it reads in moments without touch.
    checks : ChecksPart
        Of a known weight and a known touch, made with this calibration and probe.
    stale : sequence of str
        Why what this rests on no longer holds, in sentences.
    names : RobotNames, optional
    unverified : bool
        Make it even if nobody has shown that it is right: ``verified`` is then false, the reasons are in
        ``provenance.stale``.

    Raises
    ------
    UnverifiedError
        There are such reasons, and `unverified` is False.
    ConfigError, InputError
        A value is out of its range.
    """
    reasons = (*stale, *reasons_against(calibration, probe_file, verification, checks))
    if reasons and not unverified:
        raise UnverifiedError(reasons)
    files = _files(calibration, probe_file, names or RobotNames(), report)
    content = {
        "schema": SCHEMA,
        "version": VERSION,
        "sensor": sensor,
        "frames": {**_FRAMES, "quaternion_ES": None if mount is None else _floats(mount)},
        "world": WorldPart(down_W=_floats(calibration.down_W)),
        "units": _UNITS,
        "gravity": _gravity(calibration.model),
        "zero": _zero(calibration, zeroed, follow=follow),
        "noise": _noise(noise, filters.wrench, calibration),
        "touch": _touch(model or TouchModel(), measured=measured),
        "streams": StreamsPart(
            pose_gap_s=LONGEST_GAP_S,
            pose_ahead_s=LONGEST_AHEAD_S,
            silence_s=max(SILENCE_S, 2.5 / sensor.rate_Hz),
            frozen_probability=FROZEN_CHANCE,
            motion=MotionPart(window_s=0.15, gyration_m=0.035),
        ),
        "filters": {"wrench": _kalman(filters), "location": _low_pass(filters.location)},
        "gates": gates.stored(),
        "controller": controller,
        "limits": limits,
        "verification": verification,
        "checks": checks,
        "self_test": None,  # needs the config; see below
        "verified": not reasons,
        **_surface(probe_file, gates),
        "provenance": {
            "created": _seconds("created", created),
            "tool": f"contactbench {__version__}",
            "operator": operator,
            "session": session,
            "files": {name: hashlib.sha256(data).hexdigest() for name, data in files.items()},
            "sources": list(sources),
            "stale": list(reasons),
        },
    }
    try:
        checked = RuntimeModel.model_validate(content)
    except ValidationError as error:
        raise ConfigError(f"the config cannot be made: {arg(fault_of(error))}.") from None
    probe = _painted(probe_file)
    check_config(checked, probe, files, message("the config cannot be made"))
    return with_self_test(RuntimeConfig(checked, probe, MappingProxyType(files), probe_file.region_warnings))


def calibration_refused(model: RuntimeModel) -> bool:
    """Tell whether a config, made for trials, has a calibration that must not be used: see `reasons_against`."""
    return any(
        reason.startswith(message("The calibration was refused: ")) for reason in model.provenance.stale
    )


def reasons_against(
    calibration: Calibration,
    probe_file: ProbeFile,
    verification: VerificationPart | None,
    checks: ChecksPart = NONE_DONE,
) -> tuple[str, ...]:
    """Say why a config of these would not be verified; empty if it would."""
    reasons = []
    if calibration.verdict.level == "refuse":
        reasons.append(message(f"The calibration was refused: {arg(calibration.verdict.reasons[0])}")[:1000])
    if probe_file.frame != "S":
        reasons.append(message("The probe is not aligned with the sensor (its frame is P): align it first."))
    health = probe_file.probe.health
    if not (health.watertight and health.outward):
        reasons.append(message("The surface of the probe is open or inside out: prepare it again."))
    if verification is None:
        reasons.append(message("Contacts have not been verified on markers: verify first."))
    elif not verification.passed:
        reasons.append(message(f"The verification failed: {arg(verification.diagnosis)}")[:1000])
    reasons += failed_checks(checks).values()
    return tuple(reasons)


# ---- parts -------------------------------------------------------------------------------------


def _painted(probe_file: ProbeFile) -> Probe:
    regions = probe_file.regions
    return probe_file.probe.with_region(regions.labels, regions.untouchable)


def _files(
    calibration: Calibration, probe_file: ProbeFile, names: RobotNames, report: bytes | None
) -> dict[str, bytes]:
    probe, gravity, down = _painted(probe_file), calibration.model, calibration.down_W
    colours = [region.colour for region in probe_file.regions.regions]
    files = {
        PROBE: encode_probe(probe, colours),
        PLANES: encode_planes(probe),
        ROS2: ros2_yaml(
            gravity,
            sensor_frame=names.sensor,
            world_frame=names.world,
            sensor_name=names.sensor_name,
            down_W=down,
        ).encode("ascii"),
    }
    if vertical_residual(gravity, down).weight > 0:  # force_torque_tools takes no mass of zero
        files[FT_CALIB] = ft_calib_yaml(gravity, com_frame=names.sensor, down_W=down).encode("ascii")
    if report is not None:
        files[REPORT] = report
    return dict(sorted(files.items()))


def _surface(probe_file: ProbeFile, gates: Gates) -> dict[str, Any]:
    probe, regions = probe_file.probe, probe_file.regions
    odds = gates.odds(len(regions.regions), regions.untouchable)
    return {
        "probe": {
            "file": PROBE,
            "name": probe.name,
            "facets": len(probe.faces),
            "vertices": len(probe.vertices),
            "bounds_S_m": probe.bounds.tolist(),
        },
        "regions": [
            {
                "rank": rank,
                "name": region.name,
                "colour": region.colour,
                "facets": len(regions.faces_of(rank)),
                "odds": odds[rank - 1],
                "untouchable": region.untouchable,
            }
            for rank, region in enumerate(regions.regions, 1)
        ],
        "planes": {"file": PLANES, "count": len(probe.faces)},
    }


def _gravity(model: GravityModel) -> dict[str, Any]:
    return {
        "gravity_W_N": model.gravity_W.tolist(),
        "force_bias_N": model.force_bias.tolist(),
        "centre_of_mass_S_m": model.centre_of_mass_S.tolist(),
        "torque_bias_Nm": model.torque_bias.tolist(),
        "covariance": model.covariance.tolist(),
    }


def _zero(calibration: Calibration, zeroed: datetime | None, *, follow: bool) -> ZeroPart:
    drift, rate, sigma = None, calibration.drift_rate, calibration.drift_rate_sigma
    if rate is not None and sigma is not None:
        drift = DriftPart(
            force_Nps=_floats(rate[:3]),
            torque_Nmps=_floats(rate[3:]),
            force_sigma_Nps=_floats(sigma[:3]),
            torque_sigma_Nmps=_floats(sigma[3:]),
        )
    measured = None if zeroed is None else _seconds("zeroed", zeroed)
    return ZeroPart(measured=measured, drift=drift, follow=follow)


def _noise(
    noise: WrenchNoise, wrench_filter: KalmanFilter | None, calibration: Calibration
) -> dict[str, Any]:
    if noise.extra is not None:
        raise ConfigError("noise.extra: the calibration's share is added automatically: leave it out.")
    force, torque = _floats(np.broadcast_to(noise.force, 3)), _floats(np.broadcast_to(noise.torque, 3))
    covariance = wrench_covariance(force, torque, wrench_filter, calibration.model)
    return {
        "force_N": force,
        "torque_Nm": torque,
        "orientation_rad": float(calibration.noise.orientation),
        "wrench_covariance": covariance.tolist(),
    }


def _touch(model: TouchModel, *, measured: bool) -> dict[str, Any]:
    error = model.model_error
    if error.extra is not None:
        raise ConfigError("touch.model_error: a bundle stores no covariance for it: leave extra out.")
    return {
        "torsion_arm_m": float(model.torsion_arm),
        "model_error": {
            "force_N": _floats(np.broadcast_to(error.force, 3)),
            "torque_Nm": _floats(np.broadcast_to(error.torque, 3)),
            "measured": measured,
        },
        "mesh_deviation_m": float(model.mesh_deviation),
        "mesh_curved": model.mesh_curved,
        "torsion": "learned" if model.torsion_learned else "fixed",
        "scene": model.scene,
    }


def _kalman(filters: Filters) -> dict[str, Any] | None:
    wrench_filter = filters.wrench
    if wrench_filter is None:
        return None
    return {
        "kind": "adaptive" if filters.adaptive else "kalman",
        "rate_Hz": wrench_filter.rate,
        "q": wrench_filter.q,
        "r": wrench_filter.r,
        "tuned_rate_Hz": wrench_filter.tuned_rate,
        "per_sample": wrench_filter.per_sample,
    }


def _low_pass(location: LowPass | None) -> dict[str, Any] | None:
    if location is None:
        return None
    if location.order > _MOST_ORDER:
        raise ConfigError(
            f"filters.location.order is {arg(location.order)}: a runtime supports at most {arg(_MOST_ORDER)}."
        )
    return {
        "kind": "lowpass",
        "rate_Hz": location.rate,
        "cutoff_Hz": location.cutoff,
        "order": location.order,
        "sections": low_pass_sections(location.cutoff, location.rate, location.order).tolist(),
    }


def _floats(values: ArrayLike) -> list[float]:
    listed: list[float] = np.asarray(values, dtype=np.float64).tolist()
    return listed


def _seconds(field: str, time: datetime) -> str:
    if time.tzinfo is None:
        raise ConfigError(f"{arg(field)} has no time zone: use datetime.now(UTC).")
    return time.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def encode_planes(probe: Probe) -> bytes:
    """Write the table; the same mesh gives the same bytes, and every number reads back as the same double."""
    order = _order(probe)
    numbers = np.hstack(_parts(probe, order)).tolist()
    lines = [",".join(COLUMNS)]
    for index, region, row in zip(order.tolist(), probe.region[order].tolist(), numbers, strict=True):
        plane, corners = row[:4], row[4:]
        lines.append(f"{index},{','.join(map(repr, plane))},{region},{','.join(map(repr, corners))}")
    return ("\n".join(lines) + "\n").encode("ascii")


def _order(probe: Probe) -> NDArray[np.int64]:
    last = np.iinfo(np.int64).max
    ranks = np.where(probe.region > 0, probe.region.astype(np.int64), last - 1)
    ranks[np.isin(probe.region, probe.untouchable)] = last
    return np.argsort(ranks, kind="stable")


def _parts(probe: Probe, order: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return (m, 4) normals and d, and (m, 9) corners."""
    corners, normals = probe.vertices[probe.faces[order]], probe.normals[order]
    # In a fixed order, for the same bits on every computer.
    middles = (corners[:, 0] + corners[:, 1] + corners[:, 2]) / 3.0
    x, y, z = (normals * middles).T
    d = -(x + z + y)
    return np.column_stack([normals, d]), corners.reshape(-1, 9)

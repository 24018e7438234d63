"""Whether a config can be true: what a schema cannot tell, and physics can."""

from collections.abc import Mapping
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.config.consumers import points_away
from contactbench.pipeline.config.runtime.canonical import first_difference
from contactbench.pipeline.config.runtime.checks import RATE_OFF, failed_checks
from contactbench.pipeline.config.runtime.model import VERSION, LowPassPart, RuntimeModel, VerificationPart
from contactbench.pipeline.config.runtime.pack import PLANES, PROBE
from contactbench.pipeline.config.runtime.self_test import check_self_test
from contactbench.pipeline.config.runtime.values import (
    gravity_of,
    kalman_of,
    low_pass_sections,
    wrench_covariance,
)
from contactbench.pipeline.errors import ConfigError, InputError, arg, message
from contactbench.pipeline.gates import Gates
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.load import MeshFile, settle
from contactbench.pipeline.mesh.ply import read_ply
from contactbench.pipeline.mesh.sidecar import encode_probe

_AGAIN = message("Export the config again.")
_HEAVIEST_N, _LIGHTEST_KG, _HEAVIEST_KG = 1_000.0, 0.02, 50.0
_FARTHEST_M = 2.0
_LARGEST_BIAS_N, _LARGEST_BIAS_NM = 2_000.0, 200.0
_LARGEST_NOISE_N, _LARGEST_NOISE_NM = 100.0, 10.0
_SURE = 3.0  # sigma: what is lighter than this many weighs nothing that anybody could tell
_DOWN_SINCE = 4  # the version from which on somebody has said where down is
_MOST_LEAN = 0.5  # cosine of 60 degrees: bases are mounted in multiples of 90
_SLOWEST = 1e-6  # of the rate: a filter that is slower has no sections that doubles can hold
_UNIT, _SECTIONS, _ROUNDING = 1e-9, 1e-12, 1e-9
_FARTHEST_VERTEX_M = 1_000.0
# Of what was verified: more is another unit.
_LARGEST_ERROR_M = 0.05
_LARGEST_LIMITS = {
    "max_force_N": 1_000.0,
    "max_torque_Nm": 200.0,
    "max_speed_mps": 10.0,
    "max_turn_radps": 50.0,
}


def decode_mesh(data: bytes, model: RuntimeModel, name: str) -> Probe:
    """
    Return the probe, after checking that it is the one that the config describes.

    Raises
    ------
    ConfigError
        It is not, to the byte, a mesh as contactbench writes it, or not the one that the config describes.
    """
    try:
        probe = settle(MeshFile(read_ply(data), None, "m"), None, model.probe.name)
    except (InputError, OverflowError, MemoryError) as error:
        raise ConfigError(f"{arg(name)}: {arg(error)} {arg(_AGAIN)}") from error
    part = model.probe
    found = {
        "facets": (part.facets, len(probe.faces)),
        "vertices": (part.vertices, len(probe.vertices)),
        "bounds_S_m": (part.bounds_S_m, probe.bounds.tolist()),
    }
    for field, (told, true) in found.items():
        if told != true:
            raise ConfigError(
                f"{arg(name)}: probe.{arg(field)} is {arg(told)}, but the mesh has {arg(true)}. {arg(_AGAIN)}"
            )
    _check_regions(model, probe, name)
    wanted = encode_probe(probe, [region.colour for region in model.regions])
    if data != wanted:
        raise ConfigError(
            f"{arg(name)}: byte {arg(first_difference(data, wanted))} differs from what contactbench writes"
            f" for this mesh. {arg(_AGAIN)}"
        )
    if float(np.abs(probe.vertices).max()) > _FARTHEST_VERTEX_M:
        raise ConfigError(
            f"{arg(name)}: a vertex is more than {arg(_FARTHEST_VERTEX_M):g} m from the sensor: check that"
            f" the probe is in metres. {arg(_AGAIN)}"
        )
    return probe


def check_config(
    model: RuntimeModel, probe: Probe, files: Mapping[str, bytes], name: str, *, version: int = VERSION
) -> None:
    """
    Refuse a config that cannot be true, or files that do not agree with it.

    Parameters
    ----------
    model, probe, files, name
        As of a `RuntimeConfig`; what messages call it.
    version : int
        Of the schema, as the config was written.

    Raises
    ------
    ConfigError
        Names the field, its value and the remedy.
    """
    try:
        _check_frames(model)
        _check_gravity(model, version)
        _check_noise(model)
        _check_filters(model)
        _check_controller(model)
        _check_files(model, probe, files)
        _check_touch(model)
        _check_verified(model, probe)
    except ConfigError as error:
        raise ConfigError(f"{arg(name)}: {arg(error)}") from None


def _refuse(field: str, why: str) -> NoReturn:
    raise ConfigError(f"{arg(field)} {arg(why)} {arg(_AGAIN)}")


# ---- parts -------------------------------------------------------------------------------------


def _check_regions(model: RuntimeModel, probe: Probe, name: str) -> None:
    ranks = [region.rank for region in model.regions]
    if ranks != list(range(1, len(ranks) + 1)):
        raise ConfigError(
            f"{arg(name)}: regions have the ranks {arg(ranks[:20])}, not 1, 2, and so on. {arg(_AGAIN)}"
        )
    if int(probe.region.max()) > len(ranks):
        raise ConfigError(
            f"{arg(name)}: a facet has the region {arg(probe.region.max())}, but regions lists"
            f" {arg(len(ranks))}. {arg(_AGAIN)}"
        )
    counts = np.bincount(probe.region, minlength=len(ranks) + 1)
    for region in model.regions:
        if region.facets != counts[region.rank]:
            raise ConfigError(
                f"{arg(name)}: regions.{arg(region.rank - 1)}.facets is {arg(region.facets)}, but the mesh has"
                f" {arg(counts[region.rank])} of that region. {arg(_AGAIN)}"
            )
        if region.odds > 1 if region.untouchable else region.odds < 1:
            raise ConfigError(
                f"{arg(name)}: regions.{arg(region.rank - 1)}.odds is {arg(region.odds):g}, but its untouchable is"
                f" {arg(str(region.untouchable).lower())}. {arg(_AGAIN)}"
            )
    hidden = tuple(region.rank for region in model.regions if region.untouchable)
    if probe.untouchable != hidden:
        raise ConfigError(
            f"{arg(name)}: regions lists {arg(list(hidden))} as untouchable, the mesh lists"
            f" {arg(list(probe.untouchable))}. {arg(_AGAIN)}"
        )
    names = [region.name for region in model.regions]
    if len(set(names)) < len(names):
        raise ConfigError(f"{arg(name)}: two regions have the same name. {arg(_AGAIN)}")


def _check_frames(model: RuntimeModel) -> None:
    quaternion = model.frames.quaternion_ES
    if quaternion is not None and abs(float(np.linalg.norm(quaternion)) - 1) > _UNIT:
        _refuse(
            "frames.quaternion_ES", message(f"has the length {arg(np.linalg.norm(quaternion)):.9g}, not 1.")
        )

    down = model.world.down_W
    if abs(float(np.linalg.norm(down)) - 1) > _UNIT:
        _refuse("world.down_W", message(f"has the length {arg(np.linalg.norm(down)):.9g}, not 1."))


def _check_gravity(model: RuntimeModel, version: int) -> None:
    gravity, part = gravity_of(model), model.gravity
    _check_covariance("gravity.covariance", gravity.covariance)
    weight = float(np.linalg.norm(gravity.gravity_W))
    mass = gravity.mass
    if weight > _HEAVIEST_N or mass > _HEAVIEST_KG:
        _refuse(
            "gravity.gravity_W_N",
            message(
                f"is {arg(mass):.4g} kg, more than {arg(_HEAVIEST_KG):g}: check whether it was given in grams."
            ),
        )
    weighs = mass > 0 and mass > _SURE * gravity.mass_sigma
    if weighs and mass < _LIGHTEST_KG:
        _refuse(
            "gravity.gravity_W_N",
            message(
                f"is {arg(mass):.4g} kg, less than {arg(_LIGHTEST_KG):g}: check whether forces were in kN."
            ),
        )
    down = model.world.down_W
    if points_away(gravity, down):
        _refuse(
            "gravity.gravity_W_N",
            message(f"points up ({arg(-float(gravity.gravity_W @ down)):.4g} N against world.down_W)."),
        )
    if weighs and version >= _DOWN_SINCE and points_away(gravity, down, _MOST_LEAN):
        _refuse(
            "gravity.gravity_W_N",
            message("is more than 60 degrees from world.down_W: check how the robot is mounted."),
        )
    for field, values, most, unit in (
        ("force_bias_N", part.force_bias_N, _LARGEST_BIAS_N, "N"),
        (
            "torque_bias_Nm",
            part.torque_bias_Nm,
            _LARGEST_BIAS_NM,
            message("N*m: check whether they were N*mm."),
        ),
        (
            "centre_of_mass_S_m",
            part.centre_of_mass_S_m,
            _FARTHEST_M,
            message("m: check whether they were mm."),
        ),
    ):
        size = float(np.linalg.norm(values))
        if size > most:
            _refuse(f"gravity.{field}", message(f"is {arg(size):.4g}, more than {arg(most):g} {arg(unit)}"))


def _check_noise(model: RuntimeModel) -> None:
    part = model.noise
    for field, sigmas, most in (
        ("force_N", part.force_N, _LARGEST_NOISE_N),
        ("torque_Nm", part.torque_Nm, _LARGEST_NOISE_NM),
    ):
        if not 0 < min(sigmas) <= max(sigmas) <= most:
            _refuse(
                f"noise.{field}", message(f"is {arg(sigmas)}: it must be above 0 and at most {arg(most):g}.")
            )
    wrench_filter = None if model.filters.wrench is None else kalman_of(model.filters.wrench)
    told = np.array(part.wrench_covariance)
    _check_covariance("noise.wrench_covariance", told)
    true = wrench_covariance(part.force_N, part.torque_Nm, wrench_filter, gravity_of(model))
    deviations = np.sqrt(np.diag(true))
    # Not any larger, rather than some: NaN is refused too.
    if not (np.abs(told - true) <= _ROUNDING * np.outer(deviations, deviations)).all():
        _refuse(
            "noise.wrench_covariance",
            message("does not follow from the noise of a reading, the filter and gravity.covariance."),
        )


def _check_covariance(field: str, C: NDArray[np.float64]) -> None:
    deviations = np.sqrt(np.maximum(np.diag(C), 0.0))
    scale = np.outer(deviations, deviations)
    if (np.diag(C) < 0).any() or (np.abs(C - C.T) > _ROUNDING * scale).any():
        _refuse(field, message("is not symmetric, or has a variance below 0."))
    known = deviations > 0
    if C[~known].any():
        _refuse(field, message("has a covariance where the variance is 0."))
    # As correlations: the units of the rows differ by orders of magnitude.
    with np.errstate(all="ignore"):  # what overflows is refused
        R = C[np.ix_(known, known)] / deviations[known, None] / deviations[known]
    if not (np.abs(R) <= 1 + _ROUNDING).all():
        _refuse(field, message("has a correlation beyond 1."))
    if known.any() and float(np.linalg.eigvalsh(0.5 * (R + R.T))[0]) < -_ROUNDING:
        _refuse(field, message("has a negative eigenvalue."))


def _check_filters(model: RuntimeModel) -> None:
    try:
        Gates.of_stored(model.gates)
    except InputError as error:
        raise ConfigError(f"gates: {arg(error)}. {arg(_AGAIN)}") from None
    if model.filters.location is not None:
        _check_low_pass(model.filters.location)


def _check_low_pass(part: LowPassPart) -> None:
    if not part.cutoff_Hz < part.rate_Hz / 2:
        _refuse(
            "filters.location.cutoff_Hz",
            message(f"is {arg(part.cutoff_Hz):g}, not below half of {arg(part.rate_Hz):g} Hz."),
        )
    if part.cutoff_Hz < _SLOWEST * part.rate_Hz:
        _refuse(
            "filters.location.cutoff_Hz",
            message(f"is {arg(part.cutoff_Hz):g}, too slow for {arg(part.rate_Hz):g} Hz."),
        )
    true = low_pass_sections(part.cutoff_Hz, part.rate_Hz, part.order)
    told = np.array(part.sections)
    if told.shape != true.shape or not (np.abs(told - true) <= _SECTIONS).all():
        _refuse("filters.location.sections", message("do not match cutoff_Hz, order and rate_Hz."))


def _check_controller(model: RuntimeModel) -> None:
    part, most = model.controller, model.limits.max_force_N
    if part is not None and not part.desired_force_N < most:
        _refuse(
            "controller.desired_force_N",
            message(
                f"is {arg(part.desired_force_N):g}, not below limits.max_force_N, which is {arg(most):g}."
            ),
        )


def _check_files(model: RuntimeModel, probe: Probe, files: Mapping[str, bytes]) -> None:
    for field, told, name in (
        ("probe.file", model.probe.file, PROBE),
        ("planes.file", model.planes.file, PLANES),
    ):
        if told != name:
            _refuse(field, message(f"is {arg(told)!r}, not {arg(name)!r}."))
    check_self_test(model, files)
    if model.planes.count != len(probe.faces):
        _refuse(
            "planes.count",
            message(f"is {arg(model.planes.count)}, but {arg(PLANES)} has {arg(len(probe.faces))}."),
        )


def _check_touch(model: RuntimeModel) -> None:
    touch = model.checks.known_touch
    if touch is not None and touch.outcome == "passed" and None in (touch.located_S_m, touch.error_m):
        _refuse("checks.known_touch.outcome", message("is 'passed', but nothing was located."))


def _check_verified(model: RuntimeModel, probe: Probe) -> None:
    if not model.verified:
        return
    if model.verification is None or not model.verification.passed:
        _refuse("verified", message("is true, but verification is missing or did not pass."))
    for kind in failed_checks(model.checks):
        _refuse("verified", message(f"is true, but checks.{arg(kind)} failed."))
    if model.provenance.stale:
        _refuse(
            "verified", message(f"is true, but provenance.stale says: {arg(model.provenance.stale[0]):.200}")
        )
    if not (probe.health.watertight and probe.health.outward):
        _refuse("verified", message("is true, but the surface of the probe is open or inside out."))
    _check_figures(model.verification)
    _check_limits(model)
    rate = model.sensor.rate_Hz
    for field, part in (("wrench", model.filters.wrench), ("location", model.filters.location)):
        if part is not None and not abs(rate / part.rate_Hz - 1) <= RATE_OFF:
            _refuse(
                f"filters.{field}.rate_Hz",
                message(
                    f"is {arg(part.rate_Hz):g}, but the sensor was verified at sensor.rate_Hz, which is {arg(rate):g}."
                ),
            )


def _check_figures(part: VerificationPart) -> None:
    for field in ("touches", "markers"):
        if getattr(part, field) < 1:
            _refuse(f"verification.{field}", message("is 0, but verified is true."))
    for field in ("limit_mean_m", "limit_max_m"):
        if getattr(part, field) > _LARGEST_ERROR_M:
            _refuse(
                f"verification.{field}",
                message(
                    f"is {arg(getattr(part, field)):g}, more than {arg(_LARGEST_ERROR_M):g} m: check whether it was mm."
                ),
            )
    if part.mean_error_m > part.limit_mean_m or part.max_error_m > part.limit_max_m:
        _refuse("verification.passed", message("is true, but an error exceeds its limit."))
    for field in ("mean_error_m", "p95_error_m"):
        if getattr(part, field) > part.max_error_m * (1 + _ROUNDING):
            _refuse(f"verification.{field}", message("is more than verification.max_error_m."))


def _check_limits(model: RuntimeModel) -> None:
    for field, most in _LARGEST_LIMITS.items():
        limit = getattr(model.limits, field)
        if limit is not None and limit > most:
            _refuse(
                f"limits.{field}", message(f"is {arg(limit):g}, more than {arg(most):g}: check the unit.")
            )
    most = model.limits.max_force_N
    for axis, limit in enumerate(model.gates.saturation[:3]):
        if limit is not None and limit < most:
            _refuse(
                f"gates.saturation.{axis}",
                message(
                    f"is {arg(limit):g}: the sensor cannot measure limits.max_force_N, which is {arg(most):g}."
                ),
            )

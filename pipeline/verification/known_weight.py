"""
A known weight on the tool: it shows whether the sensor reads newtons, and the right way up.

No residual of a calibration shows a wrong unit, scale or sign: poses agree with one another in any unit. A weight that
somebody else has measured does.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc

from contactbench.pipeline.calibration import Calibration, PoseSample
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY, cross_matrix, prediction_jacobian
from contactbench.pipeline.calibration.orientation import convention_of
from contactbench.pipeline.calibration.parameters import Parameters, check_roles, sha256_of
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.files import File
from contactbench.pipeline.settings import ORIENTATION_NOISE_DEG, WeightSettings
from contactbench.pipeline.verification.known_check import (
    SCHEMAS,
    VERSION,
    WEIGHT,
    WEIGHT_ROLES,
    CheckOutcome,
    KnownCheck,
    likely,
    load_calibrated,
    or_none,
    swap,
    to_bytes,
    words_of,
)

Floats = NDArray[np.float64]

_GRAVITY_RANGE = (9.70, 9.90)  # m/s²: no place on Earth is outside
_GRAVITY_SIGMA = 0.015  # m/s²: from 9.780 at the equator to 9.832 at the poles, if nobody says where this is
_SURE = 3.0  # standard deviations of an error that is no chance
_EXCLUDED = 2.0  # standard deviations by which an error as large as the limit is ruled out
_LIMIT_OVER_SIGMA = 5.0  # limit over uncertainty: with this an error is nearly always told from none
_TILT = np.radians(5.0)  # the base stands upright, or where `down` says, within this
_CORRELATED = 2.0  # a mean of neighbours that a filter made alike is so much less sure
_INCONSISTENT = 1e-4  # chance of residuals as large
_THERE = 10.0  # standard deviations of a change whose direction means something
_SAME_FACTOR = 0.03
_SEEN = 0.5  # share of the weight that a channel reads
_EXPLAINED = 0.1  # of the weight: another reading of the channels leaves less
_TWIST = 0.01  # m: torque about the line of the weight, over the weight: a swing, a string beside a finger
_OFFSET_N = 0.3  # N: a zero that is further off was moved since the calibration

# What measured over true weight is if ..., and why. The first that fits is told.
_FACTORS = (
    (1 / 9.80665, message("The forces are in kgf (kilograms), not N: multiply them by 9.80665.")),
    (
        9.80665,
        message("The forces were multiplied by 9.81 once too often: they are treated as kgf, but are in N."),
    ),
    (1 / 4.448222, message("The forces are in lbf (pounds), not N: multiply them by 4.448.")),
    (
        4.448222,
        message("The forces were multiplied by 4.448 once too often: they are treated as lbf, but are in N."),
    ),
    (0.45359237, message("The mass was probably given in pounds: give it in kg.")),
    (2.20462262, message("The weight is probably marked in pounds, or two weights hang on the tool.")),
    (1e-3, message("The mass was given in grams instead of kg, or the forces are in kN.")),
    (1e3, message("The forces are in mN, or the mass was given in tonnes: give it in kg.")),
)
_LEVERS = ((1000.0, "N·mm"), (100.0, "N·cm"))
_AXES = "xyz"
_ORIENTATION = float(np.radians(ORIENTATION_NOISE_DEG["robot"]))


class WeightParameters(WeightSettings, Parameters):
    """As the options of ``contactbench calibrate check weight``."""


@dataclass(frozen=True, eq=False)
class WeightCheck(KnownCheck):
    """What a known weight shows."""

    # The weight as the sensor reads it, along gravity, kg; minus: upwards
    measured: float
    measured_sigma: float
    # Measured over true force. Its uncertainty has the weight's own and that of gravity in it.
    scale: float
    scale_sigma: float
    # Angle between the change of force and gravity, rad
    direction: float
    direction_sigma: float
    lever: float  # Distance of the weight's line from the sensor's origin as the torques say, m
    # Force channels that read at least half of the weight somewhere; of the others the check says nothing
    axes: tuple[str, ...]
    offset: float  # |F| without the weight after compensation, N

    def to_json(self) -> dict[str, Any]:
        """Return the figures."""
        return {
            "measured_kg": self.measured,
            "measured_sigma_kg": self.measured_sigma,
            "scale": self.scale,
            "scale_sigma": self.scale_sigma,
            "direction_error_deg": float(np.degrees(self.direction)),
            "direction_sigma_deg": or_none(np.degrees(self.direction_sigma)),
            "lever_mm": 1e3 * self.lever,
            "axes": list(self.axes),
            "offset_N": self.offset,
            **self.said(),
        }


def check_weight(
    calibration: Calibration,
    unloaded: Sequence[PoseSample],
    loaded: Sequence[PoseSample],
    mass: float,
    mass_sigma: float = 0.0,
    *,
    gravity: float | None = None,
    limit: float = 0.01,
    reach: float = 0.5,
    faults: tuple[str, ...] = (),
) -> WeightCheck:
    """
    Compare a known weight with what the sensor reads.

    The readings without the weight give the sensor's zero of today, so that a drift since the calibration does not
    count. Readings at the same orientations with and without it rest on the calibration least.

    Parameters
    ----------
    calibration : Calibration
    unloaded, loaded : sequence of PoseSample
        Still readings without the weight and with it, R_WS and raw; one of each at least.
    mass, mass_sigma : float
        kg; standard uncertainty.
    gravity : float, optional
        Here, m/s²; left out: 9.80665 ± 0.015.
    limit : float
        Largest error of scale that passes, as a share.
    reach : float
        Largest plausible lever, m.
    faults : tuple of str
        Why nothing that rests on this calibration may pass, in sentences.

    Raises
    ------
    InputError
        A number is out of its range, or there are no readings.
    """
    for name, poses in (("unloaded", unloaded), ("loaded", loaded)):
        if not poses:
            raise InputError(
                f"{arg(name)}: there are no still readings: hold the tool still for a few seconds."
            )
    if not (0 < mass < 1000 and 0 <= mass_sigma < mass):
        raise InputError(
            f"mass {arg(mass):g} ± {arg(mass_sigma):g} kg: give a mass above 0 and a smaller uncertainty."
        )
    if gravity is not None and not _GRAVITY_RANGE[0] <= gravity <= _GRAVITY_RANGE[1]:
        raise InputError(
            f"gravity {arg(gravity):g} m/s²: give a value between {arg(_GRAVITY_RANGE[0])} and"
            f" {arg(_GRAVITY_RANGE[1])}."
        )
    g = STANDARD_GRAVITY if gravity is None else gravity
    of_weight = float(np.hypot(mass_sigma / mass, 0.0 if gravity is not None else _GRAVITY_SIGMA / g))
    weighed = _Weighed(calibration, unloaded, loaded, mass * g)
    along = float(weighed.force @ weighed.down)
    noise = float(np.sqrt(weighed.down @ weighed.covariance @ weighed.down))
    scale, noise_share = along / (mass * g), noise / (mass * g)
    sigma = float(np.hypot(noise_share, abs(scale) * of_weight))
    angle, angle_sigma = weighed.direction()
    lever, twist = weighed.lever()
    wrong = [*faults, *weighed.wrong_channels(angle, angle_sigma)]
    error, unsure = abs(scale - 1), ""
    if error + _EXCLUDED * sigma > limit and len(wrong) == len(faults):
        if error > _SURE * sigma:
            wrong.append(weighed.why(scale, sigma, along / noise))
        else:
            unsure = _too_unsure(mass, mass_sigma, noise_share, of_weight, limit, len(loaded))
    wrong += _wrong_torque(lever, twist, reach)
    if wrong:
        outcome, reasons = CheckOutcome.FAILED, wrong
    else:
        outcome = CheckOutcome.UNDECIDED if unsure else CheckOutcome.PASSED
        reasons = [*([unsure] if unsure else []), *weighed.notes()]
    return WeightCheck(
        outcome,
        tuple(reasons),
        words_of(outcome, reasons, _passed(mass, along / g, noise / g, angle)),
        along / g,
        noise / g,
        scale,
        sigma,
        angle,
        angle_sigma,
        lever,
        weighed.axes,
        float(np.linalg.norm(weighed.offset)),
    )


class _Weighed:
    """
    The change of force that the weight makes, from all readings at once.

    A reading is ``offset + R_SW f + error``, the second only with the weight; offset and f are fitted by generalised
    least squares with the noise, the calibration's covariance and errors of the orientation.
    """

    def __init__(
        self,
        calibration: Calibration,
        unloaded: Sequence[PoseSample],
        loaded: Sequence[PoseSample],
        weight: float,
    ) -> None:
        poses = (*unloaded, *loaded)
        model = calibration.model
        self.down = calibration.down_W
        self.model, self.weight = model, weight
        self.R_SW = np.array([pose.R_WS.T for pose in poses])
        self.loads = np.arange(len(poses)) >= len(unloaded)
        readings = np.array([np.concatenate([pose.force, pose.torque]) for pose in poses])
        self.forces = readings[:, :3]
        self.wrenches = readings - np.array([model.predict(pose.R_WS) for pose in poses])
        # (n, 3, 6): of the offset and the weight.
        self.design = np.concatenate(
            [np.broadcast_to(np.eye(3), self.R_SW.shape), self.R_SW * self.loads[:, None, None]], axis=2
        )
        self.V = self._covariance(calibration, poses)
        inverse = np.linalg.inv(self.V)
        A = self.design.reshape(-1, 6)
        C = np.linalg.inv(A.T @ inverse @ A)
        y = self.wrenches[:, :3].ravel()
        x = C @ A.T @ inverse @ y
        self.offset, self.force, self.covariance = x[:3], x[3:], C[3:, 3:]
        left = y - A @ x
        self.chi_square, self.freedom = float(left @ inverse @ left), len(y) - 6

    def _covariance(self, calibration: Calibration, poses: Sequence[PoseSample]) -> Floats:
        """Return that of all forces (3 n, 3 n), N²."""
        n, model = len(poses), self.model
        J = prediction_jacobian(self.R_SW, model.vector)[:, :3].reshape(3 * n, 12)
        V = J @ model.covariance @ J.T
        orientation = calibration.noise.orientation or _ORIENTATION
        factor = calibration.noise_factor[0]
        for row, pose in enumerate(poses):
            # The calibration's noise has in it what averaging leaves; a short reading may be worse than that.
            own = factor * calibration.noise.sigmas[:3]
            if pose.force_sd is not None:
                own = np.maximum(own, _CORRELATED * pose.force_sd / np.sqrt(pose.count))
            load = self.R_SW[row] @ (model.gravity_W + self.loads[row] * self.weight * self.down)
            turned = orientation * cross_matrix(load)
            V[3 * row : 3 * row + 3, 3 * row : 3 * row + 3] += np.diag(own**2) + turned @ turned.T
        return V + 1e-12 * np.eye(3 * n)

    @property
    def axes(self) -> tuple[str, ...]:
        """Channels that read the weight, or half of it."""
        share = np.abs(self.R_SW[self.loads] @ self.down).max(axis=0)
        return tuple(axis for axis, part in zip(_AXES, share, strict=True) if part >= _SEEN)

    def direction(self) -> tuple[float, float]:
        """Return the angle between the change and gravity, and its 1 sigma, rad."""
        size = float(np.linalg.norm(self.force))
        if size < 1e-9:
            return 0.0, float("inf")
        cosine = float(np.clip(self.force @ self.down / size, -1, 1))
        across = np.eye(3) - np.outer(self.down, self.down)
        sigma = float(np.sqrt(np.linalg.eigvalsh(across @ self.covariance @ across)[-1]))
        return float(np.arccos(cosine)), sigma / size

    def wrong_channels(self, angle: float, sigma: float) -> Iterator[str]:
        """Say it if the change is not along gravity, or not the same in all poses; upwards is told by the sign."""
        aside = angle > _TILT + _SURE * sigma and angle < np.pi - _TILT - _SURE * sigma
        if aside and np.linalg.norm(self.force) > _THERE * np.sqrt(np.trace(self.covariance)):
            yield message(
                f"The force changes in a direction {arg(np.degrees(angle)):.0f}° away from straight"
                f" down. {arg(self._sideways())}"
            )
        elif self.freedom > 0 and chdtrc(self.freedom, self.chi_square) < _INCONSISTENT:
            times = np.sqrt(self.chi_square / self.freedom)
            yield message(
                f"The readings differ between poses by {arg(times):.1f} times what noise and"
                " calibration explain: something swung, touched the tool or slipped, or the force"
                " channels have different scales."
            )

    def _sideways(self) -> str:
        """Say which channels are exchanged or negated, if that explains the change."""
        changes = {}
        for a, b in ((0, 1), (1, 2), (0, 2)):
            changes[message(f"the channels f{arg(_AXES[a])} and f{arg(_AXES[b])} are swapped")] = swap(a, b)
        for axis, signs in zip(_AXES, 1 - 2 * np.eye(3), strict=True):
            changes[message(f"the channel f{arg(axis)} has the wrong sign")] = np.diag(signs)
        loads = self.model.gravity_W + self.loads[:, None] * self.weight * self.down
        expected = np.einsum("nij,nj->ni", self.R_SW, loads) + self.model.force_bias
        fitting = []
        for words, T in changes.items():  # each undoes itself
            left = self.forces @ T - expected
            left -= left.mean(axis=0)  # the offset
            if float(np.sqrt((left**2).sum() / self.loads.sum())) < _EXPLAINED * self.weight:
                fitting.append(words)
        if not fitting:
            return message("The orientations or the mount are wrong, or something else pulled on the tool.")
        return likely(fitting)

    def lever(self) -> tuple[float, float]:
        """Return the distance of the weight's line from the origin, and its torque about that line over its size, m."""
        force = self.R_SW @ self.force
        torque = self.wrenches[:, 3:]
        zero = torque[~self.loads].mean(axis=0)
        size = max(float(np.linalg.norm(self.force)), 1e-9)
        unit = force[self.loads] / size
        change = torque[self.loads] - zero
        twist = np.einsum("nk,nk->n", change, unit)
        across = change - twist[:, None] * unit
        return (float(np.linalg.norm(across, axis=1).max()) / size, float(np.abs(twist).max()) / size)

    def why(self, scale: float, sigma: float, significance: float) -> str:
        """Say how far the weight is off, and the likely cause."""
        if abs(significance) < _SURE:
            return message(
                "The readings do not show the weight: it was not on the tool, it rested on"
                " something, or the readings with and without it are the same."
            )
        size, sign = abs(scale), self._sign(scale)
        for factor, cause in _FACTORS:
            if abs(size / factor - 1) < _SAME_FACTOR:
                return message(
                    f"The sensor reads {arg(size):.4g} times the weight. {arg(cause)} {arg(sign)}"
                ).strip()
        if sign:
            return message(f"The sensor reads {arg(size):.4g} times the weight, upwards. {arg(sign)}")
        off, unsure = f"{100 * abs(scale - 1):.1f}", f"{100 * sigma:.1f}"
        first = message(f"The sensor reads {arg(off)} ± {arg(unsure)} % too much.")
        if scale < 1:
            first = message(f"The sensor reads {arg(off)} ± {arg(unsure)} % too little.")
        return message(
            f"{arg(first)} Check that the weight hangs freely, and that the sensor's own calibration"
            " and range are correct. If they are, multiply its forces and torques by"
            f" {arg(1 / scale):.4f}."
        )

    def _sign(self, scale: float) -> str:
        if scale >= 0:
            return ""
        if self.model.gravity_W @ self.down > 0:  # the tool's own weight points down
            return message(
                "The readings with and without the weight are probably swapped: the tool's own"
                " weight points down."
            )
        return message(
            "The forces have the wrong sign, or the world's z axis points down: give the direction of down."
        )

    def notes(self) -> Iterator[str]:
        """Say what else is worth knowing."""
        if untested := [f"f{axis}" for axis in _AXES if axis not in self.axes]:
            yield message(
                f"The weight hardly loaded {arg(', '.join(untested))}: tilt the tool and repeat to check that too."
            )
        size = float(np.linalg.norm(self.offset))
        if size > _OFFSET_N:
            yield message(
                f"Without the weight the sensor reads {arg(size):.2g} N after compensation: its zero"
                " moved since the calibration, or something touched the tool. Recalibrate."
            )


def _wrong_torque(lever: float, twist: float, reach: float) -> Iterator[str]:
    if lever > reach:
        cause = message("Check the unit of the torques.")
        if units := [unit for factor, unit in _LEVERS if 0.001 <= lever / factor <= reach]:
            cause = message(f"The torques are probably in {arg(' / '.join(units))}, not N·m.")
        far = message(
            f"By the torques, the weight hangs {arg(lever):.3g} m from the sensor, beyond {arg(1e3 * reach):g} mm."
        )
        yield message(f"{arg(far)} {arg(cause)}")
    elif twist > _TWIST + 0.05 * lever:
        yield message(
            "A hanging weight makes no torque about its own line, but the sensor reads"
            f" {arg(1e3 * twist):.0f} mm times its force. Torque channels are swapped, one has the"
            " wrong sign, or the weight was held."
        )


def _passed(mass: float, measured: float, sigma: float, angle: float) -> str:
    return message(
        f"The sensor reads {arg(measured):.4g} ± {arg(sigma):.2g} kg for a weight of {arg(mass):.4g} kg,"
        f" {arg(np.degrees(angle)):.1f}° from straight down: unit, sign and scale of the forces are"
        " correct."
    )


def _too_unsure(
    mass: float, mass_sigma: float, noise: float, of_weight: float, limit: float, readings: int
) -> str:
    """Say what would make the uncertainty small enough; shares of the weight."""
    aim = limit / _LIMIT_OVER_SIGMA
    sigma = float(np.hypot(noise, of_weight))
    start = message(
        f"The uncertainty is {arg(100 * sigma):.2g} % of the weight; detecting an error of"
        f" {arg(100 * limit):.2g} % takes {arg(100 * aim):.2g} %."
    )
    own = mass_sigma / mass
    if own >= 0.9 * aim:
        return message(f"{arg(start)} Use a weight known to better than {arg(100 * own):.2g} %.")
    if of_weight >= 0.9 * aim:
        return message(f"{arg(start)} Give the local gravity, or allow a larger limit.")
    times = noise / float(np.sqrt(aim**2 - of_weight**2))
    heavier, more = mass * times, int(np.ceil(times**2)) * max(1, readings // 2)
    return message(
        f"{arg(start)} Use a weight of {arg(heavier):.2g} kg or more, hold still for longer, or take"
        f" {arg(more)} readings with and without the weight."
    )


# ---- from files ----------------------------------------------------------------------------------


def known_weight(
    inputs: Mapping[str, File], parameters: Mapping[str, Any], created: str | None
) -> dict[str, bytes]:
    """
    Check ``calibration`` with readings ``unloaded`` and ``loaded``: what a session keeps, and the command writes.

    Raises
    ------
    InputError
        An input or a parameter cannot be used.
    """
    given = WeightParameters.checked(parameters)
    return {given.name: to_bytes(weight_content(inputs, given, created))}


def weight_content(
    inputs: Mapping[str, File], given: WeightParameters, created: str | None
) -> dict[str, Any]:
    """Return all that the file of a check says; arguments and errors as for `known_weight`."""
    from contactbench.pipeline.calibration.files.capture_file import read_any_poses

    check_roles(inputs, WEIGHT_ROLES)
    calibration, R_ES, faults = load_calibrated(inputs["calibration"], given.R_ES)
    tables = [read_any_poses(inputs[role], convention_of(given), R_ES=R_ES) for role in WEIGHT_ROLES[1:]]
    unloaded, loaded = (table.poses for table in tables)
    found = check_weight(
        calibration,
        unloaded,
        loaded,
        given.mass,
        given.mass_sigma,
        gravity=given.gravity,
        limit=given.limit / 100,
        reach=given.reach / 1000,
        faults=faults,
    )
    return {
        "schema": SCHEMAS[WEIGHT],
        "version": VERSION,
        "mass_kg": given.mass,
        "mass_sigma_kg": given.mass_sigma,
        "certificate": given.certificate,
        "gravity_m_s2": STANDARD_GRAVITY if given.gravity is None else given.gravity,
        **found.to_json(),
        "limit_percent": given.limit,
        "readings": {"unloaded": len(unloaded), "loaded": len(loaded)},
        "warnings": [sentence for table in tables for sentence in table.warnings],
        "created": created,
        "calibration_sha256": sha256_of(inputs["calibration"]),
        "sources": {role: sha256_of(inputs[role]) for role in WEIGHT_ROLES[1:]},
    }

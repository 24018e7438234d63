"""
A press on a known point: it shows whether contacts are located where they are.

One point off the sensor's axis tells a wrong sign or unit of the torques, and a probe that is turned on the sensor,
before anything rests on a located contact.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.orientation import convention_of
from contactbench.pipeline.calibration.parameters import Parameters, check_roles, sha256_of
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.knobs import Three
from contactbench.pipeline.settings import TouchSettings
from contactbench.pipeline.verification.known_check import (
    SCHEMAS,
    TOUCH,
    TOUCH_ROLES,
    VERSION,
    CheckOutcome,
    KnownCheck,
    likely,
    load_calibrated,
    or_none,
    swap,
    to_bytes,
    words_of,
)
from contactbench.pipeline.verification.markers import TouchLocator, make_markers, with_normals
from contactbench.pipeline.verification.protocol import ProtocolSettings, measured_noise
from contactbench.pipeline.verification.verify import find_touches

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.calibration import GravityModel
    from contactbench.pipeline.files import File
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.verification.protocol import Touch
    from contactbench.pipeline.verification.source import TouchRecording

    Floats = NDArray[np.float64]

_POINT = message("the point")
# A finger trembles and gives way; what counts is where it pressed, not how steadily.
PROTOCOL = ProtocolSettings(windows=((3.0, 60.0),), order=(_POINT,), steady_N=1.0, slip_m=0.005)
_EXCLUDED = 2.0  # standard deviations beyond the limit of an error that is no chance
_INWARD = np.cos(np.radians(75.0))  # of -F along the normal: less is no press
_MOST_TORSION = 0.01  # m: torque of a finger about its line of force, over the force
_NEAR_BEST = 0.002  # m: causes that explain it about as well
_MOST_CAUSES = 3


@dataclass(frozen=True)
class Mistake:
    """A way in which wrenches can be wrong: what to say, and T (6, 6) that makes right ones of them."""

    words: str
    T: Floats


def _mistakes() -> Iterator[Mistake]:
    """Yield the mistakes that a touch can show, the usual ones first."""
    for force, torque, words in (
        (1, -1, message("the torques have the wrong sign")),
        (-1, -1, message("all channels have the wrong sign: the sensor reports the force on its other side")),
        (-1, 1, message("the forces have the wrong sign")),
        (1, 1e-3, message("the torques are in N·mm, not N·m")),
        (1, 1e-2, message("the torques are in N·cm, not N·m")),
        (9.80665, 1, message("the forces are in kgf, not N")),
        (4.448222, 1, message("the forces are in lbf, not N")),
        (1, 1e3, message("the torques are in kN·m, or were divided by 1000 once too often")),
        (1, 0.112985, message("the torques are in lbf·in, not N·m")),
        (1, 1.355818, message("the torques are in lbf·ft, not N·m")),
        (1, 9.80665, message("the torques are in kgf·m, not N·m")),
        (1, 9.80665e-2, message("the torques are in kgf·cm, not N·m")),
        (4.448222, 0.112985, message("forces and torques are in lbf and lbf·in, not N and N·m")),
        (9.80665, 9.80665e-3, message("forces and torques are in kgf and kgf·mm, not N and N·m")),
    ):
        yield Mistake(words, np.diag(np.repeat([float(force), torque], 3)))
    for turn in (90, 180, -90):
        R = Rotation.from_euler("z", -turn, degrees=True).as_matrix()
        words = message(
            f"the probe's mesh is turned by {arg(turn)}° about the sensor's z axis, or the sensor on its mount"
        )
        yield Mistake(words, _both(R))
    for axis in "xy":
        R = Rotation.from_euler(axis, 180, degrees=True).as_matrix()
        yield Mistake(
            message(f"the probe's mesh is turned by 180° about the sensor's {arg(axis)} axis"), _both(R)
        )
    for row in range(6):
        signs = np.ones(6)
        signs[row] = -1
        yield Mistake(
            message(f"the channel {arg('fm'[row // 3])}{arg('xyz'[row % 3])} has the wrong sign"),
            np.diag(signs),
        )
    for a, b in ((0, 1), (1, 2), (0, 2)):
        P = swap(a, b)
        one, other = "xyz"[a], "xyz"[b]
        yield Mistake(message(f"the channels of {arg(one)} and {arg(other)} are swapped"), _both(P))
        torques = np.eye(6)
        torques[3:, 3:] = P
        yield Mistake(message(f"the torque channels of {arg(one)} and {arg(other)} are swapped"), torques)


def _both(T: Floats) -> Floats:
    """Return what does the same (3, 3) to forces and torques."""
    both = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = T
    return both


MISTAKES = tuple(_mistakes())
# The mistakes without which nothing located may be trusted: a touch that cannot tell them does not pass.
_MUST_SHOW = MISTAKES[:4]


class TouchParameters(TouchSettings, Parameters):
    """As the options of ``contactbench calibrate check touch``."""

    point: Three  # That was pressed, mm, S: the coordinates of the prepared probe


@dataclass(frozen=True, eq=False)
class TouchCheck(KnownCheck):
    """What a press on a known point shows; lengths in m."""

    point: Floats  # (3,) that was pressed, S
    # (3,) where the contact was found, S, mean over the presses; None: nowhere on the probe
    located: Floats | None
    # Distance of the two; its 1 sigma by noise, calibration and how well the point is hit
    error: float | None
    sigma: float
    missed_by: float  # Distance of the point from the line of force
    lever: float  # Of that line from the sensor's origin: how much the touch says of the torques
    force: float  # Mean |F|, N
    presses: int

    def to_json(self) -> dict[str, Any]:
        """Return the figures."""
        return {
            "point_S_m": self.point.tolist(),
            "located_S_m": None if self.located is None else self.located.tolist(),
            "error_m": self.error,
            "sigma_m": or_none(self.sigma),
            "missed_by_m": self.missed_by,
            "lever_m": self.lever,
            "force_N": self.force,
            "presses": self.presses,
            **self.said(),
        }


def check_touch(
    probe: Probe,
    model: GravityModel,
    point: ArrayLike,
    recording: TouchRecording,
    *,
    point_sigma: float = 0.002,
    limit: float = 0.005,
    faults: tuple[str, ...] = (),
) -> TouchCheck:
    """
    Locate presses on one known point, and compare.

    Parameters
    ----------
    probe : Probe
        S.
    model : GravityModel
    point : (3,)
        On the probe, S, m. Every settled press of the recording is taken to be of it.
    recording : TouchRecording
        Raw.
    point_sigma : float
        How well the point is hit, 1 sigma, m.
    limit : float
        Largest error that passes, m.
    faults : tuple of str
        Why nothing that rests on this calibration may pass, in sentences.

    Raises
    ------
    MarkerError
        The point is off the probe.
    InputError
        Nothing settled touches the probe.
    """
    if not (0 <= point_sigma < 1 and 0 < limit < 1):
        raise InputError(
            f"limit {arg(limit):g} m, point {arg(point_sigma):g} m: give lengths between 0 and 1 m."
        )
    marker, _ = with_normals(make_markers(np.asarray(point, dtype=np.float64)[None], [_POINT]), probe)
    compensated = recording.compensated(model)
    noise, correlation, _ = measured_noise(compensated, PROTOCOL, None)
    placing = TouchLocator(probe, marker, model, noise, PROTOCOL.samples, correlation)
    touches = [touch for touch in find_touches(compensated, placing, PROTOCOL) if touch.span is not None]
    if not touches:
        most = float(np.linalg.norm(compensated.wrenches[:, :3], axis=1).max(initial=0.0))
        raise InputError(
            f"No steady press: |F| reaches {arg(most):.1f} N. Press with 5 to 15 N for a second, then let go. If the"
            " press was harder, the forces are not in N: check them with a known weight."
        )
    return _judged(touches, compensated, placing, point_sigma, limit, faults)


def _judged(
    touches: list[Touch],
    compensated: TouchRecording,
    placing: TouchLocator,
    point_sigma: float,
    limit: float,
    faults: tuple[str, ...],
) -> TouchCheck:
    (marker,) = placing.markers
    wrenches = np.array([_mean(touch, compensated) for touch in touches])
    presses = _Presses(wrenches, marker.point_S, marker.normal_S)
    points = [_located(*each, placing) for each in zip(touches, wrenches, strict=True)]
    known = [each for each in points if each is not None]
    located = np.mean(known, axis=0) if len(known) == len(points) else None
    error = None if located is None else float(np.linalg.norm(located - marker.point_S))
    spread = [np.trace(touch.located.covariance) for touch in touches if touch.located is not None]
    sigma = float(np.sqrt((np.mean(spread) if spread else 0.0) + point_sigma**2))
    allowed = limit + _EXCLUDED * sigma
    reasons, outcome = [], CheckOutcome.PASSED
    if error is None or error > allowed:
        outcome = CheckOutcome.FAILED
        reasons = [_where(error, sigma), presses.cause(allowed)]
    elif error > limit or sigma > limit / _EXCLUDED:
        outcome = CheckOutcome.UNDECIDED
        what = message(
            f"Press harder with something thin, and hit the point to within {arg(500 * limit):.1f} mm."
        )
        reasons = [_where(error, sigma), what]
    elif any(presses.would_hide(each, allowed) for each in _MUST_SHOW):
        outcome = CheckOutcome.UNDECIDED
        near = message(
            f"The line of force passes only {arg(1e3 * presses.lever):.0f} mm from the sensor's"
            " origin, so a wrong sign or unit of the torques would not show."
        )
        aside = message(
            f"Press a point on the side of the probe, at least {arg(3e3 * limit):.0f} mm from the sensor's axis."
        )
        reasons = [near, aside]
    if faults:
        outcome, reasons = CheckOutcome.FAILED, [*faults, *reasons]
    passed = message(
        f"The press was located {arg(1e3 * (error or 0.0)):.1f} ± {arg(1e3 * sigma):.1f} mm from the known"
        " point: signs and units are correct."
    )
    return TouchCheck(
        outcome,
        tuple(reasons),
        words_of(outcome, reasons, passed),
        marker.point_S,
        located,
        error,
        sigma,
        presses.missed_by(),
        presses.lever,
        float(np.linalg.norm(wrenches[:, :3], axis=1).mean()),
        len(touches),
    )


class _Presses:
    """Mean wrenches (n, 6) of presses on one point, and how well they fit it."""

    def __init__(self, wrenches: Floats, point: Floats, normal: Floats) -> None:
        self.wrenches, self._point, self._normal = wrenches, point, normal

    @property
    def lever(self) -> float:
        """Mean distance of the lines of force from the sensor's origin, m."""
        return float(_misses(self.wrenches, np.zeros(3))[0].mean())

    def missed_by(self) -> float:
        """Return the mean distance of the lines of force from the point, m."""
        return float(_misses(self.wrenches, self._point)[0].mean())

    def _fit(self, wrenches: Floats) -> float:
        """Return by how far they miss the point at most, m; infinite: they pull, or twist more than a finger."""
        missed, twist = _misses(wrenches, self._point)
        inward = -(wrenches[:, :3] @ self._normal) / np.linalg.norm(wrenches[:, :3], axis=1)
        if (inward < _INWARD).any() or (twist > _MOST_TORSION).any():
            return float("inf")
        return float(missed.max())

    def would_hide(self, mistake: Mistake, allowed: float) -> bool:
        """Tell whether a mistake in these wrenches, if they are right, would go unnoticed."""
        return self._fit(self.wrenches @ np.linalg.inv(mistake.T).T) <= allowed

    def cause(self, allowed: float) -> str:
        """Say which mistakes explain that the point was missed."""
        if self._fit(self.wrenches) <= allowed:
            return message(
                "The line of force passes through the point, but no contact was found there."
                " Check the mesh at this point, and that nothing else touched the probe."
            )
        fits = [self._fit(self.wrenches @ each.T.T) for each in MISTAKES]
        best = min(fits)
        if best > allowed:
            return message(
                "No common mistake explains it. Check that the right point was pressed, that"
                " nothing else touched the probe, and how the mesh is aligned with the sensor."
            )
        # Among causes that fit about as well the usual ones come first.
        fitting = [each.words for each, fit in zip(MISTAKES, fits, strict=True) if fit <= best + _NEAR_BEST]
        return likely(fitting[:_MOST_CAUSES])


def _misses(wrenches: Floats, point: Floats) -> tuple[Floats, Floats]:
    """Return the distance of lines of force from a point, and the torque about the lines over the force, m."""
    forces = wrenches[:, :3]
    size = np.linalg.norm(forces, axis=1)
    unit = forces / size[:, None]
    torque = wrenches[:, 3:] - np.cross(point, forces)
    along = np.einsum("nk,nk->n", torque, unit)
    across = np.linalg.norm(torque - along[:, None] * unit, axis=1)
    return across / size, np.abs(along) / size


def _mean(touch: Touch, recording: TouchRecording) -> Floats:
    begin, end = touch.span or (touch.start, touch.time)
    taken = (recording.times >= begin) & (recording.times <= end)
    mean: Floats = recording.wrenches[taken].mean(axis=0)
    return mean


def _located(touch: Touch, wrench: Floats, placing: TouchLocator) -> Floats | None:
    """Return where a press was found; where its line meets the probe twice, the place near the point."""
    contact = placing.solver.locate(wrench, placing.markers.points[0])
    if contact.point is not None and contact.accepted:
        return np.array(contact.point)
    return None if touch.located is None else touch.located.point


def _where(error: float | None, sigma: float) -> str:
    if error is None:
        return message("No single touch on the probe explains the press.")
    return message(
        f"The press was located {arg(1e3 * error):.1f} ± {arg(1e3 * sigma):.1f} mm from the known point."
    )


# ---- from files ----------------------------------------------------------------------------------


def known_touch(
    inputs: Mapping[str, File], parameters: Mapping[str, Any], created: str | None
) -> dict[str, bytes]:
    """
    Check ``calibration`` and ``probe`` with a recording ``touch``: what a session keeps, and the command writes.

    Raises
    ------
    InputError
        An input or a parameter cannot be used.
    """
    given = TouchParameters.checked(parameters)
    return {given.name: to_bytes(touch_content(inputs, given, created))}


def touch_content(inputs: Mapping[str, File], given: TouchParameters, created: str | None) -> dict[str, Any]:
    """Return all that the file of a check says; arguments and errors as for `known_touch`."""
    from contactbench.pipeline.verification.result import load_surface
    from contactbench.pipeline.verification.source import read_touch_recording

    check_roles(inputs, TOUCH_ROLES)
    calibration, R_ES, faults = load_calibrated(inputs["calibration"], given.R_ES)
    probe = load_surface(inputs["probe"])
    recording = read_touch_recording(inputs["touch"], convention_of(given), R_ES)
    found = check_touch(
        probe,
        calibration.model,
        np.array(given.point) / 1e3,
        recording,
        point_sigma=given.point_sigma / 1e3,
        limit=given.limit / 1e3,
        faults=faults,
    )
    return {
        "schema": SCHEMAS[TOUCH],
        "version": VERSION,
        **found.to_json(),
        "limit_m": given.limit / 1e3,
        "warnings": list(recording.warnings),
        "created": created,
        "calibration_sha256": sha256_of(inputs["calibration"]),
        "probe_sha256": sha256_of(inputs["probe"]),
        "sources": {"touch": sha256_of(inputs["touch"])},
    }

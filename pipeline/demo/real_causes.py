"""What really makes the contacts of a real bench wrong, cause by cause: the truth that a diagnosis is judged by."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.calibration.fit import two_stage
from contactbench.pipeline.calibration.poses import stack
from contactbench.pipeline.simulation.reality.bench import RealBench
from contactbench.pipeline.simulation.reality.presses import VERIFIED_S
from contactbench.pipeline.simulation.virtual.markers import markers
from contactbench.pipeline.verification.causes import across, sensitivities
from contactbench.pipeline.verification.figures import ErrorCause

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.reality import Reality
    from contactbench.pipeline.simulation.loads import LoadedSensor
    from contactbench.pipeline.simulation.reality.bench import RealTape, RealTouch
    from contactbench.pipeline.simulation.reality.presses import MarkedPresses
    from contactbench.pipeline.verification.figures import ModelError

    Array = NDArray[np.float64]

_RATE_HZ = 20.0  # without noise a few readings tell all

# The effects that each cause names.
EFFECTS: dict[ErrorCause, tuple[str, ...]] = {
    ErrorCause.GRAVITY: ("cable", "drag", "warming"),
    ErrorCause.SENSOR: ("hysteresis", "hysteresis_of_load", "creep", "crosstalk", "hand"),
    ErrorCause.MOUNT: ("mount",),
    ErrorCause.ALIGNMENT: ("seat", "bend"),
    ErrorCause.MESH: ("lens", "scale"),
    ErrorCause.MARKERS: ("markers", "tip"),
    ErrorCause.TORSION: ("patch", "lean", "twist", "second"),
}


@dataclass(frozen=True)
class TrueCauses:
    """Mean squares of the errors that each cause alone makes on touches of markers, mm²."""

    squares: dict[ErrorCause, float]

    @property
    def first(self) -> ErrorCause:
        """The largest."""
        return max(self.squares, key=lambda cause: self.squares[cause])

    @property
    def share(self) -> float:
        """What the largest has of all."""
        return self.squares[self.first] / max(sum(self.squares.values()), 1e-12)


def true_causes(
    name: str,
    reality: Reality,
    seed: int,
    loaded: LoadedSensor,
    planned: Array,
    pressed: MarkedPresses,
    noise: Array,
    told: Array | None = None,
) -> TrueCauses:
    """
    Repeat weighing and presses with the effects of one cause after the other, without noise.

    Parameters
    ----------
    planned : (k, 3, 3)
        R_WS of the poses to calibrate with.
    noise : (6, 6)
        Covariance of the mean wrench of a touch by the sensor's noise alone.
    told : (4, 4), optional
        Where an alignment has put the probe, against where it was said to sit.
    """
    squares = dict.fromkeys((*EFFECTS, ErrorCause.NOISE), 0.0)
    for cause, effects in EFFECTS.items():
        alone = reality.only(*effects)
        if not alone.on:
            continue
        bench = RealBench(name, alone, seed, loaded, rate=_RATE_HZ, noise=False)
        # Without noise there is nothing to weigh or to doubt: least squares do.
        theta = two_stage(stack(bench.weigh(planned).poses()))
        model = GravityModel.from_vector(theta, np.zeros((12, 12)))
        bench.warm()
        bench.time = VERIFIED_S
        tape = bench.press(pressed.on(bench), pressed.R_WS)
        places = markers(name)
        if told is not None and cause is ErrorCause.ALIGNMENT:
            places = places @ told[:3, :3].T + told[:3, 3]
        errors = along_surface(tape, tape.compensated(model), places[np.asarray(pressed.markers) - 1])
        squares[cause] = 1e6 * float((errors**2).sum(axis=1).mean())
    ideal = RealBench(name, type(reality)(), seed, loaded)
    J = _across(pressed.on(ideal))
    squares[ErrorCause.NOISE] = 1e6 * float(np.einsum("nij,jk,nik->n", J, noise, J).mean())
    return TrueCauses(squares)


def true_floor(tape: RealTape, wrenches: Array, noise: Array) -> float:
    """
    Return what the wrenches (n, 6) of touches are off beyond noise, as an error of the contact, rms, m.

    Parameters
    ----------
    wrenches : (n, 6)
        Compensated means.
    noise : (6, 6)
        Their covariance by the sensor's noise alone.
    """
    J = _across(tape.touches)
    off = wrenches - np.array([touch.contact for touch in tape.touches])
    square = (np.einsum("nij,nj->ni", J, off) ** 2).sum(axis=1).mean()
    return float(np.sqrt(max(square - np.einsum("nij,jk,nik->n", J, noise, J).mean(), 0.0)))


def floor_ratio(told: Sequence[float | None], true: Sequence[float]) -> float:
    """Return the told floors over the true ones, rms of all days with both; NaN where noise alone is to be found."""
    pairs = np.array([pair for pair in zip(told, true, strict=True) if pair[0] is not None], float).reshape(
        -1, 2
    )
    pairs = pairs[np.isfinite(pairs).all(axis=1)]
    if not pairs[:, 1].any():
        return float("nan")
    return float(np.sqrt(np.mean(pairs[:, 0] ** 2) / np.mean(pairs[:, 1] ** 2)))


def told_floor(tape: RealTape, found: ModelError) -> float:
    """Return what verification says of the same, as likely too large as too small, m."""
    sigma = np.repeat([found.likely_force_N, found.likely_torque_Nm], 3)
    return float(np.sqrt(((_across(tape.touches) * sigma) ** 2).sum(axis=(1, 2)).mean()))


def along_surface(tape: RealTape, wrenches: Array, places: Array) -> Array:
    """Return how far wrenches (n, 6) of touches put their contacts from places (n, 3), along the surface, (n, 2), m."""
    F, M = wrenches[:, :3], wrenches[:, 3:]
    return np.asarray((_across(tape.touches)[:, :, 3:] @ (M - np.cross(places, F))[:, :, None])[:, :, 0])


def _across(touches: Sequence[RealTouch]) -> Array:
    """Return (n, 2, 6) how contacts move along the surface with their wrenches, m/N and m/(N·m)."""
    points = np.array([touch.point for touch in touches])
    normals = np.array([touch.normal for touch in touches])
    forces = np.array([touch.contact[:3] for touch in touches])
    return across(normals) @ sensitivities(points, normals, forces)

"""
Gains by a rule: the highest that leave wanted margins on all tissue from soft to stiff.

Each loop - force, turn about x, turn about y - is the discrete-time one of `margins`: averaged readings, the period's
delay, the servo's cubic, the admittance and, if the variant has it, what leads. Its gain is halved or raised until on
none of five stiffnesses less than the wanted gain and phase margin is left, or until it is as fast as is of use: noise
grows with the gain, and no margin shows that.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.control.margins import AXES, Axis, Margins, loop_of, margins
from contactbench.pipeline.control.settings import (
    USUAL_GAIN,
    ControlSettings,
    Variant,
    controller_of,
    limits_of,
)
from contactbench.pipeline.errors import InputError, arg, message

if TYPE_CHECKING:
    from contactbench.pipeline.control.settings import Foundation

_SLOWEST, _STEPS = 0.2, 12
_SLOWER = (1.0, 0.8, 0.65, 0.5, 0.4, 0.3)  # shares of the usual bandwidth of what leads
_USED = 5  # stiffnesses for which margins are asked


@dataclass(frozen=True)
class WantedMargins:
    """
    What gains must leave.

    Raises
    ------
    InputError
        A number is out of range.
    """

    gain: float = 2.0  # factor by which a loop may still grow
    phase: float = math.radians(30)  # rad
    spread: float = 5.0  # tissue may be this many times softer or stiffer
    fastest: float = 8.0  # 1/s: no gain above it is chosen

    def __post_init__(self) -> None:
        if not (1 < self.gain <= 100 and 0 < self.phase < math.pi / 2):
            raise InputError(
                f"tuning: gain margin {arg(self.gain):g}, phase margin {arg(math.degrees(self.phase)):g}"
                " degrees: give 1 to 100, and 0 to 90."
            )
        if not (1 <= self.spread <= 20 and _SLOWEST < self.fastest <= 50):
            raise InputError(
                f"tuning: spread {arg(self.spread):g}, fastest {arg(self.fastest):g}/s: give 1 to 20, and up to 50."
            )

    def kept(self, found: Margins) -> bool:
        """Tell whether margins are large enough."""
        return found.stable and found.gain >= self.gain and found.phase >= self.phase


@dataclass(frozen=True)
class MarginRow:
    """The margins of one loop on tissue of one modulus (N/m³) and stiffness at the wanted force (N/m)."""

    modulus: float
    stiffness: float
    axis: Axis
    margins: Margins


@dataclass(frozen=True)
class Tuned:
    """Gains that were chosen."""

    settings: ControlSettings
    modulus: float  # that they were chosen for, N/m³
    wanted: WantedMargins
    reached: dict[str, str]  # for each loop, what stopped its gain


def tune(
    foundation: Foundation,
    modulus: float,
    *,
    variant: Variant = Variant.AWARE,
    wanted: WantedMargins | None = None,
    desired_force: float = 7.0,
    servo_lag: float = 0.0,
) -> Tuned:
    """
    Choose the gains.

    Parameters
    ----------
    foundation : Foundation
        Of the probe.
    modulus : float
        Of the usual tissue, N/m³; see `Foundation.modulus_of`.
    variant : Variant
        The aware one measures the stiffness by a press before it tracks; the plain one has to do with any.
    desired_force : float
        N.
    servo_lag : float
        How late the arm is, s.

    Raises
    ------
    InputError
        A number is out of range, or even the slowest loop leaves too little.
    """
    wanted = wanted or WantedMargins()
    base = replace(ControlSettings(), variant=variant, servo_lag=servo_lag)
    search = _Search(foundation, modulus, wanted, desired_force, base)
    for axis in AXES:
        search.choose(axis)
    return Tuned(search.settings(), modulus, wanted, search.reached)


class _Search:
    """The loops one after the other: they do not touch each other."""

    def __init__(
        self,
        foundation: Foundation,
        modulus: float,
        wanted: WantedMargins,
        force: float,
        base: ControlSettings,
    ) -> None:
        self._foundation, self._modulus, self._wanted, self._force = foundation, modulus, wanted, force
        self._base = base
        self._gains = dict.fromkeys(AXES, _SLOWEST)
        self._bandwidths = dict(zip(AXES, base.bandwidth, strict=True))
        self.reached: dict[str, str] = {}

    def settings(self) -> ControlSettings:
        """Return those of the gains so far."""
        force, x, y = (self._gains[axis] for axis in AXES)
        made = ControlSettings.for_probe(
            self._foundation,
            desired_force=self._force,
            modulus=self._modulus,
            force_gain=force,
            angle_gains=(x, y),
        )
        place, about_x, about_y = (self._bandwidths[axis] for axis in AXES)
        base = self._base
        return replace(
            made,
            variant=base.variant,
            servo_lag=base.servo_lag,
            bandwidth=(place, about_x, about_y),
        )

    def choose(self, axis: Axis) -> None:
        """Find the gain of a loop; what leads in it becomes slower first, if it leaves too little by itself."""
        usual, fastest = self._bandwidths[axis], self._wanted.fastest
        for share in _SLOWER:
            self._bandwidths[axis] = share * usual
            if self._left(axis, min(USUAL_GAIN, fastest)):
                break
            if self._base.variant is Variant.PLAIN:
                break
        gain = self._highest(axis)
        self._gains[axis] = gain
        slower = (
            ""
            if self._bandwidths[axis] == usual
            else message(f", lead slowed to {arg(self._bandwidths[axis]):.3g}/s")
        )
        self.reached[axis] = (
            message("as fast as is useful") if gain == fastest else message("the margins")
        ) + slower

    def _left(self, axis: Axis, gain: float) -> bool:
        self._gains[axis] = gain
        tried = self.settings()
        moduli = spread_of(self._modulus, self._wanted.spread)
        return all(
            self._wanted.kept(margins(loop_of(tried, self._foundation, each, axis))) for each in moduli
        )

    def _highest(self, axis: Axis) -> float:
        """Return the highest gain that leaves enough, by halving the interval in its logarithm."""
        low, high = _SLOWEST, self._wanted.fastest
        if self._left(axis, high):
            return high
        if not self._left(axis, low):
            raise InputError(
                f"tuning: {arg(axis)}: even a gain of {arg(low):g}/s leaves less than the wanted margins:"
                " lower the margins or the spread of stiffness."
            )
        for _ in range(_STEPS):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if self._left(axis, middle) else (low, middle)
        return low


def spread_of(modulus: float, spread: float, count: int = _USED) -> list[float]:
    """Return moduli from so many times softer to stiffer, evenly in their logarithm, N/m³."""
    return [float(each) for each in modulus * np.geomspace(1 / spread, spread, count)]


def rows_of(tuned: Tuned, foundation: Foundation, count: int = 9) -> list[MarginRow]:
    """Return the margins of all loops against the stiffness of the tissue."""
    force = tuned.settings.desired_force
    return [
        MarginRow(
            modulus,
            foundation.at(force, modulus).stiffness,
            axis,
            margins(loop_of(tuned.settings, foundation, modulus, axis)),
        )
        for modulus in spread_of(tuned.modulus, tuned.wanted.spread, count)
        for axis in AXES
    ]


def settings_content(settings: ControlSettings) -> dict[str, Any]:
    """Return what ``bundle export --settings`` takes: the parts ``controller`` and ``limits``."""
    return {
        "controller": controller_of(settings).model_dump(),
        "limits": limits_of(settings).model_dump(),
    }

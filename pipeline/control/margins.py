"""How far the loops are from swinging: gain and phase margin against the stiffness of the tissue.

Gains by a rule: the highest that leave wanted margins on all tissue from soft to stiff.

Each loop - force, turn about x, turn about y - is the discrete-time one of `margins`: averaged readings, the period's
delay, the servo's cubic, the admittance and, if the variant has it, what leads. Its gain is halved or raised until on
none of five stiffnesses less than the wanted gain and phase margin is left, or until it is as fast as is of use: noise
grows with the gain, and no margin shows that.
"""

import math
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.config.runtime.config import RuntimeConfig
from contactbench.pipeline.control.inverse import Admittance
from contactbench.pipeline.control.settings import (
    LEFT,
    TO_TIP_M,
    TOOL_KG,
    USUAL_GAIN,
    USUAL_MODULUS,
    ControlSettings,
    Foundation,
    Variant,
    calm_on,
    controller_of,
    for_tool,
    limits_of,
    settings_of,
)
from contactbench.pipeline.control.surface import Follower
from contactbench.pipeline.errors import InputError, arg, message

Axis = Literal["force", "about x", "about y"]
AXES: tuple[Axis, ...] = ("force", "about x", "about y")
_READINGS = 4  # in a period
_STEPS = 300  # of an impulse response: 6 s at 50 Hz
_MOST = 1e3


@dataclass(frozen=True)
class LoopModel:
    """One loop, in the path that it controls: m along the axis, or rad about one."""

    gain: float  # 1/s: speed per path that is missing, in the steady state
    settling: float  # mass over damping, s
    spring: float = 0.0  # stiffness over damping, 1/s
    # what is sensed over what there is: true over assumed stiffness, or gain of the place
    ratio: float = 1.0
    bandwidth: float = 0.0  # 1/s, of the estimate that is led by; 0: nothing leads
    smoothing: float = 0.0  # s, of what is led by; 0: none
    # s²: path that is sensed too little for each unit of acceleration: the share of the tool's inertia that
    # was not taken off
    inertia: float = 0.0
    lag: float = 0.0  # how late the arm is, s
    servo: float = math.inf  # rad/s, with which the arm goes along its set-points
    period: float = 0.02  # s


@dataclass(frozen=True)
class Margins:
    """What a loop has left."""

    stable: bool
    # factor by which the loop may grow before it swings; below 1: it swings, and must shrink by that much
    gain: float
    phase: float  # rad, smallest at a frequency where the loop's gain is 1; 0 if it swings
    crossover: float  # rad/s, the largest such frequency


def loop_of(
    settings: ControlSettings,
    foundation: Foundation,
    modulus: float,
    axis: Axis,
    *,
    assumed: float | None = None,
    unknown: float = LEFT,
    tool: tuple[float, float] = (TOOL_KG, TO_TIP_M),
) -> LoopModel:
    """
    Return a loop of a controller on tissue.

    Parameters
    ----------
    foundation : Foundation
        Of the probe.
    modulus : float
        Of the tissue, N/m³.
    assumed : float, optional
        What the aware variant takes the modulus to be; left out, it has measured it. The plain one does not ask.
    unknown : float
        Share of the tool's inertia that compensation misses; negative: that it takes off too much.
    tool : (mass, lever)
        kg, and from its centre of mass to the tip, m.

    Raises
    ------
    InputError
        A number is out of range.
    """
    if not (0 < modulus < math.inf and -1 <= unknown <= 1):
        raise InputError(
            f"margins: modulus {arg(modulus)} N/m³, unknown {arg(unknown)}: give a positive one, and -1 to 1."
        )
    force = settings.desired_force
    true = foundation.at(force, modulus)
    told = foundation.at(force, assumed or modulus)
    aware, (mass_kg, lever_m), calm = settings.variant is Variant.AWARE, tool, 1.0
    if axis == "force":
        mass, damping, spring = settings.force_mass, settings.force_damping, settings.force_stiffness
        real, believed = true.stiffness, told.stiffness
        wanted, bandwidth = settings.force_gain, settings.bandwidth[0]
        drive, smoothing, felt, calm = 1.0, 0.0, unknown * mass_kg / real, calm_on(believed, mass_kg)
    else:
        which = AXES.index(axis) - 1
        damping = settings.angle_damping[which]
        mass = damping * settings.settling if aware else settings.angle_inertia[which]
        spring = settings.angle_stiffness[which]
        real, believed = ((each.gain_y, each.gain_x)[which] for each in (true, told))
        wanted, bandwidth = settings.angle_gains[which], settings.bandwidth[1 + which]
        drive, smoothing = force, settings.smoothing
        lever = lever_m if aware else lever_m**2 / real  # by the lean of the force, or by the place
        felt = unknown * mass_kg * lever / force
    common = LoopModel(
        gain=drive * real / damping,
        settling=mass / damping,
        spring=spring / damping,
        inertia=felt,
        lag=settings.servo_lag,
        period=settings.period,
    )
    if not aware:
        return common
    # What is sensed is divided by what is assumed: the gain is the wanted one times what was assumed wrongly. The tilt
    # comes mostly from the lean of the force, which no modulus spoils; the place would be the worst case.
    led = {"bandwidth": calm * bandwidth, "smoothing": smoothing}
    return replace(common, gain=calm * wanted, ratio=real / believed, **led)


def margins(loop: LoopModel) -> Margins:
    """
    Return the margins of a loop, from its discrete-time response L(exp(i w T)).

    The servo goes through its set-points by cubics, the sensor's readings of a period are averaged, and the controller
    is the one that runs: its impulse responses are taken from `Admittance` and `Follower` themselves. It is stable if
    1 + L turns by +90° from w = 0 to the Nyquist frequency: L has one pole at z = 1, the others inside.
    """
    w = np.concatenate([np.geomspace(0.05, 5.0, 100), np.linspace(5.0, math.pi / loop.period, 500)[1:]])
    L = response(loop, w)
    if not _stable(L):
        least = _limit(L, 1.0 / _MOST, 1.0)
        return Margins(stable=False, gain=least, phase=0.0, crossover=_crossover(w, L)[0])
    last, phase = _crossover(w, L)
    return Margins(stable=True, gain=_limit(L, 1.0, _MOST), phase=phase, crossover=last)


def response(loop: LoopModel, w: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return L at angular frequencies (n,), rad/s."""
    T = loop.period
    late = np.exp(-1j * w * T)  # z^-1
    # The set-point that a speed leads to is reached at the next step, by cubics whose speed at each set-point is the
    # mean speed towards it; the mean of the readings on the way:
    u = np.arange(1, _READINGS + 1) / _READINGS
    fresh, old = float(np.mean(2 * u**2 - u**3)), float(np.mean(u - 2 * u**2 + u**3))
    place = late**2 / (1 - late)  # where the arm was a period ago, in speeds times T
    sensed = T * (place + old * late**2 + fresh * late)
    steps = loop.lag / T
    whole, part = int(steps), steps - int(steps)
    # Speed is fed forward in the servo, which is critically damped.
    slow = 1j * w / loop.servo
    behind = late**whole * (1 - part + part * late) * (1 + 2 * slow) / (1 + slow) ** 2
    sensed = sensed * behind
    felt = loop.inertia * (late - late**2) / T * behind
    push, led = _controller(loop, w)
    L = (push + led) * loop.ratio * (sensed + felt)
    if loop.bandwidth:
        # The estimate adds where the probe was at the mean time of the readings, from where the joints were.
        mean = 1 - float(np.mean(u))
        L = L - led * T * (place + (1 - mean) * late) * behind
    return np.asarray(L)


def _controller(
    loop: LoopModel, w: NDArray[np.float64]
) -> tuple[NDArray[np.complex128], NDArray[np.complex128] | float]:
    """Return speed per path that is missing, and speed that is led by per path that is seen, at w."""
    T = loop.period
    pull = Admittance(loop.settling / loop.gain, 1.0 / loop.gain, loop.spring / loop.gain)
    pulse = np.zeros(_STEPS)
    pulse[0] = 1.0
    waves = np.exp(-1j * T * np.outer(w, np.arange(_STEPS)))
    push = waves @ np.array([pull.step(each, T) for each in pulse])
    if not loop.bandwidth:
        return push, 0.0
    follower = Follower([loop.bandwidth])
    follower.update(np.zeros(1), T)
    ahead = T * (0.5 - 0.5 / _READINGS) + T / 2 + loop.lag + loop.smoothing
    share = 1.0 if loop.smoothing == 0 else 1 - math.exp(-T / loop.smoothing)
    speed, speeds = 0.0, []
    for each in pulse:
        follower.update(np.array([each]), T)
        speed += share * (float(follower.speed(ahead)[0]) - speed)
        speeds.append(speed)
    return push, waves @ np.array(speeds)


def _stable(L: NDArray[np.complex128]) -> bool:
    turned = np.unwrap(np.angle(1 + L))
    # It begins at -90° less what it has turned until the lowest frequency, and ends on the real axis.
    return bool(abs((turned[-1] - turned[0]) - math.pi / 2) < 1.0)


def _limit(L: NDArray[np.complex128], low: float, high: float) -> float:
    """Return the factor between two at which a loop begins to swing; the far one, if it does not."""
    stable_at_low = _stable(low * L)
    if stable_at_low == _stable(high * L):
        return high if stable_at_low else low
    for _ in range(40):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if _stable(middle * L) == stable_at_low else (low, middle)
    return math.sqrt(low * high)


def _crossover(w: NDArray[np.float64], L: NDArray[np.complex128]) -> tuple[float, float]:
    """Return the largest frequency where |L| is 1, and the smallest distance from -1 in phase there."""
    size = np.abs(L)
    there = np.flatnonzero((size[:-1] - 1) * (size[1:] - 1) <= 0)
    if not len(there):
        return 0.0, math.pi
    phase = math.pi - np.abs(np.angle(L[there]))
    return float(w[there[-1]]), float(phase.min())


# ---- gains by a rule: the highest that leave wanted margins on all tissue from soft to stiff -----


_SLOWEST, _HALVINGS = 0.2, 12
_ARM_SERVO = 60.0  # rad/s, usual for a light arm: no bundle says it
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


_LEAST = WantedMargins(gain=1.5, phase=math.radians(20))  # of gains that somebody chose


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

    Raises
    ------
    InputError
        A number is out of range, or even the slowest loop leaves too little.
    """
    wanted = wanted or WantedMargins()
    search = _Search(foundation, modulus, wanted, desired_force, variant)
    for axis in AXES:
        search.choose(axis)
    return Tuned(search.settings(), modulus, wanted, search.reached)


class _Search:
    """The loops one after the other: they do not touch each other."""

    def __init__(
        self, foundation: Foundation, modulus: float, wanted: WantedMargins, force: float, variant: Variant
    ) -> None:
        self._foundation, self._modulus, self._wanted, self._force = foundation, modulus, wanted, force
        self._variant = variant
        self._gains = dict.fromkeys(AXES, _SLOWEST)
        self._bandwidths = dict(zip(AXES, ControlSettings.bandwidth, strict=True))
        self.reached: dict[str, str] = {}

    def settings(self) -> ControlSettings:
        """Return those of the gains so far."""
        force, x, y = (self._gains[axis] for axis in AXES)
        given = {"desired_force": self._force, "modulus": self._modulus}
        made = ControlSettings.for_probe(self._foundation, **given, force_gain=force, angle_gains=(x, y))
        place, about_x, about_y = (self._bandwidths[axis] for axis in AXES)
        return replace(made, variant=self._variant, bandwidth=(place, about_x, about_y))

    def choose(self, axis: Axis) -> None:
        """Find the gain of a loop; what leads in it becomes slower first, if it leaves too little by itself."""
        usual, fastest = self._bandwidths[axis], self._wanted.fastest
        for share in _SLOWER if self._variant is Variant.AWARE else ():
            self._bandwidths[axis] = share * usual
            if self._left(axis, min(USUAL_GAIN, fastest)):
                break
        self._gains[axis] = gain = self._highest(axis)
        self.reached[axis] = message("as fast as is useful") if gain == fastest else message("the margins")
        if self._bandwidths[axis] != usual:
            self.reached[axis] += message(f", lead slowed to {arg(self._bandwidths[axis]):.3g}/s")

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
        for _ in range(_HALVINGS):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if self._left(axis, middle) else (low, middle)
        return low


def spread_of(modulus: float, spread: float, count: int = _USED) -> list[float]:
    """Return moduli from so many times softer to stiffer, evenly in their logarithm, N/m³."""
    return [float(each) for each in modulus * np.geomspace(1 / spread, spread, count)]


def rows_of(tuned: Tuned, foundation: Foundation, count: int = 9) -> list[MarginRow]:
    """Return the margins of all loops against the stiffness of the tissue."""
    s, force = tuned.settings, tuned.settings.desired_force
    return [
        MarginRow(
            each, foundation.at(force, each).stiffness, axis, margins(loop_of(s, foundation, each, axis))
        )
        for each in spread_of(tuned.modulus, tuned.wanted.spread, count)
        for axis in AXES
    ]


def weak_loops(config: RuntimeConfig, settings: ControlSettings | None = None) -> list[tuple[str, Margins]]:
    """
    Say which loops of a bundle leave too little on an arm, with the remedy and with the least that each leaves.

    On tissue five times softer to stiffer than usual, with the arm's servo and delays and the bundle's tool.

    Parameters
    ----------
    settings : ControlSettings, optional
        In place of the bundle's controller; a bundle without one has no loops.
    """
    if settings is None and config.model.controller is None:
        return []
    settings = settings or settings_of(config.model.controller, config.model.limits)
    foundation, gravity = Foundation(config.probe), config.gravity
    tool = float(gravity.mass), foundation.height - float(gravity.centre_of_mass_S[2])
    settings, weak = for_tool(settings, *tool), []
    for axis in AXES:
        found = []
        for modulus in spread_of(USUAL_MODULUS, _LEAST.spread):
            loop = loop_of(settings, foundation, modulus, axis, tool=tool)
            left = margins(replace(loop, servo=_ARM_SERVO))
            found.append((min(left.gain / _LEAST.gain, left.phase / _LEAST.phase), modulus, left))
        share, modulus, left = min(found, key=lambda each: each[0])
        if share < 1:
            stiffness = foundation.at(settings.desired_force, modulus).stiffness
            said = message(
                f"Controller, {arg(axis)}: on tissue of {arg(stiffness):.0f} N/m an arm leaves a gain margin of"
                f" {arg(left.gain):.2g} and a phase margin of {arg(math.degrees(left.phase)):.0f} degrees: choose"
                " lower gains, such as those of control tune."
            )
            weak.append((said, left))
    return weak


def settings_content(settings: ControlSettings) -> dict[str, Any]:
    """Return what ``bundle export --settings`` takes: the parts ``controller`` and ``limits``."""
    return {"controller": controller_of(settings).model_dump(), "limits": limits_of(settings).model_dump()}

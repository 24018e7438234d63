"""What a real force/torque sensor makes of a true wrench: noise, bias, drift, crosstalk, hysteresis, steps, range."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import InputError, arg

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from contactbench.pipeline.mesh.arrays import Floats, Mask
    from contactbench.pipeline.reality import Reality

_ZERO = np.zeros(6)
_HIGHEST_RATE = 1000.0
_FULL_SCALE = np.repeat([300.0, 12.0], 3)  # of a sensor without a limit, N and N·m
_SLOPE = 0.1  # share of a change that the loop takes on until it is as wide as it gets
_CREEP_S = 60.0


def _six(force: float, torque: float) -> Floats:
    return np.array([force] * 3 + [torque] * 3)


@dataclass(frozen=True, eq=False)
class SensorSettings:
    """A sensor's figures; every array (6,) is Fx Fy Fz Mx My Mz in S, N and N·m about the sensor's origin."""

    # (6,) standard deviation of one reading; white and Gaussian
    noise: Floats = field(default_factory=lambda: _ZERO.copy())
    # (6,) what it reads without load, at `reference` temperature
    bias: Floats = field(default_factory=lambda: _ZERO.copy())
    # (6, 6) the true wrench times this is what the elements feel; the identity for a perfect one
    crosstalk: Floats = field(default_factory=lambda: np.eye(6))
    # (6,) how the bias moves, per kelvin
    drift: Floats = field(default_factory=lambda: _ZERO.copy())
    # (kelvin, seconds) how much warmer it gets than where it stands, and the time constant
    warm_up: tuple[float, float] = (0.0, 600.0)
    # (6,) step of the readings; 0 for none
    resolution: Floats = field(default_factory=lambda: _ZERO.copy())
    # (6,) largest reading of either sign; a larger one is given as this, and marked
    limit: Floats = field(default_factory=lambda: np.full(6, np.inf))
    # (6,) width of the loop between loading and unloading, N and N·m
    hysteresis: Floats = field(default_factory=lambda: _ZERO.copy())
    hysteresis_of_load: float = 0.0  # the same, as a share of the largest load since it was re-zeroed
    creep: float = 0.0  # share of a load that is read in addition after minutes; time constant one minute
    rate: float = 200.0  # readings a second, up to 1000 Hz
    # temperature of the room, °C, which is also the temperature that `bias` belongs to
    ambient: float = 22.0

    def __post_init__(self) -> None:
        for name in ("noise", "bias", "drift", "resolution", "limit", "hysteresis"):
            value = np.array(getattr(self, name), dtype=np.float64)
            finite = np.isfinite(value).all() or (name == "limit" and not np.isnan(value).any())
            if value.shape != (6,) or not finite:
                raise InputError(f"sensor model: {arg(name)}: give six finite numbers, not {arg(value)}.")
            if name in ("noise", "resolution", "limit", "hysteresis") and (value < 0).any():
                raise InputError(f"sensor model: {arg(name)}: give numbers of 0 or more, not {arg(value)}.")
            object.__setattr__(self, name, value)
        crosstalk = np.array(self.crosstalk, dtype=np.float64)
        if crosstalk.shape != (6, 6) or not np.isfinite(crosstalk).all():
            raise InputError("sensor model: crosstalk: give six rows of six finite numbers.")
        object.__setattr__(self, "crosstalk", crosstalk)
        if not (0 <= self.hysteresis_of_load <= 1 and 0 <= self.creep <= 1):
            raise InputError(
                f"sensor model: hysteresis of load {arg(self.hysteresis_of_load)}, creep {arg(self.creep)}:"
                " give shares from 0 to 1."
            )
        if not 0 < self.rate <= _HIGHEST_RATE:
            raise InputError(
                f"sensor model: rate {arg(self.rate):g} Hz: give one above 0, up to {arg(_HIGHEST_RATE):g}."
            )
        if not (np.isfinite(self.warm_up).all() and self.warm_up[1] > 0 and np.isfinite(self.ambient)):
            raise InputError(
                f"sensor model: warm-up {arg(self.warm_up)}: give kelvin and a positive time, s."
            )

    def at(self, rate: float) -> SensorSettings:
        """Return the same sensor read at another rate, Hz."""
        return replace(self, rate=rate)

    def silent(self) -> SensorSettings:
        """Return the same sensor without noise and without steps."""
        return replace(self, noise=_ZERO, resolution=_ZERO)

    def with_(self, reality: Reality, rng: np.random.Generator) -> SensorSettings:
        """
        Return the same sensor with what a real bench adds; warmth is no part of it: see `SensorModel.warm`.

        Parameters
        ----------
        rng : numpy.random.Generator
            Of the signs of the crosstalk: two sensors of a kind do not have the same.
        """
        signs = np.where(rng.random((6, 6)) < 0.5, -1.0, 1.0)
        skewed = np.eye(6) + signs * (_skewed(reality.crosstalk / 100) - np.eye(6))
        return replace(
            self,
            crosstalk=skewed @ self.crosstalk,
            hysteresis=self.hysteresis
            + reality.hysteresis / 100 * np.where(np.isfinite(self.limit), self.limit, _FULL_SCALE),
            hysteresis_of_load=self.hysteresis_of_load + reality.hysteresis_of_load / 100,
            creep=self.creep + reality.creep / 100,
        )


def _skewed(share: float) -> Floats:
    """Return crosstalk of a share of full scale; fixed, so that every run sees the same sensor."""
    pattern = np.array([np.sin(1.0 + k) for k in range(36)]).reshape(6, 6)
    np.fill_diagonal(pattern, 0.0)
    scale = _six(1.0, 0.05)  # N·m that go with 1 N: a lever of 50 mm
    return np.eye(6) + share * pattern * np.outer(scale, 1.0 / scale)


# The paper gives no noise. At 1 N it found the contact with an SD of 1.4 mm after its Kalman filter: 7.4 mm before
# it, which is 0.05 N and 1.4 N·mm on a lever of 100 mm.
PRESETS: dict[str, SensorSettings] = {
    "ideal": SensorSettings(),
    "paper": SensorSettings(
        noise=_six(0.05, 0.0014),
        bias=np.array([1.8, -2.6, 4.1, 0.06, -0.04, 0.02]),
        drift=np.array([0.01, -0.008, 0.03, 2e-4, -3e-4, 1e-4]),
        warm_up=(4.0, 900.0),
        resolution=_six(0.01, 0.0002),
        limit=_six(300.0, 12.0),
    ),
    "noisy": SensorSettings(
        noise=_six(0.2, 0.006),
        bias=np.array([6.0, -9.5, 14.0, 0.25, -0.18, 0.12]),
        crosstalk=_skewed(0.005),
        drift=np.array([0.05, -0.04, 0.12, 8e-4, -1.2e-3, 5e-4]),
        warm_up=(10.0, 600.0),
        resolution=_six(0.05, 0.001),
        limit=_six(150.0, 6.0),
    ),
}


def preset(name: str) -> SensorSettings:
    """
    Return a preset.

    Raises
    ------
    InputError
        There is none of that name.
    """
    if name not in PRESETS:
        raise InputError(f"sensor model {arg(name)!r}: choose one of {arg(', '.join(PRESETS))}.")
    return PRESETS[name]


@dataclass(frozen=True, eq=False)
class SensorReadings:
    """What the sensor gave."""

    wrenches: Floats  # (n, 6) S, N and N·m
    saturated: Mask  # (n,) bool Whether a channel is at its limit
    temperatures: Floats  # (n,) °C


class SensorModel:
    """
    One sensor from the moment it was switched on.

    Parameters
    ----------
    seed : int or numpy.random.Generator
        Of the noise: the same one gives the same readings.
    """

    def __init__(self, settings: SensorSettings, seed: int | np.random.Generator = 0) -> None:
        self.settings = settings
        self._rng = np.random.default_rng(seed)
        self._offset = settings.bias.copy()
        self._heat: list[tuple[float, float]] = [(0.0, settings.warm_up[0])]
        self._loop = _Loop(settings)

    @property
    def bias(self) -> Floats:
        """What it reads without load at the room's temperature, (6,); changes when it is re-zeroed."""
        return self._offset.copy()

    def temperature(self, times: ArrayLike) -> Floats:
        """Return its temperature, °C, at times (n,) since it was switched on, s."""
        at = np.atleast_1d(np.asarray(times, dtype=np.float64))
        risen = np.zeros(len(at))
        for since, kelvin in self._heat:
            risen += np.where(
                at > since, kelvin * -np.expm1(-np.maximum(at - since, 0) / self.settings.warm_up[1]), 0
            )
        return self.settings.ambient + risen

    def warm(self, kelvin: float, time: float) -> None:
        """Let what it stands on get warmer by this, from a time on; it follows with its own time constant."""
        self._heat.append((time, kelvin))

    def rezero(self, wrench: ArrayLike, time: float) -> None:
        """Make what it reads now its zero, as somebody does at the device: the true wrench (6,), and when."""
        drift = self.settings.drift * (self.temperature(time)[0] - self.settings.ambient)
        felt = self.settings.crosstalk @ np.asarray(wrench, dtype=np.float64)
        self._offset = -felt - drift - self._loop.left
        self._loop.most = np.abs(felt)

    def read(self, times: ArrayLike, wrenches: ArrayLike) -> SensorReadings:
        """
        Read true wrenches.

        Parameters
        ----------
        times : (n,)
            s since it was switched on.
        wrenches : (n, 6)
            Contact, weight and inertia, S.
        """
        true = np.atleast_2d(np.asarray(wrenches, dtype=np.float64))
        settings = self.settings
        temperatures = self.temperature(times)
        given = self._loop.read(times, true @ settings.crosstalk.T) + self._offset
        given += np.outer(temperatures - settings.ambient, settings.drift)
        given += settings.noise * self._rng.standard_normal(true.shape)
        stepped = settings.resolution > 0
        given[:, stepped] = (
            np.round(given[:, stepped] / settings.resolution[stepped]) * settings.resolution[stepped]
        )
        saturated: Mask = np.any(np.abs(given) >= settings.limit, axis=1)
        return SensorReadings(np.clip(given, -settings.limit, settings.limit), saturated, temperatures)


class _Loop:
    """
    What the elements remember: hysteresis and creep.

    Hysteresis is a stop operator (Visintin 1994): z <- clip(z + 0.1 dx, -h, h) is taken off the load, so that a channel
    reads 2 h more on the way down than on the way up. Creep is c' = (creep x - c) / 60 s.
    """

    def __init__(self, settings: SensorSettings) -> None:
        self._half, self._of_load, self._creep = (
            settings.hysteresis / 2,
            settings.hysteresis_of_load / 2,
            settings.creep,
        )
        self._on = bool(self._half.any() or self._of_load or self._creep)
        self._before: tuple[float, Floats] | None = None
        self._z, self._c = _ZERO.copy(), _ZERO.copy()
        self.most = _ZERO.copy()  # (6,) largest load since it was re-zeroed

    @property
    def left(self) -> Floats:
        """(6,) what is read in addition to the load."""
        return self._c - self._z

    def read(self, times: ArrayLike, felt: Floats) -> Floats:
        """Return what elements that feel (n, 6) at times (n,) give."""
        if not self._on:
            return felt
        read = np.empty_like(felt)
        # One at a time, because each remembers the last.
        for row, (time, x) in enumerate(zip(np.atleast_1d(times).tolist(), felt, strict=True)):
            since, before = (time, _ZERO) if self._before is None else self._before
            self.most = np.maximum(self.most, np.abs(x))
            half = self._half + self._of_load * self.most
            self._z = np.clip(self._z + _SLOPE * (x - before), -half, half)
            # Between two readings the load is taken to have been the later one.
            self._c = self._c + (self._creep * x - self._c) * -np.expm1(-(time - since) / _CREEP_S)
            self._before = (time, x)
            read[row] = x + self.left
        return read

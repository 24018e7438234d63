"""What a real force/torque sensor makes of a true wrench: noise, bias, drift, crosstalk, steps, range."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_ZERO = np.zeros(6)
_HIGHEST_RATE = 1000.0


def _six(force: float, torque: float) -> NDArray[np.float64]:
    return np.array([force] * 3 + [torque] * 3)


@dataclass(frozen=True, eq=False)
class SensorSettings:
    """A sensor's figures; every array (6,) is Fx Fy Fz Mx My Mz in S, N and N·m about the sensor's origin."""

    # (6,) standard deviation of one reading; white and Gaussian
    noise: NDArray[np.float64] = field(default_factory=lambda: _ZERO.copy())
    # (6,) what it reads without load, at `reference` temperature
    bias: NDArray[np.float64] = field(default_factory=lambda: _ZERO.copy())
    # (6, 6) the true wrench times this is what the elements feel; the identity for a perfect one
    crosstalk: NDArray[np.float64] = field(default_factory=lambda: np.eye(6))
    # (6,) how the bias moves, per kelvin
    drift: NDArray[np.float64] = field(default_factory=lambda: _ZERO.copy())
    # (kelvin, seconds) how much warmer it gets than where it stands, and the time constant
    warm_up: tuple[float, float] = (0.0, 600.0)
    # (6,) step of the readings; 0 for none
    resolution: NDArray[np.float64] = field(default_factory=lambda: _ZERO.copy())
    # (6,) largest reading of either sign; a larger one is given as this, and marked
    limit: NDArray[np.float64] = field(default_factory=lambda: np.full(6, np.inf))
    rate: float = 200.0  # readings a second, up to 1000 Hz
    # temperature of the room, °C, which is also the temperature that `bias` belongs to
    ambient: float = 22.0

    def __post_init__(self) -> None:
        for name, shape in (("noise", 6), ("bias", 6), ("drift", 6), ("resolution", 6), ("limit", 6)):
            value = np.array(getattr(self, name), dtype=np.float64)
            finite = np.isfinite(value).all() or (name == "limit" and not np.isnan(value).any())
            if value.shape != (shape,) or not finite:
                raise InputError(f"sensor model: {name}: give six finite numbers, not {value}.")
            if name in ("noise", "resolution", "limit") and (value < 0).any():
                raise InputError(f"sensor model: {name}: give numbers of 0 or more, not {value}.")
            object.__setattr__(self, name, value)
        crosstalk = np.array(self.crosstalk, dtype=np.float64)
        if crosstalk.shape != (6, 6) or not np.isfinite(crosstalk).all():
            raise InputError("sensor model: crosstalk: give six rows of six finite numbers.")
        object.__setattr__(self, "crosstalk", crosstalk)
        if not 0 < self.rate <= _HIGHEST_RATE:
            raise InputError(
                f"sensor model: rate {self.rate:g} Hz: give one above 0, up to {_HIGHEST_RATE:g}."
            )
        if not (np.isfinite(self.warm_up).all() and self.warm_up[1] > 0 and np.isfinite(self.ambient)):
            raise InputError(f"sensor model: warm-up {self.warm_up}: give kelvin and a positive time, s.")

    @property
    def wrench_noise(self) -> WrenchNoise:
        """The noise of one reading, for contact location."""
        return WrenchNoise(self.noise[:3], self.noise[3:])

    def at(self, rate: float) -> SensorSettings:
        """Return the same sensor read at another rate, Hz."""
        return replace(self, rate=rate)


def _skewed(share: float) -> NDArray[np.float64]:
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
        raise InputError(f"sensor model {name!r}: choose one of {', '.join(PRESETS)}.")
    return PRESETS[name]


@dataclass(frozen=True, eq=False)
class SensorReadings:
    """What the sensor gave."""

    wrenches: NDArray[np.float64]  # (n, 6) S, N and N·m
    saturated: NDArray[np.bool_]  # (n,) bool Whether a channel is at its limit
    temperatures: NDArray[np.float64]  # (n,) °C


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

    @property
    def bias(self) -> NDArray[np.float64]:
        """What it reads without load at the room's temperature, (6,); changes when it is re-zeroed."""
        return self._offset.copy()

    def temperature(self, times: ArrayLike) -> NDArray[np.float64]:
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
        self._offset = -self.settings.crosstalk @ np.asarray(wrench, dtype=np.float64) - drift

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
        given = true @ settings.crosstalk.T + self._offset
        given += np.outer(temperatures - settings.ambient, settings.drift)
        given += settings.noise * self._rng.standard_normal(true.shape)
        stepped = settings.resolution > 0
        given[:, stepped] = (
            np.round(given[:, stepped] / settings.resolution[stepped]) * settings.resolution[stepped]
        )
        saturated: NDArray[np.bool_] = np.any(np.abs(given) >= settings.limit, axis=1)
        return SensorReadings(np.clip(given, -settings.limit, settings.limit), saturated, temperatures)

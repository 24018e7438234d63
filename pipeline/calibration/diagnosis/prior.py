"""What is known of a load before it is measured: it decides where two readings leave the same residuals."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.errors import InputError, arg, message

DOWN = message("gravity points down")
WEIGHED = message("the mass as weighed")
MASS = message("a plausible mass")
SIDE = message("the centre of mass lies on the tool's side")
REACH = message("the centre of mass lies within the tool")
QUIET = message("a plausible noise")

_TAIL = 4.0  # degrees of freedom of Student's t: a base ten standard deviations off level is strange, not impossible
_HUBER = 3.0  # standard deviations
_WORST = 20.0  # what a bound that is broken costs at most
# A centre of mass usually lies about a fifth of the tool's length away, give or take a factor of 4.5.
_USUAL_SHARE, _USUAL_SPREAD = 0.2, 1.5
_SOFT_END = 0.15  # a bound on length is soft by this share of it
# A pose's mean is usually less noisy than this, give or take a factor of 4.5, and hardly ever beyond the bound.
_USUAL_NOISE, _NOISE_SPREAD, _NOISY = np.array([0.1, 0.004]), 1.5, np.array([0.5, 0.025])
_BEYOND, _LOUDEST = 6.0, 12.0  # what each factor of e beyond it costs, and all of it at most
# Torques over forces, m: what sensors of the size of a fist have, give or take a factor of 2; what any other costs.
_USUAL_ARM, _ARM_SPREAD, _ODDEST_ARM = 0.04, 0.7, 3.0


@dataclass(frozen=True)
class Prior:
    """What is known before.

    Raises
    ------
    InputError
        A value is not finite or outside its range.
    """

    # (3,) where gravity points in W; only its direction counts. Default: -z. Change it for a base on a wall
    # or a ceiling whose own frame is used for W.
    down_W: tuple[float, float, float] = (0.0, 0.0, -1.0)
    # 1 sigma of the angle between gravity and `down_W`, rad: how far from level the base is
    tilt: float = float(np.radians(3.0))
    mass: float | None = None  # Of all that hangs on the sensor, as weighed, kg
    # Its standard deviation, kg. Default: 5 % (bolts and cables are easily forgotten).
    mass_sigma: float | None = None
    # For a mass that was not weighed: 95 % of loads lie within, kg
    mass_range: tuple[float, float] = (0.02, 10.0)
    # (3,) from the sensor to the tool, S. Default: z.
    tool_axis_S: tuple[float, float, float] = (0.0, 0.0, 1.0)
    # 1 sigma of how far the centre of mass may lie on the other side of the sensor's origin, m
    behind: float = 0.005
    tool_length: float = 0.3  # The centre of mass is no further than this from the sensor's origin, m
    # Share of recordings in which any one mistake is made: a reading that is not as declared must be this
    # much more probable to be believed
    mistake: float = 0.05
    noise_factor: float = 1.35  # The noise that is given is right up to this factor, 1 sigma

    def __post_init__(self) -> None:
        for name in ("down_W", "tool_axis_S"):
            object.__setattr__(self, name, _direction(name, getattr(self, name)))
        for name, least, most, unit in (
            ("tilt", 0.0, np.pi, "rad"),
            ("mass", 0.0, 1e4, "kg"),
            ("mass_sigma", 0.0, 1e4, "kg"),
            ("behind", 0.0, 10.0, "m"),
            ("tool_length", 0.0, 10.0, "m"),
            ("mistake", 0.0, 1.0, "a share"),
            ("noise_factor", 1.0, 1e3, "a factor"),
        ):
            value = getattr(self, name)
            if value is not None and not least < value <= most:
                raise InputError(
                    f"Prior.{arg(name)}: {arg(value)} is not above {arg(least):g} and at most {arg(most):g}"
                    f" ({arg(unit)})."
                )
        if self.mass_sigma is not None and self.mass is None:
            raise InputError("Prior.mass_sigma without Prior.mass: give the mass as weighed, kg, too.")
        low, high = self.mass_range
        if not 0 < low < high < np.inf:
            raise InputError(
                f"Prior.mass_range: {arg(self.mass_range)} is no range of masses: give (low, high), kg."
            )

    def log_densities(
        self, g: NDArray[np.float64], L: NDArray[np.float64], covariance: NDArray[np.float64]
    ) -> dict[str, float]:
        """Return what each piece of knowledge says of an estimate, as logarithms.

        Parameters
        ----------
        g : (3,)
            Weight, W, N.
        L : (3,)
            Centre of mass, S, m.
        covariance : (6, 6)
            Of both.
        """
        weight = max(float(np.linalg.norm(g)), 1e-12)
        C_g, C_L = covariance[:3, :3], covariance[3:, 3:]
        # Of poses that are alike to the last digit, rounding may leave less than nothing.
        weight_sigma, L_sigma = (np.sqrt(max(float(np.trace(C)), 0.0) / 3) for C in (C_g, C_L))
        angle = angle_between(g, np.array(self.down_W))
        parts = {
            DOWN: -(_TAIL + 2)
            / 2
            * np.log1p(angle**2 / (_TAIL * (self.tilt**2 + (weight_sigma / weight) ** 2)))
        }
        mass, mass_sigma = weight / STANDARD_GRAVITY, weight_sigma / STANDARD_GRAVITY
        if self.mass is not None:
            sigma = 0.05 * self.mass if self.mass_sigma is None else self.mass_sigma
            parts[WEIGHED] = -_huber((mass - self.mass) / np.hypot(sigma, mass_sigma))
        else:
            low, high = np.log(self.mass_range)
            parts[MASS] = -0.5 * _off(mass, mass_sigma, np.exp((low + high) / 2), (high - low) / 4) ** 2
        axis = np.array(self.tool_axis_S)
        short = max(-float(axis @ L), 0.0)
        parts[SIDE] = -_bound(short**2 / (self.behind**2 + axis @ C_L @ axis))
        distance = float(np.linalg.norm(L))
        usual = _off(distance, L_sigma, _USUAL_SHARE * self.tool_length, _USUAL_SPREAD)
        beyond = max((distance - 2 * L_sigma) / self.tool_length - 1, 0.0)
        parts[REACH] = -0.5 * usual**2 - _bound((beyond / _SOFT_END) ** 2)
        return {name: float(value) for name, value in parts.items()}


def quiet(noise: NDArray[np.float64]) -> float:
    """Return the logarithm of how plausible noise (2,) of a pose's mean is, N and N·m; 0 for a usual sensor's."""
    usual = np.maximum(np.log(noise / _USUAL_NOISE), 0) / _NOISE_SPREAD
    beyond = np.maximum(np.log(noise / _NOISY), 0)
    arm = float(np.log(noise[1] / noise[0] / _USUAL_ARM)) / _ARM_SPREAD
    loud = min(float((0.5 * usual**2 + _BEYOND * beyond).sum()), _LOUDEST)
    return -loud - min(0.5 * arm**2, _ODDEST_ARM)


def angle_between(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Return the angle between two vectors (3,), rad; 0 where one is zero."""
    return float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))


def _off(value: float, sigma: float, usual: float, spread: float) -> float:
    """Return how many `spread`s of its logarithm a value surely is from what is usual."""
    low, high = max(value - 2 * sigma, 1e-12), max(value + 2 * sigma, 1e-12)
    return float(np.log(np.clip(usual, low, high) / usual)) / spread


def _huber(z: float) -> float:
    """Return z²/2, growing only linearly where somebody has more likely forgotten a part."""
    z = abs(float(z))
    return 0.5 * z**2 if z < _HUBER else _HUBER * (z - 0.5 * _HUBER)


def _bound(square: float) -> float:
    return min(0.5 * float(square), _WORST)


def _direction(name: str, value: tuple[float, float, float]) -> tuple[float, ...]:
    array = np.array(value, dtype=np.float64)
    if array.shape != (3,) or not np.isfinite(array).all() or not array.any():
        raise InputError(
            f"Prior.{arg(name)}: give three finite numbers that are not all 0, not {arg(value)!r}."
        )
    return tuple((array / np.linalg.norm(array)).tolist())

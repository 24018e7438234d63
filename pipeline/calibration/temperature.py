"""How much the bias moves with the sensor's temperature."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import chdtrc

from pipeline.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]


_ALIKE = 0.9  # correlation of temperature and time, beyond which their effects are hard to tell apart


_SAME = 0.999  # beyond which they cannot be


_DOUBT = 1e-3  # noise that was given is doubted when chance explains the scatter once in so many


@dataclass(frozen=True, eq=False)
class TemperatureCoefficient:
    """How the biases follow the sensor's temperature.

    Attributes
    ----------
    coefficient, sigma : (6,)
        N/K and N·m/K with 1 sigma; NaN and infinite where refused.
    significance : (6,)
        Distance from zero in sigmas.
    drift, drift_sigma : (6,) or None
        What changes with time at constant temperature, N/s and N·m/s; None without times.
    time_correlation : float or None
        Of temperature and time, -1 to 1: near 1, warm-up and drift look alike; then `sigma` is large, because
        both are fitted together.
    span : float
        Of the temperatures, K.
    scatter : (6,)
        Residual variance over that of the noise; where chance does not explain it, the sigmas have been widened.
    refusal : str or None
        Why there is no answer.
    sentence : str
        All this in words.
    """

    coefficient: Floats
    sigma: Floats
    significance: Floats
    drift: Floats | None
    drift_sigma: Floats | None
    time_correlation: float | None
    span: float
    scatter: Floats
    refusal: str | None
    sentence: str


def temperature_coefficient(
    temperatures: ArrayLike,
    residuals: ArrayLike,
    sigma: ArrayLike,
    times: ArrayLike | None = None,
    *,
    smallest_span: float = 2.0,
) -> TemperatureCoefficient:
    """Fit how residuals of a gravity model follow the temperature, by weighted least squares.

    Parameters
    ----------
    temperatures : array_like (n,)
        Degrees Celsius.
    residuals : array_like (n, 6)
        Read minus predicted, S, N and N·m.
    sigma : array_like (6,), (2,) or (n, 6)
        Standard deviation of a residual.
    times : array_like (n,), optional
        s. With them a steady drift is fitted too.
    smallest_span : float
        K below which no coefficient is given. Default 2: a sensor's own thermometer is good to some tenths.

    Raises
    ------
    InputError
        Shapes do not fit, or numbers are not finite.
    """
    T, y = np.asarray(temperatures, dtype=np.float64), np.asarray(residuals, dtype=np.float64)
    t = None if times is None else np.asarray(times, dtype=np.float64)
    n = len(T) if T.ndim == 1 else 0
    if n < 2 or y.shape != (n, 6) or (t is not None and t.shape != (n,)):
        raise InputError(
            f"temperature_coefficient: temperatures {T.shape}, residuals {y.shape} and times"
            f" {None if t is None else t.shape} do not fit: give (n,), (n, 6) and (n,), n of 2 or more"
        )
    if not (np.isfinite(T).all() and np.isfinite(y).all() and (t is None or np.isfinite(t).all())):
        raise InputError("temperature_coefficient: leave out moments with a value that is not finite")
    s = np.asarray(sigma, dtype=np.float64)
    s = np.broadcast_to(s if s.shape == (n, 6) else six("sigma", s), (n, 6))
    span = float(np.ptp(T))
    together = _correlation(T, t)
    refusal = _refusal(n, span, smallest_span, together, t is not None)
    if refusal:
        none = np.full(6, np.nan)
        return TemperatureCoefficient(
            none, np.full(6, inf), np.zeros(6), None, None, together, span, none, refusal, refusal
        )
    columns = [np.ones(n), T - T.mean()]
    if t is not None:
        columns.append((t - t.mean()) / max(float(np.ptp(t)), 1e-9))  # alike in size to the others
    X = np.column_stack(columns)
    fits = [_weighted(X, y[:, axis], s[:, axis]) for axis in range(6)]
    values, sigmas = np.array([fit[0] for fit in fits]), np.array([fit[1] for fit in fits])
    scatter = np.array([fit[2] for fit in fits])
    drift = drift_sigma = None
    if t is not None:
        length = max(float(np.ptp(t)), 1e-9)
        drift, drift_sigma = values[:, 2] / length, sigmas[:, 2] / length
    coefficient, error = values[:, 1], sigmas[:, 1]
    significance = np.abs(coefficient) / error
    words = _temperature_words(coefficient, error, significance, together)
    return TemperatureCoefficient(
        coefficient, error, significance, drift, drift_sigma, together, span, scatter, None, words
    )


def _weighted(X: Floats, y: Floats, sigma: Floats) -> tuple[Floats, Floats, float]:
    """Return the coefficients of X (n, k), their standard deviations, and the scatter."""
    A, b = X / sigma[:, None], y / sigma
    covariance = np.linalg.inv(A.T @ A)
    values = covariance @ (A.T @ b)
    freedom = len(y) - X.shape[1]
    cost = float(((b - A @ values) ** 2).sum())
    scatter = cost / freedom if freedom else 1.0
    wide = scatter if freedom and chdtrc(freedom, cost) < _DOUBT else 1.0
    return values, np.sqrt(np.diag(covariance) * wide), scatter


def _correlation(T: Floats, t: Floats | None) -> float | None:
    if t is None or np.ptp(T) == 0 or np.ptp(t) == 0:
        return None
    return float(np.corrcoef(T, t)[0, 1])


def _refusal(n: int, span: float, smallest: float, together: float | None, timed: bool) -> str | None:
    needed = 4 if timed else 3
    if n < needed:
        return f"{n} moments do not show a temperature coefficient: take {needed} or more."
    if span < smallest:
        return (
            f"The temperature changed by {span:.1f} K only; it takes {smallest:.1f} K to tell its effect from noise."
            " Let the sensor warm up or cool down between the moments."
        )
    if together is not None and abs(together) > _SAME:
        return (
            f"The temperature changed only along with time (correlation {together:.4f}): warm-up and drift cannot be"
            " told apart. Record while it cools down, too."
        )
    return None


def _temperature_words(
    coefficient: Floats, sigma: Floats, significance: Floats, together: float | None
) -> str:
    axes = ["Fx", "Fy", "Fz", "Mx", "My", "Mz"]
    units = 3 * [(1.0, "N/K")] + 3 * [(1e3, "mN·m/K")]
    # Three in a thousand per axis by chance; with six axes, one in fifty.
    found = [
        f"{axes[i]} {units[i][0] * coefficient[i]:.2g} ± {units[i][0] * sigma[i]:.1g} {units[i][1]}"
        for i in range(6)
        if significance[i] > 3
    ]
    words = (
        f"The bias follows the temperature: {', '.join(found)}."
        if found
        else "No axis follows the temperature by more than three sigma."
    )
    if together is not None and abs(together) > _ALIKE:
        words += (
            f" Temperature and time went together (correlation {together:.2f}): warm-up and drift look alike, which"
            " is why the uncertainty is large. A cooling-down would tell them apart."
        )
    return words


def six(name: str, value: ArrayLike) -> Floats:
    """Return six numbers above 0, two repeated for force and torque; InputError if they are not."""
    array = np.asarray(value, dtype=np.float64)
    if array.shape == (2,):
        array = np.repeat(array, 3)
    if array.shape != (6,) or not np.isfinite(array).all() or (array <= 0).any():
        raise InputError(f"{name}: give six finite numbers above 0 (or two: force, torque), not {value!r}")
    return array


def angle(first: Floats, second: Floats) -> float:
    """Return the angle between two orientations, rad."""
    return float(np.arccos(np.clip((np.trace(first.T @ second) - 1) / 2, -1.0, 1.0)))


def words(wrench: Floats) -> str:
    """Write the sizes of a wrench (6,)."""
    force, torque = float(np.linalg.norm(wrench[:3])), 1e3 * float(np.linalg.norm(wrench[3:]))
    return f"{float(f'{force:.2g}'):g} N and {float(f'{torque:.2g}'):g} mN·m"

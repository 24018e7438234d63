"""The unit superellipse and its exact derivatives: the cross-section of every probe."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import xlogy

Array = NDArray[np.float64]


class Axis(NamedTuple):
    """One coordinate of the unit section with its derivatives in the angle ``phi`` and the exponent ``m``."""

    value: Array
    phi: Array
    m: Array
    phi_phi: Array
    phi_m: Array
    m_m: Array


def unit_section(phi: Array, m: Array) -> tuple[Axis, Axis]:
    """Evaluate the superellipse ``|x|^m + |y|^m = 1`` in polar form.

    The point is ``rho (cos phi, sin phi)`` with ``rho = (|cos phi|^m + |sin phi|^m)^(-1/m)``. Scaling it by
    the half widths afterwards, rather than putting them inside ``rho``, keeps the derivatives finite where
    a half width vanishes.

    Parameters
    ----------
    phi : (n,) array
        Polar angle on the unit section [rad].
    m : (n,) array
        Exponent, at least 2: 2 is an ellipse, larger values approach a rectangle.

    Returns
    -------
    x, y : Axis
        The two coordinates, each with first and second derivatives.
    """
    # A spline of exponents that are all 2 may fall short of 2 by rounding, where 0^(m-2) is infinite.
    m = np.maximum(m, 2.0)
    cos, sin = np.cos(phi), np.sin(phi)
    c, s = np.abs(cos), np.abs(sin)
    cm, sm = c**m, s**m
    total = cm + sm
    log_total = np.log(total)
    rho = np.exp(-log_total / m)
    first = (xlogy(cm, c) + xlogy(sm, s)) / total
    second = (xlogy(xlogy(cm, c), c) + xlogy(xlogy(sm, s), s)) / total
    # growth = d(log rho)/dm and its own derivative in m.
    growth = log_total / m**2 - first / m
    growth_m = 2 * first / m**2 - 2 * log_total / m**3 - (second - first**2) / m
    # With p = rho^(m+1), the angular derivatives collapse to x' = -p s^(m-1), y' = p c^(m-1).
    p = rho / total
    c_lower, s_lower = c ** (m - 1), s ** (m - 1)
    cs, sc = c_lower * np.sign(cos), s_lower * np.sign(sin)
    log_rho_phi = (cs * sin - sc * cos) / total
    p_phi, p_m = (m + 1) * p * log_rho_phi, p * (-log_total / m + (m + 1) * growth)

    def axis(turn: int, base: Array, lower: Array, side: Array, other: Array) -> Axis:
        value, edge = rho * other, lower * np.sign(side)
        return Axis(
            value=value,
            phi=turn * p * edge,
            m=value * growth,
            phi_phi=turn * p_phi * edge - p * (m - 1) * base ** (m - 2) * other,
            phi_m=turn * p_m * edge + turn * p * xlogy(lower, base) * np.sign(side),
            m_m=value * (growth**2 + growth_m),
        )

    return axis(-1, s, s_lower, sin, cos), axis(1, c, c_lower, cos, sin)

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
    cs, sc = c ** (m - 1) * np.sign(cos), s ** (m - 1) * np.sign(sin)
    log_rho_phi = (cs * sin - sc * cos) / total
    p_phi, p_m = (m + 1) * p * log_rho_phi, p * (-log_total / m + (m + 1) * growth)
    x, y = rho * cos, rho * sin
    return (
        Axis(
            value=x,
            phi=-p * sc,
            m=x * growth,
            phi_phi=-p_phi * sc - p * (m - 1) * s ** (m - 2) * cos,
            phi_m=-p_m * sc - p * xlogy(s ** (m - 1), s) * np.sign(sin),
            m_m=x * (growth**2 + growth_m),
        ),
        Axis(
            value=y,
            phi=p * cs,
            m=y * growth,
            phi_phi=p_phi * cs - p * (m - 1) * c ** (m - 2) * sin,
            phi_m=p_m * cs + p * xlogy(c ** (m - 1), c) * np.sign(cos),
            m_m=y * (growth**2 + growth_m),
        ),
    )

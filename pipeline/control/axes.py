"""Which error turns which axis: it follows from the geometry, not from the order of an equation's components."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def turn_of(offset: NDArray[np.float64], normal: NDArray[np.float64]) -> NDArray[np.float64]:
    """
    Return the axis, times the length of the offset, about which a probe must turn to bring the contact back.

    Where the contact lies off its wanted place, the tissue is nearer there: that side must give way. A turn w moves a
    place e by w x e; with w = n x e that is (n x e) x e = -n |e|² for a tangent e: away from the tissue.
    A contact off in +x, with n = +z, needs a turn about +y; one off in +y, about -x.

    Parameters
    ----------
    offset : (3,)
        Contact minus wanted contact, m; what is along the normal does not count.
    normal : (3,)
        Outward unit normal n of the probe at the wanted contact, same frame.

    Returns
    -------
    (3,)
        n x e, m.
    """
    return cross(normal, offset)


def cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a x b of two (3,); numpy's own takes ten times as long for one pair."""
    ax, ay, az = a.tolist()
    bx, by, bz = b.tolist()
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def pressing(force: NDArray[np.float64], normal: NDArray[np.float64]) -> float:
    """Return how hard the tissue is pressed, N: -n . F of the force F (3,) on the probe; negative if it pulls."""
    return -float(force @ normal)

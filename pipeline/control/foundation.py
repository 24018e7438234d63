"""What a probe's shape says of a press on flat soft tissue: how force, stiffness and place hang together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact.footprint import FACE_DEPTH_M, spread

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe

_PLACES = 1500
_DEPTHS = 400
USUAL_MODULUS = 3e6  # N/m³


@dataclass(frozen=True)
class FacePress:
    """
    One press.

    Attributes
    ----------
    depth : float
        m.
    stiffness : float
        N/m, change of force with depth.
    gain_x, gain_y : float
        How far the contact moves along S's x and y for each rad that the tissue is tilted, m/rad.
    x, y : float
        Where the contact is in S while the tissue is not tilted, m.
    """

    depth: float
    stiffness: float
    gain_x: float
    gain_y: float
    x: float
    y: float


class Foundation:
    """
    A probe's face on a bed of springs of one modulus E (N/m³): force E A(d), stiffness E A'(d) at a depth d.

    With the modulus and the force, all else is known from the shape: the depth, the stiffness, and how far the contact
    moves when the tissue tilts: for a tilt t about y each place at x is deeper by x t, which moves the centroid by
    t sum(x (x - mean)) / A(d) over the places in contact.

    Parameters
    ----------
    probe : Probe
        In S, its face towards +z.

    Attributes
    ----------
    height : float
        Of the probe's tip in S, m.

    Raises
    ------
    InputError
        Nothing of the probe faces +z.
    """

    def __init__(self, probe: Probe) -> None:
        places, _, area = spread(probe, _PLACES)
        high = float(probe.vertices[:, 2].max())
        self._depths = np.linspace(FACE_DEPTH_M / _DEPTHS, FACE_DEPTH_M * 0.98, _DEPTHS)
        deep = np.maximum(self._depths[:, None] - (high - places[:, 2])[None], 0.0)  # (depths, places)
        inside = deep > 0
        count = np.maximum(inside.sum(axis=1), 1)
        self._force = np.maximum(deep.sum(axis=1) * area, 1e-15)  # A(d), m³
        self._slope = count * area  # A'(d), m²
        gains, means = [], []
        for x in (places[:, 0], places[:, 1]):
            weighted = deep @ x / np.maximum(deep.sum(axis=1), 1e-15)
            means.append(weighted)
            gains.append((inside @ (x * x) - (inside @ x) * weighted) * area / self._force)
        self._gains = np.maximum(np.array(gains), 1e-5)
        # One row per depth: all that a press is made of is found with one look into the table.
        self._rows = np.column_stack([self._depths, self._slope, self._gains.T, np.array(means).T])
        self._numbers = np.arange(float(_DEPTHS))
        self.height = high

    def at(self, force: float, modulus: float) -> FacePress:
        """Return the press of a force, N, on tissue of a modulus, N/m³; beyond 12 mm that of 12 mm."""
        place = float(np.interp(force / modulus, self._force, self._numbers))
        first = min(int(place), _DEPTHS - 2)
        share = place - first
        found = (1 - share) * self._rows[first] + share * self._rows[first + 1]
        depth, slope, gain_x, gain_y, x, y = found.tolist()
        return FacePress(depth, modulus * slope, gain_x, gain_y, x, y)

    def modulus_of(self, force: float, stiffness: float) -> float:
        """Return the modulus, N/m³, that gives a stiffness, N/m, at a force, N; the nearest that the table has."""
        # At each depth a force stands for one modulus, and that for one stiffness, which falls with the depth.
        moduli = force / self._force
        stiffnesses = moduli * self._slope
        order = np.argsort(stiffnesses, kind="stable")
        return float(np.interp(stiffness, stiffnesses[order], moduli[order]))

    @property
    def axes(self) -> NDArray[np.float64]:
        """Mean gains along x and y over all depths, (2,), m/rad: which axis the place of the contact tells more of."""
        return np.asarray(self._gains.mean(axis=1))

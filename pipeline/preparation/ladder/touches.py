"""The touches that a probe is expected to feel, drawn on its own mesh."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from contactbench.pipeline.contact import Gates, WrenchNoise
from contactbench.pipeline.errors import arg
from contactbench.pipeline.preparation.ladder.errors import LadderError
from contactbench.pipeline.simulation import Touches, add_noise, draw_touches

if TYPE_CHECKING:
    import numpy.typing as npt

    from contactbench.pipeline.mesh import Probe

Part = Literal["region", "rest", "all"]

FEWEST = 100

# draw_touches keeps points above a height and normals that face up by more than this: here all of them.
_EVERYWHERE = {"above": -math.inf, "facing": -math.inf}


@dataclass(frozen=True, eq=False)
class ExpectedTouches:
    """
    What the sensor will read, and how its readings are judged.

    Raises
    ------
    LadderError
        A value is out of its range.
    """

    noise: WrenchNoise = field(default_factory=WrenchNoise)  # of the compensated, filtered wrench
    force: tuple[float, float] = (8.0, 10.0)  # |F|, N, uniform
    # between -F and the outward normal, degrees, uniform, under 90
    friction_angle: tuple[float, float] = (0.0, 30.0)
    torsion_arm: float = 0.0003  # standard deviation of the local torque over |F|, m
    gates: Gates = field(default_factory=Gates)  # when the solver gives an answer
    count: int = 4_000  # touches per part of the probe, at least 100
    seed: int = 0  # of chance, at least 0

    def __post_init__(self) -> None:
        low, high = self.force
        if not 0 < low <= high < math.inf:
            raise LadderError(
                f"the force range is {arg(low):g} to {arg(high):g} N: give two numbers above 0, smaller first."
            )
        low, high = self.friction_angle
        if not 0 <= low <= high < 90:
            raise LadderError(
                f"the friction angle's range is {arg(low):g} to {arg(high):g} degrees: give two numbers from"
                " 0 to below 90, smaller first."
            )
        if not 0 <= self.torsion_arm < math.inf:
            raise LadderError(
                f"the torsion arm is {arg(self.torsion_arm):g} m: give a length of 0 or more, such as 0.0003."
            )
        if self.count < FEWEST:
            raise LadderError(
                f"{arg(self.count)} touches are too few to judge an error: give at least {arg(FEWEST)}."
            )
        if self.seed < 0:
            raise LadderError(f"the seed is {arg(self.seed)}: give a whole number of at least 0.")

    def to_json(self) -> dict[str, Any]:
        """Return plain data; the noise as standard deviations of Fx Fy Fz Mx My Mz, N and N·m."""
        return {
            "noise": np.sqrt(np.diagonal(self.noise.covariance)).tolist(),
            "force_n": list(self.force),
            "friction_angle_deg": list(self.friction_angle),
            "torsion_arm_m": self.torsion_arm,
            "count": self.count,
            "seed": self.seed,
        }


@dataclass(frozen=True, eq=False)
class DrawnTouches:
    """Touches of one part of a probe."""

    part: Part  # the priority regions, what is outside them, or the whole probe when it has none
    truth: Touches  # on the facets of the mesh
    noisy: npt.NDArray[np.float64]  # (n, 6) its wrenches with the sensor's noise, N and N·m in S


def draw_parts(probe: Probe, expected: ExpectedTouches) -> tuple[DrawnTouches, ...]:
    """
    Draw touches evenly over the area of each part; none of regions that nothing can touch.

    Parameters
    ----------
    probe : Probe
        The full mesh.
    expected : ExpectedTouches
        What to draw. The same seed gives the same touches.

    Returns
    -------
    tuple of DrawnTouches
        The regions first, then the rest; or the whole probe.

    Raises
    ------
    LadderError
        Nothing of the probe can be touched.
    """
    touchable = ~np.isin(probe.region, probe.untouchable)
    inside, outside = touchable & (probe.region > 0), probe.region == 0
    parts: list[tuple[Part, npt.NDArray[np.bool_]]] = [("region", inside), ("rest", outside)]
    if not touchable.any():
        raise LadderError("the whole probe is marked untouchable: correct the regions.")
    if not inside.any():
        parts = [("all", outside)]
    return tuple(
        _draw(probe, expected, part, mask, number) for number, (part, mask) in enumerate(parts) if mask.any()
    )


def _draw(
    probe: Probe, expected: ExpectedTouches, part: Part, mask: npt.NDArray[np.bool_], number: int
) -> DrawnTouches:
    rng = np.random.default_rng([expected.seed, number])
    truth = draw_touches(
        _Facets(probe, np.flatnonzero(mask)),
        expected.count,
        rng,
        force=expected.force,
        angle=expected.friction_angle,
        torsion_arm=expected.torsion_arm,
        **_EVERYWHERE,
    )
    return DrawnTouches(part, truth, add_noise(truth.wrenches, expected.noise, rng))


class _Facets:
    """Some facets of a mesh, sampled as `assets.Surface` is: all that `draw_touches` asks of one."""

    def __init__(self, probe: Probe, facets: npt.NDArray[np.intp]) -> None:
        self._probe = probe
        self._facets = facets
        self._area = np.cumsum(probe.areas[facets])

    def sample(
        self, count: int, rng: np.random.Generator
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Return points and normals (count, 3) in S, uniform by area."""
        where = rng.random(count) * self._area[-1]
        row = np.minimum(np.searchsorted(self._area, where, side="right"), len(self._area) - 1)
        chosen = self._facets[row]
        corners = self._probe.vertices[self._probe.faces[chosen]]
        points = np.einsum("ij,ijk->ik", rng.dirichlet([1.0, 1.0, 1.0], count), corners)
        return points, self._probe.normals[chosen]

"""The limits that decide when an answer is given."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from math import cos, exp, inf, isnan, log, radians
from statistics import NormalDist
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import InputError, arg

LARGEST_ODDS = 1e9
BEHIND_M = 0.003  # along the force: nearer surfaces are one, seen through the noise
_UNLIMITED = (inf, inf, inf, inf, inf, inf)


@dataclass(frozen=True)
class Gates:
    """Limits and odds behind the reason codes; lengths in metres, force in newtons, odds as "so many to one".

    A touch is judged by d2, its misfit to the wrench, in standard deviations squared. Odds are in the same
    unit: odds of o to 1 are worth 2 ln(o).

    Parameters
    ----------
    min_force : float
        ``low_force`` below this |F|, N. Default 0.5: with 0.05 N of noise the force direction is then known
        to 6 degrees and the point to about 15 mm; below it, an answer would be pure noise.
    friction_angle : float
        Largest angle between -F and the outward normal, degrees, under 90. Default 75: friction would
        have to exceed 3.7, and the noise bound is already four times that of a perpendicular touch.
        If only a touch beyond it explains the wrench, the reason is ``tangential``.
    implausible_probability : float
        ``implausible`` if a touch leaves a misfit that chance alone reaches with at most this probability
        (chi-square, one degree of freedom). Default 0.001: d2 over 10.8.
    rival_odds : float
        ``ambiguous`` unless the likeliest place is this many times likelier than any other. Default 100.
    ambiguity_distance : float
        Places closer together than this, or than 4.5 standard deviations, count as the same touch, m. Default 5 mm:
        smaller distances lie within the scatter of a light touch and do not disturb a controller.
    region_odds : float
        Odds of a touch in the region of highest priority relative to elsewhere; each further region a tenth of it,
        at least 10. Default 1000.
    untouchable_odds : float
        Factor by which a touch of an untouchable facet is less likely than of any other. Default 1000.
    first_odds : float
        Odds that the first surface on the line of force is touched rather than one behind it. Default e squared,
        about 7: enough to decide between equals, too little to hide an ambiguity.
    follow_odds : float
        Odds that a touch stays near the previous one rather than jumps. Default 1000.
    follow_distance : float
        Distance that counts as near, m. Default 10 mm: at 200 Hz a probe sliding at 1 m/s moves 5 mm, and a light
        touch scatters by 5 mm.
    recent_samples : int
        The previous contact is forgotten after this many samples in a row without an accepted one.
        Default 20: 0.1 s at 200 Hz, shorter than any deliberate lift and touch.
    max_age : float
        ``stale`` when a sample is older, s. Default 0.1: five control cycles of a 50 Hz robot.
    saturation : tuple of 6 floats
        ``saturated`` when a channel reaches this, N and N·m. Default none: take it from the sensor's data
        sheet, because a clipped channel looks like any other number.
    region_only : bool
        ``outside_region`` for a contact outside every declared region. Default off: regions are a
        preference among candidates, not a fence.
    accept_by_region : bool
        Whether ``by_region``, certain only because of the declared regions, counts as accepted. Default on: declaring
        a region states that touches are expected there. A press along the probe's axis is rarely certain without
        it, because the line of force also meets the shoulder of the flange.

    Raises
    ------
    InputError
        A limit is out of range.
    """

    min_force: float = 0.5
    friction_angle: float = 75.0
    implausible_probability: float = 0.001
    rival_odds: float = 100.0
    ambiguity_distance: float = 0.005
    region_odds: float = 1000.0
    untouchable_odds: float = 1000.0
    first_odds: float = exp(2.0)
    follow_odds: float = 1000.0
    follow_distance: float = 0.010
    recent_samples: int = 20
    max_age: float = 0.1
    saturation: tuple[float, float, float, float, float, float] = field(default=_UNLIMITED)
    region_only: bool = False
    accept_by_region: bool = True

    def __post_init__(self) -> None:
        for name in ("min_force", "ambiguity_distance", "follow_distance", "max_age"):
            value = getattr(self, name)
            if isnan(value) or value < 0:
                raise InputError(f"Gates.{arg(name)} must be at least 0, not {arg(value)}")
        for name in ("rival_odds", "region_odds", "untouchable_odds", "first_odds", "follow_odds"):
            value = getattr(self, name)
            if not 1 <= value <= LARGEST_ODDS:
                raise InputError(
                    f"Gates.{arg(name)} must be between 1 and {arg(LARGEST_ODDS):g} to one, not {arg(value)}"
                )
        if not 1e-9 <= self.implausible_probability <= 0.5:
            raise InputError(
                f"Gates.implausible_probability must be between 1e-9 and 0.5, not {arg(self.implausible_probability)}"
            )
        if not 0 < self.friction_angle < 90:
            raise InputError(
                f"Gates.friction_angle must be between 0 and 90 degrees, not {arg(self.friction_angle)}"
            )
        if not isinstance(self.recent_samples, int) or not 0 <= self.recent_samples < 2**63:
            raise InputError(
                f"Gates.recent_samples must be a whole number of at least 0, not {arg(self.recent_samples)}"
            )
        if len(self.saturation) != 6 or any(isnan(v) or v <= 0 for v in self.saturation):
            raise InputError(
                f"Gates.saturation needs six positive limits (N, N·m), not {arg(self.saturation)}"
            )

    @property
    def implausible_misfit(self) -> float:
        """d2 that chance exceeds with `implausible_probability`: a normal variable's quantile, squared."""
        return NormalDist().inv_cdf(1 - self.implausible_probability / 2) ** 2

    def bonus(self, region: NDArray[np.int32], untouchable: Iterable[int] = ()) -> NDArray[np.float64]:
        """
        Return 2 ln(odds) of a touch on each facet.

        Parameters
        ----------
        region : (m,) int32
            Number of each facet's region, 0 for none.
        untouchable : iterable of int
            Numbers of the untouchable regions.
        """
        count = int(region.max(initial=0))
        return np.array([0.0, *(2 * log(odds) for odds in self.odds(count, untouchable))])[region]

    def odds(self, count: int, untouchable: Iterable[int] = ()) -> list[float]:
        """Return the odds of a touch in each of `count` regions, numbered from 1, relative to one elsewhere."""
        hidden = set(untouchable)
        odds, listed = self.region_odds, []
        for number in range(1, count + 1):
            if number in hidden:
                listed.append(1 / self.untouchable_odds)
            else:
                listed.append(odds)
                odds = max(odds / 10, min(odds, 10.0))
        return listed

    def kernel_arguments(self) -> dict[str, Any]:
        """Return the keyword arguments of :class:`contactbench.pipeline.kernel.Solver` that are limits and odds."""
        return {
            "min_force": self.min_force,
            "cos_friction": cos(radians(self.friction_angle)),
            "implausible_misfit": self.implausible_misfit,
            "rival_cost": 2 * log(self.rival_odds),
            "ambiguity_distance": self.ambiguity_distance,
            "behind_cost": 2 * log(self.first_odds),
            "behind_distance": BEHIND_M,
            "follow_cost": 2 * log(self.follow_odds),
            "follow_distance": self.follow_distance,
            "recent_samples": self.recent_samples,
            "max_age": self.max_age,
            "saturation": np.array(self.saturation, dtype=np.float64),
            "region_only": self.region_only,
            "accept_by_region": self.accept_by_region,
        }

"""What simplification costs: the same wrenches located on the full mesh and on a simplified one."""

import math
from dataclasses import dataclass, field
from math import sqrt
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.contact import Batch, ContactSolver, Gates, Reason, WrenchNoise
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats, Mask
from contactbench.pipeline.preparation.alignment.touches.fit import MarkerModel
from contactbench.pipeline.simulation import Touches, add_noise, draw_touches

Part = Literal["region", "rest", "all"]

FEWEST = 100

# draw_touches keeps points above a height and normals that face up by more than this: here all of them.
_EVERYWHERE = {"above": -math.inf, "facing": -math.inf}


class LadderError(InputError):
    """A ladder that cannot be measured as asked: says what is wrong, where, and the remedy."""


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
    noisy: Floats  # (n, 6) its wrenches with the sensor's noise, N and N·m in S


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
    parts: list[tuple[Part, Mask]] = [("region", inside), ("rest", outside)]
    if not touchable.any():
        raise LadderError("the whole probe is marked untouchable: correct the regions.")
    if not inside.any():
        parts = [("all", outside)]
    return tuple(
        _draw(probe, expected, part, mask, number) for number, (part, mask) in enumerate(parts) if mask.any()
    )


def _draw(probe: Probe, expected: ExpectedTouches, part: Part, mask: Mask, number: int) -> DrawnTouches:
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

    def sample(self, count: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
        """Return points and normals (count, 3) in S, uniform by area."""
        where = rng.random(count) * self._area[-1]
        row = np.minimum(np.searchsorted(self._area, where, side="right"), len(self._area) - 1)
        chosen = self._facets[row]
        corners = self._probe.vertices[self._probe.faces[chosen]]
        points = np.einsum("ij,ijk->ik", rng.dirichlet([1.0, 1.0, 1.0], count), corners)
        return points, self._probe.normals[chosen]


Statistic = Literal["mean", "p95", "max"]

_FOUR_SIGMA = 4.0


@dataclass(frozen=True)
class ContactDifference:
    """
    How the answers on a simplified mesh differ from those on the full one.

    An answer is settled when it is accepted: ``ok``, ``vertex`` or ``by_region``. Distances are taken over the
    touches that both meshes settle, and the others are counted.
    """

    settled: int  # touches that the full mesh settles
    compared: int  # touches that both settle
    # mean, p95, largest: distance between the two points, m; None when nothing can be compared
    mean: float | None
    p95: float | None
    largest: float | None
    lost: int  # settled on the full mesh, without a point on the simplified one
    doubtful: int  # settled on the full mesh, a point with a warning on the simplified one
    gained: int  # settled on the simplified mesh only
    changed: int  # touches with another reason; those of settled ones are taken as one
    jumped: int  # settled by both, yet further apart than what counts as ambiguous: wrong without a warning

    @property
    def failed_share(self) -> float:
        """Share of what the full mesh settles that is lost, doubtful or jumped on the simplified one."""
        return (self.lost + self.doubtful + self.jumped) / max(self.settled, 1)

    def statistic(self, name: Statistic) -> float | None:
        """Return the mean, the 95th percentile or the largest distance, m."""
        return {"mean": self.mean, "p95": self.p95, "max": self.largest}[name]


@dataclass(frozen=True)
class PartErrors:
    """The added contact error on one part of the probe."""

    part: Part  # the priority regions, what is outside them, or the whole probe when it has none
    touches: int  # how many were located
    noisy: ContactDifference  # with the sensor's noise: what a user will see
    noise_free: ContactDifference  # without: what the shape alone does
    # noise bound: root mean square error that the sensor's noise alone gives on the full mesh, where it
    # settles a touch and nothing is known of the torsion, m
    bound: float
    # how much larger the root mean square error against the true points is than on the full mesh: 0.05
    # is 5 % more. Over the touches that both settle alike, without jumps, and that the full mesh places
    # within four sigma of the truth; None when there are none.
    growth: float | None

    def over_bound(self, statistic: Statistic) -> float | None:
        """Return a statistic of the noisy touches over the noise bound; None when either is not there."""
        value = self.noisy.statistic(statistic)
        return None if value is None or self.bound == 0 else value / self.bound


@dataclass(frozen=True, eq=False)
class _Located:
    """The full mesh's answers to the touches of one part."""

    drawn: DrawnTouches
    noisy: Batch
    noise_free: Batch
    bound: float


class ContactReference:
    """
    The touches, and where the full mesh locates them.

    Parameters
    ----------
    full : Probe
        The full mesh.
    expected : ExpectedTouches
        What it will feel.

    Raises
    ------
    LadderError
        The full mesh settles too few touches to compare anything.
    """

    def __init__(self, full: Probe, expected: ExpectedTouches) -> None:
        self.expected = expected
        solver = self._solver(full)
        self._located = tuple(_locate(solver, drawn) for drawn in draw_parts(full, expected))
        self._refuse_unsettled()

    @property
    def wrenches(self) -> Floats:
        """Noisy wrenches of the part that is judged: the regions, or all, (n, 6) in S, N and N·m."""
        return self._located[0].drawn.noisy

    def compare(self, probe: Probe) -> tuple[PartErrors, ...]:
        """
        Locate the same touches on another mesh.

        Parameters
        ----------
        probe : Probe
            A simplified mesh, with its regions, in the same frame S.

        Returns
        -------
        tuple of PartErrors
            The part that is judged first: the regions, or the whole probe.
        """
        solver = self._solver(probe)
        return tuple(self._compare_part(located, solver) for located in self._located)

    def _compare_part(self, full: _Located, solver: ContactSolver) -> PartErrors:
        noisy = solver.locate_batch(full.drawn.noisy, threads=0)
        noise_free = solver.locate_batch(full.drawn.truth.wrenches, threads=0)
        jump = self.expected.gates.ambiguity_distance
        return PartErrors(
            full.drawn.part,
            len(full.drawn.truth),
            _difference(full.noisy, noisy, jump),
            _difference(full.noise_free, noise_free, jump),
            full.bound,
            _growth(full.noisy, noisy, full.drawn.truth.points, jump),
        )

    def _solver(self, probe: Probe) -> ContactSolver:
        return ContactSolver(probe, self.expected.noise, self.expected.gates)

    def _refuse_unsettled(self) -> None:
        judged = self._located[0]
        settled = int(np.count_nonzero(_settled(judged.noisy)))
        if settled < FEWEST / 2:
            raise LadderError(
                f"the full mesh settles only {arg(settled)} of {arg(len(judged.noisy))} touches"
                f" ({arg(_reasons(judged.noisy))}), so there is nothing to compare with: check that the"
                " surface is a closed shell in the sensor's frame, without openings into a hollow (--close"
                " auto), and that the forces are the expected ones."
            )


def _locate(solver: ContactSolver, drawn: DrawnTouches) -> _Located:
    noisy = solver.locate_batch(drawn.noisy, threads=0)
    found = _settled(noisy)
    model = MarkerModel(
        noisy.points[found], noisy.normals[found], drawn.noisy[found], solver.noise.covariance, 0.0
    )
    smallest = model.sigmas(np.eye(4))
    bound = sqrt(float(np.trace(smallest, axis1=1, axis2=2).mean())) if len(smallest) else 0.0
    return _Located(drawn, noisy, solver.locate_batch(drawn.truth.wrenches, threads=0), bound)


def _settled(batch: Batch) -> Mask:
    return np.array(batch.accepted)


def _reasons(batch: Batch) -> str:
    values, counts = np.unique(batch.reasons, return_counts=True)
    return ", ".join(
        f"{Reason(value).name.lower()} {count}" for value, count in zip(values, counts, strict=True)
    )


def _difference(full: Batch, other: Batch, jump: float) -> ContactDifference:
    before, after = _settled(full), _settled(other)
    both = before & after
    apart = np.linalg.norm(full.points[both] - other.points[both], axis=1)
    pointless = before & ~after & np.isnan(other.points[:, 0])
    # Whether a facet or a vertex answers is a matter of the mesh, not of the touch.
    reasons = [np.where(_settled(batch), Reason.OK, batch.reasons) for batch in (full, other)]
    some = len(apart) > 0
    return ContactDifference(
        settled=int(np.count_nonzero(before)),
        compared=len(apart),
        mean=float(apart.mean()) if some else None,
        p95=float(np.percentile(apart, 95)) if some else None,
        largest=float(apart.max()) if some else None,
        lost=int(np.count_nonzero(pointless)),
        doubtful=int(np.count_nonzero(before & ~after & ~pointless)),
        gained=int(np.count_nonzero(after & ~before)),
        changed=int(np.count_nonzero(reasons[0] != reasons[1])),
        jumped=int(np.count_nonzero(apart > jump)),
    )


def _growth(full: Batch, other: Batch, truth: Floats, jump: float) -> float | None:
    before, after = (np.linalg.norm(batch.points - truth, axis=1) for batch in (full, other))
    # A touch that is put on another part of the probe is tens of millimetres off: one of them, on either mesh,
    # would hide what the others do. Jumps are counted instead.
    chosen = _settled(full) & _settled(other) & (before <= _FOUR_SIGMA * full.sigma_max)
    chosen &= np.linalg.norm(full.points - other.points, axis=1) <= jump
    squares = float(np.sum(before[chosen] ** 2))
    return sqrt(float(np.sum(after[chosen] ** 2)) / squares) - 1 if squares > 0 else None

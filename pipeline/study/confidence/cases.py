"""Touches whose place is known from exact surfaces or meshes, with what makes them hard, and what the solver says."""

from dataclasses import dataclass

import numpy as np

from contactbench.pipeline.contact import Batch, ContactSolver, Reason, WrenchNoise
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats, Mask
from contactbench.pipeline.simulation import Touches, add_noise, draw_touches
from contactbench.pipeline.study.sweep.plan import TouchedBody, body_of, mesh_of

# What was tried, in words -> share of one seed.
Measured = dict[str, float]

RAW = WrenchNoise()
FILTERED = WrenchNoise(0.18 * 0.05, 0.18 * 0.002)  # as behind a low-pass filter
NOISES = {"raw": RAW, "filtered": FILTERED}
TORSIONS_M = (0.0003, 0.003)
ASTRAY_M = 0.010
_FACE_M, _FACING = 0.015, 0.7  # the lens: so near to the tip, and so level
_APART_M = 0.020
EVENLY, LENS, ANYWHERE = "anywhere, no region", "on the lens, declared", "anywhere, lens declared"
TOUCHED = (EVENLY, LENS, ANYWHERE)
_NEAR_M, _DEPTH_M, _STEEP = 0.005, 0.002, 0.5  # one place: across the force; along it, and per metre across
# Within 95 % of a normal distribution in two dimensions.
_ELLIPSE = -2 * np.log(0.05)


@dataclass(frozen=True, eq=False)
class Asked:
    """Touches, and what was answered."""

    touches: Touches
    wrenches: Floats  # (n, 6) as the sensor read them
    batch: Batch
    errors: Floats  # (n,) m NaN without a point
    sure: Mask  # (n,) bool Reason ``ok`` or ``vertex``: nothing but the wrench was needed

    def off(self, limit: float) -> Mask:
        """Tell which answers have a point that is further off than this, m."""
        return np.asarray(self.errors > limit)

    def reason(self, reason: Reason) -> float:
        """Return the share of the touches that were answered so."""
        return float(np.mean(self.batch.reasons == reason))


def ask(solver: ContactSolver, touches: Touches, wrenches: Floats) -> Asked:
    """Locate wrenches (n, 6) of touches."""
    batch = solver.locate_batch(wrenches)
    errors = np.linalg.norm(batch.points - touches.points, axis=1)
    return Asked(touches, wrenches, batch, errors, batch.reasons <= Reason.VERTEX)


def press(
    body: TouchedBody,
    solver: ContactSolver,
    count: int,
    rng: np.random.Generator,
    *,
    drift: bool = False,
    **drawn: object,
) -> Asked:
    """
    Draw touches, add noise, locate.

    Parameters
    ----------
    drift : bool
        Draw the model's error into the wrenches, too.
    **drawn
        As for :func:`contactbench.pipeline.simulation.draw_touches`.
    """
    touches = draw_touches(body.surface, count, rng, **({"above": body.above} | drawn))  # type: ignore[arg-type]
    wrenches = add_noise(touches.wrenches, solver.noise, rng)
    return ask(solver, touches, add_noise(wrenches, solver.model.model_error, rng) if drift else wrenches)


def mesh(name: str, facets: int, *, region: bool = False) -> Probe:
    """Return a probe's mesh; unless told so, nothing is declared on it."""
    probe = mesh_of(name, facets)
    return probe if region else probe.with_region(np.zeros(len(probe.faces), np.int32))


# ---- the cases: each gives what was tried, and its figures for one seed -------------------------------------


def two(name: str, facets: int, count: int, rng: np.random.Generator) -> Measured:
    """Touch in two places at once, one pressed one to three times as hard as the other."""
    solver, body = ContactSolver(mesh(name, facets)), body_of(name)
    one, other = (draw_touches(body.surface, count, rng, above=body.above) for _ in range(2))
    wrenches = one.wrenches + other.wrenches / rng.uniform(1.0, 3.0, (count, 1))
    asked = ask(solver, one, add_noise(wrenches, solver.noise, rng))
    apart = np.linalg.norm(one.points - other.points, axis=1) > _APART_M
    from_both = asked.off(0.005) & (np.linalg.norm(asked.batch.points - other.points, axis=1) > 0.005)
    same_side = np.einsum("ni,ni->n", one.normals, other.normals) > 0.5
    return {
        "sure": float(asked.sure[apart].mean()),
        "sure and over 5 mm from both": float(np.mean((asked.sure & from_both)[apart])),
        "the same, touches of one side": float(np.mean((asked.sure & from_both)[apart & same_side])),
        "the same, others": float(np.mean((asked.sure & from_both)[apart & ~same_side])),
        "implausible": float(np.mean(asked.batch.reasons[apart] == Reason.IMPLAUSIBLE)),
    }


def single(
    name: str, facets: int, noise: WrenchNoise, torsion: float, count: int, rng: np.random.Generator
) -> Measured:
    """Touch once, 8 to 10 N: how often that is sure."""
    solver = ContactSolver(mesh(name, facets), noise)
    asked = press(body_of(name), solver, count, rng, torsion_arm=torsion)
    return {
        "sure": float(asked.sure.mean()),
        "sure, of these over 5 mm off": float(asked.off(0.005)[asked.sure].mean()),
        "ambiguous": asked.reason(Reason.AMBIGUOUS),
        "implausible": asked.reason(Reason.IMPLAUSIBLE),
    }


def reliability(
    name: str, facets: int, touched: str, count: int, rng: np.random.Generator
) -> tuple[Floats, Mask]:
    """Return confidence and whether the place was right, of all answers with a point; touched as `TOUCHED` names it."""
    probe = mesh(name, facets, region=touched != EVENLY)
    solver = ContactSolver(probe)
    where = {"above": float(probe.bounds[1, 2]) - _FACE_M, "facing": _FACING} if touched == LENS else {}
    drawn = where | {"force": (1.0, 12.0), "angle": (0.0, 15.0), "torsion_arm": solver.model.torsion_arm}
    asked = press(body_of(name), solver, count, rng, drift=True, **drawn)
    given = np.isfinite(asked.errors)
    return asked.batch.confidences[given], (_same_place(asked) | (asked.errors <= _NEAR_M))[given]


def _same_place(asked: Asked) -> Mask:
    """Tell which touches lie at the place of their answer, as the solver keeps places apart: across, and in depth."""
    off, normals = asked.touches.points - asked.batch.points, asked.batch.normals
    force = asked.wrenches[:, :3] / np.linalg.norm(asked.wrenches[:, :3], axis=1, keepdims=True)
    across = np.linalg.norm(np.cross(off, force), axis=1)
    height = np.abs(np.sum(off * normals, axis=1) / np.sum(force * normals, axis=1))
    return np.asarray(
        (across <= np.maximum(_NEAR_M, 4.5 * asked.batch.sigma_max)) & (height <= _DEPTH_M + _STEEP * across)
    )


def ellipse(
    name: str,
    facets: int,
    noise: WrenchNoise,
    torsion: float,
    count: int,
    rng: np.random.Generator,
    *,
    drift: bool,
) -> Measured:
    """Count true points in the 95 % ellipse of the sure answers that are not astray."""
    solver = ContactSolver(mesh(name, facets), noise)
    asked = press(body_of(name), solver, count, rng, torsion_arm=torsion, drift=drift)
    judged = asked.sure & ~asked.off(ASTRAY_M)
    # The covariance has no extent along the facet's normal: its two larger axes span the tangent plane.
    variances, axes = np.linalg.eigh(asked.batch.covariances[judged])
    off = np.einsum("nij,ni->nj", axes, (asked.batch.points - asked.touches.points)[judged])
    inside = np.sum(off[:, 1:] ** 2 / variances[:, 1:], axis=1) <= _ELLIPSE
    return {"inside": float(inside.mean()), "left out": float(1.0 - judged.mean())}

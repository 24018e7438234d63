"""Is single precision enough? The solver's own sources with every double a float, beside the usual build."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver, Gates, TouchModel, WrenchNoise
from contactbench.pipeline.contact.touch_model import DEFAULT_FORCE_N, DEFAULT_TORQUE_NM
from contactbench.pipeline.study import hard_meshes as hm

from . import builds, theory
from .theory import Row, Where

if TYPE_CHECKING:
    from contactbench.pipeline.study.hard_meshes import Body, Float

    from .builds import Workshop

PART = "precision"
APART = "point, single from double precision"
SHARE = "point, single from double precision, over one sigma of the default noise"
REASON, PLACE = "another reason", "another place, over 1 mm away"
INSIDE, STEEP, LARGE = "inside the friction cone", "steeper than the friction cone", "large local torque"
ANGLE, FACETS = "friction angle up to, degrees", "facets"
PITCH, FORCE = "local torque over force, m", "force, N"
BY = "single"
# Stated: a hundredth of what a force of 10 N scatters by, and so seldom another answer that noise hides it.
MOST_MM, MOST_SHARE = 0.01, 1.0
_CONE = Gates()
_FACETS = (500, 1000, 20_000, 100_000)


def run(
    samples: int,
    seed: int,
    workshop: Workshop,
    *,
    quick: bool = False,
) -> list[Row]:
    """Compare the precisions inside the friction cone, past it, and where the local torque is large."""
    rows: list[Row] = []
    for i, name in enumerate(assets.PROBE_NAMES):
        rng = np.random.default_rng((seed, i))
        for facets in _FACETS[:2] if quick else _FACETS:
            body = hm.bundled(name, facets)
            touches = theory.touch(body, samples, rng, angle=(0.0, 60.0))
            case = f"{name}, {INSIDE}"
            where: Where = {"x": len(body.faces), "axis": FACETS}
            rows += _compared(case, body, touches.wrenches, _CONE, workshop, judged=True, **where)
        rows += _on_one(name, samples, rng, workshop)
    return rows


def _on_one(name: str, samples: int, rng: np.random.Generator, workshop: Workshop) -> list[Row]:
    """Turn, twist and scale the wrench on a probe of 1,000 facets."""
    body, title = hm.bundled(name, 1000), name
    rows: list[Row] = []
    more: Where
    for low, high in ((60.0, 75.0), (75.0, 85.0), (85.0, 89.0), (89.0, 89.9)):
        touches = theory.touch(body, samples, rng, angle=(low, high))
        steep = high > _CONE.friction_angle
        gates = Gates(friction_angle=min(high + 0.5, 89.999)) if steep else _CONE
        case = f"{title}, {STEEP if steep else INSIDE}"
        rows += _compared(case, body, touches.wrenches, gates, workshop, judged=not steep, x=high, axis=ANGLE)
    for arm in (1e-3, 1e-2, 1e-1, 1.0):
        touches = theory.touch(body, samples, rng, arm=arm)
        case, model = f"{title}, {LARGE}", TouchModel(torsion_arm=arm)  # else nothing would explain it
        more = {"x": arm, "axis": PITCH}
        rows += _compared(case, body, touches.wrenches, _CONE, workshop, judged=False, model=model, **more)
    touches = theory.touch(body, samples, rng)
    for power in (-18, -12, -6, 0, 6, 12, 18):
        # What is left out of the wrench's model stays in proportion: under a weak force nothing else would be seen.
        gates, noise, size = Gates(min_force=0.0), WrenchNoise(0.0, 0.0), 10.0**power / 9.0
        model = TouchModel(model_error=WrenchNoise(DEFAULT_FORCE_N * size, DEFAULT_TORQUE_NM * size))
        case, wrenches = f"{title}, any force, no gate, no noise", size * touches.wrenches
        more = {"judged": abs(power) <= 12, "x": 10.0**power, "axis": FORCE}
        rows += _compared(case, body, wrenches, gates, workshop, noise=noise, model=model, **more)
    return rows


def _compared(
    case: str,
    body: Body,
    wrenches: Float,
    gates: Gates,
    workshop: Workshop,
    *,
    judged: bool,
    noise: WrenchNoise | None = None,
    model: TouchModel | None = None,
    **more: Any,
) -> list[Row]:
    solver = ContactSolver(body.probe(), noise or WrenchNoise(), gates, model)
    batch = solver.locate_batch(wrenches)
    double, single = builds.kernel_rows(batch), workshop.solve(builds.SINGLE, solver, wrenches)[0]
    off = 1e3 * np.linalg.norm(single["point"] - double["point"], axis=1)
    elsewhere = off > 1.0
    near = np.where(elsewhere, np.nan, off)
    another = double["reason"] != single["reason"]
    count = len(wrenches)
    rows = [
        Row.of(PART, case, BY, APART, "mm", near, most=MOST_MM if judged else None, **more),
        _share(case, REASON, int(another.sum()), count, judged, more),
        _share(case, PLACE, int(elsewhere.sum()), count, judged, more),
    ]
    if noise is None:
        rows.append(Row.of(PART, case, BY, SHARE, "", near / (1e3 * batch.sigma_max), **more))
    return rows


def _share(case: str, figure: str, found: int, tries: int, judged: bool, more: Where) -> Row:
    share = 100.0 * found / tries
    most = MOST_SHARE if judged else None
    return Row(PART, case, BY, figure, "%", tries, share, share, most=most, **more)

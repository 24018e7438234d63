"""Tables of the dynamic experiments, the paper's figures beside ours."""

from __future__ import annotations

from itertools import pairwise
from math import nan, sqrt
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.reproduce.dynamic_cells import FORCE_N, IN_PLANE, OUT_OF_PLANE
from benchmarks.reproduce.dynamic_paper import FORCES, TABLE_1, TABLE_2

from contactbench.pipeline.control.foundation import USUAL_MODULUS
from contactbench.pipeline.study.control_rig import foundation_of
from contactbench.pipeline.study.sheets import Cell as Value
from contactbench.pipeline.study.sheets import Sheet, short

if TYPE_CHECKING:
    from collections.abc import Sequence

    from benchmarks.reproduce.dynamic_cells import Outcome

_CROSS = "not followed"
_FOLLOWED = 0.999
_PAPER_ORDER = ("contactbench", "wrench_axis", "iterative")


def grouped(outcomes: Sequence[Outcome]) -> dict[tuple[str, str, float, str], list[Outcome]]:
    """Return the seeds of each (variant, motion, period, method), in the order they came."""
    groups: dict[tuple[str, str, float, str], list[Outcome]] = {}
    for outcome in outcomes:
        cell = outcome.cell
        groups.setdefault((str(cell.variant), cell.motion, cell.period, cell.method), []).append(outcome)
    return groups


def table_one(outcomes: Sequence[Outcome]) -> Sheet:
    """Return mean angle errors of our method, and the paper's of its method and of humans."""
    groups = grouped(outcomes)
    periods = sorted({o.cell.period for o in outcomes}, reverse=True)
    places = [(motion, period) for period in periods for motion in (IN_PLANE, OUT_OF_PLANE)]
    first = outcomes[0].cell.method
    rows: list[tuple[Value, ...]] = [
        (
            f"{first}, {variant}",
            *(_angle(groups.get((variant, motion, period, first))) for motion, period in places),
        )
        for variant in dict.fromkeys(str(o.cell.variant) for o in outcomes)
    ]
    for name, told in TABLE_1.items():
        rows.append((f"paper: {name}", *(_printed(told, place) for place in places)))
    columns = tuple(f"T={period:g} s {motion} deg" for motion, period in places)
    return Sheet("table-1", "Table I: mean absolute angle error", ("who", *columns), tuple(rows))


def table_two(outcomes: Sequence[Outcome]) -> Sheet:
    """Return angle and force of all methods, over the seeds, and the paper's."""
    rows: list[tuple[Value, ...]] = []
    for (variant, motion, period, method), mine in grouped(outcomes).items():
        printed = TABLE_2.get((method, motion, period), (nan, nan))
        forces = FORCES.get(motion) if (method, period) == ("contactbench", 10.0) else None
        rows.append(
            (
                variant,
                f"{period:g}",
                motion,
                method,
                _angle(mine),
                float(np.mean([o.angle[1] for o in mine])),
                float(np.std([o.angle[0] for o in mine])),
                *((_CROSS, nan) if printed is None else printed),
                min(o.force[0] for o in mine),
                max(o.force[2] for o in mine),
                *((nan, nan) if forces is None else forces),
                float(np.mean([o.other[0] for o in mine])),
                float(np.mean([o.place for o in mine])),
            )
        )
    columns = (
        "variant", "T s", "motion", "method", "error deg", "SD", "SD of seeds", "paper deg", "paper SD", "least N",
        "largest N", "paper least", "paper largest", "other axis deg", "place mm",
    )  # fmt: skip
    return Sheet("table-2", "Table II: all methods with the same gains and seeds", columns, tuple(rows))


def runs(outcomes: Sequence[Outcome]) -> Sheet:
    """Return every run."""
    rows = tuple(
        (
            str(o.cell.variant), o.cell.period, o.cell.motion, o.cell.method, o.cell.seed, o.followed, *o.force,
            *o.angle, *o.other, o.whole, o.first, o.lost, o.place, *o.torsion, o.speed, o.held, o.ended,
        )
        for o in outcomes
    )  # fmt: skip
    columns = (
        "variant", "T s", "motion", "method", "seed", "followed", "least N", "mean N", "largest N", "error deg",
        "SD deg", "other axis deg", "other SD deg", "whole angle deg", "largest before N", "lost", "place mm",
        "torsion Nmm", "axis shift mm", "joint speed", "limited", "why not followed",
    )  # fmt: skip
    return Sheet("runs", "Every run", columns, rows)


def order_notes(outcomes: Sequence[Outcome]) -> list[str]:
    """Say whether the methods come in the paper's order, and why not."""
    methods = list(dict.fromkeys(o.cell.method for o in outcomes))
    if not set(_PAPER_ORDER) <= set(methods):
        return []
    groups = grouped(outcomes)
    said = []
    for variant in dict.fromkeys(str(o.cell.variant) for o in outcomes):
        kept, apart, cases = 0, 0, 0
        for motion in (IN_PLANE, OUT_OF_PLANE):
            for period in sorted({o.cell.period for o in outcomes}):
                found = {m: groups[variant, motion, period, m] for m in _PAPER_ORDER}
                cases += 1
                means = [float(np.mean([o.angle[0] for o in found[m]])) for m in _PAPER_ORDER]
                kept += all(a < b for a, b in pairwise(means))
                apart += any(_differs(found[_PAPER_ORDER[0]], found[m]) for m in _PAPER_ORDER[1:])
        said.append(
            f"{variant}: the paper's order ({' before '.join(_PAPER_ORDER)}) holds in {kept} of {cases} cases; in"
            f" {apart} does another method differ from the first by more than three standard errors of the paired"
            " seeds."
        )
    return [*said, _why_equal(outcomes, methods)]


def _why_equal(outcomes: Sequence[Outcome], methods: Sequence[str]) -> str:
    """Say what a contact of this scene leaves methods to differ by."""
    place = {m: float(np.nanmean([o.place for o in outcomes if o.cell.method == m])) for m in methods}
    listed = ", ".join(f"{m} {short(value)} mm" for m, value in place.items())
    torsion, shift = np.nanmean([o.torsion for o in outcomes], axis=0).tolist()
    press = foundation_of(outcomes[0].cell.probe).at(FORCE_N, USUAL_MODULUS)
    within, across = (float(np.degrees(1e-3 * shift / gain)) for gain in (press.gain_x, press.gain_y))
    lost = (
        "less than one degree: the order cannot come from it here. A flat soft phantom that does not spin twists no"
        " probe; the paper's differences must come from what this scene leaves out: time that a method takes, a surface"
        " that is fitted worse, or tissue that twists the probe."
        if max(within, across) < 1
        else "enough to tell methods apart that neglect it."
    )
    return (
        f"From sensed to true contact (RMS): {listed}. The true contact's torque about its own normal is"
        f" {short(torsion)} N·mm (RMS). It moves the wrench's axis by {short(shift)} mm, which a place alone would take"
        f" for {short(within)} degrees of tilt in plane and {short(across)} out of plane: {lost} The aware variant"
        " takes its tilt from where the force leans, too, which is the same for every method."
    )


def _angle(mine: Sequence[Outcome] | None) -> Value:
    if not mine:
        return nan
    if min(o.followed for o in mine) < _FOLLOWED:
        return _CROSS
    return float(np.mean([o.angle[0] for o in mine]))


def _printed(told: dict[tuple[str, float], float | None], place: tuple[str, float]) -> Value:
    value = told.get(place, nan)
    return _CROSS if value is None else value


def _differs(one: Sequence[Outcome], other: Sequence[Outcome]) -> bool:
    apart = np.array([b.angle[0] - a.angle[0] for a, b in zip(one, other, strict=True)])
    if len(apart) < 2:
        return bool(abs(apart[0]) > 0.1 * one[0].angle[0])
    return bool(abs(apart.mean()) > 3 * apart.std(ddof=1) / sqrt(len(apart)))

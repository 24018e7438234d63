"""Tables and pictures of the dynamic experiments, the paper's figures beside ours."""

from __future__ import annotations

from itertools import pairwise
from math import nan, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.reproduce.dynamic_cells import FORCE_N, IN_PLANE, MOTIONS, OUT_OF_PLANE, START_S, VERTICAL
from benchmarks.trials import canvas, png

from contactbench.pipeline.control.settings import USUAL_MODULUS
from contactbench.pipeline.study.gain_trials import foundation_of
from contactbench.pipeline.study.report import Cell as Value
from contactbench.pipeline.study.report import Sheet, short

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from benchmarks.reproduce.dynamic_cells import Cell, Outcome

    from contactbench.pipeline.control.loop import Trace

# (motion, period s) -> degrees; None: the robot could not follow.
TABLE_1: dict[str, dict[tuple[str, float], float | None]] = {
    "proposed method": {
        (IN_PLANE, 10.0): 1.26,
        (OUT_OF_PLANE, 10.0): 1.55,
        (IN_PLANE, 5.0): 3.97,
        (OUT_OF_PLANE, 5.0): 4.65,
        (IN_PLANE, 2.0): None,
        (OUT_OF_PLANE, 2.0): None,
    },
    "human, with eyes": {
        (IN_PLANE, 10.0): 0.62,
        (OUT_OF_PLANE, 10.0): 0.83,
        (IN_PLANE, 5.0): 1.24,
        (OUT_OF_PLANE, 5.0): 1.78,
        (IN_PLANE, 2.0): 2.87,
        (OUT_OF_PLANE, 2.0): 3.96,
    },
    "human, by touch": {
        (IN_PLANE, 10.0): 1.34,
        (OUT_OF_PLANE, 10.0): 1.98,
        (IN_PLANE, 5.0): 2.69,
        (OUT_OF_PLANE, 5.0): 3.86,
        (IN_PLANE, 2.0): 3.89,
        (OUT_OF_PLANE, 2.0): 4.62,
    },
}
# (method, motion, period s) -> mean and SD, degrees; None: could not follow.
TABLE_2: dict[tuple[str, str, float], tuple[float, float] | None] = {
    ("contactbench", IN_PLANE, 10.0): (1.53, 1.47),
    ("contactbench", OUT_OF_PLANE, 10.0): (1.87, 1.38),
    ("contactbench", IN_PLANE, 5.0): (3.34, 2.53),
    ("contactbench", OUT_OF_PLANE, 5.0): (3.74, 2.28),
    ("iterative", IN_PLANE, 10.0): (3.35, 2.54),
    ("iterative", OUT_OF_PLANE, 10.0): (2.73, 1.40),
    ("iterative", IN_PLANE, 5.0): (5.37, 4.15),
    ("iterative", OUT_OF_PLANE, 5.0): (5.15, 3.89),
    ("wrench_axis", IN_PLANE, 10.0): (2.27, 1.72),
    ("wrench_axis", OUT_OF_PLANE, 10.0): (2.68, 1.87),
    ("wrench_axis", IN_PLANE, 5.0): (4.43, 3.23),
    ("wrench_axis", OUT_OF_PLANE, 5.0): None,
}
# At T = 10 s, N.
FORCES = {VERTICAL: (5.23, 8.83), IN_PLANE: (6.04, 8.26), OUT_OF_PLANE: (5.46, 8.48)}

DIFFERENCES = (
    (
        "The paper's phantom is real, of a stiffness that it does not give; ours is a bed of springs of 3e6 N/m³ (2"
        " N/mm for the convex probe at 7 N), flat, without waves, slow creep or tissue that moves sideways. With it a"
        " contact has next to no torque about its own normal."
    ),
    (
        "The paper says neither its gains nor its noise. Ours are 6/s for force and angle, which gives its force range"
        " and angle errors of the same size; the noise (0.05 N, 1.4 N·mm a reading) is inferred from its scatter."
    ),
    (
        "Gravity and bias are taken off by a calibration from eight poses of a virtual sensor, and the rest of the"
        " bias in the air before the touch, for half a second: the paper tells only of the first."
    ),
    (
        "Errors are those between the probe's true axis and the phantom's true normal at the same instant, in the"
        " plane of the motion, from the platform's first moment on. The paper aligns two clocks and takes the axis from"
        " the robot's joint angles: bending of its arm and a clock's offset are in its figures, not in ours."
    ),
    (
        "The platform begins with a jump in speed, as Eq. 11 does: the first moments are in all means and ranges, which"
        " makes them larger than those of steady motion."
    ),
    (
        "The scene `platform` has a stiff mount in place of an arm; `arm` has an Elfin3 with a servo of 60 rad/s and"
        " its limits of speed, acceleration and torque, but without friction and bending."
    ),
    (
        "The phantom `flat` is the paper's, with gel (friction 0.1). `twisting` is dry skin (0.6) that slides by 5 mm"
        " and spins by 20 degrees to either side with the motion; `curved` is a dry cylinder of 100 mm radius, 45"
        " degrees askew, that slides by 5 mm. On both the paper has no figures."
    ),
    "Everything is computed within the sampling instant: no method pays for the time that it takes.",
)


_CROSS = "not followed"
_FOLLOWED = 0.999
_PAPER_ORDER = ("contactbench", "wrench_axis", "iterative")


def grouped(outcomes: Sequence[Outcome]) -> dict[tuple[str, str, str, float, str], list[Outcome]]:
    """Return the seeds of each (variant, phantom, motion, period, method), in the order they came."""
    groups: dict[tuple[str, str, str, float, str], list[Outcome]] = {}
    for outcome in outcomes:
        cell = outcome.cell
        place = (str(cell.variant), cell.phantom, cell.motion, cell.period, cell.method)
        groups.setdefault(place, []).append(outcome)
    return groups


def table_one(outcomes: Sequence[Outcome]) -> Sheet:
    """Return mean angle errors of our method, and the paper's of its method and of humans."""
    groups = grouped(outcomes)
    periods = sorted({o.cell.period for o in outcomes}, reverse=True)
    places = [(motion, period) for period in periods for motion in (IN_PLANE, OUT_OF_PLANE)]
    first = outcomes[0].cell.method
    rows: list[tuple[Value, ...]] = [
        (
            f"{first}, {variant}, {phantom}",
            *(_angle(groups.get((variant, phantom, motion, period, first))) for motion, period in places),
        )
        for variant, phantom in dict.fromkeys((str(o.cell.variant), o.cell.phantom) for o in outcomes)
    ]
    for name, told in TABLE_1.items():
        rows.append((f"paper: {name}", *(_printed(told, place) for place in places)))
    columns = tuple(f"T={period:g} s {motion} deg" for motion, period in places)
    return Sheet("table-1", "Table I: mean absolute angle error", ("who", *columns), tuple(rows))


def table_two(outcomes: Sequence[Outcome]) -> Sheet:
    """Return angle and force of all methods, over the seeds, and the paper's."""
    rows: list[tuple[Value, ...]] = []
    for (variant, phantom, motion, period, method), mine in grouped(outcomes).items():
        flat = phantom == "flat"
        printed = TABLE_2.get((method, motion, period), (nan, nan)) if flat else (nan, nan)
        forces = FORCES.get(motion) if flat and (method, period) == ("contactbench", 10.0) else None
        angles = [o.angle[0] for o in mine]
        rows.append(
            (
                phantom,
                variant,
                f"{period:g}",
                motion,
                method,
                len(mine),
                _angle(mine),
                f"{short(min(angles))} to {short(max(angles))}",
                float(np.mean([o.angle[1] for o in mine])),
                *((_CROSS, nan) if printed is None else printed),
                min(o.force[0] for o in mine),
                max(o.force[2] for o in mine),
                *((nan, nan) if forces is None else forces),
                float(np.mean([o.other[0] for o in mine])),
                float(np.mean([o.place for o in mine])),
                float(np.mean([o.torsion[0] for o in mine])),
            )
        )
    columns = (
        "phantom", "variant", "T s", "motion", "method", "seeds", "error deg", "over seeds", "SD", "paper deg",
        "paper SD", "least N", "largest N", "paper least", "paper largest", "other axis deg", "place mm", "torsion Nmm",
    )  # fmt: skip
    return Sheet("table-2", "Table II: all methods with the same gains and seeds", columns, tuple(rows))


def runs(outcomes: Sequence[Outcome]) -> Sheet:
    """Return every run."""
    rows = tuple(
        (
            o.cell.phantom, str(o.cell.variant), o.cell.period, o.cell.motion, o.cell.method, o.cell.seed, o.followed,
            *o.force, *o.angle, *o.other, o.whole, o.first, o.lost, o.place, *o.torsion, o.speed, o.held, o.ended,
        )
        for o in outcomes
    )  # fmt: skip
    columns = (
        "phantom", "variant", "T s", "motion", "method", "seed", "followed", "least N", "mean N", "largest N",
        "error deg", "SD deg", "other axis deg", "other SD deg", "whole angle deg", "largest before N", "lost",
        "place mm", "torsion Nmm", "axis shift mm", "joint speed", "limited", "why not followed",
    )  # fmt: skip
    return Sheet("runs", "Every run", columns, rows, shown=False)


def order_notes(outcomes: Sequence[Outcome]) -> list[str]:
    """Say whether the methods come in the paper's order on one phantom, and why not."""
    methods = list(dict.fromkeys(o.cell.method for o in outcomes))
    if not set(_PAPER_ORDER) <= set(methods):
        return []
    groups, phantom = grouped(outcomes), outcomes[0].cell.phantom
    said = []
    for variant in dict.fromkeys(str(o.cell.variant) for o in outcomes):
        kept, apart, cases = 0, 0, 0
        for motion in (IN_PLANE, OUT_OF_PLANE):
            for period in sorted({o.cell.period for o in outcomes if o.cell.motion == motion}):
                found = {m: groups[variant, phantom, motion, period, m] for m in _PAPER_ORDER}
                cases += 1
                means = [float(np.mean([o.angle[0] for o in found[m]])) for m in _PAPER_ORDER]
                kept += all(a < b for a, b in pairwise(means))
                apart += any(_differs(found[_PAPER_ORDER[0]], found[m]) for m in _PAPER_ORDER[1:])
        said.append(
            f"{phantom}, {variant}: the paper's order ({' before '.join(_PAPER_ORDER)}) holds in {kept} of {cases}"
            f" cases; in {apart} does another method differ from the first by more than three standard errors of the"
            " paired seeds."
        )
    return [*said, f"{phantom}: {_why_equal(outcomes, methods)}"]


def _why_equal(outcomes: Sequence[Outcome], methods: Sequence[str]) -> str:
    """Say what a contact of this scene leaves methods to differ by."""
    place = {m: float(np.nanmean([o.place for o in outcomes if o.cell.method == m])) for m in methods}
    listed = ", ".join(f"{m} {short(value)} mm" for m, value in place.items())
    torsion, shift = np.nanmean([o.torsion for o in outcomes], axis=0).tolist()
    press = foundation_of(outcomes[0].cell.probe).at(FORCE_N, USUAL_MODULUS)
    within, across = (float(np.degrees(1e-3 * shift / gain)) for gain in (press.gain_x, press.gain_y))
    lost = (
        "less than one degree: the order cannot come from it here. A soft phantom that does not spin hardly twists a"
        " probe; the paper's differences must come from what this scene leaves out: time that a method takes, a surface"
        " that is fitted worse, or tissue that twists the probe, as the phantom `twisting` does."
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


_COLOURS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
_BARS = ("#0072b2", "#56b4e9", "#e69f00", "#009e73")
_PHANTOM, _BAND = "#303030", "#b0b0b0"


def draw_course(traces: Mapping[Cell, Trace]) -> bytes:
    """Draw force, and height or angle, against time for the slowest motion, as a PNG image."""
    made = [motion for motion in MOTIONS if any(cell.motion == motion for cell in traces)]
    figure = canvas(14, 1 + 3 * len(made))
    panels = figure.subplots(len(made), 2, sharex=True, squeeze=False)
    slowest = max(cell.period for cell in traces)
    for row, motion in zip(panels, made, strict=True):
        shown = {c: t for c, t in traces.items() if (c.motion, c.period) == (motion, slowest)}
        column = list(MOTIONS).index(motion)
        unit, what = ("mm", "height") if column == 0 else ("deg", "angle")
        for number, (cell, trace) in enumerate(shown.items()):
            seen = trace.between(START_S - 1)
            time, name = seen.time - START_S, f"{cell.phantom}, {cell.variant}"
            colour = _COLOURS[number % len(_COLOURS)]
            row[0].plot(time, seen.force, color=colour, lw=1, label=name)
            if number == 0:
                row[1].plot(time, _path(seen.phantom, column), color=_PHANTOM, lw=1.5, label="phantom")
            row[1].plot(time, _path(seen.probe, column), color=colour, lw=1, label=f"probe, {name}")
        low, high = FORCES[motion]
        if slowest == 10.0:
            row[0].axhspan(low, high, color=_BAND, alpha=0.3, label="paper's range")
        row[0].set(title=f"{motion}, T = {slowest:g} s", ylabel="force, N")
        row[1].set(title=f"{what} of phantom and probe", ylabel=unit)
        for panel in row:
            panel.legend(fontsize=8)
            panel.grid(alpha=0.3)
    for panel in panels[-1]:
        panel.set_xlabel("s since the platform began to move")
    return png(figure)


def draw_methods(outcomes: Sequence[Outcome]) -> bytes:
    """Draw mean angle errors of all methods, with their scatter over the seeds, as a PNG image."""
    figure = canvas(14, 5)
    panels = figure.subplots(1, 2, sharey=True)
    periods = sorted({o.cell.period for o in outcomes}, reverse=True)
    methods = list(dict.fromkeys(o.cell.method for o in outcomes))
    variants = list(dict.fromkeys(str(o.cell.variant) for o in outcomes))
    width = 0.8 / (len(methods) * len(variants))
    places = list(dict.fromkeys((o.cell.phantom, T) for o in outcomes for T in periods))
    groups = grouped(outcomes)
    for panel, motion in zip(panels, (IN_PLANE, OUT_OF_PLANE), strict=True):
        for k, (variant, method) in enumerate((v, m) for v in variants for m in methods):
            cells = [groups.get((variant, phantom, motion, T, method), []) for phantom, T in places]
            found = [[o.angle[0] for o in cell] or [nan] for cell in cells]
            panel.bar(
                np.arange(len(places)) + (k + 0.5) * width - 0.4,
                [np.mean(each) for each in found],
                width,
                yerr=[np.std(each) for each in found],
                color=_BARS[methods.index(method) % len(_BARS)],
                hatch="//" if variant == "plain" else None,
                label=f"{method}, {variant}",
            )
        panel.set_xticks(range(len(places)), [f"{phantom}, T = {T:g} s" for phantom, T in places])
        panel.set(title=motion, ylabel="mean absolute angle error, deg")
        panel.grid(axis="y", alpha=0.3)
    panels[1].legend(fontsize=8)
    return png(figure)


def _path(body: Any, column: int) -> Any:
    return 1e3 * (body[:, 0] - body[0, 0]) if column == 0 else np.degrees(body[:, column])

"""What the figures come to, in sentences."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.study.stability import amplification as am
from contactbench.pipeline.study.stability import bias, edges, exact, precision, repeat, thin, units
from contactbench.pipeline.study.stability import rounding as ro
from contactbench.pipeline.study.stability.rows import PARTS, Row, of_part

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

_ENOUGH_MM = precision.MOST_MM
_FIRST_ORDER_HOLDS = 1.1
_NONE = float("nan")


@dataclass(frozen=True)
class Verdict:
    """
    One sentence.

    Attributes
    ----------
    part : str
        A key of :data:`PARTS`.
    words : str
    passed : bool or None
        Whether the bounds behind it were kept; None where nothing was measured.
    """

    part: str
    words: str
    passed: bool | None


def verdicts(rows: Iterable[Row]) -> list[Verdict]:
    """Return a verdict on each part."""
    every = list(rows)
    said = []
    for part in PARTS:
        own = of_part(every, part)
        words = _WORDS[part](own) if own else "Not measured: there is no g++ to build the solver with."
        broken = [row for row in own if not row.met]
        if broken:
            words += " BROKEN: " + "; ".join(_broken(row) for row in broken[:3])
            words += f" and {len(broken) - 3} more." if len(broken) > 3 else "."
        said.append(Verdict(part, words, not broken if own else None))
    return said


def number(value: float) -> str:
    """Return a figure for people: three digits."""
    return "-" if not np.isfinite(value) else f"{value:.3g}"


def _broken(row: Row) -> str:
    place = "" if row.x is None else f" at {number(row.x)} ({row.axis})"
    most = number(row.most or 0.0)
    return f"{row.case}, {row.by}: {row.figure} {number(row.worst)} {row.unit}{place}, allowed {most}"


def _furthest(rows: Sequence[Row], limit: float, **which: str) -> float:
    """Return the last x, from the first row on, up to which `worst` stays within a limit."""
    last = float("nan")
    for row in (r for r in rows if all(getattr(r, k) == v for k, v in which.items())):
        if not row.worst <= limit:
            break
        last = row.x if row.x is not None else last
    return last


def _amplification(rows: Sequence[Row]) -> str:
    name = [row.case for row in rows if row.figure == am.CONDITION][-1]
    ordinary = {row.x: row for row in rows if row.figure == am.CONDITION and row.case == name}
    along, slanted = ordinary[0.0], ordinary[75.0]
    measured, predicted = (
        {r.x: r.worst for r in rows if r.figure == am.SPREAD and r.by == by and r.x}
        for by in (am.MEASURED, am.PREDICTED)
    )
    fits = [x for x, value in predicted.items() if value <= _FIRST_ORDER_HOLDS * measured[x]]
    return (
        f"A small error of the wrench moves the point as first-order theory says, to {_said(rows, figure=am.OFF)} %,"
        f" from cosines of the friction angle of 1 to {min(am.COSINES):g} and from forces of 100 to 1e-6 N: as 1 /"
        f" cosine and as 1 / force. On {name} an error of 1 % moves it by up to {number(10 * along.median)} mm"
        f" (median) along the normal, {number(10 * slanted.median)} mm at 75 degrees and"
        f" {number(10 * slanted.worst)} mm at worst. With the default noise, first order holds within 10 %"
        f" down to {number(min(fits, default=_NONE))} N; the gate for low forces is at 0.5 N."
    )


def _rounding(rows: Sequence[Row]) -> str:
    steep = "ellipsoid, force turned towards the facet"
    ordinary = [row for row in rows if row.case != steep]
    parts = [
        f"{_said(rows, figure=ro.RATIO, by=by)} roundoffs times the condition in {by} precision"
        for by in _precisions(rows)
    ]
    finest = max((r.x or 0.0 for r in rows if r.axis == ro.FACETS), default=0.0)
    return (
        f"An answer is off by at most {' and '.join(parts)} (stated: {ro.MOST_ROUNDOFFS:g}), up to {finest:,.0f}"
        f" facets. In double that is {_said(ordinary, figure=ro.ERROR, by=ro.DOUBLE)} mm for ordinary touches, up to"
        f" 10 m from the sensor, and {_said(rows, figure=ro.ERROR, by=ro.DOUBLE, case=steep)} mm for a force that"
        f" grazes the facet at a cosine of {min(am.COSINES):g}. The 4 x 4 elimination of Algorithm 1 is off by up to"
        f" {_said(rows, figure=ro.RATIO, by=ro.ALGORITHM1)} of the same roundoffs."
    )


def _edges(rows: Sequence[Row]) -> str:
    sure = []
    for by in _precisions(rows):
        right = [r.x or 0.0 for r in rows if r.figure == edges.OTHER and r.by == by and r.worst == 0]
        sure.append(f"{number(min(right, default=_NONE))} of the edge's length in {by} precision")
    unanswered = sum(r.worst for r in rows if r.figure == edges.UNANSWERED)
    on_edges, on_vertices = (
        _said(rows, figure=edges.REFUSED, by=ro.DOUBLE, case=f"T-shape, next to {place} points")
        for place in ("edge", "vertex")
    )
    jump = {r.x: r.median for r in rows if r.figure == edges.JUMP and r.by == edges.MEASURED}
    return (
        f"Next to edges and vertices {unanswered:.0f} touches go unanswered. The facet that was pressed answers down"
        f" to {' and '.join(sure)} from them. Nearer, rounding decides, and on the T-shape's sharp rims it names the"
        f" wall behind, too steep to answer: {on_edges} % on edges and {on_vertices} % on vertices are refused."
        " Across an edge the answer steps along it by |h| |n1 x n2| / (|n1.f| |n2.f|), to"
        f" {_said(rows, figure=edges.JUMP_OFF)} %: {number(jump.get(0.3, _NONE))} mm (median) for a local torque of"
        " 0.3 mm times the force on 1,280 facets."
    )


def _precision(rows: Sequence[Row]) -> str:
    inside = [r for r in rows if precision.INSIDE in r.case]
    finest = max((r.x or 0.0 for r in inside if r.axis == precision.FACETS), default=0.0)
    steep = [r for r in rows if r.figure == precision.APART and r.axis == precision.ANGLE]
    fits = [r.x for r in steep if r.x and all(s.worst <= _ENOUGH_MM for s in steep if s.x == r.x)]
    twisted = [r for r in rows if r.axis == precision.PITCH and r.x == 1.0]
    enough = "is enough" if all(row.met for row in rows) else "is not always enough"
    return (
        f"Single precision {enough} inside the friction cone of 75 degrees, up to {finest:,.0f} facets: worst"
        f" {_said(inside, figure=precision.APART)} mm from double, {_said(inside, figure=precision.SHARE)} of the"
        f" default noise, and another reason in {_said(inside, figure=precision.REASON)} % of answers. It stays"
        f" within {_ENOUGH_MM:g} mm up to {max(fits, default=_NONE):g} degrees from the normal, where the cone"
        f" is opened (worst {_said(steep)} mm at {max((r.x or 0.0 for r in steep), default=_NONE):g}); with a"
        f" local torque of 1 m times the force it is {_said(twisted, figure=precision.APART)} mm off. Where it is not"
        " enough: thin facets and biases, below."
    )


def _thin(rows: Sequence[Row]) -> str:
    parts = []
    for by in _precisions(rows):
        fits = [
            _furthest(rows, _ENOUGH_MM, case=kind, by=by, figure=thin.FROM_TRUTH)
            for kind in (thin.CAP, thin.NEEDLE)
        ]
        refused = [r.x or 0.0 for r in rows if r.figure == thin.REFUSED and r.by == by]
        parts.append(
            f"in {by} precision down to heights of {number(max(fits))} of the longest edge (from"
            f" {number(max(refused, default=_NONE))} on the mesh is refused)"
        )
    judged = [r for r in rows if r.figure == thin.FROM_TRUTH and r.most is not None]
    slender = [f"{number(1.0 / r.worst)} ({r.case})" for r in rows if r.figure == thin.SLENDER]
    return (
        f"Points on thin facets are right to {_ENOUGH_MM:g} mm {' and '.join(parts)}. Stated for double precision:"
        f" {thin.MOST_MM:g} mm down to 1e-8; worst {_said(judged)} mm."
        f" The thinnest facets of the probes are {', '.join(slender)} of their longest edge high."
    )


def _units(rows: Sequence[Row]) -> str:
    parts = [f"{_said(rows, figure=units.ROUNDING, by=by)} in {by}" for by in _precisions(rows)]
    bits = sum(r.worst for r in rows if r.figure == units.DIFFER and r.most is not None)
    return (
        f"In µm, mm, m and km, and with forces from 1e-9 to 1e9 of a newton, {_said(rows, figure=units.REASON)} % of"
        " answers get another reason, and points are off by, unscaled, of the probe's size, at most"
        f" {' and '.join(parts)} precision. Lengths or forces times a power of two change {bits:.0f} answers by any"
        " bit. The solver's own tolerances have no unit: of the probe's size, 1e-14 (a facet without area) and 1e-6 (a"
        " deviation that is always expected), and a cosine of 1e-3 (edge-on). Those with a unit are the gates (0.5 N,"
        " 5 mm, 10 mm, saturation), the 3 mm from which on a surface lies behind another, the noise, the torsion arm,"
        " the mesh's deviation, and what a probe may measure (5 mm to 2 m, within 1e9 m): with gates left in metres,"
        f" {_said(rows, figure=units.FORGOTTEN)} % of answers get another reason."
    )


def _bias(rows: Sequence[Row]) -> str:
    fits = {
        by: _furthest(rows, _ENOUGH_MM, by=by, figure=bias.ERROR) for by in (ro.DOUBLE, bias.WIRE, ro.SINGLE)
    }
    parts = [f"{number(most)} times the contact ({by})" for by, most in fits.items() if np.isfinite(most)]
    judged = [r for r in rows if r.figure == bias.OVER and r.most is not None]
    return (
        "A bias costs the roundoff of the reading times 1 + bias / contact times the condition, at most"
        f" {_said(judged)} times that. The point stays within {_ENOUGH_MM:g} mm up to a bias of {', '.join(parts)}."
    )


def _exact(rows: Sequence[Row]) -> str:
    changed = sum(int(r.worst) for r in rows if r.figure == exact.OTHERWISE)
    lost = sum(int(r.worst) for r in rows if r.figure == exact.NONE)
    tries = sum(r.tries for r in rows if r.figure == exact.NONE)
    return (
        f"Against rational numbers, {tries:,} wrenches: answers are right to"
        f" {_said(rows, figure=exact.ERROR, by=exact.DOUBLE)} mm over the cosine of the friction angle; long double,"
        f" the judge elsewhere, to {_said(rows, figure=exact.ERROR, by=exact.LONG)} mm. Rounding decided {changed}"
        f" times whether a facet answers, at most {_said(rows, figure=exact.DEPTH)} mm from its edge; {lost} wrenches"
        " lost their answer, and two answers of one wrench on a convex body are at most"
        f" {_said(rows, figure=exact.SPREAD)} mm apart."
    )


def _repeat(rows: Sequence[Row]) -> str:
    judged = [r for r in rows if r.figure == repeat.DIFFER and r.most is not None]
    shown = [r for r in rows if r.figure == repeat.DIFFER and r.most is None]
    words = (
        f"{sum(r.worst for r in judged):.0f} of {judged[0].tries:,} answers differ in any bit, each on its own and"
        f" tracked: {', '.join(dict.fromkeys(r.by for r in judged))}."
    )
    if shown:
        most = max(shown, key=lambda r: r.worst)
        apart = [r.median for r in rows if r.figure == repeat.APART]
        words += (
            f" With fused multiply-adds ({most.by}), which the kernel's build forbids, {most.worst:,.0f} differ, by"
            f" {number(max(apart))} mm in the median, and {_said(rows, figure=repeat.REASON)} get another reason: the"
            " two facets at an edge no longer agree on its moment, and touches on it can fall between them."
        )
    return words


def _precisions(rows: Sequence[Row]) -> list[str]:
    return [by for by in (ro.DOUBLE, ro.SINGLE) if any(row.by == by for row in rows)]


def _said(rows: Sequence[Row], **which: str) -> str:
    """Return the largest `worst` of the rows whose fields are as given, for people."""
    found = [
        r.worst for r in rows if all(getattr(r, k) == v for k, v in which.items()) and np.isfinite(r.worst)
    ]
    return number(max(found, default=_NONE))


_WORDS: dict[str, Callable[[Sequence[Row]], str]] = {
    "amplification": _amplification,
    "rounding": _rounding,
    "edges": _edges,
    "precision": _precision,
    "thin facets": _thin,
    "units": _units,
    "bias": _bias,
    "exact": _exact,
    "repeatability": _repeat,
}

"""The tables of the static experiments, with the paper's figures beside ours."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.marker_touches import ACROSS, ANGLES, IN_PLANE, PERPENDICULAR
from benchmarks.reproduce.located import OURS, distances_mm

from contactbench.pipeline.study.report import Sheet

if TYPE_CHECKING:
    from collections.abc import Sequence

    from benchmarks.reproduce.located import Attributed, Effect, Explained, ForceErrors, ProbeResult
    from numpy.typing import NDArray

    from contactbench.pipeline.study.report import Cell

PAPER_PROBE = "t-shape"  # of its angles, forces and times

# Mean ± SD, mm.
PAPER = {
    ("t-shape", PERPENDICULAR): "0.94 ± 0.49",
    ("t-shape", IN_PLANE): "1.6 ± 0.6",
    ("t-shape", ACROSS): "2.0 ± 0.5 (largest of all 3.10)",
    ("linear", PERPENDICULAR): "1.28 ± 0.44",
    ("convex", PERPENDICULAR): "0.91 ± 0.24",
}
_PAPER_FORCE = {1.0: "largest 3.5, SD 1.4", 20.0: "SD 0.08"}
_PAPER_TIMES = "570 ± 310, largest 890"

DIFFERENCES = (
    (
        "The truth is the physics' contact point, not a mark seen by a camera. Distances to the marker are given too,"
        " and how far from it the tip comes to rest."
    ),
    (
        "The markers are ours: five along the acoustic face, the others spread over the sides of the head; the paper"
        " shows its own only in a photograph."
    ),
    (
        "The probe is rigid and sits rigidly on its sensor; mount, housing and camera do not err. What they could add"
        " is in the table of causes."
    ),
    (
        "The tip is a ball of 1.5 mm that holds by friction of 1 and turns about the normal; the paper's is a printed"
        " stylus."
    ),
    "The noise (0.05 N, 1.4 N·mm a reading) is inferred from the paper's scatter at 1 N: it gives no noise.",
    (
        "Gravity is calibrated from 8 planned poses of one second each, simulated by their sums of weight, bias and"
        " noise because a resting scene reads just these; the paper took more than three. The sensor was on for an"
        " hour before."
    ),
    (
        "Readings are taken half a second into a touch at rest with a force drawn from 8 to 10 N; the paper took them"
        " while the force passed through that range."
    ),
    "Times are of compiled code on this machine and on this mesh; the paper's are of its own program and mesh.",
)


def errors_sheet(probes: Sequence[ProbeResult]) -> Sheet:
    """Every probe, angle and method."""
    rows: list[tuple[Cell, ...]] = []
    for result in probes:
        for (angle, method), e in result.errors.items():
            paper = PAPER.get((result.name, angle), "") if method == OURS else ""
            rows.append(
                (result.name, angle, method, e.touches, e.mean, e.sd, e.largest, e.to_marker, e.bound)
                + (e.over_bound, 100 * e.answered, 100 * e.sure, 100 * e.ambiguous)
                + (e.common, e.common_mean, e.common_largest, paper)
            )
    columns = ("probe", "angle", "method", "touches", "mean mm", "SD mm", "largest mm", "to marker mm")
    more = ("bound mm", "over bound", "answered %", "without doubt %", "ambiguous %")
    common = ("answered by all", "their mean mm", "their largest mm", "paper mm")
    return Sheet("errors", "Errors of location", (*columns, *more, *common), tuple(rows))


def markers_sheet(probes: Sequence[ProbeResult]) -> Sheet:
    """Mean and SD by marker and angle, our method."""
    rows: list[tuple[Cell, ...]] = []
    for result in probes:
        error = distances_mm(result.located[OURS].points, result.touched.points)
        for marker in np.unique(result.touched.markers).tolist():
            at = [
                error[(result.touched.markers == marker) & (result.touched.angles == k)]
                for k in range(len(ANGLES))
            ]
            place = (1e3 * result.touched.targets[result.touched.markers == marker][0]).round(3).tolist()
            figures = [f(each) for each in at for f in (_mean, _sd)]
            rows.append((result.name, marker, *place, *figures))
    columns = tuple(f"{what} {angle} mm" for angle in ANGLES for what in ("mean", "SD"))
    return Sheet(
        "markers",
        "Errors by marker (contactbench)",
        ("probe", "marker", "x", "y", "z", *columns),
        tuple(rows),
    )


def forces_sheet(name: str, forces: Sequence[ForceErrors]) -> Sheet:
    """Marker 3 at several forces."""
    paper = _PAPER_FORCE if name == PAPER_PROBE else {}
    rows = tuple(
        (one.angle, one.force, one.errors.touches, one.errors.mean, one.errors.sd, one.errors.largest)
        + (one.errors.bound, one.errors.over_bound, paper.get(one.force, ""))
        for one in forces
    )
    columns = ("angle", "force N", "readings", "mean mm", "SD mm", "largest mm", "bound mm", "over bound")
    return Sheet(
        "forces", f"Errors by force at marker 3 of the {name} (contactbench)", (*columns, "paper mm"), rows
    )


def force_errors_sheet(errors: NDArray[Any]) -> Sheet:
    """Compare the filtered force with the true one."""
    rows: list[tuple[Cell, ...]] = [(str(n + 1), *map(float, each)) for n, each in enumerate(errors)]
    rows.append(("all", *map(float, errors.mean(axis=0))))
    columns = ("marker", *(f"{angle} N" for angle in ANGLES))
    return Sheet("force_errors", "Mean error of the filtered force, 5 to 20 N", columns, tuple(rows))


def causes_sheet(attributed: Sequence[Attributed], explained: Explained | None) -> Sheet:
    """Tell what each cause adds, and what would give the paper's figures where they are of this probe."""
    rows: list[tuple[Cell, ...]] = [
        (one.cause, *one.means, *one.added, *one.ratios[1:], max(one.largest)) for one in attributed
    ]
    if explained is not None:
        blank = [None] * len(ANGLES)
        ratios = [mean / explained.means[0] for mean in explained.means[1:]]
        fitted = (
            f"fitted: markers {explained.reference_mm:.2f} mm off, mount {explained.stiffness:.0f} N·m/rad"
        )
        rows.append((fitted, *explained.means, *blank, *ratios, None))
        rows.append(("paper", 0.9, 1.6, 2.0, *blank, 1.6 / 0.9, 2.0 / 0.9, 3.10))
    columns = (
        "cause",
        *(f"mean {angle} mm" for angle in ANGLES),
        *(f"adds {angle} mm" for angle in ANGLES),
        "in plane over perpendicular",
        "across over perpendicular",
        "largest mm",
    )
    title = "Where errors at an angle come from: distance to the marker"
    return Sheet("causes", title, columns, tuple(rows))


def effects_sheet(effects: Sequence[Effect]) -> Sheet:
    """Tell what the scene leaves out."""
    rows = tuple(
        (one.change, 1e3 * one.shift, 1e3 * one.most, 1e3 * one.located, 1e3 * one.most_located)
        for one in effects
    )
    columns = ("scene", "contact moves µm", "most µm", "located off, no noise µm", "most µm ")
    return Sheet("left_out", "What the scene leaves out", columns, rows)


def times_sheet(probes: Sequence[ProbeResult]) -> Sheet:
    """Compiled times."""
    rows: list[tuple[Cell, ...]] = [
        (result.name, method, float(np.median(us)), float(us.mean()), float(us.std()), float(us.max()), "")
        for result in probes
        for method, us in result.times_us.items()
    ]
    if any(result.name == PAPER_PROBE for result in probes):
        rows.append((PAPER_PROBE, "paper", None, None, None, None, _PAPER_TIMES))
    columns = ("probe", "method", "median µs", "mean µs", "SD µs", "largest µs", "paper µs")
    return Sheet("times", "Time of a solve, compiled", columns, tuple(rows), shown=False)


def _mean(values: NDArray[np.float64]) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if len(finite) else float("nan")


def _sd(values: NDArray[np.float64]) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.std()) if len(finite) else float("nan")

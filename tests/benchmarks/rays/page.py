"""The tables and the picture of a touch beside a ray query."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.rays.contenders import (
    ALL,
    ANSWERS,
    BATCH,
    BVH,
    EMBREEX,
    FCPW,
    OPEN3D,
    OURS,
    PAIR,
    SINGLE,
    TRIMESH,
)
from matplotlib import rc_context
from matplotlib.figure import Figure as Picture
from matplotlib.ticker import FormatStrFormatter, NullFormatter

from contactbench.pipeline.study.pages import COLOURS, STYLE, environment, origin, png
from contactbench.pipeline.study.report import Sheet, StudyReport

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from typing import Any

    from benchmarks.rays.contest import OnMesh
    from numpy.typing import NDArray

    from contactbench.pipeline.study.report import Cell, Figure

    Float = NDArray[np.float64]

OURS_ALL, OURS_SURE = "contactbench, all answers", "contactbench, sure answers"
RAY_FIRST, RAY_BEST = "ray, first hit", "ray, of all hits the one nearest to the truth"
COLD, TRACKING = "each at a new place", "tracking"
PICTURE = "rays-speed-error.png"
_NEAR_M, _FAR_M = 1e-3, 5e-3
_COMMAND = "packaging/run benchmark rays --bvh DIR --write docs/validation/rays.md"
_ABOUT = (
    "Touches lie all over the probe above its mount (8 to 10 N, up to 30 degrees, torsion of 0.3 mm times the force),"
    " with noise of 0.05 N and 0.002 N·m. A ray is the wrench axis of the same reading, from outside along the force."
    " All are asked in turn, round by round, each round at new places; ratios are of the same round. Times are"
    " processor time of the thread that computes, for two threads by the wall; FCPW's batch takes all cores, and the"
    " time of all of them counts. Two threads are judged by the least time of one over the least time of two, because"
    " whatever else runs only adds to either; what they would be with a core each is twice the processor time of one"
    " over that of both. Single solves are timed by the wall, the same touches in each round, and judged by each"
    " touch's median over the rounds, so that interrupts do not count."
)
_ABOUT_ERRORS = (
    "A ray tracer answers no wrench, but a line, and has no doubt: where the line of force meets the probe more than"
    " once, its first hit may be the wrong one, without a warning. All hits mostly hold the right one, but do not say"
    " which it is: in the table of errors who knows the truth has chosen. The bound is what noise alone leaves unknown"
    " of a touch. In the picture, of all hits the first counts; each line runs over the sizes of the mesh."
)


@dataclass(frozen=True, eq=False)
class Errors:
    """How far answers on one mesh are from the true touches."""

    # whose -> (touches,) distances, m, inf for no answer, and what noise alone leaves unknown of each, m
    found: dict[str, tuple[Float, Float]]
    hits: float  # that a ray has on average; NaN where nobody lists them

    def mean_mm(self, whose: str) -> float:
        """Mean of the answers that there are."""
        off = self.found[whose][0]
        return 1e3 * float(np.mean(off[np.isfinite(off)]))


def report(
    settings: Mapping[str, Any],
    measured: Sequence[OnMesh],
    errors: Mapping[int, Errors],
    figures: tuple[Figure, ...],
    absent: Mapping[str, str],
) -> StudyReport:
    """Put everything together."""
    missing = [f"Left out: {name} ({why})." for name, why in absent.items()]
    notes = (_ABOUT, *missing, "", _ABOUT_ERRORS, "", origin(environment(), _COMMAND))
    sheets = (
        *(_times(measured, calls) for calls in (BATCH, PAIR, SINGLE)),
        *(_ratios(measured, calls) for calls in (BATCH, PAIR, SINGLE)),
        _solves(measured),
        _errors(errors),
        _answers(measured),
        _everything(measured),
    )
    title = "A touch beside a ray query"
    return StudyReport(title, dict(settings), figures, notes, sheets, {PICTURE: _picture(measured, errors)})


def _keys(measured: Sequence[OnMesh], calls: str) -> list[tuple[str, str, str]]:
    return [key for key in measured[0].clocks if key[2] == calls]


def _times(measured: Sequence[OnMesh], calls: str) -> Sheet:
    columns = ("who", *(f"{mesh.facets:,}" for mesh in measured))
    rows = [(_who(key), *(_spread(mesh.taken(key)) for mesh in measured)) for key in _keys(measured, calls)]
    name = f"times-{_plain(calls)}"
    return Sheet(name, f"µs each, {calls}: median (least to most) by facets", columns, tuple(rows))


def _ratios(measured: Sequence[OnMesh], calls: str) -> Sheet:
    own = OURS, "", calls
    rows = [
        (_who(key), *(_spread(mesh.taken(own) / mesh.taken(key)) for mesh in measured))
        for key in _keys(measured, calls)
        if key != own
    ]
    columns = ("over", *(f"{mesh.facets:,}" for mesh in measured))
    return Sheet(f"ratios-{_plain(calls)}", f"A touch over others, {calls}, by facets", columns, tuple(rows))


def _solves(measured: Sequence[OnMesh]) -> Sheet:
    rows = [
        (
            name,
            f"{mesh.facets:,}",
            _spread(mesh.medians(name) / 1e3),
            mesh.own_tail(name),
            _spread(mesh.tails(name)),
        )
        for name in (COLD, TRACKING)
        for mesh in measured
    ]
    columns = (
        "solves",
        "facets",
        "median, µs",
        "99 % over median",
        "99 % over median, as each round measured it",
    )
    return Sheet("solves", "Single solves of the kernel, all sizes in turn", columns, tuple(rows))


def _errors(errors: Mapping[int, Errors]) -> Sheet:
    rows: list[tuple[Cell, ...]] = []
    for facets, each in errors.items():
        touches = len(each.found[OURS_ALL][0])
        for name, (off, bound) in each.found.items():
            shares = (
                *(len(off) / touches, np.mean(off <= _NEAR_M), np.mean(off <= bound)),
                *(np.mean(np.isfinite(off) & (off > _FAR_M)), np.mean(~np.isfinite(off))),
            )
            own, near, within, far, none = (100 * float(share) for share in shares)
            middle, most = (1e3 * float(np.percentile(off, share)) for share in (50, 95))
            rows.append((f"{facets:,}", name, own, near, within, each.mean_mm(name), middle, most, far, none))
    columns = (
        *("facets", "answers", "of all touches, %", "within 1 mm, %", "within the noise bound, %"),
        *("mean mm", "median mm", "95 % mm", "beyond 5 mm, %", "no answer, %"),
    )
    hits = ", ".join(f"{each.hits:.2f}" for each in errors.values() if np.isfinite(each.hits))
    title = f"Distance from the true touch; hits of a ray, by facets: {hits or 'not listed'}"
    return Sheet("errors", title, columns, tuple(rows))


def _answers(measured: Sequence[OnMesh]) -> Sheet:
    there = dict.fromkeys(key[:2] for key in measured[0].clocks)
    rows = [(" ".join(key).rstrip(), ANSWERS[key]) for key in there]
    return Sheet("answers", "What an answer holds", ("who", "answer"), tuple(rows))


def _everything(measured: Sequence[OnMesh]) -> Sheet:
    rows = [
        (
            mesh.facets,
            *key,
            float(np.median(us)),
            float(us.min()),
            float(us.max()),
            float(np.median(mesh.walls(key))),
        )
        for mesh in measured
        for key in mesh.clocks
        for us in [mesh.taken(key)]
    ]
    columns = ("facets", "who", "query", "calls", "median_us", "least_us", "most_us", "median_wall_us")
    return Sheet("times", "Times", columns, tuple(rows), shown=False)


def _who(key: tuple[str, str, str]) -> str:
    return f"{key[0]}, {key[1]}" if key[1] else f"**{key[0]}**"


def _plain(calls: str) -> str:
    return calls.replace(", ", "-").replace(" ", "-")


def _spread(values: Float) -> str:
    middle, least, most = float(np.median(values)), float(values.min()), float(values.max())
    return f"{middle:.3g} ({least:.3g} to {most:.3g})"


_MARKS = {OURS: "o", OPEN3D: "^", EMBREEX: "v", TRIMESH: "D", BVH: "P", FCPW: "X"}


def _picture(measured: Sequence[OnMesh], errors: Mapping[int, Errors]) -> bytes:
    """Draw time against mean error, a line for each who over the sizes; all and sure answers of ours."""
    with rc_context(STYLE):
        picture = Picture(figsize=(8.6, 4.4), dpi=110, layout="constrained")
        for axes, calls in zip(picture.subplots(1, 2, sharey=True), (BATCH, SINGLE), strict=True):
            for key in _keys(measured, calls):
                if key[0] in _MARKS:
                    _line(axes, measured, errors, key)
            axes.set(xscale="log", xlabel="µs each", title=calls, ylim=(0, None))
            axes.xaxis.set_major_formatter(FormatStrFormatter("%g"))
            axes.xaxis.set_minor_formatter(NullFormatter())
        picture.axes[0].set_ylabel("mean error, mm")
        shown: dict[str, Any] = {}
        for axes in picture.axes:
            shown |= {line.get_label(): line for line in axes.get_legend_handles_labels()[0]}
        picture.legend(shown.values(), shown, loc="outside lower center", ncols=4, fontsize=7)
        return png(picture)


def _line(
    axes: Any, measured: Sequence[OnMesh], errors: Mapping[int, Errors], key: tuple[str, str, str]
) -> None:
    name, query, _ = key
    colour, mark = COLOURS[[*_MARKS].index(name)], _MARKS[name]
    us = [float(np.median(mesh.taken(key))) for mesh in measured]
    lines = [(RAY_FIRST, f"{name}, {query}", "none" if query == ALL else colour)]
    if not query:
        lines = [
            (OURS_ALL, "contactbench, all answers", "none"),
            (OURS_SURE, "contactbench, sure answers", colour),
        ]
    for whose, label, face in lines:
        if any(whose not in each.found for each in errors.values()):
            continue
        mm = [errors[mesh.facets].mean_mm(whose) for mesh in measured]
        axes.plot(us, mm, ":" if face == "none" else "-", marker=mark, c=colour, mfc=face, label=label)
        if whose == OURS_SURE:
            for at in (0, -1):
                text = f"{measured[at].facets:,} facets"
                axes.annotate(
                    text,
                    (us[at], mm[at]),
                    (0, 4),
                    textcoords="offset points",
                    fontsize=6,
                    c=colour,
                    rotation=60,
                )

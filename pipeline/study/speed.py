"""Speed against error: every method on the same mesh and the same touches, in one run."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver, Reason, WrenchNoise, methods
from contactbench.pipeline.contact.wrench_axis import EmbreeAxis
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation import add_noise, draw_slide, draw_touches
from contactbench.pipeline.simulation.marker_touches import model_of
from contactbench.pipeline.study.pages import table
from contactbench.pipeline.study.report import FigureVerdict, verdict_of
from contactbench.pipeline.study.sweep.scores import bound_of
from contactbench.pipeline.timing import Timing, time_calls

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray
    from rich.table import Table

    from contactbench.pipeline.contact.methods import ContactMethod
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.simulation import Touches

DEFAULT_FACETS = (500, 1_000, 20_000, 100_000)

# The literal loop costs up to a millisecond a solve: enough of them for a p99, not for a coffee break.
_SLOW_SAMPLES = 400
_BATCH = "Python, batch"
_TOGETHER = 500  # wrenches, or rays, of a batch from Python
_PAST_M, _MISSED = 1e-6, 1e30  # behind a hit the next ray begins; Embree's distance of none is 1e37


@dataclass(frozen=True)
class SpeedRow:
    """One method on one mesh."""

    # method, language: ``C++``: compiled solves in a batch; ``Python``: one call at a time; ``Python,
    # batch``: 500 in one call
    method: str
    language: str
    facets: int
    timing: Timing  # nanoseconds a solve
    # mean_mm, p95_mm, max_mm: error against the true surface, over touches that got a point; None where
    # only time was measured
    mean_mm: float | None = None
    p95_mm: float | None = None
    max_mm: float | None = None
    over_bound: float | None = None  # root mean square error over the noise bound's, over settled touches
    # share of touches whose answer was accepted: without doubt, or because of the declared lens. Rivals
    # know no doubt.
    settled: float | None = None
    answered: float | None = None  # share of touches that got a point


@dataclass(frozen=True)
class SpeedTarget:
    """A figure to reach: measured against its limit."""

    name: str
    measured: float
    limit: float
    at_least: bool = False

    @property
    def verdict(self) -> FigureVerdict:
        """Whether the measured figure is within the limit."""
        least, most = (self.limit, None) if self.at_least else (None, self.limit)
        return verdict_of(self.measured, least=least, most=most)

    @property
    def cells(self) -> list[str]:
        """It as a row of a table."""
        limit = f"{'at least' if self.at_least else 'at most'} {self.limit:g}"
        return [self.name, f"{self.measured:.3g}", limit, str(self.verdict)]


@dataclass(frozen=True)
class SpeedReport:
    """Everything that :func:`run` measured."""

    probe: str
    seed: int
    touches: int
    rows: list[SpeedRow]
    targets: list[SpeedTarget]
    stream_samples: int
    stream_differences: int

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        data = asdict(self)
        for entry, target in zip(data["targets"], self.targets, strict=True):
            entry["verdict"] = str(target.verdict)
        return data

    @property
    def passed(self) -> bool:
        """Whether tracking and cold solves never differed."""
        return not self.stream_differences

    def tables(self) -> list[Table]:
        """Return the measurements, the targets and the stream comparison for a terminal."""
        title = f"{self.probe}, {self.touches:,} touches, seed {self.seed}"
        measured = _table(title, _COLUMNS, [_cells(row) for row in self.rows])
        targets = _table("Ratios, all from this run", _TARGETS, [target.cells for target in self.targets])
        targets.caption = self._stream
        return [measured, targets]

    def markdown(self) -> str:
        """Return the same as Markdown."""
        parts = [
            f"# Speed against error: {self.probe}",
            f"{self.touches:,} touches, seed {self.seed}. {self._stream}",
            table(_COLUMNS, [_cells(row) for row in self.rows]),
            table(_TARGETS, [target.cells for target in self.targets]),
        ]
        return "\n\n".join(parts) + "\n"

    @property
    def _stream(self) -> str:
        if not self.stream_samples:
            return "Tracking was not compared with cold solves."
        return (
            f"Tracking differed from cold solves on {self.stream_differences} samples"
            f" of a {self.stream_samples:,}-sample stream, over all resolutions."
        )


def run(
    probe: str = "t-shape",
    facets: Sequence[int] = DEFAULT_FACETS,
    *,
    touches: int = 10_000,
    stream: int = 1_000_000,
    rounds: int = 40,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> SpeedReport:
    """Measure every method at every resolution.

    Parameters
    ----------
    probe : str
        A bundled probe.
    facets : sequence of int
        Resolutions, ascending.
    touches : int
        Simulated touches (8-10 N, up to 30 degrees, paper-like noise) for errors and compiled times.
    stream : int
        Samples of the sliding stream on which tracking must equal a cold solve; 0 to skip.
    rounds : int
        Blocks of 250 Python calls for each method.
    seed : int
        Of the touches and the noise.
    progress : callable
        Told in words what is being measured.

    Raises
    ------
    InputError
        There is no such probe, too few touches, or two resolutions within 5 % of each other.
    """
    if probe not in assets.PROBE_NAMES:
        raise InputError(
            f"there is no bundled probe {probe!r}; choose one of {', '.join(assets.PROBE_NAMES)}"
        )
    for low, high in pairwise(sorted(facets)):
        if high < 1.05 * low:
            raise InputError(f"facets: {low} and {high} are too close to tell apart; leave one out")
    if touches < 1_000:
        raise InputError(f"touches: {touches} are too few for a p99; give at least 1000")
    rng = np.random.default_rng(seed)
    noise = WrenchNoise()
    truth = draw_touches(assets.surface(probe), touches, rng, above=0.02)
    wrenches = add_noise(truth.wrenches, noise, rng)
    sliding = add_noise(draw_slide(assets.surface(probe), max(stream, 20_000), rng).wrenches, noise, rng)
    rows: list[SpeedRow] = []
    differences = 0
    for count in facets:
        progress(f"{count:,} facets")
        body = model_of(probe, count)
        rows += _compiled_rows(body, noise, truth, wrenches, sliding)
        rows += _python_rows(body, noise, wrenches, sliding, rounds)
        if stream:
            progress(f"{count:,} facets: tracking against cold solves on {stream:,} samples")
            differences += stream_differences(ContactSolver(body, noise), sliding[:stream])
    return SpeedReport(probe, seed, touches, rows, _targets(rows, facets), stream, differences)


def stream_differences(solver: ContactSolver, wrenches: NDArray[np.float64]) -> int:
    """Count samples of a stream on which ``track`` and ``locate`` with the same previous contact differ.

    Every sample is solved twice: tracked in one batch, and cold with the contact that tracking followed
    at that moment. Reason, face, vertex, number of candidates, point and local torque must agree to the
    last bit. A second touch that joins the followed one is told by tracking alone.
    """
    solver.reset()
    tracked = solver.track_batch(wrenches)
    cold = solver.locate_batch_after(
        wrenches, _followed(tracked.accepted, tracked.points, solver.gates.recent_samples)
    )
    same, joined = np.ones(len(wrenches), dtype=bool), tracked.reasons == Reason.TWO_TOUCHES
    for name in ("reasons", "faces", "vertices", "candidates", "points", "torques"):
        a, b = getattr(tracked, name), getattr(cold, name)
        equal = (a == b) | (np.isnan(a) & np.isnan(b)) if a.dtype == np.float64 else a == b
        same &= equal.reshape(len(wrenches), -1).all(axis=1)
    return int(np.count_nonzero(~(same | joined)))


def _followed(accepted: NDArray[np.bool_], points: NDArray[np.float64], recent: int) -> NDArray[np.float64]:
    """Return (n, 3) the last accepted contact before each sample, NaN where none is recent."""
    rows = np.arange(len(accepted))
    last = np.maximum.accumulate(np.where(accepted, rows, -1))
    before = np.concatenate([[-1], last[:-1]])
    misses = rows - 1 - before
    known = (before >= 0) & (misses <= recent)
    return np.where(known[:, None], points[np.maximum(before, 0)], np.nan)


def _compiled_rows(
    probe: Probe,
    noise: WrenchNoise,
    truth: Touches,
    wrenches: NDArray[np.float64],
    sliding: NDArray[np.float64],
) -> list[SpeedRow]:
    rows = []
    bound = bound_of(truth, np.sqrt(np.diag(noise.covariance)))
    for name in ("algorithm1", "iterative", "scan", "contactbench"):
        method = methods.make(name, probe, noise)
        slow = name == "algorithm1" or (name == "scan" and len(probe.faces) > 5_000)
        few = wrenches[:_SLOW_SAMPLES] if slow else wrenches
        method.engine.time_each(few[:100])
        timing = Timing.of(method.engine.time_each(few))
        rows.append(_scored(method, "C++", probe, timing, truth, wrenches, bound))
        if name == "contactbench":
            method.engine.time_tracking(sliding[:1_000])
            tracking = Timing.of(method.engine.time_tracking(sliding[:20_000]))
            rows.append(SpeedRow("contactbench, tracking", "C++", len(probe.faces), tracking))
    return rows


def _scored(
    method: ContactMethod,
    language: str,
    probe: Probe,
    timing: Timing,
    truth: Touches,
    wrenches: NDArray[np.float64],
    bound: NDArray[np.float64],
) -> SpeedRow:
    batch = method.locate_batch(wrenches)
    error = np.linalg.norm(batch.points - truth.points, axis=1)
    seen = np.isfinite(error)
    settled = batch.accepted
    limit = np.sqrt(np.mean(bound[settled]))
    mm = 1e3 * error[seen]
    return SpeedRow(
        method.name,
        language,
        len(probe.faces),
        timing,
        float(mm.mean()),
        float(np.percentile(mm, 95)),
        float(mm.max()),
        float(np.sqrt(np.mean(error[settled] ** 2)) / limit),
        float(settled.mean()),
        float(seen.mean()),
    )


def _python_rows(
    probe: Probe, noise: WrenchNoise, wrenches: NDArray[np.float64], sliding: NDArray[np.float64], rounds: int
) -> list[SpeedRow]:
    solver = ContactSolver(probe, noise)
    cold, stream = list(wrenches[:5_000]), list(sliding[:20_000])
    calls: dict[str, tuple[Callable[[Any], object], Sequence[Any]]] = {
        "contactbench": (solver.locate, cold),
        "contactbench, tracking": (solver.track, stream),
    }
    together: dict[str, tuple[Callable[[Any], object], Sequence[Any]]] = {
        "contactbench": (solver.locate_batch, [wrenches[i : i + _TOGETHER] for i in _starts(wrenches)])
    }
    try:
        axis = EmbreeAxis(solver)
    except InputError:
        pass  # the ratios to Embree are left out, and the report says so
    else:
        origins, directions = axis.rays(wrenches)
        trace = partial(axis.scene.run, query="INTERSECT")
        rays = [(origins[i : i + 1], directions[i : i + 1]) for i in range(len(cold))]
        calls["embree, one ray"] = (lambda ray: trace(ray[0], ray[1]), rays)
        many = [(origins[i : i + _TOGETHER], directions[i : i + _TOGETHER]) for i in _starts(wrenches)]
        together["embree, first hit"] = (lambda ray: trace(ray[0], ray[1]), many)
        together["embree, every hit"] = (lambda ray: every_hit(axis, ray[0], ray[1]), many)
    size = len(probe.faces)
    rows = [
        SpeedRow(name, "Python", size, timing) for name, timing in time_calls(calls, rounds=rounds).items()
    ]
    for name, timing in time_calls(together, rounds=rounds, block=2).items():
        each = Timing(timing.median / _TOGETHER, timing.p99 / _TOGETHER)
        rows.append(SpeedRow(name, _BATCH, size, each))
    return rows


def _starts(wrenches: NDArray[np.float64]) -> range:
    return range(0, len(wrenches) - _TOGETHER + 1, _TOGETHER)


def every_hit(
    axis: EmbreeAxis, origins: NDArray[np.float32], directions: NDArray[np.float32]
) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
    """
    Return all places where rays (n, 3), (n, 3) meet the mesh: which ray (k,), and how far along it (k,), m.

    Embree is asked again from behind each hit, all rays that are left in one call.
    """
    left, begun = np.arange(len(origins)), np.zeros(len(origins), np.float32)
    rays, distances = [], []
    while len(left):
        start = origins[left] + begun[left, None] * directions[left]
        met = axis.scene.run(start, directions[left], query="DISTANCE")
        hit = met < _MISSED
        left = left[hit]
        begun[left] += met[hit] + np.float32(_PAST_M)
        rays.append(left)
        distances.append(begun[left])
    return np.concatenate(rays), np.concatenate(distances)


def _targets(rows: Sequence[SpeedRow], facets: Sequence[int]) -> list[SpeedTarget]:
    median = {(r.method, r.language, i): r.timing.median for r, i in _indexed(rows, facets)}
    targets = []
    for count in facets:
        embree = median.get(("embree, one ray", "Python", count))
        if embree:
            cold = median["contactbench", "Python", count] / embree
            tracking = median["contactbench, tracking", "Python", count] / embree
            targets.append(
                SpeedTarget(f"locate over one Embree ray, from Python, {count:,} facets", cold, 1.5)
            )
            targets.append(
                SpeedTarget(f"track over one Embree ray, from Python, {count:,} facets", tracking, 0.7)
            )
        ratio = median["algorithm1", "C++", count] / median["contactbench", "C++", count]
        limit = {500: 30.0, 20_000: 400.0}.get(count)
        if limit:
            targets.append(
                SpeedTarget(
                    f"Algorithm 1 over contactbench, C++, {count:,} facets", ratio, limit, at_least=True
                )
            )
    if 1_000 in facets and 100_000 in facets:
        for method, limit in (("contactbench", 6.0), ("contactbench, tracking", 2.5)):
            for language in ("C++", "Python"):
                growth = median[method, language, 100_000] / median[method, language, 1_000]
                targets.append(
                    SpeedTarget(f"growth of {method} from 1k to 100k facets, {language}", growth, limit)
                )
    for r, count in _indexed(rows, facets):
        if r.method.startswith("contactbench") and r.language != _BATCH:
            spread = r.timing.p99 / r.timing.median
            targets.append(
                SpeedTarget(f"p99 over median of {r.method}, {r.language}, {count:,} facets", spread, 4.0)
            )
    return targets


def _indexed(rows: Sequence[SpeedRow], facets: Sequence[int]) -> list[tuple[SpeedRow, int]]:
    """Pair each row with the requested facet count its mesh came nearest to."""
    return [(r, min(facets, key=lambda count: abs(count - r.facets))) for r in rows]


# ---- as text ---------------------------------------------------------------------------------------

_COLUMNS = (
    "method",
    "from",
    "facets",
    "median µs",
    "p99 µs",
    "mean mm",
    "p95 mm",
    "max mm",
    "rms/bound, settled",
    "settled %",
    "answered %",
)
_TARGETS = ("figure", "measured", "target", "")


def _cells(row: SpeedRow) -> list[str]:
    def number(value: float | None, digits: str = ".2f") -> str:
        return "" if value is None else format(value, digits)

    def percent(value: float | None) -> str:
        return number(None if value is None else 100 * value, ".1f")

    return [
        row.method,
        row.language,
        f"{row.facets:,}",
        f"{row.timing.median / 1e3:.3g}",
        f"{row.timing.p99 / 1e3:.3g}",
        number(row.mean_mm),
        number(row.p95_mm),
        number(row.max_mm, ".1f"),
        number(row.over_bound),
        percent(row.settled),
        percent(row.answered),
    ]


def _table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> Table:
    from rich.table import Table

    built = Table(title=title)
    for i, column in enumerate(columns):
        built.add_column(column, justify="left" if i == 0 else "right")
    for row in rows:
        built.add_row(*row)
    return built

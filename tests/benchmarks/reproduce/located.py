"""Touches of markers located by every method: errors against the truth, and by force and cause."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.marker_touches import ANGLES, MarkerStation, held, row, stack
from benchmarks.reproduce.readings import COLD_S, filtered_noise, noise_at, read_touches
from benchmarks.trials import rms
from scipy.spatial.transform import Rotation

from contactbench import assets
from contactbench.pipeline.calibration.suggest import contact_sensitivity
from contactbench.pipeline.contact import Reason, WrenchNoise
from contactbench.pipeline.contact.methods import METHODS, make
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import TRUE_FACETS, model_of, truth_of
from contactbench.pipeline.simulation.scenes.indenter import STEP_S, BenchScene, Tip, TipPress, TouchScene
from contactbench.pipeline.study.gain_trials import draw_sensor

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from benchmarks.marker_touches import Touched
    from numpy.typing import NDArray

    from contactbench.pipeline.contact import Batch
    from contactbench.pipeline.contact.methods import ContactMethod
    from contactbench.pipeline.simulation.scenes.physics import SceneMoment
    from contactbench.pipeline.study.gain_trials import CalibratedSensor


@dataclass(frozen=True)
class Errors:
    """
    Errors of some touches; mm, NaN where there is none.

    Nothing is left aside: a touch counts wherever a point is named, with the first of several that are as likely.
    """

    touches: int
    # Shares of the touches: with a point, with a point and no doubt, and with the warning that another is
    # as likely
    answered: float
    # Shares of the touches: with a point, with a point and no doubt, and with the warning that another is
    # as likely
    sure: float
    # Shares of the touches: with a point, with a point and no doubt, and with the warning that another is
    # as likely
    ambiguous: float
    mean: float  # Distance to the true contact
    sd: float  # Distance to the true contact
    largest: float  # Distance to the true contact
    to_marker: float  # Mean distance to the marker
    bound: float  # Root mean square that noise after the filter and the calibration alone give
    over_bound: float  # Root mean square distance over it
    common: int  # Touches that every method names a point for
    common_mean: float  # Distance to the true contact over those
    common_largest: float  # Distance to the true contact over those


@dataclass(frozen=True, eq=False)
class Located:
    """Answers of one method, a row per touch."""

    points: NDArray[np.float64]  # (n, 3). S, m; NaN without an answer.
    reasons: NDArray[np.uint8]  # (n,)

    @classmethod
    def of(cls, batch: Batch) -> Located:
        """Copy what is needed of a batch."""
        return cls(batch.points.copy(), batch.reasons.copy())

    @classmethod
    def joined(cls, parts: list[Located]) -> Located:
        """Put answers one behind the other."""
        return cls(np.concatenate([p.points for p in parts]), np.concatenate([p.reasons for p in parts]))

    @property
    def settled(self) -> NDArray[np.bool_]:
        """Which are given without doubt, (n,); the declared region may have decided."""
        return np.isin(self.reasons, (Reason.OK, Reason.VERTEX, Reason.BY_REGION))

    @property
    def answered(self) -> NDArray[np.bool_]:
        """Which have a point, doubtful or not, (n,)."""
        return np.asarray(np.isfinite(self.points).all(axis=1))

    def where(self, chosen: NDArray[np.bool_]) -> Located:
        """Return some rows."""
        return Located(self.points[chosen], self.reasons[chosen])


def bounds_m(touched: Touched, bench: CalibratedSensor) -> NDArray[np.float64]:
    """Return the root mean square error that noise and calibration alone give to each touch, (n,), m."""
    covariances = noise_at(bench, touched.R_WS)
    squares = [
        np.trace(J @ C @ J.T)
        for J, C in (
            (contact_sensitivity(p, n, w[None, :3])[0], C)
            for p, n, w, C in zip(touched.points, touched.normals, touched.contacts, covariances, strict=True)
        )
    ]
    return np.asarray(np.sqrt(squares))


def distances_mm(points: NDArray[np.float64], truth: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far points (n, 3) are from others, (n,), mm."""
    return np.asarray(1e3 * np.linalg.norm(points - truth, axis=1))


def errors_of(
    located: Located, touched: Touched, bounds: NDArray[np.float64], common: NDArray[np.bool_] | None = None
) -> Errors:
    """Sum up the answers to touches."""
    answered = located.answered
    every = answered if common is None else common
    share, sure = float(answered.mean()), float(located.settled.mean())
    ambiguous = float((located.reasons == Reason.AMBIGUOUS).mean())
    if not answered.any():
        return Errors(len(touched), share, sure, ambiguous, nan, nan, nan, nan, nan, nan, 0, nan, nan)
    error = distances_mm(located.points, touched.points)
    bound = 1e3 * rms(bounds[answered])
    shared = error[every]
    return Errors(
        len(touched),
        share,
        sure,
        ambiguous,
        float(error[answered].mean()),
        float(error[answered].std()),
        float(error[answered].max()),
        float(distances_mm(located.points, touched.targets)[answered].mean()),
        bound,
        rms(error[answered]) / bound,
        len(shared),
        float(shared.mean()) if len(shared) else nan,
        float(shared.max()) if len(shared) else nan,
    )


OURS, LITERAL = "contactbench", "algorithm1"


@dataclass(frozen=True, eq=False)
class ProbeResult:
    """All methods on one probe."""

    name: str
    touched: Touched
    bounds: NDArray[np.float64]  # (n,). m.
    located: dict[str, Located]  # By method
    errors: dict[tuple[str, str], Errors]  # dict of (angle, method) to Errors
    # dict of str to (n,). Compiled time of each solve, by method; without those that have none.
    times_us: dict[str, NDArray[np.float64]]
    notes: tuple[str, ...]  # Methods that are left out


def solver_for(
    method: str, name: str, facets: int, bench: CalibratedSensor, R_WS: NDArray[np.float64]
) -> ContactMethod:
    """Build a method that knows the filtered noise and what the calibration leaves, averaged over the touches."""
    extra = bench.calibration.model.wrench_covariance(R_WS).mean(axis=0)
    left = filtered_noise(bench)
    return make(method, model_of(name, facets), WrenchNoise(left.force, left.torque, extra))


def key_of(name: str) -> int:
    """Return the key of a probe's noise: its own, whichever others are asked for."""
    return assets.PROBE_NAMES.index(name)


def locate_all(name: str, facets: int, touched: Touched, benches: Sequence[CalibratedSensor]) -> ProbeResult:
    """Read, compensate and filter every touch with the bench of its seed, and locate it with every method."""
    parts: dict[str, list[Located]] = {method: [] for method in METHODS}
    times: dict[str, list[NDArray[np.float64]]] = {method: [] for method in METHODS}
    bounds, notes = [], {}
    for bench in benches:
        mine = touched.where(touched.seeds == bench.seed)
        wrenches = read_touches(bench, mine.contacts, mine.R_WS, key_of(name))
        bounds.append(bounds_m(mine, bench))
        for method in METHODS:
            try:
                built = solver_for(method, name, facets, bench, mine.R_WS)
            except InputError as error:
                notes[method] = f"{method} is left out: {error}."
                continue
            parts[method].append(Located.of(built.locate_batch(wrenches)))
            engine: Any = built.engine
            if hasattr(engine, "time_each"):
                times[method].append(np.asarray(engine.time_each(wrenches)) / 1e3)
    located = {method: Located.joined(each) for method, each in parts.items() if each}
    limit = np.concatenate(bounds)
    # Every method is also judged on the same touches: to answer only the easy ones must not look better.
    common = np.all([each.answered for each in located.values()], axis=0)
    errors = {
        (angle, method): _errors_at(answers, touched, limit, common, touched.angles == index)
        for index, angle in enumerate(ANGLES)
        for method, answers in located.items()
    }
    timed = {method: np.concatenate(each) for method, each in times.items() if each}
    return ProbeResult(name, touched, limit, located, errors, timed, tuple(notes.values()))


def _errors_at(
    located: Located,
    touched: Touched,
    bounds: NDArray[np.float64],
    common: NDArray[np.bool_],
    rows: NDArray[np.bool_],
) -> Errors:
    return errors_of(located.where(rows), touched.where(rows), bounds[rows], common[rows])


FORCES_N = (1.0, 2.0, 5.0, 10.0, 15.0, 20.0)
RISING_N = (5.0, 10.0, 15.0, 20.0)
MARKER = 3
_READINGS = 20  # of each touch and seed, with fresh noise


@dataclass(frozen=True, eq=False)
class ForceErrors:
    """One force at one angle."""

    force: float  # N
    angle: str
    errors: Errors


def by_force(
    name: str, facets: int, marker_S: NDArray[np.float64], benches: Sequence[CalibratedSensor], key: int
) -> list[ForceErrors]:
    """Press one marker at every angle with `FORCES_N`, and locate many readings of each touch."""
    station = MarkerStation(name, marker_S)
    found: list[ForceErrors] = []
    for index, (angle, (tilt, azimuth)) in enumerate(ANGLES.items()):
        for force in FORCES_N:
            moment = station.touch(TipPress(force, tilt, azimuth))
            rows = [
                row((bench.seed, MARKER, index, repeat), station.scene.marker_S, moment)
                for bench in benches
                for repeat in range(_READINGS)
            ]
            found.append(_at_force(name, facets, stack(rows), benches, key + len(found), force, angle))
    return found


def force_errors(
    name: str, markers_S: NDArray[np.float64], benches: Sequence[CalibratedSensor], key: int
) -> NDArray[np.float64]:
    """Press every marker with `RISING_N`, and compare the filtered force with the true one."""
    rows = []
    for number, marker_S in enumerate(markers_S):
        station = MarkerStation(name, marker_S)
        for index, (tilt, azimuth) in enumerate(ANGLES.values()):
            for repeat, force in enumerate(RISING_N):
                moment = station.touch(TipPress(force, tilt, azimuth))
                rows.append(row((0, number + 1, index, repeat), station.scene.marker_S, moment))
    touched = stack(rows)
    true = np.linalg.norm(touched.contacts[:, :3], axis=1)
    off = []
    for bench in benches:
        read = read_touches(bench, touched.contacts, touched.R_WS, key)
        off.append(np.abs(np.linalg.norm(read[:, :3], axis=1) - true))
    mean = np.mean(off, axis=0).reshape(len(markers_S), len(ANGLES), len(RISING_N))
    return np.asarray(mean.mean(axis=2))


def _at_force(
    name: str,
    facets: int,
    touched: Touched,
    benches: Sequence[CalibratedSensor],
    key: int,
    force: float,
    angle: str,
) -> ForceErrors:
    parts, bounds = [], []
    for bench in benches:
        mine = touched.where(touched.seeds == bench.seed)
        wrenches = read_touches(bench, mine.contacts, mine.R_WS, key)
        method = solver_for(OURS, name, facets, bench, mine.R_WS)
        parts.append(Located.of(method.locate_batch(wrenches)))
        bounds.append(bounds_m(mine, bench))
    located = Located.joined(parts)
    return ForceErrors(force, angle, errors_of(located, touched, np.concatenate(bounds)))


REFERENCE_M = 0.0005
STIFFNESS = 150.0  # N·m/rad: 10 N across, 130 mm away, turn the probe by half a degree
COARSE_FACETS, FINE_FACETS = 200, 20_000
FINE = f"mesh of {FINE_FACETS:,} facets"
_PAPER_PERPENDICULAR, _PAPER_ANGLED = 0.9, 1.8  # mm; the mean of 1.6 and 2.0
_STIFFEST, _SOFTEST, _TRIED = 1000.0, 10.0, 33


@dataclass(frozen=True)
class Causes:
    """What is wrong."""

    reference: float = 0.0  # How far off each marker is taken to be, m
    # How far the probe turns against its sensor, about the sensor's origin, rad/(N·m)
    compliance: float = 0.0
    facets: int | None = None  # Of the mesh; None as everywhere else
    method: str = OURS
    cold: bool = False  # Calibrated a minute after the sensor was switched on


CASES: dict[str, Causes] = {
    "none of them": Causes(),
    "markers 0.5 mm off": Causes(reference=REFERENCE_M),
    f"mount yields, {STIFFNESS:g} N·m/rad": Causes(compliance=1 / STIFFNESS),
    f"mesh of {COARSE_FACETS} facets": Causes(facets=COARSE_FACETS),
    FINE: Causes(facets=FINE_FACETS),
    "first accepted plane": Causes(method=LITERAL),
    "calibrated cold": Causes(cold=True),
    "all of them": Causes(REFERENCE_M, 1 / STIFFNESS, COARSE_FACETS, LITERAL, cold=True),
}


@dataclass(frozen=True)
class Attributed:
    """Distance to the marker under one cause, by angle as `ANGLES`."""

    cause: str
    means: tuple[float, ...]  # mm
    rms: tuple[float, ...]  # mm
    largest: tuple[float, ...]  # mm
    # Root of the difference of squares to the same without any cause, mm; negative where it got smaller
    added: tuple[float, ...]

    @property
    def ratios(self) -> tuple[float, ...]:
        """Mean of each angle over that of the perpendicular touches."""
        return tuple(mean / self.means[0] for mean in self.means)


@dataclass(frozen=True)
class Explained:
    """The reference error and the mount that would together give the paper's means."""

    reference_mm: float
    stiffness: float  # N·m/rad
    means: tuple[float, ...]  # mm, by angle


def attribute(
    name: str, facets: int, touched: Touched, benches: Sequence[CalibratedSensor]
) -> list[Attributed]:
    """Locate the touches of one probe under each of `CASES`; the parameters as for `locate_all`."""
    rows: list[Attributed] = []
    for cause, causes in CASES.items():
        errors = _located(name, facets, touched, benches, causes)
        by_angle = [errors[(touched.angles == k) & np.isfinite(errors)] for k in range(len(ANGLES))]
        roots = tuple(float(np.sqrt(np.mean(each**2))) for each in by_angle)
        more = np.square(roots) - np.square(rows[0].rms if rows else roots)
        added = np.sign(more) * np.sqrt(np.abs(more))
        means = tuple(float(each.mean()) for each in by_angle)
        largest = tuple(float(each.max()) for each in by_angle)
        rows.append(Attributed(cause, means, roots, largest, tuple(added.tolist())))
    return rows


def explain(name: str, facets: int, touched: Touched, bench: CalibratedSensor) -> Explained:
    """Find the reference error and the mount's stiffness with which the touches of one seed give the paper's means."""
    mine = touched.where(touched.seeds == bench.seed)
    found = []
    for compliance in 1 / np.geomspace(_STIFFEST, _SOFTEST, _TRIED):
        points = _points(name, facets, mine, bench, Causes(compliance=float(compliance))).points
        offset = _offset_for(points, mine)
        means = _means(distances_mm(points, _references(mine, offset)), mine)
        miss = abs(means[0] - _PAPER_PERPENDICULAR) + abs((means[1] + means[2]) / 2 - _PAPER_ANGLED)
        found.append((miss, Explained(1e3 * offset, 1 / float(compliance), means)))
    return min(found, key=lambda each: each[0])[1]


def _offset_for(points: NDArray[np.float64], touched: Touched) -> float:
    """Return the reference error, m, that brings the perpendicular mean to the paper's; 0 where it is beyond."""
    low, high = 0.0, 0.003
    for _ in range(20):
        middle = (low + high) / 2
        mean = _means(distances_mm(points, _references(touched, middle)), touched)[0]
        low, high = (low, middle) if mean > _PAPER_PERPENDICULAR else (middle, high)
    return (low + high) / 2


def _means(errors: NDArray[np.float64], touched: Touched) -> tuple[float, ...]:
    return tuple(float(np.nanmean(errors[touched.angles == k])) for k in range(len(ANGLES)))


def _located(
    name: str, facets: int, touched: Touched, benches: Sequence[CalibratedSensor], causes: Causes
) -> NDArray[np.float64]:
    """Return the distance of each answer to where its marker is taken to be, mm, (n,)."""
    parts = []
    for bench in benches:
        mine = touched.where(touched.seeds == bench.seed)
        used = draw_sensor(bench.seed, calibrated_at=COLD_S) if causes.cold else bench
        parts.append(_points(name, facets, mine, used, causes))
    return distances_mm(Located.joined(parts).points, _references(touched, causes.reference))


def _points(name: str, facets: int, mine: Touched, bench: CalibratedSensor, causes: Causes) -> Located:
    turned = _yielding(mine, causes.compliance)
    wrenches = read_touches(bench, turned.contacts, turned.R_WS, key_of(name))
    method = solver_for(causes.method, name, causes.facets or facets, bench, turned.R_WS)
    return Located.of(method.locate_batch(wrenches))


def _yielding(touched: Touched, compliance: float) -> Touched:
    """Turn the probe against its sensor by what the touch's torque makes of it: the force stays, its place moves."""
    if compliance == 0:
        return touched
    force, torque = touched.contacts[:, :3], touched.contacts[:, 3:]
    moved = Rotation.from_rotvec(compliance * torque).apply(touched.points)
    contacts = np.hstack([force, torque + np.cross(moved - touched.points, force)])
    return replace(touched, contacts=contacts)


def _references(touched: Touched, offset: float) -> NDArray[np.float64]:
    """Return where each marker is taken to be, (n, 3): off in a direction of its own, the same in every touch."""
    angles = 2.4 * touched.markers  # the golden angle: all directions alike
    across = np.where(np.abs(touched.normals[:, :1]) < 0.9, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    first = np.cross(touched.normals, across)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(touched.normals, first)
    return np.asarray(
        touched.targets + offset * (np.cos(angles)[:, None] * first + np.sin(angles)[:, None] * second)
    )


_SCENE_FORCE_N = 9.0
_REST_S = 1.0


@dataclass(frozen=True)
class Effect:
    """One change of the scene, over some markers and all angles; mm."""

    change: str
    shift: float  # How far the true contact moves: mean and largest
    most: float  # How far the true contact moves: mean and largest
    # Distance from the true contact to what is located from its wrench, without noise, on the true mesh:
    # mean and largest
    located: float
    # Distance from the true contact to what is located from its wrench, without noise, on the true mesh:
    # mean and largest
    most_located: float


def effects(name: str, markers_S: NDArray[np.float64], bench: CalibratedSensor) -> list[Effect]:
    """Press some markers (n, 3) in the scene as it is, and in changed ones."""
    truth = truth_of(name)
    makers: dict[str, Callable[[NDArray[np.float64], TipPress], SceneMoment]] = {
        "as it is": lambda at, press: _rested(TouchScene(truth, at), press),
        "half the time step": lambda at, press: _rested(TouchScene(truth, at, step=STEP_S / 2), press),
        "tip of 3 mm instead of 1.5": lambda at, press: _rested(TouchScene(truth, at, tip=Tip(0.003)), press),
        "on a wrist that yields": lambda at, press: _on_wrist(BenchScene(truth), at, press),
    }
    presses = [TipPress(_SCENE_FORCE_N, tilt, azimuth) for tilt, azimuth in ANGLES.values()]
    moments = {
        change: [make(at, press) for at in markers_S for press in presses] for change, make in makers.items()
    }
    standing = np.array([held(moment.contact) for moment in moments["as it is"]])
    method = solver_for(OURS, name, TRUE_FACETS, bench, standing)
    places = {change: np.array([moment.point_S for moment in each]) for change, each in moments.items()}
    found = []
    for change, each in moments.items():
        moved = distances_mm(places[change], places["as it is"])
        points = method.locate_batch(np.array([moment.contact for moment in each])).points
        off = distances_mm(points, places[change])
        found.append(
            Effect(change, float(moved.mean()), float(moved.max()), float(off.mean()), float(off.max()))
        )
    return found


def _rested(scene: TouchScene, press: TipPress) -> SceneMoment:
    scene.press(press)
    moment = scene.settle()
    if moment is None:
        raise InputError(
            f"the tip slips at {np.round(1e3 * scene.marker_S, 1)} mm: choose a marker with more face around it."
        )
    return moment


def _on_wrist(scene: BenchScene, marker_S: NDArray[np.float64], press: TipPress) -> SceneMoment:
    scene.aim(marker_S)
    scene.press(press)
    scene.advance(_REST_S)
    return scene.moment()

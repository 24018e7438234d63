"""Does verification name what is really wrong, and size what its model leaves? Days on benches that are drawn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass

import numpy as np
from benchmarks.real_bench import VERIFIED_S, MarkedPresses, RealBench, RealTape, RealTouch
from benchmarks.trials import in_processes
from numpy.typing import NDArray

from contactbench import assets
from contactbench.pipeline.calibration import GravityModel, calibrate
from contactbench.pipeline.calibration.model import two_stage
from contactbench.pipeline.calibration.poses import stack
from contactbench.pipeline.demo.gravity import planned_poses
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.reality import MIXES, Reality
from contactbench.pipeline.simulation.loads import LoadedSensor, draw_load
from contactbench.pipeline.simulation.marker_touches import model_of
from contactbench.pipeline.simulation.virtual.markers import markers
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport
from contactbench.pipeline.verification.causes import across, sensitivities
from contactbench.pipeline.verification.figures import ErrorCause, ModelError
from contactbench.pipeline.verification.markers import make_markers
from contactbench.pipeline.verification.protocol import ProtocolSettings
from contactbench.pipeline.verification.source import TouchRecording
from contactbench.pipeline.verification.verify import VerifySettings, verify

Array = NDArray[np.float64]

# The effects that each cause names.
EFFECTS: dict[ErrorCause, tuple[str, ...]] = {
    ErrorCause.GRAVITY: ("cable", "drag", "warming"),
    ErrorCause.SENSOR: ("hysteresis", "hysteresis_of_load", "creep", "crosstalk", "hand"),
    ErrorCause.MOUNT: ("mount",),
    ErrorCause.ALIGNMENT: ("seat", "bend"),
    ErrorCause.MESH: ("lens", "scale"),
    ErrorCause.MARKERS: ("markers", "tip"),
    ErrorCause.TORSION: ("patch", "lean", "twist", "second"),
}
FACETS = 2_000
_MASS_KG = (0.3, 0.8)
_WINDOW_N, _SAMPLES, _HELD = (7.5, 10.5), 50, 100
_SHARES = (0.6, 0.9)  # of the squared errors, that the dominant cause has
_STEPS, _SLACK = 2, 0.1
_TYPICAL = MIXES["typical"]
# Sizes to begin from; 0: not raised. Markers are pressed with a tip, not with a pad.
_LARGER = Reality(
    cable=0.2, mount=5, hysteresis=0.02, hysteresis_of_load=0.2, crosstalk=0.5, hand=0.1, warming=4,
    seat=1, lens=0.5, bend=0.5, markers=0.8, tip=2,
)  # fmt: skip
_RAISED = [cause for cause, effects in EFFECTS.items() if set(effects) & set(_LARGER.on)]


@dataclass(frozen=True)
class DrawnDay:
    """One draw: what was wrong, and what was said."""

    probe: str
    raised: str  # the effect that is larger than on a decent bench, and how large
    true: ErrorCause
    share: float  # that it has of the squares
    told: ErrorCause | None
    told_share: float
    mean_mm: float  # of accepted touches, from the markers as they are told
    # rms of the contact's error that the floor stands for, as verification says it and as it is, mm
    told_floor: float
    true_floor: float


def run(
    *,
    draws: int = 100,
    seed: int = 0,
    workers: int | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Draw days, each on a decent bench on which one effect is so large that it makes most of the errors."""
    if draws < 5 or seed < 0:
        raise InputError(f"{draws} draws, seed {seed}: give at least 5 draws and a seed of at least 0.")
    days: list[DrawnDay] = []
    for number, day in enumerate(in_processes(draw_day, [(seed, n) for n in range(draws)], workers), 1):
        days.append(day)
        progress(f"{number} of {draws}: {day.raised} on {day.probe}: {day.true}, told {day.told}")
    return StudyReport(
        "Days on drawn benches",
        {"draws": draws, "seed": seed},
        _figures(days),
        sheets=(_by_cause(days), _sheet(days)),
        notes=(
            (
                "Each bench is typical but for one effect, drawn, and so large that its cause alone makes"
                f" {100 * _SHARES[0]:.0f} to {100 * _SHARES[1]:.0f} % of the squared errors. Floors are of the typical"
                " bench's size or above."
            ),
        ),
    )


def draw_day(job: tuple[int, int]) -> DrawnDay:
    """Draw a bench, calibrate and verify on it; the probe is not aligned by touches, which would hide its cause."""
    seed, number = job
    rng = np.random.default_rng([seed, 22, number])
    name = assets.PROBE_NAMES[int(rng.integers(len(assets.PROBE_NAMES)))]
    loaded, bench_seed = LoadedSensor(draw_load(rng, _MASS_KG)), int(rng.integers(2**31))
    pressed = MarkedPresses.drawn(name, rng)
    causes = _Causes(name, bench_seed, loaded, pressed)
    reality, raised = _drawn(rng, causes)
    true = causes.of(reality)
    bench = RealBench(name, reality, bench_seed, loaded)
    model = calibrate(bench.weigh(planned_poses()).poses()).model
    bench.warm()
    bench.time = VERIFIED_S
    tape = bench.press(pressed.on(bench), pressed.R_WS)
    recording = TouchRecording(tape.times, tape.readings.wrenches, tape.told, tape.readings.saturated)
    protocol = ProtocolSettings(windows=(_WINDOW_N,), samples=_SAMPLES)
    probe = model_of(name, FACETS)
    found = verify(
        probe, model, make_markers(markers(name)), recording, VerifySettings(protocol, resamples=100)
    )
    told = None if found.diagnosis is None else found.diagnosis.first
    said = 0.0 if found.diagnosis is None else found.diagnosis.shares[0].share
    floor = np.nan if found.model_error is None else told_floor(tape, found.model_error)
    mean = np.nan if found.overall is None else found.overall.mean_mm
    off = true_floor(tape, tape.compensated(model), causes.noise)
    return DrawnDay(name, raised, true.first, true.share, told, said, mean, 1e3 * floor, 1e3 * off)


@dataclass(frozen=True, eq=False)
class _Causes:
    """What the causes do on one bench."""

    name: str
    seed: int
    loaded: LoadedSensor
    pressed: MarkedPresses

    @property
    def noise(self) -> Array:
        """(6, 6) of the mean of a touch."""
        return np.diag(self.loaded.settings.noise**2) / _HELD

    def of(self, reality: Reality) -> TrueCauses:
        return true_causes(
            self.name, reality, self.seed, self.loaded, planned_poses(), self.pressed, self.noise
        )


def _drawn(rng: np.random.Generator, causes: _Causes) -> tuple[Reality, str]:
    """Return a bench with one effect raised; another is drawn where even its largest size does not dominate."""
    usual = causes.of(_TYPICAL).squares
    while True:
        # A cause first, then one of its effects: else the sensor's four would count four times.
        cause = _RAISED[int(rng.integers(len(_RAISED)))]
        mine = [effect for effect in EFFECTS[cause] if effect in _LARGER.on]
        effect, wanted = mine[int(rng.integers(len(mine)))], float(rng.uniform(*_SHARES))
        others = sum(square for which, square in usual.items() if which is not cause)
        off, size = Reality.model_fields[effect].default, getattr(_LARGER, effect)
        for _ in range(_STEPS):  # squares grow with the square of the size, nearly
            found = causes.of(_TYPICAL.model_copy(update={effect: off + size}).only(*EFFECTS[cause]))
            size *= float(np.sqrt(wanted / (1 - wanted) * others / found.squares[cause]))
            size = min(size, Reality.limits(effect)[1] - off)
        reality = _TYPICAL.model_copy(update={effect: off + size})
        true = causes.of(reality)
        if true.first is cause and true.share > _SHARES[0] - _SLACK:
            return reality, f"{effect} {off + size:.3g}"


def _figures(days: list[DrawnDay]) -> tuple[Figure, ...]:
    named = sum(day.told is day.true for day in days)
    told, true = (np.array([getattr(day, name) for day in days]) for name in ("told_floor", "true_floor"))
    ratios = told / true
    return (
        Figure.share("diagnosis", "names the dominant cause first", named, len(days), least=80.0),
        Figure.of("floor", "as told over as it is, by day", ratios[np.isfinite(ratios)]),
        Figure(
            "floor", "as told over as it is, rms of all days",
            floor_ratio(told.tolist(), true.tolist()), least=0.75, most=1.25,
        ),
    )  # fmt: skip


def _by_cause(days: list[DrawnDay]) -> Sheet:
    rows = []
    for cause in EFFECTS:
        mine = [day for day in days if day.true is cause]
        if mine:
            wrong = [str(day.told) for day in mine if day.told is not cause]
            instead = ", ".join(sorted(set(wrong), key=wrong.count, reverse=True))
            rows.append((str(cause), len(mine), sum(day.told is cause for day in mine), instead))
    return Sheet("causes", "Dominant causes", ("cause", "days", "named first", "named instead"), tuple(rows))


def _sheet(days: list[DrawnDay]) -> Sheet:
    columns = (
        "probe", "raised", "dominant", "its share", "told", "told share", "mean mm", "floor told mm", "floor true mm",
    )  # fmt: skip
    return Sheet("days", "Days", columns, tuple(map(astuple, days)), shown=False)


# ---- what really makes the contacts of a real bench wrong, cause by cause ------------------------


_RATE_HZ = 20.0  # without noise a few readings tell all


@dataclass(frozen=True)
class TrueCauses:
    """Mean squares of the errors that each cause alone makes on touches of markers, mm²."""

    squares: dict[ErrorCause, float]

    @property
    def first(self) -> ErrorCause:
        """The largest."""
        return max(self.squares, key=lambda cause: self.squares[cause])

    @property
    def share(self) -> float:
        """What the largest has of all."""
        return self.squares[self.first] / max(sum(self.squares.values()), 1e-12)


def true_causes(
    name: str,
    reality: Reality,
    seed: int,
    loaded: LoadedSensor,
    planned: Array,
    pressed: MarkedPresses,
    noise: Array,
) -> TrueCauses:
    """
    Repeat weighing and presses with the effects of one cause after the other, without noise.

    Parameters
    ----------
    planned : (k, 3, 3)
        R_WS of the poses to calibrate with.
    noise : (6, 6)
        Covariance of the mean wrench of a touch by the sensor's noise alone.
    """
    squares = dict.fromkeys((*EFFECTS, ErrorCause.NOISE), 0.0)
    for cause, effects in EFFECTS.items():
        alone = reality.only(*effects)
        if not alone.on:
            continue
        bench = RealBench(name, alone, seed, loaded, rate=_RATE_HZ, noise=False)
        # Without noise there is nothing to weigh or to doubt: least squares do.
        theta = two_stage(stack(bench.weigh(planned).poses()))
        model = GravityModel.from_vector(theta, np.zeros((12, 12)))
        bench.warm()
        bench.time = VERIFIED_S
        tape = bench.press(pressed.on(bench), pressed.R_WS)
        places = markers(name)[np.asarray(pressed.markers) - 1]
        errors = along_surface(tape, tape.compensated(model), places)
        squares[cause] = 1e6 * float((errors**2).sum(axis=1).mean())
    ideal = RealBench(name, type(reality)(), seed, loaded)
    J = _across(pressed.on(ideal))
    squares[ErrorCause.NOISE] = 1e6 * float(np.einsum("nij,jk,nik->n", J, noise, J).mean())
    return TrueCauses(squares)


def true_floor(tape: RealTape, wrenches: Array, noise: Array) -> float:
    """
    Return what the wrenches (n, 6) of touches are off beyond noise, as an error of the contact, rms, m.

    Parameters
    ----------
    wrenches : (n, 6)
        Compensated means.
    noise : (6, 6)
        Their covariance by the sensor's noise alone.
    """
    J = _across(tape.touches)
    off = wrenches - np.array([touch.contact for touch in tape.touches])
    square = (np.einsum("nij,nj->ni", J, off) ** 2).sum(axis=1).mean()
    return float(np.sqrt(max(square - np.einsum("nij,jk,nik->n", J, noise, J).mean(), 0.0)))


def floor_ratio(told: Sequence[float | None], true: Sequence[float]) -> float:
    """Return the told floors over the true ones, rms of all days with both; NaN where noise alone is to be found."""
    pairs = np.array([pair for pair in zip(told, true, strict=True) if pair[0] is not None], float).reshape(
        -1, 2
    )
    pairs = pairs[np.isfinite(pairs).all(axis=1)]
    if not pairs[:, 1].any():
        return float("nan")
    return float(np.sqrt(np.mean(pairs[:, 0] ** 2) / np.mean(pairs[:, 1] ** 2)))


def told_floor(tape: RealTape, found: ModelError) -> float:
    """Return what verification says of the same, as likely too large as too small, m."""
    sigma = np.repeat([found.likely_force_N, found.likely_torque_Nm], 3)
    return float(np.sqrt(((_across(tape.touches) * sigma) ** 2).sum(axis=(1, 2)).mean()))


def along_surface(tape: RealTape, wrenches: Array, places: Array) -> Array:
    """Return how far wrenches (n, 6) of touches put their contacts from places (n, 3), along the surface, (n, 2), m."""
    F, M = wrenches[:, :3], wrenches[:, 3:]
    return np.asarray((_across(tape.touches)[:, :, 3:] @ (M - np.cross(places, F))[:, :, None])[:, :, 0])


def _across(touches: Sequence[RealTouch]) -> Array:
    """Return (n, 2, 6) how contacts move along the surface with their wrenches, m/N and m/(N·m)."""
    points = np.array([touch.point for touch in touches])
    normals = np.array([touch.normal for touch in touches])
    forces = np.array([touch.contact[:3] for touch in touches])
    return across(normals) @ sensitivities(points, normals, forces)

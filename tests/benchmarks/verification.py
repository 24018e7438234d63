"""Does a verification say what is true? Intervals that hold, and the cause that was put in named, on drawn touches."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial.transform import Rotation
from weighing_files import draw_weighing

from contactbench import assets
from contactbench.pipeline.calibration import GravityModel, calibrate
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation import add_noise
from contactbench.pipeline.simulation.sensor_model import preset
from contactbench.pipeline.simulation.virtual.markers import markers as bundled_markers
from contactbench.pipeline.study.report import Figure, StudyReport
from contactbench.pipeline.verification.causes import across
from contactbench.pipeline.verification.figures import ErrorCause
from contactbench.pipeline.verification.markers import make_markers
from contactbench.pipeline.verification.source import TouchRecording
from contactbench.pipeline.verification.statistics import intervals
from contactbench.pipeline.verification.verify import VerifySettings, verify

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.verification.figures import Intervals, Verification
    from contactbench.pipeline.verification.markers import MarkerSet

    Array = NDArray[np.float64]

LEVEL = 0.95
# % of first causes that are right; share of the error from which a cause is said surely.
_NAMED, _SURE = 90.0, 0.8
_PROBE, _FACETS = "t-shape", 4_000
_REPEATS = 2
_HELD, _BETWEEN, _RATE = 100, 20, 200.0
_FORCE, _ANGLE = (8.2, 9.8), (0.0, 30.0)
_TORSION_M = 0.0003
_TILT = np.radians(45.0)
_MARKERS, _TOUCHES, _PLACE_M = 17, 5, 0.0005


@dataclass(frozen=True, eq=False)
class Bench:
    """What is verified, with one thing wrong."""

    probe: Probe  # What the program is told
    markers: MarkerSet  # In S as the program is told
    model: GravityModel  # What the program is told
    recording: TouchRecording
    order: tuple[str, ...] = ()  # In which the markers are said to be touched

    def verified(self, settings: VerifySettings | None = None) -> Verification:
        """Verify it; the noise is the sensor's as its maker states it."""
        noise = sensor_noise()
        settings = settings or VerifySettings()
        stated = replace(
            settings,
            protocol=replace(settings.protocol, order=self.order or settings.protocol.order),
            noise_force=float(np.asarray(noise.force)[0]),
            noise_torque=float(np.asarray(noise.torque)[0]),
        )
        return verify(self.probe, self.model, self.markers, self.recording, stated)


def run(
    *, trials: int = 1000, seed: int = 0, progress: Callable[[str], None] = lambda _: None
) -> StudyReport:
    """Measure every figure."""
    if trials < 20 or seed < 0:
        raise InputError(f"{trials} trials, seed {seed}: give at least 20 trials and a seed of at least 0.")
    progress("intervals of bias and scatter")
    figures = list(coverage(trials, seed))
    progress("intervals where the touches of a marker are alike")
    figures += clustered(trials, seed)
    wrong = 0
    for name in SCENARIOS:
        progress(f"diagnosis: {name}")
        figure, said = naming(name, -(-trials // len(SCENARIOS)), seed)
        figures.append(figure)
        wrong += said
    figures.append(Figure("verification", "reports with a sentence that is wrong", float(wrong), most=0))
    return StudyReport("Verification", {"trials": trials, "seed": seed}, tuple(figures))


def coverage(trials: int, seed: int) -> tuple[Figure, ...]:
    """Draw errors with a known bias and scatter, and count the intervals that hold them."""
    held = np.zeros((trials, 2), dtype=bool)
    for trial in range(trials):
        rng = np.random.default_rng([seed, 1, trial])
        bias, sigma = rng.normal(0.0, 5e-4, 3), rng.uniform(2e-4, 8e-4, 3)
        turn = Rotation.from_quat(rng.standard_normal(4)).as_matrix()
        count = int(rng.integers(30, 120))
        errors = bias + (rng.standard_normal((count, 3)) * sigma) @ turn.T
        held[trial] = _held(intervals(errors, level=LEVEL, seed=trial), bias, (sigma**2).sum())
    return _coverage("the 95 % interval of the {} holds the truth", held)


def clustered(trials: int, seed: int) -> tuple[Figure, ...]:
    """Draw five touches of each of 17 markers whose places are off by 0.5 mm, and count the intervals that hold."""
    held = np.zeros((trials, 2), dtype=bool)
    markers = np.repeat(np.arange(_MARKERS), _TOUCHES)
    for trial in range(trials):
        rng = np.random.default_rng([seed, 3, trial])
        bias, sigma = rng.normal(0.0, 5e-4, 3), rng.uniform(2e-4, 8e-4, 3)
        places = bias + _PLACE_M * rng.standard_normal((_MARKERS, 3))
        errors = places[markers] + rng.standard_normal((len(markers), 3)) * sigma
        found = intervals(errors, groups=markers, level=LEVEL, seed=trial)
        held[trial] = _held(found, bias, (sigma**2).sum() + 3 * _PLACE_M**2)
    what = f"the 95 % interval of the {{}} holds the truth, {_TOUCHES} touches of markers off by {1e3 * _PLACE_M:g} mm"
    return _coverage(what, held)


def naming(name: str, trials: int, seed: int) -> tuple[Figure, int]:
    """Put one thing wrong, verify, and count how often it is told first, and how often something else is."""
    number = list(SCENARIOS).index(name)
    told = [judged(name, np.random.default_rng([seed, 2, number, t])) for t in range(trials)]
    right, wrong = np.sum(told, axis=0)
    figure = Figure.share("verification", f"first cause: {name}", int(right), trials, least=_NAMED)
    return figure, int(wrong)


def judged(name: str, rng: np.random.Generator) -> tuple[bool, bool]:
    """Tell whether a report on a drawn bench names what is wrong with it first, and whether it says anything wrong."""
    result = bench(name, rng).verified(VerifySettings(resamples=100))
    found, causes, words = result.diagnosis, SCENARIOS[name].causes, SCENARIOS[name].words
    if found is None:
        return not causes or any(words in each for each in (*result.warnings, *result.verdict.reasons)), False
    within, right = found.text.startswith("The errors are within"), found.first in causes
    right &= within or words in found.text
    surely = found.shares[0].share > _SURE and bool(causes or not within) and "cannot tell" not in found.text
    aside = "No action needed" in found.text and not result.verdict.passed
    return right or (not causes and within), aside or (surely and not right)


def bench(name: str | None, rng: np.random.Generator) -> Bench:
    """
    Draw touches of every marker of the T-shape, read them, and put one thing wrong; None: nothing.

    The readings are those of a sensor with a load, sample by sample, in drawn orientations; the calibration is one
    that was made with it.
    """
    points, normals = (np.repeat(each, _REPEATS, axis=0) for each in true_markers())
    wrenches = draw_presses(points, normals, rng)
    weighing = draw_weighing(
        rng, poses=(10, 12), mass=(0.3, 0.8), force_noise=(0.01, 0.02), torque_noise=(3e-4, 5e-4)
    )
    told = calibrate(weighing.poses, weighing.noise).model
    draft = Draft(
        points=points,
        normals=normals,
        wrenches=wrenches,
        R_WS=_held_at(len(points), rng),
        truth=weighing.truth,
        told=told,
        vertices=np.array(mesh(_FACETS).vertices),
        faces=mesh(_FACETS).faces,
        places=true_markers()[0],
    )
    if name is not None:
        draft = SCENARIOS[name].fault(draft, rng)
    probe = Probe.from_arrays(draft.vertices, draft.faces)
    markers = make_markers(draft.places)
    order = tuple(markers.names[k] for k in draft.order)
    return Bench(probe, markers, draft.told, _read(draft, rng), order)


def sensor_noise(times: float = 1.0) -> WrenchNoise:
    """Return the noise of the bench's sensor, or a multiple of it."""
    sigma = times * preset("paper").noise
    return WrenchNoise(sigma[:3], sigma[3:])


@cache
def mesh(facets: int) -> Probe:
    """Return the bench's probe with about so many facets."""
    return Probe.from_arrays(*assets.make(_PROBE, facets))


@cache
def true_markers() -> tuple[Array, Array]:
    """Return its markers (n, 3), S, m, on the true surface, and the normals there."""
    points, normals, _ = assets.surface(_PROBE).project(bundled_markers(_PROBE))
    return points, normals


# ---- drawing -----------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Draft:
    """A bench before it is read."""

    points: Array  # (n, 3) where each touch is made, S, m, and the normals there
    normals: Array
    wrenches: Array  # (n, 6) of the touches alone, S
    R_WS: Array  # (n, 3, 3)
    truth: GravityModel  # Of the load
    told: GravityModel  # What the program is told of it; of probe and markers, too
    vertices: Array
    faces: NDArray[np.int32]
    places: Array
    louder: float = 1.0  # Times the sensor's noise
    channels: Array = field(default_factory=lambda: np.eye(6))  # (6, 6) what the sensor makes of a wrench
    added: Array | float = 0.0  # (n, 6) what else is in the readings
    yields: float = 0.0  # rad/(N·m) of the mount
    order: tuple[int, ...] = ()  # Of markers, if it is given


Fault = Callable[[Draft, np.random.Generator], Draft]


def draw_presses(
    points: Array,
    normals: Array,
    rng: np.random.Generator,
    *,
    force: tuple[float, float] = _FORCE,
    grip: float = 0.0,
    ball: float = 0.0,
) -> Array:
    """Return true wrenches (n, 6) of touches at points; a tip may grip, m, or be a ball that leans, of radius m."""
    n, (first, second) = len(points), np.moveaxis(across(normals), 1, 0)
    around, tilt = rng.uniform(0, 2 * np.pi, n)[:, None], np.radians(rng.uniform(*_ANGLE, n))[:, None]
    side = np.cos(around) * first + np.sin(around) * second
    forces = rng.uniform(*force, n)[:, None] * (np.sin(tilt) * side - np.cos(tilt) * normals)
    size = np.linalg.norm(forces, axis=1)[:, None]
    torques = _TORSION_M * rng.standard_normal(n)[:, None] * size * normals
    torques = torques + grip * rng.choice([-1.0, 1.0], n)[:, None] * forces
    points = points - ball * np.sin(tilt) * side
    return np.hstack([forces, np.cross(points, forces) + torques])


def _held_at(count: int, rng: np.random.Generator) -> Array:
    """Draw orientations in which touches are made: the probe down, tilted, turned about itself."""
    down = Rotation.from_rotvec([np.pi, 0.0, 0.0])
    bearing, tilt = rng.uniform(0, 2 * np.pi, count), _TILT * np.sqrt(rng.random(count))
    axes = np.column_stack([np.cos(bearing), np.sin(bearing), np.zeros(count)])
    spin = Rotation.from_rotvec(np.outer(rng.uniform(0, 2 * np.pi, count), [0.0, 0.0, 1.0]))
    return (Rotation.from_rotvec(tilt[:, None] * axes) * down * spin).as_matrix()


def _read(draft: Draft, rng: np.random.Generator) -> TouchRecording:
    """Hold each touch, let go between them, and read it all with the load on."""
    n, each = len(draft.wrenches), _HELD + _BETWEEN
    wrenches = _grown(draft) if draft.yields else draft.wrenches
    pressed = np.tile(np.arange(each) >= _BETWEEN, n)[:, None]
    weight = draft.truth.predict(draft.R_WS) + draft.added
    true = np.repeat(wrenches @ draft.channels.T, each, axis=0) * pressed + np.repeat(weight, each, axis=0)
    noisy = add_noise(true, sensor_noise(draft.louder), rng)
    still = np.zeros(n * each, dtype=bool)
    return TouchRecording(np.arange(n * each) / _RATE, noisy, np.repeat(draft.R_WS, each, axis=0), still)


def _grown(draft: Draft) -> Array:
    """Return the wrenches (n, 6) that press a probe whose mount yields, under its weight, too."""
    F, M, points = draft.wrenches[:, :3], draft.wrenches[:, 3:], draft.points
    G, centre = draft.truth.gravity_W @ draft.R_WS, draft.truth.centre_of_mass_S
    hung = np.cross(centre, G)
    turned, hangs = (Rotation.from_rotvec(draft.yields * each) for each in (M + hung, hung))
    grown = np.cross(turned.apply(points) - points, F)
    hangs_at = np.tile(centre, (len(F), 1))
    grown += np.cross(turned.apply(hangs_at) - hangs.apply(hangs_at), G)
    return np.hstack([F, M + grown])


# ---- what is put in ----------------------------------------------------------------------------


@dataclass(frozen=True)
class Scenario:
    """One thing that is wrong, and what may be said first of it."""

    fault: Fault
    causes: tuple[ErrorCause, ...] = ()  # None: nothing is to be said
    words: str = ""  # That belong to it


def _placed(turn_deg: tuple[float, float], shift_m: tuple[float, float]) -> Fault:
    """Turn the mount about the probe's middle, and shift it."""

    def fault(draft: Draft, rng: np.random.Generator) -> Draft:
        R: Array = Rotation.from_rotvec(np.radians(rng.uniform(*turn_deg)) * _direction(rng)).as_matrix()
        middle = true_markers()[0].mean(axis=0)
        t = middle - R @ middle + rng.uniform(*shift_m) * _direction(rng)
        return replace(draft, vertices=draft.vertices @ R.T + t, places=draft.places @ R.T + t)

    return fault


def _loaded(mass_N: tuple[float, float] = (0.0, 0.0), centre_m: float = 0.0, zero: float = 0.0) -> Fault:
    """Hang something on the load after the calibration, move its centre of mass, or let the zero be another."""

    def fault(draft: Draft, rng: np.random.Generator) -> Draft:
        model, added = draft.truth, rng.uniform(*mass_N)
        weight = float(np.linalg.norm(model.gravity_W))
        place = model.centre_of_mass_S + rng.normal(0.0, 0.03, 3)
        centre = (weight * model.centre_of_mass_S + added * place) / (weight + added)
        truth = GravityModel(
            model.gravity_W * (1 + added / weight),
            model.force_bias + zero * rng.uniform(0.1, 0.3) * _direction(rng),
            centre + centre_m * _direction(rng),
            model.torque_bias + zero * rng.uniform(0.005, 0.010) * _direction(rng),
        )
        return replace(draft, truth=truth)

    return fault


def _drifting(draft: Draft, rng: np.random.Generator) -> Draft:
    whole = np.concatenate(
        [rng.uniform(0.3, 0.8) * _direction(rng), rng.uniform(0.01, 0.02) * _direction(rng)]
    )
    return replace(draft, added=np.linspace(0.0, 1.0, len(draft.wrenches))[:, None] * whole)


def _cabled(draft: Draft, rng: np.random.Generator) -> Draft:
    """Let a cable pull one way in the room, at a point of the probe."""
    pull = rng.uniform(0.3, 0.8) * _direction(rng) @ draft.R_WS
    at = np.array([*rng.uniform(-0.03, 0.03, 2), rng.uniform(0.02, 0.15)])
    return replace(draft, added=np.hstack([pull, np.cross(at, pull)]))


def _pressed(**how: tuple[float, float]) -> Fault:
    """Press in another way: harder or softer, with a tip that grips, with a ball that leans."""

    def fault(draft: Draft, rng: np.random.Generator) -> Draft:
        drawn: dict[str, Any] = {
            name: value if name == "force" else rng.uniform(*value) for name, value in how.items()
        }
        return replace(draft, wrenches=draw_presses(draft.points, draft.normals, rng, **drawn))

    return fault


def _coarse(draft: Draft, rng: np.random.Generator) -> Draft:
    rough = mesh(int(rng.integers(100, 160)))
    return replace(draft, vertices=np.array(rough.vertices), faces=rough.faces)


def _scaled(draft: Draft, rng: np.random.Generator) -> Draft:
    """Make mesh and markers too large or too small, about the probe's middle."""
    middle, times = draft.vertices.mean(axis=0), 1 + rng.choice([-1, 1]) * rng.uniform(0.03, 0.06)
    there = [middle + times * (each - middle) for each in (draft.vertices, draft.places)]
    return replace(draft, vertices=there[0], places=there[1])


def _moved(share: float) -> Fault:
    """Say of some markers, at least one, that they are elsewhere along the surface."""

    def fault(draft: Draft, rng: np.random.Generator) -> Draft:
        out = draft.places.copy()
        for row in rng.choice(len(out), max(round(share * len(out)), 1), replace=False):
            side = np.cross(true_markers()[1][row], _direction(rng))
            out[row] += rng.uniform(0.0015, 0.003) * side / np.linalg.norm(side)
        return replace(draft, places=np.asarray(assets.surface(_PROBE).project(out)[0]))

    return fault


def _swapped(draft: Draft, rng: np.random.Generator) -> Draft:
    labels = np.arange(len(draft.places))
    a, b = rng.choice(len(labels), 2, replace=False)
    labels[[a, b]] = b, a
    return replace(draft, order=tuple(np.repeat(labels, _REPEATS).tolist()))


def _misread(make: Callable[[np.random.Generator], Array]) -> Fault:
    """Let the sensor make another wrench of each touch; what hangs on it was calibrated as it reads it."""
    return lambda draft, rng: replace(draft, channels=make(rng))


def _gains(rng: np.random.Generator) -> Array:
    gains = np.ones(6)
    gains[rng.integers(6)] += rng.choice([-1, 1]) * rng.uniform(0.06, 0.12)
    return np.diag(gains)


def _mixed(rng: np.random.Generator) -> Array:
    scale = np.repeat([1.0, 0.05], 3)
    return np.eye(6) + 0.01 * rng.standard_normal((6, 6)) * scale[:, None] / scale


def _flipped(rng: np.random.Generator) -> Array:
    signs = np.ones(6)
    signs[rng.integers(3) + np.array([0, 3])] = -1.0
    return np.diag(signs)


def _looped(draft: Draft, rng: np.random.Generator) -> Draft:
    """Read less on the way up than on the way down, in every channel."""
    loop = np.repeat([rng.uniform(0.1, 0.2), rng.uniform(0.004, 0.008)], 3)
    return replace(draft, wrenches=draft.wrenches - loop * np.sign(draft.wrenches))


_OF_ZERO = (ErrorCause.GRAVITY, ErrorCause.SENSOR)
SCENARIOS: dict[str, Scenario] = {
    "nothing": Scenario(lambda draft, _: draft),
    "alignment": Scenario(_placed((1.5, 3.0), (0.001, 0.002)), (ErrorCause.ALIGNMENT,)),
    "the probe is shifted": Scenario(_placed((0.0, 0.0), (0.0015, 0.003)), (ErrorCause.ALIGNMENT,)),
    "gravity": Scenario(_loaded((0.2, 0.5), zero=1.0), (ErrorCause.GRAVITY,)),
    "the mass is wrong": Scenario(_loaded((0.5, 1.0)), (ErrorCause.GRAVITY,)),
    "the centre of mass is wrong": Scenario(_loaded(centre_m=0.01), (ErrorCause.GRAVITY,)),
    "the zero drifts": Scenario(_drifting, _OF_ZERO),
    "a cable pulls": Scenario(_cabled, _OF_ZERO),
    "noise": Scenario(lambda draft, _: replace(draft, louder=5.0), (ErrorCause.NOISE,)),
    "mesh": Scenario(_coarse, (ErrorCause.MESH,)),
    "the mesh has another scale": Scenario(_scaled, (ErrorCause.MESH,), "scale"),
    "torsion": Scenario(_pressed(grip=(0.004, 0.008)), (ErrorCause.TORSION,)),
    "a ball leans": Scenario(_pressed(ball=(0.003, 0.005)), (ErrorCause.MARKERS,), "lean"),
    "touches are too soft": Scenario(
        _pressed(force=(2.0, 4.0)), (ErrorCause.NOISE,), "too few accepted touches"
    ),
    "markers": Scenario(_moved(0.25), (ErrorCause.MARKERS,), "check the position"),
    "one marker is elsewhere": Scenario(_moved(0.0), (ErrorCause.MARKERS,), "check the position"),
    "labels are swapped": Scenario(_swapped, (ErrorCause.MARKERS,), "are swapped"),
    "mount": Scenario(lambda draft, rng: replace(draft, yields=rng.uniform(0.01, 0.02)), (ErrorCause.MOUNT,)),
    "sensor": Scenario(_looped, (ErrorCause.SENSOR,), "hysteresis"),
    "a gain is wrong": Scenario(_misread(_gains), (ErrorCause.SENSOR,), "gain"),
    "crosstalk": Scenario(_misread(_mixed), (ErrorCause.SENSOR,), "gain"),
    "an axis is flipped": Scenario(_misread(_flipped), (ErrorCause.SENSOR,), "sign"),
}


def _direction(rng: np.random.Generator) -> Array:
    v = rng.standard_normal(3)
    return np.asarray(v / np.linalg.norm(v))


def _held(found: Intervals | None, bias: Array, scatter2: float) -> tuple[bool, bool]:
    """Tell whether intervals hold a bias (3,), m, and a squared scatter, m²."""
    if found is None:
        return False, False
    ends = zip(bias, found.bias_mm, strict=True)
    low, high = found.scatter_mm
    return all(a <= 1e3 * b <= z for b, (a, z) in ends), bool(low <= 1e3 * np.sqrt(scatter2) <= high)


def _coverage(question: str, held: NDArray[np.bool_]) -> tuple[Figure, ...]:
    """Return the figures of the bias and the scatter."""
    return tuple(
        _figure(question.format(what), int(held[:, column].sum()), len(held))
        for column, what in enumerate(("bias (all three at once)", "scatter"))
    )


def _figure(question: str, hits: int, trials: int) -> Figure:
    return Figure.share("verification", question, hits, trials, least=100 * LEVEL)

"""Does a verification say what is true? Intervals that hold, and the cause that was put in named, on drawn touches."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING

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
from contactbench.pipeline.verification.figures import ErrorCause
from contactbench.pipeline.verification.markers import make_markers
from contactbench.pipeline.verification.source import TouchRecording
from contactbench.pipeline.verification.statistics import intervals
from contactbench.pipeline.verification.verify import VerifySettings, verify

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.verification.figures import Intervals, Verification
    from contactbench.pipeline.verification.markers import MarkerSet

    Array = NDArray[np.float64]

CAUSES = list(ErrorCause)[:-1]  # not drift: only a zero that follows leaves some
LEVEL = 0.95
_PROBE, _FACETS, _COARSE = "t-shape", 4_000, (100, 160)
_REPEATS = 2
_HELD, _BETWEEN, _RATE = 100, 20, 200.0
_FORCE, _ANGLE = (8.2, 9.8), (0.0, 30.0)
_TORSION_M = 0.0003
_TILT = np.radians(45.0)
_MARKERS, _TOUCHES, _PLACE_M = 17, 5, 0.0005

# What is put in: the mount turned by 1.5 to 3 degrees and shifted by 1 to 2 mm; 20 to 50 g added after the calibration
# (a cable, a cover) and a sensor that has drifted by 0.1 to 0.3 N and 5 to 10 N·mm; noise times five; a mesh of a
# hundred facets; a tip that grips, with torque arms of 4 to 8 mm about the force; every fourth marker 1.5 to 3 mm from
# where it is said to be; a mount that yields by 10 to 20 mrad/N·m; a sensor that reads 0.1 to 0.2 N and 4 to 8 N·mm
# otherwise on its way up, in every channel.
_TURN_DEG, _SHIFT_M = (1.5, 3.0), (0.001, 0.002)
_ADDED_N, _DRIFT_N, _DRIFT_NM = (0.2, 0.5), (0.1, 0.3), (0.005, 0.010)
_LOUDER = 5.0
_GRIP_M = (0.004, 0.008)
_EVERY, _AWAY_M = 4, (0.0015, 0.003)
# A mount that yields, rad/(N·m); what a sensor reads otherwise on its way up than on its way down, N and N·m.
_YIELDS, _LOOP_N, _LOOP_NM = (0.010, 0.020), (0.1, 0.2), (0.004, 0.008)


@dataclass(frozen=True, eq=False)
class Bench:
    """What is verified, with one thing wrong."""

    probe: Probe  # What the program is told
    markers: MarkerSet  # In S as the program is told
    model: GravityModel  # What the program is told
    recording: TouchRecording

    def verified(self, settings: VerifySettings | None = None) -> Verification:
        """Verify it; the noise is the sensor's as its maker states it."""
        noise = sensor_noise()
        stated = replace(
            settings or VerifySettings(),
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
    for cause in CAUSES:
        progress(f"diagnosis: {cause}")
        figures.append(naming(cause, -(-trials // len(CAUSES)), seed))
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


def naming(cause: ErrorCause, trials: int, seed: int) -> Figure:
    """Put one cause in, verify, and count how often it is named first."""
    named = sum(
        named_first(cause, np.random.default_rng([seed, 2, CAUSES.index(cause), t])) for t in range(trials)
    )
    return _figure(f"{cause} is named where it was put in", named, trials)


def named_first(cause: ErrorCause, rng: np.random.Generator) -> bool:
    """Tell whether the diagnosis of a drawn bench names what is wrong with it."""
    found = bench(cause, rng).verified(VerifySettings(resamples=100)).diagnosis
    return found is not None and found.first is cause


def bench(cause: ErrorCause | None, rng: np.random.Generator) -> Bench:
    """
    Draw touches of every marker of the T-shape, read them, and put one thing wrong; None: nothing.

    The readings are those of a sensor with a load, sample by sample, in drawn orientations; the calibration is one
    that was made with it.
    """
    points, normals = true_markers()
    points, normals = np.repeat(points, _REPEATS, axis=0), np.repeat(normals, _REPEATS, axis=0)
    wrenches = draw_presses(points, normals, cause, rng)
    weighing = draw_weighing(
        rng, poses=(10, 12), mass=(0.3, 0.8), force_noise=(0.01, 0.02), torque_noise=(3e-4, 5e-4)
    )
    told = calibrate(weighing.poses, weighing.noise).model
    truth = _heavier(weighing.truth, rng) if cause is ErrorCause.GRAVITY else weighing.truth
    if cause is ErrorCause.SENSOR:
        loop = np.repeat([rng.uniform(*_LOOP_N), rng.uniform(*_LOOP_NM)], 3)
        wrenches = wrenches - loop * np.sign(wrenches)
    yields = rng.uniform(*_YIELDS) if cause is ErrorCause.MOUNT else 0.0
    noise = sensor_noise(_LOUDER if cause is ErrorCause.NOISE else 1.0)
    recording = _read(wrenches, truth, noise, rng, points, yields)
    facets = int(rng.integers(*_COARSE)) if cause is ErrorCause.MESH else _FACETS
    vertices, places = np.array(mesh(facets).vertices), true_markers()[0]
    if cause is ErrorCause.ALIGNMENT:
        R, t = _misplaced(rng)
        vertices, places = vertices @ R.T + t, places @ R.T + t
    if cause is ErrorCause.MARKERS:
        places = _moved(places, rng)
    probe = Probe.from_arrays(vertices, mesh(facets).faces)
    return Bench(probe, make_markers(places), told, recording)


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


def draw_presses(points: Array, normals: Array, cause: ErrorCause | None, rng: np.random.Generator) -> Array:
    """Return true wrenches (n, 6) of touches at points."""
    n = len(points)
    helper = np.eye(3)[np.abs(normals).argmin(axis=1)]
    first = np.cross(helper, normals)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    around, tilt = rng.uniform(0, 2 * np.pi, n)[:, None], np.radians(rng.uniform(*_ANGLE, n))[:, None]
    side = np.cos(around) * first + np.sin(around) * np.cross(normals, first)
    forces = rng.uniform(*_FORCE, n)[:, None] * (np.sin(tilt) * side - np.cos(tilt) * normals)
    size = np.linalg.norm(forces, axis=1)[:, None]
    torques = _TORSION_M * rng.standard_normal(n)[:, None] * size * normals
    if cause is ErrorCause.TORSION:
        torques = torques + rng.uniform(*_GRIP_M) * rng.choice([-1.0, 1.0], n)[:, None] * forces
    return np.hstack([forces, np.cross(points, forces) + torques])


def _read(
    wrenches: Array,
    truth: GravityModel,
    noise: WrenchNoise,
    rng: np.random.Generator,
    points: Array,
    yields: float = 0.0,
) -> TouchRecording:
    """Hold each touch, let go between them, and read it all with the load on."""
    n, each = len(wrenches), _HELD + _BETWEEN
    down = Rotation.from_rotvec([np.pi, 0.0, 0.0])
    bearing, tilt = rng.uniform(0, 2 * np.pi, n), _TILT * np.sqrt(rng.random(n))
    axes = np.column_stack([np.cos(bearing), np.sin(bearing), np.zeros(n)])
    spin = Rotation.from_rotvec(np.outer(rng.uniform(0, 2 * np.pi, n), [0.0, 0.0, 1.0]))
    held = (Rotation.from_rotvec(tilt[:, None] * axes) * down * spin).as_matrix()
    if yields:
        wrenches = _grown(wrenches, points, truth, held, yields)
    R_WS = np.repeat(held, each, axis=0)
    pressed = np.tile(np.arange(each) >= _BETWEEN, n)[:, None]
    true = np.repeat(wrenches, each, axis=0) * pressed + truth.predict(R_WS)
    return TouchRecording(
        np.arange(n * each) / _RATE, add_noise(true, noise, rng), R_WS, np.zeros(n * each, dtype=bool)
    )


def _grown(wrenches: Array, points: Array, truth: GravityModel, R_WS: Array, yields: float) -> Array:
    """Return wrenches (n, 6) that press a probe whose mount yields by so many rad/(N·m), under its weight, too."""
    F, M = wrenches[:, :3], wrenches[:, 3:]
    G, centre = truth.gravity_W @ R_WS, truth.centre_of_mass_S
    hung = np.cross(centre, G)
    turned, hangs = (Rotation.from_rotvec(yields * each) for each in (M + hung, hung))
    grown = np.cross(turned.apply(points) - points, F)
    hangs_at = np.tile(centre, (len(F), 1))
    grown += np.cross(turned.apply(hangs_at) - hangs.apply(hangs_at), G)
    return np.hstack([F, M + grown])


def _heavier(model: GravityModel, rng: np.random.Generator) -> GravityModel:
    """Return the load with a little more on it, and the sensor a little drifted."""
    added = rng.uniform(*_ADDED_N)
    weight = float(np.linalg.norm(model.gravity_W))
    place = model.centre_of_mass_S + rng.normal(0.0, 0.03, 3)
    return GravityModel(
        model.gravity_W * (1 + added / weight),
        model.force_bias + rng.uniform(*_DRIFT_N) * _direction(rng),
        (weight * model.centre_of_mass_S + added * place) / (weight + added),
        model.torque_bias + rng.uniform(*_DRIFT_NM) * _direction(rng),
    )


def _misplaced(rng: np.random.Generator) -> tuple[Array, Array]:
    """Return R (3, 3) and t (3,) of a mount that is wrong; it is turned about the probe's middle."""
    R: Array = Rotation.from_rotvec(np.radians(rng.uniform(*_TURN_DEG)) * _direction(rng)).as_matrix()
    middle = true_markers()[0].mean(axis=0)
    return R, middle - R @ middle + rng.uniform(*_SHIFT_M) * _direction(rng)


def _moved(places: Array, rng: np.random.Generator) -> Array:
    """Return places (n, 3) with some of them moved along the surface."""
    out = places.copy()
    for row in rng.choice(len(out), -(-len(out) // _EVERY), replace=False):
        side = np.cross(true_markers()[1][row], _direction(rng))
        out[row] += rng.uniform(*_AWAY_M) * side / np.linalg.norm(side)
    points, _, _ = assets.surface(_PROBE).project(out)
    return np.asarray(points)


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

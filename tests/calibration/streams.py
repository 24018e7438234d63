"""Raw recordings of a robot that steps through poses, with the faults that benches have, and their truth.

The noise is made in the frequency domain and the motion in closed form: nothing here is shared with the code
under test. Every recording follows from its seed alone.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.calibration.stillness import StillnessDetector

FORCE, TORQUE = slice(0, 3), slice(3, 6)
WHITE = np.repeat([0.05, 0.0014], 3)
# A 0.9 kg probe, 60 mm in front of the sensor, on a sensor that was never zeroed.
MODEL = GravityModel([0.05, -0.1, -9.0], [3.0, -4.0, 6.0], [0.004, -0.002, 0.06], [0.1, 0.05, -0.2])


@dataclass(frozen=True, eq=False)
class Event:
    """Something from outside: first and last second of its effect, and its largest size (6,)."""

    start: float
    stop: float
    size: np.ndarray
    kind: str


@dataclass(frozen=True, eq=False)
class Dwell:
    """One pose: when the robot stands, when the last tremor is below a third of the noise, what is true."""

    start: float
    settled: float
    stop: float
    R_WS: np.ndarray
    wrench: np.ndarray


@dataclass(frozen=True, eq=False)
class Recording:
    t: np.ndarray
    wrenches: np.ndarray
    R_WS: np.ndarray
    dwells: list[Dwell]
    events: list[Event]
    drift: np.ndarray
    rate: float
    model: GravityModel = field(default=MODEL)

    def dwell_at(self, start: float, stop: float) -> Dwell | None:
        return next((d for d in self.dwells if d.start <= start and stop <= d.stop + 1e-9), None)


def stream(
    seed: int = 0,
    *,
    rate: float = 200.0,
    poses: int = 8,
    dwell: float = 5.0,
    white: np.ndarray = WHITE,
    corner: float = 0.3,
    drift: float = 2e-4,
    hum: float = 0.0,
    mains: float = 50.0,
    quantised: bool = False,
    spikes: float = 0.0,
    missing: float = 0.0,
    bumps: float = 0.0,
    smallest_bump: float = 0.5,
    touches: float = 0.0,
    vertical: float = 0.2,
    jitter: float = 0.0,
    model: GravityModel = MODEL,
) -> Recording:
    """Make a recording.

    Parameters
    ----------
    white : (6,)
        Standard deviation of a sample's white noise, N and N·m.
    corner : float
        Where 1/f noise equals the white noise, Hz.
    drift : float
        Steady drift, N/s (and a 40th of it, N·m/s), beside a random walk as large after a minute.
    hum : float
        Amplitude at the mains frequency, N (a 40th of it, N·m).
    quantised : bool
        In steps of 0.01 N and 1 mN·m.
    spikes, missing : float
        Share of samples.
    bumps, touches : float
        Probability of one in a dwell. A touch lasts to the dwell's end.
    smallest_bump : float
        N; sizes are spread evenly on a logarithmic scale up to 20 N.
    vertical : float
        Share of motions that only turn about the vertical: no weight tells of them.
    jitter : float
        Of the times, as a share of the sampling interval.
    """
    rng = np.random.default_rng(seed)
    orientations = _orientations(rng, poses, vertical)
    moves = rng.uniform(0.8, 2.0, poses)
    stands = np.cumsum(moves + dwell) - dwell  # when the robot stops
    n = int((stands[-1] + dwell) * rate)
    t = np.arange(n) / rate
    R_WS, moving = _motion(t, orientations, stands, moves)
    clean = model.predict(R_WS)
    clean += _tremor(rng, t, moving)
    settled = np.array([_settle(rng, t, stop, clean, white) for stop in stands])
    events: list[Event] = []
    for stop, still in zip(stands, settled, strict=True):
        if rng.random() < bumps:
            events.append(_bump(rng, t, still + rng.uniform(0.3, dwell - 1.2), clean, smallest_bump))
        if rng.random() < touches:
            events.append(_touch(rng, t, stop, stop + dwell, clean))
    drifting = _drift(rng, t, drift)
    wrenches = clean + drifting + coloured(rng, n, rate, white, corner)
    phases = rng.uniform(0, 2 * np.pi, 6)
    beat = 2 * np.pi * (mains + rng.normal(0, 0.02)) * t[:, None] + phases
    wrenches += hum * np.repeat([1.0, 1 / 40], 3) * rng.uniform(0.5, 1, 6) * np.sin(beat)
    hit = np.flatnonzero(rng.random(n) < spikes)
    axes = rng.integers(0, 6, len(hit))
    wrenches[hit, axes] += (
        rng.choice([-1, 1], len(hit)) * np.where(axes < 3, 1, 0.025) * rng.uniform(1, 30, len(hit))
    )
    if quantised:
        step = np.repeat([0.01, 0.001], 3)
        wrenches = np.round(wrenches / step) * step
    t = t + rng.uniform(-0.5, 0.5, n) * jitter / rate
    keep = rng.random(n) >= missing
    dwells = [
        Dwell(stop, still, stop + dwell, R.as_matrix(), model.predict(R.as_matrix()))
        for stop, still, R in zip(stands, settled, orientations[1:], strict=True)
    ]
    return Recording(t[keep], wrenches[keep], R_WS[keep], dwells, events, drifting[keep], rate, model)


def coloured(rng: np.random.Generator, n: int, rate: float, white: np.ndarray, corner: float) -> np.ndarray:
    """Noise (n, 6) of density S (1 + corner / f), down to one cycle in the record."""
    count = 2 * n
    f = np.fft.rfftfreq(count, 1 / rate)
    shape = np.sqrt(1 + corner / np.maximum(f, f[1]))
    # Slower than the recording is constant during it: bias, not noise.
    shape[f < rate / n] = 1.0
    noise = np.fft.irfft(np.fft.rfft(rng.standard_normal((count, 6)), axis=0) * shape[:, None], count, axis=0)
    return noise[:n] * white


def _orientations(rng: np.random.Generator, poses: int, vertical: float) -> list[Rotation]:
    found = [Rotation.random(None, rng)]
    for _ in range(poses):
        if rng.random() < vertical:
            found.append(Rotation.from_rotvec([0, 0, rng.uniform(0.5, 2.0)]) * found[-1])
        else:
            found.append(Rotation.from_rotvec(rng.uniform(0.5, 2.0) * _direction(rng)) * found[-1])
    return found


def _motion(
    t: np.ndarray, orientations: list[Rotation], stands: np.ndarray, moves: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """R_WS (n, 3, 3), and how fast it moves (n,) as a share of the largest speed of each motion."""
    R_WS = np.repeat(orientations[-1].as_matrix()[None], len(t), axis=0)
    speed = np.zeros(len(t))
    previous = 0.0
    for i, (stop, move) in enumerate(zip(stands, moves, strict=True)):
        standing = (t >= previous) & (t < stop - move)
        R_WS[standing] = orientations[i].as_matrix()
        on = (t >= stop - move) & (t < stop)
        s = (t[on] - (stop - move)) / move
        path = np.clip(s**3 * (10 - 15 * s + 6 * s**2), 0, 1)
        pair = Rotation.concatenate([orientations[i], orientations[i + 1]])
        R_WS[on] = Slerp([0, 1], pair)(path).as_matrix()
        speed[on] = 16 * s**2 * (1 - s) ** 2
        previous = stop
    return R_WS, speed


def _tremor(rng: np.random.Generator, t: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """The robot's vibration while it moves."""
    size = rng.uniform(0.3, 1.5) * np.repeat([1.0, 0.05], 3) * rng.uniform(0.3, 1, 6)
    f = rng.uniform(8, 20)
    return (
        (0.1 + 0.9 * speed)[:, None]
        * (speed > 0)[:, None]
        * size
        * np.sin(2 * np.pi * f * t[:, None] + rng.uniform(0, 6, 6))
    )


def _settle(
    rng: np.random.Generator, t: np.ndarray, stop: float, clean: np.ndarray, white: np.ndarray
) -> float:
    """Add what follows a stop: a vibration that dies away, and a creep. Return when both are over."""
    after = t >= stop
    since = t[after] - stop
    unit = np.repeat([1.0, 0.05], 3) * rng.uniform(-1, 1, 6)
    shake, decay, f = rng.uniform(0.3, 3.0), rng.uniform(0.05, 0.35), rng.uniform(8, 20)
    creep, slow = rng.uniform(0.05, 0.5), rng.uniform(0.1, 0.4)
    clean[after] += (
        unit
        * (shake * np.exp(-since / decay) * np.sin(2 * np.pi * f * since) + creep * np.exp(-since / slow))[
            :, None
        ]
    )
    left = (shake * np.exp(-since / decay) + creep * np.exp(-since / slow))[:, None] * np.abs(unit)
    loud = np.flatnonzero((left > white / 3).any(axis=1))
    return stop + (since[loud[-1]] if len(loud) else 0.0)


def _bump(rng: np.random.Generator, t: np.ndarray, at: float, clean: np.ndarray, smallest: float) -> Event:
    """A knock (half a sine), a ringing one, or a step that stays to the next motion a second later."""
    size = smallest * (20 / smallest) ** rng.random()
    direction = np.concatenate([_direction(rng), 0.1 * _direction(rng)]) * size
    kind = rng.choice(["knock", "ringing", "step"])
    since = t - at
    if kind == "knock":
        length = rng.uniform(0.02, 0.3)
        shape = np.where((since >= 0) & (since < length), np.sin(np.pi * since / length), 0)
    elif kind == "ringing":
        length, f = rng.uniform(0.1, 0.4), rng.uniform(8, 20)
        shape = np.where(
            since >= 0, np.exp(-np.maximum(since, 0) / length * 3) * np.sin(2 * np.pi * f * since), 0
        )
        length *= 1.5
    else:
        length = rng.uniform(0.3, 0.8)
        shape = np.clip(since / 0.05, 0, 1) * np.clip((length - since) / 0.05, 0, 1)
    clean += shape[:, None] * direction
    return Event(at, at + length, direction, str(kind))


def _touch(rng: np.random.Generator, t: np.ndarray, start: float, stop: float, clean: np.ndarray) -> Event:
    """Something that leans on the probe from before it stands until it leaves."""
    size = rng.uniform(1, 10)
    force = size * _direction(rng)
    wrench = np.concatenate([force, np.cross([0.0, 0.0, 0.1], force)])
    clean += (np.clip((t - start + 0.2) / 0.2, 0, 1) * np.clip((stop - t) / 0.2, 0, 1))[:, None] * wrench
    return Event(start, stop, wrench, "touch")


def _drift(rng: np.random.Generator, t: np.ndarray, rate: float) -> np.ndarray:
    unit = np.repeat([1.0, 1 / 40], 3)
    steps = rng.standard_normal((len(t), 6)) * np.sqrt(np.gradient(t))[:, None]
    walk = np.cumsum(steps, axis=0) * (rate * np.sqrt(60.0))
    return unit * (rate * rng.uniform(-1, 1, 6) * t[:, None] + walk)


def _direction(rng: np.random.Generator) -> np.ndarray:
    v = rng.standard_normal(3)
    return v / np.linalg.norm(v)


def find_captures(t, wrenches, settings=None, R_WS=None, model=None):
    """Return the detector after a whole recording: with its captures, and what it rejected."""
    detector = StillnessDetector(None, settings, model)
    detector.update_block(t, wrenches, R_WS)
    detector.finish()
    return detector

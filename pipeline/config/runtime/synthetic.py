"""
A synthetic stream for one bundle: everything that a runtime may meet, on this very probe, the same for the same seed.

Touches are not drawn blindly: of many random ones some of each reason are kept, so that a small stream has them all.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import zip_longest
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.config.runtime.values import make_runtime

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.config.runtime.config import RuntimeConfig

_DRAWN = 200  # touches that the cast is chosen from
_OF_EACH = 3  # reason
_LONGEST_STEP_S = 0.01
_POSE_STEP_S = 0.018  # enough in a window for the motion's fit
_LONG_REST_S = 0.3
_LONGEST_REST_S = 0.5  # between acts; otherwise long enough for a stream to start anew
_LIFT_S, _STILL_S = 0.5, 5.0  # in the air; the same attitude is held for so long
_SHARE = 0.5  # of a channel's limit that a touch takes at most
_LATENCY_S = 0.002
_MORE_POSES = 530
_LEFT_FOR_LONG = 100  # samples
_FAR_NM = 300.0
_OVERRANGE, _INVALID, _LATE, _ERROR, _CLOCK = 1, 2, 8, 16, 32


@dataclass(frozen=True)
class StreamPose:
    """A pose: s, R (nine numbers, row by row), m."""

    time: float
    R: tuple[float, ...]
    p: tuple[float, ...]


@dataclass(frozen=True)
class StreamSample:
    """A raw reading: s, s, bits of Status, N and N·m."""

    time: float
    arrival: float
    flags: int
    wrench: tuple[float, ...]


Row = StreamPose | StreamSample


def synthetic_stream(config: RuntimeConfig, samples: int, seed: int = 1) -> list[Row]:
    """
    Return poses and samples in the order in which they come.

    Parameters
    ----------
    config : RuntimeConfig
    samples : int
        How many there are; from about 300 on, every act is played at least once.
    seed : int
    """
    stage = _Stage(config, samples, np.random.default_rng(seed))
    acts = stage.acts()
    stage.unprepared()
    stage.rest(_LONG_REST_S)
    while not stage.full:
        for act in acts:
            stage.pause()
            act()
        acts = [acts[i] for i in stage.rng.permutation(len(acts))]
        if stage.long_acts and stage.left > _LEFT_FOR_LONG:
            acts.append(stage.long_acts.pop())
    return stage.rows


class _Stage:
    """Where the acts are played; it moves the tool, and adds gravity, inertia and noise."""

    def __init__(self, config: RuntimeConfig, samples: int, rng: np.random.Generator) -> None:
        model, self.probe, self.rng, self.left = config.model, config.probe, rng, samples
        self.rows: list[Row] = []
        self.gravity, self.gates = config.gravity, model.gates
        self.noise = np.array([*model.noise.force_N, *model.noise.torque_Nm])
        self.limits = np.array([np.inf if limit is None else limit for limit in self.gates.saturation])
        self.step = min(1 / model.sensor.rate_Hz, _LONGEST_STEP_S)
        quaternion = model.frames.quaternion_ES
        self.R_ES = (
            np.eye(3) if quaternion is None else Rotation.from_quat(quaternion, scalar_first=True).as_matrix()
        )
        self.time, self.next_pose, self.lead = 1.0, 1.0, 0.0
        self.follows, self._still = model.zero.follow, False
        self.cast = self._cast(config)
        self.long_acts = [self.stale_for_long, self.poses_in_advance]

    @property
    def full(self) -> bool:
        return self.left <= 0

    def acts(self) -> list[Callable[[], None]]:
        held = [partial(self.hold, touch) for touch in self.cast]
        special = [
            *([self.lift] if self.follows else []),
            self.two_touches,
            self.light,
            self.slide,
            self.no_measurements,
            self.clock,
            self.no_poses,
            self.hang,
        ]
        # In turn: whatever is cut off at the end, some of each were played.
        return [act for pair in zip_longest(special, held) for act in pair if act is not None]

    # ---- acts ----------------------------------------------------------------------------------

    def unprepared(self) -> None:
        """Play samples before there is a pose, then with one only."""
        self.play([np.zeros(6)] * 2, poses=False)
        self.play([self.cast[0]] * 3)

    def lift(self) -> None:
        """Hold still in the air, with a zero that is off by what a cable does."""
        self._still = True
        off = self.rng.uniform(-1, 1, 6) * np.repeat([0.2 * self.gates.min_force_N, 0.002], 3)
        count = round(_LIFT_S / self.step)
        self.left += count  # beside what every bundle is asked
        self.play([off] * count)
        self._still = False

    def hold(self, touch: NDArray[np.float64]) -> None:
        self.lead = float(self.rng.choice([0.0, 0.03]))
        self.play([share * touch for share in (0.05, 1.0, 1.0, 1.02, 1.0, 0.02)])

    def light(self) -> None:
        """Play a touch that grows through the least force."""
        touch = self.cast[0]
        small = self.gates.min_force_N / max(float(np.linalg.norm(touch[:3])), 1e-9)
        self.play([share * small * touch for share in (0.2, 0.8, 1.05, 1.3, 2.0, 3.0)])

    def slide(self) -> None:
        """Slide along the probe, slowly enough to be followed, then jump."""
        (one, n), (other, _) = self._place(), self._place()
        way = (other - one) / max(float(np.linalg.norm(other - one)), 1e-9)
        points = [one + 0.002 * i * way for i in range(8)] + [other] * 3
        self.play([self._wrench(p, -self._force() * n, 0.0) for p in points])

    def two_touches(self) -> None:
        """Let a second touch join one that is followed, and the first leave."""
        first = max((self._touch(0.0) for _ in range(20)), key=lambda touch: float(touch[2]))
        second = min((self._touch(0.0) for _ in range(20)), key=lambda touch: float(touch @ first))
        moment = min(self.gates.recent_samples, 40)
        self.play([first] * (moment + 4) + [first + second] * 6 + [second] * 10)

    def no_measurements(self) -> None:
        """Play NaN, and what a sensor itself flags."""
        touch = self.cast[0]
        self.play([touch] * 2)
        self.play([np.full(6, np.nan)])
        self.play([touch], flags=_LATE)
        for flag in (_INVALID, _ERROR | _OVERRANGE, _OVERRANGE, _CLOCK):
            self.play([touch], flags=flag)
        for channel in np.flatnonzero(np.isfinite(self.limits))[:2]:
            beyond = touch.copy()
            beyond[channel] += 2.5 * self.limits[channel]
            self.play([beyond])
            self.play([beyond], flags=_OVERRANGE)
        self.play([touch] * 3)
        # No touch explains these.
        self.pause()
        self.play([self._far() for _ in range(3)])
        self.play([touch + [0, 0, 0, *self.rng.normal(0, 0.3, 3)] for _ in range(4)])

    def clock(self) -> None:
        """Let time stand still, go back, and leap far ahead, which makes the times after it stale."""
        touch = self.cast[-1]
        self.play([touch] * 3)
        for back in (0.0, 0.004):
            self.play([touch], shift=-back - self.step)
        self.play([touch], shift=0.1)
        for later in (0.012, 0.01, -0.015, 0.012, 0.012, 0.02, 0.02, 0.03):
            self.play([touch])
            self.time += later
        self.play([touch] * 2)

    def stale_for_long(self) -> None:
        """Let one time lie ahead, and stay below it until the number of samples tells that it was wrong."""
        self.play([self.cast[0]], shift=0.11)
        self.play([self.cast[0]] * 60)

    def poses_in_advance(self) -> None:
        """Give more poses at once than are kept: those of the next samples are forgotten."""
        for i in range(_MORE_POSES):
            self._add_pose(self.time + 0.001 * i, *self._pose(self.time))
        self.play([self.cast[0]] * 40, poses=False)
        self.next_pose = self.time + 0.001 * _MORE_POSES
        self.time = self.next_pose

    def no_poses(self) -> None:
        """Stop the poses, give one that is no rotation and an old one, and set the robot's clock back."""
        touch = self.cast[0]
        for _ in range(6):
            self.play([touch], poses=False)
            self.time += 0.05
        R, p = self._pose(self.time)
        self._add_pose(self.time, -R, p)
        self.play([touch], poses=False)
        self.next_pose = self.time
        self.play([touch] * 2)
        self._add_pose(self.time - 0.05, R, p)
        self._add_pose(self.time - 1.0, R, np.full(3, np.nan))
        self.play([touch], poses=False)
        self.next_pose = self.time
        self.play([touch])

    def hang(self) -> None:
        """Repeat the last reading, as a sensor that hangs does."""
        # A short run, as of a coarse sensor, makes a longer one usual.
        for repeats in (6, 19):
            self.play([self.cast[0]] * 2)
            last = self.rows[-1]
            if isinstance(last, StreamSample):
                for _ in range(repeats):
                    self._poses()
                    self._sample(last.wrench, 0, 0.0)

    def pause(self) -> None:
        """Let a gap come, after which the stream starts anew."""
        self.rest(min(1.2 * self.gates.max_age_s, _LONGEST_REST_S))

    def rest(self, seconds: float) -> None:
        """Let time pass without samples."""
        self.time += seconds
        self._poses()

    # ---- the machinery -------------------------------------------------------------------------

    def play(
        self, touches: list[NDArray[np.float64]], *, flags: int = 0, shift: float = 0.0, poses: bool = True
    ) -> None:
        for touch in touches:
            if poses:
                self._poses()
            R, _ = self._pose(self.time)
            R_WS = R @ self.R_ES
            acceleration = 0.0 if self._still else -0.02 * _SWING**2 * np.sin(_SWING * self.time)
            weight = R_WS.T @ (self.gravity.gravity_W - self.gravity.mass * acceleration)
            centre = self.gravity.centre_of_mass_S
            still = np.concatenate(
                [self.gravity.force_bias + weight, self.gravity.torque_bias + np.cross(centre, weight)]
            )
            reading = still + touch + self.rng.normal(0, self.noise)
            self._sample(tuple(np.round(reading, 5).tolist()), flags, shift)

    def _sample(self, wrench: tuple[float, ...], flags: int, shift: float) -> None:
        if self.full:
            return
        self.left -= 1
        self.time += self.step
        time = round(self.time + shift, 6)
        # Not every stream knows it.
        arrival = round(time + _LATENCY_S, 6) if self.left % 4 else float("nan")
        self.rows.append(StreamSample(time, arrival, flags, wrench))

    def _poses(self) -> None:
        while self.next_pose <= self.time + self.lead and not self.full:
            self._add_pose(self.next_pose, *self._pose(self.next_pose))
            self.next_pose += _POSE_STEP_S

    def _add_pose(self, time: float, R: NDArray[np.float64], p: NDArray[np.float64]) -> None:
        self.rows.append(
            StreamPose(round(time, 6), tuple(np.round(R, 8).ravel().tolist()), tuple(np.round(p, 6).tolist()))
        )

    def _pose(self, t: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        t = t - t % _STILL_S if self._still else t
        turn = 0.4 * np.array([np.sin(0.9 * t), np.cos(0.7 * t), np.sin(0.5 * t)])
        return Rotation.from_rotvec(turn).as_matrix(), np.array([0.4, 0.0, 0.3]) + 0.02 * np.sin(_SWING * t)

    # ---- touches -------------------------------------------------------------------------------

    def _cast(self, config: RuntimeConfig) -> list[NDArray[np.float64]]:
        """Return some touches of each reason, the first one sure."""
        runtime, R = make_runtime(config), np.eye(3)
        still = self.gravity.predict(R[None])[0]
        kept: dict[str, list[NDArray[np.float64]]] = {"ok": []}
        for _ in range(_DRAWN):
            touch = self._touch(float(self.rng.choice([0.0, 0.4, 1.1, 1.45])))
            runtime.reset()
            found = kept.setdefault(runtime.update(still + touch, R, 0.0).reason_name, [])
            if len(found) < _OF_EACH:
                found.append(touch)
        sure = kept.pop("ok") or [self._touch(0.0)]
        return [*sure, *(touch for of_reason in kept.values() for touch in of_reason)]

    def _touch(self, tilt: float) -> NDArray[np.float64]:
        """Return a touch somewhere, its force so many radians off the normal."""
        p, n = self._place()
        side = np.cross(n, self.rng.normal(size=3))
        side /= max(float(np.linalg.norm(side)), 1e-9)
        size = self._force()
        return self._wrench(
            p, -size * (np.cos(tilt) * n + np.sin(tilt) * side), float(self.rng.normal(0, 5e-4)) * size
        )

    def _far(self) -> NDArray[np.float64]:
        """Return a light force with a torque that no lever of the probe makes."""
        torque = _SHARE * np.where(np.isfinite(self.limits[3:]), self.limits[3:], _FAR_NM)
        light = -1.5 * self.gates.min_force_N
        return np.array([0.0, 0.0, light, *torque * 10 ** self.rng.uniform(-2.0, 0.0)])

    def _place(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return a place on the probe, and its normal; every other one in a region, if there is one."""
        faces = np.arange(len(self.probe.faces))
        painted = np.flatnonzero(self.probe.region)
        face = int(self.rng.choice(painted if len(painted) and self.rng.integers(2) else faces))
        return self.rng.dirichlet([1.0, 1.0, 1.0]) @ self.probe.vertices[
            self.probe.faces[face]
        ], self.probe.normals[face]

    def _force(self) -> float:
        return float(self.rng.uniform(2.0, 9.0))

    def _wrench(self, p: NDArray[np.float64], F: NDArray[np.float64], k: float) -> NDArray[np.float64]:
        """Return a wrench, no larger than the sensor can read."""
        wrench = np.concatenate([F, np.cross(p, F) - k * F / max(float(np.linalg.norm(F)), 1e-9)])
        most = float((np.abs(wrench) / self.limits).max())
        return wrench * min(1.0, _SHARE / most) if most > 0 else wrench


_SWING = np.array([6.0, 5.0, 7.0])  # rad/s: accelerations of about 1 m/s²

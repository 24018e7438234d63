"""
``self_test.csv``: samples in a bundle, and the answers that every runtime must give to them; see docs/bundle.md.

A runtime that answers otherwise is another one than the bundle is for, or somebody edited the bundle.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from hashlib import sha256
from itertools import zip_longest
from math import isfinite, isnan, nan
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.config.runtime.model import RuntimeModel, SelfTestPart
from contactbench.pipeline.config.runtime.pack import SELF_TEST
from contactbench.pipeline.config.runtime.values import make_runtime
from contactbench.pipeline.errors import ConfigError, arg, message

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from numpy.typing import NDArray

    from contactbench.pipeline import kernel
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


SAMPLES: Final = 300
_TOLERANCE = 1e-9  # other processors and libraries round otherwise
_DECIMALS = 12
_AGAIN = message("Export the config again.")
_MOST_FLAGS = 255
_LARGEST = 4 * 2**20

_POSE = ("pose", "time_s", *(f"R{row}{column}" for row in "123" for column in "123"), "x_m", "y_m", "z_m")
_INPUTS = ("sample", "time_s", "arrival_s", "flags", "Fx_N", "Fy_N", "Fz_N", "Mx_Nm", "My_Nm", "Mz_Nm")
_NAMES = ("reason", "accepted", "health")
_NUMBERS = (
    "pose_age_s",
    *(
        f"{what}_{axis}_{unit}"
        for what, unit in (("force", "N"), ("torque", "Nm"), ("point", "m"))
        for axis in "xyz"
    ),
    *(f"normal_{axis}" for axis in "xyz"),
    *(f"{what}_{axis}_m" for what in ("filtered", "second", "sigma") for axis in "xyz"),
    "confidence",
    "misfit",
    "left_over_Nm",
)
_SAMPLE = (*_INPUTS, *_NAMES, *_NUMBERS)
_HEAD = (",".join(_POSE), ",".join(_SAMPLE))


def with_self_test(config: RuntimeConfig) -> RuntimeConfig:
    """Return a config with test vectors, made by the runtime of this contactbench."""
    data = _encoded(config)
    model, files = config.model, dict(sorted({**config.files, SELF_TEST: data}.items()))
    hashes = {**model.provenance.files, SELF_TEST: sha256(data).hexdigest()}
    part = SelfTestPart(file=SELF_TEST, samples=SAMPLES)
    provenance = model.provenance.model_copy(update={"files": hashes})
    model = model.model_copy(update={"self_test": part, "provenance": provenance})
    return replace(config, model=model, files=MappingProxyType(files))


def check_self_test(model: RuntimeModel, files: Mapping[str, bytes]) -> None:
    """Refuse a model that says something else of test vectors than the files; ConfigError."""
    told = None if model.self_test is None else model.self_test.file
    if told != (SELF_TEST if SELF_TEST in files else None):
        raise ConfigError(
            f"self_test.file is {arg(told)!r}, and that is not what the bundle holds. {arg(_AGAIN)}"
        )


def replay(config: RuntimeConfig, name: str) -> int | None:
    """
    Replay a config's test vectors.

    Parameters
    ----------
    config : RuntimeConfig
    name : str
        What messages call the bundle.

    Returns
    -------
    int or None
        How many samples there were; None where the config has no test vectors.

    Raises
    ------
    ConfigError
        The file is none of this kind, or the runtime gives another answer; names the first line that differs, and how
        far contacts moved.
    """
    part = config.model.self_test
    if part is None:
        return None
    where = f"{name}: {part.file}"
    lines = _lines_of(config.files[part.file], where)
    rows = [_row_of(cells, where, line) for line, cells in lines]
    samples = sum(isinstance(row, StreamSample) for row in rows)
    if samples != part.samples:
        raise ConfigError(
            f"{arg(where)}: there are {arg(samples)} samples, but self_test.samples is {arg(part.samples)}."
            f" {arg(_AGAIN)}"
        )
    first, differing, moved = "", 0, 0.0
    for (line, cells), contact in zip(lines, _answers(config, rows), strict=True):
        if contact is not None and (found := _difference(cells[len(_INPUTS) :], contact)):
            first, differing = (
                first or message(f"{arg(where)}: line {arg(line)}: {arg(found)}"),
                differing + 1,
            )
            moved = max(moved, _moved(cells[len(_INPUTS) + len(_NAMES) :], contact))
    if first:
        raise ConfigError(
            f"{arg(first)}: the bundle was edited, or is for another runtime: {arg(differing)} of {arg(samples)}"
            f" answers differ, and contacts moved by up to {arg(1e3 * moved):.3g} mm. Export the config again with"
            " this contactbench."
        )
    return samples


# ---- parts -------------------------------------------------------------------------------------


def _encoded(config: RuntimeConfig) -> bytes:
    """Return a synthetic stream, and what the runtime says of it."""
    lines = list(_HEAD)
    rows = synthetic_stream(config, SAMPLES)
    for row, contact in zip(rows, _answers(config, rows), strict=True):
        if isinstance(row, StreamPose):
            lines.append(",".join(["pose", *map(_cell, (row.time, *row.R, *row.p))]))
        elif contact is not None:
            given = ["sample", _cell(row.time), _cell(row.arrival), str(row.flags), *map(_cell, row.wrench)]
            numbers = (_cell(round(value, _DECIMALS)) for value in _numbers_of(contact))
            lines.append(",".join([*given, *_names_of(contact), *numbers]))
    return ("\n".join(lines) + "\n").encode("ascii")


def _answers(config: RuntimeConfig, rows: list[Row]) -> Iterator[kernel.RuntimeContact | None]:
    runtime = make_runtime(config)
    for row in rows:
        if isinstance(row, StreamSample):
            yield runtime.locate(np.array(row.wrench), row.time, row.arrival, row.flags)
        else:
            runtime.pose(np.array(row.R).reshape(3, 3), np.array(row.p), row.time)
            yield None


def _names_of(contact: kernel.RuntimeContact) -> tuple[str, ...]:
    return contact.reason_name, str(int(contact.accepted)), str(contact.health)


def _numbers_of(contact: kernel.RuntimeContact) -> tuple[float, ...]:
    covariance = contact.covariance
    sigmas = None if covariance is None else np.sqrt(np.maximum(np.diag(covariance), 0.0))
    return (
        contact.pose_age,
        *_many(contact.wrench, 6),
        *_many(contact.point, 3),
        *_many(contact.normal, 3),
        *_many(contact.filtered_point, 3),
        *_many(contact.second, 3),
        *_many(sigmas, 3),
        contact.confidence,
        contact.misfit,
        contact.left_over,
    )


def _many(values: NDArray[np.float64] | None, count: int) -> list[float]:
    return [nan] * count if values is None else values.tolist()


def _cell(value: float) -> str:
    return repr(value) if isfinite(value) else ""


def _lines_of(data: bytes, where: str) -> list[tuple[int, list[str]]]:
    """Return line numbers and cells."""
    if len(data) > _LARGEST:
        raise ConfigError(f"{arg(where)}: the file is larger than {arg(_LARGEST >> 20)} MiB. {arg(_AGAIN)}")
    if not data.isascii() or not data.endswith(b"\n"):
        raise ConfigError(f"{arg(where)}: this is not ASCII, or its last line has no end. {arg(_AGAIN)}")
    lines = data.decode("ascii").split("\n")[:-1]
    if tuple(lines[:2]) != _HEAD:
        raise ConfigError(f"{arg(where)}: the first two lines are not those of test vectors. {arg(_AGAIN)}")
    return [(number, line.split(",")) for number, line in enumerate(lines[2:], 3)]


def _row_of(cells: list[str], where: str, line: int) -> Row:
    kinds = {"pose": _POSE, "sample": _SAMPLE}
    columns = kinds.get(cells[0])
    if columns is None or len(cells) != len(columns):
        raise ConfigError(f"{arg(where)}: line {arg(line)} is neither a pose nor a sample. {arg(_AGAIN)}")
    try:
        if columns is _POSE:
            time, *numbers = (_number(cell) for cell in cells[1:])
            return StreamPose(time, tuple(numbers[:9]), tuple(numbers[9:]))
        time, arrival = _number(cells[1]), _number(cells[2])
        for cell in cells[len(_INPUTS) + len(_NAMES) :]:
            _number(cell)
        return StreamSample(
            time, arrival, _flags(cells[3]), tuple(_number(cell) for cell in cells[4 : len(_INPUTS)])
        )
    except ValueError as error:
        raise ConfigError(
            f"{arg(where)}: line {arg(line)} holds something other than a number ({arg(str(error)[:60])})."
            f" {arg(_AGAIN)}"
        ) from None


def _number(cell: str) -> float:
    if not cell:
        return nan
    value = float(cell)
    # In the one spelling: readers differ in what else they take for a number.
    if not isfinite(value) or repr(value) != cell:
        raise ValueError(repr(cell))
    return value


def _flags(cell: str) -> int:
    flags = int(cell)
    if not 0 <= flags <= _MOST_FLAGS or str(flags) != cell:
        raise ValueError(repr(cell))
    return flags


def _difference(told: list[str], contact: kernel.RuntimeContact) -> str:
    """Say which of the answers in a line is not the runtime's; empty: none."""
    answers: tuple[str | float, ...] = (*_names_of(contact), *_numbers_of(contact))
    for column, cell, here in zip((*_NAMES, *_NUMBERS), told, answers, strict=True):
        if not (cell == here if isinstance(here, str) else _near(_number(cell), here)):
            shown = here if isinstance(here, str) else _cell(here)
            return message(
                f"{arg(column)} is {arg(cell or 'empty'):.40}, but this runtime says {arg(shown or 'nothing')}"
            )
    return ""


def _moved(numbers: list[str], contact: kernel.RuntimeContact) -> float:
    """Return how far the point of a contact is from the one in a line, m; 0 where one of them has none."""
    begin = _NUMBERS.index("point_x_m")
    told = [_number(cell) for cell in numbers[begin : begin + 3]]
    return float(np.nan_to_num(np.linalg.norm(np.subtract(told, _many(contact.point, 3)))))


def _near(told: float, here: float) -> bool:
    if isnan(told) or not isfinite(here):
        return isnan(told) and not isfinite(here)
    return abs(told - here) <= _TOLERANCE * max(1.0, abs(told))

"""A tool on a sensor, on a real bench whose clock goes on: weighed, and pressed at known places."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil, pi

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from contactbench.pipeline.calibration import GravityModel, PoseSample
from contactbench.pipeline.contact.following import FollowedZero
from contactbench.pipeline.demo.compare import TILTS
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.reality import Reality
from contactbench.pipeline.simulation.loads import LoadedSensor, orientations_in_use
from contactbench.pipeline.simulation.reality.chance import chance
from contactbench.pipeline.simulation.reality.pulls import WrenchDisturbance
from contactbench.pipeline.simulation.reality.real_probe import RealProbe, leaning
from contactbench.pipeline.simulation.scenes.indenter import TipPress, draw_press
from contactbench.pipeline.simulation.scenes.physics import Payload
from contactbench.pipeline.simulation.sensor_model import SensorModel, SensorReadings
from contactbench.pipeline.simulation.virtual.bench import bundled
from contactbench.pipeline.simulation.virtual.markers import markers

RATE_HZ = 200.0
WARM_S = 3600.0  # since the sensor was switched on
_TURN_RAD_S, _SHORTEST_TURN_S, _STILL_S = pi / 2, 0.5, 2.5
# A press: in the air, pushed, held, let go, in the air again, s; then the tool is turned, which is not recorded.
_WAITS_S, _RAMP_S, _HELD_S, _PAUSE_S = 0.3, 0.1, 0.5, 1.5


@dataclass(frozen=True, eq=False)
class RealTouch:
    """The truth about one press; S."""

    marker: int | None  # from 1; None: somewhere else
    press: TipPress
    # (3,) of the tip on the true surface, m, and the outward normal there
    point: Floats
    normal: Floats
    contact: Floats  # (6,) what the tip does, N and N·m


@dataclass(frozen=True, eq=False)
class RealTape:
    """What was recorded, n samples, and the truth behind it."""

    times: Floats  # (n,) s since the sensor was switched on
    R_WS: Floats  # (n, 3, 3) true
    told: Floats  # (n, 3, 3) what the robot says of it, R_BS: it may be late
    readings: SensorReadings
    holds: tuple[slice, ...]  # samples of each pose or press in which nothing moves
    touches: tuple[RealTouch, ...]  # one for each hold, where something was pressed

    def means(self) -> tuple[Floats, Floats]:
        """Return mean readings (k, 6) of the holds, and what was told of their orientations (k, 3, 3)."""
        wrenches = np.array([self.readings.wrenches[hold].mean(axis=0) for hold in self.holds])
        return wrenches, self.told[[hold.stop - 1 for hold in self.holds]]

    def poses(self) -> list[PoseSample]:
        """Return the holds as poses to calibrate with."""
        poses = []
        for hold in self.holds:
            rows = self.readings.wrenches[hold]
            mean, scatter = rows.mean(axis=0), rows.std(axis=0, ddof=1)
            told = self.told[hold.stop - 1]
            poses.append(PoseSample(told, mean[:3], mean[3:], len(rows), scatter[:3], scatter[3:]))
        return poses

    def compensated(self, model: GravityModel, *, follow: bool = False) -> Floats:
        """Return mean wrenches (k, 6) of the holds without bias and weight; `follow`: the zero follows."""
        wrenches, R_WS = self.means()
        if not follow:
            return np.asarray(wrenches - model.predict(R_WS))
        compensated = model.compensate(self.told, self.readings.wrenches)
        left = compensated - FollowedZero().taken(compensated, self.told, self.times)
        return np.array([left[hold].mean(axis=0) for hold in self.holds])


class RealBench:
    """
    Quasi-static: at rest, physics gives just the sums that are taken here.

    Parameters
    ----------
    name : str
        A bundled probe: what the program is told of. `real` is what is there.
    seed : int
        Of the bench: what its effects are drawn from. The same one gives the same bench with any effects.
    rate : float
        Of the readings, Hz: fewer make it quicker, and noisier.
    noise : bool
        Whether the sensor has any.
    R_BW : (3, 3), optional
        Turns W into the robot's base, in which its poses are told.
    """

    def __init__(
        self,
        name: str,
        reality: Reality,
        seed: int,
        loaded: LoadedSensor,
        *,
        rate: float = RATE_HZ,
        noise: bool = True,
        R_BW: Floats | None = None,
    ) -> None:
        self._R_BW = np.eye(3) if R_BW is None else R_BW
        self.reality, self.loaded, self.rate, self.time = reality, loaded, rate, WARM_S
        self.real = RealProbe.of(bundled(name), markers(name), reality, seed)
        load = loaded.load
        self._disturbance = WrenchDisturbance(
            reality, self.real, seed, Payload(load.mass, load.centre_of_mass_S)
        )
        settings = loaded.settings.with_(reality, chance(seed, "crosstalk")).at(rate)
        if not noise:
            settings = settings.silent()
        self._sensor = SensorModel(settings, chance(seed, "noise"))

    def weigh(self, R_WS: Floats) -> RealTape:
        """Turn to orientations (k, 3, 3), one after the other, and stay in each."""
        rows = _Rows(self.rate, self.time)
        for number, R in enumerate(R_WS):
            before = R_WS[max(number - 1, 0)]
            angle = float(Rotation.from_matrix(before.T @ R).magnitude())
            rows.turn(before, R, max(_SHORTEST_TURN_S, angle / _TURN_RAD_S))
            rows.stay(R, _STILL_S)
        return self._read(rows)

    def warm(self) -> None:
        """Let it get warmer from now on, by what the bench adds."""
        if self.reality.warming:
            self._sensor.warm(self.reality.warming, self.time)

    def marked(self, marker: int, press: TipPress) -> RealTouch:
        """Return the touch of somebody who aims at a marker, from 1."""
        return self._touch(marker, self.real.aimed(self.real.targets[marker - 1], press), press)

    def anywhere(self, place: Floats, press: TipPress) -> RealTouch:
        """Return the touch of the point of the true surface that is nearest to a place (3,)."""
        return self._touch(None, place, press)

    def press(self, touches: Sequence[RealTouch], R_WS: Floats) -> RealTape:
        """Press one after the other, in orientations (k, 3, 3): wait, push, hold, let go."""
        rows = _Rows(self.rate, self.time)
        for touch, R in zip(touches, R_WS, strict=True):
            rows.pressed(touch, R)
        return self._read(rows)

    def _touch(self, marker: int | None, place: Floats, press: TipPress) -> RealTouch:
        point, normal = self.real.truth.nearest(place)
        return RealTouch(marker, press, point, normal, contact_of(press, point, normal))

    def _read(self, rows: _Rows) -> RealTape:
        times, R_WS, contacts, points, normals = rows.arrays()
        felt = self._disturbance.wrenches(times, R_WS, contacts, points, normals)
        readings = self._sensor.read(times, felt + self.loaded.weight(R_WS))
        late = np.searchsorted(times, times - self.reality.pose_latency / 1e3 - 1e-9)
        told = self._R_BW @ R_WS[np.minimum(late, np.arange(len(times)))]
        self.time = float(times[-1])
        return RealTape(times, R_WS, told, readings, tuple(rows.holds), tuple(rows.touches))


def contact_of(press: TipPress, point: Floats, normal: Floats) -> Floats:
    """Return the wrench (6,) about S's origin of a tip that presses so at a point with this outward normal."""
    tilt = np.radians(press.tilt)
    F = press.force * (np.sin(tilt) * leaning(normal, press.azimuth) - np.cos(tilt) * normal)
    return np.concatenate([F, np.cross(point, F) + press.torsion * normal])


class _Rows:
    """Samples as they come."""

    def __init__(self, rate: float, start: float) -> None:
        self._step, self._time = 1 / rate, start
        self._times: list[float] = []
        self._R: list[Floats] = []
        self._contacts: list[tuple[Floats, Floats, Floats]] = []
        self.holds: list[slice] = []
        self.touches: list[RealTouch] = []

    def arrays(self) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        """Return times, orientations, contacts, points and normals."""
        contacts, points, normals = (np.array(each) for each in zip(*self._contacts, strict=True))
        return np.array(self._times), np.array(self._R), contacts, points, normals

    def turn(self, before: Floats, after: Floats, seconds: float) -> None:
        count = self._count(seconds)
        path = Slerp([0.0, 1.0], Rotation.from_matrix(np.stack([before, after])))
        u = np.arange(1, count + 1) / count
        for R in path(u**3 * (10 + u * (6 * u - 15))).as_matrix():
            self._add(R)

    def stay(self, R: Floats, seconds: float) -> None:
        begin = len(self._times)
        for _ in range(self._count(seconds)):
            self._add(R)
        self.holds.append(slice(begin, len(self._times)))

    def pressed(self, touch: RealTouch, R: Floats) -> None:
        if self._times:
            self._time += _PAUSE_S
        up, held = self._count(_RAMP_S), self._count(_HELD_S)
        for share in self._ramp(up):
            self._add(R, share, touch)
        begin = len(self._times)
        for _ in range(held):
            self._add(R, 1.0, touch)
        self.holds.append(slice(begin, len(self._times)))
        self.touches.append(touch)
        for share in reversed(list(self._ramp(up))):
            self._add(R, share, touch)

    def _ramp(self, count: int) -> Iterator[float]:
        yield from [0.0] * self._count(_WAITS_S)
        yield from (np.arange(1, count + 1) / (count + 1)).tolist()

    def _count(self, seconds: float) -> int:
        return max(2, ceil(seconds / self._step - 1e-9))

    def _add(self, R: Floats, share: float = 0.0, touch: RealTouch | None = None) -> None:
        self._time += self._step
        self._times.append(self._time)
        self._R.append(R)
        nowhere = np.zeros(3)
        if touch is None:
            self._contacts.append((np.zeros(6), nowhere, nowhere))
        else:
            self._contacts.append((share * touch.contact, touch.point, touch.normal))


VERIFIED_S = 7200.0  # when markers are pressed, s since the sensor was switched on


@dataclass(frozen=True, eq=False)
class MarkedPresses:
    """Presses of markers, n of them."""

    markers: Sequence[int]  # from 1
    presses: Sequence[TipPress]
    R_WS: Floats  # (n, 3, 3)

    @classmethod
    def drawn(cls, name: str, rng: np.random.Generator) -> MarkedPresses:
        """Draw how every marker of a bundled probe is pressed, straight and at 30 degrees, with the tool in use."""
        places = [(marker, tilt) for marker in range(1, len(markers(name)) + 1) for tilt in TILTS]
        presses = [draw_press(rng, tilt) for _, tilt in places]
        return cls([marker for marker, _ in places], presses, orientations_in_use(len(places), rng))

    def on(self, bench: RealBench) -> list[RealTouch]:
        """Return what they are on a bench."""
        return [bench.marked(m, press) for m, press in zip(self.markers, self.presses, strict=True)]

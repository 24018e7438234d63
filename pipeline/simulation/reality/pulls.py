"""What a sensor feels on a real bench beside the touch and the weight: cable, yielding mount, second tip, pad, hand."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.simulation.reality.chance import chance
from contactbench.pipeline.simulation.reality.real_probe import RealProbe, leaning

if TYPE_CHECKING:
    from contactbench.pipeline.mesh.arrays import Floats, Mask
    from contactbench.pipeline.reality import Reality
    from contactbench.pipeline.simulation.scenes.physics import Payload, SceneMoment, TrueSurface


_TIED_S = np.array([0.0, 0.02, 0.06])  # m: where the cable leaves the tool, and the way it leaves
_LEAVES_S = np.array([0.0, 1.0, 0.0])
_REST_DEG = (35.0, 75.0)  # from straight up
_GIVES = 0.5  # of a unit vector: how far the cable's end moves before friction lets go
_GRIP_M, _GRIP_Z_M = 0.025, 0.045  # where a hand holds the handle
_HAND_S, _TREMOR_HZ, _TREMOR = 1.0, 10.0, 0.1
_APART_M = 0.03  # of two tips


class WrenchDisturbance:
    """
    What disturbs the wrench, sample by sample: it remembers where the cable came from and how the hand pulled.

    Quasi-static: a wrench that changes the readings, and does not move the tool.

    Parameters
    ----------
    real : RealProbe
    seed : int
        Of the bench.
    payload : Payload
        A mount that yields moves the weight, too.
    """

    def __init__(self, reality: Reality, real: RealProbe, seed: int, payload: Payload) -> None:
        self._reality, self._real = reality, real
        self._weight_W = np.array([0.0, 0.0, -payload.mass * STANDARD_GRAVITY])
        self._centre_S = payload.centre_of_mass_S
        self._free = _rest(chance(seed, "cable"))
        self._before: Floats | None = None
        self._held = np.zeros(3)
        rng = chance(seed, "hand")
        angle, self._phases = rng.uniform(0, 2 * np.pi), rng.uniform(0, 2 * np.pi, 3)
        self._grip_S = np.array([_GRIP_M * np.cos(angle), _GRIP_M * np.sin(angle), _GRIP_Z_M])
        self._chance, self._pull, self._time = rng, rng.standard_normal(3), 0.0
        self._pad = None
        if reality.patch:
            askew = float(chance(seed, "lean").uniform(0, 360))
            self._pad = Pad(real.truth, reality.patch / 1e3, reality.lean, askew, reality.twist)

    def of(self, moment: SceneMoment) -> SceneMoment:
        """Return a moment with what is felt in it; asked twice about the same time, it answers the same."""
        contact, centre, more = moment.contact, moment.centroid_S, 0
        pressed = moment.contacts > 0
        if pressed:
            contact, centre, more = self._touched(contact, moment.point_S, moment.normal_S)
        place = centre if pressed else np.zeros(3)
        rows = (np.array([moment.time]), moment.R_WS[None], contact[None], place[None], np.array([pressed]))
        felt = contact + self._beside(*rows)[0]
        reading = moment.reading - moment.contact + felt
        return replace(
            moment, reading=reading, contact=contact, centroid_S=centre, contacts=moment.contacts + more
        )

    def wrenches(
        self, times: Floats, R_WS: Floats, contacts: Floats, points: Floats, normals: Floats
    ) -> Floats:
        """
        Return what is felt beside the weight, (n, 6), one after the other.

        Parameters
        ----------
        times : (n,)
        R_WS : (n, 3, 3)
        contacts : (n, 6)
            Zero in the air.
        points, normals : (n, 3)
            Where the tip touches, if it does.
        """
        pressed: Mask = np.asarray(contacts.any(axis=1))
        contacts, centres = contacts.copy(), points.copy()
        if self._pad is not None or self._reality.second:
            last: tuple[bytes, Floats, Floats] | None = None
            for row in np.flatnonzero(pressed):
                key = contacts[row].tobytes() + points[row].tobytes()
                if last is None or last[0] != key:  # a touch that is held is the same press
                    last = (key, *self._touched(contacts[row], points[row], normals[row])[:2])
                contacts[row], centres[row] = last[1:]
        beside: Floats = self._beside(np.asarray(times), R_WS, contacts, centres, pressed)
        return contacts + beside

    # ---- what touches ------------------------------------------------------------------------------

    def _touched(self, contact: Floats, point: Floats, normal: Floats) -> tuple[Floats, Floats, int]:
        """Return the wrench (6,) of all that touches, its mean place (3,), and how many contacts more there are."""
        centre, more = point, 0
        force = float(np.linalg.norm(contact[:3]))
        if self._pad is not None and contact[:3] @ normal < 0:
            press = self._pad.press(point, normal, contact[:3])
            contact, centre = press.contact, press.centre_of_pressure
        share = self._reality.second
        if share:
            # The marker that lies nearest to the distance: on the head, and where a tip can reach.
            targets = self._real.targets
            off = np.abs(np.linalg.norm(targets - point, axis=1) - _APART_M)
            place, n = self._real.truth.nearest(targets[int(off.argmin())])
            other = -share * force * n
            contact = contact + np.concatenate([other, np.cross(place, other)])
            centre, more = (centre + share * place) / (1 + share), 1
        return contact, centre, more

    # ---- what pulls --------------------------------------------------------------------------------

    def _beside(self, times: Floats, R_WS: Floats, contacts: Floats, points: Floats, pressed: Mask) -> Floats:
        """Return what is felt beside touch and weight, (n, 6)."""
        wrenches = np.zeros((len(times), 6))
        if self._reality.cable:
            wrenches += self._cable(R_WS)
        if self._reality.mount:
            weights = R_WS.transpose(0, 2, 1) @ self._weight_W
            wrenches[:, 3:] += self._yielded(weights, np.where(pressed[:, None], contacts, 0.0), points)
        if self._reality.hand:
            wrenches += np.where(pressed[:, None], self._hand(times), 0.0)
        return wrenches

    def _cable(self, R_WS: Floats) -> Floats:
        """
        Return the cable's pull: ``P (1 - e u) / 2`` towards u, where it hangs free; e is the way it leaves the tool.

        Friction holds ``drag P z / r`` of it, with ``z <- z + de`` of length r at most (stop operator). A pull that is
        linear in e would vanish in the calibration, whose weight is any vector.
        """
        e = R_WS @ _LEAVES_S
        way = self._free - e
        way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-12)
        F_W = ((1 - e @ self._free) / 2)[:, None] * way - self._reality.drag / _GIVES * self._dragged(e)
        F_S = self._reality.cable * np.einsum("nij,ni->nj", R_WS, F_W)
        return np.hstack([F_S, np.cross(_TIED_S, F_S)])

    def _dragged(self, e: Floats) -> Floats:
        """Return z (n, 3), and remember the last."""
        held = np.zeros_like(e)
        if self._reality.drag == 0:
            return held
        before = e[0] if self._before is None else self._before
        for row, step in enumerate(np.diff(e, axis=0, prepend=before[None])):
            z = self._held + step
            length = float(np.sqrt(z @ z))
            self._held = held[row] = z if length <= _GIVES else z * (_GIVES / length)
        self._before = e[-1]
        return held

    def _yielded(self, weights: Floats, contacts: Floats, points: Floats) -> Floats:
        """Return the torques (n, 3) by which all that presses moves on a probe turned by ``c M``, to first order."""
        turns = 1e-3 * self._reality.mount * (contacts[:, 3:] + np.cross(self._centre_S, weights))
        torques = np.cross(np.cross(turns, self._centre_S), weights)
        return np.asarray(torques + np.cross(np.cross(turns, points), contacts[:, :3]))

    def _hand(self, times: Floats) -> Floats:
        """Return the pull of a hand: Ornstein-Uhlenbeck of 1 s, and a tremor."""
        pulls = np.empty((len(times), 3))
        for row, time in enumerate(times.tolist()):
            left = float(np.exp(-max(time - self._time, 0.0) / _HAND_S))
            if left < 1:
                self._pull = left * self._pull + np.sqrt(1 - left**2) * self._chance.standard_normal(3)
                self._time = time
            pulls[row] = self._pull
        pulls += _TREMOR * np.sqrt(2) * np.sin(2 * np.pi * _TREMOR_HZ * times[:, None] + self._phases)
        F = self._reality.hand / np.sqrt(3) * pulls
        return np.hstack([F, np.cross(self._grip_S, F)])


def _rest(rng: np.random.Generator) -> Floats:
    """Draw the way in W that the cable leaves a tool that it does not pull at."""
    tilt, bearing = np.radians(rng.uniform(*_REST_DEG)), rng.uniform(0, 2 * np.pi)
    return np.array([np.sin(tilt) * np.cos(bearing), np.sin(tilt) * np.sin(bearing), np.cos(tilt)])


# ---- A soft pad that presses a probe -------------------------------------------------------------


_PLACES = 200
_MODULUS = 3e6  # N/m³: 15 mm across, 9 N press it in by 4 mm
_FRICTION = 0.4
_REACH_M = 0.02
_HALVINGS = 60


@dataclass(frozen=True, eq=False)
class PadPress:
    """One press; everything in S."""

    contact: Floats  # (6,) what the pad does to the probe, N and N·m about S
    places: Floats  # (n, 3) of the surface that it touches, m
    pressures: Floats  # (n,) forces along the normals there, N

    @property
    def centre_of_pressure(self) -> Floats:
        """Mean of the places by what presses there, (3,), m."""
        return np.asarray(self.pressures @ self.places / self.pressures.sum())


class Pad:
    """
    A round pad on a bed of springs, flat before it is pressed.

    Pressure is ``p = E max(0, d + theta x - g)`` along the surface's normal, g the gap between surface and pad.
    Friction obeys ``|f| <= 0.4 p``; what pulls along the surface comes first, and of what is left a share turns about
    the normal: ``f = -0.4 p share sqrt(1 - (F_t / 0.4 F_n)²) (n x r) / |r|`` (limit surface of Goyal, Ruina and
    Papadopoulos 1991).

    Parameters
    ----------
    radius : float
        m.
    lean : float
        How far the pad stands askew, degrees, and to which azimuth.
    twist : float
        The share, -1 to 1.
    """

    def __init__(
        self, truth: TrueSurface, radius: float, lean: float = 0.0, azimuth: float = 0.0, twist: float = 0.0
    ) -> None:
        self._probe, self._radius, self._twist = truth.probe, radius, twist
        self._lean, self._azimuth = np.radians(lean), azimuth
        self._index = SurfaceIndex(truth.probe.vertices, truth.probe.faces)
        k = np.arange(
            _PLACES // 2
        )  # a sunflower, even over the disc, and its mirror image: the middle is its centre
        r, turn = radius * np.sqrt((k + 0.5) / len(k)), k * np.pi * (3 - np.sqrt(5))
        half = np.column_stack([r * np.cos(turn), r * np.sin(turn)])
        self._disc = np.concatenate([half, -half])

    def press(self, point: Floats, normal: Floats, force: Floats) -> PadPress:
        """
        Press at a point with a force (3,), N, of which the part along the normal is kept; what slips is lost.

        Raises
        ------
        InputError
            The force pulls, or the pad meets no surface.
        """
        push = float(-force @ normal)
        x = leaning(normal, 0.0)
        y = np.cross(normal, x)
        starts = point + self._disc @ np.array([x, y]) + _REACH_M * normal
        down = np.broadcast_to(-normal, starts.shape)
        distances, facets = self._index.first_hit(starts, np.ascontiguousarray(down))
        hit = (facets >= 0) & (distances < 2 * _REACH_M)
        if push <= 0 or not hit.any():
            raise InputError("a soft pad: it meets no surface, or pulls: touch elsewhere, or with less tilt.")
        gaps = distances[hit] - _REACH_M
        normals = self._probe.normals[facets[hit]]
        places = starts[hit] - distances[hit, None] * normal
        tilted = np.tan(self._lean) * (self._disc[hit] @ _bearing(self._azimuth))
        stiffness = _MODULUS * np.pi * self._radius**2 / _PLACES
        facing = np.maximum(normals @ normal, 0.0)
        pressures = _pressed(tilted - gaps, stiffness, facing, push)
        forces = -pressures[:, None] * normals
        forces += self._dragged(pressures, normals, places, force + push * normal, push)
        torque = np.cross(places, forces).sum(axis=0)
        on = pressures > 0
        return PadPress(np.concatenate([forces.sum(axis=0), torque]), places[on], pressures[on])

    def _dragged(
        self, pressures: Floats, normals: Floats, places: Floats, sideways: Floats, push: float
    ) -> Floats:
        held = _FRICTION * push
        pull = float(np.linalg.norm(sideways))
        share = min(1.0, pull / held)
        slide = pressures[:, None] / pressures.sum() * sideways * min(1.0, held / max(pull, 1e-12))
        turn = np.cross(normals, places - pressures @ places / pressures.sum())
        turn /= np.maximum(np.linalg.norm(turn, axis=1, keepdims=True), 1e-9)
        free = self._twist * np.sqrt(1.0 - share**2)
        return np.asarray(slide - _FRICTION * free * pressures[:, None] * turn)


def _bearing(azimuth: float) -> Floats:
    return np.array([np.cos(np.radians(azimuth)), np.sin(np.radians(azimuth))])


def _pressed(heights: Floats, stiffness: float, facing: Floats, push: float) -> Floats:
    """Return pressures (n,), N, that push together along the pad's axis; by halving the depth."""
    low, high = -float(heights.max()), -float(heights.min()) + push / (stiffness * max(facing.sum(), 1e-9))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        much = stiffness * np.maximum(heights + middle, 0.0) @ facing > push
        low, high = (low, middle) if much else (middle, high)
    return np.asarray(stiffness * np.maximum(heights + high, 0.0))

"""Drift: the sensor's bias followed through moments without contact, and over temperature."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import inf, isfinite
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import chdtrc, chdtri, ndtri

from pipeline.calibration.contact_error import ContactTask, contact_sensitivity, usual_task
from pipeline.calibration.fit import PoseNoise
from pipeline.calibration.model import GravityModel, prediction_jacobian
from pipeline.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
from pipeline.calibration.temperature import (
    TemperatureCoefficient,
    angle,
    six,
    temperature_coefficient,
    words,
)

# Of the twelve parameters: the biases, which are followed, and gravity and centre of mass, which are not.
_BIASES = np.array([3, 4, 5, 9, 10, 11])


_ORDER = np.concatenate([_BIASES, [0, 1, 2, 6, 7, 8]])


_BACK = np.argsort(_ORDER)


_GATE = 1e-6  # that a moment without contact is taken for a touch, if drift and noise are as given


_AGREE = 1e-3  # that moments with one offset are taken for different ones


_ANYTHING = np.repeat([1e3, 1e2], 3) ** 2  # N², N²·m²: what a bias could be after somebody zeroed the sensor


_TURNED = np.radians(
    20.0
)  # between orientations: what hangs from the probe or leans on it then looks different


_TINY = 1e-280  # the smallest probability that has a normal deviate


@dataclass(frozen=True, eq=False)
class BiasState:
    """What a tracker knows after a moment without contact.

    Attributes
    ----------
    time : float
        s.
    bias_change : (6,)
        What to add to the model's biases, S, N and N·m.
    covariance : (6, 6)
        Of `bias_change`, with the calibration's share.
    sigmas : float
        How far that is from no change, as a normal deviate of what the calibration and the moments leave
        uncertain.
    contact_shift : float
        By how much such a bias moves a contact that is computed with the uncorrected model, m: the worst of the
        task's forces.
    used : bool
        Whether the moment was taken for one without contact.
    rezeroed : bool
        Whether the sensor's zero was changed since the calibration.
    warning : str or None
        What the technician must know, and do.
    """

    time: float
    bias_change: Floats
    covariance: Floats
    sigmas: float
    contact_shift: float
    used: bool
    rezeroed: bool
    warning: str | None


class _Moment(NamedTuple):
    t: float
    R_WS: Floats
    offset: Floats  # (6,) read minus predicted
    H: Floats  # (6, 12) change of the prediction with biases, gravity, centre of mass
    noise: Floats  # (6,) variances


class BiasTracker:
    """Follows the six biases through moments in which nothing touches the probe.

    The change of the biases is a random walk. A moment shows their sum with the calibration's error at its
    orientation and noise:

        read - predicted = change + J_c c + noise,    c : errors of gravity and centre of mass

    The calibration's error is the same in every moment: averaging does not lessen it, and taking it for noise
    would make the tracker ever surer of something that it cannot see. So c is a *considered* state (Schmidt's
    Kalman filter): it is never estimated, but its covariance, and what the estimate has in common with it, are
    carried along. The test for a change is exact in the same way: beside the estimate the tracker keeps its
    dependence on the calibration's error, a (6, 12) matrix, and the noise that has entered it.

    A touch is large and sudden: a moment that neither the random walk nor the noise explains is not used.
    Several of them in a row that agree with one another, at different orientations, mean that somebody zeroed
    the sensor.

    Parameters
    ----------
    model : GravityModel
        With its covariance.
    random_walk : array_like (6,) or (2,), optional
        Of the biases, N/√s and N·m/√s; two numbers serve three axes each. Default 0.003 and 0.0001: 0.2 N and
        6 mN·m after an hour.
    age : float
        s from the calibration to the first moment. Default 600.
    smallest_touch : (float, float)
        N and N·m: what is less off than that is drift, however sudden. Default 0.2 and 0.005.
    false_alarm : float
        Probability that a moment warns although the biases have not changed. Default 1 in 1000.
    confirm : int
        Moments in a row that must agree to tell a new zero from a touch. Default 5.
    task : ContactTask, optional
        The touches behind `contact_shift`.

    Raises
    ------
    InputError
        A number is out of its range.
    """

    def __init__(
        self,
        model: GravityModel,
        *,
        random_walk: ArrayLike = (0.003, 0.0001),
        age: float = 600.0,
        smallest_touch: tuple[float, float] = (0.2, 0.005),
        false_alarm: float = 1e-3,
        confirm: int = 5,
        task: ContactTask | None = None,
    ) -> None:
        self.model = model
        self._walk = six("random_walk", random_walk) ** 2
        if not 0 <= age < inf:
            raise InputError(f"BiasTracker.age: {age} s; give the time since the calibration, 0 or more")
        if not (0 < false_alarm < 1 and confirm >= 2 and min(smallest_touch) >= 0):
            raise InputError(
                f"BiasTracker: false_alarm {false_alarm} must lie between 0 and 1, confirm {confirm} must be 2 or"
                f" more, smallest_touch {smallest_touch} not negative"
            )
        self._touch, self._false_alarm, self._confirm = smallest_touch, false_alarm, confirm
        task = task or usual_task()
        self._sensitivity = contact_sensitivity(task.point, task.normal, task.forces)
        self._prior = model.covariance[np.ix_(_ORDER, _ORDER)]
        self._suspects: deque[_Moment] = deque(maxlen=confirm)
        self._history: list[tuple[float, float, Floats, Floats]] = []
        self._t = -inf
        self._rezeroed = False
        self._restart(self._walk * age)

    def _restart(self, spread: Floats) -> None:
        self._change = np.zeros(6)
        self._P = self._prior.copy()
        self._P[range(6), range(6)] += spread
        self._dependence, self._entered = np.zeros((6, 12)), np.zeros((6, 6))

    def update(
        self,
        t: float,
        R_WS: ArrayLike,
        wrench: ArrayLike,
        noise: PoseNoise | ArrayLike,
        temperature: float | None = None,
    ) -> BiasState:
        """Take the mean reading of a moment that is thought to be without contact.

        Parameters
        ----------
        t : float
            s, not before the last moment's.
        R_WS : array_like (3, 3)
            Orientation of the sensor.
        wrench : array_like (6,)
            Mean reading, S, N and N·m, with bias and weight.
        noise : PoseNoise or array_like (6,)
            Standard deviation of that mean: a capture's standard error, with what orientations are off by.
        temperature : float, optional
            Of the sensor, degrees Celsius; kept for `temperature_coefficient`.

        Raises
        ------
        InputError
            A shape is wrong, a number is not finite, or time runs backwards.
        """
        moment = self._moment(t, R_WS, wrench, noise)
        self._P[range(6), range(6)] += self._walk * (0.0 if self._t == -inf else t - self._t)
        self._t = t
        if self._is_touch(moment):
            self._suspects.append(moment)
            return self._doubted()
        self._suspects.clear()
        self._absorb(moment)
        if temperature is not None and isfinite(temperature):
            self._history.append((t, temperature, moment.offset, np.sqrt(moment.noise)))
        return self._state(used=True, warning=self._warning())

    def corrected_model(self) -> GravityModel:
        """Return the model with the biases as they are now, and its covariance; nothing applies it by itself.

        Gravity and centre of mass stay as they are; what the new biases have in common with their errors is in
        the covariance.
        """
        theta = self.model.vector.copy()
        theta[_BIASES] += self._change
        return GravityModel.from_vector(theta, self._P[np.ix_(_BACK, _BACK)])

    def temperature_coefficient(self) -> TemperatureCoefficient:
        """Return how the biases follow the temperature, from all moments that were used and had one.

        Raises
        ------
        InputError
            There were fewer than two.
        """
        if len(self._history) < 2:
            raise InputError(
                f"temperature_coefficient: {len(self._history)} moments with a temperature; give it to update"
            )
        t, temperatures, offsets, sigmas = zip(*self._history, strict=True)
        return temperature_coefficient(temperatures, offsets, sigmas, t)

    # ---- one moment ----------------------------------------------------------------------------

    def _moment(self, t: float, R_WS: ArrayLike, wrench: ArrayLike, noise: PoseNoise | ArrayLike) -> _Moment:
        R, w = np.array(R_WS, dtype=np.float64), np.array(wrench, dtype=np.float64)
        if R.shape != (3, 3) or w.shape != (6,) or not (np.isfinite(R).all() and np.isfinite(w).all()):
            raise InputError(
                f"BiasTracker.update: give finite R_WS (3, 3) and wrench (6,), not shapes {R.shape}, {w.shape}"
            )
        if not self._t <= t < inf:
            raise InputError(
                f"BiasTracker.update: time {t} s after {self._t} s; times must not run backwards"
            )
        sigmas = noise.sigmas if isinstance(noise, PoseNoise) else six("noise", noise)
        H = prediction_jacobian(R.T[None], self.model.vector)[0][:, _ORDER]
        return _Moment(t, R, w - self.model.predict(R), H, sigmas**2)

    def _is_touch(self, moment: _Moment) -> bool:
        jump = moment.offset - self._change
        large = np.linalg.norm(jump[:3]) > self._touch[0] or np.linalg.norm(jump[3:]) > self._touch[1]
        S = moment.H @ self._P @ moment.H.T + np.diag(moment.noise)
        return bool(large and jump @ np.linalg.solve(S, jump) > chdtri(6, _GATE))

    def _absorb(self, moment: _Moment) -> None:
        """Update the estimate; gravity and centre of mass keep their values but not their independence."""
        H, N = moment.H, np.diag(moment.noise)
        S = H @ self._P @ H.T + N
        K = np.linalg.solve(S, H @ self._P[:, :6]).T
        self._change = self._change + K @ (moment.offset - self._change)
        stay = np.eye(12)
        stay[:6] -= K @ H
        self._P = stay @ self._P @ stay.T
        self._P[:6, :6] += K @ N @ K.T
        self._P = 0.5 * (self._P + self._P.T)
        rest = np.eye(6) - K
        self._dependence = rest @ self._dependence + K @ H
        self._entered = rest @ self._entered @ rest.T + K @ N @ K.T

    def _doubted(self) -> BiasState:
        """Decide what moments that look touched mean."""
        if len(self._suspects) < self._confirm or not self._agree():
            size = self._suspects[-1].offset - self._change
            return self._state(
                used=False,
                warning=f"Touched: {words(size)} off, too much and too sudden for drift. This moment is not used.",
            )
        turned = max(angle(self._suspects[0].R_WS, moment.R_WS) for moment in self._suspects)
        if turned < _TURNED:
            return self._state(
                used=False,
                warning=f"The last {self._confirm} moments are off by the same {words(self._suspects[-1].offset)}:"
                " the sensor has been re-zeroed, or something rests on the probe. Turn the wrist to tell which.",
            )
        self._rezeroed = True
        self._restart(_ANYTHING)
        for moment in self._suspects:
            self._absorb(moment)
        self._suspects.clear()
        return self._state(used=True, warning=self._warning())

    def _agree(self) -> bool:
        """Return whether the suspects show one and the same offset, however they are turned."""
        moments = list(self._suspects)
        offsets = np.array([moment.offset for moment in moments])
        middle = np.median(offsets, axis=0)
        walked = self._walk * (moments[-1].t - moments[0].t)
        own = self._prior.copy()
        own[:6] = own[:, :6] = 0.0  # an error of the biases is the same in all of them
        total = 0.0
        for moment, offset in zip(moments, offsets - middle, strict=True):
            C = moment.H @ own @ moment.H.T + np.diag(moment.noise + walked)
            total += float(offset @ np.linalg.solve(C, offset))
        return bool(total < chdtri(6 * len(moments), _AGREE))

    # ---- what it means -------------------------------------------------------------------------

    def _sigmas(self) -> float:
        """Return how far the change is from what an unchanged bias would show."""
        expected = self._dependence @ self._prior @ self._dependence.T + self._entered
        scale = np.sqrt(np.maximum(np.diag(expected), 1e-30))
        unit = self._change / scale
        whitened = expected / np.outer(scale, scale) + 1e-12 * np.eye(6)
        square = float(unit @ np.linalg.solve(whitened, unit))
        p = float(chdtrc(6, square))
        return float(-ndtri(p / 2)) if p > _TINY else float(np.sqrt(square))

    def _shift(self) -> float:
        return float(np.linalg.norm(self._sensitivity @ self._change, axis=1).max())

    def _warning(self) -> str | None:
        effect = f"a contact is off by up to {1e3 * self._shift():.2g} mm"
        if self._rezeroed:
            return f"The sensor seems to have been re-zeroed ({words(self._change)}; {effect}): recalibrate."
        sigmas = self._sigmas()
        if sigmas < -ndtri(self._false_alarm / 2):
            return None
        return (
            f"The bias has moved by {words(self._change)} since the calibration, {sigmas:.1f} sigma of what that"
            f" leaves open; {effect}. Recalibrate, or take over the corrected bias."
        )

    def _state(self, *, used: bool, warning: str | None) -> BiasState:
        return BiasState(
            self._t, self._change.copy(), self._P[:6, :6].copy(), self._sigmas(), self._shift(), used,
            self._rezeroed, warning,
        )  # fmt: skip

"""Touches as they happen: the protocol on live samples, and what it has found so far."""

from __future__ import annotations

import threading
from collections import Counter, deque
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.contact.following import FollowedZero, follow_words
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.verification.markers import Marker, MarkerSet, TouchLocator, memory, sample_noise
from contactbench.pipeline.verification.protocol import ProtocolState, Touch, TouchEvent, TouchProtocol
from contactbench.pipeline.verification.verify import VerifySettings
from contactbench.pipeline.workbench.live import LiveBlock

_SMOOTH = 10  # samples that the shown force is the mean of
_RECENT_S = 1.0
_FEWEST = 40  # samples that noise is told from
SEEN = message("The zero was seen: touch the next marker.")  # the one notice that is good news


@dataclass
class TouchOrder:
    """
    The order in which markers are touched, where it is given; it can be changed while touches go on.

    A protocol asks for ``order[accepted % len(order)]``; written out touch by touch, a marker can be left out, or
    touched again, without a change of what was asked before.
    """

    names: list[str]  # One for each touch

    @classmethod
    def of(cls, order: Sequence[str], repeats: int, windows: int) -> TouchOrder:
        """Return every marker in its turn, once per repeat and force window."""
        return cls([name for _ in range(repeats * windows) for name in order])

    def skip(self, accepted: int) -> bool:
        """Leave out the marker that would come next, this time and all others; whether there was one."""
        if accepted >= len(self.names):
            return False
        name = self.names[accepted]
        self.names[accepted:] = [each for each in self.names[accepted:] if each != name]
        return True

    def repeat(self, accepted: int, name: str) -> None:
        """Have a marker touched next."""
        self.names.insert(min(accepted, len(self.names)), name)


@dataclass(frozen=True)
class TouchOf:
    """A press that was decided, as it is shown."""

    marker: str | None  # None: unknown
    why: str  # Why it was rejected; empty: it was accepted
    force: float  # N
    error_mm: tuple[float, float, float] | None = None  # (3,) tuple; Contact minus marker, S
    # size_mm, sigma_mm: Length of that, and what noise and calibration explain (1 sigma)
    size_mm: float | None = None
    sigma_mm: float | None = None

    @property
    def ratio(self) -> float | None:
        """The error over what noise and calibration explain."""
        return self.size_mm / self.sigma_mm if self.size_mm is not None and self.sigma_mm else None


@dataclass(frozen=True)
class MarkerRow:
    """
    What is known of a marker; errors in mm; `state` is open, done, failed or skipped.

    `wanted` is the number of accepted touches that it needs, `window` the force window (N) of the next of them.
    """

    name: str
    point_mm: tuple[float, float, float]  # S
    touches: int = 0
    wanted: int = 1
    mean_mm: float | None = None
    max_mm: float | None = None
    state: str = "open"
    window: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class TouchView:
    """All that there is to see now."""

    state: ProtocolState
    force: float  # |F|, N, compensated; NaN: not known
    rows: tuple[MarkerRow, ...]
    next_one: int | None  # Place of the marker that should be touched next; None: all are done
    window: tuple[float, float]  # (low, high); With what force, N
    last: TouchOf | None
    errors_mm: tuple[float, ...]  # Of the accepted touches, oldest first
    mean_mm: float | None
    sd_mm: float | None
    max_mm: float | None
    accepted: int
    wanted: int
    notice: str  # What is in the way; empty: nothing
    # For the accepted touches, S: where the marker is and where it was found, m, and the covariance of that, m²
    contacts: tuple[tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]], ...] = field(
        default=()
    )


def point_mm(marker: Marker) -> tuple[float, float, float]:
    """Return where a marker is, S, mm."""
    x, y, z = (1e3 * marker.point_S).tolist()
    return x, y, z


def live_noise(wrenches: NDArray[np.float64]) -> tuple[WrenchNoise, float] | None:
    """
    Return the noise of a sample, such that a mean of n has 1/n of its variance, and the correlation of neighbours.

    Parameters
    ----------
    wrenches : (n, 6)
        Samples in a row, N and N·m; raw ones will do.
    """
    from contactbench.pipeline.contact import WrenchNoise

    run = wrenches[np.isfinite(wrenches).all(axis=1)]
    if len(run) < _FEWEST:
        return None
    tau, neighbours = memory([run]) or (1.0, 0.0)
    correlation = max(tau / (1 - min(neighbours, 0.999)), 1.0)
    base, root = sample_noise([run]), np.sqrt(correlation)
    return WrenchNoise(np.asarray(base.force) * root, np.asarray(base.torque) * root), correlation


class LiveTouches:
    """
    Follow live samples; `feed` is called in their thread, everything else in any.

    Parameters
    ----------
    probe : Probe
        S.
    model : GravityModel
    markers : MarkerSet
        With normals.
    settings : VerifySettings
    noise : (WrenchNoise, correlation)
        See `live_noise`.
    """

    def __init__(
        self,
        probe: Probe,
        model: GravityModel,
        markers: MarkerSet,
        settings: VerifySettings,
        noise: tuple[WrenchNoise, float],
    ) -> None:
        self.markers, self.settings = markers, settings
        self._model, protocol = model, settings.protocol
        self._turns: TouchOrder | None = None
        if protocol.order:
            self._turns = TouchOrder.of(protocol.order, protocol.repeats, len(protocol.windows))
            protocol = replace(protocol, order=tuple(self._turns.names))
        placing = TouchLocator(probe, markers, model, noise[0], protocol.samples, noise[1])
        self._protocol = TouchProtocol(placing, protocol)
        self._zero = FollowedZero() if settings.follow else None
        self._now = self._touched = 0.0  # s of the samples' clock: the last one, and the last one in a touch
        self._lock = threading.Lock()
        self._touches: dict[float, Touch] = {}
        self._events: deque[TouchEvent] = deque(maxlen=200)
        self._forces: deque[float] = deque(maxlen=_SMOOTH)
        self._poses: deque[tuple[float, bool]] = deque()
        self._first: list[float] = []
        self._skipped: dict[str, str] = dict(settings.left_out)
        self._again: list[str] = []
        self._extra: Counter[str] = Counter()
        self._last: Touch | None = None

    # ---- samples -----------------------------------------------------------------------------

    def feed(self, block: LiveBlock) -> None:
        """Take samples."""
        wrenches = self._model.compensate(block.R_WS, block.wrenches)
        with self._lock:
            if self._zero is not None:
                wrenches = wrenches - self._zero.taken(wrenches, block.R_WS, block.times)
            self._watch(block.times, wrenches)
            for event in self._protocol.feed(block.times, wrenches, block.R_WS, block.saturated):
                self._heard(event)
            self._now = float(block.times[-1]) if len(block.times) else self._now
            if self._protocol.state is not ProtocolState.ARMED:
                self._touched = self._now

    def _watch(self, times: NDArray[np.float64], wrenches: NDArray[np.float64]) -> None:
        known = np.isfinite(wrenches).all(axis=1)
        sizes = np.linalg.norm(wrenches[known, :3], axis=1).tolist()
        self._forces.extend(sizes)
        if len(self._first) < _FEWEST:
            self._first.extend(sizes[: _FEWEST - len(self._first)])
        if len(times):
            self._poses.append((float(times[-1]), bool(known.any())))
            while self._poses[0][0] < times[-1] - _RECENT_S:
                self._poses.popleft()

    def _heard(self, event: TouchEvent) -> None:
        self._events.append(event)
        touch = event.touch
        if touch is None:
            return
        self._touches[touch.start] = self._last = touch
        if touch.why is None and touch.placed is not None:
            name = self.markers[touch.placed.marker].name
            if name in self._again:
                self._again.remove(name)

    def end(self) -> None:
        """Take no more samples: a press that goes on has ended."""
        with self._lock:
            for event in self._protocol.finish():
                self._heard(event)

    # ---- wishes ------------------------------------------------------------------------------

    def skip(self, why: str = "", name: str | None = None) -> str | None:
        """
        Leave out the next marker; returns its name, None: nothing is left out.

        Parameters
        ----------
        why : str
            Kept with the verification. Without it, that says of the marker that it is missing.
        name : str, optional
            Only if it is this one.
        """
        with self._lock:
            rows = self._rows()
            place = self._next(rows)
            if place is None or name not in (None, self.markers[place].name):
                return None
            name = self.markers[place].name
            if self._turns is not None:
                if not self._turns.skip(self._accepted_count()):
                    return None
                self._reorder()
            if name in self._again:
                self._again.remove(name)
            self._skipped[name] = why.strip()
            return name

    def repeat(self, name: str) -> None:
        """Have a marker touched next, once more; all its touches count."""
        with self._lock:
            self._skipped.pop(name, None)
            if name in self._again:
                return
            if self._turns is not None:
                self._turns.repeat(self._accepted_count(), name)
                self._reorder()
            self._extra[name] += 1
            self._again.insert(0, name)

    def _reorder(self) -> None:
        assert self._turns is not None  # noqa: S101  (for the type checker; both callers asked)
        self._protocol.settings = replace(self._protocol.settings, order=tuple(self._turns.names))

    @property
    def order(self) -> tuple[str, ...]:
        """In which markers were asked for, touch by touch; empty: any order. What the same recording is judged by."""
        return tuple(self._turns.names) if self._turns is not None else ()

    @property
    def left_out(self) -> dict[str, str]:
        """Markers that were left out for a reason, and the reasons."""
        with self._lock:
            return {name: why for name, why in self._skipped.items() if why}

    # ---- what is seen ------------------------------------------------------------------------

    def take_events(self) -> list[TouchEvent]:
        """Return what happened since the last call."""
        with self._lock:
            events = list(self._events)
            self._events.clear()
            return events

    def view(self) -> TouchView:
        """Return all that there is to see now."""
        with self._lock:
            rows = self._rows()
            place = self._next(rows)
            shown = [self._shown(touch) for touch in self._accepted()]
            sizes = [each.size_mm for each in shown if each.size_mm is not None]
            window = self.settings.protocol.windows[0]
            if place is not None and rows[place].window is not None:
                window = rows[place].window or window
            return TouchView(
                state=self._protocol.state,
                force=float(np.mean(self._forces)) if self._forces else float("nan"),
                rows=rows,
                next_one=place,
                window=window,
                last=None if self._last is None else self._shown(self._last),
                errors_mm=tuple(sizes),
                mean_mm=float(np.mean(sizes)) if sizes else None,
                sd_mm=float(np.std(sizes, ddof=1)) if len(sizes) > 1 else None,
                max_mm=max(sizes) if sizes else None,
                accepted=len(shown),
                wanted=sum(row.wanted for row in rows if row.state != "skipped"),
                notice=self._notice(),
                contacts=tuple(
                    (self.markers[touch.placed.marker].point_S, touch.located.point, touch.located.covariance)
                    for touch in self._accepted()
                    if touch.placed is not None and touch.located is not None
                ),
            )

    def _accepted(self) -> list[Touch]:
        return [touch for touch in self._touches.values() if touch.why is None and touch.placed is not None]

    def _accepted_count(self) -> int:
        return len(self._accepted())

    def _shown(self, touch: Touch) -> TouchOf:
        known = touch.placed is not None and not (touch.placed.far and touch.why is not None)
        marker = self.markers[touch.placed.marker] if known and touch.placed is not None else None
        if marker is None or touch.located is None:
            return TouchOf(None if marker is None else marker.name, str(touch.why or ""), touch.force)
        x, y, z = (1e3 * (touch.located.point - marker.point_S)).tolist()
        return TouchOf(
            marker.name,
            str(touch.why or ""),
            touch.force,
            (x, y, z),
            float(np.linalg.norm((x, y, z))),
            float(1e3 * np.sqrt(np.trace(touch.located.covariance))),
        )

    def _rows(self) -> tuple[MarkerRow, ...]:
        errors: dict[str, list[float]] = {}
        windows: Counter[tuple[str, tuple[float, float]]] = Counter()
        for touch in self._accepted():
            shown = self._shown(touch)
            if shown.marker is not None and touch.window is not None:
                errors.setdefault(shown.marker, []).append(shown.size_mm or 0.0)
                windows[shown.marker, touch.window] += 1
        return tuple(self._row(each, errors.get(each.name, []), windows) for each in self.markers.markers)

    def _row(
        self, marker: Marker, errors: list[float], windows: Counter[tuple[str, tuple[float, float]]]
    ) -> MarkerRow:
        name, protocol = marker.name, self.settings.protocol
        left = [each for each in protocol.windows if windows[name, each] < protocol.repeats]
        wanted = protocol.repeats * len(protocol.windows) + self._extra[name]
        worst = max(errors) if errors else None
        state = "open"
        if name in self._skipped:
            state = "skipped"
        elif not left and name not in self._again:
            state = "failed" if worst is not None and worst > 1e3 * self.settings.limits.max_m else "done"
        mean = float(np.mean(errors)) if errors else None
        window = left[0] if left else None
        return MarkerRow(name, point_mm(marker), len(errors), wanted, mean, worst, state, window)

    def _next(self, rows: tuple[MarkerRow, ...]) -> int | None:
        names = self.markers.names
        if self._turns is not None:
            accepted = self._accepted_count()
            return names.index(self._turns.names[accepted]) if accepted < len(self._turns.names) else None
        if self._again:
            return names.index(self._again[0])
        return next((place for place, row in enumerate(rows) if row.state == "open"), None)

    def _notice(self) -> str:
        if self._poses and not any(known for _, known in self._poses):
            return message(
                "No pose arrives with the samples, so the weight cannot be subtracted. Check the"
                " robot's connection; touches count again once it is back."
            )
        release = self.settings.protocol.release_N
        if len(self._first) >= _FEWEST and not self._touches and np.median(self._first) > release:
            return message(
                f"The sensor reads {arg(float(np.median(self._first))):.1f} N, but nothing should touch"
                " it yet: lift the probe clear. If nothing touches it, recalibrate."
            )
        return self._zero_notice() if self._zero is not None else ""

    def _zero_notice(self) -> str:
        """Ask for a moment without touch where none was seen since the last touch; say that one was."""
        told = self._zero.at(self._now) if self._zero is not None else None
        if told is None or self._protocol.state is not ProtocolState.ARMED:
            return ""
        if told.follows == "stopped":
            return follow_words(told)
        if not self._now - told.seen > self._touched:
            return message("Lift the probe clear for half a second: the zero follows.")
        return SEEN

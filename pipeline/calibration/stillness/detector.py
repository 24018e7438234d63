"""The detector: sample by sample, from moving to a capture."""

from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from math import ceil, inf, isfinite, log

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.calibration.model import GravityModel
from contactbench.pipeline.calibration.stillness.blocks import (
    HeldCapture,
    SampleBlock,
    StillnessIntake,
    Window,
)
from contactbench.pipeline.calibration.stillness.captures import (
    Capture,
    Rejected,
    Stillness,
    StillnessSettings,
    StillState,
    angle,
    backwards,
    checked,
    done_words,
    orientation,
    size,
    stale_words,
)
from contactbench.pipeline.calibration.stillness.quiet import Yardstick
from contactbench.pipeline.errors import InputError, arg, message

Floats = NDArray[np.float64]

_UNREST = 10.0  # times what is allowed: beyond, it moves; below, it settles
_DECAY = 2.0  # s: what would take longer to decay is motion
_KNOCK = 1.0  # s: what disturbs for longer was no bump; the robot has left
_REARM = 0.5  # s of unrest, after which a captured pose counts as left
_SOFT, _SOFT_S = 5, 1.0  # blocks before a disturbance that do not count, and s; the fewer of both
_FEWEST_BLOCKS = 3  # of a capture: fewer show no drift
_LOST = 1.5  # samples that may be missing in a row where they are rarer than `longest_gap`
_TRIMS = 3  # times that the start of a capture is left out; what then still drifts is no settling


class StillnessDetector:
    """Follows a stream of raw readings: says when it is still, averages, and drops captures that are disturbed.

    One capture is made in every pose. It begins in the window that was quiet, and ends by itself when its
    standard error is as small as asked for, or would hardly fall any more. A bump within it drops it. If the
    robot moves on, what was averaged until then counts if it lasted ``min_duration``. A capture is withdrawn
    (and then is among `rejected`, with the same indices) if it turns out to have been made in motion, because
    the sensor was much quieter later; a floor that is given, or a rate of 200 Hz, makes that very rare.

    Without orientations, a pose counts as left after half a second of unrest: a long shock after a capture
    makes a second one of the same pose, and a slow turn about the vertical, of which no weight tells, none.

    Attributes
    ----------
    captures : list of Capture
    rejected : list of Rejected
        So far, in order.

    Parameters
    ----------
    rate_hz : float, optional
        Samples a second; left out: taken from the times of the first half second.
    settings : StillnessSettings, optional
    model : GravityModel, optional
        A preliminary calibration. A steady touch is as still as no touch; only a model and the orientation show
        it.

    Raises
    ------
    InputError
        The rate is not positive and finite.
    """

    def __init__(
        self,
        rate_hz: float | None = None,
        settings: StillnessSettings | None = None,
        model: GravityModel | None = None,
    ) -> None:
        if rate_hz is not None and not (isfinite(rate_hz) and rate_hz > 0):
            raise InputError(f"StillnessDetector.rate_hz must be positive and finite, not {arg(rate_hz)}")
        self.settings = s = settings or StillnessSettings()
        self.model = model
        self.captures: list[Capture] = []
        self.rejected: list[Rejected] = []
        self._intake = StillnessIntake(rate_hz)
        self._rule = Yardstick(s, self._intake)
        self._blocks: deque[SampleBlock] = deque()  # the window
        self._unrests: deque[float] = deque()
        self._begun = False
        self._open: list[SampleBlock] = []  # the capture that is being made
        self._held: HeldCapture | None = None  # one that was disturbed
        self._done: Capture | None = None  # that of this pose
        self._after: list[SampleBlock] = []  # the still blocks of the newest capture, and what followed
        self._restless = 0.0  # s since the pose was captured
        self._trims = 0
        self._touched: int | None = None  # which of the rejected goes on
        unknown = np.full(6, np.nan)
        self._recommended = s.min_duration
        waiting = message("Waiting for samples.")
        self._now = Stillness(
            StillState.SETTLING, None, unknown, unknown, unknown, 0.0, s.min_duration, waiting
        )
        self._fresh: tuple[Capture | None, Rejected | None] = (None, None)

    def update(self, t: float, wrench: ArrayLike, R_WS: ArrayLike | None = None) -> Stillness:
        """Take one sample.

        Parameters
        ----------
        t : float
            s, not before the last sample's.
        wrench : array_like (6,)
            As the sensor gives it, S, N and N·m. Samples with NaN are skipped.
        R_WS : array_like (3, 3), optional
            Orientation of the sensor.

        Returns
        -------
        Stillness
            Changes every 0.1 s; every 0.2 s with less than 160 samples a second, and so on.

        Raises
        ------
        InputError
            A shape is wrong, or time runs backwards.
        """
        w = np.asarray(wrench, dtype=np.float64)
        if w.shape != (6,):
            raise InputError(f"wrench: give six numbers, force before torque, not shape {arg(w.shape)}")
        R = None if R_WS is None else orientation(R_WS, ())
        if not self._intake.latest <= t < inf:
            raise InputError(backwards(t, self._intake.latest))
        if t >= self._intake.due:
            for block in self._intake.close(t):
                self._take(block)
        self._intake.put(t, w, 1, R)
        return self._answer()

    def update_block(self, t: ArrayLike, wrenches: ArrayLike, R_WS: ArrayLike | None = None) -> Stillness:
        """Take samples (n,), (n, 6), with orientations (n, 3, 3) or one (3, 3); as n calls of `update`.

        `captures` and `rejected` hold what was found on the way.

        Raises
        ------
        InputError
            As for `update`.
        """
        times, w, R = checked(t, wrenches, R_WS, self._intake.latest)
        for block in self._intake.feed(times, w, R):
            self._take(block)
        return self._answer()

    def poll(self, now: float) -> Stillness:
        """Return the state at time `now`, s, when no sample has come: STALE after `longest_gap`."""
        silent = now - self._intake.latest
        if not self._longest_gap < silent < inf:
            return self._answer()
        return replace(
            self._answer(), state=StillState.STALE, seconds_until_still=None, sentence=stale_words(silent)
        )

    def finish(self) -> Stillness:
        """Say that the stream has ended: what was averaged until now counts if it is long enough."""
        last = self._intake.summary() if self._intake.rate else None
        if last is not None:
            self._take(last)
        if self._open:
            self._held, self._open = HeldCapture(self._open, "", self._intake.latest), []
        self._release(message("the recording ended"))
        return self._answer()

    def _answer(self) -> Stillness:
        if self._fresh == (None, None):
            return self._now
        captured, rejected = self._fresh
        self._fresh = (None, None)
        return replace(self._now, captured=captured, rejected=rejected)

    def _state(
        self, state: StillState, sentence: str, seconds: float | None, window: Window | None = None
    ) -> None:
        now = self._now
        sd, slope, sigma = now.sd, now.slope, now.slope_sigma
        if window is not None:
            sd, slope, sigma = np.sqrt(window.variance), window.slope, window.slope_sigma
        averaged = self._duration(self._open[:-1] or self._open) if self._open else 0.0
        if self._done:
            averaged = self._done.duration
        self._now = Stillness(state, seconds, sd, slope, sigma, averaged, self._recommended, sentence)

    def _reject(self, blocks: Sequence[SampleBlock], state: StillState, reason: str) -> None:
        first, last = blocks[0], blocks[-1]
        self._refuse(Rejected(first.first, last.last, first.start, last.stop, state, reason))

    def _refuse(self, rejected: Rejected) -> None:
        self.rejected.append(rejected)
        self._fresh = (self._fresh[0], rejected)

    @property
    def _longest_gap(self) -> float:
        rate = self._intake.rate
        return max(self.settings.longest_gap, (1 + _LOST) / rate) if rate else self.settings.longest_gap

    @property
    def shortest_stop(self) -> float:
        """How long a robot must stand, once settled, for a capture, s; longer the slower the samples come."""
        s, length = self.settings, self._intake.length if self._intake.rate else 0.0
        whole = max(s.window, (self._blocks.maxlen or 0) * length)
        return max(whole, whole / 2 + self._needed)

    @property
    def _needed(self) -> float:
        return max(self.settings.min_duration, _FEWEST_BLOCKS * self._intake.length)

    @property
    def _soft(self) -> int:
        return min(_SOFT, ceil(_SOFT_S / self._intake.length))

    # ---- one block -----------------------------------------------------------------------------

    def _take(self, block: SampleBlock | None) -> None:
        gap = self._intake.due - self._intake.last_finite if block is None else block.gap
        if gap > self._longest_gap and self._begun:
            self._interrupt(gap)
        if block is None:
            return
        if not self._begun:
            size = self._rule.begin(self._intake.length, block.stop)
            self._begun, self._blocks, self._unrests = True, deque(maxlen=size), deque(maxlen=size)
        before = Window(self._blocks) if self._open else None
        self._blocks.append(block)
        window = Window(self._blocks)
        if self._full and self._rule.learn(window, bool(self.captures)):
            self._doubt_captures()
        if before is not None:
            self._average(block, before, window)
        else:
            self._wait(block, window)

    @property
    def _full(self) -> bool:
        return len(self._blocks) == self._blocks.maxlen

    def _interrupt(self, gap: float) -> None:
        """Begin anew after a pause in the samples."""
        if self._open:
            reason = message(
                f"no samples for {arg(gap):.2g} s after {arg(self._duration(self._open)):.1f} s of averaging"
            )
            self._reject(self._open, StillState.STALE, reason)
        elif self._held:
            self._reject(self._held.blocks, StillState.BUMPED, self._held.reason)
        self._open, self._held = [], None
        if self._done and self._done.R_WS is None:
            self._done = None  # nobody knows what happened meanwhile
        self._blocks.clear()
        self._unrests.clear()
        self._state(StillState.STALE, stale_words(gap), None)

    def _doubt_captures(self) -> None:
        """Withdraw captures that were louder than the floor is now known to be: they were made in motion."""
        loudest = 1.5 * self.settings.scatter_ratio * self._rule.floor
        for index in reversed(range(len(self.captures))):
            old = self.captures[index]
            if (old.sd <= loudest).all():
                continue
            del self.captures[index]
            self._rule.memory.forget(index)
            if old is self._done:
                self._done = None
            scatter = size(old.sd, old.sd / loudest)
            reason = message(f"withdrawn: it scattered by {arg(scatter)}, more than the still sensor does")
            span = old.start_index, old.stop_index, old.start, old.stop
            self._refuse(Rejected(*span, StillState.MOVING, reason))

    # ---- without a capture ---------------------------------------------------------------------

    def _wait(self, block: SampleBlock, window: Window) -> None:
        unrest, by = self._rule.unrest(window)
        self._unrests.append(unrest)
        self._rearm(block, unrest)
        quiet = self._full and self._rule.quiet(window)
        if self._held and self._has_left(self._held, window, quiet, unrest):
            self._release(message("the robot moved on"))
        if not quiet:
            self._touched = None
            self._say_unquiet(window, unrest, by)
            return
        self._restless = 0.0
        if self._held:
            held, self._held = self._held, None
            self._reject(held.blocks, StillState.BUMPED, held.reason)
        touch = self._rule.touch(window, self.model)
        if touch:
            self._refuse_touch(window, touch)
        elif self._done:
            self._after.append(block)
            self._state(StillState.STILL, done_words(self._done), 0.0, window)
        else:
            self._trims, self._touched = 0, None
            # The older half of the window told that it is still; the newer has settled for longer.
            self._open = list(self._blocks)[len(self._blocks) // 2 :]
            self._consider(window)

    def _has_left(self, held: HeldCapture, window: Window, quiet: bool, unrest: float) -> bool:
        """Return whether what disturbed a capture was the beginning of a motion."""
        first, last = window.blocks[0], window.blocks[-1]
        disturbed = first.start if quiet else last.stop if unrest > 1 else -inf
        return disturbed - held.since > _KNOCK or self._turned(held.blocks, last)

    def _turned(self, blocks: Sequence[SampleBlock], now: SampleBlock) -> bool:
        before = blocks[0].R_WS
        if before is None or now.R_WS is None:
            return False
        return angle(before, now.R_WS) > self.settings.rotation

    def _rearm(self, block: SampleBlock, unrest: float) -> None:
        """Forget that the pose was captured once the robot has left it."""
        if self._done is None:
            return
        self._restless += self._intake.length * (unrest > 1)
        if self._done.R_WS is None or block.R_WS is None:
            left = self._restless >= _REARM
        else:
            left = angle(self._done.R_WS, block.R_WS) > self.settings.rotation
        if not left:
            return
        # The longer it was still, the more it shows of the slow noise.
        after = [old.mean for old in self._after[: -self._soft]]
        if len(after) > (self._blocks.maxlen or 0):
            self._rule.memory.extend(np.array(after))
        self._done = None
        self._blocks.clear()  # it moves already, however softly

    def _say_unquiet(self, window: Window, unrest: float, by: str) -> None:
        seconds = self._until_still(unrest)
        if self._held:
            words = message(
                f"Bumped, or left too early: {arg(self._held.reason)}. The next capture starts once"
                " everything is still."
            )
            self._state(StillState.BUMPED, words, seconds, window)
            return
        if seconds is None:
            self._state(StillState.MOVING, message(f"Moving: {arg(by)}."), None, window)
            return
        # A slope of the window means something only once no motion is left in it.
        if self._full and max(self._unrests) <= 1:
            excess = self._rule.creep(window, self._rule.sigma)
            if excess.max() > 1:
                words = message(f"Moving slowly, or drifting: {arg(size(window.slope, excess))}/s.")
                self._state(StillState.MOVING, words, None, window)
                return
        self._state(
            StillState.SETTLING, message(f"Settling: still in about {arg(seconds):.1f} s."), seconds, window
        )

    def _until_still(self, unrest: float) -> float | None:
        """Return the s until the window can be quiet, by how the unrest decays; None while it does not."""
        length, whole = self._intake.length, (self._blocks.maxlen or 0) * self._intake.length
        recent = np.array(self._unrests)
        if unrest <= 1:
            loud = np.flatnonzero(recent > 1)
            quiet = len(recent) - 1 - int(loud[-1]) if len(loud) else len(recent)
            return max(whole - quiet * length, 2 * length)
        tail = np.log(recent[-4:])
        if unrest > _UNREST or len(tail) < 4 or tail[0] <= tail[-1]:
            return None
        decay = 3 * length * log(unrest) / float(tail[0] - tail[-1])
        return whole + decay if decay < _DECAY else None

    def _refuse_touch(self, window: Window, touch: str) -> None:
        last = window.blocks[-1]
        if self._touched is not None:
            begun = self.rejected[self._touched]
            self.rejected[self._touched] = replace(begun, stop_index=last.last, stop=last.stop)
        elif self._done is None:
            self._touched = len(self.rejected)
            self._reject(window.blocks, StillState.TOUCHED, f"touched: {touch}")
        words = message(
            f"Touched: {arg(touch)}. Remove whatever touches the probe. If nothing does, recalibrate."
        )
        self._state(StillState.TOUCHED, words, None, window)

    # ---- in a capture --------------------------------------------------------------------------

    def _average(self, block: SampleBlock, before: Window, window: Window) -> None:
        reason = self._rule.disturbance(block, before, window)
        turned = self._turned(self._open, block)
        if not reason and not turned:
            self._open.append(block)
            self._consider(window)
            return
        if reason:
            reason += f" after {block.start - self._open[0].start:.1f} s"
        self._held, self._open = HeldCapture(self._open, reason, block.start), []
        self._blocks.clear()  # and is called still again only after a whole quiet window
        self._unrests.append(_UNREST)
        if turned:
            self._release(message("the sensor turned"))
            self._state(StillState.MOVING, message("Moving: the sensor turns."), None, window)
        else:
            self._say_unquiet(window, 2 * _UNREST, reason)

    def _consider(self, window: Window) -> None:
        """Finish the capture if it is long enough."""
        # The newest block only vouches for the others: what begins in it may not show yet.
        blocks = self._open[:-1]
        averaged = self._duration(blocks)
        if len(blocks) % 5 == 0 or len(self._open) == len(self._blocks) // 2:
            self._recommended = self._rule.duration(blocks)
        recommended = self._recommended
        if len(blocks) < 6 or averaged < recommended - 1e-6:
            words = message(
                f"Still: {arg(averaged):.1f} s of {arg(recommended):.1f} s averaged.{arg(self._blind(blocks[-1]))}"
            )
            self._state(StillState.STILL, words, 0.0, window)
            return
        tail = 0 if self._trims == _TRIMS else self._rule.tail(blocks)
        if tail:
            self._trims, self._open = self._trims + 1, self._open[tail:]
            words = message(
                f"Still, after settling late: {arg(self._duration(blocks[tail:])):.1f} s averaged so far."
            )
            self._state(StillState.STILL, words, 0.0, window)
            return
        self._open = []
        self._complete(blocks, window)

    def _complete(self, blocks: list[SampleBlock], window: Window | None) -> None:
        """Make a capture of `blocks`, or say why not; `window` is that of now if it is still."""
        whole = Window(blocks)
        refused = self._rule.refusal(whole)
        if refused:
            self._blocks.clear()  # the same samples would be refused again
            self._reject(blocks, StillState.MOVING, refused)
            self._state(StillState.MOVING, message(f"Not captured: {arg(refused)}."), None, window)
            return
        error = np.sqrt(self._rule.noise(blocks).variance(self._duration(blocks)))
        self._rule.memory.add(whole.means)
        first, last, count = blocks[0], blocks[-1], int(whole.counts.sum())
        capture = Capture(
            first.first, last.last, first.start, last.stop, whole.counts @ whole.means / count,
            np.sqrt(whole.variance), error, count, sum(block.spikes for block in blocks), last.R_WS,
        )  # fmt: skip
        self.captures.append(capture)
        self._fresh = (capture, self._fresh[1])
        self._restless = 0.0
        if window:
            self._done, self._after = capture, blocks
        self._state(StillState.STILL, done_words(capture) + self._blind(last), 0.0, window)

    def _release(self, why: str) -> None:
        """Decide on a held capture once it is known that the robot has left."""
        held, self._held = self._held, None
        if held is None:
            return
        # A robot starts softly: it has moved for a while before that is seen.
        blocks = held.blocks[: -self._soft if held.reason else None] or held.blocks[:1]
        if len(blocks) >= 6 and self._trims < _TRIMS:
            blocks = blocks[self._rule.tail(blocks) :]
        averaged = self._duration(blocks)
        needed = self._needed
        if averaged < self.settings.min_duration - 1e-6 or len(blocks) < _FEWEST_BLOCKS:
            reason = message(
                f"{arg(why)} after {arg(averaged):.1f} s of averaging; {arg(needed):.1f} s are needed"
            )
            self._reject(blocks, StillState.MOVING, reason)
        else:
            self._complete(blocks, None)

    def _duration(self, blocks: Sequence[SampleBlock]) -> float:
        return blocks[-1].stop - blocks[0].start + 1 / self._intake.rate

    def _blind(self, block: SampleBlock) -> str:
        """Say why a steady touch would not be seen."""
        if self.model is None:
            return message(" A steady touch cannot be detected before the first calibration.")
        if block.R_WS is None:
            return message(" A steady touch cannot be detected without the orientation.")
        return ""

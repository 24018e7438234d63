"""
A gravity calibration while it is being made, or checked: samples in, captures, and what they amount to.

Samples come in the streams' threads, solving happens in a thread of its own, and whoever draws it asks for a
`view` as often as it likes: none of them waits for another.
"""

import threading
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri

from contactbench.pipeline.calibration import Calibration, Level, PoseSample
from contactbench.pipeline.calibration.stillness import Capture, Stillness, StillnessDetector, StillState
from contactbench.pipeline.calibration.suggest import PosePlan, by_hand, describe
from contactbench.pipeline.calibration.verify import StillVerification, verify_still
from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.workbench.gravity_fit import (
    PLANNED,
    GravitySettings,
    PoseRow,
    PoseState,
    Solved,
    earlier_rows,
    live_rows,
    middle,
    plan,
    solve,
)
from contactbench.pipeline.workbench.live import LiveBlock

_TOUCH_RISK = 1e-5  # that an untouched moment looks touched
_OWN = np.repeat([0.05, 0.002], 3) ** 2  # what a calibration leaves beside its covariance, N² and N²·m²
_SHORT = 100  # samples: the newest moment
_NEAREST = np.radians(15.0)  # of a check to a pose that the calibration has seen: nearer, it tells little
_NEAR = message("This pose is too close to a calibration pose: turn the tool further.")
_NO_POSE = message(
    "The sensor sends readings, but no orientation arrives with them, so nothing can be captured."
)


@dataclass(frozen=True, eq=False)
class GravityView:
    """How it stands."""

    state: StillState
    sentence: str  # For the technician
    seconds: float | None  # Until it is still; None: cannot be told
    progress: float  # Share of the averaging that is done, 0 to 1
    captured: bool  # The present pose has its capture, and counts
    wanted: bool  # The present pose was asked for, and is captured as soon as it is averaged
    R_WS: NDArray[np.float64] | None  # (3, 3); How the sensor stands
    rows: tuple[PoseRow, ...]  # All poses, oldest first, also those that do not count
    count: int  # count, expected: Poses that count, and about how many it will take
    expected: int
    solved: Solved
    # The calibration's share of the contact error after each change, worst 1 sigma, m
    errors: tuple[float, ...]
    revision: int  # Grows with every change of rows and what follows from them
    busy: bool  # Something is being computed


class GravityWork:
    """
    A run of captures.

    Parameters
    ----------
    settings : GravitySettings
    live_R_ES : (3, 3), optional
        The mount that is in the orientations of the samples to come; left out: that of the settings.
    earlier : sequence of PoseSample
        Of an interrupted run, R_WS of the flange; they come first.
    automatic : bool
        Every still pose is taken; else those that `take` asks for.
    """

    def __init__(
        self,
        settings: GravitySettings,
        *,
        live_R_ES: NDArray[np.float64] | None = None,
        earlier: Sequence[PoseSample] = (),
        automatic: bool = True,
    ) -> None:
        self.settings, self.automatic = settings, automatic
        self._R_SE_live = (settings.R_ES if live_R_ES is None else live_R_ES).T
        self._earlier = tuple(
            replace(pose, time=None, name=message(f"pose {arg(number)}"))
            for number, pose in enumerate(earlier, 1)
        )
        self._lock = threading.Lock()
        self._detector = StillnessDetector()
        self._stillness: Stillness = self._detector.poll(-np.inf)
        self._chosen: dict[int, bool] = {}  # by the first sample of a capture
        self._origin = 0.0  # s: of the first sample
        self._present: int | None = None
        self._wanted = self._blind = self._heard = False
        self._tail: list[tuple[NDArray[np.float64], NDArray[np.float64]]] = []
        self._R_WE: NDArray[np.float64] | None = None
        self._planned: PosePlan | None = None
        self._solved = Solved(None, None, ())
        self._errors: tuple[float, ...] = ()
        self._rows: tuple[PoseRow, ...] = ()
        self._revision = self._done = 0
        self._problem = ""
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="gravity")
        self._waiting = False
        self._changed()

    # ---- samples, in the streams' threads ------------------------------------------------------

    def feed(self, block: LiveBlock) -> None:
        """Take samples."""
        known = block.known
        with self._lock:
            self._heard, self._blind = True, bool(block.whole.any()) and not known.any()
            if not known.any():
                return
            times, wrenches = block.times[known], block.wrenches[known]
            R_WE = self._flange(block.R_WS[known])
            if self._R_WE is None:
                self._origin = float(times[0])
            self._R_WE = R_WE[-1]
            self._tail = [*self._tail, (wrenches, R_WE[-1:])][-20:]
            before = len(self._detector.captures), len(self._detector.rejected)
            try:
                self._stillness = self._detector.update_block(times, wrenches, R_WE)
            except InputError as error:  # the clock was set back: a replay began anew
                self._problem = message(
                    f"The sample times went back, so the captures start over: {arg(error)}"
                )
                self._detector = StillnessDetector()
                self._chosen.clear()
            self._notice()
            if (len(self._detector.captures), len(self._detector.rejected)) != before:
                self._changed()

    def _flange(self, R_WS: NDArray[np.float64]) -> NDArray[np.float64]:
        R: NDArray[np.float64] = R_WS @ self._R_SE_live
        return R

    def _notice(self) -> None:
        """Mark the captures that are new as chosen or not, and the one of the present pose."""
        new = [each for each in self._detector.captures if each.start_index not in self._chosen]
        for capture in new:
            self._chosen[capture.start_index] = self.automatic or self._wanted
            self._present = capture.start_index
        state = self._stillness.state
        if state in {StillState.MOVING, StillState.BUMPED, StillState.STALE}:
            self._present, self._wanted = None, False
        elif new:
            self._wanted = False

    # ---- what the technician does --------------------------------------------------------------

    def take(self) -> str:
        """Take the present still pose, or the next as soon as it is still; returns what that means, in words."""
        with self._lock:
            state = self._stillness.state
            if self._present is not None and self._present in self._chosen:
                if self._chosen[self._present]:
                    return message("This pose is already captured. Turn the tool to the next one.")
                self._chosen[self._present] = True
                self._changed()
                return "Taken."
            if state in {StillState.STILL, StillState.SETTLING}:
                self._wanted = True
                return message("Averaging: keep still. The pose is captured as soon as this is done.")
            return message("The tool is moving: hold it still, then press again.")

    def set_automatic(self, automatic: bool) -> None:
        """Choose whether every still pose to come is taken, or those that `take` asks for."""
        with self._lock:
            self.automatic = automatic

    def set_left_out(self, moments: Iterable[float], left_out: bool) -> None:
        """Leave the poses out in which moments lie, s on the samples' clock, or take them back."""
        with self._lock:
            for moment in moments:
                for capture in self._detector.captures:
                    if capture.start <= moment <= capture.stop:
                        self._chosen[capture.start_index] = not left_out
            self._changed()

    def apply(self, settings: GravitySettings) -> None:
        """Read the poses, also those to come, by other settings."""
        with self._lock:
            self.settings = settings
            self._planned = None
            self._changed()

    def finish(self) -> None:
        """Take what was averaged until now: nothing more comes, and the session computes what it amounts to."""
        with self._lock:
            self._stillness = self._detector.finish()
            self._notice()

    @property
    def left_out(self) -> tuple[float, ...]:
        """Moments, s, that name the captures which do not count: the session's parameter `leave_out`."""
        with self._lock:
            return tuple(
                middle(each)
                for each in self._detector.captures
                if not self._chosen.get(each.start_index, True)
            )

    # ---- how it stands -------------------------------------------------------------------------

    @property
    def solved(self) -> Solved:
        """What the taken poses amount to, as far as it is computed."""
        with self._lock:
            return self._solved

    def view(self, now: float | None = None) -> GravityView:
        """Return how it stands; `now` is the present time on the samples' clock, s, to see that none come."""
        with self._lock:
            stillness = self._stillness if now is None else self._detector.poll(now)
            state, sentence = stillness.state, stillness.sentence
            if self._blind or not self._heard:
                state, sentence = StillState.STALE, _NO_POSE if self._blind else sentence
            touched = self._touched() if state is StillState.STILL else ""
            if touched:
                state, sentence = StillState.TOUCHED, touched
            done = self._present is not None and self._chosen.get(self._present, False)
            share = min(stillness.averaged / max(stillness.recommended, 1e-3), 1.0)
            R_WS = None if self._R_WE is None else self.settings.sensor_orientations(self._R_WE)
            solved = self._solved
            count = sum(row.state is PoseState.TAKEN for row in self._rows)
            expected = count if solved.enough else max(count + 1, PLANNED)
            return GravityView(
                state, join(" ", (self._problem, sentence)).strip(), stillness.seconds_until_still, share, done,
                self._wanted, R_WS, self._rows, count, expected, solved, self._errors, self._revision,
                self._done != self._revision,
            )  # fmt: skip

    def _touched(self) -> str:
        """Say what the still reading shows that the calibration so far does not explain; empty: nothing."""
        fitted = self._solved.calibration
        if fitted is None or fitted.verdict.level is Level.REFUSE or self._R_WE is None:
            return ""
        wrenches = np.concatenate([wrenches for wrenches, _ in self._tail])[-_SHORT:]
        R_WS = self.settings.sensor_orientations(self._R_WE)
        residual = wrenches.mean(axis=0) - fitted.model.predict(R_WS)
        C = fitted.model.wrench_covariance(R_WS) + np.diag(_OWN)
        if residual @ np.linalg.solve(C, residual) <= chdtri(6, _TOUCH_RISK):
            return ""
        return message(
            f"Something touches the tool: {arg(np.linalg.norm(residual[:3])):.2g} N more than its"
            " weight. Remove it, or move on if nothing does."
        )

    def close(self) -> None:
        """End its thread."""
        self._worker.shutdown(wait=True, cancel_futures=True)

    def wait(self) -> None:
        """Wait until everything is computed."""
        while self.view().busy:
            self._worker.submit(lambda: None).result()

    # ---- solving, in its own thread ------------------------------------------------------------

    def _changed(self) -> None:
        """Note that poses changed; the lock is held."""
        self._revision += 1
        self._rows = self._table()
        if not self._waiting:
            self._waiting = True
            self._worker.submit(self._solve)

    def _solve(self) -> None:
        with self._lock:
            self._waiting = False
            revision, settings, poses = self._revision, self.settings, self._poses()
            planned, R_WE = self._planned, self._R_WE
        now = None if R_WE is None else settings.sensor_orientations(R_WE)
        try:
            planned = planned or plan(settings)
            solved, problem = solve(poses, settings, planned, now), ""
        except InputError as error:
            solved, problem = Solved(None, None, ()), str(error)
        with self._lock:
            self._planned, self._solved, self._problem = planned, solved, problem
            if solved.calibration is not None:
                share = solved.calibration.contact_error
                self._errors = self._errors if self._errors[-1:] == (share,) else (*self._errors, share)
            self._rows, self._done = self._table(), revision

    def _poses(self) -> tuple[PoseSample, ...]:
        """Return the poses that count, R_WS of the flange, each with the name that its row has."""
        first = len(self._earlier) + 1
        new = [
            capture.to_pose(name=message(f"pose {arg(number)}"))
            for number, capture in enumerate(self._detector.captures, first)
            if self._counts(capture)
        ]
        return (*self._earlier, *new)

    def _counts(self, capture: Capture) -> bool:
        return self._chosen.get(capture.start_index, self.automatic)

    def _table(self) -> tuple[PoseRow, ...]:
        fitted, origin = self._solved.calibration, self._origin
        captures = [(each, self._counts(each)) for each in self._detector.captures]
        return (
            *earlier_rows(self._earlier, self.settings, fitted),
            *live_rows(
                captures, self._detector.rejected, len(self._earlier) + 1, self.settings, fitted, origin
            ),
        )


class GravityCheck:
    """
    Waits for a still pose that differs from a calibration's own, and compares.

    One pose says little; each further check counts those before it too.

    Parameters
    ----------
    calibration : Calibration
    settings : GravitySettings
    live_R_ES : (3, 3), optional
        The mount that is in the orientations of the samples to come; left out: that of the settings.
    before : sequence of PoseSample
        Of earlier checks.

    Attributes
    ----------
    found : StillVerification or None
        Once there was such a pose.
    poses : tuple of PoseSample
        All that were compared.
    proposal : (3, 3)
        R_WS in which the calibration is worth checking.
    """

    def __init__(
        self,
        calibration: Calibration,
        settings: GravitySettings,
        *,
        live_R_ES: NDArray[np.float64] | None = None,
        before: Sequence[PoseSample] = (),
    ) -> None:
        self._calibration, self._settings = calibration, settings
        self._R_SE_live = (settings.R_ES if live_R_ES is None else live_R_ES).T
        self._lock = threading.Lock()
        self._detector = StillnessDetector()
        self.poses = tuple(before)
        down = settings.down_W
        self._seen = np.array([down @ pose.R_WS for pose in (*calibration.poses, *before)])  # down, in S
        self._word = ""
        self.found: StillVerification | None = None
        self.proposal = self._farthest()

    @property
    def sentence(self) -> str:
        """What to do, or what is going on."""
        if self._word:
            return self._word
        stands = describe(self.proposal, self._settings.down_W)
        return message(f"Turn the tool to a new pose: {arg(stands)}. Then keep still.")

    def _farthest(self) -> NDArray[np.float64]:
        """Return the orientation whose weight pulls least like that of any pose so far."""
        tilt, down = float(np.radians(self._settings.max_tilt)), self._settings.down_W
        candidates = by_hand(300, max_tilt=tilt, down_W=down).R_WS
        nearness = (np.array(down) @ candidates @ self._seen.T).max(axis=1)
        farthest: NDArray[np.float64] = candidates[int(np.argmin(nearness))]
        return farthest

    def feed(self, block: LiveBlock) -> None:
        """Take samples, in the streams' thread."""
        known = block.known
        if self.found is not None or not known.any():
            return
        with self._lock:
            R_WS = self._settings.sensor_orientations(block.R_WS[known] @ self._R_SE_live)
            before = len(self._detector.captures)
            now = self._detector.update_block(block.times[known], block.wrenches[known], R_WS)
            if now.state is StillState.MOVING:
                self._word = ""
            elif self._word is not _NEAR:
                self._word = now.sentence
            for capture in self._detector.captures[before:]:
                pose = capture.to_pose(name=f"check {len(self.poses) + 1}")
                if (
                    np.arccos(np.clip((self._seen @ (self._settings.down_W @ pose.R_WS)).max(), -1, 1))
                    < _NEAREST
                ):
                    self._word = _NEAR
                    continue
                self.poses = (*self.poses, pose)
                self.found = verify_still(self._calibration, self.poses)
                return

    @property
    def state(self) -> StillState:
        """What the reading does."""
        with self._lock:
            return self._detector.poll(-np.inf).state
